/* Model.harmonic: chunks of frequencies without the GIL, and between them signals and progress. */
#include "binding.h"

#include <limits.h>

const char bd_py_harmonic_doc[] =
    PyDoc_STR("harmonic(omega, speed, modulus, bearing_K, bearing_C, ball, across, force, row, "
              "progress) -> response\n\n"
              "omega (f,), modulus (f, layers) complex, bearing_K and bearing_C (coefs, coefs),\n"
              "ball (f, balls) complex, across (balls, coefs), force (inputs, n), row (outputs, "
              "n); response (f, outputs, inputs) complex.");

PyObject *bd_py_harmonic(PyObject *object, PyObject *args)
{
    const bd_model *model = bd_py_model_of(object);
    PyObject *omega_in, *modulus_in, *K_in, *C_in, *ball_in, *across_in, *force_in, *row_in,
        *progress, *response = NULL;
    bd_harmonic_data data = {0};
    if (!PyArg_ParseTuple(args, "OdOOOOOOOO:harmonic", &omega_in, &data.speed, &modulus_in, &K_in,
                          &C_in, &ball_in, &across_in, &force_in, &row_in, &progress))
        return NULL;
    bd_py_module *module = PyType_GetModuleState(Py_TYPE(object));
    PyObject *keep = PyList_New(0);
    if (!module || !keep) {
        Py_XDECREF(keep);
        return NULL;
    }

    const npy_intp n = bd_model_size(model), coefs = bd_model_coefs(model);
    bd_harmonic_work *work = NULL;
    if (!(data.omega = bd_py_doubles(keep, omega_in, "omega", 1, -1, -1)))
        goto done;
    const npy_intp n_omega = bd_py_rows(keep);
    PyArrayObject *modulus =
        bd_py_copy(keep, modulus_in, NPY_CDOUBLE, "modulus", 2, n_omega, bd_model_layers(model));
    if (bd_py_require_finite(&data.speed, 1, "speed") || !modulus ||
        bd_py_require_finite(PyArray_DATA(modulus), 2 * PyArray_SIZE(modulus), "modulus") ||
        !(data.bearing_K = bd_py_doubles(keep, K_in, "bearing_K", 2, coefs, coefs)) ||
        !(data.bearing_C = bd_py_doubles(keep, C_in, "bearing_C", 2, coefs, coefs)) ||
        !(data.across = bd_py_doubles(keep, across_in, "across", 2, -1, coefs)))
        goto done;
    const npy_intp n_balls = bd_py_rows(keep);
    PyArrayObject *ball = bd_py_copy(keep, ball_in, NPY_CDOUBLE, "ball", 2, n_omega, n_balls);
    if (!ball || bd_py_require_finite(PyArray_DATA(ball), 2 * PyArray_SIZE(ball), "ball") ||
        !(data.force = bd_py_doubles(keep, force_in, "force", 2, -1, n)))
        goto done;
    const npy_intp n_in = bd_py_rows(keep);
    if (!(data.row = bd_py_doubles(keep, row_in, "row", 2, -1, n)))
        goto done;
    const npy_intp n_out = bd_py_rows(keep);
    if (n_omega > INT_MAX || n_in > 100000 || n_out > 100000 || n_balls > 100000) {
        PyErr_SetString(PyExc_ValueError,
                        "harmonic: too many frequencies, inputs, outputs or balls");
        goto done;
    }
    data.modulus = PyArray_DATA(modulus);
    data.ball = PyArray_DATA(ball);
    data.n_balls = (int)n_balls;
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
    double *out = bd_py_data(response);
    /* frequencies go in lanes: of a small model whole ones from the start, none of which is long */
    int at = 0, chunk = n <= 256 ? BD_LANES : 1;
    while (at < data.n_omega) {
        const int now = Py_MIN(chunk, data.n_omega - at);
        const double began = bd_py_seconds();
        bd_status status;
        Py_BEGIN_ALLOW_THREADS
            status = bd_harmonic(model, &data, &module->lapack, work, at, now, out);
        Py_END_ALLOW_THREADS
        if (status != BD_OK) {
            bd_py_raise(status, "harmonic");
            goto failed;
        }
        const double took = bd_py_seconds() - began;
        at += now;
        if (bd_py_after_chunk(progress, took, at, data.n_omega, &chunk))
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
