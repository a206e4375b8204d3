/* echoes.h - inside the core: what films that are carried through a contact remember of its approach (echoes.c). */
#ifndef BD_ECHOES_H
#define BD_ECHOES_H

#include "bearingdyn.h"

/* Weights of one echo for one step, complex: q(n+1) = decay q(n) + old p(n) + now p(n+1), p = b ddelta/dt. */
typedef struct bd_echo_weights {
    double decay[2], old[2], now[2];
} bd_echo_weights;

/* Given:    dt > 0; an echo whose decay has a positive real part
 * Returned: the weights, exact for p linear in the step, to 2e-14 of the larger for any decay dt */
bd_echo_weights bd_echo_step(const bd_echo *echo, double dt);

/* Doubles that a state keeps of one bearing: p, then of each echo the real and imaginary parts of q, ball by ball. */
size_t bd_echoes_size(const bd_bearing_data *data);

/* Takes the weights of every echo for the step of work's scheme. */
void bd_echoes_prepare(const bd_model *model, bd_work *work);

/* Before a start: films answer as if the rates had always been so; and after its forces: the state has them so. */
void bd_echoes_forget(const bd_model *model, bd_work *work);
void bd_echoes_begin(const bd_model *model, const bd_work *work, bd_state *state);

/* Of a step: the film that the new rates add to, from a state that is only read; and, once the step has converged, the
 * state after it. */
void bd_echoes_trial(const bd_model *model, bd_work *work, const bd_state *state);
void bd_echoes_commit(const bd_model *model, const bd_work *work, bd_state *state);

#endif
