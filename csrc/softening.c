#include "softening.h"

#include <math.h>

#include "state.h"

/* Of a layer's block in a state, behind its deviation: both filters of d^2 and of y'^2; what S was factored with; when
 * that was; whether it was. */
enum { A_ONCE, A_TWICE, B_ONCE, B_TWICE, SPRING, BRANCH, RATE, LIFT, RENEWED, SET };

/* Shares of E that E and L may be off by in the long run: a third of a percent of E is a thousandth of a layer's
 * modulus, and so is the other of its loss. While the amplitude builds up, for `patience` memories after a renewal, S is
 * factored more seldom; once it has held still for `settled`, what is left of the difference is taken out. */
static const double spring_off = 3e-3, branch_off = 5e-4, hurry = 4.0, patience = 3.0;
static const double settled = 6.0, rest = 0.2;
/* Steps between two looks at them: they are slow. */
enum { LOOK = 8 };
/* Periods that a memory is long, where nothing has moved yet. */
static const double periods = 5.0;
static const double two_pi = 6.283185307179586476925286766559;
/* Least share of D that stays a spring, where the law is used beyond its range. */
static const double least_spring = 1e-3;

/* Memories that the slow branch is long: its own loss is then three thousandths of its storage. */
static const double slow = 10.0;

typedef struct law {
    double spring, branch, rate, lift; /* E, L in Pa; Omega in 1/s; the slow branch, Pa */
} law;

static double *numbers_of(const bd_layer *layer, const bd_state *state)
{
    return state->softening + layer->memory + layer->padded;
}

/* The spring's stress, and behind it those of the branch and of the slow one. */
static double *stress_of(const bd_layer *layer, const bd_state *state)
{
    return state->stress + layer->stress + (size_t)layer->n_branches * (size_t)layer->padded;
}

/* What the Maxwell branches lack of strength (0) or loss (1) at a rate: linear between the table's points, even in the
 * logarithm of the rate, held outside. */
static double lacked(const bd_softening_data *data, double rate, int which)
{
    const int last = data->n_table - 1;
    if (last < 0)
        return 0.0;
    const double *values = data->table + which * data->n_table;
    const double at = last == 0 ? 0.0
                                : log(rate / data->rate_first) /
                                      log(data->rate_last / data->rate_first) * (double)last;
    if (!(at > 0.0))
        return values[0];
    if (at >= (double)last)
        return values[last];
    const int k = (int)at;
    const double share = at - (double)k;
    return (1.0 - share) * values[k] + share * values[k + 1];
}

/* E, L and Omega at the running amplitude. */
static law law_at(const bd_softening_data *data, const double *numbers)
{
    const double a = numbers[A_TWICE], b = numbers[B_TWICE];
    const double amplitude = sqrt(2.0 * a);
    const double rate = a > 0.0 && b > 0.0 ? sqrt(b / a) : two_pi * periods / data->memory;
    const double v = pow(amplitude / data->gamma_l, data->p);
    const double loss = data->Lm * v / (1.0 + v);
    const double storage =
        data->D * pow(1.0 + pow(amplitude / data->gamma_c, data->p), -data->m / data->p);
    const double lift = lacked(data, rate, 0);
    return (law){
        .spring = fmax(storage - loss, least_spring * data->D),
        /* of the loss that is lacked the slow branch brings a little */
        .branch = fmax(loss + lacked(data, rate, 1) - lift / (slow * data->memory * rate), 0.0),
        .rate = rate,
        .lift = lift,
    };
}

static law law_held(const double *numbers)
{
    return (law){numbers[SPRING], numbers[BRANCH], numbers[RATE], numbers[LIFT]};
}

static void hold_law(double *numbers, law now, double t)
{
    numbers[SPRING] = now.spring;
    numbers[BRANCH] = now.branch;
    numbers[RATE] = now.rate;
    numbers[LIFT] = now.lift;
    numbers[RENEWED] = t;
    numbers[SET] = 1.0;
}

static double square(const bd_layer *layer, const double *stress)
{
    double sum = 0.0;
    for (int r = 0; r < layer->rank; r++)
        sum += stress[r] * stress[r];
    return sum;
}

/* A spring of modulus G under the stress 2 G y holds stress^2 / 4 G. */
static double held_energy(const bd_layer *layer, const double *stress, double modulus)
{
    return modulus > 0.0 ? square(layer, stress) / (4.0 * modulus) : 0.0;
}

double bd_softening_stored(const bd_layer *layer, const bd_state *state)
{
    if (!layer->softening)
        return 0.0;
    const law held = law_held(numbers_of(layer, state));
    const double *spring = stress_of(layer, state);
    return held_energy(layer, spring, held.spring) +
           held_energy(layer, spring + layer->padded, 2.0 * held.branch) +
           held_energy(layer, spring + 2 * layer->padded, held.lift);
}

double bd_softening_loss(const bd_layer *layer, const bd_state *state)
{
    if (!layer->softening)
        return 0.0;
    const law held = law_held(numbers_of(layer, state));
    const double *branch = stress_of(layer, state) + layer->padded;
    return 2.0 * (held.rate * held_energy(layer, branch, 2.0 * held.branch) +
                  held_energy(layer, branch + layer->padded, held.lift) /
                      (slow * layer->softening->memory));
}

