/* Marches side by side are the marches one by one, to the bit: whatever differs between them but the structure, however
 * many they are, wherever each of them ends. */
#include <math.h>
#include <string.h>

#include "bearingdyn.h"
#include "check.h"
#include "reference_lapack.h"
#include "systems.h"

enum { STEPS = 400, DECIMATE = 3 };

/* One march, ready: a model and state of its own. */
typedef struct marching {
    bd_model *model;
    bd_work *work;
    double *state, *record;
    pool pool;
} marching;

/* Case k of the motor: another clearance and arm of a tilt, speed of its start, constant and harmonic load, angle of the first ball (even
 * cases), waves (every third has none), and damping (the last). */
static marching case_of(bd_damping_law law, bd_scheme scheme, int k)
{
    marching one = {.pool = {.n = 0}};
    pool *p = &one.pool;
    bd_model_data data = motor(p, law);
    bd_bearing_data *bearings = pool_take(p, 2, sizeof *bearings);
    bd_load_data *loads = pool_take(p, (size_t)data.n_loads, sizeof *loads);
    double *x = pool_take(p, MOTOR_SIZE, sizeof *x), *v = pool_take(p, MOTOR_SIZE, sizeof *v);
    memcpy(bearings, data.bearings, 2 * sizeof *bearings);
    memcpy(loads, data.loads, (size_t)data.n_loads * sizeof *loads);
    for (int b = 0; b < 2; b++) {
        const double tighter = 1e-6 * k;
        bearings[b].e0 += tighter * (2.0 * bearings[b].y0 + tighter);
        bearings[b].y0 += tighter;
        bearings[b].e0 += 4e-10; /* an axial distance of the groove centres too */
        bearings[b].x0 = 2e-5;
        bearings[b].angle0 += k % 2 ? 0.0 : 0.05 * k;
        bearings[b].contact.c *= k == 7 ? 2.0 : 1.0;
    }
    if (k % 3 == 0)
        bearings[1].n_waves = 0;
    for (int i = 0; i < data.n_loads; i++) {
        double *push = pool_take(p, MOTOR_SIZE, sizeof *push);
        for (int j = 0; j < MOTOR_SIZE; j++)
            push[j] = loads[i].p_cos[j] * (1.0 + 0.1 * k);
        loads[i].p_cos = push;
        loads[i].omega *= 1.0 + 0.05 * k;
    }
    if (k > 0) { /* the arm of the last tilt of one bearing */
        double *B = pool_take(p, 5 * MOTOR_SIZE, sizeof *B);
        const double **rows = pool_take(p, 2, sizeof *rows);
        memcpy(B, data.B[0], 5 * MOTOR_SIZE * sizeof *B);
        for (int j = 0; j < MOTOR_SIZE; j++)
            B[4 * MOTOR_SIZE + j] *= 1.0 + 0.01 * k;
        rows[0] = B;
        rows[1] = data.B[1];
        data.B = rows;
    }
    data.bearings = bearings;
    data.loads = loads;
    for (int j = 0; j < MOTOR_SIZE; j++)
        v[j] = 1e-3 * k * (j % 3);

    bd_status status;
    one.model = bd_model_create(&data, &status);
    CHECK_EQUAL("model", status, BD_OK);
    one.work = bd_work_create(one.model);
    one.state = pool_take(p, bd_state_size(one.model), sizeof *one.state);
    one.record = pool_take(p, (STEPS / DECIMATE + 2) * MOTOR_CHANNELS, sizeof *one.record);
    bd_state_set(one.model, one.state, 1e-4 * (k == 5), x, v);
    CHECK_EQUAL("start", bd_start(one.model, &scheme, &reference_lapack, one.work, one.state),
                BD_OK);
    CHECK_EQUAL("prepare",
                bd_prepare(one.model, &scheme, &reference_lapack,
                           bd_reference_speed(one.model, &scheme, one.state, true), one.work),
                BD_OK);
    return one;
}

static void free_case(marching *one)
{
    bd_work_free(one->work);
    bd_model_free(one->model);
    pool_empty(&one->pool);
}

static int same(const void *a, const void *b, size_t bytes)
{
    return memcmp(a, b, bytes) == 0;
}

/* Steps of case k: some end early, so that the others go on without them. */
static long long steps_of(int k)
{
    return k == 0 ? 150 : k == 3 ? 1 : STEPS - k;
}

