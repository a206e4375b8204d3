/* The linear algebra of one step; the order of the calls is in newmark.c. */
#include "abreast.h"
#include "balls.h"
#include "changed_layers.h"
#include "dense.h"
#include "exact.h"
#include "join.h"
#include "maxwell.h"
#include "receptance.h"
#include "work.h"

/* y += A u at a band's own rows. Apart, so that the loops of a step hold what nearly every block is: one band. */
static __attribute__((noinline)) void masked_add(int rows, int n_columns, const double *A,
                                                 int stride, const double *u,
                                                 const long long *inside, double *y)
{
    columns_add_inside(rows, n_columns, A, stride, u, inside, y);
}

/* a += A u of one block, whose bands do not couple; A in columns of the block's padding. */
BD_INLINE void square_add(const bd_model *model, const bd_block *block, const double *A,
                          const double *u, double *a)
{
    if (block->n_bands == 1) {
        columns_add(block->padded, block->n, A, block->padded, u, a);
        return;
    }
    for (int i = block->band; i < block->band + block->n_bands; i++) {
        const bd_span *band = &model->bands[i];
        masked_add(band->rows, band->n, A + (size_t)band->first * (size_t)block->padded + band->row,
                   block->padded, u + band->first, model->inside[i], a + band->row);
    }
}

/* a += A u, where A has a column for each rate of a layer. */
BD_INLINE void layer_add(const bd_model *model, const bd_block *block, const bd_layer *layer,
                         const double *A, const double *u, double *a)
{
    const bd_span *felt = layer->felt;
    if (block->n_bands == 1) {
        columns_add(block->padded, felt->n, A + (size_t)felt->first * (size_t)block->padded,
                    block->padded, u + felt->first, a);
        return;
    }
    for (int i = block->band; i < block->band + block->n_bands; i++, felt++) {
        const bd_span *band = &model->bands[i];
        masked_add(band->rows, felt->n, A + (size_t)felt->first * (size_t)block->padded + band->row,
                   block->padded, u + felt->first, model->inside[i], a + band->row);
    }
}

/* Predictors, trial branch stresses and the acceleration without the bearings. */
static void predict(const bd_model *model, bd_work *work, const bd_state *state)
{
    const bd_scheme *scheme = &work->scheme;
    const double dt = scheme->dt, in_x = (0.5 - scheme->beta) * dt * dt;
    const double in_v = (1.0 - scheme->gamma) * dt, in_v_new = work->in_v;

    for (int i = 0; i < model->n_padded; i += BD_WIDTH) {
        lanes a = LANES(state->a + i), v = LANES(state->v + i);
        LANES_AT(work->x + i) = LANES(state->x + i) + dt * v + in_x * a;
        LANES_AT(work->v + i) = v + in_v * a;
    }
    for (int i = 0; i < model->ranks; i += BD_WIDTH)
        LANES_AT(work->history + i) = (lanes){0};

    const bd_branch_weights *weights = work->weights;
    for (int b = 0; b < model->n_blocks; b++) {
        const bd_block *block = &model->blocks[b];
        const double *columns = work->step + work->step_at[b];
        double *a = work->a + block->offset;
        const size_t square = (size_t)block->padded * (size_t)block->n;

        if (work->diagonal[b]) {
            /* a0 without damping, (M + beta dt^2 K') a0 = -K' x, then a = a0 - S^-1 C' (v + gamma dt a0):
             * half the columns, and half the memory, of the two products */
            const double *x = work->x + block->offset, *v = work->v + block->offset;
            double *corrected = work->v_new + block->offset;
            for (int i = 0; i < block->padded; i += BD_WIDTH) {
                lanes undamped = LANES(columns + i) * LANES(x + i);
                LANES_AT(a + i) = undamped;
                LANES_AT(corrected + i) = LANES(v + i) + in_v_new * undamped;
            }
            square_add(model, block, columns + square, corrected, a);
        } else {
            for (int i = 0; i < block->padded; i += BD_WIDTH)
                LANES_AT(a + i) = (lanes){0};
            square_add(model, block, columns, work->x + block->offset, a);
            square_add(model, block, columns + square, work->v + block->offset, a);
        }
        columns += 2 * square;
        for (int l = block->layer; l < block->layer + block->n_layers; l++) {
            const bd_layer *layer = &model->layers[l];
            double *history = work->history + layer->offset;
            for (int i = 0; i < layer->n_stresses; i++) {
                size_t at = layer->stress + (size_t)i * (size_t)layer->padded;
                maxwell_trial(layer->padded, *weights++, state->stress + at,
                              state->y_rate + layer->offset, work->trial + at, history);
            }
            layer_add(model, block, layer, columns, history, a);
            columns += (size_t)layer->rank * (size_t)block->padded;
        }
    }
    for (int k = 0; k < model->n_loads; k++) {
        const bd_load_kind kind = model->loads[k].kind;
        columns_add(model->n_padded, kind == BD_LOAD_HARMONIC || kind == BD_LOAD_ROTATING ? 2 : 1,
                    work->SP + 2 * (size_t)k * (size_t)model->n_padded, model->n_padded,
                    work->load_factor + 2 * k, work->a);
    }
}

