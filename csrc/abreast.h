/* abreast.h - inside the core: marches side by side, their linear part as one (abreast.c; its kernels in
 * abreast_step.c). */
#ifndef BD_ABREAST_H
#define BD_ABREAST_H

#include "kernels.h"
#include "work.h"

/* A bearing in every case: its geometry and contacts, and what becomes of its balls. */
typedef struct bd_abreast_bearing {
    double x0[BD_ABREAST], y0[BD_ABREAST], A[BD_ABREAST], e0[BD_ABREAST];
    double h0[BD_ABREAST], kappa[BD_ABREAST], c[BD_ABREAST];
    bool by_load; /* whether damping goes with the stiffness */
    double *shift_X, *shift_Y, *shift, *shift_X_rate, *shift_Y_rate, *shift_rate; /* (balls) */
    double *force, *sine_a, *peak;                                                /* (balls) */
} bd_abreast_bearing;

/* Arrays hold a number of every case side by side: entry i of case l at [BD_ABREAST i + l]. The places of cases that
 * are not there, or have ended, are zero. */
struct bd_abreast {
    const bd_model *model; /* of the first case, as far as all have it in common */
    const bd_work *work;   /* its operators */
    double *memory;        /* everything below lies in it */

    double *x, *v, *a;       /* (n_padded) of the states */
    double *y_rate, *stress; /* (ranks), (n_stress) */
    double *g[3];            /* (coefs) bearing forces of the last step, and of the two before it */

    double *x_ahead, *v_ahead, *a_new; /* (n_padded) predictor; a without the bearings, then with */
    double *x_new, *v_new;             /* (n_padded) without the bearings, then with */
    double *history, *rate_new;        /* (ranks) */
    double *trial;                     /* (n_stress) */
    double *z, *z_rate;                /* (coefs) without the bearings */
    double *guess, *minus_g;           /* (coefs) bearing forces as far as found; negative */
    double *z_new, *z_rate_new;        /* (coefs) with those forces */
    double *force, *change;            /* (coefs) that they give, and what is missing */
    double *W, *inverse;               /* (coefs x coefs) */
    bd_abreast_bearing *bearings;
    const bd_work *basis; /* of the case by which all balls that iterate together are turned */
    double *SP, *factor;  /* (2 n_loads x n_padded), (2 n_loads) */
    double *B,
        *SB; /* (coefs x n_padded) of coefficients that are not alike in all cases: the arm of a tilt
                       follows from the clearance */
    bool *own;    /* (coefs) which they are */
    bool *swings; /* (n_loads) whether any case has two columns of a load */
};

/* A state into its lane, and out of it. */
void bd_abreast_take(const bd_abreast *abreast, const bd_state *state, int lane);
void bd_abreast_give(const bd_abreast *abreast, const bd_state *state, int lane);

/* Zeroes a lane: what is not finite there, or grows without its bearings, would slow the others down. */
void bd_abreast_empty(const bd_abreast *abreast, int lane);

#ifdef BD_ISA
void BD_NAMED(bd_abreast_predict)(bd_abreast *abreast);
unsigned BD_NAMED(bd_abreast_complete)(bd_abreast *abreast);
void BD_NAMED(bd_abreast_commit)(bd_abreast *abreast);
unsigned BD_NAMED(bd_abreast_find)(bd_abreast *abreast, unsigned cases, int patience,
                                   const double *tolerance, double *residual, int *iterations);
void BD_NAMED(bd_abreast_keep_peaks)(bd_abreast *abreast);
#endif

#endif
