#include "lapack.h"

#include <math.h>

/* A pivot this much smaller than the largest marks a matrix without a usable inverse: the factors
 * of an exactly singular matrix carry round-off, not a zero, in its place. */
static const double pivot_floor = 1e-15;

int bd_solve_real(const bd_lapack *lapack, int n, double *A, int *pivots, int nrhs, double *B)
{
    int info = 0;
    char plain = 'N';
    if (n == 0)
        return 0;
    lapack->dgetrf(&n, &n, A, &n, pivots, &info);
    if (info != 0)
        return 1;
    double largest = 0.0, smallest = INFINITY;
    for (int i = 0; i < n; i++) {
        double pivot = fabs(A[(long)i * n + i]);
        largest = fmax(largest, pivot);
        smallest = fmin(smallest, pivot);
    }
    if (!(smallest > pivot_floor * largest))
        return 1;
    lapack->dgetrs(&plain, &n, &nrhs, A, &n, pivots, B, &n, &info);
    return info != 0;
}

int bd_solve_complex(const bd_lapack *lapack, int n, double *A, int *pivots, int nrhs, double *B)
{
    int info = 0;
    char plain = 'N';
    if (n == 0)
        return 0;
    lapack->zgetrf(&n, &n, A, &n, pivots, &info);
    if (info != 0)
        return 1;
    lapack->zgetrs(&plain, &n, &nrhs, A, &n, pivots, B, &n, &info);
    return info != 0;
}
