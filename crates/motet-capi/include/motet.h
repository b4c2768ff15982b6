/* motet: tetrahedral meshes that stay good while the world in them moves.
 *
 * This header is the reference of the C library, for C99 and later and for C++. motet.hpp is the same for
 * C++17, with classes; the Fortran module is made from this header by fortran.py.
 *
 * Arrays.    Counts are int64_t, ids are int32_t and start at 0. Coordinates and vectors are rows of three
 *            doubles. A stride is the number of doubles from one row to the next: 3 for contiguous rows,
 *            which are used in place, more where other values stand between the rows. Input arrays are read
 *            during the call only. Output arrays are memory of the caller, with as many rows or values as
 *            the count states; they must not share memory with an input array.
 * Units.     Lengths are in the unit of the mesh, angles in degrees.
 * Handles.   An object that a call returns through a pointer to a pointer belongs to the caller, who frees
 *            it with the _free function of its type; NULL may be freed. What a handle lends (a text, the
 *            mesh of an outcome) is valid until the handle is freed or changed.
 * Errors.    A call that can fail returns a status and stores an error through its last argument, unless
 *            that is NULL; objects that it should have returned are NULL then. Text is UTF-8. NULL for a
 *            required argument is an error, not a crash; a handle that was freed is not detected.
 * Threads.   There is no global state. Different handles may be used at the same time. Calls that take a
 *            handle by pointer to const may run at the same time on one handle, other calls may not.
 *            `threads` in options: 0 for all cores, 1 for the thread of the caller only. Results do not
 *            depend on it.
 * Long calls. A watch, passed in options as `watched_by`, tells the progress of a call on the thread of the
 *            caller, and stops the call on request. motet_watch says more.
 * Versions.  A struct of options begins with its size, which its _init function sets; later versions append
 *            members. A program built with an older header gets the defaults of the members that it does not
 *            know. The numbers of constants never change.
 */
#ifndef MOTET_H
#define MOTET_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MOTET_VERSION_MAJOR 0
#define MOTET_VERSION_MINOR 1
#define MOTET_VERSION_PATCH 0

/* The version of the linked library: major * 10000 + minor * 100 + patch. */
int32_t motet_version(void);

/* ---- Errors -------------------------------------------------------------------------------------------- */

/* The status of a call. */
typedef int32_t motet_status;

/* Statuses of calls. */
enum {
    MOTET_OK = 0,
    MOTET_ERROR_INTERNAL = 1, /* a bug in motet; inputs are unchanged, free the handles that were to change */
    MOTET_ERROR_OPTIONS = 2,  /* options without a meaning, a NULL, a count below 0 */
    MOTET_ERROR_INPUT = 3,    /* data that cannot be read, or that do not meet what the call requires */
    MOTET_ERROR_IO = 4,       /* the operating system refused access to a file */
    MOTET_ERROR_STOPPED = 5   /* a watch stopped the call; inputs and handles are as before */
};

/* Why a call failed. */
typedef struct motet_error motet_error;

/* The status of the call that returned the error; MOTET_OK for NULL. */
motet_status motet_error_status(const motet_error *error);
/* The whole error in one sentence or two: the four parts below together. */
const char *motet_error_message(const motet_error *error);
/* What was expected and what was found. */
const char *motet_error_what(const motet_error *error);
/* The file that the error is in; NULL for errors that are in no file. */
const char *motet_error_file(const motet_error *error);
/* The place in the file or in the mesh; NULL where there is none. */
const char *motet_error_place(const motet_error *error);
/* What can be done about the error; NULL where nothing is known. */
const char *motet_error_remedy(const motet_error *error);
void motet_error_free(motet_error *error);

/* ---- Long calls ---------------------------------------------------------------------------------------- */

/* Tells the progress of long calls and stops them: those that have `watched_by` in their options, and those of
 * the handles made with such options, but for motet_mover_step, motet_refinement_divide and
 * motet_refinement_coarsen. A watch watches one call at a time; a second one is refused with
 * MOTET_ERROR_OPTIONS. Results do not depend on it. */
typedef struct motet_watch motet_watch;

/* Is told the progress: what is being done (empty at first; valid during this call only), how much of it is
 * done, and how much there is to do as far as is known by now, 0 where that is unknown. A stage may occur more
 * than once. Returns 0 to go on, another number to stop the watched call. It must not return by longjmp or an
 * exception, nor use the handles of the watched call. */
typedef int32_t (*motet_progress)(void *data, const char *stage, int64_t done, int64_t of);

/* Creates a watch that tells nobody. */
motet_status motet_watch_new(motet_watch **watch, motet_error **error);
/* Frees a watch that watches no call at the time. Handles made with it remain usable; nobody watches them any
 * longer. */
void motet_watch_free(motet_watch *watch);
/* Sets the function that is told the progress, on the thread that makes the watched call, every `every` seconds
 * while the call runs (0: 0.05), whether or not there is progress; the work goes on meanwhile, on another
 * thread. NULL for none: the call works on the thread of the caller. `data` is passed on to the function. Has
 * an effect on later calls. */
motet_status motet_watch_on_progress(
    motet_watch *watch, motet_progress tell, void *data, double every, motet_error **error);
/* Stops the watched call soon, or the next one if none is running: it returns MOTET_ERROR_STOPPED, and the
 * request is used up. May be called from any thread, from the function that is told the progress, and by a
 * handler of signals. */
