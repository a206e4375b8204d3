/* Scratch of a harmonic response: forces, rows and bearings in block order, and the blocks as their receptances need
 * them. */
#include "harmonic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernels.h"

static void *zeroed(size_t count, size_t size)
{
    return calloc(count + 1, size);
}

/* ---------------------------------------------------------------- blocks for receptances */

/* Beyond these numbers of coordinates a block does not fit the caches, and LAPACK is faster. */
enum { LARGEST = 96 };

/* Coordinates of a block from stiff to soft. A layer counts as if it were as stiff as the structure, so that the order
 * does not hang on the frequencies asked for. */
static void order_pivots(const bd_model *model, const bd_harmonic_work *work, const bd_block *block,
                         int *order)
{
    const bd_matrices of = bd_matrices_of(model, block);
    const double *held = work->held + block->matrix;
    const size_t n = (size_t)block->n;
    double stiffness[LARGEST], structure = 0.0;
    for (size_t i = 0; i < n; i++) {
        stiffness[i] = of.K[i * n + i] + held[i * n + i];
        structure += stiffness[i];
    }
    for (int l = block->layer; l < block->layer + block->n_layers; l++) {
        const double *H = work->HL + work->HL_at[l];
        double trace = 0.0;
        for (size_t i = 0; i < n; i++)
            trace += H[i * n + i];
        for (size_t i = 0; i < n && trace > 0.0; i++)
            stiffness[i] += structure / trace * H[i * n + i];
    }
    for (size_t i = 0; i < n; i++) {
        stiffness[i] /= of.M[i * n + i];
        size_t place = i;
        for (; place > 0 && stiffness[order[place - 1]] < stiffness[i]; place--)
            order[place] = order[place - 1];
        order[place] = (int)i;
    }
}

/* Whether a matrix is symmetric but for round-off. */
static bool symmetric(size_t n, const double *A)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++)
            if (fabs(A[i * n + j] - A[j * n + i]) > 4e-16 * sqrt(fabs(A[i * n + i] * A[j * n + j])))
                return false;
    return true;
}

/* Whether K + speed N, C + speed G and M are. */
static bool all_symmetric(const bd_matrices *of, size_t n, double speed)
{
    if (!symmetric(n, of->M) || !symmetric(n, of->C) || !symmetric(n, of->K))
        return false;
    for (size_t ij = 0; ij < n * n; ij++)
        if (speed * of->G[ij] != 0.0 || speed * of->N[ij] != 0.0)
            return false;
    return true;
}

/* The joints, and what holds each block in them. A block that floats between bearings is singular at low frequency,
 * and what its bearings then make of it cancels as many digits as it moves too far. Held by springs S of the
 * bearings' own size it does not; the springs are taken away again where blocks are joined. */
static void hold_blocks(const bd_model *model, const bd_harmonic_data *data, bd_harmonic_work *work)
{
    const size_t m = (size_t)model->n_coefs, n_in = (size_t)data->n_in;
    for (size_t k = 0; k < m; k++)
        work->S[k] = fabs(work->Kb[k * m + k]);
    for (int b = 0; b < model->n_blocks; b++) {
        const bd_block *block = &model->blocks[b];
        const size_t n = (size_t)block->n;
        const double *B = work->B + (size_t)block->first * m;
        double *held = work->held + block->matrix;
        for (size_t k = 0; k < m; k++) {
            work->joint[(size_t)b * m + k] = -1;
            for (size_t i = 0; i < n; i++)
                for (size_t j = 0; j < n; j++)
                    held[i * n + j] += B[i * m + k] * work->S[k] * B[j * m + k];
        }
        for (int c = 0; c < work->n_touching[b]; c++) {
            const int k = work->touching[(size_t)b * (n_in + m) + (size_t)c] - (int)n_in;
            if (k < 0)
                continue;
            work->joint[b * (int)m + k] = work->n_joints;
            work->coef[work->n_joints++] = k;
        }
    }
}

