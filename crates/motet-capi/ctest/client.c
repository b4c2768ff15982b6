/* Tests what motet.h promises, as a program of C99. Prints one line, or the first check that fails. */
#include "common.h"

static void meshes(void)
{
    motet_error *error = NULL;
    motet_mesh *mesh = cube(), *copy = NULL, *none = NULL;
    motet_text *summary = NULL;
    double *points = malloc(sizeof(double) * 4 * N_POINTS), *eas = malloc(sizeof(double) * N_TETS);
    int32_t *tets = malloc(sizeof(int32_t) * 4 * N_TETS), *kinds = malloc(sizeof(int32_t) * N_TETS), *labels = malloc(sizeof(int32_t) * N_TETS);
    int64_t *offsets = malloc(sizeof(int64_t) * (N_TETS + 1));
    const int32_t wrong[4] = {0, 1, 2, N_POINTS};
    int i;
    CHECK(points && eas && tets && kinds && labels && offsets);
    CHECK(motet_mesh_n_points(mesh) == N_POINTS && motet_mesh_n_cells(mesh) == N_TETS);
    CHECK(motet_mesh_n_of_kind(mesh, MOTET_TETRA) == N_TETS && motet_mesh_n_of_kind(mesh, MOTET_HEXAHEDRON) == 0);
    for (i = 0; i < 4 * N_POINTS; i++) points[i] = -7;
    OK(motet_mesh_points(mesh, points, N_POINTS, 4, &error));
    for (i = 0; i < N_POINTS - 1; i++) CHECK(points[4 * i] >= 0 && points[4 * i + 3] == -7);
    OK(motet_mesh_of_kind(mesh, MOTET_TETRA, tets, 4 * N_TETS, &error));
    OK(motet_mesh_cells(mesh, kinds, N_TETS, offsets, tets, motet_mesh_n_vertices_of_cells(mesh), &error));
    CHECK(kinds[0] == MOTET_TETRA && offsets[N_TETS] == 4 * N_TETS && tets[0] == 0);
    OK(motet_mesh_eas(mesh, eas, N_TETS, &error));
    for (i = 0; i < N_TETS; i++) CHECK(eas[i] > 0.3 && eas[i] <= 1);

    for (i = 0; i < N_TETS; i++) labels[i] = 1 + (i >= N_TETS / 2);
    OK(motet_mesh_set_labels(mesh, labels, N_TETS, &error));
    OK(motet_mesh_name_region(mesh, 2, "upper half", &error));
    CHECK(motet_mesh_region(mesh, "upper half") == 2 && motet_mesh_region(mesh, "1") == 1 && motet_mesh_region(mesh, "none") == -1);
    OK(motet_mesh_labels(mesh, tets, N_TETS, &error));
    CHECK(memcmp(tets, labels, sizeof(int32_t) * N_TETS) == 0);
    OK(motet_mesh_set_array(mesh, MOTET_ON_CELLS, "eas", eas, N_TETS, 1, &error));
    CHECK(motet_mesh_array_components(mesh, MOTET_ON_CELLS, "eas") == 1 && motet_mesh_array_components(mesh, MOTET_ON_POINTS, "eas") == 0);
    OK(motet_mesh_copy(mesh, &copy, &error));
    OK(motet_mesh_array(copy, MOTET_ON_CELLS, "eas", eas, N_TETS, &error));
    OK(motet_mesh_summary(copy, &summary, &error));
    CHECK(strstr(motet_text_get(summary), "\"upper half\"") != NULL);
    motet_text_free(summary);

    REFUSED(motet_mesh_add_cells(copy, MOTET_TETRA, wrong, 1, &error), MOTET_ERROR_OPTIONS, "arrays on cells");
    motet_mesh_free(copy);
    copy = cube();
    REFUSED(motet_mesh_add_cells(copy, MOTET_TETRA, wrong, 1, &error), MOTET_ERROR_INPUT, "343");
    REFUSED(motet_mesh_add_cells(copy, MOTET_TETRA, wrong, -1, &error), MOTET_ERROR_OPTIONS, "-1 cells");
    REFUSED(motet_mesh_add_cells(copy, MOTET_TETRA, NULL, 1, &error), MOTET_ERROR_OPTIONS, "vertices is NULL");
    REFUSED(motet_mesh_add_cells(copy, 1000, wrong, 1, &error), MOTET_ERROR_OPTIONS, "1000");
    REFUSED(motet_mesh_add_cells(copy, 7, wrong, 1, &error), MOTET_ERROR_OPTIONS, "differ");
    CHECK(motet_mesh_n_cells(copy) == N_TETS);
    REFUSED(motet_mesh_new(NULL, 5, 3, &none, &error), MOTET_ERROR_OPTIONS, "points is NULL");
    REFUSED(motet_mesh_new(points, 5, 2, &none, &error), MOTET_ERROR_OPTIONS, "stride of 2");
    REFUSED(motet_mesh_new(points, 5, 3, NULL, &error), MOTET_ERROR_OPTIONS, "mesh is NULL");
    REFUSED(motet_mesh_points(copy, points, 5, 3, &error), MOTET_ERROR_OPTIONS, "expected 343");
    REFUSED(motet_mesh_read("/nowhere/mesh.vtu", &none, &error), MOTET_ERROR_IO, "/nowhere/mesh.vtu");
    REFUSED(motet_mesh_read(NULL, &none, &error), MOTET_ERROR_OPTIONS, "path is NULL");
    REFUSED(motet_mesh_array(copy, MOTET_ON_POINTS, "p", points, 1, &error), MOTET_ERROR_OPTIONS, "no array p");
    CHECK(none == NULL && motet_mesh_n_points(NULL) == 0 && motet_mesh_region(NULL, "x") == -1);
    CHECK(motet_mesh_points(copy, points, 5, 3, NULL) == MOTET_ERROR_OPTIONS); /* the error is not requested */
    CHECK(motet_error_message(NULL) == NULL && motet_error_status(NULL) == MOTET_OK);
    motet_mesh_free(NULL);
    motet_error_free(NULL);
    motet_mesh_free(copy);
    motet_mesh_free(mesh);
    free(points), free(eas), free(tets), free(kinds), free(labels), free(offsets);
}

