#include "work.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "kernels.h"

/* ---------------------------------------------------------------- create, free */

/* Columns of a block's step operator. */
static size_t step_columns(const bd_model *model, const bd_block *block)
{
    size_t columns = 2 * (size_t)block->n;
    for (int l = block->layer; l < block->layer + block->n_layers; l++)
        columns += (size_t)model->layers[l].rank;
    return columns;
}

bd_work *bd_work_create(const bd_model *model)
{
    size_t n = (size_t)model->n_padded, m = (size_t)model->coefs;
    size_t steps = 0, bearing_scratch = 0;
    for (int b = 0; b < model->n_blocks; b++)
        steps += step_columns(model, &model->blocks[b]) * (size_t)model->blocks[b].padded;
    for (int b = 0; b < model->n_bearings; b++)
        bearing_scratch += bd_bearing_work_size(&model->bearings[b].data);

    bd_work *work = calloc(1, sizeof *work);
    if (!work)
        return NULL;
    struct {
        double **place;
        size_t count;
    } pieces[] = {
        {&work->step, steps},
        {&work->SB, m * n},
        {&work->SP, 2 * (size_t)model->n_loads * n},
        {&work->W, m * m},
        {&work->x, n},
        {&work->v, n},
        {&work->a, n},
        {&work->x_new, n},
        {&work->v_new, n},
        {&work->history, (size_t)model->ranks},
        {&work->trial, model->n_stress},
        {&work->y_rate, (size_t)model->ranks},
        {&work->y_before, (size_t)model->ranks},
        {&work->forget, (size_t)model->n_layers},
        {&work->z_linear, m},
        {&work->z_rate_linear, m},
        {&work->z, m},
        {&work->z_rate, m},
        {&work->Wg, m},
        {&work->force, m},
        {&work->guess, m},
        {&work->change, m},
        {&work->K, m * m},
        {&work->C, m * m},
        {&work->J, m * m},
        {&work->inverse, m * m},
        {&work->load_factor, 2 * (size_t)BD_PADDED(model->n_loads)},
        {&work->loss, n},
        {&work->a_steady, n},
        {&work->a_drift, n},
    };
    size_t n_pieces = sizeof pieces / sizeof pieces[0], total = bearing_scratch;
    for (size_t i = 0; i < n_pieces; i++)
        total += (size_t)BD_PADDED(pieces[i].count);

    size_t bytes = (total + BD_LANES) * sizeof(double);
    work->memory = aligned_alloc(64, (bytes + 63) / 64 * 64);
    work->diagonal = calloc((size_t)model->n_blocks, sizeof *work->diagonal);
    work->step_at = calloc((size_t)model->n_blocks + 1, sizeof *work->step_at);
    work->weights = calloc((size_t)model->branches + 1, sizeof *work->weights);
    work->echoes = calloc((size_t)model->n_echoes + 1, sizeof *work->echoes);
    work->bearings = calloc((size_t)model->n_bearings + 1, sizeof *work->bearings);
    if (!work->memory || !work->diagonal || !work->step_at || !work->weights || !work->echoes ||
        !work->bearings) {
        bd_work_free(work);
        return NULL;
    }
    memset(work->memory, 0, bytes);

    double *next = work->memory;
    for (size_t i = 0; i < n_pieces; i++) {
        *pieces[i].place = next;
        next += BD_PADDED(pieces[i].count);
    }
    for (int b = 0; b < model->n_bearings; b++) {
        bd_bearing_work_carve(&model->bearings[b], &work->bearings[b], next);
        next += bd_bearing_work_size(&model->bearings[b].data);
    }
    size_t at = 0;
    for (int b = 0; b < model->n_blocks; b++) {
        work->step_at[b] = at;
        at += step_columns(model, &model->blocks[b]) * (size_t)model->blocks[b].padded;
    }
    work->step_at[model->n_blocks] = at;
    return work;
}

void bd_work_free(bd_work *work)
{
    if (!work)
        return;
    free(work->memory);
    free(work->step_at);
    free(work->diagonal);
    free(work->weights);
    free(work->echoes);
    free(work->bearings);
    bd_profile_free(&work->profile);
    free(work->drift);
    bd_exact_free(work->exact);
    free(work);
}

/* ---------------------------------------------------------------- prepare */

bd_status bd_work_choose(bd_work *work, const bd_scheme *scheme)
{
    const bd_kernels *kernels = bd_kernels_for(scheme->isa);
    if (!kernels || !bd_scheme_valid(scheme))
        return BD_BAD_VALUE;
    const bd_status status = bd_profile_take(&work->profile, &scheme->speed);
    if (status != BD_OK)
        return status;
    work->scheme = *scheme;
    work->scheme.speed = work->profile.speed;
    work->in_x = scheme->beta * scheme->dt * scheme->dt;
    work->in_v = scheme->gamma * scheme->dt;
    work->kernels = kernels;
    return BD_OK;
}

