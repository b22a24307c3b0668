/* old_point.h - contact points that new ones take over from, of a contact whose polygon has changed or whose
 * block was cut. */
#ifndef TL_CONTACT_OLD_POINT_H
#define TL_CONTACT_OLD_POINT_H

#include <talus/plugin.h>

/* Columns of what a point carries by its place: shear stress, normal stress, initial normal stress, reference,
 * states. */
enum { TL_OLD_SHEAR, TL_OLD_NORMAL = 3, TL_OLD_INITIAL, TL_OLD_REFERENCE, TL_OLD_STATES };
#define TL_OLD_COLUMNS (TL_OLD_STATES + TL_STATE_COLUMNS)

/* Stresses, and what the law keeps. Axes of the model. */
typedef struct tl_old_point {
    tl_vec3 arm; /* from A's centroid; of a cut contact from the model's origin */
    tl_vec3 normal;
    double area;
    union {
        struct {
            tl_vec3 shear;
            double f_n; /* normal stress */
            /* Initial normal stress, and the overlap that it belongs to; of a cut contact this less what slip
             * has opened. */
            double n0, reference;
            double state[TL_STATE_COLUMNS];
        };
        double column[TL_OLD_COLUMNS];
    };
    double closure; /* of a cut contact: overlap less reference, m */
    uint32_t key, flags;
} tl_old_point;

/* What points carry together: their area and their shear, on B. */
typedef struct tl_shear {
    double area, energy;    /* of the springs, times 2 ks */
    tl_vec3 force, moment;  /* about where the arms begin */
    tl_vec3 centre, normal; /* of the area */
    double torsion, polar;  /* about the normal through the centre: moment of the force, second moment of the area */
} tl_shear;

/* What a patch would have carried in the next step, in six numbers, N. Three tell what it would have pressed
 * with: the force along its normal, and the moments along two directions. Three tell its shear: the forces
 * along both, and the torsion. */
enum { TL_NEXT_PRESS = 3, TL_NEXT_SUMS = 6 };

typedef struct tl_next_step {
    tl_vec3 along[2]; /* unit vectors in the plane */
    double most;      /* sum of the magnitudes of its points' forces, N; 0: not known */
    double sum[TL_NEXT_SUMS];
} tl_next_step;

/* What a contact of a block that was cut has left: its points from `first` on in a list of all such. Of a field
 * contact there is one, at the centre of its pressure. */
typedef struct tl_cut_contact {
    tl_id a, b; /* its blocks, a < b */
    uint32_t law, count;
    uint64_t first;
    /* Outward normals of the faces of a and of b, of a field contact of those that are moved out. */
    tl_vec3 face[2];
    double overlap; /* of these at its first point where they lie, m */
    double shift;   /* how far an initial stress and slip move them out, m */
    double kept;    /* energy of shear beyond the springs, J */
    tl_shear whole; /* from the model's origin */
    tl_shear taken; /* by the contacts of the parts: area, force and energy */
    tl_next_step next;
    uint8_t field;
    uint8_t holds_over_gap; /* of a patch */
    uint8_t pressed;        /* of a patch: a force acted in the last step */
    uint8_t reframed;       /* places of its points are in frames that are no more */
} tl_cut_contact;

#endif
