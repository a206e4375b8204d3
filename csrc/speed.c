/* How the shaft turns: a speed linear between knots, its rate, and its integral. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "work.h"

/* Copies the knots of the speed and integrates them. Returned: whether they are usable. */
bool bd_take_speed(bd_work *work, const bd_speed *speed)
{
    const size_t n = (size_t)speed->n;
    double *profile = malloc(3 * n * sizeof *profile);
    if (!profile)
        return false;
    double *time = profile, *value = profile + n, *angle = profile + 2 * n;
    bool usable = true;
    for (size_t k = 0; k < n; k++) {
        time[k] = speed->time[k];
        value[k] = speed->value[k];
        angle[k] = k == 0
                       ? value[0] * time[0]
                       : angle[k - 1] + 0.5 * (value[k - 1] + value[k]) * (time[k] - time[k - 1]);
        usable =
            usable && isfinite(time[k]) && isfinite(value[k]) && (k == 0 || time[k] > time[k - 1]);
    }
    free(work->profile);
    work->profile = profile;
    work->scheme.speed.time = time;
    work->scheme.speed.value = value;
    return usable;
}

/* Speed and its rate at time t, and the knot at or before it (0 before the first). */
static int interpolate(const bd_speed *speed, double t, double *value, double *rate)
{
    int low = 0, high = speed->n - 1;
    *rate = 0.0;
    if (t <= speed->time[0] || t >= speed->time[high]) {
        low = t <= speed->time[0] ? 0 : high;
        *value = speed->value[low];
        return low;
    }
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (speed->time[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    *rate = (speed->value[high] - speed->value[low]) / (speed->time[high] - speed->time[low]);
    *value = speed->value[low] + *rate * (t - speed->time[low]);
    return low;
}

bd_turn bd_turn_at(const bd_work *work, double t)
{
    const bd_speed *speed = &work->scheme.speed;
    bd_turn turn;
    const int low = interpolate(speed, t, &turn.speed, &turn.rate);
    const double since = t - speed->time[low];
    turn.angle =
        work->profile[2 * speed->n + low] + (speed->value[low] + 0.5 * turn.rate * since) * since;
    return turn;
}

double bd_reference_speed(const bd_model *model, const bd_scheme *scheme, double *flat, bool anew)
{
    double *clock = bd_state_view(model, flat).clock, rate;
    if (!bd_scheme_valid(scheme))
        return NAN;
    /* the end of the next step, to the bit as bd_march will have it */
    const double t = clock[2] == scheme->dt ? clock[0] + (clock[1] + 1.0) * scheme->dt
                                            : clock[0] + clock[1] * clock[2] + scheme->dt;
    if (anew || clock[5] == 0.0 || scheme->speed.n == 1)
        interpolate(&scheme->speed, t, &clock[4], &rate);
    clock[5] = 1.0;
    return clock[4];
}