void motet_watch_stop(const motet_watch *watch);
/* Copies the progress of the watched call, or of the last one, from any thread. `stage` receives up to n bytes
 * with the zero at the end; 64 are enough for all stages. `done` and `of` are as those of motet_progress;
 * they may be NULL. */
motet_status motet_watch_progress(
    const motet_watch *watch, char *stage, int64_t n, int64_t *done, int64_t *of, motet_error **error);

/* ---- Meshes -------------------------------------------------------------------------------------------- */

/* Points, cells of any kinds, and arrays on them. */
typedef struct motet_mesh motet_mesh;

/* Kinds of cells: VTK's numbers, with VTK's order of vertices. VTK's other kinds are accepted as well. */
enum {
    MOTET_VERTEX = 1,
    MOTET_LINE = 3,
    MOTET_TRIANGLE = 5,
    MOTET_QUAD = 9,
    MOTET_TETRA = 10,
    MOTET_HEXAHEDRON = 12,
    MOTET_WEDGE = 13,
    MOTET_PYRAMID = 14,
    MOTET_TETRA10 = 24
};

/* What the rows of an array belong to. */
enum {
    MOTET_ON_POINTS = 0,
    MOTET_ON_CELLS = 1
};

/* Creates a mesh of n points and no cells. */
motet_status motet_mesh_new(
    const double *points, int64_t n, int64_t stride, motet_mesh **mesh, motet_error **error);
/* Appends n cells of one kind; `vertices` lists the vertices of each cell, cell after cell. All ids are
 * checked: on an error no cell is appended. */
motet_status motet_mesh_add_cells(
    motet_mesh *mesh, int32_t kind, const int32_t *vertices, int64_t n, motet_error **error);
/* Sets the labels of all n cells, in their order: regions of volume cells, patches of surface cells; 0 for
 * none. */
motet_status motet_mesh_set_labels(motet_mesh *mesh, const int32_t *labels, int64_t n, motet_error **error);
/* Names the region that has a label. */
motet_status motet_mesh_name_region(motet_mesh *mesh, int32_t label, const char *name, motet_error **error);
/* Names the patch that has a label. */
motet_status motet_mesh_name_patch(motet_mesh *mesh, int32_t label, const char *name, motet_error **error);
/* Sets an array of n rows with `components` contiguous values each, on points or on cells; replaces an array
 * of the same name. */
motet_status motet_mesh_set_array(
    motet_mesh *mesh, int32_t on, const char *name, const double *values, int64_t n, int32_t components,
    motet_error **error);
/* Moves all n points. */
motet_status motet_mesh_set_points(
    motet_mesh *mesh, const double *points, int64_t n, int64_t stride, motet_error **error);

/* Reads a file; its suffix states the format. */
motet_status motet_mesh_read(const char *path, motet_mesh **mesh, motet_error **error);
/* Writes a file; its suffix states the format. */
motet_status motet_mesh_write(const motet_mesh *mesh, const char *path, motet_error **error);
/* A text that belongs to the caller. */
typedef struct motet_text motet_text;
/* The characters of a text, terminated by zero. */
const char *motet_text_get(const motet_text *text);
void motet_text_free(motet_text *text);
/* Reads a file and says what of it is not used, a sentence a line; NULL where all is. */
motet_status motet_mesh_read_noted(
    const char *path, motet_mesh **mesh, motet_text **notes, motet_error **error);
/* Writes a file and says what the format cannot hold, a sentence a line; NULL where it holds all. */
motet_status motet_mesh_write_noted(
    const motet_mesh *mesh, const char *path, motet_text **lost, motet_error **error);

/* Copies a mesh with its arrays and names. */
motet_status motet_mesh_copy(const motet_mesh *mesh, motet_mesh **copy, motet_error **error);
void motet_mesh_free(motet_mesh *mesh);

/* The number of points. */
int64_t motet_mesh_n_points(const motet_mesh *mesh);
/* The number of cells of all kinds. */
int64_t motet_mesh_n_cells(const motet_mesh *mesh);
/* The number of cells of one kind. */
int64_t motet_mesh_n_of_kind(const motet_mesh *mesh, int32_t kind);
/* The sum of the numbers of vertices of all cells. */
int64_t motet_mesh_n_vertices_of_cells(const motet_mesh *mesh);
/* Copies the coordinates of all n points. */
motet_status motet_mesh_points(
    const motet_mesh *mesh, double *points, int64_t n, int64_t stride, motet_error **error);
/* Copies the vertices of all cells of one kind, cell after cell; n is the number of these cells times the
 * number of vertices of each. */
motet_status motet_mesh_of_kind(
    const motet_mesh *mesh, int32_t kind, int32_t *vertices, int64_t n, motet_error **error);
/* Copies all cells in their order: the kind of each; where the vertices of each begin in `vertices`, and the
 * end of the last (n_cells + 1 offsets); the vertices of all cells. */
motet_status motet_mesh_cells(
    const motet_mesh *mesh, int32_t *kinds, int64_t n_cells, int64_t *offsets, int32_t *vertices,
    int64_t n_vertices, motet_error **error);
