/* field_faces.h - the planes of two blocks that a pressure field is integrated between (field.h). */
#ifndef TL_NARROW_FIELD_FACES_H
#define TL_NARROW_FIELD_FACES_H

#include <stdbool.h>
#include <stdint.h>
#include <talus/types.h>

/* The planes that bound K, in this order: faces of A, faces of B, borders of A, borders of B. Others may be among them. Of
 * blocks that overlap a face may be left out that lies wholly outside one face of the other block. With a border all faces
 * are needed, for beyond it the nearest need not bound K. Of blocks that are apart the faces left may still enclose
 * something: the deepest point is then not in both blocks. */
typedef struct tl_field_faces {
    uint32_t a, b, border_a, border_b; /* how many of each */
    uint32_t seam_a,
        seam_b;       /* so many borders, the last of A's and of B's, are seams to other parts */
    double *n[3], *c; /* [all of them] */
    /* Bits of the faces that bounded K at another time, or 0; NULL: nobody keeps them. They are of use without borders and for
     * up to TL_FIELD_KNOWN faces. They must have been all, and must be forgotten when a corner of one block has come to lie in
     * the other and on or beyond a face that is not among them. The function leaves those that bound K. */
    uint64_t *bounding;
    bool energy_only; /* the volume is not wanted, nor found where it costs more */
} tl_field_faces;

#define TL_FIELD_KNOWN 64

static inline tl_vec3 tl_field_normal(const tl_field_faces *f, uint32_t face)
{
    return (tl_vec3){f->n[0][face], f->n[1][face], f->n[2][face]};
}

#endif
