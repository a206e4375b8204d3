/* LAPACK from SciPy: its Cython capsules, told by their signatures. */
#include "binding.h"

#include <string.h>

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

int bd_py_load_lapack(bd_lapack *lapack)
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