/* Copies the labels of all n cells; 0 for cells without a label. */
motet_status motet_mesh_labels(const motet_mesh *mesh, int32_t *labels, int64_t n, motet_error **error);
/* The label of a region by its name; -1 where no region has that name. */
int32_t motet_mesh_region(const motet_mesh *mesh, const char *name);
/* The label of a patch by its name; -1 where no patch has that name. */
int32_t motet_mesh_patch(const motet_mesh *mesh, const char *name);
/* The number of vertices of a patch, by its name or its label as text; -1 where there is no such patch. */
int64_t motet_mesh_n_patch_vertices(const motet_mesh *mesh, const char *name);
/* Copies the n vertices of a patch in ascending order, by its name or its label as text. */
motet_status motet_mesh_patch_vertices(
    const motet_mesh *mesh, const char *name, int32_t *vertices, int64_t n, motet_error **error);
/* The number of components of an array; 0 where no array of numbers has that name. */
int32_t motet_mesh_array_components(const motet_mesh *mesh, int32_t on, const char *name);
/* Copies an array: n rows with all components, row after row. */
motet_status motet_mesh_array(
    const motet_mesh *mesh, int32_t on, const char *name, double *values, int64_t n, motet_error **error);
/* Computes the equi-angle quality (EAS) of each of the n cells: 1 regular, 0 flat, negative inverted, bad
 * below 0.2; NaN for cells that are not tets. */
motet_status motet_mesh_eas(const motet_mesh *mesh, double *eas, int64_t n, motet_error **error);

/* Writes counts, bounds, volumes, quality and defects as one JSON object, the one of `motet info --json`. */
motet_status motet_mesh_summary(const motet_mesh *mesh, motet_text **summary, motet_error **error);

/* ---- Motion -------------------------------------------------------------------------------------------- */

/* Moves the vertices of one mesh with its boundary. */
typedef struct motet_mover motet_mover;

/* Methods of motion: `method` in options. */
enum {
    MOTET_DELAUNAY = 0, /* weights in the Delaunay graph of the boundary (Liu, Qin, Xia 2006): the cheapest */
    MOTET_BODIES = 1,   /* rigid bodies carry the vertices around them: for parts that turn or shift far */
    MOTET_GUIDED = 2,   /* a graph with inner nodes and rotations: for walls that bend */
    MOTET_ELASTIC = 3,  /* linear elasticity; for comparison */
    MOTET_LAPLACE = 4,  /* a Laplace equation; for comparison */
    MOTET_IDW = 5,      /* inverse-distance weighting; for comparison */
    MOTET_RBF = 6       /* radial basis functions; for comparison */
};

/* Options of a mover. */
typedef struct motet_mover_options {
    size_t size;
    int32_t method;            /* how vertices follow the boundary; default MOTET_DELAUNAY */
    int32_t within_walls;      /* 1: no vertex follows the wall of another lumen or the far side of a flap;
                                * default 0 */
    int32_t smooth;            /* number of sweeps over the vertices of bad tets after each step; default 0 */
    int32_t substeps;          /* largest number of sub-steps of an advance; default 50 */
    int32_t threads;           /* default 1 */
    int32_t rigid_layer_cells; /* thickness of the rigid layer in cells: its vertices move rigidly with the
                                * wall; default 0: no layer */
    double rigid_layer;        /* thickness of the rigid layer as a distance; default 0: no layer */
    double residual;           /* relative residual at which iterative solvers stop; default 1e-6 */
    double factor_gib;         /* gibibytes that a factor of the matrix may take to be kept; default 0 */
    const char *const *slide;  /* names (or labels as text) of flat patches whose vertices slide in their
                                * plane; default none */
    int64_t n_slide;
    const char *const *bodies; /* names of patches that are rigid bodies, for MOTET_BODIES; default none:
                                * every separate part of the moved walls but the outer one */
    int64_t n_bodies;
    const char *const *wall;   /* names of patches that have the rigid layer; default none: all of the
                                * boundary that does not slide */
    int64_t n_wall;
    const int32_t *also_moved; /* inner vertices that the caller moves as well; default none */
    int64_t n_also_moved;
    double slide_tolerance;    /* largest distance of a vertex of a sliding patch from the plane of the patch,
                                * as a fraction of the radius of the patch; default 0.05 */
    motet_watch *watched_by;   /* tells the progress of calls and stops them; default NULL: nobody */
} motet_mover_options;

/* Sets all members to their defaults; `size` is sizeof(motet_mover_options). */
void motet_mover_options_init(motet_mover_options *options, size_t size);

/* Sets up the motion of a mesh; the mesh may be freed afterwards. NULL for options: the defaults. */
motet_status motet_mover_new(
    const motet_mesh *mesh, const motet_mover_options *options, motet_mover **mover, motet_error **error);
void motet_mover_free(motet_mover *mover);

/* The number of points of the mesh. */
int64_t motet_mover_n_points(const motet_mover *mover);
/* The number of vertices that the caller moves: those of the boundary, and also_moved. */
int64_t motet_mover_n_boundary(const motet_mover *mover);
/* Copies the n vertices that the caller moves, in ascending order. */
motet_status motet_mover_boundary(
    const motet_mover *mover, int32_t *vertices, int64_t n, motet_error **error);
/* Returns the four vertices that a vertex follows and their weights; is_hanging is 0, and both arrays
 * unchanged, for a vertex that follows something else. */
motet_status motet_mover_weights(
    const motet_mover *mover, int32_t vertex, int32_t vertices[4], double weights[4], int32_t *is_hanging,
    motet_error **error);

