/* The small dense kernels of the march: products of columns, and the inverse of Newton's matrix. */
#include "dense.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "systems.h"

static void products_of_columns_are_sums(void)
{
    enum { ROWS = 64, COLUMNS = 9, STRIDE = 72 };
    unsigned long long seed = 31;
    double A[COLUMNS * STRIDE], u1[COLUMNS], u2[COLUMNS];
    for (int i = 0; i < COLUMNS * STRIDE; i++)
        A[i] = uniform(&seed);
    for (int c = 0; c < COLUMNS; c++) {
        u1[c] = uniform(&seed);
        u2[c] = uniform(&seed);
    }
    for (int rows = 0; rows <= ROWS; rows += BD_LANES)
        for (int columns = 0; columns <= COLUMNS; columns++) {
            double y[ROWS + 1], one[ROWS + 1], two[ROWS + 1];
            for (int r = 0; r <= ROWS; r++)
                y[r] = one[r] = two[r] = (double)r;
            columns_add(rows, columns, A, STRIDE, u1, y);
            columns_add_two(rows, columns, A, STRIDE, u1, u2, one, two);
            for (int r = 0; r <= ROWS; r++) {
                double first = (double)r, second = (double)r;
                for (int c = 0; c < columns && r < rows; c++) {
                    first += A[c * STRIDE + r] * u1[c];
                    second += A[c * STRIDE + r] * u2[c];
                }
                /* nine roundings of numbers below 73 */
                CHECK_CLOSE("product of columns", y[r], first, 1e-13);
                CHECK_CLOSE("first of two products", one[r], first, 1e-13);
                CHECK_CLOSE("second of two products", two[r], second, 1e-13);
            }
        }
}

/* |A A^-1 - 1| for one matrix; the inverse comes in columns. */
static double inverse_error(int n, int stride, const double *A)
{
    double copy[16 * 16], inverse[16 * 16], worst = 0.0;
    memcpy(copy, A, sizeof copy);
    memset(inverse, 0x55, sizeof inverse);
    if (bd_invert(n, stride, copy, inverse))
        return INFINITY;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double sum = i == j ? -1.0 : 0.0;
            for (int k = 0; k < n; k++)
                sum += A[i * stride + k] * inverse[j * stride + k];
            worst = fmax(worst, fabs(sum));
        }
    for (int j = 0; j < n; j++)
        for (int i = n; i < stride; i++)
            CHECK_CLOSE("padding of an inverse", inverse[j * stride + i], 0.0, 0.0);
    return worst;
}

static void an_inverse_pivots(void)
{
    enum { N = 11, STRIDE = 16 };
    unsigned long long seed = 37;
    double A[STRIDE * STRIDE] = {0};
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            A[i * STRIDE + j] = uniform(&seed);
    CHECK_BELOW("inverse of a full matrix", inverse_error(N, STRIDE, A), 1e-12);
    for (int i = 0; i < N; i++)
        A[i * STRIDE + i] = 1e-18; /* without pivoting nothing of this one is left */
    CHECK_BELOW("inverse of a matrix without a diagonal", inverse_error(N, STRIDE, A), 1e-12);
    memset(A, 0, sizeof A);
    for (int i = 0; i < N; i++)
        A[i * STRIDE + (i + 4) % N] = (double)(i + 1);
    CHECK_BELOW("inverse of a permutation", inverse_error(N, STRIDE, A), 1e-15);
}

static void a_matrix_without_inverse_is_told(void)
{
    double A[16 * 16] = {0};
    for (int i = 0; i < 5; i++)
        A[i * 16 + i] = 1.0;
    A[3 * 16 + 3] = 0.0;
    CHECK_EQUAL("a zero on the diagonal", inverse_error(5, 16, A) < 1e300, 0);
    A[3 * 16 + 3] = NAN;
    CHECK_EQUAL("not a number on the diagonal", inverse_error(5, 16, A) < 1e300, 0);
    A[3 * 16 + 3] = INFINITY;
    CHECK_EQUAL("infinity on the diagonal", inverse_error(5, 16, A) < 1e300, 0);
}

int main(void)
{
    products_of_columns_are_sums();
    an_inverse_pivots();
    a_matrix_without_inverse_is_told();
    return check_result();
}
