/* detect.h - contact detection: from block shapes and body places to contacts with contact points.
 *
 * A *pair* is two blocks whose inflated bounds overlap (broad.c). A pair near enough is a *contact*: it
 * has an *axis* (axis.c: the common plane's normal, exact), and *facets* (manifold.c): face-face
 * patches, or the point share of vertices and edges, each with *contact points* that have an area
 * share. Contacts persist: while nothing has moved more than a margin, only the gaps are computed
 * anew (follow.c).
 *
 * Frames: narrow-phase geometry is done in the frame of block A's body, where B's body is given by a
 * rotation and a translation; A is the block with the lower id. Normals point from A to B. Gap is
 * positive between separate walls; overlap is -gap. */
#ifndef TL_DETECT_DETECT_H
#define TL_DETECT_DETECT_H

#include "detect/pair.h"
#include "model/model.h"

/* Overlap of a pair that touches without area, along both of two directions, that may go unseen, relative to the size:
 * a share of its faces as small as that (beside.c); and how far other such pairs may move before they are looked at
 * again. */
#define TL_SILENT 1e-5

/* Half the sine of the tilt of two faces up to which all points of their patch have the bisector for their
 * normal: a share of the force that no result shows. */
#define TL_FLUSH 1e-5

/* Square of the sine of the tilt of two faces up to which they are flush: of FLUSH_NONE in manifold.c. */
#define TL_FLUSH_TILT2 7.6152421804e-5

/* When a pair becomes a contact, and when a contact ends, relative to the smaller block's size. */
#define TL_CONTACT_TOLERANCE 1e-3
#define TL_CONTACT_RELEASE 1.5

/* Two blocks in the frame of A's body. */
typedef struct tl_pair_view {
    const tl_poly *a, *b;
    tl_mat3 turn;      /* from B's frame to A's */
    tl_vec3 shift;     /* B's origin in A's frame */
    double size;       /* of the smaller block */
    double mean_face;  /* smaller of the two mean face areas */
    tl_vec3 *vertex_b; /* B's vertices and face normals in A's frame: filled by tl_pair_place */
    tl_vec3 *normal_b;
} tl_pair_view;

typedef enum tl_axis_kind { TL_AXIS_FACE_A, TL_AXIS_FACE_B, TL_AXIS_EDGES } tl_axis_kind;

/* The separating or least penetrating axis of a pair. */
typedef struct tl_axis {
    uint32_t kind;   /* tl_axis_kind */
    uint16_t ia, ib; /* face of A or of B, or edge of A and edge of B */
    tl_vec3 n;       /* unit, A to B, in A's frame */
    double s;        /* min over B - max over A of n . x: the gap, negative when overlapping */
    double second;   /* the next best axis's s; for an s of INFINITY how far the pair may run */
} tl_axis;

/* The features it belongs to: all that a contact keeps of its axis. */
typedef struct tl_axis_features {
    uint16_t kind, ia, ib;
} tl_axis_features;

static inline tl_axis_features tl_features_of(const tl_axis *axis)
{
    return (tl_axis_features){(uint16_t)axis->kind, axis->ia, axis->ib};
}

/* An axis of these features that has no place yet. */
static inline tl_axis tl_axis_of(tl_axis_features f)
{
    return (tl_axis){.kind = f.kind, .ia = f.ia, .ib = f.ib, .s = -INFINITY, .second = -INFINITY};
}

typedef enum tl_facet_kind {
    TL_FACET_PATCH,  /* face on face */
    TL_FACET_FACE_A, /* vertices of B on a face of A */
    TL_FACET_FACE_B, /* vertices of A on a face of B */
    TL_FACET_EDGES   /* an edge of A across an edge of B */
} tl_facet_kind;

/* Largest couple per energy that is told apart, 1/rad. */
#define TL_MOST_SWING 1e30

/* Contact points that share a normal and a way to compute their gaps. Planes are kept here, for most facets
 * have them and every step asks; edges are looked up in the shapes. A step reads the doubles as one row. */
typedef struct tl_facet {
    tl_vec3 na, nb; /* outward normals of the faces, own frames; edges: na is n when made */
    double offset;  /* of the face, or the sum of those of both faces, own frames */
    tl_vec3 last,
        last_lean;  /* normal when last followed, and how points' normals differ, model's axes */
    float swing[3]; /* couple on B per energy stored in its points, A's frame, 1/rad */
    uint8_t kind;
    uint16_t ia, ib;       /* faces, or edges */
    uint16_t begin, count; /* of its points, within the contact */
} tl_facet;

