/* One contact, and the balls of one bearing: forces against the formula, tangents against differences. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bearingdyn.h"
#include "check.h"
#include "systems.h"

/* Perfect bearings do not ask how the shaft turns. */
static const bd_turn still = {0.0, 0.0, 0.0};

/* A bearing of one ball and one axial coefficient, whose indentation is the coefficient itself. */
static bd_bearing_data single_contact(bd_damping_law law)
{
    static const int zero = 0;
    bd_bearing_data bearing = deep_groove(law);
    bearing.n_balls = 1;
    bearing.n_coefs = 1;
    bearing.n_radial = 0;
    bearing.order = &zero;
    bearing.sine = &zero;
    bearing.x0 = bearing.A;
    bearing.y0 = 0.0;
    bearing.e0 = 0.0;
    return bearing;
}

static void press(const bd_bearing_data *contact, double delta, double rate, double *F, double *K,
                  double *C)
{
    double load;
    bd_bearing_single(contact, &delta, &rate, 0.0, 0.0, still, F, K, C, &load);
    /* the normal is (X, Y)/Lambda, one to round-off */
    CHECK_CLOSE("the ball carries the force", load, *F, 1e-15 * load);
}

static double damping_of(const bd_contact *contact, double delta, double s)
{
    const double *x = contact->table_delta, *c = contact->table_c;
    if (contact->law == BD_DAMPING_CONSTANT)
        return contact->c;
    if (contact->law == BD_DAMPING_LOAD)
        return contact->c * 1.5 * contact->kappa * sqrt(s);
    if (contact->law == BD_DAMPING_FILM) {
        /* the cubic that deep_groove has its nodes on */
        const double w = sqrt(s) / (sqrt(s) + sqrt(contact->c));
        return 40.0 * w * w * (1.5 - w);
    }
    if (delta <= x[0])
        return c[0];
    for (int i = 1; i < contact->n_table; i++)
        if (delta <= x[i])
            return c[i - 1] + (c[i] - c[i - 1]) * (delta - x[i - 1]) / (x[i] - x[i - 1]);
    return c[contact->n_table - 1];
}

static void contact_pushes_and_never_pulls(bd_damping_law law)
{
    const bd_bearing_data bearing = single_contact(law);
    const bd_contact *contact = &bearing.contact;
    unsigned long long seed = 11;
    int lost = 0, torn = 0;
    for (int i = 0; i < 4000; i++) {
        const double delta = 2e-5 * uniform(&seed),
                     rate = uniform(&seed) * pow(10.0, 2.0 * uniform(&seed));
        const double s = delta + contact->h0;
        double F, K, C;
        press(&bearing, delta, rate, &F, &K, &C);
        const double elastic = s > 0.0 ? contact->kappa * pow(s, 1.5) : 0.0;
        const double free_force = s > 0.0 ? elastic + damping_of(contact, delta, s) * rate : 0.0;
        const double expected = fmax(0.0, free_force);
        lost += s <= 0.0;
        torn += s > 0.0 && free_force < 0.0;
        CHECK_EQUAL("force is not tensile", F >= 0.0, 1);
        /* round-off of the terms: delta itself is got out of (A + delta)^2 */
        CHECK_CLOSE("force of the contact", F, expected,
                    1e-12 * (elastic + fabs(elastic - free_force)));
        if (F == 0.0)
            CHECK_EQUAL("no tangent where there is no force", K == 0.0 && C == 0.0, 1);
    }
    CHECK_EQUAL("cases without touch, and torn apart", lost > 100 && torn > 100, 1);
}

/* Where all has been so for long: F = kappa (s + b ddelta/dt)^1.5. */
static void a_film_that_is_carried_adds_to_the_approach(void)
{
    const bd_bearing_data bearing = single_contact(BD_DAMPING_CARRIED);
    const bd_contact *contact = &bearing.contact;
    unsigned long long seed = 11;
    int lost = 0, torn = 0;
    for (int i = 0; i < 4000; i++) {
        const double delta = 2e-5 * uniform(&seed),
                     rate = uniform(&seed) * pow(10.0, 2.0 * uniform(&seed));
        const double s = fmax(delta + contact->h0, 0.0);
        const double w = sqrt(s) / (sqrt(s) + sqrt(contact->c)), b = 6e-6 * w * w * (1.0 - w);
        const double both = s + b * rate, expected = contact->kappa * pow(fmax(both, 0.0), 1.5);
        double F, K, C;
        press(&bearing, delta, rate, &F, &K, &C);
        lost += s <= 0.0;
        torn += s > 0.0 && both < 0.0;
        /* round-off of delta, as above, and of the sum: 1e-16 of its terms in F^(2/3) */
        CHECK_CLOSE("force of the contact", F, expected,
                    1e-11 * contact->kappa * sqrt(fmax(both, 0.0)) * (s + fabs(b * rate)) + 1e-9);
        if (both < 0.0)
            CHECK_EQUAL("no tangent where there is no force", K == 0.0 && C == 0.0, 1);
    }
    CHECK_EQUAL("cases without touch, and torn apart", lost > 100 && torn > 100, 1);
}

