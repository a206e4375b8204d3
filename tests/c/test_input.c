/* Bad input is a status, before any work. */
#include <math.h>
#include <string.h>

#include "bearingdyn.h"
#include "check.h"
#include "reference_lapack.h"
#include "systems.h"

/* What creating a model of this description says. */
static bd_status status_of(const bd_model_data *data)
{
    bd_status status;
    bd_model *model = bd_model_create(data, &status);
    CHECK_EQUAL("a model comes with success alone", model != NULL, status == BD_OK);
    bd_model_free(model);
    return status;
}

static void every_number_of_a_structure_is_checked(void)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    pool p = {.n = 0};
    bd_model_data data = motor(&p, BD_DAMPING_TABLE);
    CHECK_EQUAL("the motor itself", status_of(&data), BD_OK);
    const double *values[] = {data.M,
                              data.C,
                              data.G,
                              data.K,
                              data.N,
                              data.layers[1].L,
                              data.B[1],
                              data.loads[0].p_cos,
                              data.loads[1].p_sin,
                              data.channels[2].row};
    for (size_t k = 0; k < sizeof values / sizeof values[0]; k++)
        for (int i = 0; i < 3; i++) {
            double *value = entry(values[k], 1, 5, 0), kept = *value;
            *value = bad[i];
            CHECK_EQUAL("a number that is not finite", status_of(&data), BD_BAD_VALUE);
            *value = kept;
        }
    data.n = 0;
    CHECK_EQUAL("no coordinates", status_of(&data), BD_BAD_SHAPE);
    data.n = -3;
    CHECK_EQUAL("fewer than none", status_of(&data), BD_BAD_SHAPE);
    pool_empty(&p);
}

/* One entry of each matrix moved by a share of the largest: by round-off it stays, by more it is refused. */
static void every_symmetry_is_checked(void)
{
    static const double moved[] = {1e-12, -1e-12, 1e-6, -1e-6, 1.0};
    pool p = {.n = 0};
    bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    const double *matrices[] = {data.M, data.C, data.G, data.K, data.N};
    for (int k = 0; k < 5; k++) {
        const int skew = k == 2 || k == 4;
        double largest = 0.0;
        for (int ij = 0; ij < MOTOR_SIZE * MOTOR_SIZE; ij++)
            largest = fmax(largest, fabs(matrices[k][ij]));
        for (size_t i = 0; i < sizeof moved / sizeof moved[0]; i++)
            for (int row = 2; row < MOTOR_SIZE;
                 row += 16) { /* within the first tile and at its far end */
                double *value = entry(matrices[k], MOTOR_SIZE, row, 1), kept = *value;
                *value += moved[i] * largest;
                CHECK_EQUAL("an entry on one side", status_of(&data),
                            fabs(moved[i]) < 1e-8 ? BD_OK : BD_NOT_SYMMETRIC);
                *value = kept;
            }
        double *diagonal = entry(matrices[k], MOTOR_SIZE, 3, 3), kept = *diagonal;
        *diagonal += largest;
        CHECK_EQUAL("an entry on the diagonal", status_of(&data), skew ? BD_NOT_SYMMETRIC : BD_OK);
        *diagonal = kept;
    }
    data.G = data.M;
    CHECK_EQUAL("a symmetric G", status_of(&data), BD_NOT_SYMMETRIC);
    pool_empty(&p);

    enum { N = 70 }; /* three tiles, the last one cut */
    data = bare_system(&p, N);
    for (int i = 0; i < N; i++)
        *entry(data.M, N, i, i) = 1.0;
    for (int i = 0; i < N; i++)
        for (int j = 0; j < i; j++) {
            *entry(data.N, N, i, j) = 1.0;
            *entry(data.N, N, j, i) = -1.0;
        }
    CHECK_EQUAL("a skew matrix of several tiles", status_of(&data), BD_OK);
    for (int i = 1; i < N; i++) {
        *entry(data.N, N, i, i / 2) = -1.0;
        CHECK_EQUAL("with a sign turned", status_of(&data), BD_NOT_SYMMETRIC);
        *entry(data.N, N, i, i / 2) = 1.0;
    }
    pool_empty(&p);
}

