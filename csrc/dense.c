#include "dense.h"

#include <math.h>

int bd_invert(int size, int padded, double *A, double *inverse)
{
    const size_t n = (size_t)size, stride = (size_t)padded;
    /* Gauss-Jordan on [A | I]; the right half starts as rows of I and is transposed at the end */
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < stride; j++)
            inverse[i * stride + j] = i == j ? 1.0 : 0.0;

    for (size_t k = 0; k < n; k++) {
        size_t pivot = k;
        for (size_t i = k + 1; i < n; i++)
            if (fabs(A[i * stride + k]) > fabs(A[pivot * stride + k]))
                pivot = i;
        if (!(fabs(A[pivot * stride + k]) > 0.0) || !isfinite(A[pivot * stride + k]))
            return 1;
        double scale = 1.0 / A[pivot * stride + k];
        for (size_t j = 0; j < n; j++) {
            double a = A[pivot * stride + j], b = inverse[pivot * stride + j];
            A[pivot * stride + j] = A[k * stride + j];
            inverse[pivot * stride + j] = inverse[k * stride + j];
            A[k * stride + j] = a * scale;
            inverse[k * stride + j] = b * scale;
        }
        for (size_t i = 0; i < n; i++) {
            double factor = A[i * stride + k];
            if (i == k)
                continue;
            for (size_t j = 0; j < n; j++) {
                A[i * stride + j] -= factor * A[k * stride + j];
                inverse[i * stride + j] -= factor * inverse[k * stride + j];
            }
        }
    }
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++) {
            double above = inverse[j * stride + i];
            inverse[j * stride + i] = inverse[i * stride + j];
            inverse[i * stride + j] = above;
        }
    return 0;
}
