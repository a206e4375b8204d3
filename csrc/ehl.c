#include "ehl.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>

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

/* Registers at most between looking up and using: their chains of division, look-up and cubic then overlap, which are
 * longer than a processor looks ahead. */
enum { AHEAD = 8 };
/* Binary digits of a double, of them those of a cell, and those of a cell's powers. */
enum { DIGITS = 52, CELL_DIGITS = 6, POWER_DIGITS = 2 };
/* Just below 1, so that no w reaches the end of the last cell. */
static const double below_end = 1.0 - 0x1p-50;

/* Digits of doubles as they stand, without a sign: AVX2 has no instruction that shifts signed ones to the right. */
typedef unsigned long long lane_digits
    __attribute__((vector_size(8 * BD_WIDTH), aligned(8), may_alias));

/* The cubic of each lane's cell, a power a register. Written lane by lane: a loop would go by way of memory. */
BD_INLINE void film_cubics(const double *film, const lane_digits *cell, lanes *k0, lanes *k1,
                           lanes *k2, lanes *k3)
{
#define CUBIC(lane) (film + (*cell)[lane])
#if BD_WIDTH == 4 && (defined(__clang__) || __GNUC__ >= 12)
    /* halves of two cubics side by side, then turned */
    typedef double pair __attribute__((vector_size(16), aligned(8), may_alias));
#define HALVES(a, b, k)                                                                            \
    __builtin_shufflevector(*(const pair *)(CUBIC(a) + (k)), *(const pair *)(CUBIC(b) + (k)), 0,   \
                            1, 2, 3)
    lanes even = HALVES(0, 2, 0), odd = HALVES(1, 3, 0);
    *k0 = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
    *k1 = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
    even = HALVES(0, 2, 2), odd = HALVES(1, 3, 2);
    *k2 = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
    *k3 = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
#undef HALVES
#else
#define PAIR(lane, k) CUBIC(lane)[k], CUBIC((lane) + 1)[k]
#if BD_WIDTH == 2
#define POWER(k) ((lanes){PAIR(0, k)})
#elif BD_WIDTH == 4
#define POWER(k) ((lanes){PAIR(0, k), PAIR(2, k)})
#else
#define POWER(k) ((lanes){PAIR(0, k), PAIR(2, k), PAIR(4, k), PAIR(6, k)})
#endif
    *k0 = POWER(0);
    *k1 = POWER(1);
    *k2 = POWER(2);
    *k3 = POWER(3);
#undef POWER
#undef PAIR
#endif
#undef CUBIC
}

/* Force of one register under s, where the film is thicker by what the oil carries and by what is pressed now: F =
 * kappa u^3, u^2 + give kappa u^3 = s + carried + fresh b rate; and its slopes. */
BD_INLINE void press_carried(const bd_contact *contact, bool gives, const bd_carried *oil, int at,
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

/* The film law, or the carried law; which of them the compiler knows. */
BD_INLINE void film_contacts(const bd_contact *contact, bool gives, bool carries,
                             const double *restrict film, int n, const double *restrict delta,
                             const double *restrict rate, const bd_carried *oil,
                             double *restrict force, double *restrict stiffness,
                             double *restrict damping)
{
    const bool settled = gives && !carries; /* w is of what the ring's give leaves */
    const double half = sqrt(contact->c);
    const int registers = n / BD_WIDTH, groups = (registers + AHEAD - 1) / AHEAD;
    for (int group = 0, from = 0; group < groups; group++) {
        /* of nearly one size: a register left over would have nothing to overlap with */
        const int count = (registers - from / BD_WIDTH) / (groups - group);
        elastic spring[AHEAD];
        lanes s_of[AHEAD], u[AHEAD], by_s[AHEAD];
        lane_digits cell[AHEAD];
        for (int i = 0; i < count; i++) {
            s_of[i] = LANES(delta + from + i * BD_WIDTH) + contact->h0;
            squeeze(contact, settled, &s_of[i], &spring[i]);
            lanes root = spring[i].root, s = root * root;
            /* one division, by root (root + half); 0 where nothing touches, so that w is, where c and its slope are 0 */
            lanes inverse = LANES_WHERE(spring[i].touching, 1.0 / (s + half * root));
            /* 1 + w: its leading digits are the cell, masked so that what is none reads inside the table */
            lanes place = (below_end * s) * inverse + 1.0;
            lane_digits digits = (lane_digits)place;
            cell[i] = digits >> (DIGITS - CELL_DIGITS - POWER_DIGITS) &
                      ((BD_FILM_CELLS - 1) << POWER_DIGITS);
            u[i] = place - (lanes)(digits & -(1ULL << (DIGITS - CELL_DIGITS)));
            by_s[i] = ((0.5 * half) * root) * (inverse * inverse); /* dw/ds */
            if (settled)
                by_s[i] *= spring[i].soft;
        }
        for (int i = 0; i < count; i++) {
            const int first = from + i * BD_WIDTH;
            lanes k0, k1, k2, k3;
            film_cubics(film, &cell[i], &k0, &k1, &k2, &k3);
            lanes last = u[i] * k3, both = k2 + last;
            lanes c = (k0 + u[i] * k1) + (u[i] * u[i]) * both;
            lanes slope = (k1 + u[i] * (both + both + last)) * by_s[i];
            if (carries) {
                press_carried(contact, gives, oil, first, &s_of[i], &c, &slope, rate + first,
                              force + first, stiffness + first, damping + first);
                continue;
            }
            press(&spring[i], &c, &slope, rate + first, force + first, stiffness + first,
                  damping + first);
        }
        from += count * BD_WIDTH;
    }
}

/* ---------------------------------------------------------------- all laws */

/* As bd_ehl_contacts, of a law that the compiler knows: a loop without a branch. */
BD_INLINE void contacts(const bd_contact *contact, bd_damping_law law, bool gives,
                        const double *restrict film, int n, const double *restrict delta,
                        const double *restrict rate, const bd_carried *oil, double *restrict force,
                        double *restrict stiffness, double *restrict damping)
{
    if (law == BD_DAMPING_FILM) {
        film_contacts(contact, gives, false, film, n, delta, rate, oil, force, stiffness, damping);
        return;
    }
    if (law == BD_DAMPING_CARRIED) {
        film_contacts(contact, gives, true, film, n, delta, rate, oil, force, stiffness, damping);
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

/* Given:    n contacts (whole lanes): indentation delta and its rate; `film` as in bd_bearing
 * Returned: force     F = max(0, kappa u^3 + c(delta) rate), 0 where delta + h0 <= 0, with the root u of film and
 *                     solids, u^2 + give kappa u^3 = delta + h0
 *           stiffness dF/ddelta at fixed rate, damping dF/drate; all zero where F is clipped
 *           of the carried law see bd_echo; `oil` is written to
 * Notes:    a film cannot pull, hence the clip. Where c > 0 at the film's edge F jumps there; newton.c finds the force
 *           inside the jump (grazing.h)
 * Reference: paper eq (1). */
void BD_NAMED(bd_ehl_contacts)(const bd_contact *contact, const double *restrict film, int n,
                               const double *restrict delta, const double *restrict rate,
                               const bd_carried *oil, double *restrict force,
                               double *restrict stiffness, double *restrict damping)
{
#define LAW(law)                                                                                   \
    case law:                                                                                      \
        if (contact->give * contact->kappa != 0.0)                                                 \
            contacts(contact, law, true, film, n, delta, rate, oil, force, stiffness, damping);    \
        else                                                                                       \
            contacts(contact, law, false, film, n, delta, rate, oil, force, stiffness, damping);   \
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