static void every_branch_is_checked(void)
{
    static const double bad_tau[] = {0.0, -1.0, NAN, INFINITY},
                        bad_modulus[] = {-1.0, NAN, INFINITY};
    pool p = {.n = 0};
    bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    bd_layer_data layers[2] = {data.layers[0], data.layers[1]};
    double tau[] = {1e-3, 1e-4, 1e-5}, modulus[] = {1e6, 0.0, 1e5};
    layers[0].tau = tau;
    layers[0].modulus = modulus;
    data.layers = layers;
    CHECK_EQUAL("a branch without modulus", status_of(&data), BD_OK);
    for (int i = 0; i < 4; i++) {
        tau[2] = bad_tau[i];
        CHECK_EQUAL("relaxation time", status_of(&data), BD_BAD_VALUE);
    }
    tau[2] = 1e-5;
    for (int i = 0; i < 3; i++) {
        modulus[2] = bad_modulus[i];
        CHECK_EQUAL("modulus of a branch", status_of(&data), BD_BAD_VALUE);
    }
    modulus[2] = 1e5;
    layers[0].rank = 0;
    CHECK_EQUAL("a layer without rank", status_of(&data), BD_BAD_SHAPE);
    pool_empty(&p);
}

/* What a bearing says when one of its numbers takes each of these values. */
static void refuse(bd_bearing_data *bearing, double *value, int negative, int infinite)
{
    const double kept = *value;
    *value = NAN;
    CHECK_EQUAL("NaN in a bearing", bd_bearing_check(bearing), BD_BAD_VALUE);
    *value = -1.0;
    CHECK_EQUAL("a negative number in a bearing", bd_bearing_check(bearing),
                negative ? BD_BAD_VALUE : BD_OK);
    *value = INFINITY;
    CHECK_EQUAL("an infinite number in a bearing", bd_bearing_check(bearing),
                infinite ? BD_BAD_VALUE : BD_OK);
    *value = kept;
    CHECK_EQUAL("the bearing itself", bd_bearing_check(bearing), BD_OK);
}

static void every_number_of_a_bearing_is_checked(void)
{
    bd_bearing_data bearing = deep_groove(BD_DAMPING_CONSTANT);
    refuse(&bearing, &bearing.A, 1, 1);
    refuse(&bearing, &bearing.x0, 0, 1);
    refuse(&bearing, &bearing.y0, 0, 1);
    refuse(&bearing, &bearing.e0, 0, 1);
    refuse(&bearing, &bearing.contact.kappa, 1, 1);
    refuse(&bearing, &bearing.contact.h0, 1, 1);
    refuse(&bearing, &bearing.contact.c, 1, 1);
    refuse(&bearing, &bearing.cage_ratio, 0, 1);
    refuse(&bearing, &bearing.angle0, 0, 1);

    int order[] = {1, 1, 0, 1, 1};
    bearing.order = order;
    order[3] = -1;
    CHECK_EQUAL("a negative order", bd_bearing_check(&bearing), BD_BAD_VALUE);
    order[3] = 2147483647; /* the basis functions would never be done */
    CHECK_EQUAL("an order beyond reason", bd_bearing_check(&bearing), BD_BAD_VALUE);
    order[3] = 1;
    bearing.n_balls = 0;
    CHECK_EQUAL("no balls", bd_bearing_check(&bearing), BD_BAD_SHAPE);
    bearing.n_balls = 8;
    bearing.n_radial = 6;
    CHECK_EQUAL("more radial coefficients than coefficients", bd_bearing_check(&bearing),
                BD_BAD_SHAPE);
}

static void a_damping_table_is_sorted_and_finite(void)
{
    double delta[] = {0.0, 1e-6, 2e-6}, c[] = {1.0, 2.0, 3.0};
    bd_bearing_data bearing = deep_groove(BD_DAMPING_TABLE);
    bearing.contact.table_delta = delta;
    bearing.contact.table_c = c;
    CHECK_EQUAL("a good table", bd_bearing_check(&bearing), BD_OK);
    delta[2] = 1e-6;
    CHECK_EQUAL("two equal points", bd_bearing_check(&bearing), BD_BAD_VALUE);
    delta[2] = NAN;
    CHECK_EQUAL("NaN at the end", bd_bearing_check(&bearing), BD_BAD_VALUE);
    delta[2] = INFINITY;
    CHECK_EQUAL("infinity at the end", bd_bearing_check(&bearing), BD_BAD_VALUE);
    delta[2] = 2e-6;
    c[1] = NAN;
    CHECK_EQUAL("damping that is not a number", bd_bearing_check(&bearing), BD_BAD_VALUE);
    c[1] = -2.0;
    CHECK_EQUAL("negative damping", bd_bearing_check(&bearing), BD_BAD_VALUE);
    c[1] = 2.0;
    bearing.contact.n_table = 1;
    CHECK_EQUAL("a table of one point", bd_bearing_check(&bearing), BD_OK);
    delta[0] = NAN;
    CHECK_EQUAL("whose place is not a number", bd_bearing_check(&bearing), BD_BAD_VALUE);
    bearing.contact.n_table = 0;
    CHECK_EQUAL("an empty table", bd_bearing_check(&bearing), BD_BAD_SHAPE);
}

