/* The linear algebra of one step of marches abreast: step.c's sums in step.c's order, a case per lane. */
#include "abreast.h"
#include "kernels.h"
#include "lanes.h"

/* Registers that hold one number of all cases; rows of a tile, so that it has eight sums in every set. */
enum { SETS = BD_ABREAST / BD_WIDTH, ROWS = BD_WIDTH / 2 };

#define WIDE(p, i) ((p) + (size_t)BD_ABREAST * (size_t)(i))
#define SET(p, i, s) (WIDE(p, i) + (s) * BD_WIDTH)

/* y += A u for some rows, as dense.h's tiles: even columns, odd columns, then both. */
#define DEFINE_TILE(NAME, COUNT)                                                                   \
    BD_INLINE void NAME(int n_columns, const double *restrict A, int stride,                       \
                        const double *restrict u, double *restrict y)                              \
    {                                                                                              \
        lanes even[COUNT][SETS] = {{{0}}}, odd[COUNT][SETS] = {{{0}}};                             \
        int c = 0;                                                                                 \
        for (; c + 1 < n_columns; c += 2) {                                                        \
            const double *a0 = A + (size_t)c * (size_t)stride, *a1 = a0 + stride;                  \
            for (int s = 0; s < SETS; s++) {                                                       \
                const lanes u0 = LANES(SET(u, c, s)), u1 = LANES(SET(u, c + 1, s));                \
                for (int r = 0; r < COUNT; r++) {                                                  \
                    even[r][s] += a0[r] * u0;                                                      \
                    odd[r][s] += a1[r] * u1;                                                       \
                }                                                                                  \
            }                                                                                      \
        }                                                                                          \
        if (c < n_columns)                                                                         \
            for (int s = 0; s < SETS; s++)                                                         \
                for (int r = 0; r < COUNT; r++)                                                    \
                    even[r][s] += A[(size_t)c * (size_t)stride + (size_t)r] * LANES(SET(u, c, s)); \
        for (int r = 0; r < COUNT; r++)                                                            \
            for (int s = 0; s < SETS; s++)                                                         \
                LANES_AT(SET(y, r, s)) += even[r][s] + odd[r][s];                                  \
    }

DEFINE_TILE(tile, ROWS)
DEFINE_TILE(tile_3, 3)
DEFINE_TILE(tile_2, 2)
DEFINE_TILE(tile_1, 1)

/* y += A u */
BD_INLINE void columns_add_wide(int rows, int n_columns, const double *A, int stride,
                                const double *u, double *y)
{
    int r = 0;
    for (; r + ROWS <= rows; r += ROWS)
        tile(n_columns, A + r, stride, u, WIDE(y, r));
    /* what is left together: a row by itself waits for its own sums */
    if (rows - r == 3)
        tile_3(n_columns, A + r, stride, u, WIDE(y, r));
    else if (rows - r == 2)
        tile_2(n_columns, A + r, stride, u, WIDE(y, r));
    else if (rows - r == 1)
        tile_1(n_columns, A + r, stride, u, WIDE(y, r));
}

#undef DEFINE_TILE

/* The same for one row whose numbers are each case's own. */
BD_INLINE void own_row_add(int n_columns, const double *restrict A, const double *restrict u,
                           double *restrict y)
{
    lanes sums[2][SETS] = {{{0}}};
    int c = 0;
    for (; c + 1 < n_columns; c += 2)
        for (int s = 0; s < SETS; s++) {
            sums[0][s] += LANES(SET(A, c, s)) * LANES(SET(u, c, s));
            sums[1][s] += LANES(SET(A, c + 1, s)) * LANES(SET(u, c + 1, s));
        }
    for (int s = 0; s < SETS && c < n_columns; s++)
        sums[0][s] += LANES(SET(A, c, s)) * LANES(SET(u, c, s));
    for (int s = 0; s < SETS; s++)
        LANES_AT(SET(y, 0, s)) += sums[0][s] + sums[1][s];
}

/* One column of `count` rows for mixed_rows_add. */
BD_INLINE void mixed_column(int count, const double *restrict A, const double *restrict own_A,
                            bool own, const double *restrict u, lanes sum[ROWS][SETS])
{
    for (int s = 0; s < SETS; s++) {
        const lanes each = LANES(SET(u, 0, s));
        for (int r = 0; r < count; r++)
            sum[r][s] += own ? LANES(SET(own_A, r, s)) * each : A[r] * each;
    }
}