static void motion(void)
{
    motet_error *error = NULL;
    motet_mesh *mesh = cube();
    motet_mover *mover = NULL;
    motet_mover_options options;
    motet_certificate certificate;
    double *first = malloc(sizeof(double) * 3 * N_POINTS), *points = malloc(sizeof(double) * 3 * N_POINTS), *apart = malloc(sizeof(double) * 5 * N_POINTS);
    double *displacement, *strided, weights[4];
    int32_t *boundary, four[4], is_hanging;
    const char *slide[1] = {"door"};
    int64_t n, i, k;
    CHECK(first && points && apart);
    OK(motet_mesh_points(mesh, first, N_POINTS, 3, &error));
    motet_mover_options_init(&options, sizeof options);
    CHECK(options.size == sizeof options && options.substeps == 50 && options.residual == 1e-6);
    options.threads = 2;
    OK(motet_mover_new(mesh, &options, &mover, &error));
    motet_mesh_free(mesh); /* no longer needed */
    n = motet_mover_n_boundary(mover);
    CHECK(n == N_POINTS - (N - 1) * (N - 1) * (N - 1) && motet_mover_n_points(mover) == N_POINTS);
    boundary = malloc(sizeof(int32_t) * n), displacement = malloc(sizeof(double) * 3 * n), strided = malloc(sizeof(double) * 4 * n);
    CHECK(boundary && displacement && strided);
    OK(motet_mover_boundary(mover, boundary, n, &error));
    /* An affine motion of the boundary moves every vertex by the same map. */
    for (i = 0; i < n; i++) {
        const double *x = first + 3 * boundary[i];
        displacement[3 * i] = 0.1 * x[1], displacement[3 * i + 1] = -0.2 * x[0] + 0.5, displacement[3 * i + 2] = 0.3 * x[2];
        for (k = 0; k < 3; k++) strided[4 * i + k] = displacement[3 * i + k];
    }
    OK(motet_mover_step(mover, displacement, n, 3, points, N_POINTS, 3, &error));
    for (i = 0; i < N_POINTS; i++) {
        const double *x = first + 3 * i, *y = points + 3 * i;
        CHECK(fabs(y[0] - x[0] - 0.1 * x[1]) < 1e-12 && fabs(y[1] - x[1] + 0.2 * x[0] - 0.5) < 1e-12 && fabs(y[2] - 1.3 * x[2]) < 1e-12);
    }
    /* Strided rows give the same, and nothing is written between the rows. */
    for (i = 0; i < 5 * N_POINTS; i++) apart[i] = -7;
    OK(motet_mover_step(mover, strided, n, 4, apart, N_POINTS, 5, &error));
    for (i = 0; i < N_POINTS; i++)
        CHECK(memcmp(apart + 5 * i, points + 3 * i, 3 * sizeof(double)) == 0 && apart[5 * i + 3] == -7 && apart[5 * i + 4] == -7);
    motet_certificate_init(&certificate, sizeof certificate);
    OK(motet_mover_advance(mover, displacement, n, 3, points, N_POINTS, 3, &certificate, &error));
    CHECK(certificate.complete == 1 && certificate.fraction == 1 && certificate.inverted == 0 && certificate.worst_eas > 0.2 && certificate.size == sizeof certificate);
    CHECK(certificate.worst_curved_cell == -1 && certificate.worst_curved_jacobian != certificate.worst_curved_jacobian && certificate.leaves_plane_vertex == -1);
    OK(motet_mover_advance(mover, displacement, n, 3, points, N_POINTS, 3, NULL, &error));
    /* A program that knows only the first members gets only these. */
    memset(&certificate, 0x55, sizeof certificate);
    certificate.size = offsetof(motet_certificate, fraction);
    OK(motet_mover_advance(mover, displacement, n, 3, points, N_POINTS, 3, &certificate, &error));
    CHECK(certificate.complete == 1 && certificate.bad == 0x5555555555555555 && certificate.size == offsetof(motet_certificate, fraction));

    OK(motet_mover_weights(mover, corner(1, 1, 1), four, weights, &is_hanging, &error));
    CHECK(is_hanging == 1 && fabs(weights[0] + weights[1] + weights[2] + weights[3] - 1) < 1e-14);
    OK(motet_mover_weights(mover, 0, four, weights, &is_hanging, &error));
    CHECK(is_hanging == 0);
    REFUSED(motet_mover_weights(mover, -1, four, weights, &is_hanging, &error), MOTET_ERROR_INPUT, "vertex -1");
    REFUSED(motet_mover_step(mover, displacement, n - 1, 3, points, N_POINTS, 3, &error), MOTET_ERROR_OPTIONS, "expected");
    REFUSED(motet_mover_step(mover, displacement, n, 3, points, N_POINTS - 1, 3, &error), MOTET_ERROR_OPTIONS, "expected 343");
    REFUSED(motet_mover_step(NULL, displacement, n, 3, points, N_POINTS, 3, &error), MOTET_ERROR_OPTIONS, "mover is NULL");
    REFUSED(motet_mover_step(mover, displacement, n, 3, NULL, N_POINTS, 3, &error), MOTET_ERROR_OPTIONS, "points is NULL");
    /* Rows that are both read and written. */
    REFUSED(motet_mover_step(mover, points + 3, n, 3, points, N_POINTS, 3, &error), MOTET_ERROR_OPTIONS, "share memory");
    REFUSED(motet_mover_advance(mover, points, n, 3, points, N_POINTS, 3, NULL, &error), MOTET_ERROR_OPTIONS, "share memory");
    displacement[0] = NAN;
    REFUSED(motet_mover_step(mover, displacement, n, 3, points, N_POINTS, 3, &error), MOTET_ERROR_INPUT, "finite");
    motet_mover_free(mover);

    mesh = cube();
    options.slide = slide, options.n_slide = 1;
    REFUSED(motet_mover_new(mesh, &options, &mover, &error), MOTET_ERROR_OPTIONS, "door");
    CHECK(mover == NULL);
    motet_mover_options_init(&options, sizeof options);
    options.method = 99;
    REFUSED(motet_mover_new(mesh, &options, &mover, &error), MOTET_ERROR_OPTIONS, "unknown method 99");
    REFUSED(motet_mover_new(mesh, &options, &mover, &error), MOTET_ERROR_OPTIONS, "MOTET_DELAUNAY (0), MOTET_BODIES (1)");
    memset(&options, 0, sizeof options);
    REFUSED(motet_mover_new(mesh, &options, &mover, &error), MOTET_ERROR_OPTIONS, "_init");
    for (i = MOTET_DELAUNAY; i <= MOTET_RBF; i++) {
        motet_mover_options_init(&options, sizeof options);
        options.method = (int32_t)i;
        if (i == MOTET_BODIES) {
            REFUSED(motet_mover_new(mesh, &options, &mover, &error), MOTET_ERROR_OPTIONS, "no part of them is a separate body");
            continue;
        }
        OK(motet_mover_new(mesh, i == MOTET_DELAUNAY ? NULL : &options, &mover, &error));
        motet_mover_free(mover);
    }
    motet_mesh_free(mesh);
    free(first), free(points), free(apart), free(boundary), free(displacement), free(strided);
}

