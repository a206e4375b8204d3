/* One bearing along a motion that is given: forces, tangents and powers, sample by sample. */
#include <math.h>
#include <string.h>

#include "bearing.h"
#include "damping_table.h"
#include "energy.h"
#include "kernels.h"

/* Doubles of the padded vectors and matrices of one sample. */
static size_t sample_size(const bd_bearing_data *data)
{
    const size_t coefs = (size_t)BD_PADDED(data->n_coefs), n = (size_t)data->n_coefs;
    return 3 * coefs + 2 * n * coefs;
}

/* The damping of a contact where its film closes: its force jumps there from 0 to so much times the rate. */
static double closing_damping(const bd_contact *contact)
{
    double slope;
    if (contact->law == BD_DAMPING_TABLE)
        return bd_table_damping(contact, -contact->h0, &slope);
    return contact->law == BD_DAMPING_CONSTANT ? contact->c : 0.0;
}

/* Hat function and its integral from the left. */
static double hat(double x, double *integral)
{
    const double a = fmin(fabs(x), 1.0), rest = 0.5 * (1.0 - a) * (1.0 - a);
    *integral = x < 0.0 ? rest : 1.0 - rest;
    return 1.0 - a;
}

/* A step that samples see as if they were an integral: from 0 at x = -2 to 1 at x = 2 of their distances, its slope a
 * sum of hats of total 1 whose second moment is zero. Sums over samples are then of fourth order in their distance, and
 * what aliases vanishes twice (a quasi-interpolant; I. J. Schoenberg, Quart. Appl. Math. 4 (1946) 45). */
static double sampled_step(double x, double *slope)
{
    double middle, left, right;
    *slope = 7.0 / 6.0 * hat(x, &middle);
    *slope -= (hat(x + 1.0, &left) + hat(x - 1.0, &right)) / 12.0;
    return 7.0 / 6.0 * middle - (left + right) / 12.0;
}

/* Where a film closes its damper makes the force jump from 0 to c times the rate. Every ball within two windows of it,
 * as s = delta + h0 runs through zero at its present rate, gets its share of the jump instead: forces are then
 * continuous in z. */
static void soften_jumps(const bd_bearing_data *data, double window, bd_bearing_work *work,
                         size_t coefs, double *g)
{
    const double c = closing_damping(&data->contact);
    for (size_t j = 0; c > 0.0 && j < (size_t)data->n_balls; j++) {
        const double s = work->delta[j] + data->contact.h0, rate = work->rate[j];
        if (!(fabs(s) < 2.0 * rate * window))
            continue;
        double slope;
        const double x = s / (rate * window), step = sampled_step(x, &slope);
        const double closed = fmax(s, 0.0), root = sqrt(closed);
        const double force = data->contact.kappa * closed * root + c * rate * step;
        const double more = force - work->force[j];
        work->force[j] = force;
        work->stiffness[j] = 1.5 * data->contact.kappa * root + c * slope / window;
        work->damping[j] = c * (step - x * slope);
        for (int k = 0; k < data->n_coefs; k++)
            g[k] += more * work->phi_ball[j * coefs + (size_t)k] *
                    (k < data->n_radial ? work->cosine_a[j] : work->sine_a[j]);
    }
}

size_t bd_bearing_along_size(const bd_bearing_data *data)
{
    return bd_bearing_constants(data) + bd_bearing_work_size(data) + sample_size(data);
}

bd_status bd_bearing_along(const bd_bearing_data *data, const bd_along_data *motion,
                           double *scratch, bd_along *found)
{
    const size_t coefs = (size_t)BD_PADDED(data->n_coefs), n = (size_t)data->n_coefs;
    const size_t balls = (size_t)data->n_balls;
    const bd_kernels *kernels = bd_kernels_for(BD_ISA_BEST);
    double *z = scratch + bd_bearing_constants(data) + bd_bearing_work_size(data);
    double *z_rate = z + coefs, *g = z_rate + coefs, *K = g + coefs, *C = K + n * coefs;
    double poison = 0.0; /* 0 times a number that is not finite is NaN */
    bd_bearing bearing;
    bd_bearing_work work;

    bd_bearing_setup(&bearing, data, scratch);
    bd_bearing_work_carve(&bearing, &work, scratch + bd_bearing_constants(data));
    for (size_t i = 0; i < (size_t)motion->n; i++) {
        memcpy(z, motion->z + i * n, n * sizeof *z);
        memcpy(z_rate, motion->z_rate + i * n, n * sizeof *z_rate);
        kernels->turn(&bearing, &work, motion->angle[i].cage);
        if (!bd_bearing_perfect(&bearing))
            bd_bearing_imperfect(&bearing, &work, &motion->angle[i], &motion->speed);
        kernels->force(&bearing, &work, z, z_rate, motion->speed.cage, g);
        if (motion->window > 0.0)
            soften_jumps(data, motion->window, &work, coefs, g);

        memcpy(found->g + i * n, g, n * sizeof *g);
        memcpy(found->loads + i * balls, work.force, balls * sizeof *work.force);
        found->heat[i] = bd_contact_loss(data, &work);
        double turning = 0.0, pressing = 0.0;
        for (size_t j = 0; j < balls; j++) {
            turning += work.force[j] * work.turning[j];
            pressing += work.force[j] * work.rate[j];
        }
        found->turning[i] = turning;
        found->pressing[i] = pressing;
        for (size_t k = 0; k < n; k++)
            poison += 0.0 * g[k];
        if (!found->K)
            continue;
        kernels->tangent(&bearing, &work, motion->speed.cage, (int)coefs, K, C);
        for (size_t k = 0; k < n; k++) {
            memcpy(found->K + (i * n + k) * n, K + k * coefs, n * sizeof *K);
            memcpy(found->C + (i * n + k) * n, C + k * coefs, n * sizeof *C);
        }
    }
    return poison == 0.0 ? BD_OK : BD_NOT_FINITE;
}