BD_INLINE void mixed_rows_add(int count, int n_columns, const double *restrict A,
                              const double *restrict own_A, int stride, const bool *own,
                              const double *restrict u, double *restrict y)
{
    lanes even[ROWS][SETS] = {{{0}}}, odd[ROWS][SETS] = {{{0}}};
    for (int c = 0; c < n_columns; c += 2) {
        mixed_column(count, A + c * stride, WIDE(own_A, c * stride), own[c], WIDE(u, c), even);
        if (c + 1 < n_columns)
            mixed_column(count, A + (c + 1) * stride, WIDE(own_A, (c + 1) * stride), own[c + 1],
                         WIDE(u, c + 1), odd);
    }
    for (int r = 0; r < count; r++)
        for (int s = 0; s < SETS; s++)
            LANES_AT(SET(y, r, s)) += even[r][s] + odd[r][s];
}

/* The same for columns of which some are each case's own. */
BD_INLINE void mixed_columns_add(int rows, int n_columns, const double *restrict A,
                                 const double *restrict own_A, int stride, const bool *own,
                                 const double *restrict u, double *restrict y)
{
    int r = 0;
    for (; r + ROWS <= rows; r += ROWS)
        mixed_rows_add(ROWS, n_columns, A + r, WIDE(own_A, r), stride, own, u, WIDE(y, r));
    for (; r < rows; r++)
        mixed_rows_add(1, n_columns, A + r, WIDE(own_A, r), stride, own, u, WIDE(y, r));
}

/* Bearing coefficients of the motion of n_from coordinates: rows of B, alike in all cases or not. */
BD_INLINE void coefficients_add(const bd_abreast *of, int from, int n_from, int at, int n,
                                const double *u, double *z)
{
    const bd_model *model = of->model;
    const double *B = model->B + (size_t)from * (size_t)model->coefs + at;
    const bool *own = of->own + at;
    int k = 0;
    while (k < n) {
        int alike = 0;
        while (k + alike < n && !own[k + alike])
            alike++;
        columns_add_wide(alike, n_from, B + k, model->coefs, u, WIDE(z, k));
        for (k += alike; k < n && own[k]; k++)
            own_row_add(n_from, WIDE(of->B, (at + k) * model->n_padded + from), u, WIDE(z, k));
    }
}

BD_INLINE void clear(int n, double *y)
{
    for (int i = 0; i < n * BD_ABREAST; i += BD_WIDTH)
        LANES_AT(y + i) = (lanes){0};
}

/* a += A u of one block, band by band. */
BD_INLINE void square_add(const bd_model *model, const bd_block *block, const double *A,
                          const double *u, double *a)
{
    for (int i = block->band; i < block->band + block->n_bands; i++) {
        const bd_span *band = &model->bands[i];
        columns_add_wide(band->n, band->n,
                         A + (size_t)band->first * (size_t)block->padded + band->first,
                         block->padded, WIDE(u, band->first), WIDE(a, band->first));
    }
}

/* a += A u, where A has a column for each rate of a layer. */
BD_INLINE void layer_add(const bd_model *model, const bd_block *block, const bd_layer *layer,
                         const double *A, const double *u, double *a)
{
    for (int i = 0; i < block->n_bands; i++) {
        const bd_span *band = &model->bands[block->band + i], *felt = &layer->felt[i];
        columns_add_wide(band->n, felt->n,
                         A + (size_t)felt->first * (size_t)block->padded + band->first,
                         block->padded, WIDE(u, felt->first), WIDE(a, band->first));
    }
}

/* Stresses that branches would carry without the new rate, and their sum. */
BD_INLINE void remember(const bd_abreast *of, const bd_layer *layer,
                        const bd_branch_weights *weights)
{
    double *history = WIDE(of->history, layer->offset);
    const double *rate = WIDE(of->y_rate, layer->offset);
    for (int i = 0; i < layer->n_stresses; i++) {
        const size_t at = layer->stress + (size_t)i * (size_t)layer->padded;
        const double *stress = WIDE(of->stress, at), decay = weights[i].decay, old = weights[i].old;
        double *trial = WIDE(of->trial, at);
        for (int k = 0; k < layer->rank * BD_ABREAST; k += BD_WIDTH) {
            lanes value = decay * LANES(stress + k) + old * LANES(rate + k);
            LANES_AT(trial + k) = value;
            LANES_AT(history + k) += value;
        }
    }
}

/* Columns of the loads; a load with one column is summed as one with two, of which the second adds nothing. */
BD_INLINE void push(const bd_abreast *of)
{
    const int n = of->model->n_padded * BD_ABREAST, n_loads = of->model->n_loads;
    double *a = of->a_new;
    for (int k = 0; k < n_loads; k++) {
        const double *SP = WIDE(of->SP, 2 * k * of->model->n_padded), *sine = SP + n;
        const double *factor = WIDE(of->factor, 2 * k);
        const lanes none = {0};
        for (int s = 0; s < BD_ABREAST; s += BD_WIDTH) {
            const lanes f0 = LANES(factor + s), f1 = LANES(factor + BD_ABREAST + s);
            if (of->swings[k])
                for (int i = s; i < n; i += BD_ABREAST)
                    LANES_AT(a + i) += (none + LANES(SP + i) * f0) + (none + LANES(sine + i) * f1);
            else
                for (int i = s; i < n; i += BD_ABREAST)
                    LANES_AT(a + i) += (none + LANES(SP + i) * f0) + none;
        }
    }
}

