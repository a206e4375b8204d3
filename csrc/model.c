#include "model.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

const char *bd_status_text(bd_status status)
{
#define BD_STATUS_TEXT(name, value, text)                                                          \
    case name:                                                                                     \
        return text;
    switch (status) {
        BD_STATUS_LIST(BD_STATUS_TEXT)
    }
#undef BD_STATUS_TEXT
    return "unknown status";
}

/* ---------------------------------------------------------------- blocks */

static int root_of(int *parent, int i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

static void join(int *parent, int i, int j)
{
    int a = root_of(parent, i), b = root_of(parent, j);
    if (a < b)
        parent[b] = a;
    else
        parent[a] = b;
}

/* parent[i] becomes the lowest coordinate that the linear structure couples with i. */
static void find_blocks(const bd_model_data *data, int *parent)
{
    size_t n = (size_t)data->n;
    for (int i = 0; i < data->n; i++)
        parent[i] = i;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            size_t ij = i * n + j;
            if (data->M[ij] != 0.0 || data->C[ij] != 0.0 || data->G[ij] != 0.0 ||
                data->K[ij] != 0.0 || data->N[ij] != 0.0)
                join(parent, (int)i, (int)j);
        }
    for (int l = 0; l < data->n_layers; l++) {
        const bd_layer_data *layer = &data->layers[l];
        int first = -1;
        for (int i = 0; i < data->n; i++)
            for (int r = 0; r < layer->rank; r++)
                if (layer->L[(size_t)i * (size_t)layer->rank + (size_t)r] != 0.0) {
                    if (first < 0)
                        first = i;
                    join(parent, first, i);
                }
    }
    for (int i = 0; i < data->n; i++)
        parent[i] = root_of(parent, i);
}

/* ---------------------------------------------------------------- one slab */

/* Carves aligned pieces; with base NULL it only counts, so that one layout routine does both. */
typedef struct arena {
    unsigned char *base;
    size_t used;
} arena;

enum { ALIGNMENT = 64 };

