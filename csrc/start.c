/* The acceleration that a march starts with: the residual of the equation of motion, and one solve with the mass. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "dense.h"
#include "echoes.h"
#include "energy.h"
#include "loads.h"
#include "newton.h"
#include "state.h"

/* What the layers and the bearings see of the state: y_rate = L^T v, and g at B x, B v, as if it had always
 * been so; films remember what they did. */
static void observe_state(const bd_model *model, bd_work *work, bd_state *state)
{
    const size_t m = (size_t)model->coefs;
    memset(work->z, 0, m * sizeof *work->z);
    memset(work->z_rate, 0, m * sizeof *work->z_rate);
    columns_add_two(model->coefs, model->n_padded, model->B, model->coefs, state->x, state->v,
                    work->z, work->z_rate);
    bd_turn_bearings(model, work);
    if (model->n_echoes > 0) {
        if (!state->clock.films_set)
            bd_echoes_settle(model, work, state);
        bd_echoes_recall(model, work, state);
    }
    bd_force_bearings(model, work);
    bd_echoes_press(model, work, state);
    for (size_t k = 0; k < m; k++)
        state->g[k] = state->g_before[k] = state->g_before[m + k] = work->force[k];

    memset(state->y_rate, 0, (size_t)model->ranks * sizeof *state->y_rate);
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        const bd_block *block = &model->blocks[layer->block];
        columns_add(layer->padded, block->n, layer->L, layer->padded, state->v + block->offset,
                    state->y_rate + layer->offset);
    }
}

/* M a of (1): f - B^T g - L s - (K + speed N + rate G) x - (C + speed G) v, the loads' factors in work. */
static void residual(const bd_model *model, const bd_work *work, const bd_state *state,
                     double *force)
{
    const size_t n_padded = (size_t)model->n_padded, m = (size_t)model->coefs;
    const bd_turn turn = work->turn;

    memset(force, 0, n_padded * sizeof *force);
    for (int k = 0; k < model->n_loads; k++)
        for (size_t i = 0; i < n_padded; i++)
            force[i] += work->load_factor[2 * k] * model->loads[k].p_cos[i] +
                        work->load_factor[2 * k + 1] * model->loads[k].p_sin[i];
    for (size_t i = 0; i < n_padded; i++)
        for (size_t k = 0; k < m; k++)
            force[i] -= model->B[i * m + k] * state->g[k];
    for (int b = 0; b < model->n_blocks; b++) {
        const bd_block *block = &model->blocks[b];
        const bd_matrices of = bd_matrices_of(model, block);
        const size_t n = (size_t)block->n;
        const double *x = state->x + block->offset, *v = state->v + block->offset;
        double *f = force + block->offset;

        for (int l = block->layer; l < block->layer + block->n_layers; l++) {
            const bd_layer *layer = &model->layers[l];
            const size_t padded = (size_t)layer->padded, rank = (size_t)layer->rank;
            const double *stress = state->stress + layer->stress;
            for (int i = 0; i < layer->n_stresses; i++, stress += padded)
                for (size_t j = 0; j < n; j++)
                    for (size_t r = 0; r < rank; r++)
                        f[j] -= layer->L[j * padded + r] * stress[r];
        }
        for (size_t i = 0, ij = 0; i < n; i++)
            for (size_t j = 0; j < n; j++, ij++)
                f[i] -= (of.K[ij] + turn.speed * of.N[ij] + turn.rate * of.G[ij]) * x[j] +
                        (of.C[ij] + turn.speed * of.G[ij]) * v[j];
    }
}

/* a = M^-1 force, block by block; force is destroyed. */
static bd_status solve_mass(const bd_model *model, const bd_lapack *lapack, double *force,
                            double *a)
{
    const size_t largest = (size_t)model->largest;
    double *factor = malloc(largest * largest * sizeof *factor);
    int *pivots = malloc(largest * sizeof *pivots);
    bd_status status = factor && pivots ? BD_OK : BD_NO_MEMORY;

    for (int b = 0; b < model->n_blocks && status == BD_OK; b++) {
        const bd_block *block = &model->blocks[b];
        const size_t n = (size_t)block->n;
        double *right = force + block->offset;
        memcpy(factor, bd_matrices_of(model, block).M, n * n * sizeof *factor);
        if (bd_solve_real(lapack, block->n, factor, pivots, 1, right))
            status = BD_SINGULAR_MASS;
        else
            memcpy(a + block->offset, right, n * sizeof *right);
    }
    free(factor);
    free(pivots);
    return status;
}

static bool all_finite(const double *values, int n)
{
    double poison = 0.0; /* 0 times a number that is not finite is NaN */
    for (int i = 0; i < n; i++)
        poison += values[i] * 0.0;
    return poison == 0.0;
}

bd_status bd_start(const bd_model *model, const bd_scheme *scheme, const bd_lapack *lapack,
                   bd_work *work, double *flat)
{
    bd_state state = bd_state_view(model, flat);
    bd_status status = bd_clock_valid(&state.clock) ? bd_work_choose(work, scheme) : BD_BAD_VALUE;
    if (status != BD_OK)
        return status;
    bd_clock_restart(&state.clock, scheme->dt);
    bd_clock_keep(&state);

    const double t = state.clock.origin;
    double *force = work->loss; /* free here */
    work->turn = bd_turn_at(&work->profile, t, 0.0, 0.5 * scheme->dt);
    bd_load_factors(model, work, t);
    observe_state(model, work, &state);
    residual(model, work, &state, force);
    status = solve_mass(model, lapack, force, state.a);
    if (status == BD_OK && !all_finite(state.a, model->n_padded))
        status = BD_NOT_FINITE;
    if (status == BD_OK && scheme->audit)
        bd_energy_rates(model, work, &state, state.energy);
    return status;
}
