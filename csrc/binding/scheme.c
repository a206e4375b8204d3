/* A scheme as a dict. */
#include "binding.h"

#include <limits.h>
#include <stddef.h>

typedef struct fields {
    bd_scheme scheme;
    PyObject *times, *speeds, *audit, *isa;
} fields;

#define PLAIN(name, type) {#name, type, offsetof(fields, scheme.name)}
#define OBJECT(name) {#name, BD_PY_OBJECT, offsetof(fields, name)}
static const bd_py_field scheme_fields[] = {
    PLAIN(dt, BD_PY_DOUBLE),
    PLAIN(beta, BD_PY_DOUBLE),
    PLAIN(gamma, BD_PY_DOUBLE),
    PLAIN(tolerance, BD_PY_DOUBLE),
    PLAIN(max_iterations, BD_PY_INT),
    OBJECT(times),
    OBJECT(speeds),
    OBJECT(audit),
    OBJECT(isa),
};

int bd_py_parse_scheme(PyObject *keep, PyObject *dict, bd_scheme *scheme)
{
    fields in = {0};
    int isa;
    if (bd_py_parse_fields(keep, dict, "scheme", scheme_fields, Py_ARRAY_LENGTH(scheme_fields),
                           &in) ||
        bd_py_parse_word(in.isa, "scheme.isa", bd_py_isas, &isa))
        return -1;
    *scheme = in.scheme;
    scheme->isa = (bd_isa)isa;
    scheme->audit = PyObject_IsTrue(in.audit);
    if (scheme->audit < 0 ||
        !(scheme->speed.time = bd_py_doubles(keep, in.times, "scheme.times", 1, -1, -1)))
        return -1;
    scheme->speed.n = (int)Py_MIN(bd_py_rows(keep), INT_MAX);
    if (!(scheme->speed.value =
              bd_py_doubles(keep, in.speeds, "scheme.speeds", 1, scheme->speed.n, -1)))
        return -1;
    const bd_fault fault = bd_scheme_fault(scheme);
    if (fault.field) {
        PyObject *value = Py_XNewRef(PyDict_GetItemString(dict, fault.field));
        PyErr_Format(PyExc_ValueError, "scheme.%s is %R; it must be %s", fault.field,
                     value ? value : Py_None, fault.must);
        Py_XDECREF(value);
        return -1;
    }
    return 0;
}

const char bd_py_check_scheme_doc[] =
    PyDoc_STR("check_scheme($module, scheme, /)\n--\n\nRaises what `march` would about a scheme.");

PyObject *bd_py_check_scheme(PyObject *module, PyObject *dict)
{
    bd_scheme scheme;
    (void)module;
    PyObject *keep = PyList_New(0);
    const int failed = !keep || bd_py_parse_scheme(keep, dict, &scheme);
    Py_XDECREF(keep);
    return failed ? NULL : Py_NewRef(Py_None);
}
