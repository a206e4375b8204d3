/* marching.h - inside the binding: the parts of a call that marches, for one march and for several side by side. */
#ifndef BD_PY_MARCHING_H
#define BD_PY_MARCHING_H

#include "binding.h"

#include <stdbool.h>

/* One march of a call. Zeroed; the counts, `start` and `progress` (borrowed) are the caller's. */
typedef struct bd_py_march_case {
    const bd_model *model;
    bd_py_module *module;
    PyObject *keep, *state, *record, *progress;
    bd_work *work;
    double *flat; /* the data of `state`, so many numbers */
    size_t size;
    bd_scheme scheme;
    bool exactly;
    int start;
    long long steps, decimate, kept; /* kept: rows recorded so far */
    bd_report total;
} bd_py_march_case;

/* Parses, starts and prepares. Returned: 0, or -1 with an exception; bd_py_march_free either way. */
int bd_py_march_begin(PyObject *object, PyObject *state_in, PyObject *scheme_in, PyObject *modes_in,
                      bd_py_march_case *one);

/* Marches to the end by itself. Returned: 0, or -1 with an exception of `progress`. */
int bd_py_march_along(bd_py_march_case *one);

/* (record, state, report), or NULL with an exception. */
PyObject *bd_py_march_end(bd_py_march_case *one);

void bd_py_march_free(bd_py_march_case *one);

/* The size of the next chunk after one that took so long, and was marched whole or not. */
void bd_py_chunk_adapt(double took, bool whole, long long *chunk);

#endif
