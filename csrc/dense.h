/* dense.h - inside the core: small dense kernels of the march, inlined into its clones.
 *
 * Matrices are in column form: column c of an operator is contiguous and padded to whole lanes, so that a
 * product is a sum of scaled columns, whose order no compiler may change. */
#ifndef BD_DENSE_H
#define BD_DENSE_H

#include "lanes.h"

/* One tile of rows, SETS registers wide; what is outside `inside` is not added, where that is not NULL. Even and odd
 * columns are summed apart to hide the latency of an addition; the order is part of the result and the same on every
 * machine. */
#define DEFINE_TILE(NAME, SETS)                                                                    \
    BD_INLINE void NAME(int n_columns, const double *restrict A, int stride,                       \
                        const double *restrict u, const long long *inside, double *restrict y)     \
    {                                                                                              \
        lanes even[SETS] = {{0}}, odd[SETS] = {{0}};                                               \
        int c = 0;                                                                                 \
        for (; c + 1 < n_columns; c += 2) {                                                        \
            const double *a0 = A + (size_t)c * (size_t)stride, *a1 = a0 + stride;                  \
            for (int i = 0; i < SETS; i++) {                                                       \
                even[i] += LANES(a0 + i * BD_WIDTH) * u[c];                                        \
                odd[i] += LANES(a1 + i * BD_WIDTH) * u[c + 1];                                     \
            }                                                                                      \
        }                                                                                          \
        if (c < n_columns)                                                                         \
            for (int i = 0; i < SETS; i++)                                                         \
                even[i] += LANES(A + (size_t)c * (size_t)stride + i * BD_WIDTH) * u[c];            \
        for (int i = 0; i < SETS; i++) {                                                           \
            lanes sum = even[i] + odd[i];                                                          \
            if (inside)                                                                            \
                sum = LANES_WHERE(LANE_MASK(inside + i * BD_WIDTH), sum);                          \
            LANES_AT(y + i * BD_WIDTH) += sum;                                                     \
        }                                                                                          \
    }

DEFINE_TILE(tile_1, 1)
DEFINE_TILE(tile_2, 2)
DEFINE_TILE(tile_4, 4)

/* y += sum_c u[c] A[c * stride + (0 ... rows)] where all bits of `inside` (rows) are set, or everywhere where that is
 * NULL; rows a multiple of BD_LANES. */
BD_INLINE void columns_add_inside(int rows, int n_columns, const double *A, int stride,
                                  const double *u, const long long *inside, double *y)
{
    int r = 0;
    for (; r + 4 * BD_WIDTH <= rows; r += 4 * BD_WIDTH)
        tile_4(n_columns, A + r, stride, u, inside ? inside + r : inside, y + r);
    if (r + 2 * BD_WIDTH <= rows) {
        tile_2(n_columns, A + r, stride, u, inside ? inside + r : inside, y + r);
        r += 2 * BD_WIDTH;
    }
    if (r < rows)
        tile_1(n_columns, A + r, stride, u, inside ? inside + r : inside, y + r);
}

/* The same everywhere; what is inlined knows no mask. */
BD_INLINE void columns_add(int rows, int n_columns, const double *A, int stride, const double *u,
                           double *y)
{
    columns_add_inside(rows, n_columns, A, stride, u, (const long long *)0, y);
}

/* The same for two vectors at once: y1 += A u1, y2 += A u2, each column read once. */
BD_INLINE void columns_add_two(int rows, int n_columns, const double *A, int stride,
                               const double *u1, const double *u2, double *y1, double *y2)
{
    for (int r = 0; r < rows; r += BD_WIDTH) {
        lanes even1 = {0}, even2 = {0}, odd1 = {0}, odd2 = {0};
        int c = 0;
        for (; c + 1 < n_columns; c += 2) {
            const double *a = A + (size_t)c * (size_t)stride + r;
            even1 += LANES(a) * u1[c];
            even2 += LANES(a) * u2[c];
            odd1 += LANES(a + stride) * u1[c + 1];
            odd2 += LANES(a + stride) * u2[c + 1];
        }
        if (c < n_columns) {
            const double *a = A + (size_t)c * (size_t)stride + r;
            even1 += LANES(a) * u1[c];
            even2 += LANES(a) * u2[c];
        }
        LANES_AT(y1 + r) += even1 + odd1;
        LANES_AT(y2 + r) += even2 + odd2;
    }
}

#undef DEFINE_TILE

/* inverse = A^-1 by Gauss-Jordan elimination with partial pivoting; A (n x stride row-major) is
 * destroyed, the inverse is written in column form (n columns of stride; padding rows zero).
 * Returned: 0, or nonzero where a pivot vanishes or is not finite. */
int bd_invert(int n, int stride, double *A, double *inverse);

#endif
