/* motet: tetrahedral meshes that stay good while the world in them moves.
 *
 * This header is the reference of the C library; C99 and later, C++ as well.
 *
 * Arrays.    Counts are int64_t, ids int32_t, from 0. Coordinates and vectors are doubles, three a row; a stride is the number of doubles from one row to the
 *            next, 3 where they lie end to end (then they are read and written where they lie), more where other values stand between. Arrays that are given are
 *            read during the call alone; arrays that come out are written into memory of the caller, as long as the count before it says, and shared with
 *            none that is read.
 * Units.     Lengths are in whatever unit the mesh has, angles in degrees.
 * Handles.   Whatever a call gives through a pointer to a pointer belongs to the caller, who hands it back to the _free of its kind; NULL may be freed. What is
 *            borrowed from a handle, a text or a mesh of an outcome, lives as long as the handle, and as long as it is not changed.
 * Errors.    Calls that can fail return a status, and give an error through their last argument, unless that is NULL. What they were to give is NULL then.
 *            Text is UTF-8. A NULL for something that is needed is an error, not a crash; a handle that was freed is neither.
 * Threads.   There is no global state. Different handles may be used at the same time. Calls that take a handle by pointer to const may be made at the same time
 *            for one handle, others not. `threads` in options: 0 for all cores, 1 for the caller's alone. Outcomes do not depend on it.
 * Versions.  Structs of options begin with their size, which their _init sets; later versions add members behind. An old program gets the defaults of what it does
 *            not know.
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

/* The version of the library that is linked: major * 10000 + minor * 100 + patch. */
int32_t motet_version(void);

/* ---- Errors ---------------------------------------------------------------------------------------------------------------------------- */

typedef int32_t motet_status;
enum {
    MOTET_OK = 0,
    MOTET_ERROR_INTERNAL = 1, /* a fault of motet itself; what was given is unharmed, handles that were to change should be freed */
    MOTET_ERROR_OPTIONS = 2,  /* options that mean nothing, a NULL, a count below 0 */
    MOTET_ERROR_INPUT = 3,    /* data that cannot be read, or are not what is needed */
    MOTET_ERROR_IO = 4        /* the operating system refused a file */
};

typedef struct motet_error motet_error;

motet_status motet_error_status(const motet_error *error);
/* All of it in one sentence or two. */
const char *motet_error_message(const motet_error *error);
/* What was expected and what came; in which file; where in it or in the mesh; what can be done. NULL where there is none. */
const char *motet_error_what(const motet_error *error);
const char *motet_error_file(const motet_error *error);
const char *motet_error_place(const motet_error *error);
const char *motet_error_remedy(const motet_error *error);
void motet_error_free(motet_error *error);

/* ---- Meshes ---------------------------------------------------------------------------------------------------------------------------- */

/* Points, cells of any kinds, and arrays on them. */
typedef struct motet_mesh motet_mesh;

/* Kinds of cells, by VTK's numbers and with VTK's order of vertices; others of VTK's are taken as well. */
enum {
    MOTET_VERTEX = 1, MOTET_LINE = 3, MOTET_TRIANGLE = 5, MOTET_QUAD = 9, MOTET_TETRA = 10, MOTET_HEXAHEDRON = 12, MOTET_WEDGE = 13, MOTET_PYRAMID = 14,
    MOTET_TETRA10 = 24
};

/* Where the rows of an array are. */
enum { MOTET_ON_POINTS = 0, MOTET_ON_CELLS = 1 };

