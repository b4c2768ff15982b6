/* The plain loop that any motion library has to beat, and the memory's own speed.
 *
 * usage: motion_loop update IDS WEIGHTS BOUNDARY THREADS SECONDS
 *        motion_loop move IDS WEIGHTS DISPLACEMENT FROM THREADS SECONDS
 *        motion_loop copy BYTES THREADS SECONDS
 *
 * update: x_i = sum over k of w_ik * b[id_ik], raw little-endian files (u32 x 4, f64 x 4, f64 x 3).
 * move: x_i = from_i + sum over k of w_ik * d[id_ik], which is motet's own step.
 * copy: reads half of BYTES and writes the other half. Both repeat for SECONDS and print every repeat.
 */
#define _POSIX_C_SOURCE 199309L
#include <omp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MAX_RUNS = 100000 };

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

static void update(size_t n, const uint32_t *restrict id, const double *restrict w, const double *restrict b,
                   double *restrict x, int threads) {
#pragma omp parallel for num_threads(threads) schedule(static)
  for (size_t i = 0; i < n; i++) {
    double sum[3] = {0, 0, 0};
    for (int k = 0; k < 4; k++)
      for (int c = 0; c < 3; c++) sum[c] += w[4 * i + k] * b[3 * (size_t)id[4 * i + k] + c];
    for (int c = 0; c < 3; c++) x[3 * i + c] = sum[c];
  }
}

static void move(size_t n, const uint32_t *restrict id, const double *restrict w, const double *restrict d,
                 const double *restrict from, double *restrict x, int threads) {
#pragma omp parallel for num_threads(threads) schedule(static)
  for (size_t i = 0; i < n; i++) {
    double sum[3] = {0, 0, 0};
    for (int k = 0; k < 4; k++)
      for (int c = 0; c < 3; c++) sum[c] += w[4 * i + k] * d[3 * (size_t)id[4 * i + k] + c];
    for (int c = 0; c < 3; c++) x[3 * i + c] = from[3 * i + c] + sum[c];
  }
}

static void copy(size_t n, const double *restrict a, double *restrict b, int threads) {
#pragma omp parallel for num_threads(threads) schedule(static)
  for (size_t i = 0; i < n; i++) b[i] = a[i];
}

int main(int argc, char **argv) {
  static double took[MAX_RUNS];
  int runs = 0;
  double check = 0, until;
  if (argc == 7 && !strcmp(argv[1], "update")) {
    size_t bytes;
    uint32_t *id = load(argv[2], &bytes);
    size_t n = bytes / 16;
    double *w = load(argv[3], &bytes), *b = load(argv[4], &bytes), *x = malloc(24 * n);
    int threads = atoi(argv[5]);
    update(n, id, w, b, x, threads);
    for (until = now() + atof(argv[6]); runs < MAX_RUNS && (runs < 5 || now() < until); runs++) {
      double start = now();
      update(n, id, w, b, x, threads);
      took[runs] = now() - start;
    }
    for (size_t i = 0; i < 3 * n; i++) check += x[i];
  } else if (argc == 8 && !strcmp(argv[1], "move")) {
    size_t bytes;
    uint32_t *id = load(argv[2], &bytes);
    size_t n = bytes / 16;
    double *w = load(argv[3], &bytes), *d = load(argv[4], &bytes), *from = load(argv[5], &bytes);
    double *x = malloc(24 * n);
    int threads = atoi(argv[6]);
    move(n, id, w, d, from, x, threads);
    for (until = now() + atof(argv[7]); runs < MAX_RUNS && (runs < 5 || now() < until); runs++) {
      double start = now();
      move(n, id, w, d, from, x, threads);
      took[runs] = now() - start;
    }
    for (size_t i = 0; i < 3 * n; i++) check += x[i];
  } else if (argc == 5 && !strcmp(argv[1], "copy")) {
    size_t n = strtoull(argv[2], NULL, 10) / 16;
    int threads = atoi(argv[3]);
    double *a = malloc(8 * n), *b = malloc(8 * n);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t i = 0; i < n; i++) a[i] = i, b[i] = 0;
    for (until = now() + atof(argv[4]); runs < MAX_RUNS && (runs < 5 || now() < until); runs++) {
      double start = now();
      copy(n, a, b, threads);
      took[runs] = now() - start;
      check += b[n / 2];
    }
  } else {
    fputs("usage: motion_loop update IDS WEIGHTS BOUNDARY THREADS SECONDS | "
          "move IDS WEIGHTS DISPLACEMENT FROM THREADS SECONDS | copy BYTES THREADS SECONDS\n", stderr);
    return 2;
  }
  printf("{\"check\": %.17g, \"version\": \"gcc %d.%d\", \"seconds\": [", check, __GNUC__, __GNUC_MINOR__);
  for (int i = 0; i < runs; i++) printf("%s%.9f", i ? ", " : "", took[i]);
  puts("]}");
}