/* Cases in two calls side by side, and one by one in one call. The case `breaks` starts so fast that it is lost. */
static void side_by_side(bd_damping_law law, bd_isa isa, int n, int breaks)
{
    bd_scheme scheme = motor_scheme();
    scheme.isa = isa;
    marching ones[BD_ABREAST];
    bd_abreast_case cases[BD_ABREAST];
    for (int k = 0; k < n; k++) {
        ones[k] = case_of(law, scheme, k);
        cases[k] = (bd_abreast_case){.model = ones[k].model,
                                     .work = ones[k].work,
                                     .flat = ones[k].state,
                                     .decimate = DECIMATE,
                                     .record = ones[k].record,
                                     .steps = steps_of(k) / 2};
        CHECK_EQUAL("shares with the first", bd_abreast_shares(&cases[0], &cases[k]), 1);
    }
    if (breaks >= 0) { /* a velocity whose damper forces overflow */
        const bd_state state = bd_state_view(ones[breaks].model, ones[breaks].state);
        state.v[0] = 1e308;
    }
    bd_abreast *abreast = bd_abreast_create(n, cases);
    bd_abreast_march(abreast, n, cases);
    long long first_steps[BD_ABREAST], first_rows[BD_ABREAST];
    for (int k = 0; k < n; k++) {
        first_steps[k] = cases[k].report.steps;
        first_rows[k] = cases[k].rows;
        cases[k].record += cases[k].rows * MOTOR_CHANNELS;
        cases[k].steps = k == breaks ? 0 : steps_of(k) - steps_of(k) / 2;
    }
    const bd_report lost = breaks >= 0 ? cases[breaks].report : (bd_report){0};
    bd_abreast_march(abreast, n, cases);

    for (int k = 0; k < n; k++) {
        marching alone = case_of(law, scheme, k);
        if (k == breaks)
            bd_state_view(alone.model, alone.state).v[0] = 1e308;
        bd_report first, second = {0};
        long long rows = bd_march(alone.model, &scheme, alone.work, alone.state, steps_of(k) / 2,
                                  DECIMATE, alone.record, &first);
        CHECK_EQUAL("rows of the first call", first_rows[k], rows);
        CHECK_EQUAL("steps of the first call", first_steps[k], first.steps);
        if (k == breaks) {
            CHECK_EQUAL("what is lost fails", lost.status != BD_OK, 1);
            CHECK_EQUAL("its report", same(&lost, &first, sizeof first), 1);
        } else {
            rows += bd_march(alone.model, &scheme, alone.work, alone.state,
                             steps_of(k) - steps_of(k) / 2, DECIMATE,
                             alone.record + rows * MOTOR_CHANNELS, &second);
            CHECK_EQUAL("report", same(&cases[k].report, &second, sizeof second), 1);
            CHECK_EQUAL("rows", first_rows[k] + cases[k].rows, rows);
            CHECK_EQUAL("it marched", second.status, BD_OK);
        }
        CHECK_EQUAL(
            "state",
            same(ones[k].state, alone.state, bd_state_size(alone.model) * sizeof *alone.state), 1);
        CHECK_EQUAL("record",
                    same(ones[k].record, alone.record,
                         (size_t)(rows * MOTOR_CHANNELS) * sizeof *alone.record),
                    1);
        for (int b = 0; b < 2; b++)
            CHECK_CLOSE("largest ball load", bd_peak_load(ones[k].model, ones[k].work, b),
                        bd_peak_load(alone.model, alone.work, b), 0.0);
        free_case(&alone);
    }
    bd_abreast_free(abreast);
    for (int k = 0; k < n; k++)
        free_case(&ones[k]);
}

/* Another speed, step or layer: another operator. */
static void what_differs_in_structure_does_not_go_side_by_side(void)
{
    bd_scheme scheme = motor_scheme(), shorter = scheme, audited = scheme, rising = motor_run_up();
    static const double faster = 600.0;
    bd_scheme turning = scheme;
    shorter.dt *= 0.5;
    audited.audit = 1;
    turning.speed.value = &faster;
    const bd_scheme others[] = {shorter, audited, rising, turning};
    marching one = case_of(BD_DAMPING_CONSTANT, scheme, 1);
    const bd_abreast_case a = {.model = one.model, .work = one.work};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        marching other = case_of(BD_DAMPING_CONSTANT, others[i], 1);
        const bd_abreast_case b = {.model = other.model, .work = other.work};
        CHECK_EQUAL("shares", bd_abreast_shares(&a, &b), 0);
        free_case(&other);
    }
    free_case(&one);
}

int main(void)
{
    static const bd_isa sets[] = {BD_ISA_BASE, BD_ISA_AVX2, BD_ISA_AVX512};
    for (int i = 0; i < 3; i++)
        for (int law = BD_DAMPING_CONSTANT; bd_isa_available(sets[i]) && law <= BD_DAMPING_LOAD;
             law++)
            side_by_side((bd_damping_law)law, sets[i], BD_ABREAST, -1);
    side_by_side(BD_DAMPING_CONSTANT, BD_ISA_BEST, 1, -1);
    side_by_side(BD_DAMPING_CONSTANT, BD_ISA_BEST, 3, -1);
    side_by_side(BD_DAMPING_CONSTANT, BD_ISA_BEST, 5, 2);
    side_by_side(BD_DAMPING_CONSTANT, BD_ISA_BEST, 6, 0);
    what_differs_in_structure_does_not_go_side_by_side();
    return check_result();
}
