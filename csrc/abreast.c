/* Marches side by side: cases of one structure, whose operators are read once for all of them.
 *
 * One march is bound by reading its operators; with a case in each lane each of their numbers serves eight. Bearings are
 * found case by case, by the code of a single march (newton.c), so that all sums have its order and all bits are its own. */
#include "abreast.h"

#include <stdlib.h>
#include <string.h>

#include "echoes.h"
#include "kernels.h"
#include "loads.h"
#include "newton.h"
#include "record.h"
#include "state.h"

/* ---------------------------------------------------------------- what is shared */

static bool same(const void *a, const void *b, size_t bytes)
{
    return memcmp(a, b, bytes) == 0;
}

static bool same_doubles(const double *a, const double *b, size_t n)
{
    return same(a, b, n * sizeof *a);
}

/* Blocks, layers and the bearings' places, all of which the operators' shape comes from. */
static bool same_shape(const bd_model *a, const bd_model *b)
{
    if (a->n_padded != b->n_padded || a->n_blocks != b->n_blocks || a->n_layers != b->n_layers ||
        a->n_bearings != b->n_bearings || a->n_loads != b->n_loads || a->coefs != b->coefs ||
        a->ranks != b->ranks || a->n_stress != b->n_stress || a->branches != b->branches ||
        a->n_softening > 0 || b->n_softening > 0)
        return false;
    for (int i = 0; i < a->n_blocks; i++) {
        const bd_block *p = &a->blocks[i], *q = &b->blocks[i];
        if (p->n != q->n || p->offset != q->offset || p->layer != q->layer ||
            p->n_layers != q->n_layers)
            return false;
    }
    for (int i = 0; i < a->n_layers; i++) {
        const bd_layer *p = &a->layers[i], *q = &b->layers[i];
        if (p->block != q->block || p->rank != q->rank || p->offset != q->offset ||
            p->n_stresses != q->n_stresses || p->stress != q->stress)
            return false;
    }
    for (int i = 0; i < a->n_bearings; i++)
        if (a->bearings[i].data.n_coefs != b->bearings[i].data.n_coefs)
            return false;
    return true;
}

bool bd_abreast_shares(const bd_abreast_case *p, const bd_abreast_case *q)
{
    const bd_model *a = p->model, *b = q->model;
    const bd_work *v = p->work, *w = q->work;
    const bd_scheme *s = &v->scheme, *t = &w->scheme;
    if (!same_shape(a, b) || v->exact || w->exact || v->drift || w->drift || s->audit || t->audit ||
        v->kernels != w->kernels || s->dt != t->dt || s->beta != t->beta || s->gamma != t->gamma)
        return false;
    const size_t blocks = (size_t)a->n_blocks;
    for (int i = 0; i < a->n_layers; i++)
        if (!same_doubles(a->layers[i].L, b->layers[i].L,
                          (size_t)a->blocks[a->layers[i].block].n * (size_t)a->layers[i].padded))
            return false;
    return same(v->diagonal, w->diagonal, blocks * sizeof *v->diagonal) &&
           same(a->touched, b->touched, (size_t)a->n_bearings * blocks * sizeof *a->touched) &&
           same(v->weights, w->weights, (size_t)a->branches * sizeof *v->weights) &&
           same_doubles(v->step, w->step, v->step_at[a->n_blocks]);
}

/* Whether the balls of two bearings stand alike whenever their shafts do. */
static bool turn_alike(const bd_bearing_data *a, const bd_bearing_data *b)
{
    const size_t n = (size_t)a->n_coefs;
    return a->n_balls == b->n_balls && a->n_coefs == b->n_coefs && a->angle0 == b->angle0 &&
           a->cage_ratio == b->cage_ratio && same(a->order, b->order, n * sizeof *a->order) &&
           same(a->sine, b->sine, n * sizeof *a->sine);
}

/* ---------------------------------------------------------------- create, free */

/* A case's columns of the loads into its lane. */
static void take_loads(bd_abreast *abreast, const bd_abreast_case *one, int lane)
{
    const bd_model *model = one->model;
    const size_t count = 2 * (size_t)model->n_loads * (size_t)model->n_padded;
    for (size_t i = 0; i < count; i++)
        abreast->SP[BD_ABREAST * i + (size_t)lane] = one->work->SP[i];
    for (int k = 0; k < model->n_loads; k++)
        if (model->loads[k].kind == BD_LOAD_HARMONIC || model->loads[k].kind == BD_LOAD_ROTATING)
            abreast->swings[k] = true;
}

