/* loads.h - inside the core: the loads at one time. */
#ifndef BD_LOADS_H
#define BD_LOADS_H

#include "work.h"

/* What the cosine and sine column of each load are multiplied with at time t and work->turn, into
 * work->load_factor. */
void bd_load_factors(const bd_model *model, bd_work *work, double t);

/* The value of a table at a time, linear between, its ends held. */
double bd_load_sampled(const bd_load *load, double t);

#endif