static inline tl_vec3 tl_facet_swing(const tl_facet *f)
{
    return tl_v3(f->swing[0], f->swing[1], f->swing[2]);
}

static inline void tl_facet_set_swing(tl_facet *f, tl_vec3 swing)
{
    const double value[] = {swing.x, swing.y, swing.z};
    /* the energy it belongs to is next to nothing where it is beyond a float */
    for (int k = 0; k < 3; k++)
        f->swing[k] = (float)fmin(fmax(value[k], -TL_MOST_SWING), TL_MOST_SWING);
}

/* Doubles at the head of a facet that a step reads; even, for it reads them in pairs. */
#define TL_FACET_ROW 14

/* How the normal of a point of a patch differs from the mean of its faces' normals. With M = (nA - nB)/2, L = (nA +
 * nB)/2, which is perpendicular to it, it lies along M + face L + edge M x L. `face` is -1 for a vertex of A, which
 * stands on B's face, 1 for one of B; `edge` is not 0 where two edges cross. */
typedef struct tl_lean {
    float face, edge;
} tl_lean;

/* A contact point as the geometry gives it. `p` is fixed to A for patches, faces of B and edges, and
 * to B for faces of A. Patches: `lean` tells along which normal the gap opens. */
typedef struct tl_contact_point {
    tl_vec3 p;
    tl_lean lean;
    double area;
    uint32_t key;  /* of the features that made it */
    tl_vec3 swing; /* as a facet's: what its own area adds to it */
} tl_contact_point;

/* The contact points of one pair, as one geometric evaluation finds them. */
typedef struct tl_manifold {
    tl_facet *facets;
    tl_contact_point *points;
    size_t facet_count, facet_room, point_count, point_room;
    double patch_area;
    bool lone;   /* no faces look at each other but one of each, nor will they soon */
    bool brief;  /* some areas depend on a gap: they hold for a part of the motion others do */
    bool failed; /* out of memory */
} tl_manifold;

/* The contact points of one patch, as columns: see tl_contact_point. */
typedef struct tl_patch_points {
    double *p[3], *area;
    tl_lean *lean;
    uint32_t *key;
    size_t count, room;
} tl_patch_points;

/* Per-thread room for the narrow phase. */
typedef struct tl_narrow {
    tl_vec3 *vertex_b, *normal_b;
    double *dots;
    struct tl_share_point *share; /* stand.h */
    size_t vertex_room, normal_room, dot_room, share_room;
    struct tl_polygon *polygon; /* patch.c */
    tl_patch_points patch;
    tl_manifold manifold;
    bool failed;              /* out of memory, in a phase that cannot say so */
    bool reframed;            /* the places of old points are in frames that are no more */
    bool deep;                /* met a contact whose blocks overlap too deeply: overlap.c */
    struct tl_old_point *old; /* transfer.c */
    double *value;
    size_t old_room;
} tl_narrow;

/* Frees what a room holds, not the room. */
void tl_narrow_free(tl_narrow *room);

/* How the point share of a pair is measured. */
typedef struct tl_share_rule {
    double minimum;     /* area, m2 */
    bool unconditional; /* also for edges of parallel faces */
    bool corners;       /* points of patches at corners only */
    double reach;       /* patches with every gap beyond this are left out */
} tl_share_rule;

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

/* What is known of points only while a step works on them. */
typedef struct tl_point_lanes {
    tl_table table;
    double *arm[3]; /* from A's body's centroid to the point, axes of the model */
    double *normal[3];
    double *closure; /* overlap less reference */
    double *du_n, *du_s[3];
    double *stored, *dissipated;
    double *couple[3]; /* on B per energy stored, model's axes: of ranks that have such */
    double *zero;      /* 0, for what points have no column of */
    /* what a law found, where it is asked whether it changes anything: forces and states, and flags */
    double *before[4 + TL_STATE_COLUMNS];
    uint32_t *flags_before;
} tl_point_lanes;

/* Contacts of one material whose points lie side by side: point k of the contact in lane l is row start + TL_LANES k
 * + l. What has to be done for each contact is done for all of a rank at once, one in each lane of the
 * processor's vectors, and so is what has to be done for each point. Lanes without a contact, and rows beyond a
 * contact's points, are inert: area 0. */
typedef struct tl_rank {
    uint32_t start, slots;      /* points there is room for in each lane */
    uint32_t contact[TL_LANES]; /* row, or TL_NO_ROW */
} tl_rank;

