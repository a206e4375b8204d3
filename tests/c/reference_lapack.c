#include "reference_lapack.h"

#include <complex.h>
#include <math.h>

/* Right-looking LU with partial pivoting, once for each kind of number. */
#define DEFINE_LU(TYPE, MAGNITUDE, FACTOR, SOLVE)                                                  \
    static void FACTOR(int *m, int *n, TYPE *a, int *lda, int *ipiv, int *info)                    \
    {                                                                                              \
        const int rows = *m, stride = *lda;                                                        \
        *info = 0;                                                                                 \
        for (int k = 0; k < *n && k < rows; k++) {                                                 \
            TYPE *column = a + (long)k * stride;                                                   \
            int pivot = k;                                                                         \
            for (int i = k + 1; i < rows; i++)                                                     \
                if (MAGNITUDE(column[i]) > MAGNITUDE(column[pivot]))                               \
                    pivot = i;                                                                     \
            ipiv[k] = pivot + 1;                                                                   \
            if (column[pivot] == 0.0) {                                                            \
                *info = *info ? *info : k + 1;                                                     \
                continue;                                                                          \
            }                                                                                      \
            for (int j = 0; pivot != k && j < *n; j++) {                                           \
                TYPE *entry = a + (long)j * stride, kept = entry[k];                               \
                entry[k] = entry[pivot];                                                           \
                entry[pivot] = kept;                                                               \
            }                                                                                      \
            for (int i = k + 1; i < rows; i++)                                                     \
                column[i] /= column[k];                                                            \
            for (int j = k + 1; j < *n; j++)                                                       \
                for (int i = k + 1; i < rows; i++)                                                 \
                    a[(long)j * stride + i] -= column[i] * a[(long)j * stride + k];                \
        }                                                                                          \
    }                                                                                              \
                                                                                                   \
    static void SOLVE(char *trans, int *n, int *nrhs, TYPE *a, int *lda, int *ipiv, TYPE *b,       \
                      int *ldb, int *info)                                                         \
    {                                                                                              \
        const int rows = *n;                                                                       \
        *info = *trans == 'N' ? 0 : -1;                                                            \
        for (int c = 0; c < *nrhs; c++) {                                                          \
            TYPE *x = b + (long)c * *ldb;                                                          \
            for (int k = 0; k < rows; k++) {                                                       \
                TYPE kept = x[k];                                                                  \
                x[k] = x[ipiv[k] - 1];                                                             \
                x[ipiv[k] - 1] = kept;                                                             \
            }                                                                                      \
            for (int k = 0; k < rows; k++)                                                         \
                for (int i = k + 1; i < rows; i++)                                                 \
                    x[i] -= a[(long)k * *lda + i] * x[k];                                          \
            for (int k = rows - 1; k >= 0; k--) {                                                  \
                x[k] /= a[(long)k * *lda + k];                                                     \
                for (int i = 0; i < k; i++)                                                        \
                    x[i] -= a[(long)k * *lda + i] * x[k];                                          \
            }                                                                                      \
        }                                                                                          \
    }

DEFINE_LU(double, fabs, factor_real, solve_real)
DEFINE_LU(double complex, cabs, factor_complex, solve_complex)

static void zgetrf(int *m, int *n, void *a, int *lda, int *ipiv, int *info)
{
    factor_complex(m, n, a, lda, ipiv, info);
}

static void zgetrs(char *trans, int *n, int *nrhs, void *a, int *lda, int *ipiv, void *b, int *ldb,
                   int *info)
{
    solve_complex(trans, n, nrhs, a, lda, ipiv, b, ldb, info);
}

const bd_lapack reference_lapack = {factor_real, solve_real, zgetrf, zgetrs};
