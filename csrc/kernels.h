/* kernels.h - inside the core: the hot loops, once per instruction set.
 *
 * ehl.c, balls.c, step.c, abreast_step.c, abreast_bearings.c, exact.c, receptance.c, join.c and changed_layers.c are compiled with BD_ISA (a name) and BD_WIDTH (doubles per register); their
 * functions carry the name as a suffix, and each set ends in one table of pointers. Nothing else of
 * the core depends on the instruction set. */
#ifndef BD_KERNELS_H
#define BD_KERNELS_H

#include "bearingdyn.h"

#define BD_JOIN_(a, b) a##_##b
#define BD_JOIN(a, b) BD_JOIN_(a, b)
#ifdef BD_ISA
#define BD_NAMED(name) BD_JOIN(name, BD_ISA)
#endif

typedef struct bd_receptance bd_receptance;
typedef struct bd_joints bd_joints;
typedef struct bd_changed_layers bd_changed_layers;

typedef struct bd_kernels {
    int width; /* doubles per register */
    /* balls.c: basis functions at the first ball's azimuth psi (rad) */
    void (*turn)(const bd_bearing *bearing, bd_bearing_work *work, double psi);
    /* balls.c: forces at coefficients z, z_rate (padded): g = sum F v; ball quantities stay in work */
    void (*force)(const bd_bearing *bearing, bd_bearing_work *work, const double *z,
                  const double *z_rate, double cage_speed, double *g);
    /* balls.c: the largest force of each ball, after those of a step are known */
    void (*keep_peaks)(const bd_bearing *bearing, bd_bearing_work *work);
    /* balls.c: K = dg/dz and C = dg/dz_rate at the last force, n_coefs rows of (padded) stride */
    void (*tangent)(const bd_bearing *bearing, const bd_bearing_work *work, double cage_speed,
                    int stride, double *K, double *C);
    /* step.c: predictors, trial branch stresses, and the acceleration without the bearings */
    void (*predict)(const bd_model *model, bd_work *work, const bd_state *state);
    /* step.c: bearing coefficients and rates that the structure would have without the bearings */
    void (*observe)(const bd_model *model, bd_work *work);
    /* step.c: what the departure from the reference speed adds to the acceleration, given the bearing forces
     * guessed; a = a_steady + a_drift afterwards. Returned: its largest change, and its size */
    double (*drift)(const bd_model *model, bd_work *work, double *largest);
    /* step.c: z and z_rate that go with the bearing forces guessed */
    void (*displace)(const bd_model *model, bd_work *work);
    /* step.c: guess += share * inverse (force - guess) */
    void (*correct)(const bd_model *model, bd_work *work, double share, const double *inverse);
    /* step.c: completes the acceleration and makes the trial state the state.
     * Returned: 0, or nonzero where it would not be finite; the state is then as it was */
    int (*commit)(const bd_model *model, bd_work *work, bd_state *state);
    /* receptance.c: what rows and columns of a block see of each other at `width` frequencies */
    void (*receptance)(const bd_receptance *block, const double *omega, const double *moduli,
                       double *memory, double *response, double *growth);
    /* join.c: the response of all blocks from those of each. Returned: 0, or nonzero where that loses too much */
    int (*join)(const bd_joints *joints);
    /* changed_layers.c: motions of layers whose moduli have changed, and their derivatives. Returned: 0, or nonzero where
     * they are infinite */
    int (*changed_layers)(const bd_changed_layers *layers, const double *receptance, size_t stride,
                          const double *alone, const double *change, const double *slope,
                          double *memory, int *order, double *y, double *moved);
    /* exact.c: as predict and observe, as commit, and what bearing forces are to the modes, of an exact step */
    void (*exact_predict)(const bd_model *model, bd_work *work, const bd_state *state);
    int (*exact_commit)(const bd_model *model, bd_work *work, bd_state *state);
    void (*exact_shares)(const bd_exact *exact, const double *g, double *shares);
    /* abreast_step.c: predict and observe of marches side by side; then, as the halves of commit, what becomes of them
     * (returned: a bit for each case that would not be finite), and that as the states */
    void (*abreast_predict)(bd_abreast *abreast);
    unsigned (*abreast_complete)(bd_abreast *abreast);
    void (*abreast_commit)(bd_abreast *abreast);
    /* abreast_bearings.c: forces of cases (bits) by the inverse that each has, in up to patience + 1 evaluations.
     * Returned: bits of those that were found; of them the residual and the evaluations */
    unsigned (*abreast_find)(bd_abreast *abreast, unsigned cases, int patience,
                             const double *tolerance, double *residual, int *iterations);
    void (*abreast_keep_peaks)(bd_abreast *abreast);
} bd_kernels;

/* The kernels of an instruction set, or NULL where this build or machine lacks it. */
const bd_kernels *bd_kernels_for(bd_isa isa);

#endif
