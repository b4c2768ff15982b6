/* Tests what motet.h promises about long calls, as a program of C99 with threads of POSIX. Prints one line, or the
 * first check that fails. */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>

#include "common.h"

/* What the function that is told the progress saw, and when it stops the call. */
typedef struct told {
    pthread_t thread;
    int n, stop_at, is_elsewhere, is_out_of_range, falls;
    char stage[64];
    int64_t done, of;
} told;

static told listening(int stop_at)
{
    told told;
    memset(&told, 0, sizeof told);
    told.thread = pthread_self();
    told.stop_at = stop_at;
    return told;
}

static int32_t tell(void *data, const char *stage, int64_t done, int64_t of)
{
    told *told = data;
    CHECK(strlen(stage) < sizeof told->stage);
    if (!pthread_equal(told->thread, pthread_self())) told->is_elsewhere = 1;
    if (done < 0 || of < 0 || (of > 0 && done > of)) told->is_out_of_range = 1;
    /* Other stages occur in rounds. */
    if (strcmp(stage, "triangulating points") == 0 || strcmp(stage, "recovering edges of the surface") == 0)
        if (strcmp(stage, told->stage) == 0 && of == told->of && done < told->done) told->falls++;
    strcpy(told->stage, stage);
    told->done = done, told->of = of;
    told->n++;
    return told->stop_at > 0 && told->n >= told->stop_at;
}

static motet_watch *watch_with(told *told)
{
    motet_error *error = NULL;
    motet_watch *watch = NULL;
    OK(motet_watch_new(&watch, &error));
    OK(motet_watch_on_progress(watch, tell, told, 2e-4, &error));
    return watch;
}

/* A number that depends on all bytes of a mesh. */
static uint64_t bytes_of(const motet_mesh *mesh)
{
    motet_error *error = NULL;
    int64_t n = motet_mesh_n_points(mesh), n_tets = 4 * motet_mesh_n_of_kind(mesh, MOTET_TETRA), i;
    double *points = malloc(sizeof *points * (3 * n + 1));
    int32_t *tets = malloc(sizeof *tets * (n_tets + 1));
    uint64_t sum = 14695981039346656037u, word;
    CHECK(points && tets);
    OK(motet_mesh_points(mesh, points, n, 3, &error));
    OK(motet_mesh_of_kind(mesh, MOTET_TETRA, tets, n_tets, &error));
    for (i = 0; i < 3 * n; i++) memcpy(&word, points + i, sizeof word), sum = (sum ^ word) * 1099511628211u;
    for (i = 0; i < n_tets; i++) sum = (sum ^ (uint64_t)tets[i]) * 1099511628211u;
    free(points), free(tets);
    return sum;
}

static void handles(void)
{
    motet_error *error = NULL;
    motet_watch *watch = NULL;
    char stage[64] = "unchanged";
    int64_t done = 7, of = 7;
    OK(motet_watch_new(&watch, &error));
    OK(motet_watch_progress(watch, stage, sizeof stage, &done, &of, &error));
    CHECK(stage[0] == 0 && done == 0 && of == 0);
    OK(motet_watch_progress(watch, NULL, 0, NULL, NULL, &error));
    REFUSED(motet_watch_progress(watch, NULL, 5, NULL, NULL, &error), MOTET_ERROR_OPTIONS, "stage is NULL");
    REFUSED(motet_watch_on_progress(watch, tell, NULL, -1, &error), MOTET_ERROR_OPTIONS, "every -1 seconds");
    REFUSED(motet_watch_on_progress(watch, tell, NULL, NAN, &error), MOTET_ERROR_OPTIONS, "seconds");
    REFUSED(motet_watch_on_progress(NULL, tell, NULL, 1, &error), MOTET_ERROR_OPTIONS, "watch is NULL");
    REFUSED(motet_watch_new(NULL, &error), MOTET_ERROR_OPTIONS, "watch is NULL");
    motet_watch_stop(NULL);
    motet_watch_free(NULL);
    motet_watch_free(watch);
}

/* Every call with options: a request before it stops it and is used up; then its result is that without a watch,
 * told on this thread. */
