/* rows.h - inside the core: rows of complex numbers for the hot files, `width` real parts and as many imaginary ones
 * behind them; the width is a multiple of BD_LANES. */
#ifndef BD_ROWS_H
#define BD_ROWS_H

#include "lanes.h"

#define BD_ROW_RE(p) LANES(p)
#define BD_ROW_IM(p) LANES((p) + width)

/* to -= (s_re + i s_im) from, from the register on that holds entry `first`. */
BD_INLINE void row_minus(size_t width, size_t first, double *to, double s_re, double s_im,
                         const double *from)
{
    for (size_t j = first / BD_WIDTH * BD_WIDTH; j < width; j += BD_WIDTH) {
        const lanes re = BD_ROW_RE(from + j), im = BD_ROW_IM(from + j);
        LANES_AT(to + j) -= s_re * re - s_im * im;
        LANES_AT(to + width + j) -= s_re * im + s_im * re;
    }
}

BD_INLINE void row_exchange(size_t width, double *a, double *b)
{
    for (size_t j = 0; j < 2 * width; j += BD_WIDTH) {
        const lanes kept = LANES(a + j);
        LANES_AT(a + j) = LANES(b + j);
        LANES_AT(b + j) = kept;
    }
}

/* Which of the rows k ... n - 1 (each 2 width doubles) is largest in column k; `largest` becomes its square there, or
 * stays 0 where all vanish or are not numbers. */
BD_INLINE int row_of_pivot(size_t width, int k, int n, const double *rows, double *largest)
{
    int pivot = k;
    *largest = 0.0;
    for (int i = k; i < n; i++) {
        const double *a = rows + 2 * width * (size_t)i + k;
        const double size = a[0] * a[0] + a[width] * a[width];
        if (size > *largest) {
            *largest = size;
            pivot = i;
        }
    }
    return pivot;
}

#endif
