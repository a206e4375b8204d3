/* The extension itself: its functions without a model, and its state. */
#define BD_PY_DEFINES_NUMPY
#include "binding.h"

#include <limits.h>

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

    const double *rate = bd_py_doubles(keep, rate_in, "rate", 2, -1, -1);
    npy_intp n = rate ? bd_py_rows(keep) : 0, m = rate ? bd_py_columns(keep) : 0;
    const double *dt = rate ? bd_py_doubles(keep, dt_in, "dt", 1, n > 0 ? n - 1 : 0, -1) : NULL;
    const double *modulus = dt ? bd_py_doubles(keep, modulus_in, "modulus", 1, -1, -1) : NULL;
    npy_intp branches = modulus ? bd_py_rows(keep) : 0;
    const double *tau = modulus ? bd_py_doubles(keep, tau_in, "tau", 1, branches, -1) : NULL;
    if (!tau)
        goto done;
    if (n > INT_MAX || m > INT_MAX - BD_LANES || branches > INT_MAX) {
        PyErr_SetString(PyExc_ValueError, "rate, modulus: too many values");
        goto done;
    }
    if (bd_py_require_finite(&G0, 1, "G0") || bd_py_require_finite(&eta0, 1, "eta0"))
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
    double *work =
        bd_py_scratch(keep, bd_maxwell_stress_work_size((int)m, (int)branches), sizeof *work);
    stress = work ? bd_py_new_array(2, n, m) : NULL;
    if (stress) {
        double *out = bd_py_data(stress);
        Py_BEGIN_ALLOW_THREADS
            bd_maxwell_stress((int)n, (int)m, rate, dt, G0, eta0, (int)branches, modulus, tau, out,
                              work);
        Py_END_ALLOW_THREADS
    }
done:
    Py_DECREF(keep);
    return stress;
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

/* ---------------------------------------------------------------- module */

static PyMethodDef module_methods[] = {
    {"maxwell_stress", maxwell_stress, METH_VARARGS, maxwell_stress_doc},
    {"bearing_force", bd_py_bearing_force, METH_VARARGS, bd_py_bearing_force_doc},
    {"bearing_along", bd_py_bearing_along, METH_VARARGS, bd_py_bearing_along_doc},
    {"bearing_settle", bd_py_bearing_settle, METH_VARARGS, bd_py_bearing_settle_doc},
    {"check_scheme", bd_py_check_scheme, METH_O, bd_py_check_scheme_doc},
    {"changed_layers", bd_py_changed_layers, METH_VARARGS, bd_py_changed_layers_doc},
    {"helmholtz", bd_py_helmholtz, METH_VARARGS, bd_py_helmholtz_doc},
    {"march_abreast", bd_py_march_abreast, METH_O, bd_py_march_abreast_doc},
    {"status_text", status_text, METH_VARARGS, status_text_doc},
    {NULL, NULL, 0, NULL},
};

static int module_exec(PyObject *module)
{
    bd_py_module *state = PyModule_GetState(module);
    import_array1(-1);
    if (bd_py_load_lapack(&state->lapack) || bd_py_add_words(module))
        return -1;
    state->model_type = (PyTypeObject *)PyType_FromModuleAndSpec(module, &bd_py_model_spec, NULL);
    if (!state->model_type)
        return -1;
    return PyModule_AddType(module, state->model_type);
}

static int module_traverse(PyObject *module, visitproc visit, void *arg)
{
    bd_py_module *state = PyModule_GetState(module);
    Py_VISIT(state->model_type);
    return 0;
}

static int module_clear(PyObject *module)
{
    bd_py_module *state = PyModule_GetState(module);
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
    .m_size = sizeof(bd_py_module),
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