static void each_call(void)
{
    motet_error *error = NULL;
    motet_mesh *mesh = cube(), *device = octahedron(0.5, 0.5, 0.5, 0.2);
    const motet_mesh *const devices[1] = {device};
    const char *names[1] = {"seed"};
    motet_remesh_options repair;
    motet_implant_options implant;
    motet_fill_options fill;
    int call, is_watched;
    motet_remesh_options_init(&repair, sizeof repair);
    motet_implant_options_init(&implant, sizeof implant);
    motet_fill_options_init(&fill, sizeof fill);
    CHECK(repair.watched_by == NULL && implant.watched_by == NULL && fill.watched_by == NULL);
    repair.edge_length = 0.11, fill.edge_length = 0.04;
    for (call = 0; call < 3; call++) {
        uint64_t sums[2] = {0, 0};
        for (is_watched = 0; is_watched < 2; is_watched++) {
            told told = listening(0);
            motet_watch *watch = is_watched ? watch_with(&told) : NULL;
            motet_outcome *outcome = NULL;
            repair.watched_by = implant.watched_by = fill.watched_by = watch;
#define MAKE                                                                            \
    (call == 0   ? motet_remesh(mesh, &repair, &outcome, &error)                        \
     : call == 1 ? motet_implant(mesh, devices, names, 1, &implant, &outcome, &error)   \
                 : motet_fill(devices, names, NULL, 1, &fill, &outcome, &error))
            if (is_watched) {
                uint64_t before = bytes_of(mesh);
                motet_watch_stop(watch);
                REFUSED(MAKE, MOTET_ERROR_STOPPED, "stopped on request");
                CHECK(outcome == NULL && bytes_of(mesh) == before);
            }
            OK(MAKE);
            sums[is_watched] = bytes_of(motet_outcome_mesh(outcome));
            if (is_watched) {
                char stage[64];
                OK(motet_watch_progress(watch, stage, sizeof stage, NULL, NULL, &error));
                CHECK(stage[0] != 0 && told.n > 0 && !told.is_elsewhere && !told.is_out_of_range && told.falls == 0);
            }
            motet_outcome_free(outcome);
            motet_watch_free(watch);
        }
        CHECK(sums[0] == sums[1]);
    }
    motet_mesh_free(mesh), motet_mesh_free(device);
}

/* A repair is stopped ever later, until it is done: by then it is as if it had not been stopped. */
static void stopped_in_the_middle(void)
{
    motet_error *error = NULL;
    motet_mesh *mesh = cube();
    motet_remesh_options options;
    motet_outcome *outcome = NULL;
    const uint64_t before = bytes_of(mesh);
    uint64_t sum;
    int stop_at, n_stopped = 0, has_stage = 0;
    motet_remesh_options_init(&options, sizeof options);
    options.edge_length = 0.09;
    OK(motet_remesh(mesh, &options, &outcome, &error));
    sum = bytes_of(motet_outcome_mesh(outcome));
    motet_outcome_free(outcome);
    for (stop_at = 1;; stop_at *= 3) {
        told told = listening(stop_at);
        options.watched_by = watch_with(&told);
        if (motet_remesh(mesh, &options, &outcome, &error) == MOTET_OK) {
            motet_watch_free(options.watched_by);
            break;
        }
        CHECK(motet_error_status(error) == MOTET_ERROR_STOPPED && outcome == NULL && bytes_of(mesh) == before);
        CHECK(told.n == stop_at && !told.is_elsewhere);
        has_stage |= told.stage[0] != 0, n_stopped++;
        motet_error_free(error), error = NULL;
        motet_watch_free(options.watched_by);
    }
    CHECK(n_stopped > 1 && has_stage && bytes_of(motet_outcome_mesh(outcome)) == sum);
    motet_outcome_free(outcome);
    motet_mesh_free(mesh);
}

static void *stop_soon(void *data)
{
    motet_error *error = NULL;
    char stage[64] = "";
    while (stage[0] == 0) OK(motet_watch_progress(data, stage, sizeof stage, NULL, NULL, &error));
    motet_watch_stop(data);
    return NULL;
}

/* Another thread waits for the first stage and stops the call; with and without a function that is told. */
static void stopped_by_another_thread(void)
{
    motet_error *error = NULL;
    motet_mesh *mesh = cube();
    motet_remesh_options options;
    motet_outcome *outcome = NULL;
    int is_told;
    motet_remesh_options_init(&options, sizeof options);
    options.edge_length = 0.02; /* it would take minutes */
    for (is_told = 0; is_told < 2; is_told++) {
        told told = listening(0);
        pthread_t other;
        motet_watch *watch = watch_with(&told);
        if (!is_told) OK(motet_watch_on_progress(watch, NULL, NULL, 0, &error));
        options.watched_by = watch;
        CHECK(pthread_create(&other, NULL, stop_soon, watch) == 0);
        REFUSED(motet_remesh(mesh, &options, &outcome, &error), MOTET_ERROR_STOPPED, "stopped on request");
        CHECK(pthread_join(other, NULL) == 0 && outcome == NULL && (told.n > 0) == is_told);
        motet_watch_free(watch);
    }
    motet_mesh_free(mesh);
}

/* A call within the function that is told the progress. */
typedef struct within {
    const motet_mesh *mesh;
    motet_watch *watch;
    int n;
} within;