/* Two processes, each with a part of the points, get the results of one. */
static void parts(void)
{
    motet_error *error = NULL;
    motet_mesh *mesh = cube();
    motet_point_mover *one = NULL, *half = NULL;
    double *points = malloc(sizeof(double) * 3 * N_POINTS), *whole = malloc(sizeof(double) * 3 * N_POINTS), *part = malloc(sizeof(double) * 3 * N_POINTS);
    double corners[8][3], turned[8][3], moved[8][3], moved_turned[8][3];
    int i, k;
    CHECK(points && whole && part);
    OK(motet_mesh_points(mesh, points, N_POINTS, 3, &error));
    for (i = 0; i < 8; i++)
        for (k = 0; k < 3; k++) corners[i][k] = turned[7 - i][k] = (i >> k) & 1, moved[i][k] = moved_turned[7 - i][k] = 0.01 * i * (k + 1);
    OK(motet_point_mover_new(corners[0], 8, 3, points, N_POINTS, 3, 1, &one, &error));
    OK(motet_point_mover_step(one, moved[0], 8, 3, whole, N_POINTS, 3, &error));
    OK(motet_point_mover_new(turned[0], 8, 3, points + 3 * 100, N_POINTS - 100, 3, 2, &half, &error));
    OK(motet_point_mover_step(half, moved_turned[0], 8, 3, part, N_POINTS - 100, 3, &error));
    CHECK(memcmp(part, whole + 3 * 100, sizeof(double) * 3 * (N_POINTS - 100)) == 0 && whole[3 * (N_POINTS - 1)] == 1 + 0.07);
    REFUSED(motet_point_mover_step(half, moved[0], 7, 3, part, N_POINTS - 100, 3, &error), MOTET_ERROR_OPTIONS, "expected 8");
    motet_point_mover_free(half);
    REFUSED(motet_point_mover_new(corners[0], 3, 3, points, N_POINTS, 3, 1, &half, &error), MOTET_ERROR_INPUT, "span");
    motet_point_mover_free(one);
    motet_mesh_free(mesh);
    free(points), free(whole), free(part);
}

