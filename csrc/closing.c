/* Dampers that close: the jump of their force as samples and steps can see it. */
#include "closing.h"

#include <math.h>

#include "damping_table.h"
#include "elastic_force.h"

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

void bd_soften_closing(const bd_bearing_data *data, double window, bd_bearing_work *work,
                       size_t coefs, double *g)
{
    const double c = closing_damping(&data->contact);
    for (size_t j = 0; c > 0.0 && j < (size_t)data->n_balls; j++) {
        const double s = work->delta[j] + data->contact.h0, rate = work->rate[j];
        if (!(fabs(s) < 2.0 * rate * window))
            continue;
        double slope;
        const double x = s / (rate * window), step = sampled_step(x, &slope);
        const double root = bd_elastic_root(&data->contact, s);
        const double firm = 1.5 * data->contact.kappa * root;
        const double force = data->contact.kappa * root * root * root + c * rate * step;
        const double more = force - work->force[j];
        work->force[j] = force;
        work->stiffness[j] = firm / (1.0 + data->contact.give * firm) + c * slope / window;
        work->damping[j] = c * (step - x * slope);
        for (int k = 0; k < data->n_coefs; k++)
            g[k] += more * work->phi_ball[j * coefs + (size_t)k] *
                    (k < data->n_radial ? work->cosine_a[j] : work->sine_a[j]);
    }
}
