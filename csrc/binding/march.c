/* Model.march: chunks without the GIL, and between them signals, progress and new factors. */
#include "binding.h"

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

PyObject *bd_py_march(PyObject *object, PyObject *args, PyObject *keywords)
{
    const bd_model *model = bd_py_model_of(object);
    static char *names[] = {"state", "steps",    "decimate", "scheme",
                            "start", "progress", "modes",    NULL};
    PyObject *state_in, *scheme_in, *progress, *modes_in = Py_None, *result = NULL;
    long long steps, decimate;
    int start;
    bd_scheme scheme;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OLLOpO|O:march", names, &state_in, &steps,
                                     &decimate, &scheme_in, &start, &progress, &modes_in))
        return NULL;
    if (steps < 0 || steps >= 1LL << 53 || decimate < 1) {
        PyErr_Format(PyExc_ValueError,
                     "steps is %lld and decimate %lld; they must be 0 to 2**53 - 1 and at least 1",
                     steps, decimate);
        return NULL;
    }
    bd_py_module *module = PyType_GetModuleState(Py_TYPE(object));
    PyObject *keep = PyList_New(0);
    if (!module || !keep) {
        Py_XDECREF(keep);
        return NULL;
    }

    const npy_intp channels = bd_model_channels(model);
    PyObject *state = NULL, *record = NULL;
    bd_work *work = NULL;
    bd_exact_data exact = {0};
    const bool exactly = modes_in != Py_None;
    if (exactly && bd_py_parse_exact(keep, model, modes_in, &exact))
        goto done;
    const double *given = bd_py_state_of(keep, model, state_in, (npy_intp)exact.n);
    if (!given || bd_py_parse_scheme(keep, scheme_in, &scheme))
        goto done;
    const size_t size = bd_exact_size(model, &exact);
    state = bd_py_new_array(1, (npy_intp)size, 0);
    record = bd_py_new_array(2, (npy_intp)(steps / decimate + 1), channels);
    work = bd_work_create(model);
    if (!state || !record || !work) {
        if (!work)
            PyErr_NoMemory();
        goto done;
    }
    memcpy(bd_py_data(state), given, size * sizeof(double));

    double *flat = bd_py_data(state), *rows = bd_py_data(record);
    bd_status status = BD_OK;
    Py_BEGIN_ALLOW_THREADS
        bd_soften(model, &scheme, flat, false, work);
        if (start)
            status = bd_start(model, &scheme, &module->lapack, work, flat);
        const double speed = bd_reference_speed(model, &scheme, flat, start != 0);
        if (status == BD_OK)
            status = exactly ? bd_exact_prepare(model, &scheme, &exact, work)
                             : bd_prepare(model, &scheme, &module->lapack, speed, work);
    Py_END_ALLOW_THREADS
    if (status == BD_BAD_VALUE || status == BD_BAD_SHAPE || status == BD_NO_MEMORY) {
        /* the scheme has been checked: what is left is the speed that the state was factored at */
        bd_py_raise(status, "the state's clock, or the speed at its time");
        goto done;
    }

    bd_report total = {.status = status, .bearing = -1, .open_t = -1.0, .open_bearing = -1};
    bd_report part = {0};
    long long kept = 0, chunk = 1;
    bd_state_get(model, flat, &total.t, NULL, NULL, NULL);
    while (total.status == BD_OK && total.steps < steps) {
        const long long now = Py_MIN(chunk, steps - total.steps);
        const double began = bd_py_seconds();
        Py_BEGIN_ALLOW_THREADS
            kept +=
                bd_march(model, &scheme, work, flat, now, decimate, rows + kept * channels, &part);
        Py_END_ALLOW_THREADS
        const double took = bd_py_seconds() - began;

        bd_py_report_add(&total, &part);
        if (part.status ==
            BD_REFACTOR) { /* speed or strain have moved on: factor where they are now */
            Py_BEGIN_ALLOW_THREADS
                bd_soften(model, &scheme, flat, true, work);
                const double speed = bd_reference_speed(model, &scheme, flat, true);
                total.status = scheme.speed.n == 1
                                   ? bd_prepare_softened(model, &module->lapack, work)
                                   : bd_prepare(model, &scheme, &module->lapack, speed, work);
            Py_END_ALLOW_THREADS
            total.refactors++;
        }
        /* a chunk cut short by a refactoring says nothing about the time of a whole one */
        if (took < 0.5 * BD_PY_CHUNK_SECONDS && part.steps == now)
            chunk *= 2;
        else if (took > BD_PY_CHUNK_SECONDS && chunk > 1)
            chunk /= 2;

        const int stop = bd_py_between_chunks(progress, total.steps, steps);
        if (stop < 0)
            goto done;
        if (stop > 0 && total.status == BD_OK)
            total.status = BD_INTERRUPTED;
    }
    if (total.steps > 0)
        bd_exact_end(model, work, flat);
    /* a step refuses motion and stresses that are not finite; an audit's energies, and a start without steps, do not */
    if (total.status >= BD_OK && !all_finite(flat, size))
        total.status = BD_NOT_FINITE;

    PyObject *used = PySequence_GetSlice(record, 0, (Py_ssize_t)kept);
    PyObject *report = used ? bd_py_report_dict(&total) : NULL;
    PyObject *peaks = report ? peaks_of(model, work) : NULL;
    if (peaks && PyDict_SetItemString(report, "peaks", peaks) == 0)
        result = PyTuple_Pack(3, used, state, report);
    Py_XDECREF(used);
    Py_XDECREF(report);
    Py_XDECREF(peaks);
done:
    bd_work_free(work);
    Py_XDECREF(state);
    Py_XDECREF(record);
    Py_DECREF(keep);
    return result;
}
