/* abreast.h - inside the core: marches side by side, their linear part as one (abreast.c; its kernels in
 * abreast_step.c). */
#ifndef BD_ABREAST_H
#define BD_ABREAST_H

#include "kernels.h"
#include "work.h"

/* Arrays hold a number of every case side by side: entry i of case l at [BD_ABREAST i + l]. The places of cases that
 * are not there, or have ended, are zero. */
struct bd_abreast {
    const bd_model *model; /* of the first case, as far as all have it in common */
    const bd_work *work;   /* its operators */
    double *memory;        /* everything below lies in it */

    double *x, *v, *a;       /* (n_padded) of the states */
    double *y_rate, *stress; /* (ranks), (n_stress) */

    double *x_ahead, *v_ahead, *a_new; /* (n_padded) predictor; a without the bearings, then with */
    double *x_new, *v_new;             /* (n_padded) without the bearings, then with */
    double *history, *rate_new;        /* (ranks) */
    double *trial;                     /* (n_stress) */
    double *z, *z_rate;                /* (coefs) without the bearings */
    double *minus_g;                   /* (coefs) bearing forces found, negative */
    double *SP, *factor;               /* (2 n_loads x n_padded), (2 n_loads) */
    double *B,
        *SB; /* (coefs x n_padded) of coefficients that are not alike in all cases: the arm of a tilt
                       follows from the clearance */
    bool *own;    /* (coefs) which they are */
    bool *swings; /* (n_loads) whether any case has two columns of a load */
};

#ifdef BD_ISA
void BD_NAMED(bd_abreast_predict)(bd_abreast *abreast);
unsigned BD_NAMED(bd_abreast_complete)(bd_abreast *abreast);
void BD_NAMED(bd_abreast_commit)(bd_abreast *abreast);
#endif

#endif