static void a_film_law_begins_at_zero(void)
{
    double at[BD_FILM_NODES] = {0}, rise[BD_FILM_NODES] = {0};
    bd_bearing_data bearing = deep_groove(BD_DAMPING_FILM);
    bearing.contact.table_delta = at;
    bearing.contact.table_c = rise;
    CHECK_EQUAL("a good law", bd_bearing_check(&bearing), BD_OK);
    rise[BD_FILM_CELLS] = NAN;
    CHECK_EQUAL("NaN at the end", bd_bearing_check(&bearing), BD_BAD_VALUE);
    rise[BD_FILM_CELLS] = 1.0;
    at[1] = -1.0;
    CHECK_EQUAL("negative damping", bd_bearing_check(&bearing), BD_BAD_VALUE);
    at[1] = 0.0;
    at[0] = 1.0;
    CHECK_EQUAL("a jump where contact is lost", bd_bearing_check(&bearing), BD_BAD_VALUE);
    at[0] = 0.0;
    bearing.contact.c = 0.0;
    CHECK_EQUAL("no scale", bd_bearing_check(&bearing), BD_BAD_VALUE);
    bearing.contact.c = 1e-6;
    bearing.contact.n_table = BD_FILM_CELLS;
    CHECK_EQUAL("a node too few", bd_bearing_check(&bearing), BD_BAD_SHAPE);
}

static void echoes_fade_to_the_damping_of_the_table(void)
{
    bd_echo echoes[] = {{{8e5, 0.0}, {2e5, 0.0}}, {{5e4, 1e5}, {1e5, 4.375e4}}};
    bd_bearing_data bearing = deep_groove(BD_DAMPING_CARRIED);
    bearing.contact.echoes = echoes;
    CHECK_EQUAL("good echoes", bd_bearing_check(&bearing), BD_OK);
    echoes[1].strength[1] = 4.4e4;
    CHECK_EQUAL("another damping at low frequency", bd_bearing_check(&bearing), BD_BAD_VALUE);
    echoes[1].strength[1] = NAN;
    CHECK_EQUAL("a strength that is not a number", bd_bearing_check(&bearing), BD_BAD_VALUE);
    echoes[1].strength[1] = 4.375e4;
    echoes[0] = (bd_echo){{-8e5, 0.0}, {-2e5, 0.0}};
    CHECK_EQUAL("an echo that grows", bd_bearing_check(&bearing), BD_BAD_VALUE);
    bearing.contact.n_echoes = 0;
    CHECK_EQUAL("no echo", bd_bearing_check(&bearing), BD_BAD_SHAPE);
}

/* A table of one point, met by a displacement that is not a number: nothing is read beyond its end. */
static void a_table_is_not_read_beyond_its_end(void)
{
    double *delta, *c, z[5] = {NAN, 0.0, 0.0, 0.0, 0.0}, rest[5] = {0}, g[5], K[25], C[25],
                       loads[8];
    pool p = {.n = 0};
    delta = pool_take(&p, 0, sizeof *delta); /* one double: the pool adds one to every count */
    c = pool_take(&p, 0, sizeof *c);
    *c = 30.0;
    const bd_turn still = {0.0, 0.0, 0.0};
    bd_bearing_data bearing = deep_groove(BD_DAMPING_TABLE);
    bearing.contact.n_table = 1;
    bearing.contact.table_delta = delta;
    bearing.contact.table_c = c;
    CHECK_EQUAL("status", bd_bearing_single(&bearing, z, rest, 0.0, 0.0, still, g, K, C, loads),
                BD_NOT_FINITE);
    pool_empty(&p);
}

