/* softening.h - inside the core: layers that soften with their own strain.
 *
 * A layer whose rubber softens carries, beside its Maxwell branches, three stresses more: that of a spring E, that of a
 * branch of modulus 2 L and rate Omega, and that of a slow branch which adds at Omega what the Maxwell branches lack (and
 * forgets a lasting load). They follow the running strain amplitude
 *
 *     d' = y' - d / memory,   a'' filtered twice from sum strain d^2,  b'' from sum strain y'^2,
 *     A = sqrt(2 a''),   Omega = sqrt(b'' / a'')
 *
 * slowly: they are held while S is, and renewed, with S, when they have moved. A spring that weakens loses the stress of
 * what broke, one that heals does so without stress: both cost energy, and none is made. */
#ifndef BD_SOFTENING_H
#define BD_SOFTENING_H

#include <stdbool.h>

#include "work.h"

/* Whether E, L or Omega has moved so far from what S was factored with that both are to be renewed. */
bool bd_softening_moved(const bd_model *model, const bd_state *state);

/* The running amplitudes after a step: y_before (ranks) are the layers' rates at its beginning. */
void bd_softening_step(const bd_model *model, const bd_work *work, const bd_state *state);

/* Energy of spring and branch, and power that the branch turns into heat. */
double bd_softening_stored(const bd_layer *layer, const bd_state *state);
double bd_softening_loss(const bd_layer *layer, const bd_state *state);

/* Running strain amplitude of a layer; 0 where it does not soften. */
double bd_softening_strain(const bd_layer *layer, const bd_state *state);

#endif