static void changing(void)
{
    motet_error *error = NULL;
    motet_mesh *mesh = cube(), *device = octahedron(0.5, 0.5, 0.5, 0.2);
    const motet_mesh *const devices[1] = {device};
    const char *names[1] = {"seed"};
    motet_outcome *outcome = NULL;
    motet_remesh_options repair;
    motet_implant_options implant;
    motet_fill_options fill;
    double *points = malloc(sizeof(double) * 3 * N_POINTS), *x, volume = 0;
    int32_t *old;
    int64_t i, n;
    CHECK(points != NULL);
    /* A cube whose middle vertex is almost at its neighbour. */
    OK(motet_mesh_points(mesh, points, N_POINTS, 3, &error));
    points[3 * corner(3, 3, 3)] += 0.98 / N;
    OK(motet_mesh_set_points(mesh, points, N_POINTS, 3, &error));
    motet_remesh_options_init(&repair, sizeof repair);
    OK(motet_remesh(mesh, &repair, &outcome, &error));
    CHECK(motet_outcome_complete(outcome) == 1 && strstr(motet_outcome_report(outcome), "\"after\"") != NULL);
    CHECK(motet_outcome_not_reached(outcome) == NULL && motet_outcome_not_reached(NULL) == NULL);
    motet_outcome_free(outcome);
    repair.min_eas = 0.99, repair.rounds = 1;
    OK(motet_remesh(mesh, &repair, &outcome, &error));
    CHECK(motet_outcome_complete(outcome) == 0 && strstr(motet_outcome_not_reached(outcome), "bad") != NULL);
    motet_outcome_free(outcome);
    motet_remesh_options_init(&repair, sizeof repair);
    OK(motet_remesh(mesh, &repair, &outcome, &error));
    n = motet_mesh_n_points(motet_outcome_mesh(outcome));
    old = malloc(sizeof(int32_t) * n), x = malloc(sizeof(double) * n);
    CHECK(old && x);
    OK(motet_outcome_to_old(outcome, MOTET_ON_POINTS, old, n, &error));
    CHECK(old[0] == 0);
    OK(motet_outcome_transfer(outcome, MOTET_ON_POINTS, MOTET_RULE_MEAN, points, N_POINTS, 1, x, n, &error));
    for (i = 0; i < n; i++) CHECK(old[i] < 0 || x[i] == points[old[i]]);
    REFUSED(motet_outcome_transfer(outcome, MOTET_ON_POINTS, MOTET_RULE_MEAN, points, 5, 1, x, n, &error), MOTET_ERROR_INPUT, "343");
    REFUSED(motet_outcome_transfer(outcome, MOTET_ON_POINTS, 7, points, N_POINTS, 1, x, n, &error), MOTET_ERROR_OPTIONS, "rule");
    motet_outcome_free(outcome);
    free(old), free(x), free(points);
    motet_mesh_free(mesh);

    mesh = cube();
    motet_implant_options_init(&implant, sizeof implant);
    OK(motet_implant(mesh, devices, names, 1, &implant, &outcome, &error));
    CHECK(motet_outcome_complete(outcome) == 1 && motet_mesh_region(motet_outcome_mesh(outcome), "seed") > 0);
    motet_outcome_free(outcome);
    implant.growth = -1;
    REFUSED(motet_implant(mesh, devices, names, 1, &implant, &outcome, &error), MOTET_ERROR_OPTIONS, "grow");
    REFUSED(motet_implant(mesh, devices, names, 0, NULL, &outcome, &error), MOTET_ERROR_OPTIONS, "no device");
    CHECK(outcome == NULL && motet_outcome_mesh(outcome) == NULL);

    motet_fill_options_init(&fill, sizeof fill);
    fill.edge_length = 0.1;
    OK(motet_fill(devices, names, NULL, 1, &fill, &outcome, &error));
    {
        const motet_mesh *filled = motet_outcome_mesh(outcome);
        int64_t n_tets = motet_mesh_n_of_kind(filled, MOTET_TETRA), n_points = motet_mesh_n_points(filled);
        int32_t *tets = malloc(sizeof(int32_t) * 4 * n_tets);
        double *p = malloc(sizeof(double) * 3 * n_points);
        CHECK(tets && p);
        OK(motet_mesh_of_kind(filled, MOTET_TETRA, tets, 4 * n_tets, &error));
        OK(motet_mesh_points(filled, p, n_points, 3, &error));
        for (i = 0; i < n_tets; i++) {
            const double *a = p + 3 * tets[4 * i], *b = p + 3 * tets[4 * i + 1], *c = p + 3 * tets[4 * i + 2], *d = p + 3 * tets[4 * i + 3];
            double u[3], v[3], w[3];
            int k;
            for (k = 0; k < 3; k++) u[k] = b[k] - a[k], v[k] = c[k] - a[k], w[k] = d[k] - a[k];
            volume += (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0])) / 6;
        }
        free(tets), free(p);
    }
    CHECK(fabs(volume - 4.0 / 3.0 * 0.2 * 0.2 * 0.2) < 1e-12);
    REFUSED(motet_outcome_to_old(outcome, MOTET_ON_POINTS, NULL, 0, &error), MOTET_ERROR_OPTIONS, "history");
    motet_outcome_free(outcome);
    motet_mesh_free(mesh);
    motet_mesh_free(device);
}