static void a_load_table_is_sorted_and_finite(void)
{
    pool p = {.n = 0};
    bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    bd_load_data loads[4];
    double time[] = {0.0, 1e-3, 2e-3}, value[] = {0.0, 1.0, 0.0};
    memcpy(loads, data.loads, sizeof loads);
    loads[3].time = time;
    loads[3].value = value;
    loads[3].n_samples = 3;
    data.loads = loads;
    CHECK_EQUAL("a good table", status_of(&data), BD_OK);
    time[1] = 0.0;
    CHECK_EQUAL("unsorted times", status_of(&data), BD_BAD_VALUE);
    time[1] = 1e-3;
    value[2] = NAN;
    CHECK_EQUAL("a value that is not a number", status_of(&data), BD_BAD_VALUE);
    value[2] = 0.0;
    time[2] = INFINITY;
    CHECK_EQUAL("an infinite time", status_of(&data), BD_BAD_VALUE);
    time[0] = NAN;
    loads[3].n_samples = 1;
    CHECK_EQUAL("one time that is not a number", status_of(&data), BD_BAD_VALUE);
    loads[3].n_samples = 0;
    CHECK_EQUAL("no samples", status_of(&data), BD_BAD_SHAPE);
    loads[3].n_samples = 3;
    time[0] = 0.0;
    time[2] = 2e-3;
    loads[1].omega = NAN;
    CHECK_EQUAL("a frequency that is not a number", status_of(&data), BD_BAD_VALUE);
    pool_empty(&p);
}

static void a_channel_exists(void)
{
    static const struct {
        bd_channel_kind kind;
        int bearing, index;
    } bad[] = {{BD_CHANNEL_FORCE, 2, 0}, {BD_CHANNEL_FORCE, -1, 0}, {BD_CHANNEL_FORCE, 0, 5},
               {BD_CHANNEL_BALL, 0, 8},  {BD_CHANNEL_BALL, 0, -1},  {BD_CHANNEL_LOADED, 7, 0}};
    pool p = {.n = 0};
    bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    bd_channel_data channel = {.kind = BD_CHANNEL_DISPLACEMENT, .row = NULL};
    data.n_channels = 1;
    data.channels = &channel;
    CHECK_EQUAL("a channel without a row", status_of(&data), BD_BAD_VALUE);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        channel = (bd_channel_data){
            .kind = bad[i].kind, .bearing = bad[i].bearing, .index = bad[i].index};
        CHECK_EQUAL("a channel of a bearing, coefficient or ball that is not there",
                    status_of(&data), BD_BAD_VALUE);
    }
    pool_empty(&p);
}

static void a_speed_is_checked(void)
{
    static const double times[][2] = {{0.0, 0.0}, {1.0, 0.0}, {NAN, 1.0}, {0.0, INFINITY}};
    static const double rising[] = {0.0, 1.0}, broken[] = {0.0, NAN}, rest[MOTOR_SIZE] = {0};
    pool p = {.n = 0};
    const bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    bd_work *work = bd_work_create(model);
    double *state = pool_take(&p, bd_state_size(model), sizeof *state);
    bd_state_set(model, state, 0.0, rest, rest);
    for (int i = 0; i < 6; i++) {
        bd_scheme scheme = motor_scheme();
        scheme.speed = (bd_speed){.n = i == 5 ? 0 : 2,
                                  .time = i < 4 ? times[i] : rising,
                                  .value = i == 4 ? broken : rising};
        CHECK_EQUAL("a speed that is no function of time",
                    bd_prepare(model, &scheme, &reference_lapack, 1.0, work), BD_BAD_VALUE);
        CHECK_EQUAL("nor to start with", bd_start(model, &scheme, &reference_lapack, work, state),
                    BD_BAD_VALUE);
    }
    const bd_scheme good = motor_scheme();
    CHECK_EQUAL("no reference speed", bd_prepare(model, &good, &reference_lapack, NAN, work),
                BD_BAD_VALUE);
    CHECK_EQUAL("a good one", bd_prepare(model, &good, &reference_lapack, 523.6, work), BD_OK);
    bd_work_free(work);
    bd_model_free(model);
    pool_empty(&p);
}

static void a_scheme_is_checked(void)
{
    static const double bad[] = {0.0, -1e-6, NAN, INFINITY};
    pool p = {.n = 0};
    const bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    bd_work *work = bd_work_create(model);
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 4; k++) {
            bd_scheme scheme = motor_scheme();
            if (i == 0)
                scheme.dt = bad[k];
            else if (i == 1 && k > 0)
                scheme.beta = bad[k];
            else if (i == 2 && k > 0)
                scheme.gamma = bad[k];
            else if (i == 3 && k > 1)
                scheme.speed.value = &bad[k];
            else if (i == 4 && k < 3)
                scheme.tolerance = bad[k];
            else if (i == 5 && k == 0)
                scheme.max_iterations = 0;
            else if (i == 6 && k == 0)
                scheme.isa = (bd_isa)9;
            else
                continue;
            CHECK_EQUAL("a scheme outside its domain",
                        bd_prepare(model, &scheme, &reference_lapack, 523.6, work), BD_BAD_VALUE);
        }
    bd_work_free(work);
    bd_model_free(model);
    pool_empty(&p);
}

