/* _coremodule.c - the binding: the only file that includes Python.h.
 *
 * Every function casts and checks its arguments, copies what it will read without the GIL, calls the core
 * and turns a status into an exception or a report. Inputs are never written to. */
#define PY_SSIZE_T_CLEAN
#include <Python.h>
#define NPY_NO_DEPRECATED_API NPY_2_0_API_VERSION
#include <limits.h>
#include <math.h>
#include <numpy/arrayobject.h>
#include <stdint.h>
#include <string.h>
#include <time.h>

#include "bearingdyn.h"

typedef struct module_state {
    bd_lapack lapack;
    PyTypeObject *model_type;
} module_state;

/* ---------------------------------------------------------------- LAPACK from SciPy */

/* One letter per argument of a capsule's signature: c char, i int, d double, z complex, ? anything else.
 * Compared by class, not by text, because SciPy's typedef names change between versions. */
static int argument_classes(const char *signature, char *classes, size_t room)
{
    const char *at = strchr(signature, '(');
    size_t n = 0;
    while (at && *at && *at != ')' && n + 1 < room) {
        const char *begin = at + 1, *end = begin + strcspn(begin, ",)");
        size_t length = (size_t)(end - begin);
        char text[128] = {0};
        memcpy(text, begin, length < sizeof text - 1 ? length : sizeof text - 1);
        if (strstr(text, "int64") || strstr(text, "long") || strstr(text, "float"))
            classes[n] = '?';
        else if (strstr(text, "complex") || strstr(text, "_z *"))
            classes[n] = 'z';
        else if (strstr(text, "double") || strstr(text, "_d *"))
            classes[n] = 'd';
        else if (strstr(text, "char"))
            classes[n] = 'c';
        else if (strstr(text, "int *"))
            classes[n] = 'i';
        else
            classes[n] = '?';
        n++;
        at = end;
    }
    classes[n] = 0;
    return (int)n;
}

static int load_routine(PyObject *table, const char *name, const char *expected, void *slot)
{
    PyObject *capsule = PyDict_GetItemString(table, name);
    char classes[32];
    if (!capsule || !PyCapsule_CheckExact(capsule)) {
        PyErr_Format(PyExc_ImportError, "SciPy's LAPACK has no routine %s", name);
        return -1;
    }
    const char *signature = PyCapsule_GetName(capsule);
    argument_classes(signature ? signature : "", classes, sizeof classes);
    if (strcmp(classes, expected) != 0) {
        PyErr_Format(PyExc_ImportError,
                     "SciPy's %s has the signature \"%s\"; bearingdyn needs 32-bit integers and "
                     "doubles: install a SciPy built without 64-bit LAPACK integers",
                     name, signature);
        return -1;
    }
    void *pointer = PyCapsule_GetPointer(capsule, signature);
    if (!pointer)
        return -1;
    memcpy(slot, &pointer, sizeof pointer); /* ISO C has no cast from void * to a function */
    return 0;
}

static int load_lapack(bd_lapack *lapack)
{
    PyObject *module = PyImport_ImportModule("scipy.linalg.cython_lapack");
    PyObject *table = module ? PyObject_GetAttrString(module, "__pyx_capi__") : NULL;
    int failed = !table || load_routine(table, "dgetrf", "iidiii", &lapack->dgetrf) ||
                 load_routine(table, "dgetrs", "ciidiidii", &lapack->dgetrs) ||
                 load_routine(table, "zgetrf", "iiziii", &lapack->zgetrf) ||
                 load_routine(table, "zgetrs", "ciiziizii", &lapack->zgetrs);
    Py_XDECREF(table);
    Py_XDECREF(module);
    return failed ? -1 : 0;
}

/* ---------------------------------------------------------------- arguments */

/* Raise what a status stands for. Always returns NULL. */
static PyObject *raise_status(bd_status status, const char *what)
{
    if (status == BD_NO_MEMORY)
        return PyErr_NoMemory();
    PyErr_Format(status == BD_BAD_SHAPE || status == BD_BAD_VALUE ? PyExc_ValueError
                                                                  : PyExc_ArithmeticError,
                 "%s: %s", what, bd_status_text(status));
    return NULL;
}

/* A private C-contiguous copy of `object` as doubles (or ints) of the given shape, kept alive by the list
 * `keep`; -1 leaves a dimension free. NULL with an exception where it does not fit. */
static PyArrayObject *private_copy(PyObject *keep, PyObject *object, int type, const char *name,
                                   int n_dims, npy_intp rows, npy_intp columns)
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

/* 0, or -1 with an exception that names what is not finite. */
static int require_finite(const double *values, npy_intp n, const char *name)
{
    for (npy_intp i = 0; i < n; i++)
        if (!isfinite(values[i])) {
            PyErr_Format(PyExc_ValueError, "%s must be finite", name);
            return -1;
        }
    return 0;
}

static double *doubles(PyObject *keep, PyObject *object, const char *name, int n_dims,
                       npy_intp rows, npy_intp columns)
{
    PyArrayObject *array = private_copy(keep, object, NPY_DOUBLE, name, n_dims, rows, columns);
    if (!array || require_finite(PyArray_DATA(array), PyArray_SIZE(array), name))
        return NULL;
    return PyArray_DATA(array);
}

/* The number of rows of the array kept last. */
static npy_intp rows_of_last(PyObject *keep)
{
    return PyArray_DIM((PyArrayObject *)PyList_GET_ITEM(keep, PyList_GET_SIZE(keep) - 1), 0);
}

