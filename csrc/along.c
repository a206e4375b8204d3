/* One bearing along a motion that is given: forces, tangents and powers, sample by sample. */
#include <math.h>
#include <string.h>

#include "bearing.h"
#include "closing.h"
#include "energy.h"
#include "kernels.h"

/* Doubles of the padded vectors and matrices of one sample. */
static size_t sample_size(const bd_bearing_data *data)
{
    const size_t coefs = (size_t)BD_PADDED(data->n_coefs), n = (size_t)data->n_coefs;
    return 3 * coefs + 2 * n * coefs;
}

size_t bd_bearing_along_size(const bd_bearing_data *data)
{
    return bd_bearing_constants(data) + bd_bearing_work_size(data) + sample_size(data);
}

bd_status bd_bearing_along(const bd_bearing_data *data, const bd_along_data *motion,
                           double *scratch, bd_along *found)
{
    const size_t coefs = (size_t)BD_PADDED(data->n_coefs), n = (size_t)data->n_coefs;
    const size_t balls = (size_t)data->n_balls;
    const bd_kernels *kernels = bd_kernels_for(BD_ISA_BEST);
    double *z = scratch + bd_bearing_constants(data) + bd_bearing_work_size(data);
    double *z_rate = z + coefs, *g = z_rate + coefs, *K = g + coefs, *C = K + n * coefs;
    double poison = 0.0; /* 0 times a number that is not finite is NaN */
    bd_bearing bearing;
    bd_bearing_work work;

    bd_bearing_setup(&bearing, data, scratch);
    bd_bearing_work_carve(&bearing, &work, scratch + bd_bearing_constants(data));
    for (size_t i = 0; i < (size_t)motion->n; i++) {
        memcpy(z, motion->z + i * n, n * sizeof *z);
        memcpy(z_rate, motion->z_rate + i * n, n * sizeof *z_rate);
        kernels->turn(&bearing, &work, motion->angle[i].cage);
        if (!bd_bearing_perfect(&bearing))
            bd_bearing_imperfect(&bearing, &work, &motion->angle[i], &motion->speed);
        kernels->force(&bearing, &work, z, z_rate, motion->speed.cage, g);
        if (motion->window > 0.0)
            bd_soften_edges(data, motion->window, &work, coefs, g);

        memcpy(found->g + i * n, g, n * sizeof *g);
        memcpy(found->loads + i * balls, work.force, balls * sizeof *work.force);
        found->heat[i] = bd_contact_loss(data, &work);
        if (found->pressed)
            memcpy(found->pressed + i * balls, work.pressed, balls * sizeof *work.pressed);
        double turning = 0.0, pressing = 0.0;
        for (size_t j = 0; j < balls; j++) {
            turning += work.force[j] * work.turning[j];
            pressing += work.force[j] * work.rate[j];
        }
        found->turning[i] = turning;
        found->pressing[i] = pressing;
        for (size_t k = 0; k < n; k++)
            poison += 0.0 * g[k];
        if (!found->K)
            continue;
        kernels->tangent(&bearing, &work, motion->speed.cage, (int)coefs, K, C);
        for (size_t k = 0; k < n; k++) {
            memcpy(found->K + (i * n + k) * n, K + k * coefs, n * sizeof *K);
            memcpy(found->C + (i * n + k) * n, C + k * coefs, n * sizeof *C);
        }
    }
    return poison == 0.0 ? BD_OK : BD_NOT_FINITE;
}
