/* bearing.h - inside the core: one bearing as the march sees it. */
#ifndef BD_BEARING_H
#define BD_BEARING_H

#include <stdbool.h>

#include "bearingdyn.h"

struct bd_bearing {
    bd_bearing_data data;                    /* its pointers lie in the model's slab */
    int balls, coefs;                        /* padded to whole lanes */
    const double *spacing_cos, *spacing_sin; /* (balls) of 2 pi j/Z */
    const double *absent;              /* (balls) 0, or a gap no ball closes in padding lanes */
    const double *wave_cos, *wave_sin; /* (n_waves x balls) of order * 2 pi j/Z */
    /* (BD_FILM_CELLS x BD_FILM_POWERS) c, or b, in a cell of the film's laws, by rising powers of the share of the cell;
     * or NULL */
    const double *film;
    size_t echo; /* of its films in a state's echoes */
    int weight;  /* of its first echo in bd_work.echoes */
};

enum { BD_FILM_POWERS = 4 };

/* Scratch; all arrays are padded. `phi` is kept twice: a ball per lane to indent, a coefficient per lane
 * to sum. */
struct bd_bearing_work {
    double *phi, *dphi;           /* (n_coefs x balls) basis and its derivative in psi */
    double *phi_ball, *dphi_ball; /* (n_balls x coefs) the same, transposed */
    /* (n_balls x coefs) for tangents: gradient of the indentation, and of the motion across it */
    double *normal, *along;
    double *sine_a, *cosine_a; /* (balls) of the contact angle */
    double *delta, *rate,
        *turn;       /* (balls) indentation, its rate, (cos a Xdot - sin a Ydot)/Lambda */
    double *tilt;    /* (balls) 1/Lambda */
    double *turning; /* (balls) rate of indentation at rest: the race runs past the ball */
    double *shift_X, *shift_Y, *shift; /* (balls) of imperfections: groove centres, indentation */
    double *shift_X_rate, *shift_Y_rate, *shift_rate;
    double *force, *stiffness, *damping; /* (balls) */
    double *peak;                        /* (balls) largest force at the end of a step, N */
    /* (balls) a ball at the jump of its force (grazing.h): its place, the force in the jump, and what moves it */
    double *place, *inside, *pull;
    bool holds; /* whether the three count */
    bool led;   /* whether the basis is another bearing's, which turns it (abreast.c) */
    /* (balls) of the carried law: eta without the rate at the step's end, and b ddelta/dt there */
    double *carried, *pressed;
    /* of the film's laws: (balls) the cell in which a ball was, its start in 1 + w, 0 before the first; (BD_FILM_POWERS x
     * balls) the cubic of that cell */
    double *cell, *cubic;
    double fresh; /* eta per b ddelta/dt at the step's end; 1 where all has been so for long */
};

/* Whether a contact has a table over w. */
bool bd_has_film(const bd_contact *contact);

/* Doubles that a state keeps of its films: p = b ddelta/dt, then of each echo the real and imaginary parts of q, ball by
 * ball; 0 where none is carried. */
size_t bd_echoes_size(const bd_bearing_data *data);

/* Doubles of the constant arrays (spacing and absent), and their fill. */
size_t bd_bearing_constants(const bd_bearing_data *data);
void bd_bearing_setup(bd_bearing *bearing, const bd_bearing_data *data, double *constants);

/* Carve a work out of bd_bearing_work_size doubles, zeroed. */
void bd_bearing_work_carve(const bd_bearing *bearing, bd_bearing_work *work, double *memory);

/* Takes the basis from another bearing whose balls stand alike, or (NULL) its own again. */
void bd_bearing_lead(const bd_bearing *bearing, bd_bearing_work *work,
                     const bd_bearing_work *leader);

/* Whether a bearing has no waves, pits or unequal balls; its shifts are then zero for ever. */
bool bd_bearing_perfect(const bd_bearing *bearing);

/* Whether a ball that carries is pressed on the side without a shoulder, or none leans on the shoulder, after a force
 * was worked out. */
bool bd_bearing_runs_off(const bd_bearing *bearing, const bd_bearing_work *work);

/* A bearing's bodies where the shaft has turned so far and the first ball stands at psi; of speeds likewise. */
bd_bodies bd_bearing_bodies(const bd_bearing_data *data, double psi, double turned);

/* Shifts of all balls where the bodies stand so and turn so fast. */
void bd_bearing_imperfect(const bd_bearing *bearing, bd_bearing_work *work, const bd_bodies *angle,
                          const bd_bodies *speed);

#endif
