/* harmonic.h - inside the core: scratch of a harmonic response (harmonic_work.c), and its complex numbers. */
#ifndef BD_HARMONIC_H
#define BD_HARMONIC_H

#include <complex.h>
#include <stdbool.h>

#include "join.h"
#include "model.h"
#include "receptance.h"

typedef double complex complex_t;

/* CMPLX, which older C libraries lack under Clang. */
static inline complex_t complex_of(double re, double im)
{
    union {
        double part[2];
        complex_t value;
    } pair = {{re, im}};
    return pair.value;
}

/* A product without C's search for infinities, which costs more than the product. */
static inline complex_t product(complex_t a, complex_t b)
{
    return complex_of(creal(a) * creal(b) - cimag(a) * cimag(b),
                      creal(a) * cimag(b) + cimag(a) * creal(b));
}

struct bd_harmonic_work {
    const bd_kernels *kernels;
    double *HL;          /* per layer its block's n x n matrix 2 L L^T */
    size_t *HL_at;       /* (n_layers) */
    double *force, *row; /* (n_in x n), (n_out x n) in block order, without padding */
    double *B;           /* (n x n_coefs) in block order */
    double *Kb, *Cb;     /* (n_coefs x n_coefs) as given */
    complex_t *D, *X;    /* one block's matrix; (n x (n_in + n_coefs)) solutions, column-major */
    double *S;           /* (n_coefs) springs that hold every block in its bearings */
    double *held;        /* B^T S B of each block, n x n, where its matrices lie */
    /* joints: a coefficient and a block that it sees, block by block */
    int n_joints, *joint; /* (n_blocks x n_coefs) or -1 */
    int *coef;            /* (n_joints) */
    bd_joints joints;     /* of one lane */
    double *y, *x;        /* per lane, rows of motions at joints and of outputs, as in join.h */
    double *join_memory;
    complex_t *Z; /* (n_coefs^2) */
    int *pivots;
    int *touching,
        *n_touching; /* per block: which forces (0 ... n_in) and coefficients (n_in ...) act */
    bool *read;      /* (n_blocks x n_out) whether a row reads a block's motion */
    int *
        told; /* (n_out) the coefficient that a row is, which the joints tell without reading, or -1 */
    int *twin;    /* (n_out) the force that a row is equal to, or -1; no force twice */
    bool *paired; /* (n_in) whether a force is the twin of a row */

    /* for receptances in lanes */
    bd_receptance *reduced; /* (n_blocks); n is 0 where a block is too large for it */
    int *
        beside; /* per block: what its columns are: outputs, n_out + coefficients, and forces behind them.
                 * Where D is symmetric an output stands for its twin too */
    double *pencil, *columns;
    double *omega, *moduli; /* (lanes), (n_layers x 2 x lanes) of one block's layers */
    double *memory, *response, *growth;
};

#endif