/* Bearing coefficients and rates that the structure would have without the bearings. */
BD_INLINE void observe(const bd_abreast *of)
{
    const bd_model *model = of->model;
    clear(model->coefs, of->z);
    clear(model->coefs, of->z_rate);
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_sight *end = model->sights + model->sight[b + 1];
        for (const bd_sight *sight = model->sights + model->sight[b]; sight < end; sight++) {
            const bd_span from = sight->coordinates, to = sight->coefficients;
            coefficients_add(of, from.first, from.n, to.first, to.n, WIDE(of->x_new, from.first),
                             WIDE(of->z, to.first));
            coefficients_add(of, from.first, from.n, to.first, to.n, WIDE(of->v_new, from.first),
                             WIDE(of->z_rate, to.first));
        }
    }
}

/* predict and observe of step.c. */
void BD_NAMED(bd_abreast_predict)(bd_abreast *of)
{
    const bd_model *model = of->model;
    const bd_work *work = of->work;
    const double dt = work->scheme.dt, ahead_x = (0.5 - work->scheme.beta) * dt * dt;
    const double ahead_v = (1.0 - work->scheme.gamma) * dt, in_x = work->in_x, in_v = work->in_v;
    const bd_branch_weights *weights = work->weights;

    clear(model->ranks, of->history);
    for (int b = 0; b < model->n_blocks; b++) {
        const bd_block *block = &model->blocks[b];
        const double *columns = work->step + work->step_at[b];
        const size_t square = (size_t)block->padded * (size_t)block->n;
        const size_t first = (size_t)block->offset * BD_ABREAST;
        const double *x = of->x + first, *v = of->v + first, *a = of->a + first;
        double *x_ahead = of->x_ahead + first, *v_ahead = of->v_ahead + first;
        double *a_new = of->a_new + first, *v_new = of->v_new + first;

        for (int i = 0; i < block->n * BD_ABREAST; i += BD_WIDTH) {
            lanes rate = LANES(v + i), more = LANES(a + i);
            LANES_AT(x_ahead + i) = LANES(x + i) + dt * rate + ahead_x * more;
            LANES_AT(v_ahead + i) = rate + ahead_v * more;
        }
        if (work->diagonal[b]) {
            for (int i = 0; i < block->n; i++)
                for (int s = 0; s < SETS; s++) {
                    lanes undamped = columns[i] * LANES(SET(x_ahead, i, s));
                    LANES_AT(SET(a_new, i, s)) = undamped;
                    LANES_AT(SET(v_new, i, s)) = LANES(SET(v_ahead, i, s)) + in_v * undamped;
                }
            square_add(model, block, columns + square, v_new, a_new);
        } else {
            clear(block->n, a_new);
            square_add(model, block, columns, x_ahead, a_new);
            square_add(model, block, columns + square, v_ahead, a_new);
        }
        columns += 2 * square;
        for (int l = block->layer; l < block->layer + block->n_layers; l++) {
            const bd_layer *layer = &model->layers[l];
            remember(of, layer, weights);
            weights += layer->n_stresses;
            layer_add(model, block, layer, columns, WIDE(of->history, layer->offset), a_new);
            columns += (size_t)layer->rank * (size_t)block->padded;
        }
    }
    push(of);
    /* Newton starts from the parabola through the last three forces */
    for (int k = 0; k < model->coefs * BD_ABREAST; k += BD_WIDTH)
        LANES_AT(of->guess + k) =
            3.0 * (LANES(of->g[0] + k) - LANES(of->g[1] + k)) + LANES(of->g[2] + k);
    const double *a_new = of->a_new, *x_ahead = of->x_ahead, *v_ahead = of->v_ahead;
    double *x_new = of->x_new, *v_new = of->v_new;
    const int n = model->n_padded * BD_ABREAST;
    for (int i = 0; i < n; i += BD_WIDTH) {
        lanes a = LANES(a_new + i);
        LANES_AT(x_new + i) = LANES(x_ahead + i) + in_x * a;
        LANES_AT(v_new + i) = LANES(v_ahead + i) + in_v * a;
    }
    observe(of);
}

/* The first half of step.c's commit: what becomes of all with the bearing forces found.
 * Returned: a bit for each case whose motion or stresses would not be finite */
