/* One Newmark step in acceleration form, and the march.
 *
 * Everything is linear except the balls. With predictors x~, v~ the acceleration without the bearings is one
 * product of prepared columns; the bearings are then found on their few coefficients alone:
 *     z = z* - beta dt^2 W g(z, zdot),   zdot = zdot* - gamma dt W g,   W = B S^-1 B^T
 * and the acceleration is completed by a = a* - S^-1 B^T g. The displacement form of the scheme would lose
 * energy to round-off over 1e5 steps; this one does not. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "dense.h"
#include "kernels.h"
#include "work.h"

/* A frozen Newton matrix that needs more evaluations than this is replaced. */
enum { PATIENCE = 3 };
/* From here on corrections are halved, and a step may end on position alone: a constant c makes the
 * force jump where a film opens, and inside that jump no force balances exactly. */
enum { GRAZING = 10 };
/* Turns between bearings and a varying speed, and the contraction that asks for new factors. Just factored, only
 * W' G x is left, which may contract as slowly as it likes. */
enum { SWEEPS = 60 };
static const double slow = 0.1;
/* Share of the largest bearing displacement to which the position must then be known. */
static const double grazing_tolerance = 1e-7;

/* ---------------------------------------------------------------- bearings */

void bd_turn_bearings(const bd_model *model, bd_work *work)
{
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        const double psi = bearing->data.angle0 + bearing->data.cage_ratio * work->turn.angle;
        work->kernels->turn(bearing, &work->bearings[b], psi);
        if (!bd_bearing_perfect(bearing))
            bd_bearing_imperfect(bearing, &work->bearings[b], psi,
                                 bearing->data.cage_ratio * work->turn.speed, work->turn);
    }
}

void bd_force_bearings(const bd_model *model, bd_work *work)
{
    for (int b = 0; b < model->n_bearings; b++) {
        int at = model->bearing_slot[b];
        work->kernels->force(
            &model->bearings[b], &work->bearings[b], work->z + at, work->z_rate + at,
            model->bearings[b].data.cage_ratio * work->turn.speed, work->force + at);
    }
}

/* Newton's matrix I + (beta dt^2 K + gamma dt C) W at the last evaluation, inverted.
 * Returned: 0, or nonzero where it is singular. */
static int refresh(const bd_model *model, bd_work *work)
{
    const size_t m = (size_t)model->coefs;
    const bd_scheme *scheme = &work->scheme;
    const double in_x = scheme->beta * scheme->dt * scheme->dt, in_v = scheme->gamma * scheme->dt;

    memset(work->J, 0, m * m * sizeof *work->J);
    for (size_t k = 0; k < m; k++)
        work->J[k * m + k] = 1.0;
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        const size_t at = (size_t)model->bearing_slot[b], n = (size_t)bearing->data.n_coefs;
        const size_t stride = (size_t)bearing->coefs;
        work->kernels->tangent(bearing, &work->bearings[b],
                               bearing->data.cage_ratio * work->turn.speed, bearing->coefs, work->K,
                               work->C);
        for (size_t k = 0; k < n; k++)
            for (size_t l = 0; l < n; l++) {
                double tangent = in_x * work->K[k * stride + l] + in_v * work->C[k * stride + l];
                for (size_t c = 0; c < m; c++)
                    work->J[(at + k) * m + c] += tangent * work->W[c * m + at + l];
            }
    }
    return bd_invert((int)m, (int)m, work->J, work->inverse);
}

/* ---------------------------------------------------------------- one step */

/* Largest |force - guess| and |force|; NaN in any of them makes the first NaN. */
static void measure(const bd_model *model, const bd_work *work, double *residual, double *scale)
{
    double largest_residual = 0.0, largest = 0.0, poison = 0.0;
    for (int k = 0; k < model->coefs; k++) {
        double difference = fabs(work->force[k] - work->guess[k]), size = fabs(work->force[k]);
        largest_residual = difference > largest_residual ? difference : largest_residual;
        largest = size > largest ? size : largest;
        poison += work->z[k] * 0.0 + difference * 0.0;
    }
    *residual = largest_residual + poison;
    *scale = largest;
}

