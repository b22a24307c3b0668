/* contacts.h - the tables of contacts and contact points, and how they are laid out. */
#ifndef TL_CONTACT_CONTACTS_H
#define TL_CONTACT_CONTACTS_H

#include "contact/detection.h"
#include "contact/law_states.h"
#include "contact/layout.h"
#include "contact/old_point.h"
#include "contact/tables.h"
#include "model/model.h"

void tl_contacts_init(tl_contacts *contacts, tl_points_table *points);
void tl_point_lanes_init(tl_point_lanes *lanes);
/* Gives the threads' lanes room for `capacity` points; false when out of memory. */
bool tl_detect_hold_lanes(tl_detect *d, size_t capacity);
/* The same for a tile, or the largest SIMD group of a layout, for every thread. */
bool tl_detect_make_lanes(tl_detect *d, const tl_layout *layout);
/* Adds a contact of a kind to a pair, without points, wanting room for some, whose faces hold for a path length of `valid`;
 * false when out of memory. */
bool tl_contact_append(tl_model *m, uint32_t pair, uint32_t kind, double valid, tl_tag tag,
                       size_t want_points);
/* Lays contacts and points out anew: without those with TL_PENDING_DIE, sorted by joint law and blocks,
 * each with the room it wants at least. */
tl_status tl_contacts_repack(tl_model *m);
/* Gives back the room that contacts came from when they were laid out anew last, once the layout has lasted. */
void tl_contacts_free_spare(tl_detect *d, int64_t cycles);
/* The points of a contact begin under a law. Walls that are apart and do not pull on each other are not bonded by it. */
void tl_contact_begin_law(tl_model *m, uint32_t contact, const tl_kind *kind,
                          const tl_point_lanes *lanes);
/* Moves a contact's points, if it has or wants any, to a lane with the room it wants, in its span;
 * false when there is none: lay all out anew. */
bool tl_contact_place(tl_detect *d, uint32_t contact);
/* Takes a contact out; the last one gets its row. */
void tl_contact_remove(tl_detect *d, uint32_t contact);
/* Index of the joint law that rules a tag, or TL_NO_ROW. */
uint32_t tl_law_row(const tl_model *m, tl_tag tag);
/* The kind of a joint law; NULL without one. */
static inline const tl_kind *tl_law_kind(const tl_model *m, uint32_t law)
{
    return law == TL_NO_ROW ? NULL : m->joint_laws[law].kind;
}
/* "contact of blocks 3 and 7, joint J1:2" */
void tl_contact_name(tl_model *m, uint32_t contact, char *text, size_t size);
/* Moment of a contact's forces on A, or on B, about that block's body's centroid. */
static inline tl_vec3 tl_contact_moment(const tl_model *m, uint32_t contact, bool on_b)
{
    const tl_contacts *c = &m->detect->contacts;
    if (!on_b)
        return tl_v3_neg(c->moment[contact]);
    tl_vec3 apart =
        tl_body_apart(&m->bodies, m->blocks.body[c->a[contact]], m->blocks.body[c->b[contact]]);
    return tl_v3_sub(c->moment[contact], tl_v3_cross(apart, c->force[contact]));
}

/* `need` and one in `share` more, or `least` more. */
static inline size_t tl_with_spare(size_t need, size_t share, size_t least)
{
    size_t more = need / share;
    return need + (more > least ? more : least);
}

/* Gives contacts that are sorted by spans their lanes in an empty layout: sets the start and room of each by the
 * room it wants, with one in `share` to spare; *points is the number of rows. false when out of memory. */
bool tl_layout_make(tl_layout *layout, tl_contacts *contacts, size_t share, size_t *points);
void tl_layout_free(tl_layout *layout);
/* A free lane of a contact's span with room for so many points, taken for it; NULL when there is none. */
tl_simd_group *tl_simd_group_take(tl_detect *d, uint32_t points, uint32_t contact, uint32_t *lane);
/* Notes that a contact's lane belongs to that row, or to none. */
void tl_simd_group_note(tl_detect *d, uint32_t contact, uint32_t row);

/* A point without force, area or place: an inert lane. */
void tl_point_clear(tl_points_table *p, size_t point);
/* Point k of a contact, at an arm, as one that new points take over from. */
tl_old_point tl_point_as_old(const tl_points_table *points, const tl_contacts *contacts,
                             uint32_t contact, size_t k, tl_vec3 arm);
/* Gives a point the traction of a stress, tension positive, as its initial force: its closure, and what slip has opened, count from
 * now. n from A to B. */
void tl_point_load(tl_points_table *points, size_t point, const tl_sym3 *stress, tl_vec3 n,
                   double closure, double opening);
/* The law's states of a point, at their initial values. */
void tl_point_initial_state(tl_points_table *p, size_t point, const tl_kind *kind);
/* The same taken from an old point of some area. With `stays` the point keeps its place: what a change of polygon resets
 * goes on. Energies go by their sum: tl_shear_keep. */
void tl_point_take_state(tl_points_table *p, size_t point, const tl_kind *kind, const double *old,
                         double old_area, bool stays);
/* Turns a vector in the plane of a normal into that of another. */
tl_vec3 tl_into_plane(tl_vec3 v, tl_vec3 from, tl_vec3 to);
/* The same for the vectors among a point's states. */
void tl_states_turn(const tl_kind *kind, uint32_t columns, double *state, tl_vec3 from, tl_vec3 to);
/* Makes sure that one table of points has that many state columns; false when out of memory (nothing changed). Both
 * tables need the same: tl_detect_hold_states. */
bool tl_points_hold_states(tl_points_table *points, uint32_t columns);
/* The same for initial forces and the overlaps they belong to. */
bool tl_points_hold_initial(tl_points_table *points);

/* Whether the bodies of two blocks are held still. */
bool tl_blocks_held_still(const tl_model *m, uint32_t a, uint32_t b);
/* Notes which contacts are between bodies that are held still, and wakes their spans. */
void tl_held_sort(tl_model *m);
/* All such contacts are followed again, until they are found to rest. */
void tl_held_wake(tl_model *m);
/* After a step whose laws have not failed: which spans rest from now on. */
void tl_held_followed(tl_model *m);
/* Whether a span is passed over. */
static inline bool tl_span_rests(const tl_model *m, const tl_span *span)
{
    return span->rest == TL_SPAN_RESTS && m->config.reuse_geometry;
}

#endif