/* Moves the mesh from its first place. `displacement` has a row for each moved vertex, `points` receives the
 * place of every vertex. Only the counts are checked, and that displacements are finite. The result depends
 * on the displacement only, not on earlier steps. */
motet_status motet_mover_step(
    const motet_mover *mover, const double *displacement, int64_t n_boundary, int64_t displacement_stride,
    double *points, int64_t n_points, int64_t points_stride, motet_error **error);

/* What an advance reached. */
typedef struct motet_certificate {
    size_t size;
    int32_t complete;             /* 1: the whole motion was reached */
    int32_t substeps;             /* number of sub-steps */
    double fraction;              /* the fraction of the motion that was reached */
    int64_t inverted;             /* number of inverted or flat volume cells */
    int64_t inverted_before;      /* number of inverted or flat volume cells of the mesh at first */
    int64_t bad;                  /* number of tets with an EAS below 0.2 */
    int64_t worst_cell;           /* the tet with the worst EAS; -1 where there is none */
    double worst_eas;             /* the EAS of worst_cell */
    double worst_place[3];        /* the centroid of worst_cell */
    double seconds;               /* duration of the call */
    int64_t worst_curved_cell;    /* the quadratic cell with the worst scaled Jacobian; -1 where there is
                                   * none */
    double worst_curved_jacobian; /* a lower bound of the scaled Jacobian, 0 or less where the cell may be
                                   * folded; NaN where there is none */
    int64_t leaves_plane_vertex;  /* the vertex on the rim of a sliding patch that the motion takes farthest
                                   * out of the plane of the patch; -1 where none leaves it */
    double leaves_plane_distance; /* distance of that vertex from the plane, in the unit of the mesh */
} motet_certificate;

/* Sets all members to those of an empty certificate; `size` is sizeof(motet_certificate). */
void motet_certificate_init(motet_certificate *certificate, size_t size);

/* Moves the mesh from its first place, in sub-steps where necessary: no cell that was not inverted at first
 * is inverted at the end. `displacement` and `points` are as those of motet_mover_step. A motion that is
 * reached in part only is no error. `certificate` may be NULL. */
motet_status motet_mover_advance(
    motet_mover *mover, const double *displacement, int64_t n_boundary, int64_t displacement_stride,
    double *points, int64_t n_points, int64_t points_stride, motet_certificate *certificate,
    motet_error **error);

/* Moves points with nodes, without a mesh: for processes that hold a part of a mesh each. All processes pass
 * the nodes of the whole boundary, in any order, and their own points. Points move by the Delaunay graph of
 * the nodes; cells are not known, so nothing is certified. Processes that hold the same point may place it
 * differently in the last digits. */
typedef struct motet_point_mover motet_point_mover;

/* Sets up the motion of points with nodes. */
motet_status motet_point_mover_new(
    const double *nodes, int64_t n_nodes, int64_t node_stride, const double *points, int64_t n_points,
    int64_t point_stride, int32_t threads, motet_point_mover **mover, motet_error **error);
void motet_point_mover_free(motet_point_mover *mover);
/* Moves the points from their first places. `displacement` has a row for each node, `points` receives the
 * places. Of several nodes at one place, the displacement of the first counts. */
motet_status motet_point_mover_step(
    const motet_point_mover *mover, const double *displacement, int64_t n_nodes, int64_t displacement_stride,
    double *points, int64_t n_points, int64_t points_stride, motet_error **error);

/* ---- Changes of a mesh --------------------------------------------------------------------------------- */

/* A new mesh, the origins of its points and cells, and a report. */
typedef struct motet_outcome motet_outcome;

/* 1: the requested result was reached. */
int32_t motet_outcome_complete(const motet_outcome *outcome);
/* The new mesh; belongs to the outcome. */
const motet_mesh *motet_outcome_mesh(const motet_outcome *outcome);
/* The report as one JSON object; belongs to the outcome. */
const char *motet_outcome_report(const motet_outcome *outcome);
/* Why the requested result was not reached; NULL where it was. Belongs to the outcome. */
const char *motet_outcome_not_reached(const motet_outcome *outcome);
/* For each of the n new points or cells: the old one that it equals to the bit; -1 for those that are new. */
motet_status motet_outcome_to_old(
    const motet_outcome *outcome, int32_t on, int32_t *old, int64_t n, motet_error **error);

/* How an array is transferred from the old mesh to the new one. */
enum {
    MOTET_RULE_MEAN = 0,    /* on points: interpolated; on cells: averaged by volume, so that integrals are
                             * kept */
    MOTET_RULE_INHERIT = 1, /* the value of the old point or cell with the largest share */
    MOTET_RULE_LINEAR = 2   /* on points: linear in each old tet; on cells: as MOTET_RULE_MEAN */
};
/* Transfers an array of the old mesh, n rows with `components` values each, to the n_out points or cells of
 * the new mesh. */
motet_status motet_outcome_transfer(
    const motet_outcome *outcome, int32_t on, int32_t rule, const double *values, int64_t n,
    int32_t components, double *out, int64_t n_out, motet_error **error);
void motet_outcome_free(motet_outcome *outcome);

/* What a repair may do to walls (boundary, interfaces, labelled facets): `surface` in options. */
enum {
    MOTET_SURFACE_KEEP = 0,  /* walls are kept to the bit */
    MOTET_SURFACE_ADAPT = 1, /* walls change within a distance; features are kept */
    MOTET_SURFACE_LOOSE = 2  /* walls change within a distance; features change as well where nothing else
                              * helps */
};

