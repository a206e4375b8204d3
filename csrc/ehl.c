#include "ehl.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "bearing.h"
#include "damping_table.h"
#include "lanes.h"

/* ---------------------------------------------------------------- what the laws share */

/* Elastic part of one register of contacts. */
typedef struct elastic {
    lane_mask touching; /* s > 0, s = delta + h0 */
    lanes root;         /* u of film and solids, 0 out of contact */
    lanes force;        /* kappa u^3 */
    lanes firm;         /* its slope by delta */
    lanes soft;         /* what the ring's give leaves of that slope; 1 where nothing gives */
} elastic;

BD_INLINE void squeeze(const bd_contact *contact, bool gives, const lanes *approach, elastic *found)
{
    const double kappa = contact->kappa, cubic = gives ? contact->give * kappa : 0.0;
    lanes s, root;
    found->touching = LANES_POSITIVE(*approach);
    s = LANES_WHERE(found->touching, *approach);
    lanes_sqrt(&s, &root);
    found->soft = (lanes){0} + 1.0;
    if (gives) {
        for (int k = 0; k < BD_GIVE_STEPS; k++)
            root -= (root * root * (1.0 + cubic * root) - s) /
                    (root * (2.0 + 3.0 * cubic * root) + DBL_MIN);
        found->soft = 1.0 / (1.0 + (1.5 * cubic) * root);
        s = root * root;
    }
    found->root = root;
    found->force = kappa * (root * s);
    found->firm = 1.5 * kappa * root;
    if (gives)
        found->firm *= found->soft;
}

/* Total force of one register with damping c and its slope by delta; a film cannot pull. */
BD_INLINE void press(const elastic *spring, const lanes *c, const lanes *slope, const double *rate,
                     double *force, double *stiffness, double *damping)
{
    lanes r = LANES(rate), total = spring->force + *c * r;
    lane_mask loaded = LANES_POSITIVE(total);
    LANES_AT(force) = LANES_WHERE(loaded, total);
    LANES_AT(stiffness) = LANES_WHERE(loaded, spring->firm + *slope * r);
    LANES_AT(damping) = LANES_WHERE(loaded, *c);
}

/* ---------------------------------------------------------------- the film's laws */

/* Registers at most between finding places and using cubics: their chains of root and division then overlap, which are
 * longer than a processor looks ahead. */
enum { AHEAD = 8 };
/* Binary digits of a double, of them those of a cell, and those of a cell's powers. */
enum { DIGITS = 52, CELL_DIGITS = 6, POWER_DIGITS = 2 };
/* Just below 1, so that no w reaches the end of the last cell. */
static const double below_end = 1.0 - 0x1p-50;

/* Digits of doubles as they stand. */
typedef unsigned long long lane_digits
    __attribute__((vector_size(8 * BD_WIDTH), aligned(8), may_alias));

/* Whether a bit is set in any lane. */
BD_INLINE bool any(const lane_digits *value)
{
    unsigned long long all = 0;
    for (int i = 0; i < BD_WIDTH; i++)
        all |= (*value)[i];
    return all != 0;
}

/* Takes the cubics of balls that have come into another cell; `now` is the start of each one's cell, in 1 + w. */
static __attribute__((noinline)) void keep_cubics(const double *film, const lane_digits *now,
                                                  int first, int stride, double *restrict cell,
                                                  double *restrict cubic)
{
    const unsigned long long inside = (BD_FILM_CELLS - 1) << POWER_DIGITS;
    const lane_digits was = *(const lane_digits *)(cell + first);
    for (int i = 0; i < BD_WIDTH; i++) {
        if (was[i] == (*now)[i])
            continue;
        /* masked so that what is no number reads inside the table */
        const double *own = film + ((*now)[i] >> (DIGITS - CELL_DIGITS - POWER_DIGITS) & inside);
        for (int k = 0; k < BD_FILM_POWERS; k++)
            cubic[k * stride + first + i] = own[k];
    }
    *(lane_digits *)(cell + first) = *now;
}

/* Force of one register under s, where the film is thicker by what the oil carries and by what is pressed now: F =
 * kappa u^3, u^2 + give kappa u^3 = s + carried + fresh b rate; and its slopes. */
BD_INLINE void press_carried(const bd_contact *contact, bool gives, const bd_oil *oil, int at,
                             const lanes *approach, const lanes *b, const lanes *slope,
                             const double *rate, double *force, double *stiffness, double *damping)
{
    const lanes r = LANES(rate), pressed = *b * r;
    const lanes s = *approach + LANES(oil->carried + at) + oil->fresh * pressed;
    elastic spring;
    squeeze(contact, gives, &s, &spring);
    LANES_AT(oil->pressed + at) = pressed;
    LANES_AT(force) = spring.force;
    LANES_AT(stiffness) = spring.firm * (1.0 + oil->fresh * (*slope * r));
    LANES_AT(damping) = spring.firm * (oil->fresh * *b);
}

/* The film law, or the carried law; which of them the compiler knows. A ball stays in a cell for many evaluations, so that
 * its cubic is kept: a look-up in each would wait for its own address, as long as all else here takes. */
