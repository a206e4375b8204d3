/* The march: resumed and repeated bit for bit, on every instruction set; how it ends when it cannot go on. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bearingdyn.h"
#include "check.h"
#include "reference_lapack.h"
#include "systems.h"

typedef struct outcome {
    double *state, *record;
    long long rows;
    bd_report report;
} outcome;

/* A march from the given state (at rest and started where NULL); everything lives in the pool. */
static outcome march(pool *p, const bd_model *model, bd_scheme scheme, const double *from,
                     long long steps, long long decimate)
{
    const size_t n = (size_t)bd_model_size(model), size = bd_state_size(model);
    const size_t channels = (size_t)bd_model_channels(model);
    outcome out = {.state = pool_take(p, size, sizeof(double)),
                   .record =
                       pool_take(p, ((size_t)(steps / decimate) + 1) * channels, sizeof(double))};
    bd_work *work = bd_work_create(model);
    if (from) {
        memcpy(out.state, from, size * sizeof *from);
    } else {
        const double *zero = pool_take(p, n, sizeof *zero);
        bd_state_set(model, out.state, 0.0, zero, zero);
        out.report.status = bd_start(model, &scheme, &reference_lapack, work, out.state);
    }
    if (out.report.status == BD_OK)
        out.report.status = bd_prepare(model, &scheme, &reference_lapack,
                                       bd_reference_speed(model, &scheme, out.state, false), work);
    long long done = 0, refactors = 0;
    while (out.report.status == BD_OK) {
        out.rows += bd_march(model, &scheme, work, out.state, steps - done, decimate,
                             out.record + (size_t)out.rows * channels, &out.report);
        done += out.report.steps;
        if (out.report.status != BD_REFACTOR)
            break;
        refactors++;
        out.report.status = bd_prepare(model, &scheme, &reference_lapack,
                                       bd_reference_speed(model, &scheme, out.state, true), work);
    }
    out.report.steps = done;
    out.report.refactors = refactors;
    bd_work_free(work);
    return out;
}

static int same(const double *a, const double *b, size_t n)
{
    return memcmp(a, b, n * sizeof *a) == 0;
}

static void a_march_resumes_bit_for_bit(bd_damping_law law, bd_scheme scheme)
{
    pool p = {.n = 0};
    const bd_model_data data = motor(&p, law);
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    scheme.audit = 1;
    const size_t size = bd_state_size(model), channels = (size_t)bd_model_channels(model);
    const outcome whole = march(&p, model, scheme, NULL, 1000, 7);
    const outcome first = march(&p, model, scheme, NULL, 481, 7);
    const outcome second = march(&p, model, scheme, first.state, 519, 7);
    CHECK_EQUAL("status", whole.report.status, BD_OK);
    CHECK_EQUAL("status of the second half", second.report.status, BD_OK);
    CHECK_EQUAL("rows", whole.rows, 1000 / 7);
    CHECK_EQUAL("rows of both halves", first.rows + second.rows, whole.rows);
    CHECK_EQUAL("states after run(2N) and run(N) + run(N) are the same bits",
                same(whole.state, second.state, size), 1);
    CHECK_EQUAL("records are the same bits",
                same(whole.record, first.record, (size_t)first.rows * channels) &&
                    same(whole.record + (size_t)first.rows * channels, second.record,
                         (size_t)second.rows * channels),
                1);
    CHECK_EQUAL("steps", first.report.steps + second.report.steps, 1000);
    CHECK_CLOSE("time", second.report.t, 1000 * scheme.dt, 0.0);

    /* the motor is loaded: both bearings carry, and something was lost */
    const double *last = whole.record + (size_t)(whole.rows - 1) * channels;
    CHECK_EQUAL("a bearing carries balls", last[5] >= 1.0, 1);
    CHECK_EQUAL("Newton iterated", whole.report.iterations > 1000, 1);
    bd_model_free(model);
    pool_empty(&p);
}

static void every_instruction_set_gives_the_same_bits(bd_damping_law law, bd_scheme scheme)
{
    pool p = {.n = 0};
    const bd_model_data data = motor(&p, law);
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    scheme.audit = 1;
    scheme.isa = BD_ISA_BASE;
    const outcome base = march(&p, model, scheme, NULL, 600, 3);
    CHECK_EQUAL("status", base.report.status, BD_OK);
    static const bd_isa sets[] = {BD_ISA_AVX2, BD_ISA_AVX512, BD_ISA_BEST};
    int tried = 0;
    for (int i = 0; i < 3; i++) {
        scheme.isa = sets[i];
        const outcome other = march(&p, model, scheme, NULL, 600, 3);
        if (other.report.status == BD_BAD_VALUE)
            continue; /* not on this machine */
        tried++;
        CHECK_EQUAL("state of another instruction set",
                    same(base.state, other.state, bd_state_size(model)), 1);
        CHECK_EQUAL("record of another instruction set",
                    same(base.record, other.record, (size_t)base.rows * MOTOR_CHANNELS), 1);
        CHECK_EQUAL("iterations of another instruction set", other.report.iterations,
                    base.report.iterations);
    }
    printf("instruction sets compared with the base: %d of 3\n", tried);
    bd_model_free(model);
    pool_empty(&p);
}

