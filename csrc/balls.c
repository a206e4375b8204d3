/* The balls of one bearing: from raceway coefficients to indentations, and back to summed forces.
 *
 * A ball per lane where balls are independent, a coefficient per lane where they are summed. */
#include "balls.h"

#include <float.h>
#include <math.h>

#include "bearing.h"
#include "ehl.h"
#include "grazing.h"
#include "lanes.h"

/* Rows of a tangent worked on at once: as many as a rigid ring has. */
enum { TANGENT_ROWS = 5 };

/* A number of balls rounded up to registers of this set; the padding beyond, to the widest set's, stays as it was
 * carved: zero. */
BD_INLINE int whole_lanes(int n)
{
    return (n + BD_WIDTH - 1) / BD_WIDTH * BD_WIDTH;
}

/* Basis functions of every ball. */
void BD_NAMED(bd_bearing_turn)(const bd_bearing *bearing, bd_bearing_work *work, double psi)
{
    const bd_bearing_data *data = &bearing->data;
    const size_t balls = (size_t)bearing->balls, coefs = (size_t)bearing->coefs;
    const double cos_psi = cos(psi), sin_psi = sin(psi);

    for (size_t first = 0; first < balls; first += BD_WIDTH) {
        lanes spacing_cos = LANES(bearing->spacing_cos + first);
        lanes spacing_sin = LANES(bearing->spacing_sin + first);
        lanes c1 = cos_psi * spacing_cos - sin_psi * spacing_sin;
        lanes s1 = sin_psi * spacing_cos + cos_psi * spacing_sin;
        lanes c = {0}, s = {0};
        int order = 0;

        /* by rotation from order to order; a fall (from radial to axial) starts again from order 0 */
        for (size_t k = 0; k < (size_t)data->n_coefs; k++) {
            const int wanted = data->order[k];
            const double n = (double)wanted;
            if (k == 0 || wanted < order) {
                order = 0;
                c = (lanes){0} + 1.0;
                s = (lanes){0};
            }
            for (; order < wanted; order++) {
                lanes next = c * c1 - s * s1;
                s = s * c1 + c * s1;
                c = next;
            }
            LANES_AT(work->phi + k * balls + first) = data->sine[k] ? s : c;
            LANES_AT(work->dphi + k * balls + first) = data->sine[k] ? n * c : -n * s;
        }
    }
    for (size_t k = 0; k < (size_t)data->n_coefs; k++)
        for (size_t j = 0; j < (size_t)data->n_balls; j++) {
            work->phi_ball[j * coefs + k] = work->phi[k * balls + j];
            work->dphi_ball[j * coefs + k] = work->dphi[k * balls + j];
        }
}

/* Indentation of every ball and its rate (delta = Lambda - A, written without cancellation). */
BD_INLINE void indent(const bd_bearing *bearing, bd_bearing_work *work, const double *restrict z,
                      const double *restrict z_rate, double cage_speed)
{
    const bd_bearing_data *data = &bearing->data;
    const size_t balls = (size_t)bearing->balls, n_coefs = (size_t)data->n_coefs;
    const size_t n_radial = (size_t)data->n_radial, filled = (size_t)whole_lanes(data->n_balls);
    const double x0 = data->x0, y0 = data->y0, A = data->A, e0 = data->e0;

    for (size_t first = 0; first < filled; first += BD_WIDTH) {
        /* relative motion of the groove centres: dX, dY, their slopes in psi, and their own rates */
        const double *phi = work->phi + first, *dphi = work->dphi + first;
        lanes dX = LANES(work->shift_X + first), dY = LANES(work->shift_Y + first);
        lanes X_rate = {0}, Y_rate = {0}, turn_X = {0}, turn_Y = {0};
        size_t k = 0;
        for (; k < n_radial; k++, phi += balls, dphi += balls) {
            dY += LANES(phi) * z[k];
            turn_Y += LANES(dphi) * z[k];
            Y_rate += LANES(phi) * z_rate[k];
        }
        for (; k < n_coefs; k++, phi += balls, dphi += balls) {
            dX += LANES(phi) * z[k];
            turn_X += LANES(dphi) * z[k];
            X_rate += LANES(phi) * z_rate[k];
        }
        turn_X = turn_X * cage_speed + LANES(work->shift_X_rate + first);
        turn_Y = turn_Y * cage_speed + LANES(work->shift_Y_rate + first);
        X_rate += turn_X;
        Y_rate += turn_Y;

        lanes X = x0 + dX, Y = y0 + dY, square = X * X + Y * Y, length;
        lanes_sqrt(&square, &length);
        /* DBL_MIN keeps it finite where the groove centres meet and no ball is touched */
        lanes tilt = 1.0 / (length + DBL_MIN), sine_a = X * tilt, cosine_a = Y * tilt;
        lanes stretch = dX * (2.0 * x0 + dX) + dY * (2.0 * y0 + dY) + e0;

        LANES_AT(work->sine_a + first) = sine_a;
        LANES_AT(work->cosine_a + first) = cosine_a;
        LANES_AT(work->tilt + first) = tilt;
        LANES_AT(work->delta + first) =
            stretch / (length + A) + (LANES(work->shift + first) + LANES(bearing->absent + first));
        LANES_AT(work->rate + first) =
            sine_a * X_rate + cosine_a * Y_rate + LANES(work->shift_rate + first);
        LANES_AT(work->turn + first) = (cosine_a * X_rate - sine_a * Y_rate) * tilt;
        LANES_AT(work->turning + first) =
            sine_a * turn_X + cosine_a * turn_Y + LANES(work->shift_rate + first);
    }
}