/* Points that are worked on as a whole while they are in the nearest cache, from gaps to sums: as many ranks as
 * have room for so many, or one. */
#define TL_PAGE 144

/* Whether the contacts of a run are passed over: held.c. */
enum { TL_RUN_WOKEN, TL_RUN_FOLLOWED, TL_RUN_RESTS };

/* The ranks of one material, one after the other: in the list of ranks, and their points from `begin`, used up to
 * `end`, with room up to `limit`. Contacts between bodies that are held still have runs of their own. */
typedef struct tl_run {
    uint32_t material;
    bool held;    /* between bodies that are held still */
    uint8_t rest; /* of one that is held: TL_RUN_* */
    bool
        changed; /* of one that is held: some point or sum was not what it had been, in the last step */
    size_t begin, end, limit;
    size_t rank_begin, rank_end, rank_limit;
} tl_run;

/* Where the points of all contacts are. */
typedef struct tl_layout {
    tl_run *runs;
    size_t run_count, run_room;
    tl_rank *ranks;
    size_t rank_room;
} tl_layout;

typedef struct tl_detect {
    tl_pair *pairs;
    size_t pair_count, pair_room;
    tl_pair_chunk *chunks;
    size_t chunk_room;
    bool listed;        /* pairs have been listed */
    bool rows_changed;  /* since contacts were laid out */
    bool bare;          /* there may be contacts without room for points */
    double reach;       /* half the skin of the broad phase */
    double *odometer_0; /* of each body, when the broad phase was made */
    size_t odometer_room;
    tl_id *
        ids; /* of each block, when rows were last looked at: finds them again after they have changed */
    size_t id_room;
    float *run; /* of each block: how far it can have moved since then, rounded up */
    size_t run_of_room;
    float ran;        /* the farthest of them */
    uint8_t *touched; /* bodies whose contacts came, went or grew since the time step was chosen */
    size_t touched_room;
    bool any_touched;
    uint64_t structure, laws, constraints; /* of the model, when last seen */
    /* bodies held still all of whose contacts rest, so that the sums of their forces stand; `any_idle` false: none */
    uint8_t *idle;
    size_t idle_room;
    bool any_idle;
    tl_contacts contacts, spare;
    tl_points_table points, spare_points;
    int64_t laid_at;    /* steps made when contacts were laid out */
    size_t spare_share; /* 1 / this of rows, points and facets were added to spare; 0: never yet */
    tl_layout layout;
    uint32_t *by_block, *by_block_start; /* contacts of each block: index.c */
    size_t by_block_room, by_start_room;
    uint32_t indexed; /* rows of contacts that are listed; TL_NO_ROW: the lists are out of date */
    uint32_t *by_id;  /* contact rows by ascending id; made when asked for */
    size_t by_id_room;
    bool by_id_fresh;
    tl_id next_contact;
    tl_narrow *narrow;     /* [threads] */
    tl_point_lanes *lanes; /* [threads]: a page, or the largest rank */
    size_t lane_room;
    unsigned threads;
} tl_detect;

/* Row i of a vector kept as three columns. */
static inline tl_vec3 tl_columns_get(double *const column[3], size_t i)
{
    return tl_v3(column[0][i], column[1][i], column[2][i]);
}

static inline void tl_columns_put(double *const column[3], size_t i, tl_vec3 v)
{
    column[0][i] = v.x;
    column[1][i] = v.y;
    column[2][i] = v.z;
}

/* Brings pairs, contacts and gaps up to the present places of the bodies: the first half of a step. */
tl_status tl_detect_update(tl_model *m);
/* Finds the contacts of a model whose blocks or laws have changed since the last step, for queries and
 * settings between steps. Contacts that stand are not touched, so asking never changes a result. */
tl_status tl_detect_refresh(tl_model *m);
void tl_detect_destroy(tl_detect *d);
/* A second detection in the same state: copy.c. NULL when out of memory. */
tl_detect *tl_detect_copy(const tl_detect *from);
/* Makes sure that points have initial forces and the overlaps they belong to, or so many columns of states; false when
 * out of memory (nothing changed). */
bool tl_detect_hold_initial(tl_detect *d);
bool tl_detect_hold_states(tl_detect *d, uint32_t columns);

/* ---- memory.c ---- */
/* Adds what the detection holds. */
void tl_detect_memory(const tl_model *m, tl_memory *memory);

/* ---- broad.c ---- */
tl_status tl_broad_update(tl_model *m);

