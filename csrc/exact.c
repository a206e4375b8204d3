/* One exact step: every mode of the linear part moves by factors of its own, and what the bearings press is held as a
 * parabola through the last two steps' ends and the new one, which Newton finds as in Newmark's scheme. */
#include "exact.h"

#include "dense.h"
#include "kernels.h"

/* to = keep q + [before u_before] + now u_now of one group's modes */
BD_INLINE void add_weighted(const bd_exact_group *group, const double *weight, const double *u,
                            double *to)
{
    int i = 0;
    for (; i < group->real; i += BD_WIDTH)
        LANES_AT(to + i) += LANES(weight + i) * LANES(u + i);
    const int pairs = group->pairs;
    for (; i < group->real + pairs; i += BD_WIDTH) {
        const lanes re = LANES(weight + i), im = LANES(weight + i + pairs);
        const lanes u_re = LANES(u + i), u_im = LANES(u + i + pairs);
        LANES_AT(to + i) += re * u_re - im * u_im;
        LANES_AT(to + i + pairs) += re * u_im + im * u_re;
    }
}

/* The share of every mode in the bearing forces g: P g. */
void BD_NAMED(bd_exact_shares)(const bd_model *model, const bd_exact *exact, const double *g,
                               double *shares)
{
    for (int k = 0; k < exact->n_groups; k++) {
        const bd_exact_group *group = &exact->groups[k];
        const int modes = group->real + 2 * group->pairs;
        double *to = shares + group->first;
        for (int i = 0; i < modes; i += BD_WIDTH)
            LANES_AT(to + i) = (lanes){0};
        for (int b = 0; b < model->n_bearings; b++) {
            const size_t at = (size_t)model->bearing_slot[b];
            if (group->touched[b])
                columns_add(modes, model->bearings[b].data.n_coefs,
                            exact->P + at * exact->n + group->first, (int)exact->n, g + at, to);
        }
    }
}

/* q at the step's end but for the new bearing forces, and z and z_rate of that. */
void BD_NAMED(bd_exact_predict)(const bd_model *model, bd_work *work, const bd_state *state)
{
    bd_exact *exact = work->exact;
    const size_t n = exact->n;
    const int now = exact->line ? BD_LINE_NOW : BD_NOW, stride = 2 * model->coefs;

    for (size_t i = 0; i < n; i += BD_WIDTH)
        LANES_AT(exact->trial + i) = (lanes){0};
    columns_add((int)n, 2 * model->n_loads, exact->load, (int)n, exact->factor, exact->trial);
    for (int i = 0; i < stride; i += BD_WIDTH)
        LANES_AT(exact->zz + i) = (lanes){0};
    for (int k = 0; k < exact->n_groups; k++) {
        const bd_exact_group *group = &exact->groups[k];
        const size_t first = group->first;
        const int modes = group->real + 2 * group->pairs;
        double *trial = exact->trial + first;
        const double *q = state->q + first;
        add_weighted(group, exact->weights[BD_KEEP] + first, q, trial);
        add_weighted(group, exact->weights[now] + first, exact->now + first, trial);
        if (!exact->line)
            add_weighted(group, exact->weights[BD_BEFORE] + first, exact->before + first, trial);
        if (group->loose > 0) {
            double *loose = trial + modes;
            for (int i = 0; i < group->loose; i += BD_WIDTH)
                LANES_AT(loose + i) += LANES(q + modes + i);
            columns_add(group->loose, modes, exact->loose[BD_KEEP] + group->rows, group->loose, q,
                        loose);
            columns_add(group->loose, modes, exact->loose[now] + group->rows, group->loose,
                        exact->now + first, loose);
            if (!exact->line)
                columns_add(group->loose, modes, exact->loose[BD_BEFORE] + group->rows,
                            group->loose, exact->before + first, loose);
        }
        for (int b = 0; b < model->n_bearings; b++) {
            const size_t at = 2 * (size_t)model->bearing_slot[b];
            if (group->touched[b])
                columns_add(2 * model->bearings[b].coefs, modes + group->loose,
                            exact->Z + first * (size_t)stride + at, stride, trial, exact->zz + at);
        }
    }
    for (int b = 0; b < model->n_bearings; b++) {
        const int at = model->bearing_slot[b], coefs = model->bearings[b].coefs;
        for (int i = 0; i < coefs; i += BD_WIDTH) {
            LANES_AT(work->z_linear + at + i) = LANES(exact->zz + 2 * at + i);
            LANES_AT(work->z_rate_linear + at + i) = LANES(exact->zz + 2 * at + coefs + i);
        }
    }
}

/* Completes q by the forces found, if that is finite. */
int BD_NAMED(bd_exact_commit)(const bd_model *model, bd_work *work, bd_state *state)
{
    bd_exact *exact = work->exact;
    const int new = exact->line ? BD_LINE_NEW : BD_NEW;

    BD_NAMED(bd_exact_shares)(model, exact, work->guess, exact->new);
    for (int k = 0; k < exact->n_groups; k++) {
        const bd_exact_group *group = &exact->groups[k];
        const int modes = group->real + 2 * group->pairs;
        add_weighted(group, exact->weights[new] + group->first, exact->new + group->first,
                     exact->trial + group->first);
        columns_add(group->loose, modes, exact->loose[new] + group->rows, group->loose,
                    exact->new + group->first, exact->trial + group->first + modes);
    }
    /* 0 times a number that is not finite is NaN, and so is every sum with it */
    lanes poison = {0};
    for (size_t i = 0; i < exact->n; i += BD_WIDTH)
        poison += 0.0 * LANES(exact->trial + i);
    for (int i = 0; i < BD_WIDTH; i++)
        if (!(poison[i] == 0.0))
            return 1;
    for (size_t i = 0; i < exact->n; i += BD_WIDTH) {
        LANES_AT(state->q + i) = LANES(exact->trial + i);
        LANES_AT(exact->before + i) = LANES(exact->now + i);
        LANES_AT(exact->now + i) = LANES(exact->new + i);
    }
    for (int k = 0; k < model->coefs; k += BD_WIDTH) {
        LANES_AT(state->g_before + model->coefs + k) = LANES(state->g_before + k);
        LANES_AT(state->g_before + k) = LANES(state->g + k);
        LANES_AT(state->g + k) = LANES(work->guess + k);
    }
    return 0;
}
