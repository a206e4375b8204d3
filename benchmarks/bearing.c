/* Nanoseconds that one bearing costs, kernel by kernel: one line "isa Z turn force both film carried" for each instruction
 * set of this machine and each number of balls; film is both with the damping of a film instead of a constant, and carried
 * that with a film that remembers. Built and run by bearing.py. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bearing.h"
#include "kernels.h"

enum { COEFS = 5, EVALUATIONS = 2000, REPEATS = 300 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

typedef enum kernel { TURN, FORCE, BOTH } kernel;

/* Least time of one evaluation over many repeats; every evaluation has its own input, taken from the last output
 * so that none can start before the other has ended. */
static double least(const bd_kernels *kernels, const bd_bearing *bearing, bd_bearing_work *work,
                    kernel which)
{
    _Alignas(64) double z[BD_LANES] = {2e-6, -9e-6, 12e-6, 1e-6, -2e-6},
                        rate[BD_LANES] = {1e-3, -2e-3, 1e-3};
    _Alignas(64) double g[BD_LANES], K[COEFS * BD_LANES], C[COEFS * BD_LANES];
    double best = INFINITY;
    kernels->turn(bearing, work, 0.3);
    for (int r = 0; r < REPEATS; r++) {
        double psi = 0.3, began = now();
        for (int i = 0; i < EVALUATIONS; i++) {
            if (which == TURN) {
                kernels->turn(bearing, work, psi);
                psi += 1e-3 + 1e-300 * work->phi[0];
                continue;
            }
            kernels->force(bearing, work, z, rate, 200.0, g);
            z[0] += 1e-30 * g[0];
            if (which == BOTH) {
                kernels->tangent(bearing, work, 200.0, BD_LANES, K, C);
                z[1] += 1e-30 * K[0] + 1e-30 * C[0];
            }
        }
        double each = (now() - began) / EVALUATIONS;
        best = each < best ? each : best;
    }
    return best;
}

int main(void)
{
    static const struct {
        bd_isa isa;
        const char *name;
    } sets[] = {{BD_ISA_BASE, "base"}, {BD_ISA_AVX2, "avx2"}, {BD_ISA_AVX512, "avx512"}};
    static const int order[COEFS] = {1, 1, 0, 1, 1}, sine[COEFS] = {0, 1, 0, 0, 1};
    static const int balls[] = {4, 8, 9, 16, 17, 24, 32, 48, 64};

    double c[BD_FILM_NODES], rise[BD_FILM_NODES];
    for (int i = 0; i < BD_FILM_NODES; i++) {
        const double w = (double)i / BD_FILM_CELLS;
        c[i] = 30.0 * w * w * w;
        rise[i] = 90.0 * w * w / BD_FILM_CELLS;
    }

    for (size_t s = 0; s < sizeof sets / sizeof sets[0]; s++) {
        const bd_kernels *kernels = bd_kernels_for(sets[s].isa);
        if (!kernels)
            continue;
        for (size_t b = 0; b < sizeof balls / sizeof balls[0]; b++) {
            const double A = 0.4e-3, angle = 0.25;
            bd_bearing_data data = {
                .n_balls = balls[b],
                .n_coefs = COEFS,
                .n_radial = 2,
                .order = order,
                .sine = sine,
                .x0 = A * sin(angle),
                .y0 = A * cos(angle),
                .A = A,
                .contact = {.kappa = 8e9, .law = BD_DAMPING_CONSTANT, .c = 30.0},
                .cage_ratio = 0.4,
            };
            bd_bearing bearing;
            bd_bearing_work work;
            bd_bearing_data largest = data;
            largest.contact.n_table = BD_FILM_NODES;
            largest.contact.law = BD_DAMPING_FILM;
            double *constants = aligned_alloc(64, (bd_bearing_constants(&largest) + 8) / 8 * 64);
            double *memory = aligned_alloc(64, (bd_bearing_work_size(&largest) + 8) / 8 * 64);
            if (!constants || !memory)
                return 1;
            bd_bearing_setup(&bearing, &data, constants);
            bd_bearing_work_carve(&bearing, &work, memory);
            double turn = least(kernels, &bearing, &work, TURN);
            double force = least(kernels, &bearing, &work, FORCE);
            double both = least(kernels, &bearing, &work, BOTH);
            data.contact = (bd_contact){.kappa = 8e9,
                                        .law = BD_DAMPING_FILM,
                                        .c = 2e-6,
                                        .n_table = BD_FILM_NODES,
                                        .table_delta = c,
                                        .table_c = rise};
            bd_bearing_setup(&bearing, &data, constants);
            bd_bearing_work_carve(&bearing, &work, memory);
            double film = least(kernels, &bearing, &work, BOTH);
            data.contact.law =
                BD_DAMPING_CARRIED; /* the same numbers, as b in s: what they are costs nothing */
            for (int i = 0; i < BD_FILM_NODES; i++) {
                c[i] *= 1e-7;
                rise[i] *= 1e-7;
            }
            bd_bearing_setup(&bearing, &data, constants);
            bd_bearing_work_carve(&bearing, &work, memory);
            double carried = least(kernels, &bearing, &work, BOTH);
            for (int i = 0; i < BD_FILM_NODES; i++) {
                c[i] *= 1e7;
                rise[i] *= 1e7;
            }
            printf("%s %d %.2f %.2f %.2f %.2f %.2f\n", sets[s].name, balls[b], turn, force, both,
                   film, carried);
            free(constants);
            free(memory);
        }
    }
    return 0;
}
