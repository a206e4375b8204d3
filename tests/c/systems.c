#include "systems.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

void *pool_take(pool *p, size_t count, size_t size)
{
    void *piece = calloc(count + 1, size);
    if (!piece || p->n == (int)(sizeof p->pieces / sizeof p->pieces[0])) {
        fprintf(stderr, "the test's pool is exhausted\n");
        exit(2);
    }
    p->pieces[p->n++] = piece;
    return piece;
}

void pool_empty(pool *p)
{
    while (p->n > 0)
        free(p->pieces[--p->n]);
}

double uniform(unsigned long long *seed)
{
    /* Knuth's MMIX generator; its upper bits are good enough to fill matrices */
    *seed = *seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (double)(*seed >> 11) / 4503599627370496.0 - 1.0;
}

bd_model_data bare_system(pool *p, int n)
{
    const size_t square = (size_t)n * (size_t)n;
    return (bd_model_data){
        .n = n,
        .M = pool_take(p, square, sizeof(double)),
        .C = pool_take(p, square, sizeof(double)),
        .G = pool_take(p, square, sizeof(double)),
        .K = pool_take(p, square, sizeof(double)),
        .N = pool_take(p, square, sizeof(double)),
    };
}

double *entry(const double *matrix, int n, int i, int j)
{
    return (double *)(uintptr_t)(matrix + (size_t)i * (size_t)n + (size_t)j);
}

double *random_rotation(pool *p, int n, unsigned long long *seed)
{
    double *Q = pool_take(p, (size_t)n * (size_t)n, sizeof *Q);
    for (int i = 0; i < n; i++) {
        double *row = Q + (size_t)i * (size_t)n, norm = 0.0;
        for (int j = 0; j < n; j++)
            row[j] = uniform(seed);
        /* twice is enough for orthogonality to round-off */
        for (int pass = 0; pass < 2; pass++)
            for (int k = 0; k < i; k++) {
                double dot = 0.0;
                for (int j = 0; j < n; j++)
                    dot += row[j] * Q[(size_t)k * (size_t)n + (size_t)j];
                for (int j = 0; j < n; j++)
                    row[j] -= dot * Q[(size_t)k * (size_t)n + (size_t)j];
            }
        for (int j = 0; j < n; j++)
            norm += row[j] * row[j];
        for (int j = 0; j < n; j++)
            row[j] /= sqrt(norm);
    }
    return Q;
}

bd_bearing_data deep_groove(bd_damping_law law)
{
    static const int order[] = {1, 1, 0, 1, 1}, sine[] = {0, 1, 0, 0, 1};
    static const double table_delta[] = {-1e-6, 2e-6, 1e-5}, table_c[] = {0.0, 60.0, 25.0};
    static double film_c[BD_FILM_NODES], film_rise[BD_FILM_NODES];
    for (int i = 1; i < BD_FILM_NODES; i++) {
        const double w = (double)i / BD_FILM_CELLS;
        film_c[i] = 40.0 * w * w * (1.5 - w);
        film_rise[i] = (120.0 * w * (1.0 - w)) / BD_FILM_CELLS;
    }
    static double carried_b[BD_FILM_NODES], carried_rise[BD_FILM_NODES];
    for (int i = 1; i < BD_FILM_NODES; i++) {
        const double w = (double)i / BD_FILM_CELLS;
        carried_b[i] = 6e-6 * w * w * (1.0 - w);
        carried_rise[i] = 6e-6 * w * (2.0 - 3.0 * w) / BD_FILM_CELLS;
    }
    /* real parts of strength over decay: .25 + .75 */
    static const bd_echo echoes[] = {{{8e5, 0.0}, {2e5, 0.0}}, {{5e4, 1e5}, {1e5, 4.375e4}}};
    const bool carried = law == BD_DAMPING_CARRIED, film = law == BD_DAMPING_FILM || carried;
    const double A = 0.04 * 11.5e-3, clearance = 10e-6, y0 = A - 0.5 * clearance;
    return (bd_bearing_data){
        .n_balls = 8,
        .n_coefs = 5,
        .n_radial = 2,
        .order = order,
        .sine = sine,
        .y0 = y0,
        .A = A,
        .e0 = -0.5 * clearance * (y0 + A),
        .contact = {.kappa = 1e10,
                    .h0 = law == BD_DAMPING_CONSTANT ? 0.0 : 3e-7,
                    .law = law,
                    .c = law == BD_DAMPING_LOAD ? 1e-5
                         : film                 ? 2e-6
                                                : 30.0,
                    .n_table = film ? BD_FILM_NODES : 3,
                    .table_delta = carried ? carried_b
                                   : film  ? film_c
                                           : table_delta,
                    .table_c = carried ? carried_rise
                               : film  ? film_rise
                                       : table_c,
                    .n_echoes = carried ? 2 : 0,
                    .echoes = carried ? echoes : NULL},
        .cage_ratio = 0.38,
        .angle0 = 0.2,
    };
}

