/* One bearing along a motion that is given. */
#include "binding.h"

#include <limits.h>

const char bd_py_bearing_along_doc[] = PyDoc_STR(
    "bearing_along(bearing, z, z_rate, angle, speed, window, tangents)\n"
    "-> g, loads, heat, pressing, turning, K, C, pressed\n\n"
    "One bearing through samples z, z_rate (s, n) of a motion; angle (s, 4) and speed (4,)\n"
    "of cage, inner ring, outer ring and ball spin. K, C (s, n, n), or None each; pressed (s, Z) "
    "of\n"
    "films that are carried, or None.");

PyObject *bd_py_bearing_along(PyObject *module, PyObject *args)
{
    PyObject *dict, *z_in, *rate_in, *angle_in, *speed_in, *result = NULL;
    PyObject *arrays[8] = {NULL};
    int tangents;
    bd_bearing_data bearing = {0};
    bd_along_data motion = {0};
    (void)module;
    if (!PyArg_ParseTuple(args, "OOOOOdp:bearing_along", &dict, &z_in, &rate_in, &angle_in,
                          &speed_in, &motion.window, &tangents))
        return NULL;
    PyObject *keep = PyList_New(0);
    if (!keep)
        return NULL;
    if (bd_py_parse_bearing(keep, dict, &bearing) ||
        bd_py_require_finite(&motion.window, 1, "window"))
        goto done;
    bd_status status = bd_bearing_check(&bearing);
    if (status != BD_OK) {
        bd_py_raise(status, "bearing");
        goto done;
    }
    if (!(motion.z = bd_py_doubles(keep, z_in, "z", 2, -1, bearing.n_coefs)))
        goto done;
    const npy_intp samples = bd_py_rows(keep), n = bearing.n_coefs;
    if (samples > INT_MAX / n / n) {
        PyErr_SetString(PyExc_ValueError, "z: too many samples");
        goto done;
    }
    motion.n = (int)samples;
    motion.z_rate = bd_py_doubles(keep, rate_in, "z_rate", 2, samples, n);
    const double *angle =
        motion.z_rate ? bd_py_doubles(keep, angle_in, "angle", 2, samples, 4) : NULL;
    const double *speed = angle ? bd_py_doubles(keep, speed_in, "speed", 1, 4, -1) : NULL;
    double *scratch =
        speed ? bd_py_scratch(keep, bd_bearing_along_size(&bearing), sizeof *scratch) : NULL;
    bd_bodies *bodies = scratch ? bd_py_scratch(keep, (size_t)samples, sizeof *bodies) : NULL;
    if (!bodies)
        goto done;
    for (npy_intp i = 0; i < samples; i++, angle += 4)
        bodies[i] = (bd_bodies){angle[0], angle[1], angle[2], angle[3]};
    motion.angle = bodies;
    motion.speed = (bd_bodies){speed[0], speed[1], speed[2], speed[3]};

    npy_intp square[3] = {samples, n, n};
    arrays[0] = bd_py_new_array(2, samples, n);
    arrays[1] = bd_py_new_array(2, samples, bearing.n_balls);
    for (size_t i = 2; i < 5; i++)
        arrays[i] = bd_py_new_array(1, samples, 0);
    for (size_t i = 5; i < 7; i++)
        arrays[i] = tangents ? PyArray_SimpleNew(3, square, NPY_DOUBLE) : Py_NewRef(Py_None);
    const bool remembers = bearing.contact.n_echoes > 0;
    arrays[7] = remembers ? bd_py_new_array(2, samples, bearing.n_balls) : Py_NewRef(Py_None);
    for (size_t i = 0; i < Py_ARRAY_LENGTH(arrays); i++)
        if (!arrays[i])
            goto done;
    bd_along found = {
        .g = bd_py_data(arrays[0]),
        .loads = bd_py_data(arrays[1]),
        .heat = bd_py_data(arrays[2]),
        .pressing = bd_py_data(arrays[3]),
        .turning = bd_py_data(arrays[4]),
        .K = tangents ? bd_py_data(arrays[5]) : NULL,
        .C = tangents ? bd_py_data(arrays[6]) : NULL,
        .pressed = remembers ? bd_py_data(arrays[7]) : NULL,
    };
    Py_BEGIN_ALLOW_THREADS
        status = bd_bearing_along(&bearing, &motion, scratch, &found);
    Py_END_ALLOW_THREADS
    if (status != BD_OK)
        bd_py_raise(status, "bearing_along");
    else
        result = PyTuple_Pack(8, arrays[0], arrays[1], arrays[2], arrays[3], arrays[4], arrays[5],
                              arrays[6], arrays[7]);
done:
    for (size_t i = 0; i < Py_ARRAY_LENGTH(arrays); i++)
        Py_XDECREF(arrays[i]);
    Py_DECREF(keep);
    return result;
}
