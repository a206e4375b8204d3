/* What the oil carries through a contact: echoes of the approach that fade as the film passes, as trial and commit. */
#include "echoes.h"

#include <complex.h>
#include <string.h>

#include "work.h"

typedef double complex number;

static number from_parts(const double *parts)
{
    return parts[0] + parts[1] * I;
}

static void to_parts(number value, double *parts)
{
    parts[0] = creal(value);
    parts[1] = cimag(value);
}

/* Below this size of z the closed forms lose digits, so series are summed, whose last term is then below 1e-17. */
static const double series_limit = 0.5;
enum { SERIES_TERMS = 14 };

bd_echo_weights bd_echo_step(const bd_echo *echo, double dt)
{
    const number z = -dt * from_parts(echo->decay);
    number mean, late; /* integrals of exp(z (1 - t)) and t exp(z (1 - t)) over 0 ... 1 */
    if (cabs(z) < series_limit) {
        number term = 1.0; /* z^k / (k+1)! */
        mean = late = 0.0;
        for (int k = 0; k < SERIES_TERMS; k++) {
            mean += term;
            late += term / (double)(k + 2);
            term *= z / (double)(k + 2);
        }
    } else {
        mean = (cexp(z) - 1.0) / z;
        late = (mean - 1.0) / z;
    }
    bd_echo_weights weights;
    to_parts(cexp(z), weights.decay);
    to_parts(dt * (mean - late), weights.old);
    to_parts(dt * late, weights.now);
    return weights;
}

size_t bd_echoes_size(const bd_bearing_data *data)
{
    const size_t n = (size_t)data->contact.n_echoes;
    return n > 0 ? (1 + 2 * n) * (size_t)BD_PADDED(data->n_balls) : 0;
}

void bd_echoes_prepare(const bd_model *model, bd_work *work)
{
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        for (int i = 0; i < bearing->data.contact.n_echoes; i++)
            work->echoes[bearing->weight + i] =
                bd_echo_step(&bearing->data.contact.echoes[i], work->scheme.dt);
    }
}

void bd_echoes_forget(const bd_model *model, bd_work *work)
{
    for (int b = 0; b < model->n_bearings; b++) {
        bd_bearing_work *balls = &work->bearings[b];
        memset(balls->carried, 0, (size_t)model->bearings[b].balls * sizeof *balls->carried);
        balls->fresh = 1.0;
    }
}

void bd_echoes_begin(const bd_model *model, const bd_work *work, bd_state *state)
{
    for (int b = 0; b < model->n_bearings; b++) {
        const bd_bearing *bearing = &model->bearings[b];
        const bd_contact *contact = &bearing->data.contact;
        if (contact->n_echoes == 0)
            continue;
        const size_t balls = (size_t)bearing->balls;
        const double *pressed = work->bearings[b].pressed;
        double *q = state->echoes + bearing->echo + balls;
        memcpy(q - balls, pressed, balls * sizeof *pressed);
        for (int i = 0; i < contact->n_echoes; i++, q += 2 * balls) {
            double slow[2];
            to_parts(1.0 / from_parts(contact->echoes[i].decay), slow);
            for (size_t j = 0; j < balls; j++) {
                q[j] = slow[0] * pressed[j];
                q[balls + j] = slow[1] * pressed[j];
            }
        }
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
