/* panels.h - inside the core: pairs of flat triangles that radiate sound, and the points they are integrated with.
 *
 * A rule holds points on a pair of triangles, whole lanes of them: the shape functions (barycentric coordinates) of
 * both, and the weight, of which all sum to 1. Coefficient 3 a + b is weight * phi_a(x) * phi_b(y). */
#ifndef BD_PANELS_H
#define BD_PANELS_H

#include "bearingdyn.h"

/* The touching pairs, by how many corners they share, and the apart ones, far to close. */
typedef enum bd_rule_kind {
    BD_RULE_CORNER, /* one corner in common, the first of both */
    BD_RULE_EDGE,   /* two, the first two of both in the same order */
    BD_RULE_SAME,   /* all three */
    BD_RULE_FAR,
    BD_RULE_NEAR,
    BD_RULE_NEARER,
    BD_RULE_CLOSE,
    BD_RULES
} bd_rule_kind;

typedef struct bd_rule {
    int n;         /* points, a multiple of BD_LANES; those that fill up have no weight */
    double *x, *y; /* (3 x n) shape functions on the first triangle and on the second */
    double *c;     /* (9 x n) coefficients */
} bd_rule;

/* Returned: 0, or nonzero where there is no memory; rules are freed by bd_rules_free in either case. */
int bd_rules_create(bd_rule rules[BD_RULES]);
void bd_rules_free(bd_rule rules[BD_RULES]);

/* Integrals over a pair of triangles per unit of both areas, weighted by phi_a(x) phi_b(y), as [a][b]. */
typedef struct bd_pair {
    double G[2][9];  /* of G = exp(-i k r) / (4 pi r), real and imaginary part */
    double Hy[2][9]; /* of its derivative along the normal at y */
    double Hx[2][9]; /* of that along the normal at x */
} bd_pair;

/* Given:    corners X, Y (3 x 3, m) and unit normals of two triangles in the order the rule wants; wave number, 1/m
 * Returned: the integrals. Compiled once per instruction set (kernels.h) */
typedef void bd_pair_function(const bd_rule *rule, const double *X, const double *normal_x,
                              const double *Y, const double *normal_y, double k, bd_pair *pair);

#endif
