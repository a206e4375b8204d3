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
    size_t n = (size_t)model->n_padded, m = (size_t)model->coefs, branches = 0;
    size_t steps = 0, bearing_scratch = 0;
    for (int b = 0; b < model->n_blocks; b++)
        steps += step_columns(model, &model->blocks[b]) * (size_t)model->blocks[b].padded;
    for (int b = 0; b < model->n_bearings; b++)
        bearing_scratch += bd_bearing_work_size(&model->bearings[b].data);
    for (int l = 0; l < model->n_layers; l++)
        branches += (size_t)model->layers[l].n_branches;

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
    work->step_at = calloc((size_t)model->n_blocks, sizeof *work->step_at);
    work->weights = calloc(branches + 1, sizeof *work->weights);
    work->bearings = calloc((size_t)model->n_bearings + 1, sizeof *work->bearings);
    if (!work->memory || !work->diagonal || !work->step_at || !work->weights || !work->bearings) {
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
    free(work->bearings);
    free(work->profile);
    free(work->drift);
    free(work);
}

/* ---------------------------------------------------------------- prepare */

bool bd_scheme_valid(const bd_scheme *scheme)
{
    return bd_scheme_fault(scheme).field == NULL;
}

bool bd_work_choose(bd_work *work, const bd_scheme *scheme)
{
    if (!bd_scheme_valid(scheme))
        return false;
    work->kernels = bd_kernels_for(scheme->isa);
    work->scheme = *scheme;
    return work->kernels && bd_take_speed(work, &scheme->speed);
}

/* Right-hand sides and matrix of one block, column-major and dense, in memory of its own. */
typedef struct block_system {
    double *S, *rhs, *damping;
    int *pivots;
    size_t columns;
} block_system;

/* S and [-K' | -C' | -L | p | B^T | G | N], where K' = K + speed N and C' = C + C_ve + speed G at the reference
 * speed; G and N only while the speed varies. */
static void form_block(const bd_model *model, const bd_block *block, const bd_work *work,
                       size_t first_weight, block_system *system)
{
    const bd_scheme *scheme = &work->scheme;
    const size_t n = (size_t)block->n;
    const double *M = model->M + block->matrix, *C = model->C + block->matrix;
    const double *G = model->G + block->matrix, *K = model->K + block->matrix;
    const double *N = model->N + block->matrix;
    const double in_a = scheme->beta * scheme->dt * scheme->dt, in_v = scheme->gamma * scheme->dt;
    double *D = system->damping, *rhs = system->rhs;

    for (size_t ij = 0; ij < n * n; ij++)
        D[ij] = C[ij] + work->reference * G[ij];
    for (int l = block->layer; l < block->layer + block->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        double now = 0.0;
        for (int i = 0; i < layer->n_branches; i++)
            now += work->weights[first_weight++].now;
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++) {
                const double *Li = layer->L + i * (size_t)layer->padded;
                const double *Lj = layer->L + j * (size_t)layer->padded;
                double dot = 0.0;
                for (int r = 0; r < layer->rank; r++)
                    dot += Li[r] * Lj[r];
                D[i * n + j] += now * dot;
            }
    }

    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++) {
            size_t ij = i * n + j;
            const double stiffness = K[ij] + work->reference * N[ij];
            system->S[j * n + i] = M[ij] + in_v * D[ij] + in_a * stiffness;
            rhs[j * n + i] = -stiffness;
            rhs[(n + j) * n + i] = -D[ij];
        }
    double *column = rhs + 2 * n * n;
    for (int l = block->layer; l < block->layer + block->n_layers; l++)
        for (int r = 0; r < model->layers[l].rank; r++, column += n)
            for (size_t i = 0; i < n; i++)
                column[i] = -model->layers[l].L[i * (size_t)model->layers[l].padded + (size_t)r];
    for (int k = 0; k < model->n_loads; k++)
        for (int part = 0; part < 2; part++, column += n)
            memcpy(column, (part ? model->loads[k].p_sin : model->loads[k].p_cos) + block->offset,
                   n * sizeof *column);
    for (int k = 0; k < model->coefs; k++, column += n)
        for (size_t i = 0; i < n; i++)
            column[i] = model->B[((size_t)block->offset + i) * (size_t)model->coefs + (size_t)k];
    if (work->drift)
        for (size_t j = 0; j < n; j++)
            for (size_t i = 0; i < n; i++) {
                column[j * n + i] = G[i * n + j];
                column[(n + j) * n + i] = N[i * n + j];
            }
}

/* Whether a block's mass and its stiffness at the reference speed have nothing beside the diagonal, as in modes. */
static bool is_diagonal(const bd_model *model, const bd_block *block, const bd_work *work)
{
    const size_t n = (size_t)block->n;
    const double *M = model->M + block->matrix, *K = model->K + block->matrix;
    const double *N = model->N + block->matrix;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            if (i != j &&
                (M[i * n + j] != 0.0 || K[i * n + j] + work->reference * N[i * n + j] != 0.0))
                return false;
    return true;
}

