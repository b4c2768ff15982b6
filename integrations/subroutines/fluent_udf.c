/* A user-defined function of Fluent, DEFINE_GRID_MOTION for a fluid zone: motet moves the nodes of its cells with
 * those of its walls.
 *
 * Hook it to the fluid cell zone. WALLS are the ids of the zones whose motion is prescribed by `wall_displacement`:
 * here a sphere that swings. The first call sets up the graph for the current mesh. It was compiled with
 * stand-in/udf.h, not run in Fluent.
 *
 * For a serial Fluent. In parallel each process must gather the wall nodes of all processes (PRF_GCOLLECT and the
 * like) before motet_point_mover_new and before each step.
 */
#include <math.h>
#include <stdlib.h>

#include "motet.h"
#include "udf.h"

static const int WALLS[] = {5, 6};
enum { N_WALLS = sizeof WALLS / sizeof WALLS[0] };

/* The displacement at a time of a wall node whose first place is `x`. */
static void wall_displacement(const real x[ND_ND], real time, real displacement[ND_ND])
{
    const int is_sphere = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1.01;
    displacement[0] = is_sphere ? 0.5 * sin(6.2832 * time) : 0;
    displacement[1] = displacement[2] = 0;
}

/* A list of nodes and their first places, three numbers each. */
typedef struct {
    Node **nodes;
    double *first;
    int64_t n, room;
} Places;

static Places walls, cells;
static double *displacement, *moved;
static motet_point_mover *mover;

static void add(Places *places, Node *node)
{
    int k;
    if (places->n == places->room) {
        places->room = 2 * places->room + 1024;
        places->nodes = realloc(places->nodes, sizeof(Node *) * (size_t)places->room);
        places->first = realloc(places->first, sizeof(double) * 3 * (size_t)places->room);
    }
    for (k = 0; k < 3; k++) places->first[3 * places->n + k] = NODE_COORD(node)[k];
    places->nodes[places->n++] = node;
}

/* A node is listed once for each face or cell that has it; duplicates do no harm. */
static int set_up(Domain *domain, Thread *fluid)
{
    motet_error *error = NULL;
    int w, n;
    face_t f;
    cell_t c;
    for (w = 0; w < N_WALLS; w++) {
        Thread *wall = Lookup_Thread(domain, WALLS[w]);
        begin_f_loop(f, wall)
        {
            f_node_loop(f, wall, n) add(&walls, F_NODE(f, wall, n));
        }
        end_f_loop(f, wall)
    }
    begin_c_loop(c, fluid)
    {
        c_node_loop(c, fluid, n) add(&cells, C_NODE(c, fluid, n));
    }
    end_c_loop(c, fluid)
    displacement = malloc(sizeof(double) * 3 * (size_t)walls.n);
    moved = malloc(sizeof(double) * 3 * (size_t)cells.n);
    if (motet_point_mover_new(walls.first, walls.n, 3, cells.first, cells.n, 3, 1, &mover, &error) != MOTET_OK) {
        Message("motet: %s\n", motet_error_message(error));
        motet_error_free(error);
        return 0;
    }
    return 1;
}

DEFINE_GRID_MOTION(motet_motion, domain, dt, time, dtime)
{
    Thread *fluid = DT_THREAD(dt);
    motet_error *error = NULL;
    int64_t i;
    int k;
    (void)dtime;
    SET_DEFORMING_THREAD_FLAG(fluid);
    if (mover == NULL && !set_up(domain, fluid)) return;
    for (i = 0; i < walls.n; i++) wall_displacement(walls.first + 3 * i, time, displacement + 3 * i);
    if (motet_point_mover_step(mover, displacement, walls.n, 3, moved, cells.n, 3, &error) != MOTET_OK) {
        Message("motet: %s\n", motet_error_message(error));
        motet_error_free(error);
        return;
    }
    for (i = 0; i < cells.n; i++) {
        Node *node = cells.nodes[i];
        if (!NODE_POS_NEED_UPDATE(node)) continue;
        for (k = 0; k < 3; k++) NODE_COORD(node)[k] = moved[3 * i + k];
        NODE_POS_UPDATED(node);
    }
}
