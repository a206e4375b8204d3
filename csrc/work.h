/* work.h - inside the core: scratch of one thread for one time step size. */
#ifndef BD_WORK_H
#define BD_WORK_H

#include <stdbool.h>

#include "model.h"

typedef struct bd_kernels bd_kernels;

struct bd_work {
    bd_scheme scheme; /* the arrays of its speed are copies in `profile` */
    const bd_kernels *kernels;
    double *profile;  /* times, speeds and shaft angles of the speed's knots, one after another */
    double *drift;    /* while the speed varies, per block, columns [S^-1 G | S^-1 N] */
    bd_turn turn;     /* at the end of the step */
    double reference; /* speed that S is factored at */
    double *memory;   /* everything below lies in it */

    /* operators of the prepared step */
    double *step;    /* per block, columns [-S^-1 K' | -S^-1 C' | -S^-1 L] with K' = K + speed N and
                       * C' = C + C_ve + speed G; where M and K' are diagonal, the first column is
                       * -K'/(M + beta dt^2 K') and the rest of the first n go unused */
    bool *diagonal;  /* (n_blocks) whether they are */
    size_t *step_at; /* (n_blocks) where a block's columns start */
    double *SB;      /* S^-1 B^T: a column per padded coefficient */
    double *SP;      /* S^-1 p: two columns per load (cosine, sine) */
    double *W;       /* B S^-1 B^T: a column per padded coefficient */
    bd_branch_weights *weights; /* layer by layer, branch by branch */

    /* vectors of a step, padded */
    double *x, *v, *a;       /* predictor; a without the bearings, then with */
    double *x_new, *v_new;   /* without the bearings */
    double *history, *trial; /* (ranks), (n_stress) */
    double *y_rate;          /* (ranks) at the new time */
    double *z_linear, *z_rate_linear, *z, *z_rate, *Wg; /* (coefs) */
    double *force, *guess, *change;                     /* (coefs) */
    double *K, *C, *J, *inverse;                        /* (coefs x coefs) */
    double *load_factor;                                /* (2 n_loads) */
    double *loss; /* (n_padded) scratch of the audit and of the start */
    double *a_steady,
        *a_drift; /* (n_padded) a at the reference speed; what the departure from it adds */
    bd_bearing_work *bearings;
};

/* Whether the numbers of a scheme can be marched with. */
bool bd_scheme_valid(const bd_scheme *scheme);

/* Takes over a scheme and chooses its kernels. Returned: whether the scheme is valid on this machine. */
bool bd_work_choose(bd_work *work, const bd_scheme *scheme);

/* Copies the knots of a speed and integrates them. Returned: whether they are usable. */
bool bd_take_speed(bd_work *work, const bd_speed *speed);

/* Speed, its rate and the shaft angle at time t. */
bd_turn bd_turn_at(const bd_work *work, double t);

/* What the cosine and sine column of each load are multiplied with at time t, into work->load_factor. */
void bd_load_factors(const bd_model *model, bd_work *work, double t);

/* Forces of all bearings at work's z, z_rate into work->force; where the balls are, at work->turn, first. */
void bd_turn_bearings(const bd_model *model, bd_work *work);
void bd_force_bearings(const bd_model *model, bd_work *work);

/* Power that the contacts of a bearing, and the branches of a layer, turn into heat: at the state of the last
 * evaluation, and at all branch stresses of a state. */
double bd_contact_loss(const bd_bearing_data *data, const bd_bearing_work *balls);
double bd_branch_loss(const bd_layer *layer, const double *stress);

/* Stored energies and powers at the state, whose bearing quantities stand in work. */
void bd_energy_rates(const bd_model *model, bd_work *work, const bd_state *state, double t,
                     bd_energy *energy);

/* Adds a step's work by the trapezoidal rule from the powers at both ends. */
void bd_energy_step(const bd_model *model, bd_work *work, const bd_state *state, double t);

#endif