void make_imperfect(bd_bearing_data *bearing)
{
    static const bd_wave waves[] = {
        {BD_WAVE_INNER_RADIAL, 8, 0, 4e-7, 0.3}, {BD_WAVE_INNER_AXIAL, 9, 0, 3e-7, 1.0},
        {BD_WAVE_OUTER_RADIAL, 7, 0, 3e-7, 2.0}, {BD_WAVE_OUTER_AXIAL, 16, 0, 2e-7, 0.0},
        {BD_WAVE_BALL, 2, 3, 3e-7, 0.5},         {BD_WAVE_BALL, 3, 1, 3e-7, 0.5},
    };
    static const bd_pit pits[] = {
        {BD_PIT_INNER, 0, 0.1, 1.5e-3, 2e-6},
        {BD_PIT_OUTER, 0, 0.5, 2e-3, 3e-6},
        {BD_PIT_BALL, 2, 0.2, 1e-3, 2e-6},
    };
    static const double oversize[] = {0.0, 1e-6, 0.0, -5e-7, 0.0, 0.0, 3e-7, 0.0};
    bearing->inner_ratio = 1.0;
    bearing->spin_ratio = 1.8;
    bearing->ball_diameter = 11.5e-3;
    bearing->inner_radius = 16e-3;
    bearing->outer_radius = 27.5e-3;
    bearing->n_waves = sizeof waves / sizeof waves[0];
    bearing->n_pits = sizeof pits / sizeof pits[0];
    bearing->waves = waves;
    bearing->pits = pits;
    bearing->oversize = oversize;
}

/* Modes of one part: unit masses, 1 % damping, frequencies spread between two limits (Hz). */
static void fill_part(const bd_model_data *system, int first, int n, double low, double high,
                      unsigned long long *seed)
{
    for (int i = 0; i < n; i++) {
        double omega = 2.0 * pi * low * pow(high / low, (double)i / (double)(n - 1));
        *entry(system->M, system->n, first + i, first + i) = 1.0;
        *entry(system->K, system->n, first + i, first + i) = omega * omega;
        *entry(system->C, system->n, first + i, first + i) = 0.02 * omega;
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < i; j++) {
            double mass = 0.02 * uniform(seed);
            *entry(system->M, system->n, first + i, first + j) = mass;
            *entry(system->M, system->n, first + j, first + i) = mass;
        }
}

