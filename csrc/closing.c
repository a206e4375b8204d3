/* Contacts that close and open: their force as samples and steps can see it.
 *
 * While a ball passes the edge of its contact, s = delta + h0 grows by h = |rate| window from sample to sample, and the
 * force over it is kappa h^1.5 M(xi), xi = s/h, with M = xi^1.5 + a xi^0.5 + b from xi = edge on and 0 before. In its
 * place comes the central second difference of fourth order of M's second integral. That is M under a kernel of total 1
 * without a second or third moment, so that sums over samples are of fourth order in their distance, and what aliases
 * vanishes twice (a quasi-interpolant; I. J. Schoenberg, Quart. Appl. Math. 4 (1946) 45). */
#include "closing.h"

#include <math.h>

#include "damping_table.h"

/* In distances h behind the edge: up to where all of the difference is taken, and from where on none. Between, M is
 * smooth, and the difference some 1e-4 of it. */
static const double near = 3.0, far = 5.0;
/* An edge further from s = 0 than so many h is taken by M's powers there, since the integrals cancel. */
static const double remote = 50.0;
enum { POWERS = 9 };

typedef struct shape {
    double edge, a, b;
    double power[POWERS]; /* of M about a remote edge */
} shape;

/* Second integral of M from the edge to xi; its slopes by xi and by b. */
static double integral(const shape *m, double xi, double *slope, double *by_b)
{
    const double y = xi - m->edge;
    *slope = *by_b = 0.0;
    if (!(y > 0.0))
        return 0.0;
    *by_b = 0.5 * y * y;
    if (m->edge > remote) {
        double sum = 0.0, power = y;
        for (int k = 1; k < POWERS; k++) {
            power *= y;
            *slope += m->power[k] * power / (k + 1);
            sum += m->power[k] * power * y / ((k + 1) * (k + 2));
        }
        return sum;
    }
    const double e = m->edge, root = sqrt(xi), base = sqrt(e);
    const double xi_first = xi * (xi * root * 0.4 + m->a * root / 1.5 + m->b);
    const double e_first = e * (e * base * 0.4 + m->a * base / 1.5 + m->b);
    const double xi_second =
        xi * xi * (xi * root * (4.0 / 35.0) + m->a * root * (4.0 / 15.0) + 0.5 * m->b);
    const double e_second =
        e * e * (e * base * (4.0 / 35.0) + m->a * base * (4.0 / 15.0) + 0.5 * m->b);
    *slope = xi_first - e_first;
    return xi_second - e_second - e_first * y;
}

/* M's powers about its edge: of (edge + y)^1.5 + a (edge + y)^0.5. */
static void take_powers(shape *m)
{
    double own = m->edge * sqrt(m->edge), more = m->a * sqrt(m->edge);
    for (int k = 0; k < POWERS; k++) {
        m->power[k] = own + more;
        own *= (1.5 - k) / ((k + 1) * m->edge);
        more *= (0.5 - k) / ((k + 1) * m->edge);
    }
}

/* M, its slopes by xi and by b. */
static double force_of(const shape *m, double xi, double *slope, double *by_b)
{
    *slope = *by_b = 0.0;
    if (!(xi > m->edge))
        return 0.0;
    const double root = sqrt(xi);
    *by_b = 1.0;
    *slope = 1.5 * root + 0.5 * m->a / root;
    return root * (xi + m->a) + m->b;
}

/* What softening adds to M, with its slopes. */
static double softened(const shape *m, double xi, double *slope, double *by_b)
{
    static const double weights[] = {-1.0 / 12.0, 4.0 / 3.0, -2.5, 4.0 / 3.0, -1.0 / 12.0};
    const double taper = fmin(1.0, (far - (xi - m->edge)) / (far - near));
    double sum = -force_of(m, xi, slope, by_b);
    *slope = -*slope, *by_b = -*by_b;
    for (int k = 0; k < 5; k++) {
        double slope_k, by_b_k;
        sum += weights[k] * integral(m, xi + (k - 2), &slope_k, &by_b_k);
        *slope += weights[k] * slope_k;
        *by_b += weights[k] * by_b_k;
    }
    *slope = *slope * taper - (taper < 1.0 ? sum / (far - near) : 0.0);
    *by_b *= taper;
    return sum * taper;
}

/* Whether a ball is near its edge; then M there. */
static bool take_shape(const bd_contact *contact, double s, double rate, double h, shape *m)
{
    const double kappa = contact->kappa, size = kappa * h * sqrt(h), reach = s - far * h;
    double slope, c = 0.0;
    *m = (shape){0};
    if (!(h > 0.0) || !(s > -2.0 * h))
        return false;
    if (contact->law == BD_DAMPING_LOAD) {
        m->a = 1.5 * contact->c * rate / h;
        m->edge = fmax(0.0, -m->a);
        if (!(reach < m->edge * h))
            return false;
    } else {
        if (contact->law == BD_DAMPING_CONSTANT)
            c = contact->c;
        else if (contact->law == BD_DAMPING_TABLE)
            c = bd_table_damping(contact, -contact->h0, &slope);
        const double jump = c * rate;
        if (reach > 0.0 && !(jump < 0.0 && kappa * kappa * reach * reach * reach < jump * jump))
            return false;
        m->b = jump / size;
        m->edge = jump < 0.0 ? cbrt(m->b * m->b) : 0.0;
    }
    if (m->edge > remote)
        take_powers(m);
    return s > (m->edge - 2.0) * h && s < (m->edge + far) * h;
}

void bd_soften_edges(const bd_bearing_data *data, double window, bd_bearing_work *work,
                     size_t coefs, double *g)
{
    const bd_contact *contact = &data->contact;
    if (contact->law == BD_DAMPING_FILM || contact->law == BD_DAMPING_CARRIED)
        return;
    for (size_t j = 0; j < (size_t)data->n_balls; j++) {
        const double s = work->delta[j] + contact->h0, rate = work->rate[j];
        const double speed = fabs(rate), h = speed * window;
        shape m;
        if (!take_shape(contact, s, rate, h, &m))
            continue;
        double slope, by_b;
        const double size = contact->kappa * h * sqrt(h), xi = s / h;
        const double more = softened(&m, xi, &slope, &by_b);
        work->force[j] += size * more;
        work->stiffness[j] += size * slope / h;
        /* kappa (speed window)^1.5 M(s/(speed window)), where b goes with speed^-0.5 and a stays */
        work->damping[j] += size / rate * (1.5 * more - xi * slope - 0.5 * m.b * by_b);
        for (int k = 0; k < data->n_coefs; k++)
            g[k] += size * more * work->phi_ball[j * coefs + (size_t)k] *
                    (k < data->n_radial ? work->cosine_a[j] : work->sine_a[j]);
    }
}
