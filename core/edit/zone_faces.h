/* zone_faces.h - outer faces of deformable blocks: triangles that lie bare, and what is done to them. */
#ifndef TL_EDIT_ZONE_FACES_H
#define TL_EDIT_ZONE_FACES_H

#include "edit/face_filter.h"
#include "segment/meets.h"
#include "zone/zones.h"

/* What lies on what, where one of two blocks is deformable: sorted by block, face and part. */
typedef struct tl_covers {
    tl_cover *list;
    size_t count;
} tl_covers;

/* A triangle of a surface, the share of its area that lies bare, and integrals over that. */
typedef struct tl_bare_triangle {
    uint32_t part;
    double share;
    tl_bare bare;
} tl_bare_triangle;

/* Those of one face that are meant: [begin, end) of a list. Area, mean normal, and centroid from the origin. */
typedef struct tl_bare_face {
    size_t begin, end;
    double area;
    double left_out; /* area of triangles with the middle in the box that reach out of it, m2 */
    tl_vec3 normal, centroid;
} tl_bare_face;

typedef struct tl_bare_list {
    tl_bare_triangle *at;
    size_t count, capacity;
} tl_bare_list;

/* Finds the triangles of a face that are meant and lie bare. false: out of memory. */
bool tl_bare_find(const tl_model *m, const tl_face_filter *filter, const tl_covers *covers, uint32_t row, uint32_t face,
                  tl_bare_list *list, tl_bare_face *out);
/* What covers a face of a rigid block: [*begin, return) of the list. */
size_t tl_covers_of(const tl_covers *covers, uint32_t row, uint32_t face, size_t *begin);

/* Whether a level crosses a triangle that others cover in part. */
bool tl_bare_crosses(const tl_model *m, const tl_bare_triangle *bare, double level);

/* What is done to triangles, on its way. */
typedef struct tl_outer_list {
    tl_outer_part *at;
    size_t count, capacity;
} tl_outer_list;

/* Adds what an action does to the triangles of a face; `drive`: the number of its drive, or 0. Adds the force of its
 * load and, about {0, 0, 0}, its moment. false: out of memory. */
bool tl_bare_act(const tl_model *m, const tl_boundary_action *a, const tl_face_filter *filter, uint32_t drive,
                 uint32_t row, const tl_bare_list *list, const tl_bare_face *face, tl_outer_list *to,
                 tl_boundary_result *result);

#endif