static npy_intp columns_of_last(PyObject *keep)
{
    return PyArray_DIM((PyArrayObject *)PyList_GET_ITEM(keep, PyList_GET_SIZE(keep) - 1), 1);
}

/* Scratch that lives as long as the list. */
static void *scratch(PyObject *keep, size_t count, size_t size)
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

static PyObject *new_array(int n_dims, npy_intp rows, npy_intp columns)
{
    npy_intp shape[2] = {rows, columns};
    return PyArray_ZEROS(n_dims, shape, NPY_DOUBLE, 0);
}

static double *data_of(PyObject *array)
{
    return PyArray_DATA((PyArrayObject *)array);
}

/* Whether a number read as a double stands for an int of 0 ... limit. */
static int whole(double value, double limit)
{
    return value >= 0.0 && value <= limit && value == floor(value);
}

/* (spin_ratio, ball_diameter, inner_radius, outer_radius, waves, pits, oversize): waves are rows of kind, order,
 * ball, amplitude, phase; pits of kind, ball, angle, width, depth; oversize (Z,) or empty. */
static int parse_imperfections(PyObject *keep, PyObject *tuple, bd_bearing_data *bearing)
{
    PyObject *waves_in, *pits_in, *oversize_in;
    if (!PyTuple_Check(tuple) ||
        !PyArg_ParseTuple(tuple, "ddddOOO:imperfections", &bearing->spin_ratio,
                          &bearing->ball_diameter, &bearing->inner_radius, &bearing->outer_radius,
                          &waves_in, &pits_in, &oversize_in)) {
        if (!PyErr_Occurred())
            PyErr_SetString(PyExc_TypeError, "imperfections must be a tuple of 7 values");
        return -1;
    }
    const double *wave = doubles(keep, waves_in, "waves", 2, -1, 5);
    const npy_intp n_waves = wave ? rows_of_last(keep) : 0;
    const double *pit = wave ? doubles(keep, pits_in, "pits", 2, -1, 5) : NULL;
    const npy_intp n_pits = pit ? rows_of_last(keep) : 0;
    const double *oversize = pit ? doubles(keep, oversize_in, "oversize", 1, -1, -1) : NULL;
    if (!oversize)
        return -1;
    const npy_intp n_sizes = rows_of_last(keep);
    if (n_waves > 100000 || n_pits > 100000 || (n_sizes != 0 && n_sizes != bearing->n_balls)) {
        PyErr_SetString(PyExc_ValueError,
                        "waves, pits: too many; oversize: one value for each ball");
        return -1;
    }
    bd_wave *waves = scratch(keep, (size_t)n_waves, sizeof *waves);
    bd_pit *pits = waves ? scratch(keep, (size_t)n_pits, sizeof *pits) : NULL;
    if (!pits)
        return -1;
    for (npy_intp w = 0; w < n_waves; w++, wave += 5) {
        if (!whole(wave[0], BD_WAVE_BALL) || !whole(wave[1], 1e6) || !whole(wave[2], 1e6)) {
            PyErr_SetString(PyExc_ValueError,
                            "waves: kind, order and ball must be whole numbers in range");
            return -1;
        }
        waves[w] = (bd_wave){(bd_wave_kind)wave[0], (int)wave[1], (int)wave[2], wave[3], wave[4]};
    }
    for (npy_intp p = 0; p < n_pits; p++, pit += 5) {
        if (!whole(pit[0], BD_PIT_BALL) || !whole(pit[1], 1e6)) {
            PyErr_SetString(PyExc_ValueError, "pits: kind and ball must be whole numbers in range");
            return -1;
        }
        pits[p] = (bd_pit){(bd_pit_kind)pit[0], (int)pit[1], pit[2], pit[3], pit[4]};
    }
    bearing->n_waves = (int)n_waves;
    bearing->n_pits = (int)n_pits;
    bearing->waves = waves;
    bearing->pits = pits;
    bearing->oversize = n_sizes > 0 ? oversize : NULL;
    return 0;
}

/* (Z, order, sine, n_radial, x0, y0, A, e0, kappa, h0, law, c, table, cage_ratio, angle0,
 * imperfections) */
static int parse_bearing(PyObject *keep, PyObject *tuple, bd_bearing_data *bearing)
{
    PyObject *order, *sine, *table, *imperfections;
    int law;
    if (!PyTuple_Check(tuple) ||
        !PyArg_ParseTuple(tuple, "iOOiddddddidOddO:bearing", &bearing->n_balls, &order, &sine,
                          &bearing->n_radial, &bearing->x0, &bearing->y0, &bearing->A, &bearing->e0,
                          &bearing->contact.kappa, &bearing->contact.h0, &law, &bearing->contact.c,
                          &table, &bearing->cage_ratio, &bearing->angle0, &imperfections)) {
        if (!PyErr_Occurred())
            PyErr_SetString(PyExc_TypeError, "a bearing must be a tuple of 16 values");
        return -1;
    }
    PyArrayObject *orders = private_copy(keep, order, NPY_INT, "bearing order", 1, -1, -1);
    if (!orders)
        return -1;
    npy_intp n_coefs = PyArray_DIM(orders, 0);
    PyArrayObject *sines = private_copy(keep, sine, NPY_INT, "bearing sine", 1, n_coefs, -1);
    double *points = sines ? doubles(keep, table, "damping table", 2, -1, 2) : NULL;
    if (!points)
        return -1;
    npy_intp n_table = rows_of_last(keep);
    double *columns = scratch(keep, 2 * (size_t)n_table, sizeof *columns);
    if (!columns)
        return -1;
    for (npy_intp i = 0; i < n_table; i++) {
        columns[i] = points[2 * i];
        columns[n_table + i] = points[2 * i + 1];
    }
    if (law < 0 || law > BD_DAMPING_LOAD || bearing->n_balls < 1 || bearing->n_balls > 100000 ||
        n_coefs < 1 || n_coefs > 100000 || n_table > INT_MAX) {
        PyErr_SetString(PyExc_ValueError,
                        "bearing: number of balls, of coefficients or the damping law "
                        "is outside its range");
        return -1;
    }
    bearing->n_coefs = (int)n_coefs;
    bearing->order = PyArray_DATA(orders);
    bearing->sine = PyArray_DATA(sines);
    bearing->contact.law = (bd_damping_law)law;
    bearing->contact.n_table = (int)n_table;
    bearing->contact.table_delta = columns;
    bearing->contact.table_c = columns + n_table;
    return parse_imperfections(keep, imperfections, bearing);
}