/* Is the position settled although the force is not: the last correction moved no coefficient. */
static bool position_settled(const bd_model *model, bd_work *work)
{
    const bd_scheme *scheme = &work->scheme;
    const double in_x = scheme->beta * scheme->dt * scheme->dt;
    const size_t m = (size_t)model->coefs;
    double largest_move = 0.0, largest = 0.0;
    for (size_t k = 0; k < m; k++) {
        double move = 0.0;
        for (size_t c = 0; c < m; c++)
            move += work->W[c * m + k] * (work->force[c] - work->guess[c]);
        largest_move = fmax(largest_move, fabs(in_x * move));
        largest = fmax(largest, fabs(work->z[k]));
    }
    return largest_move <= grazing_tolerance * largest;
}

/* The bearing with the largest residual, or the first whose residual is not a number. */
static int worst_bearing(const bd_model *model, const bd_work *work)
{
    int worst = -1;
    double largest = -1.0;
    for (int b = 0; b < model->n_bearings; b++)
        for (int k = 0; k < model->bearings[b].data.n_coefs; k++) {
            int at = model->bearing_slot[b] + k;
            double residual = fabs(work->force[at] - work->guess[at]);
            if (isnan(residual))
                return b;
            if (residual > largest) {
                largest = residual;
                worst = b;
            }
        }
    return worst;
}

/* Newton's iteration on the bearing forces, from work->guess; the frozen inverse lives in the state. */
static bd_status solve_bearings(const bd_model *model, bd_work *work, bd_state *state,
                                bd_report *report)
{
    const bd_scheme *scheme = &work->scheme;
    const size_t m = (size_t)model->coefs;
    const double *inverse = state->inverse;
    bool fresh = state->clock[3] != 0.0;

    for (int iteration = 0; iteration < scheme->max_iterations; iteration++) {
        double residual, scale;
        work->kernels->displace(model, work);
        bd_force_bearings(model, work);
        report->iterations++;
        measure(model, work, &residual, &scale);
        report->residual = scale > 0.0 ? residual / scale : residual;
        if (!isfinite(residual)) {
            report->bearing = worst_bearing(model, work);
            return BD_NOT_FINITE;
        }
        const bool balanced = residual <= scheme->tolerance * scale;
        const bool grazes = !balanced && iteration >= GRAZING && position_settled(model, work);
        const bool converged = balanced || grazes;
        report->grazing += grazes;
        if (!converged && (!fresh || iteration >= PATIENCE)) {
            if (refresh(model, work)) {
                report->bearing = worst_bearing(model, work);
                return BD_SINGULAR;
            }
            inverse = work->inverse;
            fresh = true;
            report->refreshes++;
        }
        if (residual > 0.0 && fresh)
            work->kernels->correct(model, work, iteration < GRAZING ? 1.0 : 0.5, inverse);
        if (converged) {
            if (inverse == work->inverse) {
                memcpy(state->inverse, work->inverse, m * m * sizeof *inverse);
                state->clock[3] = 1.0;
            }
            return BD_OK;
        }
    }
    report->bearing = worst_bearing(model, work);
    return BD_NO_CONVERGENCE;
}

/* One step's bearing forces and, while the speed varies, its departure from the reference:
 *     a = a_steady + a_drift - S^-1 B^T g,   a_drift = -S^-1 [(W - W_ref)(G v + N x) + W' G x]
 * by turns, each contracting by about dt times the departure; when that is no longer quick, S is asked for anew.
 */
