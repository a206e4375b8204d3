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
    PAIR = 2 * BD_WIDTH,               /* doubles of a complex number of lanes */
    TILE = 4,                          /* columns at a time */
    PAIR_TILE = BD_WIDTH == 8 ? 4 : 2, /* of two rows: as many as the registers hold */
};

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

/* COUNT numbers of each of ROWS rows one below the other (`apart`), row[j] -= sum_(k < i) left[k] right[k][j]; `left`
 * has the rows' factors side by side, `right` goes down a column. Two rows take what is loaded twice as far. */
#define DEFINE_TILE(NAME, ROWS, COUNT)                                                             \
    BD_INLINE void NAME(int i, const double *restrict left, const double *restrict right,          \
                        size_t stride, double *restrict row, size_t apart)                         \
    {                                                                                              \
        lanes re[ROWS][COUNT], im[ROWS][COUNT];                                                    \
        for (int r = 0; r < (ROWS); r++)                                                           \
            for (int c = 0; c < (COUNT); c++) {                                                    \
                re[r][c] = RE(row + (size_t)r * apart + c * PAIR);                                 \
                im[r][c] = IM(row + (size_t)r * apart + c * PAIR);                                 \
            }                                                                                      \
        for (int k = 0; k < i; k++, left += stride, right += stride)                               \
            for (int r = 0; r < (ROWS); r++) {                                                     \
                const lanes l_re = RE(left + r * PAIR), l_im = IM(left + r * PAIR);                \
                for (int c = 0; c < (COUNT); c++)                                                  \
                    MINUS_PRODUCT(re[r][c], im[r][c], l_re, l_im, RE(right + c * PAIR),            \
                                  IM(right + c * PAIR));                                           \
            }                                                                                      \
        for (int r = 0; r < (ROWS); r++)                                                           \
            for (int c = 0; c < (COUNT); c++) {                                                    \
                LANES_AT(row + (size_t)r * apart + c * PAIR) = re[r][c];                           \
                LANES_AT(row + (size_t)r * apart + c * PAIR + BD_WIDTH) = im[r][c];                \
            }                                                                                      \
    }

DEFINE_TILE(tile_whole, 1, TILE)
DEFINE_TILE(tile_three, 1, 3)
DEFINE_TILE(tile_two, 1, 2)
DEFINE_TILE(tile_one, 1, 1)
DEFINE_TILE(pair_tile, 2, PAIR_TILE)
DEFINE_TILE(pair_tile_one, 2, 1)

/* row[from ... to) -= sum over the i rows above it */
BD_INLINE void eliminate(int i, int from, int to, const double *left, const double *right,
                         size_t stride, double *row)
{
    int j = from;
    for (; j + TILE <= to; j += TILE)
        tile_whole(i, left, right + (size_t)j * PAIR, stride, row + (size_t)j * PAIR, 0);
    right += (size_t)j * PAIR;
    row += (size_t)j * PAIR;
    if (to - j == 3)
        tile_three(i, left, right, stride, row, 0);
    else if (to - j == 2)
        tile_two(i, left, right, stride, row, 0);
    else if (to - j == 1)
        tile_one(i, left, right, stride, row, 0);
}

/* The same of two rows, `apart` from each other. */
BD_INLINE void eliminate_pair(int i, int from, int to, const double *left, const double *right,
                              size_t stride, double *row, size_t apart)
{
    int j = from;
    for (; j + PAIR_TILE <= to; j += PAIR_TILE)
        pair_tile(i, left, right + (size_t)j * PAIR, stride, row + (size_t)j * PAIR, apart);
    for (; j < to; j++)
        pair_tile_one(i, left, right + (size_t)j * PAIR, stride, row + (size_t)j * PAIR, apart);
}

/* What the elimination of a block at the lanes' frequencies works on. Rows of U have Q behind them; columns of L, kept
 * as rows too, have P. */
typedef struct elimination {
    const bd_receptance *block;
    pencil at;
    const double *moduli;
    double *U, *L;
    size_t stride; /* of a row */
} elimination;

/* Entries from column `from` on of a block's row i, or of its column i (`down`), and the first `beside` of the columns
 * beside it: as they are before anything is taken from them. */
BD_INLINE void form_row(const elimination *e, int i, bool down, int from, int beside, double *row)
{
    const bd_receptance *block = e->block;
    const int n = block->n;
    const size_t entries = 3 + (size_t)block->n_layers;
    const double *columns = block->beside + (size_t)i * (size_t)block->n_beside;
    for (int j = from; j < n; j++) {
        const size_t at =
            down ? (size_t)j * (size_t)n + (size_t)i : (size_t)i * (size_t)n + (size_t)j;
        lanes re, im;
        entry(block, &e->at, e->moduli, block->pencil + at * entries, &re, &im);
        LANES_AT(row + j * PAIR) = re;
        LANES_AT(row + j * PAIR + BD_WIDTH) = im;
    }
    for (int c = 0; c < beside; c++) {
        LANES_AT(row + (n + c) * PAIR) = columns[c] + (lanes){0};
        LANES_AT(row + (n + c) * PAIR + BD_WIDTH) = (lanes){0};
    }
}

