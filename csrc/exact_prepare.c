/* The exact step made ready: the caller's arrays laid out in lanes, once for a march. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dense.h"
#include "exact.h"
#include "kernels.h"
#include "loads.h"

/* Arrays of a march, beside those of the polynomials. */
enum { SHARED_PIECES = 19 };

/* Coefficients that a group's motion enters or whose forces move it. */
static void take_seen(const bd_model *model, const bd_exact_data *data, bd_exact_group *group,
                      int *seen)
{
    const size_t m = (size_t)model->n_coefs, end = group->first + (size_t)group->real +
                                                   2 * (size_t)group->pairs + (size_t)group->loose;
    group->seen = seen;
    for (size_t k = 0; k < m; k++) {
        bool any = false;
        for (size_t j = group->first; j < end && !any; j++)
            any = data->P[k * (size_t)data->n + j] != 0.0 || data->Z[j * 2 * m + k] != 0.0 ||
                  data->Z[j * 2 * m + m + k] != 0.0;
        if (any)
            seen[group->n_seen++] = model->coef_slot[k];
    }
    /* two products with half the rows read half as much, where the rows are not one register anyway */
    const int once = BD_PADDED(2 * group->n_seen);
    group->twice = group->loose == 0 && BD_PADDED(group->n_seen) < once;
    group->z_rows = group->twice ? BD_PADDED(group->n_seen) : once;
}

/* The groups' sections; false where they do not fit the arrays given. */
static bool take_groups(const bd_model *model, const bd_exact_data *data, bd_exact *exact)
{
    size_t at = 0, rows = 0, held = 0, P = 0, Z = 0;
    for (int k = 0; k < exact->n_groups; k++) {
        int size[3];
        for (int i = 0; i < 3; i++) {
            const double given = data->table[3 * k + i];
            if (!(given >= 0.0 && given < 1e6) || fmod(given, BD_LANES) != 0.0)
                return false;
            size[i] = (int)given;
        }
        const size_t modes = (size_t)size[0] + 2 * (size_t)size[1], loose = (size_t)size[2];
        if (at + modes + loose > (size_t)data->n)
            return false;
        bd_exact_group *group = &exact->groups[k];
        *group = (bd_exact_group){
            .first = at,
            .real = size[0],
            .pairs = size[1],
            .loose = size[2],
            .rows = rows,
            .held = held,
            .P = P,
            .Z = Z,
        };
        take_seen(model, data, group, exact->seen + (size_t)k * (size_t)model->coefs);
        held += loose * (size_t)group->n_seen;
        P += modes * (size_t)group->n_seen;
        Z += (modes + loose) * (size_t)group->z_rows;
        at += modes + loose;
        rows += modes * loose;
    }
    return at == (size_t)data->n && rows == (size_t)data->n_loose;
}

/* A caller's row (n) on coordinates to padded ones. */
static void place_row(const bd_model *model, const double *from, double *to)
{
    for (int i = 0; i < model->n; i++)
        to[model->slot[i]] = from[i];
}

/* Where the caller's stress r of branch i of layer l lies. */
static void place_stresses(const bd_model *model, const double *from, const size_t *starts,
                           double *to)
{
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        for (int i = 0; i < layer->n_branches; i++)
            for (int r = 0; r < layer->rank; r++)
                to[layer->stress + (size_t)i * (size_t)layer->padded + (size_t)r] =
                    from[starts[layer->source] + (size_t)i * (size_t)layer->rank + (size_t)r];
    }
}

/* What one group makes of coefficient k of the caller's, which is the one numbered `place` that it sees. */
static void place_seen(const bd_model *model, const bd_exact_data *data, bd_exact *exact,
                       const bd_exact_group *group, size_t k, size_t place)
{
    const size_t n = exact->n, m = (size_t)model->n_coefs;
    const size_t modes = (size_t)group->real + 2 * (size_t)group->pairs;
    const size_t loose = (size_t)group->loose, z_rows = (size_t)group->z_rows;
    const double *P = data->P + k * n + group->first;
    memcpy(exact->P + group->P + place * modes, P, modes * sizeof *P);
    for (size_t i = 0; i < modes + loose; i++) {
        const double *from = data->Z + (group->first + i) * 2 * m;
        double *column = exact->Z + group->Z + i * z_rows;
        column[place] = from[k];
        if (!group->twice)
            column[(size_t)group->n_seen + place] = from[m + k];
    }
    for (int w = 0; w < bd_exact_held(exact->hold + 1, 0); w++)
        for (size_t i = 0; i < modes; i++)
            for (size_t r = 0; r < loose; r++)
                exact->held[w][group->held + place * loose + r] +=
                    P[i] *
                    data->loose[(size_t)w * (size_t)data->n_loose + group->rows + i * loose + r];
}

