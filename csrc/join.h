/* join.h - inside the core: blocks joined by their bearings, at one frequency (join.c). */
#ifndef BD_JOIN_H
#define BD_JOIN_H

#include "kernels.h"

/* Columns are unit forces: one at each joint, and from `first` on those that are asked for, so that no register holds
 * both. Rows are kept as in rows.h. */
struct bd_joints {
    int n_joints, n_out, n_coefs;
    size_t first, width; /* multiples of BD_LANES */
    const int *coef;     /* (n_joints) which coefficient each is */
    const double *Z;     /* (n_coefs x n_coefs) complex: the bearings */
    const double *S;     /* (n_coefs) springs that hold every block */
    double *y;           /* (n_joints rows) motions at the joints; destroyed */
    double *x;           /* (n_out rows) motions of the outputs; from `first` on, the answer */
    double *memory;      /* (2 n_coefs + n_joints rows) scratch */
};

#ifdef BD_ISA
/* Returned: 0, or nonzero where joining would be singular or cancel too many digits */
int BD_NAMED(bd_join_blocks)(const bd_joints *joints);
#endif

#endif