/* Row i of U and, unless it is that of U over the pivot, column i of L. */
BD_INLINE void form(const elimination *e, int i)
{
    const bd_receptance *block = e->block;
    const size_t row = (size_t)i * e->stride;
    form_row(e, i, false, i, block->n_beside,
             e->U + row); /* nothing left of the diagonal is kept */
    if (!block->symmetric)
        form_row(e, i, true, i + 1, block->n_left, e->L + row);
}

/* Rows i and, where `pair`, i + 1 minus what the `count` rows from k on take from them. */
BD_INLINE void take(const elimination *e, int i, bool pair, int k, int count)
{
    const bd_receptance *block = e->block;
    const int n = block->n, right = n + block->first_right, end = n + block->n_beside;
    const int left = n + block->n_left;
    const size_t stride = e->stride, row = (size_t)i * stride, above = (size_t)k * stride;
    const size_t own = above + (size_t)i * PAIR;
    double *u = e->U + row, *l = e->L + row;
    const double *U = e->U + above, *L = e->L + above;
    const int seen[2][2] = {{i, block->symmetric ? end : n},
                            {right, block->symmetric ? right : end}};

    for (int part = 0; part < 2; part++) {
        int from = seen[part][0];
        const int to = seen[part][1];
        if (!pair) {
            eliminate(count, from, to, e->L + own, U, stride, u);
            continue;
        }
        if (part == 0) { /* the second has nothing in the column of the first's pivot */
            tile_one(count, e->L + own, U + (size_t)from * PAIR, stride, u + (size_t)from * PAIR,
                     0);
            from++;
        }
        eliminate_pair(count, from, to, e->L + own, U, stride, u, stride);
    }
    if (block->symmetric)
        return;
    if (!pair) {
        eliminate(count, i + 1, left, e->U + own, L, stride, l);
        return;
    }
    tile_one(count, e->U + own, L + (size_t)(i + 1) * PAIR, stride, l + (size_t)(i + 1) * PAIR, 0);
    eliminate_pair(count, i + 2, left, e->U + own, L, stride, l, stride);
}

/* Column i of L over the pivot. Returned in `grown`, added: what was taken from the diagonal, squared, over what it
 * was formed from. */
BD_INLINE void finish(const elimination *e, int i, lanes *grown)
{
    const bd_receptance *block = e->block;
    const int n = block->n;
    const size_t row = (size_t)i * e->stride;
    const double *own = block->pencil + (size_t)i * (size_t)(n + 1) * (3 + (size_t)block->n_layers);
    lanes scale = __builtin_fabs(own[0]) + e->at.square * __builtin_fabs(own[1]) +
                  e->at.omega * __builtin_fabs(own[2]);
    for (int m = 0; m < block->n_layers; m++) {
        const lanes modulus = LANES(e->moduli + m * PAIR),
                    loss = LANES(e->moduli + m * PAIR + BD_WIDTH);
        lanes size = modulus * modulus + loss * loss;
        lanes_sqrt(&size, &size);
        scale += size * own[3 + m];
    }
    lanes taken = {0};
    for (int k = 0; k < i; k++) {
        const double *a = e->L + (size_t)k * e->stride + (size_t)i * PAIR;
        const double *b = e->U + (size_t)k * e->stride + (size_t)i * PAIR;
        taken += (RE(a) * RE(a) + IM(a) * IM(a)) * (RE(b) * RE(b) + IM(b) * IM(b));
    }
    *grown += taken / (scale * scale);

    const double *u = e->U + row;
    double *l = e->L + row;
    const lanes p_re = RE(u + i * PAIR), p_im = IM(u + i * PAIR);
    const lanes over = 1.0 / (p_re * p_re + p_im * p_im);
    const lanes i_re = p_re * over, i_im = -p_im * over;
    const double *from = block->symmetric ? u : l;
    for (int j = i + 1; j < n + block->n_left; j++) {
        const lanes re = RE(from + j * PAIR), im = IM(from + j * PAIR);
        LANES_AT(l + j * PAIR) = re * i_re - im * i_im;
        LANES_AT(l + j * PAIR + BD_WIDTH) = re * i_im + im * i_re;
    }
}

void BD_NAMED(bd_receptance_solve)(const bd_receptance *block, const double *omega,
                                   const double *moduli, double *memory, double *response,
                                   double *growth)
{
    const int n = block->n, n_left = block->n_left, end = n + block->n_beside;
    const int right = n + block->first_right;
    const size_t stride = (size_t)end * PAIR;
    double *U = memory, *L = memory + (size_t)n * stride;
    const elimination e = {block, {LANES(omega), LANES(omega) * LANES(omega)}, moduli, U, L,
                           stride};
    lanes grown = {0};

    for (int i = 0; i < n; i += 2) {
        const bool pair = i + 1 < n;
        form(&e, i);
        if (pair)
            form(&e, i + 1);
        take(&e, i, pair, 0, i);
        finish(&e, i, &grown);
        if (pair) {
            take(&e, i + 1, false, i, 1);
            finish(&e, i + 1, &grown);
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