static bd_status solve_step(const bd_model *model, bd_work *work, bd_state *state,
                            bd_report *report)
{
    const size_t n = (size_t)model->n_padded, m = (size_t)model->coefs;
    const bool bearings = model->n_bearings > 0;
    const bool factored_here = work->reference == work->turn.speed;
    double before = INFINITY;

    /* Newton starts from the parabola through the last three forces */
    for (size_t k = 0; k < m; k++)
        work->guess[k] = 3.0 * (state->g[k] - state->g_before[k]) + state->g_before[m + k];
    if (!work->drift) {
        if (!bearings)
            return BD_OK;
        work->kernels->observe(model, work);
        return solve_bearings(model, work, state, report);
    }

    memcpy(work->a_steady, work->a, n * sizeof *work->a);
    memset(work->a_drift, 0, n * sizeof *work->a_drift);
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        double largest, change = work->kernels->drift(model, work, &largest);
        if (!isfinite(change))
            return BD_NOT_FINITE;
        if (bearings) {
            work->kernels->observe(model, work);
            bd_status status = solve_bearings(model, work, state, report);
            if (status != BD_OK)
                return status;
        }
        if (change <= 1e-3 * work->scheme.tolerance * largest)
            return BD_OK;
        if (sweep > 0 && change > (factored_here ? 1.0 : slow) * before)
            break;
        before = change;
    }
    return factored_here ? BD_NO_CONVERGENCE : BD_REFACTOR;
}

/* ---------------------------------------------------------------- march */

static void record_row(const bd_model *model, const bd_work *work, const bd_state *state,
                       double *row)
{
    const double *const motion[] = {state->x, state->v, state->a};
    for (int c = 0; c < model->n_channels; c++) {
        const bd_channel *channel = &model->channels[c];
        double value = 0.0;
        switch (channel->kind) {
        case BD_CHANNEL_DISPLACEMENT:
        case BD_CHANNEL_VELOCITY:
        case BD_CHANNEL_ACCELERATION:
            for (int i = 0; i < model->n_padded; i++)
                value += channel->row[i] * motion[channel->kind][i];
            break;
        case BD_CHANNEL_FORCE:
            value = state->g[model->bearing_slot[channel->bearing] + channel->index];
            break;
        case BD_CHANNEL_BALL:
            value = work->bearings[channel->bearing].force[channel->index];
            break;
        case BD_CHANNEL_LOADED:
            for (int j = 0; j < model->bearings[channel->bearing].data.n_balls; j++)
                value += work->bearings[channel->bearing].force[j] > 0.0 ? 1.0 : 0.0;
            break;
        case BD_CHANNEL_CONTACT_LOSS:
            value = bd_contact_loss(&model->bearings[channel->bearing].data,
                                    &work->bearings[channel->bearing]);
            break;
        case BD_CHANNEL_BRANCH_LOSS:
            value = bd_branch_loss(&model->layers[channel->index], state->stress);
            break;
        }
        row[c] = value;
    }
}

static bool finite_state(const bd_model *model, const bd_state *state)
{
    double poison = 0.0;
    for (int i = 0; i < model->n_padded; i++)
        poison += state->a[i] * 0.0;
    return poison == 0.0;
}