/* A mesh of n points and no cells. */
motet_status motet_mesh_new(const double *points, int64_t n, int64_t stride, motet_mesh **mesh, motet_error **error);
/* Adds n cells of one kind; vertices has the vertices of each, end to end. All are checked: on an error nothing is added. */
motet_status motet_mesh_add_cells(motet_mesh *mesh, int32_t kind, const int32_t *vertices, int64_t n, motet_error **error);
/* Labels of all cells, in their order: the regions of volume cells, the patches of surface cells; 0 for none. */
motet_status motet_mesh_set_labels(motet_mesh *mesh, const int32_t *labels, int64_t n, motet_error **error);
motet_status motet_mesh_name_region(motet_mesh *mesh, int32_t label, const char *name, motet_error **error);
motet_status motet_mesh_name_patch(motet_mesh *mesh, int32_t label, const char *name, motet_error **error);
/* An array of n rows of so many components, end to end, on points or on cells, in place of one of the same name. */
motet_status motet_mesh_set_array(
    motet_mesh *mesh, int32_t on, const char *name, const double *values, int64_t n, int32_t components, motet_error **error);
/* New places of all points. */
motet_status motet_mesh_set_points(motet_mesh *mesh, const double *points, int64_t n, int64_t stride, motet_error **error);

/* A file of any format, by its ending. */
motet_status motet_mesh_read(const char *path, motet_mesh **mesh, motet_error **error);
motet_status motet_mesh_write(const motet_mesh *mesh, const char *path, motet_error **error);

motet_status motet_mesh_copy(const motet_mesh *mesh, motet_mesh **copy, motet_error **error);
void motet_mesh_free(motet_mesh *mesh);

int64_t motet_mesh_n_points(const motet_mesh *mesh);
int64_t motet_mesh_n_cells(const motet_mesh *mesh);
/* How many cells are of a kind. */
int64_t motet_mesh_n_of_kind(const motet_mesh *mesh, int32_t kind);
/* How many vertices all cells have together. */
int64_t motet_mesh_n_vertices_of_cells(const motet_mesh *mesh);
motet_status motet_mesh_points(const motet_mesh *mesh, double *points, int64_t n, int64_t stride, motet_error **error);
/* The vertices of the cells of a kind, end to end: n is the number of cells times the number of vertices of each. */
motet_status motet_mesh_of_kind(const motet_mesh *mesh, int32_t kind, int32_t *vertices, int64_t n, motet_error **error);
/* All cells in their order: the kind of each; where each one's vertices begin, and the last one's end (n_cells + 1); all vertices. */
motet_status motet_mesh_cells(
    const motet_mesh *mesh, int32_t *kinds, int64_t n_cells, int64_t *offsets, int32_t *vertices, int64_t n_vertices, motet_error **error);
/* The labels of all cells; 0 for those without. */
motet_status motet_mesh_labels(const motet_mesh *mesh, int32_t *labels, int64_t n, motet_error **error);
/* The label of a name, -1 where there is none of that name. */
int32_t motet_mesh_region(const motet_mesh *mesh, const char *name);
int32_t motet_mesh_patch(const motet_mesh *mesh, const char *name);
/* How many vertices a patch has, by its name or its label written out; -1 where there is none of that name. Then these vertices, rising. */
int64_t motet_mesh_n_patch_vertices(const motet_mesh *mesh, const char *name);
motet_status motet_mesh_patch_vertices(const motet_mesh *mesh, const char *name, int32_t *vertices, int64_t n, motet_error **error);
/* How many components an array has; 0 where there is none of that name, or one of texts. */
int32_t motet_mesh_array_components(const motet_mesh *mesh, int32_t on, const char *name);
/* The values of an array, n rows end to end. */
motet_status motet_mesh_array(const motet_mesh *mesh, int32_t on, const char *name, double *values, int64_t n, motet_error **error);
/* The equi-angle quality of each cell: 1 regular, 0 flat, negative inverted, bad below 0.2; NaN for those that are no tets. */
motet_status motet_mesh_eas(const motet_mesh *mesh, double *eas, int64_t n, motet_error **error);
/* Counts, bounds, volumes, quality and defects as one JSON object, as `motet info --json` prints it. */
typedef struct motet_text motet_text;
motet_status motet_mesh_summary(const motet_mesh *mesh, motet_text **summary, motet_error **error);
const char *motet_text_get(const motet_text *text);
void motet_text_free(motet_text *text);