/* Bearings, by the caller's coefficients. */
static void place_bearings(const bd_model *model, const bd_exact_data *data, bd_exact *exact)
{
    const size_t m = (size_t)model->n_coefs, coefs = (size_t)model->coefs;
    for (size_t k = 0; k < m; k++) {
        const int slot = model->coef_slot[k];
        const size_t own = (size_t)slot;
        for (int g = 0; g < exact->n_groups; g++)
            for (int i = 0; i < exact->groups[g].n_seen; i++)
                if (exact->groups[g].seen[i] == slot)
                    place_seen(model, data, exact, &exact->groups[g], k, (size_t)i);
        for (int order = 0; order < exact->hold; order++)
            for (int i = 0; i < 2; i++)
                for (size_t l = 0; l < m; l++)
                    exact->W[order][i][own * coefs + (size_t)model->coef_slot[l]] =
                        data->W[(size_t)(2 * order + i) * m * m + k * m + l];
        for (size_t i = 0; i < (size_t)model->n_padded; i++)
            exact->push[own * (size_t)model->n_padded + i] = -model->B[i * coefs + own];
    }
}

/* What channels of motion read. */
static void place_channels(const bd_model *model, bd_exact *exact)
{
    const size_t n = exact->n, padded = (size_t)model->n_padded;
    for (int c = 0; c < model->n_channels; c++) {
        const bd_channel *channel = &model->channels[c];
        const double *shapes = channel->kind == BD_CHANNEL_DISPLACEMENT ? exact->X
                               : channel->kind == BD_CHANNEL_VELOCITY   ? exact->V
                                                                        : exact->A;
        if (channel->kind == BD_CHANNEL_BRANCH_LOSS)
            exact->physical = true;
        if (channel->kind > BD_CHANNEL_ACCELERATION)
            continue;
        double *row = exact->rows + (size_t)c * n;
        for (size_t j = 0; j < n; j++)
            for (size_t i = 0; i < padded; i++)
                row[j] += channel->row[i] * shapes[j * padded + i];
        if (channel->kind != BD_CHANNEL_ACCELERATION)
            continue;
        for (size_t k = 0; k < (size_t)model->coefs; k++)
            for (size_t i = 0; i < padded; i++)
                exact->rows_g[(size_t)c * (size_t)model->coefs + k] +=
                    channel->row[i] * exact->push[k * padded + i];
        for (int l = 0; l < model->n_loads; l++)
            for (size_t i = 0; i < padded; i++) {
                double *of =
                    exact->rows_load + 2 * ((size_t)c * (size_t)model->n_loads + (size_t)l);
                of[0] += channel->row[i] * model->loads[l].p_cos[i];
                of[1] += channel->row[i] * model->loads[l].p_sin[i];
            }
    }
}

size_t bd_exact_size(const bd_model *model, const bd_exact_data *data)
{
    return bd_state_size(model) + (size_t)data->n;
}

