/* A state: one flat array, and what its parts are. */
#include "state.h"

#include <math.h>
#include <string.h>

/* ---------------------------------------------------------------- clock */

/* Where the clock's parts lie at the head of a state; a flag is 1 or 0, a count a whole number. */
enum { ORIGIN, STEPS, STEP, INVERSE_SET, REFERENCE, REFERENCE_SET, FILMS_SET };

/* From here on a count and the next are the same double. */
static const double most_steps = 9007199254740992.0;

static bd_clock clock_of(const double *flat)
{
    const bool counts = flat[STEPS] >= 0.0 && flat[STEPS] < most_steps;
    return (bd_clock){
        .origin = flat[ORIGIN],
        .steps = counts ? (long long)flat[STEPS] : -1,
        .dt = flat[STEP],
        .reference = flat[REFERENCE],
        .inverse_set = flat[INVERSE_SET] != 0.0,
        .reference_set = flat[REFERENCE_SET] != 0.0,
        .films_set = flat[FILMS_SET] != 0.0,
    };
}

bool bd_clock_valid(const bd_clock *clock)
{
    return clock->steps >= 0 && isfinite(clock->origin) && clock->dt >= 0.0 &&
           isfinite(clock->dt) && isfinite(clock->reference);
}

double bd_clock_time(const bd_clock *clock, long long ahead)
{
    return clock->origin + (double)(clock->steps + ahead) * clock->dt;
}

void bd_clock_restart(bd_clock *clock, double dt)
{
    clock->origin = bd_clock_time(clock, 0);
    clock->steps = 0;
    clock->dt = dt;
}

void bd_clock_keep(const bd_state *state)
{
    const bd_clock *clock = &state->clock;
    state->flat[ORIGIN] = clock->origin;
    state->flat[STEPS] = (double)clock->steps;
    state->flat[STEP] = clock->dt;
    state->flat[INVERSE_SET] = clock->inverse_set;
    state->flat[REFERENCE] = clock->reference;
    state->flat[REFERENCE_SET] = clock->reference_set;
    state->flat[FILMS_SET] = clock->films_set;
}

/* ---------------------------------------------------------------- parts */

size_t bd_state_size(const bd_model *model)
{
    size_t n = (size_t)model->n_padded, m = (size_t)model->coefs;
    return BD_LANES + 3 * n + (size_t)model->ranks + model->n_stress + model->n_softening_doubles +
           model->n_echo_doubles + 3 * m + m * m +
           (size_t)BD_PADDED(sizeof(bd_energy) / sizeof(double));
}

bd_state bd_state_view(const bd_model *model, double *flat)
{
    size_t n = (size_t)model->n_padded, m = (size_t)model->coefs;
    bd_state state = {.flat = flat, .clock = clock_of(flat)};
    state.x = flat + BD_LANES;
    state.v = state.x + n;
    state.a = state.v + n;
    state.y_rate = state.a + n;
    state.stress = state.y_rate + model->ranks;
    state.softening = state.stress + model->n_stress;
    state.echoes = state.softening + model->n_softening_doubles;
    state.g = state.echoes + model->n_echo_doubles;
    state.g_before = state.g + m;
    state.inverse = state.g_before + 2 * m;
    state.energy = (bd_energy *)(void *)(state.inverse + m * m);
    state.q = flat + bd_state_size(model);
    return state;
}

void bd_state_set(const bd_model *model, double *flat, double t, const double *x, const double *v)
{
    memset(flat, 0, bd_state_size(model) * sizeof *flat);
    bd_state state = bd_state_view(model, flat);
    state.flat[ORIGIN] = t;
    for (int i = 0; i < model->n; i++) {
        state.x[model->slot[i]] = x[i];
        state.v[model->slot[i]] = v[i];
    }
}

int bd_model_stresses(const bd_model *model)
{
    int count = 0;
    for (int l = 0; l < model->n_layers; l++)
        count += model->layers[l].n_branches * model->layers[l].rank;
    return count;
}

/* Where a layer's stresses begin among all in the caller's order. */
static int stresses_before(const bd_model *model, int source)
{
    int before = 0;
    for (int l = 0; l < model->n_layers; l++)
        if (model->layers[l].source < source)
            before += model->layers[l].n_branches * model->layers[l].rank;
    return before;
}

void bd_state_stress(const bd_model *model, double *flat, const double *stress)
{
    bd_state state = bd_state_view(model, flat);
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        const double *from = stress + stresses_before(model, layer->source);
        double *to = state.stress + layer->stress;
        for (int i = 0; i < layer->n_branches; i++, from += layer->rank, to += layer->padded)
            memcpy(to, from, (size_t)layer->rank * sizeof *to);
    }
}

int bd_model_films(const bd_model *model)
{
    int count = 0;
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing_data *data = &model->bearings[b].data;
        if (data->contact.n_echoes > 0)
            count += (1 + 2 * data->contact.n_echoes) * data->n_balls;
    }
    return count;
}

void bd_state_films(const bd_model *model, double *flat, const double *films)
{
    const bd_state state = bd_state_view(model, flat);
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        const int n_echoes = bearing->data.contact.n_echoes, n_balls = bearing->data.n_balls;
        double *to = state.echoes + bearing->echo;
        for (int row = 0; n_echoes > 0 && row < 1 + 2 * n_echoes; row++) {
            memcpy(to, films, (size_t)n_balls * sizeof *to);
            films += n_balls;
            to += bearing->balls;
        }
    }
    state.flat[FILMS_SET] = 1.0;
}

void bd_state_get(const bd_model *model, const double *flat, double *t, double *x, double *v,
                  double *a)
{
    const double *state_x = flat + BD_LANES, *state_v = state_x + model->n_padded;
    const double *state_a = state_v + model->n_padded;
    if (t)
        *t = flat[ORIGIN] + flat[STEPS] * flat[STEP];
    for (int i = 0; i < model->n; i++) {
        if (x)
            x[i] = state_x[model->slot[i]];
        if (v)
            v[i] = state_v[model->slot[i]];
        if (a)
            a[i] = state_a[model->slot[i]];
    }
}
