/* The complex response over many frequencies.
 *
 * D(omega) = K + speed N - omega^2 M + i omega (C + speed G) + sum_l 2 G*_l(omega) L_l L_l^T is block-diagonal; the
 * linearised bearings join the blocks through a few coefficients y = B x alone:
 *     x = X_F - X_B g,   (I + Z B X_B) g = Z B X_F,   X_F = D^-1 F,  X_B = D^-1 B^T,  Z = K_b + i omega C_b.
 * A 3-block motor of 80 coordinates is solved three times faster so than as one. */
#include <complex.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"

typedef double complex complex_t;

/* CMPLX, which older C libraries lack under Clang. */
static inline complex_t complex_of(double re, double im)
{
    union {
        double part[2];
        complex_t value;
    } pair = {{re, im}};
    return pair.value;
}

struct bd_harmonic_work {
    double *HL;           /* per layer its block's n x n matrix 2 L L^T */
    size_t *HL_at;        /* (n_layers) */
    double *force, *row;  /* (n_in x n), (n_out x n) in block order, without padding */
    double *B;            /* (n x n_coefs) in block order */
    double *Kb, *Cb;      /* (n_coefs x n_coefs) as given */
    complex_t *D, *X;     /* one block's matrix; (n x (n_in + n_coefs)) solutions, column-major */
    complex_t *BX;        /* (n_coefs x (n_in + n_coefs)) */
    complex_t *Z, *A, *g; /* (n_coefs^2), (n_coefs^2), (n_coefs x n_in) */
    complex_t *RX;        /* (n_out x (n_in + n_coefs)) */
    int *pivots;
    int *touching,
        *n_touching; /* per block: which forces (0 ... n_in) and coefficients (n_in ...) act */
    bool *read;      /* (n_blocks x n_out) whether a row reads a block's motion */
};

static void *zeroed(size_t count, size_t size)
{
    return calloc(count + 1, size);
}

bd_harmonic_work *bd_harmonic_work_create(const bd_model *model, const bd_harmonic_data *data)
{
    const size_t n = (size_t)model->n, m = (size_t)model->n_coefs;
    const size_t n_in = (size_t)data->n_in, n_out = (size_t)data->n_out, columns = n_in + m;
    size_t layers = 0;
    for (int l = 0; l < model->n_layers; l++) {
        size_t rows = (size_t)model->blocks[model->layers[l].block].n;
        layers += rows * rows;
    }
    bd_harmonic_work *work = calloc(1, sizeof *work);
    if (!work)
        return NULL;
    work->HL = zeroed(layers, sizeof *work->HL);
    work->HL_at = zeroed((size_t)model->n_layers, sizeof *work->HL_at);
    work->force = zeroed(n_in * n, sizeof *work->force);
    work->row = zeroed(n_out * n, sizeof *work->row);
    work->B = zeroed(n * m, sizeof *work->B);
    work->Kb = zeroed(m * m, sizeof *work->Kb);
    work->Cb = zeroed(m * m, sizeof *work->Cb);
    work->D = zeroed(n * n, sizeof *work->D);
    work->X = zeroed(n * columns, sizeof *work->X);
    work->BX = zeroed(m * columns, sizeof *work->BX);
    work->Z = zeroed(m * m, sizeof *work->Z);
    work->A = zeroed(m * m, sizeof *work->A);
    work->g = zeroed(m * n_in, sizeof *work->g);
    work->RX = zeroed(n_out * columns, sizeof *work->RX);
    work->pivots = zeroed(n + m, sizeof *work->pivots);
    work->touching = zeroed((size_t)model->n_blocks * columns, sizeof *work->touching);
    work->n_touching = zeroed((size_t)model->n_blocks, sizeof *work->n_touching);
    work->read = zeroed((size_t)model->n_blocks * n_out, sizeof *work->read);
    if (!work->HL || !work->HL_at || !work->force || !work->row || !work->B || !work->Kb ||
        !work->Cb || !work->D || !work->X || !work->BX || !work->Z || !work->A || !work->g ||
        !work->RX || !work->pivots || !work->touching || !work->n_touching || !work->read) {
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
                if (work->row[o * n + i] != 0.0)
                    work->read[(size_t)b * n_out + o] = true;
    }
    memcpy(work->Kb, data->bearing_K, m * m * sizeof *work->Kb);
    memcpy(work->Cb, data->bearing_C, m * m * sizeof *work->Cb);
    return work;
}