BD_INLINE void film_contacts(const bd_contact *contact, bool gives, bool carries, int n,
                             const double *restrict delta, const double *restrict rate,
                             const bd_oil *oil, double *restrict force, double *restrict stiffness,
                             double *restrict damping)
{
    const bool settled = gives && !carries; /* w is of what the ring's give leaves */
    const double half = sqrt(contact->c);
    const int stride = oil->stride;
    const double *film = oil->film;
    double *const cells = oil->cell, *const cubics = oil->cubic;
    const bd_contact own = *contact;
    for (int from = 0, until; from < n; from = until) {
        /* registers cross no line of the cache: stores are read again at once */
        _Alignas(64) elastic springs[AHEAD];
        _Alignas(64) lanes s_of[AHEAD], u_of[AHEAD], by_s_of[AHEAD];
        _Alignas(64) lane_digits cell_of[AHEAD];
        lane_digits moved = {0};
        until = from + AHEAD * BD_WIDTH < n ? from + AHEAD * BD_WIDTH : n;
        for (int first = from, i = 0; first < until; first += BD_WIDTH, i++) {
            s_of[i] = LANES(delta + first) + own.h0;
            squeeze(&own, settled, &s_of[i], &springs[i]);
            const lanes root = springs[i].root, sum = root + half;
            /* 1 + w, whose leading digits are the cell */
            const lanes place = (below_end * root) / sum + 1.0;
            cell_of[i] = (lane_digits)place & -(1ULL << (DIGITS - CELL_DIGITS));
            u_of[i] = place - (lanes)cell_of[i];
            moved |= cell_of[i] ^ *(const lane_digits *)(cells + first);
            /* dw/ds, 0 where nothing touches, as c is */
            by_s_of[i] = LANES_WHERE(springs[i].touching, (0.5 * half) / (root * (sum * sum)));
            if (settled)
                by_s_of[i] *= springs[i].soft;
        }
        if (any(&moved))
            for (int first = from, i = 0; first < until; first += BD_WIDTH, i++)
                keep_cubics(film, &cell_of[i], first, stride, cells, cubics);
        for (int first = from, i = 0; first < until; first += BD_WIDTH, i++) {
            const double *cubic = cubics + first;
            const lanes k1 = LANES(cubic + stride), k2 = LANES(cubic + 2 * stride);
            const lanes u = u_of[i], last = u * LANES(cubic + 3 * stride), both = k2 + last;
            const lanes c = (LANES(cubic) + u * k1) + (u * u) * both;
            const lanes slope = (k1 + u * (both + both + last)) * by_s_of[i];
            if (carries)
                press_carried(&own, gives, oil, first, &s_of[i], &c, &slope, rate + first,
                              force + first, stiffness + first, damping + first);
            else
                press(&springs[i], &c, &slope, rate + first, force + first, stiffness + first,
                      damping + first);
        }
    }
}

/* ---------------------------------------------------------------- all laws */

/* As bd_ehl_contacts, of a law that the compiler knows: a loop without a branch. */
BD_INLINE void contacts(const bd_contact *contact, bd_damping_law law, bool gives, int n,
                        const double *restrict delta, const double *restrict rate,
                        const bd_oil *oil, double *restrict force, double *restrict stiffness,
                        double *restrict damping)
{
    if (law == BD_DAMPING_FILM) {
        film_contacts(contact, gives, false, n, delta, rate, oil, force, stiffness, damping);
        return;
    }
    if (law == BD_DAMPING_CARRIED) {
        film_contacts(contact, gives, true, n, delta, rate, oil, force, stiffness, damping);
        return;
    }
    for (int first = 0; first < n; first += BD_WIDTH) {
        elastic spring;
        lanes c = {0}, slope = {0}, s = LANES(delta + first) + contact->h0;
        squeeze(contact, gives, &s, &spring);
        if (law == BD_DAMPING_CONSTANT)
            c = c + contact->c;
        if (law == BD_DAMPING_LOAD) {
            lanes soft = spring.soft;
            c = contact->c * spring.firm;
            slope = (contact->c * 0.75 * contact->kappa) * (soft * soft * soft) / spring.root;
        }
        if (law == BD_DAMPING_TABLE)
            for (int j = 0; j < BD_WIDTH; j++) {
                double slope_j;
                c[j] = bd_table_damping(contact, delta[first + j], &slope_j);
                slope[j] = slope_j;
            }
        c = LANES_WHERE(spring.touching, c);
        press(&spring, &c, &slope, rate + first, force + first, stiffness + first, damping + first);
    }
}

/* Given:    n contacts (whole lanes): indentation delta and its rate; the film's laws need the oil
 * Returned: force     F = max(0, kappa u^3 + c(delta) rate), 0 where delta + h0 <= 0, with the root u of film and
 *                     solids, u^2 + give kappa u^3 = delta + h0
 *           stiffness dF/ddelta at fixed rate, damping dF/drate; all zero where F is clipped
 *           of the carried law see bd_echo; what the oil keeps is written to
 * Notes:    a film cannot pull, hence the clip. Where c > 0 at the film's edge F jumps there; newton.c finds the force
 *           inside the jump (grazing.h)
 * Reference: paper eq (1). */
void BD_NAMED(bd_ehl_contacts)(const bd_contact *contact, int n, const double *restrict delta,
                               const double *restrict rate, const bd_oil *oil,
                               double *restrict force, double *restrict stiffness,
                               double *restrict damping)
{
#define LAW(law)                                                                                   \
    case law:                                                                                      \
        if (contact->give * contact->kappa != 0.0)                                                 \
            contacts(contact, law, true, n, delta, rate, oil, force, stiffness, damping);          \
        else                                                                                       \
            contacts(contact, law, false, n, delta, rate, oil, force, stiffness, damping);         \
        break;
    switch (contact->law) {
        LAW(BD_DAMPING_CONSTANT)
        LAW(BD_DAMPING_LOAD)
        LAW(BD_DAMPING_FILM)
        LAW(BD_DAMPING_CARRIED)
        LAW(BD_DAMPING_TABLE)
    }
#undef LAW
}
