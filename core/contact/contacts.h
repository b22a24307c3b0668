/* contacts.h - the tables of contacts and contact points, and how they are laid out. */
#ifndef TL_CONTACT_CONTACTS_H
#define TL_CONTACT_CONTACTS_H

#include "contact/detection.h"
#include "contact/law_states.h"
#include "contact/layout.h"
#include "contact/old_point.h"
#include "contact/sides.h"
#include "contact/tables.h"
#include "model/model.h"

/* Adds a contact of a kind to a pair, without points, wanting room for some, whose faces hold for a path length of
 * `valid`; false when out of memory. */
bool tl_contact_append(tl_model *m, uint32_t pair, uint32_t kind, double valid, tl_tag tag, size_t want_points);
/* Lays contacts and points out anew: without those with TL_PENDING_DIE, sorted by joint law and blocks,
 * each with the room it wants at least. */
tl_status tl_contacts_repack(tl_model *m);
/* Gives back the room that contacts came from when they were laid out anew last, once the layout has lasted. */
void tl_contacts_free_spare(tl_detect *d, int64_t cycles);
/* The points of a contact begin under a law. Walls that are apart and do not pull on each other are not bonded by
 * it. */
void tl_contact_begin_law(tl_model *m, uint32_t contact, const tl_kind *kind, const tl_point_lanes *lanes);
/* Moves the points of contacts with something pending to lanes with the room they want, in their spans. Spans that
 * contacts under another law lack are added behind the others. false when there is no room: lay all out anew. */
bool tl_contacts_place(tl_detect *d, int64_t cycles);
/* Whether contacts that have moved to added spans have left so many lanes empty, for so long, that laying out anew
 * would have cost less. */
bool tl_contacts_scattered(const tl_detect *d, int64_t cycles);
/* Takes a contact out; the last one gets its row. */
void tl_contact_remove(tl_detect *d, uint32_t contact);
/* Index of the law that rules a contact of this tag between the blocks of two rows, or TL_NO_ROW. */
uint32_t tl_law_row(const tl_model *m, tl_tag tag, uint32_t a, uint32_t b);
/* The kind of a joint law; NULL without one. */
static inline const tl_kind *tl_law_kind(const tl_model *m, uint32_t law)
{
    return law == TL_NO_ROW ? NULL : m->joint_laws[law].kind;
}
/* "contact of blocks 3 and 7, joint J1:2" */
void tl_contact_describe(tl_model *m, uint32_t contact, char *text, size_t size);

/* A point without force, area or place: an inert lane. */
void tl_point_clear(tl_points_table *p, size_t point);
/* Gives a point another area: its stresses stay. */
void tl_point_resize(tl_points_table *points, size_t point, double area);
/* Point k of a contact, at an arm, as one that new points take over from. */
tl_old_point tl_point_as_old(const tl_points_table *points, const tl_contacts *contacts, uint32_t contact, size_t k,
                             tl_vec3 arm);
/* The law's states of a point, at their initial values. */
void tl_point_initial_state(tl_points_table *p, size_t point, const tl_kind *kind);
/* The same taken from an old point of some area. With `stays` the point keeps its place: what a change of polygon
 * resets goes on. Energies go by their sum: tl_shear_keep. */
void tl_point_take_state(tl_points_table *p, size_t point, const tl_kind *kind, const double *old, double old_area,
                         bool stays);
/* Turns a vector in the plane of a normal into that of another. */
static inline tl_vec3 tl_into_plane(tl_vec3 v, tl_vec3 from, tl_vec3 to)
{
    v = tl_v3_turn(v, from, to);
    return tl_v3_madd(v, -tl_v3_dot(v, to), to);
}
/* The same for the vectors among a point's states. */
void tl_states_turn(const tl_kind *kind, uint32_t columns, double *state, tl_vec3 from, tl_vec3 to);
/* A free row for what a field contact keeps; TL_NO_ROW when out of memory. */
uint32_t tl_press_take(tl_detect *d);

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
