/* Receptances P D^-1 Q of one block, at one frequency per lane.
 *
 *     D(omega) = K - omega^2 M + i omega C + sum_l 2 G*_l(omega) H_l,    D = L U
 *
 * Only what the rows P and the columns Q see is wanted, so D is eliminated and never solved with: Q rides along as
 * further columns of U, P as further rows of L, and P D^-1 Q = (P U^-1)(L^-1 Q). Where D is symmetric L is U^T over
 * the pivots, and half of it need not be worked out.
 *
 * Lanes cannot exchange rows each in its own way, so pivots are taken in a fixed order, stiff coordinates first: what
 * lies above the frequency is then eliminated as if it were static, and the damping, which makes the imaginary part
 * positive, bounds what is left. How far sums outgrew what they were formed from is returned, lane by lane, for the
 * caller to do better where it was too far. */
#include "receptance.h"

#include "dense.h"
#include "lanes.h"

enum {
    PAIR = 2 * BD_WIDTH,
    TILE = 4
}; /* doubles of a complex number of lanes; columns at a time */

/* (re, im) -= a b */
#define MINUS_PRODUCT(re, im, a_re, a_im, b_re, b_im)                                              \
    do {                                                                                           \
        (re) -= (a_re) * (b_re) - (a_im) * (b_im);                                                 \
        (im) -= (a_re) * (b_im) + (a_im) * (b_re);                                                 \
    } while (0)

#define RE(p) LANES(p)
#define IM(p) LANES((p) + BD_WIDTH)

/* Frequencies of all lanes. */
typedef struct pencil {
    lanes omega, square;
} pencil;

/* Coefficients of D_ij, with the moduli and frequencies of the lanes. */
BD_INLINE void entry(const bd_receptance *block, const pencil *at, const double *moduli,
                     const double *from, lanes *re, lanes *im)
{
    *re = from[0] - at->square * from[1];
    *im = at->omega * from[2];
    for (int l = 0; l < block->n_layers; l++) {
        *re += LANES(moduli + l * PAIR) * from[3 + l];
        *im += LANES(moduli + l * PAIR + BD_WIDTH) * from[3 + l];
    }
}

/* TILE (or fewer: `count`) numbers row[j] = a[j] - sum_(k < i) left[k] right[k][j]; `right` goes down a column. */
#define DEFINE_TILE(NAME, COUNT)                                                                   \
    BD_INLINE void NAME(int i, const double *restrict left, size_t left_stride,                    \
                        const double *restrict right, size_t stride, double *restrict row)         \
    {                                                                                              \
        lanes re[COUNT], im[COUNT];                                                                \
        for (int c = 0; c < COUNT; c++) {                                                          \
            re[c] = RE(row + c * PAIR);                                                            \
            im[c] = IM(row + c * PAIR);                                                            \
        }                                                                                          \
        for (int k = 0; k < i; k++, left += left_stride, right += stride) {                        \
            const lanes l_re = RE(left), l_im = IM(left);                                          \
            for (int c = 0; c < COUNT; c++)                                                        \
                MINUS_PRODUCT(re[c], im[c], l_re, l_im, RE(right + c * PAIR),                      \
                              IM(right + c * PAIR));                                               \
        }                                                                                          \
        for (int c = 0; c < COUNT; c++) {                                                          \
            LANES_AT(row + c * PAIR) = re[c];                                                      \
            LANES_AT(row + c * PAIR + BD_WIDTH) = im[c];                                           \
        }                                                                                          \
    }

DEFINE_TILE(tile_whole, TILE)
DEFINE_TILE(tile_three, 3)
DEFINE_TILE(tile_two, 2)
DEFINE_TILE(tile_one, 1)

/* row[from ... to) -= sum over the i rows above it */
BD_INLINE void eliminate(int i, int from, int to, const double *left, const double *right,
                         size_t stride, double *row)
{
    int j = from;
    for (; j + TILE <= to; j += TILE)
        tile_whole(i, left, stride, right + (size_t)j * PAIR, stride, row + (size_t)j * PAIR);
    right += (size_t)j * PAIR;
    row += (size_t)j * PAIR;
    if (to - j == 3)
        tile_three(i, left, stride, right, stride, row);
    else if (to - j == 2)
        tile_two(i, left, stride, right, stride, row);
    else if (to - j == 1)
        tile_one(i, left, stride, right, stride, row);
}

