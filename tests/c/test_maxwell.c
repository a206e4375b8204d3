/* Maxwell branches: weights and history against closed forms in long double. */
#include <complex.h>
#include <math.h>

#include "bearingdyn.h"
#include "check.h"
#include "systems.h"

/* p = x int_0^1 s e^(-xs) ds and q = x int_0^1 (1 - s) e^(-xs) ds. As series both have positive terms only;
 * beyond x = 2 the closed forms lose nothing. */
static void exact_weights(long double x, long double *p, long double *q)
{
    if (x > 2.0L) {
        long double loss = -expm1l(-x);
        *q = 1.0L - loss / x;
        *p = loss / x - expl(-x);
        return;
    }
    long double term = x * expl(-x);
    *p = *q = 0.0L;
    for (int k = 0; k < 60; k++) {
        *p += term / (long double)((k + 1) * (k + 2));
        *q += term / (long double)(k + 2);
        term *= x / (long double)(k + 1);
    }
}

static void weights_equal_the_closed_forms(void)
{
    double worst = 0.0;
    for (int i = 0; i <= 2200; i++) {
        const double tau = 0.37, modulus = 2.5e6;
        const double dt = tau * pow(10.0, -8.0 + 11.0 * (double)i / 2200.0);
        long double x = (long double)dt / (long double)tau, p, q;
        exact_weights(x, &p, &q);
        const long double scale = 2.0L * (long double)tau * (long double)modulus;
        bd_branch_weights w = bd_maxwell_weights(dt, tau, modulus);
        worst = fmax(worst, (double)fabsl((long double)w.old / (scale * p) - 1.0L));
        worst = fmax(worst, (double)fabsl((long double)w.now / (scale * q) - 1.0L));
        /* e^-x is as uncertain as the rounding of x itself, x units of round-off */
        const double room = 1.0 + (double)x;
        worst = fmax(worst, (double)fabsl((long double)w.decay - expl(-x)) / room);
    }
    /* a handful of roundings of 2.2e-16 */
    CHECK_BELOW("weights for dt/tau from 1e-8 to 1e3, relative", worst, 1.5e-15);
}

/* S of one branch at time[n] under rates linear between samples: a sum of ramps, theory.md section 1. */
static long double exact_stress(int n, const double *time, const double *rate, double modulus,
                                double tau)
{
    const long double factor = 2.0L * (long double)modulus * (long double)tau;
    long double sum = (long double)rate[0] *
                      -expm1l(-((long double)time[n] - (long double)time[0]) / (long double)tau);
    long double slope = 0.0L;
    for (int k = 0; k < n; k++) {
        const long double h = (long double)time[k + 1] - (long double)time[k];
        const long double next = ((long double)rate[k + 1] - (long double)rate[k]) / h;
        const long double since = (long double)time[n] - (long double)time[k];
        long double p, q;
        exact_weights(since / (long double)tau, &p, &q);
        sum += (next - slope) * since * q;
        slope = next;
    }
    return factor * sum;
}

static void history_is_exact_for_a_piecewise_linear_rate(void)
{
    enum { N = 40, M = 3 };
    static const double ratio[] = {1e-8, 1e-5, 1e-3, 0.04, 0.4, 0.6, 5.0, 1e3};
    unsigned long long seed = 3;
    double worst = 0.0;
    for (size_t i = 0; i < sizeof ratio / sizeof ratio[0]; i++) {
        const double modulus = 3e6, tau = 2e-3;
        double rate[N * M], one[N], dt[N - 1], time[N] = {0.0}, stress[N * M], work[8 * 6];
        for (int n = 0; n < N * M; n++)
            rate[n] = uniform(&seed); /* and so not zero at the start */
        for (int n = 0; n < N - 1; n++) {
            /* steps change; multiples of a power of two, so that the times are exact */
            const double step =
                ldexp(round(ldexp(ratio[i] * tau * (1.5 + uniform(&seed)), 40)), -40);
            time[n + 1] = time[n] + fmax(step, ldexp(1.0, -40));
            dt[n] = time[n + 1] - time[n];
        }
        CHECK_EQUAL("scratch of the stress", bd_maxwell_stress_work_size(M, 1), 48);
        bd_maxwell_stress(N, M, rate, dt, 0.0, 0.0, 1, &modulus, &tau, stress, work);
        for (int c = 0; c < M; c++) {
            double largest = 0.0, error = 0.0;
            for (int n = 0; n < N; n++)
                one[n] = rate[n * M + c];
            for (int n = 0; n < N; n++) {
                const long double expected = exact_stress(n, time, one, modulus, tau);
                largest = fmax(largest, (double)fabsl(expected));
                error = fmax(error, (double)fabsl((long double)stress[n * M + c] - expected));
            }
            worst = fmax(worst, error / largest);
        }
    }
    CHECK_BELOW("stress under a piecewise-linear rate, changing dt, relative", worst, 1e-12);
}

static void spring_and_dashpot_stand_in_parallel(void)
{
    const double rate[] = {2.0, 3.0, -1.0}, dt[] = {0.5, 0.25}, G0 = 7.0, eta0 = 11.0;
    double stress[3], work[8 * 5];
    bd_maxwell_stress(3, 1, rate, dt, G0, eta0, 0, NULL, NULL, stress, work);
    CHECK_CLOSE("stress at the start", stress[0], 2.0 * eta0 * 2.0, 1e-14);
    CHECK_CLOSE("stress after a step", stress[1], 2.0 * G0 * 1.25 + 2.0 * eta0 * 3.0, 1e-13);
    CHECK_CLOSE("stress after two", stress[2], 2.0 * G0 * 1.5 - 2.0 * eta0, 1e-13);
}

/* Relative error of the discrete branch modulus (average acceleration: the strain is the trapezoidal sum of the
 * rate) against i omega tau/(1 + i omega tau), at dt/tau = omega dt = x. */
static double modulus_error(double x)
{
    const bd_branch_weights w = bd_maxwell_weights(x, 1.0, 0.5);
    const double complex z = cexp(I * x), strain = 0.5 * x * (z + 1.0) / (z - 1.0);
    const double complex got = (w.old + w.now * z) / (z - w.decay) / strain;
    return cabs(got / (I / (1.0 + I)) - 1.0);
}

static void discrete_modulus_is_fourth_order(void)
{
    /* two digits are given in theory.md section 1 */
    CHECK_CLOSE("discrete modulus at dt/tau = omega dt = 0.1", modulus_error(0.1), 5.7e-7, 0.05e-7);
    CHECK_CLOSE("discrete modulus at dt/tau = omega dt = 0.5", modulus_error(0.5), 3.7e-4, 0.05e-4);
    /* half the step divides an error of fourth order by 16, but for terms of (x/2)^2 */
    CHECK_CLOSE("order of the discrete modulus", log2(modulus_error(0.1) / modulus_error(0.05)),
                4.0, 0.02);
}

int main(void)
{
    weights_equal_the_closed_forms();
    history_is_exact_for_a_piecewise_linear_rate();
    spring_and_dashpot_stand_in_parallel();
    discrete_modulus_is_fourth_order();
    return check_result();
}