void bd_harmonic_work_free(bd_harmonic_work *work)
{
    if (!work)
        return;
    void *pieces[] = {work->HL,       work->HL_at,      work->force, work->row, work->B,
                      work->Kb,       work->Cb,         work->D,     work->X,   work->BX,
                      work->Z,        work->A,          work->g,     work->RX,  work->pivots,
                      work->touching, work->n_touching, work->read};
    for (size_t i = 0; i < sizeof pieces / sizeof pieces[0]; i++)
        free(pieces[i]);
    free(work);
}

/* D of one block into the top left of a column-major matrix of `stride` rows, at (place, place). */
static void form(const bd_model *model, const bd_harmonic_data *data, const bd_harmonic_work *work,
                 const bd_block *block, int index, size_t stride, size_t place, complex_t *D)
{
    const size_t n = (size_t)block->n;
    const double omega = data->omega[index];
    const bd_matrices of = bd_matrices_of(model, block);

    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++) {
            const size_t ij = i * n + j;
            double re = of.K[ij] + data->speed * of.N[ij] - omega * omega * of.M[ij];
            double im = omega * (of.C[ij] + data->speed * of.G[ij]);
            D[(place + j) * stride + place + i] = complex_of(re, im);
        }
    for (int l = block->layer; l < block->layer + block->n_layers; l++) {
        const double *modulus = data->modulus + 2 * ((size_t)index * (size_t)model->n_layers +
                                                     (size_t)model->layers[l].source);
        const double re = modulus[0], im = modulus[1];
        const double *H = work->HL + work->HL_at[l];
        for (size_t j = 0; j < n; j++)
            for (size_t i = 0; i < n; i++)
                D[(place + j) * stride + place + i] +=
                    complex_of(re * H[i * n + j], im * H[i * n + j]);
    }
}

/* All coordinates and bearings as one system: D + B^T Z B. */
static int solve_whole(const bd_model *model, const bd_harmonic_data *data, const bd_lapack *lapack,
                       bd_harmonic_work *work, int index)
{
    const size_t n = (size_t)model->n, m = (size_t)model->n_coefs;
    memset(work->D, 0, n * n * sizeof *work->D);
    for (int b = 0; b < model->n_blocks; b++)
        form(model, data, work, &model->blocks[b], index, n, (size_t)model->blocks[b].first,
             work->D);
    for (size_t k = 0; k < m; k++)
        for (size_t l = 0; l < m; l++) {
            const complex_t Z = work->Z[k * m + l];
            if (Z == 0.0)
                continue;
            for (size_t j = 0; j < n; j++)
                for (size_t i = 0; i < n; i++)
                    work->D[j * n + i] += work->B[i * m + k] * Z * work->B[j * m + l];
        }
    for (int k = 0; k < data->n_in; k++)
        for (size_t i = 0; i < n; i++)
            work->X[(size_t)k * n + i] = work->force[(size_t)k * n + i];
    return bd_solve_complex(lapack, model->n, (double *)work->D, work->pivots, data->n_in,
                            (double *)work->X);
}

/* X_F and X_B of one block, added to B X and to rows . X. */
static int solve_block(const bd_model *model, const bd_harmonic_data *data, const bd_lapack *lapack,
                       bd_harmonic_work *work, int b, int index)
{
    const bd_block *block = &model->blocks[b];
    const size_t n = (size_t)block->n, m = (size_t)model->n_coefs, whole = (size_t)model->n;
    const size_t first = (size_t)block->first, n_in = (size_t)data->n_in,
                 n_out = (size_t)data->n_out;
    const int *touching = work->touching + (size_t)b * (n_in + m);
    const size_t columns = (size_t)work->n_touching[b];

    form(model, data, work, block, index, n, 0, work->D);
    for (size_t c = 0; c < columns; c++) {
        const size_t which = (size_t)touching[c];
        for (size_t i = 0; i < n; i++)
            work->X[c * n + i] = which < n_in ? work->force[which * whole + first + i]
                                              : work->B[(first + i) * m + which - n_in];
    }
    if (bd_solve_complex(lapack, block->n, (double *)work->D, work->pivots, (int)columns,
                         (double *)work->X))
        return 1;
    for (size_t c = 0; c < columns; c++) {
        const size_t which = (size_t)touching[c];
        const complex_t *X = work->X + c * n;
        for (size_t i = 0; i < n; i++) {
            const double *B = work->B + (first + i) * m;
            const double re = creal(X[i]), im = cimag(X[i]);
            for (size_t k = 0; k < m; k++)
                work->BX[which * m + k] += complex_of(B[k] * re, B[k] * im);
        }
        for (size_t o = 0; o < n_out; o++) {
            if (!work->read[(size_t)b * n_out + o])
                continue;
            const double *row = work->row + o * whole + first;
            double re = 0.0, im = 0.0;
            for (size_t i = 0; i < n; i++) {
                re += row[i] * creal(X[i]);
                im += row[i] * cimag(X[i]);
            }
            work->RX[which * n_out + o] += complex_of(re, im);
        }
    }
    return 0;
}