/* Where a block's drift columns start. */
static size_t drift_at(const bd_model *model, int b)
{
    size_t at = 0;
    for (int i = 0; i < b; i++)
        at += 2 * (size_t)model->blocks[i].n * (size_t)model->blocks[i].padded;
    return at;
}

/* The solved columns into the padded operators of work. */
static void place_block(const bd_model *model, int b, bd_work *work, const block_system *system)
{
    const bd_block *block = &model->blocks[b];
    const size_t n = (size_t)block->n, padded = (size_t)block->padded;
    const size_t in_step = step_columns(model, block);
    const double *column = system->rhs;

    for (size_t c = 0; c < in_step; c++, column += n) {
        double *to = work->step + work->step_at[b] + c * padded;
        memcpy(to, column, n * sizeof *column);
        memset(to + n, 0, (padded - n) * sizeof *to); /* bd_start may have written there */
    }
    if (work->diagonal[b]) { /* one column serves instead of the first n */
        const double in_a = work->scheme.beta * work->scheme.dt * work->scheme.dt;
        double *to = work->step + work->step_at[b];
        for (size_t i = 0; i < n; i++) {
            const size_t ii = block->matrix + i * n + i;
            const double stiffness = model->K[ii] + work->reference * model->N[ii];
            to[i] = -stiffness / (model->M[ii] + in_a * stiffness);
        }
    }
    for (size_t c = 0; c < 2 * (size_t)model->n_loads; c++, column += n)
        memcpy(work->SP + c * (size_t)model->n_padded + block->offset, column, n * sizeof *column);
    for (size_t c = 0; c < (size_t)model->coefs; c++, column += n)
        memcpy(work->SB + c * (size_t)model->n_padded + block->offset, column, n * sizeof *column);
    if (work->drift)
        for (size_t c = 0; c < 2 * n; c++, column += n)
            memcpy(work->drift + drift_at(model, b) + c * padded, column, n * sizeof *column);
}

/* Columns of a block's right-hand side. */
static size_t right_columns(const bd_model *model, const bd_work *work, const bd_block *block)
{
    return step_columns(model, block) + 2 * (size_t)model->n_loads + (size_t)model->coefs +
           (work->drift ? 2 * (size_t)block->n : 0);
}

bd_status bd_prepare(const bd_model *model, const bd_scheme *scheme, const bd_lapack *lapack,
                     double reference_speed, bd_work *work)
{
    if (!bd_work_choose(work, scheme) || !isfinite(reference_speed))
        return BD_BAD_VALUE;
    work->reference = reference_speed;
    free(work->drift);
    work->drift = NULL;
    if (scheme->speed.n > 1) {
        work->drift = calloc(drift_at(model, model->n_blocks) + 1, sizeof *work->drift);
        if (!work->drift)
            return BD_NO_MEMORY;
    }

    size_t weight = 0, largest = 0, widest = 0;
    for (int l = 0; l < model->n_layers; l++)
        for (int i = 0; i < model->layers[l].n_branches; i++)
            work->weights[weight++] = bd_maxwell_weights(scheme->dt, model->layers[l].tau[i],
                                                         model->layers[l].modulus[i]);
    for (int b = 0; b < model->n_blocks; b++) {
        size_t n = (size_t)model->blocks[b].n;
        size_t columns = right_columns(model, work, &model->blocks[b]);
        largest = n > largest ? n : largest;
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
    weight = 0;
    for (int b = 0; b < model->n_blocks && status == BD_OK; b++) {
        const bd_block *block = &model->blocks[b];
        system.columns = right_columns(model, work, block);
        work->diagonal[b] = is_diagonal(model, block, work);
        form_block(model, block, work, weight, &system);
        if (bd_solve_real(lapack, block->n, system.S, system.pivots, (int)system.columns,
                          system.rhs))
            status = BD_SINGULAR;
        else
            place_block(model, b, work, &system);
        for (int l = block->layer; l < block->layer + block->n_layers; l++)
            weight += (size_t)model->layers[l].n_branches;
    }
    free(system.S);
    free(system.damping);
    free(system.rhs);
    free(system.pivots);

    /* W = B S^-1 B^T */
    const size_t m = (size_t)model->coefs;
    for (size_t c = 0; c < m; c++)
        for (size_t k = 0; k < m; k++) {
            double sum = 0.0;
            for (size_t i = 0; i < (size_t)model->n_padded; i++)
                sum += model->B[i * m + k] * work->SB[c * (size_t)model->n_padded + i];
            work->W[c * m + k] = sum;
        }
    return status;
}
