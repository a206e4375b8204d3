/* march_abreast: several marches in one call, those that share their linear part side by side. */
#include "binding.h"
#include "marching.h"

#include <string.h>

const char bd_py_march_abreast_doc[] = PyDoc_STR(
    "march_abreast(calls) -> list of (record, state, report)\n\n"
    "calls: tuples (model, state, steps, decimate, scheme, start, progress, modes), the arguments "
    "of Model.march. Each comes out as Model.march would return it, to the bit.");

/* Cases that go abreast: their places among the calls. */
typedef struct group {
    bd_abreast_case cases[BD_ABREAST];
    bd_py_march_case *of[BD_ABREAST];
    int n;
} group;

static bd_abreast_case case_of(bd_py_march_case *one)
{
    return (bd_abreast_case){
        .model = one->model, .work = one->work, .flat = one->flat, .decimate = one->decimate};
}

/* The first cases that are not yet taken and share with the first of them. */
static group gather(bd_py_march_case *all, Py_ssize_t n, bool *taken)
{
    group found = {.n = 0};
    for (Py_ssize_t i = 0; i < n && found.n < BD_ABREAST; i++) {
        const bd_abreast_case one = case_of(&all[i]);
        if (taken[i] || (found.n > 0 && !bd_abreast_shares(&found.cases[0], &one)))
            continue;
        taken[i] = true;
        found.of[found.n] = &all[i];
        found.cases[found.n++] = one;
    }
    return found;
}

/* Whether a case has steps left. */
static bool goes_on(const bd_py_march_case *one)
{
    return one->total.status == BD_OK && one->total.steps < one->steps;
}

/* One chunk of all cases that go on. Returned: whether any did, or -1 with an exception of a `progress`. */
static int one_chunk(bd_abreast *abreast, group *with, long long *chunk)
{
    bool whole = true, any = false;
    for (int i = 0; i < with->n; i++) {
        bd_py_march_case *one = with->of[i];
        bd_abreast_case *each = &with->cases[i];
        each->steps = goes_on(one) ? Py_MIN(*chunk, one->steps - one->total.steps) : 0;
        each->record = bd_py_data(one->record) + one->kept * bd_model_channels(one->model);
        any = any || each->steps > 0;
    }
    if (!any)
        return 0;
    const double began = bd_py_seconds();
    Py_BEGIN_ALLOW_THREADS
        bd_abreast_march(abreast, with->n, with->cases);
    Py_END_ALLOW_THREADS
    for (int i = 0; i < with->n; i++) {
        const bd_abreast_case *each = &with->cases[i];
        if (each->steps > 0) {
            bd_py_report_add(&with->of[i]->total, &each->report);
            with->of[i]->kept += each->rows;
        }
        whole = whole && each->report.steps == each->steps;
    }
    bd_py_chunk_adapt(bd_py_seconds() - began, whole, chunk);
    for (int i = 0; i < with->n; i++) {
        bd_py_march_case *one = with->of[i];
        if (with->cases[i].steps == 0)
            continue;
        const int stop = bd_py_between_chunks(one->progress, one->total.steps, one->steps);
        if (stop < 0)
            return -1;
        for (int k = 0; k < with->n && stop > 0; k++) /* the user ends all of them */
            if (with->of[k]->total.status == BD_OK)
                with->of[k]->total.status = BD_INTERRUPTED;
    }
    return 1;
}

/* Marches a group to its end. Returned: 0, or -1 with an exception. */
static int march_group(group *with)
{
    if (with->n == 1)
        return bd_py_march_along(with->of[0]);
    bd_abreast *abreast = bd_abreast_create(with->n, with->cases);
    if (!abreast) {
        PyErr_NoMemory();
        return -1;
    }
    long long chunk = 1;
    int more = 1;
    while (more > 0)
        more = one_chunk(abreast, with, &chunk);
    bd_abreast_free(abreast);
    return more;
}

/* Reads the arguments of one march and prepares it. Returned: 0, or -1 with an exception. */
static int begin(bd_py_module *module, PyObject *call, bd_py_march_case *one)
{
    PyObject *object, *state, *scheme, *modes;
    if (!PyTuple_Check(call)) {
        PyErr_SetString(PyExc_TypeError, "calls must hold tuples, the arguments of Model.march");
        return -1;
    }
    if (!PyArg_ParseTuple(call, "O!OLLOpOO:march_abreast", module->model_type, &object, &state,
                          &one->steps, &one->decimate, &scheme, &one->start, &one->progress,
                          &modes))
        return -1;
    return bd_py_march_begin(object, state, scheme, modes, one);
}

PyObject *bd_py_march_abreast(PyObject *module, PyObject *argument)
{
    PyObject *calls = PySequence_Tuple(argument), *results = NULL;
    if (!calls)
        return NULL;
    const Py_ssize_t n = PyTuple_GET_SIZE(calls);
    bd_py_march_case *all = PyMem_Calloc((size_t)n + 1, sizeof *all);
    bool *taken = PyMem_Calloc((size_t)n + 1, sizeof *taken);
    if (!all || !taken) {
        PyErr_NoMemory();
        goto done;
    }
    for (Py_ssize_t i = 0; i < n; i++)
        if (begin(PyModule_GetState(module), PyTuple_GET_ITEM(calls, i), &all[i]))
            goto done;
    for (group next = gather(all, n, taken); next.n > 0; next = gather(all, n, taken))
        if (march_group(&next))
            goto done;
    results = PyList_New(n);
    for (Py_ssize_t i = 0; results && i < n; i++) {
        PyObject *result = bd_py_march_end(&all[i]);
        if (!result)
            Py_CLEAR(results);
        else
            PyList_SET_ITEM(results, i, result);
    }
done:
    for (Py_ssize_t i = 0; all && i < n; i++)
        bd_py_march_free(&all[i]);
    PyMem_Free(all);
    PyMem_Free(taken);
    Py_DECREF(calls);
    return results;
}