unsigned BD_NAMED(bd_abreast_complete)(bd_abreast *of)
{
    const bd_model *model = of->model;
    const bd_work *work = of->work;
    const double in_x = work->in_x, in_v = work->in_v;

    for (int k = 0; k < model->coefs * BD_ABREAST; k += BD_WIDTH)
        LANES_AT(of->minus_g + k) = -LANES(of->guess + k);
    for (int b = 0; b < model->n_bearings; b++) {
        const int slot = model->bearing_slot[b], n_coefs = model->bearings[b].data.n_coefs;
        const bd_sight *end = model->sights + model->sight[b + 1];
        bool any_own = false;
        for (int k = 0; k < n_coefs; k++)
            any_own = any_own || of->own[slot + k];
        for (const bd_sight *sight = model->sights + model->sight[b]; sight < end; sight++) {
            const int at = sight->coefficients.first, n_seen = sight->coefficients.n;
            const int to = sight->coordinates.first, n = sight->coordinates.n;
            const double *columns = work->SB + (size_t)at * (size_t)model->n_padded + (size_t)to;
            const double *minus_g = WIDE(of->minus_g, at);
            double *a = WIDE(of->a_new, to);
            if (any_own)
                mixed_columns_add(n, n_seen, columns, WIDE(of->SB, at * model->n_padded + to),
                                  model->n_padded, of->own + at, minus_g, a);
            else
                columns_add_wide(n, n_seen, columns, model->n_padded, minus_g, a);
        }
    }
    lanes poison[SETS] = {{0}};
    const double *a_new = of->a_new, *x_ahead = of->x_ahead, *v_ahead = of->v_ahead;
    double *x_new = of->x_new, *v_new = of->v_new;
    const int n = model->n_padded;
    for (int i = 0; i < n; i++)
        for (int s = 0; s < SETS; s++) {
            lanes a = LANES(SET(a_new, i, s));
            lanes x = LANES(SET(x_ahead, i, s)) + in_x * a;
            lanes v = LANES(SET(v_ahead, i, s)) + in_v * a;
            LANES_AT(SET(x_new, i, s)) = x;
            LANES_AT(SET(v_new, i, s)) = v;
            poison[s] += 0.0 * x + 0.0 * v;
        }
    const bd_branch_weights *weights = work->weights;
    clear(model->ranks, of->rate_new);
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        const bd_block *block = &model->blocks[layer->block];
        const double *history = WIDE(of->history, layer->offset);
        double *rate = WIDE(of->rate_new, layer->offset), now = 0.0;
        for (int i = 0; i < block->n_bands; i++) {
            const bd_span *band = &model->bands[block->band + i], *felt = &layer->felt[i];
            columns_add_wide(felt->n, band->n,
                             layer->L + (size_t)band->first * (size_t)layer->padded + felt->first,
                             layer->padded, WIDE(of->v_new, block->offset + band->first),
                             WIDE(rate, felt->first));
        }
        for (int i = 0; i < layer->n_stresses; i++)
            now += weights++->now;
        for (int r = 0; r < layer->rank; r++)
            for (int s = 0; s < SETS; s++)
                poison[s] += 0.0 * (LANES(SET(history, r, s)) + now * LANES(SET(rate, r, s)));
    }
    unsigned lost = 0;
    for (int s = 0; s < SETS; s++)
        for (int i = 0; i < BD_WIDTH; i++)
            lost |= (unsigned)!(poison[s][i] == 0.0) << (s * BD_WIDTH + i);
    return lost;
}

/* The second half: the trial states become the states. */
void BD_NAMED(bd_abreast_commit)(bd_abreast *of)
{
    const bd_model *model = of->model;
    const bd_branch_weights *weights = of->work->weights;
    double *now[] = {of->x, of->v, of->a, of->y_rate};
    double *next[] = {of->x_new, of->v_new, of->a_new, of->rate_new};

    double *oldest = of->g[2];

    of->g[2] = of->g[1], of->g[1] = of->g[0], of->g[0] = of->guess, of->guess = oldest;
    of->x = next[0], of->v = next[1], of->a = next[2], of->y_rate = next[3];
    of->x_new = now[0], of->v_new = now[1], of->a_new = now[2], of->rate_new = now[3];
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        const double *rate = WIDE(of->y_rate, layer->offset);
        for (int i = 0; i < layer->n_stresses; i++) {
            const size_t at = layer->stress + (size_t)i * (size_t)layer->padded;
            const double *trial = WIDE(of->trial, at), weight = weights++->now;
            double *stress = WIDE(of->stress, at);
            for (int k = 0; k < layer->rank * BD_ABREAST; k += BD_WIDTH)
                LANES_AT(stress + k) = LANES(trial + k) + weight * LANES(rate + k);
        }
    }
}
