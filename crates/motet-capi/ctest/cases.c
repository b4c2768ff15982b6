/* The small cases of testdata, by the C library: prints a name and a number a line.
 *
 *   cases repair MESH PATCH DX DY DZ SMOOTH     a patch is shifted, bad tets are repaired, x is transferred
 *   cases implant HOST DEVICE NAME
 *   cases contact SURFACE SURFACE
 *   cases loop MESH PATCH DX DY DZ STEPS        a patch moves away in steps and returns; saved and loaded half way
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "motet.h"

static motet_error *error = NULL;

static void ok(motet_status status)
{
    if (status == MOTET_OK) return;
    fprintf(stderr, "%s\n", motet_error_message(error));
    exit(1);
}

static void *memory(size_t n, size_t of)
{
    void *place = calloc(n ? n : 1, of);
    if (place == NULL) exit(1);
    return place;
}

static motet_mesh *read_mesh(const char *path)
{
    motet_mesh *mesh = NULL;
    ok(motet_mesh_read(path, &mesh, &error));
    return mesh;
}

static void report(const char *name, double value) { printf("%s %.17g\n", name, value); }

static void report_mesh(const motet_mesh *mesh)
{
    int64_t n = motet_mesh_n_points(mesh), n_cells = motet_mesh_n_cells(mesh), i;
    double *points = memory(3 * n, sizeof *points), *eas = memory(n_cells, sizeof *eas), sum[3] = {0, 0, 0}, worst = 1;
    ok(motet_mesh_points(mesh, points, n, 3, &error));
    ok(motet_mesh_eas(mesh, eas, n_cells, &error));
    for (i = 0; i < 3 * n; i++) sum[i % 3] += points[i];
    for (i = 0; i < n_cells; i++)
        if (eas[i] < worst) worst = eas[i];
    report("points", (double)n);
    report("tets", (double)motet_mesh_n_of_kind(mesh, MOTET_TETRA));
    report("sum_x", sum[0]), report("sum_y", sum[1]), report("sum_z", sum[2]);
    report("worst_eas", worst);
    free(points), free(eas);
}

static void repair(char **words)
{
    motet_mesh *mesh = read_mesh(words[0]);
    motet_mover_options options;
    motet_mover *mover = NULL;
    motet_certificate certificate;
    motet_outcome *outcome = NULL;
    int64_t n_points = motet_mesh_n_points(mesh), n_patch = motet_mesh_n_patch_vertices(mesh, words[1]), n, n_new, i, k = 0;
    int32_t *patch = memory(n_patch > 0 ? n_patch : 0, sizeof *patch), *boundary;
    double *points = memory(3 * n_points, sizeof *points), *x = memory(n_points, sizeof *x), *displacement, *new_x, sum = 0;
    ok(motet_mesh_patch_vertices(mesh, words[1], patch, n_patch > 0 ? n_patch : 0, &error));
    motet_mover_options_init(&options, sizeof options);
    options.smooth = atoi(words[5]);
    ok(motet_mover_new(mesh, &options, &mover, &error));
    n = motet_mover_n_boundary(mover);
    boundary = memory(n, sizeof *boundary), displacement = memory(3 * n, sizeof *displacement);
    ok(motet_mover_boundary(mover, boundary, n, &error));
    for (i = 0; i < n; i++) { /* both lists are in ascending order */
        while (k < n_patch && patch[k] < boundary[i]) k++;
        if (k < n_patch && patch[k] == boundary[i])
            displacement[3 * i] = atof(words[2]), displacement[3 * i + 1] = atof(words[3]), displacement[3 * i + 2] = atof(words[4]);
    }
    motet_certificate_init(&certificate, sizeof certificate);
    ok(motet_mover_advance(mover, displacement, n, 3, points, n_points, 3, &certificate, &error));
    report("complete", certificate.complete);
    report("bad_after_motion", (double)certificate.bad);
    report("worst_after_motion", certificate.worst_eas);
    ok(motet_mesh_set_points(mesh, points, n_points, 3, &error));
    ok(motet_remesh(mesh, NULL, &outcome, &error));
    report("repaired", motet_outcome_complete(outcome));
    report_mesh(motet_outcome_mesh(outcome));
    for (i = 0; i < n_points; i++) x[i] = points[3 * i];
    n_new = motet_mesh_n_points(motet_outcome_mesh(outcome));
    new_x = memory(n_new, sizeof *new_x);
    ok(motet_outcome_transfer(outcome, MOTET_ON_POINTS, MOTET_RULE_MEAN, x, n_points, 1, new_x, n_new, &error));
    for (i = 0; i < n_new; i++) sum += new_x[i];
    report("sum_carried", sum);
    free(patch), free(boundary), free(points), free(x), free(displacement), free(new_x);
    motet_outcome_free(outcome), motet_mover_free(mover), motet_mesh_free(mesh);
}