/* ---- pairs.c ---- */
/* Makes room for what is kept of the model's blocks and bodies; their runs begin here. */
tl_status tl_pairs_restart(tl_model *m);
/* Notes how far blocks have run. */
void tl_pairs_run(tl_model *m);
/* Looks at the pairs without a contact that may have come near: chunks and pairs tell which were found. */
void tl_pairs_look(tl_model *m);
/* Lets a pair sleep until its blocks have run `way` more. */
void tl_pair_sleep(tl_detect *d, tl_pair *pair, double way);
/* The wake of a pair, without a contact, whose runs are to begin anew. */
void tl_pair_rebase(const tl_detect *d, tl_pair *pair);
/* Forgets what shows that a pair touches without area; without a contact it is looked at again. */
void tl_pair_wake(tl_detect *d, uint32_t pair);
/* Notes that a pair has lost its contact. */
void tl_pair_parted(tl_detect *d, uint32_t pair);

/* ---- look.c: libccd's first look ---- */
/* False when the blocks, each grown by `reach` / 2, are certainly apart. */
bool tl_look_near(const tl_pair_view *view, double reach);

/* ---- axis.c ---- */
/* Fills vertex_b and normal_b of the view. */
bool tl_pair_place(tl_pair_view *view, tl_narrow *room);
/* Fills them for one face of B only. */
bool tl_pair_place_face(tl_pair_view *view, uint32_t face, tl_narrow *room);
/* The exact common plane's axis. That of the features of `previous` (or NULL) is preferred when nearly as good. s is
 * INFINITY where parts of joined bodies do not press on each other, whatever their walls do. */
tl_axis tl_axis_search(const tl_pair_view *view, tl_narrow *room, const tl_axis_features *previous);
/* How far a pair whose axis parts it may run before it is searched again. */
double tl_axis_wait(const tl_axis *axis, double size);
/* n and s of an axis's features in the present place, whether or not they still define it; false for edges that are
 * parallel. */
bool tl_axis_place(const tl_pair_view *view, tl_axis *axis);
/* The same; false when the features no longer define it. */
bool tl_axis_follow(const tl_pair_view *view, tl_axis *axis);
/* Unit direction perpendicular to both edges, within `outward`'s half-space; false when parallel. */
bool tl_edge_normal(tl_vec3 edge_a, tl_vec3 edge_b, tl_vec3 outward, tl_vec3 *n);

/* ---- beside.c: pairs that touch without area ---- */
/* Chooses the faces that show it. */
void tl_beside_note(const tl_pair_view *view, tl_pair *p);
/* How far the pair may run before it may carry more than goes unseen, or is as near as a contact; negative when it
 * may do so now. `gap` gets the larger one of the two faces. */
double tl_beside_margin(const tl_pair_view *view, const tl_pair *p, double *gap);

/* ---- manifold.c ---- */
/* Facets and points of a pair whose axis is known, into room->manifold. */
void tl_manifold_build(const tl_pair_view *view, const tl_axis *axis, const tl_share_rule *rule,
                       tl_narrow *room);
bool tl_manifold_add_point(tl_manifold *m, tl_contact_point point);
/* Makes room for `count` points more; false when out of memory. */
bool tl_manifold_reserve(tl_manifold *m, size_t count);
/* Makes sure there is room for so many facets in all; false when out of memory. */
bool tl_manifold_reserve_facets(tl_manifold *m, size_t room);
/* Lays the patch of two faces that lie flush on each other, where nothing else touches; false, when they do
 * not. */
bool tl_manifold_renew(const tl_pair_view *view, uint32_t fa, uint32_t fb,
                       const tl_share_rule *rule, tl_narrow *room);
/* The joint of the touching faces. */
tl_tag tl_touching_tag(const tl_pair_view *view, tl_vec3 n);

/* ---- patch.c ---- */
/* The points of face `fa` of A on face `fb` of B, into room->patch, with areas scaled by `weight`; returns the
 * scaled area (0 when they do not overlap). */
double tl_patch_lay(const tl_pair_view *view, uint32_t fa, uint32_t fb, double weight,
                    const tl_share_rule *rule, tl_narrow *room);
/* Adds the patch of face `fa` of A on face `fb` of B, with areas scaled by `weight` and the facet's
 * `swing`; returns its scaled area (0 when they do not overlap). */
double tl_patch_add(const tl_pair_view *view, uint32_t fa, uint32_t fb, double weight,
                    tl_vec3 swing, const tl_share_rule *rule, tl_narrow *room);
void tl_polygon_free(struct tl_polygon *polygon, tl_patch_points *points);

