/* The march of cases side by side: who marches, who is led by whom, and the order of a step (newmark.c's). */
#include <string.h>

#include "abreast.h"
#include "echoes.h"
#include "loads.h"
#include "newton.h"
#include "record.h"
#include "state.h"

/* Cases that march, by their lanes. */
typedef struct runners {
    bd_abreast *abreast;
    bd_abreast_case *cases;
    bd_state state[BD_ABREAST];
    bool runs[BD_ABREAST];
    int leader[BD_ABREAST]; /* whose shaft stands and turns alike */
    unsigned alike;         /* bits of cases whose bearings can be found in lanes */
    double tolerance[BD_ABREAST], t[BD_ABREAST];
    int n, left;
} runners;

static double *lane(double *wide, int k, int l)
{
    return wide + BD_ABREAST * k + l;
}

/* ---------------------------------------------------------------- begin, end */

/* What a case's own iteration may have changed: its inverse into its lane. */
static void take_inverse(const runners *all, int l)
{
    const int m = all->abreast->model->coefs;
    for (int k = 0; k < m * m; k++)
        *lane(all->abreast->inverse, k, l) = all->state[l].inverse[k];
}

/* The largest loads of its balls into a case's lane, or out of it. */
static void take_peaks(const runners *all, int l)
{
    const bd_model *model = all->cases[l].model;
    for (int b = 0; b < model->n_bearings; b++)
        for (int j = 0; j < model->bearings[b].data.n_balls; j++)
            *lane(all->abreast->bearings[b].peak, j, l) = all->cases[l].work->bearings[b].peak[j];
}

static void give_peaks(const runners *all, int l)
{
    const bd_model *model = all->cases[l].model;
    for (int b = 0; b < model->n_bearings; b++)
        for (int j = 0; j < model->bearings[b].data.n_balls; j++)
            all->cases[l].work->bearings[b].peak[j] = *lane(all->abreast->bearings[b].peak, j, l);
}

/* A case ends: its state is that of its last step. */
static void retire(runners *all, int l, bd_status status)
{
    bd_abreast_case *one = &all->cases[l];
    bd_state *state = &all->state[l];
    one->report.status = status;
    bd_abreast_give(all->abreast, state, l);
    give_peaks(all, l);
    bd_abreast_empty(all->abreast, l);
    one->report.t = bd_clock_time(&state->clock, 0);
    bd_clock_keep(state);
    all->runs[l] = false;
    all->left--;
}

/* Begins a case as bd_march begins. */
static void begin(runners *all, int l)
{
    bd_abreast_case *one = &all->cases[l];
    const double dt = one->work->scheme.dt;
    const int m = one->model->coefs;
    bd_state *state = &all->state[l];

    one->report = (bd_report){.status = BD_OK, .bearing = -1, .open_t = -1.0, .open_bearing = -1};
    one->rows = 0;
    if (one->steps == 0)
        return;
    *state = bd_state_view(one->model, one->flat);
    if (!bd_clock_valid(&state->clock)) {
        one->report.status = BD_BAD_VALUE;
        return;
    }
    if (state->clock.dt != dt) {
        bd_clock_restart(&state->clock, dt);
        state->clock.inverse_set = false;
    }
    bd_abreast_take(all->abreast, state, l);
    take_inverse(all, l);
    take_peaks(all, l);
    for (int k = 0; k < m * m; k++)
        *lane(all->abreast->W, k, l) = one->work->W[k];
    all->tolerance[l] = one->work->scheme.tolerance;
    all->runs[l] = true;
    all->left++;
}

/* ---------------------------------------------------------------- who is led by whom */

/* Whether the balls of two bearings stand alike whenever their shafts do. */
static bool turn_alike(const bd_bearing_data *a, const bd_bearing_data *b)
{
    const size_t n = (size_t)a->n_coefs;
    return a->n_balls == b->n_balls && a->n_coefs == b->n_coefs && a->angle0 == b->angle0 &&
           a->cage_ratio == b->cage_ratio &&
           memcmp(a->order, b->order, n * sizeof *a->order) == 0 &&
           memcmp(a->sine, b->sine, n * sizeof *a->sine) == 0;
}

/* Whether two shafts stand and turn alike, at every step to come: at the same time, of the same constant speed. */
static bool shafts_alike(const runners *all, int a, int b)
{
    const bd_clock *p = &all->state[a].clock, *q = &all->state[b].clock;
    const bd_speed *s = &all->cases[a].work->profile.speed, *t = &all->cases[b].work->profile.speed;
    return p->origin == q->origin && p->steps == q->steps && s->value[0] == t->value[0] &&
           s->time[0] == t->time[0];
}

