/* Blocks held by springs S of their own, joined by what these lack:
 *
 *     (I + P Y) h = P Y_F,    P v = Z sum_c v_c - S v_b,    x = X_F - X_b h
 *
 * Y and Y_F are the motions y of all joints under unit forces at them and under those asked for. */
#include "join.h"

#include <math.h>
#include <string.h>

#include "rows.h"

/* Joining the blocks cancels as many digits as I + P Y is large: near a resonance of a block by itself, and at low
 * frequency where one floats although its bearings' springs hold it. */
static const double largest_joint = 1e4;

/* Rows [I + P Y, P Y_F] into `to`; `sums` and `forces` have a row for each coefficient. */
static void form(const bd_joints *j, double *sums, double *forces, double *to)
{
    const size_t width = j->width, size = 2 * width, m = (size_t)j->n_coefs;
    memset(sums, 0, size * m * sizeof *sums);
    memset(forces, 0, size * m * sizeof *forces);
    for (int i = 0; i < j->n_joints; i++)
        row_minus(width, 0, sums + size * (size_t)j->coef[i], -1.0, 0.0, j->y + size * (size_t)i);
    for (size_t k = 0; k < m; k++)
        for (size_t l = 0; l < m; l++) {
            const double *Z = j->Z + 2 * (k * m + l);
            if (Z[0] != 0.0 || Z[1] != 0.0)
                row_minus(width, 0, forces + size * k, -Z[0], -Z[1], sums + size * l);
        }
    for (size_t i = 0; i < (size_t)j->n_joints; i++) {
        const size_t k = (size_t)j->coef[i];
        memcpy(to + size * i, forces + size * k, size * sizeof *to);
        row_minus(width, 0, to + size * i, j->S[k], 0.0, j->y + size * i);
        to[size * i + i] += 1.0;
    }
}

int BD_NAMED(bd_join_blocks)(const bd_joints *j)
{
    const size_t width = j->width, size = 2 * width, joints = (size_t)j->n_joints;
    double *sums = j->memory, *forces = sums + size * (size_t)j->n_coefs;
    double *A = forces + size * (size_t)j->n_coefs;
    form(j, sums, forces, A);

    for (size_t i = 0; i < joints; i++)
        for (size_t c = 0; c < joints; c++) {
            const double *a = A + size * i + c;
            if (!(fabs(a[0]) + fabs(a[width]) <= largest_joint))
                return 1;
        }

    for (int k = 0; k < j->n_joints; k++) {
        double pivot;
        const int from = row_of_pivot(width, k, j->n_joints, A, &pivot);
        double *u = A + size * (size_t)k;
        if (!(pivot > 0.0))
            return 1;
        if (from != k)
            row_exchange(width, u, A + size * (size_t)from);
        const double p_re = u[k] / pivot, p_im = -u[width + (size_t)k] / pivot;
        for (size_t i = (size_t)k + 1; i < joints; i++) {
            double *a = A + size * i;
            const double re = a[k], im = a[width + (size_t)k];
            row_minus(width, (size_t)k, a, re * p_re - im * p_im, re * p_im + im * p_re, u);
        }
    }
    /* h in the columns of the forces, from the last row up */
    for (size_t k = joints; k-- > 0;) {
        double *h = A + size * k;
        for (size_t i = k + 1; i < joints; i++)
            row_minus(width, j->first, h, h[i], h[width + i], A + size * i);
        const double re = h[k], im = h[width + k], over = 1.0 / (re * re + im * im);
        const double s_re = re * over, s_im = -im * over;
        for (size_t c = j->first; c < width; c += BD_WIDTH) {
            const lanes h_re = BD_ROW_RE(h + c), h_im = BD_ROW_IM(h + c);
            LANES_AT(h + c) = s_re * h_re - s_im * h_im;
            LANES_AT(h + width + c) = s_re * h_im + s_im * h_re;
        }
    }
    for (size_t o = 0; o < (size_t)j->n_out; o++) {
        double *x = j->x + size * o;
        for (size_t i = 0; i < joints; i++)
            if (x[i] != 0.0 || x[width + i] != 0.0)
                row_minus(width, j->first, x, x[i], x[width + i], A + size * i);
    }
    return 0;
}