/* One block's pencil and columns into `pencil` and `columns`, and what its columns are into `beside`. */
static void reduce(const bd_model *model, const bd_harmonic_data *data, bd_harmonic_work *work,
                   int b, double *pencil, double *columns, int *beside)
{
    const bd_block *block = &model->blocks[b];
    const bd_matrices of = bd_matrices_of(model, block);
    const size_t n = (size_t)block->n, m = (size_t)model->n_coefs, whole = (size_t)model->n;
    const size_t n_in = (size_t)data->n_in, n_out = (size_t)data->n_out,
                 first = (size_t)block->first;
    bd_receptance *reduced = &work->reduced[b];
    int order[LARGEST];
    order_pivots(model, work, block, order);
    *reduced = (bd_receptance){
        .n = block->n,
        .n_layers = block->n_layers,
        .symmetric = all_symmetric(&of, n, data->speed),
        .pencil = pencil,
        .beside = columns,
    };
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const size_t ij = (size_t)order[i] * n + (size_t)order[j];
            *pencil++ = of.K[ij] + data->speed * of.N[ij] + work->held[block->matrix + ij];
            *pencil++ = of.M[ij];
            *pencil++ = of.C[ij] + data->speed * of.G[ij];
            for (int l = block->layer; l < block->layer + block->n_layers; l++)
                *pencil++ = work->HL[work->HL_at[l] + ij];
        }

    const int *touching = work->touching + (size_t)b * (n_in + m);
    int count = 0;
    /* what is both row and column stands between the rows and the forces: coefficients, and rows with a twin */
    for (int both = 0; both < 2; both++) {
        for (size_t o = 0; o < n_out; o++)
            if (work->read[(size_t)b * n_out + o] &&
                both == (reduced->symmetric && work->twin[o] >= 0))
                beside[count++] = (int)o;
        if (!both)
            reduced->first_right = count;
    }
    for (int c = 0; c < work->n_touching[b]; c++)
        if (touching[c] >= (int)n_in)
            beside[count++] = (int)n_out + touching[c] - (int)n_in;
    reduced->n_left = count;
    for (int c = 0; c < work->n_touching[b]; c++)
        if (touching[c] < (int)n_in && !(reduced->symmetric && work->paired[touching[c]]))
            beside[count++] = (int)(n_out + m) + touching[c];
    reduced->n_beside = count;
    for (size_t i = 0; i < n; i++)
        for (int c = 0; c < count; c++) {
            const size_t at = first + (size_t)order[i], which = (size_t)beside[c];
            *columns++ = which < n_out       ? work->row[which * whole + at]
                         : which < n_out + m ? work->B[at * m + which - n_out]
                                             : work->force[(which - n_out - m) * whole + at];
        }
}

/* Room for what the joints do to one another. Returned: whether there was memory. */
static bool join_room(const bd_model *model, const bd_harmonic_data *data, bd_harmonic_work *work)
{
    const size_t lanes = (size_t)work->kernels->width, joints = (size_t)work->n_joints;
    const size_t m = (size_t)model->n_coefs, n_out = (size_t)data->n_out;
    const size_t first = (size_t)BD_PADDED(work->n_joints);
    const size_t width = first + (size_t)BD_PADDED(data->n_in), size = 2 * width;
    work->y = zeroed(lanes * joints * size, sizeof *work->y);
    work->x = zeroed(lanes * n_out * size, sizeof *work->x);
    work->join_memory = zeroed((2 * m + joints) * size, sizeof *work->join_memory);
    work->joints = (bd_joints){
        .n_joints = work->n_joints,
        .n_out = data->n_out,
        .n_coefs = model->n_coefs,
        .first = first,
        .width = width,
        .coef = work->coef,
        .Z = (const double *)work->Z,
        .S = work->S,
        .memory = work->join_memory,
    };
    return work->y && work->x && work->join_memory;
}