/* ---- Motion ---------------------------------------------------------------------------------------------------------------------------- */

/* Moves the vertices of one mesh after its boundary. */
typedef struct motet_mover motet_mover;

enum {
    MOTET_DELAUNAY = 0, /* weights in the Delaunay graph of the boundary (Liu, Qin, Xia 2006): the cheapest */
    MOTET_BODIES = 1,   /* rigid bodies carry along what is round them: for parts that turn or shift far */
    MOTET_GUIDED = 2,   /* nodes inside, with rotations: for walls that bend */
    MOTET_ELASTIC = 3,  /* an elastic body; to compare with */
    MOTET_LAPLACE = 4,  /* a Laplace equation; to compare with */
    MOTET_IDW = 5,      /* inverse-distance weighting; to compare with */
    MOTET_RBF = 6       /* radial basis functions; to compare with */
};

typedef struct motet_mover_options {
    size_t size;
    int32_t method;            /* default MOTET_DELAUNAY */
    int32_t within_walls;      /* 1: no vertex follows the wall of another lumen or the far side of a flap; default 0 */
    int32_t smooth;            /* sweeps over the vertices of bad tets after each step; default 0 */
    int32_t substeps;          /* at most so many in an advance; default 50 */
    int32_t threads;           /* default 1 */
    int32_t rigid_layer_cells; /* vertices so many cells from the wall keep their place relative to it; default 0: none */
    double rigid_layer;        /* the same by a distance; default 0: none */
    double residual;           /* when an iterated linear system is solved; default 1e-6 */
    double factor_gib;         /* a factor of it is kept where it takes no more gibibytes; default 0 */
    const char *const *slide;  /* names (or labels written out) of flat patches whose vertices slide in their plane; default none */
    int64_t n_slide;
    const char *const *bodies; /* of patches that are rigid bodies; default none: all parts of the walls but the outer one, the boundary and interfaces that are moved */
    int64_t n_bodies;
    const char *const *wall;   /* of patches that have the rigid layer; default none: all of the boundary that does not slide */
    int64_t n_wall;
    const int32_t *also_moved; /* vertices inside that are moved, too; default none */
    int64_t n_also_moved;
    double slide_tolerance;    /* how far vertices of a patch that slides may be off its plane, as a part of its radius; default 0.05 */
} motet_mover_options;

/* Defaults; size is sizeof(motet_mover_options). */
void motet_mover_options_init(motet_mover_options *options, size_t size);

/* Sets up the motion of a mesh, which is not needed any longer after. NULL options: the defaults. */
motet_status motet_mover_new(const motet_mesh *mesh, const motet_mover_options *options, motet_mover **mover, motet_error **error);
void motet_mover_free(motet_mover *mover);

int64_t motet_mover_n_points(const motet_mover *mover);
/* The vertices that the caller moves, rising: those of the boundary, and also_moved. */
int64_t motet_mover_n_boundary(const motet_mover *mover);
motet_status motet_mover_boundary(const motet_mover *mover, int32_t *vertices, int64_t n, motet_error **error);
/* The four vertices that a vertex follows, and their weights; is_hanging is 0 where it follows something else. */
motet_status motet_mover_weights(
    const motet_mover *mover, int32_t vertex, int32_t vertices[4], double weights[4], int32_t *is_hanging, motet_error **error);

/* Moves the mesh from its first place: displacement has a row for each vertex of the boundary, points gets the place of every vertex. Nothing is checked but the
 * counts and that displacements are finite; a step depends on the displacement alone, never on the steps before. */
motet_status motet_mover_step(
    const motet_mover *mover, const double *displacement, int64_t n_boundary, int64_t displacement_stride, double *points, int64_t n_points,
    int64_t points_stride, motet_error **error);

