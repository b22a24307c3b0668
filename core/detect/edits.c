/* edits.c - what edits of the model leave of pairs and contacts.
 *
 * A block bears the count of structure with which it came, or got another shape, frame or tags. What is newer than the
 * count that detection has seen is treated as if it were new. All else that is known of pairs and contacts stays.
 *
 * What contacts of blocks that were cut carry is left to those of their parts: a part of a wall carries what it carried
 * before (contact/cut_contacts.c). */
#include "detect/edits.h"

#include "base/columns.h"
#include "base/parallel.h"
#include "contact/across_gap.h"
#include "contact/contacts.h"
#include "contact/cut_contacts.h"
#include "contact/facing.h"
#include "contact/index.h"
#include "contact/kind.h"
#include "contact/lean.h"
#include "contact/pair_view.h"
#include "contact/shear.h"
#include "contact/store.h"
#include "detect/grazing.h"
#include "detect/pairs.h"
#include "detect/update.h"
#include "force/cut_parts.h"
#include "model/joints.h"
#include "zone/grid.h"

#include <stdlib.h>

/* Contacts a worker takes at a time. */
#define CONTACT_CHUNK 256
/* Constant: below any path length. The pair is tested in the next step. */
#define AWAKE (-1.f)
/* Tolerance: minimum area over that of a patch from which the patch may be none: below MOST_MIN_AREA of
 * narrow/manifold.c. */
#define SURE_MIN_AREA 0.01

/* ---------------------------------------------------------------- rows ------------------- */

/* What is made before anything is changed. */
typedef struct rows_scratch {
    uint32_t *row;                /* [blocks seen] the present row, or TL_NO_ROW */
    uint32_t *part;               /* [blocks seen] of one that was cut: one of its parts, or TL_NO_ROW */
    double *odometer_0;           /* [bodies] */
    uint8_t *touched;             /* [bodies] */
    tl_known_block *known_blocks; /* [blocks] */
} rows_scratch;

static bool reserve_scratch(const tl_model *m, rows_scratch *scratch)
{
    tl_detect *d = m->detect;
    size_t blocks = m->blocks.table.rows, bodies = m->bodies.table.rows;
    *scratch = (rows_scratch){.row = malloc((d->known_block_count + 1) * sizeof *scratch->row),
                              .part = malloc((d->known_block_count + 1) * sizeof *scratch->part),
                              .odometer_0 = calloc(bodies + 1, sizeof *scratch->odometer_0),
                              .touched = calloc(bodies + 1, 1),
                              .known_blocks = malloc((blocks + 1) * sizeof *scratch->known_blocks)};
    return scratch->row && scratch->part && scratch->odometer_0 && scratch->touched && scratch->known_blocks &&
           tl_fit(&d->idle, &d->idle_capacity, bodies + 1, sizeof *d->idle) &&
           tl_fit(&d->path, &d->path_capacity, blocks + 1, sizeof *d->path);
}

static void free_scratch(rows_scratch *scratch)
{
    free(scratch->row);
    free(scratch->part);
    free(scratch->odometer_0);
    free(scratch->touched);
    free(scratch->known_blocks);
}

/* Runs of bodies that have come or changed begin here, and their contacts are not what they were; others keep both. */
static void keep_bodies(tl_model *m, const rows_scratch *scratch)
{
    const tl_detect *d = m->detect;
    for (size_t body = 0; body < m->bodies.table.rows; body++) {
        scratch->odometer_0[body] = m->bodies.odometer[body];
        scratch->touched[body] = true;
    }
    for (size_t old = 0; old < d->known_block_count; old++) {
        uint32_t row = scratch->row[old], before = d->known_blocks[old].body;
        if (row == TL_NO_ROW || tl_block_is_new(m, row))
            continue;
        scratch->odometer_0[m->blocks.body[row]] = d->odometer_0[before];
        scratch->touched[m->blocks.body[row]] = d->touched[before];
    }
}

static int compare_known(const void *x, const void *y)
{
    const tl_known_block *p = x, *q = y;
    return (p->id > q->id) - (p->id < q->id);
}

/* Finds a part of each block that was cut. */
static void find_parts(const tl_model *m, const rows_scratch *scratch)
{
    const tl_detect *d = m->detect;
    for (size_t old = 0; old < d->known_block_count; old++)
        scratch->part[old] = TL_NO_ROW;
    for (size_t i = 0; i < m->cut_part_count && d->known_block_count; i++) {
        tl_known_block root = {.id = m->cut_parts[i].root};
        if (tl_block_row_quiet(m, m->cut_parts[i].id) == TL_NO_ROW)
            continue;
        const tl_known_block *known = bsearch(&root, d->known_blocks, d->known_block_count, sizeof root, compare_known);
        if (known)
            scratch->part[known - d->known_blocks] = (uint32_t)i;
    }
}

