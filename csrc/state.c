/* A state: one flat array, and what its parts are. */
#include <string.h>

#include "model.h"

size_t bd_state_size(const bd_model *model)
{
    size_t n = (size_t)model->n_padded, m = (size_t)model->coefs;
    return BD_LANES + 3 * n + (size_t)model->ranks + model->n_stress + 3 * m + m * m +
           (size_t)BD_PADDED(sizeof(bd_energy) / sizeof(double));
}

bd_state bd_state_view(const bd_model *model, double *flat)
{
    size_t n = (size_t)model->n_padded, m = (size_t)model->coefs;
    bd_state state = {.clock = flat};
    state.x = flat + BD_LANES;
    state.v = state.x + n;
    state.a = state.v + n;
    state.y_rate = state.a + n;
    state.stress = state.y_rate + model->ranks;
    state.g = state.stress + model->n_stress;
    state.g_before = state.g + m;
    state.inverse = state.g_before + 2 * m;
    state.energy = (bd_energy *)(void *)(state.inverse + m * m);
    return state;
}

void bd_state_set(const bd_model *model, double *flat, double t, const double *x, const double *v)
{
    memset(flat, 0, bd_state_size(model) * sizeof *flat);
    bd_state state = bd_state_view(model, flat);
    state.clock[0] = t;
    for (int i = 0; i < model->n; i++) {
        state.x[model->slot[i]] = x[i];
        state.v[model->slot[i]] = v[i];
    }
}

void bd_state_get(const bd_model *model, const double *flat, double *t, double *x, double *v,
                  double *a)
{
    const double *state_x = flat + BD_LANES, *state_v = state_x + model->n_padded;
    const double *state_a = state_v + model->n_padded;
    if (t)
        *t = flat[0] + flat[1] * flat[2];
    for (int i = 0; i < model->n; i++) {
        if (x)
            x[i] = state_x[model->slot[i]];
        if (v)
            v[i] = state_v[model->slot[i]];
        if (a)
            a[i] = state_a[model->slot[i]];
    }
}