/* Joining the blocks cancels as many digits as I + Z B X_B is large: near a resonance of a block by itself, and
 * at low frequency where a block floats. Beyond this all is solved as one. */
static const double largest_joint = 1e6;

/* Block by block, then joined through the bearings; the answer is left in RX's first n_in columns.
 * Returned: 0, or nonzero where that would be singular or lose too many digits. */
static int solve_blocks(const bd_model *model, const bd_harmonic_data *data,
                        const bd_lapack *lapack, bd_harmonic_work *work, int index)
{
    const size_t m = (size_t)model->n_coefs, n_in = (size_t)data->n_in, n_out = (size_t)data->n_out;

    memset(work->BX, 0, m * (n_in + m) * sizeof *work->BX);
    memset(work->RX, 0, n_out * (n_in + m) * sizeof *work->RX);
    for (int b = 0; b < model->n_blocks; b++)
        if (solve_block(model, data, lapack, work, b, index))
            return 1;

    /* (I + Z B X_B) g = Z B X_F */
    double largest = 0.0;
    for (size_t c = 0; c < n_in + m; c++)
        for (size_t k = 0; k < m; k++) {
            complex_t sum = c == n_in + k ? 1.0 : 0.0;
            for (size_t l = 0; l < m; l++)
                sum += work->Z[k * m + l] * work->BX[c * m + l];
            if (c < n_in) {
                work->g[c * m + k] = sum;
            } else {
                work->A[(c - n_in) * m + k] = sum;
                largest = fmax(largest, fabs(creal(sum)) + fabs(cimag(sum)));
            }
        }
    if (!(largest <= largest_joint))
        return 1;
    if (bd_solve_complex(lapack, model->n_coefs, (double *)work->A, work->pivots, data->n_in,
                         (double *)work->g))
        return 1;
    for (size_t c = 0; c < n_in; c++)
        for (size_t k = 0; k < m; k++)
            for (size_t o = 0; o < n_out; o++)
                work->RX[c * n_out + o] -= work->RX[(n_in + k) * n_out + o] * work->g[c * m + k];
    return 0;
}

bd_status bd_harmonic(const bd_model *model, const bd_harmonic_data *data, const bd_lapack *lapack,
                      bd_harmonic_work *work, int first, int count, double *response)
{
    const size_t m = (size_t)model->n_coefs, n = (size_t)model->n;
    const size_t n_in = (size_t)data->n_in, n_out = (size_t)data->n_out;

    for (int index = first; index < first + count; index++) {
        const double omega = data->omega[index];
        double *out = response + 2 * (size_t)index * n_out * n_in;

        for (size_t kl = 0; kl < m * m; kl++)
            work->Z[kl] = complex_of(work->Kb[kl], omega * work->Cb[kl]);
        /* at rest a block that floats is singular by itself, though held by its bearings */
        bool whole = omega == 0.0 || model->n_blocks == 1;
        if (!whole)
            whole = solve_blocks(model, data, lapack, work, index) != 0;
        if (whole && solve_whole(model, data, lapack, work, index))
            return BD_SINGULAR_DYNAMIC;

        for (size_t o = 0; o < n_out; o++)
            for (size_t c = 0; c < n_in; c++) {
                complex_t value = 0.0;
                if (whole)
                    for (size_t i = 0; i < n; i++)
                        value += work->row[o * n + i] * work->X[c * n + i];
                else
                    value = work->RX[c * n_out + o];
                if (!isfinite(creal(value)) || !isfinite(cimag(value)))
                    return BD_NOT_FINITE;
                out[2 * (o * n_in + c)] = creal(value);
                out[2 * (o * n_in + c) + 1] = cimag(value);
            }
    }
    return BD_OK;
}
