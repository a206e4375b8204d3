/* exact.h - inside the core: the exact step of the linear part (exact.c; prepared in exact_prepare.c).
 *
 * Coordinates that the structure couples move in modes of their own. The numbers q of one group are its real modes, the
 * real parts of its pairs, their imaginary parts, and the displacements that nothing holds ("loose"), each section
 * padded to whole lanes. */
#ifndef BD_EXACT_H
#define BD_EXACT_H

#include <stdbool.h>

#include "kernels.h"
#include "work.h"

/* Rows of weights: of q; of the bearing forces at s = -1, 0, 1 on a parabola; at s = 0, 1 on a line. */
enum { BD_KEEP, BD_BEFORE, BD_NOW, BD_NEW, BD_LINE_NOW, BD_LINE_NEW, BD_WEIGHTS };

typedef struct bd_exact_group {
    size_t first;           /* in q */
    int real, pairs, loose; /* padded */
    size_t rows;            /* where its part of `loose` begins */
    size_t held;            /* of each of `held` */
    const bool *touched;    /* (n_bearings) */
    const size_t *seen;     /* (n_bearings) of Z */
} bd_exact_group;

struct bd_exact {
    int n_groups;
    size_t n; /* numbers of q */
    bd_exact_group *groups;
    bool *touched;
    size_t *seen;
    int n_varying; /* loads that are not constant */
    int *varying;
    double *memory;              /* everything below lies in it */
    double *weights[BD_WEIGHTS]; /* (n) */
    double *nothing;             /* (n) zeros */
    double *loose;               /* per group a column of loose rows for each number of its modes */
    double *held[BD_WEIGHTS];    /* per group a column of loose rows for each bearing force */
    double *P; /* a column (n) per padded coefficient: modes' shares of its force, with its sign */
    double *Z; /* per group and bearing a column of its z, then its z_rate, per number */
    double *constant;  /* (n) of all constant loads */
    double *load;      /* two columns (n) per load that varies */
    double *X, *V, *A; /* a column (n_padded) per number: x, v and a free of forces */
    double *push;    /* a column (n_padded) per coefficient: a from its force; M is the identity */
    double *S;       /* a column (n_stress) per number */
    double *W[2][2]; /* on a line, on a parabola: of z and of z_rate, a column per coefficient */
    double *rows, *rows_g,
        *rows_load; /* per channel: on q, on the bearing forces, on the loads' factors */
    double *trial, *new, *now, *before, *zz, *factor; /* (n) four times, (2 coefs), (2 n_loads) */
    bool physical; /* whether a row of the record needs x, v, a and the stresses */
    bool line;     /* whether this step has no force before the present one */
};

/* From the state's bearing forces, at the start of a march and after each change of its step. */
void bd_exact_recall(const bd_model *model, bd_work *work, const bd_state *state);

/* The step's weights: Newton's operators, and the loads' factors from t to t + dt. */
void bd_exact_choose(const bd_model *model, bd_work *work, const bd_state *state, double from);

/* A channel of motion from q; the loads' factors are those of the present time. */
double bd_exact_row(const bd_model *model, const bd_work *work, const bd_state *state, int channel);

/* x, v, a and the stresses of a state. */
void bd_exact_motion(const bd_model *model, const bd_work *work, bd_state *state);

#ifdef BD_ISA
void BD_NAMED(bd_exact_predict)(const bd_model *model, bd_work *work, const bd_state *state);
int BD_NAMED(bd_exact_commit)(const bd_model *model, bd_work *work, bd_state *state);
void BD_NAMED(bd_exact_shares)(const bd_model *model, const bd_exact *exact, const double *g,
                               double *shares);
#endif

#endif