/* Room for the columns of a speed that varies, or none. */
static bool take_drift(const bd_model *model, bd_work *work)
{
    size_t count = 0;
    for (int b = 0; b < model->n_blocks; b++)
        count += 2 * (size_t)model->blocks[b].n * (size_t)model->blocks[b].padded;
    free(work->drift);
    work->drift = work->scheme.speed.n > 1 ? calloc(count, sizeof *work->drift) : NULL;
    return work->drift || work->scheme.speed.n == 1;
}

/* Matrix and right-hand sides of one block, column-major and dense, in memory of its own. */
typedef struct block_system {
    double *S, *rhs, *damping;
    int *pivots;
} block_system;

/* Columns of a block's right-hand side. */
static size_t right_columns(const bd_model *model, const bd_work *work, const bd_block *block)
{
    return step_columns(model, block) + 2 * (size_t)model->n_loads + (size_t)model->coefs +
           (work->drift ? 2 * (size_t)block->n : 0);
}

/* C' = C + speed G + sum of the branches' present weights times L L^T, row-major. */
static void form_damping(const bd_model *model, const bd_block *block, const bd_work *work,
                         double *damping)
{
    const size_t n = (size_t)block->n;
    const bd_matrices of = bd_matrices_of(model, block);

    for (size_t ij = 0; ij < n * n; ij++)
        damping[ij] = of.C[ij] + work->reference * of.G[ij];
    for (int l = block->layer; l < block->layer + block->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        double now = 0.0;
        for (int i = 0; i < layer->n_stresses; i++)
            now += work->weights[layer->branch + i].now;
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++) {
                const double *Li = layer->L + i * (size_t)layer->padded;
                const double *Lj = layer->L + j * (size_t)layer->padded;
                double dot = 0.0;
                for (int r = 0; r < layer->rank; r++)
                    dot += Li[r] * Lj[r];
                damping[i * n + j] += now * dot;
            }
    }
}

/* A row-major matrix, times a sign, as n columns. Returned: where the next column goes. */
static double *put_columns(size_t n, double sign, const double *matrix, double *column)
{
    for (size_t j = 0; j < n; j++, column += n)
        for (size_t i = 0; i < n; i++)
            column[i] = sign * matrix[i * n + j];
    return column;
}

/* S and [-K' | -C' | -L | p | B^T | G | N], where K' = K + speed N and C' is form_damping's, at the reference
 * speed; G and N only while the speed varies. */
static void form_block(const bd_model *model, const bd_block *block, const bd_work *work,
                       const block_system *system)
{
    const size_t n = (size_t)block->n, m = (size_t)model->coefs;
    const bd_matrices of = bd_matrices_of(model, block);
    double *column = system->rhs;

    form_damping(model, block, work, system->damping);
    for (size_t j = 0; j < n; j++, column += n)
        for (size_t i = 0; i < n; i++) {
            const size_t ij = i * n + j;
            const double stiffness = of.K[ij] + work->reference * of.N[ij];
            system->S[j * n + i] =
                of.M[ij] + work->in_v * system->damping[ij] + work->in_x * stiffness;
            column[i] = -stiffness;
        }
    column = put_columns(n, -1.0, system->damping, column);
    for (int l = block->layer; l < block->layer + block->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        for (int r = 0; r < layer->rank; r++, column += n)
            for (size_t i = 0; i < n; i++)
                column[i] = -layer->L[i * (size_t)layer->padded + (size_t)r];
    }
    for (int k = 0; k < model->n_loads; k++) {
        const bd_load *load = &model->loads[k];
        memcpy(column, load->p_cos + block->offset, n * sizeof *column);
        memcpy(column + n, load->p_sin + block->offset, n * sizeof *column);
        column += 2 * n;
    }
    for (size_t k = 0; k < m; k++, column += n)
        for (size_t i = 0; i < n; i++)
            column[i] = model->B[((size_t)block->offset + i) * m + k];
    if (work->drift) {
        column = put_columns(n, 1.0, of.G, column);
        put_columns(n, 1.0, of.N, column);
    }
}

/* Whether a block's mass and its stiffness at the reference speed have nothing beside the diagonal, as in modes. */
static bool is_diagonal(const bd_model *model, const bd_block *block, double reference)
{
    const size_t n = (size_t)block->n;
    const bd_matrices of = bd_matrices_of(model, block);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const size_t ij = i * n + j;
            if (i != j && (of.M[ij] != 0.0 || of.K[ij] + reference * of.N[ij] != 0.0))
                return false;
        }
    return true;
}

/* Columns of n rows to a stride. Returned: the first that was not moved. */
static const double *move_columns(size_t columns, size_t n, const double *from, size_t stride,
                                  double *to)
{
    for (size_t c = 0; c < columns; c++, from += n)
        memcpy(to + c * stride, from, n * sizeof *to);
    return from;
}

