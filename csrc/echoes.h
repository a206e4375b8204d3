/* echoes.h - inside the core: what films that are carried through a contact remember of its approach (echoes.c). */
#ifndef BD_ECHOES_H
#define BD_ECHOES_H

#include "work.h"

/* Before a start: films answer as if the rates had always been so; and after its forces: the state has them so. */
void bd_echoes_forget(const bd_model *model, bd_work *work);
void bd_echoes_begin(const bd_model *model, const bd_work *work, bd_state *state);

/* Of a step: the film that the new rates add to, from a state that is only read; and, once the step has converged, the
 * state after it. */
void bd_echoes_trial(const bd_model *model, bd_work *work, const bd_state *state);
void bd_echoes_commit(const bd_model *model, const bd_work *work, bd_state *state);

#endif
