/* What a change of the layers' moduli does to their own motions, at one frequency.
 *
 *     (I + R Delta) y = alone,    (I + R Delta) dy_l = -R (dDelta_l) y
 *
 * A few dozen coordinates: rows are kept as one register after another of real and imaginary parts, and eliminated with
 * rows exchanged, since a change that softens a resonance makes the matrix small. */
#include "changed_layers.h"

#include <string.h>

#include "lanes.h"

typedef struct scratch {
    size_t width; /* doubles of the real parts of a row, and of the imaginary ones behind them */
    double *R, *U,
        *L; /* (rank) rows; those of U and L as they were exchanged, L without its diagonal of ones */
    double *x, *b; /* one row each */
} scratch;

#define RE(p) LANES(p)
#define IM(p) LANES((p) + width)

/* Sum of a row times x from the group of BD_LANES that holds `first` on to before `end`; in an order that does not hang
 * on the width of a register. */
BD_INLINE void dot(size_t width, const double *row, const double *x, size_t first, size_t end,
                   double *re, double *im)
{
    enum { GROUPS = BD_LANES / BD_WIDTH };
    lanes sum_re[GROUPS] = {{0}}, sum_im[GROUPS] = {{0}};
    for (size_t j = first / BD_LANES * BD_LANES; j < end; j += BD_LANES)
        for (size_t g = 0; g < GROUPS; g++) {
            const double *a = row + j + g * BD_WIDTH, *b = x + j + g * BD_WIDTH;
            sum_re[g] += RE(a) * RE(b) - IM(a) * IM(b);
            sum_im[g] += RE(a) * IM(b) + IM(a) * RE(b);
        }
    double r[BD_LANES], i[BD_LANES];
    for (size_t g = 0; g < GROUPS; g++) {
        LANES_AT(r + g * BD_WIDTH) = sum_re[g];
        LANES_AT(i + g * BD_WIDTH) = sum_im[g];
    }
    *re = ((r[0] + r[4]) + (r[2] + r[6])) + ((r[1] + r[5]) + (r[3] + r[7]));
    *im = ((i[0] + i[4]) + (i[2] + i[6])) + ((i[1] + i[5]) + (i[3] + i[7]));
}

/* x = U^-1 L^-1 b with b in the order of the pivots, where it stands in the scratch; b is destroyed. */
static void substitute(const scratch *s, int rank)
{
    double *b = s->b, *x = s->x;
    for (int i = 1; i < rank; i++) {
        double re, im;
        dot(s->width, s->L + 2 * s->width * (size_t)i, b, 0, (size_t)i, &re, &im);
        b[i] -= re;
        b[s->width + (size_t)i] -= im;
    }
    memset(x, 0, 2 * s->width * sizeof *x);
    for (int i = rank - 1; i >= 0; i--) {
        const double *row = s->U + 2 * s->width * (size_t)i;
        double re, im;
        /* what lies left of the diagonal in its register meets zeros of x */
        dot(s->width, row, x, (size_t)i, s->width, &re, &im);
        re = b[i] - re;
        im = b[s->width + (size_t)i] - im;
        const double p_re = row[i], p_im = row[s->width + (size_t)i];
        const double over = 1.0 / (p_re * p_re + p_im * p_im);
        x[i] = (re * p_re + im * p_im) * over;
        x[s->width + (size_t)i] = (im * p_re - re * p_im) * over;
    }
}

