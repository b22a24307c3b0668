/* sound.c - whether a detection that was read from a file fits together. The file may hold anything: what is used as
 * the number of a row, a face, a lane or a choice must be one, and a bool must be one. What the numbers of the
 * mechanics are does not matter here, as long as places are finite. */
#include "contact/sound.h"

#include "base/walk.h"
#include "contact/kind.h"
#include "narrow/narrow.h"

/* A face number that every block may have had which has gone. */
#define ANY_FACES UINT32_MAX

/* Faces of the block that had a row when the detection last looked: as long as a block lives it keeps them, though not
 * their places and tags. */
static uint32_t faces_of(const tl_model *m, const tl_detect *d, uint32_t seen)
{
    uint32_t row = tl_block_row_quiet(m, d->known_blocks[seen].id);
    return row == TL_NO_ROW ? ANY_FACES : m->blocks.shape[row]->face_count;
}

/* The same of the planes (polyhedron.h), which a block that has come to another body has not kept; contacts of such are
 * made anew. */
static uint32_t planes_of(const tl_model *m, const tl_detect *d, uint32_t seen)
{
    uint32_t row = tl_block_row_quiet(m, d->known_blocks[seen].id);
    bool kept = row != TL_NO_ROW && m->blocks.changed[row] <= d->structure;
    return kept ? m->blocks.shape[row]->plane_count : ANY_FACES;
}

/* ---------------------------------------------------------------- pairs ------------------ */

/* Whether the faces of a pair are there. A contact for which something is still to be done may have something else in
 * their place; it forgets that when it is done. */
static bool pair_faces_are_sound(const tl_model *m, const tl_detect *d, const tl_pair *p)
{
    const tl_contacts *c = &d->contacts;
    uint8_t pending = tl_pair_is_apart(p) ? TL_PENDING_NONE : c->pending[p->contact];
    if (tl_pending_waits(pending) || pending == TL_PENDING_DIE ||
        (pending == TL_PENDING_MOVE && c->point_count[p->contact] > 0))
        return true;
    tl_pair_faces f = tl_pair_faces_of(p);
    const uint32_t faces[] = {f.one, f.other};
    for (int k = 0; k < 2; k++)
        if (faces[k] / 2 >= faces_of(m, d, faces[k] % 2 ? p->b : p->a))
            return false;
    return true;
}

static bool pair_is_sound(const tl_model *m, const tl_detect *d, uint32_t index)
{
    const tl_pair *p = &d->pairs[index];
    if (p->a >= p->b || p->b >= d->known_block_count)
        return false;
    if (!tl_pair_is_apart(p) && (p->contact >= d->contacts.table.rows || d->contacts.pair[p->contact] != index ||
                                 d->contacts.a[p->contact] != p->a || d->contacts.b[p->contact] != p->b))
        return false;
    return pair_faces_are_sound(m, d, p);
}

/* What is known of blocks and bodies as they were when the detection last looked: as they are, if nothing was edited
 * since. */
static bool seen_are_sound(const tl_model *m, const tl_detect *d)
{
    size_t blocks = m->blocks.table.rows;
    if (d->listed && d->structure == m->structure && d->known_block_count != blocks)
        return false;
    if (d->listed && (d->path_capacity < d->known_block_count || d->structure > m->structure))
        return false;
    for (size_t row = 0; row < d->known_block_count; row++) {
        const tl_known_block *s = &d->known_blocks[row];
        if (s->body >= d->odometer_capacity || s->body >= d->touched_capacity || s->body >= d->idle_capacity ||
            s->id <= (row ? d->known_blocks[row - 1].id : 0))
            return false;
        if (d->structure == m->structure && (s->id != m->blocks.id[row] || s->body != m->blocks.body[row]))
            return false;
    }
    return true;
}

static bool pairs_are_sound(const tl_model *m, const tl_detect *d)
{
    size_t chunks = (d->pair_count + TL_PAIR_CHUNK - 1) / TL_PAIR_CHUNK;
    if (d->pair_count >= TL_PAIR_APART || d->chunk_capacity < chunks)
        return false;
    for (uint32_t i = 0; i < d->pair_count; i++)
        if (!pair_is_sound(m, d, i))
            return false;
    for (size_t i = 0; i < d->chunk_capacity; i++)
        if (!tl_is_flag(&d->chunks[i].found))
            return false;
    return true;
}

/* ---------------------------------------------------------------- presses ---------------- */

static bool apex_is_sound(const tl_apex_faces *apex, uint32_t faces)
{
    if (!tl_is_flag(&apex->known) || apex->holds > 3 || apex->strays > TL_APEX_STRAYS)
        return false;
    for (uint32_t k = 0; k < apex->holds; k++)
        if (apex->held[k] >= faces)
            return false;
    for (uint32_t k = 0; k < apex->strays; k++)
        if (apex->stray[k] >= faces)
            return false;
    return true;
}