/* ---------------------------------------------------------------- functions without a model */

PyDoc_STRVAR(maxwell_stress_doc,
             "maxwell_stress(rate, dt, G0, eta0, modulus, tau) -> stress\n\n"
             "rate (n, m), dt (n - 1,); see bd_maxwell_stress in bearingdyn.h.");

static PyObject *maxwell_stress(PyObject *module, PyObject *args)
{
    PyObject *rate_in, *dt_in, *modulus_in, *tau_in, *stress = NULL;
    double G0, eta0;
    (void)module;
    if (!PyArg_ParseTuple(args, "OOddOO:maxwell_stress", &rate_in, &dt_in, &G0, &eta0, &modulus_in,
                          &tau_in))
        return NULL;
    PyObject *keep = PyList_New(0);
    if (!keep)
        return NULL;

    const double *rate = doubles(keep, rate_in, "rate", 2, -1, -1);
    npy_intp n = rate ? rows_of_last(keep) : 0, m = rate ? columns_of_last(keep) : 0;
    const double *dt = rate ? doubles(keep, dt_in, "dt", 1, n > 0 ? n - 1 : 0, -1) : NULL;
    const double *modulus = dt ? doubles(keep, modulus_in, "modulus", 1, -1, -1) : NULL;
    npy_intp branches = modulus ? rows_of_last(keep) : 0;
    const double *tau = modulus ? doubles(keep, tau_in, "tau", 1, branches, -1) : NULL;
    if (!tau)
        goto done;
    if (n > INT_MAX || m > INT_MAX - BD_LANES || branches > INT_MAX) {
        PyErr_SetString(PyExc_ValueError, "rate, modulus: too many values");
        goto done;
    }
    if (require_finite(&G0, 1, "G0") || require_finite(&eta0, 1, "eta0"))
        goto done;
    for (npy_intp i = 0; i < n - 1; i++)
        if (!(dt[i] > 0.0)) {
            PyErr_Format(PyExc_ValueError, "dt[%zd] must be positive", (Py_ssize_t)i);
            goto done;
        }
    for (npy_intp i = 0; i < branches; i++)
        if (!(tau[i] > 0.0) || !(modulus[i] >= 0.0)) {
            PyErr_Format(PyExc_ValueError, "branch %zd needs tau > 0 and modulus >= 0",
                         (Py_ssize_t)i);
            goto done;
        }
    double *work = scratch(keep, bd_maxwell_stress_work_size((int)m, (int)branches), sizeof *work);
    stress = work ? new_array(2, n, m) : NULL;
    if (stress) {
        double *out = data_of(stress);
        Py_BEGIN_ALLOW_THREADS bd_maxwell_stress((int)n, (int)m, rate, dt, G0, eta0, (int)branches,
                                                 modulus, tau, out, work);
        Py_END_ALLOW_THREADS
    }
done:
    Py_DECREF(keep);
    return stress;
}

PyDoc_STRVAR(bearing_force_doc,
             "bearing_force(bearing, z, z_rate, angle, cage_speed, shaft_angle, shaft_speed)\n"
             "-> g, K, C, loads\n\n"
             "Force and tangents of one bearing on its coefficients z (n,).");

static PyObject *bearing_force(PyObject *module, PyObject *args)
{
    PyObject *tuple, *z_in, *rate_in, *result = NULL;
    double angle, cage_speed;
    bd_turn shaft = {0};
    bd_bearing_data bearing = {0};
    (void)module;
    if (!PyArg_ParseTuple(args, "OOOdddd:bearing_force", &tuple, &z_in, &rate_in, &angle,
                          &cage_speed, &shaft.angle, &shaft.speed))
        return NULL;
    PyObject *keep = PyList_New(0);
    if (!keep)
        return NULL;
    PyObject *g = NULL, *K = NULL, *C = NULL, *loads = NULL;
    if (parse_bearing(keep, tuple, &bearing))
        goto done;
    bd_status status = bd_bearing_check(&bearing);
    if (status != BD_OK) {
        raise_status(status, "bearing");
        goto done;
    }
    const double *z = doubles(keep, z_in, "z", 1, bearing.n_coefs, -1);
    const double *rate = z ? doubles(keep, rate_in, "z_rate", 1, bearing.n_coefs, -1) : NULL;
    if (!rate || require_finite(&angle, 1, "angle") ||
        require_finite(&cage_speed, 1, "cage_speed") ||
        require_finite(&shaft.angle, 1, "shaft_angle") ||
        require_finite(&shaft.speed, 1, "shaft_speed"))
        goto done;
    g = new_array(1, bearing.n_coefs, 0);
    K = new_array(2, bearing.n_coefs, bearing.n_coefs);
    C = new_array(2, bearing.n_coefs, bearing.n_coefs);
    loads = new_array(1, bearing.n_balls, 0);
    if (!g || !K || !C || !loads)
        goto done;
    status = bd_bearing_single(&bearing, z, rate, angle, cage_speed, shaft, data_of(g), data_of(K),
                               data_of(C), data_of(loads));
    if (status != BD_OK)
        raise_status(status, "bearing_force");
    else
        result = PyTuple_Pack(4, g, K, C, loads);
done:
    Py_XDECREF(g);
    Py_XDECREF(K);
    Py_XDECREF(C);
    Py_XDECREF(loads);
    Py_DECREF(keep);
    return result;
}

