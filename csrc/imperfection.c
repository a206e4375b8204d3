/* What keeps a bearing from being perfect: waviness, balls of unequal size, pits. All of it depends on time alone, so it
 * is worked out once per step, as shifts of every ball's groove centres and indentation, with their rates. */
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "bearing.h"

static const double two_pi = 6.28318530717958647692;

bool bd_bearing_perfect(const bd_bearing *bearing)
{
    return bearing->data.n_waves == 0 && bearing->data.n_pits == 0 && !bearing->data.oversize;
}

/* A race's wave at every ball: scale * cos(order (psi_j - turned) + phase) and its rate. */
static void add_race_wave(const bd_bearing *bearing, int w, double scale, double angle, double rate,
                          double *shift, double *shift_rate)
{
    const bd_wave *wave = &bearing->data.waves[w];
    const double n = (double)wave->order;
    const double argument = n * angle + wave->phase;
    const double c = scale * wave->amplitude * cos(argument),
                 s = scale * wave->amplitude * sin(argument);
    const double *spacing_cos = bearing->wave_cos + (size_t)w * (size_t)bearing->balls;
    const double *spacing_sin = bearing->wave_sin + (size_t)w * (size_t)bearing->balls;

    for (int j = 0; j < bearing->balls; j++) {
        shift[j] += c * spacing_cos[j] - s * spacing_sin[j];
        shift_rate[j] -= n * rate * (s * spacing_cos[j] + c * spacing_sin[j]);
    }
}

/* Drop into a pit at arc s from its centre, and its slope in s. */
static double drop(const bd_pit *pit, double diameter, double s, double *slope)
{
    const double radius = 0.5 * diameter, reach = 0.5 * pit->width - fabs(s);
    *slope = 0.0;
    if (!(reach > 0.0))
        return 0.0;
    if (reach >= radius)
        return fmin(pit->depth, radius);
    const double root = sqrt(radius * radius - reach * reach);
    const double depth = reach * reach / (radius + root); /* radius - root without cancellation */
    if (depth >= pit->depth)
        return pit->depth;
    *slope = (s > 0.0 ? -1.0 : 1.0) * reach / root;
    return depth;
}

/* One pit met at arc radius * (angle between ball and pit). */
static void add_pit(const bd_bearing *bearing, const bd_pit *pit, double radius, double angle,
                    double rate, double *shift, double *shift_rate)
{
    double slope;
    const double s = radius * remainder(angle, two_pi);
    *shift -= drop(pit, bearing->data.ball_diameter, s, &slope);
    *shift_rate -= slope * radius * rate;
}

bd_bodies bd_bearing_bodies(const bd_bearing_data *data, double psi, double turned)
{
    return (bd_bodies){psi, data->inner_ratio * turned, data->outer_ratio * turned,
                       data->spin_ratio * turned};
}

void bd_bearing_imperfect(const bd_bearing *bearing, bd_bearing_work *work, const bd_bodies *angle,
                          const bd_bodies *speed)
{
    const bd_bearing_data *data = &bearing->data;
    const double psi = angle->cage, inner = angle->inner, outer = angle->outer;
    const double spin = angle->spin, spin_rate = speed->spin;
    /* the first ball's azimuth on each race, and how fast the race runs past it */
    const double on_inner = psi - inner, inner_rate = speed->cage - speed->inner;
    const double on_outer = psi - outer, outer_rate = speed->cage - speed->outer;
    double **cleared[] = {&work->shift_X,      &work->shift_Y,      &work->shift,
                          &work->shift_X_rate, &work->shift_Y_rate, &work->shift_rate};

    for (size_t i = 0; i < sizeof cleared / sizeof cleared[0]; i++)
        memset(*cleared[i], 0, (size_t)bearing->balls * sizeof **cleared[i]);

    for (int w = 0; w < data->n_waves; w++) {
        const bd_wave *wave = &data->waves[w];
        switch (wave->kind) {
        case BD_WAVE_INNER_RADIAL:
            add_race_wave(bearing, w, 1.0, on_inner, inner_rate, work->shift_Y, work->shift_Y_rate);
            break;
        case BD_WAVE_INNER_AXIAL:
            add_race_wave(bearing, w, 1.0, on_inner, inner_rate, work->shift_X, work->shift_X_rate);
            break;
        case BD_WAVE_OUTER_RADIAL:
            add_race_wave(bearing, w, -1.0, on_outer, outer_rate, work->shift_Y,
                          work->shift_Y_rate);
            break;
        case BD_WAVE_OUTER_AXIAL:
            add_race_wave(bearing, w, -1.0, on_outer, outer_rate, work->shift_X,
                          work->shift_X_rate);
            break;
        case BD_WAVE_BALL:
            if (wave->order % 2 == 0) { /* the same on both sides; odd orders keep the diameter */
                const double n = (double)wave->order, argument = n * spin + wave->phase;
                work->shift[wave->ball] += 2.0 * wave->amplitude * cos(argument);
                work->shift_rate[wave->ball] -=
                    2.0 * wave->amplitude * n * spin_rate * sin(argument);
            }
            break;
        }
    }

    for (int p = 0; p < data->n_pits; p++) {
        const bd_pit *pit = &data->pits[p];
        const double ball_radius = 0.5 * data->ball_diameter;
        if (pit->kind ==
            BD_PIT_BALL) { /* meets one race at its angle, the other half a spin later */
            double *shift = &work->shift[pit->ball], *rate = &work->shift_rate[pit->ball];
            add_pit(bearing, pit, ball_radius, spin - pit->angle, spin_rate, shift, rate);
            add_pit(bearing, pit, ball_radius, spin - pit->angle + 0.5 * two_pi, spin_rate, shift,
                    rate);
            continue;
        }
        const bool of_inner = pit->kind == BD_PIT_INNER;
        const double radius = of_inner ? data->inner_radius : data->outer_radius;
        const double turned = of_inner ? inner : outer;
        const double rate = of_inner ? inner_rate : outer_rate;
        for (int j = 0; j < data->n_balls; j++) {
            const double psi_j = psi + two_pi * (double)j / (double)data->n_balls;
            add_pit(bearing, pit, radius, psi_j - turned - pit->angle, rate, &work->shift[j],
                    &work->shift_rate[j]);
        }
    }

    if (data->oversize)
        for (int j = 0; j < data->n_balls; j++)
            work->shift[j] += data->oversize[j];
}
