/* bearingdyn.h - the C core: a linear structure, viscoelastic layers and ball bearings in time and frequency.
 *
 * The core knows arrays, balls, branches and time; nothing of materials, meshes, files or units (any
 * consistent set serves; the Python side uses SI).
 *
 *     M a + (C + Omega G) v + (K + Omega N) x + sum_l L_l sum_i s_li + B^T g(B x, B v, t) = f(t)   (1)
 *
 *   M, C, K    symmetric, n x n; G skew (gyroscopic), N skew (circulatory: damping that turns), per rad/s
 *   L_l        factor of a layer's deviatoric matrix, H = L L^T (paper eqs 16, 25); y = L^T x
 *   s_li       stress of Maxwell branch i in the layer's coordinates (paper eqs 8-11)
 *   B          rows: relative (inner minus outer) Fourier coefficients of the raceways
 *   g          force of the balls on those coefficients (paper eqs 1-4)
 *
 * Who owns what: bd_model is immutable after creation and may be shared by threads without a lock.
 * A state is one flat array of doubles that resumes a march bit for bit. bd_work is scratch for one
 * thread and one time step. Nothing here prints, exits, keeps globals, or allocates inside the march.
 *
 * Symbols that collide between fields, settled here:
 *   G       gyroscopic matrix of the system; a branch's shear modulus is `modulus`
 *   kappa   deflection coefficient of the two contacts of a ball in series (paper eq 2)
 *   beta, gamma  Newmark's; the bearing's gamma = D cos(alpha)/dm stays in Python
 *   c       viscous damping of a contact;  C  viscous damping matrix
 *   tau     relaxation time of a branch;   t_c  damping time of a load-tied contact
 *   omega   angular frequency of an excitation; speed  turning speed of the shaft (rad/s)
 */
#ifndef BEARINGDYN_H
#define BEARINGDYN_H

#include <stdbool.h>
#include <stddef.h>

#include "lapack.h"

/* ---------------------------------------------------------------- words */

/* Words shared with Python stand once, in lists like those below: X(enumerator, word). The enumeration is made from the
 * list here, and so is the table that the binding shows to Python (binding/words.c). Codes count from 0. */
#define BD_ENUMERATOR(name, word) name,

/* ---------------------------------------------------------------- status */

/* 0 is success, < 0 fatal, > 0 a stop that is not an error. */
#define BD_STATUS_LIST(X)                                                                          \
    X(BD_OK, 0, "success")                                                                         \
    X(BD_INTERRUPTED, 1, "interrupted by the user")                                                \
    X(BD_REFACTOR, 2,                                                                              \
      "the speed, or a layer's strain, has moved from where the step was factored")                \
    X(BD_NO_MEMORY, -1, "out of memory")                                                           \
    X(BD_BAD_SHAPE, -2, "an array has the wrong shape")                                            \
    X(BD_BAD_VALUE, -3, "a value is outside its domain")                                           \
    X(BD_SINGULAR, -4, "the effective mass matrix is singular")                                    \
    X(BD_SINGULAR_MASS, -5, "the mass matrix is singular")                                         \
    X(BD_NO_CONVERGENCE, -6, "Newton's iteration on the bearing forces did not converge")          \
    X(BD_NOT_FINITE, -7, "the response is no longer finite")                                       \
    X(BD_SINGULAR_DYNAMIC, -8, "the dynamic stiffness is singular")                                \
    X(BD_NOT_SYMMETRIC, -9, "M, C and K must be symmetric, G and N skew-symmetric")

#define BD_STATUS_ENUM(name, value, text) name = (value),
typedef enum bd_status { BD_STATUS_LIST(BD_STATUS_ENUM) } bd_status;
#undef BD_STATUS_ENUM

/* Returned: one line of English for a status, without a full stop. */
const char *bd_status_text(bd_status status);

/* ---------------------------------------------------------------- vector width */

/* Arrays inside the core are padded to whole lanes, the padding held at zero, so that kernels have
 * no remainder loops and the order of every sum is the same whatever the instruction set. */
enum { BD_LANES = 8 };
#define BD_PADDED(n) (((n) + BD_LANES - 1) / BD_LANES * BD_LANES)

/* The hot kernels are compiled for each instruction set and chosen at run time. Contraction to FMA is
 * off and lanes never mix, so that all of them give the same bits. */
#define BD_ISA_LIST(X)                                                                             \
    X(BD_ISA_BEST, "best") /* of those this machine has */                                         \
    X(BD_ISA_BASE, "base") /* of every machine the core is compiled for */                         \
    X(BD_ISA_AVX2, "avx2")                                                                         \
    X(BD_ISA_AVX512, "avx512")

