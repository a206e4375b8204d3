#include "model.h"

#include <stdbool.h>
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

/* ---------------------------------------------------------------- partition */

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

/* Whether a layer moves with a coordinate. */
static bool touches(const bd_layer_data *layer, int i)
{
    const double *row = layer->L + (size_t)i * (size_t)layer->rank;
    for (int r = 0; r < layer->rank; r++)
        if (row[r] != 0.0)
            return true;
    return false;
}

/* The first coordinate that a layer moves with, or -1. */
static int first_touched(const bd_model_data *data, const bd_layer_data *layer)
{
    for (int i = 0; i < data->n; i++)
        if (touches(layer, i))
            return i;
    return -1;
}

/* parent[i] becomes the lowest coordinate that the linear structure couples with i. */
static void find_leads(const bd_model_data *data, int *parent)
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
        const int first = first_touched(data, layer);
        for (int i = first; first >= 0 && i < data->n; i++)
            if (touches(layer, i))
                join(parent, first, i);
    }
    for (int i = 0; i < data->n; i++)
        parent[i] = root_of(parent, i);
}

/* Which coordinates and layers lie in which block, and where: all that the layout of a model depends on. */
typedef struct partition {
    int n_blocks, n_padded, largest;
    size_t squares;    /* doubles of one matrix, block by block */
    int *order, *slot; /* (n) as in bd_model */
    bd_block *blocks;  /* (n_blocks) */
    int *source;       /* (n_layers) the caller's index of a layer in block order */
    void *memory;
} partition;

/* The blocks of coordinates, in the order of their lowest ones. */
static void place_coordinates(partition *parts, const bd_model_data *data, const int *lead_of)
{
    int place = 0;
    for (int lead = 0; lead < data->n; lead++) {
        if (lead_of[lead] != lead)
            continue;
        bd_block block = {.first = place, .offset = parts->n_padded, .matrix = parts->squares};
        for (int i = lead; i < data->n; i++)
            if (lead_of[i] == lead) {
                parts->order[place++] = i;
                parts->slot[i] = block.offset + block.n++;
            }
        block.padded = BD_PADDED(block.n);
        parts->largest = block.n > parts->largest ? block.n : parts->largest;
        parts->squares += (size_t)block.n * (size_t)block.n;
        parts->n_padded += block.padded;
        parts->blocks[parts->n_blocks++] = block;
    }
}

/* The layers of each block, in the caller's order. */
static void place_layers(partition *parts, const bd_model_data *data, const int *lead_of,
                         int *lead_of_layer)
{
    int place = 0;
    for (int l = 0; l < data->n_layers; l++) {
        const int first = first_touched(data, &data->layers[l]);
        lead_of_layer[l] =
            first < 0 ? 0 : lead_of[first]; /* one that does nothing lies in the first */
    }
    for (int b = 0; b < parts->n_blocks; b++) {
        bd_block *block = &parts->blocks[b];
        block->layer = place;
        for (int l = 0; l < data->n_layers; l++)
            if (lead_of_layer[l] == parts->order[block->first])
                parts->source[place++] = l;
        block->n_layers = place - block->layer;
    }
}

/* Returned: whether there was memory; parts->memory is to be freed. */
static bool find_partition(const bd_model_data *data, partition *parts)
{
    const size_t n = (size_t)data->n, n_layers = (size_t)data->n_layers;
    *parts =
        (partition){.memory = malloc(n * sizeof(bd_block) + (3 * n + 2 * n_layers) * sizeof(int))};
    if (!parts->memory)
        return false;
    parts->blocks = parts->memory;
    parts->order = (int *)(parts->blocks + n);
    parts->slot = parts->order + n;
    parts->source = parts->slot + n;
    int *lead_of = parts->source + n_layers, *lead_of_layer = lead_of + n;

    find_leads(data, lead_of);
    place_coordinates(parts, data, lead_of);
    place_layers(parts, data, lead_of, lead_of_layer);
    return true;
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

/* A copy; where `from` is NULL the piece stays zero. */
static void *copy(arena *a, const void *from, size_t count, size_t size)
{
    void *to = carve(a, count, size);
    if (to && from && count > 0)
        memcpy(to, from, count * size);
    return to;
}

static double *copy_doubles(arena *a, const double *from, size_t count)
{
    return copy(a, from, count, sizeof *from);
}

/* A vector (n) of the caller, padded and in block order; NULL is a vector of zeros. */
static double *copy_vector(arena *a, const bd_model *model, const double *from)
{
    double *to = carve(a, (size_t)model->n_padded, sizeof *to);
    if (to && from)
        for (int i = 0; i < model->n; i++)
            to[model->slot[i]] = from[i];
    return to;
}

/* The caller's (n x n) matrix, block by block. */
static double *copy_matrix(arena *a, const bd_model *model, const partition *parts,
                           const double *from)
{
    double *matrix = carve(a, parts->squares, sizeof *matrix), *to = matrix;
    for (int b = 0; matrix && b < parts->n_blocks; b++) {
        const int *index = parts->order + parts->blocks[b].first, n = parts->blocks[b].n;
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++)
                *to++ = from[(size_t)index[i] * (size_t)model->n + (size_t)index[j]];
    }
    return matrix;
}