/* Options of a repair, which finds bad tets and repairs these only. */
typedef struct motet_remesh_options {
    size_t size;
    double min_eas;          /* tets with a lower EAS are bad; default 0.2 */
    double min_dihedral_deg; /* tets with a smaller dihedral angle are bad as well, in degrees; default 0 */
    int32_t best;            /* 1: all tets are improved, not the bad ones only; default 0 */
    int32_t surface;         /* what happens to walls; default MOTET_SURFACE_KEEP */
    double distance;         /* how far walls may stray; default 0: a thousandth of the largest extent */
    int32_t repair_layers;   /* 1: thin tets of boundary layers are repaired as others are; default 0 */
    int32_t rounds;          /* largest number of rounds; default 20 */
    int32_t threads;         /* default 0 */
    double edge_length;      /* requested length of all edges; default 0: edges keep their lengths */
    const double *sizes;     /* requested length of edges at each point; default NULL */
    int64_t n_sizes;
    const char *const *hold; /* names (or labels as text) of regions and patches that are kept to the bit;
                              * default none */
    int64_t n_hold;
    motet_watch *watched_by; /* tells the progress and stops the call; default NULL: nobody */
} motet_remesh_options;

/* Sets all members to their defaults; `size` is sizeof(motet_remesh_options). */
void motet_remesh_options_init(motet_remesh_options *options, size_t size);
/* Repairs the bad tets of a mesh. NULL for options: the defaults. */
motet_status motet_remesh(
    const motet_mesh *mesh, const motet_remesh_options *options, motet_outcome **outcome,
    motet_error **error);

/* What becomes of the space inside a device: `inside` in options. */
enum {
    MOTET_INSIDE_OWN = 0,    /* devices keep their tets; devices that are surfaces are filled */
    MOTET_INSIDE_FILLED = 1, /* all devices are filled with new tets */
    MOTET_INSIDE_HOLLOW = 2  /* no tets: the surface of the device bounds the mesh */
};

/* What of the host is refined before the implantation: `adapt` in options. */
enum {
    MOTET_ADAPT_NO = 0,    /* nothing */
    MOTET_ADAPT_WALLS = 1, /* walls near the devices */
    MOTET_ADAPT_ALL = 2    /* all tets near the devices */
};

/* Options of an implantation, which puts devices into a mesh of tets. */
typedef struct motet_implant_options {
    size_t size;
    int32_t inside;          /* the space inside devices; default MOTET_INSIDE_OWN */
    int32_t conform;         /* 1: devices get a new surface near theirs, for surfaces that touch or cross
                              * themselves; default 0: every triangle is kept */
    double tolerance;        /* with conform: largest distance of the new surface from that of the device;
                              * default 0: a fifth of the radius of a wire as thick as the device */
    int32_t keep_outside;    /* 1: the parts of devices outside of the host are kept; default 0: they are cut
                              * off */
    int32_t adapt;           /* what is refined first; default MOTET_ADAPT_WALLS */
    double stray;            /* how far surfaces may stray where a device meets a wall; default -1: a twentieth
                              * of the edge length of the device */
    double edge_length;      /* length of edges beside the devices; default 0: as those of the devices */
    double growth;           /* growth of lengths per unit of distance from the devices; default 0.5 */
    double carve;            /* tets nearer to a device than this number of edge lengths are replaced; default
                              * 1 */
    double reach;            /* tets farther than this number of edge lengths are kept to the bit; default 3 */
    double min_eas;          /* tets with a lower EAS are repaired; default 0.2 */
    int32_t threads;         /* default 0 */
    motet_watch *watched_by; /* tells the progress and stops the call; default NULL: nobody */
} motet_implant_options;

/* Sets all members to their defaults; `size` is sizeof(motet_implant_options). */
void motet_implant_options_init(motet_implant_options *options, size_t size);
/* Puts devices into a host. `names` has a name for each device: that of its region and its patch. NULL for
 * options: the defaults. */
motet_status motet_implant(
    const motet_mesh *host, const motet_mesh *const *devices, const char *const *names, int64_t n_devices,
    const motet_implant_options *options, motet_outcome **outcome, motet_error **error);

/* Options of filling, which makes tets inside closed surfaces. */
typedef struct motet_fill_options {
    size_t size;
    double edge_length;      /* length of inner edges, the largest where sizes grow; default 0: only necessary
                              * points */
    int32_t graded;          /* 1: lengths are those of the surface and grow inwards; default 0 */
    double growth;           /* growth of lengths per unit of distance; default 0: 0.3 */
    double min_eas;          /* tets with a lower EAS are repaired; default 0: 0.2 with sizes, no repair
                              * without */
    int32_t layers;          /* number of thin layers on walls; default 0 */
    double first_layer;      /* thickness of the first layer */
    double layer_growth;     /* ratio of the thicknesses of a layer and the one before; default 1.2 */
    int32_t keep_prisms;     /* 1: layers are wedges and pyramids, not divided into tets; default 0 */
    int32_t repair;          /* 1: T-junctions, coincident faces, duplicates, orientation and small holes are
                              * repaired first; default 0 */
    int32_t threads;         /* default 0 */
    int32_t cut;             /* 1: surfaces that cross are divided along their intersection; default 0 */
    int32_t voids;           /* 1: spaces inside closed surfaces that are turned inward stay empty; default 0 */
    motet_watch *watched_by; /* tells the progress and stops the call; default NULL: nobody */
    int32_t unite;           /* 1: bodies that cross, touch or lie on each other become one, without what lies
                              * inside; default 0 */
    double wrap;             /* the surfaces are replaced by a closed one within this distance, around what they
                              * enclose: they may be open, torn and cross; default 0: they are not */
} motet_fill_options;