typedef enum bd_isa { BD_ISA_LIST(BD_ENUMERATOR) } bd_isa;

/* Whether this build and this machine have an instruction set. */
bool bd_isa_available(bd_isa isa);

/* ---------------------------------------------------------------- Maxwell history (maxwell.c) */

/* Weights of one branch for one step: S(n+1) = decay S(n) + old ydot(n) + now ydot(n+1). */
typedef struct bd_branch_weights {
    double decay; /* E = exp(-dt/tau) */
    double old;   /* 2 tau modulus [(1 - E) - q] */
    double now;   /* 2 tau modulus q,  q = 1 - (1 - E) tau/dt */
} bd_branch_weights;

/* Given:    dt > 0, tau > 0, modulus >= 0
 * Returned: the weights, exact for a strain rate linear in the step, to a few units of round-off for
 *           any dt/tau > 0
 * Reference: paper eqs (10), (11), written for the full branch stress so that they stay exact when
 *           dt changes and restart exactly. */
bd_branch_weights bd_maxwell_weights(double dt, double tau, double modulus);

/* Deviatoric stress of a material point under a given strain rate, paper eq (9) without its
 * volumetric part: 2 G0 e + 2 eta0 edot + sum of branches, from e = 0 and S = 0.
 * Given:    rate (n_times x n_components) linear between samples, dt (n_times - 1) each > 0
 * Returned: stress (n_times x n_components)
 * Notes:    work is scratch of bd_maxwell_stress_work_size doubles */
size_t bd_maxwell_stress_work_size(int n_components, int n_branches);
void bd_maxwell_stress(int n_times, int n_components, const double *rate, const double *dt,
                       double G0, double eta0, int n_branches, const double *modulus,
                       const double *tau, double *stress, double *work);

/* ---------------------------------------------------------------- EHL contact (ehl.c) */

/* F = kappa (delta + h0 - give F_e)^1.5 + c(delta) ddelta/dt, never tensile: paper eq (1). F_e is the elastic part: the
 * ring lies in series with the film and solids, by `give` more (or, negative, less) than the half-space of Hertz. */

#define BD_DAMPING_LIST(X)                                                                         \
    X(BD_DAMPING_CONSTANT, "constant") /* c while in contact (paper section 4.1) */                \
    X(BD_DAMPING_TABLE, "table")       /* c(delta), piecewise linear, its ends held */             \
    X(BD_DAMPING_LOAD, "load")         /* c = t_c dQ/ddelta: vanishes where contact is lost */     \
    X(BD_DAMPING_FILM, "film") /* of a lubricated contact, over its load: vanishes likewise */     \
    X(BD_DAMPING_CARRIED,                                                                          \
      "carried") /* as film at low frequency; the oil carries what was pressed */

typedef enum bd_damping_law { BD_DAMPING_LIST(BD_ENUMERATOR) } bd_damping_law;

/* Of the film law, with s = delta + h0: c over w = sqrt(s)/(sqrt(s) + sqrt(scale)), which goes from 0 where contact is
 * lost towards 1, by cubics between equidistant nodes. */
enum { BD_FILM_CELLS = 64, BD_FILM_NODES = BD_FILM_CELLS + 1 };

/* Of the carried law: u^2 + give kappa u^3 = s + eta and F = kappa u^3, where the film eta answers the rate of approach
 * through what the oil carries from the inlet through the contact,
 *     eta = sum of Re(strength_i q_i),   dq_i/dt = -decay_i q_i + b(s) ddelta/dt,   Re sum of strength_i/decay_i = 1,
 * b in s over w as the film law's c, here with w from s itself. Slow motions find eta = b ddelta/dt, the damping b dF/ds.
 * F cannot be negative and jumps nowhere. */
typedef struct bd_echo {
    double decay[2],
        strength[2]; /* 1/s, real and imaginary part; of a pair of two its first, doubled */
} bd_echo;

/* Weights of one echo for one step, complex: q(n+1) = decay q(n) + old p(n) + now p(n+1), p = b ddelta/dt. */
typedef struct bd_echo_weights {
    double decay[2], old[2], now[2];
} bd_echo_weights;

/* Given:    dt > 0; an echo whose decay has a positive real part
 * Returned: the weights, exact for p linear in the step, to 2e-14 of the larger for any decay dt */
bd_echo_weights bd_echo_step(const bd_echo *echo, double dt);