PyDoc_STRVAR(status_text_doc, "status_text(status) -> str\n\nWhat a status of the core means.");

static PyObject *status_text(PyObject *module, PyObject *args)
{
    int status;
    (void)module;
    if (!PyArg_ParseTuple(args, "i:status_text", &status))
        return NULL;
    return PyUnicode_FromString(bd_status_text((bd_status)status));
}

/* ---------------------------------------------------------------- Model */

typedef struct model_object {
    PyObject_HEAD bd_model *model;
} model_object;

/* An array of `size`-byte records for the items of a tuple, or NULL with an exception. */
static void *records(PyObject *keep, PyObject *items, size_t size)
{
    Py_ssize_t n = PyTuple_GET_SIZE(items);
    if (n > 1000000) {
        PyErr_SetString(PyExc_ValueError, "too many layers, bearings, loads or channels");
        return NULL;
    }
    return scratch(keep, (size_t)n, size);
}

/* The items of a sequence of tuples as a tuple of our own, kept alive by `keep`: converting an item may run
 * any code, which must not change the sequence under our feet. */
static PyObject *sequence(PyObject *keep, PyObject *object, const char *name)
{
    PyObject *items = PySequence_Tuple(object);
    if (!items && PyErr_ExceptionMatches(PyExc_TypeError))
        PyErr_Format(PyExc_TypeError, "%s must be a sequence of tuples", name);
    if (!items)
        return NULL;
    int failed = PyList_Append(keep, items);
    Py_DECREF(items);
    for (Py_ssize_t i = 0; !failed && i < PyTuple_GET_SIZE(items); i++)
        if (!PyTuple_Check(PyTuple_GET_ITEM(items, i))) {
            PyErr_Format(PyExc_TypeError, "%s[%zd] must be a tuple", name, i);
            failed = 1;
        }
    return failed ? NULL : items;
}

static int parse_layers(PyObject *keep, PyObject *items, npy_intp n, bd_layer_data *layers)
{
    for (Py_ssize_t l = 0; l < PyTuple_GET_SIZE(items); l++) {
        PyObject *L_in, *modulus_in, *tau_in;
        if (!PyArg_ParseTuple(PyTuple_GET_ITEM(items, l), "OOO:layer", &L_in, &modulus_in, &tau_in))
            return -1;
        layers[l].L = doubles(keep, L_in, "layer L", 2, n, -1);
        if (!layers[l].L)
            return -1;
        npy_intp rank = columns_of_last(keep);
        layers[l].modulus = doubles(keep, modulus_in, "layer modulus", 1, -1, -1);
        if (!layers[l].modulus)
            return -1;
        npy_intp branches = rows_of_last(keep);
        layers[l].tau = doubles(keep, tau_in, "layer tau", 1, branches, -1);
        if (!layers[l].tau)
            return -1;
        layers[l].rank = (int)Py_MIN(rank, INT_MAX);
        layers[l].n_branches = (int)Py_MIN(branches, INT_MAX);
    }
    return 0;
}

static int parse_bearings(PyObject *keep, PyObject *items, npy_intp n, bd_bearing_data *bearings,
                          const double **B)
{
    for (Py_ssize_t b = 0; b < PyTuple_GET_SIZE(items); b++) {
        PyObject *tuple, *B_in;
        if (!PyArg_ParseTuple(PyTuple_GET_ITEM(items, b), "OO:bearing", &tuple, &B_in) ||
            parse_bearing(keep, tuple, &bearings[b]))
            return -1;
        B[b] = doubles(keep, B_in, "bearing B", 2, bearings[b].n_coefs, n);
        if (!B[b])
            return -1;
    }
    return 0;
}

static int parse_loads(PyObject *keep, PyObject *items, npy_intp n, bd_load_data *loads)
{
    for (Py_ssize_t k = 0; k < PyTuple_GET_SIZE(items); k++) {
        PyObject *cos_in, *sin_in, *time_in, *value_in;
        int kind;
        if (!PyArg_ParseTuple(PyTuple_GET_ITEM(items, k), "idOOOO:load", &kind, &loads[k].omega,
                              &cos_in, &sin_in, &time_in, &value_in))
            return -1;
        if (kind < 0 || kind > BD_LOAD_SAMPLED) {
            PyErr_Format(PyExc_ValueError, "load kind %d is unknown", kind);
            return -1;
        }
        loads[k].kind = (bd_load_kind)kind;
        loads[k].p_cos = doubles(keep, cos_in, "load p_cos", 1, n, -1);
        loads[k].p_sin = loads[k].p_cos ? doubles(keep, sin_in, "load p_sin", 1, n, -1) : NULL;
        loads[k].time = loads[k].p_sin ? doubles(keep, time_in, "load time", 1, -1, -1) : NULL;
        if (!loads[k].time)
            return -1;
        npy_intp samples = rows_of_last(keep);
        loads[k].value = doubles(keep, value_in, "load value", 1, samples, -1);
        if (!loads[k].value)
            return -1;
        loads[k].n_samples = (int)Py_MIN(samples, INT_MAX);
    }
    return 0;
}

