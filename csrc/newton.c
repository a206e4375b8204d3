/* The bearing forces of one step, on their few coefficients alone:
 *     z = z* - beta dt^2 W g(z, zdot),   zdot = zdot* - gamma dt W g,   W = B S^-1 B^T
 * by Newton's iteration with a matrix that is kept from step to step while it serves. */
#include "newton.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "dense.h"
#include "kernels.h"

/* A frozen Newton matrix that needs more evaluations than this is replaced. */
enum { PATIENCE = 3 };
/* From here on corrections are halved, and a step may end on position alone: a constant c makes the
 * force jump where a film opens, and inside that jump no force balances exactly. */
enum { GRAZING = 10 };
/* Share of the largest bearing displacement to which the position must then be known. */
static const double grazing_tolerance = 1e-7;

void bd_turn_bearings(const bd_model *model, bd_work *work)
{
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        const double psi = bearing->data.angle0 + bearing->data.cage_ratio * work->turn.angle;
        work->kernels->turn(bearing, &work->bearings[b], psi);
        if (!bd_bearing_perfect(bearing))
            bd_bearing_imperfect(bearing, &work->bearings[b], psi,
                                 bearing->data.cage_ratio * work->turn.speed, work->turn);
    }
}

void bd_force_bearings(const bd_model *model, bd_work *work)
{
    for (int b = 0; b < model->n_bearings; b++) {
        int at = model->bearing_slot[b];
        work->kernels->force(
            &model->bearings[b], &work->bearings[b], work->z + at, work->z_rate + at,
            model->bearings[b].data.cage_ratio * work->turn.speed, work->force + at);
    }
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

/* Is the position settled although the force is not: the last correction moved no coefficient. */
static bool position_settled(const bd_model *model, const bd_work *work)
{
    const size_t m = (size_t)model->coefs;
    double largest_move = 0.0, largest = 0.0;
    for (size_t k = 0; k < m; k++) {
        double move = 0.0;
        for (size_t c = 0; c < m; c++)
            move += work->W[c * m + k] * (work->force[c] - work->guess[c]);
        largest_move = fmax(largest_move, fabs(work->in_x * move));
        largest = fmax(largest, fabs(work->z[k]));
    }
    return largest_move <= grazing_tolerance * largest;
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

bd_status bd_solve_bearings(const bd_model *model, bd_work *work, bd_state *state,
                            bd_report *report)
{
    const bd_scheme *scheme = &work->scheme;
    const size_t m = (size_t)model->coefs;
    const double *inverse = state->inverse;
    bool fresh = state->clock.inverse_set;

    for (int iteration = 0; iteration < scheme->max_iterations; iteration++) {
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
        const bool balanced = residual <= scheme->tolerance * scale;
        const bool grazes = !balanced && iteration >= GRAZING && position_settled(model, work);
        const bool converged = balanced || grazes;
        report->grazing += grazes;
        if (!converged && (!fresh || iteration >= PATIENCE)) {
            if (refresh(model, work)) {
                report->bearing = worst_bearing(model, work);
                return BD_SINGULAR;
            }
            inverse = work->inverse;
            fresh = true;
            report->refreshes++;
        }
        if (residual > 0.0 && fresh)
            work->kernels->correct(model, work, iteration < GRAZING ? 1.0 : 0.5, inverse);
        if (converged) {
            if (inverse == work->inverse) {
                memcpy(state->inverse, work->inverse, m * m * sizeof *inverse);
                state->clock.inverse_set = true;
            }
            return BD_OK;
        }
    }
    report->bearing = worst_bearing(model, work);
    return BD_NO_CONVERGENCE;
}
