/* narrow.h - what the geometry of a pair works in and finds, and the rule it goes by. */
#ifndef TL_NARROW_NARROW_H
#define TL_NARROW_NARROW_H

#include "narrow/corner.h"
#include "narrow/facet.h"
#include "narrow/field.h"
#include "narrow/view.h"

/* Integrals over the common volume for a law that is not linear: of 1, of d^2 and of d^3. That of d is the energy. */
enum { TL_PRESS_VOLUME, TL_PRESS_SQUARE, TL_PRESS_CUBE, TL_PRESS_POWERS };

/* In A's frame, for a stiffness 2 kn of 1: energy, m^4, and force on B, m^3, with its moment about the origin, m^4. */
typedef struct tl_press {
    double energy;
    tl_vec3 force, moment;
    double lifted;    /* what `opened` of the query has added to the energy, m^4 */
    double area;      /* on which it acts, m^2 */
    double overlap;   /* 2 |force| / area, m: that of flush faces of that area */
    double deepest;   /* largest overlap, m */
    double radius;    /* of gyration of the area, m */
    double stiffness; /* over kn, m^2 */
    double patch;     /* share of the patch: 1 .. 0 */
    tl_vec3 point;    /* centre of the pressure */
    tl_vec3 normal;   /* force / |force| */
    bool powers;      /* the powers of its tl_press_extra are known */
} tl_press;

/* What few presses have besides; it is found and copied only with those that have it. */
typedef struct tl_press_extra {
    /* of a law that is not linear: integrals with minus their gradients, as the force is that of the energy */
    tl_field_power powers[TL_PRESS_POWERS];
    /* where `lifted` is not 0, what `opened` of the query has added: to those; to force and moment */
    double lifted_powers[TL_PRESS_POWERS];
    tl_vec3 lifted_force, lifted_moment;
} tl_press_extra;

/* Whether a press has something besides. */
static inline bool tl_press_has_extra(const tl_press *press)
{
    return press->powers || press->lifted != 0;
}

/* The contact points of one pair, as one geometric evaluation finds them. */
typedef struct tl_manifold {
    tl_facet facet;
    tl_contact_point *points;
    size_t point_count, point_capacity;
    const tl_press *press; /* of a field */
    const tl_press_extra *extra;
    double valid; /* way that the pair may move before the kind and the faces are chosen anew */
    bool failed;  /* out of memory */
} tl_manifold;

/* The outlines of two faces in the plane of their patch, and the polygon that one clips from the other. */
typedef struct tl_outlines {
    tl_point2 *face, *clip; /* of A's face and of B's, counter-clockwise; one allocation */
    tl_corner *corner;      /* memory of both lists */
    tl_corner *now, *next;  /* the polygon's corners; and where the next cut puts them */
    size_t corner_capacity, face_capacity;
} tl_outlines;

/* Scratch memory of a thread for the narrow phase. */
typedef struct tl_narrow_scratch {
    tl_vec3 *vertex_b, *normal_b;
    size_t vertex_capacity, normal_capacity;
    double *corner; /* corner_sums.c */
    size_t corner_capacity;
    tl_outlines outlines;         /* common_polygon.c */
    struct tl_patch_batch *batch; /* patch_batch.c */
    tl_patch_points patch;
    tl_manifold manifold;
    tl_press found; /* of a pair that is looked at alone */
    tl_press_extra extra;
    bool failed;              /* out of memory, in a phase that cannot say so */
    bool reframed;            /* the places of old points are in frames that are no more */
    bool deep;                /* met a contact whose blocks overlap too deeply: overlap.c */
    struct tl_old_point *old; /* transfer.c */
    struct tl_ring_cell *cell;
    size_t old_capacity, cell_capacity;
    double *plane, *press; /* region.c, press.c */
    uint16_t *face;        /* of a region */
    size_t plane_capacity, press_capacity, face_capacity;
    tl_field_scratch field;
} tl_narrow_scratch;

/* How a pair is to touch. */
typedef struct tl_touch_rule {
    double min_area;     /* of a field contact, m2 */
    bool corners;        /* points of patches at corners only */
    bool volumes, opens; /* of field contacts: see tl_press_query */
    double reach;        /* patches with every gap beyond this are left out */
} tl_touch_rule;

/* Frees what the scratch memory holds, not the struct. */
void tl_narrow_scratch_free(tl_narrow_scratch *scratch);
/* Makes room for `count` points more; false when out of memory. */
bool tl_manifold_reserve(tl_manifold *m, size_t count);

/* Fills vertex_b and normal_b of views, until any are filled anew; false when out of memory. */
bool tl_pairs_place(tl_pair_view view[], uint32_t count, tl_narrow_scratch *scratch);
bool tl_pair_place(tl_pair_view *view, tl_narrow_scratch *scratch);
/* The same with nothing filled yet; and then some normals, or all. */
bool tl_pairs_reserve(tl_pair_view view[], uint32_t count, tl_narrow_scratch *scratch);
void tl_pair_place_normals(const tl_pair_view *view, const uint16_t *face, uint32_t count);
void tl_pair_place_all(const tl_pair_view *view);

#endif
