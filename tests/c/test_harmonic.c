/* The complex response against closed forms, and block by block against one matrix. */
#include <complex.h>
#include <math.h>
#include <string.h>

#include "bearingdyn.h"
#include "check.h"
#include "reference_lapack.h"
#include "systems.h"

/* All frequencies of a question at once. */
static bd_status answer(const bd_model *model, const bd_harmonic_data *question,
                        double complex *response)
{
    bd_harmonic_work *work = bd_harmonic_work_create(model, question);
    const bd_status status = bd_harmonic(model, question, &reference_lapack, work, 0,
                                         question->n_omega, (double *)response);
    bd_harmonic_work_free(work);
    return status;
}

/* m, c, k and a layer of rank one: x = F/(k - omega^2 m + i omega c + 2 G* L^2). */
static void an_oscillator_on_a_layer_answers_in_closed_form(void)
{
    enum { N = 5 };
    static const double omega[N] = {0.0, 10.0, 50.0, 333.0, 4000.0};
    static const double modulus[2 * N] = {10.0, 0.0, 12.0, 3.0, 15.0, 8.0, 20.0, 9.0, 30.0, 1.0};
    pool p = {.n = 0};
    bd_model_data data = bare_system(&p, 1);
    *entry(data.M, 1, 0, 0) = 0.3;
    *entry(data.C, 1, 0, 0) = 2.0;
    *entry(data.K, 1, 0, 0) = 900.0;
    const double L = 7.0, force[] = {1.0, -2.5}, row = 3.0;
    const bd_layer_data layer = {.rank = 1, .L = &L};
    data.n_layers = 1;
    data.layers = &layer;
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    const bd_harmonic_data question = {.speed = 4.0,
                                       .n_omega = N,
                                       .n_in = 2,
                                       .n_out = 1,
                                       .omega = omega,
                                       .modulus = modulus,
                                       .force = force,
                                       .row = &row,
                                       .bearing_K = &row,
                                       .bearing_C = &row};
    double complex response[2 * N];
    CHECK_EQUAL("status", answer(model, &question, response), BD_OK);
    double worst = 0.0;
    for (int i = 0; i < N; i++)
        for (int k = 0; k < 2; k++) {
            const double complex G = modulus[2 * i] + I * modulus[2 * i + 1];
            const double complex D =
                900.0 - omega[i] * omega[i] * 0.3 + I * omega[i] * 2.0 + 2.0 * G * L * L;
            worst = fmax(worst, cabs(response[2 * i + k] * D / (row * force[k]) - 1.0));
        }
    CHECK_BELOW("response of an oscillator on a layer, relative", worst, 1e-14);
    bd_model_free(model);
    pool_empty(&p);
}

/* The same in two directions alike, turning, with z = x + i y: the skew matrices [[0, g], [-g, 0]] and
 * [[0, n], [-n, 0]] have the whirl (1, i) as a mode, of i g and i n, so that
 * z = F/(k - omega^2 m + i omega c + speed (i n - omega g)) where F acts along x and i F along y. */
static void a_turning_oscillator_answers_in_closed_form(void)
{
    enum { N = 5 };
    static const double omega[N] = {0.0, 10.0, 50.0, 333.0, 4000.0};
    static const double force[] = {1.0, 0.0, 0.0, 1.0}, row[] = {1.0, 0.0}, none = 0.0;
    const double g = 0.7, n = 13.0, speed = 4.0;
    pool p = {.n = 0};
    bd_model_data data = bare_system(&p, 2);
    for (int i = 0; i < 2; i++) {
        *entry(data.M, 2, i, i) = 0.3;
        *entry(data.C, 2, i, i) = 2.0;
        *entry(data.K, 2, i, i) = 900.0;
        *entry(data.G, 2, i, 1 - i) = i == 0 ? g : -g;
        *entry(data.N, 2, i, 1 - i) = i == 0 ? n : -n;
    }
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    const bd_harmonic_data question = {.speed = speed,
                                       .n_omega = N,
                                       .n_in = 2,
                                       .n_out = 1,
                                       .omega = omega,
                                       .force = force,
                                       .row = row,
                                       .bearing_K = &none,
                                       .bearing_C = &none};
    double complex response[2 * N];
    CHECK_EQUAL("status", answer(model, &question, response), BD_OK);
    double worst = 0.0;
    for (int i = 0; i < N; i++) {
        const double complex D =
            900.0 - omega[i] * omega[i] * 0.3 + I * omega[i] * 2.0 + speed * (I * n - omega[i] * g);
        const double complex z = response[2 * i] + I * response[2 * i + 1];
        worst = fmax(worst, cabs(z * D - 1.0));
    }
    CHECK_BELOW("response of a turning oscillator, relative", worst, 1e-14);
    bd_model_free(model);
    pool_empty(&p);
}

