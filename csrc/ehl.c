#include "ehl.h"

#include <float.h>
#include <math.h>

#include "damping_table.h"
#include "lanes.h"

/* Given:    n contacts (whole lanes): indentation delta and its rate
 * Returned: force     F = max(0, kappa u^3 + c(delta) rate), 0 where delta + h0 <= 0, with the root u of film and
 *                     solids, u^2 + give kappa u^3 = delta + h0
 *           stiffness dF/ddelta at fixed rate, damping dF/drate; all zero where F is clipped
 * Notes:    a film cannot pull, hence the clip. Where c > 0 at the film's edge F jumps there; newton.c finds the force
 *           inside the jump (grazing.h)
 * Reference: paper eq (1). */
void BD_NAMED(bd_ehl_contacts)(const bd_contact *contact, int n, const double *restrict delta,
                               const double *restrict rate, double *restrict force,
                               double *restrict stiffness, double *restrict damping)
{
    const double kappa = contact->kappa, h0 = contact->h0, give = contact->give;
    const double cubic = give * kappa;

    for (int first = 0; first < n; first += BD_WIDTH) {
        lanes d = LANES(delta + first), r = LANES(rate + first);
        lanes s = d + h0, root, c = {0}, slope = {0}; /* slope: dc/ddelta */

        /* elastic part: root of what film and solids are compressed by, zero out of contact */
        lane_mask touching = LANES_POSITIVE(s);
        s = LANES_WHERE(touching, s);
        lanes_sqrt(&s, &root);
        lanes firm = 1.5 * kappa * root,
              soft = (lanes){0} + 1.0; /* dF_e/ds, and what the give leaves of it */
        if (cubic != 0.0) {
            for (int k = 0; k < BD_GIVE_STEPS; k++)
                root -= (root * root * (1.0 + cubic * root) - s) /
                        (root * (2.0 + 3.0 * cubic * root) + DBL_MIN);
            soft = 1.0 / (1.0 + (1.5 * cubic) * root);
            firm = (1.5 * kappa) * root * soft;
            s = root * root;
        }

        switch (contact->law) {
        case BD_DAMPING_CONSTANT:
            c = LANES_WHERE(touching, c + contact->c);
            break;
        case BD_DAMPING_LOAD:
            c = contact->c * firm;
            slope =
                LANES_WHERE(touching, (contact->c * 0.75 * kappa) * (soft * soft * soft) / root);
            break;
        case BD_DAMPING_FILM: {
            const double *at = contact->table_delta, *rise = contact->table_c;
            const double half = sqrt(contact->c);
            lanes part = 1.0 / (root + half), x = BD_FILM_CELLS * (root * part);
            lanes u = x, c0, c1, r0, r1;
            for (int j = 0; j < BD_WIDTH; j++) {
                const int i = bd_film_cell(x[j]);
                u[j] -= i;
                c0[j] = at[i], c1[j] = at[i + 1];
                r0[j] = rise[i], r1[j] = rise[i + 1];
            }
            /* Hermite's cubic, and its slope by x; dx/ds = cells half part^2 soft / 2 root */
            lanes over = c1 - c0, third = r0 + r1 - 2.0 * over, second = over - r0 - third;
            c = c0 + u * (r0 + u * (second + u * third));
            slope = r0 + u * (2.0 * second + u * (3.0 * third));
            slope = LANES_WHERE(touching,
                                slope * ((0.5 * BD_FILM_CELLS * half) * part * part * soft) / root);
            break;
        }
        case BD_DAMPING_TABLE:
            for (int j = 0; j < BD_WIDTH; j++) {
                double slope_j;
                c[j] = bd_table_damping(contact, d[j], &slope_j);
                slope[j] = slope_j;
            }
            c = LANES_WHERE(touching, c);
            break;
        }

        /* total force; a film cannot pull */
        lanes total = kappa * (root * s) + c * r;
        lane_mask loaded = LANES_POSITIVE(total);
        LANES_AT(force + first) = LANES_WHERE(loaded, total);
        LANES_AT(stiffness + first) = LANES_WHERE(loaded, firm + slope * r);
        LANES_AT(damping + first) = LANES_WHERE(loaded, c);
    }
}
