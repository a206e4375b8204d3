/* changed_layers.h - inside the core: motions of layers whose moduli have changed, from those of the linear system
 * (changed_layers.c). */
#ifndef BD_CHANGED_LAYERS_H
#define BD_CHANGED_LAYERS_H

#include "kernels.h"

/* Layer coordinates, layer after layer; those of layer l end before end[l], the last of them before rank. */
struct bd_changed_layers {
    int rank, n_layers;
    const int *end;
};

/* Doubles of scratch for a rank, by any of the instruction sets. */
static inline size_t bd_changed_layers_room(int rank)
{
    const size_t width = (size_t)BD_PADDED(rank);
    return 2 * width * (3 * (size_t)rank + 2);
}

#ifdef BD_ISA
/* Given:    receptance R (rank rows of complex numbers, `stride` doubles apart) of the layer coordinates at one
 *           frequency, `alone` (rank) their motions at the linear moduli, `change` (n_layers) of the complex moduli and
 *           its `slope` over something, all complex; scratch in `memory`, zero before the first call, and in `order`
 *           (rank)
 * Returned: y (rank) = (I + R Delta)^-1 alone, Delta = 2 change on each layer; and `moved` (n_layers x rank), its
 *           derivatives by that something of each layer. As a value: 0, or nonzero where the matrix is singular */
int BD_NAMED(bd_changed_layers_solve)(const bd_changed_layers *layers, const double *receptance,
                                      size_t stride, const double *alone, const double *change,
                                      const double *slope, double *memory, int *order, double *y,
                                      double *moved);
#endif

#endif