typedef struct bd_contact {
    double kappa, h0; /* N/m^1.5; sum of both films, m */
    double give;      /* compliance of the ring beyond Hertz at a ball of its own, m/N */
    bd_damping_law law;
    double c; /* N s/m (constant), t_c in s (load), or scale in m (film, carried) */
    int n_table;
    /* (n_table) increasing, and N s/m. Film: c at the nodes and its rise per cell, N s/m; both zero at the first. Carried:
     * likewise b, s */
    const double *table_delta, *table_c;
    int n_echoes;          /* 0 but for the carried law */
    const bd_echo *echoes; /* (n_echoes) */
} bd_contact;

/* ---------------------------------------------------------------- ball bearing (bearing.c) */

#define BD_WAVE_LIST(X)                                                                            \
    X(BD_WAVE_INNER_RADIAL, "inner_radial") /* of a race, which turns with its ring */             \
    X(BD_WAVE_INNER_AXIAL, "inner_axial")                                                          \
    X(BD_WAVE_OUTER_RADIAL, "outer_radial")                                                        \
    X(BD_WAVE_OUTER_AXIAL, "outer_axial")                                                          \
    X(BD_WAVE_BALL, "ball") /* of one ball's surface; met by both races, so odd orders cancel */

typedef enum bd_wave_kind { BD_WAVE_LIST(BD_ENUMERATOR) } bd_wave_kind;

/* amplitude cos(order angle + phase), the angle measured on the body that carries the wave. A race's wave is
 * the displacement of its surface along +r or +z. */
typedef struct bd_wave {
    bd_wave_kind kind;
    int order, ball; /* ball: which one carries it, 0 ... n_balls - 1 */
    double amplitude, phase;
} bd_wave;

#define BD_PIT_LIST(X) X(BD_PIT_INNER, "inner") X(BD_PIT_OUTER, "outer") X(BD_PIT_BALL, "ball")

typedef enum bd_pit_kind { BD_PIT_LIST(BD_ENUMERATOR) } bd_pit_kind;

/* A localised defect. A ball drops into it by min(depth, D/2 - sqrt(D^2/4 - (width/2 - |s|)^2)), s the arc
 * from its centre: continuous, and a ball cannot reach the bottom of a narrow pit. */
typedef struct bd_pit {
    bd_pit_kind kind;
    int ball;
    double angle, width, depth; /* angle of its centre on the body that carries it */
} bd_pit;

/* Each race's groove-centre displacement is a Fourier series in the azimuth, radial and axial. The
 * kernel sees coefficients inner minus outer, all radial ones before all axial ones. A rigid ring has
 * radial cos 1, sin 1 and axial cos 0, cos 1, sin 1; a flexible ring just has more. */
typedef struct bd_bearing_data {
    int n_balls, n_coefs, n_radial;
    const int *order; /* (n_coefs) */
    const int *sine;  /* (n_coefs) 0: cos(order psi), 1: sin(order psi) */
    double x0, y0;    /* axial and radial distance of the groove centres at the origin */
    double A;         /* their distance with the ball just touching, (fi + fo - 1) D */
    double e0;        /* x0^2 + y0^2 - A^2, formed without cancellation */
    bd_contact contact;
    double cage_ratio; /* cage speed over shaft speed */
    double inner_ratio,
        outer_ratio; /* speed of each ring over shaft speed: its waves and pits turn so */
    double angle0;   /* azimuth of the first ball at zero shaft angle */
    double
        spin_ratio; /* spin of a ball about its own axis over shaft speed, < 0 where the outer ring is faster */
    double ball_diameter, inner_radius, outer_radius; /* of a ball; of the races where balls run */
    int n_waves, n_pits;
    const bd_wave *waves;
    const bd_pit *pits;
    const double *oversize; /* (n_balls) diameter of each ball beyond the nominal, or NULL */
    int shoulder; /* +1, -1: axial load on the inner ring is borne towards +z, -z only; 0: both ways */
    double open_sine; /* sine of the contact angle on the open side from which a ball runs off */
} bd_bearing_data;

/* Of the bodies of a bearing their angles, rad, or speeds, rad/s: the azimuth of the first ball, the rings, and the spin
 * of a ball about its own axis. */
typedef struct bd_bodies {
    double cage, inner, outer, spin;
} bd_bodies;

typedef struct bd_bearing bd_bearing;           /* as kept in a model */
typedef struct bd_bearing_work bd_bearing_work; /* scratch of one bearing */

/* BD_OK, or what is wrong with a description. */
bd_status bd_bearing_check(const bd_bearing_data *data);

/* Doubles of scratch one bearing needs. */
size_t bd_bearing_work_size(const bd_bearing_data *data);

/* ---------------------------------------------------------------- model (model.c) */

