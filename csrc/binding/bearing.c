/* A bearing as a dict, and the force of one by itself. */
#include "binding.h"

#include <limits.h>
#include <math.h>
#include <stddef.h>

/* ---------------------------------------------------------------- imperfections */

typedef struct imperfections {
    double spin_ratio, ball_diameter, inner_radius, outer_radius;
    PyObject *waves, *pits, *oversize;
} imperfections;

#define DOUBLE(name) {#name, BD_PY_DOUBLE, offsetof(imperfections, name)}
#define OBJECT(name) {#name, BD_PY_OBJECT, offsetof(imperfections, name)}
static const bd_py_field imperfection_fields[] = {
    DOUBLE(spin_ratio), DOUBLE(ball_diameter), DOUBLE(inner_radius), DOUBLE(outer_radius),
    OBJECT(waves),      OBJECT(pits),          OBJECT(oversize),
};
#undef DOUBLE
#undef OBJECT

/* Whether a number read as a double stands for an int of 0 ... limit. */
static int whole(double value, double limit)
{
    return value >= 0.0 && value <= limit && value == floor(value);
}

/* Whether a number read as a double is the code of a word. */
static int is_code(double value, const bd_py_word *words)
{
    while (words->word && (double)words->code != value)
        words++;
    return words->word != NULL;
}

/* waves: rows of kind, order, ball, amplitude, phase; pits: of kind, ball, angle, width, depth; oversize (Z,) or
 * empty. Kinds are the codes of WAVE_KINDS and PIT_KINDS. */
static int parse_imperfections(PyObject *keep, PyObject *dict, bd_bearing_data *bearing)
{
    imperfections in;
    if (bd_py_parse_fields(keep, dict, "bearing.imperfections", imperfection_fields,
                           Py_ARRAY_LENGTH(imperfection_fields), &in))
        return -1;
    const double *wave = bd_py_doubles(keep, in.waves, "bearing.imperfections.waves", 2, -1, 5);
    const npy_intp n_waves = wave ? bd_py_rows(keep) : 0;
    const double *pit =
        wave ? bd_py_doubles(keep, in.pits, "bearing.imperfections.pits", 2, -1, 5) : NULL;
    const npy_intp n_pits = pit ? bd_py_rows(keep) : 0;
    const double *oversize =
        pit ? bd_py_doubles(keep, in.oversize, "bearing.imperfections.oversize", 1, -1, -1) : NULL;
    if (!oversize)
        return -1;
    const npy_intp n_sizes = bd_py_rows(keep);
    if (n_waves > 100000 || n_pits > 100000 || (n_sizes != 0 && n_sizes != bearing->n_balls)) {
        PyErr_Format(PyExc_ValueError,
                     "bearing.imperfections has %zd waves, %zd pits and %zd values of oversize; it "
                     "must have at most 100000 waves and pits, and none or %d of oversize, one for "
                     "each ball",
                     (Py_ssize_t)n_waves, (Py_ssize_t)n_pits, (Py_ssize_t)n_sizes,
                     bearing->n_balls);
        return -1;
    }
    bd_wave *waves = bd_py_scratch(keep, (size_t)n_waves, sizeof *waves);
    bd_pit *pits = waves ? bd_py_scratch(keep, (size_t)n_pits, sizeof *pits) : NULL;
    if (!pits)
        return -1;
    for (npy_intp w = 0; w < n_waves; w++, wave += 5) {
        if (!is_code(wave[0], bd_py_wave_kinds) || !whole(wave[1], 1e6) || !whole(wave[2], 1e6)) {
            PyErr_Format(PyExc_ValueError,
                         "bearing.imperfections.waves[%zd] must begin with a code of WAVE_KINDS, "
                         "and an order and a ball that are whole numbers from 0 to 1000000",
                         (Py_ssize_t)w);
            return -1;
        }
        waves[w] = (bd_wave){(bd_wave_kind)wave[0], (int)wave[1], (int)wave[2], wave[3], wave[4]};
    }
    for (npy_intp p = 0; p < n_pits; p++, pit += 5) {
        if (!is_code(pit[0], bd_py_pit_kinds) || !whole(pit[1], 1e6)) {
            PyErr_Format(PyExc_ValueError,
                         "bearing.imperfections.pits[%zd] must begin with a code of PIT_KINDS, and "
                         "a ball that is a whole number from 0 to 1000000",
                         (Py_ssize_t)p);
            return -1;
        }
        pits[p] = (bd_pit){(bd_pit_kind)pit[0], (int)pit[1], pit[2], pit[3], pit[4]};
    }
    bearing->spin_ratio = in.spin_ratio;
    bearing->ball_diameter = in.ball_diameter;
    bearing->inner_radius = in.inner_radius;
    bearing->outer_radius = in.outer_radius;
    bearing->n_waves = (int)n_waves;
    bearing->n_pits = (int)n_pits;
    bearing->waves = waves;
    bearing->pits = pits;
    bearing->oversize = n_sizes > 0 ? oversize : NULL;
    return 0;
}

