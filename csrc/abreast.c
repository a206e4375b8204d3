/* Marches side by side: cases of one structure, whose operators are read once for all of them.
 *
 * One march is bound by reading its operators; with a case in each lane each of their numbers serves eight. All sums have
 * the order of a single march, and so its bits. Bearings whose balls stand alike are found in lanes too, while the inverse
 * that each case has serves; else a case is left to newton.c for that step. */
#include "abreast.h"

#include <stdlib.h>
#include <string.h>

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
    if (a->n_padded != b->n_padded || a->n_blocks != b->n_blocks || a->n_bands != b->n_bands ||
        a->n_layers != b->n_layers || a->n_bearings != b->n_bearings || a->n_loads != b->n_loads ||
        a->coefs != b->coefs || a->ranks != b->ranks || a->n_stress != b->n_stress ||
        a->branches != b->branches || a->n_softening > 0 || b->n_softening > 0)
        return false;
    for (int i = 0; i < a->n_blocks; i++) {
        const bd_block *p = &a->blocks[i], *q = &b->blocks[i];
        if (p->n != q->n || p->offset != q->offset || p->layer != q->layer ||
            p->n_layers != q->n_layers || p->n_bands != q->n_bands)
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
    const size_t blocks = (size_t)a->n_blocks, bands = (size_t)a->n_bands;
    for (int i = 0; i < a->n_layers; i++)
        if (!same_doubles(a->layers[i].L, b->layers[i].L,
                          (size_t)a->blocks[a->layers[i].block].n * (size_t)a->layers[i].padded))
            return false;
    return same(v->diagonal, w->diagonal, blocks * sizeof *v->diagonal) &&
           same(a->bands, b->bands, bands * sizeof *a->bands) &&
           same(a->sight, b->sight, ((size_t)a->n_bearings + 1) * sizeof *a->sight) &&
           same(a->sights, b->sights, (size_t)a->sight[a->n_bearings] * sizeof *a->sights) &&
           same(v->weights, w->weights, (size_t)a->branches * sizeof *v->weights) &&
           same_doubles(v->step, w->step, v->step_at[a->n_blocks]);
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

/* Arrays of balls that a bearing has. */
enum { BALL_PARTS = 9 };

static size_t most_balls(int n_cases, const bd_abreast_case *cases, int bearing)
{
    int most = 0;
    for (int l = 0; l < n_cases; l++) {
        const int n = cases[l].model->bearings[bearing].data.n_balls;
        most = n > most ? n : most;
    }
    return (size_t)most;
}

/* Geometry and contacts of a bearing, the first case's in lanes that are not there. Returned: the memory behind it */
static double *take_bearing(bd_abreast_bearing *wide, int n_cases, const bd_abreast_case *cases,
                            int bearing, double *memory)
{
    const size_t room = BD_ABREAST * most_balls(n_cases, cases, bearing);
    double **parts[BALL_PARTS] = {&wide->shift_X,      &wide->shift_Y,      &wide->shift,
                                  &wide->shift_X_rate, &wide->shift_Y_rate, &wide->shift_rate,
                                  &wide->force,        &wide->sine_a,       &wide->peak};
    for (int p = 0; p < BALL_PARTS; p++, memory += room)
        *parts[p] = memory;
    for (int l = 0; l < BD_ABREAST; l++) {
        const bd_bearing_data *data = &cases[l < n_cases ? l : 0].model->bearings[bearing].data;
        wide->x0[l] = data->x0, wide->y0[l] = data->y0, wide->A[l] = data->A;
        wide->e0[l] = data->e0, wide->h0[l] = data->contact.h0;
        wide->kappa[l] = data->contact.kappa, wide->c[l] = data->contact.c;
    }
    wide->by_load = cases[0].model->bearings[bearing].data.contact.law == BD_DAMPING_LOAD;
    return memory;
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
        {&abreast->g[0], m},
        {&abreast->g[1], m},
        {&abreast->g[2], m},
        {&abreast->guess, m},
        {&abreast->z_new, m},
        {&abreast->z_rate_new, m},
        {&abreast->force, m},
        {&abreast->change, m},
        {&abreast->W, m * m},
        {&abreast->inverse, m * m},
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
    for (int b = 0; b < model->n_bearings; b++)
        total += BD_ABREAST * BALL_PARTS * most_balls(n, cases, b);
    abreast->memory = aligned_alloc(64, total * sizeof(double));
    abreast->swings = calloc(loads + 1, sizeof *abreast->swings);
    abreast->own = calloc(m + 1, sizeof *abreast->own);
    abreast->bearings = calloc((size_t)model->n_bearings + 1, sizeof *abreast->bearings);
    if (!abreast->memory || !abreast->swings || !abreast->own || !abreast->bearings) {
        bd_abreast_free(abreast);
        return NULL;
    }
    memset(abreast->memory, 0, total * sizeof(double));
    double *next = abreast->memory;
    for (size_t i = 0; i < n_pieces; i++) {
        *pieces[i].place = next;
        next += BD_ABREAST * pieces[i].count;
    }
    for (int b = 0; b < model->n_bearings; b++)
        next = take_bearing(&abreast->bearings[b], n, cases, b, next);
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
    free(abreast->bearings);
    free(abreast);
}

/* ---------------------------------------------------------------- states in and out of their lanes */

/* The parts of a state that lie in lanes. */
enum { PARTS = 8 };

static void parts_of(const bd_abreast *abreast, const bd_state *state, double **wide, double **flat,
                     size_t *counts)
{
    const bd_model *model = abreast->model;
    const size_t n = (size_t)model->n_padded, m = (size_t)model->coefs;
    double *const lanes_of[PARTS] = {abreast->x,      abreast->v,    abreast->a,    abreast->y_rate,
                                     abreast->stress, abreast->g[0], abreast->g[1], abreast->g[2]};
    double *const parts[PARTS] = {state->x,      state->v, state->a,        state->y_rate,
                                  state->stress, state->g, state->g_before, state->g_before + m};
    const size_t sizes[PARTS] = {n, n, n, (size_t)model->ranks, model->n_stress, m, m, m};
    memcpy(wide, lanes_of, sizeof lanes_of);
    memcpy(flat, parts, sizeof parts);
    memcpy(counts, sizes, sizeof sizes);
}

void bd_abreast_take(const bd_abreast *abreast, const bd_state *state, int lane)
{
    double *wide[PARTS], *flat[PARTS];
    size_t counts[PARTS];
    parts_of(abreast, state, wide, flat, counts);
    for (int p = 0; p < PARTS; p++)
        for (size_t i = 0; i < counts[p]; i++)
            wide[p][BD_ABREAST * i + (size_t)lane] = flat[p][i];
}

void bd_abreast_give(const bd_abreast *abreast, const bd_state *state, int lane)
{
    double *wide[PARTS], *flat[PARTS];
    size_t counts[PARTS];
    parts_of(abreast, state, wide, flat, counts);
    for (int p = 0; p < PARTS; p++)
        for (size_t i = 0; i < counts[p]; i++)
            flat[p][i] = wide[p][BD_ABREAST * i + (size_t)lane];
}

void bd_abreast_empty(const bd_abreast *abreast, int lane)
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
        {abreast->g[0], (size_t)model->coefs},
        {abreast->g[1], (size_t)model->coefs},
        {abreast->g[2], (size_t)model->coefs},
        {abreast->guess, (size_t)model->coefs},
        {abreast->factor, 2 * (size_t)model->n_loads},
    };
    for (size_t p = 0; p < sizeof all / sizeof all[0]; p++)
        for (size_t i = 0; i < all[p].count; i++)
            all[p].wide[BD_ABREAST * i + (size_t)lane] = 0.0;
}