/* How a layer softens with the amplitude of its own strain (softening.c): beside the Maxwell branches stand a spring
 * E = F - L, a branch of modulus 2 L, and one that makes good what the Maxwell branches lack, of the running strain amplitude,
 *     F = D (1 + (A/gamma_c)^p)^(-m/p),   L = Lm (A/gamma_l)^p / (1 + (A/gamma_l)^p) */
typedef struct bd_softening_data {
    double D, gamma_c, m, Lm, gamma_l, p;
    double memory; /* time over which the amplitude is remembered */
    double
        pressed; /* relaxed modulus, beyond that of K, which a layer at rest carries at the start */
    const double *strain; /* (rank) weights of y^2 in the square of the strain amplitude */
    int n_table;          /* frequencies, even in their logarithm from rate_first to rate_last */
    double rate_first, rate_last;
    const double
        *table; /* (2 n_table) what the branches lack: strength of a slow branch, then loss */
} bd_softening_data;

typedef struct bd_layer_data {
    int rank, n_branches;
    const double *L;                    /* (n x rank) row-major */
    const double *modulus, *tau;        /* (n_branches) */
    const bd_softening_data *softening; /* NULL: the layer is linear */
} bd_layer_data;

/* Of the rotating load, an unbalance: theta is the shaft angle; the second term acts while the speed changes. */
#define BD_LOAD_LIST(X)                                                                            \
    X(BD_LOAD_CONSTANT, "constant") /* p_cos */                                                    \
    X(BD_LOAD_HARMONIC, "harmonic") /* p_cos cos(omega t) + p_sin sin(omega t) */                  \
    X(BD_LOAD_ROTATING,                                                                            \
      "rotating")                 /* speed^2 (p_cos cos(theta) + p_sin sin(theta))               \
                                     * + speed' (p_cos sin(theta) - p_sin cos(theta)) */ \
    X(BD_LOAD_SAMPLED, "sampled") /* p_cos times a table, linear between, its ends held */

typedef enum bd_load_kind { BD_LOAD_LIST(BD_ENUMERATOR) } bd_load_kind;

typedef struct bd_load_data {
    bd_load_kind kind;
    double omega;
    const double *p_cos, *p_sin; /* (n) */
    int n_samples;
    const double *time, *value; /* (n_samples) */
} bd_load_data;

#define BD_CHANNEL_LIST(X)                                                                         \
    X(BD_CHANNEL_DISPLACEMENT, "displacement") /* row . x */                                       \
    X(BD_CHANNEL_VELOCITY, "velocity")         /* row . v */                                       \
    X(BD_CHANNEL_ACCELERATION, "acceleration") /* row . a */                                       \
    X(BD_CHANNEL_FORCE, "force")               /* bearing's force on coefficient `index` */        \
    X(BD_CHANNEL_BALL, "ball")                 /* load of ball `index` */                          \
    X(BD_CHANNEL_LOADED, "loaded")             /* number of loaded balls */                        \
    X(BD_CHANNEL_CONTACT_LOSS, "contact_loss") /* power that contacts turn into heat, W */         \
    X(BD_CHANNEL_BRANCH_LOSS, "branch_loss")   /* the same of the branches of layer `index` */     \
    X(BD_CHANNEL_STRAIN, "strain")             /* running strain amplitude of layer `index` */

typedef enum bd_channel_kind { BD_CHANNEL_LIST(BD_ENUMERATOR) } bd_channel_kind;

typedef struct bd_channel_data {
    bd_channel_kind kind;
    const double *row; /* (n) for the first three kinds */
    int bearing, index;
} bd_channel_data;

typedef struct bd_model_data {
    int n, n_layers, n_bearings, n_loads, n_channels;
    /* (n x n) row-major; M, C, K symmetric and G, N skew to 1e-8 of a matrix's largest entry, else
     * BD_NOT_SYMMETRIC */
    const double *M, *C, *G, *K, *N;
    const bd_layer_data *layers;
    const bd_bearing_data *bearings;
    const double *const *B; /* per bearing (n_coefs x n) row-major */
    const bd_load_data *loads;
    const bd_channel_data *channels;
} bd_model_data;

typedef struct bd_model bd_model;

/* Given:    a description; every array is copied, nothing of it is kept
 * Returned: a model in one allocation, or NULL and *status
 * Notes:    coordinates that neither M, C, G, K, N nor a layer couples fall into blocks, found here;
 *           bearings couple blocks only through their few coefficients. What a layer joins, and the columns of its
 *           factor do not, a march takes apart inside the block. */
bd_model *bd_model_create(const bd_model_data *data, bd_status *status);

/* What the model keeps, in bytes. */
size_t bd_model_bytes(const bd_model *model);

/* Safe on NULL. */
void bd_model_free(bd_model *model);

