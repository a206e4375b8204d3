#include "record.h"

#include <math.h>

#include "energy.h"
#include "exact.h"
#include "softening.h"

void bd_record_row(const bd_model *model, const bd_work *work, bd_state *state, double *row)
{
    const double *const motion[] = {state->x, state->v, state->a};
    if (work->exact && work->exact->physical)
        bd_exact_motion(model, work, state);
    for (int c = 0; c < model->n_channels; c++) {
        const bd_channel *channel = &model->channels[c];
        double value = 0.0;
        switch (channel->kind) {
        case BD_CHANNEL_DISPLACEMENT:
        case BD_CHANNEL_VELOCITY:
        case BD_CHANNEL_ACCELERATION:
            if (work->exact) {
                value = bd_exact_row(model, work, state, c);
                break;
            }
            for (int i = 0; i < model->n_padded; i++)
                value += channel->row[i] * motion[channel->kind][i];
            break;
        case BD_CHANNEL_FORCE:
            value = state->g[model->bearing_slot[channel->bearing] + channel->index];
            break;
        case BD_CHANNEL_BALL:
            value = work->bearings[channel->bearing].force[channel->index];
            break;
        case BD_CHANNEL_LOADED:
            for (int j = 0; j < model->bearings[channel->bearing].data.n_balls; j++)
                value += work->bearings[channel->bearing].force[j] > 0.0 ? 1.0 : 0.0;
            break;
        case BD_CHANNEL_CONTACT_LOSS:
            value = bd_contact_loss(&model->bearings[channel->bearing].data,
                                    &work->bearings[channel->bearing]);
            break;
        case BD_CHANNEL_BRANCH_LOSS:
            value = bd_branch_loss(&model->layers[channel->index], state) +
                    bd_softening_loss(&model->layers[channel->index], state);
            break;
        case BD_CHANNEL_STRAIN:
            value = bd_softening_strain(&model->layers[channel->index], state);
            break;
        }
        row[c] = value;
    }
}

void bd_count_open_sides(const bd_model *model, const bd_work *work, double t, bd_report *report)
{
    int b = 0;
    while (b < model->n_bearings && !bd_bearing_runs_off(&model->bearings[b], &work->bearings[b]))
        b++;
    if (b == model->n_bearings)
        return;
    if (report->open_steps++ == 0) {
        report->open_t = t;
        report->open_bearing = b;
    }
}

double bd_peak_load(const bd_model *model, const bd_work *work, int bearing)
{
    double largest = 0.0;
    for (int j = 0; j < model->bearings[bearing].data.n_balls; j++)
        largest = fmax(largest, work->bearings[bearing].peak[j]);
    return largest;
}