bd_model_data motor(pool *p, bd_damping_law law)
{
    static const double modulus[] = {2e5, 1e6, 5e6}, tau[] = {1e-3, 1e-4, 2e-6};
    static const double time[] = {0.0, 2e-4, 3e-4, 1e-3}, value[] = {0.0, 50.0, -20.0, 5.0};
    static const int first[] = {0, 7, 13};
    enum { N = MOTOR_SIZE, RANK = 3 };
    unsigned long long seed = 7;
    bd_model_data system = bare_system(p, N);

    /* parts */
    fill_part(&system, 0, 7, 20.0, 8e3, &seed);
    fill_part(&system, 7, 6, 600.0, 9e3, &seed);
    fill_part(&system, 13, 6, 700.0, 9e3, &seed);
    for (int i = 0; i < 7; i++)
        for (int j = 0; j < i; j++) {
            double gyro = 0.05 * uniform(&seed), turning = 5.0 * uniform(&seed);
            *entry(system.G, N, i, j) = gyro;
            *entry(system.G, N, j, i) = -gyro;
            *entry(system.N, N, i, j) = turning;
            *entry(system.N, N, j, i) = -turning;
        }

    /* a layer in each housing */
    bd_layer_data *layers = pool_take(p, 2, sizeof *layers);
    for (int l = 0; l < 2; l++) {
        double *L = pool_take(p, (size_t)N * RANK, sizeof *L);
        for (int i = first[l + 1]; i < first[l + 1] + 6; i++)
            for (int r = 0; r < RANK; r++)
                L[i * RANK + r] = uniform(&seed);
        layers[l] = (bd_layer_data){
            .rank = RANK, .n_branches = 3 - l, .L = L, .modulus = modulus, .tau = tau};
    }
    system.n_layers = 2;
    system.layers = layers;

    /* a bearing between the shaft and each housing */
    bd_bearing_data *bearings = pool_take(p, 2, sizeof *bearings);
    const double **B = pool_take(p, 2, sizeof *B);
    for (int b = 0; b < 2; b++) {
        double *rows = pool_take(p, (size_t)5 * N, sizeof *rows);
        for (int k = 0; k < 5; k++) {
            for (int i = 0; i < 7; i++)
                rows[k * N + i] = 0.7 * uniform(&seed);
            for (int i = first[b + 1]; i < first[b + 1] + 6; i++)
                rows[k * N + i] = -uniform(&seed);
        }
        bearings[b] = deep_groove(law);
        if (b == 1)
            make_imperfect(&bearings[b]);
        B[b] = rows;
    }
    system.n_bearings = 2;
    system.bearings = bearings;
    system.B = B;

    /* loads of every kind */
    bd_load_data *loads = pool_take(p, 4, sizeof *loads);
    for (int k = 0; k < 4; k++) {
        double *p_cos = pool_take(p, N, sizeof *p_cos), *p_sin = pool_take(p, N, sizeof *p_sin);
        for (int i = 0; i < 7; i++) {
            p_cos[i] = uniform(&seed);
            p_sin[i] = uniform(&seed);
        }
        for (int i = 0; i < 7; i++) {
            double scale = k == 0 ? 800.0 : k == 1 ? 60.0 : k == 2 ? 1e-4 : 1.0;
            p_cos[i] *= scale;
            p_sin[i] *= scale;
        }
        loads[k] = (bd_load_data){.kind = (bd_load_kind)k,
                                  .omega = 2.0 * pi * 900.0,
                                  .p_cos = p_cos,
                                  .p_sin = p_sin,
                                  .n_samples = 4,
                                  .time = time,
                                  .value = value};
    }
    system.n_loads = 4;
    system.loads = loads;

    /* channels of every kind */
    bd_channel_data *channels = pool_take(p, MOTOR_CHANNELS, sizeof *channels);
    for (int c = 0; c < MOTOR_CHANNELS; c++) {
        double *row = pool_take(p, N, sizeof *row);
        row[2 * c] = 1.0;
        row[18] = 0.3;
        channels[c] = (bd_channel_data){.kind = (bd_channel_kind)(c < 6 ? c : c - 6),
                                        .row = row,
                                        .bearing = c % 2,
                                        .index = c % 5};
    }
    channels[5].index = 0;
    system.n_channels = MOTOR_CHANNELS;
    system.channels = channels;
    return system;
}

static const double zero = 0.0;
const bd_speed no_turning = {.n = 1, .time = &zero, .value = &zero};

bd_scheme motor_scheme(void)
{
    static const double time = 0.0, speed = 523.6;
    return (bd_scheme){.dt = 2.5e-6,
                       .beta = 0.25,
                       .gamma = 0.5,
                       .speed = {.n = 1, .time = &time, .value = &speed},
                       .tolerance = 1e-9,
                       .max_iterations = 40};
}

bd_scheme motor_run_up(void)
{
    static const double time[] = {1e-4, 5.01e-4, 1.002e-3}, speed[] = {0.0, 2000.0, -500.0};
    bd_scheme scheme = motor_scheme();
    scheme.speed = (bd_speed){.n = 3, .time = time, .value = speed};
    return scheme;
}
