/* What is allocated when, the linker putting these functions in the allocator's place: nothing in a march, and for a
 * model little beside its matrices. */
#include <stdbool.h>
#include <stdlib.h>

#include "bearingdyn.h"
#include "check.h"
#include "reference_lapack.h"
#include "systems.h"

static int calls;
static size_t aligned; /* bytes of the last aligned piece, as a model's is */

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void __real_free(void *piece);

void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void __wrap_free(void *piece);

void *__wrap_malloc(size_t size)
{
    calls++;
    return __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    calls++;
    return __real_calloc(count, size);
}

void *__wrap_realloc(void *old, size_t size)
{
    calls++;
    return __real_realloc(old, size);
}

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    calls++;
    aligned = size;
    return __real_aligned_alloc(alignment, size);
}

void __wrap_free(void *piece)
{
    calls++;
    __real_free(piece);
}

static void the_march_allocates_nothing(bd_damping_law law, bd_scheme scheme, bool softens)
{
    enum { STEPS = 400 };
    pool p = {.n = 0};
    bd_model_data data = motor(&p, law);
    const double rest[MOTOR_SIZE] = {0};
    double record[(STEPS + 1) * MOTOR_CHANNELS];
    /* all layers soften, of a memory so long that the step need not be factored anew */
    double strain[16], table[4] = {1.0, 2.0, 0.0, 0.0};
    bd_layer_data layers[8];
    for (int r = 0; r < 16; r++)
        strain[r] = 1e6;
    const bd_softening_data softening = {.D = 1e5,
                                         .gamma_c = 1e-3,
                                         .m = 0.5,
                                         .Lm = 1e4,
                                         .gamma_l = 1e-3,
                                         .p = 2.0,
                                         .memory = 1e3,
                                         .strain = strain,
                                         .n_table = 2,
                                         .rate_first = 1.0,
                                         .rate_last = 1e4,
                                         .table = table};
    for (int l = 0; softens && l < data.n_layers; l++) {
        layers[l] = data.layers[l];
        layers[l].softening = &softening;
    }
    data.layers = softens ? layers : data.layers;
    bd_status status;
    bd_report report;
    scheme.audit = 1;

    calls = 0;
    bd_model *model = bd_model_create(&data, &status);
    bd_work *work = bd_work_create(model);
    CHECK_EQUAL("the calls are counted", calls > 3, 1);
    double *state = pool_take(&p, bd_state_size(model), sizeof *state);
    bd_state_set(model, state, 0.0, rest, rest);
    bd_soften(model, &scheme, state, false, work);
    CHECK_EQUAL("start", bd_start(model, &scheme, &reference_lapack, work, state), BD_OK);
    CHECK_EQUAL("prepare",
                bd_prepare(model, &scheme, &reference_lapack,
                           bd_reference_speed(model, &scheme, state, true), work),
                BD_OK);

    calls = 0;
    bd_march(model, &scheme, work, state, STEPS, 1, record, &report);
    CHECK_EQUAL("calls to the allocator in a march", calls, 0);
    CHECK_EQUAL("status", report.status, BD_OK);
    CHECK_EQUAL("Newton's matrix was formed in it", report.refreshes > 0, 1);

    bd_work_free(work);
    bd_model_free(model);
    pool_empty(&p);
}

/* Coordinates that nothing couples: five numbers each, and what says where they are. */
static void a_model_keeps_little_beside_its_matrices(void)
{
    enum { N = 2000 };
    pool p = {.n = 0};
    bd_model_data data = bare_system(&p, N);
    bd_status status;
    for (int i = 0; i < N; i++)
        *entry(data.M, N, i, i) = 1.0 + i;
    bd_model *model = bd_model_create(&data, &status);
    CHECK_EQUAL("status", status, BD_OK);
    CHECK_EQUAL("blocks", bd_model_blocks(model), N);
    CHECK_EQUAL("what a model says it keeps", bd_model_bytes(model), aligned);
    CHECK_BELOW("over 2000 blocks of one coordinate", (double)aligned / (5.0 * 8.0 * N), 3.0);
    bd_model_free(model);

    /* one block: the matrices are nearly all */
    for (int i = 1; i < N; i++)
        *entry(data.M, N, 0, i) = *entry(data.M, N, i, 0) = 1e-3;
    model = bd_model_create(&data, &status);
    CHECK_EQUAL("blocks", bd_model_blocks(model), 1);
    CHECK_EQUAL("what a model says it keeps", bd_model_bytes(model), aligned);
    CHECK_BELOW("over one block", (double)aligned / (5.0 * 8.0 * N * N), 1.001);
    bd_model_free(model);
    pool_empty(&p);
}

int main(void)
{
    a_model_keeps_little_beside_its_matrices();
    the_march_allocates_nothing(BD_DAMPING_CONSTANT, motor_scheme(), false);
    the_march_allocates_nothing(BD_DAMPING_CONSTANT, motor_run_up(), false);
    the_march_allocates_nothing(BD_DAMPING_TABLE, motor_scheme(), false);
    the_march_allocates_nothing(BD_DAMPING_TABLE, motor_run_up(), false);
    the_march_allocates_nothing(BD_DAMPING_LOAD, motor_scheme(), false);
    the_march_allocates_nothing(BD_DAMPING_LOAD, motor_run_up(), false);
    the_march_allocates_nothing(BD_DAMPING_LOAD, motor_scheme(), true);
    the_march_allocates_nothing(BD_DAMPING_FILM, motor_scheme(), false);
    the_march_allocates_nothing(BD_DAMPING_CARRIED, motor_scheme(), false);
    return check_result();
}