static bool planes_are_sound(const uint8_t *plane, uint32_t count, uint32_t faces)
{
    for (uint32_t k = 0; k < count; k++)
        if (plane[k] >= faces && plane[k] != TL_MESH_ZERO)
            return false;
    return true;
}

static bool mesh_is_sound(const tl_field_mesh *mesh, uint32_t faces)
{
    if (mesh->corners > TL_MESH_CORNERS || mesh->polygons > TL_MESH_POLYGONS || !apex_is_sound(&mesh->apex[0], faces) ||
        !apex_is_sound(&mesh->apex[1], faces) || (faces < TL_FIELD_KNOWN && mesh->bounding >> faces != 0) ||
        !planes_are_sound(mesh->own[0], 2u * mesh->polygons, faces))
        return false;
    for (int k = 0; k < 4; k++)
        if (!planes_are_sound(mesh->plane[k], tl_mesh_lanes(mesh), faces))
            return false;
    uint32_t sides = 0;
    for (uint32_t k = 0; k < mesh->polygons; k++) {
        if (mesh->sides[k] < 3)
            return false;
        sides += mesh->sides[k];
    }
    if (sides > TL_MESH_SIDES)
        return false;
    for (uint32_t k = 0; k < sides; k++)
        if (mesh->loop[k] >= mesh->corners)
            return false;
    return true;
}

static bool press_is_sound(const tl_model *m, const tl_detect *d, const tl_press_row *row, uint32_t a, uint32_t b)
{
    if (!tl_is_flag(&row->press.powers) || !tl_is_flag(&row->flush) || !tl_is_flag(&row->listed) ||
        !tl_is_flag(&row->by_slope) || !tl_is_flag(&row->leans) || !tl_is_flag(&row->refused) ||
        !(row->shifted.a < faces_of(m, d, a) && row->shifted.b < faces_of(m, d, b)))
        return false;
    uint32_t sum = 0;
    for (int k = 0; k < 4; k++)
        for (uint32_t i = 0; i < row->count[k]; i++) {
            if (sum == TL_PRESS_FACES || row->face[sum] >= planes_of(m, d, k % 2 ? b : a))
                return false;
            sum++;
        }
    if (row->blunt_a > row->count[0] || row->blunt_b > row->count[1])
        return row->listed ? false : true;
    return mesh_is_sound(&row->mesh, sum) &&
           (row->by_slope ? tl_is_flag(&row->slope.known) && tl_is_flag(&row->there.powers)
                          : mesh_is_sound(&row->flat, sum));
}

/* The rows of presses: each is a contact's, or in the list of free ones. */
static bool presses_are_sound(const tl_model *m, const tl_detect *d, unsigned char *used)
{
    size_t count = d->press_count, rows = 0, free_rows = 0;
    bool sound = d->balance_left >= 0 && d->balance_left <= 1;
    for (uint32_t c = 0; c < d->contacts.table.rows && sound; c++) {
        uint32_t row = d->contacts.press[c];
        if (row == TL_NO_ROW)
            continue;
        sound = row < count && !used[row] && press_is_sound(m, d, &d->press[row], d->contacts.a[c], d->contacts.b[c]);
        if (sound)
            used[row] = 1;
        rows++;
    }
    for (uint32_t row = count ? d->press_free : TL_NO_ROW; sound && row != TL_NO_ROW; row = d->press[row].next_free) {
        sound = row < count && !used[row];
        if (!sound)
            break;
        used[row] = 1;
        free_rows++;
    }
    return sound && rows + free_rows == count;
}

/* ---------------------------------------------------------------- contacts --------------- */

static bool facet_is_sound(const tl_model *m, const tl_detect *d, uint32_t row)
{
    const tl_contacts *c = &d->contacts;
    const tl_facet *f = &c->facet[row];
    if (f->kind >= d->kind_count || !(f->ride >= 0 && f->ride <= 1))
        return false;
    if (c->point_count[row] == 0)
        return f->ia < TL_POLY_MAX_FACES && f->ib < TL_POLY_MAX_FACES;
    return tl_contact_kind_of(d, row)->place->sound(d, row, faces_of(m, d, c->a[row]), faces_of(m, d, c->b[row]));
}

static bool contact_is_sound(const tl_model *m, const tl_detect *d, uint32_t row)
{
    const tl_contacts *c = &d->contacts;
    return c->born[row] >= 0 && c->born[row] <= m->cycles && c->a[row] < c->b[row] &&
           c->b[row] < d->known_block_count && c->pair[row] < d->pair_count && d->pairs[c->pair[row]].contact == row &&
           (c->law[row] < m->joint_law_count || c->law[row] == TL_NO_ROW) && c->tag[row].joint <= m->joint_count &&
           c->kind[row] < d->kind_count && c->held[row] <= 1 && c->holds_over_gap[row] <= 1 &&
           c->handed_over[row] <= 1 && c->new_points[row] <= TL_POINTS_OTHERS &&
           c->pending[row] <= TL_PENDING_GROW_PATCH && c->deep[row] <= TL_DEEP_SUNK &&
           c->point_count[row] <= c->point_capacity[row] && facet_is_sound(m, d, row);
}

