#include "grazing.h"

#include <math.h>

#include "damping_table.h"

/* What `place` says; FREE where the force does not jump. */
enum { FREE, OPEN, EDGE, CLOSED };

/* `pull` of a ball on the edge, in units of the force that moves it by one length in this step: each correction
 * brings it nearer to the edge by this factor. */
static const double hold_firmness = 30.0;

double bd_edge_damping(const bd_contact *contact)
{
    double slope;
    switch (contact->law) {
    case BD_DAMPING_CONSTANT:
        return contact->c;
    case BD_DAMPING_TABLE:
        return bd_table_damping(contact, -contact->h0, &slope);
    case BD_DAMPING_LOAD:
    case BD_DAMPING_FILM:
    case BD_DAMPING_CARRIED:
        break;
    }
    return 0.0;
}

static int place_of(const bd_bearing_work *work, int ball)
{
    return (int)work->place[ball];
}

void bd_held_contacts(const bd_contact *contact, int n_balls, bd_bearing_work *work)
{
    const double c = bd_edge_damping(contact);
    for (int j = 0; j < n_balls; j++) {
        const double s = work->delta[j] + contact->h0;
        const int place = place_of(work, j);
        if (place == EDGE) {
            work->force[j] = work->inside[j] + work->pull[j] * s;
            work->stiffness[j] = work->pull[j];
            work->damping[j] = 0.0;
        } else if ((place == OPEN && s > 0.0) || (place == CLOSED && !(s > 0.0))) {
            const double force = place == CLOSED ? c * work->rate[j] : 0.0;
            work->force[j] = fmax(force, 0.0);
            work->stiffness[j] = 0.0;
            work->damping[j] = force > 0.0 ? c : 0.0;
        }
    }
}

void bd_hold(const bd_bearing *bearing, bd_bearing_work *work, const double *W, size_t stride,
             double in_x)
{
    const size_t n = (size_t)bearing->data.n_coefs;
    work->holds = bd_edge_damping(&bearing->data.contact) > 0.0;
    if (!work->holds)
        return;
    for (int j = 0; j < bearing->data.n_balls; j++) {
        const double *normal = work->normal + (size_t)j * (size_t)bearing->coefs;
        double mobility = 0.0;
        for (size_t l = 0; l < n; l++)
            for (size_t k = 0; k < n; k++)
                mobility += normal[k] * W[l * stride + k] * normal[l];
        const double pull = hold_firmness / (in_x * mobility);
        const bool held = pull > 0.0 && isfinite(pull);
        work->pull[j] = pull;
        work->inside[j] = 0.0;
        work->place[j] = !held                                             ? FREE
                         : work->delta[j] + bearing->data.contact.h0 > 0.0 ? CLOSED
                                                                           : OPEN;
    }
}

/* A condition broken by more than a force `least` moves a ball to the neighbour; without a jump, past the edge. */
static int next_place(int place, double s, double force, double jump, double pull, double least)
{
    if (place == OPEN && pull * s > least)
        return jump > 0.0 ? EDGE : CLOSED;
    if (place == CLOSED && pull * s < -least)
        return jump > 0.0 ? EDGE : OPEN;
    if (place == EDGE && force < -least)
        return OPEN;
    if (place == EDGE && force > jump + least)
        return CLOSED;
    return place;
}

int bd_regrip(const bd_bearing *bearing, bd_bearing_work *work, double least, bool all)
{
    const bd_contact *contact = &bearing->data.contact;
    const double c = bd_edge_damping(contact);
    int moved = 0;
    for (int j = 0; work->holds && j < bearing->data.n_balls && (all || moved == 0); j++) {
        const double s = work->delta[j] + contact->h0, jump = fmax(c * work->rate[j], 0.0);
        const int place = place_of(work, j);
        const int next = next_place(place, s, work->force[j], jump, work->pull[j], least);
        if (next != place) {
            work->place[j] = next;
            work->inside[j] = fmin(work->force[j], jump);
            moved++;
        }
    }
    return moved;
}

double bd_edge_slip(const bd_bearing *bearing, const bd_bearing_work *work)
{
    double slip = 0.0;
    for (int j = 0; work->holds && j < bearing->data.n_balls; j++)
        if (place_of(work, j) == EDGE)
            slip = fmax(slip, fabs(work->force[j] - work->inside[j]));
    return slip;
}

void bd_follow_edges(const bd_bearing *bearing, bd_bearing_work *work)
{
    for (int j = 0; work->holds && j < bearing->data.n_balls; j++)
        if (place_of(work, j) == EDGE)
            work->inside[j] = work->force[j];
}

double bd_largest_pull(const bd_bearing *bearing, const bd_bearing_work *work)
{
    double largest = 0.0;
    for (int j = 0; work->holds && j < bearing->data.n_balls; j++)
        if (place_of(work, j) == EDGE)
            largest = fmax(largest, work->pull[j]);
    return largest;
}