/* ---------------------------------------------------------------- contacts that end ------ */

/* The points in the places where their blocks have carried them, and their sums. */
static void keep_points(tl_model *m, uint32_t c, const tl_cut_side *a, const tl_cut_side *b, tl_cut_contact *cut)
{
    tl_detect *d = m->detect;
    const tl_facet *facet = &d->contacts.facet[c];
    uint32_t column = tl_shear_kept_column(m, cut->law);
    tl_shear *whole = &cut->whole;
    tl_facing_place to = {*a->r, {0, 0, 0}};
    if (!cut->field)
        to = tl_facing_ride(a->r, b->r, tl_v3_sub(b->place, a->place), &facet->laid.turn, facet->laid.shift,
                            facet->ride);
    for (size_t k = 0; k < cut->count; k++) {
        tl_vec3 p = tl_columns_get(d->points.p, tl_point_row(&d->contacts, c, k));
        tl_vec3 place = tl_v3_add(tl_v3_add(a->place, to.at), tl_m3_mul(&to.to, p));
        tl_old_point point = tl_point_as_old(&d->points, &d->contacts, c, k, place);
        tl_shear_add(whole, point.area, place, tl_v3_scale(point.area, point.shear));
        whole->centre = tl_v3_madd(whole->centre, point.area, place);
        whole->normal = point.normal;
        cut->kept += column == TL_NO_ROW ? 0 : point.state[column];
        d->cut_points[d->cut_point_count++] = point;
    }
    whole->centre = tl_v3_scale(whole->area > 0 ? 1 / whole->area : 0, whole->centre);
}

/* The springs of a field contact, and how far an initial stress has moved its face, as a patch has that. */
static void keep_field(tl_model *m, uint32_t c, tl_cut_contact *cut)
{
    const tl_press_row *row = tl_press_row_of(m, c);
    tl_old_point *point = &m->detect->cut_points[cut->first];
    cut->whole.energy = row->spare[0] + row->spare[1];
    tl_shear_add_field(m, c, &cut->whole);
    point->n0 = 0;
    point->reference = -row->shift;
}

/* The overlap of the walls at a place: of faces with the sum `offset` of their offsets. */
static double overlap_at(const tl_cut_contact *cut, double offset, const tl_cut_side *a, const tl_cut_side *b,
                         tl_vec3 place)
{
    return offset - tl_v3_dot(cut->face[0], tl_v3_sub(place, a->place)) -
           tl_v3_dot(cut->face[1], tl_v3_sub(place, b->place));
}

/* Takes what slip has opened out of the references of a patch's points, and notes their closures. */
static void keep_closures(tl_model *m, uint32_t c, const tl_cut_side *a, const tl_cut_side *b, tl_cut_contact *cut)
{
    double offset = m->detect->contacts.facet[c].offset, opening[TL_LANES];
    for (size_t k = 0; k < cut->count; k++) {
        tl_old_point *p = &m->detect->cut_points[cut->first + k];
        if (k % TL_LANES == 0)
            tl_contact_point_openings(m, c, k, opening);
        p->closure = overlap_at(cut, offset, a, b, p->arm) - p->reference;
        p->reference -= opening[k % TL_LANES];
    }
}

/* The faces of a patch, or those of a field contact that are moved out, where they lie, and how far they are moved. */
static void keep_faces(tl_model *m, uint32_t c, const tl_cut_side *a, const tl_cut_side *b, tl_cut_contact *cut)
{
    const tl_facet *facet = &m->detect->contacts.facet[c];
    const tl_press_row *row = tl_press_row_of(m, c);
    tl_vec3 na = facet->na, nb = facet->nb;
    double offset = facet->offset;
    if (cut->field) {
        na = row->shifted_at[0].normal;
        nb = row->shifted_at[1].normal;
        offset = row->shifted_at[0].offset + row->shifted_at[1].offset;
    }
    cut->shift = cut->field ? row->shift : tl_contact_mean_lift(m, c);
    cut->face[0] = tl_m3_mul(a->r, na);
    cut->face[1] = tl_m3_mul(b->r, nb);
    cut->overlap = overlap_at(cut, offset, a, b, m->detect->cut_points[cut->first].arm);
}