/* Bearing coefficients and rates that the structure would have without the bearings. */
static void observe(const bd_model *model, bd_work *work)
{
    const double in_x = work->in_x, in_v = work->in_v;

    for (int i = 0; i < model->n_padded; i += BD_WIDTH) {
        lanes a = LANES(work->a + i);
        LANES_AT(work->x_new + i) = LANES(work->x + i) + in_x * a;
        LANES_AT(work->v_new + i) = LANES(work->v + i) + in_v * a;
    }
    for (int k = 0; k < model->coefs; k += BD_WIDTH)
        LANES_AT(work->z_linear + k) = LANES_AT(work->z_rate_linear + k) = (lanes){0};
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_sight *end = model->sights + model->sight[b + 1];
        for (const bd_sight *sight = model->sights + model->sight[b]; sight < end; sight++) {
            const int from = sight->coordinates.first, to = sight->coefficients.row;
            columns_add_two(sight->coefficients.rows, sight->coordinates.n,
                            model->B + (size_t)from * (size_t)model->coefs + to, model->coefs,
                            work->x_new + from, work->v_new + from, work->z_linear + to,
                            work->z_rate_linear + to);
        }
    }
}

/* a -= S^-1 B^T guess */
BD_INLINE void add_bearings(const bd_model *model, bd_work *work)
{
    for (int k = 0; k < model->coefs; k += BD_WIDTH)
        LANES_AT(work->change + k) = -LANES(work->guess + k);
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_sight *end = model->sights + model->sight[b + 1];
        for (const bd_sight *sight = model->sights + model->sight[b]; sight < end; sight++) {
            const int at = sight->coefficients.first, to = sight->coordinates.row;
            columns_add_inside(sight->coordinates.rows, sight->coefficients.n,
                               work->SB + (size_t)at * (size_t)model->n_padded + to,
                               model->n_padded, work->change + at, model->inside[sight->band],
                               work->a + to);
        }
    }
}