/* The solved columns into the padded operators of work. */
static void place_block(const bd_model *model, int b, bd_work *work, const block_system *system,
                        double *drift)
{
    const bd_block *block = &model->blocks[b];
    const size_t n = (size_t)block->n, padded = (size_t)block->padded;
    const size_t whole = (size_t)model->n_padded;
    double *step = work->step + work->step_at[b];
    const double *column = system->rhs;

    column = move_columns(step_columns(model, block), n, column, padded, step);
    work->diagonal[b] = is_diagonal(model, block, work->reference);
    if (work->diagonal[b]) { /* one column serves instead of the first n */
        const bd_matrices of = bd_matrices_of(model, block);
        for (size_t i = 0; i < n; i++) {
            const size_t ii = i * n + i;
            const double stiffness = of.K[ii] + work->reference * of.N[ii];
            step[i] = -stiffness / (of.M[ii] + work->in_x * stiffness);
        }
    }
    column = move_columns(2 * (size_t)model->n_loads, n, column, whole, work->SP + block->offset);
    column = move_columns((size_t)model->coefs, n, column, whole, work->SB + block->offset);
    if (drift)
        move_columns(2 * n, n, column, padded, drift);
}

/* Whether a block has a layer that softens. */
static bool softens(const bd_model *model, const bd_block *block)
{
    for (int l = block->layer; l < block->layer + block->n_layers; l++)
        if (model->layers[l].softening)
            return true;
    return false;
}

/* S^-1 times all right-hand sides, block by block, or only of those that soften. */
static bd_status factor_blocks(const bd_model *model, const bd_lapack *lapack, bool only_soft,
                               bd_work *work)
{
    const size_t largest = (size_t)model->largest;
    size_t widest = 0;
    for (int b = 0; b < model->n_blocks; b++) {
        const size_t columns = right_columns(model, work, &model->blocks[b]);
        widest = columns > widest ? columns : widest;
    }
    block_system system = {
        .S = malloc(largest * largest * sizeof(double)),
        .damping = malloc(largest * largest * sizeof(double)),
        .rhs = malloc(largest * widest * sizeof(double)),
        .pivots = malloc(largest * sizeof(int)),
    };
    bd_status status =
        system.S && system.damping && system.rhs && system.pivots ? BD_OK : BD_NO_MEMORY;
    double *drift = work->drift;
    for (int b = 0; b < model->n_blocks && status == BD_OK; b++) {
        const bd_block *block = &model->blocks[b];
        if (!only_soft || softens(model, block)) {
            form_block(model, block, work, &system);
            if (bd_solve_real(lapack, block->n, system.S, system.pivots,
                              (int)right_columns(model, work, block), system.rhs))
                status = BD_SINGULAR;
            else
                place_block(model, b, work, &system, drift);
        }
        if (drift)
            drift += 2 * (size_t)block->n * (size_t)block->padded;
    }
    free(system.S);
    free(system.damping);
    free(system.rhs);
    free(system.pivots);
    return status;
}

/* W = B S^-1 B^T */
static void join_bearings(const bd_model *model, bd_work *work)
{
    const size_t m = (size_t)model->coefs, n = (size_t)model->n_padded;
    for (size_t c = 0; c < m; c++)
        for (size_t k = 0; k < m; k++) {
            double sum = 0.0;
            for (size_t i = 0; i < n; i++)
                sum += model->B[i * m + k] * work->SB[c * n + i];
            work->W[c * m + k] = sum;
        }
}

void bd_echoes_prepare(const bd_model *model, bd_work *work)
{
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        for (int i = 0; i < bearing->data.contact.n_echoes; i++)
            work->echoes[bearing->weight + i] =
                bd_echo_step(&bearing->data.contact.echoes[i], work->scheme.dt);
    }
}

bd_status bd_prepare(const bd_model *model, const bd_scheme *scheme, const bd_lapack *lapack,
                     double reference_speed, bd_work *work)
{
    bd_status status = isfinite(reference_speed) ? bd_work_choose(work, scheme) : BD_BAD_VALUE;
    if (status != BD_OK)
        return status;
    work->reference = reference_speed;
    if (!take_drift(model, work))
        return BD_NO_MEMORY;
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        for (int i = 0; i < layer->n_branches; i++)
            work->weights[layer->branch + i] =
                bd_maxwell_weights(scheme->dt, layer->tau[i], layer->modulus[i]);
    }
    bd_echoes_prepare(model, work);
    status = factor_blocks(model, lapack, false, work);
    if (status == BD_OK)
        join_bearings(model, work);
    return status;
}

bd_status bd_prepare_softened(const bd_model *model, const bd_lapack *lapack, bd_work *work)
{
    const bd_status status = factor_blocks(model, lapack, true, work);
    if (status == BD_OK)
        join_bearings(model, work);
    return status;
}