/* Whether the contacts of two bearings are pressed by one code of abreast_bearings.c. */
static bool press_alike(const bd_contact *a, const bd_contact *b)
{
    return a->law == b->law && (a->law == BD_DAMPING_CONSTANT || a->law == BD_DAMPING_LOAD) &&
           a->give == 0.0 && b->give == 0.0;
}

/* Lets each case that marches use the turn and the bases of the first such that turns alike. */
static void follow(runners *all)
{
    int first = -1;
    all->alike = 0;
    for (int l = 0; l < all->n; l++) {
        const bd_model *model = all->cases[l].model;
        int leader = l;
        bool alike = all->runs[l] && all->cases[l].work->scheme.max_iterations > BD_PATIENCE;
        for (int k = 0; k < l && leader == l && all->runs[l]; k++)
            if (all->runs[k] && all->leader[k] == k && shafts_alike(all, k, l))
                leader = k;
        all->leader[l] = leader;
        first = first < 0 && all->runs[l] ? l : first;
        for (int b = 0; b < model->n_bearings; b++) {
            const bd_bearing *own = &model->bearings[b];
            const bd_bearing *of_leader = &all->cases[leader].model->bearings[b];
            const bool turns = turn_alike(&of_leader->data, &own->data);
            const bool led = leader != l && turns;
            bd_bearing_lead(own, &all->cases[l].work->bearings[b],
                            led ? &all->cases[leader].work->bearings[b] : NULL);
            alike = alike && leader == first && turns &&
                    press_alike(&all->cases[0].model->bearings[b].data.contact, &own->data.contact);
        }
        all->alike |= (unsigned)alike << l;
    }
    all->abreast->basis = all->cases[first < 0 ? 0 : first].work;
}

/* ---------------------------------------------------------------- one step */

/* Where the shaft of a case is, and what its loads are, at the end of the step. */
static void turn(runners *all, int l)
{
    const bd_abreast_case *one = &all->cases[l];
    const double dt = one->work->scheme.dt, t = bd_clock_time(&all->state[l].clock, 1);
    all->t[l] = t;
    one->work->turn = all->leader[l] == l ? bd_turn_at(&one->work->profile, t, 0.5 * dt, 0.5 * dt)
                                          : all->cases[all->leader[l]].work->turn;
    bd_load_factors(one->model, one->work, t);
    for (int k = 0; k < 2 * one->model->n_loads; k++)
        *lane(all->abreast->factor, k, l) = one->work->load_factor[k];
}

/* Where the balls of a case are; what its imperfections shift, into its lane. */
static void turn_balls(const runners *all, int l)
{
    const bd_abreast_case *one = &all->cases[l];
    bd_turn_bearings(one->model, one->work);
    for (int b = 0; b < one->model->n_bearings; b++) {
        const bd_bearing *bearing = &one->model->bearings[b];
        const bd_bearing_work *own = &one->work->bearings[b];
        const bd_abreast_bearing *wide = &all->abreast->bearings[b];
        const double *const shifts[] = {own->shift_X,      own->shift_Y,      own->shift,
                                        own->shift_X_rate, own->shift_Y_rate, own->shift_rate};
        double *const lanes_of[] = {wide->shift_X,      wide->shift_Y,      wide->shift,
                                    wide->shift_X_rate, wide->shift_Y_rate, wide->shift_rate};
        for (int p = 0; p < 6 && !bd_bearing_perfect(bearing); p++)
            for (int j = 0; j < bearing->data.n_balls; j++)
                *lane(lanes_of[p], j, l) = shifts[p][j];
    }
}

/* The bearings of one case by itself, as in a march of its own. */
static bd_status find_alone(runners *all, int l)
{
    bd_abreast *abreast = all->abreast;
    bd_abreast_case *one = &all->cases[l];
    bd_work *work = one->work;
    const bd_model *model = one->model;
    const long long refreshes = one->report.refreshes;

    for (int k = 0; k < model->coefs; k++) {
        const double g = *lane(abreast->g[0], k, l), before = *lane(abreast->g[1], k, l);
        work->guess[k] = 3.0 * (g - before) + *lane(abreast->g[2], k, l);
        work->z_linear[k] = *lane(abreast->z, k, l);
        work->z_rate_linear[k] = *lane(abreast->z_rate, k, l);
    }
    bd_echoes_trial(model, work, &all->state[l]);
    const bd_status status = bd_solve_bearings(model, work, &all->state[l], &one->report);
    for (int k = 0; k < model->coefs; k++)
        *lane(abreast->guess, k, l) = work->guess[k];
    for (int b = 0; b < model->n_bearings; b++)
        for (int j = 0; j < model->bearings[b].data.n_balls; j++)
            *lane(abreast->bearings[b].force, j, l) = work->bearings[b].force[j];
    if (one->report.refreshes != refreshes)
        take_inverse(all, l);
    return status;
}