/* What a speed other than the reference adds. */
static double drift(const bd_model *model, bd_work *work, double *largest)
{
    const double in_x = work->in_x, in_v = work->in_v;
    const double departure = work->turn.speed - work->reference, rate = work->turn.rate;
    const double *columns = work->drift;
    double change = 0.0;
    *largest = 0.0;

    /* x and v that go with the present guess of everything */
    for (int i = 0; i < model->n_padded; i += BD_WIDTH)
        LANES_AT(work->a + i) = LANES(work->a_steady + i) + LANES(work->a_drift + i);
    add_bearings(model, work);
    for (int i = 0; i < model->n_padded; i += BD_WIDTH) {
        lanes a = LANES(work->a + i);
        lanes x = LANES(work->x + i) + in_x * a, v = LANES(work->v + i) + in_v * a;
        LANES_AT(work->x_new + i) = -departure * v - rate * x; /* what meets G */
        LANES_AT(work->v_new + i) = -departure * x;            /* what meets N */
        LANES_AT(work->a + i) = (lanes){0};
    }
    for (int b = 0; b < model->n_blocks; b++) {
        const bd_block *block = &model->blocks[b];
        const size_t square = (size_t)block->padded * (size_t)block->n;
        square_add(model, block, columns, work->x_new + block->offset, work->a + block->offset);
        square_add(model, block, columns + square, work->v_new + block->offset,
                   work->a + block->offset);
        columns += 2 * square;
    }
    for (int i = 0; i < model->n_padded; i++) {
        double difference = __builtin_fabs(work->a[i] - work->a_drift[i]);
        change = __builtin_fmax(change, difference); /* a NaN is seen when the step is committed */
        *largest = __builtin_fmax(*largest, __builtin_fabs(work->a[i]));
    }
    for (int i = 0; i < model->n_padded; i += BD_WIDTH) {
        LANES_AT(work->a_drift + i) = LANES(work->a + i);
        LANES_AT(work->a + i) = LANES(work->a_steady + i) + LANES(work->a_drift + i);
    }
    return change;
}

/* z and z_rate that go with the bearing forces guessed. */
static void displace(const bd_model *model, bd_work *work)
{
    const double in_x = work->in_x, in_v = work->in_v;

    for (int k = 0; k < model->coefs; k += BD_WIDTH)
        LANES_AT(work->Wg + k) = (lanes){0};
    for (int b = 0; b < model->n_bearings; b++) {
        const int at = model->bearing_slot[b];
        columns_add(model->coefs, model->bearings[b].data.n_coefs,
                    work->W + (size_t)at * (size_t)model->coefs, model->coefs, work->guess + at,
                    work->Wg);
    }
    for (int k = 0; k < model->coefs; k += BD_WIDTH) {
        lanes Wg = LANES(work->Wg + k);
        LANES_AT(work->z + k) = LANES(work->z_linear + k) - in_x * Wg;
        LANES_AT(work->z_rate + k) = LANES(work->z_rate_linear + k) - in_v * Wg;
    }
    if (!work->exact)
        return;
    for (int k = 0; k < model->coefs; k += BD_WIDTH)
        LANES_AT(work->Wg + k) = (lanes){0};
    for (int b = 0; b < model->n_bearings; b++) {
        const int at = model->bearing_slot[b];
        columns_add(model->coefs, model->bearings[b].data.n_coefs,
                    work->W_rate + (size_t)at * (size_t)model->coefs, model->coefs,
                    work->guess + at, work->Wg);
    }
    for (int k = 0; k < model->coefs; k += BD_WIDTH)
        LANES_AT(work->z_rate + k) = LANES(work->z_rate_linear + k) - LANES(work->Wg + k);
}

/* guess += share * inverse (force - guess); returns through `change` what force and guess differed. */
static void correct(const bd_model *model, bd_work *work, double share, const double *inverse)
{
    for (int k = 0; k < model->coefs; k += BD_WIDTH)
        LANES_AT(work->change + k) = share * (LANES(work->force + k) - LANES(work->guess + k));
    for (int b = 0; b < model->n_bearings; b++) {
        const int at = model->bearing_slot[b];
        columns_add(model->coefs, model->bearings[b].data.n_coefs,
                    inverse + (size_t)at * (size_t)model->coefs, model->coefs, work->change + at,
                    work->guess);
    }
}