/* ---------------------------------------------------------------- bearing */

typedef struct fields {
    bd_bearing_data data;
    PyObject *order, *sine, *law, *table, *echoes, *imperfections;
} fields;

#define INT(name, place) {name, BD_PY_INT, offsetof(fields, data.place)}
#define DOUBLE(name, place) {name, BD_PY_DOUBLE, offsetof(fields, data.place)}
#define OBJECT(name, place) {name, BD_PY_OBJECT, offsetof(fields, place)}
static const bd_py_field bearing_fields[] = {
    INT("n_balls", n_balls),
    OBJECT("order", order),
    OBJECT("sine", sine),
    INT("n_radial", n_radial),
    DOUBLE("x0", x0),
    DOUBLE("y0", y0),
    DOUBLE("A", A),
    DOUBLE("e0", e0),
    DOUBLE("kappa", contact.kappa),
    DOUBLE("h0", contact.h0),
    DOUBLE("give", contact.give),
    OBJECT("law", law),
    DOUBLE("c", contact.c),
    OBJECT("table", table),
    OBJECT("echoes", echoes),
    DOUBLE("cage_ratio", cage_ratio),
    DOUBLE("angle0", angle0),
    DOUBLE("inner_ratio", inner_ratio),
    DOUBLE("outer_ratio", outer_ratio),
    INT("shoulder", shoulder),
    DOUBLE("open_sine", open_sine),
    OBJECT("imperfections", imperfections),
};
#undef INT
#undef DOUBLE
#undef OBJECT

int bd_py_parse_bearing(PyObject *keep, PyObject *dict, bd_bearing_data *bearing)
{
    fields in = {0};
    int law;
    if (bd_py_parse_fields(keep, dict, "bearing", bearing_fields, Py_ARRAY_LENGTH(bearing_fields),
                           &in) ||
        bd_py_parse_word(in.law, "bearing.law", bd_py_damping_laws, &law))
        return -1;
    *bearing = in.data;
    PyArrayObject *orders = bd_py_copy(keep, in.order, NPY_INT, "bearing.order", 1, -1, -1);
    if (!orders)
        return -1;
    npy_intp n_coefs = PyArray_DIM(orders, 0);
    PyArrayObject *sines = bd_py_copy(keep, in.sine, NPY_INT, "bearing.sine", 1, n_coefs, -1);
    double *points = sines ? bd_py_doubles(keep, in.table, "bearing.table", 2, -1, 2) : NULL;
    if (!points)
        return -1;
    npy_intp n_table = bd_py_rows(keep);
    double *columns = bd_py_scratch(keep, 2 * (size_t)n_table, sizeof *columns);
    if (!columns)
        return -1;
    for (npy_intp i = 0; i < n_table; i++) {
        columns[i] = points[2 * i];
        columns[n_table + i] = points[2 * i + 1];
    }
    double *echoes = bd_py_doubles(keep, in.echoes, "bearing.echoes", 2, -1, 4);
    if (!echoes)
        return -1;
    const npy_intp n_echoes = bd_py_rows(keep);
    if (bearing->n_balls < 1 || bearing->n_balls > 100000) {
        PyErr_Format(PyExc_ValueError, "bearing.n_balls is %d; it must be 1 to 100000",
                     bearing->n_balls);
        return -1;
    }
    if (n_coefs < 1 || n_coefs > 100000 || n_table > INT_MAX || n_echoes > 1000) {
        PyErr_Format(PyExc_ValueError,
                     "bearing.order has %zd coefficients, bearing.table %zd rows and "
                     "bearing.echoes %zd; they must be 1 to 100000, below 2**31 and at most 1000",
                     (Py_ssize_t)n_coefs, (Py_ssize_t)n_table, (Py_ssize_t)n_echoes);
        return -1;
    }
    bearing->n_coefs = (int)n_coefs;
    bearing->order = PyArray_DATA(orders);
    bearing->sine = PyArray_DATA(sines);
    bearing->contact.law = (bd_damping_law)law;
    bearing->contact.n_table = (int)n_table;
    bearing->contact.table_delta = columns;
    bearing->contact.table_c = columns + n_table;
    /* rows of decay and strength, real and imaginary parts, as bd_echo has them */
    bearing->contact.n_echoes = (int)n_echoes;
    bearing->contact.echoes = (const bd_echo *)(const void *)echoes;
    return parse_imperfections(keep, in.imperfections, bearing);
}

const char bd_py_bearing_force_doc[] =
    PyDoc_STR("bearing_force(bearing, z, z_rate, angle, cage_speed, shaft_angle, shaft_speed)\n"
              "-> g, K, C, loads\n\n"
              "Force and tangents of one bearing on its coefficients z (n,).");