/* What an advance reached. */
typedef struct motet_certificate {
    size_t size;
    int32_t complete;     /* 1: the mesh is where it was asked to be */
    int32_t substeps;
    double fraction;      /* the part of the way that was reached */
    int64_t inverted;     /* volume cells that are inverted or flat */
    int64_t inverted_before;
    int64_t bad;          /* tets with an EAS below 0.2 */
    int64_t worst_cell;   /* the tet with the worst EAS, -1 where there is none */
    double worst_eas;
    double worst_place[3];
    double seconds;
    int64_t worst_curved_cell;    /* the quadratic cell with the worst scaled Jacobian, -1 where there is none */
    double worst_curved_jacobian; /* a lower bound of it, 0 or less where the cell may be folded; NaN where there is none */
    int64_t leaves_plane_vertex;  /* the vertex of a sliding patch's rim that is moved farthest out of its plane, -1 where none is */
    double leaves_plane_distance; /* how far, in the unit of the mesh */
} motet_certificate;

void motet_certificate_init(motet_certificate *certificate, size_t size);

/* The same in sub-steps if need be: no cell that was upright at first is inverted in the end. A motion that does not get all the way is no error. certificate may be
 * NULL. */
motet_status motet_mover_advance(
    motet_mover *mover, const double *displacement, int64_t n_boundary, int64_t displacement_stride, double *points, int64_t n_points,
    int64_t points_stride, motet_certificate *certificate, motet_error **error);

/* Points after nodes, without a mesh: for processes that have a part of it each. All give the nodes of the whole boundary, in any order, and their own points; cells
 * are not known, so nothing is certified. By the Delaunay graph of the nodes; processes that have the same point may place it apart by its last digits. */
typedef struct motet_point_mover motet_point_mover;

motet_status motet_point_mover_new(
    const double *nodes, int64_t n_nodes, int64_t node_stride, const double *points, int64_t n_points, int64_t point_stride, int32_t threads,
    motet_point_mover **mover, motet_error **error);
void motet_point_mover_free(motet_point_mover *mover);
/* Moves the points from their first place; of several nodes at one place the displacement of the first counts. */
motet_status motet_point_mover_step(
    const motet_point_mover *mover, const double *displacement, int64_t n_nodes, int64_t displacement_stride, double *points, int64_t n_points,
    int64_t points_stride, motet_error **error);

/* ---- What changes a mesh ---------------------------------------------------------------------------------------------------------------- */

/* A new mesh, where everything in it came from, and what was done. */
typedef struct motet_outcome motet_outcome;

/* 1: all that was asked is reached. */
int32_t motet_outcome_complete(const motet_outcome *outcome);
const motet_mesh *motet_outcome_mesh(const motet_outcome *outcome);
/* What was done, as one JSON object. */
const char *motet_outcome_report(const motet_outcome *outcome);
/* Why the requested result was not reached; NULL where it was. Belongs to the outcome. */
const char *motet_outcome_not_reached(const motet_outcome *outcome);
/* For each new vertex (cell) the old one that it is, to the bit; -1 for those that came. */
motet_status motet_outcome_to_old(const motet_outcome *outcome, int32_t on, int32_t *old, int64_t n, motet_error **error);
/* An array of the old mesh on the new one. */
enum {
    MOTET_RULE_MEAN = 0,    /* on points interpolated; on cells averaged by volume, so that integrals stay */
    MOTET_RULE_INHERIT = 1, /* the value of what has the largest share */
    MOTET_RULE_LINEAR = 2   /* on points linear in each old tet; on cells as MEAN */
};
motet_status motet_outcome_transfer(
    const motet_outcome *outcome, int32_t on, int32_t rule, const double *values, int64_t n, int32_t components, double *out, int64_t n_out,
    motet_error **error);
void motet_outcome_free(motet_outcome *outcome);

