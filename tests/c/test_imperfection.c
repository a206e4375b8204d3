/* Waves, pits and unequal balls: what is refused, and that a wave of no height and a pit of no depth are nothing. */
#include <math.h>
#include <string.h>

#include "bearingdyn.h"
#include "check.h"
#include "systems.h"

static void imperfections_are_checked(void)
{
    static const double no_size[8] = {0.0, 0.0, NAN, 0.0, 0.0, 0.0, 0.0, 0.0};
    bd_bearing_data bearing = deep_groove(BD_DAMPING_CONSTANT);
    make_imperfect(&bearing);
    CHECK_EQUAL("an imperfect bearing", bd_bearing_check(&bearing), BD_OK);
    for (int i = 0; i < 15; i++) {
        bd_bearing_data bad = bearing;
        bd_wave wave = bearing.waves[0];
        bd_pit pit = bearing.pits[0];
        switch (i) {
        case 0:
            wave.order = -1;
            break;
        case 1:
            wave.ball = 8;
            break;
        case 2:
            wave.ball = -1;
            break;
        case 3:
            wave.amplitude = NAN;
            break;
        case 4:
            wave.phase = INFINITY;
            break;
        case 5:
            pit.width = 0.0;
            break;
        case 6:
            pit.depth = -1e-6;
            break;
        case 7:
            pit.angle = NAN;
            break;
        case 8:
            pit.ball = 8;
            break;
        case 9:
            pit.depth = INFINITY;
            break;
        case 10:
            bad.spin_ratio = NAN;
            break;
        case 11:
            bad.ball_diameter = 0.0;
            break;
        case 12:
            bad.inner_radius = INFINITY;
            break;
        case 13:
            bad.oversize = no_size;
            break;
        default:
            pit.width = NAN;
            break;
        }
        bad.n_waves = bad.n_pits = 1;
        bad.waves = &wave;
        bad.pits = &pit;
        CHECK_EQUAL("an imperfection outside its domain", bd_bearing_check(&bad), BD_BAD_VALUE);
    }
    bearing.n_waves = -1;
    CHECK_EQUAL("fewer waves than none", bd_bearing_check(&bearing), BD_BAD_SHAPE);
}

static void what_has_no_size_does_nothing(void)
{
    const bd_turn shaft = {300.0, 0.0, 2.0};
    const double z[] = {2e-5, -1e-5, 3e-6, 1e-6, -2e-6}, rate[] = {1e-3, 0.0, 2e-3, 0.0, 1e-3};
    const double equal[8] = {0};
    double g[5], K[25], C[25], loads[8], same_g[5], same_K[25], same_C[25], same_loads[8];
    const bd_bearing_data perfect = deep_groove(BD_DAMPING_TABLE);
    bd_bearing_data bearing = perfect;
    make_imperfect(&bearing);
    bd_wave waves[6];
    bd_pit pits[3];
    memcpy(waves, bearing.waves, sizeof waves);
    memcpy(pits, bearing.pits, sizeof pits);
    for (int w = 0; w < 6; w++)
        waves[w].amplitude = 0.0;
    for (int k = 0; k < 3; k++)
        pits[k].depth = 0.0;
    bearing.waves = waves;
    bearing.pits = pits;
    bearing.oversize = equal;
    for (int i = 0; i < 20; i++) {
        const double angle = 0.3 * i;
        bd_bearing_single(&perfect, z, rate, angle, 110.0, shaft, g, K, C, loads);
        bd_bearing_single(&bearing, z, rate, angle, 110.0, shaft, same_g, same_K, same_C,
                          same_loads);
        CHECK_EQUAL("forces and loads",
                    memcmp(g, same_g, sizeof g) || memcmp(loads, same_loads, sizeof loads), 0);
        CHECK_EQUAL("tangents", memcmp(K, same_K, sizeof K) || memcmp(C, same_C, sizeof C), 0);
    }
}

int main(void)
{
    imperfections_are_checked();
    what_has_no_size_does_nothing();
    return check_result();
}