PyObject *bd_py_bearing_force(PyObject *module, PyObject *args)
{
    PyObject *dict, *z_in, *rate_in, *result = NULL;
    double angle, cage_speed;
    bd_turn shaft = {0};
    bd_bearing_data bearing = {0};
    (void)module;
    if (!PyArg_ParseTuple(args, "OOOdddd:bearing_force", &dict, &z_in, &rate_in, &angle,
                          &cage_speed, &shaft.angle, &shaft.speed))
        return NULL;
    PyObject *keep = PyList_New(0);
    if (!keep)
        return NULL;
    PyObject *g = NULL, *K = NULL, *C = NULL, *loads = NULL;
    if (bd_py_parse_bearing(keep, dict, &bearing))
        goto done;
    bd_status status = bd_bearing_check(&bearing);
    if (status != BD_OK) {
        bd_py_raise(status, "bearing");
        goto done;
    }
    const double *z = bd_py_doubles(keep, z_in, "z", 1, bearing.n_coefs, -1);
    const double *rate = z ? bd_py_doubles(keep, rate_in, "z_rate", 1, bearing.n_coefs, -1) : NULL;
    if (!rate || bd_py_require_finite(&angle, 1, "angle") ||
        bd_py_require_finite(&cage_speed, 1, "cage_speed") ||
        bd_py_require_finite(&shaft.angle, 1, "shaft_angle") ||
        bd_py_require_finite(&shaft.speed, 1, "shaft_speed"))
        goto done;
    g = bd_py_new_array(1, bearing.n_coefs, 0);
    K = bd_py_new_array(2, bearing.n_coefs, bearing.n_coefs);
    C = bd_py_new_array(2, bearing.n_coefs, bearing.n_coefs);
    loads = bd_py_new_array(1, bearing.n_balls, 0);
    if (!g || !K || !C || !loads)
        goto done;
    status = bd_bearing_single(&bearing, z, rate, angle, cage_speed, shaft, bd_py_data(g),
                               bd_py_data(K), bd_py_data(C), bd_py_data(loads));
    if (status != BD_OK)
        bd_py_raise(status, "bearing_force");
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

const char bd_py_bearing_settle_doc[] = PyDoc_STR(
    "bearing_settle(bearing, loads, radius, angle, shaft_angle) -> z, ball_loads, outcome\n\n"
    "Rest of one bearing under loads (m, n) on its coefficients, first steps radius (m,).");

PyObject *bd_py_bearing_settle(PyObject *module, PyObject *args)
{
    PyObject *dict, *loads_in, *radius_in, *result = NULL;
    double angle, shaft_angle;
    bd_bearing_data bearing = {0};
    (void)module;
    if (!PyArg_ParseTuple(args, "OOOdd:bearing_settle", &dict, &loads_in, &radius_in, &angle,
                          &shaft_angle))
        return NULL;
    PyObject *keep = PyList_New(0);
    if (!keep)
        return NULL;
    PyObject *z = NULL, *balls = NULL, *outcome = NULL;
    bd_settle *settle = NULL;
    if (bd_py_parse_bearing(keep, dict, &bearing))
        goto done;
    bd_status status = bd_bearing_check(&bearing);
    if (status != BD_OK) {
        bd_py_raise(status, "bearing");
        goto done;
    }
    const double *load = bd_py_doubles(keep, loads_in, "loads", 2, -1, bearing.n_coefs);
    const npy_intp cases = load ? bd_py_rows(keep) : 0;
    const double *radius = load ? bd_py_doubles(keep, radius_in, "radius", 1, cases, -1) : NULL;
    if (!radius || bd_py_require_finite(&angle, 1, "angle") ||
        bd_py_require_finite(&shaft_angle, 1, "shaft_angle"))
        goto done;
    z = bd_py_new_array(2, cases, bearing.n_coefs);
    balls = bd_py_new_array(2, cases, bearing.n_balls);
    outcome = bd_py_new_array(1, cases, 0);
    if (!z || !balls || !outcome)
        goto done;
    settle = bd_settle_create(&bearing, angle, shaft_angle);
    if (!settle) {
        PyErr_NoMemory();
        goto done;
    }
    double *z_out = bd_py_data(z), *balls_out = bd_py_data(balls),
           *outcome_out = bd_py_data(outcome);
    enum { CHUNK = 500 };
    for (npy_intp first = 0; first < cases; first += CHUNK) {
        const npy_intp end = first + CHUNK < cases ? first + CHUNK : cases;
        Py_BEGIN_ALLOW_THREADS
            for (npy_intp i = first; i < end; i++)
                outcome_out[i] = (double)bd_settle_case(settle, load + i * bearing.n_coefs,
                                                        radius[i], z_out + i * bearing.n_coefs,
                                                        balls_out + i * bearing.n_balls);
        Py_END_ALLOW_THREADS
        if (PyErr_CheckSignals())
            goto done;
    }
    result = PyTuple_Pack(3, z, balls, outcome);
done:
    bd_settle_free(settle);
    Py_XDECREF(z);
    Py_XDECREF(balls);
    Py_XDECREF(outcome);
    Py_DECREF(keep);
    return result;
}
