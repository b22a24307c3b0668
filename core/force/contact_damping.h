/* contact_damping.h - damping of contacts in proportion to their stiffness, point by point. */
#ifndef TL_FORCE_CONTACT_DAMPING_H
#define TL_FORCE_CONTACT_DAMPING_H

#include "contact/layout.h"
#include "contact/tables.h"
#include "model/model.h"

struct tl_group_sums;

/* What points carry before their law is called, as columns beside each other. */
typedef struct tl_point_forces {
    double *normal, *shear[3]; /* N */
} tl_point_forces;

/* Notes what `count` points of the tables carry, from a row on. */
void tl_damping_note(const double *f_n, double *const f_s[3], size_t first, size_t count, const tl_point_forces *to);

/* Points of one law after it was called: columns of `count` entries. */
typedef struct tl_damped_points {
    size_t count;
    const double *area, *f_n, *f_s[3], *du_n, *du_s[3];
    const uint32_t *flags;
} tl_damped_points;

/* Replaces the forces before the law by the damping forces on B. `rate`: beta over the last step. */
void tl_damping_of_points(const tl_law *law, const tl_damped_points *of, double rate, const tl_point_forces *forces);

#endif
