/* One Newmark step in acceleration form, and the march.
 *
 * Everything is linear except the balls. With predictors x~, v~ the acceleration without the bearings is one
 * product of prepared columns; the bearings are then found on their few coefficients alone (newton.c), and the
 * acceleration is completed by a = a* - S^-1 B^T g. The displacement form of the scheme would lose energy to
 * round-off over 1e5 steps; this one does not. */
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "echoes.h"
#include "energy.h"
#include "exact.h"
#include "kernels.h"
#include "loads.h"
#include "newton.h"
#include "record.h"
#include "softening.h"
#include "state.h"

/* Turns between bearings and a varying speed, and the contraction that asks for new factors. Just factored, only
 * W' G x is left, which may contract as slowly as it likes. */
enum { SWEEPS = 60 };
static const double slow = 0.1;

/* ---------------------------------------------------------------- one step */

/* One step's bearing forces and, while the speed varies, its departure from the reference:
 *     a = a_steady + a_drift - S^-1 B^T g,   a_drift = -S^-1 [(W - W_ref)(G v + N x) + W' G x]
 * by turns, each contracting by about dt times the departure; when that is no longer quick, S is asked for anew.
 */
static bd_status solve_step(const bd_model *model, bd_work *work, bd_state *state,
                            bd_report *report)
{
    const size_t n = (size_t)model->n_padded;
    const bool bearings = model->n_bearings > 0;
    const bool factored_here = work->reference == work->turn.speed;
    double before = INFINITY;

    bd_guess_bearings(model, work, state);
    if (!work->drift) {
        if (!bearings)
            return BD_OK;
        if (!work->exact)
            work->kernels->observe(model, work);
        return bd_solve_bearings(model, work, state, report);
    }

    memcpy(work->a_steady, work->a, n * sizeof *work->a);
    memset(work->a_drift, 0, n * sizeof *work->a_drift);
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        double largest, change = work->kernels->drift(model, work, &largest);
        if (!isfinite(change))
            return BD_NOT_FINITE;
        if (bearings) {
            work->kernels->observe(model, work);
            bd_status status = bd_solve_bearings(model, work, state, report);
            if (status != BD_OK)
                return status;
        }
        if (change <= 1e-3 * work->scheme.tolerance * largest)
            return BD_OK;
        if (sweep > 0 && change > (factored_here ? 1.0 : slow) * before)
            break;
        before = change;
    }
    return factored_here ? BD_NO_CONVERGENCE : BD_REFACTOR;
}

/* ---------------------------------------------------------------- march */

double bd_reference_speed(const bd_model *model, const bd_scheme *scheme, double *flat, bool anew)
{
    bd_state state = bd_state_view(model, flat);
    bd_clock *clock = &state.clock;
    if (!bd_scheme_valid(scheme) || !bd_clock_valid(clock))
        return NAN;
    /* the end of the next step, to the bit as bd_march will have it */
    const double t =
        clock->dt == scheme->dt ? bd_clock_time(clock, 1) : bd_clock_time(clock, 0) + scheme->dt;
    if (anew || !clock->reference_set || scheme->speed.n == 1)
        clock->reference = bd_speed_at(&scheme->speed, t);
    clock->reference_set = true;
    bd_clock_keep(&state);
    return clock->reference;
}

long long bd_march(const bd_model *model, const bd_scheme *scheme, bd_work *work, double *flat,
                   long long n_steps, long long decimate, double *record, bd_report *report)
{
    bd_state state = bd_state_view(model, flat);
    const double dt = scheme->dt;
    long long rows = 0;

    *report = (bd_report){.status = BD_OK, .bearing = -1, .open_t = -1.0, .open_bearing = -1};
    if (!bd_clock_valid(&state.clock)) {
        report->status = BD_BAD_VALUE;
        return 0;
    }
    if (state.clock.dt != dt) { /* Newton's inverse belonged to the old step size */
        bd_clock_restart(&state.clock, dt);
        state.clock.inverse_set = false;
    }
    if (work->exact)
        bd_exact_recall(model, work, &state);
    for (; report->steps < n_steps; report->steps++) {
        const double t = bd_clock_time(&state.clock, 1);
        if (bd_softening_moved(model, &state)) {
            report->status = BD_REFACTOR;
            break;
        }
        if (model->n_softening > 0)
            memcpy(work->y_before, state.y_rate, (size_t)model->ranks * sizeof *state.y_rate);

        /* the structure without its bearings */
        work->turn = bd_turn_at(&work->profile, t, 0.5 * dt, 0.5 * dt);
        bd_load_factors(model, work, t);
        if (work->exact) {
            bd_exact_choose(model, work, &state, bd_clock_time(&state.clock, 0));
            work->kernels->exact_predict(model, work, &state);
        } else {
            work->kernels->predict(model, work, &state);
        }

        /* the bearings, on their own few numbers */
        if (model->n_bearings > 0)
            bd_turn_bearings(model, work);
        if (model->n_echoes > 0)
            bd_echoes_trial(model, work, &state);
        report->status = solve_step(model, work, &state, report);
        if (report->status != BD_OK)
            break;

        /* both together; only now does the state change */
        if (work->exact ? work->kernels->exact_commit(model, work, &state)
                        : work->kernels->commit(model, work, &state)) {
            report->status = BD_NOT_FINITE;
            break;
        }
        state.clock.steps++;
        if (model->n_echoes > 0)
            bd_echoes_commit(model, work, &state);
        if (model->n_softening > 0)
            bd_softening_step(model, work, &state);
        bd_count_open_sides(model, work, t, report);
        for (int b = 0; b < model->n_bearings; b++)
            work->kernels->keep_peaks(&model->bearings[b], &work->bearings[b]);
        if (scheme->audit && work->exact)
            bd_exact_motion(model, work, &state);
        if (scheme->audit)
            bd_energy_step(model, work, &state);

        if (state.clock.steps % decimate == 0) {
            bd_record_row(model, work, &state, record + rows * model->n_channels);
            rows++;
        }
    }
    report->t = bd_clock_time(&state.clock, 0);
    bd_clock_keep(&state);
    return rows;
}
