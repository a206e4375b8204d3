/* Whether a description can be computed with: shapes first, then values. */
#include <math.h>
#include <stdbool.h>

#include "model.h"

/* Finite, all n of them; NULL counts as empty only for n = 0. */
static bool all_finite(const double *values, size_t n)
{
    if (n > 0 && !values)
        return false;
    for (size_t i = 0; i < n; i++)
        if (!isfinite(values[i]))
            return false;
    return true;
}

static bool increasing(const double *values, int n)
{
    for (int i = 1; i < n; i++)
        if (!(values[i] > values[i - 1]))
            return false;
    return true;
}

/* Basis functions are built up from order to order; beyond this a call would not come to an end. */
enum { HIGHEST_ORDER = 10000 };

static bool nonnegative(const double *values, int n)
{
    for (int i = 0; i < n; i++)
        if (!(values[i] >= 0.0))
            return false;
    return true;
}

bool bd_scheme_valid(const bd_scheme *scheme)
{
    return bd_scheme_fault(scheme).field == NULL;
}

/* Largest accepted |A - sign A^T| over the largest |A|. Of what is assembled and reduced, T^T A T, 2e-15 was the most
 * that was seen, and matrices read from files may have ten digits; a matrix that lacks the symmetry, or has an entry
 * on one side alone, misses it by about 1. */
static const double symmetry = 1e-8;

/* Is A (n x n) symmetric (sign 1) or skew (-1)? Tiles are compared, so that A^T too is read along its rows. */
static bool mirrored(const double *A, size_t n, double sign)
{
    enum { TILE = 32 };
    double largest = 0.0, difference = 0.0;
    for (size_t ij = 0; ij < n * n; ij++)
        largest = fabs(A[ij]) > largest ? fabs(A[ij]) : largest;
    for (size_t top = 0; top < n; top += TILE)
        for (size_t left = 0; left <= top; left += TILE)
            for (size_t i = top; i < n && i < top + TILE; i++)
                for (size_t j = left; j <= i && j < left + TILE; j++) {
                    const double apart = fabs(A[i * n + j] - sign * A[j * n + i]);
                    difference = apart > difference ? apart : difference;
                }
    return difference <= symmetry * largest;
}

/* Whether all echoes fade, and slow motions find the damping that the table has. */
static bool fades_to_damping(const bd_contact *contact)
{
    double slow = 0.0;
    for (int i = 0; i < contact->n_echoes; i++) {
        const double *d = contact->echoes[i].decay, *s = contact->echoes[i].strength;
        if (!(d[0] > 0.0))
            return false;
        slow += (s[0] * d[0] + s[1] * d[1]) / (d[0] * d[0] + d[1] * d[1]);
    }
    return fabs(slow - 1.0) < 1e-6; /* strengths are solved for: round-off, with room */
}

