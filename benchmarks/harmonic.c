/* The bare loop of a harmonic response with low rank: what its arithmetic alone costs, one frequency after another.
 * Built, fed and run by harmonic.py.
 *
 * Blocks in their own modes, with diagonal damping: D^-1 = diag(1/(w^2 - omega^2 + i omega c)). Layers and bearings
 * join through the few columns they act on (Woodbury), the layers inside a block, then the bearings across blocks.
 *
 * in:  doubles in native order from the file of argv[1]:
 *      n_omega, n_blocks, m, n_in, n_out; omega; Z's K_b and C_b (m x m);
 *      per block n, rank, columns; which of the m + n_out + n_in they are, behind the layer's rank (columns);
 *      w^2 (n), c (n); per frequency the layer's G* (2); U (n x columns)
 * out: one line, the least seconds of one pass; the response, complex (n_omega x n_out x n_in), to argv[2] */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef double complex cplx;

enum { PASSES = 20, MOST = 64 };

typedef struct block {
    int n, rank, columns, which[MOST]; /* the columns that act on it, and their places in T */
    const double *square, *damping, *modulus, *U;
} block;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double size(cplx z)
{
    return fabs(creal(z)) + fabs(cimag(z));
}

/* A X = B by elimination with row exchange; A (n x n), B (n x columns), rows of `stride`. */
static void solve(int n, int columns, int stride, cplx *A, cplx *B)
{
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++)
            if (size(A[i * stride + k]) > size(A[pivot * stride + k]))
                pivot = i;
        for (int j = 0; pivot != k && j < n; j++) {
            const cplx t = A[k * stride + j];
            A[k * stride + j] = A[pivot * stride + j];
            A[pivot * stride + j] = t;
        }
        for (int j = 0; pivot != k && j < columns; j++) {
            const cplx t = B[k * stride + j];
            B[k * stride + j] = B[pivot * stride + j];
            B[pivot * stride + j] = t;
        }
        const cplx over = 1.0 / A[k * stride + k];
        for (int i = k + 1; i < n; i++) {
            const cplx l = A[i * stride + k] * over;
            for (int j = k + 1; j < n; j++)
                A[i * stride + j] -= l * A[k * stride + j];
            for (int j = 0; j < columns; j++)
                B[i * stride + j] -= l * B[k * stride + j];
        }
    }
    for (int k = n - 1; k >= 0; k--)
        for (int j = 0; j < columns; j++) {
            for (int i = k + 1; i < n; i++)
                B[k * stride + j] -= A[k * stride + i] * B[i * stride + j];
            B[k * stride + j] /= A[k * stride + k];
        }
}

/* T += U^T D^-1 U of one block with its layer, over its columns behind the layer's. */
static void receptance(const block *b, int index, double omega, cplx T[MOST][MOST])
{
    const int rank = b->rank, columns = b->columns;
    static cplx R[MOST][MOST], A[MOST][MOST], B[MOST][MOST];
    memset(R, 0, sizeof R);
    for (int k = 0; k < b->n; k++) {
        const double *u = b->U + k * columns;
        const cplx d = 1.0 / (b->square[k] - omega * omega + I * omega * b->damping[k]);
        for (int p = 0; p < columns; p++) {
            const double re = u[p] * creal(d), im = u[p] * cimag(d);
            for (int q = p; q < columns; q++)
                R[p][q] += re * u[q] + I * (im * u[q]);
        }
    }
    for (int p = 0; p < columns; p++)
        for (int q = 0; q < p; q++)
            R[p][q] = R[q][p];
    if (rank > 0) {
        const cplx G = 2.0 * (b->modulus[2 * index] + I * b->modulus[2 * index + 1]);
        for (int p = 0; p < rank; p++) {
            memcpy(A[p], R[p], (size_t)rank * sizeof(cplx));
            A[p][p] += 1.0 / G;
            memcpy(B[p], R[p] + rank, (size_t)(columns - rank) * sizeof(cplx));
        }
        solve(rank, columns - rank, MOST, A[0], B[0]);
        for (int p = rank; p < columns; p++)
            for (int k = 0; k < rank; k++)
                for (int q = rank; q < columns; q++)
                    R[p][q] -= R[p][k] * B[k][q - rank];
    }
    for (int p = rank; p < columns; p++)
        for (int q = rank; q < columns; q++)
            T[b->which[p]][b->which[q]] += R[p][q];
}

