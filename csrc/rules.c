/* Points and weights on pairs of triangles.
 *
 * Where two triangles touch, the kernel 1/r is integrated in coordinates that make it smooth (Sauter and Schwab);
 * elsewhere a rule of each triangle is multiplied with that of the other, the finer the closer they are. */
#include <math.h>
#include <stdlib.h>

#include "panels.h"

#define ORDER 4 /* Gauss points along each of the four coordinates of a touching pair */
#define CLOSE 6 /* along each of two, on a triangle close to another */

/* Gauss-Legendre on 0...1, by Newton's method from Chebyshev's points. */
static void gauss(int n, double *x, double *w)
{
    for (int i = 0; i < n; i++) {
        double z = cos(3.14159265358979323846 * (i + 0.75) / (n + 0.5)), slope = 1.0;
        for (int step = 0; step < 20; step++) {
            double p = 1.0, before = 0.0;
            for (int j = 1; j <= n; j++) {
                double next = ((2 * j - 1) * z * p - (j - 1) * before) / j;
                before = p;
                p = next;
            }
            slope = n * (z * p - before) / (z * z - 1.0);
            z -= p / slope;
        }
        x[i] = 0.5 * (1.0 - z);
        w[i] = 1.0 / ((1.0 - z * z) * slope * slope);
    }
}

static int rule_create(bd_rule *rule, int points)
{
    const size_t n = (size_t)((points + BD_LANES - 1) / BD_LANES * BD_LANES);
    rule->n = (int)n;
    rule->x = calloc(15 * n, sizeof *rule->x);
    if (!rule->x)
        return 1;
    rule->y = rule->x + 3 * n;
    rule->c = rule->y + 3 * n;
    return 0;
}

/* Point i of a rule by its barycentric coordinates; the last repeats without weight where the rule is filled up. */
static void put(bd_rule *rule, int i, const double *x, const double *y, double weight)
{
    for (int a = 0; a < 3; a++) {
        rule->x[a * rule->n + i] = x[a];
        rule->y[a * rule->n + i] = y[a];
        for (int b = 0; b < 3; b++)
            rule->c[(3 * a + b) * rule->n + i] = weight * x[a] * y[b];
    }
}

static void fill_up(bd_rule *rule, int points)
{
    for (int i = points; i < rule->n; i++) {
        double x[3], y[3];
        for (int a = 0; a < 3; a++) {
            x[a] = rule->x[a * rule->n + points - 1];
            y[a] = rule->y[a * rule->n + points - 1];
        }
        put(rule, i, x, y, 0.0);
    }
}

/* A point of the triangle 0 <= v <= u <= 1, whose corners are (0,0), (1,0), (1,1). */
static void corners_of(double u, double v, double *phi)
{
    phi[0] = 1.0 - u;
    phi[1] = u - v;
    phi[2] = v;
}

/* The regions into which the pair is cut, each mapped onto the unit cube: coordinates (u, v) on both triangles in
 * units of the cube's first coordinate.
 * Reference: Sauter, Schwab, Boundary Element Methods, Springer 2011, section 5.2. */
static void region(bd_rule_kind kind, int which, double p, double q, double s, double *x, double *y)
{
    const double pq = p * q, pqs = p * q * s;
    double first[2], second[2];
    switch (kind) {
    case BD_RULE_SAME:
        /* three regions, and each with the triangles exchanged */
        first[0] = which / 2 == 0 ? 1.0 : which / 2 == 1 ? 1.0 - pqs : 1.0;
        first[1] = which / 2 == 0   ? 1.0 - p + pq
                   : which / 2 == 1 ? p * (1.0 - q * s)
                                    : p * (1.0 - q + q * s);
        second[0] = which / 2 == 0 ? 1.0 - pqs : which / 2 == 1 ? 1.0 : 1.0 - pq;
        second[1] = which / 2 == 0 ? 1.0 - p : p * (1.0 - q);
        break;
    case BD_RULE_EDGE:
        if (which < 2) {
            first[0] = 1.0, first[1] = which == 0 ? p * s : p;
            second[0] = which == 0 ? 1.0 - pq : 1.0 - pqs;
            second[1] = which == 0 ? p * (1.0 - q) : pq * (1.0 - s);
        } else {
            first[0] = which == 2 ? 1.0 - pq : 1.0 - pqs;
            first[1] = which == 2 ? p * (1.0 - q) : which == 3 ? pq * (1.0 - s) : p * (1.0 - q * s);
            second[0] = 1.0, second[1] = which == 2 ? pqs : which == 3 ? p : pq;
        }
        break;
    default:
        first[0] = 1.0, first[1] = p;
        second[0] = q, second[1] = q * s;
        break;
    }
    const int turn = kind == BD_RULE_EDGE ? 0 : which % 2;
    for (int i = 0; i < 2; i++) {
        x[i] = turn ? second[i] : first[i];
        y[i] = turn ? first[i] : second[i];
    }
}

