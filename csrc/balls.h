/* balls.h - inside the core: the ball kernels of one instruction set (balls.c); see bd_kernels. */
#ifndef BD_BALLS_H
#define BD_BALLS_H

#include "kernels.h"

void BD_NAMED(bd_bearing_turn)(const bd_bearing *bearing, bd_bearing_work *work, double psi);
void BD_NAMED(bd_bearing_force)(const bd_bearing *bearing, bd_bearing_work *work, const double *z,
                                const double *z_rate, double cage_speed, double *restrict g);
void BD_NAMED(bd_bearing_keep_peaks)(const bd_bearing *bearing, bd_bearing_work *work);
void BD_NAMED(bd_bearing_tangent)(const bd_bearing *bearing, const bd_bearing_work *work,
                                  double cage_speed, int stride, double *restrict K,
                                  double *restrict C);

#endif
