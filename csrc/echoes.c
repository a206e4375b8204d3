/* What the oil carries through a contact: echoes of the approach that fade as the film passes, as trial and commit. */
#include "echoes.h"

#include <string.h>

#include "newton.h"

void bd_echoes_settle(const bd_model *model, bd_work *work, bd_state *state)
{
    const size_t m = (size_t)model->coefs;
    /* the balls turn past what stands, and have always done so: q = p / decay, which is fresh by 1 */
    double *moving = work->z_rate,
           *standing = work->z_rate_linear; /* the latter is free before a step */
    memset(standing, 0, m * sizeof *standing);
    for (int b = 0; b < model->n_bearings; b++) {
        bd_bearing_work *balls = &work->bearings[b];
        memset(balls->carried, 0, (size_t)model->bearings[b].balls * sizeof *balls->carried);
        balls->fresh = 1.0;
    }
    work->z_rate = standing;
    bd_force_bearings(model, work);
    work->z_rate = moving;

    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        const bd_contact *contact = &bearing->data.contact;
        const size_t balls = (size_t)bearing->balls;
        const double *pressed = work->bearings[b].pressed;
        double *q = state->echoes + bearing->echo + balls;
        for (int i = 0; i < contact->n_echoes; i++, q += 2 * balls) {
            /* 1/decay */
            const double *d = contact->echoes[i].decay, size = d[0] * d[0] + d[1] * d[1];
            const double slow[2] = {d[0] / size, -d[1] / size};
            for (size_t j = 0; j < balls; j++) {
                q[j] = slow[0] * pressed[j];
                q[balls + j] = slow[1] * pressed[j];
            }
        }
    }
}

void bd_echoes_recall(const bd_model *model, bd_work *work, const bd_state *state)
{
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        const bd_contact *contact = &bearing->data.contact;
        const size_t balls = (size_t)bearing->balls;
        const double *q = state->echoes + bearing->echo + balls;
        double *restrict carried = work->bearings[b].carried;
        memset(carried, 0, balls * sizeof *carried);
        for (int i = 0; i < contact->n_echoes; i++, q += 2 * balls)
            for (size_t j = 0; j < balls; j++)
                carried[j] += contact->echoes[i].strength[0] * q[j] -
                              contact->echoes[i].strength[1] * q[balls + j];
        work->bearings[b].fresh = 0.0;
    }
}

void bd_echoes_press(const bd_model *model, const bd_work *work, bd_state *state)
{
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        if (bearing->data.contact.n_echoes > 0)
            memcpy(state->echoes + bearing->echo, work->bearings[b].pressed,
                   (size_t)bearing->balls * sizeof(double));
    }
}

void bd_echoes_trial(const bd_model *model, bd_work *work, const bd_state *state)
{
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        const bd_contact *contact = &bearing->data.contact;
        if (contact->n_echoes == 0)
            continue;
        const size_t balls = (size_t)bearing->balls;
        const double *pressed = state->echoes + bearing->echo, *q = pressed + balls;
        double *restrict carried = work->bearings[b].carried;
        double fresh = 0.0;
        memset(carried, 0, balls * sizeof *carried);
        for (int i = 0; i < contact->n_echoes; i++, q += 2 * balls) {
            const bd_echo_weights *w = &work->echoes[bearing->weight + i];
            const double *strength = contact->echoes[i].strength;
            /* real parts of strength times the weights */
            const double re = strength[0] * w->decay[0] - strength[1] * w->decay[1];
            const double im = strength[0] * w->decay[1] + strength[1] * w->decay[0];
            const double old = strength[0] * w->old[0] - strength[1] * w->old[1];
            fresh += strength[0] * w->now[0] - strength[1] * w->now[1];
            for (size_t j = 0; j < balls; j++)
                carried[j] += re * q[j] - im * q[balls + j] + old * pressed[j];
        }
        work->bearings[b].fresh = fresh;
    }
}

void bd_echoes_commit(const bd_model *model, const bd_work *work, bd_state *state)
{
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        const int n_echoes = bearing->data.contact.n_echoes;
        if (n_echoes == 0)
            continue;
        const size_t balls = (size_t)bearing->balls;
        const double *restrict new = work->bearings[b].pressed;
        double *restrict pressed = state->echoes + bearing->echo;
        double *restrict q = pressed + balls;
        for (int i = 0; i < n_echoes; i++, q += 2 * balls) {
            const bd_echo_weights *w = &work->echoes[bearing->weight + i];
            for (size_t j = 0; j < balls; j++) {
                const double re = q[j], im = q[balls + j];
                q[j] = w->decay[0] * re - w->decay[1] * im + w->old[0] * pressed[j] +
                       w->now[0] * new[j];
                q[balls + j] = w->decay[1] * re + w->decay[0] * im + w->old[1] * pressed[j] +
                               w->now[1] * new[j];
            }
        }
        memcpy(pressed, new, balls * sizeof *new);
    }
}
