#include "radiation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "panels.h"

typedef struct panel {
    int corner[3];
    double X[9];      /* corners, m */
    double normal[3]; /* of unit length, outwards */
    double
        side[9]; /* sides opposite to the corners, over twice the area: curl phi_a up to its sign */
    double middle[3];
    double area, size; /* m^2; longest side, m */
    int grounded[3];   /* whether a corner lies on the floor, and so is its own image */
} panel;

struct bd_radiation {
    int n_points, n_faces, floor;
    double floor_height;
    panel *panels;
    bd_rule rules[BD_RULES];
    bd_pair_function *pair;
};

extern bd_pair_function bd_panel_pair_base;
#ifdef BD_HAVE_X86_SETS
extern bd_pair_function bd_panel_pair_avx2, bd_panel_pair_avx512;
#endif

static bd_pair_function *best_pair(void)
{
#ifdef BD_HAVE_X86_SETS
    if (bd_isa_available(BD_ISA_AVX512))
        return bd_panel_pair_avx512;
    if (bd_isa_available(BD_ISA_AVX2))
        return bd_panel_pair_avx2;
#endif
    return bd_panel_pair_base;
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double distance(const double *a, const double *b)
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(dot(d, d));
}

static void measure(panel *p, const bd_radiation_data *data, const int *corner)
{
    double cross[3];
    for (int a = 0; a < 3; a++) {
        p->corner[a] = corner[a];
        memcpy(p->X + 3 * a, data->points + 3 * (long)corner[a], 3 * sizeof(double));
    }
    for (int j = 0; j < 3; j++) {
        const int u = (j + 1) % 3, v = (j + 2) % 3;
        cross[j] = (p->X[3 + u] - p->X[u]) * (p->X[6 + v] - p->X[v]) -
                   (p->X[3 + v] - p->X[v]) * (p->X[6 + u] - p->X[u]);
        p->middle[j] = (p->X[j] + p->X[3 + j] + p->X[6 + j]) / 3.0;
    }
    const double twice = sqrt(dot(cross, cross));
    p->area = 0.5 * twice;
    p->size = 0.0;
    for (int a = 0; a < 3; a++) {
        const double *from = p->X + 3 * ((a + 1) % 3), *to = p->X + 3 * ((a + 2) % 3);
        for (int j = 0; j < 3; j++)
            p->side[3 * a + j] = (to[j] - from[j]) / twice;
        p->size = fmax(p->size, distance(from, to));
        p->normal[a] = cross[a] / twice;
    }
    for (int a = 0; a < 3; a++)
        p->grounded[a] =
            data->floor && fabs(p->X[3 * a + 1] - data->floor_height) <= 1e-9 * p->size;
}

bd_radiation *bd_radiation_create(const bd_radiation_data *data)
{
    bd_radiation *made = calloc(1, sizeof *made);
    if (!made)
        return NULL;
    made->n_points = data->n_points;
    made->n_faces = data->n_faces;
    made->floor = data->floor;
    made->floor_height = data->floor_height;
    made->pair = best_pair();
    made->panels = calloc((size_t)data->n_faces + 1, sizeof *made->panels);
    if (bd_rules_create(made->rules) || !made->panels) {
        bd_radiation_free(made);
        return NULL;
    }
    for (int t = 0; t < data->n_faces; t++)
        measure(&made->panels[t], data, data->faces + 3 * (long)t);
    return made;
}

void bd_radiation_free(bd_radiation *radiation)
{
    if (!radiation)
        return;
    bd_rules_free(radiation->rules);
    free(radiation->panels);
    free(radiation);
}

/* A panel seen in the floor; its corners keep their order, so that it is the normal that tells inside from outside. */
static void reflect(const bd_radiation *radiation, const panel *p, panel *image)
{
    *image = *p;
    for (int a = 0; a < 3; a++) {
        image->X[3 * a + 1] = 2.0 * radiation->floor_height - p->X[3 * a + 1];
        /* the curl is an axial vector: all of it turns round, and its y again */
        image->side[3 * a] = -p->side[3 * a];
        image->side[3 * a + 2] = -p->side[3 * a + 2];
    }
    image->normal[1] = -p->normal[1];
    image->middle[1] = 2.0 * radiation->floor_height - p->middle[1];
}

