/* Pairs of triangles: the rules integrate polynomials, and the static kernel over one triangle has a closed form. */
#include "panels.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "radiation.h"

static double factorial(int n)
{
    return n < 2 ? 1.0 : n * factorial(n - 1);
}

/* Mean of phi_0^a phi_1^b phi_2^c over a triangle: 2 a! b! c! / (a + b + c + 2)! */
static double mean(int a, int b, int c)
{
    return 2.0 * factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + 2);
}

static void rules_integrate_polynomials_of_both_triangles(void)
{
    bd_rule rules[BD_RULES];
    CHECK_EQUAL("memory", bd_rules_create(rules), 0);
    /* 4 Gauss points carry degree 7 of each coordinate, of which the cube's first takes 3 for its volume */
    static const int degrees[BD_RULES] = {4, 4, 4, 2, 4, 6, 9};
    for (int kind = 0; kind < BD_RULES; kind++) {
        const bd_rule *rule = &rules[kind];
        const int touching = kind < BD_RULE_FAR;
        double worst = 0.0;
        for (int p = 0; p <= degrees[kind]; p++)
            for (int q = 0; q <= degrees[kind] - (touching ? p : 0); q++) {
                double sum = 0.0, without = 0.0;
                for (int i = 0; i < rule->n; i++) {
                    double weight = 0.0;
                    for (int c = 0; c < 9; c++)
                        weight += rule->c[c * rule->n + i];
                    const double *x = rule->x, *y = rule->y;
                    sum += weight * pow(x[rule->n + i], p) * pow(y[2 * rule->n + i], q);
                    without += weight;
                }
                worst = fmax(worst, fabs(sum / (mean(0, p, 0) * mean(0, 0, q)) - 1.0));
                worst = fmax(worst, fabs(without - 1.0));
            }
        /* the tables have 15 digits, and some hundred products are summed */
        CHECK_BELOW("polynomials on a pair of triangles", worst, 1e-12);
    }
    bd_rules_free(rules);
}

/* The mean of 1/r over both points of one triangle with sides l: -(4/3) sum ln(1 - 2 l / perimeter) / l.
 * Reference: Eibert, Hansen, IEEE Trans. Antennas Propag. 43 (1995) 1499. */
static void potential_of_a_triangle_on_itself_has_its_closed_form(void)
{
    const double points[9] = {0.0, 0.0, 0.0, 1.0, 0.1, 0.0, 0.3, 0.7, 0.2};
    const int faces[3] = {0, 1, 2};
    const bd_radiation_data data = {.n_points = 3, .n_faces = 1, .points = points, .faces = faces};
    bd_radiation *radiation = bd_radiation_create(&data);
    double V[2] = {0.0}, V1[6] = {0.0}, Kt[6] = {0.0}, K[18] = {0.0}, D[18] = {0.0};
    const bd_radiation_operators out = {V, V1, Kt, K, D};
    bd_radiation_rows(radiation, 1e-9, 0, 1, &out);
    double sides[3], perimeter = 0.0, closed = 0.0;
    for (int a = 0; a < 3; a++) {
        const double *p = points + 3 * a, *q = points + 3 * ((a + 1) % 3);
        sides[a] = sqrt(pow(p[0] - q[0], 2) + pow(p[1] - q[1], 2) + pow(p[2] - q[2], 2));
        perimeter += sides[a];
    }
    for (int a = 0; a < 3; a++)
        closed -= 4.0 / 3.0 * log(1.0 - 2.0 * sides[a] / perimeter) / sides[a];
    const double s = 0.5 * perimeter;
    const double area = sqrt(s * (s - sides[0]) * (s - sides[1]) * (s - sides[2]));
    /* what 4 Gauss points leave of a smooth integrand: 2e-5 seen */
    CHECK_CLOSE("1/r on one triangle", V[0] * 4.0 * 3.14159265358979323846 / (area * area), closed,
                1e-4 * closed);
    CHECK_CLOSE("parts of it", V1[0] + V1[2] + V1[4], V[0], 1e-14 * V[0]);
    /* a constant pressure has no curl: rows of D vanish with k */
    CHECK_BELOW("D of a constant", fabs(D[0] + D[2] + D[4]), 1e-14);
    bd_radiation_free(radiation);
}

int main(void)
{
    rules_integrate_polynomials_of_both_triangles();
    potential_of_a_triangle_on_itself_has_its_closed_form();
    return check_result();
}
