/* tables.h - contacts and contact points, as tables. */
#ifndef TL_CONTACT_TABLES_H
#define TL_CONTACT_TABLES_H

#include "base/table.h"
#include "narrow/axis.h"

typedef struct tl_contacts {
    tl_table table;
    tl_id *id;
    uint32_t *a, *b; /* block rows */
    uint32_t *pair;  /* index of its pair */
    tl_tag *tag;
    uint32_t *material; /* index of the model's materials, or TL_NO_ROW */
    tl_axis_features *axis;
    double *search; /* sum of odometers up to which the axis need not be searched anew */
    double *until;  /* sum of odometers up to which the facets may be reused */
    uint32_t *facet_start;
    uint32_t *point_start; /* row of the first point; the next are TL_LANES rows apart */
    uint16_t *facet_count, *facet_room, *point_count, *point_room;
    double *area;
    tl_vec3 *force;  /* on B */
    tl_vec3 *moment; /* of the forces on B, about A's body's centroid */
    /* some point carried a force across a gap in the last step: a bond in tension, or an initial stress not yet
     * relieved. Such a contact ends only with that force */
    uint8_t *across;
    uint8_t *fresh; /* its points were placed in this step */
    uint8_t *lone;  /* its faces that look at each other are one of each block */
    uint8_t *fate;  /* what the parallel phase leaves to the serial one: TL_FATE_* */
    uint8_t *held;  /* both its bodies are held still: held.c */
    uint8_t *deep;  /* its blocks overlap too deeply: TL_DEEP_*, overlap.c */
    /* facets */
    tl_facet *facet;
    size_t facet_total, facet_capacity;
} tl_contacts;

/* MOVE: its points belong in another run. */
enum { TL_FATE_KEEP, TL_FATE_GROW, TL_FATE_DIE, TL_FATE_MOVE };

/* Which of the two limits an overlap is beyond: that of a contact that is born so, or that of one that has sunk in. */
enum { TL_DEEP_NOT, TL_DEEP_BORN, TL_DEEP_SUNK };

typedef struct tl_points_table {
    tl_table table;
    double *p[3];
    int16_t *lean_face, *lean_edge; /* tl_lean, in steps: see tl_point_lean */
    uint32_t *key;
    double *area;
    double *reference, *f_n0; /* overlap at closure 0, initial normal force; NULL: 0 everywhere */
    double *f_n, *f_s[3];
    uint32_t *flags;
    double *state[TL_STATE_COLUMNS]; /* as many as the laws need; the others are NULL */
    uint32_t state_columns;
    bool initial; /* has the columns reference and f_n0 */
} tl_points_table;

/* Row of point k of a contact. */
static inline size_t tl_point_row(const tl_contacts *c, uint32_t contact, size_t k)
{
    return c->point_start[contact] + k * TL_LANES;
}

/* The block with which a block has a contact. */
static inline uint32_t tl_contact_partner(const tl_contacts *c, uint32_t contact, uint32_t block)
{
    return c->a[contact] == block ? c->b[contact] : c->a[contact];
}

#endif