/* ---- expect.c ---- */
/* Whether it is worth asking the memory for what ranks need before they do. */
bool tl_points_are_far(const tl_detect *d);
/* Asks for what a rank that comes soon will need to be followed, or to be brought up to date. */
void tl_rank_expect(const tl_model *m, const tl_rank *rank);
void tl_rank_expect_shapes(const tl_model *m, const tl_rank *rank);
/* Asks for what tells where that is: for a rank that comes a little later. */
void tl_rank_expect_contacts(const tl_detect *d, const tl_rank *rank);

/* ---- follow.c ---- */
/* Gaps, normals and relative motion of the contacts of a rank, its first point's into lane `lane`; turns shear forces
 * with the common plane, and the states of which `tangents` has a bit. false when no area depends on tilt: there are
 * no couples then. */
bool tl_rank_follow(tl_model *m, const tl_rank *rank, const tl_point_lanes *lanes, size_t lane,
                    uint32_t tangents);

/* ---- places.c ---- */
/* Arms, normals and closures of a contact's points in the present place, from lane 0 on. */
void tl_contact_places(const tl_model *m, uint32_t contact, const tl_point_lanes *lanes);
/* The same for a contact whose points are new: forces turn from here. */
void tl_contact_begin(tl_model *m, uint32_t contact, const tl_point_lanes *lanes);
/* Area-weighted normal and point (coordinates relative to the origin), and the smallest gap. */
void tl_contact_summary(const tl_model *m, uint32_t contact, tl_vec3 *normal, tl_vec3 *point,
                        double *gap);
/* Normal of a point that leans so when its contact was last followed; 0 when it never was. */
tl_vec3 tl_facet_last_normal(const tl_facet *facet, tl_lean lean);

/* ---- overlap.c ---- */
/* "contact of blocks 3 and 7, joint J1:2" */
void tl_contact_name(tl_model *m, uint32_t contact, char *text, size_t size);
/* Whether two blocks overlap so deeply that their contact cannot tell how to part them; less is enough for one that is
 * just born. */
bool tl_overlap_is_deep(const tl_model *m, const tl_pair_view *view, const tl_axis *axis,
                        uint32_t a, uint32_t b, bool born);
/* Marks a contact whose blocks do, so that its axis is searched whenever it is looked at. */
void tl_overlap_mark(tl_contacts *contacts, uint32_t contact, bool born);
/* After a step's contacts have been settled: the sentence of the first that is marked, and of which a block can move. */
tl_status tl_overlaps_check(tl_model *m);

/* ---- update.c ---- */
/* The rule of the point share for a pair of a joint; pairs that carry a force across a gap keep all
 * their points. */
tl_share_rule tl_share_rule_of(const tl_model *m, const tl_pair_view *view, tl_tag tag,
                               bool across);
/* The same for a contact of bodies that have other frames than when its facets were made. */
void tl_contact_reframe(tl_model *m, uint32_t contact, unsigned thread);
/* Builds the facets of a contact that has just been given its room, unless it wants more: then its fate is still to
 * grow; false when out of memory. */
bool tl_contact_fill(tl_model *m, uint32_t contact);

/* ---- renew.c ---- */
/* Brings the facets of the contacts of a rank up to the present place, if they are stale; their fates tell what is left
 * to do. false when none was. */
bool tl_rank_update(tl_model *m, const tl_rank *rank, unsigned thread);

/* ---- transfer.c ---- */
/* Puts the manifold's points in the place of the contact's, carrying over state so that total force
 * and moment follow the area; the points fit into the contact's room. */
bool tl_contact_transfer(tl_model *m, uint32_t contact, tl_narrow *room,
                         const tl_point_lanes *lanes);

/* ---- contacts.c ---- */
void tl_contacts_init(tl_contacts *contacts, tl_points_table *points);
void tl_point_lanes_init(tl_point_lanes *lanes);
/* Adds a contact of a pair, without points, wanting room for some, whose axis stands for a run of `margin`; false when
 * out of memory. */
bool tl_contact_append(tl_model *m, uint32_t pair, const tl_axis *axis, double margin, tl_tag tag,
                       size_t want_points, size_t want_facets);
/* Lays contacts and points out anew: without those of fate TL_FATE_DIE, sorted by material and blocks,
 * each with the room it wants at least. */
tl_status tl_contacts_repack(tl_model *m);
/* Moves a contact's points and facets to where there is the room it wants, in the run of its material;
 * false when there is none: lay all out anew. */
