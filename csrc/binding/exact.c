/* Modes of an exact step as a dict of arrays. */
#include "binding.h"

typedef struct fields {
    PyObject *table, *roots, *weights, *loose, *P, *Z, *load, *X, *V, *A, *S, *W;
} fields;

#define OBJECT(name) {#name, BD_PY_OBJECT, offsetof(fields, name)}
static const bd_py_field exact_fields[] = {
    OBJECT(table), OBJECT(roots), OBJECT(weights), OBJECT(loose), OBJECT(P), OBJECT(Z),
    OBJECT(load),  OBJECT(X),     OBJECT(V),       OBJECT(A),     OBJECT(S), OBJECT(W),
};

int bd_py_parse_exact(PyObject *keep, const bd_model *model, PyObject *dict, bd_exact_data *exact)
{
    const npy_intp coordinates = bd_model_size(model), m = bd_model_coefs(model);
    fields in = {0};
    if (bd_py_parse_fields(keep, dict, "modes", exact_fields, Py_ARRAY_LENGTH(exact_fields), &in) ||
        !(exact->table = bd_py_doubles(keep, in.table, "modes.table", 2, -1, 3)))
        return -1;
    exact->n_groups = (int)bd_py_rows(keep);
    if (!(exact->W = bd_py_doubles(keep, in.W, "modes.W", 2, -1, m * m)))
        return -1;
    exact->hold = (int)Py_MIN(bd_py_rows(keep) / 2, INT_MAX);
    if (exact->hold < 1 || exact->hold > 3 || bd_py_rows(keep) != 2 * exact->hold) {
        PyErr_Format(PyExc_ValueError, "modes.W has %zd rows; it must have 2, 4 or 6",
                     (Py_ssize_t)bd_py_rows(keep));
        return -1;
    }
    const npy_intp rows = (exact->hold + 1) * (exact->hold + 2) / 2;
    if (!(exact->weights = bd_py_doubles(keep, in.weights, "modes.weights", 2, rows, -1)))
        return -1;
    const npy_intp n = bd_py_columns(keep);
    exact->n = n;
    if (!(exact->roots = bd_py_doubles(keep, in.roots, "modes.roots", 1, n, -1)) ||
        !(exact->loose = bd_py_doubles(keep, in.loose, "modes.loose", 2, rows, -1)))
        return -1;
    exact->n_loose = bd_py_columns(keep);
    if (!(exact->P = bd_py_doubles(keep, in.P, "modes.P", 2, m, n)) ||
        !(exact->Z = bd_py_doubles(keep, in.Z, "modes.Z", 2, n, 2 * m)) ||
        !(exact->load =
              bd_py_doubles(keep, in.load, "modes.load", 2, 2 * bd_model_loads(model), n)) ||
        !(exact->X = bd_py_doubles(keep, in.X, "modes.X", 2, n, coordinates)) ||
        !(exact->V = bd_py_doubles(keep, in.V, "modes.V", 2, n, coordinates)) ||
        !(exact->A = bd_py_doubles(keep, in.A, "modes.A", 2, n, coordinates)) ||
        !(exact->S = bd_py_doubles(keep, in.S, "modes.S", 2, n, -1)))
        return -1;
    exact->n_stresses = bd_py_columns(keep);
    return 0;
}
