/* kind.h - kinds of contact: what differs between them, as tables of operations.
 *
 * The number of a kind is that of its facets (narrow/facet.h). What a module needs of a kind it asks of its table here;
 * the lists of detect/kinds.c say which kinds there are. A new kind is a file with such tables, and a line there. */
#ifndef TL_CONTACT_KIND_H
#define TL_CONTACT_KIND_H

#include "base/hash.h"
#include "contact/detection.h"
#include "contact/facing.h"
#include "contact/layout.h"
#include "contact/pair_view.h"
#include "model/contributor.h"
#include "narrow/manifold.h"
#include "narrow/surface.h"
#include "zone/grid.h"

/* The frames of a contact's two bodies: axes of the model, A's centroid as zero. */
typedef struct tl_body_frames {
    const tl_mat3 *ra, *rb;
    tl_vec3 d; /* from A's centroid to B's */
} tl_body_frames;

/* Where a contact is, what it bears, and what is kept and shown of it. */
typedef struct tl_kind_place {
    /* Its facet in the present place, and where points of A's frame are. */
    tl_facing (*facing)(const tl_facet *facet, const tl_body_frames *frames);
    tl_facing_place (*place)(const tl_facet *facet, const tl_body_frames *frames);
    /* How many of its points have an area of their own: the first ones. */
    uint32_t (*areas)(uint32_t points);
    /* For the time step: area, m2, as far as it counts, and its second moment about the centroid of A's side or of B's,
     * m4. `quick`: it is known at once. Of others the step first tries a bound, by their area alone. */
    tl_spread (*bounds)(const tl_model *m, uint32_t contact, bool of_b);
    bool quick;
    /* Where it presses, from A's centroid, and how far it is pressed in under a law of that stiffness. */
    double (*pressed)(const tl_model *m, uint32_t contact, double law, tl_vec3 *arm);
    /* Adds the polygons on which it acts, in A's frame. false: out of memory. */
    bool (*show)(tl_model *m, uint32_t contact, const tl_pair_view *view, tl_narrow_scratch *scratch,
                 tl_surface *surface);
    /* Whether points and faces that were read from a file are such a kind's; faces of its blocks. */
    bool (*sound)(const tl_detect *d, uint32_t contact, uint32_t faces_a, uint32_t faces_b);
    /* What it keeps beside its rows in the tables, if it has points or not. */
    void (*hash)(tl_hash *hash, const tl_detect *d, uint32_t contact);
} tl_kind_place;

struct tl_arms;
struct tl_group_sums;
struct tl_law;

/* From places to forces, for a SIMD group of contacts. */
typedef struct tl_kind_force {
    /* Its points have cells of the contact's area: they may be partly open, and have outermost fibres. */
    bool cells;
    /* Places, overlaps and motions of points, the first point's into lane `lane`. Turns shear forces, and the states of
     * which `tangents` has a bit, with the normals. */
    void (*follow)(tl_model *m, const tl_simd_group *group, const tl_point_lanes *lanes, size_t lane, uint32_t tangents,
                   struct tl_arms *arms);
    /* Force, moment and energies of each contact, of what the law has made of its points. */
    void (*sum)(const tl_model *m, const struct tl_law *law, const tl_simd_group *group, const tl_point_lanes *lanes,
                size_t lane, const struct tl_arms *arms, struct tl_group_sums *out);
    /* Likewise force and moment of the damping of their points, which is in the first four columns of `before`. */
    void (*damp)(const tl_model *m, const tl_simd_group *group, const tl_point_lanes *lanes, size_t lane,
                 const struct tl_arms *arms, struct tl_group_sums *out);
} tl_kind_force;

/* A contact that is found, and one whose points are to be others. */
typedef struct tl_kind_make {
    /* Whether contacts of two blocks are always of this kind; NULL: their shapes decide (narrow/manifold.c). `find`
     * then tells what they are in the present place, into the thread's manifold. false: out of memory. */
    bool (*claims)(const tl_model *m, uint32_t block_a, uint32_t block_b);
    bool (*find)(const tl_model *m, const tl_pair_view *view, tl_narrow_scratch *scratch);
    /* Puts the manifold in the place of a contact, which has the room for it. `stays`: its points are the same, and
     * have not run along the faces. false: out of memory. */
    bool (*take)(tl_model *m, uint32_t contact, bool stays, tl_narrow_scratch *scratch, const tl_point_lanes *lanes);
} tl_kind_make;

typedef struct tl_contact_kind {
    const char *name;
    const tl_kind_place *place;
    const tl_kind_force *force;
    const tl_kind_make *make;
} tl_contact_kind;

static inline const tl_contact_kind *tl_contact_kind_of(const tl_detect *d, uint32_t contact)
{
    return d->kinds[d->contacts.facet[contact].kind];
}

/* Facet and points of the contact of two blocks that have been placed, into the thread's manifold: tl_manifold_find,
 * unless a kind of contact claims them. false: out of memory. */
static inline bool tl_kind_find(const tl_model *m, uint32_t block_a, uint32_t block_b, const tl_pair_view *view,
                                const tl_region *region, const tl_touch_rule *rule, const tl_manifold_before *before,
                                tl_narrow_scratch *scratch)
{
    for (uint32_t k = 0; k < m->detect->kind_count; k++) {
        const tl_kind_make *make = m->detect->kinds[k]->make;
        if (make->claims && make->claims(m, block_a, block_b))
            return make->find(m, view, scratch);
    }
    const bool found = tl_manifold_find(view, region, rule, before, scratch);
    /* deformable blocks that lie flush meet by segments */
    if (found && tl_blocks_deform_either(m, block_a, block_b) &&
        (tl_blocks_meet(m, block_a, block_b) || !tl_facet_is_field(&scratch->manifold.facet)))
        scratch->manifold.point_count = 0;
    return found;
}

/* Points of a contact that have an area of their own. */
static inline uint32_t tl_contact_areas(const tl_detect *d, uint32_t contact)
{
    return tl_contact_kind_of(d, contact)->place->areas(d->contacts.point_count[contact]);
}

#endif
