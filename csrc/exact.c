/* One exact step: every mode of the linear part moves by factors of its own, and what the bearings press is held as a
 * parabola through the last two steps' ends and the new one, which Newton finds as in Newmark's scheme. */
#include "exact.h"

#include "dense.h"
#include "kernels.h"

/* to += weight u of one group's modes */
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

/* (re, im) += weight u of pairs at i */
#define ADD_PAIR(weight, u)                                                                        \
    do {                                                                                           \
        const lanes w_re = LANES((weight) + i), w_im = LANES((weight) + i + pairs);                \
        const lanes u_re = LANES((u) + i), u_im = LANES((u) + i + pairs);                          \
        re += w_re * u_re - w_im * u_im;                                                           \
        im += w_re * u_im + w_im * u_re;                                                           \
    } while (0)

/* to = constant + keep q + now u_now + before u_before of one group's modes: all in one pass */
BD_INLINE void move_modes(const bd_exact_group *group, const double *constant, const double *keep,
                          const double *now, const double *before, const double *q,
                          const double *u_now, const double *u_before, double *to)
{
    const int pairs = group->pairs;
    int i = 0;
    for (; i < group->real; i += BD_WIDTH)
        LANES_AT(to + i) = LANES(constant + i) + LANES(keep + i) * LANES(q + i) +
                           LANES(now + i) * LANES(u_now + i) +
                           LANES(before + i) * LANES(u_before + i);
    for (; i < group->real + pairs; i += BD_WIDTH) {
        lanes re = LANES(constant + i), im = LANES(constant + i + pairs);
        ADD_PAIR(keep, q);
        ADD_PAIR(now, u_now);
        ADD_PAIR(before, u_before);
        LANES_AT(to + i) = re;
        LANES_AT(to + i + pairs) = im;
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
    const int now = exact->line ? BD_LINE_NOW : BD_NOW, m = model->coefs;
    const double *before = exact->line ? exact->nothing : exact->weights[BD_BEFORE];

    for (int i = 0; i < 2 * m; i += BD_WIDTH)
        LANES_AT(exact->zz + i) = (lanes){0};
    for (int k = 0; k < exact->n_groups; k++) {
        const bd_exact_group *group = &exact->groups[k];
        const size_t first = group->first;
        const int modes = group->real + 2 * group->pairs;
        double *trial = exact->trial + first, *loose = trial + modes;
        const double *q = state->q + first;
        move_modes(group, exact->constant + first, exact->weights[BD_KEEP] + first,
                   exact->weights[now] + first, before + first, q, exact->now + first,
                   exact->before + first, trial);
        for (int i = 0; i < group->loose; i += BD_WIDTH)
            LANES_AT(loose + i) = LANES(exact->constant + first + modes + i) + LANES(q + modes + i);
        if (group->loose > 0) {
            columns_add(group->loose, modes, exact->loose + group->rows, group->loose, q, loose);
            columns_add(group->loose, m, exact->held[now] + group->held, group->loose, state->g,
                        loose);
            if (!exact->line)
                columns_add(group->loose, m, exact->held[BD_BEFORE] + group->held, group->loose,
                            state->g_before, loose);
        }
        if (exact->n_varying > 0)
            columns_add(modes + group->loose, 2 * exact->n_varying, exact->load + first,
                        (int)exact->n, exact->factor, trial);
        for (int b = 0; b < model->n_bearings; b++) {
            const int rows = 2 * model->bearings[b].coefs;
            if (group->touched[b])
                columns_add(rows, modes + group->loose, exact->Z + group->seen[b], rows, trial,
                            exact->zz + 2 * model->bearing_slot[b]);
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
        if (group->loose > 0)
            columns_add(group->loose, model->coefs, exact->held[new] + group->held, group->loose,
                        work->guess, exact->trial + group->first + modes);
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