int bd_model_blocks(const bd_model *model);
int bd_model_channels(const bd_model *model);
int bd_model_bearings(const bd_model *model);
int bd_model_coefs(const bd_model *model);
int bd_model_layers(const bd_model *model);
int bd_model_loads(const bd_model *model);
int bd_model_softening(const bd_model *model); /* how many layers soften */
int bd_model_size(const bd_model *model);

/* ---------------------------------------------------------------- state and march (newmark.c) */

/* Speed of the shaft, rad/s: linear between the given times, held outside. One time is a constant speed. The
 * shaft angle is its exact integral, with angle speed[0] time[0] at time[0]. */
typedef struct bd_speed {
    int n;
    const double *time, *value; /* (n) */
} bd_speed;

/* How the shaft turns at one time. */
typedef struct bd_turn {
    double speed, rate, angle; /* rad/s, rad/s^2, rad */
} bd_turn;

typedef struct bd_scheme {
    double dt, beta, gamma; /* Newmark; 1/4 and 1/2 conserve energy */
    bd_speed speed;         /* its arrays are the caller's; bd_start and bd_prepare copy them */
    double tolerance;       /* of a bearing's force against the largest, per step */
    int max_iterations;
    int audit;  /* nonzero: energies and work are integrated */
    bd_isa isa; /* of the kernels; one that this machine lacks is a BD_BAD_VALUE */
} bd_scheme;

/* From the eleventh iteration of a step on, corrections are halved; after this many the halves are below the smallest
 * double. A step cannot be interrupted, so that a larger limit could only hang. */
#define BD_ITERATIONS_LIMIT 1000

typedef struct bd_fault {
    const char *field,
        *must; /* which number, and what it must be; both NULL where nothing is wrong */
} bd_fault;

/* The first number of a scheme that cannot be marched with on this machine. */
bd_fault bd_scheme_fault(const bd_scheme *scheme);

/* What the audit integrates. Turning feeds in what the cage drives the balls with and what the shaft drives its own
 * damping with:
 *   load + turning - (linear + branch + contact + softening) = change of (kinetic + elastic + stored + indentation) */
#define BD_ENERGY_LIST(X)                                                                          \
    /* now, J */                                                                                   \
    X(kinetic)                                                                                     \
    X(elastic)                                                                                     \
    X(stored)                                                                                      \
    X(indentation)                                                                                 \
    /* work since the start, J */                                                                  \
    X(load)                                                                                        \
    X(turning)                                                                                     \
    X(linear)                                                                                      \
    X(branch)                                                                                      \
    X(contact)                                                                                     \
    X(softening)                                                                                   \
    /* integral of |power of loads and turning|, J */                                              \
    X(throughput)

#define BD_ENERGY_FIELD(name) double name;
typedef struct bd_energy {
    BD_ENERGY_LIST(BD_ENERGY_FIELD)
    double power[6]; /* at the present time, in the order of the works, W */
} bd_energy;
#undef BD_ENERGY_FIELD

/* X(type, name, how it adds): of two marches, one after the other, a count is the sum of both; of the rest the last of
 * both counts, or the first that is not negative. A new counter is named here, counted where it happens, and typed in
 * core.Report. */
typedef long long bd_count;
#define BD_REPORT_LIST(X)                                                                          \
    X(bd_status, status, last)                                                                     \
    X(bd_count, steps, sum)      /* done in this call */                                           \
    X(bd_count, iterations, sum) /* evaluations of the bearings */                                 \
    X(bd_count, refreshes, sum)  /* of Newton's matrix */                                          \
    X(bd_count, refactors, sum)  /* of S, as the speed or a layer moved: counted by the caller */  \
    X(bd_count, grazing, sum)    /* steps in which balls were held where their film opens */       \
    X(bd_count, open_steps,                                                                        \
      sum)                   /* with a ball on a bearing's open side, or none on its shoulder */   \
    X(double, open_t, first) /* at the first of them, -1 without */                                \
    X(int, open_bearing, first) /* whose it was, -1 without */                                     \
    X(double, t, last)          /* at the end */                                                   \
    X(double, residual, last)   /* of the last step, relative */                                   \
    X(int, bearing, last)       /* with the largest residual, -1 without */

#define BD_REPORT_FIELD(type, name, adds) type name;
typedef struct bd_report {
    BD_REPORT_LIST(BD_REPORT_FIELD)
} bd_report;
#undef BD_REPORT_FIELD

/* A state is a flat array of doubles: exactly what resumes a march bit for bit. */
size_t bd_state_size(const bd_model *model);

