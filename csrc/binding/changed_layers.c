/* Motions of layers whose moduli have changed, in chunks of entries without the GIL. */
#include "binding.h"

#include <limits.h>

#include "../changed_layers.h"

const char bd_py_changed_layers_doc[] =
    PyDoc_STR("changed_layers(receptance, which, alone, change, slope, end, isa) -> y, moved\n\n"
              "receptance (f, r, r), alone (e, r), change and slope (e, layers) complex; of each "
              "entry which (e,) f\n"
              "it is of; end (layers,) of each layer's coordinates; y (e, r) and moved (e, layers, "
              "r); see changed_layers.h.");

/* An array that is read where it lies: complex numbers whose rows are without gaps. */
static PyArrayObject *receptance_of(PyObject *object)
{
    PyArrayObject *array = PyArray_Check(object) ? (PyArrayObject *)object : NULL;
    const npy_intp size = (npy_intp)(2 * sizeof(double));
    if (array && PyArray_NDIM(array) == 3 && PyArray_TYPE(array) == NPY_CDOUBLE &&
        PyArray_ISBEHAVED_RO(array) && PyArray_DIM(array, 1) == PyArray_DIM(array, 2) &&
        PyArray_DIM(array, 1) > 0 && PyArray_STRIDE(array, 2) == size &&
        PyArray_STRIDE(array, 1) >= size * PyArray_DIM(array, 2) &&
        PyArray_STRIDE(array, 1) % size == 0 && PyArray_STRIDE(array, 0) % size == 0)
        return array;
    PyErr_SetString(PyExc_ValueError,
                    "receptance must be a complex array (frequencies, r, r), row after row");
    return NULL;
}

PyObject *bd_py_changed_layers(PyObject *module, PyObject *args)
{
    PyObject *receptance_in, *which_in, *alone_in, *change_in, *slope_in, *end_in, *isa_in,
        *made = NULL, *moved = NULL, *out = NULL;
    (void)module;
    if (!PyArg_ParseTuple(args, "OOOOOOO:changed_layers", &receptance_in, &which_in, &alone_in,
                          &change_in, &slope_in, &end_in, &isa_in))
        return NULL;
    PyObject *keep = PyList_New(0);
    if (!keep)
        return NULL;

    int isa;
    PyArrayObject *receptance = receptance_of(receptance_in);
    PyArrayObject *which =
        receptance ? bd_py_copy(keep, which_in, NPY_INTP, "which", 1, -1, -1) : NULL;
    if (!which || bd_py_parse_word(isa_in, "isa", bd_py_isas, &isa))
        goto done;
    const npy_intp rank = PyArray_DIM(receptance, 1), entries = PyArray_SIZE(which);
    PyArrayObject *end = bd_py_copy(keep, end_in, NPY_INT, "end", 1, -1, -1);
    const npy_intp n_layers = end ? PyArray_SIZE(end) : 0;
    PyArrayObject *alone =
        end ? bd_py_copy(keep, alone_in, NPY_CDOUBLE, "alone", 2, entries, rank) : NULL;
    PyArrayObject *change =
        alone ? bd_py_copy(keep, change_in, NPY_CDOUBLE, "change", 2, entries, n_layers) : NULL;
    PyArrayObject *slope =
        change ? bd_py_copy(keep, slope_in, NPY_CDOUBLE, "slope", 2, entries, n_layers) : NULL;
    if (!slope)
        goto done;
    const bd_kernels *kernels = bd_kernels_for((bd_isa)isa);
    if (!kernels || rank > 10000 || n_layers > rank || entries > INT_MAX) {
        PyErr_SetString(PyExc_ValueError, kernels
                                              ? "changed_layers: too many coordinates or entries"
                                              : "isa: this machine lacks it");
        goto done;
    }
    const bd_changed_layers layers = {
        .rank = (int)rank, .n_layers = (int)n_layers, .end = PyArray_DATA(end)};
    for (npy_intp l = 0; l < n_layers; l++)
        if (layers.end[l] < (l ? layers.end[l - 1] : 0) || layers.end[l] > layers.rank ||
            (l == n_layers - 1 && layers.end[l] != layers.rank)) {
            PyErr_SetString(PyExc_ValueError, "end must rise to the number of coordinates");
            goto done;
        }
    const npy_intp *of = PyArray_DATA(which);
    for (npy_intp e = 0; e < entries; e++)
        if (of[e] < 0 || of[e] >= PyArray_DIM(receptance, 0)) {
            PyErr_Format(PyExc_ValueError, "which[%zd] names a frequency outside 0...%zd",
                         (Py_ssize_t)e, (Py_ssize_t)PyArray_DIM(receptance, 0) - 1);
            goto done;
        }
    double *memory = bd_py_scratch(keep, bd_changed_layers_room(layers.rank), sizeof *memory);
    int *order = memory ? bd_py_scratch(keep, (size_t)rank, sizeof *order) : NULL;
    npy_intp y_shape[2] = {entries, rank}, moved_shape[3] = {entries, n_layers, rank};
    if (!order || !(made = PyArray_ZEROS(2, y_shape, NPY_CDOUBLE, 0)) ||
        !(moved = PyArray_ZEROS(3, moved_shape, NPY_CDOUBLE, 0)))
        goto done;

    const char *from = PyArray_DATA(receptance);
    const npy_intp step = PyArray_STRIDE(receptance, 0);
    const size_t stride = (size_t)PyArray_STRIDE(receptance, 1) / sizeof(double);
    const double *y0 = PyArray_DATA(alone), *d = PyArray_DATA(change), *s = PyArray_DATA(slope);
    double *y = bd_py_data(made), *dy = bd_py_data(moved);
    const size_t wide = 2 * (size_t)rank, few = 2 * (size_t)n_layers;
    int chunk = 1;
    for (size_t at = 0; at < (size_t)entries;) {
        const size_t now = Py_MIN((size_t)chunk, (size_t)entries - at);
        const double began = bd_py_seconds();
        int singular = 0;
        Py_BEGIN_ALLOW_THREADS
            for (size_t e = at; e < at + now && !singular; e++)
                singular = kernels->changed_layers(
                    &layers, (const double *)(const void *)(from + of[e] * step), stride,
                    y0 + e * wide, d + e * few, s + e * few, memory, order, y + e * wide,
                    dy + e * wide * (size_t)n_layers);
        Py_END_ALLOW_THREADS
        if (singular) {
            bd_py_raise(BD_SINGULAR_DYNAMIC, "changed_layers");
            goto done;
        }
        at += now;
        if (bd_py_after_chunk(Py_None, bd_py_seconds() - began, (int)at, (int)entries, &chunk))
            goto done;
    }
    out = PyTuple_Pack(2, made, moved);
done:
    Py_XDECREF(made);
    Py_XDECREF(moved);
    Py_DECREF(keep);
    return out;
}
