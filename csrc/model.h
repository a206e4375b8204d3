/* model.h - inside the core: what a model holds, in one allocation. */
#ifndef BD_MODEL_H
#define BD_MODEL_H

#include "bearing.h"
#include "partition.h"

typedef struct bd_layer {
    int source; /* index in the caller's list */
    int block, rank, padded;
    int offset;                         /* in padded vectors of layer rates */
    int branch, n_branches;             /* the first one's place among the branches of all layers */
    int n_stresses;                     /* branches, and three more where the layer softens */
    size_t memory;                      /* of its deviation in a state's softening */
    const bd_softening_data *softening; /* or NULL */
    size_t stress;                      /* of its first branch in a state's stress */
    const double *L;     /* (block n x padded rank): row j holds coordinate j's part in each rate */
    const bd_span *felt; /* (block n_bands) the rates that each band's motion enters */
    const double *modulus, *tau;
} bd_layer;

typedef struct bd_load {
    bd_load_kind kind;
    double omega;
    int n_samples;
    const double *p_cos, *p_sin; /* (n_padded) */
    const double *time, *value;
} bd_load;

typedef struct bd_channel {
    bd_channel_kind kind;
    int bearing, index;
    const double *row; /* (n_padded) or NULL */
} bd_channel;

/* A bearing and a band of coordinates whose motion enters its coefficients; both spans in padded vectors. */
typedef struct bd_sight {
    int band; /* of bd_model.bands */
    bd_span coordinates, coefficients;
} bd_sight;

/* The matrices of (1), blocks one after another; or those of one block, n x n row-major. */
typedef struct bd_matrices {
    const double *M, *C, *G, *K, *N;
} bd_matrices;

struct bd_model {
    size_t bytes; /* of the allocation */
    int n, n_padded, n_blocks, n_bands, n_layers, n_bearings, n_loads, n_channels;
    int largest;  /* coordinates of the largest block */
    int branches; /* of all layers */
    int n_coefs,
        coefs; /* of all bearings: as counted by the caller, and padded bearing by bearing */
    int ranks; /* of all layers, padded layer by layer */
    size_t n_stress;
    int n_softening;            /* layers that soften */
    size_t n_softening_doubles; /* of a state */
    int n_echoes;               /* of all bearings' films that are carried */
    size_t n_echo_doubles;      /* of a state */
    const int *order;           /* (n) the caller's index of a coordinate in block order */
    const int *slot;            /* (n) padded position of the caller's coordinate */
    const int *coef_slot;       /* (n_coefs) padded position of the caller's coefficient */
    const int *bearing_slot;    /* (n_bearings) padded position of a bearing's first coefficient */
    const bd_block *blocks;
    const bd_span *bands; /* (n_bands) in their block; none couples with another but by bearings */
    const long long *const *inside; /* (n_bands) its rows: all bits set at its own; NULL: all are */
    const bd_layer *layers;
    const bd_bearing *bearings;
    const bd_load *loads;
    const bd_channel *channels;
    bd_matrices matrices;
    const bd_sight *sights; /* bearing by bearing, in the order of the bands */
    const int *sight;       /* (n_bearings + 1) a bearing's first one, and the end of all */
    const double *B;        /* (n_padded x coefs): row j holds coordinate j's part in each */
};

/* Numbers that a state keeps of a layer that softens, behind its deviation (softening.c). */
enum { BD_SOFTENING_NUMBERS = 10 };

/* Doubles of both, padded; 0 where a layer does not soften. */
size_t bd_softening_size(const bd_layer *layer);

/* The matrices of one block. */
bd_matrices bd_matrices_of(const bd_model *model, const bd_block *block);

/* BD_OK, or what is wrong with a description; bd_model_create asks it first. */
bd_status bd_model_check(const bd_model_data *data);

/* Whether the numbers of a scheme can be marched with; what its speed holds is left to bd_profile_take. */
bool bd_scheme_valid(const bd_scheme *scheme);

#endif