/* When a state is, and what its march keeps from step to step. */
typedef struct bd_clock {
    double origin; /* of time; the state's own time is origin + steps dt */
    long long steps;
    double dt;
    double reference;   /* speed that S is factored at */
    bool inverse_set;   /* whether Newton's frozen inverse is one */
    bool reference_set; /* whether the reference speed is one */
    bool films_set;     /* whether films remember more than how balls turned */
} bd_clock;

/* Views of a state's parts; vectors are padded and in the model's block order. */
typedef struct bd_state {
    double *flat;
    bd_clock clock;    /* a copy; in the array it lies as doubles */
    double *x, *v, *a; /* (n_padded) */
    double *y_rate;    /* (rank_padded) layer rates L^T v */
    double *stress; /* branch stresses, layer by layer, branch by branch, then those of softening */
    double *softening; /* of layers that soften: what their amplitude runs on */
    double *echoes;    /* of films that are carried: what they remember (echoes.c) */
    double *g;         /* (coefs_padded) bearing forces of the last step */
    double *g_before;  /* (2 coefs_padded) those of the two steps before it */
    double *inverse;   /* (coefs_padded^2) Newton's frozen inverse */
    bd_energy *energy;
    double *q; /* behind the rest, of an exact march only: the numbers of its modes */
} bd_state;

bd_state bd_state_view(const bd_model *model, double *flat);

/* Given:    x, v (n) in the caller's order, start time
 * Returned: a state with branches at rest (relaxed), without acceleration: see bd_start */
void bd_state_set(const bd_model *model, double *flat, double t, const double *x, const double *v);

/* How many stresses bd_state_stress takes: of every layer, its branches' components. */
int bd_model_stresses(const bd_model *model);

/* Given: a state from bd_state_set; what the branches bear, layer by layer in the caller's order, branch by branch */
void bd_state_stress(const bd_model *model, double *flat, const double *stress);

/* How many numbers bd_state_films takes: of every bearing whose films are carried 1 + 2 n_echoes for a ball. */
int bd_model_films(const bd_model *model);

/* Given: a state from bd_state_set; of every such bearing what its films remember, ball by ball in each row: p, then of
 * each echo the real and the imaginary parts of q */
void bd_state_films(const bd_model *model, double *flat, const double *films);

/* Returned: x, v, a (n) in the caller's order; any may be NULL */
void bd_state_get(const bd_model *model, const double *flat, double *t, double *x, double *v,
                  double *a);

typedef struct bd_work bd_work;
bd_work *bd_work_create(const bd_model *model); /* NULL: out of memory */
void bd_work_free(bd_work *work);               /* safe on NULL */

/* Factors the effective mass S = M + gamma dt (C + C_ve + speed G) + beta dt^2 (K + speed N) at a reference
 * speed, block by block, and forms the operators of a step. LAPACK is used here and nowhere in the march.
 * Notes:    at a constant speed the reference must be that speed; else bd_reference_speed gives it. */
bd_status bd_prepare(const bd_model *model, const bd_scheme *scheme, const bd_lapack *lapack,
                     double reference_speed, bd_work *work);

/* The same, where only the layers' laws have changed since: blocks without layers that soften are left. */
bd_status bd_prepare_softened(const bd_model *model, const bd_lapack *lapack, bd_work *work);

/* Takes the law of every layer that softens from a state into work, before bd_prepare; with `anew` the law is first
 * renewed at the state's running amplitude. It is kept in the state, so that a resumed march repeats every bit. */
void bd_soften(const bd_model *model, const bd_scheme *scheme, double *flat, bool anew,
               bd_work *work);

/* The speed a state's march is factored at: of the state if it has one, else that at the end of the
 * next step; with `anew`, always the latter. It is kept in the state, so that a resumed march repeats
 * every bit. */
double bd_reference_speed(const bd_model *model, const bd_scheme *scheme, double *flat, bool anew);

/* The acceleration that satisfies (1) at the state's own displacement, velocity and branch stress.
 * Notes:    before bd_prepare; without BD_OK the acceleration is void. Films that are carried remember what bd_state_films
 *           gave, else that balls have always turned past what stood: velocities are then sudden to them */
bd_status bd_start(const bd_model *model, const bd_scheme *scheme, const bd_lapack *lapack,
                   bd_work *work, double *flat);

/* The exact step of the linear part at a constant speed (exact.c): each group of coupled coordinates in modes of its
 * own, all prepared for one step size. Sections are padded to whole lanes: of each group the real modes, the real parts
 * of pairs, their imaginary parts, and displacements that nothing holds, which are integrals of their velocity. Of a
 * row's product with a pair twice the real part counts, which the rows hold already. */