/* Keeps what a contact leaves, whose first block is `a`; NULL when out of memory. */
static tl_cut_contact *keep_contact(tl_model *m, uint32_t c, const tl_cut_side *a, const tl_cut_side *b)
{
    tl_detect *d = m->detect;
    bool field = tl_facet_is_field(&d->contacts.facet[c]);
    size_t count = tl_contact_areas(d, c);
    if (!tl_grow(&d->cut_contacts, &d->cut_capacity, d->cut_count + 1, sizeof *d->cut_contacts) ||
        !tl_grow(&d->cut_points, &d->cut_point_capacity, d->cut_point_count + count, sizeof *d->cut_points))
        return NULL;
    tl_cut_contact *cut = &d->cut_contacts[d->cut_count++];
    *cut = (tl_cut_contact){.a = a->id,
                            .b = b->id,
                            .law = d->contacts.law[c],
                            .count = (uint32_t)count,
                            .first = d->cut_point_count,
                            .field = field,
                            .holds_over_gap = !field && d->contacts.holds_over_gap[c],
                            .pressed = !field && !tl_v3_is_zero(d->contacts.force[c]),
                            .reframed = a->reframed};
    keep_points(m, c, a, b, cut);
    keep_faces(m, c, a, b, cut);
    if (field)
        keep_field(m, c, cut);
    else
        keep_closures(m, c, a, b, cut);
    return cut;
}

/* After it is kept: the contact that ends takes nothing of it along. */
static void empty_contact(tl_model *m, uint32_t c)
{
    tl_detect *d = m->detect;
    tl_press_row *row = tl_press_row_of(m, c);
    for (size_t k = 0; k < d->contacts.point_count[c]; k++)
        tl_columns_put(d->points.f_s, tl_point_row(&d->contacts, c, k), tl_v3(0, 0, 0));
    if (row)
        row->spare[0] = row->spare[1] = 0;
    d->contacts.released[c] = 0;
}

/* Whether the contact of a pair, with the rows that detection has seen, ends because a block of it was cut. */
static bool leaves(const tl_detect *d, const rows_scratch *scratch, const tl_pair *p)
{
    bool a_ends = scratch->row[p->a] == TL_NO_ROW, b_ends = scratch->row[p->b] == TL_NO_ROW;
    return (a_ends || b_ends) && !tl_pair_is_apart(p) && (!a_ends || scratch->part[p->a] != TL_NO_ROW) &&
           (!b_ends || scratch->part[p->b] != TL_NO_ROW) && d->contacts.pending[p->contact] != TL_PENDING_DIE &&
           d->contacts.point_count[p->contact] > 0;
}

static tl_cut_side side_of(const tl_model *m, const rows_scratch *scratch, uint32_t seen)
{
    tl_id id = m->detect->known_blocks[seen].id;
    uint32_t row = scratch->row[seen];
    const tl_cut_part *part = row == TL_NO_ROW ? &m->cut_parts[scratch->part[seen]] : NULL;
    uint32_t side = tl_block_side(m, part ? tl_block_row_quiet(m, part->id) : row);
    return (tl_cut_side){.id = id,
                         .r = part ? &part->r : tl_side_rotation(m, side),
                         .place = part ? part->place : tl_side_place(m, side),
                         .side = side,
                         .reframed = !part && tl_block_is_new(m, row)};
}

/* Keeps what contacts of blocks that were cut leave; false when out of memory (nothing changed). */
static bool keep_cut_contacts(tl_model *m, const rows_scratch *scratch)
{
    tl_detect *d = m->detect;
    size_t contacts = d->cut_count, points = d->cut_point_count;
    bool there = true;
    for (size_t i = 0; i < d->pair_count && m->cut_part_count && there; i++) {
        const tl_pair *p = &d->pairs[i];
        if (!leaves(d, scratch, p))
            continue;
        tl_cut_side a = side_of(m, scratch, p->a), b = side_of(m, scratch, p->b);
        tl_cut_contact *cut = keep_contact(m, p->contact, &a, &b);
        there = cut != NULL;
        if (there)
            tl_cut_contact_foresee(m, p->contact, cut, &a, &b);
    }
    if (d->cut_count == contacts)
        return there;
    /* for the references of what the parts press with */
    if (!there || !tl_detect_hold_initial(d)) {
        d->cut_count = contacts;
        d->cut_point_count = points;
        return false;
    }
    for (size_t i = 0; i < d->pair_count; i++)
        if (leaves(d, scratch, &d->pairs[i]))
            empty_contact(m, d->pairs[i].contact);
    tl_cut_contacts_sort(d);
    return true;
}