/* What contacts of blocks that were cut have left. */
static bool cut_contacts_are_sound(const tl_model *m, const tl_detect *d)
{
    for (size_t i = 0; i < d->cut_count; i++) {
        const tl_cut_contact *e = &d->cut_contacts[i];
        if (e->first > d->cut_point_count || e->count > d->cut_point_count - e->first || e->field > 1 ||
            e->holds_over_gap > 1 || e->pressed > 1 || e->reframed > 1 || (e->field && e->count != 1) ||
            e->count > UINT16_MAX || (e->law != TL_NO_ROW && e->law >= m->joint_law_count))
            return false;
    }
    return true;
}

/* ---------------------------------------------------------------- layout ----------------- */

/* The lanes of a SIMD group: those that are taken belong to contacts of its span that know so. */
static bool group_is_sound(const tl_detect *d, const tl_span *span, const tl_simd_group *group, size_t *taken)
{
    const tl_contacts *c = &d->contacts;
    for (uint32_t l = 0; l < TL_LANES; l++) {
        uint32_t row = group->contact[l];
        if (row == TL_NO_ROW)
            continue;
        if (row >= c->table.rows || c->point_start[row] != group->start + l || c->point_capacity[row] != group->slots ||
            c->law[row] != span->law || c->held[row] != span->held || c->kind[row] != span->kind)
            return false;
        ++*taken;
    }
    return true;
}

/* A span's SIMD groups lie one after the other in its rows, which begin behind those of the span before. */
static bool span_is_sound(const tl_model *m, const tl_detect *d, const tl_span *span, const tl_span *before,
                          size_t *taken)
{
    if (!tl_is_flag(&span->held) || span->kind >= d->kind_count || !tl_is_flag(&span->changed) ||
        span->rest > TL_SPAN_RESTS || (span->law != TL_NO_ROW && span->law >= m->joint_law_count))
        return false;
    if (span->begin < (before ? before->limit : 0) || span->begin % TL_LANES || span->end < span->begin ||
        span->limit < span->end || span->limit > d->points.table.rows || span->limit % TL_LANES ||
        span->group_begin < (before ? before->group_limit : 0) || span->group_end < span->group_begin ||
        span->group_limit < span->group_end || span->group_limit > d->layout.group_capacity)
        return false;
    size_t at = span->begin;
    for (size_t r = span->group_begin; r < span->group_end; r++) {
        const tl_simd_group *group = &d->layout.groups[r];
        size_t rows = (size_t)group->slots * TL_LANES;
        if (group->start != at || group->slots == 0 || rows > span->end - at || !group_is_sound(d, span, group, taken))
            return false;
        at += rows;
    }
    return at == span->end;
}

static bool layout_is_sound(const tl_model *m, const tl_detect *d)
{
    size_t taken = 0, wanted = 0;
    if (d->points.table.rows > UINT32_MAX || d->layout.laid_rows > d->points.table.rows || d->layout.added_at < 0 ||
        d->layout.added_at > m->cycles)
        return false;
    for (size_t k = 0; k < d->layout.span_count; k++)
        if (!span_is_sound(m, d, &d->layout.spans[k], k ? &d->layout.spans[k - 1] : NULL, &taken))
            return false;
    for (uint32_t row = 0; row < d->contacts.table.rows; row++)
        wanted += d->contacts.point_capacity[row] > 0;
    return taken == wanted;
}

const char *tl_detect_unsound(const tl_model *m, const tl_detect *d, unsigned char *used)
{
    if (d->contacts.table.rows >= TL_PAIR_APART || d->contacts.table.rows > d->pair_count)
        return "contacts do not fit their pairs";
    if (!seen_are_sound(m, d))
        return "what was known of blocks does not fit them";
    for (uint32_t row = 0; row < d->contacts.table.rows; row++)
        if (!contact_is_sound(m, d, row))
            return "a contact does not fit its blocks";
    if (!pairs_are_sound(m, d))
        return "pairs do not fit the blocks";
    if (!cut_contacts_are_sound(m, d))
        return "what was left does not fit the contacts";
    if (!presses_are_sound(m, d, used))
        return "what field contacts keep does not fit them";
    if (d->laid_at < 0 || d->laid_at > m->cycles || !layout_is_sound(m, d))
        return "the points do not fit their contacts";
    return NULL;
}