static void implant(char **words)
{
    motet_mesh *host = read_mesh(words[0]), *device = read_mesh(words[1]);
    const motet_mesh *const devices[1] = {device};
    const char *names[1] = {words[2]};
    motet_outcome *outcome = NULL;
    const motet_mesh *mesh;
    ok(motet_implant(host, devices, names, 1, NULL, &outcome, &error));
    mesh = motet_outcome_mesh(outcome);
    report("complete", motet_outcome_complete(outcome));
    report("region", motet_mesh_region(mesh, words[2]));
    report_mesh(mesh);
    motet_outcome_free(outcome), motet_mesh_free(host), motet_mesh_free(device);
}

static void contact(char **words)
{
    motet_mesh *first = read_mesh(words[0]), *second = read_mesh(words[1]);
    motet_contact *contact = NULL;
    int64_t n[2] = {motet_mesh_n_points(first), motet_mesh_n_points(second)}, counts[2], i;
    int32_t *triangles;
    double *points = memory(3 * (n[0] + n[1]), sizeof *points), *gaps = memory(n[0] + n[1], sizeof *gaps), least, sum = 0;
    counts[0] = motet_mesh_n_of_kind(first, MOTET_TRIANGLE), counts[1] = motet_mesh_n_of_kind(second, MOTET_TRIANGLE);
    triangles = memory(3 * (counts[0] + counts[1]), sizeof *triangles);
    ok(motet_mesh_points(first, points, n[0], 3, &error));
    ok(motet_mesh_points(second, points + 3 * n[0], n[1], 3, &error));
    ok(motet_mesh_of_kind(first, MOTET_TRIANGLE, triangles, 3 * counts[0], &error));
    ok(motet_mesh_of_kind(second, MOTET_TRIANGLE, triangles + 3 * counts[0], 3 * counts[1], &error));
    for (i = 3 * counts[0]; i < 3 * (counts[0] + counts[1]); i++) triangles[i] += (int32_t)n[0];
    ok(motet_contact_new(points, n[0] + n[1], 3, triangles, counts, NULL, 2, NULL, &contact, &error));
    ok(motet_contact_measure(contact, gaps, n[0] + n[1], &least, &error));
    for (i = 0; i < n[0] + n[1]; i++)
        if (isfinite(gaps[i])) sum += gaps[i];
    report("least", least);
    report("sum_of_gaps", sum);
    free(points), free(gaps), free(triangles);
    motet_contact_free(contact), motet_mesh_free(first), motet_mesh_free(second);
}