bd_status bd_exact_prepare(const bd_model *model, const bd_scheme *scheme,
                           const bd_exact_data *data, bd_work *work)
{
    bd_status status = bd_work_choose(work, scheme);
    if (status != BD_OK)
        return status;
    if (model->n_softening > 0 || scheme->speed.n != 1)
        return BD_BAD_VALUE;
    bd_exact *exact = calloc(1, sizeof *exact);
    if (!exact)
        return BD_NO_MEMORY;
    bd_exact_free(work->exact);
    work->exact = exact;
    work->reference = scheme->speed.value[0];
    work->in_x = work->in_v = 1.0; /* Newton's operators hold them */
    bd_echoes_prepare(model, work);
    const size_t n = (size_t)data->n, padded = (size_t)model->n_padded, m = (size_t)model->coefs;
    const size_t channels = (size_t)model->n_channels, loads = (size_t)model->n_loads;
    exact->n = n;
    exact->n_groups = data->n_groups;
    exact->groups = calloc((size_t)data->n_groups + 1, sizeof *exact->groups);
    exact->hold = data->hold;
    exact->seen = calloc((size_t)data->n_groups * m + 1, sizeof *exact->seen);
    exact->varying = calloc(loads + 1, sizeof *exact->varying);
    size_t all_loose = 0;
    for (int k = 0; k < data->n_groups; k++)
        all_loose += (size_t)fmax(0.0, fmin(data->table[3 * k + 2], 1e6));
    struct {
        double **place;
        size_t count;
    } pieces[SHARED_PIECES + 2 * BD_WEIGHTS + 3 * BD_HOLDS + 1] = {
        {&exact->roots, n},
        {&exact->constant, n},
        {&exact->loose, (size_t)data->n_loose},
        {&exact->P, m * n},
        {&exact->Z, (2 * m + BD_LANES) * n},
        {&exact->load, 2 * loads * n},
        {&exact->X, n * padded},
        {&exact->V, n * padded},
        {&exact->A, n * padded},
        {&exact->push, m * padded},
        {&exact->S, n * model->n_stress},
        {&exact->rows, channels * n},
        {&exact->rows_g, channels * m},
        {&exact->rows_load, 2 * channels * loads},
        {&exact->trial, n},
        {&exact->rate, n},
        {&exact->packed, m},
        {&exact->zz, 4 * m + BD_LANES},
        {&exact->factor, 2 * loads},
    };
    size_t n_pieces = SHARED_PIECES, total = BD_LANES;
    for (int w = 0; w < bd_exact_held(data->hold + 1, 0); w++) {
        pieces[n_pieces].place = &exact->weights[w], pieces[n_pieces++].count = n;
        pieces[n_pieces].place = &exact->held[w], pieces[n_pieces++].count = all_loose * m;
    }
    for (int order = 0; order < data->hold; order++)
        for (int i = 0; i < 2; i++)
            pieces[n_pieces].place = &exact->W[order][i], pieces[n_pieces++].count = m * m;
    for (int k = 0; k <= BD_HOLDS; k++)
        pieces[n_pieces].place = &exact->shares[k], pieces[n_pieces++].count = n;
    for (size_t i = 0; i < n_pieces; i++)
        total += BD_PADDED(pieces[i].count);
    const size_t bytes = total * sizeof(double);
    exact->memory = aligned_alloc(64, (bytes + 63) / 64 * 64);
    size_t *starts = calloc((size_t)model->n_layers + 1, sizeof *starts);
    if (!exact->memory || !exact->groups || !exact->seen || !exact->varying || !starts) {
        free(starts);
        return BD_NO_MEMORY;
    }
    memset(exact->memory, 0, bytes);
    double *next = exact->memory;
    for (size_t i = 0; i < n_pieces; i++) {
        *pieces[i].place = next;
        next += BD_PADDED(pieces[i].count);
    }

    size_t stresses = 0;
    for (int source = 0; source < model->n_layers; source++) {
        starts[source] = stresses;
        for (int l = 0; l < model->n_layers; l++)
            if (model->layers[l].source == source)
                stresses += (size_t)model->layers[l].rank * (size_t)model->layers[l].n_branches;
    }
    if (!take_groups(model, data, exact) || stresses != (size_t)data->n_stresses) {
        free(starts);
        return BD_BAD_SHAPE;
    }
    memcpy(exact->roots, data->roots, n * sizeof(double));
    for (int w = 0; w < bd_exact_held(data->hold + 1, 0); w++)
        memcpy(exact->weights[w], data->weights + (size_t)w * n, n * sizeof(double));
    memcpy(exact->loose, data->loose, (size_t)data->n_loose * sizeof(double));
    for (int k = 0; k < model->n_loads; k++) {
        const double *from = data->load + 2 * (size_t)k * n;
        if (model->loads[k].kind == BD_LOAD_CONSTANT) {
            for (size_t j = 0; j < n; j++)
                exact->constant[j] += from[j];
            continue;
        }
        memcpy(exact->load + 2 * (size_t)exact->n_varying * n, from, 2 * n * sizeof(double));
        exact->varying[exact->n_varying++] = k;
    }
    for (size_t j = 0; j < n; j++) {
        place_row(model, data->X + j * (size_t)model->n, exact->X + j * padded);
        place_row(model, data->V + j * (size_t)model->n, exact->V + j * padded);
        place_row(model, data->A + j * (size_t)model->n, exact->A + j * padded);
        place_stresses(model, data->S + j * stresses, starts, exact->S + j * model->n_stress);
    }
    free(starts);
    place_bearings(model, data, exact);
    place_channels(model, exact);
    return BD_OK;
}

