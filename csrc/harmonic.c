/* The complex response over many frequencies.
 *
 * D(omega) = K + speed N - omega^2 M + i omega (C + speed G) + sum_l 2 G*_l(omega) L_l L_l^T is block-diagonal; the
 * linearised bearings join the blocks through a few coefficients y = B x alone:
 *     (D + B^T Z B) x = F,   Z = K_b + i omega C_b + balls.
 * Each block b is held by springs S at the coefficients that it sees, D' = D + B_b^T S B_b, and joined to the others
 * by what they lack, h_b = Z sum_c y_c - S y_b, with y_b = B_b x:
 *     x = X_F - sum_b X_b h_b,   (I + P Y) h = P Y_F,   X_F = D'^-1 F,  X_b = D'^-1 B_b^T,
 * Y and Y_F the motions y of all joints under unit forces at them and under F, P v = Z sum_c v_c - S v_b. */
#include "harmonic.h"

#include <math.h>
#include <string.h>

#include "kernels.h"

/* D of one block, with `held` (n x n or NULL), into the top left of a column-major matrix of `stride` rows, at
 * (place, place). */
static void form(const bd_model *model, const bd_harmonic_data *data, const bd_harmonic_work *work,
                 const bd_block *block, const double *held, int index, size_t stride, size_t place,
                 complex_t *D)
{
    const size_t n = (size_t)block->n;
    const double omega = data->omega[index];
    const bd_matrices of = bd_matrices_of(model, block);

    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++) {
            const size_t ij = i * n + j;
            double re = of.K[ij] + data->speed * of.N[ij] - omega * omega * of.M[ij];
            if (held)
                re += held[ij];
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
        form(model, data, work, &model->blocks[b], NULL, index, n, (size_t)model->blocks[b].first,
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

/* The column of a force or, behind the forces, of one at a coefficient of a block. */
static size_t column_of(const bd_model *model, const bd_harmonic_data *data,
                        const bd_harmonic_work *work, int b, size_t which)
{
    const size_t n_in = (size_t)data->n_in, m = (size_t)model->n_coefs;
    return which < n_in ? work->joints.first + which
                        : (size_t)work->joint[(size_t)b * m + which - n_in];
}

/* The row of a lane's motions in which output or, behind the outputs, the joint of a block is told. */
static double *row_of(const bd_model *model, const bd_harmonic_data *data,
                      const bd_harmonic_work *work, int b, size_t which, size_t lane)
{
    const size_t n_out = (size_t)data->n_out, m = (size_t)model->n_coefs;
    const size_t size = 2 * work->joints.width, joints = (size_t)work->n_joints;
    return which < n_out
               ? work->x + (lane * n_out + which) * size
               : work->y +
                     (lane * joints + (size_t)work->joint[(size_t)b * m + which - n_out]) * size;
}

/* X_F and X_b of one block, added to the motions of joints and rows. */
static int solve_block(const bd_model *model, const bd_harmonic_data *data, const bd_lapack *lapack,
                       bd_harmonic_work *work, int b, int index, size_t lane)
{
    const bd_block *block = &model->blocks[b];
    const size_t n = (size_t)block->n, m = (size_t)model->n_coefs, whole = (size_t)model->n;
    const size_t first = (size_t)block->first, n_in = (size_t)data->n_in,
                 n_out = (size_t)data->n_out;
    const int *touching = work->touching + (size_t)b * (n_in + m);
    const size_t columns = (size_t)work->n_touching[b];
    const size_t width = work->joints.width;

    form(model, data, work, block, work->held + block->matrix, index, n, 0, work->D);
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
        const size_t which = column_of(model, data, work, b, (size_t)touching[c]);
        const complex_t *X = work->X + c * n;
        for (size_t k = 0; k < m; k++) {
            const int joint = work->joint[(size_t)b * m + k];
            double re = 0.0, im = 0.0;
            for (size_t i = 0; joint >= 0 && i < n; i++) {
                re += work->B[(first + i) * m + k] * creal(X[i]);
                im += work->B[(first + i) * m + k] * cimag(X[i]);
            }
            if (joint < 0)
                continue;
            double *y = row_of(model, data, work, b, n_out + k, lane) + which;
            y[0] += re;
            y[width] += im;
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
            double *x = row_of(model, data, work, b, o, lane) + which;
            x[0] += re;
            x[width] += im;
        }
    }
    return 0;
}

/* Beyond this the fixed order of pivots has cost a digit or two, and a block is solved with rows exchanged: squared,
 * as growth is counted. */
static const double largest_growth = 1e4;

/* X_F and X_b of one block at all frequencies of a batch. Those that failed leave their lane of `whole` set. */
static void solve_lanes(const bd_model *model, const bd_harmonic_data *data,
                        const bd_lapack *lapack, bd_harmonic_work *work, int b, int first,
                        int count, bool *whole)
{
    const bd_block *block = &model->blocks[b];
    const bd_receptance *reduced = &work->reduced[b];
    const size_t m = (size_t)model->n_coefs, n_in = (size_t)data->n_in, n_out = (size_t)data->n_out,
                 width = (size_t)work->kernels->width;
    const int *beside = work->beside + (size_t)b * (n_out + m + n_in);

    if (reduced->n > 0) {
        for (int l = 0; l < block->n_layers; l++) {
            const size_t source = (size_t)model->layers[block->layer + l].source;
            double *moduli = work->moduli + 2 * width * (size_t)l;
            for (size_t lane = 0; lane < width; lane++) {
                const size_t index = (size_t)first + (lane < (size_t)count ? lane : 0);
                const double *modulus =
                    data->modulus + 2 * (index * (size_t)model->n_layers + source);
                moduli[lane] = modulus[0];
                moduli[width + lane] = modulus[1];
            }
        }
        work->kernels->receptance(reduced, work->omega, work->moduli, work->memory, work->response,
                                  work->growth);
    }
    for (size_t lane = 0; lane < (size_t)count; lane++) {
        if (whole[lane])
            continue;
        if (reduced->n == 0 || !(work->growth[lane] <= largest_growth)) {
            whole[lane] = solve_block(model, data, lapack, work, b, first + (int)lane, lane) != 0;
            continue;
        }
        const double *response = work->response + lane;
        for (int p = 0; p < reduced->n_left; p++) {
            double *row = row_of(model, data, work, b, (size_t)beside[p], lane);
            for (int q = reduced->first_right; q < reduced->n_beside; q++, response += 2 * width) {
                const size_t from = (size_t)beside[q];
                const size_t which = from < n_out ? work->joints.first + (size_t)work->twin[from]
                                     : from < n_out + m
                                         ? column_of(model, data, work, b, n_in + from - n_out)
                                         : work->joints.first + from - n_out - m;
                row[which] += response[0];
                row[work->joints.width + which] += response[width];
            }
        }
    }
}

/* The motions of a lane's coefficients, where outputs are such, from those of their joints. */
static void tell_coefficients(const bd_harmonic_work *work, size_t n_out, size_t lane)
{
    const size_t size = 2 * work->joints.width, joints = (size_t)work->n_joints;
    for (size_t o = 0; o < n_out; o++)
        for (size_t j = 0; j < joints; j++) {
            if (work->coef[j] != work->told[o])
                continue;
            const double *y = work->y + (lane * joints + j) * size;
            double *x = work->x + (lane * n_out + o) * size;
            for (size_t i = 0; i < size; i++)
                x[i] += y[i];
        }
}

/* One frequency's response from its lane, or from the solution of all coordinates as one. */
static bd_status write_response(const bd_model *model, const bd_harmonic_data *data,
                                const bd_harmonic_work *work, const double *x, double *out)
{
    const size_t n = (size_t)model->n, n_in = (size_t)data->n_in, n_out = (size_t)data->n_out;
    for (size_t o = 0; o < n_out; o++) {
        const double *row = x ? x + 2 * work->joints.width * o + work->joints.first : NULL;
        for (size_t c = 0; c < n_in; c++) {
            complex_t value = 0.0;
            if (!x)
                for (size_t i = 0; i < n; i++)
                    value += work->row[o * n + i] * work->X[c * n + i];
            else
                value = complex_of(row[c], row[work->joints.width + c]);
            if (!isfinite(creal(value)) || !isfinite(cimag(value)))
                return BD_NOT_FINITE;
            out[2 * (o * n_in + c)] = creal(value);
            out[2 * (o * n_in + c) + 1] = cimag(value);
        }
    }
    return BD_OK;
}

/* Adds the balls that answer by frequency, sum of ball v v^T, to Z (m x m). */
static void add_balls(const bd_harmonic_data *data, int index, size_t m, complex_t *Z)
{
    for (size_t b = 0; b < (size_t)data->n_balls; b++) {
        const double *ball = data->ball + 2 * ((size_t)index * (size_t)data->n_balls + b);
        const double *v = data->across + b * m;
        for (size_t kl = 0; kl < m * m; kl++) {
            const double both = v[kl / m] * v[kl % m];
            Z[kl] += complex_of(ball[0] * both, ball[1] * both);
        }
    }
}

bd_status bd_harmonic(const bd_model *model, const bd_harmonic_data *data, const bd_lapack *lapack,
                      bd_harmonic_work *work, int first, int count, double *response)
{
    const size_t m = (size_t)model->n_coefs, n_in = (size_t)data->n_in, n_out = (size_t)data->n_out;
    const int width = work->kernels->width;
    const size_t lanes = (size_t)width, size = 2 * work->joints.width;
    const size_t of_joints = (size_t)work->n_joints * size, of_outputs = n_out * size;

    for (int from = first; from < first + count; from += width) {
        const int now = first + count - from < width ? first + count - from : width;
        bool whole[BD_LANES];
        for (int lane = 0; lane < width; lane++) {
            work->omega[lane] = data->omega[from + (lane < now ? lane : 0)];
            /* at rest a block that floats is singular by itself, though held by its bearings */
            whole[lane] = work->omega[lane] == 0.0;
        }
        memset(work->y, 0, lanes * of_joints * sizeof *work->y);
        memset(work->x, 0, lanes * of_outputs * sizeof *work->x);
        for (int b = 0; b < model->n_blocks; b++)
            solve_lanes(model, data, lapack, work, b, from, now, whole);

        for (int lane = 0; lane < now; lane++) {
            double *x = work->x + (size_t)lane * of_outputs;
            for (size_t kl = 0; kl < m * m; kl++)
                work->Z[kl] = complex_of(work->Kb[kl], work->omega[lane] * work->Cb[kl]);
            add_balls(data, from + lane, m, work->Z);
            tell_coefficients(work, n_out, (size_t)lane);
            work->joints.y = work->y + (size_t)lane * of_joints;
            work->joints.x = x;
            if (whole[lane] || work->kernels->join(&work->joints)) {
                if (solve_whole(model, data, lapack, work, from + lane))
                    return BD_SINGULAR_DYNAMIC;
                x = NULL;
            }
            const bd_status status = write_response(
                model, data, work, x, response + 2 * (size_t)(from + lane) * n_out * n_in);
            if (status != BD_OK)
                return status;
        }
    }
    return BD_OK;
}
