/* Weights of one echo of what is pressed for one step. */
#include <complex.h>

#include "bearingdyn.h"

typedef double complex number;

static number from_parts(const double *parts)
{
    return parts[0] + parts[1] * I;
}

static void to_parts(number value, double *parts)
{
    parts[0] = creal(value);
    parts[1] = cimag(value);
}

/* Below this size of z the closed forms lose digits, so series are summed, whose last term is then below 1e-17. */
static const double series_limit = 0.5;
enum { SERIES_TERMS = 14 };

bd_echo_weights bd_echo_step(const bd_echo *echo, double dt)
{
    const number z = -dt * from_parts(echo->decay);
    number mean, late; /* integrals of exp(z (1 - t)) and t exp(z (1 - t)) over 0 ... 1 */
    if (cabs(z) < series_limit) {
        number term = 1.0; /* z^k / (k+1)! */
        mean = late = 0.0;
        for (int k = 0; k < SERIES_TERMS; k++) {
            mean += term;
            late += term / (double)(k + 2);
            term *= z / (double)(k + 2);
        }
    } else {
        mean = (cexp(z) - 1.0) / z;
        late = (mean - 1.0) / z;
    }
    bd_echo_weights weights;
    to_parts(cexp(z), weights.decay);
    to_parts(dt * (mean - late), weights.old);
    to_parts(dt * late, weights.now);
    return weights;
}
