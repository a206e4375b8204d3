/* Arguments: arrays, and dicts with named fields. What is said in binding.h is not said again here. */
#include "binding.h"

#include <limits.h>
#include <math.h>
#include <string.h>
#include <time.h>

/* ---------------------------------------------------------------- arrays */

PyObject *bd_py_raise(bd_status status, const char *what)
{
    if (status == BD_NO_MEMORY)
        return PyErr_NoMemory();
    PyErr_Format(status == BD_BAD_SHAPE || status == BD_BAD_VALUE || status == BD_NOT_SYMMETRIC
                     ? PyExc_ValueError
                     : PyExc_ArithmeticError,
                 "%s: %s", what, bd_status_text(status));
    return NULL;
}

PyArrayObject *bd_py_copy(PyObject *keep, PyObject *object, int type, const char *name, int n_dims,
                          npy_intp rows, npy_intp columns)
{
    PyObject *array =
        PyArray_FROMANY(object, type, n_dims, n_dims,
                        NPY_ARRAY_CARRAY | NPY_ARRAY_ENSURECOPY | NPY_ARRAY_NOTSWAPPED);
    if (!array) {
        if (PyErr_ExceptionMatches(PyExc_ValueError) || PyErr_ExceptionMatches(PyExc_TypeError)) {
            PyErr_Clear();
            PyErr_Format(PyExc_ValueError, "%s must be a %d-dimensional array of numbers", name,
                         n_dims);
        }
        return NULL;
    }
    int failed = PyList_Append(keep, array);
    Py_DECREF(array);
    if (failed)
        return NULL;
    const npy_intp *shape = PyArray_DIMS((PyArrayObject *)array);
    if ((rows >= 0 && shape[0] != rows) || (n_dims > 1 && columns >= 0 && shape[1] != columns)) {
        PyErr_Format(PyExc_ValueError,
                     "%s has %zd rows and %zd columns; expected %zd and %zd (-1: any)", name,
                     (Py_ssize_t)shape[0], (Py_ssize_t)(n_dims > 1 ? shape[1] : 1),
                     (Py_ssize_t)rows, (Py_ssize_t)(n_dims > 1 ? columns : 1));
        return NULL;
    }
    return (PyArrayObject *)array;
}

int bd_py_require_finite(const double *values, npy_intp n, const char *name)
{
    for (npy_intp i = 0; i < n; i++)
        if (!isfinite(values[i])) {
            PyErr_Format(PyExc_ValueError, "%s must be finite", name);
            return -1;
        }
    return 0;
}

double *bd_py_doubles(PyObject *keep, PyObject *object, const char *name, int n_dims, npy_intp rows,
                      npy_intp columns)
{
    PyArrayObject *array = bd_py_copy(keep, object, NPY_DOUBLE, name, n_dims, rows, columns);
    if (!array || bd_py_require_finite(PyArray_DATA(array), PyArray_SIZE(array), name))
        return NULL;
    return PyArray_DATA(array);
}

npy_intp bd_py_rows(PyObject *keep)
{
    return PyArray_DIM((PyArrayObject *)PyList_GET_ITEM(keep, PyList_GET_SIZE(keep) - 1), 0);
}

npy_intp bd_py_columns(PyObject *keep)
{
    return PyArray_DIM((PyArrayObject *)PyList_GET_ITEM(keep, PyList_GET_SIZE(keep) - 1), 1);
}

void *bd_py_scratch(PyObject *keep, size_t count, size_t size)
{
    if (count > (size_t)PY_SSIZE_T_MAX / size) {
        PyErr_NoMemory();
        return NULL;
    }
    PyObject *bytes = PyBytes_FromStringAndSize(NULL, (Py_ssize_t)(count * size + 1));
    if (!bytes)
        return NULL;
    int failed = PyList_Append(keep, bytes);
    Py_DECREF(bytes);
    if (failed)
        return NULL;
    memset(PyBytes_AS_STRING(bytes), 0, count * size + 1);
    return PyBytes_AS_STRING(bytes);
}

PyObject *bd_py_new_array(int n_dims, npy_intp rows, npy_intp columns)
{
    npy_intp shape[2] = {rows, columns};
    return PyArray_ZEROS(n_dims, shape, NPY_DOUBLE, 0);
}

double *bd_py_data(PyObject *array)
{
    return PyArray_DATA((PyArrayObject *)array);
}

/* ---------------------------------------------------------------- fields of a dict */

