/* ehl.h - inside the core: a row of EHL contacts (ehl.c). */
#ifndef BD_EHL_H
#define BD_EHL_H

#include "elastic_force.h"
#include "kernels.h"

/* What the carried law needs besides: as in bd_bearing_work. */
typedef struct bd_carried {
    const double *carried;
    double *pressed;
    double fresh;
} bd_carried;

void BD_NAMED(bd_ehl_contacts)(const bd_contact *contact, const double *restrict film, int n,
                               const double *restrict delta, const double *restrict rate,
                               const bd_carried *oil, double *restrict force,
                               double *restrict stiffness, double *restrict damping);

#endif