/* Invalid numbers in options are errors that name the kind of option: none counts as "not given". */
static void numbers(void)
{
    static const double wrong[2] = {NAN, -2};
    motet_error *error = NULL;
    motet_mesh *mesh = cube(), *device = octahedron(0.5, 0.5, 0.5, 0.2);
    const motet_mesh *const devices[1] = {device};
    const char *names[1] = {"seed"};
    static const int32_t triangles[2][3] = {{0, 1, 2}, {3, 4, 5}};
    static const double points[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, still[6][3];
    static const int64_t counts[2] = {1, 1};
    motet_mover_options mover;
    motet_remesh_options repair;
    motet_implant_options implant;
    motet_fill_options fill;
    motet_contact_options contact;
    motet_moving_options moving;
    motet_mover *no_mover = NULL;
    motet_outcome *outcome = NULL;
    motet_contact *handle = NULL;
    motet_moving *no_moving = NULL;
    motet_refinement *refinement = NULL;
    double time;
    int i;
    OK(motet_refinement_new(mesh, NULL, &refinement, &error));
    OK(motet_contact_new(points[0], 6, 3, triangles[0], counts, NULL, 2, NULL, &handle, &error));
    for (i = 0; i < 2; i++) {
        const double x = wrong[i];
#define SET(options, init) init(&options, sizeof options)
#define MOVER(member) \
    (SET(mover, motet_mover_options_init), mover.method = MOTET_LAPLACE, mover.member = x, motet_mover_new(mesh, &mover, &no_mover, &error))
#define REPAIR(member) (SET(repair, motet_remesh_options_init), repair.surface = MOTET_SURFACE_ADAPT, repair.member = x, motet_remesh(mesh, &repair, &outcome, &error))
#define IMPLANT(member) \
    (SET(implant, motet_implant_options_init), implant.conform = 1, implant.member = x, motet_implant(mesh, devices, names, 1, &implant, &outcome, &error))
#define FILL(member)                                                                                                      \
    (SET(fill, motet_fill_options_init), fill.graded = 1, fill.layers = 2, fill.first_layer = 0.01, fill.member = x, \
     motet_fill(devices, names, NULL, 1, &fill, &outcome, &error))
#define CONTACT(member) \
    (SET(contact, motet_contact_options_init), contact.member = x, motet_contact_new(points[0], 6, 3, triangles[0], counts, NULL, 2, &contact, &none, &error))
#define MOVING(member) (SET(moving, motet_moving_options_init), moving.surface = MOTET_SURFACE_ADAPT, moving.member = x, motet_moving_new(mesh, &moving, &no_moving, &error))
        motet_contact *none = NULL;
        REFUSED(MOVER(rigid_layer), MOTET_ERROR_OPTIONS, "rigid layer");
        REFUSED(MOVER(residual), MOTET_ERROR_OPTIONS, "residual");
        REFUSED(MOVER(factor_gib), MOTET_ERROR_OPTIONS, "factor");
        REFUSED(REPAIR(min_eas), MOTET_ERROR_OPTIONS, "EAS");
        REFUSED(REPAIR(min_dihedral_deg), MOTET_ERROR_OPTIONS, "degrees");
        REFUSED(REPAIR(distance), MOTET_ERROR_OPTIONS, "stray");
        CHECK(REPAIR(edge_length) != MOTET_OK);
        motet_error_free(error), error = NULL;
        REFUSED(IMPLANT(tolerance), MOTET_ERROR_OPTIONS, "tolerance");
        REFUSED(IMPLANT(stray), MOTET_ERROR_OPTIONS, "stray");
        REFUSED(IMPLANT(edge_length), MOTET_ERROR_OPTIONS, "size");
        REFUSED(IMPLANT(growth), MOTET_ERROR_OPTIONS, "grow");
        REFUSED(IMPLANT(carve), MOTET_ERROR_OPTIONS, "edge lengths");
        REFUSED(IMPLANT(reach), MOTET_ERROR_OPTIONS, "edge lengths");
        REFUSED(IMPLANT(min_eas), MOTET_ERROR_OPTIONS, "EAS");
        REFUSED(FILL(edge_length), MOTET_ERROR_OPTIONS, "size");
        REFUSED(FILL(growth), MOTET_ERROR_OPTIONS, "grow");
        REFUSED(FILL(min_eas), MOTET_ERROR_OPTIONS, "EAS");
        REFUSED(FILL(first_layer), MOTET_ERROR_OPTIONS, "first layer");
        REFUSED(FILL(layer_growth), MOTET_ERROR_OPTIONS, "grow");
        REFUSED(CONTACT(warn), MOTET_ERROR_OPTIONS, "warning");
        REFUSED(CONTACT(within), MOTET_ERROR_OPTIONS, "reach");
        REFUSED(CONTACT(fold), MOTET_ERROR_OPTIONS, "fold");
        REFUSED(motet_contact_ahead(handle, still[0], 6, 3, x, &time, &error), MOTET_ERROR_OPTIONS, "horizon");
        REFUSED(MOVING(rigid_layer), MOTET_ERROR_OPTIONS, "rigid layer");
        REFUSED(MOVING(min_eas), MOTET_ERROR_OPTIONS, "EAS");
        REFUSED(MOVING(distance), MOTET_ERROR_OPTIONS, "stray");
        REFUSED(MOVING(margin), MOTET_ERROR_OPTIONS, "margin");
        REFUSED(MOVING(floor), MOTET_ERROR_OPTIONS, "floor");
        REFUSED(MOVING(improve_below), MOTET_ERROR_OPTIONS, "improve_below");
        REFUSED(motet_refinement_near(refinement, device, x, 0.5, NULL, &error), MOTET_ERROR_OPTIONS, "size");
        REFUSED(motet_refinement_near(refinement, device, 0.5, x, NULL, &error), MOTET_ERROR_OPTIONS, "grow");
        CHECK(no_mover == NULL && outcome == NULL && none == NULL && no_moving == NULL);
    }
    motet_refinement_free(refinement), motet_contact_free(handle), motet_mesh_free(mesh), motet_mesh_free(device);
}

static void refinement(void)
{
    motet_error *error = NULL;
    motet_mesh *mesh = cube(), *device = octahedron(0.5, 0.5, 0.5, 0.1);
    motet_refinement *refinement = NULL;
    motet_outcome *outcome = NULL;
    int32_t *marks, *generations;
    int64_t i, n;
    OK(motet_refinement_new(mesh, NULL, &refinement, &error));
    OK(motet_refinement_near(refinement, device, 0.05, 0.5, &outcome, &error));
    CHECK(motet_outcome_complete(outcome) == 1);
    motet_outcome_free(outcome);
    n = motet_mesh_n_cells(motet_refinement_mesh(refinement));
    CHECK(n > N_TETS);
    while (n > N_TETS) {
        int64_t before = n;
        marks = malloc(sizeof(int32_t) * n), generations = malloc(sizeof(int32_t) * n);
        CHECK(marks && generations);
        OK(motet_refinement_generations(refinement, generations, n, &error));
        for (i = 0; i < n; i++) marks[i] = generations[i] > 0;
        OK(motet_refinement_coarsen(refinement, marks, n, NULL, &error));
        free(marks), free(generations);
        n = motet_mesh_n_cells(motet_refinement_mesh(refinement));
        CHECK(n < before);
    }
    REFUSED(motet_refinement_divide(refinement, NULL, 3, &outcome, &error), MOTET_ERROR_OPTIONS, "expected");
    motet_refinement_free(refinement);
    motet_mesh_free(mesh);
    motet_mesh_free(device);
}

static void contact(void)
{
    motet_error *error = NULL;
    motet_mesh *bodies[2];
    motet_contact *contact = NULL;
    double points[12][3], gaps[12], least, distance, places[6], time, velocity[12][3] = {{0}};
    int32_t triangles[16][3], nearest[2], rooms[2] = {MOTET_ROOM_FOUND, MOTET_ROOM_NO};
    int64_t counts[2] = {8, 8};
    int i, k;
    bodies[0] = octahedron(0, 0, 0, 1), bodies[1] = octahedron(2.5, 0, 0, 1);
    for (i = 0; i < 2; i++) {
        OK(motet_mesh_points(bodies[i], points[6 * i], 6, 3, &error));
        OK(motet_mesh_of_kind(bodies[i], MOTET_TRIANGLE, triangles[8 * i], 24, &error));
        motet_mesh_free(bodies[i]);
    }
    for (i = 8; i < 16; i++)
        for (k = 0; k < 3; k++) triangles[i][k] += 6;
    OK(motet_contact_new(points[0], 12, 3, triangles[0], counts, NULL, 2, NULL, &contact, &error));
    OK(motet_contact_measure(contact, gaps, 12, &least, &error));
    CHECK(fabs(least - 0.5) < 1e-15 && fabs(gaps[0] - 0.5) < 1e-15 && fabs(gaps[7] - 0.5) < 1e-15);
    OK(motet_contact_nearest(contact, 1, 0, &distance, places, nearest, &error));
    CHECK(distance == least && fabs(places[0] - 1.5) < 1e-15 && fabs(places[3] - 1) < 1e-15);
    for (i = 6; i < 12; i++) velocity[i][0] = -1;
    OK(motet_contact_ahead(contact, velocity[0], 12, 3, 0, &time, &error));
    CHECK(fabs(time - 0.5) < 1e-6 && time <= 0.5);
    for (i = 6; i < 12; i++) points[i][0] -= 0.25;
    OK(motet_contact_refit(contact, points[0], 12, 3, &error));
    OK(motet_contact_measure(contact, gaps, 12, NULL, &error));
    CHECK(fabs(gaps[0] - 0.25) < 1e-15);
    REFUSED(motet_contact_nearest(contact, 0, 5, &distance, NULL, NULL, &error), MOTET_ERROR_OPTIONS, "there are 2");
    motet_contact_free(contact);
    OK(motet_contact_new(points[0], 12, 3, triangles[0], counts, rooms, 2, NULL, &contact, &error));
    motet_contact_free(contact);
    rooms[1] = 2;
    REFUSED(motet_contact_new(points[0], 12, 3, triangles[0], counts, rooms, 2, NULL, &contact, &error), MOTET_ERROR_OPTIONS, "MOTET_ROOM_YES (1)");
    triangles[15][2] = 12;
    REFUSED(motet_contact_new(points[0], 12, 3, triangles[0], counts, NULL, 2, NULL, &contact, &error), MOTET_ERROR_INPUT, "triangle 15");
    counts[0] = -8;
    REFUSED(motet_contact_new(points[0], 12, 3, triangles[0], counts, NULL, 2, NULL, &contact, &error), MOTET_ERROR_OPTIONS, "-8 triangles");
    CHECK(contact == NULL);
}

/* The sum of a cell array times the volumes of the tets. */
static double integral(const motet_mesh *mesh, const char *name)
{
    motet_error *error = NULL;
    int64_t n = motet_mesh_n_cells(mesh), n_points = motet_mesh_n_points(mesh), i;
    int32_t *tets = malloc(sizeof(int32_t) * 4 * n);
    double *p = malloc(sizeof(double) * 3 * n_points), *values = malloc(sizeof(double) * n), sum = 0;
    CHECK(tets && p && values && motet_mesh_n_of_kind(mesh, MOTET_TETRA) == n);
    OK(motet_mesh_of_kind(mesh, MOTET_TETRA, tets, 4 * n, &error));
    OK(motet_mesh_points(mesh, p, n_points, 3, &error));
    OK(motet_mesh_array(mesh, MOTET_ON_CELLS, name, values, n, &error));
    for (i = 0; i < n; i++) {
        const double *a = p + 3 * tets[4 * i], *b = p + 3 * tets[4 * i + 1], *c = p + 3 * tets[4 * i + 2], *d = p + 3 * tets[4 * i + 3];
        double u[3], v[3], w[3];
        int k;
        for (k = 0; k < 3; k++) u[k] = b[k] - a[k], v[k] = c[k] - a[k], w[k] = d[k] - a[k];
        sum += values[i] * fabs(u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0])) / 6;
    }
    free(tets), free(p), free(values);
    return sum;
}

