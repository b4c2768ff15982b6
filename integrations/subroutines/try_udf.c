/* Calls the example on a tiny fluid zone made with the stand-in for Fluent, and checks that the node in the middle
 * follows. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "udf.h"

void motet_motion(Domain *domain, Dynamic_Thread *dt, real time, real dtime);

Thread *Lookup_Thread(Domain *domain, int id)
{
    int i;
    for (i = 0; i < domain->n_faces; i++)
        if (domain->faces[i]->id == id) return domain->faces[i];
    return NULL;
}

int main(void)
{
    /* An octahedron of radius 1, the body, in one of radius 4, the walls; one node between. */
    static Node nodes[13];
    Node *body_nodes[6], *wall_nodes[6], *cell_nodes[4];
    Thread body = {5, 2, 3, body_nodes, 0}, wall = {6, 2, 3, wall_nodes, 0}, fluid = {1, 1, 4, cell_nodes, 0}, *faces[2] = {&body, &wall};
    Domain domain = {NULL, faces, 0, 2};
    Dynamic_Thread dynamic = {&fluid};
    int i;
    memset(nodes, 0, sizeof nodes);
    for (i = 0; i < 6; i++) {
        nodes[i].x[i / 2] = i % 2 ? -1 : 1, nodes[6 + i].x[i / 2] = i % 2 ? -4 : 4;
        body_nodes[i] = &nodes[i], wall_nodes[i] = &nodes[6 + i];
    }
    nodes[12].x[0] = 2.5;
    cell_nodes[0] = &nodes[0], cell_nodes[1] = &nodes[6], cell_nodes[2] = &nodes[8], cell_nodes[3] = &nodes[12];
    for (i = 0; i < 13; i++) nodes[i].needs_update = 1;
    motet_motion(&domain, &dynamic, 0.25, 0.25);
    printf("the body is at %.3f, the node between at %.3f, the wall at %.3f\n", nodes[0].x[0], nodes[12].x[0], nodes[6].x[0]);
    return !(fabs(nodes[0].x[0] - 1.5) < 1e-6 && fabs(nodes[12].x[0] - 2.75) < 1e-6 && nodes[6].x[0] == 4 && fluid.deforms);
}
