#include "panels.h"

#include "kernels.h"
#include "lanes.h"

#define BLOCK 128 /* points whose kernels are kept at a time: 6 KB, in the first cache */

/* sin and cos of lanes, to 1e-13: the angle modulo 2 pi, a quarter of it by series, and doubled twice. */
BD_INLINE void sine_cosine(const lanes *angle, lanes *sine, lanes *cosine)
{
    const double whole = 6755399441055744.0; /* 1.5 * 2^52: adding it rounds to an integer */
    lanes turns = *angle * 0.15915494309189533577;
    lanes t = (turns - ((turns + whole) - whole)) * 1.57079632679489661923, u = t * t;
    lanes s =
        t * (1.0 + u * (-1.0 / 6 +
                        u * (1.0 / 120 +
                             u * (-1.0 / 5040 +
                                  u * (1.0 / 362880 + u * (-1.0 / 39916800 + u / 6227020800.0))))));
    lanes c =
        1.0 +
        u * (-0.5 + u * (1.0 / 24 +
                         u * (-1.0 / 720 +
                              u * (1.0 / 40320 + u * (-1.0 / 3628800 + u * (1.0 / 479001600 -
                                                                            u / 87178291200.0))))));
    lanes s2 = 2.0 * s * c, c2 = 1.0 - 2.0 * s * s;
    *sine = 2.0 * s2 * c2;
    *cosine = 1.0 - 2.0 * s2 * s2;
}

extern bd_pair_function BD_NAMED(bd_panel_pair);

void BD_NAMED(bd_panel_pair)(const bd_rule *rule, const double *X, const double *normal_x,
                             const double *Y, const double *normal_y, double k, bd_pair *pair)
{
    lanes sum[6][9] = {{{0}}};
    double kernel[6][BLOCK];

    for (int first = 0; first < rule->n; first += BLOCK) {
        const int many = rule->n - first < BLOCK ? rule->n - first : BLOCK;

        for (int i = 0; i < many; i += BD_WIDTH) {
            const double *at = rule->x + first + i, *to = rule->y + first + i;
            lanes x0 = LANES(at), x1 = LANES(at + rule->n), x2 = LANES(at + 2 * rule->n);
            lanes y0 = LANES(to), y1 = LANES(to + rule->n), y2 = LANES(to + 2 * rule->n);
            lanes square = {0}, along_x = {0}, along_y = {0}, r, sine, cosine;
            for (int j = 0; j < 3; j++) {
                lanes d = (y0 * Y[j] + y1 * Y[3 + j] + y2 * Y[6 + j]) -
                          (x0 * X[j] + x1 * X[3 + j] + x2 * X[6 + j]);
                square += d * d;
                along_x -= d * normal_x[j];
                along_y += d * normal_y[j];
            }
            lanes_sqrt(&square, &r);
            lanes inverse = 1.0 / r, angle = k * r;
            sine_cosine(&angle, &sine, &cosine);
            lanes scale = 0.079577471545947667884 * inverse; /* 1 / (4 pi r) */
            lanes re = scale * cosine, im = -scale * sine;
            /* dG/dr = -(1/r + i k) G, and dr/dn = (y - x) n / r */
            lanes slope_re = (k * im - inverse * re) * inverse;
            lanes slope_im = -(k * re + inverse * im) * inverse;
            LANES_AT(kernel[0] + i) = re;
            LANES_AT(kernel[1] + i) = im;
            LANES_AT(kernel[2] + i) = slope_re * along_y;
            LANES_AT(kernel[3] + i) = slope_im * along_y;
            LANES_AT(kernel[4] + i) = slope_re * along_x;
            LANES_AT(kernel[5] + i) = slope_im * along_x;
        }
        for (int c = 0; c < 9; c++) {
            const double *weight = rule->c + (size_t)c * (size_t)rule->n + first;
            lanes s0 = sum[0][c], s1 = sum[1][c], s2 = sum[2][c];
            lanes s3 = sum[3][c], s4 = sum[4][c], s5 = sum[5][c];
            for (int i = 0; i < many; i += BD_WIDTH) {
                lanes w = LANES(weight + i);
                s0 += w * LANES(kernel[0] + i);
                s1 += w * LANES(kernel[1] + i);
                s2 += w * LANES(kernel[2] + i);
                s3 += w * LANES(kernel[3] + i);
                s4 += w * LANES(kernel[4] + i);
                s5 += w * LANES(kernel[5] + i);
            }
            sum[0][c] = s0, sum[1][c] = s1, sum[2][c] = s2;
            sum[3][c] = s3, sum[4][c] = s4, sum[5][c] = s5;
        }
    }
    double *out[6] = {pair->G[0], pair->G[1], pair->Hy[0], pair->Hy[1], pair->Hx[0], pair->Hx[1]};
    for (int f = 0; f < 6; f++)
        for (int c = 0; c < 9; c++) {
            double total = 0.0;
            for (int j = 0; j < BD_WIDTH; j++)
                total += sum[f][c][j];
            out[f][c] = total;
        }
}