static int touching(bd_rule *rule, bd_rule_kind kind)
{
    const int regions = kind == BD_RULE_SAME ? 6 : kind == BD_RULE_EDGE ? 5 : 2;
    const int points = regions * ORDER * ORDER * ORDER * ORDER;
    double g[ORDER], w[ORDER];
    if (rule_create(rule, points))
        return 1;
    gauss(ORDER, g, w);
    int at = 0;
    for (int which = 0; which < regions; which++)
        for (int i = 0; i < ORDER * ORDER * ORDER * ORDER; i++) {
            const int a = i % ORDER, b = i / ORDER % ORDER, c = i / (ORDER * ORDER) % ORDER;
            const int d = i / (ORDER * ORDER * ORDER);
            double u[2], v[2], x[3], y[3];
            region(kind, which, g[b], g[c], g[d], u, v);
            /* the volume of the cube's element; both triangles together measure 1/4 */
            double weight = 4.0 * w[a] * w[b] * w[c] * w[d] * g[a] * g[a] * g[a];
            if (kind == BD_RULE_CORNER)
                weight *= g[c];
            else
                weight *= g[b] * g[b] * (kind == BD_RULE_EDGE && which == 0 ? 1.0 : g[c]);
            corners_of(g[a] * u[0], g[a] * u[1], x);
            corners_of(g[a] * v[0], g[a] * v[1], y);
            put(rule, at++, x, y, weight);
        }
    fill_up(rule, points);
    return 0;
}

/* Orbits of symmetric rules on a triangle: two coordinates and the weight of each point; equal coordinates make
 * three points, others six.
 * Reference: Dunavant, Int. J. Numer. Meth. Eng. 21 (1985) 1129: degrees 2, 4 and 6. */
static const double orbits[3][3][3] = {
    {{1.0 / 6.0, 1.0 / 6.0, 1.0 / 3.0}},
    {{0.445948490915965, 0.445948490915965, 0.223381589678011},
     {0.091576213509771, 0.091576213509771, 0.109951743655322}},
    {{0.063089014491502, 0.063089014491502, 0.050844906370207},
     {0.249286745170910, 0.249286745170910, 0.116786275726379},
     {0.310352451033785, 0.053145049844816, 0.082851075618374}},
};

/* Returned: how many points */
static int one_triangle(bd_rule_kind kind, double phi[][3], double *weight)
{
    int n = 0;
    if (kind == BD_RULE_CLOSE) {
        double g[CLOSE], w[CLOSE];
        gauss(CLOSE, g, w);
        for (int i = 0; i < CLOSE; i++)
            for (int j = 0; j < CLOSE; j++) {
                corners_of(g[i], g[i] * g[j], phi[n]);
                weight[n++] = 2.0 * w[i] * w[j] * g[i];
            }
        return n;
    }
    for (int o = 0; o < 3; o++) {
        const double *orbit = orbits[kind - BD_RULE_FAR][o];
        const double a = orbit[0], b = orbit[1], c = 1.0 - a - b;
        if (!(orbit[2] > 0.0))
            continue;
        const double values[3] = {a, b, c};
        static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                         {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};
        for (int p = 0; p < (a < b || a > b ? 6 : 3); p++) {
            for (int i = 0; i < 3; i++)
                phi[n][i] = values[orders[p][i]];
            weight[n++] = orbit[2];
        }
    }
    return n;
}

static int apart(bd_rule *rule, bd_rule_kind kind)
{
    double phi[CLOSE * CLOSE][3], weight[CLOSE * CLOSE];
    const int n = one_triangle(kind, phi, weight);
    if (rule_create(rule, n * n))
        return 1;
    for (int i = 0; i < n * n; i++)
        put(rule, i, phi[i / n], phi[i % n], weight[i / n] * weight[i % n]);
    fill_up(rule, n * n);
    return 0;
}

int bd_rules_create(bd_rule rules[BD_RULES])
{
    int failed = 0;
    for (int kind = 0; kind < BD_RULES; kind++) {
        rules[kind].x = NULL;
        failed = failed || (kind < BD_RULE_FAR ? touching(&rules[kind], (bd_rule_kind)kind)
                                               : apart(&rules[kind], (bd_rule_kind)kind));
    }
    return failed;
}

void bd_rules_free(bd_rule rules[BD_RULES])
{
    for (int kind = 0; kind < BD_RULES; kind++)
        free(rules[kind].x);
}