/* Bad tets are found and repaired, and only they. */
typedef struct motet_remesh_options {
    size_t size;
    double min_eas;          /* a tet below is bad; default 0.2 */
    double min_dihedral_deg; /* or one with a dihedral angle below this; default 0 */
    int32_t best;            /* 1: the worst tets as good as they get, everywhere; default 0 */
    int32_t surface;         /* 0: kept to the bit; 1: adapts within a distance, features kept; 2: features, too, where nothing else helps; default 0 */
    double distance;         /* how far it may stray; default 0: a thousandth of the largest extent */
    int32_t repair_layers;   /* 1: thin tets of boundary layers are repaired as others are; default 0 */
    int32_t rounds;          /* default 20 */
    int32_t threads;         /* default 0 */
    double edge_length;      /* edges are brought to this length; default 0: they are left */
    const double *sizes;     /* or to these, one for each point; default NULL */
    int64_t n_sizes;
    const char *const *hold; /* names (or labels written out) of regions and patches that stay to the bit; default none */
    int64_t n_hold;
} motet_remesh_options;

void motet_remesh_options_init(motet_remesh_options *options, size_t size);
motet_status motet_remesh(const motet_mesh *mesh, const motet_remesh_options *options, motet_outcome **outcome, motet_error **error);

/* Devices are put into a mesh of tets. */
typedef struct motet_implant_options {
    size_t size;
    int32_t inside;    /* 0: devices keep their tets, surfaces are filled; 1: all are filled anew; 2: hollow; default 0 */
    int32_t conform;   /* 1: a new surface near the device's, for those that touch or cross themselves; default 0: every triangle kept */
    double tolerance;  /* how far that may be; default 0: a fifth of the radius of a wire as thick as the device */
    int32_t keep_outside; /* 1: what lies outside of the host is kept; default 0: it is cut off */
    int32_t adapt;     /* what of the host is refined first: 0 nothing, 1 walls nearby, 2 all nearby; default 1 */
    double stray;      /* how far surfaces may stray where a device meets a wall; default -1: a twentieth of its edges */
    double edge_length; /* beside the devices; default 0: as theirs */
    double growth;     /* of sizes, per unit of distance; default 0.5 */
    double carve;      /* what is nearer than so many edges is replaced; default 1 */
    double reach;      /* what is farther stays to the bit; default 3 */
    double min_eas;    /* tets below are repaired; default 0.2 */
    int32_t threads;   /* default 0 */
} motet_implant_options;

void motet_implant_options_init(motet_implant_options *options, size_t size);
/* names are those of the regions and patches of the devices. */
motet_status motet_implant(
    const motet_mesh *host, const motet_mesh *const *devices, const char *const *names, int64_t n_devices, const motet_implant_options *options,
    motet_outcome **outcome, motet_error **error);

/* Closed surfaces are filled with tets. */
typedef struct motet_fill_options {
    size_t size;
    double edge_length; /* of edges inside, the largest where sizes grow; default 0: no points inside but those needed */
    int32_t graded;     /* 1: as long as those of the surface, growing inwards; default 0 */
    double growth;      /* per unit of distance; default 0: 0.3 */
    double min_eas;     /* tets below are repaired; default 0: 0.2 with sizes, none without */
    int32_t layers;     /* thin layers on walls; default 0 */
    double first_layer; /* thickness of the first */
    double layer_growth; /* how many times as thick each next one is; default 1.2 */
    int32_t keep_prisms; /* 1: layers stay wedges and pyramids; default 0 */
    int32_t repair;     /* 1: T-junctions, faces on each other, duplicates, orientation and small holes are mended first; default 0 */
    int32_t threads;    /* default 0 */
    int32_t cut;        /* 1: surfaces that go through each other are divided where they do; default 0 */
    int32_t voids;      /* 1: what closed surfaces turned inward enclose is left out; default 0 */
} motet_fill_options;

