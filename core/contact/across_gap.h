/* across_gap.h - what contact points carry where their walls are apart: lifts by slip and initial forces, and bonds. */
#ifndef TL_CONTACT_ACROSS_GAP_H
#define TL_CONTACT_ACROSS_GAP_H

#include "contact/detection.h"
#include "model/model.h"

/* The lift, m, and the share of tension that is held, 0 to 1, of `count` points from row `first`, a multiple of
 * TL_LANES: see tl_law_ops. */
void tl_points_across_gap(const tl_law *law, const tl_points_table *points, size_t first, size_t count, double *lift,
                          double *hold);

/* The same of a contact. */
typedef struct tl_contact_across {
    double most; /* the largest lift from where its faces lie on each other, m; at least 0 */
    bool bonded; /* some point pulls */
    bool whole;  /* every point holds all of its tension */
} tl_contact_across;

tl_contact_across tl_contact_across_gap(const tl_model *m, uint32_t contact);

/* Whether anything may have lifted the points of a contact, or holds them. */
static inline bool tl_contact_is_lifted(const tl_model *m, uint32_t contact)
{
    const tl_detect *d = m->detect;
    const uint32_t row = d->contacts.law[contact];
    if (row == TL_NO_ROW || d->contacts.point_count[contact] == 0)
        return false;
    const tl_law *law = &m->joint_laws[row];
    const tl_law_ops *ops = law->kind->ops;
    return law->pulls != TL_PULL_NONE || d->points.f_n0 || (ops->across_gap && law->columns > 0);
}

/* Whether slip may open a contact: without an initial force only a state lifts. */
static inline bool tl_contact_opens(const tl_model *m, uint32_t contact)
{
    uint32_t law = m->detect->contacts.law[contact];
    return law != TL_NO_ROW && tl_law_opens(&m->joint_laws[law]);
}

/* The openings by slip of TL_LANES points of a contact from `first`, as a law of its kind has them, m; 0 beyond
 * the last and without a law. */
void tl_law_point_openings(const tl_model *m, const tl_law *law, uint32_t contact, size_t first,
                           double opening[TL_LANES]);
/* The same as its own law has them; 0 where nothing ever opens them. */
static inline void tl_contact_point_openings(const tl_model *m, uint32_t contact, size_t first,
                                             double opening[TL_LANES])
{
    const tl_law *law = tl_contact_opens(m, contact) ? &m->joint_laws[m->detect->contacts.law[contact]] : NULL;
    tl_law_point_openings(m, law, contact, first, opening);
}
/* The same of all that lifts them. */
void tl_contact_point_lifts(const tl_model *m, uint32_t contact, size_t first, double lift[TL_LANES]);

#endif
