/* HXT's optimiser of tets on a mesh that is there already, boundary kept.
 *
 * usage: remesh_hxt POINTS TETS TRIANGLES OUTER QUALITY LEAST THREADS OUT      raw little-endian f64 x 3, u32 x 4, u32 x 3
 *
 * The first OUTER points are those of the boundary, TRIANGLES its facets. QUALITY is `aspect`, HXT's own measure,
 * or `eas`; the optimiser works on tets below LEAST. Writes OUT.points and OUT.tets, prints JSON.
 * Gmsh calls this optimiser only on meshes that HXT has just made; Debian's libgmsh exports it, without a header,
 * hence the declarations here. The clock includes the adjacency and the constraints; three repeats.
 */
#define _POSIX_C_SOURCE 199309L
#include <float.h>
#include <math.h>
#include <omp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* The beginning of HXT's mesh: all that is used here. */
typedef struct {
  double *points; /* four numbers each */
  uint32_t n_points, room_points;
  uint32_t *tets;
  uint64_t *neighbours;
  uint32_t *colors;
  uint16_t *flags;
  uint64_t n_tets, room_tets;
  uint32_t *triangles, *triangle_colors;
  uint64_t n_triangles, room_triangles;
} Mesh;

typedef double Quality(double *a, double *b, double *c, double *d, void *);
typedef struct {
  void *box;
  Quality *quality;
  void *data;
  double least;
  int threads;
  uint32_t n_fixed;
  int verbosity, reproducible;
} Options;

int hxtMeshCreate(Mesh **);
int hxtMeshDelete(Mesh **);
int hxtTetAdjacencies(Mesh *);
int hxtAddGhosts(Mesh *);
int hxtGetTri2TetMap(Mesh *, uint64_t *tet_of_triangle, uint64_t *missing);
int hxtConstrainTriangles(Mesh *, uint64_t *tet_of_triangle);
int hxtOptimizeTetrahedra(Mesh *, Options *);
void hxtBboxAdd(void *box, double *points, uint32_t n);

enum { RUNS = 3 };

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

static void *load(const char *path, size_t *bytes) {
  FILE *file = fopen(path, "rb");
  if (!file) { perror(path); exit(1); }
  fseek(file, 0, SEEK_END);
  *bytes = ftell(file);
  rewind(file);
  void *data = malloc(*bytes);
  if (fread(data, 1, *bytes, file) != *bytes) exit(1);
  fclose(file);
  return data;
}

static void check(int status, const char *what) {
  if (status >= 0) return;
  fprintf(stderr, "HXT: %s ended with %d\n", what, status);
  exit(1);
}

