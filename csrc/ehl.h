/* ehl.h - inside the core: a row of EHL contacts (ehl.c). */
#ifndef BD_EHL_H
#define BD_EHL_H

#include "elastic_force.h"
#include "kernels.h"

/* What the film's laws need besides: as in bd_bearing and bd_bearing_work. */
typedef struct bd_oil {
    const double *film;
    int stride; /* of cubic */
    double *cell, *cubic;
    const double *carried;
    double *pressed;
    double fresh;
} bd_oil;

void BD_NAMED(bd_ehl_contacts)(const bd_contact *contact, int n, const double *restrict delta,
                               const double *restrict rate, const bd_oil *oil,
                               double *restrict force, double *restrict stiffness,
                               double *restrict damping);

#endif