/* Sets all members to their defaults; `size` is sizeof(motet_fill_options). */
void motet_fill_options_init(motet_fill_options *options, size_t size);
/* Fills closed surfaces with tets. `names` has a name for each surface; is_membrane has 1 for surfaces that
 * may end inside the others, NULL: there are none. NULL for options: the defaults. The outcome has no
 * history. */
motet_status motet_fill(
    const motet_mesh *const *surfaces, const char *const *names, const int32_t *is_membrane,
    int64_t n_surfaces, const motet_fill_options *options, motet_outcome **outcome, motet_error **error);

/* A mesh whose tets are divided over many steps, and whose divisions are taken back. */
typedef struct motet_refinement motet_refinement;

/* Options of a refinement. */
typedef struct motet_refinement_options {
    size_t size;
    int32_t threads;         /* default 0 */
    motet_watch *watched_by; /* tells the progress of calls and stops them; default NULL: nobody */
} motet_refinement_options;

/* Sets all members to their defaults; `size` is sizeof(motet_refinement_options). */
void motet_refinement_options_init(motet_refinement_options *options, size_t size);
/* Sets up the refinement of a mesh; the mesh may be freed afterwards. NULL for options: the defaults. */
motet_status motet_refinement_new(
    const motet_mesh *mesh, const motet_refinement_options *options, motet_refinement **refinement,
    motet_error **error);
void motet_refinement_free(motet_refinement *refinement);
/* The current mesh; belongs to the refinement and is valid until the next change. */
const motet_mesh *motet_refinement_mesh(const motet_refinement *refinement);
/* Copies the number of divisions of each of the n cells; -1 for cells that are not tets. */
motet_status motet_refinement_generations(
    const motet_refinement *refinement, int32_t *generations, int64_t n, motet_error **error);
/* Divides the tets among the n cells whose mark is not 0, and further tets where conformity requires it. The
 * outcome has a copy of the mesh and the history; NULL where none is wanted. */
motet_status motet_refinement_divide(
    motet_refinement *refinement, const int32_t *marks, int64_t n, motet_outcome **outcome,
    motet_error **error);
/* Takes back the divisions of which all parts have a mark that is not 0. `marks` and `outcome` are as those
 * of motet_refinement_divide. */
motet_status motet_refinement_coarsen(
    motet_refinement *refinement, const int32_t *marks, int64_t n, motet_outcome **outcome,
    motet_error **error);
/* Divides tets until no edge is longer than `at` at a surface, and `growth` more per unit of distance from
 * it. The outcome is as that of motet_refinement_divide. On an error nothing is changed. */
motet_status motet_refinement_near(
    motet_refinement *refinement, const motet_mesh *surface, double at, double growth,
    motet_outcome **outcome, motet_error **error);

/* ---- Contact ------------------------------------------------------------------------------------------- */

/* Surfaces over one list of points, whose distances are measured. */
typedef struct motet_contact motet_contact;

/* Whether a body is the wall of a room that contains other bodies: is_room of motet_contact_new. */
enum {
    MOTET_ROOM_FOUND = -1, /* a closed surface that encloses most of the area of another body is its room */
    MOTET_ROOM_NO = 0,     /* a body, not a room */
    MOTET_ROOM_YES = 1     /* a room that contains the others */
};

/* Options of contact. */
typedef struct motet_contact_options {
    size_t size;
    double warn;     /* vertices with a smaller gap warn; default 0: none */
    double within;   /* largest distance that is searched; default 0: no limit */
    double fold;     /* two places of one surface are neighbours, without a gap, if the way along the
                      * surface is shorter than this many times the straight distance; default 3 */
    int32_t own;     /* 1: each surface is measured against itself as well; default 0 */
    int32_t facing;  /* 1: only surfaces that face each other through free space; default 0 */
    int32_t threads; /* default 0 */
} motet_contact_options;

/* Sets all members to their defaults; `size` is sizeof(motet_contact_options). */
void motet_contact_options_init(motet_contact_options *options, size_t size);
/* Sets up bodies over n_points points. `triangles` has three vertices for each triangle, body after body;
 * `counts` has the number of triangles of each body; is_room has a MOTET_ROOM_ constant for each body, NULL:
 * MOTET_ROOM_FOUND for all. NULL for options: the defaults. */
motet_status motet_contact_new(
    const double *points, int64_t n_points, int64_t stride, const int32_t *triangles, const int64_t *counts,
    const int32_t *is_room, int64_t n_bodies, const motet_contact_options *options, motet_contact **contact,
    motet_error **error);
void motet_contact_free(motet_contact *contact);
/* Moves all points. */
motet_status motet_contact_refit(
    motet_contact *contact, const double *points, int64_t n_points, int64_t stride, motet_error **error);
/* Measures the gap at each point: the least of the gaps of its bodies; infinite for points of no body and
 * where nothing is within reach; negative where a body is where it must not be. `least` receives the least
 * distance of any two triangles; it may be NULL. */
