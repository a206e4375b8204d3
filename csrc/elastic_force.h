/* elastic_force.h - inside the core: the elastic part of a contact's force, one at a time. */
#ifndef BD_ELASTIC_FORCE_H
#define BD_ELASTIC_FORCE_H

#include "bearingdyn.h"

#include <math.h>

/* Newton's steps for the root below. It begins at most a few per cent off, and each step squares that. */
enum { BD_GIVE_STEPS = 5 };

/* Root u of what film and solids are compressed by, u^2 + give kappa u^3 = s = delta + h0; 0 out of contact. */
static inline double bd_elastic_root(const bd_contact *contact, double s)
{
    const double cubic = contact->give * contact->kappa;
    double u = sqrt(fmax(s, 0.0));
    for (int k = 0; s > 0.0 && cubic != 0.0 && k < BD_GIVE_STEPS; k++)
        u -= (u * u * (1.0 + cubic * u) - s) / (u * (2.0 + 3.0 * cubic * u));
    return u;
}

/* Elastic part of the force, kappa u^3, and its energy in film, solids and the ring's give. */
static inline double bd_elastic_force(const bd_contact *contact, double s, double *energy)
{
    const double u = bd_elastic_root(contact, s);
    const double force = contact->kappa * u * u * u;
    *energy = (0.4 * u * u + 0.5 * contact->give * force) * force;
    return force;
}

#endif
