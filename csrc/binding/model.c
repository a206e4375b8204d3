/* Model: what a march and a harmonic response are of. */
#include "binding.h"

#include <limits.h>

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
    return bd_py_scratch(keep, (size_t)n, size);
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

/* How a layer softens, or NULL with an exception. */
static const bd_softening_data *parse_softening(PyObject *keep, PyObject *tuple, npy_intp rank)
{
    PyObject *strain_in, *table_in;
    bd_softening_data *law = bd_py_scratch(keep, 1, sizeof *law);
    if (!law || !PyTuple_Check(tuple)) {
        if (law)
            PyErr_SetString(PyExc_TypeError, "a layer's softening must be a tuple");
        return NULL;
    }
    if (!PyArg_ParseTuple(tuple, "ddddddddOddO:softening", &law->D, &law->gamma_c, &law->m,
                          &law->Lm, &law->gamma_l, &law->p, &law->memory, &law->pressed, &strain_in,
                          &law->rate_first, &law->rate_last, &table_in))
        return NULL;
    law->strain = bd_py_doubles(keep, strain_in, "softening strain", 1, rank, -1);
    law->table = law->strain ? bd_py_doubles(keep, table_in, "softening table", 2, 2, -1) : NULL;
    if (!law->table)
        return NULL;
    law->n_table = (int)Py_MIN(bd_py_columns(keep), INT_MAX);
    return law;
}

static int parse_layers(PyObject *keep, PyObject *items, npy_intp n, bd_layer_data *layers)
{
    for (Py_ssize_t l = 0; l < PyTuple_GET_SIZE(items); l++) {
        PyObject *L_in, *modulus_in, *tau_in, *softening_in = Py_None;
        if (!PyArg_ParseTuple(PyTuple_GET_ITEM(items, l), "OOO|O:layer", &L_in, &modulus_in,
                              &tau_in, &softening_in))
            return -1;
        layers[l].L = bd_py_doubles(keep, L_in, "layer L", 2, n, -1);
        if (!layers[l].L)
            return -1;
        npy_intp rank = bd_py_columns(keep);
        layers[l].modulus = bd_py_doubles(keep, modulus_in, "layer modulus", 1, -1, -1);
        if (!layers[l].modulus)
            return -1;
        npy_intp branches = bd_py_rows(keep);
        layers[l].tau = bd_py_doubles(keep, tau_in, "layer tau", 1, branches, -1);
        if (!layers[l].tau)
            return -1;
        layers[l].rank = (int)Py_MIN(rank, INT_MAX);
        layers[l].n_branches = (int)Py_MIN(branches, INT_MAX);
        layers[l].softening = NULL;
        if (softening_in != Py_None &&
            !(layers[l].softening = parse_softening(keep, softening_in, rank)))
            return -1;
    }
    return 0;
}

static int parse_bearings(PyObject *keep, PyObject *items, npy_intp n, bd_bearing_data *bearings,
                          const double **B)
{
    for (Py_ssize_t b = 0; b < PyTuple_GET_SIZE(items); b++) {
        PyObject *dict, *B_in;
        if (!PyArg_ParseTuple(PyTuple_GET_ITEM(items, b), "OO:bearing", &dict, &B_in) ||
            bd_py_parse_bearing(keep, dict, &bearings[b]))
            return -1;
        B[b] = bd_py_doubles(keep, B_in, "bearing B", 2, bearings[b].n_coefs, n);
        if (!B[b])
            return -1;
    }
    return 0;
}

