/* The bearings of marches abreast, a case per lane: newton.c's iteration with the inverse that each case has, by the sums
 * of balls.c and ehl.c in their order. What that does not settle is left to newton.c. */
#include <float.h>
#include <limits.h>

#include "abreast.h"
#include "lanes.h"

enum { SETS = BD_ABREAST / BD_WIDTH };

#define WIDE(p, i) ((p) + (size_t)BD_ABREAST * (size_t)(i))
#define SET(p, i, s) (WIDE(p, i) + (s) * BD_WIDTH)

/* value where the mask is set, else other */
#define CHOOSE(mask, value, other)                                                                 \
    ((lanes)(((lane_mask)(value) & (mask)) | ((lane_mask)(other) & ~(mask))))

/* One register of a matrix of each case times a vector: row r of `M`, whose columns are bearings' coefficients, summed
 * bearing by bearing as columns_add does. */
BD_INLINE void own_product(const bd_model *model, const double *M, const double *u, int r, int s,
                           lanes *sum)
{
    const int m = model->coefs;
    for (int b = 0; b < model->n_bearings; b++) {
        const int at = model->bearing_slot[b], n = model->bearings[b].data.n_coefs;
        lanes even = {0}, odd = {0};
        int c = 0;
        for (; c + 1 < n; c += 2) {
            even += LANES(SET(M, (at + c) * m + r, s)) * LANES(SET(u, at + c, s));
            odd += LANES(SET(M, (at + c + 1) * m + r, s)) * LANES(SET(u, at + c + 1, s));
        }
        if (c < n)
            even += LANES(SET(M, (at + c) * m + r, s)) * LANES(SET(u, at + c, s));
        *sum += even + odd;
    }
}

/* z and z_rate of the cases that still iterate. */
BD_INLINE void displace(bd_abreast *of, const lane_mask *active)
{
    const bd_model *model = of->model;
    const double in_x = of->work->in_x, in_v = of->work->in_v;
    for (int b = 0; b < model->n_bearings; b++)
        for (int k = 0; k < model->bearings[b].data.n_coefs; k++) {
            const int r = model->bearing_slot[b] + k;
            for (int s = 0; s < SETS; s++) {
                lanes Wg = {0};
                own_product(model, of->W, of->guess, r, s, &Wg);
                lanes z = LANES(SET(of->z, r, s)) - in_x * Wg;
                lanes rate = LANES(SET(of->z_rate, r, s)) - in_v * Wg;
                LANES_AT(SET(of->z_new, r, s)) = CHOOSE(active[s], z, LANES(SET(of->z_new, r, s)));
                LANES_AT(SET(of->z_rate_new, r, s)) =
                    CHOOSE(active[s], rate, LANES(SET(of->z_rate_new, r, s)));
            }
        }
}

/* Forces of one bearing at z_new. The balls of all cases stand alike; a contact's damping is constant or goes with its
 * stiffness. */
BD_INLINE void press(const bd_abreast *of, int b)
{
    const bd_bearing *bearing = &of->model->bearings[b];
    const bd_bearing_work *basis = &of->basis->bearings[b];
    const bd_abreast_bearing *own = &of->bearings[b];
    const int at = of->model->bearing_slot[b], balls = bearing->balls;
    const int n = bearing->data.n_coefs, n_radial = bearing->data.n_radial;
    const double cage_speed = bearing->data.cage_ratio * of->basis->turn.speed;

    for (int s = 0; s < SETS; s++) {
        const double *z = SET(of->z_new, at, s), *z_rate = SET(of->z_rate_new, at, s);
        double *g = SET(of->force, at, s);
        const lanes x0 = LANES(own->x0 + s * BD_WIDTH), y0 = LANES(own->y0 + s * BD_WIDTH);
        const lanes A = LANES(own->A + s * BD_WIDTH), e0 = LANES(own->e0 + s * BD_WIDTH);
        const lanes h0 = LANES(own->h0 + s * BD_WIDTH), kappa = LANES(own->kappa + s * BD_WIDTH);
        const lanes damping = LANES(own->c + s * BD_WIDTH);

        for (int k = 0; k < n; k++)
            LANES_AT(WIDE(g, k)) = (lanes){0};
        for (int j = 0; j < bearing->data.n_balls; j++) {
            const double *phi = basis->phi + j, *dphi = basis->dphi + j;
            lanes dX = LANES(SET(own->shift_X, j, s)), dY = LANES(SET(own->shift_Y, j, s));
            lanes X_rate = {0}, Y_rate = {0}, turn_X = {0}, turn_Y = {0};
            int k = 0;
            for (; k < n_radial; k++) {
                const lanes each = LANES(WIDE(z, k));
                dY += phi[k * balls] * each;
                turn_Y += dphi[k * balls] * each;
                Y_rate += phi[k * balls] * LANES(WIDE(z_rate, k));
            }
            for (; k < n; k++) {
                const lanes each = LANES(WIDE(z, k));
                dX += phi[k * balls] * each;
                turn_X += dphi[k * balls] * each;
                X_rate += phi[k * balls] * LANES(WIDE(z_rate, k));
            }
            turn_X = turn_X * cage_speed + LANES(SET(own->shift_X_rate, j, s));
            turn_Y = turn_Y * cage_speed + LANES(SET(own->shift_Y_rate, j, s));
            X_rate += turn_X;
            Y_rate += turn_Y;

            lanes X = x0 + dX, Y = y0 + dY, square = X * X + Y * Y, length, root;
            lanes_sqrt(&square, &length);
            lanes tilt = 1.0 / (length + DBL_MIN), sine_a = X * tilt, cosine_a = Y * tilt;
            lanes stretch = dX * (2.0 * x0 + dX) + dY * (2.0 * y0 + dY) + e0;
            lanes delta = stretch / (length + A) + (LANES(SET(own->shift, j, s)) + 0.0);
            lanes rate = sine_a * X_rate + cosine_a * Y_rate + LANES(SET(own->shift_rate, j, s));

            lanes in = delta + h0;
            const lane_mask touching = LANES_POSITIVE(in);
            in = LANES_WHERE(touching, in);
            lanes_sqrt(&in, &root);
            lanes c = damping;
            if (own->by_load)
                c = damping * (1.5 * kappa * root);
            c = LANES_WHERE(touching, c);
            lanes total = kappa * (root * in) + c * rate;
            lanes force = LANES_WHERE(LANES_POSITIVE(total), total);

            LANES_AT(SET(own->force, j, s)) = force;
            LANES_AT(SET(own->sine_a, j, s)) = sine_a;
            const lanes radial = force * cosine_a, axial = force * sine_a;
            for (k = 0; k < n_radial; k++)
                LANES_AT(WIDE(g, k)) += phi[k * balls] * radial;
            for (; k < n; k++)
                LANES_AT(WIDE(g, k)) += phi[k * balls] * axial;
        }
    }
}