motet_status motet_contact_measure(
    motet_contact *contact, double *gaps, int64_t n_points, double *least, motet_error **error);
/* Finds the closest points of two bodies: their distance, infinite where nothing is within reach; the two
 * places; the triangle of each. `places` and `triangles` may be NULL. */
motet_status motet_contact_nearest(
    motet_contact *contact, int32_t first, int32_t second, double *distance, double places[6],
    int32_t triangles[2], motet_error **error);
/* Computes a time before which nothing touches if points move straight on at their velocities, one row for
 * each point; infinite where nothing touches before the horizon (0: no horizon). */
motet_status motet_contact_ahead(
    const motet_contact *contact, const double *velocity, int64_t n_points, int64_t stride, double horizon,
    double *time, motet_error **error);

/* ---- Moving meshes ------------------------------------------------------------------------------------- */

/* A mesh that moves with its walls and stays good: certified, repaired while bad tets still have a volume,
 * refined, watched; its arrays are transferred where it changes. Displacements are those of the walls of the
 * first mesh, from their first places, whatever the mesh becomes. */
typedef struct motet_moving motet_moving;

/* Options of a moving mesh. */
typedef struct motet_moving_options {
    size_t size;
    int32_t method;                /* how vertices follow the walls; default MOTET_DELAUNAY */
    int32_t within_walls;          /* 1: no vertex follows the wall of another lumen or the far side of a
                                    * flap; default 0 */
    int32_t smooth;                /* number of sweeps over the vertices of bad tets after each step; default
                                    * 0 */
    int32_t rigid_layer_cells;     /* thickness of the rigid layer in cells; default 0: no layer */
    double rigid_layer;            /* thickness of the rigid layer as a distance; default 0: no layer */
    const char *const *inside;     /* names (or labels as text) of patches inside the volume that are driven,
                                    * such as a flap; default none */
    int64_t n_inside;
    const char *const *slide;      /* names of flat patches whose vertices slide in their plane; default
                                    * none */
    int64_t n_slide;
    const char *const *bodies;     /* names of patches that are rigid bodies, for MOTET_BODIES; default none:
                                    * every separate part of the moved walls but the outer one */
    int64_t n_bodies;
    const char *const *wall;       /* names of patches that have the rigid layer; default none: all of the
                                    * boundary that does not slide */
    int64_t n_wall;
    int32_t no_repair;             /* 1: nothing is repaired, and a step stops before a cell is inverted;
                                    * default 0 */
    int32_t surface;               /* what a repair does to walls; default MOTET_SURFACE_KEEP */
    double distance;               /* how far walls may stray; default 0: a thousandth of the largest
                                    * extent */
    double min_eas;                /* tets with a lower EAS are bad; default 0.2 */
    double margin;                 /* a repair aims at an EAS of min_eas plus this; default 0.05 */
    double floor;                  /* no step takes a tet that can be repaired below this EAS; default 0.05 */
    double improve_below;          /* where a repair changes the mesh, tets with a lower EAS are improved as
                                    * well and the number of vertices is kept; 0: only bad tets change;
                                    * default 0.75 */
    const char *const *contents;   /* names of cell arrays that are densities of something that stays in its
                                    * cell: their integrals are kept; default none */
    int64_t n_contents;
    const char *const *watch;      /* names of patches whose gaps are measured at each step; default none */
    int64_t n_watch;
    double warn;                   /* vertices with a smaller gap warn; default 0: none */
    double within;                 /* largest distance that is searched; default 0: no limit */
    double horizon;                /* how far contact is predicted, in units of time; default 0: the duration
                                    * of the last step */
    double hold;                   /* walls stop at this distance from each other, whatever displacement is
                                    * requested; each watched patch gives way to those listed after it;
                                    * default 0: they do not stop */
    int32_t remembered;            /* number of changes that are kept for motet_moving_since; default 64 */
    int32_t threads;               /* default 0 */
    const char *const *hold_names; /* names of regions and patches that a repair keeps to the bit; default
                                    * none */
    int64_t n_hold_names;
    double slide_tolerance;        /* largest distance of a vertex of a sliding patch from the plane of the
                                    * patch, as a fraction of the radius of the patch; default 0.05 */
    int32_t valid_at_start;        /* 1: new tets must have a volume also where their vertices were at the
                                    * start of the step; a repair that inserts others is repeated with the
                                    * replaced tets held; default 0 */
    int32_t strain_in_band;        /* 1: with MOTET_BODIES a band beside the bodies takes the strain, for
                                    * bodies that go on in one direction; default 0: the strain is spread over
                                    * all of the volume */
    int32_t returns;               /* 1: the walls return to their first places again and again: tets are
                                    * improved to be good there as well, and a mesh that does not settle is
                                    * replaced by the first mesh when the walls are back; default 0 */
    motet_watch *watched_by;       /* tells the progress of calls and stops them; default NULL: nobody */
} motet_moving_options;

/* Sets all members to their defaults; `size` is sizeof(motet_moving_options). */
void motet_moving_options_init(motet_moving_options *options, size_t size);
/* Sets up the motion of a mesh with its arrays; the mesh may be freed afterwards. NULL for options: the
 * defaults. */
motet_status motet_moving_new(
    const motet_mesh *mesh, const motet_moving_options *options, motet_moving **moving, motet_error **error);