/* A whole number that fits an int. */
static int read_int(PyObject *value, const char *what, const char *name, int *to)
{
    PyObject *index = PyNumber_Index(value);
    if (!index) {
        if (PyErr_ExceptionMatches(PyExc_TypeError))
            PyErr_Format(PyExc_TypeError, "%s.%s is %R; it must be a whole number", what, name,
                         value);
        return -1;
    }
    int overflow;
    const long number = PyLong_AsLongAndOverflow(index, &overflow);
    Py_DECREF(index);
    if (overflow || number < INT_MIN || number > INT_MAX) {
        PyErr_Format(PyExc_ValueError, "%s.%s is %R; it must be below 2**31 in size", what, name,
                     value);
        return -1;
    }
    *to = (int)number;
    return 0;
}

static int read_double(PyObject *value, const char *what, const char *name, double *to)
{
    *to = PyFloat_AsDouble(value);
    if (*to == -1.0 && PyErr_Occurred()) {
        if (PyErr_ExceptionMatches(PyExc_TypeError))
            PyErr_Format(PyExc_TypeError, "%s.%s is %R; it must be a number", what, name, value);
        return -1;
    }
    if (!isfinite(*to)) {
        PyErr_Format(PyExc_ValueError, "%s.%s is %R; it must be finite", what, name, value);
        return -1;
    }
    return 0;
}

/* Names the first key that is not a field. Always returns -1. */
static int raise_unknown(PyObject *dict, const char *what, const bd_py_field *fields, size_t n)
{
    PyObject *key, *value;
    Py_ssize_t at = 0;
    while (PyDict_Next(dict, &at, &key, &value)) {
        size_t f = 0;
        while (f < n && !(PyUnicode_Check(key) &&
                          PyUnicode_CompareWithASCIIString(key, fields[f].name) == 0))
            f++;
        if (f == n) {
            PyErr_Format(PyExc_TypeError, "%s has a field %R that is unknown", what, key);
            break;
        }
    }
    return -1;
}

int bd_py_parse_fields(PyObject *keep, PyObject *dict, const char *what, const bd_py_field *fields,
                       size_t n, void *to)
{
    if (!PyDict_Check(dict)) {
        PyErr_Format(PyExc_TypeError, "%s is %R; it must be a dict of named fields", what, dict);
        return -1;
    }
    /* a copy of our own: reading a number may run any code, which must not change the dict under our feet */
    PyObject *own = PyDict_Copy(dict);
    int failed = !own || PyList_Append(keep, own);
    Py_XDECREF(own);
    for (size_t f = 0; !failed && f < n; f++) {
        const bd_py_field *field = &fields[f];
        PyObject *value = PyDict_GetItemString(own, field->name); /* borrowed from `own` */
        void *place = (char *)to + field->offset;
        if (!value) {
            PyErr_Format(PyExc_TypeError, "%s has no field \"%s\"", what, field->name);
            failed = 1;
        } else if (field->type == BD_PY_INT)
            failed = read_int(value, what, field->name, place);
        else if (field->type == BD_PY_DOUBLE)
            failed = read_double(value, what, field->name, place);
        else
            memcpy(place, &value, sizeof value);
    }
    if (failed)
        return -1;
    return PyDict_GET_SIZE(own) == (Py_ssize_t)n ? 0 : raise_unknown(own, what, fields, n);
}

/* ---------------------------------------------------------------- long calls */

double bd_py_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int bd_py_between_chunks(PyObject *progress, long long done, long long total)
{
    if (PyErr_CheckSignals() == 0) {
        if (progress == Py_None)
            return 0;
        PyObject *answer = PyObject_CallFunction(progress, "LL", done, total);
        Py_XDECREF(answer);
        if (answer)
            return 0;
    }
    if (!PyErr_ExceptionMatches(PyExc_KeyboardInterrupt))
        return -1;
    PyErr_Clear();
    return 1;
}

int bd_py_after_chunk(PyObject *progress, double took, int done, int total, int *chunk)
{
    if (took < 0.5 * BD_PY_CHUNK_SECONDS && *chunk < 1000000)
        *chunk *= 2;
    else if (took > BD_PY_CHUNK_SECONDS && *chunk > 1)
        *chunk /= 2;
    const int stop = bd_py_between_chunks(progress, done, total);
    if (stop > 0)
        PyErr_SetNone(PyExc_KeyboardInterrupt);
    return stop ? -1 : 0;
}
