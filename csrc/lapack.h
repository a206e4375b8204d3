/* lapack.h - the four LAPACK routines the core needs, through a table of function pointers.
 *
 * The binding fills the table from SciPy's own LAPACK, so that the extension links no BLAS; a C test
 * fills it with a small reference. Fortran calling convention, 32-bit integers, column-major. */
#ifndef BD_LAPACK_H
#define BD_LAPACK_H

typedef struct bd_lapack {
    void (*dgetrf)(int *m, int *n, double *a, int *lda, int *ipiv, int *info);
    void (*dgetrs)(char *trans, int *n, int *nrhs, double *a, int *lda, int *ipiv, double *b,
                   int *ldb, int *info);
    void (*zgetrf)(int *m, int *n, void *a, int *lda, int *ipiv, int *info);
    void (*zgetrs)(char *trans, int *n, int *nrhs, void *a, int *lda, int *ipiv, void *b, int *ldb,
                   int *info);
} bd_lapack;

/* Solve A X = B in place: A (n x n) is overwritten by its factors, B (n x nrhs) by X, column-major.
 * Returned: 0, or nonzero where A is singular to working precision. */
int bd_solve_real(const bd_lapack *lapack, int n, double *A, int *pivots, int nrhs, double *B);
int bd_solve_complex(const bd_lapack *lapack, int n, double *A, int *pivots, int nrhs, double *B);

#endif