/* Ends a contact: a block of it has gone or become deformable, or both have become one body. */
static void end_contact(tl_model *m, const rows_scratch *scratch, uint32_t contact, uint32_t a, uint32_t b)
{
    m->detect->contacts.pending[contact] = TL_PENDING_DIE;
    if (a != TL_NO_ROW)
        scratch->touched[m->blocks.body[a]] = true;
    if (b != TL_NO_ROW)
        scratch->touched[m->blocks.body[b]] = true;
}

/* Whether a contact is no more than an answer to somebody who has asked: it has been in no step, and bears no initial
 * stress. Where a block of it changes it is found as if nobody had. */
static bool is_fresh(const tl_model *m, uint32_t contact)
{
    const tl_detect *d = m->detect;
    bool stressed = false;
    for (size_t k = 0; d->points.initial && k < d->contacts.point_count[contact]; k++)
        stressed = stressed || d->points.f_n0[tl_point_row(&d->contacts, contact, k)] != 0;
    return d->contacts.born[contact] == m->cycles && !stressed;
}

/* Pairs, in their order, with their present rows: ids ascend with rows before and after. */
static void keep_pairs(tl_model *m, const rows_scratch *scratch)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    size_t kept = 0;
    for (size_t i = 0; i < d->pair_count; i++) {
        tl_pair p = d->pairs[i];
        uint32_t a = scratch->row[p.a], b = scratch->row[p.b];
        bool parted = a == TL_NO_ROW || b == TL_NO_ROW || m->blocks.body[a] == m->blocks.body[b];
        bool changed = !parted && (tl_block_is_new(m, a) || tl_block_is_new(m, b));
        if (tl_pair_is_apart(&p)) {
            if (parted || changed)
                continue; /* the broad phase lists it anew */
        } else if (parted || (changed && is_fresh(m, p.contact)) || (changed && tl_blocks_deform_either(m, a, b))) {
            end_contact(m, scratch, p.contact, a, b);
            continue;
        } else {
            c->a[p.contact] = a;
            c->b[p.contact] = b;
            c->pair[p.contact] = (uint32_t)kept;
            if (c->pending[p.contact] == TL_PENDING_DIE)
                end_contact(m, scratch, p.contact, a, b);
        }
        p.a = a;
        p.b = b;
        d->pairs[kept++] = p;
    }
    d->pair_count = kept;
    for (size_t chunk = 0; chunk * TL_PAIR_CHUNK < kept; chunk++)
        d->chunks[chunk] = (tl_pair_chunk){.wake = -INFINITY};
}

tl_status tl_edits_find_rows(tl_model *m)
{
    tl_detect *d = m->detect;
    size_t blocks = m->blocks.table.rows, bodies = m->bodies.table.rows;
    rows_scratch scratch;
    bool there = reserve_scratch(m, &scratch);
    for (size_t old = 0; there && old < d->known_block_count; old++)
        scratch.row[old] = tl_block_row_quiet(m, d->known_blocks[old].id);
    if (there)
        find_parts(m, &scratch);
    if (!there || !keep_cut_contacts(m, &scratch)) {
        free_scratch(&scratch);
        return tl_fail_memory(&m->error);
    }
    keep_bodies(m, &scratch);
    keep_pairs(m, &scratch);
    for (size_t row = 0; row < blocks; row++)
        scratch.known_blocks[row] = (tl_known_block){m->blocks.id[row], m->blocks.body[row]};
    free(scratch.row);
    free(scratch.part);
    free(d->odometer_0);
    free(d->touched);
    free(d->known_blocks);
    d->odometer_0 = scratch.odometer_0;
    d->touched = scratch.touched;
    d->known_blocks = scratch.known_blocks;
    d->odometer_capacity = d->touched_capacity = bodies + 1;
    d->known_block_capacity = blocks + 1;
    d->known_block_count = blocks;
    d->any_touched = true;
    tl_contacts_unlist(d);
    return TL_OK;
}

/* ---------------------------------------------------------------- laws ------------------- */

/* Whether a contact's press lacks the volumes that its law asks for now. */
static bool lacks_volumes(const tl_model *m, uint32_t row, uint32_t law)
{
    const tl_press_row *press = tl_press_row_of(m, row);
    return press && !press->press.powers && law != TL_NO_ROW && tl_law_presses(&m->joint_laws[law]);
}

/* Contacts under another joint law belong in another span. */
static void find_laws(tl_model *m)
{
    tl_contacts *c = &m->detect->contacts;
    for (uint32_t row = 0; row < c->table.rows; row++) {
        if (c->pending[row] == TL_PENDING_DIE)
            continue;
        uint32_t law = tl_law_row(m, c->tag[row], c->a[row], c->b[row]);
        if (c->pending[row] == TL_PENDING_NONE && law != c->law[row])
            c->pending[row] = TL_PENDING_MOVE;
        if (lacks_volumes(m, row, law))
            c->points_valid_to[row] = TL_OUTDATED;
    }
}