/* Which coefficients are not alike in all cases, and what they are in each. */
static void take_coefficients(bd_abreast *abreast, int n_cases, const bd_abreast_case *cases)
{
    const bd_model *first = cases[0].model;
    const size_t n = (size_t)first->n_padded, m = (size_t)first->coefs;
    for (int l = 0; l < n_cases; l++) {
        const double *B = cases[l].model->B, *SB = cases[l].work->SB;
        for (size_t k = 0; k < m; k++) {
            bool alike = same_doubles(SB + k * n, cases[0].work->SB + k * n, n);
            for (size_t i = 0; i < n; i++) {
                const size_t at = BD_ABREAST * (k * n + i) + (size_t)l;
                alike = alike && same_doubles(B + i * m + k, first->B + i * m + k, 1);
                abreast->B[at] = B[i * m + k];
                abreast->SB[at] = SB[k * n + i];
            }
            abreast->own[k] = abreast->own[k] || !alike;
        }
    }
}

bd_abreast *bd_abreast_create(int n, const bd_abreast_case *cases)
{
    const bd_model *model = cases[0].model;
    const size_t rows = (size_t)model->n_padded, m = (size_t)model->coefs;
    const size_t ranks = (size_t)model->ranks, loads = (size_t)model->n_loads;
    bd_abreast *abreast = calloc(1, sizeof *abreast);
    if (!abreast)
        return NULL;
    struct {
        double **place;
        size_t count;
    } pieces[] = {
        {&abreast->x, rows},
        {&abreast->v, rows},
        {&abreast->a, rows},
        {&abreast->y_rate, ranks},
        {&abreast->x_ahead, rows},
        {&abreast->v_ahead, rows},
        {&abreast->a_new, rows},
        {&abreast->x_new, rows},
        {&abreast->v_new, rows},
        {&abreast->history, ranks},
        {&abreast->rate_new, ranks},
        {&abreast->stress, model->n_stress},
        {&abreast->trial, model->n_stress},
        {&abreast->z, m},
        {&abreast->z_rate, m},
        {&abreast->minus_g, m},
        {&abreast->SP, 2 * loads * rows},
        {&abreast->factor, 2 * loads},
        {&abreast->B, m * rows},
        {&abreast->SB, m * rows},
    };
    const size_t n_pieces = sizeof pieces / sizeof pieces[0];
    size_t total = BD_ABREAST;
    for (size_t i = 0; i < n_pieces; i++)
        total += BD_ABREAST * pieces[i].count;
    abreast->memory = aligned_alloc(64, total * sizeof(double));
    abreast->swings = calloc(loads + 1, sizeof *abreast->swings);
    abreast->own = calloc(m + 1, sizeof *abreast->own);
    if (!abreast->memory || !abreast->swings || !abreast->own) {
        bd_abreast_free(abreast);
        return NULL;
    }
    memset(abreast->memory, 0, total * sizeof(double));
    double *next = abreast->memory;
    for (size_t i = 0; i < n_pieces; i++) {
        *pieces[i].place = next;
        next += BD_ABREAST * pieces[i].count;
    }
    abreast->model = model;
    abreast->work = cases[0].work;
    for (int l = 0; l < n; l++)
        take_loads(abreast, &cases[l], l);
    take_coefficients(abreast, n, cases);
    return abreast;
}

void bd_abreast_free(bd_abreast *abreast)
{
    if (!abreast)
        return;
    free(abreast->memory);
    free(abreast->swings);
    free(abreast->own);
    free(abreast);
}

/* ---------------------------------------------------------------- states in and out of their lanes */

/* The parts of a state that lie in lanes. */
enum { PARTS = 5 };

static void parts_of(const bd_abreast *abreast, const bd_state *state, double **wide, double **flat,
                     size_t *counts)
{
    const bd_model *model = abreast->model;
    double *const lanes_of[PARTS] = {abreast->x, abreast->v, abreast->a, abreast->y_rate,
                                     abreast->stress};
    double *const parts[PARTS] = {state->x, state->v, state->a, state->y_rate, state->stress};
    const size_t n = (size_t)model->n_padded;
    const size_t sizes[PARTS] = {n, n, n, (size_t)model->ranks, model->n_stress};
    memcpy(wide, lanes_of, sizeof lanes_of);
    memcpy(flat, parts, sizeof parts);
    memcpy(counts, sizes, sizeof sizes);
}