void motet_fill_options_init(motet_fill_options *options, size_t size);
/* is_membrane: 1 for surfaces that may end inside the others; NULL: none. The outcome has no history. */
motet_status motet_fill(
    const motet_mesh *const *surfaces, const char *const *names, const int32_t *is_membrane, int64_t n_surfaces, const motet_fill_options *options,
    motet_outcome **outcome, motet_error **error);

/* A mesh whose tets are divided and taken back, step after step. */
typedef struct motet_refinement motet_refinement;

motet_status motet_refinement_new(const motet_mesh *mesh, int32_t threads, motet_refinement **refinement, motet_error **error);
void motet_refinement_free(motet_refinement *refinement);
/* The mesh as it is now: borrowed, until the next change. */
const motet_mesh *motet_refinement_mesh(const motet_refinement *refinement);
/* How often each cell was divided; -1 for those that are no tets. */
motet_status motet_refinement_generations(const motet_refinement *refinement, int32_t *generations, int64_t n, motet_error **error);
/* Divides the tets among the cells whose mark is not 0, and what has to be so that all fit. The outcome, which may be NULL, has a copy of the mesh and the history. */
motet_status motet_refinement_divide(
    motet_refinement *refinement, const int32_t *marks, int64_t n, motet_outcome **outcome, motet_error **error);
/* Takes back divisions of which all parts are marked. */
motet_status motet_refinement_coarsen(
    motet_refinement *refinement, const int32_t *marks, int64_t n, motet_outcome **outcome, motet_error **error);
/* Divides until no edge is longer than `at` at a surface, and `growth` more per unit of distance from it. */
motet_status motet_refinement_near(
    motet_refinement *refinement, const motet_mesh *surface, double at, double growth, motet_outcome **outcome, motet_error **error);

/* ---- Contact --------------------------------------------------------------------------------------------------------------------------- */

/* Two or more surfaces over one list of points, or one with itself. */
typedef struct motet_contact motet_contact;

typedef struct motet_contact_options {
    size_t size;
    double warn;     /* gaps below are warned of; default 0: none */
    double within;   /* how far is looked; default 0: no limit */
    double fold;     /* places of one surface are neighbours where the way along it is shorter than so many times the straight one; default 3 */
    int32_t own;     /* 1: each surface is measured against itself as well; default 0 */
    int32_t facing;  /* 1: only where surfaces face each other through free space; default 0 */
    int32_t threads; /* default 0 */
} motet_contact_options;

void motet_contact_options_init(motet_contact_options *options, size_t size);
/* Triangles of all bodies, one body after the other; counts has the number of each; is_room is 1 for walls of rooms that others are within, 0 for
 * bodies that are none, -1 where that is to be found: a closed surface that encloses most of another one's area is its room. NULL: -1 for all. */
motet_status motet_contact_new(
    const double *points, int64_t n_points, int64_t stride, const int32_t *triangles, const int64_t *counts, const int32_t *is_room, int64_t n_bodies,
    const motet_contact_options *options, motet_contact **contact, motet_error **error);
void motet_contact_free(motet_contact *contact);
/* New places of all points. */
motet_status motet_contact_refit(motet_contact *contact, const double *points, int64_t n_points, int64_t stride, motet_error **error);
/* The gap at each point: the least of those of its bodies, infinite for points of none and where nothing is within reach, negative where it must not be. least may be
 * NULL, and gets the least distance of any pair of triangles. */
motet_status motet_contact_measure(motet_contact *contact, double *gaps, int64_t n_points, double *least, motet_error **error);
/* The nearest places of two bodies, that of each; distance is infinite where nothing is within reach. */
motet_status motet_contact_nearest(
    motet_contact *contact, int32_t first, int32_t second, double *distance, double places[6], int32_t triangles[2], motet_error **error);
/* Nothing touches earlier, if points go on straight at their velocities; infinite where nothing does before the horizon (0: no end). */
motet_status motet_contact_ahead(
    const motet_contact *contact, const double *velocity, int64_t n_points, int64_t stride, double horizon, double *time, motet_error **error);