static void blocks_are_found(void)
{
    pool p = {.n = 0};
    bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    CHECK_EQUAL("blocks of the motor", bd_model_blocks(model), MOTOR_BLOCKS);
    CHECK_EQUAL("channels", bd_model_channels(model), MOTOR_CHANNELS);
    CHECK_EQUAL("coefficients", bd_model_coefs(model), 10);
    CHECK_EQUAL("layers", bd_model_layers(model), 2);
    CHECK_EQUAL("size", bd_model_size(model), MOTOR_SIZE);
    bd_model_free(model);

    /* one entry of any matrix joins two blocks */
    const double *matrices[] = {data.M, data.C, data.G, data.K, data.N};
    for (int i = 0; i < 5; i++) {
        double *joint = entry(matrices[i], MOTOR_SIZE, 18, 0);
        *joint = 1e-12;
        model = bd_model_create(&data, &status);
        CHECK_EQUAL("blocks of a joined motor", bd_model_blocks(model), MOTOR_BLOCKS - 1);
        bd_model_free(model);
        *joint = 0.0;
    }
    /* so does a layer */
    *entry(data.layers[0].L, 3, 0, 1) = 1e-9;
    model = bd_model_create(&data, &status);
    CHECK_EQUAL("blocks joined by a layer", bd_model_blocks(model), MOTOR_BLOCKS - 1);
    bd_model_free(model);
    pool_empty(&p);
}

/* The same motor with its coordinates dealt out anew moves in the same way. */
static void the_order_of_coordinates_does_not_matter(void)
{
    enum { N = MOTOR_SIZE };
    pool p = {.n = 0};
    bd_model_data data = motor(&p, BD_DAMPING_LOAD), dealt = bare_system(&p, N);
    int place[N];
    for (int i = 0; i < N; i++)
        place[i] = (i * 7 + 3) % N; /* 7 and 19 have no common factor */
    const double *from[] = {data.M, data.C, data.G, data.K, data.N};
    const double *to[] = {dealt.M, dealt.C, dealt.G, dealt.K, dealt.N};
    for (int k = 0; k < 5; k++)
        for (int i = 0; i < N; i++)
            for (int j = 0; j < N; j++)
                *entry(to[k], N, place[i], place[j]) = *entry(from[k], N, i, j);
    bd_layer_data layers[2];
    const double *B[2];
    bd_load_data loads[4];
    bd_channel_data channels[MOTOR_CHANNELS];
    for (int l = 0; l < 2; l++) {
        double *L = pool_take(&p, (size_t)N * 3, sizeof *L),
               *rows = pool_take(&p, (size_t)N * 5, sizeof *rows);
        for (int i = 0; i < N; i++) {
            for (int r = 0; r < 3; r++)
                L[place[i] * 3 + r] = data.layers[l].L[i * 3 + r];
            for (int k = 0; k < 5; k++)
                rows[k * N + place[i]] = data.B[l][k * N + i];
        }
        layers[l] = data.layers[l];
        layers[l].L = L;
        B[l] = rows;
    }
    for (int k = 0; k < 4; k++) {
        double *p_cos = pool_take(&p, N, sizeof *p_cos), *p_sin = pool_take(&p, N, sizeof *p_sin);
        for (int i = 0; i < N; i++) {
            p_cos[place[i]] = data.loads[k].p_cos[i];
            p_sin[place[i]] = data.loads[k].p_sin[i];
        }
        loads[k] = data.loads[k];
        loads[k].p_cos = p_cos;
        loads[k].p_sin = p_sin;
    }
    for (int c = 0; c < MOTOR_CHANNELS; c++) {
        double *row = pool_take(&p, N, sizeof *row);
        for (int i = 0; i < N; i++)
            row[place[i]] = data.channels[c].row[i];
        channels[c] = data.channels[c];
        channels[c].row = row;
    }
    dealt.n_layers = 2;
    dealt.layers = layers;
    dealt.n_bearings = 2;
    dealt.bearings = data.bearings;
    dealt.B = B;
    dealt.n_loads = 4;
    dealt.loads = loads;
    dealt.n_channels = MOTOR_CHANNELS;
    dealt.channels = channels;

    bd_status status;
    bd_model *one = bd_model_create(&data, &status), *other = bd_model_create(&dealt, &status);
    CHECK_EQUAL("blocks of the dealt motor", bd_model_blocks(other), MOTOR_BLOCKS);
    const outcome a = march(&p, one, motor_scheme(), NULL, 400, 1);
    const outcome b = march(&p, other, motor_scheme(), NULL, 400, 1);
    double worst = 0.0;
    for (int c = 0; c < MOTOR_CHANNELS; c++) {
        double largest = 0.0, difference = 0.0;
        for (int i = 0; i < 400; i++) {
            largest = fmax(largest, fabs(a.record[i * MOTOR_CHANNELS + c]));
            difference = fmax(difference, fabs(a.record[i * MOTOR_CHANNELS + c] -
                                               b.record[i * MOTOR_CHANNELS + c]));
        }
        worst = fmax(worst, difference / largest);
    }
    /* Newton's tolerance is 1e-9 of a force; the frozen matrix contracts well below it */
    CHECK_BELOW("the same motor in another order of coordinates", worst, 1e-8);
    bd_model_free(one);
    bd_model_free(other);
    pool_empty(&p);
}

