/* lanes.h - inside the core: one register of doubles as one value.
 *
 * GCC's and Clang's vector notation: element-wise arithmetic only, so nothing is reordered. Plain loops
 * were vectorised across the wrong index, with gathers, at a quarter of the speed; vectors wider than
 * the machine's registers went through memory, at a tenth. Macros, not functions, where a value would
 * be passed: the calling convention of a vector depends on the instruction set. */
#ifndef BD_LANES_H
#define BD_LANES_H

#include "bearingdyn.h"

/* Doubles per register of the target; padding (BD_LANES) is a multiple of all of them. */
#ifndef BD_WIDTH
#define BD_WIDTH 2
#endif

typedef double lanes __attribute__((vector_size(8 * BD_WIDTH), aligned(8), may_alias));
typedef long long lane_mask __attribute__((vector_size(8 * BD_WIDTH), aligned(8), may_alias));

/* Lanes at a double pointer, aligned or not. */
#define LANES(p) (*(const lanes *)(p))
#define LANES_AT(p) (*(lanes *)(p))
#define LANE_MASK(p) (*(const lane_mask *)(p))

/* All bits set where value > 0, from the sign bit of its negative (0 - 0 has none): compilers turn a
 * comparison of wide vectors into scalars. A NaN may count as either. */
#define LANES_POSITIVE(value) ((lane_mask)(0.0 - (value)) >> 63)

/* value where the mask is set, else 0.0 */
#define LANES_WHERE(mask, value) ((lanes)((lane_mask)(mask) & (lane_mask)(value)))

#define BD_INLINE static inline __attribute__((always_inline))

/* root = sqrt(value), lane by lane; compilers make one instruction of it. */
BD_INLINE void lanes_sqrt(const lanes *value, lanes *root)
{
    double v[BD_WIDTH], r[BD_WIDTH];
    LANES_AT(v) = *value;
    for (int i = 0; i < BD_WIDTH; i++)
        r[i] = __builtin_sqrt(v[i]);
    *root = LANES(r);
}

#endif