typedef struct bd_exact_data {
    int n_groups;
    long long n, n_loose, n_stresses; /* numbers of all groups; of loose rows; stresses, unpadded */
    int hold;            /* 1 ... 3, largest order of the polynomial that the forces are held by */
    const double *table; /* (n_groups x 3) sizes of the sections: real, pairs, loose */
    const double *roots; /* (n) of the modes, 1/s */
    /* ((hold + 1)(hold + 2)/2 x n) of the modes; then by the order 1 ... hold, of the forces at 1, 0, -1 ... 1 - order */
    const double *weights;
    const double *loose; /* (as many x n_loose) of loose displacements, per mode a row of them */
    const double *P, *Z; /* (n_coefs x n), (n x 2 n_coefs): bearing forces in, z and z_rate out */
    const double *
        load; /* (2 n_loads x n): over a step, per factor at its start; of a table, start and end */
    const double *X, *V, *A, *S; /* (n x n coordinates) x, v, a without forces; (n x n_stresses) */
    const double
        *W; /* (2 hold x n_coefs^2) minus z and z_rate per force at the end, order by order */
} bd_exact_data;

typedef struct bd_exact bd_exact;

/* Doubles of a state that is marched so. */
size_t bd_exact_size(const bd_model *model, const bd_exact_data *data);

/* In place of bd_prepare: bd_march then takes exact steps. The mass matrix must be the identity.
 * Returned: BD_OK; BD_BAD_SHAPE where arrays do not fit; BD_BAD_VALUE where the speed varies or a layer softens */
bd_status bd_exact_prepare(const bd_model *model, const bd_scheme *scheme,
                           const bd_exact_data *data, bd_work *work);

/* After the last bd_march of exact steps: x, v, a and the stresses of the state from its modes. */
void bd_exact_end(const bd_model *model, const bd_work *work, double *flat);

/* Largest load of one ball of a bearing, N, at the end of any step marched with this work. */
double bd_peak_load(const bd_model *model, const bd_work *work, int bearing);

/* n_steps of the scheme prepared in work.
 * Given:    decimate >= 1: a row of channels is kept each time the state's step count is a multiple;
 *           record has room for n_steps/decimate + 1 rows of n_channels
 * Returned: rows written; report
 * Notes:    allocates nothing, calls no LAPACK. On failure the state is that of the last good step.
 *           BD_REFACTOR asks for bd_soften and bd_prepare at bd_reference_speed(..., true), both anew; then the
 *           march goes on. */
long long bd_march(const bd_model *model, const bd_scheme *scheme, bd_work *work, double *flat,
                   long long n_steps, long long decimate, double *record, bd_report *report);

/* ---------------------------------------------------------------- marches side by side (abreast.c) */

/* At most so many. */
enum { BD_ABREAST = 8 };

/* One of several marches that share the structure and its step: bearings (their clearance, waves, balls), loads, states,
 * channels and counts of steps are its own. */
typedef struct bd_abreast_case {
    const bd_model *model;
    bd_work *work; /* prepared by bd_prepare */
    double *flat;  /* the state */
    long long steps, decimate;
    double *record;   /* as bd_march's */
    long long rows;   /* written by the last call */
    bd_report report; /* of the last call */
} bd_abreast_case;

typedef struct bd_abreast bd_abreast;

/* Whether two marches share their linear part, to the bit (how bearings see it apart, as the arm of a tilt follows from
 * the clearance): they have one step and one constant speed, no audit, no layer
 * that softens, no exact steps. */
bool bd_abreast_shares(const bd_abreast_case *a, const bd_abreast_case *b);

/* For n <= BD_ABREAST cases of which each shares with the first; model and work of that must outlive it. NULL: out of
 * memory */
bd_abreast *bd_abreast_create(int n, const bd_abreast_case *cases);
void bd_abreast_free(bd_abreast *abreast); /* safe on NULL */

/* bd_march of every case, its steps of its own; one that fails ends by itself.
 * Given:    the cases of bd_abreast_create, whose states may have been marched on; steps may be 0
 * Returned: states, records, rows and reports as bd_march returns them, to the bit
 * Notes:    allocates nothing, calls no LAPACK */
void bd_abreast_march(bd_abreast *abreast, int n, bd_abreast_case *cases);

/* Force and tangents of one bearing by itself, rows padded to the caller's n_coefs.
 * Returned: g (n_coefs), K and C (n_coefs x n_coefs row-major) = dg/dz, dg/dzdot, loads (n_balls);
 *           BD_NOT_FINITE where they overflow */
bd_status bd_bearing_single(const bd_bearing_data *data, const double *z, const double *z_rate,
                            double angle, double cage_speed, bd_turn shaft, double *g, double *K,
                            double *C, double *loads);

