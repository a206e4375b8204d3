#include "bearing.h"

#include "kernels.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* A gap no displacement of the linear theory closes: keeps padding lanes out of contact. */
static const double no_ball = -1e6;

size_t bd_bearing_work_size(const bd_bearing_data *data)
{
    size_t balls = (size_t)BD_PADDED(data->n_balls), coefs = (size_t)BD_PADDED(data->n_coefs);
    return 2 * (size_t)data->n_coefs * balls + 4 * balls * coefs + (23 + BD_FILM_POWERS) * balls;
}

bool bd_has_film(const bd_contact *contact)
{
    return contact->law == BD_DAMPING_FILM || contact->law == BD_DAMPING_CARRIED;
}

size_t bd_echoes_size(const bd_bearing_data *data)
{
    const size_t n = (size_t)data->contact.n_echoes;
    return n > 0 ? (1 + 2 * n) * (size_t)BD_PADDED(data->n_balls) : 0;
}

size_t bd_bearing_constants(const bd_bearing_data *data)
{
    const bool film = bd_has_film(&data->contact);
    return (3 + 2 * (size_t)data->n_waves) * (size_t)BD_PADDED(data->n_balls) +
           (film ? BD_FILM_CELLS * BD_FILM_POWERS : 0);
}

/* Hermite's cubics of a film's law by powers of the distance in w from the cell's start. */
static void set_film(const bd_contact *contact, double *film)
{
    const double *at = contact->table_delta, *rise = contact->table_c, n = BD_FILM_CELLS;
    for (int i = 0; i < BD_FILM_CELLS; i++, film += BD_FILM_POWERS) {
        const double over = at[i + 1] - at[i], third = rise[i] + rise[i + 1] - 2.0 * over;
        film[0] = at[i];
        film[1] = n * rise[i];
        film[2] = n * n * (over - rise[i] - third);
        film[3] = n * n * n * third;
    }
}

void bd_bearing_setup(bd_bearing *bearing, const bd_bearing_data *data, double *constants)
{
    const double pi = 3.14159265358979323846;
    int balls = BD_PADDED(data->n_balls);
    double *spacing_cos = constants, *spacing_sin = constants + balls,
           *absent = constants + 2 * balls;

    for (int j = 0; j < balls; j++) {
        double angle = 2.0 * pi * (double)j / (double)data->n_balls;
        bool real = j < data->n_balls;
        spacing_cos[j] = real ? cos(angle) : 0.0;
        spacing_sin[j] = real ? sin(angle) : 0.0;
        absent[j] = real ? 0.0 : no_ball;
    }
    double *wave_cos = absent + balls, *wave_sin = wave_cos + (size_t)data->n_waves * (size_t)balls;
    for (int w = 0; w < data->n_waves; w++)
        for (int j = 0; j < data->n_balls; j++) {
            /* the remainder keeps high orders exact */
            long long step = (long long)data->waves[w].order * j % data->n_balls;
            double angle = 2.0 * pi * (double)step / (double)data->n_balls;
            wave_cos[w * balls + j] = cos(angle);
            wave_sin[w * balls + j] = sin(angle);
        }
    double *film = wave_sin + (size_t)data->n_waves * (size_t)balls;
    bearing->film = bd_has_film(&data->contact) ? film : NULL;
    if (bearing->film)
        set_film(&data->contact, film);
    bearing->data = *data;
    bearing->balls = balls;
    bearing->coefs = BD_PADDED(data->n_coefs);
    bearing->spacing_cos = spacing_cos;
    bearing->spacing_sin = spacing_sin;
    bearing->absent = absent;
    bearing->wave_cos = wave_cos;
    bearing->wave_sin = wave_sin;
}

void bd_bearing_work_carve(const bd_bearing *bearing, bd_bearing_work *work, double *memory)
{
    size_t balls = (size_t)bearing->balls, coefs = (size_t)bearing->coefs;
    size_t by_ball = (size_t)bearing->data.n_coefs * balls;
    double **parts[] = {
        &work->sine_a,     &work->cosine_a, &work->delta,  &work->rate,         &work->turn,
        &work->tilt,       &work->turning,  &work->force,  &work->stiffness,    &work->damping,
        &work->shift_X,    &work->shift_Y,  &work->shift,  &work->shift_X_rate, &work->shift_Y_rate,
        &work->shift_rate, &work->place,    &work->inside, &work->pull,         &work->peak,
        &work->carried,    &work->pressed,  &work->cell,   &work->cubic};

    work->holds = false;
    work->fresh = 1.0;
    work->normal = memory + 2 * by_ball + 2 * balls * coefs;
    bd_bearing_lead(bearing, work, NULL);
    work->along = work->normal + balls * coefs;
    memory = work->along + balls * coefs;
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++, memory += balls)
        *parts[i] = memory;
    memset(work->cell, 0, balls * sizeof *work->cell);
}