static void a_new_step_size_starts_a_new_count(void)
{
    pool p = {.n = 0};
    const bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    bd_scheme scheme = motor_scheme();
    const outcome first = march(&p, model, scheme, NULL, 10, 4);
    scheme.dt *= 0.5;
    const outcome second = march(&p, model, scheme, first.state, 10, 4);
    CHECK_EQUAL("rows before", first.rows, 2);
    CHECK_EQUAL("rows after", second.rows, 2);
    CHECK_CLOSE("time after", second.report.t, 15 * 2.5e-6, 1e-20);
    bd_model_free(model);
    pool_empty(&p);
}

/* A load that tears everything apart: a status, and the state of the last good step. */
static void a_march_that_fails_leaves_the_last_good_step(void)
{
    static const double time[] = {5e-5, 5.25e-5}, value[] = {0.0, 1e308};
    pool p = {.n = 0};
    bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    bd_load_data loads[4];
    memcpy(loads, data.loads, sizeof loads);
    loads[3].time = time;
    loads[3].value = value;
    loads[3].n_samples = 2;
    double *blow = pool_take(&p, MOTOR_SIZE, sizeof *blow);
    for (int i = 0; i < MOTOR_SIZE; i++)
        blow[i] = 100.0;
    loads[3].p_cos = blow;
    data.loads = loads;
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    const bd_scheme scheme = motor_scheme();
    const outcome good = march(&p, model, scheme, NULL, 20, 1);
    const outcome bad = march(&p, model, scheme, NULL, 100, 1);
    CHECK_EQUAL("a march before the blow", good.report.status, BD_OK);
    CHECK_EQUAL("a march into the blow fails", bad.report.status < 0, 1);
    CHECK_EQUAL("steps done", bad.report.steps, 20);
    CHECK_EQUAL("rows kept", bad.rows, 20);
    CHECK_EQUAL("a bearing is named", bad.report.bearing >= 0, 1);
    CHECK_CLOSE("time of the last good step", bad.report.t, 5e-5, 1e-18);
    CHECK_EQUAL("state of the last good step", same(good.state, bad.state, bd_state_size(model)),
                1);
    bd_model_free(model);
    pool_empty(&p);
}

/* An unstable scheme on a structure without bearings: never a number that is not finite, whatever is recorded. */
static void overflow_is_noticed_without_bearings(void)
{
    pool p = {.n = 0};
    bd_model_data data = bare_system(&p, 1);
    *entry(data.M, 1, 0, 0) = 1.0;
    *entry(data.K, 1, 0, 0) = 1e6;
    const double x = 1.0, v = 0.0;
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    const bd_scheme scheme = {
        .dt = 1.0, .gamma = 0.5, .speed = no_turning, .tolerance = 1e-9, .max_iterations = 9};
    double *state = pool_take(&p, bd_state_size(model), sizeof *state), record[1];
    bd_work *work = bd_work_create(model);
    bd_report report;
    bd_state_set(model, state, 0.0, &x, &v);
    CHECK_EQUAL("start", bd_start(model, &scheme, &reference_lapack, work, state), BD_OK);
    CHECK_EQUAL("prepare", bd_prepare(model, &scheme, &reference_lapack, 0.0, work), BD_OK);
    bd_march(model, &scheme, work, state, 1000, 100000, record, &report);
    double end[3];
    bd_state_get(model, state, NULL, &end[0], &end[1], &end[2]);
    CHECK_EQUAL("overflow is a status", report.status, BD_NOT_FINITE);
    CHECK_EQUAL("the state stays finite", isfinite(end[0]) && isfinite(end[1]) && isfinite(end[2]),
                1);
    CHECK_EQUAL("steps are counted up to there", report.steps > 10 && report.steps < 1000, 1);
    bd_work_free(work);
    bd_model_free(model);
    pool_empty(&p);
}