static int parse_channels(PyObject *keep, PyObject *items, npy_intp n, bd_channel_data *channels)
{
    for (Py_ssize_t c = 0; c < PyTuple_GET_SIZE(items); c++) {
        PyObject *row_in;
        int kind;
        if (!PyArg_ParseTuple(PyTuple_GET_ITEM(items, c), "iOii:channel", &kind, &row_in,
                              &channels[c].bearing, &channels[c].index))
            return -1;
        if (kind < 0 || kind > BD_CHANNEL_BRANCH_LOSS) {
            PyErr_Format(PyExc_ValueError, "channel kind %d is unknown", kind);
            return -1;
        }
        channels[c].kind = (bd_channel_kind)kind;
        channels[c].row = NULL;
        if (kind <= BD_CHANNEL_ACCELERATION) {
            channels[c].row = doubles(keep, row_in, "channel row", 1, n, -1);
            if (!channels[c].row)
                return -1;
        }
    }
    return 0;
}

PyDoc_STRVAR(
    model_doc,
    "Model(M, C, G, K, N, layers, bearings, loads, channels)\n\n"
    "Immutable; arrays are copied. layers: (L, modulus, tau); bearings: (kernel tuple, B);\n"
    "loads: (kind, omega, p_cos, p_sin, time, value); channels: (kind, row, bearing, index).\n"
    "See bd_model_data in bearingdyn.h.");

static PyObject *model_new(PyTypeObject *type, PyObject *args, PyObject *keywords)
{
    PyObject *in[9], *items[4];
    static char *names[] = {"M",      "C",        "G",     "K",        "N",
                            "layers", "bearings", "loads", "channels", NULL};
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OOOOOOOOO:Model", names, &in[0], &in[1],
                                     &in[2], &in[3], &in[4], &in[5], &in[6], &in[7], &in[8]))
        return NULL;
    PyObject *keep = PyList_New(0);
    if (!keep)
        return NULL;
    model_object *self = NULL;
    bd_model_data data = {0};

    data.M = doubles(keep, in[0], "M", 2, -1, -1);
    if (!data.M)
        goto done;
    npy_intp n = rows_of_last(keep);
    if (n != columns_of_last(keep) || n < 1 || n > 30000) {
        PyErr_Format(PyExc_ValueError, "M must be square with 1 to 30000 rows, not %zd",
                     (Py_ssize_t)n);
        goto done;
    }
    data.n = (int)n;
    if (!(data.C = doubles(keep, in[1], "C", 2, n, n)) ||
        !(data.G = doubles(keep, in[2], "G", 2, n, n)) ||
        !(data.K = doubles(keep, in[3], "K", 2, n, n)) ||
        !(data.N = doubles(keep, in[4], "N", 2, n, n)))
        goto done;
    for (int i = 0; i < 4; i++)
        if (!(items[i] = sequence(keep, in[5 + i], names[5 + i])))
            goto done;

    bd_layer_data *layers = records(keep, items[0], sizeof *layers);
    bd_bearing_data *bearings = layers ? records(keep, items[1], sizeof *bearings) : NULL;
    const double **B = bearings ? records(keep, items[1], sizeof *B) : NULL;
    bd_load_data *loads = B ? records(keep, items[2], sizeof *loads) : NULL;
    bd_channel_data *channels = loads ? records(keep, items[3], sizeof *channels) : NULL;
    if (!channels || parse_layers(keep, items[0], n, layers) ||
        parse_bearings(keep, items[1], n, bearings, B) || parse_loads(keep, items[2], n, loads) ||
        parse_channels(keep, items[3], n, channels))
        goto done;
    data.n_layers = (int)PyTuple_GET_SIZE(items[0]);
    data.n_bearings = (int)PyTuple_GET_SIZE(items[1]);
    data.n_loads = (int)PyTuple_GET_SIZE(items[2]);
    data.n_channels = (int)PyTuple_GET_SIZE(items[3]);
    data.layers = layers;
    data.bearings = bearings;
    data.B = B;
    data.loads = loads;
    data.channels = channels;

    bd_status status;
    bd_model *model = bd_model_create(&data, &status);
    if (!model) {
        raise_status(status, "Model");
        goto done;
    }
    self = (model_object *)type->tp_alloc(type, 0);
    if (self)
        self->model = model;
    else
        bd_model_free(model);
done:
    Py_DECREF(keep);
    return (PyObject *)self;
}

static void model_dealloc(PyObject *object)
{
    PyTypeObject *type = Py_TYPE(object);
    bd_model_free(((model_object *)object)->model);
    type->tp_free(object);
    Py_DECREF(type);
}

static const bd_model *model_of(PyObject *object)
{
    return ((model_object *)object)->model;
}