/* The rule of a pair, and the orders (3 each) of the corners that it wants. */
static const bd_rule *choose(const bd_radiation *radiation, const panel *x, const panel *y,
                             int mirrored, int *order_x, int *order_y)
{
    int shared = 0, used_x[3] = {0}, used_y[3] = {0};
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            if (x->corner[a] == y->corner[b] && (!mirrored || x->grounded[a])) {
                order_x[shared] = a;
                order_y[shared++] = b;
                used_x[a] = used_y[b] = 1;
            }
    int next_x = shared, next_y = shared;
    for (int a = 0; a < 3; a++) {
        if (!used_x[a])
            order_x[next_x++] = a;
        if (!used_y[a])
            order_y[next_y++] = a;
    }
    if (shared > 0)
        return &radiation->rules[shared == 1   ? BD_RULE_CORNER
                                 : shared == 2 ? BD_RULE_EDGE
                                               : BD_RULE_SAME];
    /* in sizes of the larger panel, at which the rules' errors are 1e-4 or less */
    const double away = distance(x->middle, y->middle) / fmax(x->size, y->size);
    return &radiation->rules[away > 4.0   ? BD_RULE_FAR
                             : away > 2.0 ? BD_RULE_NEAR
                             : away > 1.0 ? BD_RULE_NEARER
                                          : BD_RULE_CLOSE];
}

/* The pair's integrals over both areas, in the corners' own order. */
static void integrate(const bd_radiation *radiation, const panel *x, const panel *y, int mirrored,
                      double k, bd_pair *pair)
{
    int order_x[3], order_y[3];
    const bd_rule *rule = choose(radiation, x, y, mirrored, order_x, order_y);
    double X[9], Y[9];
    for (int a = 0; a < 3; a++) {
        memcpy(X + 3 * a, x->X + 3 * order_x[a], 3 * sizeof(double));
        memcpy(Y + 3 * a, y->X + 3 * order_y[a], 3 * sizeof(double));
    }
    bd_pair found;
    radiation->pair(rule, X, x->normal, Y, y->normal, k, &found);
    const double both = x->area * y->area;
    for (int part = 0; part < 2; part++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                const int from = 3 * a + b, to = 3 * order_x[a] + order_y[b];
                pair->G[part][to] = both * found.G[part][from];
                pair->Hy[part][to] = both * found.Hy[part][from];
                pair->Hx[part][to] = both * found.Hx[part][from];
            }
}

static void add_pair(const bd_radiation *radiation, int t, int s, int mirrored, double k,
                     const bd_radiation_operators *out)
{
    const panel *x = &radiation->panels[t];
    panel image;
    if (mirrored)
        reflect(radiation, &radiation->panels[s], &image);
    const panel *y = mirrored ? &image : &radiation->panels[s];
    const long faces = radiation->n_faces, points = radiation->n_points;
    bd_pair pair;
    integrate(radiation, x, y, mirrored, k, &pair);
    if (t == s &&
        !mirrored) { /* on a plane there is no slope along its normal but the source's own */
        memset(pair.Hx, 0, sizeof pair.Hx);
        memset(pair.Hy, 0, sizeof pair.Hy);
    }
    const double normals = k * k * dot(x->normal, y->normal);
    for (int part = 0; part < 2; part++) {
        const double *G = pair.G[part], *Hx = pair.Hx[part], *Hy = pair.Hy[part];
        double all = 0.0;
        for (int c = 0; c < 9; c++)
            all += G[c];
        out->V[2 * (t * faces + s) + part] += all;
        if (t != s)
            out->V[2 * (s * faces + t) + part] += all;
        for (int a = 0; a < 3; a++) {
            const long i = x->corner[a];
            out->V1[2 * (i * faces + s) + part] += G[3 * a] + G[3 * a + 1] + G[3 * a + 2];
            out->Kt[2 * (i * faces + s) + part] += Hx[3 * a] + Hx[3 * a + 1] + Hx[3 * a + 2];
            for (int b = 0; b < 3; b++) {
                const long j = y->corner[b];
                const double d =
                    all * dot(x->side + 3 * a, y->side + 3 * b) - normals * G[3 * a + b];
                out->D[2 * (i * points + j) + part] += d;
                out->K[2 * (i * points + j) + part] += Hy[3 * a + b];
                if (t == s)
                    continue;
                out->D[2 * (j * points + i) + part] += d;
                out->K[2 * (j * points + i) + part] += Hx[3 * a + b];
            }
        }
        if (t == s)
            continue;
        for (int b = 0; b < 3; b++) {
            const long j = y->corner[b];
            out->V1[2 * (j * faces + t) + part] += G[b] + G[3 + b] + G[6 + b];
            out->Kt[2 * (j * faces + t) + part] += Hy[b] + Hy[3 + b] + Hy[6 + b];
        }
    }
}

void bd_radiation_rows(const bd_radiation *radiation, double k, int first, int count,
                       const bd_radiation_operators *out)
{
    for (int t = first; t < first + count; t++)
        for (int s = t; s < radiation->n_faces; s++) {
            add_pair(radiation, t, s, 0, k, out);
            if (radiation->floor)
                add_pair(radiation, t, s, 1, k, out);
        }
}
