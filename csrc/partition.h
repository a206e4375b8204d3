/* partition.h - inside the core: which coordinates the linear structure couples, and where a model keeps them. */
#ifndef BD_PARTITION_H
#define BD_PARTITION_H

#include "bearingdyn.h"

/* A run of indices of a padded vector, as the columns and as the rows of products. */
typedef struct bd_span {
    int first, n;  /* indices first ... first + n; n is 0 where there are none */
    int row, rows; /* whole lanes of the vector, with them all */
} bd_span;

/* Coordinates that the linear structure or a layer joins. */
typedef struct bd_block {
    int n, padded;       /* coordinates, and the same in whole lanes */
    int first;           /* in block order without padding: bd_model.order[first ... first + n) */
    int offset;          /* in padded vectors */
    int layer, n_layers; /* its layers are layer ... layer + n_layers of bd_model.layers */
    int band, n_bands;   /* its coordinates are bands band ... band + n_bands of bd_model.bands */
    size_t matrix;       /* of its n x n row-major matrices in M, C, G, K, N */
} bd_block;

/* Which coordinates and layers lie in which block, and where: all that the layout of a model depends on. */
typedef struct bd_partition {
    int n_blocks, n_bands, n_padded, largest;
    size_t squares;    /* doubles of one matrix, block by block */
    int *order, *slot; /* (n) as in bd_model */
    bd_block *blocks;  /* (n_blocks) */
    bd_span *bands;    /* (n_bands) as in bd_model */
    int *source;       /* (n_layers) the caller's index of a layer in block order */
    void *memory;
} bd_partition;

/* Returned: whether there was memory; parts->memory is to be freed. */
bool bd_partition_create(const bd_model_data *data, bd_partition *parts);

/* Indices first ... first + n of a vector of `padded` doubles, and the whole lanes that hold them. */
bd_span bd_span_of(int first, int n, int padded);

#endif
