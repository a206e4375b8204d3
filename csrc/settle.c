/* settle.c - where a bearing comes to rest under given loads: the minimum of its energy, case by case. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bearing.h"
#include "kernels.h"

/* As in bearingdyn/bearing/energy_minimum.py, which is the specification. */
static const double tolerance = 1e-12, parted = 1e-20, round_off = 2.220446049250313e-16;
enum { MOST_STEPS = 400 };

struct bd_settle {
    bd_bearing bearing;
    bd_bearing_work work;
    const bd_kernels *kernels;
    int n, stride;
    double cage, *z, *rate, *g, *K, *C; /* padded */
    double *trial, *r, *step, *factor;  /* trial padded; the rest (n), (n), (n x n) */
};

bd_settle *bd_settle_create(const bd_bearing_data *data, double angle, double shaft_angle)
{
    const size_t n = (size_t)data->n_coefs, coefs = (size_t)BD_PADDED(data->n_coefs);
    const size_t constants = bd_bearing_constants(data), scratch = bd_bearing_work_size(data);
    const size_t own = 4 * coefs + 2 * n * coefs + 2 * n + n * n;
    bd_settle *s = calloc(1, sizeof *s + (constants + scratch + own) * sizeof(double));
    if (!s)
        return NULL;
    double *memory = (double *)(s + 1);
    s->kernels = bd_kernels_for(BD_ISA_BEST);
    s->n = data->n_coefs;
    s->stride = (int)coefs;
    bd_bearing_setup(&s->bearing, data, memory);
    bd_bearing_work_carve(&s->bearing, &s->work, memory + constants);
    s->z = memory + constants + scratch;
    s->rate = s->z + coefs;
    s->g = s->rate + coefs;
    s->trial = s->g + coefs;
    s->K = s->trial + coefs;
    s->C = s->K + n * coefs;
    s->r = s->C + n * coefs;
    s->step = s->r + n;
    s->factor = s->step + n;
    s->kernels->turn(&s->bearing, &s->work, angle);
    if (!bd_bearing_perfect(&s->bearing)) {
        const bd_bodies stand = bd_bearing_bodies(data, angle, shaft_angle), still = {0};
        bd_bearing_imperfect(&s->bearing, &s->work, &stand, &still);
    }
    return s;
}

void bd_settle_free(bd_settle *settle)
{
    free(settle);
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Stored energy at z, with force and sum of loads left behind. */
static double press(bd_settle *s, const double *z, double *held)
{
    const bd_bearing_data *data = &s->bearing.data;
    double energy = 0.0;
    *held = 0.0;
    s->kernels->force(&s->bearing, &s->work, z, s->rate, 0.0, s->g);
    for (int j = 0; j < data->n_balls; j++) {
        const double F = s->work.force[j];
        /* the integral of kappa s^1.5 is (2/5) F s */
        energy += 0.4 * F * (s->work.delta[j] + data->contact.h0);
        *held += F;
    }
    return energy;
}

/* step = -(K + mu I)^-1 r by Cholesky. Returned: 0, or nonzero where it is not positive definite. */
static int solve(bd_settle *s, double mu)
{
    const int n = s->n;
    double *L = s->factor, *x = s->step;
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            double sum = s->K[i * s->stride + j] + (i == j ? mu : 0.0);
            for (int k = 0; k < j; k++)
                sum -= L[i * n + k] * L[j * n + k];
            if (i == j) {
                if (!(sum > 0.0))
                    return 1;
                L[i * n + i] = sqrt(sum);
            } else {
                L[i * n + j] = sum / L[j * n + j];
            }
        }
    for (int i = 0; i < n; i++) {
        double sum = -s->r[i];
        for (int k = 0; k < i; k++)
            sum -= L[i * n + k] * x[k];
        x[i] = sum / L[i * n + i];
    }
    for (int i = n - 1; i >= 0; i--) {
        double sum = x[i];
        for (int k = i + 1; k < n; k++)
            sum -= L[k * n + i] * x[k];
        x[i] = sum / L[i * n + i];
    }
    return 0;
}

bd_settled bd_settle_case(bd_settle *s, const double *load, double radius, double *z_out,
                          double *loads_out)
{
    const int n = s->n;
    const double size = sqrt(dot(n, load, load));
    double held, mu = size > 0.0 ? size / radius : 1.0;
    bd_settled outcome = BD_SETTLED_NOT;

    memset(s->z, 0, (size_t)s->stride * sizeof *s->z);
    double energy = press(s, s->z, &held), residual = 0.0;
    for (int steps = 0; steps < MOST_STEPS; steps++) {
        for (int i = 0; i < n; i++)
            s->r[i] = s->g[i] - load[i];
        residual = sqrt(dot(n, s->r, s->r));
        if (residual <= fmax(tolerance * (size + held), parted)) {
            outcome = BD_SETTLED;
            break;
        }
        if (!isfinite(residual))
            break;
        s->kernels->tangent(&s->bearing, &s->work, 0.0, s->stride, s->K, s->C);
        double trace = 0.0;
        for (int i = 0; i < n; i++)
            trace += s->K[i * s->stride + i];
        /* the springs that hold flat motions: of no effect on the others */
        mu = fmax(mu, 1e-13 * trace);
        bool moved = false, ended = false;
        while (!moved && !ended && isfinite(mu)) {
            if (solve(s, mu)) {
                mu = fmax(4.0 * mu, 1e-12 * trace);
                continue;
            }
            const double length = sqrt(dot(n, s->step, s->step));
            double curved = 0.0, held_there;
            for (int i = 0; i < n; i++)
                curved += s->step[i] * dot(n, s->K + i * s->stride, s->step);
            for (int i = 0; i < n; i++)
                s->trial[i] = s->z[i] + s->step[i];
            const double there = press(s, s->trial, &held_there);
            const double gain = energy - there + dot(n, load, s->step);
            const double promised = -dot(n, s->step, s->r) - 0.5 * curved;
            double left = 0.0;
            for (int i = 0; i < n; i++)
                left += (s->g[i] - load[i]) * (s->g[i] - load[i]);
            const bool better = sqrt(left) < residual;
            if (gain > 1e-4 * promised || better) {
                memcpy(s->z, s->trial, (size_t)n * sizeof *s->z);
                energy = there;
                held = held_there;
                moved = true;
                mu *= gain > 0.75 * promised || (better && sqrt(left) < 0.1 * residual) ? 0.02
                      : gain < 0.1 * promised && !better                                ? 4.0
                                                                                        : 1.0;
            } else {
                /* energies agree to round-off near the minimum; there the residual decides */
                ended = length <= 8.0 * round_off * sqrt(dot(n, s->z, s->z));
                mu = 8.0 * fmax(mu, 1e-12 * trace);
            }
        }
        if (!moved) {
            press(s, s->z, &held);
            outcome = ended ? BD_SETTLED : BD_SETTLED_NOT;
            break;
        }
    }
    if (outcome == BD_SETTLED && bd_bearing_runs_off(&s->bearing, &s->work))
        outcome = BD_SETTLED_ASTRAY;
    memcpy(z_out, s->z, (size_t)n * sizeof *z_out);
    memcpy(loads_out, s->work.force, (size_t)s->bearing.data.n_balls * sizeof *loads_out);
    return outcome;
}
