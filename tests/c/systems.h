/* systems.h - systems to march: their arrays live in a pool until it is emptied. */
#ifndef SYSTEMS_H
#define SYSTEMS_H

#include "bearingdyn.h"

/* Zeroed memory, all freed at once. */
typedef struct pool {
    void *pieces[256];
    int n;
} pool;

void *pool_take(pool *p, size_t count, size_t size);
void pool_empty(pool *p);

/* A uniform number in [-1, 1) from a seed that it advances. */
double uniform(unsigned long long *seed);

/* n coordinates without mass, stiffness, layers, bearings, loads or channels. */
bd_model_data bare_system(pool *p, int n);

/* Writable views of a system's own arrays. */
double *entry(const double *matrix, int n, int i, int j);

/* Orthonormal (n x n), drawn from the seed. */
double *random_rotation(pool *p, int n, unsigned long long *seed);

/* A deep-groove bearing: Z = 8, D = 11.5 mm, dm = 43.5 mm, 10 um of clearance; rigid rings. */
bd_bearing_data deep_groove(bd_damping_law law);

/* Waves of every kind, a pit on every body and balls of two sizes for it. */
void make_imperfect(bd_bearing_data *bearing);

/* A motor in small: a turning shaft of 7 coordinates and two housings of 6, each behind a layer, joined by two
 * bearings; loads and channels of every kind. */
bd_model_data motor(pool *p, bd_damping_law law);

enum { MOTOR_SIZE = 19, MOTOR_BLOCKS = 3, MOTOR_CHANNELS = 8 };

/* A shaft at rest. */
extern const bd_speed no_turning;

/* Average acceleration at 5000 rpm. */
bd_scheme motor_scheme(void);

/* The same while the speed rises and falls within a millisecond. */
bd_scheme motor_run_up(void);

#endif
