/* Echoes of what is pressed: weights of a step against closed forms in long double. */
#include <complex.h>
#include <math.h>

#include "bearingdyn.h"
#include "check.h"
#include "systems.h"

/* Integrals of exp(z (1 - t)) and t exp(z (1 - t)) over 0 ... 1. Of the series all terms are summed in long double,
 * whose largest is e^|z|: for |z| <= 4 that costs two digits of nineteen. */
static void exact_integrals(long double complex z, long double complex *mean,
                            long double complex *late)
{
    if (cabsl(z) > 4.0L) {
        *mean = (cexpl(z) - 1.0L) / z;
        *late = (*mean - 1.0L) / z;
        return;
    }
    long double complex term = 1.0L;
    *mean = *late = 0.0L;
    for (int k = 0; k < 80; k++) {
        *mean += term;
        *late += term / (long double)(k + 2);
        term *= z / (long double)(k + 2);
    }
}

static double away(const double *found, long double complex expected, long double scale)
{
    const long double re = (long double)found[0] - creall(expected),
                      im = (long double)found[1] - cimagl(expected);
    return (double)(hypotl(re, im) / scale);
}

static void weights_equal_the_closed_forms(void)
{
    double worst = 0.0;
    for (int i = 0; i <= 1100; i++)
        for (int turn = 0; turn <= 8; turn++) {
            const double size = pow(10.0, -8.0 + 11.0 * (double)i / 1100.0), dt = 3e-6;
            const double angle = 1.5 * (double)turn / 8.0; /* real part positive */
            const bd_echo echo = {{size / dt * cos(angle), size / dt * sin(angle)}, {1.0, 0.0}};
            const bd_echo_weights w = bd_echo_step(&echo, dt);
            const long double complex z =
                -(long double)dt * ((long double)echo.decay[0] + (long double)echo.decay[1] * I);
            long double complex mean, late;
            exact_integrals(z, &mean, &late);
            const long double h = (long double)dt;
            worst = fmax(worst, away(w.now, h * late, h * cabsl(late)));
            /* beyond |z| of 1 the old rate counts for less than the new one by |z|, and so do its roundings */
            const long double larger = fmaxl(cabsl(mean - late), cabsl(late));
            worst = fmax(worst, away(w.old, h * (mean - late), h * larger));
            worst = fmax(worst, away(w.decay, cexpl(z), 1.0L + cabsl(z)));
        }
    /* closed forms from |z| = .5 on: 1 - mean loses a factor of four, mean - late as much again */
    CHECK_BELOW("weights for |decay| dt from 1e-8 to 1e3, relative", worst, 2e-14);
}

/* Under p = p0 + p1 t an echo that began at rest is known. */
static void steps_are_exact_for_a_rate_linear_in_time(void)
{
    const bd_echo echo = {{4e4, -9e4}, {1.0, 0.0}};
    const long double complex d = 4e4L - 9e4L * I;
    const double steps[] = {1e-6, 3e-6, 1e-7, 2e-5, 2e-5};
    long double t = 0.0L;
    double q[2] = {0.0, 0.0}, worst = 0.0;
    for (int k = 0; k < 5; k++) {
        const bd_echo_weights w = bd_echo_step(&echo, steps[k]);
        const double p = (double)(0.3L + 7e4L * t);
        t += (long double)steps[k];
        const double p_new = (double)(0.3L + 7e4L * t);
        const double re = w.decay[0] * q[0] - w.decay[1] * q[1] + w.old[0] * p + w.now[0] * p_new;
        q[1] = w.decay[1] * q[0] + w.decay[0] * q[1] + w.old[1] * p + w.now[1] * p_new;
        q[0] = re;
        const long double complex fade = cexpl(-d * t);
        const long double complex exact =
            (0.3L / d) * (1.0L - fade) + 7e4L * (t / d - (1.0L - fade) / (d * d));
        worst = fmax(worst, away(q, exact, cabsl(exact)));
    }
    CHECK_BELOW("an echo after unequal steps, relative", worst, 1e-13);
}

int main(void)
{
    weights_equal_the_closed_forms();
    steps_are_exact_for_a_rate_linear_in_time();
    return check_result();
}