bool tl_contact_place(tl_detect *d, uint32_t contact);
/* Takes a contact out; the last one gets its row. */
void tl_contact_remove(tl_detect *d, uint32_t contact);
/* Index of the material that rules a tag, or TL_NO_ROW. */
uint32_t tl_material_row(const tl_model *m, tl_tag tag);
/* View of two blocks, and the odometers of their bodies, summed. */
tl_pair_view tl_pair_view_of(const tl_model *m, uint32_t a, uint32_t b);
static inline double tl_pair_odometer(const tl_model *m, uint32_t a, uint32_t b)
{
    return m->bodies.odometer[m->blocks.body[a]] + m->bodies.odometer[m->blocks.body[b]];
}
/* The block with which a block has a contact. */
static inline uint32_t tl_contact_partner(const tl_contacts *c, uint32_t contact, uint32_t block)
{
    return c->a[contact] == block ? c->b[contact] : c->a[contact];
}
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
/* Leans are kept in steps: -1, 0 and 1 are exact, and the normal of a point is as exact as its place in a patch. `face`
 * lies within 1, `edge` within 2. */
#define TL_LEAN_FACE_STEP 0x1p-14f
#define TL_LEAN_EDGE_STEP 0x1p-13f

/* The nearest whole number of steps, for -lean the same with the other sign, as blocks in the other order have it: a float
 * this large has no digits behind the point. */
static inline int16_t tl_lean_steps(float lean, float step)
{
    const float whole = 0x1.8p23f;
    return (int16_t)(int32_t)((lean / step + whole) - whole);
}

/* How the normal of a point leans. */
static inline tl_lean tl_point_lean(const tl_points_table *p, size_t row)
{
    return (tl_lean){TL_LEAN_FACE_STEP * p->lean_face[row], TL_LEAN_EDGE_STEP * p->lean_edge[row]};
}

static inline void tl_point_set_lean(tl_points_table *p, size_t row, tl_lean lean)
{
    p->lean_face[row] = tl_lean_steps(lean.face, TL_LEAN_FACE_STEP);
    p->lean_edge[row] = tl_lean_steps(lean.edge, TL_LEAN_EDGE_STEP);
}

/* Row of point k of a contact. */
static inline size_t tl_point_row(const tl_contacts *c, uint32_t contact, size_t k)
{
    return c->point_start[contact] + k * TL_LANES;
}

/* `need` and one in `share` more, or `least` more. */
static inline size_t tl_with_spare(size_t need, size_t share, size_t least)
{
    size_t more = need / share;
    return need + (more > least ? more : least);
}

/* ---- index.c ---- */
/* Lists the contacts of each block, and notes whether some are bare; after contacts have come, gone or been given
 * room. false when out of memory. */
bool tl_contacts_index(tl_model *m);
/* Contacts have gone, or rows of contacts or blocks have changed: all are to be listed anew. */
void tl_contacts_unlist(tl_detect *d);
/* Row of the contact of an id, or TL_NO_ROW. */
uint32_t tl_contact_row(tl_detect *d, tl_id id);

/* ---- ranks.c ---- */
/* Gives contacts that are sorted by runs their lanes in an empty layout: sets the start and room of each by the
 * room it wants, with one in `share` to spare; *points is the number of rows. false when out of memory. */
bool tl_layout_make(tl_layout *layout, tl_contacts *contacts, size_t share, size_t *points);
void tl_layout_free(tl_layout *layout);
/* A free lane of a contact's run with room for so many points, taken for it; NULL when there is none. */
tl_rank *tl_rank_take(tl_detect *d, uint32_t points, uint32_t contact, uint32_t *lane);
/* Notes that a contact's lane belongs to that row, or to none. */
void tl_rank_note(tl_detect *d, uint32_t contact, uint32_t row);

/* ---- points.c ---- */
/* A point without force, area or place: an inert lane. */
void tl_point_clear(tl_points_table *p, size_t point);
/* The law's states of a point, at their initial values, or taken from an old point of some area. */
void tl_point_initial_state(tl_points_table *p, size_t point, const tl_kind *kind);
void tl_point_begin(tl_points_table *p, size_t point, const tl_kind *kind); /* and no flags */
void tl_point_take_state(tl_points_table *p, size_t point, const tl_kind *kind, const double *old,
                         double old_area);
/* The same for a point that keeps its place: what is reset on a change of polygon stays. */
void tl_point_keep_state(tl_points_table *p, size_t point, const tl_kind *kind, const double *old,
                         double old_area);
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
