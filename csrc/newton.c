/* The bearing forces of one step, on their few coefficients alone:
 *     z = z* - beta dt^2 W g(z, zdot),   zdot = zdot* - gamma dt W g,   W = B S^-1 B^T
 * by Newton's iteration with a matrix that is kept from step to step while it serves. */
#include "newton.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "closing.h"
#include "dense.h"
#include "grazing.h"
#include "kernels.h"

/* From here on corrections are halved; where a ball hops across the jump of its force, balls are held instead. */
enum { GRAZING = 10 };
/* Corrections with held balls: so many in which all that must move do, then one ball at a time (the first, which
 * comes to an end where W is a P-matrix: Murty 1974). */
enum { TOGETHER = 20, HELD = 400 };
/* Of the tolerance, what an exact step's last correction may leave by the rate of the one before it, and that rate. */
static const double left_over = 0.1, steep = 0.01;
/* A position is known to so many times its rounding error. */
static const double rounding = 16.0 * DBL_EPSILON;

void bd_turn_bearings(const bd_model *model, bd_work *work)
{
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        const double psi = bearing->data.angle0 + bearing->data.cage_ratio * work->turn.angle;
        if (!work->bearings[b].led)
            work->kernels->turn(bearing, &work->bearings[b], psi);
        if (!bd_bearing_perfect(bearing)) {
            const double cage_speed = bearing->data.cage_ratio * work->turn.speed;
            const bd_bodies stand = bd_bearing_bodies(&bearing->data, psi, work->turn.angle);
            const bd_bodies turn = bd_bearing_bodies(&bearing->data, cage_speed, work->turn.speed);
            bd_bearing_imperfect(bearing, &work->bearings[b], &stand, &turn);
        }
    }
}

void bd_force_bearings(const bd_model *model, bd_work *work)
{
    for (int b = 0; b < model->n_bearings; b++) {
        int at = model->bearing_slot[b];
        work->kernels->force(
            &model->bearings[b], &work->bearings[b], work->z + at, work->z_rate + at,
            model->bearings[b].data.cage_ratio * work->turn.speed, work->force + at);
        /* exact steps hold forces as polynomials, which kinks and jumps would put out */
        if (work->exact && !work->bearings[b].holds)
            bd_soften_edges(&model->bearings[b].data, work->scheme.dt, &work->bearings[b],
                            (size_t)model->bearings[b].coefs, work->force + at);
    }
}

void bd_guess_bearings(const bd_model *model, bd_work *work, const bd_state *state)
{
    const size_t m = (size_t)model->coefs;
    for (size_t k = 0; k < m; k++)
        work->guess[k] = 3.0 * (state->g[k] - state->g_before[k]) + state->g_before[m + k];
}

/* Newton's matrix I + (beta dt^2 K + gamma dt C) W at the last evaluation, inverted.
 * Returned: 0, or nonzero where it is singular. */
static int refresh(const bd_model *model, bd_work *work)
{
    const size_t m = (size_t)model->coefs;

    memset(work->J, 0, m * m * sizeof *work->J);
    for (size_t k = 0; k < m; k++)
        work->J[k * m + k] = 1.0;
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        const size_t at = (size_t)model->bearing_slot[b], n = (size_t)bearing->data.n_coefs;
        const size_t stride = (size_t)bearing->coefs;
        work->kernels->tangent(bearing, &work->bearings[b],
                               bearing->data.cage_ratio * work->turn.speed, bearing->coefs, work->K,
                               work->C);
        for (size_t k = 0; k < n; k++)
            for (size_t l = 0; l < n; l++) {
                if (work->exact) {
                    for (size_t c = 0; c < m; c++)
                        work->J[(at + k) * m + c] +=
                            work->K[k * stride + l] * work->W[c * m + at + l] +
                            work->C[k * stride + l] * work->W_rate[c * m + at + l];
                    continue;
                }
                double tangent =
                    work->in_x * work->K[k * stride + l] + work->in_v * work->C[k * stride + l];
                for (size_t c = 0; c < m; c++)
                    work->J[(at + k) * m + c] += tangent * work->W[c * m + at + l];
            }
    }
    return bd_invert((int)m, (int)m, work->J, work->inverse);
}

/* Largest |force - guess| and |force|; NaN in any of them makes the first NaN. */
static void measure(const bd_model *model, const bd_work *work, double *residual, double *scale)
{
    double largest_residual = 0.0, largest = 0.0, poison = 0.0;
    for (int k = 0; k < model->coefs; k++) {
        double difference = fabs(work->force[k] - work->guess[k]), size = fabs(work->force[k]);
        largest_residual = difference > largest_residual ? difference : largest_residual;
        largest = size > largest ? size : largest;
        poison += work->z[k] * 0.0 + difference * 0.0;
    }
    *residual = largest_residual + poison;
    *scale = largest;
}

/* Holds the balls of every bearing, whose tangents were taken at the last evaluation.
 * Returned: whether any force can jump */
static bool hold_balls(const bd_model *model, bd_work *work)
{
    bool any = false;
    for (int b = 0; b < model->n_bearings; b++) {
        const size_t at = (size_t)model->bearing_slot[b], m = (size_t)model->coefs;
        bd_hold(&model->bearings[b], &work->bearings[b], work->W + at * m + at, m, work->in_x);
        any = any || work->bearings[b].holds;
    }
    return any;
}