/* A state's clock whose numbers mean nothing. */
static void a_clock_is_checked(void)
{
    static const struct {
        int at;
        double value;
    } bad[] = {{0, NAN},  {0, INFINITY}, {1, -1.0}, {1, 1e300}, {1, NAN},
               {2, -1.0}, {2, INFINITY}, {2, NAN},  {4, NAN},   {4, INFINITY}};
    static const double rest[MOTOR_SIZE] = {0};
    pool p = {.n = 0};
    const bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    const bd_scheme scheme = motor_scheme();
    double record[3 * MOTOR_CHANNELS];
    bd_report report;
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    bd_work *work = bd_work_create(model);
    double *state = pool_take(&p, bd_state_size(model), sizeof *state);
    bd_state_set(model, state, 0.0, rest, rest);
    CHECK_EQUAL("start", bd_start(model, &scheme, &reference_lapack, work, state), BD_OK);
    CHECK_EQUAL("prepare", bd_prepare(model, &scheme, &reference_lapack, 523.6, work), BD_OK);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        const double kept = state[bad[i].at];
        state[bad[i].at] = bad[i].value;
        CHECK_EQUAL("start with a broken clock",
                    bd_start(model, &scheme, &reference_lapack, work, state), BD_BAD_VALUE);
        CHECK_EQUAL("its reference speed",
                    isnan(bd_reference_speed(model, &scheme, state, true)) != 0, 1);
        CHECK_EQUAL("rows", bd_march(model, &scheme, work, state, 2, 1, record, &report), 0);
        CHECK_EQUAL("march with a broken clock", report.status, BD_BAD_VALUE);
        state[bad[i].at] = kept;
    }
    bd_march(model, &scheme, work, state, 2, 1, record, &report);
    CHECK_EQUAL("march with a good one", report.status, BD_OK);
    CHECK_EQUAL("steps on it", bd_state_view(model, state).clock.steps, 2);
    bd_work_free(work);
    bd_model_free(model);
    pool_empty(&p);
}

static void a_coordinate_without_mass_is_singular(void)
{
    pool p = {.n = 0};
    bd_model_data data = bare_system(&p, 2);
    const double rest[2] = {0};
    *entry(data.M, 2, 0, 0) = 1.0;
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    bd_work *work = bd_work_create(model);
    double *state = pool_take(&p, bd_state_size(model), sizeof *state), a[2];
    const bd_scheme scheme = motor_scheme();
    bd_state_set(model, state, 0.0, rest, rest);
    CHECK_EQUAL("start without mass", bd_start(model, &scheme, &reference_lapack, work, state),
                BD_SINGULAR_MASS);
    bd_state_get(model, state, NULL, NULL, NULL, a);
    CHECK_EQUAL("the state stays finite", isfinite(a[0]) && isfinite(a[1]), 1);
    CHECK_EQUAL("neither mass nor spring",
                bd_prepare(model, &scheme, &reference_lapack, 523.6, work), BD_SINGULAR);
    bd_work_free(work);
    bd_model_free(model);

    /* a matrix that is singular without a zero in it */
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            *entry(data.M, 2, i, j) = i == j ? (i ? 0.09 : 1.0) : 0.3;
    model = bd_model_create(&data, &status);
    work = bd_work_create(model);
    CHECK_EQUAL("a mass matrix of rank one",
                bd_start(model, &scheme, &reference_lapack, work, state), BD_SINGULAR_MASS);
    bd_work_free(work);
    bd_model_free(model);
    pool_empty(&p);
}

static void nothing_is_freed_twice_or_missed(void)
{
    bd_model_free(NULL);
    bd_work_free(NULL);
    bd_harmonic_work_free(NULL);
    CHECK_EQUAL("a status that is none", strcmp(bd_status_text((bd_status)77), "unknown status"),
                0);
    CHECK_EQUAL("success", strcmp(bd_status_text(BD_OK), "success"), 0);
}

int main(void)
{
    every_number_of_a_structure_is_checked();
    every_symmetry_is_checked();
    every_branch_is_checked();
    every_number_of_a_bearing_is_checked();
    a_damping_table_is_sorted_and_finite();
    a_film_law_begins_at_zero();
    echoes_fade_to_the_damping_of_the_table();
    a_table_is_not_read_beyond_its_end();
    a_load_table_is_sorted_and_finite();
    a_channel_exists();
    a_speed_is_checked();
    a_scheme_is_checked();
    a_clock_is_checked();
    a_coordinate_without_mass_is_singular();
    nothing_is_freed_twice_or_missed();
    return check_result();
}