/* Completes the acceleration and makes the trial state the state, if that is finite. */
static int commit(const bd_model *model, bd_work *work, bd_state *state)
{
    const double in_x = work->in_x, in_v = work->in_v;

    add_bearings(model, work);

    /* 0 times a number that is not finite is NaN, and so is every sum with it */
    lanes poison = {0};
    for (int i = 0; i < model->n_padded; i += BD_WIDTH) {
        lanes a = LANES(work->a + i);
        lanes x = LANES(work->x + i) + in_x * a, v = LANES(work->v + i) + in_v * a;
        LANES_AT(work->x_new + i) = x;
        LANES_AT(work->v_new + i) = v;
        poison += 0.0 * x + 0.0 * v;
    }

    const bd_branch_weights *weights = work->weights;
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        const bd_block *block = &model->blocks[layer->block];
        double *rate = work->y_rate + layer->offset;
        for (int r = 0; r < layer->padded; r += BD_WIDTH)
            LANES_AT(rate + r) = (lanes){0};
        for (int i = 0; i < block->n_bands; i++) {
            const bd_span *band = &model->bands[block->band + i], *felt = &layer->felt[i];
            if (felt->n > 0)
                columns_add(felt->rows, band->n,
                            layer->L + (size_t)band->first * (size_t)layer->padded + felt->row,
                            layer->padded, work->v_new + block->offset + band->first,
                            rate + felt->row);
        }
        /* the sum of the new stresses stands for all of them: it is not finite where one of them is not */
        double now = 0.0;
        for (int i = 0; i < layer->n_stresses; i++)
            now += weights++->now;
        for (int r = 0; r < layer->padded; r += BD_WIDTH)
            poison += 0.0 * (LANES(work->history + layer->offset + r) + now * LANES(rate + r));
    }
    for (int i = 0; i < BD_WIDTH; i++)
        if (!(poison[i] == 0.0))
            return 1;

    for (int k = 0; k < model->coefs; k += BD_WIDTH) {
        LANES_AT(state->g_before + model->coefs + k) = LANES(state->g_before + k);
        LANES_AT(state->g_before + k) = LANES(state->g + k);
        LANES_AT(state->g + k) = LANES(work->guess + k);
    }
    for (int i = 0; i < model->n_padded; i += BD_WIDTH) {
        LANES_AT(state->a + i) = LANES(work->a + i);
        LANES_AT(state->x + i) = LANES(work->x_new + i);
        LANES_AT(state->v + i) = LANES(work->v_new + i);
    }
    for (int i = 0; i < model->ranks; i += BD_WIDTH)
        LANES_AT(state->y_rate + i) = LANES(work->y_rate + i);
    weights = work->weights;
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        for (int i = 0; i < layer->n_stresses; i++) {
            size_t at = layer->stress + (size_t)i * (size_t)layer->padded;
            maxwell_commit(layer->padded, *weights++, work->trial + at,
                           state->y_rate + layer->offset, state->stress + at);
        }
    }
    return 0;
}

extern const bd_kernels BD_NAMED(bd_kernels);
const bd_kernels BD_NAMED(bd_kernels) = {
    .width = BD_WIDTH,
    .turn = BD_NAMED(bd_bearing_turn),
    .force = BD_NAMED(bd_bearing_force),
    .keep_peaks = BD_NAMED(bd_bearing_keep_peaks),
    .tangent = BD_NAMED(bd_bearing_tangent),
    .predict = predict,
    .observe = observe,
    .drift = drift,
    .displace = displace,
    .correct = correct,
    .commit = commit,
    .receptance = BD_NAMED(bd_receptance_solve),
    .join = BD_NAMED(bd_join_blocks),
    .changed_layers = BD_NAMED(bd_changed_layers_solve),
    .exact_predict = BD_NAMED(bd_exact_predict),
    .exact_commit = BD_NAMED(bd_exact_commit),
    .exact_shares = BD_NAMED(bd_exact_shares),
    .abreast_predict = BD_NAMED(bd_abreast_predict),
    .abreast_complete = BD_NAMED(bd_abreast_complete),
    .abreast_commit = BD_NAMED(bd_abreast_commit),
    .abreast_find = BD_NAMED(bd_abreast_find),
    .abreast_keep_peaks = BD_NAMED(bd_abreast_keep_peaks),
};
