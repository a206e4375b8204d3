/* The lists of bearingdyn.h as tables for Python, and as what is read from it and given to it by name. */
#include "binding.h"

#include <string.h>

#define WORD(name, word) {word, name},
#define TABLE(LIST) {LIST(WORD){NULL, 0}}
const bd_py_word bd_py_isas[] = TABLE(BD_ISA_LIST);
const bd_py_word bd_py_damping_laws[] = TABLE(BD_DAMPING_LIST);
const bd_py_word bd_py_load_kinds[] = TABLE(BD_LOAD_LIST);
const bd_py_word bd_py_channel_kinds[] = TABLE(BD_CHANNEL_LIST);
const bd_py_word bd_py_wave_kinds[] = TABLE(BD_WAVE_LIST);
const bd_py_word bd_py_pit_kinds[] = TABLE(BD_PIT_LIST);
const bd_py_word bd_py_settled[] = TABLE(BD_SETTLED_LIST);

/* Enumerators without their prefix BD_. */
#define STATUS(name, value, text) {&#name[3], value},
static const bd_py_word statuses[] = {BD_STATUS_LIST(STATUS){NULL, 0}};

/* How the fields of a report add; see bd_py_report_add. */
#define ADDS(type, name, adds) {#name, #adds},
static const struct {
    const char *field, *adds;
} report_fields[] = {BD_REPORT_LIST(ADDS)};

#define NAME(name) #name,
static const char *const energies[] = {BD_ENERGY_LIST(NAME)};

/* ---------------------------------------------------------------- from Python */

int bd_py_parse_word(PyObject *object, const char *what, const bd_py_word *words, int *code)
{
    int overflow = 0;
    const long number = PyLong_Check(object) ? PyLong_AsLongAndOverflow(object, &overflow) : 0;
    for (const bd_py_word *w = words; w->word; w++)
        if (PyUnicode_Check(object) ? PyUnicode_CompareWithASCIIString(object, w->word) == 0
                                    : PyLong_Check(object) && !overflow && number == w->code) {
            *code = w->code;
            return 0;
        }
    char list[256] = "";
    for (const bd_py_word *w = words; w->word; w++) {
        const size_t used = strlen(list);
        PyOS_snprintf(list + used, sizeof list - used, "%s\"%s\"", used ? ", " : "", w->word);
    }
    PyErr_Format(PyExc_ValueError, "%s is %R; it must be one of %s", what, object, list);
    return -1;
}

/* ---------------------------------------------------------------- to Python */

/* Steals a reference to `value`, which may be NULL. */
static int put(PyObject *dict, const char *name, PyObject *value)
{
    const int failed = !value || PyDict_SetItemString(dict, name, value);
    Py_XDECREF(value);
    return failed ? -1 : 0;
}

/* Steals a reference to `value`, which may be NULL. */
static int add(PyObject *module, const char *name, PyObject *value)
{
    const int failed = !value || PyModule_AddObjectRef(module, name, value);
    Py_XDECREF(value);
    return failed ? -1 : 0;
}

/* Adds a dict as a read-only view; steals a reference to it, which may be NULL. */
static int add_view(PyObject *module, const char *name, PyObject *dict)
{
    PyObject *view = dict ? PyDictProxy_New(dict) : NULL;
    Py_XDECREF(dict);
    return add(module, name, view);
}

static PyObject *dict_of(const bd_py_word *words)
{
    PyObject *dict = PyDict_New();
    for (const bd_py_word *w = words; dict && w->word; w++)
        if (put(dict, w->word, PyLong_FromLong(w->code)))
            Py_CLEAR(dict);
    return dict;
}

int bd_py_add_words(PyObject *module)
{
    const struct {
        const char *name;
        const bd_py_word *words;
    } tables[] = {
        {"ISAS", bd_py_isas},
        {"DAMPING_LAWS", bd_py_damping_laws},
        {"LOAD_KINDS", bd_py_load_kinds},
        {"CHANNEL_KINDS", bd_py_channel_kinds},
        {"WAVE_KINDS", bd_py_wave_kinds},
        {"PIT_KINDS", bd_py_pit_kinds},
        {"SETTLED", bd_py_settled},
        {"STATUSES", statuses},
    };
    for (size_t i = 0; i < Py_ARRAY_LENGTH(tables); i++)
        if (add_view(module, tables[i].name, dict_of(tables[i].words)))
            return -1;

    PyObject *fields = PyDict_New();
    for (size_t i = 0; fields && i < Py_ARRAY_LENGTH(report_fields); i++)
        if (put(fields, report_fields[i].field, PyUnicode_FromString(report_fields[i].adds)))
            Py_CLEAR(fields);
    if (add_view(module, "REPORT_FIELDS", fields))
        return -1;

    PyObject *names = PyTuple_New(Py_ARRAY_LENGTH(energies));
    for (size_t i = 0; names && i < Py_ARRAY_LENGTH(energies); i++) {
        PyObject *name = PyUnicode_FromString(energies[i]);
        if (name)
            PyTuple_SET_ITEM(names, (Py_ssize_t)i, name);
        else
            Py_CLEAR(names);
    }
    return add(module, "ENERGIES", names);
}

PyObject *bd_py_energy_dict(const bd_energy *energy)
{
#define PUT_ENERGY(name) || put(dict, #name, PyFloat_FromDouble(energy->name))
    PyObject *dict = PyDict_New();
    if (!dict BD_ENERGY_LIST(PUT_ENERGY))
        Py_CLEAR(dict);
    return dict;
}

#define NUMBER(value)                                                                              \
    _Generic((value), double: PyFloat_FromDouble, default: PyLong_FromLongLong)(value)

PyObject *bd_py_report_dict(const bd_report *report)
{
#define PUT_REPORT(type, name, adds) || put(dict, #name, NUMBER(report->name))
    PyObject *dict = PyDict_New();
    if (!dict BD_REPORT_LIST(PUT_REPORT))
        Py_CLEAR(dict);
    return dict;
}

void bd_py_report_add(bd_report *total, const bd_report *part)
{
#define ADD_sum(to, from) to += from
#define ADD_last(to, from) to = from
#define ADD_first(to, from) to = to < 0 ? from : to
#define ADD(type, name, adds) ADD_##adds(total->name, part->name);
    BD_REPORT_LIST(ADD)
}