static int parse_loads(PyObject *keep, PyObject *items, npy_intp n, bd_load_data *loads)
{
    for (Py_ssize_t k = 0; k < PyTuple_GET_SIZE(items); k++) {
        PyObject *kind_in, *cos_in, *sin_in, *time_in, *value_in;
        int kind;
        if (!PyArg_ParseTuple(PyTuple_GET_ITEM(items, k), "OdOOOO:load", &kind_in, &loads[k].omega,
                              &cos_in, &sin_in, &time_in, &value_in) ||
            bd_py_parse_word(kind_in, "load kind", bd_py_load_kinds, &kind))
            return -1;
        loads[k].kind = (bd_load_kind)kind;
        loads[k].p_cos = bd_py_doubles(keep, cos_in, "load p_cos", 1, n, -1);
        loads[k].p_sin =
            loads[k].p_cos ? bd_py_doubles(keep, sin_in, "load p_sin", 1, n, -1) : NULL;
        loads[k].time =
            loads[k].p_sin ? bd_py_doubles(keep, time_in, "load time", 1, -1, -1) : NULL;
        if (!loads[k].time)
            return -1;
        npy_intp samples = bd_py_rows(keep);
        loads[k].value = bd_py_doubles(keep, value_in, "load value", 1, samples, -1);
        if (!loads[k].value)
            return -1;
        loads[k].n_samples = (int)Py_MIN(samples, INT_MAX);
    }
    return 0;
}

static int parse_channels(PyObject *keep, PyObject *items, npy_intp n, bd_channel_data *channels)
{
    for (Py_ssize_t c = 0; c < PyTuple_GET_SIZE(items); c++) {
        PyObject *kind_in, *row_in;
        int kind;
        if (!PyArg_ParseTuple(PyTuple_GET_ITEM(items, c), "OOii:channel", &kind_in, &row_in,
                              &channels[c].bearing, &channels[c].index) ||
            bd_py_parse_word(kind_in, "channel kind", bd_py_channel_kinds, &kind))
            return -1;
        channels[c].kind = (bd_channel_kind)kind;
        channels[c].row = NULL;
        if (kind <= BD_CHANNEL_ACCELERATION) {
            channels[c].row = bd_py_doubles(keep, row_in, "channel row", 1, n, -1);
            if (!channels[c].row)
                return -1;
        }
    }
    return 0;
}

