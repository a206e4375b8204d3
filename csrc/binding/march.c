/* Model.march: chunks without the GIL, and between them signals, progress and new factors. Its parts serve marches side
 * by side too (abreast.c). */
#include "binding.h"
#include "marching.h"

#include <string.h>

const char bd_py_march_doc[] = PyDoc_STR(
    "march(state, steps, decimate, scheme, start, progress, modes=None) -> record, state, "
    "report\n\n"
    "modes: None for Newmark's steps, else a dict for exact ones. scheme: a dict, see core.Scheme. "
    "The GIL is released. A new state is returned; the one given\n"
    "is not touched. progress(done, total) is called every 0.05 s. report: a dict of\n"
    "REPORT_FIELDS, and of peaks, the largest load of one ball of each bearing. An interrupt "
    "(Ctrl-C) ends the march with the status INTERRUPTED and what was\n"
    "recorded, be it in the last of its steps.");

static bool all_finite(const double *values, size_t n)
{
    double poison = 0.0;
    for (size_t i = 0; i < n; i++)
        poison += 0.0 * values[i];
    return poison == 0.0;
}

/* The largest ball load of every bearing, a tuple of floats. */
static PyObject *peaks_of(const bd_model *model, const bd_work *work)
{
    const int n = bd_model_bearings(model);
    PyObject *peaks = PyTuple_New(n);
    for (int b = 0; peaks && b < n; b++) {
        PyObject *load = PyFloat_FromDouble(bd_peak_load(model, work, b));
        if (!load)
            Py_CLEAR(peaks);
        else
            PyTuple_SET_ITEM(peaks, b, load);
    }
    return peaks;
}

int bd_py_march_begin(PyObject *object, PyObject *state_in, PyObject *scheme_in, PyObject *modes_in,
                      bd_py_march_case *one)
{
    one->model = bd_py_model_of(object);
    if (one->steps < 0 || one->steps >= 1LL << 53 || one->decimate < 1) {
        PyErr_Format(PyExc_ValueError,
                     "steps is %lld and decimate %lld; they must be 0 to 2**53 - 1 and at least 1",
                     one->steps, one->decimate);
        return -1;
    }
    const bd_model *model = one->model;
    one->module = PyType_GetModuleState(Py_TYPE(object));
    one->keep = PyList_New(0);
    if (!one->module || !one->keep)
        return -1;

    bd_exact_data exact = {0};
    one->exactly = modes_in != Py_None;
    if (one->exactly && bd_py_parse_exact(one->keep, model, modes_in, &exact))
        return -1;
    const double *given = bd_py_state_of(one->keep, model, state_in, (npy_intp)exact.n);
    if (!given || bd_py_parse_scheme(one->keep, scheme_in, &one->scheme))
        return -1;
    one->size = bd_exact_size(model, &exact);
    one->state = bd_py_new_array(1, (npy_intp)one->size, 0);
    one->record =
        bd_py_new_array(2, (npy_intp)(one->steps / one->decimate + 1), bd_model_channels(model));
    one->work = bd_work_create(model);
    if (!one->state || !one->record || !one->work) {
        if (!one->work)
            PyErr_NoMemory();
        return -1;
    }
    one->flat = bd_py_data(one->state);
    memcpy(one->flat, given, one->size * sizeof(double));

    const bd_lapack *lapack = &one->module->lapack;
    bd_status status = BD_OK;
    Py_BEGIN_ALLOW_THREADS
        bd_soften(model, &one->scheme, one->flat, false, one->work);
        if (one->start)
            status = bd_start(model, &one->scheme, lapack, one->work, one->flat);
        const double speed = bd_reference_speed(model, &one->scheme, one->flat, one->start != 0);
        if (status == BD_OK)
            status = one->exactly ? bd_exact_prepare(model, &one->scheme, &exact, one->work)
                                  : bd_prepare(model, &one->scheme, lapack, speed, one->work);
    Py_END_ALLOW_THREADS
    if (status == BD_BAD_VALUE || status == BD_BAD_SHAPE || status == BD_NO_MEMORY) {
        /* the scheme has been checked: what is left is the speed that the state was factored at */
        bd_py_raise(status, "the state's clock, or the speed at its time");
        return -1;
    }
    one->total = (bd_report){.status = status, .bearing = -1, .open_t = -1.0, .open_bearing = -1};
    bd_state_get(model, one->flat, &one->total.t, NULL, NULL, NULL);
    return 0;
}

