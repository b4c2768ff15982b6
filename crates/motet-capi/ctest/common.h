/* Checks and meshes that the tests of motet.h share. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "motet.h"

#define CHECK(so)                                                                    \
    do {                                                                             \
        if (!(so)) {                                                                 \
            fprintf(stderr, "%s:%d: check failed: %s\n", __FILE__, __LINE__, #so);   \
            exit(1);                                                                 \
        }                                                                            \
    } while (0)

/* A call that must succeed. */
static void ok(motet_status status, motet_error **error, int line)
{
    if (status != MOTET_OK) {
        fprintf(stderr, "line %d: %s\n", line, motet_error_message(*error));
        exit(1);
    }
    CHECK(*error == NULL);
}
#define OK(call) ok((call), &error, __LINE__)

/* A call that must fail with this status and these words. */
static void refused(motet_status status, motet_error **error, motet_status expected, const char *words, int line)
{
    if (status != expected || *error == NULL || strstr(motet_error_message(*error), words) == NULL) {
        fprintf(stderr, "line %d: status %d, %s\n", line, (int)status, *error ? motet_error_message(*error) : "no error");
        exit(1);
    }
    CHECK(motet_error_status(*error) == expected && motet_error_what(*error) != NULL);
    motet_error_free(*error);
    *error = NULL;
}
#define REFUSED(call, expected, words) refused((call), &error, expected, words, __LINE__)

enum { N = 6, N_POINTS = (N + 1) * (N + 1) * (N + 1), N_TETS = 6 * N * N * N };

static int corner(int i, int j, int k) { return (k * (N + 1) + j) * (N + 1) + i; }

/* The unit cube: each cell of a grid cut into six tets around its diagonal. */
static motet_mesh *cube(void)
{
    static const int paths[6][2][3] = {
        {{1, 0, 0}, {1, 1, 0}}, {{1, 1, 0}, {0, 1, 0}}, {{0, 1, 0}, {0, 1, 1}}, {{0, 1, 1}, {0, 0, 1}}, {{0, 0, 1}, {1, 0, 1}}, {{1, 0, 1}, {1, 0, 0}}};
    static double points[N_POINTS][3];
    static int32_t tets[N_TETS][4];
    motet_error *error = NULL;
    motet_mesh *mesh = NULL;
    int i, j, k, p, n = 0;
    for (k = 0; k <= N; k++)
        for (j = 0; j <= N; j++)
            for (i = 0; i <= N; i++) {
                double *point = points[corner(i, j, k)];
                point[0] = (double)i / N, point[1] = (double)j / N, point[2] = (double)k / N;
            }
    for (k = 0; k < N; k++)
        for (j = 0; j < N; j++)
            for (i = 0; i < N; i++)
                for (p = 0; p < 6; p++, n++) {
                    const int *a = paths[p][0], *b = paths[p][1];
                    tets[n][0] = corner(i, j, k);
                    tets[n][1] = corner(i + a[0], j + a[1], k + a[2]);
                    tets[n][2] = corner(i + b[0], j + b[1], k + b[2]);
                    tets[n][3] = corner(i + 1, j + 1, k + 1);
                }
    OK(motet_mesh_new(&points[0][0], N_POINTS, 3, &mesh, &error));
    OK(motet_mesh_add_cells(mesh, MOTET_TETRA, &tets[0][0], N_TETS, &error));
    return mesh;
}

/* The surface of an octahedron. */
static motet_mesh *octahedron(double x, double y, double z, double radius)
{
    static const int32_t triangles[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    double points[6][3];
    motet_error *error = NULL;
    motet_mesh *mesh = NULL;
    int i;
    for (i = 0; i < 6; i++) {
        points[i][0] = x, points[i][1] = y, points[i][2] = z;
        points[i][i / 2] += i % 2 ? -radius : radius;
    }
    OK(motet_mesh_new(&points[0][0], 6, 3, &mesh, &error));
    OK(motet_mesh_add_cells(mesh, MOTET_TRIANGLE, &triangles[0][0], 8, &error));
    return mesh;
}