/* A block's rows of a layer's factor, each padded. */
static double *copy_factor(arena *a, const partition *parts, const bd_block *block,
                           const bd_layer_data *from)
{
    const size_t rank = (size_t)from->rank, padded = (size_t)BD_PADDED(from->rank);
    double *L = carve(a, (size_t)block->n * padded, sizeof *L);
    for (int j = 0; L && j < block->n; j++)
        memcpy(L + (size_t)j * padded, from->L + (size_t)parts->order[block->first + j] * rank,
               rank * sizeof *L);
    return L;
}

size_t bd_softening_size(const bd_layer *layer)
{
    return layer->softening ? (size_t)layer->padded + (size_t)BD_PADDED(BD_SOFTENING_NUMBERS) : 0;
}

/* A law with arrays of its own, or NULL. */
static const bd_softening_data *copy_softening(arena *a, const bd_layer_data *from)
{
    if (!from->softening)
        return NULL;
    bd_softening_data *own = copy(a, from->softening, 1, sizeof *own);
    const double *strain = copy_doubles(a, from->softening->strain, (size_t)from->rank);
    const double *table =
        copy_doubles(a, from->softening->table, 2 * (size_t)from->softening->n_table);
    if (own) {
        own->strain = strain;
        own->table = table;
    }
    /* while only counting there is no copy yet, but there will be one */
    return own ? own : from->softening;
}

static void layout_layers(arena *a, bd_model *model, const bd_model_data *data,
                          const partition *parts)
{
    bd_layer *layers = carve(a, (size_t)data->n_layers, sizeof *layers);
    for (int b = 0; b < parts->n_blocks; b++) {
        const bd_block *block = &parts->blocks[b];
        for (int l = block->layer; l < block->layer + block->n_layers; l++) {
            const bd_layer_data *from = &data->layers[parts->source[l]];
            const bd_layer layer = {
                .source = parts->source[l],
                .block = b,
                .rank = from->rank,
                .padded = BD_PADDED(from->rank),
                .offset = model->ranks,
                .branch = model->branches,
                .n_branches = from->n_branches,
                .n_stresses = from->n_branches + (from->softening ? 3 : 0),
                .memory = model->n_softening_doubles,
                .softening = copy_softening(a, from),
                .stress = model->n_stress,
                .L = copy_factor(a, parts, block, from),
                .modulus = copy_doubles(a, from->modulus, (size_t)from->n_branches),
                .tau = copy_doubles(a, from->tau, (size_t)from->n_branches),
            };
            if (layers)
                layers[l] = layer;
            model->ranks += layer.padded;
            model->branches += layer.n_stresses;
            model->n_stress += (size_t)layer.padded * (size_t)layer.n_stresses;
            model->n_softening += layer.softening != NULL;
            model->n_softening_doubles += bd_softening_size(&layer);
        }
    }
    model->n_layers = data->n_layers;
    model->layers = layers;
}