static void contact_tangent_is_the_derivative_of_its_force(bd_damping_law law)
{
    const bd_bearing_data bearing = single_contact(law);
    unsigned long long seed = 13;
    double worst = 0.0;
    for (int i = 0; i < 2000; i++) {
        const double delta = 5e-6 + 4e-6 * uniform(&seed), rate = 0.02 * uniform(&seed);
        const double h = 1e-10, hr = 1e-5;
        double F, K, C, up, down, unused[2];
        if (fabs(delta - 2e-6) < 2.0 * h) /* a corner of the table */
            continue;
        press(&bearing, delta, rate, &F, &K, &C);
        if (F < 1e-2) /* near the clip */
            continue;
        press(&bearing, delta + h, rate, &up, &unused[0], &unused[1]);
        press(&bearing, delta - h, rate, &down, &unused[0], &unused[1]);
        worst = fmax(worst, fabs((up - down) / (2.0 * h) - K) / K);
        press(&bearing, delta, rate + hr, &up, &unused[0], &unused[1]);
        press(&bearing, delta, rate - hr, &down, &unused[0], &unused[1]);
        worst = fmax(worst, fabs((up - down) / (2.0 * hr) - C) / fmax(C, 1.0));
    }
    /* round-off of F over h: 1e-16 F/(h K), F/K ~ delta, so about 1e-11; curvature h^2/delta^2 ~ 1e-9 */
    CHECK_BELOW("contact tangent against differences", worst, 1e-7);
}

static double largest_of(const double *values, int n)
{
    double largest = 0.0;
    for (int i = 0; i < n; i++)
        largest = fmax(largest, fabs(values[i]));
    return largest;
}

static void bearing_tangent_is_the_derivative_of_its_force(bd_damping_law law, bool imperfect)
{
    enum { M = 5 };
    bd_bearing_data bearing = deep_groove(law);
    if (imperfect)
        make_imperfect(&bearing);
    unsigned long long seed = 17;
    double worst_K = 0.0, worst_C = 0.0;
    for (int i = 0; i < 300; i++) {
        const double angle = 3.0 * uniform(&seed), cage = 200.0 * uniform(&seed);
        const bd_turn shaft = {500.0 * uniform(&seed), 0.0, 9.0 * uniform(&seed)};
        double z[M], z_rate[M], g[M], K[M * M], C[M * M], loads[8], moved[M];
        double up[M], down[M], ignored[M * M], ignored_too[M * M];
        for (int k = 0; k < M; k++) {
            z[k] = 1.5e-5 * uniform(&seed);
            z_rate[k] = 5e-3 * uniform(&seed);
        }
        bd_bearing_single(&bearing, z, z_rate, angle, cage, shaft, g, K, C, loads);
        /* each ball needs some load (or a clear gap), lest a difference straddle the edge of contact */
        int near_edge = 0;
        for (int j = 0; j < 8; j++)
            near_edge += loads[j] > 0.0 && loads[j] < 3.0;
        if (near_edge || largest_of(loads, 8) == 0.0)
            continue;
        for (int l = 0; l < M; l++) {
            const double h = 1e-10, hr = 1e-5;
            memcpy(moved, z, sizeof moved);
            moved[l] = z[l] + h;
            bd_bearing_single(&bearing, moved, z_rate, angle, cage, shaft, up, ignored, ignored_too,
                              loads);
            moved[l] = z[l] - h;
            bd_bearing_single(&bearing, moved, z_rate, angle, cage, shaft, down, ignored,
                              ignored_too, loads);
            for (int k = 0; k < M; k++)
                worst_K = fmax(worst_K, fabs((up[k] - down[k]) / (2.0 * h) - K[k * M + l]) /
                                            largest_of(K, M * M));
            memcpy(moved, z_rate, sizeof moved);
            moved[l] = z_rate[l] + hr;
            bd_bearing_single(&bearing, z, moved, angle, cage, shaft, up, ignored, ignored_too,
                              loads);
            moved[l] = z_rate[l] - hr;
            bd_bearing_single(&bearing, z, moved, angle, cage, shaft, down, ignored, ignored_too,
                              loads);
            for (int k = 0; k < M; k++)
                worst_C = fmax(worst_C, fabs((up[k] - down[k]) / (2.0 * hr) - C[k * M + l]) /
                                            largest_of(C, M * M));
        }
    }
    CHECK_BELOW("bearing stiffness against differences", worst_K, 1e-7);
    CHECK_BELOW("bearing damping against differences", worst_C, 1e-7);
}

