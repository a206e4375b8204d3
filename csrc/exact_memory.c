/* What an exact step holds, given back: apart from its making, which works on bd_work, that owns it. */
#include <stdlib.h>

#include "exact.h"

void bd_exact_free(bd_exact *exact)
{
    if (!exact)
        return;
    free(exact->memory);
    free(exact->groups);
    free(exact->seen);
    free(exact->varying);
    free(exact);
}
