/* solid_mesh.h - the surface of a solid, and of the pieces into which it is cut, as half-edges.
 *
 * A face is plane and has one loop around it and one around each of its holes. The loop around runs counter-clockwise
 * from outside, the others clockwise. Pieces share vertices, and nothing else. A piece may have several shells, for
 * cavities, and may touch itself along a cut that did not part it. */
#ifndef TL_GEOMETRY_SOLID_MESH_H
#define TL_GEOMETRY_SOLID_MESH_H

#include <stdbool.h>
#include <talus/types.h>

#define TL_SOLID_NONE UINT32_MAX

/* Runs from vertex `from` to that of `next`, with its face at the left. */
typedef struct tl_half_edge {
    uint32_t from, next, prev;
    uint32_t mate; /* the same edge on the other face */
    uint32_t face;
    uint32_t ring; /* of the first one of a loop: the first one of the next loop of the face, or none */
    bool reflex;   /* the solid bends inward here */
    bool flat;     /* both faces lie in one plane */
} tl_half_edge;

typedef struct tl_solid_face {
    uint32_t first; /* half-edge of the loop around */
    uint32_t plane;
    bool turned; /* the outward normal is the opposite of the plane's */
    bool inside; /* lies between pieces: made by a cut */
    tl_tag tag;
    uint32_t piece;
    uint32_t shell;
    uint32_t slot;  /* scratch: its place among the faces near a plane */
    uint32_t mark;  /* scratch: `stamp` when it was met last */
    tl_vec3 center; /* of a ball that holds it */
    double radius;
} tl_solid_face;

typedef struct tl_solid_piece {
    uint32_t *face, faces, face_capacity; /* and some that have gone to other pieces */
    uint32_t *reflex, reflexes,
        reflex_capacity; /* the older half-edge of each reflex edge, and of some that are none any more */
} tl_solid_piece;

typedef struct tl_solid_shell {
    uint32_t face; /* one of it */
    bool apart;    /* a cavity that no cut has reached: its piece has other shells */
} tl_solid_shell;

typedef struct tl_solid_mesh {
    tl_vec3 *vertex;
    double *height;        /* [vertices] scratch: above the plane of a section */
    int8_t *side;          /* [vertices] scratch: -1 below, 0 on, 1 above */
    uint32_t *vertex_mark; /* [vertices] scratch */
    uint32_t vertices, vertex_capacity;
    tl_half_edge *half;
    uint32_t *cross;     /* [half-edges] scratch: number of the crossing with a plane */
    uint32_t *half_mark; /* [half-edges] scratch */
    uint32_t halves, half_capacity;
    tl_solid_face *face;
    uint32_t faces, face_capacity;
    tl_plane *plane;
    uint32_t planes, plane_capacity;
    uint32_t *bisector; /* [first halves] plane midway between the faces of a reflex edge; half-edges that are split off
                           have that of their origin */
    tl_solid_piece *piece;
    uint32_t pieces, piece_capacity;
    tl_solid_shell *shell;
    uint32_t shells, shell_capacity;
    uint32_t stamp;
    double on;   /* m: a point nearer to a plane lies on it */
    double size; /* m: diagonal of the bounds */
    double volume;
    tl_vec3 center; /* centroid */
    tl_vec3 place;  /* added to coordinates in messages */
} tl_solid_mesh;

static inline uint32_t tl_half_to(const tl_solid_mesh *m, uint32_t h)
{
    return m->half[m->half[h].next].from;
}

/* A vertex as messages give it. */
static inline tl_vec3 tl_solid_shown(const tl_solid_mesh *m, uint32_t vertex)
{
    const tl_vec3 x = m->vertex[vertex];
    return (tl_vec3){x.x + m->place.x, x.y + m->place.y, x.z + m->place.z};
}

/* The outward normal of a face. */
static inline tl_vec3 tl_solid_normal(const tl_solid_mesh *m, uint32_t face)
{
    const tl_vec3 n = m->plane[m->face[face].plane].normal;
    return m->face[face].turned ? (tl_vec3){-n.x, -n.y, -n.z} : n;
}

/* A loop over the half-edges of a face: `h` is each of them, `first` the first one of its loop. */
#define TL_EACH_HALF(m, face_number, h, first)                                                                         \
    for (uint32_t first = (m)->face[face_number].first, h = first, round_ = 0; first != TL_SOLID_NONE;                 \
         h = (m)->half[h].next, round_ = h == first, first = round_ ? (m)->half[first].ring : first,                   \
                  h = round_ ? first : h)

/* Makes room for one more; false without memory. */
bool tl_solid_grow(void *list, uint32_t *capacity, uint32_t count, size_t bytes);
bool tl_solid_add_vertex(tl_solid_mesh *m, tl_vec3 at, uint32_t *vertex);
bool tl_solid_add_half(tl_solid_mesh *m, tl_half_edge edge, uint32_t *half);
bool tl_solid_add_face(tl_solid_mesh *m, tl_solid_face face, uint32_t *added);
bool tl_solid_add_plane(tl_solid_mesh *m, tl_plane plane, uint32_t *added);
bool tl_solid_add_piece(tl_solid_mesh *m, uint32_t *added);
bool tl_piece_add_face(tl_solid_piece *p, uint32_t face);
/* Forgets faces that have gone to other pieces; gives the number of the others. */
uint32_t tl_piece_compact(tl_solid_mesh *m, uint32_t piece);
bool tl_piece_add_reflex(tl_solid_piece *p, uint32_t half);
void tl_solid_free(tl_solid_mesh *m);
/* A stamp that no mark has. */
uint32_t tl_solid_stamp(tl_solid_mesh *m);
/* Finds the ball of a face. */
void tl_solid_find_ball(tl_solid_mesh *m, uint32_t face);
/* Twice the vector area of a loop. */
tl_vec3 tl_solid_loop_area(const tl_solid_mesh *m, uint32_t first);
/* 1 inside the loop, -1 outside, 0 within `on` of it; seen along the normal, turning as it does. */
int tl_solid_in_loop(const tl_solid_mesh *m, uint32_t first, tl_vec3 normal, tl_vec3 at);
/* 1 inside a face, -1 outside, 0 within `on` of its loops. */
int tl_solid_in_face(const tl_solid_mesh *m, uint32_t face, tl_vec3 at);
/* How often the faces of a list go round a point off them. */
int tl_solid_winding(const tl_solid_mesh *m, const uint32_t *face, size_t count, tl_vec3 at);

#endif