/* |value| */
BD_INLINE void size_of(const lanes *value, lanes *size)
{
    const lane_mask sign = (lane_mask){0} | LLONG_MIN;
    *size = (lanes)((lane_mask)*value & ~sign);
}

/* Largest |force - guess| and |force|; what is not a number makes the first NaN. */
BD_INLINE void measure(const bd_abreast *of, double *residual, double *scale)
{
    const bd_model *model = of->model;
    for (int s = 0; s < SETS; s++) {
        lanes most = {0}, largest = {0}, poison = {0};
        for (int b = 0; b < model->n_bearings; b++)
            for (int k = 0; k < model->bearings[b].data.n_coefs; k++) {
                const int r = model->bearing_slot[b] + k;
                const lanes force = LANES(SET(of->force, r, s));
                const lanes difference = force - LANES(SET(of->guess, r, s));
                lanes off, size;
                size_of(&difference, &off);
                size_of(&force, &size);
                most = CHOOSE(LANES_POSITIVE(off - most), off, most);
                largest = CHOOSE(LANES_POSITIVE(size - largest), size, largest);
                poison += 0.0 * LANES(SET(of->z_new, r, s)) + 0.0 * off;
            }
        LANES_AT(residual + s * BD_WIDTH) = most + poison;
        LANES_AT(scale + s * BD_WIDTH) = largest;
    }
}

/* guess += inverse (force - guess) of the cases that still iterate. */
BD_INLINE void correct(bd_abreast *of, const lane_mask *active)
{
    const bd_model *model = of->model;
    for (int r = 0; r < model->coefs; r++)
        for (int s = 0; s < SETS; s++)
            LANES_AT(SET(of->change, r, s)) =
                LANES(SET(of->force, r, s)) - LANES(SET(of->guess, r, s));
    for (int b = 0; b < model->n_bearings; b++)
        for (int k = 0; k < model->bearings[b].data.n_coefs; k++) {
            const int r = model->bearing_slot[b] + k;
            for (int s = 0; s < SETS; s++) {
                lanes guess = LANES(SET(of->guess, r, s));
                own_product(model, of->inverse, of->change, r, s, &guess);
                LANES_AT(SET(of->guess, r, s)) =
                    CHOOSE(active[s], guess, LANES(SET(of->guess, r, s)));
            }
        }
}

/* Given:    bits of the cases that march and have an inverse
 * Returned: bits of those whose forces were found; their guess, residual and iterations */
unsigned BD_NAMED(bd_abreast_find)(bd_abreast *of, unsigned cases, int patience,
                                   const double *tolerance, double *residual, int *iterations)
{
    double scale[BD_ABREAST];
    unsigned left = cases;
    for (int iteration = 0; iteration <= patience && left; iteration++) {
        lane_mask active[SETS];
        double now[BD_ABREAST];
        unsigned lost = 0, done = 0;
        for (int s = 0; s < SETS; s++)
            for (int i = 0; i < BD_WIDTH; i++)
                active[s][i] = left >> (s * BD_WIDTH + i) & 1 ? -1 : 0;
        displace(of, active);
        for (int b = 0; b < of->model->n_bearings; b++)
            press(of, b);
        measure(of, now, scale);
        for (int l = 0; l < BD_ABREAST; l++)
            if (left >> l & 1) {
                iterations[l] = iteration + 1;
                residual[l] = scale[l] > 0.0 ? now[l] / scale[l] : now[l];
                done |= (unsigned)(now[l] <= tolerance[l] * scale[l]) << l;
                lost |= (unsigned)!(now[l] < DBL_MAX) << l;
            }
        correct(of, active);
        left &= ~done & ~lost;
        cases &= ~lost;
    }
    return cases & ~left;
}

/* The running maximum of every ball's force. */
void BD_NAMED(bd_abreast_keep_peaks)(bd_abreast *of)
{
    for (int b = 0; b < of->model->n_bearings; b++) {
        const bd_abreast_bearing *own = &of->bearings[b];
        const int n = of->model->bearings[b].data.n_balls * BD_ABREAST;
        const double *force = own->force;
        double *peak = own->peak;
        for (int i = 0; i < n; i += BD_WIDTH) {
            lanes more = LANES(force + i) - LANES(peak + i);
            LANES_AT(peak + i) += LANES_WHERE(LANES_POSITIVE(more), more);
        }
    }
}