/* L U = I + R Delta with rows exchanged: row i of it was row order[i]. Returned: nonzero where it is singular. */
static int factor(const scratch *s, int rank, int *order)
{
    const size_t width = s->width, row_size = 2 * width;
    for (int k = 0; k < rank; k++) {
        int pivot = k;
        double largest = -1.0;
        for (int i = k; i < rank; i++) {
            const double *a = s->U + row_size * (size_t)i + k;
            const double size = a[0] * a[0] + a[width] * a[width];
            if (size > largest) {
                largest = size;
                pivot = i;
            }
        }
        if (!(largest > 0.0))
            return 1;
        double *u = s->U + row_size * (size_t)k;
        if (pivot != k) {
            double *other = s->U + row_size * (size_t)pivot;
            double *l = s->L + row_size * (size_t)k, *below = s->L + row_size * (size_t)pivot;
            for (size_t j = 0; j < row_size; j += BD_WIDTH) {
                const lanes a = LANES(u + j), b = LANES(l + j);
                LANES_AT(u + j) = LANES(other + j);
                LANES_AT(other + j) = a;
                LANES_AT(l + j) = LANES(below + j);
                LANES_AT(below + j) = b;
            }
            const int was = order[k];
            order[k] = order[pivot];
            order[pivot] = was;
        }
        const double over = 1.0 / largest, p_re = u[k] * over, p_im = -u[width + (size_t)k] * over;
        for (int i = k + 1; i < rank; i++) {
            double *a = s->U + row_size * (size_t)i, *l = s->L + row_size * (size_t)i;
            const double a_re = a[k], a_im = a[width + (size_t)k];
            const double l_re = a_re * p_re - a_im * p_im, l_im = a_re * p_im + a_im * p_re;
            l[k] = l_re;
            l[width + (size_t)k] = l_im;
            /* from the register that holds the diagonal on: what lies left of it is not read again */
            for (size_t j = (size_t)k / BD_WIDTH * BD_WIDTH; j < width; j += BD_WIDTH) {
                const lanes u_re = RE(u + j), u_im = IM(u + j);
                LANES_AT(a + j) -= l_re * u_re - l_im * u_im;
                LANES_AT(a + width + j) -= l_re * u_im + l_im * u_re;
            }
        }
    }
    return 0;
}

int BD_NAMED(bd_changed_layers_solve)(const bd_changed_layers *layers, const double *receptance,
                                      size_t stride, const double *alone, const double *change,
                                      const double *slope, double *memory, int *order, double *y,
                                      double *moved)
{
    const int rank = layers->rank;
    const size_t n = (size_t)rank;
    const size_t width = (size_t)BD_PADDED(rank), row_size = 2 * width;
    const scratch s = {.width = width,
                       .R = memory,
                       .U = memory + row_size * n,
                       .L = memory + row_size * 2 * n,
                       .x = memory + row_size * 3 * n,
                       .b = memory + row_size * (3 * n + 1)};
    memset(s.L, 0, row_size * n * sizeof *s.L);

    for (size_t i = 0; i < n; i++) {
        const double *from = receptance + i * stride;
        double *R = s.R + row_size * i, *U = s.U + row_size * i;
        int l = 0;
        for (size_t j = 0; j < n; j++) {
            while ((int)j >= layers->end[l])
                l++;
            const double re = from[2 * j], im = from[2 * j + 1];
            const double d_re = 2.0 * change[2 * l], d_im = 2.0 * change[2 * l + 1];
            R[j] = re;
            R[width + j] = im;
            U[j] = re * d_re - im * d_im;
            U[width + j] = re * d_im + im * d_re;
        }
        U[i] += 1.0;
        order[i] = (int)i;
    }
    if (factor(&s, rank, order))
        return 1;

    for (int i = 0; i < rank; i++) {
        s.b[i] = alone[2 * order[i]];
        s.b[width + (size_t)i] = alone[2 * order[i] + 1];
    }
    substitute(&s, rank);
    for (size_t i = 0; i < n; i++) {
        y[2 * i] = s.x[i];
        y[2 * i + 1] = s.x[width + i];
    }

    int first = 0;
    for (int l = 0; l < layers->n_layers; first = layers->end[l++], moved += 2 * n) {
        const double d_re = -2.0 * slope[2 * l], d_im = -2.0 * slope[2 * l + 1];
        memset(s.x, 0, row_size * sizeof *s.x);
        for (int j = first; j < layers->end[l]; j++) {
            s.x[j] = d_re * y[2 * j] - d_im * y[2 * j + 1];
            s.x[width + (size_t)j] = d_re * y[2 * j + 1] + d_im * y[2 * j];
        }
        for (int i = 0; i < rank; i++)
            dot(width, s.R + row_size * (size_t)order[i], s.x, (size_t)first,
                (size_t)layers->end[l], &s.b[i], &s.b[width + (size_t)i]);
        substitute(&s, rank);
        for (size_t i = 0; i < n; i++) {
            moved[2 * i] = s.x[i];
            moved[2 * i + 1] = s.x[width + i];
        }
    }
    return 0;
}
