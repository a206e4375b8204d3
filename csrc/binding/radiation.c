/* The integral operators of sound outside a surface, in chunks of rows without the GIL. */
#include "binding.h"

#include <limits.h>

#include "../radiation.h"

const char bd_py_helmholtz_doc[] =
    PyDoc_STR("helmholtz(points, faces, k, floor) -> V, V1, Kt, K, D\n\n"
              "points (n, 3), faces (m, 3), wave number k > 0, height of a rigid floor or None; "
              "complex V (m, m),\n"
              "V1 and Kt (n, m), K and D (n, n); see radiation.h.");

static PyObject *zeros(PyObject *list, npy_intp rows, npy_intp columns, double **data)
{
    npy_intp shape[2] = {rows, columns};
    PyObject *array = PyArray_ZEROS(2, shape, NPY_CDOUBLE, 0);
    if (!array)
        return NULL;
    *data = PyArray_DATA((PyArrayObject *)array);
    const int failed = PyList_Append(list, array);
    Py_DECREF(array);
    return failed ? NULL : array;
}

PyObject *bd_py_helmholtz(PyObject *module, PyObject *args)
{
    PyObject *points_in, *faces_in, *floor_in, *made = NULL, *out = NULL;
    double k;
    bd_radiation_data data = {0};
    bd_radiation *radiation = NULL;
    (void)module;
    if (!PyArg_ParseTuple(args, "OOdO:helmholtz", &points_in, &faces_in, &k, &floor_in))
        return NULL;
    PyObject *keep = PyList_New(0);
    if (!keep)
        return NULL;

    if (!(data.points = bd_py_doubles(keep, points_in, "points", 2, -1, 3)))
        goto done;
    const npy_intp n = bd_py_rows(keep);
    PyArrayObject *faces = bd_py_copy(keep, faces_in, NPY_INT, "faces", 2, -1, 3);
    if (!faces)
        goto done;
    const npy_intp m = PyArray_DIM(faces, 0);
    data.faces = PyArray_DATA(faces);
    if (n > INT_MAX / 2 || m > INT_MAX / 2) {
        PyErr_SetString(PyExc_ValueError, "points, faces: too many");
        goto done;
    }
    for (npy_intp i = 0; i < 3 * m; i++)
        if (data.faces[i] < 0 || data.faces[i] >= n) {
            PyErr_Format(PyExc_ValueError, "faces[%zd] names a point outside 0...%zd",
                         (Py_ssize_t)(i / 3), (Py_ssize_t)(n - 1));
            goto done;
        }
    if (!(k > 0.0) || bd_py_require_finite(&k, 1, "k")) {
        if (!PyErr_Occurred())
            PyErr_SetString(PyExc_ValueError, "k must be positive");
        goto done;
    }
    data.n_points = (int)n;
    data.n_faces = (int)m;
    data.floor = floor_in != Py_None;
    if (data.floor) {
        data.floor_height = PyFloat_AsDouble(floor_in);
        if (PyErr_Occurred() || bd_py_require_finite(&data.floor_height, 1, "floor"))
            goto done;
    }

    bd_radiation_operators to;
    if (!(made = PyList_New(0)) || !zeros(made, m, m, &to.V) || !zeros(made, n, m, &to.V1) ||
        !zeros(made, n, m, &to.Kt) || !zeros(made, n, n, &to.K) || !zeros(made, n, n, &to.D))
        goto done;
    if (!(radiation = bd_radiation_create(&data))) {
        PyErr_NoMemory();
        goto done;
    }
    int at = 0, chunk = 1;
    while (at < data.n_faces) {
        const int now = Py_MIN(chunk, data.n_faces - at);
        const double began = bd_py_seconds();
        Py_BEGIN_ALLOW_THREADS
            bd_radiation_rows(radiation, k, at, now, &to);
        Py_END_ALLOW_THREADS
        const double took = bd_py_seconds() - began;
        at += now;
        if (bd_py_after_chunk(Py_None, took, at, data.n_faces, &chunk))
            goto done;
    }
    out = PyList_AsTuple(made);
done:
    bd_radiation_free(radiation);
    Py_XDECREF(made);
    Py_DECREF(keep);
    return out;
}