/* The bearings of all cases. Returned: bits of those that were found in lanes */
static unsigned find_bearings(runners *all)
{
    bd_abreast *abreast = all->abreast;
    double residual[BD_ABREAST];
    int iterations[BD_ABREAST];
    unsigned ready = 0, found = 0;

    for (int l = 0; l < all->n; l++)
        if (all->runs[l]) {
            turn_balls(all, l);
            if (all->alike >> l & 1 && all->state[l].clock.inverse_set)
                ready |= 1U << l;
        }
    if (ready)
        found = abreast->work->kernels->abreast_find(abreast, ready, BD_PATIENCE, all->tolerance,
                                                     residual, iterations);
    for (int l = 0; l < all->n; l++) {
        bd_report *report = &all->cases[l].report;
        if (found >> l & 1) {
            report->iterations += iterations[l];
            report->residual = residual[l];
        } else if (all->runs[l]) {
            const bd_status status = find_alone(all, l);
            if (status != BD_OK)
                retire(all, l, status);
        }
    }
    return found;
}

/* Whether a channel asks for the balls themselves. */
static bool asks_for_balls(const bd_model *model)
{
    for (int c = 0; c < model->n_channels; c++)
        if (model->channels[c].kind == BD_CHANNEL_BALL ||
            model->channels[c].kind == BD_CHANNEL_LOADED ||
            model->channels[c].kind == BD_CHANNEL_CONTACT_LOSS)
            return true;
    return false;
}

/* Whether any bearing has a side without a shoulder. */
static bool is_open(const bd_model *model)
{
    for (int b = 0; b < model->n_bearings; b++)
        if (model->bearings[b].data.shoulder != 0)
            return true;
    return false;
}

/* What else a step leaves of one case, once its state has moved on. */
static void end_step(runners *all, int l, bool found_in_lanes)
{
    bd_abreast_case *one = &all->cases[l];
    const bd_model *model = one->model;
    bd_work *work = one->work;
    bd_state *state = &all->state[l];

    state->clock.steps++;
    one->report.steps++;
    bd_echoes_commit(model, work, state);
    const bool kept = state->clock.steps % one->decimate == 0, open = is_open(model);
    if (found_in_lanes && (open || (kept && asks_for_balls(model)))) {
        /* its own balls at the motion found, to the bit as they were there */
        for (int k = 0; k < model->coefs; k++) {
            work->z[k] = *lane(all->abreast->z_new, k, l);
            work->z_rate[k] = *lane(all->abreast->z_rate_new, k, l);
        }
        bd_force_bearings(model, work);
    }
    if (open)
        bd_count_open_sides(model, work, all->t[l], &one->report);
    if (kept) {
        bd_abreast_give(all->abreast, state, l);
        bd_record_row(model, work, state, one->record + one->rows * model->n_channels);
        one->rows++;
    }
    if (one->report.steps == one->steps)
        retire(all, l, BD_OK);
}

/* One step of all. Returned: whether the same cases go on */
static bool step(runners *all)
{
    bd_abreast *abreast = all->abreast;
    const bd_kernels *kernels = abreast->work->kernels;
    const int before = all->left;
    unsigned found = 0;

    for (int l = 0; l < all->n; l++)
        if (all->runs[l])
            turn(all, l);
    kernels->abreast_predict(abreast);
    if (abreast->model->n_bearings > 0)
        found = find_bearings(all);
    const unsigned lost = kernels->abreast_complete(abreast);
    for (int l = 0; l < all->n; l++)
        if (all->runs[l] && lost >> l & 1)
            retire(all, l, BD_NOT_FINITE);
    kernels->abreast_commit(abreast);
    kernels->abreast_keep_peaks(abreast);
    for (int l = 0; l < all->n; l++)
        if (all->runs[l])
            end_step(all, l, found >> l & 1);
    return all->left == before;
}

void bd_abreast_march(bd_abreast *abreast, int n, bd_abreast_case *cases)
{
    runners all = {.abreast = abreast, .cases = cases, .n = n};

    for (int l = 0; l < n; l++)
        begin(&all, l);
    while (all.left > 0) {
        follow(&all);
        while (step(&all))
            ;
    }
    follow(&all); /* each its own again */
}
