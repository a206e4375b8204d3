#include "maxwell.h"

#include <math.h>
#include <string.h>

/* Below this dt/tau the closed forms cancel (q -> x/2 out of 1 - 1), so the series is summed; sixteen
 * terms leave less than 1e-18 at x = 1/2. */
static const double series_limit = 0.5;

/* q(x) = 1 - (1 - e^-x)/x and p(x) = (1 - e^-x) - q(x) = (1 - e^-x)/x - e^-x. */
static void ramp_weights(double x, double *p, double *q)
{
    if (x >= series_limit) {
        double mean = -expm1(-x) / x;
        *q = 1.0 - mean;
        *p = mean - exp(-x);
        return;
    }
    double term = 1.0; /* (-1)^(k+1) x^k / (k+1)! */
    double sum_q = 0.0, sum_p = 0.0;
    for (int k = 1; k <= 16; k++) {
        term *= (k == 1 ? x : -x) / (double)(k + 1);
        sum_q += term;
        sum_p += term * (double)k;
    }
    *q = sum_q;
    *p = sum_p;
}

bd_branch_weights bd_maxwell_weights(double dt, double tau, double modulus)
{
    double x = dt / tau, p, q;
    ramp_weights(x, &p, &q);
    return (bd_branch_weights){
        .decay = exp(-x),
        .old = 2.0 * tau * modulus * p,
        .now = 2.0 * tau * modulus * q,
    };
}

size_t bd_maxwell_stress_work_size(int n_components, int n_branches)
{
    return (size_t)BD_PADDED(n_components) * (5 + (size_t)n_branches);
}

void bd_maxwell_stress(int n_times, int n_components, const double *rate, const double *dt,
                       double G0, double eta0, int n_branches, const double *modulus,
                       const double *tau, double *stress, double *work)
{
    const int padded = BD_PADDED(n_components);
    const size_t row = (size_t)n_components * sizeof *rate, room = (size_t)padded;
    double *strain = work, *before = strain + room, *now = before + room;
    double *trial = now + room, *history = trial + room, *branches = history + room;
    memset(work, 0, bd_maxwell_stress_work_size(n_components, n_branches) * sizeof *work);

    for (int n = 0; n < n_times; n++) {
        double *out = stress + (size_t)n * (size_t)n_components;
        memcpy(before, now, row);
        memcpy(now, rate + (size_t)n * (size_t)n_components, row);
        memset(history, 0, room * sizeof *history);

        /* at the first sample nothing has happened yet: e = 0 and S = 0 */
        for (int i = 0; n > 0 && i < n_branches; i++) {
            double *S = branches + (size_t)i * room;
            bd_branch_weights w = bd_maxwell_weights(dt[n - 1], tau[i], modulus[i]);
            maxwell_trial(padded, w, S, before, trial, history);
            maxwell_commit(padded, w, trial, now, S);
            for (int c = 0; c < n_components; c++)
                history[c] += w.now * now[c];
        }
        for (int c = 0; c < n_components; c++) {
            if (n > 0)
                strain[c] += 0.5 * dt[n - 1] * (before[c] + now[c]);
            out[c] = 2.0 * G0 * strain[c] + 2.0 * eta0 * now[c] + history[c];
        }
    }
}