/* Writes all that later steps depend on to a .vtu file. */
motet_status motet_moving_save(const motet_moving *moving, const char *path, motet_error **error);
/* Continues from a file of motet_moving_save: with the same options, later steps are the same to the bit.
 * Earlier changes are not remembered. */
motet_status motet_moving_load(
    const char *path, const motet_moving_options *options, motet_moving **moving, motet_error **error);
void motet_moving_free(motet_moving *moving);

/* The number of driven vertices: those of the boundary and of the patches `inside` of the first mesh. */
int64_t motet_moving_n_driven(const motet_moving *moving);
/* Copies the first places of the n driven vertices. Displacements have a row for each of these, in this
 * order. */
motet_status motet_moving_driven_places(
    const motet_moving *moving, double *places, int64_t n, int64_t stride, motet_error **error);
/* The current time; 0 at first. */
double motet_moving_time(const motet_moving *moving);
/* The number of steps so far. */
int64_t motet_moving_step(const motet_moving *moving);
/* The current mesh with its arrays; belongs to the moving mesh and is valid until the next call that changes
 * it. */
const motet_mesh *motet_moving_mesh(const motet_moving *moving);
/* Computes the velocity of each of the n points of the current mesh in the last step. */
motet_status motet_moving_velocity(
    const motet_moving *moving, double *velocity, int64_t n, int64_t stride, motet_error **error);
/* Computes the displacement of each of the n points of the current mesh from its first place. */
motet_status motet_moving_displacement(
    const motet_moving *moving, double *displacement, int64_t n, int64_t stride, motet_error **error);
/* Sets an array of n rows with `components` contiguous values each; replaces an array of the same name. The
 * array is transferred where the mesh changes. */
motet_status motet_moving_set_array(
    motet_moving *moving, int32_t on, const char *name, const double *values, int64_t n, int32_t components,
    motet_error **error);

/* The result of a step. */
typedef struct motet_step {
    size_t size;
    int64_t step;            /* number of the step, from 1 */
    double time;             /* the time that was reached */
    int32_t complete;        /* 1: the walls reached the requested displacement */
    int32_t legs;            /* number of parts in which the step was made */
    double fraction;         /* the fraction of the motion that was reached */
    int64_t changes;         /* number of changes of connectivity; above 0, points and cells are numbered
                              * anew */
    int64_t points;          /* number of points of the mesh */
    int64_t tets;            /* number of tets of the mesh */
    int64_t bad;             /* number of tets with an EAS below the limit */
    int64_t forced;          /* number of bad tets that are as good as the walls at them allow */
    int64_t inverted;        /* number of flat or inverted tets */
    int64_t worst_cell;      /* the tet with the worst EAS; -1 where there is none */
    double worst_eas;        /* the EAS of worst_cell */
    double worst_place[3];   /* the centroid of worst_cell */
    double gap;              /* the least gap of the watched patches; infinite where nothing is within reach,
                              * or no patch is watched */
    int64_t warned;          /* number of vertices that warn */
    int64_t held;            /* number of driven vertices that were stopped before another patch */
    double touch_not_before; /* a time before which nothing touches at the velocities of this step; infinite
                              * where nothing touches within the horizon */
    double seconds;          /* duration of the call */
} motet_step;

/* Sets all members to those of an empty step; `size` is sizeof(motet_step). */
void motet_step_init(motet_step *step, size_t size);
/* Moves the walls to their displacements at a time after the current one, one row for each driven vertex; the
 * inside follows and is repaired on the way where necessary. A motion that is reached in part only is no
 * error: `complete` is 0. `step` may be NULL. On an error nothing is changed. */
motet_status motet_moving_advance(
    motet_moving *moving, double time, const double *displacement, int64_t n_driven, int64_t stride,
    motet_step *step, motet_error **error);
/* Repairs the bad tets of the current mesh, for a mesh that is bad at first or after refinement; a step
 * repairs by itself. `changes` receives the number of changes; it may be NULL. */
motet_status motet_moving_repair(motet_moving *moving, int64_t *changes, motet_error **error);
/* Divides tets until no edge is longer than `at` at a surface, and `growth` more per unit of distance from
 * it; `coarsen` 1: divisions that are not needed are taken back. `changes` receives the number of changes; it
 * may be NULL. */
motet_status motet_moving_refine_near(
    motet_moving *moving, const motet_mesh *surface, double at, double growth, int32_t coarsen,
    int64_t *changes, motet_error **error);
/* Divides tets until edges at watched patches are no longer than the gap between them or than `smallest`;
 * `coarsen` 1: divisions that are not needed are taken back. `changes` receives the number of changes; it may
 * be NULL. */
motet_status motet_moving_refine_gaps(
    motet_moving *moving, double smallest, int32_t coarsen, int64_t *changes, motet_error **error);

/* 1 where all changes since a step are remembered (step 0: since the first mesh), otherwise 0. */
int32_t motet_moving_remembers(const motet_moving *moving, int64_t step);
/* The history from the mesh after a step to the current mesh: transfers any array of the caller, of any time
 * in between, by motet_outcome_transfer. The outcome is NULL where the mesh did not change, so that arrays
 * fit as they are. */
motet_status motet_moving_since(
    const motet_moving *moving, int64_t step, motet_outcome **outcome, motet_error **error);

#ifdef __cplusplus
}
#endif

#endif