static void cross(const double *u, const double *v, double *w) {
  for (int i = 0; i < 3; i++) w[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
}

static double dot(const double *u, const double *v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

/* The cosine between two vectors, turned by half: of the angle inside a facet, or between two facets. */
static double inner(const double *u, const double *v) { return -dot(u, v) / sqrt(dot(u, u) * dot(v, v)); }

typedef struct { double low, high; } Range; /* of cosines: the greatest and the least angle */

static void widen(Range *range, double cosine) {
  if (cosine < range->low) range->low = cosine;
  if (cosine > range->high) range->high = cosine;
}

static double skew(Range cosines, double right) {
  const double pi = acos(-1), greatest = acos(fmax(cosines.low, -1)), least = acos(fmin(cosines.high, 1));
  return fmax((greatest - right) / (pi - right), (right - least) / right);
}

/* 1 - skew, as Verdict's tet_equiangle_skew; 0 for a tet that is not positive. */
static double eas(double *a, double *b, double *c, double *d, void *unused) {
  (void)unused;
  static const int facets[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}; /* turned outward */
  double *corners[4] = {a, b, c, d}, normals[4][3];
  Range plane = {2, -2}, dihedral = {2, -2};
  for (int f = 0; f < 4; f++) {
    double edges[3][3];
    for (int k = 0; k < 3; k++)
      for (int i = 0; i < 3; i++) edges[k][i] = corners[facets[f][(k + 1) % 3]][i] - corners[facets[f][k]][i];
    cross(edges[0], edges[1], normals[f]);
    for (int k = 0; k < 3; k++) widen(&plane, inner(edges[k], edges[(k + 1) % 3]));
    for (int g = 0; g < f; g++) widen(&dihedral, inner(normals[f], normals[g]));
  }
  const double up[3] = {d[0] - a[0], d[1] - a[1], d[2] - a[2]};
  if (dot(normals[3], up) >= 0) return 0;
  return fmax(0, 1 - fmax(skew(plane, acos(0.5)), skew(dihedral, acos(1. / 3))));
}

static Mesh *mesh_of(char **words) {
  size_t bytes;
  Mesh *mesh;
  check(hxtMeshCreate(&mesh), "hxtMeshCreate");
  double *points = load(words[1], &bytes);
  mesh->n_points = mesh->room_points = bytes / 24;
  mesh->points = calloc(mesh->n_points, 32);
  for (size_t i = 0; i < mesh->n_points; i++) memcpy(mesh->points + 4 * i, points + 3 * i, 24);
  free(points);
  mesh->tets = load(words[2], &bytes);
  mesh->n_tets = mesh->room_tets = bytes / 16;
  mesh->colors = calloc(mesh->n_tets, sizeof *mesh->colors);
  mesh->flags = calloc(mesh->n_tets, sizeof *mesh->flags);
  mesh->triangles = load(words[3], &bytes);
  mesh->n_triangles = mesh->room_triangles = bytes / 12;
  mesh->triangle_colors = calloc(mesh->n_triangles, sizeof *mesh->triangle_colors);
  return mesh;
}

static void optimise(Mesh *mesh, uint32_t n_fixed, Quality *quality, double least, int threads) {
  double box[8] __attribute__((aligned(32))) = {DBL_MAX, DBL_MAX, DBL_MAX, 0, -DBL_MAX, -DBL_MAX, -DBL_MAX, 0};
  hxtBboxAdd(box, mesh->points, mesh->n_points);
  check(hxtTetAdjacencies(mesh), "hxtTetAdjacencies");
  check(hxtAddGhosts(mesh), "hxtAddGhosts");
  uint64_t *tet_of_triangle = malloc(8 * mesh->n_triangles), missing = 0;
  check(hxtGetTri2TetMap(mesh, tet_of_triangle, &missing), "hxtGetTri2TetMap");
  check(missing ? -1 : 0, "the search for boundary facets");
  check(hxtConstrainTriangles(mesh, tet_of_triangle), "hxtConstrainTriangles");
  free(tet_of_triangle);
  Options options = {box, quality, NULL, least, threads, n_fixed, 0, 1};
  check(hxtOptimizeTetrahedra(mesh, &options), "hxtOptimizeTetrahedra");
}

static void save(const Mesh *mesh, const char *out) {
  char path[4096];
  snprintf(path, sizeof path, "%s.points", out);
  FILE *file = fopen(path, "wb");
  for (size_t i = 0; i < mesh->n_points; i++) fwrite(mesh->points + 4 * i, 8, 3, file);
  fclose(file);
  snprintf(path, sizeof path, "%s.tets", out);
  file = fopen(path, "wb");
  for (size_t i = 0; i < mesh->n_tets; i++)
    if (mesh->tets[4 * i + 3] != UINT32_MAX) fwrite(mesh->tets + 4 * i, 4, 4, file);
  fclose(file);
}

int main(int count, char **words) {
  if (count != 9) return 2;
  const int threads = atoi(words[7]);
  omp_set_num_threads(threads);
  double seconds[RUNS];
  for (int run = 0; run < RUNS; run++) {
    Mesh *mesh = mesh_of(words);
    const double start = now();
    optimise(mesh, atoi(words[4]), strcmp(words[5], "eas") ? NULL : eas, atof(words[6]), threads);
    seconds[run] = now() - start;
    if (run == RUNS - 1) save(mesh, words[8]);
    hxtMeshDelete(&mesh);
  }
  printf("{\"seconds\": [%.6f, %.6f, %.6f], \"version\": \"4.8.4\"}\n", seconds[0], seconds[1], seconds[2]);
}
