#include "kernels.h"

extern const bd_kernels bd_kernels_base;
#ifdef BD_HAVE_X86_SETS
extern const bd_kernels bd_kernels_avx2;
extern const bd_kernels bd_kernels_avx512;
#endif

const bd_kernels *bd_kernels_for(bd_isa isa)
{
#ifdef BD_HAVE_X86_SETS
    __builtin_cpu_init();
    if ((isa == BD_ISA_BEST || isa == BD_ISA_AVX512) && __builtin_cpu_supports("avx512f"))
        return &bd_kernels_avx512;
    if ((isa == BD_ISA_BEST || isa == BD_ISA_AVX2) && __builtin_cpu_supports("avx2"))
        return &bd_kernels_avx2;
#endif
    return isa == BD_ISA_BEST || isa == BD_ISA_BASE ? &bd_kernels_base : NULL;
}

bool bd_isa_available(bd_isa isa)
{
    return bd_kernels_for(isa) != NULL;
}
