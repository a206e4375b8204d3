#include "profile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The knot at or before t; 0 before the first. */
static int knot_before(const bd_speed *speed, double t)
{
    int low = 0, high = speed->n - 1;
    if (t <= speed->time[0] || t >= speed->time[high])
        return t <= speed->time[0] ? 0 : high;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (speed->time[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Slope behind a knot for a time that lies behind it: 0 before the first knot and behind the last. */
static double slope_behind(const bd_speed *speed, int low, double t)
{
    if (t <= speed->time[0] || low == speed->n - 1)
        return 0.0;
    return (speed->value[low + 1] - speed->value[low]) / (speed->time[low + 1] - speed->time[low]);
}

double bd_speed_at(const bd_speed *speed, double t)
{
    const int low = knot_before(speed, t);
    const double slope = slope_behind(speed, low, t);
    return slope == 0.0 ? speed->value[low] : speed->value[low] + slope * (t - speed->time[low]);
}

static double angle_at(const bd_profile *profile, double t)
{
    const bd_speed *speed = &profile->speed;
    const int low = knot_before(speed, t);
    const double since = t - speed->time[low];
    return profile->angle[low] +
           (speed->value[low] + 0.5 * slope_behind(speed, low, t) * since) * since;
}

/* Mean rate from one time to a later one; the slope itself, to the bit, where no knot lies between. */
static double mean_rate(const bd_speed *speed, double from, double to)
{
    const int low = knot_before(speed, from), last = speed->n - 1;
    if (to <= speed->time[0] || from >= speed->time[last])
        return 0.0;
    if (from >= speed->time[0] && to <= speed->time[low + 1])
        return slope_behind(speed, low, to);
    return (bd_speed_at(speed, to) - bd_speed_at(speed, from)) / (to - from);
}

bd_status bd_profile_take(bd_profile *profile, const bd_speed *speed)
{
    const size_t n = (size_t)speed->n;
    for (size_t k = 0; k < n; k++)
        if (!isfinite(speed->time[k]) || !isfinite(speed->value[k]) ||
            (k > 0 && !(speed->time[k] > speed->time[k - 1])))
            return BD_BAD_VALUE;
    double *memory = malloc(3 * n * sizeof *memory);
    if (!memory)
        return BD_NO_MEMORY;

    double *time = memory, *value = memory + n, *angle = memory + 2 * n;
    memcpy(time, speed->time, n * sizeof *time);
    memcpy(value, speed->value, n * sizeof *value);
    angle[0] = value[0] * time[0];
    for (size_t k = 1; k < n; k++)
        angle[k] = angle[k - 1] + 0.5 * (value[k - 1] + value[k]) * (time[k] - time[k - 1]);
    bd_profile_free(profile);
    *profile = (bd_profile){
        .speed = {.n = speed->n, .time = time, .value = value}, .angle = angle, .memory = memory};
    if (time[0] < 0.0) { /* the shaft stands at 0 at t = 0, whatever it did before */
        const double turned = angle_at(profile, 0.0);
        for (size_t k = 0; k < n; k++)
            angle[k] -= turned;
    }
    return isfinite(angle[n - 1]) ? BD_OK
                                  : BD_BAD_VALUE; /* finite knots turn it beyond all numbers */
}

void bd_profile_free(bd_profile *profile)
{
    free(profile->memory);
    *profile = (bd_profile){0};
}

bd_turn bd_turn_at(const bd_profile *profile, double t, double before, double after)
{
    return (bd_turn){
        .speed = bd_speed_at(&profile->speed, t),
        .rate = mean_rate(&profile->speed, t - before, t + after),
        .angle = angle_at(profile, t),
    };
}
