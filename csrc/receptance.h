/* receptance.h - inside the core: receptances of one block at several frequencies at once (receptance.c). */
#ifndef BD_RECEPTANCE_H
#define BD_RECEPTANCE_H

#include <stdbool.h>

#include "kernels.h"

/* Coordinates are in the order of the pivots. */
typedef struct bd_receptance {
    int n, n_layers;
    int n_beside, n_left,
        first_right; /* columns; P^T is the first n_left, Q all from first_right on */
    bool symmetric;  /* whether D is, at every frequency */
    const double
        *pencil; /* (n x n x (3 + n_layers)) of each entry: K, M, C, and 2 L L^T by layer */
    const double *beside; /* (n x n_beside) */
} bd_receptance;

#ifdef BD_ISA
/* Given:    omega (lanes), moduli (n_layers x 2 x lanes: storage, loss) of as many frequencies as a register has doubles
 * Returned: response (n_left x (n_beside - first_right) x 2 x lanes: real, imaginary); growth (lanes): sum of squares of what was taken
 *           from the diagonal over what it was formed from; NaN where a pivot vanished */
void BD_NAMED(bd_receptance_solve)(const bd_receptance *block, const double *omega,
                                   const double *moduli, double *memory, double *response,
                                   double *growth);
#endif

#endif