void BD_NAMED(bd_receptance_solve)(const bd_receptance *block, const double *omega,
                                   const double *moduli, double *memory, double *response,
                                   double *growth)
{
    const int n = block->n, n_left = block->n_left, beside = block->n_beside;
    const int right = n + block->first_right, end = n + beside;
    const size_t entries = 3 + (size_t)block->n_layers;
    /* rows of U with Q behind them, and columns of L with P behind them, each as a row */
    const size_t stride = (size_t)end * PAIR;
    double *U = memory, *L = memory + (size_t)n * stride;
    const pencil at = {LANES(omega), LANES(omega) * LANES(omega)};
    lanes grown = {0};

    for (int i = 0; i < n; i++) {
        double *u = U + (size_t)i * stride, *l = L + (size_t)i * stride;
        for (int j = i; j < n; j++) { /* nothing to the left of the diagonal is kept */
            lanes re, im;
            entry(block, &at, moduli, block->pencil + ((size_t)i * (size_t)n + (size_t)j) * entries,
                  &re, &im);
            LANES_AT(u + j * PAIR) = re;
            LANES_AT(u + j * PAIR + BD_WIDTH) = im;
        }
        const double *columns = block->beside + (size_t)i * (size_t)beside;
        for (int c = 0; c < beside; c++) {
            LANES_AT(u + (n + c) * PAIR) = columns[c] + (lanes){0};
            LANES_AT(u + (n + c) * PAIR + BD_WIDTH) = (lanes){0};
        }

        /* what the diagonal is formed from, squared, against what is taken from it */
        const double *own = block->pencil + (size_t)i * (size_t)(n + 1) * entries;
        lanes scale = __builtin_fabs(own[0]) + at.square * __builtin_fabs(own[1]) +
                      at.omega * __builtin_fabs(own[2]);
        for (int m = 0; m < block->n_layers; m++) {
            const lanes modulus = LANES(moduli + m * PAIR),
                        loss = LANES(moduli + m * PAIR + BD_WIDTH);
            lanes size = modulus * modulus + loss * loss;
            lanes_sqrt(&size, &size);
            scale += size * own[3 + m];
        }
        lanes taken = {0};
        for (int k = 0; k < i; k++) {
            const double *a = L + (size_t)k * stride + (size_t)i * PAIR;
            const double *b = U + (size_t)k * stride + (size_t)i * PAIR;
            taken += (RE(a) * RE(a) + IM(a) * IM(a)) * (RE(b) * RE(b) + IM(b) * IM(b));
        }
        grown += taken / (scale * scale);

        if (block->symmetric) {
            eliminate(i, i, end, L + (size_t)i * PAIR, U, stride, u);
        } else {
            /* U and Q by the rows of L; then the column of L and P by those of U */
            eliminate(i, i, n, L + (size_t)i * PAIR, U, stride, u);
            eliminate(i, right, end, L + (size_t)i * PAIR, U, stride, u);
            for (int j = i + 1; j < n; j++) {
                lanes re, im;
                entry(block, &at, moduli,
                      block->pencil + ((size_t)j * (size_t)n + (size_t)i) * entries, &re, &im);
                LANES_AT(l + j * PAIR) = re;
                LANES_AT(l + j * PAIR + BD_WIDTH) = im;
            }
            for (int c = 0; c < n_left; c++) {
                LANES_AT(l + (n + c) * PAIR) = columns[c] + (lanes){0};
                LANES_AT(l + (n + c) * PAIR + BD_WIDTH) = (lanes){0};
            }
            eliminate(i, i + 1, n + n_left, U + (size_t)i * PAIR, L, stride, l);
        }

        /* over the pivot */
        const lanes p_re = RE(u + i * PAIR), p_im = IM(u + i * PAIR);
        const lanes over = 1.0 / (p_re * p_re + p_im * p_im);
        const lanes i_re = p_re * over, i_im = -p_im * over;
        const double *from = block->symmetric ? u : l;
        for (int j = i + 1; j < n + n_left; j++) {
            const lanes re = RE(from + j * PAIR), im = IM(from + j * PAIR);
            LANES_AT(l + j * PAIR) = re * i_re - im * i_im;
            LANES_AT(l + j * PAIR + BD_WIDTH) = re * i_im + im * i_re;
        }
    }

    /* minus the corner that is left of [D Q; P 0]; among columns that are both P and Q it is symmetric with D */
    const int seen = end - right, both = block->symmetric ? block->first_right : n_left;
    for (int p = 0; p < n_left; p++) {
        double *row = response + (size_t)(p * seen) * PAIR;
        const int from = p > both ? p - both : 0;
        for (int q = 0; q < from; q++) {
            const double *mirror = response + (size_t)((both + q) * seen + from) * PAIR;
            LANES_AT(row + q * PAIR) = LANES(mirror);
            LANES_AT(row + q * PAIR + BD_WIDTH) = LANES(mirror + BD_WIDTH);
        }
        for (int i = 2 * from; i < 2 * seen; i++)
            LANES_AT(row + i * BD_WIDTH) = (lanes){0};
        eliminate(n, from, seen, L + (size_t)(n + p) * PAIR, U + (size_t)right * PAIR, stride, row);
        for (int i = 2 * from; i < 2 * seen; i++)
            LANES_AT(row + i * BD_WIDTH) = -LANES(row + i * BD_WIDTH);
    }
    LANES_AT(growth) = grown;
}