/* ---- The loop --------------------------------------------------------------------------------------------------------------------------- */

/* A mesh that moves with its walls and stays good: moved, certified, repaired while what is bad still has a volume, refined, watched, its arrays carried along.
 * Displacements are always given for the walls as they came, counted from there, whatever the mesh becomes. */
typedef struct motet_moving motet_moving;

typedef struct motet_moving_options {
    size_t size;
    int32_t method;            /* of motion, these as of a mover; default MOTET_DELAUNAY */
    int32_t within_walls;      /* default 0 */
    int32_t smooth;            /* default 0 */
    int32_t rigid_layer_cells; /* default 0: none */
    double rigid_layer;        /* default 0: none */
    const char *const *inside; /* names (or labels written out) of patches inside the volume that are driven, such as a flap; default none */
    int64_t n_inside;
    const char *const *slide;  /* the others as of a mover */
    int64_t n_slide;
    const char *const *bodies;
    int64_t n_bodies;
    const char *const *wall;
    int64_t n_wall;
    int32_t no_repair;         /* 1: nothing is repaired, a step ends where a cell would turn over; default 0 */
    int32_t surface;           /* what repair may do to walls, and how far they may stray: as of motet_remesh_options; default 0: kept to the bit */
    double distance;
    double min_eas;            /* a tet below is bad; default 0.2 */
    double margin;             /* tets are repaired up to so much above that; default 0.05 */
    double floor;              /* no step takes a tet that can be repaired below this; default 0.05 */
    double improve_below;      /* where a repair changes the mesh, tets below this are made better, too, and the number of vertices is kept; 0: not; default 0.75 */
    const char *const *contents; /* cell arrays that are densities of something that stays in its cell: their integrals are kept; default none */
    int64_t n_contents;
    const char *const *watch;  /* patches whose gaps are measured at each step; default none */
    int64_t n_watch;
    double warn;               /* gaps below are warned of; default 0: none */
    double within;             /* how far is looked; default 0: no limit */
    double horizon;            /* how far ahead, in units of time; default 0: as long as the last step took */
    double hold;               /* walls stop at this distance, wherever they are requested to go, each patch before those after it; default 0: they do not */
    int32_t remembered;        /* so many changes are remembered for motet_moving_since; default 64 */
    int32_t threads;           /* default 0 */
    const char *const *hold_names; /* regions and patches that repair leaves as they are: as hold of motet_remesh_options; default none */
    int64_t n_hold_names;
    double slide_tolerance;    /* how far vertices of a patch that slides may be off its plane, as a part of its radius; default 0.05 */
    int32_t valid_at_start;    /* 1: a repair that brings tets without volume where their vertices were as the step began is made again with the tets that they replace held; default 0 */
    int32_t strain_in_band;    /* 1: with MOTET_BODIES the strain goes into a band beside the bodies, for bodies that go on; default 0: over all that is between them and the walls */
    int32_t returns;           /* 1: the walls come back to where they were at first, again and again, and tets are to be good there, too; a mesh that does not settle is replaced by the first one there; default 0 */
} motet_moving_options;

void motet_moving_options_init(motet_moving_options *options, size_t size);
/* Sets up the motion of a mesh with its arrays, which is not needed any longer after. NULL options: the defaults. */
motet_status motet_moving_new(const motet_mesh *mesh, const motet_moving_options *options, motet_moving **moving, motet_error **error);
/* Writes all that the next steps depend on, as a .vtu; goes on from there with the same options, to the same bits. Changes before are not remembered. */
motet_status motet_moving_save(const motet_moving *moving, const char *path, motet_error **error);
motet_status motet_moving_load(const char *path, const motet_moving_options *options, motet_moving **moving, motet_error **error);
void motet_moving_free(motet_moving *moving);

