#include "profile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    return BD_OK;
}

void bd_profile_free(bd_profile *profile)
{
    free(profile->memory);
    *profile = (bd_profile){0};
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

bd_turn bd_turn_at(const bd_profile *profile, double t)
{
    const bd_speed *speed = &profile->speed;
    bd_turn turn;
    const int low = interpolate(speed, t, &turn.speed, &turn.rate);
    const double since = t - speed->time[low];
    turn.angle = profile->angle[low] + (speed->value[low] + 0.5 * turn.rate * since) * since;
    return turn;
}

double bd_speed_at(const bd_speed *speed, double t)
{
    double value, rate;
    interpolate(speed, t, &value, &rate);
    return value;
}