double bd_softening_strain(const bd_layer *layer, const bd_state *state)
{
    return layer->softening ? sqrt(2.0 * numbers_of(layer, state)[A_TWICE]) : 0.0;
}

/* The spring of a layer at rest in x: what it carries there beyond its own relaxed stiffness. */
static void press(const bd_model *model, const bd_layer *layer, const bd_state *state)
{
    const bd_block *block = &model->blocks[layer->block];
    double *spring = stress_of(layer, state);
    for (int j = 0; j < block->n; j++)
        for (int r = 0; r < layer->rank; r++)
            spring[r] += 2.0 * layer->softening->pressed *
                         layer->L[(size_t)j * (size_t)layer->padded + (size_t)r] *
                         state->x[block->offset + j];
}

bool bd_softening_moved(const bd_model *model, const bd_state *state)
{
    if (model->n_softening == 0 || state->clock.steps % LOOK != 0)
        return false;
    const double t = bd_clock_time(&state->clock, 0);
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        if (!layer->softening)
            continue;
        const double *numbers = numbers_of(layer, state);
        const law now = law_at(layer->softening, numbers), held = law_held(numbers);
        if (!isfinite(now.spring + now.branch + now.rate + now.lift))
            continue; /* the march will say so */
        const double age = (t - numbers[RENEWED]) / layer->softening->memory;
        const double share = age < patience ? hurry : age < settled ? 1.0 : rest;
        const double slack = share * held.spring;
        if (!(fabs(now.spring - held.spring) <= spring_off * slack) ||
            !(fabs(now.branch - held.branch) <= branch_off * slack) ||
            !(fabs(now.lift - held.lift) <= spring_off * slack) ||
            !(held.branch * fabs(log(now.rate / held.rate)) <= spring_off * slack))
            return true;
    }
    return false;
}

void bd_softening_step(const bd_model *model, const bd_work *work, const bd_state *state)
{
    const double half = 0.5 * work->scheme.dt;
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        if (!layer->softening)
            continue;
        const double *strain = layer->softening->strain;
        const double *before = work->y_before + layer->offset;
        const double *rate = state->y_rate + layer->offset;
        double *d = state->softening + layer->memory, *numbers = numbers_of(layer, state);
        const double forget = work->forget[l], keep = 1.0 - forget;
        /* what came in a step came, on average, in its middle */
        const double came = half * sqrt(keep);
        double moved = 0.0, turned = 0.0;
        for (int r = 0; r < layer->rank; r++) {
            d[r] = keep * d[r] + came * (before[r] + rate[r]);
            moved += strain[r] * d[r] * d[r];
            turned += strain[r] * rate[r] * rate[r];
        }
        numbers[A_ONCE] += forget * (moved - numbers[A_ONCE]);
        numbers[A_TWICE] += forget * (numbers[A_ONCE] - numbers[A_TWICE]);
        numbers[B_ONCE] += forget * (turned - numbers[B_ONCE]);
        numbers[B_TWICE] += forget * (numbers[B_ONCE] - numbers[B_TWICE]);
    }
}

/* What is left of the stress of a spring whose modulus changes. */
static double left(double now, double before)
{
    return before > 0.0 ? fmin(1.0, now / before) : 1.0;
}

/* Gives a layer's spring and branches a new law. Returned: the energy that is lost by it. */
static double renew(const bd_layer *layer, const bd_state *state, law now, double t)
{
    double *numbers = numbers_of(layer, state);
    double *spring = stress_of(layer, state);
    double *branch = spring + layer->padded, *lift = branch + layer->padded;
    const law held = law_held(numbers);
    const double before = bd_softening_stored(layer, state);
    const double spring_left = left(now.spring, held.spring);
    const double branch_left = left(now.branch, held.branch);
    const double lift_left = left(now.lift, held.lift);
    for (int r = 0; r < layer->rank; r++) {
        spring[r] *= spring_left;
        branch[r] *= branch_left;
        lift[r] *= lift_left;
    }
    hold_law(numbers, now, t);
    return before - bd_softening_stored(layer, state);
}

void bd_soften(const bd_model *model, const bd_scheme *scheme, double *flat, bool anew,
               bd_work *work)
{
    const bd_state state = bd_state_view(model, flat);
    const double t = bd_clock_time(&state.clock, 0);
    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        if (!layer->softening)
            continue;
        double *numbers = numbers_of(layer, &state);
        const law now = law_at(layer->softening, numbers);
        if (numbers[SET] == 0.0) {
            press(model, layer, &state);
            hold_law(numbers, now, t);
        } else if (anew) {
            const double lost = renew(layer, &state, now, t);
            if (scheme->audit)
                state.energy->softening += lost;
        }
        bd_branch_weights *weights = work->weights + layer->branch + layer->n_branches;
        const law held = law_held(numbers);
        /* a spring is a branch that never relaxes: 2 E times the mean rate */
        weights[0] = (bd_branch_weights){1.0, held.spring * scheme->dt, held.spring * scheme->dt};
        weights[1] = bd_maxwell_weights(scheme->dt, 1.0 / held.rate, 2.0 * held.branch);
        weights[2] = bd_maxwell_weights(scheme->dt, slow * layer->softening->memory, held.lift);
        work->forget[l] = -expm1(-scheme->dt / layer->softening->memory);
    }
}