static void *carve(arena *a, size_t count, size_t size)
{
    void *piece = a->base ? a->base + a->used : NULL;
    a->used += (count * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    return piece;
}

static double *carve_doubles(arena *a, size_t count)
{
    return carve(a, count, sizeof(double));
}

static double *copy_doubles(arena *a, size_t count, const double *from)
{
    double *to = carve_doubles(a, count);
    if (to && count > 0)
        memcpy(to, from, count * sizeof *to);
    return to;
}

/* A vector (n) of the caller, padded and in block order. */
static double *copy_vector(arena *a, const bd_model *model, const double *from)
{
    double *to = carve_doubles(a, (size_t)model->n_padded);
    if (to && from)
        for (int i = 0; i < model->n; i++)
            to[model->slot[i]] = from[i];
    return to;
}

/* The caller's (n x n) matrix, block by block. */
static const double *copy_matrix(arena *a, const bd_model *model, size_t total, const double *from)
{
    double *to = carve_doubles(a, total);
    if (to)
        for (int b = 0; b < model->n_blocks; b++) {
            const bd_block *block = &model->blocks[b];
            const int *index = model->order + block->first;
            for (int i = 0; i < block->n; i++)
                for (int j = 0; j < block->n; j++)
                    to[block->matrix + (size_t)i * (size_t)block->n + (size_t)j] =
                        from[(size_t)index[i] * (size_t)model->n + (size_t)index[j]];
        }
    return to;
}

/* Which coordinates lie in which block, and where: returns the doubles of one block matrix. */
static size_t layout_blocks(arena *a, bd_model *model, const int *parent)
{
    size_t n = (size_t)model->n, total = 0;
    int *order = carve(a, n, sizeof *order), *slot = carve(a, n, sizeof *slot);
    bd_block *blocks = carve(a, n, sizeof *blocks);
    int place = 0;

    model->n_blocks = 0;
    model->n_padded = 0;
    for (int lead = 0; lead < model->n; lead++) {
        if (parent[lead] != lead)
            continue;
        bd_block block = {.first = place, .offset = model->n_padded, .matrix = total};
        for (int i = lead; i < model->n; i++) {
            if (parent[i] != lead)
                continue;
            if (order) {
                order[place] = i;
                slot[i] = block.offset + block.n;
            }
            place++;
            block.n++;
        }
        block.padded = BD_PADDED(block.n);
        total += (size_t)block.n * (size_t)block.n;
        model->n_padded += block.padded;
        if (blocks)
            blocks[model->n_blocks] = block;
        model->n_blocks++;
    }
    model->order = order;
    model->slot = slot;
    model->blocks = blocks;
    return total;
}

static void layout_layers(arena *a, bd_model *model, const bd_model_data *data, const int *parent)
{
    bd_layer *layers = carve(a, (size_t)data->n_layers, sizeof *layers);
    bd_block *blocks = (bd_block *)(uintptr_t)model->blocks;
    int place = 0;

    model->n_layers = data->n_layers;
    model->ranks = 0;
    model->n_stress = 0;
    for (int b = 0; b < model->n_blocks; b++) {
        int lead = blocks ? model->order[blocks[b].first] : -1, first = place;
        for (int l = 0; l < data->n_layers; l++) {
            const bd_layer_data *from = &data->layers[l];
            /* while counting nothing is known of blocks: each layer is counted with the first */
            int home = 0;
            if (blocks) {
                home = -1;
                for (int i = 0; i < data->n && home < 0; i++)
                    for (int r = 0; r < from->rank; r++)
                        if (from->L[(size_t)i * (size_t)from->rank + (size_t)r] != 0.0) {
                            home = parent[i];
                            break;
                        }
                if (home < 0)
                    home = model->order[blocks[0].first]; /* a layer that does nothing */
            }
            if (blocks ? home != lead : b != 0)
                continue;
            int rows = blocks ? blocks[b].n : data->n, padded = BD_PADDED(from->rank);
            double *L = carve_doubles(a, (size_t)rows * (size_t)padded);
            double *modulus = copy_doubles(a, (size_t)from->n_branches, from->modulus);
            double *tau = copy_doubles(a, (size_t)from->n_branches, from->tau);
            if (blocks) {
                for (int j = 0; j < rows; j++)
                    memcpy(L + (size_t)j * (size_t)padded,
                           from->L + (size_t)model->order[blocks[b].first + j] * (size_t)from->rank,
                           (size_t)from->rank * sizeof *L);
                layers[place] = (bd_layer){
                    .source = l,
                    .block = b,
                    .rank = from->rank,
                    .padded = padded,
                    .offset = model->ranks,
                    .n_branches = from->n_branches,
                    .stress = model->n_stress,
                    .L = L,
                    .modulus = modulus,
                    .tau = tau,
                };
            }
            place++;
            model->ranks += padded;
            model->n_stress += (size_t)padded * (size_t)from->n_branches;
        }
        if (blocks) {
            blocks[b].layer = first;
            blocks[b].n_layers = place - first;
        }
    }
    model->layers = layers;
}

static void layout_bearings(arena *a, bd_model *model, const bd_model_data *data)
{
    bd_bearing *bearings = carve(a, (size_t)data->n_bearings, sizeof *bearings);
    int *bearing_slot = carve(a, (size_t)data->n_bearings, sizeof *bearing_slot);
    int place = 0;

    model->n_bearings = data->n_bearings;
    model->n_coefs = 0;
    model->coefs = 0;
    for (int b = 0; b < data->n_bearings; b++) {
        model->n_coefs += data->bearings[b].n_coefs;
        if (bearing_slot)
            bearing_slot[b] = model->coefs;
        model->coefs += BD_PADDED(data->bearings[b].n_coefs);
    }
    int *coef_slot = carve(a, (size_t)model->n_coefs, sizeof *coef_slot);
    double *B = carve_doubles(a, (size_t)model->n_padded * (size_t)model->coefs);
    /* blocks are as many as coordinates at most, which is all that is known while counting */
    int *touched = carve(a, (size_t)data->n_bearings * (size_t)data->n, sizeof *touched);

    for (int b = 0; b < data->n_bearings; b++) {
        bd_bearing_data own = data->bearings[b];
        size_t n_coefs = (size_t)own.n_coefs;
        int *order = carve(a, n_coefs, sizeof *order), *sine = carve(a, n_coefs, sizeof *sine);
        double *constants = carve_doubles(a, bd_bearing_constants(&own));
        size_t n_table = own.contact.law == BD_DAMPING_TABLE ? (size_t)own.contact.n_table : 0;
        double *table_delta = copy_doubles(a, n_table, own.contact.table_delta);
        double *table_c = copy_doubles(a, n_table, own.contact.table_c);
        bd_wave *waves = carve(a, (size_t)own.n_waves, sizeof *waves);
        bd_pit *pits = carve(a, (size_t)own.n_pits, sizeof *pits);
        double *oversize = copy_doubles(a, own.oversize ? (size_t)own.n_balls : 0, own.oversize);
        if (!bearings)
            continue;
        memcpy(order, own.order, n_coefs * sizeof *order);
        memcpy(sine, own.sine, n_coefs * sizeof *sine);
        if (own.n_waves > 0)
            memcpy(waves, own.waves, (size_t)own.n_waves * sizeof *waves);
        if (own.n_pits > 0)
            memcpy(pits, own.pits, (size_t)own.n_pits * sizeof *pits);
        own.waves = waves;
        own.pits = pits;
        own.oversize = own.oversize ? oversize : NULL;
        own.order = order;
        own.sine = sine;
        own.contact.table_delta = table_delta;
        own.contact.table_c = table_c;
        bd_bearing_setup(&bearings[b], &own, constants);
        for (int k = 0; k < own.n_coefs; k++) {
            coef_slot[place++] = bearing_slot[b] + k;
            for (int i = 0; i < data->n; i++)
                B[(size_t)model->slot[i] * (size_t)model->coefs + (size_t)(bearing_slot[b] + k)] =
                    data->B[b][(size_t)k * (size_t)data->n + (size_t)i];
        }
    }
    for (int b = 0; bearings && b < data->n_bearings; b++)
        for (int c = 0; c < model->n_blocks; c++)
            for (int i = 0; i < model->blocks[c].n; i++)
                for (int k = 0; k < bearings[b].data.n_coefs; k++)
                    if (B[(size_t)(model->blocks[c].offset + i) * (size_t)model->coefs +
                          (size_t)(bearing_slot[b] + k)] != 0.0)
                        touched[b * model->n_blocks + c] = 1;
    model->touched = touched;
    model->bearings = bearings;
    model->bearing_slot = bearing_slot;
    model->coef_slot = coef_slot;
    model->B = B;
}

static void layout_loads(arena *a, bd_model *model, const bd_model_data *data)
{
    bd_load *loads = carve(a, (size_t)data->n_loads, sizeof *loads);
    model->n_loads = data->n_loads;
    for (int k = 0; k < data->n_loads; k++) {
        const bd_load_data *from = &data->loads[k];
        bool turning = from->kind == BD_LOAD_HARMONIC || from->kind == BD_LOAD_ROTATING;
        size_t samples = from->kind == BD_LOAD_SAMPLED ? (size_t)from->n_samples : 0;
        bd_load load = {
            .kind = from->kind,
            .omega = from->omega,
            .n_samples = (int)samples,
            .p_cos = copy_vector(a, model, from->p_cos),
            .p_sin = copy_vector(a, model, turning ? from->p_sin : NULL),
            .time = copy_doubles(a, samples, from->time),
            .value = copy_doubles(a, samples, from->value),
        };
        if (loads)
            loads[k] = load;
    }
    model->loads = loads;
}

static void layout_channels(arena *a, bd_model *model, const bd_model_data *data)
{
    bd_channel *channels = carve(a, (size_t)data->n_channels, sizeof *channels);
    model->n_channels = data->n_channels;
    for (int c = 0; c < data->n_channels; c++) {
        const bd_channel_data *from = &data->channels[c];
        bool linear = from->kind <= BD_CHANNEL_ACCELERATION;
        bd_channel channel = {
            .kind = from->kind,
            .bearing = linear ? -1 : from->bearing,
            .index = from->index,
            .row = linear ? copy_vector(a, model, from->row) : NULL,
        };
        if (channels)
            channels[c] = channel;
    }
    model->channels = channels;
}

/* One routine lays a model out, first to count (a.base NULL), then to fill. */
static bd_model *layout(arena *a, const bd_model_data *data, const int *parent)
{
    bd_model counting = {0}, *in_slab = carve(a, 1, sizeof *in_slab);
    bd_model *model = in_slab ? in_slab : &counting;

    model->n = data->n;
    size_t total = layout_blocks(a, model, parent);
    layout_layers(a, model, data, parent);
    layout_bearings(a, model, data);
    layout_loads(a, model, data);
    layout_channels(a, model, data);
    /* while counting, nothing is known of blocks: the whole matrix bounds them */
    if (!in_slab)
        total = (size_t)data->n * (size_t)data->n;
    model->M = copy_matrix(a, model, total, data->M);
    model->C = copy_matrix(a, model, total, data->C);
    model->G = copy_matrix(a, model, total, data->G);
    model->K = copy_matrix(a, model, total, data->K);
    model->N = copy_matrix(a, model, total, data->N);
    return in_slab;
}

bd_model *bd_model_create(const bd_model_data *data, bd_status *status)
{
    *status = bd_model_check(data);
    if (*status != BD_OK)
        return NULL;

    int *parent = malloc((size_t)data->n * sizeof *parent);
    if (!parent) {
        *status = BD_NO_MEMORY;
        return NULL;
    }
    find_blocks(data, parent);

    arena a = {.base = NULL};
    layout(&a, data, parent);
    size_t size = a.used;
    a.base = aligned_alloc(ALIGNMENT, size);
    a.used = 0;
    bd_model *model = NULL;
    if (a.base) {
        memset(a.base, 0, size);
        model = layout(&a, data, parent);
    } else {
        *status = BD_NO_MEMORY;
    }
    free(parent);
    return model;
}

void bd_model_free(bd_model *model)
{
    free(model);
}

int bd_model_blocks(const bd_model *model)
{
    return model->n_blocks;
}

int bd_model_channels(const bd_model *model)
{
    return model->n_channels;
}

int bd_model_coefs(const bd_model *model)
{
    return model->n_coefs;
}

int bd_model_layers(const bd_model *model)
{
    return model->n_layers;
}

int bd_model_size(const bd_model *model)
{
    return model->n;
}
