/* solid_section.h - the section of a piece by a plane: what solid_section.c finds and solid_cut.c makes a cut of. */
#ifndef TL_GEOMETRY_SOLID_SECTION_H
#define TL_GEOMETRY_SOLID_SECTION_H

#include "geometry/solid_mesh.h"

/* An edge that the plane crosses between its ends. As a node of the section it has the number of vertices + its own. */
typedef struct tl_crossing {
    tl_vec3 at;
    uint32_t half;
    uint32_t vertex; /* once the edge is divided */
} tl_crossing;

/* Where the line of the plane in a face enters or leaves the face. */
typedef struct tl_line_end {
    double along;  /* m: on the line */
    uint32_t half; /* crossed, or the one that begins at a vertex on the plane */
    bool crosses;
    bool starts;     /* the face lies after it on the line */
    bool from_below; /* the half-edge leads below: where the line ends here, too, that end is the nearer one */
} tl_line_end;

/* A stretch of the line within a face. */
typedef struct tl_span {
    uint32_t face;
    tl_line_end start, end;
    uint32_t first_rim; /* its rims: this one below, the next one above */
    uint32_t made;      /* half-edge from its end to its start, of the part of the face above */
} tl_span;

/* A half-edge of the new face of one side. The sides are 0 below and 1 above. */
typedef struct tl_rim {
    uint32_t from, to; /* nodes */
    uint32_t next;
    uint32_t root;   /* union: of the part of the section */
    uint32_t origin; /* the span, or the half-edge on the plane whose mate it becomes */
    uint32_t loop;
    uint32_t made; /* half-edge */
    uint8_t above;
    bool of_span;
} tl_rim;

typedef struct tl_rim_loop {
    uint32_t first; /* rim */
    uint32_t in;    /* the loop around it on its side; its own number: it goes around; none */
    double area;    /* m2: > 0 for a loop around */
    double low[2], high[2];
} tl_rim_loop;

typedef struct tl_section {
    uint32_t piece, plane;
    uint32_t *face, faces, face_capacity; /* near the plane */
    uint8_t *lies;                        /* [faces] all of the face lies on it */
    uint32_t lies_capacity;
    tl_line_end *end;
    uint32_t ends, end_capacity;
    tl_span *span;
    uint32_t spans, span_capacity;
    tl_crossing *crossing;
    uint32_t crossings, crossing_capacity;
    tl_rim *rim;
    uint32_t rims, rim_capacity;
    uint64_t *key; /* rims by side and first node */
    uint32_t keys, key_capacity;
    tl_rim_loop *loop;
    uint32_t loops, loop_capacity;
    struct tl_part_score *score;
    uint32_t score_capacity;
    tl_vec3 t1, t2; /* in the plane */
} tl_section;

/* A cut of a piece: by a plane, over the part of the section that hangs together with a reflex edge. */
typedef struct tl_solid_cut {
    uint32_t plane;
    uint32_t edge; /* none: a cut of a convex piece */
    int32_t gain;  /* reflex edges that it ends less those that it cuts in two */
    bool thin;     /* makes a sharp wedge or a short edge */
    double area;   /* m2 */
    double length; /* m: from the centroid of the solid to that of the cut */
    double
        thickness; /* the least: sine of the angle of a wedge that it leaves; once tried: of pieces, over their sizes */
    bool refused;  /* it was tried, and left thin pieces */
} tl_solid_cut;

typedef struct tl_solid_cuts {
    tl_solid_cut *cut;
    uint32_t count, capacity;
} tl_solid_cuts;

tl_section *tl_section_new(void);
void tl_section_free(tl_section *s);
/* Adds the cuts of a piece by a plane; false without memory. */
bool tl_section_cuts(tl_section *s, tl_solid_mesh *m, uint32_t piece, uint32_t plane, tl_solid_cuts *cuts);
bool tl_solid_cut_better(const tl_solid_cut *a, const tl_solid_cut *b);
/* Finds the section of a piece; false without memory. *sound: its loops close. */
bool tl_section_make(tl_section *s, tl_solid_mesh *m, uint32_t piece, uint32_t plane, bool *sound);
/* The name of the part of the section that a rim belongs to. */
uint32_t tl_section_part(tl_section *s, uint32_t rim);
tl_vec3 tl_section_node(const tl_section *s, const tl_solid_mesh *m, uint32_t node);

#endif