void bd_exact_recall(const bd_model *model, bd_work *work, const bd_state *state)
{
    bd_exact *exact = work->exact;
    work->kernels->exact_shares(exact, state->g, exact->shares[1]);
    work->kernels->exact_shares(exact, state->g_before, exact->shares[2]);
    work->kernels->exact_shares(exact, state->g_before + model->coefs, exact->shares[3]);
}

void bd_exact_choose(const bd_model *model, bd_work *work, bd_state *state, double from)
{
    bd_exact *exact = work->exact;
    /* while the order grows, so does what a force does in the step: Newton's inverse was of the order before */
    if (state->clock.steps > 0 && state->clock.steps < exact->hold)
        state->clock.inverse_set = false;
    exact->order = (int)(state->clock.steps < exact->hold ? state->clock.steps + 1 : exact->hold);
    work->W = exact->W[exact->order - 1][0];
    work->W_rate = exact->W[exact->order - 1][1];

    if (exact->n_varying == 0)
        return;
    /* factors count at the step's start, and of a table at its end too */
    const bd_turn end = work->turn;
    work->turn = bd_turn_at(&work->profile, from, 0.0, 0.0);
    for (int i = 0; i < exact->n_varying; i++) {
        const bd_load *load = &model->loads[exact->varying[i]];
        double *factor = exact->factor + 2 * i;
        if (load->kind == BD_LOAD_HARMONIC) {
            factor[0] = cos(load->omega * from);
            factor[1] = sin(load->omega * from);
        } else if (load->kind == BD_LOAD_ROTATING) { /* the columns hold the square of the speed */
            factor[0] = cos(work->turn.angle);
            factor[1] = sin(work->turn.angle);
        } else {
            factor[0] = bd_load_sampled(load, from);
            factor[1] = work->load_factor[2 * exact->varying[i]];
        }
    }
    work->turn = end;
}

double bd_exact_row(const bd_model *model, const bd_work *work, const bd_state *state, int channel)
{
    const bd_exact *exact = work->exact;
    const double *row = exact->rows + (size_t)channel * exact->n;
    double sums[BD_LANES] = {0.0}, value = 0.0;
    for (size_t j = 0; j < exact->n; j += BD_LANES)
        for (size_t i = 0; i < BD_LANES; i++)
            sums[i] += row[j + i] * state->q[j + i];
    for (size_t i = 0; i < BD_LANES; i++)
        value += sums[i];
    if (model->channels[channel].kind == BD_CHANNEL_ACCELERATION) {
        for (size_t k = 0; k < (size_t)model->coefs; k++)
            value += exact->rows_g[(size_t)channel * (size_t)model->coefs + k] * state->g[k];
        for (size_t k = 0; k < 2 * (size_t)model->n_loads; k++)
            value += exact->rows_load[2 * (size_t)channel * (size_t)model->n_loads + k] *
                     work->load_factor[k];
    }
    return value;
}

void bd_exact_motion(const bd_model *model, const bd_work *work, bd_state *state)
{
    const bd_exact *exact = work->exact;
    const int n = (int)exact->n, padded = model->n_padded;
    const size_t all = (size_t)padded * sizeof(double);
    memset(state->x, 0, all);
    memset(state->v, 0, all);
    memset(state->a, 0, all);
    memset(state->stress, 0, model->n_stress * sizeof(double));
    columns_add(padded, n, exact->X, padded, state->q, state->x);
    columns_add(padded, n, exact->V, padded, state->q, state->v);
    columns_add(padded, n, exact->A, padded, state->q, state->a);
    columns_add(padded, model->coefs, exact->push, padded, state->g, state->a);
    for (int k = 0; k < model->n_loads; k++)
        for (int i = 0; i < padded; i++)
            state->a[i] += work->load_factor[2 * k] * model->loads[k].p_cos[i] +
                           work->load_factor[2 * k + 1] * model->loads[k].p_sin[i];
    columns_add((int)model->n_stress, n, exact->S, (int)model->n_stress, state->q, state->stress);
    memset(state->y_rate, 0, (size_t)model->ranks * sizeof *state->y_rate);
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        const bd_block *block = &model->blocks[layer->block];
        columns_add(layer->padded, block->n, layer->L, layer->padded, state->v + block->offset,
                    state->y_rate + layer->offset);
    }
}

void bd_exact_end(const bd_model *model, const bd_work *work, double *flat)
{
    bd_state state = bd_state_view(model, flat);
    if (work->exact)
        bd_exact_motion(model, work, &state);
}
