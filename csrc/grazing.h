/* grazing.h - inside the core: balls whose film opens or closes within a step.
 *
 * With c > 0 at the edge of the film, s = delta + h0 = 0, the law jumps there from 0 to c * rate. A step that has to
 * end inside the jump has one force that balances, F in [0, c rate] at s = 0: the law in its set-valued sense. A ball is
 * held on one of three places, and moves from one to a neighbour while its own condition is broken:
 *     open    F = 0,           s <= 0
 *     edge    s = 0,           0 <= F <= c rate
 *     closed  F by the law,    s >= 0
 * On the edge F = inside + pull s, and `inside` follows F until s is zero (method of multipliers). */
#ifndef BD_GRAZING_H
#define BD_GRAZING_H

#include <stdbool.h>

#include "bearing.h"

/* c at the edge of the film; 0 where the law vanishes there and nothing jumps. */
double bd_edge_damping(const bd_contact *contact);

/* Overwrites force, stiffness and damping of the balls whose indentation does not fit their place. */
void bd_held_contacts(const bd_contact *contact, int n_balls, bd_bearing_work *work);

/* Holds every ball of a bearing where it is. `normal` must be filled (bd_bearing_tangent).
 * W (columns of `stride`) acceleration of the coefficients by their forces; in_x displacement by an acceleration */
void bd_hold(const bd_bearing *bearing, bd_bearing_work *work, const double *W, size_t stride,
             double in_x);

/* Moves balls whose condition is broken by more than a force `least`: all of them, or the first only.
 * Returned: how many were moved */
int bd_regrip(const bd_bearing *bearing, bd_bearing_work *work, double least, bool all);

/* The largest force by which a ball on the edge is still off s = 0; and `inside` follows the force. */
double bd_edge_slip(const bd_bearing *bearing, const bd_bearing_work *work);
void bd_follow_edges(const bd_bearing *bearing, bd_bearing_work *work);

/* The largest `pull` of balls on the edge; 0 without any. */
double bd_largest_pull(const bd_bearing *bearing, const bd_bearing_work *work);

#endif
