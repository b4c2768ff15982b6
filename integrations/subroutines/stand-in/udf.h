/* Stands in for Fluent's udf.h: declares what fluent_udf.c uses, to check that the example compiles. It contains no
 * code of Fluent. */
#ifndef STAND_IN_UDF_H
#define STAND_IN_UDF_H

#include <stdio.h>

#define ND_ND 3
typedef double real;
typedef int cell_t;
typedef int face_t;
typedef struct { real x[ND_ND]; int needs_update; int id; } Node;
typedef struct { int id; int n; int of_each; Node **nodes; int deforms; } Thread;
typedef struct { Thread **cells; Thread **faces; int n_cells; int n_faces; } Domain;
typedef struct { Thread *thread; } Dynamic_Thread;

#define DEFINE_GRID_MOTION(name, domain, dt, time, dtime) void name(Domain *domain, Dynamic_Thread *dt, real time, real dtime)
#define DT_THREAD(dt) ((dt)->thread)
#define SET_DEFORMING_THREAD_FLAG(t) ((t)->deforms = 1)
#define begin_c_loop(c, t) for ((c) = 0; (c) < (t)->n; (c)++)
#define end_c_loop(c, t)
#define c_node_loop(c, t, n) for ((n) = 0; (n) < (t)->of_each; (n)++)
#define C_NODE(c, t, n) ((t)->nodes[(c) * (t)->of_each + (n)])
#define begin_f_loop(f, t) for ((f) = 0; (f) < (t)->n; (f)++)
#define end_f_loop(f, t)
#define f_node_loop(f, t, n) for ((n) = 0; (n) < (t)->of_each; (n)++)
#define F_NODE(f, t, n) ((t)->nodes[(f) * (t)->of_each + (n)])
#define NODE_COORD(v) ((v)->x)
#define NODE_POS_NEED_UPDATE(v) ((v)->needs_update)
#define NODE_POS_UPDATED(v) ((v)->needs_update = 0)
#define NODE_MARK_INDEX(v) ((v)->id)
#define Message printf
Thread *Lookup_Thread(Domain *domain, int id);

#endif