void bd_bearing_lead(const bd_bearing *bearing, bd_bearing_work *work,
                     const bd_bearing_work *leader)
{
    const size_t balls = (size_t)bearing->balls, coefs = (size_t)bearing->coefs;
    const size_t by_ball = (size_t)bearing->data.n_coefs * balls, by_coef = balls * coefs;

    work->led = leader != NULL;
    work->phi = leader ? leader->phi : work->normal - 2 * by_ball - 2 * by_coef;
    work->dphi = work->phi + by_ball;
    work->phi_ball = work->dphi + by_ball;
    work->dphi_ball = work->phi_ball + by_coef;
}

/* Of the largest ball load: a ball that only brushes the groove does not carry. */
static const double carries = 0.01;
/* Of the open sine, 1 of 5 degrees: a ball that leans on the shoulder at all. */
static const double leans = 0.2;

bool bd_bearing_runs_off(const bd_bearing *bearing, const bd_bearing_work *work)
{
    const bd_bearing_data *data = &bearing->data;
    double largest = 0.0, astray = 0.0, leaning = 0.0;
    if (data->shoulder == 0)
        return false;
    for (int j = 0; j < data->n_balls; j++) {
        const double sine = (double)data->shoulder * work->sine_a[j], force = work->force[j];
        largest = fmax(largest, force);
        astray = sine < -data->open_sine ? fmax(astray, force) : astray;
        leaning = sine > leans * data->open_sine ? fmax(leaning, force) : leaning;
    }
    return astray > carries * largest || (largest > 0.0 && leaning <= carries * largest);
}

bd_status bd_bearing_single(const bd_bearing_data *data, const double *z, const double *z_rate,
                            double angle, double cage_speed, bd_turn shaft, double *g, double *K,
                            double *C, double *loads)
{
    size_t coefs = (size_t)BD_PADDED(data->n_coefs), n = (size_t)data->n_coefs;
    size_t constants = bd_bearing_constants(data), scratch = bd_bearing_work_size(data);
    double *memory = calloc(constants + scratch + 3 * coefs + 2 * n * coefs, sizeof *memory);
    if (!memory)
        return BD_NO_MEMORY;
    double *padded_z = memory + constants + scratch, *padded_rate = padded_z + coefs;
    double *padded_g = padded_rate + coefs, *padded_K = padded_g + coefs;
    double *padded_C = padded_K + n * coefs;
    const bd_kernels *kernels = bd_kernels_for(BD_ISA_BEST);
    bd_bearing bearing;
    bd_bearing_work work;

    bd_bearing_setup(&bearing, data, memory);
    bd_bearing_work_carve(&bearing, &work, memory + constants);
    memcpy(padded_z, z, n * sizeof *z);
    memcpy(padded_rate, z_rate, n * sizeof *z_rate);
    kernels->turn(&bearing, &work, angle);
    if (!bd_bearing_perfect(&bearing)) {
        const bd_bodies stand = bd_bearing_bodies(data, angle, shaft.angle);
        const bd_bodies turn = bd_bearing_bodies(data, cage_speed, shaft.speed);
        bd_bearing_imperfect(&bearing, &work, &stand, &turn);
    }
    kernels->force(&bearing, &work, padded_z, padded_rate, cage_speed, padded_g);
    kernels->tangent(&bearing, &work, cage_speed, (int)coefs, padded_K, padded_C);

    memcpy(g, padded_g, n * sizeof *g);
    for (size_t k = 0; k < n; k++) {
        memcpy(K + k * n, padded_K + k * coefs, n * sizeof *K);
        memcpy(C + k * n, padded_C + k * coefs, n * sizeof *C);
    }
    memcpy(loads, work.force, (size_t)data->n_balls * sizeof *loads);
    free(memory);

    /* 0 times a number that is not finite is NaN */
    double poison = 0.0;
    for (size_t k = 0; k < n; k++)
        poison += 0.0 * g[k];
    for (size_t kl = 0; kl < n * n; kl++)
        poison += 0.0 * K[kl] + 0.0 * C[kl];
    return poison == 0.0 ? BD_OK : BD_NOT_FINITE;
}