static void take(const bd_abreast *abreast, const bd_state *state, int lane)
{
    double *wide[PARTS], *flat[PARTS];
    size_t counts[PARTS];
    parts_of(abreast, state, wide, flat, counts);
    for (int p = 0; p < PARTS; p++)
        for (size_t i = 0; i < counts[p]; i++)
            wide[p][BD_ABREAST * i + (size_t)lane] = flat[p][i];
}

static void give(const bd_abreast *abreast, const bd_state *state, int lane)
{
    double *wide[PARTS], *flat[PARTS];
    size_t counts[PARTS];
    parts_of(abreast, state, wide, flat, counts);
    for (int p = 0; p < PARTS; p++)
        for (size_t i = 0; i < counts[p]; i++)
            flat[p][i] = wide[p][BD_ABREAST * i + (size_t)lane];
}

/* Zeroes a lane: what is not finite there, or grows without its bearings, would slow the others down. */
static void empty(const bd_abreast *abreast, int lane)
{
    const bd_model *model = abreast->model;
    const size_t n = (size_t)model->n_padded, ranks = (size_t)model->ranks;
    const struct {
        double *wide;
        size_t count;
    } all[] = {
        {abreast->x, n},
        {abreast->v, n},
        {abreast->a, n},
        {abreast->x_ahead, n},
        {abreast->v_ahead, n},
        {abreast->a_new, n},
        {abreast->x_new, n},
        {abreast->v_new, n},
        {abreast->y_rate, ranks},
        {abreast->history, ranks},
        {abreast->rate_new, ranks},
        {abreast->stress, model->n_stress},
        {abreast->trial, model->n_stress},
        {abreast->minus_g, (size_t)model->coefs},
        {abreast->factor, 2 * (size_t)model->n_loads},
    };
    for (size_t p = 0; p < sizeof all / sizeof all[0]; p++)
        for (size_t i = 0; i < all[p].count; i++)
            all[p].wide[BD_ABREAST * i + (size_t)lane] = 0.0;
}

/* ---------------------------------------------------------------- march */

/* Cases that march, by their lanes. */
typedef struct runners {
    bd_state state[BD_ABREAST];
    bool runs[BD_ABREAST];
    int n, left;
} runners;

/* A case ends: its state is that of its last step. */
static void retire(bd_abreast *abreast, runners *all, bd_abreast_case *one, int lane,
                   bd_status status)
{
    bd_state *state = &all->state[lane];
    one->report.status = status;
    give(abreast, state, lane);
    empty(abreast, lane);
    one->report.t = bd_clock_time(&state->clock, 0);
    bd_clock_keep(state);
    all->runs[lane] = false;
    all->left--;
}

/* Begins a case as bd_march begins. */
static void begin(bd_abreast *abreast, runners *all, bd_abreast_case *one, int lane)
{
    const double dt = one->work->scheme.dt;
    bd_state *state = &all->state[lane];

    one->report = (bd_report){.status = BD_OK, .bearing = -1, .open_t = -1.0, .open_bearing = -1};
    one->rows = 0;
    all->runs[lane] = false;
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
    take(abreast, state, lane);
    all->runs[lane] = true;
    all->left++;
}

/* Whether two shafts stand and turn alike, at every step to come: at the same time, of the same constant speed. */
static bool shafts_alike(const runners *all, const bd_abreast_case *cases, int a, int b)
{
    const bd_clock *p = &all->state[a].clock, *q = &all->state[b].clock;
    const bd_speed *s = &cases[a].work->profile.speed, *t = &cases[b].work->profile.speed;
    return p->origin == q->origin && p->steps == q->steps && s->value[0] == t->value[0] &&
           s->time[0] == t->time[0];
}

/* Lets each case that marches use the turn and the bases of the first such that turns alike; `leader` names it. */
static void follow(const runners *all, const bd_abreast_case *cases, int *leader)
{
    for (int l = 0; l < all->n; l++) {
        const bd_model *model = cases[l].model;
        leader[l] = l;
        for (int k = 0; k < l && leader[l] == l && all->runs[l]; k++)
            if (all->runs[k] && leader[k] == k && shafts_alike(all, cases, k, l))
                leader[l] = k;
        for (int b = 0; b < model->n_bearings; b++) {
            const bd_bearing *own = &model->bearings[b];
            const bd_bearing *first = &cases[leader[l]].model->bearings[b];
            const bool led = leader[l] != l && turn_alike(&first->data, &own->data);
            bd_bearing_lead(own, &cases[l].work->bearings[b],
                            led ? &cases[leader[l]].work->bearings[b] : NULL);
        }
    }
}

