/* profile.h - inside the core: how the shaft turns, at any time. */
#ifndef BD_PROFILE_H
#define BD_PROFILE_H

#include "bearingdyn.h"

/* A speed with its integral; zeroed, it holds nothing. */
typedef struct bd_profile {
    bd_speed speed;      /* its arrays are the profile's own */
    const double *angle; /* (n) shaft angle at each time, 0 at t = 0 */
    double *memory;      /* all three arrays */
} bd_profile;

/* Copies the knots of a speed and integrates them; what the profile held before is freed.
 * Returned: BD_OK; else the profile is as it was */
bd_status bd_profile_take(bd_profile *profile, const bd_speed *speed);

void bd_profile_free(bd_profile *profile);

/* Speed and shaft angle (0 at t = 0) at time t, and the mean rate from t - before to t + after. A step feels the mean of
 * the half steps around its node: the trapezoid sum of the rate is then the speed's own change, wherever knots lie. */
bd_turn bd_turn_at(const bd_profile *profile, double t, double before, double after);

/* The speed alone, which needs no integral. */
double bd_speed_at(const bd_speed *speed, double t);

#endif