/* Returned: whether there was memory. */
static bool reduce_blocks(const bd_model *model, const bd_harmonic_data *data,
                          bd_harmonic_work *work)
{
    const size_t all = (size_t)data->n_out + (size_t)model->n_coefs + (size_t)data->n_in;
    size_t squares = 0, rows = 0, room = 0, widest = 0, layers = 0;
    for (int b = 0; b < model->n_blocks; b++) {
        const bd_block *block = &model->blocks[b];
        size_t n = (size_t)block->n, outputs = 0, beside = (size_t)work->n_touching[b];
        for (int o = 0; o < data->n_out; o++)
            outputs += work->read[(size_t)b * (size_t)data->n_out + (size_t)o];
        /* many outputs cost less by the motion of all coordinates */
        if (n > LARGEST || outputs > n)
            continue;
        beside += outputs;
        work->reduced[b].n = block->n;
        squares += n * n * (3 + (size_t)block->n_layers);
        rows += n * beside;
        room = n * (n + beside) > room ? n * (n + beside) : room;
        widest = beside > widest ? beside : widest;
        layers = (size_t)block->n_layers > layers ? (size_t)block->n_layers : layers;
    }
    const size_t width = (size_t)work->kernels->width;
    work->beside = zeroed((size_t)model->n_blocks * all, sizeof *work->beside);
    work->pencil = zeroed(squares, sizeof *work->pencil);
    work->columns = zeroed(rows, sizeof *work->columns);
    work->omega = zeroed(width, sizeof *work->omega);
    work->moduli = zeroed(2 * width * layers, sizeof *work->moduli);
    work->memory = zeroed(4 * width * room, sizeof *work->memory);
    work->response = zeroed(2 * width * widest * widest, sizeof *work->response);
    work->growth = zeroed(width, sizeof *work->growth);
    if (!work->beside || !work->pencil || !work->columns || !work->omega || !work->moduli ||
        !work->memory || !work->response || !work->growth)
        return false;
    double *pencil = work->pencil, *columns = work->columns;
    for (int b = 0; b < model->n_blocks; b++) {
        const size_t n = (size_t)work->reduced[b].n;
        if (n == 0)
            continue;
        reduce(model, data, work, b, pencil, columns, work->beside + (size_t)b * all);
        pencil += n * n * (3 + (size_t)work->reduced[b].n_layers);
        columns += n * (size_t)work->reduced[b].n_beside;
    }
    return true;
}

/* ---------------------------------------------------------------- all of it */

/* Whether a row (n) is a column of a matrix of m columns. */
static bool is_column(size_t n, size_t m, const double *row, const double *column)
{
    for (size_t i = 0; i < n; i++)
        if (row[i] != column[i * m])
            return false;
    return true;
}

