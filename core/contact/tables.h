/* tables.h - contacts and contact points, as tables. */
#ifndef TL_CONTACT_TABLES_H
#define TL_CONTACT_TABLES_H

#include "base/table.h"
#include "contact/carrier.h"
#include "model/seat.h"
#include "narrow/press.h"
#include "narrow/press_slope.h"

/* For a path length up to which something of a contact holds: it is found anew in any case. */
#define TL_OUTDATED (-INFINITY)

/* Where the sides of a contact were against each other: B in the frame of A, its centroid and its rotation, each to
 * seven digits. */
typedef struct tl_spot {
    float centroid[3], turn[4];
    float remaining; /* its blocks may move so far against each other, m, before its faces are to be chosen anew */
} tl_spot;

typedef struct tl_contacts {
    tl_table table;
    int64_t *born;   /* steps made when it got points last after having none: by this it is known */
    uint32_t *a, *b; /* block rows */
    uint32_t *pair;  /* index of its pair */
    tl_tag *tag;
    uint32_t *law; /* index into the model's joint_laws, or TL_NO_ROW */
    tl_facet *facet;
    uint8_t *kind;           /* of the span into which its points belong */
    uint32_t *press;         /* row of what a field contact keeps, or TL_NO_ROW */
    double *faces_valid_to;  /* sum of odometers up to which the choice of its faces holds */
    double *points_valid_to; /* sum of odometers up to which its points may be reused */
    tl_spot *spot;           /* of patches: where their points were laid, or their faces chosen */
    uint32_t *point_start;   /* row of the first point; the next are TL_LANES rows apart */
    uint16_t *point_count, *point_capacity;
    double *area;
    double *released; /* shear energy that went with area since the last step, J: heat */
    double *stored;   /* energy after the last step, J; NaN: under another law or stress */
    tl_vec3 *force;   /* on B */
    tl_vec3 *moment;  /* of the forces on B, about A's body's centroid */
    /* a bond or an initial stress acted across a gap in the last step: it ends only with that force */
    uint8_t *holds_over_gap;
    uint8_t *handed_over; /* in this step, and its heat is what it has lost */
    uint8_t *new_points;  /* its points were placed in this step: TL_POINTS_* */
    uint8_t *pending;     /* what the parallel phase leaves to the serial one: TL_PENDING_* */
    uint8_t *held;        /* both its bodies are held still: contacts.c */
    uint8_t *deep;        /* its blocks overlap too deeply: TL_DEEP_*, overlap.c */
    /* of models with deformable blocks; NULL: there has been none */
    tl_carrier *carrier[2]; /* of its sides on deformable blocks */
    double *share;          /* of its energy that counts: segments have the rest (segment/blend.c) */
    double *heat;           /* of all of it in the last step, J */
} tl_contacts;

/* Faces that a field contact remembers; of one with more the faces are listed in every step. */
#define TL_PRESS_FACES 48

/* What a field contact keeps beside its points. Lengths and forces of the press in A's frame. */
typedef struct tl_press_row {
    tl_press press;
    /* How far its faces `shifted` are moved out by an initial stress and by slip, m; what slip has opened of it, by its
     * points. */
    double shift, opening[TL_FIELD_POINTS];
    double opened, paid; /* by slip in the step before `lifted_at`, m; with energy of shear, J */
    int64_t lifted_at, moved_at, since;
    tl_vec3 half; /* of the way of the centre of pressure before `moved_at`, in A's frame */
    tl_face_pair shifted;
    /* they, of A and of B, in the frames of their bodies; and as they lean, before they are moved out, if they do */
    tl_plane shifted_at[2], lean[2];
    tl_block_frame frame[2]; /* those frames */
    uint32_t next_free;
    double spare[2]; /* energy of shear and of torsion beyond uniform stress, times 2 ks */
    uint16_t count[4], face[TL_PRESS_FACES], blunt_a, blunt_b; /* of its tl_region */
    tl_pair_pose listed_at;                                    /* where they were listed */
    double listed_shift;                                       /* and with which shift */
    bool flush, listed, leans;
    bool refused; /* there it was no patch, although it lay still */
    tl_field_mesh mesh;
    /* It goes by the slopes that its press has had there at the place where it was `since` some step; or else by its
     * mesh, and has stayed near a place since then (fields.c). Then it also keeps the mesh of the patch of its flush
     * faces. */
    tl_pair_pose place;
    bool by_slope;
    union {
        struct {
            tl_press there;
            tl_press_slope slope;
        };
        tl_field_mesh flat;
    };
    tl_press_extra extra; /* of a press that has more */
} tl_press_row;

/* GROW: it waits for room for its points; GROW_PATCH: for those of the same two faces, so that it then comes out as it
 * would have with room; REFRAME: besides, its old points are in frames that are no more. MOVE: its points belong in
 * another span. */
enum { TL_PENDING_NONE, TL_PENDING_GROW, TL_PENDING_REFRAME, TL_PENDING_DIE, TL_PENDING_MOVE, TL_PENDING_GROW_PATCH };

/* What happened to the points of a contact in this step: nothing; placed anew; others are there than before. */
enum { TL_POINTS_STAY, TL_POINTS_PLACED, TL_POINTS_OTHERS };

/* Whether a contact waits for room for its points. */
static inline bool tl_pending_waits(uint8_t pending)
{
    return pending == TL_PENDING_GROW || pending == TL_PENDING_GROW_PATCH || pending == TL_PENDING_REFRAME;
}

/* Which of the two limits an overlap is beyond: that of a contact that is born so, or that of one that has sunk in. */
enum { TL_DEEP_NOT, TL_DEEP_BORN, TL_DEEP_SUNK };

typedef struct tl_points_table {
    tl_table table;
    uint32_t *key, *flags;
    double *p[3], *area;
    double *reference, *f_n0; /* overlap at closure 0, initial normal force; NULL: 0 everywhere */
    double *f_n, *f_s[3];
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
