/* One exact step: every mode of the linear part moves by factors of its own, and what the bearings press is held as a
 * polynomial through the last steps' ends and the new one, which Newton finds as in Newmark's scheme. */
#include "exact.h"

#include "dense.h"
#include "kernels.h"

/* (re, im) += weight u of pairs at i */
#define ADD_PAIR(weight, u)                                                                        \
    do {                                                                                           \
        const lanes w_re = LANES((weight) + i), w_im = LANES((weight) + i + pairs);                \
        const lanes u_re = LANES((u) + i), u_im = LANES((u) + i + pairs);                          \
        re += w_re * u_re - w_im * u_im;                                                           \
        im += w_re * u_im + w_im * u_re;                                                           \
    } while (0)

/* to = constant + keep q + sum weights[k] shares[k] of one group's modes, all in one pass; inlined with a constant
 * count. */
BD_INLINE void move_modes(const bd_exact *exact, const bd_exact_group *group, int count,
                          const double *q, double *to)
{
    const size_t first = group->first;
    const int pairs = group->pairs, row = bd_exact_held(count, 1);
    const double *constant = exact->constant + first, *keep = exact->weights[BD_KEEP] + first;
    const double *weights[BD_HOLDS], *shares[BD_HOLDS];
    for (int k = 0; k < count; k++) {
        weights[k] = exact->weights[row + k] + first;
        shares[k] = exact->shares[1 + k] + first;
    }
    int i = 0;
    for (; i < group->real; i += BD_WIDTH) {
        lanes sum = LANES(constant + i) + LANES(keep + i) * LANES(q + i);
        for (int k = 0; k < count; k++)
            sum += LANES(weights[k] + i) * LANES(shares[k] + i);
        LANES_AT(to + i) = sum;
    }
    for (; i < group->real + pairs; i += BD_WIDTH) {
        lanes re = LANES(constant + i), im = LANES(constant + i + pairs);
        ADD_PAIR(keep, q);
        for (int k = 0; k < count; k++)
            ADD_PAIR(weights[k], shares[k]);
        LANES_AT(to + i) = re;
        LANES_AT(to + i + pairs) = im;
    }
}

/* rate = roots q of one group's modes */
BD_INLINE void rate_modes(const bd_exact_group *group, const double *roots, const double *q,
                          double *rate)
{
    const int pairs = group->pairs;
    int i = 0;
    for (; i < group->real; i += BD_WIDTH)
        LANES_AT(rate + i) = LANES(roots + i) * LANES(q + i);
    for (; i < group->real + pairs; i += BD_WIDTH) {
        lanes re = {0}, im = {0};
        ADD_PAIR(roots, q);
        LANES_AT(rate + i) = re;
        LANES_AT(rate + i + pairs) = im;
    }
}

/* The forces that a group's motion meets. */
BD_INLINE void pack(const bd_exact_group *group, const double *g, double *packed)
{
    for (int k = 0; k < group->n_seen; k++)
        packed[k] = g[group->seen[k]];
}

/* Shares of one group's modes in the forces packed. */
BD_INLINE void share(const bd_exact *exact, const bd_exact_group *group, double *shares)
{
    const int modes = group->real + 2 * group->pairs;
    for (int i = 0; i < modes; i += BD_WIDTH)
        LANES_AT(shares + i) = (lanes){0};
    columns_add(modes, group->n_seen, exact->P + group->P, modes, exact->packed, shares);
}

/* The share of every mode in the bearing forces g: P g. */
void BD_NAMED(bd_exact_shares)(const bd_exact *exact, const double *g, double *shares)
{
    for (int k = 0; k < exact->n_groups; k++) {
        pack(&exact->groups[k], g, exact->packed);
        share(exact, &exact->groups[k], shares + exact->groups[k].first);
    }
}

/* What a group's numbers are to the bearing coefficients it is seen in, added to z and z_rate. */
BD_INLINE void see(const bd_exact *exact, const bd_exact_group *group, const double *trial,
                   double *z, double *z_rate)
{
    const int modes = group->real + 2 * group->pairs, rows = group->z_rows;
    double *zz = exact->zz, *zz_rate = zz + (group->twice ? rows : group->n_seen);
    for (int i = 0; i < 2 * rows; i += BD_WIDTH)
        LANES_AT(zz + i) = (lanes){0};
    if (group->twice) {
        rate_modes(group, exact->roots + group->first, trial, exact->rate);
        columns_add_two(rows, modes, exact->Z + group->Z, rows, trial, exact->rate, zz, zz_rate);
    } else {
        columns_add(rows, modes + group->loose, exact->Z + group->Z, rows, trial, zz);
    }
    for (int k = 0; k < group->n_seen; k++) {
        z[group->seen[k]] += zz[k];
        z_rate[group->seen[k]] += zz_rate[k];
    }
}