void bd_py_march_free(bd_py_march_case *one)
{
    bd_work_free(one->work);
    Py_XDECREF(one->state);
    Py_XDECREF(one->record);
    Py_XDECREF(one->keep);
}

void bd_py_chunk_adapt(double took, bool whole, long long *chunk)
{
    if (took < 0.5 * BD_PY_CHUNK_SECONDS && whole)
        *chunk *= 2;
    else if (took > BD_PY_CHUNK_SECONDS && *chunk > 1)
        *chunk /= 2;
}

int bd_py_march_along(bd_py_march_case *one)
{
    const bd_model *model = one->model;
    const npy_intp channels = bd_model_channels(model);
    const bd_lapack *lapack = &one->module->lapack;
    double *rows = bd_py_data(one->record), *flat = one->flat;
    bd_report *total = &one->total, part = {0};
    long long chunk = 1;

    while (total->status == BD_OK && total->steps < one->steps) {
        const long long now = Py_MIN(chunk, one->steps - total->steps);
        const double began = bd_py_seconds();
        Py_BEGIN_ALLOW_THREADS
            one->kept += bd_march(model, &one->scheme, one->work, flat, now, one->decimate,
                                  rows + one->kept * channels, &part);
        Py_END_ALLOW_THREADS
        const double took = bd_py_seconds() - began;

        bd_py_report_add(total, &part);
        if (part.status ==
            BD_REFACTOR) { /* speed or strain have moved on: factor where they are now */
            Py_BEGIN_ALLOW_THREADS
                bd_soften(model, &one->scheme, flat, true, one->work);
                const double speed = bd_reference_speed(model, &one->scheme, flat, true);
                total->status = one->scheme.speed.n == 1
                                    ? bd_prepare_softened(model, lapack, one->work)
                                    : bd_prepare(model, &one->scheme, lapack, speed, one->work);
            Py_END_ALLOW_THREADS
            total->refactors++;
        }
        /* a chunk cut short by a refactoring says nothing about the time of a whole one */
        bd_py_chunk_adapt(took, part.steps == now, &chunk);

        const int stop = bd_py_between_chunks(one->progress, total->steps, one->steps);
        if (stop < 0)
            return -1;
        if (stop > 0 && total->status == BD_OK)
            total->status = BD_INTERRUPTED;
    }
    return 0;
}

PyObject *bd_py_march_end(bd_py_march_case *one)
{
    bd_report *total = &one->total;
    PyObject *result = NULL;
    if (total->steps > 0)
        bd_exact_end(one->model, one->work, one->flat);
    /* a step refuses motion and stresses that are not finite; an audit's energies, and a start without steps, do not */
    if (total->status >= BD_OK && !all_finite(one->flat, one->size))
        total->status = BD_NOT_FINITE;

    PyObject *used = PySequence_GetSlice(one->record, 0, (Py_ssize_t)one->kept);
    PyObject *report = used ? bd_py_report_dict(total) : NULL;
    PyObject *peaks = report ? peaks_of(one->model, one->work) : NULL;
    if (peaks && PyDict_SetItemString(report, "peaks", peaks) == 0)
        result = PyTuple_Pack(3, used, one->state, report);
    Py_XDECREF(used);
    Py_XDECREF(report);
    Py_XDECREF(peaks);
    return result;
}

PyObject *bd_py_march(PyObject *object, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"state", "steps",    "decimate", "scheme",
                            "start", "progress", "modes",    NULL};
    PyObject *state_in, *scheme_in, *modes_in = Py_None, *result = NULL;
    bd_py_march_case one = {0};
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OLLOpO|O:march", names, &state_in, &one.steps,
                                     &one.decimate, &scheme_in, &one.start, &one.progress,
                                     &modes_in))
        return NULL;
    if (bd_py_march_begin(object, state_in, scheme_in, modes_in, &one) == 0 &&
        bd_py_march_along(&one) == 0)
        result = bd_py_march_end(&one);
    bd_py_march_free(&one);
    return result;
}