PyDoc_STRVAR(model_state_doc, "state(t, x, v) -> state\n\nA flat state at rest in its branches.");

static PyObject *model_state(PyObject *object, PyObject *args)
{
    const bd_model *model = model_of(object);
    PyObject *x_in, *v_in, *state = NULL;
    double t;
    if (!PyArg_ParseTuple(args, "dOO:state", &t, &x_in, &v_in))
        return NULL;
    PyObject *keep = PyList_New(0);
    if (!keep)
        return NULL;
    const double *x = doubles(keep, x_in, "x", 1, bd_model_size(model), -1);
    const double *v = x ? doubles(keep, v_in, "v", 1, bd_model_size(model), -1) : NULL;
    if (v && !require_finite(&t, 1, "t") &&
        (state = new_array(1, (npy_intp)bd_state_size(model), 0)))
        bd_state_set(model, data_of(state), t, x, v);
    Py_DECREF(keep);
    return state;
}

/* A private copy of a state of this model. */
static double *state_of(PyObject *keep, const bd_model *model, PyObject *object)
{
    double *state = doubles(keep, object, "state", 1, (npy_intp)bd_state_size(model), -1);
    if (state &&
        !(state[1] >= 0.0 && state[1] < 9007199254740992.0 && state[2] >= 0.0)) { /* 2^53 */
        PyErr_SetString(PyExc_ValueError,
                        "state must come from this model: its count of steps is impossible");
        return NULL;
    }
    return state;
}

PyDoc_STRVAR(model_unpack_doc,
             "unpack(state) -> t, x, v, a, energy\n\n"
             "energy: kinetic, elastic, stored, indentation; work of load, turning,\n"
             "linear, branch, contact; throughput (J).");

static PyObject *model_unpack(PyObject *object, PyObject *args)
{
    const bd_model *model = model_of(object);
    PyObject *state_in, *result = NULL;
    double t;
    if (!PyArg_ParseTuple(args, "O:unpack", &state_in))
        return NULL;
    PyObject *keep = PyList_New(0);
    if (!keep)
        return NULL;
    PyObject *x = NULL, *v = NULL, *a = NULL, *energy = NULL;
    double *state = state_of(keep, model, state_in);
    if (state) {
        x = new_array(1, bd_model_size(model), 0);
        v = new_array(1, bd_model_size(model), 0);
        a = new_array(1, bd_model_size(model), 0);
        energy = new_array(1, 10, 0);
        if (x && v && a && energy) {
            bd_state_get(model, state, &t, data_of(x), data_of(v), data_of(a));
            memcpy(data_of(energy), bd_state_view(model, state).energy, 10 * sizeof(double));
            result = Py_BuildValue("dOOOO", t, x, v, a, energy);
        }
    }
    Py_XDECREF(x);
    Py_XDECREF(v);
    Py_XDECREF(a);
    Py_XDECREF(energy);
    Py_DECREF(keep);
    return result;
}

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Between two chunks of a long call: signals and progress.
 * Returned: 0 to go on, 1 when the user interrupts (the exception is cleared), -1 with an exception. */
static int between_chunks(PyObject *progress, long long done, long long total)
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

/* How long a chunk may keep the interpreter waiting: Ctrl-C is honoured within twice this. */
static const double chunk_seconds = 0.05;

PyDoc_STRVAR(
    model_march_doc,
    "march(state, steps, decimate, dt, beta, gamma, times, speeds, tolerance, max_iterations, "
    "audit,\n"
    "      isa, start, progress) -> record, state, report\n\n"
    "The GIL is released. A new state is returned; the one given is not touched. progress(done,\n"
    "total) is called every 0.05 s. report: status, steps, iterations, refreshes, refactors, t, "
    "residual,\n"
    "bearing. An interrupt (Ctrl-C) ends the march with status 1 and what was recorded, be\n"
    "it in the last of its steps.");

