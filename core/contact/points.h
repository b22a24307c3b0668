/* points.h - contact points: cleared, and the states of their law (points.c). */
#ifndef TL_CONTACT_POINTS_H
#define TL_CONTACT_POINTS_H

#include "contact/old_point.h"
#include "contact/tables.h"

/* A point without force, area or place: an inert lane. */
void tl_point_clear(tl_points_table *p, size_t point);
/* Point k of a contact, at an arm, as one that new points take over from. */
tl_old_point tl_point_as_old(const tl_points_table *points, const tl_contacts *contacts,
                             uint32_t contact, size_t k, tl_vec3 arm);
/* Gives a point the traction of a stress, tension positive, as its initial force: its closure, and what slip has opened, count from
 * now. n from A to B. */
void tl_point_load(tl_points_table *points, size_t point, const tl_sym3 *stress, tl_vec3 n,
                   double closure, double opening);
/* The law's states of a point, at their initial values, or taken from an old point of some area. */
void tl_point_initial_state(tl_points_table *p, size_t point, const tl_kind *kind);
void tl_point_begin(tl_points_table *p, size_t point, const tl_kind *kind); /* and no flags */
void tl_point_take_state(tl_points_table *p, size_t point, const tl_kind *kind, const double *old,
                         double old_area);
/* The same for a point that keeps its place: what is reset on a change of polygon stays. */
void tl_point_keep_state(tl_points_table *p, size_t point, const tl_kind *kind, const double *old,
                         double old_area);
/* Sets the vectors among a point's states to 0. */
void tl_point_clear_vectors(tl_points_table *points, size_t point, const tl_kind *kind);
/* Turns the vectors among a point's states with its normal, from the old one into the plane of the new. */
void tl_point_turn_states(tl_points_table *points, size_t point, const tl_kind *kind, tl_vec3 from,
                          tl_vec3 to);
/* Columns of the states of a kind of law. */
uint32_t tl_kind_state_columns(const tl_kind *kind);
/* Makes sure that one table of points has that many state columns; false when out of memory (nothing changed). Both
 * tables need the same: tl_detect_hold_states. */
bool tl_points_hold_states(tl_points_table *points, uint32_t columns);
/* The same for initial forces and the overlaps they belong to. */
bool tl_points_hold_initial(tl_points_table *points);
/* State descriptor k of a kind. */
const tl_state *tl_kind_state(const tl_kind *kind, uint32_t k);

#endif
