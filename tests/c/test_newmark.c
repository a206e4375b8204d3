/* Newmark's scheme on linear structures: order, conservation of energy. */
#include <math.h>
#include <stdlib.h>

#include "bearingdyn.h"
#include "check.h"
#include "reference_lapack.h"
#include "systems.h"

static const double pi = 3.14159265358979323846;

/* A state at (x, v), started, after n_steps. */
static double *run(pool *p, const bd_model *model, const bd_scheme *scheme, const double *x,
                   const double *v, long long n_steps)
{
    double *state = pool_take(p, bd_state_size(model), sizeof *state);
    const size_t channels = (size_t)bd_model_channels(model);
    double *record = pool_take(p, 2 * channels, sizeof *record);
    bd_work *work = bd_work_create(model);
    bd_report report;
    bd_state_set(model, state, 0.0, x, v);
    CHECK_EQUAL("start", bd_start(model, scheme, &reference_lapack, work, state), BD_OK);
    CHECK_EQUAL("prepare", bd_prepare(model, scheme, &reference_lapack, 0.0, work), BD_OK);
    bd_march(model, scheme, work, state, n_steps, n_steps, record, &report);
    CHECK_EQUAL("march", report.status, BD_OK);
    CHECK_EQUAL("steps", report.steps, n_steps);
    bd_work_free(work);
    return state;
}

/* Displacement after 0.5 s of a damped oscillator of 3 Hz under a force of 2 Hz, from x = 1, v = -2. */
static double oscillate(double beta, double gamma, int n_steps)
{
    pool p = {.n = 0};
    bd_model_data data = bare_system(&p, 1);
    *entry(data.M, 1, 0, 0) = 2.0;
    *entry(data.C, 1, 0, 0) = 1.5;
    *entry(data.K, 1, 0, 0) = 2.0 * 36.0 * pi * pi;
    const double p_cos = 40.0, p_sin = -25.0, x = 1.0, v = -2.0;
    const bd_load_data load = {
        .kind = BD_LOAD_HARMONIC, .omega = 4.0 * pi, .p_cos = &p_cos, .p_sin = &p_sin};
    data.n_loads = 1;
    data.loads = &load;
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    bd_scheme scheme = {.speed = no_turning,
                        .dt = 0.5 / n_steps,
                        .beta = beta,
                        .gamma = gamma,
                        .tolerance = 1e-9,
                        .max_iterations = 10};
    double result, t;
    bd_state_get(model, run(&p, model, &scheme, &x, &v, n_steps), &t, &result, NULL, NULL);
    CHECK_CLOSE("time at the end", t, 0.5, 1e-15);
    bd_model_free(model);
    pool_empty(&p);
    return result;
}

/* The same in closed form. */
static double oscillator_exact(double t)
{
    const double m = 2.0, c = 1.5, k = 2.0 * 36.0 * pi * pi, omega = 4.0 * pi, P = 40.0, Q = -25.0;
    const double re = k - m * omega * omega, im = c * omega, size = re * re + im * im;
    /* steady: a cos + b sin */
    const double a = (P * re - Q * im) / size, b = (Q * re + P * im) / size;
    const double sigma = c / (2.0 * m), damped = sqrt(k / m - sigma * sigma);
    const double A = 1.0 - a, B = (-2.0 - b * omega + sigma * A) / damped;
    return a * cos(omega * t) + b * sin(omega * t) +
           exp(-sigma * t) * (A * cos(damped * t) + B * sin(damped * t));
}

static void order_is_two_on_a_smooth_problem(void)
{
    /* average acceleration, linear acceleration, Fox and Goodwin's beta, central differences */
    static const double betas[] = {0.25, 1.0 / 6.0, 0.0};
    for (int i = 0; i < 3; i++)
        for (int n = 200; n <= 800; n *= 2) {
            const double exact = oscillator_exact(0.5);
            const double coarse = oscillate(betas[i], 0.5, n) - exact;
            const double fine = oscillate(betas[i], 0.5, 2 * n) - exact;
            CHECK_CLOSE("order of Newmark's scheme", log2(fabs(coarse / fine)), 2.0, 0.05);
        }
    /* gamma away from one half costs an order */
    const double exact = oscillator_exact(0.5);
    const double coarse = oscillate(0.3, 0.6, 1600) - exact,
                 fine = oscillate(0.3, 0.6, 3200) - exact;
    CHECK_CLOSE("order with gamma = 0.6", log2(fabs(coarse / fine)), 1.0, 0.1);
}

/* (v^T v + x^T K x)/2 of one coordinate with unit mass, or of all. */
static double energy_of(int n, const double *K, const double *x, const double *v)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++) {
        double force = 0.0;
        for (int j = 0; j < n; j++)
            force += K[i * n + j] * x[j];
        sum += 0.5 * (v[i] * v[i] + x[i] * force);
    }
    return sum;
}

/* 1e5 steps of 2.5 us without damping. */
static void average_acceleration_conserves_energy(int coupled)
{
    enum { N = 16, STEPS = 100000 };
    pool p = {.n = 0};
    unsigned long long seed = 5;
    bd_model_data data = bare_system(&p, N);
    double *Q = random_rotation(&p, N, &seed), omega2[N], x[N], v[N];
    for (int i = 0; i < N; i++) {
        omega2[i] = pow(2.0 * pi * 10.0 * pow(1e3, i / (N - 1.0)), 2.0); /* 10 Hz to 10 kHz */
        x[i] = (1.0 + 0.5 * uniform(&seed)) / sqrt(omega2[i]);
        v[i] = uniform(&seed);
        *entry(data.M, N, i, i) = 1.0;
    }
    for (int i = 0; i < N; i++)
        for (int j = 0; j <= i; j++) {
            double k = coupled ? 0.0 : (i == j ? omega2[i] : 0.0);
            for (int m = 0; coupled && m < N; m++)
                k += Q[m * N + i] * omega2[m] * Q[m * N + j];
            *entry(data.K, N, i, j) = k;
            *entry(data.K, N, j, i) = k;
        }
    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    CHECK_EQUAL("blocks", bd_model_blocks(model), coupled ? 1 : N);
    bd_scheme scheme = {.speed = no_turning,
                        .dt = 2.5e-6,
                        .beta = 0.25,
                        .gamma = 0.5,
                        .tolerance = 1e-9,
                        .max_iterations = 10};
    double *state = run(&p, model, &scheme, x, v, STEPS), x_end[N], v_end[N];
    bd_state_get(model, state, NULL, x_end, v_end, NULL);
    if (coupled) {
        const double before = energy_of(N, data.K, x, v),
                     after = energy_of(N, data.K, x_end, v_end);
        CHECK_BELOW("change of energy of coupled modes", fabs(after / before - 1.0), 1e-10);
    } else {
        double worst = 0.0;
        for (int i = 0; i < N; i++) {
            const double before = energy_of(1, &omega2[i], &x[i], &v[i]);
            worst =
                fmax(worst, fabs(energy_of(1, &omega2[i], &x_end[i], &v_end[i]) / before - 1.0));
        }
        CHECK_BELOW("change of energy of each mode", worst, 1e-10);
    }
    bd_model_free(model);
    pool_empty(&p);
}

int main(void)
{
    order_is_two_on_a_smooth_problem();
    average_acceleration_conserves_energy(0);
    average_acceleration_conserves_energy(1);
    return check_result();
}