static void blocks_joined_by_bearings_answer_as_one(void)
{
    enum { N = MOTOR_SIZE, OUT = 4, FREQUENCIES = 6 };
    pool p = {.n = 0};
    bd_model_data data = motor(&p, BD_DAMPING_CONSTANT);
    bd_status status;
    bd_model *apart = bd_model_create(&data, &status);
    /* the smallest of numbers joins the blocks, and all is solved as one matrix */
    *entry(data.K, N, 0, 8) = *entry(data.K, N, 8, 14) = 1e-300;
    bd_model *whole = bd_model_create(&data, &status);
    CHECK_EQUAL("blocks apart", bd_model_blocks(apart), 3);
    CHECK_EQUAL("blocks joined", bd_model_blocks(whole), 1);

    double omega[FREQUENCIES], modulus[FREQUENCIES * 4], K[100] = {0}, C[100] = {0};
    double *force = pool_take(&p, (size_t)2 * N, sizeof *force),
           *row = pool_take(&p, (size_t)OUT * N, sizeof *row);
    unsigned long long seed = 23;
    for (int i = 0; i < FREQUENCIES; i++) {
        omega[i] = 60.0 * pow(5.0, i);
        for (int l = 0; l < 4; l++)
            modulus[4 * i + l] = 1e6 * (1.5 + uniform(&seed));
    }
    for (int b = 0; b < 2; b++)
        for (int k = 0; k < 5; k++)
            for (int l = 0; l < 5; l++) {
                K[(5 * b + k) * 10 + 5 * b + l] =
                    1e8 * ((k == l ? 2.0 : 0.0) + 0.3 * uniform(&seed));
                C[(5 * b + k) * 10 + 5 * b + l] = k == l ? 60.0 : 5.0;
            }
    for (int i = 0; i < 2 * N; i++)
        force[i] = uniform(&seed);
    for (int i = 0; i < OUT * N; i++)
        row[i] = uniform(&seed);
    const bd_harmonic_data question = {.speed = 500.0,
                                       .n_omega = FREQUENCIES,
                                       .n_in = 2,
                                       .n_out = OUT,
                                       .omega = omega,
                                       .modulus = modulus,
                                       .force = force,
                                       .row = row,
                                       .bearing_K = K,
                                       .bearing_C = C};
    double complex one[FREQUENCIES * OUT * 2], other[FREQUENCIES * OUT * 2],
        set[FREQUENCIES * OUT * 2];
    const bd_model *models[] = {apart, whole};
    double complex *answers[] = {one, other};
    for (int m = 0; m < 2; m++) {
        bd_harmonic_work *work = bd_harmonic_work_create(models[m], &question);
        CHECK_EQUAL(
            "first half",
            bd_harmonic(models[m], &question, &reference_lapack, work, 0, 2, (double *)answers[m]),
            BD_OK);
        CHECK_EQUAL("second half",
                    bd_harmonic(models[m], &question, &reference_lapack, work, 2, FREQUENCIES - 2,
                                (double *)answers[m]),
                    BD_OK);
        bd_harmonic_work_free(work);
    }
    /* whatever the width of a register, and however frequencies fall into it */
    for (bd_isa isa = BD_ISA_BASE; isa <= BD_ISA_AVX512; isa++) {
        if (!bd_isa_available(isa))
            continue;
        bd_harmonic_data same = question;
        same.isa = isa;
        CHECK_EQUAL("all at once", answer(apart, &same, set), BD_OK);
        CHECK_EQUAL("bits of an instruction set", memcmp(set, one, sizeof one), 0);
    }
    double worst = 0.0;
    for (int i = 0; i < FREQUENCIES; i++) {
        double largest = 0.0, difference = 0.0;
        for (int k = 0; k < 2 * OUT; k++) {
            largest = fmax(largest, cabs(other[i * 2 * OUT + k]));
            difference = fmax(difference, cabs(one[i * 2 * OUT + k] - other[i * 2 * OUT + k]));
        }
        worst = fmax(worst, difference / largest);
    }
    /* two digits for resonances of a block by itself */
    CHECK_BELOW("response block by block against one matrix, relative", worst, 1e-12);
    bd_model_free(apart);
    bd_model_free(whole);
    pool_empty(&p);
}

