/* arcs.h - the heavy loops in the search of a pair's axis (arcs.c). */
#ifndef TL_NARROW_ARCS_H
#define TL_NARROW_ARCS_H

#include "narrow/view.h"

/* Edges of B that are looked at together: a bit each. */
#define TL_ARCS_ROW 64

/* One block's vertices over the other's faces. */
typedef struct tl_over {
    uint32_t vertices, faces;
    size_t lanes;    /* faces, and some that are none */
    double *along;   /* [vertices][lanes] along each face's normal */
    double *low;     /* [lanes] the lowest */
    double *offset;  /* [lanes] of the faces */
    uint64_t *under; /* [lanes] vertices that lie deep under the face, a bit each */
} tl_over;

/* The edges whose axes may have an s above `least`, and room for rows. */
typedef struct tl_arcs {
    const tl_pair_view *view;
    double least;
    uint16_t *a, *b;
    size_t a_count, b_count;
    uint64_t *rows;
    double *columns;
} tl_arcs;

/* Numbers that a search needs room for. */
size_t tl_arcs_room(const tl_poly *a, const tl_poly *b);
/* B's vertices over A's faces (`on_a`), and A's over B's; what is left of the room. */
double *tl_over_faces(const tl_pair_view *view, double *room, tl_over *on_a, tl_over *on_b);
/* The edges left when those are gone whose axes' s is no more than `least` for certain; without those of seams for
 * `walls`. */
tl_arcs tl_arcs_begin(const tl_pair_view *view, const tl_over *on_a, const tl_over *on_b,
                      bool walls, double least, double *room);
/* For each edge arcs->a[k] those of the TL_ARCS_ROW edges arcs->b[begin], ... whose arcs cross its own, and whose s may
 * be above `least`: a bit each. */
const uint64_t *tl_arcs_across(const tl_arcs *arcs, size_t begin);

#endif
