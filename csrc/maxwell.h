/* maxwell.h - inside the core: the history of a branch as trial and commit, inlined into its users. */
#ifndef BD_MAXWELL_H
#define BD_MAXWELL_H

#include "lanes.h"

/* What the branch would carry without the new rate; the committed stress is only read.
 * Given:    n values (a multiple of BD_LANES) of committed stress and of the rate at the old time
 * Returned: trial (n); its sum is added to history (n) */
BD_INLINE void maxwell_trial(int n, bd_branch_weights w, const double *restrict stress,
                             const double *restrict rate_old, double *restrict trial,
                             double *restrict history)
{
    for (int i = 0; i < n; i += BD_WIDTH) {
        lanes value = w.decay * LANES(stress + i) + w.old * LANES(rate_old + i);
        LANES_AT(trial + i) = value;
        LANES_AT(history + i) += value;
    }
}

/* Once per converged step: stress = trial + now * rate_new. */
BD_INLINE void maxwell_commit(int n, bd_branch_weights w, const double *restrict trial,
                              const double *restrict rate_new, double *restrict stress)
{
    for (int i = 0; i < n; i += BD_WIDTH)
        LANES_AT(stress + i) = LANES(trial + i) + w.now * LANES(rate_new + i);
}

#endif
