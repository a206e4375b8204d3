/* The audit: where the energy is, and which power changes it. Written from the physics of each element, not from
 * the scheme, so that a mistake in the march does not cancel here. */
#include "energy.h"

#include "elastic_force.h"

#include <math.h>
#include <string.h>

#include "softening.h"

/* half x^T A x of a block-diagonal matrix, and A x into `product`. */
static double quadratic(const bd_model *model, const double *A, const double *x, double *product)
{
    double sum = 0.0;
    for (int b = 0; b < model->n_blocks; b++) {
        const bd_block *block = &model->blocks[b];
        const size_t n = (size_t)block->n;
        for (size_t i = 0; i < n; i++) {
            double row = 0.0;
            for (size_t j = 0; j < n; j++)
                row += A[block->matrix + i * n + j] * x[(size_t)block->offset + j];
            product[(size_t)block->offset + i] = row;
            sum += 0.5 * row * x[(size_t)block->offset + i];
        }
    }
    return sum;
}

double bd_contact_loss(const bd_bearing_data *data, const bd_bearing_work *balls)
{
    double loss = 0.0;
    for (int j = 0; j < data->n_balls; j++) {
        double s = fmax(balls->delta[j] + data->contact.h0, 0.0);
        double energy;
        loss += (balls->force[j] - bd_elastic_force(&data->contact, s, &energy)) * balls->rate[j];
    }
    return loss;
}

/* a branch is a spring 2 G and a dashpot 2 G tau in series, under the stress S; 0 if it is none */
static double branch_square(const bd_layer *layer, int branch, const double *stress)
{
    const double *S = stress + layer->stress + (size_t)branch * (size_t)layer->padded;
    double square = 0.0;
    if (!(layer->modulus[branch] > 0.0))
        return 0.0;
    for (int r = 0; r < layer->rank; r++)
        square += S[r] * S[r];
    return square / (2.0 * layer->modulus[branch]);
}

double bd_branch_loss(const bd_layer *layer, const bd_state *state)
{
    double loss = 0.0;
    for (int i = 0; i < layer->n_branches; i++)
        loss += branch_square(layer, i, state->stress) / layer->tau[i];
    return loss;
}

void bd_energy_rates(const bd_model *model, bd_work *work, const bd_state *state, bd_energy *energy)
{
    double load = 0.0, turning = 0.0, branch = 0.0, contact = 0.0, softening = 0.0;
    double stored = 0.0, indentation = 0.0;

    energy->kinetic = quadratic(model, model->matrices.M, state->v, work->loss);
    energy->elastic = quadratic(model, model->matrices.K, state->x, work->loss);
    double linear = 2.0 * quadratic(model, model->matrices.C, state->v, work->loss);

    /* the circulatory force -speed N x: the shaft turns damping material through its own deflection; and
     * the gyroscopic force rate G x of a changing speed */
    quadratic(model, model->matrices.N, state->x, work->loss);
    for (int i = 0; i < model->n_padded; i++)
        turning -= work->turn.speed * work->loss[i] * state->v[i];
    if (work->turn.rate != 0.0) {
        quadratic(model, model->matrices.G, state->x, work->loss);
        for (int i = 0; i < model->n_padded; i++)
            turning -= work->turn.rate * work->loss[i] * state->v[i];
    }

    for (int k = 0; k < model->n_loads; k++)
        for (int i = 0; i < model->n_padded; i++)
            load += (work->load_factor[2 * k] * model->loads[k].p_cos[i] +
                     work->load_factor[2 * k + 1] * model->loads[k].p_sin[i]) *
                    state->v[i];

    for (int l = 0; l < model->n_layers; l++) {
        const bd_layer *layer = &model->layers[l];
        for (int i = 0; i < layer->n_branches; i++)
            stored += 0.5 * branch_square(layer, i, state->stress);
        branch += bd_branch_loss(layer, state);
        stored += bd_softening_stored(layer, state);
        softening += bd_softening_loss(layer, state);
    }

    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing_data *data = &model->bearings[b].data;
        const bd_bearing_work *balls = &work->bearings[b];
        for (int j = 0; j < data->n_balls; j++) {
            double s = fmax(balls->delta[j] + data->contact.h0, 0.0);
            double elastic;
            bd_elastic_force(&data->contact, s, &elastic);
            indentation += elastic;
            turning += balls->force[j] * balls->turning[j];
        }
        contact += bd_contact_loss(data, balls);
    }

    energy->stored = stored;
    energy->indentation = indentation;
    memcpy(energy->power, (double[]){load, turning, linear, branch, contact, softening},
           sizeof energy->power);
}

void bd_energy_step(const bd_model *model, bd_work *work, const bd_state *state)
{
    bd_energy *energy = state->energy;
    double *works[] = {&energy->load,   &energy->turning, &energy->linear,
                       &energy->branch, &energy->contact, &energy->softening};
    const double half = 0.5 * work->scheme.dt;
    double before[6];

    memcpy(before, energy->power, sizeof before);
    bd_energy_rates(model, work, state, energy);
    for (int i = 0; i < 6; i++)
        *works[i] += half * (before[i] + energy->power[i]);
    energy->throughput +=
        half * (fabs(before[0] + before[1]) + fabs(energy->power[0] + energy->power[1]));
}