static void turned_by_one_pitch_a_bearing_is_itself(void)
{
    const bd_bearing_data bearing = deep_groove(BD_DAMPING_CONSTANT);
    const double pitch = 2.0 * 3.14159265358979323846 / 8.0;
    const double z[] = {2e-5, -1e-5, 3e-6, 1e-6, -2e-6}, rest[5] = {0};
    double g[5], turned[5], K[25], C[25], loads[8];
    bd_bearing_single(&bearing, z, rest, 0.3, 0.0, still, g, K, C, loads);
    bd_bearing_single(&bearing, z, rest, 0.3 + pitch, 0.0, still, turned, K, C, loads);
    for (int k = 0; k < 5; k++)
        CHECK_CLOSE("force after one pitch", turned[k], g[k], 1e-11 * largest_of(g, 5));
}

/* The films' laws keep the cubics of balls from one evaluation to the next; it must not show. */
static void a_bearing_answers_the_same_wherever_it_was_before(bd_damping_law law)
{
    enum { N = 400, COEFS = 5, BALLS = 11 };
    bd_bearing_data bearing = deep_groove(law);
    bearing.n_balls = BALLS; /* some lanes are empty */
    static double z[N * COEFS], rate[N * COEFS], g[N * COEFS], K[N * COEFS * COEFS],
        C[N * COEFS * COEFS], loads[N * BALLS], heat[N], pressing[N], turning[N];
    bd_bodies angle[N];
    unsigned long long seed = 5;
    for (int i = 0; i < N; i++) {
        angle[i] = (bd_bodies){.cage = 0.01 * i};
        for (int k = 0; k < COEFS; k++) {
            z[COEFS * i + k] = 2e-5 * uniform(&seed);
            rate[COEFS * i + k] = 1e-3 * uniform(&seed);
        }
    }
    const bd_along_data motion = {
        .n = N, .z = z, .z_rate = rate, .angle = angle, .speed = {.cage = 200.0}};
    bd_along found = {.g = g,
                      .K = K,
                      .C = C,
                      .loads = loads,
                      .heat = heat,
                      .pressing = pressing,
                      .turning = turning};
    double *scratch = calloc(bd_bearing_along_size(&bearing), sizeof *scratch);
    CHECK_EQUAL("the motion is known", bd_bearing_along(&bearing, &motion, scratch, &found), BD_OK);
    free(scratch);
    for (int i = 0; i < N; i++) {
        double own_g[COEFS], own_K[COEFS * COEFS], own_C[COEFS * COEFS], own_loads[BALLS];
        bd_bearing_single(&bearing, z + COEFS * i, rate + COEFS * i, angle[i].cage, 200.0, still,
                          own_g, own_K, own_C, own_loads);
        CHECK_EQUAL("force", memcmp(own_g, g + COEFS * i, sizeof own_g), 0);
        CHECK_EQUAL("stiffness", memcmp(own_K, K + COEFS * COEFS * i, sizeof own_K), 0);
        CHECK_EQUAL("damping", memcmp(own_C, C + COEFS * COEFS * i, sizeof own_C), 0);
    }
}

int main(void)
{
    static const bd_damping_law laws[] = {BD_DAMPING_CONSTANT, BD_DAMPING_TABLE, BD_DAMPING_LOAD,
                                          BD_DAMPING_FILM, BD_DAMPING_CARRIED};
    for (int i = 0; i < 5; i++) {
        if (laws[i] != BD_DAMPING_CARRIED)
            contact_pushes_and_never_pulls(laws[i]);
        contact_tangent_is_the_derivative_of_its_force(laws[i]);
        bearing_tangent_is_the_derivative_of_its_force(laws[i], false);
        bearing_tangent_is_the_derivative_of_its_force(laws[i], true);
    }
    a_film_that_is_carried_adds_to_the_approach();
    a_bearing_answers_the_same_wherever_it_was_before(BD_DAMPING_FILM);
    a_bearing_answers_the_same_wherever_it_was_before(BD_DAMPING_CARRIED);
    turned_by_one_pitch_a_bearing_is_itself();
    return check_result();
}