/* A patch moves away in `n_steps` steps and returns in as many; the state is saved and loaded half way. */
static void loop(char **words)
{
    motet_mesh *mesh = read_mesh(words[0]);
    int64_t n_points = motet_mesh_n_points(mesh), n_patch = motet_mesh_n_patch_vertices(mesh, words[1]), n_steps = atoi(words[5]), n, i, k, changes = 0;
    int32_t *patch = memory(n_patch, sizeof *patch);
    double *points = memory(3 * n_points, sizeof *points), *x = memory(n_points, sizeof *x), *places, *shifts, *displacement, *velocity, sum = 0;
    char *state = memory(strlen(words[0]) + sizeof ".state.vtu", 1);
    motet_moving_options options;
    motet_moving *moving = NULL;
    ok(motet_mesh_patch_vertices(mesh, words[1], patch, n_patch, &error));
    ok(motet_mesh_points(mesh, points, n_points, 3, &error));
    motet_moving_options_init(&options, sizeof options);
    options.smooth = 2;
    ok(motet_moving_new(mesh, &options, &moving, &error));
    n = motet_moving_n_driven(moving);
    places = memory(3 * n, sizeof *places), shifts = memory(3 * n, sizeof *shifts), displacement = memory(3 * n, sizeof *displacement);
    ok(motet_moving_driven_places(moving, places, n, 3, &error));
    for (i = 0, k = 0; i < n; i++) /* driven vertices and those of the patch are in ascending order */
        if (k < n_patch && memcmp(places + 3 * i, points + 3 * patch[k], 3 * sizeof *places) == 0) {
            shifts[3 * i] = atof(words[2]), shifts[3 * i + 1] = atof(words[3]), shifts[3 * i + 2] = atof(words[4]);
            k++;
        }
    for (i = 0; i < n_points; i++) x[i] = points[3 * i];
    for (k = 1; k <= 2 * n_steps; k++) {
        double part = (double)(k <= n_steps ? k : 2 * n_steps - k) / (double)n_steps;
        motet_outcome *outcome = NULL;
        motet_step step;
        for (i = 0; i < 3 * n; i++) displacement[i] = part * shifts[i];
        motet_step_init(&step, sizeof step);
        ok(motet_moving_advance(moving, (double)k, displacement, n, 3, &step, &error));
        if (!step.complete || step.bad || step.inverted) exit(4);
        changes += step.changes;
        ok(motet_moving_since(moving, k - 1, &outcome, &error)); /* an array of the caller is transferred */
        if (outcome != NULL) {
            int64_t n_new = step.points;
            double *new_x = memory(n_new, sizeof *new_x);
            ok(motet_outcome_transfer(outcome, MOTET_ON_POINTS, MOTET_RULE_MEAN, x, n_points, 1, new_x, n_new, &error));
            free(x), x = new_x, n_points = n_new;
            motet_outcome_free(outcome);
        }
        if (k == n_steps) {
            strcat(strcpy(state, words[0]), ".state.vtu");
            ok(motet_moving_save(moving, state, &error));
            motet_moving_free(moving);
            ok(motet_moving_load(state, &options, &moving, &error));
        }
    }
    velocity = memory(3 * n_points, sizeof *velocity);
    ok(motet_moving_velocity(moving, velocity, n_points, 3, &error));
    report("changes", (double)changes);
    report("time", motet_moving_time(moving));
    for (i = 0; i < n_points; i++) sum += velocity[3 * i];
    report("sum_velocity", sum);
    for (i = 0, sum = 0; i < n_points; i++) sum += x[i];
    report("sum_carried", sum);
    report_mesh(motet_moving_mesh(moving));
    free(patch), free(points), free(x), free(places), free(shifts), free(displacement), free(velocity), free(state);
    motet_moving_free(moving), motet_mesh_free(mesh);
}

int main(int n, char **words)
{
    if (n == 8 && strcmp(words[1], "repair") == 0) repair(words + 2);
    else if (n == 5 && strcmp(words[1], "implant") == 0) implant(words + 2);
    else if (n == 4 && strcmp(words[1], "contact") == 0) contact(words + 2);
    else if (n == 8 && strcmp(words[1], "loop") == 0) loop(words + 2);
    else return 2;
    return 0;
}
