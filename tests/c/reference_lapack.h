/* reference_lapack.h - the four LAPACK routines the core needs, unblocked: for tests only. */
#ifndef REFERENCE_LAPACK_H
#define REFERENCE_LAPACK_H

#include "lapack.h"

extern const bd_lapack reference_lapack;

#endif