/* A speed that leaps within one step: new factors, once, those of the step to come. */
static void a_leap_of_the_speed_is_factored_once(void)
{
    static const double time[] = {0.0, 2.1e-5, 2.2e-5}, speed[] = {0.0, 0.0, 1e6};
    pool p = {.n = 0};
    bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    data.n_bearings = 0;
    data.n_channels = 3; /* those of the structure */
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    bd_scheme scheme = motor_scheme();
    scheme.speed = (bd_speed){.n = 3, .time = time, .value = speed};
    const outcome out = march(&p, model, scheme, NULL, 40, 1);
    CHECK_EQUAL("status", out.report.status, BD_OK);
    CHECK_EQUAL("steps", out.report.steps, 40);
    CHECK_EQUAL("factored anew", out.report.refactors, 1);
    bd_model_free(model);
    pool_empty(&p);
}

/* The bearing that is named is the one that failed. */
static void the_failing_bearing_is_named(void)
{
    pool p = {.n = 0};
    bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    for (int b = 0; b < 2; b++) {
        double x[MOTOR_SIZE] = {0}, rest[MOTOR_SIZE] = {0};
        x[b == 0 ? 7 : 13] = 1e300; /* a coordinate of that bearing's housing alone */
        double *state = pool_take(&p, bd_state_size(model), sizeof *state);
        double record[2 * MOTOR_CHANNELS];
        bd_work *work = bd_work_create(model);
        const bd_scheme scheme = motor_scheme();
        bd_report report;
        bd_state_set(model, state, 0.0, x, rest);
        CHECK_EQUAL("prepare", bd_prepare(model, &scheme, &reference_lapack, 523.6, work), BD_OK);
        bd_march(model, &scheme, work, state, 1, 1, record, &report);
        CHECK_EQUAL("status", report.status, BD_NOT_FINITE);
        CHECK_EQUAL("bearing", report.bearing, b);
        bd_work_free(work);
    }
    bd_model_free(model);
    pool_empty(&p);
}

int main(void)
{
    a_march_resumes_bit_for_bit(BD_DAMPING_CONSTANT, motor_scheme());
    a_march_resumes_bit_for_bit(BD_DAMPING_CONSTANT, motor_run_up());
    a_march_resumes_bit_for_bit(BD_DAMPING_TABLE, motor_scheme());
    a_march_resumes_bit_for_bit(BD_DAMPING_TABLE, motor_run_up());
    a_march_resumes_bit_for_bit(BD_DAMPING_LOAD, motor_scheme());
    a_march_resumes_bit_for_bit(BD_DAMPING_LOAD, motor_run_up());
    a_march_resumes_bit_for_bit(BD_DAMPING_FILM, motor_run_up());
    a_march_resumes_bit_for_bit(BD_DAMPING_CARRIED, motor_scheme());
    a_march_resumes_bit_for_bit(BD_DAMPING_CARRIED, motor_run_up());
    every_instruction_set_gives_the_same_bits(BD_DAMPING_CONSTANT, motor_scheme());
    every_instruction_set_gives_the_same_bits(BD_DAMPING_CONSTANT, motor_run_up());
    every_instruction_set_gives_the_same_bits(BD_DAMPING_TABLE, motor_scheme());
    every_instruction_set_gives_the_same_bits(BD_DAMPING_TABLE, motor_run_up());
    every_instruction_set_gives_the_same_bits(BD_DAMPING_LOAD, motor_scheme());
    every_instruction_set_gives_the_same_bits(BD_DAMPING_LOAD, motor_run_up());
    every_instruction_set_gives_the_same_bits(BD_DAMPING_FILM, motor_run_up());
    every_instruction_set_gives_the_same_bits(BD_DAMPING_CARRIED, motor_run_up());
    blocks_are_found();
    the_order_of_coordinates_does_not_matter();
    a_new_step_size_starts_a_new_count();
    a_march_that_fails_leaves_the_last_good_step();
    overflow_is_noticed_without_bearings();
    a_leap_of_the_speed_is_factored_once();
    the_failing_bearing_is_named();
    return check_result();
}
