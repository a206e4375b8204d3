/* state.h - inside the core: the clock of a state, which lies in it as doubles. */
#ifndef BD_STATE_H
#define BD_STATE_H

#include <stdbool.h>

#include "model.h"

/* Whether a march can go on from a clock: its numbers finite, its count of steps a whole one. */
bool bd_clock_valid(const bd_clock *clock);

/* The time a number of steps after the clock's own. */
double bd_clock_time(const bd_clock *clock, long long ahead);

/* Starts a new count, of steps of size dt, at the clock's own time. */
void bd_clock_restart(bd_clock *clock, double dt);

/* Writes the clock of a view back to the array that the view is of. */
void bd_clock_keep(const bd_state *state);

#endif