static PyObject *model_march(PyObject *object, PyObject *args)
{
    const bd_model *model = model_of(object);
    PyObject *state_in, *time_in, *speed_in, *progress, *result = NULL;
    long long steps, decimate;
    int start, isa;
    bd_scheme scheme;
    if (!PyArg_ParseTuple(args, "OLLdddOOdipipO:march", &state_in, &steps, &decimate, &scheme.dt,
                          &scheme.beta, &scheme.gamma, &time_in, &speed_in, &scheme.tolerance,
                          &scheme.max_iterations, &scheme.audit, &isa, &start, &progress))
        return NULL;
    scheme.isa = (bd_isa)isa;
    if (steps < 0 || steps >= 1LL << 53 || decimate < 1) {
        PyErr_SetString(PyExc_ValueError, "steps must be 0 to 2**53 - 1 and decimate at least 1");
        return NULL;
    }
    module_state *module = PyType_GetModuleState(Py_TYPE(object));
    PyObject *keep = PyList_New(0);
    if (!module || !keep) {
        Py_XDECREF(keep);
        return NULL;
    }

    const npy_intp channels = bd_model_channels(model);
    PyObject *state = NULL, *record = NULL;
    bd_work *work = NULL;
    const double *given = state_of(keep, model, state_in);
    if (!given || !(scheme.speed.time = doubles(keep, time_in, "speed time", 1, -1, -1)))
        goto done;
    scheme.speed.n = (int)Py_MIN(rows_of_last(keep), INT_MAX);
    if (!(scheme.speed.value = doubles(keep, speed_in, "speed value", 1, scheme.speed.n, -1)))
        goto done;
    state = new_array(1, (npy_intp)bd_state_size(model), 0);
    record = new_array(2, (npy_intp)(steps / decimate + 1), channels);
    work = bd_work_create(model);
    if (!state || !record || !work) {
        if (!work)
            PyErr_NoMemory();
        goto done;
    }
    memcpy(data_of(state), given, bd_state_size(model) * sizeof(double));

    double *flat = data_of(state), *rows = data_of(record);
    bd_status status = BD_OK;
    Py_BEGIN_ALLOW_THREADS if (start) status =
        bd_start(model, &scheme, &module->lapack, work, flat);
    if (status == BD_OK)
        status = bd_prepare(model, &scheme, &module->lapack,
                            bd_reference_speed(model, &scheme, flat, start != 0), work);
    Py_END_ALLOW_THREADS if (status == BD_BAD_VALUE || status == BD_NO_MEMORY)
    {
        raise_status(status, "march: dt, beta, gamma, speed, tolerance or max_iterations");
        goto done;
    }

    bd_report total = {.status = status, .bearing = -1}, report = {0};
    long long kept = 0, chunk = 1;
    bd_state_get(model, flat, &total.t, NULL, NULL, NULL);
    while (total.status == BD_OK && total.steps < steps) {
        const long long now = Py_MIN(chunk, steps - total.steps);
        const double began = seconds();
        Py_BEGIN_ALLOW_THREADS kept +=
            bd_march(model, &scheme, work, flat, now, decimate, rows + kept * channels, &report);
        Py_END_ALLOW_THREADS const double took = seconds() - began;

        total.status = report.status;
        total.steps += report.steps;
        total.iterations += report.iterations;
        total.refreshes += report.refreshes;
        total.grazing += report.grazing;
        total.t = report.t;
        total.residual = report.residual;
        total.bearing = report.bearing;
        if (report.status == BD_REFACTOR) { /* the speed has moved on: factor where it is now */
            Py_BEGIN_ALLOW_THREADS total.status =
                bd_prepare(model, &scheme, &module->lapack,
                           bd_reference_speed(model, &scheme, flat, true), work);
            Py_END_ALLOW_THREADS total.refactors++;
        }
        if (took < 0.5 * chunk_seconds && report.steps == now) /* not cut short by a refactoring */
            chunk *= 2;
        else if (took > chunk_seconds && chunk > 1)
            chunk /= 2;

        const int stop = between_chunks(progress, total.steps, steps);
        if (stop < 0)
            goto done;
        if (stop > 0 && total.status == BD_OK)
            total.status = BD_INTERRUPTED;
    }
    PyObject *used = PySequence_GetSlice(record, 0, (Py_ssize_t)kept);
    if (used)
        result = Py_BuildValue("NO(iLLLLLddi)", used, state, (int)total.status, total.steps,
                               total.iterations, total.refreshes, total.refactors, total.grazing,
                               total.t, total.residual, total.bearing);
done:
    bd_work_free(work);
    Py_XDECREF(state);
    Py_XDECREF(record);
    Py_DECREF(keep);
    return result;
}

PyDoc_STRVAR(
    model_harmonic_doc,
    "harmonic(omega, speed, modulus, bearing_K, bearing_C, force, row, progress) -> response\n\n"
    "omega (f,), modulus (f, layers) complex, bearing_K and bearing_C (coefs, coefs),\n"
    "force (inputs, n), row (outputs, n); response (f, outputs, inputs) complex.");

static PyObject *model_harmonic(PyObject *object, PyObject *args)
{
    const bd_model *model = model_of(object);
    PyObject *omega_in, *modulus_in, *K_in, *C_in, *force_in, *row_in, *progress, *response = NULL;
    bd_harmonic_data data = {0};
    if (!PyArg_ParseTuple(args, "OdOOOOOO:harmonic", &omega_in, &data.speed, &modulus_in, &K_in,
                          &C_in, &force_in, &row_in, &progress))
        return NULL;
    module_state *module = PyType_GetModuleState(Py_TYPE(object));
    PyObject *keep = PyList_New(0);
    if (!module || !keep) {
        Py_XDECREF(keep);
        return NULL;
    }

    const npy_intp n = bd_model_size(model), coefs = bd_model_coefs(model);
    bd_harmonic_work *work = NULL;
    if (!(data.omega = doubles(keep, omega_in, "omega", 1, -1, -1)))
        goto done;
    const npy_intp n_omega = rows_of_last(keep);
    PyArrayObject *modulus =
        private_copy(keep, modulus_in, NPY_CDOUBLE, "modulus", 2, n_omega, bd_model_layers(model));
    if (require_finite(&data.speed, 1, "speed") || !modulus ||
        require_finite(PyArray_DATA(modulus), 2 * PyArray_SIZE(modulus), "modulus") ||
        !(data.bearing_K = doubles(keep, K_in, "bearing_K", 2, coefs, coefs)) ||
        !(data.bearing_C = doubles(keep, C_in, "bearing_C", 2, coefs, coefs)) ||
        !(data.force = doubles(keep, force_in, "force", 2, -1, n)))
        goto done;
    const npy_intp n_in = rows_of_last(keep);
    if (!(data.row = doubles(keep, row_in, "row", 2, -1, n)))
        goto done;
    const npy_intp n_out = rows_of_last(keep);
    if (n_omega > INT_MAX || n_in > 100000 || n_out > 100000) {
        PyErr_SetString(PyExc_ValueError, "harmonic: too many frequencies, inputs or outputs");
        goto done;
    }
    data.modulus = PyArray_DATA(modulus);
    data.n_omega = (int)n_omega;
    data.n_in = (int)n_in;
    data.n_out = (int)n_out;

    npy_intp shape[3] = {n_omega, n_out, n_in};
    response = PyArray_ZEROS(3, shape, NPY_CDOUBLE, 0);
    work = bd_harmonic_work_create(model, &data);
    if (!response || !work) {
        if (!work)
            PyErr_NoMemory();
        goto failed;
    }
    double *out = data_of(response);
    int at = 0, chunk = 1;
    while (at < data.n_omega) {
        const int now = Py_MIN(chunk, data.n_omega - at);
        const double began = seconds();
        bd_status status;
        Py_BEGIN_ALLOW_THREADS status =
            bd_harmonic(model, &data, &module->lapack, work, at, now, out);
        Py_END_ALLOW_THREADS if (status != BD_OK)
        {
            raise_status(status, "harmonic");
            goto failed;
        }
        const double took = seconds() - began;
        at += now;
        if (took < 0.5 * chunk_seconds && chunk < 1000000)
            chunk *= 2;
        else if (took > chunk_seconds && chunk > 1)
            chunk /= 2;
        const int stop = between_chunks(progress, at, data.n_omega);
        if (stop > 0)
            PyErr_SetNone(PyExc_KeyboardInterrupt);
        if (stop != 0)
            goto failed;
    }
    goto done;
failed:
    Py_CLEAR(response);
done:
    bd_harmonic_work_free(work);
    Py_DECREF(keep);
    return response;
}