/* A bearing's description with arrays of its own. */
static bd_bearing_data copy_bearing(arena *a, const bd_bearing_data *from)
{
    const size_t n_coefs = (size_t)from->n_coefs;
    const bd_contact *contact = &from->contact;
    const bool tabled = contact->law == BD_DAMPING_TABLE || bd_has_film(contact);
    const size_t n_table = tabled ? (size_t)contact->n_table : 0;
    bd_bearing_data own = *from;
    own.order = copy(a, from->order, n_coefs, sizeof *from->order);
    own.sine = copy(a, from->sine, n_coefs, sizeof *from->sine);
    own.contact.table_delta = copy_doubles(a, contact->table_delta, n_table);
    own.contact.table_c = copy_doubles(a, contact->table_c, n_table);
    own.contact.n_echoes = contact->law == BD_DAMPING_CARRIED ? contact->n_echoes : 0;
    own.contact.echoes =
        copy(a, contact->echoes, (size_t)own.contact.n_echoes, sizeof *contact->echoes);
    own.waves = copy(a, from->waves, (size_t)from->n_waves, sizeof *from->waves);
    own.pits = copy(a, from->pits, (size_t)from->n_pits, sizeof *from->pits);
    if (from->oversize)
        own.oversize = copy_doubles(a, from->oversize, (size_t)from->n_balls);
    return own;
}

/* Where a bearing's coefficients go, and its columns of B. */
static void fill_coefs(const bd_model *model, const double *rows, int slot, int n_coefs,
                       int *coef_slot, double *B)
{
    for (int k = 0; k < n_coefs; k++) {
        coef_slot[k] = slot + k;
        for (int i = 0; i < model->n; i++)
            B[(size_t)model->slot[i] * (size_t)model->coefs + (size_t)(slot + k)] =
                rows[(size_t)k * (size_t)model->n + (size_t)i];
    }
}

/* Whether any coordinate of a block is among those that n_coefs columns of B, from `slot` on, read. */
static bool sees(const bd_model *model, int slot, int n_coefs, const bd_block *block)
{
    for (int i = block->offset; i < block->offset + block->n; i++)
        for (int k = slot; k < slot + n_coefs; k++)
            if (model->B[(size_t)i * (size_t)model->coefs + (size_t)k] != 0.0)
                return true;
    return false;
}

static void layout_bearings(arena *a, bd_model *model, const bd_model_data *data)
{
    const size_t n_bearings = (size_t)data->n_bearings;
    for (int b = 0; b < data->n_bearings; b++) {
        model->n_coefs += data->bearings[b].n_coefs;
        model->coefs += BD_PADDED(data->bearings[b].n_coefs);
    }
    bd_bearing *bearings = carve(a, n_bearings, sizeof *bearings);
    int *bearing_slot = carve(a, n_bearings, sizeof *bearing_slot);
    int *coef_slot = carve(a, (size_t)model->n_coefs, sizeof *coef_slot);
    int *touched = carve(a, n_bearings * (size_t)model->n_blocks, sizeof *touched);
    double *B = carve(a, (size_t)model->n_padded * (size_t)model->coefs, sizeof *B);
    model->n_bearings = data->n_bearings;
    model->bearings = bearings;
    model->bearing_slot = bearing_slot;
    model->coef_slot = coef_slot;
    model->touched = touched;
    model->B = B;

    int place = 0,
        slot = 0; /* of the bearing's first coefficient: as counted by the caller, padded */
    for (int b = 0; b < data->n_bearings; b++) {
        const bd_bearing_data own = copy_bearing(a, &data->bearings[b]);
        double *constants = carve(a, bd_bearing_constants(&own), sizeof *constants);
        if (bearings) {
            bd_bearing_setup(&bearings[b], &own, constants);
            bearings[b].echo = model->n_echo_doubles;
            bearings[b].weight = model->n_echoes;
            bearing_slot[b] = slot;
            fill_coefs(model, data->B[b], slot, own.n_coefs, coef_slot + place, B);
            for (int c = 0; c < model->n_blocks; c++)
                touched[b * model->n_blocks + c] =
                    sees(model, slot, own.n_coefs, &model->blocks[c]);
        }
        model->n_echoes += own.contact.n_echoes;
        model->n_echo_doubles += bd_echoes_size(&own);
        place += own.n_coefs;
        slot += BD_PADDED(own.n_coefs);
    }
}

static void layout_loads(arena *a, bd_model *model, const bd_model_data *data)
{
    bd_load *loads = carve(a, (size_t)data->n_loads, sizeof *loads);
    for (int k = 0; k < data->n_loads; k++) {
        const bd_load_data *from = &data->loads[k];
        const bool turning = from->kind == BD_LOAD_HARMONIC || from->kind == BD_LOAD_ROTATING;
        const size_t samples = from->kind == BD_LOAD_SAMPLED ? (size_t)from->n_samples : 0;
        const bd_load load = {
            .kind = from->kind,
            .omega = from->omega,
            .n_samples = (int)samples,
            .p_cos = copy_vector(a, model, from->p_cos),
            .p_sin = copy_vector(a, model, turning ? from->p_sin : NULL),
            .time = copy_doubles(a, from->time, samples),
            .value = copy_doubles(a, from->value, samples),
        };
        if (loads)
            loads[k] = load;
    }
    model->n_loads = data->n_loads;
    model->loads = loads;
}