bd_harmonic_work *bd_harmonic_work_create(const bd_model *model, const bd_harmonic_data *data)
{
    const size_t n = (size_t)model->n, m = (size_t)model->n_coefs;
    const size_t n_in = (size_t)data->n_in, n_out = (size_t)data->n_out, columns = n_in + m;
    size_t layers = 0, squares = 0;
    for (int b = 0; b < model->n_blocks; b++)
        squares += (size_t)model->blocks[b].n * (size_t)model->blocks[b].n;
    for (int l = 0; l < model->n_layers; l++) {
        size_t rows = (size_t)model->blocks[model->layers[l].block].n;
        layers += rows * rows;
    }
    bd_harmonic_work *work = calloc(1, sizeof *work);
    if (!work)
        return NULL;
    work->kernels = bd_kernels_for(data->isa);
    if (!work->kernels)
        work->kernels = bd_kernels_for(BD_ISA_BEST);
    work->reduced = zeroed((size_t)model->n_blocks, sizeof *work->reduced);
    work->HL = zeroed(layers, sizeof *work->HL);
    work->HL_at = zeroed((size_t)model->n_layers, sizeof *work->HL_at);
    work->force = zeroed(n_in * n, sizeof *work->force);
    work->row = zeroed(n_out * n, sizeof *work->row);
    work->B = zeroed(n * m, sizeof *work->B);
    work->Kb = zeroed(m * m, sizeof *work->Kb);
    work->Cb = zeroed(m * m, sizeof *work->Cb);
    work->D = zeroed(n * n, sizeof *work->D);
    work->X = zeroed(n * columns, sizeof *work->X);
    const size_t joints = (size_t)model->n_blocks * m; /* at most */
    work->S = zeroed(m, sizeof *work->S);
    work->held = zeroed(squares, sizeof *work->held);
    work->joint = zeroed(joints, sizeof *work->joint);
    work->coef = zeroed(joints, sizeof *work->coef);
    work->Z = zeroed(m * m, sizeof *work->Z);
    work->pivots = zeroed(n + joints, sizeof *work->pivots);
    work->touching = zeroed((size_t)model->n_blocks * columns, sizeof *work->touching);
    work->n_touching = zeroed((size_t)model->n_blocks, sizeof *work->n_touching);
    work->read = zeroed((size_t)model->n_blocks * n_out, sizeof *work->read);
    work->told = zeroed(n_out, sizeof *work->told);
    work->twin = zeroed(n_out, sizeof *work->twin);
    work->paired = zeroed(n_in, sizeof *work->paired);
    if (!work->reduced || !work->HL || !work->HL_at || !work->force || !work->row || !work->B ||
        !work->Kb || !work->Cb || !work->S || !work->held || !work->joint || !work->coef ||
        !work->D || !work->X || !work->Z || !work->pivots || !work->touching || !work->n_touching ||
        !work->read || !work->told || !work->twin || !work->paired) {
        bd_harmonic_work_free(work);
        return NULL;
    }

    size_t at = 0;
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        const size_t rows = (size_t)model->blocks[layer->block].n, stride = (size_t)layer->padded;
        work->HL_at[l] = at;
        for (size_t i = 0; i < rows; i++)
            for (size_t j = 0; j < rows; j++) {
                double dot = 0.0;
                for (int r = 0; r < layer->rank; r++)
                    dot += layer->L[i * stride + (size_t)r] * layer->L[j * stride + (size_t)r];
                work->HL[at++] = 2.0 * dot;
            }
    }
    for (size_t i = 0; i < n; i++) {
        const size_t from = (size_t)model->order[i], padded = (size_t)model->slot[from];
        for (size_t k = 0; k < n_in; k++)
            work->force[k * n + i] = data->force[k * n + from];
        for (size_t k = 0; k < n_out; k++)
            work->row[k * n + i] = data->row[k * n + from];
        for (size_t k = 0; k < m; k++)
            work->B[i * m + k] =
                model->B[padded * (size_t)model->coefs + (size_t)model->coef_slot[k]];
    }
    for (size_t o = 0; o < n_out; o++) {
        work->told[o] = -1;
        for (size_t k = 0; k < m && work->told[o] < 0; k++)
            if (is_column(n, m, work->row + o * n, work->B + k))
                work->told[o] = (int)k;
    }
    for (int b = 0; b < model->n_blocks; b++) {
        const size_t first = (size_t)model->blocks[b].first, rows = (size_t)model->blocks[b].n;
        for (size_t c = 0; c < columns; c++) {
            bool acts = false;
            for (size_t i = first; i < first + rows && !acts; i++)
                acts = (c < n_in ? work->force[c * n + i] : work->B[i * m + c - n_in]) != 0.0;
            if (acts)
                work->touching[(size_t)b * columns + (size_t)work->n_touching[b]++] = (int)c;
        }
        for (size_t o = 0; o < n_out; o++)
            for (size_t i = first; i < first + rows; i++)
                if (work->told[o] < 0 && work->row[o * n + i] != 0.0)
                    work->read[(size_t)b * n_out + o] = true;
    }
    for (size_t o = 0; o < n_out; o++) {
        work->twin[o] = -1;
        for (size_t k = 0; k < n_in && work->twin[o] < 0 && work->told[o] < 0; k++)
            if (!work->paired[k] &&
                memcmp(work->row + o * n, work->force + k * n, n * sizeof *work->row) == 0) {
                work->twin[o] = (int)k;
                work->paired[k] = true;
            }
    }
    memcpy(work->Kb, data->bearing_K, m * m * sizeof *work->Kb);
    memcpy(work->Cb, data->bearing_C, m * m * sizeof *work->Cb);
    hold_blocks(model, data, work);
    if (!join_room(model, data, work) || !reduce_blocks(model, data, work)) {
        bd_harmonic_work_free(work);
        return NULL;
    }
    return work;
}

void bd_harmonic_work_free(bd_harmonic_work *work)
{
    if (!work)
        return;
    void *pieces[] = {
        work->HL,          work->HL_at,      work->force,  work->row,     work->B,     work->Kb,
        work->Cb,          work->D,          work->X,      work->y,       work->Z,     work->x,
        work->join_memory, work->pivots,     work->S,      work->held,    work->joint, work->coef,
        work->touching,    work->n_touching, work->read,   work->told,    work->twin,  work->paired,
        work->reduced,     work->beside,     work->pencil, work->columns, work->omega, work->moduli,
        work->memory,      work->response,   work->growth};
    for (size_t i = 0; i < sizeof pieces / sizeof pieces[0]; i++)
        free(pieces[i]);
    free(work);
}