static PyObject *model_blocks(PyObject *object, void *closure)
{
    (void)closure;
    return PyLong_FromLong(bd_model_blocks(model_of(object)));
}

static PyObject *model_bytes(PyObject *object, void *closure)
{
    (void)closure;
    return PyLong_FromSize_t(bd_model_bytes(model_of(object)));
}

static PyMethodDef model_methods[] = {
    {"state", model_state, METH_VARARGS, model_state_doc},
    {"unpack", model_unpack, METH_VARARGS, model_unpack_doc},
    {"march", model_march, METH_VARARGS, model_march_doc},
    {"harmonic", model_harmonic, METH_VARARGS, model_harmonic_doc},
    {NULL, NULL, 0, NULL},
};

static PyObject *model_channels(PyObject *object, void *closure)
{
    (void)closure;
    return PyLong_FromLong(bd_model_channels(model_of(object)));
}

static PyGetSetDef model_getset[] = {
    {"channels", model_channels, NULL, "Number of recorded channels.", NULL},
    {"blocks", model_blocks, NULL, "Blocks of coordinates that the structure couples.", NULL},
    {"nbytes", model_bytes, NULL, "Bytes that the model keeps.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

/* ISO C has no cast from a function to void *, which slots want; POSIX and CPython do. */
static PyType_Slot model_slots[] = {
    {Py_tp_doc, (void *)(uintptr_t)model_doc},
    {Py_tp_new, (void *)(uintptr_t)model_new},
    {Py_tp_dealloc, (void *)(uintptr_t)model_dealloc},
    {Py_tp_methods, model_methods},
    {Py_tp_getset, model_getset},
    {0, NULL},
};

static PyType_Spec model_spec = {
    .name = "bearingdyn._core.Model",
    .basicsize = sizeof(model_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = model_slots,
};

/* ---------------------------------------------------------------- module */

static PyMethodDef module_methods[] = {
    {"maxwell_stress", maxwell_stress, METH_VARARGS, maxwell_stress_doc},
    {"bearing_force", bearing_force, METH_VARARGS, bearing_force_doc},
    {"status_text", status_text, METH_VARARGS, status_text_doc},
    {NULL, NULL, 0, NULL},
};

static int module_exec(PyObject *module)
{
    module_state *state = PyModule_GetState(module);
    import_array1(-1);
    if (load_lapack(&state->lapack))
        return -1;
    state->model_type = (PyTypeObject *)PyType_FromModuleAndSpec(module, &model_spec, NULL);
    if (!state->model_type)
        return -1;
    return PyModule_AddType(module, state->model_type);
}

static int module_traverse(PyObject *module, visitproc visit, void *arg)
{
    module_state *state = PyModule_GetState(module);
    Py_VISIT(state->model_type);
    return 0;
}

static int module_clear(PyObject *module)
{
    module_state *state = PyModule_GetState(module);
    Py_CLEAR(state->model_type);
    return 0;
}

static void module_free(void *module)
{
    module_clear((PyObject *)module);
}

static PyModuleDef_Slot module_slots[] = {
    {Py_mod_exec, (void *)(uintptr_t)module_exec},
#ifdef Py_mod_gil
    {Py_mod_gil, Py_MOD_GIL_NOT_USED},
#endif
    {0, NULL},
};

static struct PyModuleDef module_definition = {
    PyModuleDef_HEAD_INIT,
    .m_name = "bearingdyn._core",
    .m_doc = "The C core of bearingdyn; imported by bearingdyn.core alone.",
    .m_size = sizeof(module_state),
    .m_methods = module_methods,
    .m_slots = module_slots,
    .m_traverse = module_traverse,
    .m_clear = module_clear,
    .m_free = module_free,
};

PyMODINIT_FUNC PyInit__core(void)
{
    return PyModuleDef_Init(&module_definition);
}
