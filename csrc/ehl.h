/* ehl.h - inside the core: a row of EHL contacts (ehl.c). */
#ifndef BD_EHL_H
#define BD_EHL_H

#include "elastic_force.h"
#include "kernels.h"

void BD_NAMED(bd_ehl_contacts)(const bd_contact *contact, const double *restrict film, int n,
                               const double *restrict delta, const double *restrict rate,
                               double *restrict force, double *restrict stiffness,
                               double *restrict damping);

#endif