bd_status bd_start(const bd_model *model, const bd_scheme *scheme, const bd_lapack *lapack,
                   bd_work *work, double *flat)
{
    bd_state state = bd_state_view(model, flat);
    double t = state.clock[0] + state.clock[1] * state.clock[2];
    const size_t n_padded = (size_t)model->n_padded;

    if (!bd_work_choose(work, scheme))
        return BD_BAD_VALUE;
    work->turn = bd_turn_at(work, t);
    state.clock[0] = t;
    state.clock[1] = 0.0;
    state.clock[2] = scheme->dt;
    memset(work->z, 0, (size_t)model->coefs * sizeof *work->z);
    memset(work->z_rate, 0, (size_t)model->coefs * sizeof *work->z_rate);
    columns_add_two(model->coefs, model->n_padded, model->B, model->coefs, state.x, state.v,
                    work->z, work->z_rate);
    bd_turn_bearings(model, work);
    bd_force_bearings(model, work);
    for (size_t k = 0, m = (size_t)model->coefs; k < m; k++)
        state.g[k] = state.g_before[k] = state.g_before[m + k] = work->force[k];
    bd_load_factors(model, work, t);

    /* residual force on every coordinate; work->loss is free here */
    double *force = work->loss;
    memset(force, 0, n_padded * sizeof *force);
    for (int k = 0; k < model->n_loads; k++)
        for (size_t i = 0; i < n_padded; i++)
            force[i] += work->load_factor[2 * k] * model->loads[k].p_cos[i] +
                        work->load_factor[2 * k + 1] * model->loads[k].p_sin[i];
    for (size_t i = 0; i < n_padded; i++)
        for (int k = 0; k < model->coefs; k++)
            force[i] -= model->B[i * (size_t)model->coefs + (size_t)k] * state.g[k];
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        const bd_block *block = &model->blocks[layer->block];
        double *rate = state.y_rate + layer->offset;
        memset(rate, 0, (size_t)layer->padded * sizeof *rate);
        columns_add(layer->padded, block->n, layer->L, layer->padded, state.v + block->offset,
                    rate);
        for (int i = 0; i < layer->n_branches; i++) {
            const double *stress = state.stress + layer->stress + (size_t)i * (size_t)layer->padded;
            for (int j = 0; j < block->n; j++)
                for (int r = 0; r < layer->rank; r++)
                    force[block->offset + j] -=
                        layer->L[(size_t)j * (size_t)layer->padded + (size_t)r] * stress[r];
        }
    }

    /* M a = force, block by block; the prepared step columns lend their room to the factor */
    int largest = 0;
    for (int b = 0; b < model->n_blocks; b++)
        largest = model->blocks[b].n > largest ? model->blocks[b].n : largest;
    int *pivots = malloc((size_t)largest * sizeof *pivots);
    if (!pivots)
        return BD_NO_MEMORY;
    bd_status status = BD_OK;
    for (int b = 0; b < model->n_blocks && status == BD_OK; b++) {
        const bd_block *block = &model->blocks[b];
        const size_t n = (size_t)block->n;
        const double *C = model->C + block->matrix, *G = model->G + block->matrix;
        const double *K = model->K + block->matrix, *N = model->N + block->matrix;
        double *right = force + block->offset;
        double *x = state.x + block->offset, *v = state.v + block->offset;
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++)
                right[i] -= (K[i * n + j] + work->turn.speed * N[i * n + j] +
                             work->turn.rate * G[i * n + j]) *
                                x[j] +
                            (C[i * n + j] + work->turn.speed * G[i * n + j]) * v[j];
        double *factor = work->step + work->step_at[b];
        memcpy(factor, model->M + block->matrix, n * n * sizeof *factor);
        if (bd_solve_real(lapack, block->n, factor, pivots, 1, right))
            status = BD_SINGULAR_MASS;
        else
            memcpy(state.a + block->offset, right, n * sizeof *right);
    }
    free(pivots);
    if (status == BD_OK && !finite_state(model, &state))
        status = BD_NOT_FINITE;
    if (status == BD_OK && scheme->audit)
        bd_energy_rates(model, work, &state, t, state.energy);
    return status;
}

long long bd_march(const bd_model *model, const bd_scheme *scheme, bd_work *work, double *flat,
                   long long n_steps, long long decimate, double *record, bd_report *report)
{
    bd_state state = bd_state_view(model, flat);
    const double dt = scheme->dt;
    long long rows = 0;

    *report = (bd_report){.status = BD_OK, .bearing = -1};
    if (state.clock[2] !=
        dt) { /* a new step size starts a new count, and Newton's matrix with it */
        state.clock[0] += state.clock[1] * state.clock[2];
        state.clock[1] = 0.0;
        state.clock[2] = dt;
        state.clock[3] = 0.0;
    }
    for (; report->steps < n_steps; report->steps++) {
        const double t = state.clock[0] + (state.clock[1] + 1.0) * dt;

        /* the structure without its bearings */
        work->turn = bd_turn_at(work, t);
        bd_load_factors(model, work, t);
        work->kernels->predict(model, work, &state);

        /* the bearings, on their own few numbers */
        if (model->n_bearings > 0)
            bd_turn_bearings(model, work);
        report->status = solve_step(model, work, &state, report);
        if (report->status != BD_OK)
            break;

        /* both together; only now does the state change */
        if (work->kernels->commit(model, work, &state)) {
            report->status = BD_NOT_FINITE;
            break;
        }
        state.clock[1] += 1.0;
        if (scheme->audit)
            bd_energy_step(model, work, &state, t);

        if ((long long)state.clock[1] % decimate == 0) {
            record_row(model, work, &state, record + rows * model->n_channels);
            rows++;
        }
    }
    report->t = state.clock[0] + state.clock[1] * dt;
    return rows;
}
