/* energy.h - inside the core: where the energy of a state is, and which power changes it. */
#ifndef BD_ENERGY_H
#define BD_ENERGY_H

#include "work.h"

/* Power that the contacts of a bearing, and the branches of a layer, turn into heat: at the state of the last
 * evaluation, and at a state. */
double bd_contact_loss(const bd_bearing_data *data, const bd_bearing_work *balls);
double bd_branch_loss(const bd_layer *layer, const bd_state *state);

/* Stored energies and powers at the state, whose load factors and bearing quantities stand in work. */
void bd_energy_rates(const bd_model *model, bd_work *work, const bd_state *state,
                     bd_energy *energy);

/* Adds a step's work by the trapezoidal rule from the powers at both ends. */
void bd_energy_step(const bd_model *model, bd_work *work, const bd_state *state);

#endif