/* Where the shaft of a case is, and what its loads are, at the end of the step. */
static void turn(bd_abreast *abreast, bd_abreast_case *cases, int lane, int leader, double t)
{
    const bd_abreast_case *one = &cases[lane];
    const double dt = one->work->scheme.dt;
    one->work->turn = leader == lane ? bd_turn_at(&one->work->profile, t, 0.5 * dt, 0.5 * dt)
                                     : cases[leader].work->turn;
    bd_load_factors(one->model, one->work, t);
    for (int k = 0; k < 2 * one->model->n_loads; k++)
        abreast->factor[BD_ABREAST * k + lane] = one->work->load_factor[k];
}

/* The bearings of one case, found as in a march of its own. */
static bd_status find_bearings(bd_abreast *abreast, bd_abreast_case *one, bd_state *state, int lane)
{
    bd_work *work = one->work;
    const int m = one->model->coefs;
    bd_turn_bearings(one->model, work);
    bd_guess_bearings(one->model, work, state);
    bd_echoes_trial(one->model, work, state);
    for (int k = 0; k < m; k++) {
        work->z_linear[k] = abreast->z[BD_ABREAST * k + lane];
        work->z_rate_linear[k] = abreast->z_rate[BD_ABREAST * k + lane];
    }
    const bd_status status = bd_solve_bearings(one->model, work, state, &one->report);
    for (int k = 0; k < m; k++)
        abreast->minus_g[BD_ABREAST * k + lane] = -work->guess[k];
    return status;
}

/* What else a step leaves of one case, once its state has moved on. */
static void end_step(const bd_abreast *abreast, bd_abreast_case *one, bd_state *state, int lane,
                     double t)
{
    const bd_model *model = one->model;
    bd_work *work = one->work;
    const size_t m = (size_t)model->coefs, row = m * sizeof *state->g;

    memcpy(state->g_before + m, state->g_before, row);
    memcpy(state->g_before, state->g, row);
    memcpy(state->g, work->guess, row);
    state->clock.steps++;
    bd_echoes_commit(model, work, state);
    bd_count_open_sides(model, work, t, &one->report);
    for (int b = 0; b < model->n_bearings; b++)
        work->kernels->keep_peaks(&model->bearings[b], &work->bearings[b]);
    if (state->clock.steps % one->decimate == 0) {
        give(abreast, state, lane);
        bd_record_row(model, work, state, one->record + one->rows * model->n_channels);
        one->rows++;
    }
    one->report.steps++;
}

/* One step of all. Returned: whether the same cases go on */
static bool step(bd_abreast *abreast, runners *all, bd_abreast_case *cases, const int *leader)
{
    const bd_kernels *kernels = abreast->work->kernels;
    const int before = all->left;
    double t[BD_ABREAST];

    for (int l = 0; l < all->n; l++)
        if (all->runs[l]) {
            t[l] = bd_clock_time(&all->state[l].clock, 1);
            turn(abreast, cases, l, leader[l], t[l]);
        }
    kernels->abreast_predict(abreast);
    for (int l = 0; l < all->n; l++)
        if (all->runs[l] && abreast->model->n_bearings > 0) {
            const bd_status status = find_bearings(abreast, &cases[l], &all->state[l], l);
            if (status != BD_OK)
                retire(abreast, all, &cases[l], l, status);
        }
    const unsigned lost = kernels->abreast_complete(abreast);
    for (int l = 0; l < all->n; l++)
        if (all->runs[l] && lost >> l & 1)
            retire(abreast, all, &cases[l], l, BD_NOT_FINITE);
    kernels->abreast_commit(abreast);
    for (int l = 0; l < all->n; l++)
        if (all->runs[l]) {
            end_step(abreast, &cases[l], &all->state[l], l, t[l]);
            if (cases[l].report.steps == cases[l].steps)
                retire(abreast, all, &cases[l], l, BD_OK);
        }
    return all->left == before;
}

void bd_abreast_march(bd_abreast *abreast, int n, bd_abreast_case *cases)
{
    runners all = {.n = n};
    int leader[BD_ABREAST];

    for (int l = 0; l < n; l++)
        begin(abreast, &all, &cases[l], l);
    while (all.left > 0) {
        follow(&all, cases, leader);
        while (step(abreast, &all, cases, leader))
            ;
    }
    follow(&all, cases, leader); /* each its own again */
}
