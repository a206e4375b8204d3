/* radiation.h - the integral operators of sound outside closed surfaces of flat triangles.
 *
 * Time runs as exp(+i omega t), so that G(x, y) = exp(-i k r) / (4 pi r) goes out; normals point into the fluid. The
 * pressure is linear on each triangle and continuous (phi_a of point a), its slope along the normal constant on
 * each triangle (1_t). A rigid floor y = height adds to G that of the mirrored source. Integrated over both surfaces:
 *     V [t][s] = <1_t, G 1_s>                       V1[a][s] = <phi_a, G 1_s>
 *     K [a][b] = <phi_a, dG/dn_y phi_b>             Kt[a][s] = <phi_a, dG/dn_x 1_s>
 *     D [a][b] = <phi_a, -d2G/dn_x dn_y phi_b> = int int G (curl phi_a curl phi_b - k^2 n_x n_y phi_a phi_b)
 * Reference: Nedelec, Acoustic and Electromagnetic Equations, Springer 2001, section 3.4 */
#ifndef BD_RADIATION_H
#define BD_RADIATION_H

typedef struct bd_radiation_data {
    int n_points, n_faces;
    const double *points; /* (n_points x 3), m */
    const int *faces;     /* (n_faces x 3), anticlockwise seen from outside */
    int floor; /* nonzero: the plane y = floor_height is rigid, and all points lie on or above it */
    double floor_height; /* m */
} bd_radiation_data;

/* Complex, row-major, real and imaginary parts side by side; zero before the first row. */
typedef struct bd_radiation_operators {
    double *V;  /* (n_faces x n_faces) */
    double *V1; /* (n_points x n_faces) */
    double *Kt; /* (n_points x n_faces) */
    double *K;  /* (n_points x n_points) */
    double *D;  /* (n_points x n_points) */
} bd_radiation_operators;

typedef struct bd_radiation bd_radiation;

/* Given:    the surface, its indices in range and its triangles with area; copied
 * Returned: NULL where there is no memory */
bd_radiation *bd_radiation_create(const bd_radiation_data *data);
void bd_radiation_free(bd_radiation *radiation);

/* Adds the pairs of the triangles first ... first + count - 1 with themselves and all later ones, at wave number
 * k, 1/m. All rows together, in any order, make the operators. */
void bd_radiation_rows(const bd_radiation *radiation, double k, int first, int count,
                       const bd_radiation_operators *out);

#endif
