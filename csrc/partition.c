/* Which coordinates the linear structure couples, and in which order a model keeps them.
 *
 * A layer joins all that it moves with into one block, since its stresses are one list; where the columns of its
 * factor couple less, as the orders of a ring do not, the block falls into bands, which products take one by one. */
#include "partition.h"

#include <stdbool.h>
#include <stdlib.h>

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

static void take_roots(int n, int *parent)
{
    for (int i = 0; i < n; i++)
        parent[i] = root_of(parent, i);
}

/* The first coordinate that a layer moves with, or -1. */
static int first_touched(const bd_model_data *data, const bd_layer_data *layer)
{
    const size_t rank = (size_t)layer->rank;
    for (size_t i = 0; i < (size_t)data->n; i++)
        for (size_t r = 0; r < rank; r++)
            if (layer->L[i * rank + r] != 0.0)
                return (int)i;
    return -1;
}

/* parent[i] becomes the lowest coordinate that matrices, or a column of a layer's factor, couple with i. */
static void find_leads(const bd_model_data *data, int *parent)
{
    const size_t n = (size_t)data->n;
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
        for (int r = 0; r < layer->rank; r++)
            for (int i = 0, before = -1; i < data->n; i++)
                if (layer->L[(size_t)i * (size_t)layer->rank + (size_t)r] != 0.0) {
                    if (before >= 0)
                        join(parent, before, i);
                    before = i;
                }
    }
    take_roots(data->n, parent);
}

/* The same with all coordinates of a layer together, from the finer ones. */
static void join_layers(const bd_model_data *data, const int *fine, int *parent)
{
    for (int i = 0; i < data->n; i++)
        parent[i] = fine[i];
    for (int l = 0; l < data->n_layers; l++) {
        const bd_layer_data *layer = &data->layers[l];
        const size_t rank = (size_t)layer->rank;
        const int first = first_touched(data, layer);
        for (size_t i = 0; first >= 0 && i < (size_t)data->n; i++)
            for (size_t r = 0; r < rank; r++)
                if (layer->L[i * rank + r] != 0.0)
                    join(parent, first, (int)i);
    }
    take_roots(data->n, parent);
}

bd_span bd_span_of(int first, int n, int padded)
{
    const int rows = BD_PADDED(n);
    return (bd_span){
        .first = first, .n = n, .row = first + rows > padded ? padded - rows : first, .rows = rows};
}

/* A block's coordinates band by band; bands that fit together into one set of lanes are one, since a product of a few
 * rows costs as much as one of many. Returned: the next free place in parts->order. */
static int place_bands(bd_partition *parts, const bd_model_data *data, bd_block *block,
                       const int *fine, const int *lead_of, int lead)
{
    int place = block->first, begin = 0; /* of the band that is being filled, in the block */
    for (int band = lead; band < data->n; band++) {
        if (fine[band] != band || lead_of[band] != lead)
            continue;
        const int before = place - block->first;
        for (int i = band; i < data->n; i++)
            if (fine[i] == band) {
                parts->slot[i] = block->offset + place - block->first;
                parts->order[place++] = i;
            }
        if (before > begin && place - block->first - begin > BD_LANES) {
            parts->bands[parts->n_bands++] = (bd_span){.first = begin, .n = before - begin};
            begin = before;
        }
    }
    block->n = place - block->first;
    block->padded = BD_PADDED(block->n);
    parts->bands[parts->n_bands++] = (bd_span){.first = begin, .n = block->n - begin};
    return place;
}

/* The blocks of coordinates, in the order of their lowest ones. */
static void place_coordinates(bd_partition *parts, const bd_model_data *data, const int *fine,
                              const int *lead_of)
{
    int place = 0;
    for (int lead = 0; lead < data->n; lead++) {
        if (lead_of[lead] != lead)
            continue;
        bd_block block = {.first = place,
                          .offset = parts->n_padded,
                          .matrix = parts->squares,
                          .band = parts->n_bands};
        place = place_bands(parts, data, &block, fine, lead_of, lead);
        block.n_bands = parts->n_bands - block.band;
        for (int i = block.band; i < parts->n_bands; i++)
            parts->bands[i] = bd_span_of(parts->bands[i].first, parts->bands[i].n, block.padded);
        parts->largest = block.n > parts->largest ? block.n : parts->largest;
        parts->squares += (size_t)block.n * (size_t)block.n;
        parts->n_padded += block.padded;
        parts->blocks[parts->n_blocks++] = block;
    }
}

/* The layers of each block, in the caller's order. */
static void place_layers(bd_partition *parts, const bd_model_data *data, const int *lead_of,
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
            if (lead_of_layer[l] == lead_of[parts->order[block->first]])
                parts->source[place++] = l;
        block->n_layers = place - block->layer;
    }
}

bool bd_partition_create(const bd_model_data *data, bd_partition *parts)
{
    const size_t n = (size_t)data->n, n_layers = (size_t)data->n_layers;
    *parts = (bd_partition){.memory = malloc(n * (sizeof(bd_block) + sizeof(bd_span)) +
                                             (4 * n + 2 * n_layers) * sizeof(int))};
    if (!parts->memory)
        return false;
    parts->blocks = parts->memory;
    parts->bands = (bd_span *)(parts->blocks + n);
    parts->order = (int *)(parts->bands + n);
    parts->slot = parts->order + n;
    parts->source = parts->slot + n;
    int *fine = parts->source + n_layers, *lead_of = fine + n, *lead_of_layer = lead_of + n;

    find_leads(data, fine);
    join_layers(data, fine, lead_of);
    place_coordinates(parts, data, fine, lead_of);
    place_layers(parts, data, lead_of, lead_of_layer);
    return true;
}
