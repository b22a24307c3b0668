/* transfer.h - new contact points in the place of old ones. */
#ifndef TL_CONTACT_TRANSFER_H
#define TL_CONTACT_TRANSFER_H

#include "contact/layout.h"
#include "model/model.h"
#include "narrow/narrow.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Puts the manifold's points in the place of the contact's, carrying over state so that total force
 * and moment follow the area; the points fit into the contact's room. */
bool tl_contact_transfer(tl_model *m, uint32_t contact, tl_narrow_scratch *scratch,
                         const tl_point_lanes *lanes);

/* The cell of a point: its share of the patch. That of the centroid lies inside; around it the others follow each other. */
typedef struct tl_ring_cell {
    double x, y, area; /* of the point, about the centroid of the patch */
    uint32_t point;
    bool inside;
    double share;    /* of the patch, or of what lies around the centroid */
    double turn;     /* direction of the point from the centroid, 0 to 4 */
    double swept;    /* share of the patch from the first cell's point to this one's */
    double from, to; /* where the cell begins and ends, as `swept` */
} tl_ring_cell;

/* Second moments of areas about their centroid: xx, xy, yy. */
typedef struct tl_ring_spread {
    double xx, xy, yy;
} tl_ring_spread;

/* Whether points span a plane; within about `place` of a line slopes would be quotients of rounding. */
static inline bool tl_ring_spans(const tl_ring_spread *i, double area, double place)
{
    return i->xx * i->yy - i->xy * i->xy > area * place * place * (i->xx + i->yy);
}

/* Tolerance: changes of a contact's area up to this part of it are rounding. */
#define TL_SAME_AREA 1e-12

/* The shear of all points of a contact. */
typedef struct tl_shear {
    double area, energy;   /* of the springs, times 2 ks */
    tl_vec3 force, moment; /* on B, about A's centroid */
} tl_shear;

/* Of a patch. */
tl_shear tl_shear_of(const tl_model *m, uint32_t contact);
/* After points have been given other areas, stresses as they were, which makes `now` of `before`. What comes into contact
 * brings no shear, and what goes takes its own with it: where the area has grown, the shear force is brought down to
 * what it was; the springs never have more energy than before. What they have less is heat. */
void tl_shear_resized(tl_model *m, uint32_t contact, const tl_shear *before, const tl_shear *now);

/* What shear holds beyond its springs, J: the sum of such a state of the law over the points of a contact. */
double tl_shear_kept(const tl_model *m, uint32_t contact);
/* Gives new points, whose state is 0, that sum: those of a patch by their areas, in a field contact the point of shear. Without points it is
 * heat. */
void tl_shear_keep(tl_model *m, uint32_t contact, double energy);

/* The motion of B against A in the last step: at an arm from A's centroid, `way` + `turn` x arm. */
typedef struct tl_contact_motion {
    tl_vec3 way, turn;
} tl_contact_motion;

tl_contact_motion tl_contact_moved(const tl_model *m, uint32_t contact);

#endif