bd_status bd_bearing_check(const bd_bearing_data *bearing)
{
    const bd_contact *contact = &bearing->contact;
    if (bearing->n_balls < 1 || bearing->n_coefs < 1 || bearing->n_radial < 0 ||
        bearing->n_radial > bearing->n_coefs)
        return BD_BAD_SHAPE;
    for (int k = 0; k < bearing->n_coefs; k++)
        if (bearing->order[k] < 0 || bearing->order[k] > HIGHEST_ORDER)
            return BD_BAD_VALUE;
    const double finite[] = {bearing->x0,     bearing->y0,    bearing->e0, bearing->cage_ratio,
                             bearing->angle0, contact->kappa, contact->h0, contact->c,
                             bearing->A,      contact->give};
    if (!all_finite(finite, sizeof finite / sizeof finite[0]) || !(bearing->A > 0.0) ||
        !(contact->kappa > 0.0) || !(contact->h0 >= 0.0) || !(contact->c >= 0.0))
        return BD_BAD_VALUE;
    if (bearing->n_waves < 0 || bearing->n_pits < 0)
        return BD_BAD_SHAPE;
    if (bearing->shoulder < -1 || bearing->shoulder > 1)
        return BD_BAD_VALUE;
    const double sizes[] = {bearing->spin_ratio,   bearing->ball_diameter, bearing->inner_radius,
                            bearing->outer_radius, bearing->inner_ratio,   bearing->outer_ratio,
                            bearing->open_sine};
    if (!all_finite(sizes, sizeof sizes / sizeof sizes[0]) ||
        (bearing->n_pits > 0 && !(bearing->ball_diameter > 0.0)) ||
        (bearing->oversize && !all_finite(bearing->oversize, (size_t)bearing->n_balls)))
        return BD_BAD_VALUE;
    for (int w = 0; w < bearing->n_waves; w++) {
        const bd_wave *wave = &bearing->waves[w];
        if (wave->order < 0 || !isfinite(wave->amplitude) || !isfinite(wave->phase) ||
            wave->ball < 0 || wave->ball >= bearing->n_balls)
            return BD_BAD_VALUE;
    }
    for (int p = 0; p < bearing->n_pits; p++) {
        const bd_pit *pit = &bearing->pits[p];
        if (!(pit->width > 0.0) || !(pit->depth >= 0.0) || !isfinite(pit->angle) ||
            !isfinite(pit->width) || !isfinite(pit->depth) || pit->ball < 0 ||
            pit->ball >= bearing->n_balls)
            return BD_BAD_VALUE;
    }
    if (contact->law == BD_DAMPING_TABLE) {
        if (contact->n_table < 1)
            return BD_BAD_SHAPE;
        if (!all_finite(contact->table_c, (size_t)contact->n_table) ||
            !nonnegative(contact->table_c, contact->n_table) ||
            !all_finite(contact->table_delta, (size_t)contact->n_table) ||
            !increasing(contact->table_delta, contact->n_table))
            return BD_BAD_VALUE;
    }
    if (bd_has_film(contact)) {
        const double *at = contact->table_delta, *rise = contact->table_c;
        if (contact->n_table != BD_FILM_NODES)
            return BD_BAD_SHAPE;
        if (!(contact->c > 0.0) || !all_finite(at, BD_FILM_NODES) ||
            !all_finite(rise, BD_FILM_NODES) || !nonnegative(at, BD_FILM_NODES) || at[0] != 0.0 ||
            rise[0] != 0.0)
            return BD_BAD_VALUE;
    }
    if (contact->law == BD_DAMPING_CARRIED) {
        const double *numbers = contact->n_echoes > 0 ? contact->echoes->decay : NULL;
        if (contact->n_echoes < 1)
            return BD_BAD_SHAPE;
        if (!all_finite(numbers, (size_t)contact->n_echoes * sizeof(bd_echo) / sizeof(double)) ||
            !fades_to_damping(contact))
            return BD_BAD_VALUE;
    }
    return BD_OK;
}

#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)

bd_fault bd_scheme_fault(const bd_scheme *scheme)
{
    const bd_speed *speed = &scheme->speed;
    if (!(scheme->dt > 0.0) || !isfinite(scheme->dt))
        return (bd_fault){"dt", "a positive, finite step"};
    if (!(scheme->beta >= 0.0) || !isfinite(scheme->beta))
        return (bd_fault){"beta", "zero or positive, and finite"};
    if (!(scheme->gamma >= 0.0) || !isfinite(scheme->gamma))
        return (bd_fault){"gamma", "zero or positive, and finite"};
    if (!(scheme->tolerance > 0.0))
        return (bd_fault){"tolerance", "positive"};
    if (scheme->max_iterations < 1 || scheme->max_iterations > BD_ITERATIONS_LIMIT)
        return (bd_fault){"max_iterations",
                          "1 to " TEXT(BD_ITERATIONS_LIMIT) ", as a step cannot be interrupted"};
    if (speed->n < 1 || !all_finite(speed->time, (size_t)speed->n) ||
        !increasing(speed->time, speed->n))
        return (bd_fault){"times", "one or more finite times, each later than the one before"};
    if (!all_finite(speed->value, (size_t)speed->n))
        return (bd_fault){"speeds", "finite"};
    if (!isfinite(speed->time[0] * speed->value[0]))
        return (bd_fault){"times", "a first time to which the shaft's angle is a finite number"};
    if (!bd_isa_available(scheme->isa))
        return (bd_fault){"isa",
                          "an instruction set that this machine and build have; \"best\" is"};
    return (bd_fault){NULL, NULL};
}

