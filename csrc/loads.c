/* The loads at one time: what multiplies the columns that were solved for them beforehand. */
#include "loads.h"

#include <math.h>

double bd_load_sampled(const bd_load *load, double t)
{
    int low = 0, high = load->n_samples - 1;
    if (t <= load->time[0])
        return load->value[0];
    if (t >= load->time[high])
        return load->value[high];
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (load->time[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    double share = (t - load->time[low]) / (load->time[high] - load->time[low]);
    return load->value[low] + share * (load->value[high] - load->value[low]);
}

void bd_load_factors(const bd_model *model, bd_work *work, double t)
{
    const bd_turn turn = work->turn;
    double *factor = work->load_factor;
    for (int k = 0; k < model->n_loads; k++, factor += 2) {
        const bd_load *load = &model->loads[k];
        factor[1] = 0.0;
        switch (load->kind) {
        case BD_LOAD_CONSTANT:
            factor[0] = 1.0;
            break;
        case BD_LOAD_HARMONIC:
            factor[0] = cos(load->omega * t);
            factor[1] = sin(load->omega * t);
            break;
        case BD_LOAD_ROTATING: {
            const double c = cos(turn.angle), s = sin(turn.angle), square = turn.speed * turn.speed;
            factor[0] = square * c + turn.rate * s;
            factor[1] = square * s - turn.rate * c;
            break;
        }
        case BD_LOAD_SAMPLED:
            factor[0] = bd_load_sampled(load, t);
            break;
        }
    }
}
