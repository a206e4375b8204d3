/* work.h - inside the core: scratch of one thread for one time step size. */
#ifndef BD_WORK_H
#define BD_WORK_H

#include <stdbool.h>

#include "model.h"
#include "profile.h"

typedef struct bd_kernels bd_kernels;

/* Safe on NULL. */
void bd_exact_free(bd_exact *exact);

struct bd_work {
    bd_scheme scheme;  /* its speed is the profile's */
    double in_x, in_v; /* beta dt^2, gamma dt: what an acceleration adds to x and to v */
    bd_profile profile;
    const bd_kernels *kernels;
    double *drift;    /* while the speed varies, per block, columns [S^-1 G | S^-1 N] */
    bd_turn turn;     /* at the end of the step */
    double reference; /* speed that S is factored at */
    double *memory;   /* everything below lies in it */

    /* operators of the prepared step */
    double *step;    /* per block, columns [-S^-1 K' | -S^-1 C' | -S^-1 L] with K' = K + speed N and
                       * C' = C + C_ve + speed G; where M and K' are diagonal, the first column is
                       * -K'/(M + beta dt^2 K') and the rest of the first n go unused */
    bool *diagonal;  /* (n_blocks) whether they are */
    size_t *step_at; /* (n_blocks) where a block's columns start, and their end */
    double *SB;      /* S^-1 B^T: a column per padded coefficient */
    double *SP;      /* S^-1 p: two columns per load (cosine, sine) */
    double *W;       /* B S^-1 B^T: a column per padded coefficient */
    double *
        W_rate; /* of an exact step, where W is of z alone and both hold what in_x and in_v are for */
    bd_exact *exact;            /* or NULL */
    bd_branch_weights *weights; /* (branches) layer by layer */
    bd_echo_weights *echoes;    /* (n_echoes) bearing by bearing */

    /* vectors of a step, padded */
    double *x, *v, *a;       /* predictor; a without the bearings, then with */
    double *x_new, *v_new;   /* without the bearings */
    double *history, *trial; /* (ranks), (n_stress) */
    double *y_rate;          /* (ranks) at the new time */
    double *y_before;        /* (ranks) at the old time, where layers soften */
    double *forget;          /* (n_layers) share of a running amplitude that a step replaces */
    double *z_linear, *z_rate_linear, *z, *z_rate, *Wg; /* (coefs) */
    double *force, *guess, *change;                     /* (coefs) */
    double *K, *C, *J, *inverse;                        /* (coefs x coefs) */
    double *load_factor;                                /* (2 n_loads) */
    double *loss; /* (n_padded) scratch of the audit and of the start */
    double *a_steady,
        *a_drift; /* (n_padded) a at the reference speed; what the departure from it adds */
    bd_bearing_work *bearings;
};

/* Takes the weights of every echo for the step of work's scheme. */
void bd_echoes_prepare(const bd_model *model, bd_work *work);

/* Takes over a scheme, copies its speed and chooses its kernels; BD_BAD_VALUE where it is not valid, or not on this
 * machine. */
bd_status bd_work_choose(bd_work *work, const bd_scheme *scheme);

#endif
