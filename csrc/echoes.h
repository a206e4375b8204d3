/* echoes.h - inside the core: what films that are carried through a contact remember of its approach (echoes.c). */
#ifndef BD_ECHOES_H
#define BD_ECHOES_H

#include "work.h"

/* Of a start, at z in work and the balls where they are. Films that know no motion: the state's echoes are those of balls
 * that have always turned past it. Then what is carried at this moment, whatever the rates now are; and, once the forces
 * are known, what is pressed. */
void bd_echoes_settle(const bd_model *model, bd_work *work, bd_state *state);
void bd_echoes_recall(const bd_model *model, bd_work *work, const bd_state *state);
void bd_echoes_press(const bd_model *model, const bd_work *work, bd_state *state);

/* Of a step: the film that the new rates add to, from a state that is only read; and, once the step has converged, the
 * state after it. */
void bd_echoes_trial(const bd_model *model, bd_work *work, const bd_state *state);
void bd_echoes_commit(const bd_model *model, const bd_work *work, bd_state *state);

#endif