static int32_t call_within(void *data, const char *stage, int64_t done, int64_t of)
{
    within *within = data;
    motet_error *error = NULL;
    motet_outcome *outcome = NULL;
    motet_remesh_options options;
    (void)stage, (void)done, (void)of;
    motet_remesh_options_init(&options, sizeof options);
    options.watched_by = within->watch, options.threads = 1;
    REFUSED(motet_remesh(within->mesh, &options, &outcome, &error), MOTET_ERROR_OPTIONS, "already watches a call");
    options.watched_by = NULL;
    OK(motet_remesh(within->mesh, &options, &outcome, &error));
    motet_outcome_free(outcome);
    within->n++;
    return 1;
}

static void one_call_at_a_time(void)
{
    motet_error *error = NULL;
    motet_mesh *mesh = cube();
    motet_remesh_options options;
    motet_outcome *outcome = NULL;
    within within = {NULL, NULL, 0};
    within.mesh = mesh;
    OK(motet_watch_new(&within.watch, &error));
    OK(motet_watch_on_progress(within.watch, call_within, &within, 1e-3, &error));
    motet_remesh_options_init(&options, sizeof options);
    options.edge_length = 0.02, options.watched_by = within.watch;
    REFUSED(motet_remesh(mesh, &options, &outcome, &error), MOTET_ERROR_STOPPED, "stopped on request");
    CHECK(within.n == 1);
    motet_watch_free(within.watch);
    motet_mesh_free(mesh);
}

/* The floor of the cube bulges. */
static void bulge(const double *places, double *displacement, int64_t n, double height)
{
    int64_t i;
    for (i = 0; i < n; i++) {
        const double *at = places + 3 * i;
        displacement[3 * i] = displacement[3 * i + 1] = 0;
        displacement[3 * i + 2] = at[2] > 0 ? 0 : height * 16 * at[0] * (1 - at[0]) * at[1] * (1 - at[1]);
    }
}

/* Steps of a moving mesh are stopped ever later; after each stop the mesh is as before, and in the end as if
 * nothing had been stopped. */
static void a_moving_mesh(void)
{
    motet_error *error = NULL;
    motet_mesh *mesh = cube();
    motet_moving_options options;
    motet_moving *plain = NULL, *watched = NULL;
    told told = listening(0);
    motet_watch *watch = watch_with(&told);
    motet_step step;
    double *places, *displacement;
    int64_t n, k, changes = 0;
    int n_stopped = 0;
    motet_moving_options_init(&options, sizeof options);
    OK(motet_moving_new(mesh, &options, &plain, &error));
    options.watched_by = watch;
    motet_watch_stop(watch);
    REFUSED(motet_moving_new(mesh, &options, &watched, &error), MOTET_ERROR_STOPPED, "setting up a motion");
    OK(motet_moving_new(mesh, &options, &watched, &error));
    n = motet_moving_n_driven(plain);
    places = malloc(sizeof *places * 3 * n), displacement = malloc(sizeof *displacement * 3 * n);
    CHECK(places && displacement);
    OK(motet_moving_driven_places(plain, places, n, 3, &error));
    for (k = 1; k <= 3; k++) {
        int stop_at;
        bulge(places, displacement, n, 0.2 * (double)k);
        motet_step_init(&step, sizeof step);
        OK(motet_moving_advance(plain, (double)k, displacement, n, 3, &step, &error));
        changes += step.changes;
        for (stop_at = 1;; stop_at *= 2) {
            const uint64_t before = bytes_of(motet_moving_mesh(watched));
            motet_status status;
            told = listening(stop_at);
            status = motet_moving_advance(watched, (double)k, displacement, n, 3, NULL, &error);
            if (status == MOTET_OK) break;
            CHECK(status == MOTET_ERROR_STOPPED && bytes_of(motet_moving_mesh(watched)) == before);
            CHECK(motet_moving_step(watched) == k - 1 && motet_moving_time(watched) == (double)(k - 1));
            CHECK(!told.is_elsewhere);
            motet_error_free(error), error = NULL;
            n_stopped++;
        }
        CHECK(bytes_of(motet_moving_mesh(watched)) == bytes_of(motet_moving_mesh(plain)));
    }
    CHECK(changes > 0 && n_stopped > 0);
    /* Once the watch is freed, nobody is told, and nothing is stopped. */
    told = listening(1);
    motet_watch_stop(watch);
    motet_watch_free(watch);
    bulge(places, displacement, n, 0.5);
    OK(motet_moving_advance(plain, 4, displacement, n, 3, NULL, &error));
    OK(motet_moving_advance(watched, 4, displacement, n, 3, NULL, &error));
    CHECK(told.n == 0 && bytes_of(motet_moving_mesh(watched)) == bytes_of(motet_moving_mesh(plain)));
    free(places), free(displacement);
    motet_moving_free(plain), motet_moving_free(watched);
    motet_mesh_free(mesh);
}

int main(void)
{
    handles();
    each_call();
    stopped_in_the_middle();
    stopped_by_another_thread();
    one_call_at_a_time();
    a_moving_mesh();
    printf("all checks of long calls passed\n");
    return 0;
}