/* Two coordinates whose diagonal vanishes at omega = 1: D = [[0, k], [k, 0]]. Without an exchange of rows there is no
 * pivot; at the other frequencies of the batch there is. */
static void a_vanishing_pivot_is_exchanged(void)
{
    enum { N = 5 };
    static const double omega[N] = {0.5, 1.0, 0.9999999, 1.5, 2.0};
    static const double force[] = {1.0, 0.0}, row[] = {1.0, 0.0, 0.0, 1.0}, none = 0.0;
    const double k = 0.25;
    pool p = {.n = 0};
    bd_model_data data = bare_system(&p, 2);
    for (int i = 0; i < 2; i++) {
        *entry(data.M, 2, i, i) = *entry(data.K, 2, i, i) = 1.0;
        *entry(data.K, 2, i, 1 - i) = k;
    }
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    const bd_harmonic_data question = {.n_omega = N,
                                       .n_in = 1,
                                       .n_out = 2,
                                       .omega = omega,
                                       .force = force,
                                       .row = row,
                                       .bearing_K = &none,
                                       .bearing_C = &none};
    double complex response[2 * N];
    CHECK_EQUAL("status", answer(model, &question, response), BD_OK);
    double worst = 0.0;
    for (int i = 0; i < N; i++) {
        const double d = 1.0 - omega[i] * omega[i], over = d * d - k * k;
        worst = fmax(worst, cabs(response[2 * i] - d / over));
        worst = fmax(worst, cabs(response[2 * i + 1] + k / over));
    }
    CHECK_BELOW("response where a pivot vanishes", worst, 1e-14 / k);
    bd_model_free(model);
    pool_empty(&p);
}

static void a_free_body_at_rest_is_singular(void)
{
    pool p = {.n = 0};
    bd_model_data data = bare_system(&p, 1);
    *entry(data.M, 1, 0, 0) = 1.0;
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    const double zero = 0.0, one = 1.0;
    double complex response;
    const bd_harmonic_data question = {.n_omega = 1,
                                       .n_in = 1,
                                       .n_out = 1,
                                       .omega = &zero,
                                       .modulus = &one,
                                       .bearing_K = &one,
                                       .bearing_C = &one,
                                       .force = &one,
                                       .row = &one};
    CHECK_EQUAL("status", answer(model, &question, &response), BD_SINGULAR_DYNAMIC);
    bd_model_free(model);
    pool_empty(&p);
}

int main(void)
{
    an_oscillator_on_a_layer_answers_in_closed_form();
    a_turning_oscillator_answers_in_closed_form();
    blocks_joined_by_bearings_answer_as_one();
    a_vanishing_pivot_is_exchanged();
    a_free_body_at_rest_is_singular();
    return check_result();
}