/* Where the driven vertices were at first: those of the boundary, and of `inside`. Displacements have a row for each of these, in this order. */
int64_t motet_moving_n_driven(const motet_moving *moving);
motet_status motet_moving_driven_places(const motet_moving *moving, double *places, int64_t n, int64_t stride, motet_error **error);
/* The time that was reached, from 0, and how many steps were made. */
double motet_moving_time(const motet_moving *moving);
int64_t motet_moving_step(const motet_moving *moving);
/* The mesh as it is, with its arrays: borrowed, until the next call that changes it. */
const motet_mesh *motet_moving_mesh(const motet_moving *moving);
/* Of each of its vertices: the velocity in the last step; how far it is from where it was at first. */
motet_status motet_moving_velocity(const motet_moving *moving, double *velocity, int64_t n, int64_t stride, motet_error **error);
motet_status motet_moving_displacement(const motet_moving *moving, double *displacement, int64_t n, int64_t stride, motet_error **error);
/* Puts an array of n rows on the mesh, in place of one of the same name: it is carried where the mesh changes. */
motet_status motet_moving_set_array(
    motet_moving *moving, int32_t on, const char *name, const double *values, int64_t n, int32_t components, motet_error **error);

/* What became of a step. */
typedef struct motet_step {
    size_t size;
    int64_t step;         /* its number, from 1 */
    double time;          /* that was reached */
    int32_t complete;     /* 1: the walls are where they were asked to be */
    int32_t legs;         /* in how many parts it was gone */
    double fraction;      /* the part of the way that was gone */
    int64_t changes;      /* how often connectivity was changed: above 0 the numbers of points and cells are others than before */
    int64_t points;
    int64_t tets;
    int64_t bad;          /* tets with an EAS below the limit; of these, those that walls force */
    int64_t forced;
    int64_t inverted;     /* tets that are flat or inverted */
    int64_t worst_cell;   /* -1 where there is none */
    double worst_eas;
    double worst_place[3];
    double gap;           /* the least of the watched patches; infinite where nothing is within reach, or none is watched */
    int64_t warned;       /* vertices that warn */
    int64_t held;         /* driven vertices that were stopped in front of another patch */
    double touch_not_before; /* nothing touches earlier, at the velocities of this step; infinite: not within the horizon */
    double seconds;
} motet_step;

void motet_step_init(motet_step *step, size_t size);
/* Takes the walls to where they are at a time after the one that was reached; the inside follows, and is repaired on the way where need be. A motion that cannot be gone to
 * the end is no error: complete is 0. step may be NULL. On an error all is as it was before the call. */
motet_status motet_moving_advance(
    motet_moving *moving, double time, const double *displacement, int64_t n_driven, int64_t stride, motet_step *step, motet_error **error);
/* Repairs what is bad where the mesh is: of one that came, or was refined. A step does so by itself. changes, here and below, may be NULL. */
motet_status motet_moving_repair(motet_moving *moving, int64_t *changes, motet_error **error);
/* Divides until no edge is longer than `at` at a surface, and `growth` more per unit of distance from it; coarsen 1: divisions that are not needed are taken back. */
motet_status motet_moving_refine_near(
    motet_moving *moving, const motet_mesh *surface, double at, double growth, int32_t coarsen, int64_t *changes, motet_error **error);
/* Divides until edges at watched patches are no longer than the gap between them is wide, or than `smallest`; coarsen 1: takes back what is not needed. */
motet_status motet_moving_refine_gaps(motet_moving *moving, double smallest, int32_t coarsen, int64_t *changes, motet_error **error);

/* Whether all changes since a step are known (0: since the first mesh); 1 or 0. */
int32_t motet_moving_remembers(const motet_moving *moving, int64_t step);
/* From the mesh after a step to the mesh as it is: carries any array of the caller's own, of any time level in between, by motet_outcome_transfer. The outcome is NULL where
 * nothing changed, and arrays serve as they are. */
motet_status motet_moving_since(const motet_moving *moving, int64_t step, motet_outcome **outcome, motet_error **error);

#ifdef __cplusplus
}
#endif

#endif