static bool softening_valid(const bd_softening_data *law, int rank)
{
    const double above_zero[] = {law->D, law->gamma_c, law->m, law->gamma_l, law->p, law->memory};
    const int n = (int)(sizeof above_zero / sizeof above_zero[0]);
    for (int i = 0; i < n; i++)
        if (!(above_zero[i] > 0.0) || !isfinite(above_zero[i]))
            return false;
    return law->Lm >= 0.0 && isfinite(law->Lm) && isfinite(law->pressed) && law->n_table >= 0 &&
           all_finite(law->strain, (size_t)rank) && nonnegative(law->strain, rank) &&
           (law->n_table < 1 ||
            (law->rate_first > 0.0 && law->rate_last > law->rate_first &&
             isfinite(law->rate_last) && all_finite(law->table, 2 * (size_t)law->n_table) &&
             nonnegative(law->table, 2 * law->n_table)));
}

bd_status bd_model_check(const bd_model_data *data)
{
    size_t n = (size_t)data->n;
    if (data->n < 1 || data->n_layers < 0 || data->n_bearings < 0 || data->n_loads < 0 ||
        data->n_channels < 0)
        return BD_BAD_SHAPE;
    if (!all_finite(data->M, n * n) || !all_finite(data->C, n * n) || !all_finite(data->G, n * n) ||
        !all_finite(data->K, n * n) || !all_finite(data->N, n * n))
        return BD_BAD_VALUE;
    if (!mirrored(data->M, n, 1.0) || !mirrored(data->C, n, 1.0) || !mirrored(data->G, n, -1.0) ||
        !mirrored(data->K, n, 1.0) || !mirrored(data->N, n, -1.0))
        return BD_NOT_SYMMETRIC;
    for (int l = 0; l < data->n_layers; l++) {
        const bd_layer_data *layer = &data->layers[l];
        if (layer->rank < 1 || layer->n_branches < 0)
            return BD_BAD_SHAPE;
        if (!all_finite(layer->L, n * (size_t)layer->rank))
            return BD_BAD_VALUE;
        if (!all_finite(layer->tau, (size_t)layer->n_branches) ||
            !all_finite(layer->modulus, (size_t)layer->n_branches) ||
            !nonnegative(layer->modulus, layer->n_branches))
            return BD_BAD_VALUE;
        for (int i = 0; i < layer->n_branches; i++)
            if (!(layer->tau[i] > 0.0))
                return BD_BAD_VALUE;
        if (layer->softening && !softening_valid(layer->softening, layer->rank))
            return BD_BAD_VALUE;
    }
    for (int b = 0; b < data->n_bearings; b++) {
        bd_status status = bd_bearing_check(&data->bearings[b]);
        if (status != BD_OK)
            return status;
        if (!all_finite(data->B[b], n * (size_t)data->bearings[b].n_coefs))
            return BD_BAD_VALUE;
    }
    for (int k = 0; k < data->n_loads; k++) {
        const bd_load_data *load = &data->loads[k];
        bool turning = load->kind == BD_LOAD_HARMONIC || load->kind == BD_LOAD_ROTATING;
        if (!all_finite(load->p_cos, n) || (turning && !all_finite(load->p_sin, n)) ||
            !isfinite(load->omega))
            return BD_BAD_VALUE;
        if (load->kind == BD_LOAD_SAMPLED) {
            if (load->n_samples < 1)
                return BD_BAD_SHAPE;
            if (!all_finite(load->value, (size_t)load->n_samples) ||
                !all_finite(load->time, (size_t)load->n_samples) ||
                !increasing(load->time, load->n_samples))
                return BD_BAD_VALUE;
        }
    }
    for (int c = 0; c < data->n_channels; c++) {
        const bd_channel_data *channel = &data->channels[c];
        if (channel->kind <= BD_CHANNEL_ACCELERATION) {
            if (!all_finite(channel->row, n))
                return BD_BAD_VALUE;
            continue;
        }
        if (channel->kind == BD_CHANNEL_BRANCH_LOSS || channel->kind == BD_CHANNEL_STRAIN) {
            if (channel->index < 0 || channel->index >= data->n_layers)
                return BD_BAD_VALUE;
            continue;
        }
        if (channel->bearing < 0 || channel->bearing >= data->n_bearings || channel->index < 0)
            return BD_BAD_VALUE;
        const bd_bearing_data *bearing = &data->bearings[channel->bearing];
        if ((channel->kind == BD_CHANNEL_FORCE && channel->index >= bearing->n_coefs) ||
            (channel->kind == BD_CHANNEL_BALL && channel->index >= bearing->n_balls))
            return BD_BAD_VALUE;
    }
    return BD_OK;
}