/* radial for a lane's coefficient below n_radial, else axial: masks of the kinds in one group. */
BD_INLINE void kind_masks(int n_radial, int first, lane_mask *radial)
{
    for (int k = 0; k < BD_WIDTH; k++)
        (*radial)[k] = first + k < n_radial ? -1 : 0;
}

/* Indent, press, and sum over the balls. */
void BD_NAMED(bd_bearing_force)(const bd_bearing *bearing, bd_bearing_work *work, const double *z,
                                const double *z_rate, double cage_speed, double *restrict g)
{
    const bd_bearing_data *data = &bearing->data;
    const int coefs = bearing->coefs;

    indent(bearing, work, z, z_rate, cage_speed);
    const bd_oil oil = {.film = bearing->film,
                        .stride = bearing->balls,
                        .cell = work->cell,
                        .cubic = work->cubic,
                        .carried = work->carried,
                        .pressed = work->pressed,
                        .fresh = work->fresh};
    BD_NAMED(bd_ehl_contacts)(&data->contact, whole_lanes(data->n_balls), work->delta, work->rate,
                              &oil, work->force, work->stiffness, work->damping);
    if (work->holds)
        bd_held_contacts(&data->contact, data->n_balls, work);

    for (int first = 0; first < coefs; first += BD_WIDTH) {
        const double *phi = work->phi_ball + first;
        lanes radial = {0}, axial = {0};
        lane_mask is_radial;
        kind_masks(data->n_radial, first, &is_radial);
        for (int j = 0; j < data->n_balls; j++, phi += coefs) {
            radial += LANES(phi) * (work->force[j] * work->cosine_a[j]);
            axial += LANES(phi) * (work->force[j] * work->sine_a[j]);
        }
        LANES_AT(g + first) = LANES_WHERE(is_radial, radial) + LANES_WHERE(~is_radial, axial);
    }
}

/* The running maximum of every ball's force; its padding lanes have none. */
void BD_NAMED(bd_bearing_keep_peaks)(const bd_bearing *bearing, bd_bearing_work *work)
{
    for (size_t first = 0; first < (size_t)bearing->balls; first += BD_WIDTH) {
        lanes more = LANES(work->force + first) - LANES(work->peak + first);
        LANES_AT(work->peak + first) += LANES_WHERE(LANES_POSITIVE(more), more);
    }
}

/* Rows k0 ... k0 + rows of both tangents, one register of columns wide; inlined with a constant count of rows,
 * whose sums then stay in registers over all balls. */
BD_INLINE void tangent_rows(const bd_bearing *bearing, const bd_bearing_work *work,
                            double cage_speed, lane_mask is_radial, int first, int k0, int rows,
                            int stride, double *restrict K, double *restrict C)
{
    const int coefs = bearing->coefs;
    const double *normal = work->normal, *along = work->along, *slopes = work->dphi_ball;
    lanes K_row[TANGENT_ROWS] = {{0}}, C_row[TANGENT_ROWS] = {{0}};

    for (int j = 0; j < bearing->data.n_balls;
         j++, normal += coefs, along += coefs, slopes += coefs) {
        const double s = work->sine_a[j], c = work->cosine_a[j];
        lanes dphi = cage_speed * LANES(slopes + first), v = LANES(normal + first),
              w = LANES(along + first);

        /* p: d(rate)/dz at fixed z_rate, because the normal turns and the race runs past the ball */
        lanes p = LANES_WHERE(is_radial, c * dphi) + LANES_WHERE(~is_radial, s * dphi);
        p += work->turn[j] * w;

        lanes across = work->stiffness[j] * v + work->damping[j] * p;
        lanes turned = (work->force[j] * work->tilt[j]) * w;
        lanes viscous = work->damping[j] * v;
        for (int i = 0; i < rows; i++) {
            K_row[i] += normal[k0 + i] * across + along[k0 + i] * turned;
            C_row[i] += normal[k0 + i] * viscous;
        }
    }
    for (int i = 0; i < rows; i++) {
        const size_t at = (size_t)(k0 + i) * (size_t)stride + (size_t)first;
        LANES_AT(K + at) = K_row[i];
        LANES_AT(C + at) = C_row[i];
    }
}

/* Tangents of that sum. */
void BD_NAMED(bd_bearing_tangent)(const bd_bearing *bearing, const bd_bearing_work *work,
                                  double cage_speed, int stride, double *restrict K,
                                  double *restrict C)
{
    const int coefs = bearing->coefs, n_coefs = bearing->data.n_coefs;

    for (int first = 0; first < coefs; first += BD_WIDTH) {
        lane_mask is_radial;
        kind_masks(bearing->data.n_radial, first, &is_radial);
        for (int j = 0; j < bearing->data.n_balls; j++) {
            const size_t at = (size_t)j * (size_t)coefs + (size_t)first;
            const double s = work->sine_a[j], c = work->cosine_a[j];
            lanes phi = LANES(work->phi_ball + at);
            LANES_AT(work->normal + at) =
                LANES_WHERE(is_radial, c * phi) + LANES_WHERE(~is_radial, s * phi);
            LANES_AT(work->along + at) =
                LANES_WHERE(is_radial, -s * phi) + LANES_WHERE(~is_radial, c * phi);
        }
    }
    for (int first = 0; first < coefs; first += BD_WIDTH) {
        lane_mask is_radial;
        int k = 0;
        kind_masks(bearing->data.n_radial, first, &is_radial);
        for (; k + TANGENT_ROWS <= n_coefs; k += TANGENT_ROWS)
            tangent_rows(bearing, work, cage_speed, is_radial, first, k, TANGENT_ROWS, stride, K,
                         C);
        for (; k < n_coefs; k++)
            tangent_rows(bearing, work, cage_speed, is_radial, first, k, 1, stride, K, C);
    }
}
