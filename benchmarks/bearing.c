/* Nanoseconds that one bearing costs, kernel by kernel: one line "isa Z turn force both film carried" for each instruction
 * set of this machine and each number of balls; film is both with the damping of a film instead of a constant, and carried
 * that with a film that remembers. Built and run by bearing.py; arguments choose numbers of balls, else 4 to 64. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bearing.h"
#include "kernels.h"

/* Short runs, many of them, one law after the other in turns: the least of each is then of undisturbed moments, and a
 * change of the processor's pace meets all alike. */
enum { COEFS = 5, WARM = 20, EVALUATIONS = 400, REPEATS = 2000 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

typedef enum kernel { TURN, FORCE, BOTH } kernel;

/* What is timed: a kernel with a contact's law, and the least time of one evaluation so far. */
typedef struct timed {
    kernel which;
    const bd_contact *contact;
    double best;
} timed;

/* Memory of one bearing, the same for all laws: where arrays lie is worth a tenth. */
typedef struct place {
    double *constants, *memory;
} place;

/* Radial coefficients as a march has them: two evaluations a step of 2.5 us, in which the cage turns by 200 rad/s and the
 * ring swings by 1 um at 2 kHz, so that balls change their cell in the table of a film about as often as there. */
static double path[WARM + EVALUATIONS][2];

static void set_path(void)
{
    const double dt = 2.5e-6, pi = 3.14159265358979323846;
    for (int i = 0; i < WARM + EVALUATIONS; i++) {
        const double t = dt * (i / 2), r = 9e-6 + 1e-6 * sin(2 * pi * 2e3 * t), at = 200.0 * t;
        path[i][0] = r * sin(0.2 + at);
        path[i][1] = -r * cos(0.2 + at);
    }
}

/* One short run; every evaluation has its own input, taken from the last output so that none can start before the other
 * has ended. */
static void run(const bd_kernels *kernels, const bd_bearing_data *data, place at, timed *one)
{
    _Alignas(64) double z[BD_LANES] = {2e-6, -9e-6, 12e-6, 1e-6, -2e-6},
                        rate[BD_LANES] = {1e-3, -2e-3, 1e-3};
    _Alignas(64) double g[BD_LANES] = {0}, K[COEFS * BD_LANES] = {0}, C[COEFS * BD_LANES] = {0};
    bd_bearing_data own = *data;
    bd_bearing bearing;
    bd_bearing_work work;
    own.contact = *one->contact;
    bd_bearing_setup(&bearing, &own, at.constants);
    bd_bearing_work_carve(&bearing, &work, at.memory);
    kernels->turn(&bearing, &work, 0.3);

    double psi = 0.3, began = 0.0;
    for (int i = -WARM; i < EVALUATIONS; i++) {
        if (i == 0)
            began = now();
        if (one->which == TURN) {
            kernels->turn(&bearing, &work, psi);
            psi += 1e-3 + 1e-300 * work.phi[0];
            continue;
        }
        z[0] = path[WARM + i][0] + 1e-30 * g[0];
        z[1] = path[WARM + i][1] + 1e-30 * K[0] + 1e-30 * C[0];
        kernels->force(&bearing, &work, z, rate, 200.0, g);
        if (one->which == BOTH)
            kernels->tangent(&bearing, &work, 200.0, BD_LANES, K, C);
    }
    double each = (now() - began) / EVALUATIONS;
    one->best = each < one->best ? each : one->best;
}

int main(int argc, char **argv)
{
    static const struct {
        bd_isa isa;
        const char *name;
    } sets[] = {{BD_ISA_BASE, "base"}, {BD_ISA_AVX2, "avx2"}, {BD_ISA_AVX512, "avx512"}};
    static const int order[COEFS] = {1, 1, 0, 1, 1}, sine[COEFS] = {0, 1, 0, 0, 1};
    static const int usual[] = {4, 8, 9, 16, 17, 24, 32, 48, 64};
    const int numbers = argc > 1 ? argc - 1 : (int)(sizeof usual / sizeof usual[0]);

    set_path();
    double c[BD_FILM_NODES], rise[BD_FILM_NODES], b[BD_FILM_NODES], b_rise[BD_FILM_NODES];
    for (int i = 0; i < BD_FILM_NODES; i++) {
        const double w = (double)i / BD_FILM_CELLS;
        c[i] = 30.0 * w * w * w;
        rise[i] = 90.0 * w * w / BD_FILM_CELLS;
        b[i] = 1e-7 * c[i]; /* as b in s: what the numbers are costs nothing */
        b_rise[i] = 1e-7 * rise[i];
    }
    const bd_contact constant = {.kappa = 8e9, .law = BD_DAMPING_CONSTANT, .c = 30.0};
    const bd_contact film = {.kappa = 8e9,
                             .law = BD_DAMPING_FILM,
                             .c = 2e-6,
                             .n_table = BD_FILM_NODES,
                             .table_delta = c,
                             .table_c = rise};
    bd_contact carried = film;
    carried.law = BD_DAMPING_CARRIED;
    carried.table_delta = b;
    carried.table_c = b_rise;
    const timed kinds[] = {{TURN, &constant, INFINITY},
                           {FORCE, &constant, INFINITY},
                           {BOTH, &constant, INFINITY},
                           {BOTH, &film, INFINITY},
                           {BOTH, &carried, INFINITY}};
    enum { KINDS = sizeof kinds / sizeof kinds[0] };

    for (size_t s = 0; s < sizeof sets / sizeof sets[0]; s++) {
        const bd_kernels *kernels = bd_kernels_for(sets[s].isa);
        if (!kernels)
            continue;
        for (int n = 0; n < numbers; n++) {
            const int balls = argc > 1 ? atoi(argv[n + 1]) : usual[n];
            const double A = 0.4e-3, angle = 0.25;
            bd_bearing_data data = {
                .n_balls = balls,
                .n_coefs = COEFS,
                .n_radial = 2,
                .order = order,
                .sine = sine,
                .x0 = A * sin(angle),
                .y0 = A * cos(angle),
                .A = A,
                .cage_ratio = 0.4,
                .contact = film, /* the largest */
            };
            place at = {aligned_alloc(64, (bd_bearing_constants(&data) + 8) / 8 * 64),
                        aligned_alloc(64, (bd_bearing_work_size(&data) + 8) / 8 * 64)};
            if (!at.constants || !at.memory)
                return 1;
            timed of[KINDS];
            memcpy(of, kinds, sizeof kinds);
            for (int r = 0; r < REPEATS; r++)
                for (size_t k = 0; k < KINDS; k++)
                    run(kernels, &data, at, &of[k]);
            printf("%s %d", sets[s].name, balls);
            for (size_t k = 0; k < KINDS; k++)
                printf(" %.2f", of[k].best);
            printf("\n");
            free(at.constants);
            free(at.memory);
        }
    }
    return 0;
}