/* Whether a contact that is a patch remains one whatever the minimum area was before. */
static bool stays_patch(const tl_model *m, uint32_t row)
{
    const tl_contacts *c = &m->detect->contacts;
    if (c->point_count[row] == 0 || tl_facet_is_field(&c->facet[row]))
        return false;
    tl_min_area_rule rule = tl_min_area_of(m, c->tag[row]);
    double mean = fmin(m->blocks.mean_face[c->a[row]], m->blocks.mean_face[c->b[row]]);
    double min_area = isnan(rule.absolute) ? rule.fraction * mean : rule.absolute;
    return min_area <= SURE_MIN_AREA * c->area[row];
}

/* Forgets what shows that a pair touches without area; without a contact it is tested again. */
static void wake_pair(tl_detect *d, uint32_t i)
{
    tl_pair *p = &d->pairs[i];
    tl_pair_faces faces = tl_pair_faces_of(p);
    if (tl_pair_is_apart(p) && faces.one != faces.other) {
        p->wake = AWAKE;
        d->chunks[i / TL_PAIR_CHUNK].wake = AWAKE;
    }
    tl_pair_forget_faces(p);
}

/* Pairs that touch without area are tested again, but for those that have nothing in common. */
static void wake_pairs(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)thread;
    tl_model *m = user;
    tl_detect *d = m->detect;
    for (uint32_t i = (uint32_t)begin; i < end; i++) {
        tl_pair *p = &d->pairs[i];
        tl_pair_faces faces = tl_pair_faces_of(p);
        if (!tl_pair_is_apart(p) || faces.one == faces.other) {
            wake_pair(d, i);
            continue;
        }
        tl_pair_view view = tl_pair_view_of(m, p->a, p->b);
        if (!tl_grazing_only_touches(&view, p)) {
            wake_pair(d, i);
            continue;
        }
        tl_pair_forget_faces(p);
        tl_pair_sleep(d, p, TL_STILL * view.size);
        if (p->wake < d->chunks[chunk].wake)
            d->chunks[chunk].wake = p->wake;
    }
}

/* Under another minimum area contacts that are no patches, or too small ones, are made anew, and pairs that only
 * touched are looked at again; under another rule for the points of patches, all are made anew. */
static void find_rules(tl_model *m)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    bool all = d->contact_points != m->config.contact_points;
    tl_parallel_for(m->pool, d->pair_count, TL_PAIR_CHUNK, wake_pairs, m);
    for (uint32_t row = 0; row < c->table.rows; row++) {
        if (c->pending[row] == TL_PENDING_DIE)
            continue;
        bool patch = stays_patch(m, row);
        if (all || !patch)
            c->points_valid_to[row] = TL_OUTDATED;
        if (!patch && tl_facet_is_patch(&c->facet[row]))
            c->faces_valid_to[row] = TL_OUTDATED;
    }
}

/* ---------------------------------------------------------------- frames ----------------- */

/* Puts the planes that a field contact keeps into the frames that its blocks' bodies have now. */
static void reframe_faces(tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_press_row *row = tl_press_row_of(m, c);
    for (int of_b = 0; row && of_b < 2; of_b++) {
        tl_block_frame now = tl_block_frame_of(m, of_b ? contacts->b[c] : contacts->a[c]);
        if (memcmp(&now, &row->frame[of_b], sizeof now) == 0)
            continue;
        row->shifted_at[of_b] = tl_plane_reframed(row->shifted_at[of_b], &row->frame[of_b], &now);
        row->lean[of_b] = tl_plane_reframed(row->lean[of_b], &row->frame[of_b], &now);
        row->frame[of_b] = now;
    }
}

static void reframe_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    tl_model *m = user;
    const tl_contacts *c = &m->detect->contacts;
    for (uint32_t row = (uint32_t)begin; row < end; row++)
        if (c->pending[row] != TL_PENDING_DIE && (tl_block_is_new(m, c->a[row]) || tl_block_is_new(m, c->b[row]))) {
            reframe_faces(m, row);
            tl_contact_reframe(m, row, thread);
        }
}

void tl_edits_follow(tl_model *m, bool rows)
{
    tl_detect *d = m->detect;
    if (d->rules != m->rules) /* before contacts note the room they want in the place of faces */
        find_rules(m);
    if (d->laws != m->laws)
        find_laws(m);
    if (rows)
        tl_parallel_for(m->pool, d->contacts.table.rows, CONTACT_CHUNK, reframe_range, m);
}
