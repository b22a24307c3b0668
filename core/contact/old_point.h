/* old_point.h - contact points that new ones take over from: of a contact whose polygon has changed, or of one that has ended
 * because a block of it was cut. */
#ifndef TL_CONTACT_OLD_POINT_H
#define TL_CONTACT_OLD_POINT_H

#include <stdbool.h>
#include <talus/plugin.h>

/* Stresses, and what the law keeps. Axes of the model. */
typedef struct tl_old_point {
    tl_vec3 arm; /* from A's centroid; of one of an estate from the model's origin */
    tl_vec3 normal, shear;
    double area, f_n; /* f_n: normal stress */
    /* Initial normal stress, and the overlap that it belongs to; of one of an estate this less what slip has opened. */
    double n0, reference;
    double state[TL_STATE_COLUMNS];
    double closure; /* of one of an estate: overlap less reference, m */
    uint32_t key, flags;
} tl_old_point;

/* Shear of points: on B. */
typedef struct tl_heritage {
    double area, energy; /* of the springs, times 2 ks */
    tl_vec3 force;
} tl_heritage;

/* What a patch would have carried in the next step, in six numbers, N: what it would have pressed with, force along its normal and what tells of
 * the moments along two directions; and its shear, forces along both and torsion. */
enum { TL_CARRIED_PRESS = 3, TL_CARRIED = 6 };

typedef struct tl_carried {
    tl_vec3 centre;
    tl_vec3 normal, along[2]; /* unit vectors */
    double area;              /* m2 */
    double most,
        energy; /* sum of the magnitudes of its points' forces, N, 0: not known; of its shear springs, times 2 ks */
    double sum[TL_CARRIED];
} tl_carried;

/* What a contact of a block that was cut has left: its points from `first` on in a list of all such. Of a field contact there is
 * one, at the centre of its pressure. */
typedef struct tl_estate {
    tl_id a, b; /* its blocks, a < b */
    uint32_t law, count;
    uint64_t first;
    /* Outward normals of the faces of a and of b, of a field contact of those that are moved out; by how much they overlap at its
     * first point where they lie, and how far an initial stress and slip move them out, m. */
    tl_vec3 face[2];
    double overlap, shift;
    double torsion, energy; /* of a field contact: about its normal; of its springs, times 2 ks */
    tl_heritage taken;      /* by the patches of the parts */
    tl_carried carried;     /* by a patch */
    uint8_t field;
    uint8_t holds_over_gap;
    uint8_t pressed;  /* a force acted in the last step */
    uint8_t reframed; /* places of its points are in frames that are no more */
} tl_estate;

#endif
