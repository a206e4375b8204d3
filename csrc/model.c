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
static double *copy_matrix(arena *a, const bd_model *model, const bd_partition *parts,
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

/* The columns from the first to the last in which any of a band's rows (padded) of a matrix has an entry. */
static bd_span span_of_entries(const double *rows, const bd_span *band, int n, int padded)
{
    int first = n, end = 0;
    for (int j = band->first; j < band->first + band->n; j++)
        for (int k = 0; k < n; k++)
            if (rows[(size_t)j * (size_t)padded + (size_t)k] != 0.0) {
                first = k < first ? k : first;
                end = k + 1 > end ? k + 1 : end;
            }
    return end > first ? bd_span_of(first, end - first, padded) : (bd_span){0};
}

/* Of each band of coordinates, which rows of its lanes are its own; NULL for all of a block, whose padding is zero. */
static void layout_bands(arena *a, bd_model *model, const bd_partition *parts)
{
    const size_t n_bands = (size_t)parts->n_bands;
    const long long **inside = carve(a, n_bands, sizeof *inside);
    for (int b = 0; b < parts->n_blocks; b++) {
        const bd_block *block = &parts->blocks[b];
        for (int i = block->band; block->n_bands > 1 && i < block->band + block->n_bands; i++) {
            const bd_span *band = &parts->bands[i];
            long long *own = carve(a, (size_t)band->rows, sizeof *own);
            if (own) {
                inside[i] = own;
                memset(own + (band->first - band->row), 0xff, (size_t)band->n * sizeof *own);
            }
        }
    }
    model->n_bands = parts->n_bands;
    model->bands = copy(a, parts->bands, n_bands, sizeof *parts->bands);
    model->inside = inside;
}

/* Which rates of a layer each band of its block enters. */
static const bd_span *find_felt(arena *a, const bd_partition *parts, const bd_block *block,
                                const double *L, int rank)
{
    bd_span *felt = carve(a, (size_t)block->n_bands, sizeof *felt);
    for (int i = 0; felt && i < block->n_bands; i++)
        felt[i] = span_of_entries(L, &parts->bands[block->band + i], rank, BD_PADDED(rank));
    return felt;
}

/* A block's rows of a layer's factor, each padded. */
static double *copy_factor(arena *a, const bd_partition *parts, const bd_block *block,
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
                          const bd_partition *parts)
{
    bd_layer *layers = carve(a, (size_t)data->n_layers, sizeof *layers);
    for (int b = 0; b < parts->n_blocks; b++) {
        const bd_block *block = &parts->blocks[b];
        for (int l = block->layer; l < block->layer + block->n_layers; l++) {
            const bd_layer_data *from = &data->layers[parts->source[l]];
            const double *L = copy_factor(a, parts, block, from);
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
                .L = L,
                .felt = find_felt(a, parts, block, L, from->rank),
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

static bd_span moved_by(bd_span span, int offset)
{
    return (bd_span){span.first + offset, span.n, span.row + offset, span.rows};
}

/* Which coefficients of a bearing the motion of a band enters, from the caller's B (n_coefs x n). */
static bd_span span_of_coefficients(const bd_model_data *data, int bearing, const int *order, int n)
{
    const int n_coefs = data->bearings[bearing].n_coefs;
    int first = n_coefs, end = 0;
    for (int k = 0; k < n_coefs; k++)
        for (int j = 0; j < n; j++)
            if (data->B[bearing][(size_t)k * (size_t)data->n + (size_t)order[j]] != 0.0) {
                first = k < first ? k : first;
                end = k + 1;
            }
    return end > first ? bd_span_of(first, end - first, BD_PADDED(n_coefs)) : (bd_span){0};
}

/* Of each bearing the bands that it sees; the piece is counted to the last one. */
static void layout_sights(arena *a, bd_model *model, const bd_model_data *data,
                          const bd_partition *parts)
{
    int *sight = carve(a, (size_t)data->n_bearings + 1, sizeof *sight);
    bd_sight *sights = carve(a, 0, sizeof *sights);
    int n = 0, slot = 0;
    for (int b = 0; b < data->n_bearings; b++) {
        if (sight)
            sight[b] = n;
        for (int c = 0; c < parts->n_blocks; c++) {
            const bd_block *block = &parts->blocks[c];
            for (int i = block->band; i < block->band + block->n_bands; i++) {
                const bd_span band = parts->bands[i];
                const bd_span seen =
                    span_of_coefficients(data, b, parts->order + block->first + band.first, band.n);
                if (seen.n > 0 && sights)
                    sights[n] = (bd_sight){i, moved_by(band, block->offset), moved_by(seen, slot)};
                n += seen.n > 0;
            }
        }
        slot += BD_PADDED(data->bearings[b].n_coefs);
    }
    carve(a, (size_t)n, sizeof *sights);
    if (sight)
        sight[data->n_bearings] = n;
    model->sights = sights;
    model->sight = sight;
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
    double *B = carve(a, (size_t)model->n_padded * (size_t)model->coefs, sizeof *B);
    model->n_bearings = data->n_bearings;
    model->bearings = bearings;
    model->bearing_slot = bearing_slot;
    model->coef_slot = coef_slot;
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
static bd_model *layout(arena *a, const bd_model_data *data, const bd_partition *parts)
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
    layout_bands(a, &model, parts);
    layout_layers(a, &model, data, parts);
    layout_bearings(a, &model, data);
    layout_sights(a, &model, data, parts);
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
    bd_partition parts;
    *status = bd_model_check(data);
    if (*status != BD_OK)
        return NULL;
    if (!bd_partition_create(data, &parts)) {
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
