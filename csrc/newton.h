/* newton.h - inside the core: the forces of all bearings, at a given place and in a step. */
#ifndef BD_NEWTON_H
#define BD_NEWTON_H

#include "work.h"

/* A frozen Newton matrix that needs more evaluations than this is replaced. */
enum { BD_PATIENCE = 3 };

/* Where the balls are at work->turn. */
void bd_turn_bearings(const bd_model *model, bd_work *work);

/* Forces of all bearings at work's z, z_rate into work->force, the balls turned before. */
void bd_force_bearings(const bd_model *model, bd_work *work);

/* work->guess on the parabola through the last three forces, where Newton starts. */
void bd_guess_bearings(const bd_model *model, bd_work *work, const bd_state *state);

/* Newton's iteration from work->guess to the forces that balance in this step; the inverse it goes by is the
 * state's, and replaced there when it no longer serves. */
bd_status bd_solve_bearings(const bd_model *model, bd_work *work, bd_state *state,
                            bd_report *report);

#endif