static void release_balls(const bd_model *model, bd_work *work)
{
    for (int b = 0; b < model->n_bearings; b++)
        work->bearings[b].holds = false;
}

/* Held balls after an evaluation: moves those whose place is wrong by more than a force `least`, all `together` or one
 * when the rest has settled; lets what edges push follow once the forces balance.
 * Returned: whether nothing was left to do; else the forces are to be evaluated anew */
static bool hold(const bd_model *model, bd_work *work, double least, double residual, bool together)
{
    double slip = 0.0;
    int moved = 0;
    for (int b = 0; b < model->n_bearings; b++)
        slip = fmax(slip, bd_edge_slip(&model->bearings[b], &work->bearings[b]));
    const bool balanced = residual <= least, settled = balanced && slip <= least;
    for (int b = 0; b < model->n_bearings && (together || (settled && moved == 0)); b++)
        moved += bd_regrip(&model->bearings[b], &work->bearings[b], least, together);
    for (int b = 0; b < model->n_bearings && balanced && moved == 0 && !settled; b++)
        bd_follow_edges(&model->bearings[b], &work->bearings[b]);
    return settled && moved == 0;
}

/* The force that the rounding of the position makes on an edge. */
static double noise(const bd_model *model, const bd_work *work)
{
    double pull = 0.0, largest = 0.0;
    for (int b = 0; b < model->n_bearings; b++)
        pull = fmax(pull, bd_largest_pull(&model->bearings[b], &work->bearings[b]));
    for (int k = 0; pull > 0.0 && k < model->coefs; k++)
        largest = fmax(largest, fabs(work->z[k]));
    return rounding * largest * pull;
}

/* The bearing with the largest residual, or the first whose residual is not a number. */
static int worst_bearing(const bd_model *model, const bd_work *work)
{
    int worst = -1;
    double largest = -1.0;
    for (int b = 0; b < model->n_bearings; b++)
        for (int k = 0; k < model->bearings[b].data.n_coefs; k++) {
            int at = model->bearing_slot[b] + k;
            double residual = fabs(work->force[at] - work->guess[at]);
            if (isnan(residual))
                return b;
            if (residual > largest) {
                largest = residual;
                worst = b;
            }
        }
    return worst;
}

/* What the next correction leaves by the rate of the last, where that is steep; else infinite. An exact step is long:
 * its guess is too far off for two evaluations, and a third would only see what is known. */
static double expected_rest(double before, double residual)
{
    return residual <= steep * before ? residual / before * residual : INFINITY;
}

static bd_status iterate(const bd_model *model, bd_work *work, bd_state *state, bd_report *report)
{
    const bd_scheme *scheme = &work->scheme;
    const size_t m = (size_t)model->coefs;
    const double *inverse = state->inverse;
    bool fresh = state->clock.inverse_set, holds = false;
    double before = 0.0;
    int limit = scheme->max_iterations, held = 0;

    for (int iteration = 0; iteration < limit; iteration++) {
        double residual, scale;
        work->kernels->displace(model, work);
        bd_force_bearings(model, work);
        report->iterations++;
        measure(model, work, &residual, &scale);
        report->residual = scale > 0.0 ? residual / scale : residual;
        if (!isfinite(residual)) {
            report->bearing = worst_bearing(model, work);
            return BD_NOT_FINITE;
        }
        double least = scheme->tolerance * scale;
        bool converged = residual <= least;
        if (work->exact && fresh && !holds && !converged) {
            const double rest = expected_rest(before, residual);
            converged = rest <= left_over * least;
            if (converged)
                report->residual = rest / scale;
            before = residual;
        }
        if (holds) {
            least = fmax(least, noise(model, work));
            converged = hold(model, work, least, residual, held++ < TOGETHER);
            if (!converged) {
                bd_force_bearings(model, work);
                measure(model, work, &residual, &scale);
            }
        }
        if (!converged && (!fresh || iteration >= BD_PATIENCE)) {
            if (refresh(model, work)) {
                report->bearing = worst_bearing(model, work);
                return BD_SINGULAR;
            }
            inverse = work->inverse;
            fresh = true;
            report->refreshes++;
        }
        if (!converged && iteration == GRAZING) {
            holds = hold_balls(model, work);
            limit += holds ? HELD : 0;
        }
        if (residual > 0.0 && fresh)
            work->kernels->correct(model, work, iteration < GRAZING || holds ? 1.0 : 0.5, inverse);
        if (converged) {
            report->grazing += holds && noise(model, work) > 0.0;
            if (inverse == work->inverse && !holds) {
                memcpy(state->inverse, work->inverse, m * m * sizeof *inverse);
                state->clock.inverse_set = true;
            }
            return BD_OK;
        }
    }
    report->bearing = worst_bearing(model, work);
    return BD_NO_CONVERGENCE;
}

bd_status bd_solve_bearings(const bd_model *model, bd_work *work, bd_state *state,
                            bd_report *report)
{
    const bd_status status = iterate(model, work, state, report);
    release_balls(model, work);
    return status;
}