/* ---------------------------------------------------------------- a given motion (along.c) */

/* One bearing through many samples of a motion that is known, as the balance of harmonics needs it. */
typedef struct bd_along_data {
    int n;                    /* samples */
    const double *z, *z_rate; /* (n x n_coefs) */
    const bd_bodies
        *angle; /* (n) of each body by itself: the bodies need not stand as in one march */
    bd_bodies speed;
    double
        window; /* s between samples, over which a force that jumps as a film closes is spread; 0: not */
} bd_along_data;

/* What comes of it; K and C may both be NULL. */
typedef struct bd_along {
    double *g;     /* (n x n_coefs) */
    double *K, *C; /* (n x n_coefs x n_coefs) dg/dz, dg/dzdot */
    double *loads; /* (n x n_balls) */
    double *
        pressed; /* (n x n_balls) m/s: p of films that are carried (bd_echo_weights); may be NULL */
    /* (n) W: power that contacts turn into heat, that presses the balls in all, and that turning feeds in */
    double *heat, *pressing, *turning;
} bd_along;

/* Doubles of scratch that bd_bearing_along needs. */
size_t bd_bearing_along_size(const bd_bearing_data *data);

/* Given:    a checked bearing; scratch, zeroed
 * Returned: BD_OK, or BD_NOT_FINITE where a force overflows
 * Notes:    the kernels of the march, so that both find the same motion */
bd_status bd_bearing_along(const bd_bearing_data *data, const bd_along_data *motion,
                           double *scratch, bd_along *found);

/* ---------------------------------------------------------------- one bearing at rest (settle.c) */

/* How a search for the place of rest ended. */
#define BD_SETTLED_LIST(X)                                                                         \
    X(BD_SETTLED, "settled")                                                                       \
    X(BD_SETTLED_NOT, "no equilibrium")                                                            \
    X(BD_SETTLED_ASTRAY,                                                                           \
      "open side") /* a ball that carries is pressed where there is no shoulder */

typedef enum bd_settled { BD_SETTLED_LIST(BD_ENUMERATOR) } bd_settled;

/* One bearing at one cage angle, which many loads are put on; outer ring held. */
typedef struct bd_settle bd_settle;
bd_settle *bd_settle_create(const bd_bearing_data *data, double angle,
                            double shaft_angle); /* NULL: out of memory */
void bd_settle_free(bd_settle *settle);          /* safe on NULL */

/* Given:    load (n_coefs) on the coefficients, radius > 0 of the order of the expected displacement
 * Returned: z (n_coefs), loads (n_balls)
 * Notes:    allocates nothing. The energy is convex: regularised Newton steps from z = 0, whose length
 *           follows what they gain. A motion that costs nothing stays at its origin. */
bd_settled bd_settle_case(bd_settle *settle, const double *load, double radius, double *z,
                          double *loads);

/* ---------------------------------------------------------------- harmonic response (harmonic.c) */

typedef struct bd_harmonic_data {
    double speed; /* rad/s, for G and N */
    int n_omega, n_in, n_out;
    const double *omega;   /* (n_omega) rad/s */
    const double *modulus; /* (n_omega x n_layers) complex G*, re and im interleaved */
    const double *bearing_K, *bearing_C; /* (coefs x coefs) row-major, linearised bearings */
    int n_balls;          /* that answer by frequency besides: sum of ball v v^T is added */
    const double *ball;   /* (n_omega x n_balls) complex, N/m */
    const double *across; /* (n_balls x coefs) v */
    const double *force;  /* (n_in x n) */
    const double *row;    /* (n_out x n) */
    bd_isa isa; /* of the kernels; the best where this machine lacks it. All give the same bits */
} bd_harmonic_data;

typedef struct bd_harmonic_work bd_harmonic_work;
bd_harmonic_work *bd_harmonic_work_create(const bd_model *model, const bd_harmonic_data *data);
void bd_harmonic_work_free(bd_harmonic_work *work);

/* Response at frequencies first .. first + count - 1.
 * Returned: response (n_omega x n_out x n_in) complex interleaved, those rows written
 * Notes:    each block of the structure is solved by itself, several frequencies at once, and the blocks are joined
 *           through the few bearing coefficients; where a block by itself is singular or nearly so (one that
 *           floats, at low frequency), all is solved as one. A frequency's response is the same, to the bit,
 *           whatever others are asked for beside it.
 * Reference: paper eq (20), with G' (omega) in its deviatoric part. */
bd_status bd_harmonic(const bd_model *model, const bd_harmonic_data *data, const bd_lapack *lapack,
                      bd_harmonic_work *work, int first, int count, double *response);

#endif