static void loop(void)
{
    static const char *const contents[1] = {"density"}, *const watched[1] = {"nowhere"};
    motet_error *error = NULL;
    motet_mesh *mesh = cube(), *device = octahedron(0.5, 0.5, 0.1, 0.05);
    motet_moving_options options;
    motet_moving *moving = NULL, *none = NULL;
    motet_outcome *outcome = NULL;
    motet_step step;
    int64_t n, n_new, changes = 0, i, k;
    double *places, *displacement, *density = malloc(sizeof(double) * N_TETS), *x = malloc(sizeof(double) * N_POINTS), *first = malloc(sizeof(double) * 3 * N_POINTS), *now, before;
    CHECK(density && x && first);
    OK(motet_mesh_points(mesh, first, N_POINTS, 3, &error));
    for (i = 0; i < N_TETS; i++) density[i] = 1 + (double)(i % 7);
    for (i = 0; i < N_POINTS; i++) x[i] = 3 * first[3 * i] - 1;
    OK(motet_mesh_set_array(mesh, MOTET_ON_CELLS, "density", density, N_TETS, 1, &error));
    before = integral(mesh, "density");
    motet_moving_options_init(&options, sizeof options);
    options.contents = contents, options.n_contents = 1, options.threads = 1;
    OK(motet_moving_new(mesh, &options, &moving, &error));
    OK(motet_moving_set_array(moving, MOTET_ON_POINTS, "x", x, N_POINTS, 1, &error));
    n = motet_moving_n_driven(moving);
    CHECK(n == N_POINTS - (N - 1) * (N - 1) * (N - 1) && motet_moving_time(moving) == 0 && motet_moving_step(moving) == 0);
    places = malloc(sizeof(double) * 4 * n), displacement = malloc(sizeof(double) * 3 * n);
    CHECK(places && displacement);
    OK(motet_moving_driven_places(moving, places, n, 4, &error));

    /* The floor bulges until tets are bad and are repaired. */
    for (k = 1; k <= 4; k++) {
        for (i = 0; i < n; i++) {
            const double *at = places + 4 * i;
            displacement[3 * i] = displacement[3 * i + 1] = 0;
            displacement[3 * i + 2] = at[2] > 0 ? 0 : 0.16 * (double)k * 16 * at[0] * (1 - at[0]) * at[1] * (1 - at[1]);
        }
        motet_step_init(&step, sizeof step);
        OK(motet_moving_advance(moving, 0.25 * (double)k, displacement, n, 3, &step, &error));
        CHECK(step.step == k && step.complete == 1 && step.inverted == 0 && step.time == 0.25 * (double)k && step.size == sizeof step && isinf(step.gap));
        changes += step.changes;
    }
    CHECK(changes > 0 && step.points == motet_mesh_n_points(motet_moving_mesh(moving)) && motet_moving_remembers(moving, 0) == 1);
    CHECK(fabs(integral(motet_moving_mesh(moving), "density") / before - 1) < 1e-12); /* contents are conserved */
    n_new = step.points;
    now = malloc(sizeof(double) * 3 * n_new);
    free(first), first = malloc(sizeof(double) * 3 * n_new);
    free(x), x = malloc(sizeof(double) * n_new);
    CHECK(now && first && x);
    OK(motet_mesh_points(motet_moving_mesh(moving), now, n_new, 3, &error));
    OK(motet_moving_displacement(moving, first, n_new, 3, &error));
    OK(motet_mesh_array(motet_moving_mesh(moving), MOTET_ON_POINTS, "x", x, n_new, &error));
    for (i = 0; i < n_new; i++) CHECK(fabs(x[i] - (3 * (now[3 * i] - first[3 * i]) - 1)) < 1e-12); /* linear in the first places */
    OK(motet_moving_velocity(moving, now, n_new, 3, &error));
    OK(motet_moving_since(moving, 0, &outcome, &error));
    CHECK(outcome != NULL && motet_mesh_n_points(motet_outcome_mesh(outcome)) == n_new);
    motet_outcome_free(outcome);
    OK(motet_moving_since(moving, 4, &outcome, &error));
    CHECK(outcome == NULL);
    OK(motet_moving_repair(moving, &changes, &error));
    OK(motet_moving_refine_near(moving, device, 0.05, 0.5, 1, &changes, &error));
    CHECK(changes > 0 && motet_mesh_n_points(motet_moving_mesh(moving)) > n_new);
    CHECK(fabs(integral(motet_moving_mesh(moving), "density") / before - 1) < 1e-12);

    REFUSED(motet_moving_advance(moving, 1, displacement, n, 3, NULL, &error), MOTET_ERROR_OPTIONS, "not after the current time 1");
    REFUSED(motet_moving_advance(moving, 2, displacement, n - 1, 3, NULL, &error), MOTET_ERROR_OPTIONS, "expected");
    REFUSED(motet_moving_advance(moving, 2, NULL, n, 3, NULL, &error), MOTET_ERROR_OPTIONS, "displacement is NULL");
    REFUSED(motet_moving_advance(NULL, 2, displacement, n, 3, NULL, &error), MOTET_ERROR_OPTIONS, "moving is NULL");
    step.size = 0;
    REFUSED(motet_moving_advance(moving, 2, displacement, n, 3, &step, &error), MOTET_ERROR_OPTIONS, "_init");
    displacement[5] = NAN;
    REFUSED(motet_moving_advance(moving, 2, displacement, n, 3, NULL, &error), MOTET_ERROR_INPUT, "driven vertex 1");
    CHECK(motet_moving_time(moving) == 1 && motet_moving_step(moving) == 4);
    REFUSED(motet_moving_velocity(moving, now, n_new, 3, &error), MOTET_ERROR_OPTIONS, "expected");
    REFUSED(motet_moving_set_array(moving, MOTET_ON_POINTS, "x", x, n_new, 1, &error), MOTET_ERROR_INPUT, "rows");
    REFUSED(motet_moving_refine_gaps(moving, 0, 1, NULL, &error), MOTET_ERROR_OPTIONS, "smallest");
    REFUSED(motet_moving_since(moving, -1, &outcome, &error), MOTET_ERROR_OPTIONS, "-1 steps");
    REFUSED(motet_moving_load("nowhere.vtu", &options, &none, &error), MOTET_ERROR_IO, "nowhere.vtu");
    options.watch = watched, options.n_watch = 1;
    REFUSED(motet_moving_new(mesh, &options, &none, &error), MOTET_ERROR_OPTIONS, "nowhere");
    options.n_watch = 0, options.surface = 7;
    REFUSED(motet_moving_new(mesh, &options, &none, &error), MOTET_ERROR_OPTIONS, "unknown surface rule 7");
    CHECK(none == NULL && motet_moving_mesh(none) == NULL && isnan(motet_moving_time(none)));
    free(places), free(displacement), free(density), free(x), free(first), free(now);
    motet_moving_free(moving), motet_moving_free(none);
    motet_mesh_free(mesh), motet_mesh_free(device);
}

int main(void)
{
    CHECK(motet_version() == MOTET_VERSION_MAJOR * 10000 + MOTET_VERSION_MINOR * 100 + MOTET_VERSION_PATCH);
    meshes();
    motion();
    parts();
    changing();
    numbers();
    refinement();
    contact();
    loop();
    printf("all checks of motet.h passed\n");
    return 0;
}
