/* binding.h - inside the binding: the only header that includes Python.h and NumPy.
 *
 * Every function casts and checks its arguments, copies what it will read without the GIL, calls the core
 * and turns a status into an exception or a report. Inputs are never written to. What one call copies lives as long
 * as its list `keep`.
 *
 * NumPy's functions are reached through a table of pointers that import_array fills, the one writable global of the
 * extension. module.c defines it (BD_PY_DEFINES_NUMPY); it is the same for every interpreter, and hidden.
 *
 * Included first of all headers: Python.h decides what the C library declares. */
#ifndef BD_BINDING_H
#define BD_BINDING_H

#define PY_SSIZE_T_CLEAN
#include <Python.h>
#define NPY_NO_DEPRECATED_API NPY_2_0_API_VERSION
#define PY_ARRAY_UNIQUE_SYMBOL bd_py_numpy
#ifndef BD_PY_DEFINES_NUMPY
#define NO_IMPORT_ARRAY
#endif
#include <numpy/arrayobject.h>

#include "../bearingdyn.h"

typedef struct bd_py_module {
    bd_lapack lapack;
    PyTypeObject *model_type;
} bd_py_module;

/* ---------------------------------------------------------------- lapack.c */

/* SciPy's own LAPACK, told by its signatures. Returned: 0, or -1 with an ImportError. */
int bd_py_load_lapack(bd_lapack *lapack);

/* ---------------------------------------------------------------- words.c: the lists of bearingdyn.h */

typedef struct bd_py_word {
    const char *word; /* NULL at the end of a table */
    int code;
} bd_py_word;

extern const bd_py_word bd_py_isas[], bd_py_damping_laws[], bd_py_load_kinds[],
    bd_py_channel_kinds[], bd_py_wave_kinds[], bd_py_pit_kinds[], bd_py_settled[];

/* The code of a word, or a code itself. Returned: 0, or -1 with an exception that lists the words. */
int bd_py_parse_word(PyObject *object, const char *what, const bd_py_word *words, int *code);

/* The tables as read-only dicts of the module. Returned: 0, or -1 with an exception. */
int bd_py_add_words(PyObject *module);

/* The works and energies of an audit by name, J, as a new dict. */
PyObject *bd_py_energy_dict(const bd_energy *energy);

/* A report as a new dict; and what a later one adds to it. */
PyObject *bd_py_report_dict(const bd_report *report);
void bd_py_report_add(bd_report *total, const bd_report *part);

/* ---------------------------------------------------------------- parse.c: arguments */

/* Raise what a status stands for. Always returns NULL. */
PyObject *bd_py_raise(bd_status status, const char *what);

/* A private C-contiguous copy of `object` of the given type and shape; -1 leaves a dimension free. NULL with an
 * exception where it does not fit. */
PyArrayObject *bd_py_copy(PyObject *keep, PyObject *object, int type, const char *name, int n_dims,
                          npy_intp rows, npy_intp columns);

/* The same as doubles, all of them finite. */
double *bd_py_doubles(PyObject *keep, PyObject *object, const char *name, int n_dims, npy_intp rows,
                      npy_intp columns);

/* Shape of the array kept last. */
npy_intp bd_py_rows(PyObject *keep);
npy_intp bd_py_columns(PyObject *keep);

/* 0, or -1 with an exception that names what is not finite. */
int bd_py_require_finite(const double *values, npy_intp n, const char *name);

/* Scratch, zeroed, that lives as long as the list; NULL with an exception. */
void *bd_py_scratch(PyObject *keep, size_t count, size_t size);

PyObject *bd_py_new_array(int n_dims, npy_intp rows, npy_intp columns);
double *bd_py_data(PyObject *array);

/* A field of a dict, and where its value goes: an int, a finite double, or a PyObject * that `keep` holds. */
typedef struct bd_py_field {
    const char *name;
    enum { BD_PY_INT, BD_PY_DOUBLE, BD_PY_OBJECT } type;
    size_t offset;
} bd_py_field;

/* Reads a dict that must have these fields and no others into the struct at `to`.
 * Returned: 0, or -1 with an exception that names the field that is missing, unknown or of the wrong type */
int bd_py_parse_fields(PyObject *keep, PyObject *dict, const char *what, const bd_py_field *fields,
                       size_t n, void *to);

/* Between two chunks of a long call: signals and progress.
 * Returned: 0 to go on, 1 when the user interrupts (the exception is cleared), -1 with an exception. */
int bd_py_between_chunks(PyObject *progress, long long done, long long total);

/* How long a chunk may keep the interpreter waiting: Ctrl-C is honoured within twice this. */
#define BD_PY_CHUNK_SECONDS 0.05
double bd_py_seconds(void);

/* After a chunk that took so many seconds, of a call that leaves nothing half done: the next one's size, signals and
 * progress. Returned: 0 to go on, or -1 with an exception, KeyboardInterrupt among them */
int bd_py_after_chunk(PyObject *progress, double took, int done, int total, int *chunk);

/* ---------------------------------------------------------------- bearing.c, scheme.c: dicts */

/* A bearing as BearingKernel.packed returns it. Returned: 0, or -1 with an exception. */
int bd_py_parse_bearing(PyObject *keep, PyObject *dict, bd_bearing_data *bearing);

/* Modes of an exact step, as analysis/exact_step.py makes them. Returned: 0, or -1 with an exception. */
int bd_py_parse_exact(PyObject *keep, const bd_model *model, PyObject *dict, bd_exact_data *exact);

/* A scheme as core.Scheme.packed returns it, with what cannot be marched with refused. */
int bd_py_parse_scheme(PyObject *keep, PyObject *dict, bd_scheme *scheme);

PyObject *bd_py_bearing_force(PyObject *module, PyObject *args);
PyObject *bd_py_bearing_settle(PyObject *module, PyObject *args);
PyObject *bd_py_check_scheme(PyObject *module, PyObject *dict);
extern const char bd_py_bearing_force_doc[], bd_py_bearing_settle_doc[], bd_py_check_scheme_doc[];

/* ---------------------------------------------------------------- radiation.c: sound */

PyObject *bd_py_helmholtz(PyObject *module, PyObject *args);
extern const char bd_py_helmholtz_doc[];

/* ---------------------------------------------------------------- changed_layers.c */

PyObject *bd_py_changed_layers(PyObject *module, PyObject *args);
extern const char bd_py_changed_layers_doc[];

/* ---------------------------------------------------------------- along.c */

PyObject *bd_py_bearing_along(PyObject *module, PyObject *args);
extern const char bd_py_bearing_along_doc[];

/* ---------------------------------------------------------------- abreast.c */

PyObject *bd_py_march_abreast(PyObject *module, PyObject *argument);
extern const char bd_py_march_abreast_doc[];

/* ---------------------------------------------------------------- model.c, march.c, harmonic.c: Model */

extern PyType_Spec bd_py_model_spec;

const bd_model *bd_py_model_of(PyObject *object);
/* A private copy of a state of this model, with so many numbers behind it for an exact march; -1: any. */
double *bd_py_state_of(PyObject *keep, const bd_model *model, PyObject *object, npy_intp modes);

PyObject *bd_py_march(PyObject *object, PyObject *args, PyObject *keywords);
PyObject *bd_py_harmonic(PyObject *object, PyObject *args);
extern const char bd_py_march_doc[], bd_py_harmonic_doc[];

#endif
