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

/* Rows of weights: of q; then by the order 1, 2, 3 of the polynomial that holds the bearing forces, of the new one and
 * of so many before it. */
enum { BD_KEEP, BD_HOLDS = 3, BD_WEIGHTS = 10 };

/* The row of the force `back` steps before the new one. */
static inline int bd_exact_held(int order, int back)
{
    return order * (order + 1) / 2 + back;
}

typedef struct bd_exact_group {
    size_t first;           /* in q */
    int real, pairs, loose; /* padded */
    size_t rows;            /* where its part of `loose` begins */
    size_t held;            /* of each of `held` */
    int n_seen;             /* bearing coefficients that its motion enters */
    const int *seen;        /* (n_seen) their slots */
    size_t P, Z;            /* where its parts of them begin */
    int z_rows;             /* padded rows of its part of Z */
    bool twice;             /* whether that is of z alone, and z_rate the same of the rates of q */
} bd_exact_group;

struct bd_exact {
    int n_groups;
    int hold;  /* largest order of the polynomial */
    int order; /* of this step */
    size_t n;  /* numbers of q */
    bd_exact_group *groups;
    int *seen;
    int n_varying; /* loads that are not constant */
    int *varying;
    double *memory;              /* everything below lies in it */
    double *weights[BD_WEIGHTS]; /* (n) */
    double *roots;               /* (n) of the modes */
    double *loose;               /* per group a column of loose rows for each number of its modes */
    double *held[BD_WEIGHTS];    /* per group a column of loose rows for each coefficient seen */
    double *
        P; /* per group a column of its modes for each coefficient seen: their shares of its force, with its sign */
    double *Z; /* per group a column of the coefficients seen, z and z_rate or z, for each number */
    double *constant;  /* (n) of all constant loads */
    double *load;      /* two columns (n) per load that varies */
    double *X, *V, *A; /* a column (n_padded) per number: x, v and a free of forces */
    double *push; /* a column (n_padded) per coefficient: a from its force; M is the identity */
    double *S;    /* a column (n_stress) per number */
    double *W[BD_HOLDS][2]; /* by order: of z and of z_rate, a column per coefficient */
    double *rows, *rows_g,
        *rows_load;       /* per channel: on q, on the bearing forces, on the loads' factors */
    double *trial, *rate; /* (n) */
    double *shares[BD_HOLDS + 1]; /* (n) of the new forces and of so many before them */
    double *packed, *zz;          /* (coefs), (4 coefs) of one group */
    double *factor;               /* (2 n_loads) */
    bool physical;                /* whether a row of the record needs x, v, a and the stresses */
};

/* From the state's bearing forces, at the start of a march and after each change of its step. */
void bd_exact_recall(const bd_model *model, bd_work *work, const bd_state *state);

/* The step's weights: Newton's operators, and the loads' factors from t to t + dt. */
void bd_exact_choose(const bd_model *model, bd_work *work, bd_state *state, double from);

/* A channel of motion from q; the loads' factors are those of the present time. */
double bd_exact_row(const bd_model *model, const bd_work *work, const bd_state *state, int channel);

/* x, v, a and the stresses of a state. */
void bd_exact_motion(const bd_model *model, const bd_work *work, bd_state *state);

#ifdef BD_ISA
void BD_NAMED(bd_exact_predict)(const bd_model *model, bd_work *work, const bd_state *state);
int BD_NAMED(bd_exact_commit)(const bd_model *model, bd_work *work, bd_state *state);
void BD_NAMED(bd_exact_shares)(const bd_exact *exact, const double *g, double *shares);
#endif

#endif