/* All frequencies once. */
static void pass(const block *blocks, int n_blocks, int n_omega, int m, int n_out, int n_in,
                 const double *omega, const double *K, const double *C, cplx *response)
{
    static cplx T[MOST][MOST], A[MOST][MOST], g[MOST][MOST];
    for (int f = 0; f < n_omega; f++) {
        memset(T, 0, sizeof T);
        for (int b = 0; b < n_blocks; b++)
            receptance(&blocks[b], f, omega[f], T);
        for (int p = 0; p < m; p++) {
            for (int q = 0; q < m; q++) {
                cplx sum = p == q;
                for (int k = 0; k < m; k++)
                    sum += (K[p * m + k] + I * omega[f] * C[p * m + k]) * T[k][q];
                A[p][q] = sum;
            }
            for (int q = 0; q < n_in; q++) {
                cplx sum = 0.0;
                for (int k = 0; k < m; k++)
                    sum += (K[p * m + k] + I * omega[f] * C[p * m + k]) * T[k][m + n_out + q];
                g[p][q] = sum;
            }
        }
        solve(m, n_in, MOST, A[0], g[0]);
        for (int o = 0; o < n_out; o++)
            for (int q = 0; q < n_in; q++) {
                cplx sum = T[m + o][m + n_out + q];
                for (int k = 0; k < m; k++)
                    sum -= T[m + o][k] * g[k][q];
                *response++ = sum;
            }
    }
}

int main(int argc, char **argv)
{
    FILE *file = argc == 3 ? fopen(argv[1], "rb") : NULL;
    if (!file)
        return 1;
    fseek(file, 0, SEEK_END);
    const size_t count = (size_t)ftell(file) / sizeof(double);
    rewind(file);
    double *data = malloc(count * sizeof *data);
    if (!data || fread(data, sizeof *data, count, file) != count)
        return 1;
    fclose(file);

    const double *at = data;
    const int n_omega = (int)*at++, n_blocks = (int)*at++, m = (int)*at++;
    const int n_in = (int)*at++, n_out = (int)*at++;
    const double *omega = at, *K = omega + n_omega, *C = K + m * m;
    at = C + m * m;
    block *blocks = malloc((size_t)n_blocks * sizeof *blocks);
    cplx *response = malloc((size_t)(n_omega * n_in * n_out) * sizeof *response);
    if (!blocks || !response)
        return 1;
    for (int b = 0; b < n_blocks; b++) {
        block *own = &blocks[b];
        own->n = (int)*at++;
        own->rank = (int)*at++;
        own->columns = (int)*at++;
        if (own->columns > MOST || m + n_out + n_in > MOST)
            return 1;
        for (int c = 0; c < own->columns; c++)
            own->which[c] = (int)*at++;
        own->square = at;
        own->damping = own->square + own->n;
        own->modulus = own->damping + own->n;
        own->U = own->modulus + 2 * n_omega;
        at = own->U + own->n * own->columns;
    }

    double best = 1e300;
    for (int p = 0; p < PASSES; p++) {
        const double began = now();
        pass(blocks, n_blocks, n_omega, m, n_out, n_in, omega, K, C, response);
        const double took = now() - began;
        best = took < best ? took : best;
    }
    printf("%.9g\n", best);
    file = fopen(argv[2], "wb");
    if (!file || fwrite(response, sizeof *response, (size_t)(n_omega * n_in * n_out), file) == 0)
        return 1;
    return fclose(file);
}