PyDoc_STRVAR(
    model_doc,
    "Model(M, C, G, K, N, layers, bearings, loads, channels)\n\n"
    "Immutable; arrays are copied. layers: (L, modulus, tau), and softening where a layer "
    "softens,\n"
    "a tuple of bd_softening_data's fields; bearings: (dict, B), see\n"
    "BearingKernel.packed; loads: (kind, omega, p_cos, p_sin, time, value); channels: (kind, row,\n"
    "bearing, index), their kinds words or codes of LOAD_KINDS and CHANNEL_KINDS.\n"
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

    data.M = bd_py_doubles(keep, in[0], "M", 2, -1, -1);
    if (!data.M)
        goto done;
    npy_intp n = bd_py_rows(keep);
    if (n != bd_py_columns(keep) || n < 1 || n > 30000) {
        PyErr_Format(PyExc_ValueError, "M must be square with 1 to 30000 rows, not %zd",
                     (Py_ssize_t)n);
        goto done;
    }
    data.n = (int)n;
    if (!(data.C = bd_py_doubles(keep, in[1], "C", 2, n, n)) ||
        !(data.G = bd_py_doubles(keep, in[2], "G", 2, n, n)) ||
        !(data.K = bd_py_doubles(keep, in[3], "K", 2, n, n)) ||
        !(data.N = bd_py_doubles(keep, in[4], "N", 2, n, n)))
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
        bd_py_raise(status, "Model");
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

const bd_model *bd_py_model_of(PyObject *object)
{
    return ((model_object *)object)->model;
}

PyDoc_STRVAR(
    model_state_doc,
    "state(t, x, v, stress=None, films=None) -> state\n\n"
    "A flat state, at rest in its branches or with what they bear: layer by layer, branch by "
    "branch; with films that have settled or remember a motion: see bd_state_films in "
    "bearingdyn.h.");

static PyObject *model_state(PyObject *object, PyObject *args)
{
    const bd_model *model = bd_py_model_of(object);
    PyObject *x_in, *v_in, *stress_in = Py_None, *films_in = Py_None, *state = NULL;
    double t;
    if (!PyArg_ParseTuple(args, "dOO|OO:state", &t, &x_in, &v_in, &stress_in, &films_in))
        return NULL;
    PyObject *keep = PyList_New(0);
    if (!keep)
        return NULL;
    const double *x = bd_py_doubles(keep, x_in, "x", 1, bd_model_size(model), -1);
    const double *v = x ? bd_py_doubles(keep, v_in, "v", 1, bd_model_size(model), -1) : NULL;
    const bool bears = v && stress_in != Py_None;
    const double *stress =
        bears ? bd_py_doubles(keep, stress_in, "stress", 1, bd_model_stresses(model), -1) : NULL;
    const bool remembers = v && (stress || !bears) && films_in != Py_None;
    const double *films =
        remembers ? bd_py_doubles(keep, films_in, "films", 1, bd_model_films(model), -1) : NULL;
    if (v && (stress || !bears) && (films || !remembers) && !bd_py_require_finite(&t, 1, "t") &&
        (state = bd_py_new_array(1, (npy_intp)bd_state_size(model), 0))) {
        bd_state_set(model, bd_py_data(state), t, x, v);
        if (stress)
            bd_state_stress(model, bd_py_data(state), stress);
        if (films)
            bd_state_films(model, bd_py_data(state), films);
    }
    Py_DECREF(keep);
    return state;
}

double *bd_py_state_of(PyObject *keep, const bd_model *model, PyObject *object, npy_intp modes)
{
    const npy_intp size = (npy_intp)bd_state_size(model);
    double *state = bd_py_doubles(keep, object, "state", 1, modes < 0 ? -1 : size + modes, -1);
    if (state && bd_py_rows(keep) < size) {
        PyErr_Format(PyExc_ValueError, "state has %zd numbers; it must have %zd",
                     (Py_ssize_t)bd_py_rows(keep), (Py_ssize_t)size);
        return NULL;
    }
    if (state &&
        !(state[1] >= 0.0 && state[1] < 9007199254740992.0 && state[2] >= 0.0)) { /* 2^53 */
        PyErr_SetString(PyExc_ValueError,
                        "state must come from this model: its count of steps is impossible");
        return NULL;
    }
    return state;
}

PyDoc_STRVAR(model_unpack_doc,
             "unpack(state, exact=False) -> t, x, v, a, energy\n\n"
             "exact: whether the modes of exact steps may follow. energy: a dict of "
             "ENERGIES, J.");

static PyObject *model_unpack(PyObject *object, PyObject *args)
{
    const bd_model *model = bd_py_model_of(object);
    PyObject *state_in, *result = NULL;
    double t;
    int exact = 0;
    if (!PyArg_ParseTuple(args, "O|p:unpack", &state_in, &exact))
        return NULL;
    PyObject *keep = PyList_New(0);
    if (!keep)
        return NULL;
    PyObject *x = NULL, *v = NULL, *a = NULL, *energy = NULL;
    double *state = bd_py_state_of(keep, model, state_in, exact ? -1 : 0);
    if (state) {
        x = bd_py_new_array(1, bd_model_size(model), 0);
        v = bd_py_new_array(1, bd_model_size(model), 0);
        a = bd_py_new_array(1, bd_model_size(model), 0);
        energy = bd_py_energy_dict(bd_state_view(model, state).energy);
        if (x && v && a && energy) {
            bd_state_get(model, state, &t, bd_py_data(x), bd_py_data(v), bd_py_data(a));
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

static PyObject *model_blocks(PyObject *object, void *closure)
{
    (void)closure;
    return PyLong_FromLong(bd_model_blocks(bd_py_model_of(object)));
}

static PyObject *model_bytes(PyObject *object, void *closure)
{
    (void)closure;
    return PyLong_FromSize_t(bd_model_bytes(bd_py_model_of(object)));
}

static PyMethodDef model_methods[] = {
    {"state", model_state, METH_VARARGS, model_state_doc},
    {"unpack", model_unpack, METH_VARARGS, model_unpack_doc},
    {"march", (PyCFunction)(void (*)(void))bd_py_march, METH_VARARGS | METH_KEYWORDS,
     bd_py_march_doc},
    {"harmonic", bd_py_harmonic, METH_VARARGS, bd_py_harmonic_doc},
    {NULL, NULL, 0, NULL},
};

static PyObject *model_channels(PyObject *object, void *closure)
{
    (void)closure;
    return PyLong_FromLong(bd_model_channels(bd_py_model_of(object)));
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

PyType_Spec bd_py_model_spec = {
    .name = "bearingdyn._core.Model",
    .basicsize = sizeof(model_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = model_slots,
};