/* q at the step's end but for the new bearing forces, and z and z_rate of that. */
void BD_NAMED(bd_exact_predict)(const bd_model *model, bd_work *work, const bd_state *state)
{
    bd_exact *exact = work->exact;
    const int order = exact->order;

    for (int i = 0; i < model->coefs; i += BD_WIDTH)
        LANES_AT(work->z_linear + i) = LANES_AT(work->z_rate_linear + i) = (lanes){0};
    for (int k = 0; k < exact->n_groups; k++) {
        const bd_exact_group *group = &exact->groups[k];
        const size_t first = group->first;
        const int modes = group->real + 2 * group->pairs;
        double *trial = exact->trial + first, *loose = trial + modes;
        const double *q = state->q + first;
        if (order == 3)
            move_modes(exact, group, 3, q, trial);
        else if (order == 2)
            move_modes(exact, group, 2, q, trial);
        else
            move_modes(exact, group, 1, q, trial);
        if (group->loose > 0) {
            for (int i = 0; i < group->loose; i += BD_WIDTH)
                LANES_AT(loose + i) =
                    LANES(exact->constant + first + modes + i) + LANES(q + modes + i);
            columns_add(group->loose, modes, exact->loose + group->rows, group->loose, q, loose);
            for (int back = 1; back <= order; back++) {
                pack(group, back == 1 ? state->g : state->g_before + (back - 2) * model->coefs,
                     exact->packed);
                columns_add(group->loose, group->n_seen,
                            exact->held[bd_exact_held(order, back)] + group->held, group->loose,
                            exact->packed, loose);
            }
        }
        if (exact->n_varying > 0)
            columns_add(modes + group->loose, 2 * exact->n_varying, exact->load + first,
                        (int)exact->n, exact->factor, trial);
        if (group->n_seen > 0)
            see(exact, group, trial, work->z_linear, work->z_rate_linear);
    }
}

/* trial += weight shares of one group's modes. Returned: 0 times all of it, which is NaN where any is not finite */
BD_INLINE void complete_modes(const bd_exact_group *group, const double *weight,
                              const double *shares, double *trial, lanes *poison)
{
    const int pairs = group->pairs;
    int i = 0;
    for (; i < group->real; i += BD_WIDTH) {
        const lanes sum = LANES(trial + i) + LANES(weight + i) * LANES(shares + i);
        LANES_AT(trial + i) = sum;
        *poison += 0.0 * sum;
    }
    for (; i < group->real + pairs; i += BD_WIDTH) {
        lanes re = LANES(trial + i), im = LANES(trial + i + pairs);
        ADD_PAIR(weight, shares);
        LANES_AT(trial + i) = re;
        LANES_AT(trial + i + pairs) = im;
        *poison += 0.0 * re + 0.0 * im;
    }
}

/* Completes q by the forces found, if that is finite. */
int BD_NAMED(bd_exact_commit)(const bd_model *model, bd_work *work, bd_state *state)
{
    bd_exact *exact = work->exact;
    const int new = bd_exact_held(exact->order, 0);
    double *shares = exact->shares[0];
    lanes poison = {0};

    for (int k = 0; k < exact->n_groups; k++) {
        const bd_exact_group *group = &exact->groups[k];
        const int modes = group->real + 2 * group->pairs;
        double *trial = exact->trial + group->first, *loose = trial + modes;
        pack(group, work->guess, exact->packed);
        share(exact, group, shares + group->first);
        complete_modes(group, exact->weights[new] + group->first, shares + group->first, trial,
                       &poison);
        if (group->loose > 0)
            columns_add(group->loose, group->n_seen, exact->held[new] + group->held, group->loose,
                        exact->packed, loose);
        for (int i = 0; i < group->loose; i += BD_WIDTH)
            poison += 0.0 * LANES(loose + i);
    }
    for (int i = 0; i < BD_WIDTH; i++)
        if (!(poison[i] == 0.0))
            return 1;
    for (size_t i = 0; i < exact->n; i += BD_WIDTH)
        LANES_AT(state->q + i) = LANES(exact->trial + i);
    double *oldest = exact->shares[BD_HOLDS];
    for (int k = BD_HOLDS; k > 0; k--)
        exact->shares[k] = exact->shares[k - 1];
    exact->shares[0] = oldest;
    for (int k = 0; k < model->coefs; k += BD_WIDTH) {
        LANES_AT(state->g_before + model->coefs + k) = LANES(state->g_before + k);
        LANES_AT(state->g_before + k) = LANES(state->g + k);
        LANES_AT(state->g + k) = LANES(work->guess + k);
    }
    return 0;
}
