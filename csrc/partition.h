/* partition.h - inside the core: which coordinates the linear structure couples, and in which order a model keeps them. */
#ifndef BD_PARTITION_H
#define BD_PARTITION_H

#include "model.h"

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
bool bd_partition_find(const bd_model_data *data, bd_partition *parts);

/* Indices first ... first + n of a vector of `padded` doubles, and the whole lanes that hold them. */
bd_span bd_span_of(int first, int n, int padded);

#endif