/* Where the caller's layer lies among those of all blocks. */
static int place_of_layer(const bd_model *model, int source)
{
    int l = 0;
    while (model->layers && model->layers[l].source != source)
        l++;
    return l;
}

static void layout_channels(arena *a, bd_model *model, const bd_model_data *data)
{
    bd_channel *channels = carve(a, (size_t)data->n_channels, sizeof *channels);
    for (int c = 0; c < data->n_channels; c++) {
        const bd_channel_data *from = &data->channels[c];
        const bool linear = from->kind <= BD_CHANNEL_ACCELERATION;
        const bool of_layer =
            from->kind == BD_CHANNEL_BRANCH_LOSS || from->kind == BD_CHANNEL_STRAIN;
        const bd_channel channel = {
            .kind = from->kind,
            .bearing = linear ? -1 : from->bearing,
            .index = of_layer ? place_of_layer(model, from->index) : from->index,
            .row = linear ? copy_vector(a, model, from->row) : NULL,
        };
        if (channels)
            channels[c] = channel;
    }
    model->n_channels = data->n_channels;
    model->channels = channels;
}

/* One routine lays a model out, first to count (a->base NULL), then to fill. */
static bd_model *layout(arena *a, const bd_model_data *data, const partition *parts)
{
    const size_t n = (size_t)data->n;
    bd_model *in_slab = carve(a, 1, sizeof *in_slab);
    bd_model model = {
        .n = data->n,
        .n_padded = parts->n_padded,
        .n_blocks = parts->n_blocks,
        .largest = parts->largest,
        .order = copy(a, parts->order, n, sizeof *parts->order),
        .slot = copy(a, parts->slot, n, sizeof *parts->slot),
        .blocks = copy(a, parts->blocks, (size_t)parts->n_blocks, sizeof *parts->blocks),
    };
    layout_layers(a, &model, data, parts);
    layout_bearings(a, &model, data);
    layout_loads(a, &model, data);
    layout_channels(a, &model, data);
    model.matrices = (bd_matrices){
        .M = copy_matrix(a, &model, parts, data->M),
        .C = copy_matrix(a, &model, parts, data->C),
        .G = copy_matrix(a, &model, parts, data->G),
        .K = copy_matrix(a, &model, parts, data->K),
        .N = copy_matrix(a, &model, parts, data->N),
    };
    model.bytes = a->used;
    if (in_slab)
        *in_slab = model;
    return in_slab;
}

bd_model *bd_model_create(const bd_model_data *data, bd_status *status)
{
    partition parts;
    *status = bd_model_check(data);
    if (*status != BD_OK)
        return NULL;
    if (!find_partition(data, &parts)) {
        *status = BD_NO_MEMORY;
        return NULL;
    }

    arena a = {.base = NULL};
    layout(&a, data, &parts);
    const size_t size = a.used;
    a = (arena){.base = aligned_alloc(ALIGNMENT, size)};
    bd_model *model = NULL;
    if (a.base) {
        memset(a.base, 0, size);
        model = layout(&a, data, &parts);
    } else {
        *status = BD_NO_MEMORY;
    }
    free(parts.memory);
    return model;
}

void bd_model_free(bd_model *model)
{
    free(model);
}

/* ---------------------------------------------------------------- what it holds */

bd_matrices bd_matrices_of(const bd_model *model, const bd_block *block)
{
    const bd_matrices all = model->matrices;
    const size_t at = block->matrix;
    return (bd_matrices){all.M + at, all.C + at, all.G + at, all.K + at, all.N + at};
}

size_t bd_model_bytes(const bd_model *model)
{
    return model->bytes;
}

int bd_model_blocks(const bd_model *model)
{
    return model->n_blocks;
}

int bd_model_bearings(const bd_model *model)
{
    return model->n_bearings;
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

int bd_model_loads(const bd_model *model)
{
    return model->n_loads;
}

int bd_model_softening(const bd_model *model)
{
    return model->n_softening;
}

int bd_model_size(const bd_model *model)
{
    return model->n;
}
