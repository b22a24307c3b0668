/* scene_contacts.c - CONT and the extra fields of contacts. */
#include "io/scene_contacts.h"

#include "base/parallel.h"
#include "contact/detection.h"
#include "force/bear.h"
#include "io/extra_fields.h"
#include "io/pieces.h"
#include "io/scene_numbers.h"
#include "io/scene_put.h"
#include "io/verdict.h"
#include "query/contact_fields.h"
#include "query/contact_polygons.h"
#include "query/point_fields.h"

#include <stdlib.h>

/* Contacts that a thread takes at a time. */
#define CHUNK 512
/* Where there are more contacts, a frame has those that slip. */
#define FEW 20000

typedef struct contacts {
    tl_model *model;
    uint32_t *rows;          /* of contacts with points, in order of id */
    tl_contact_facts *facts; /* of each */
    size_t listed;
    uint32_t *picked; /* of these, the contacts of the frame */
    size_t count;
    tl_law_states states;
    unsigned char *id, *a, *b, *joint, *plane, *point, *normal, *force, *area, *gap, *slip, *used,
        *state;
} contacts;

/* ---------------------------------------------------------------- which ------------------ */

static void find_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const contacts *c = user;
    for (size_t i = begin; i < end; i++)
        c->facts[i] = tl_contact_facts_of(c->model, c->rows[i]);
}

static void pick(contacts *c, int32_t choice)
{
    bool all =
        choice == TL_HTML_CONTACTS_ALL || (choice == TL_HTML_CONTACTS_FEW && c->listed <= FEW);
    for (size_t i = 0; i < c->listed; i++)
        if (all || c->facts[i].state == TL_CONTACT_SLIPPING)
            c->picked[c->count++] = (uint32_t)i;
}

/* ---------------------------------------------------------------- columns ---------------- */

static void put_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const contacts *c = user;
    for (size_t i = begin; i < end; i++) {
        const tl_contact_facts *facts = &c->facts[c->picked[i]];
        uint32_t row = c->rows[c->picked[i]];
        tl_vec3 force = tl_v3_madd(facts->shear_force, facts->normal_force, facts->normal);
        tl_put_u32(c->id + 4 * i, facts->id);
        tl_put_u32(c->a + 4 * i, facts->a);
        tl_put_u32(c->b + 4 * i, facts->b);
        tl_put_u32(c->joint + 4 * i, facts->tag.joint);
        tl_put_u32(c->plane + 4 * i, facts->tag.plane);
        tl_put_vec3(c->point + 12 * i, tl_v3_sub(facts->point, c->model->origin));
        tl_put_vec3(c->normal + 12 * i, facts->normal);
        tl_put_vec3(c->force + 12 * i, force);
        tl_put_f32(c->area + 4 * i, facts->area);
        tl_put_f32(c->gap + 4 * i, facts->gap);
        tl_put_f32(c->slip + 4 * i,
                   tl_law_states_slip(c->model, &c->states, row, facts->shear_displacement));
        tl_put_u8(c->state + i, (uint32_t)facts->state);
    }
}

/* The polygons, contact by contact. */
static void put_polygons(const tl_contact_polygons *p, unsigned char *to)
{
    for (size_t i = 0; i < p->contacts; i++)
        for (uint32_t k = p->first[i]; k < p->first[i + 1]; k++)
            to = tl_put_u32(to, (uint32_t)i);
    for (size_t k = 0; k < p->polygons; k++)
        to = tl_put_u32(to, p->start[k + 1] - p->start[k]);
    for (size_t k = 0; k < p->corners; k++)
        to = tl_put_vec3(to, p->corner[k]);
}

static tl_status put_columns(contacts *c, const tl_contact_polygons *p, tl_piece *out)
{
    size_t n = c->count;
    size_t bytes = 12 + 72 * n + tl_scene_column_bytes(n, 1) + 8 * p->polygons + 12 * p->corners;
    unsigned char *to = tl_scene_chunk(out, "CONT", bytes, &c->model->error);
    if (!to)
        return c->model->error.status;
    to = tl_put_u32(to, (uint32_t)n);
    to = tl_put_u32(to, (uint32_t)p->polygons);
    to = tl_put_u32(to, (uint32_t)p->corners);
    c->id = tl_scene_column(&to, n, 4);
    c->a = tl_scene_column(&to, n, 4);
    c->b = tl_scene_column(&to, n, 4);
    c->joint = tl_scene_column(&to, n, 4);
    c->plane = tl_scene_column(&to, n, 4);
    c->point = tl_scene_column(&to, n, 12);
    c->normal = tl_scene_column(&to, n, 12);
    c->force = tl_scene_column(&to, n, 12);
    c->area = tl_scene_column(&to, n, 4);
    c->gap = tl_scene_column(&to, n, 4);
    c->slip = tl_scene_column(&to, n, 4);
    c->used = tl_scene_column(&to, n, 4);
    c->state = tl_scene_column(&to, n, 1);
    tl_parallel_for(c->model->pool, n, CHUNK, put_range, c);
    for (size_t i = 0; i < n; i++) /* the law is asked, on one thread */
        tl_put_f32(c->used + 4 * i, tl_contact_shear_used(c->model, c->rows[c->picked[i]]));
    put_polygons(p, to);
    return TL_OK;
}

static tl_status put_contacts(contacts *c, tl_piece *out)
{
    tl_contact_polygons polygons = {0};
    uint32_t *rows = malloc((c->count + 1) * sizeof *rows);
    for (size_t i = 0; rows && i < c->count; i++)
        rows[i] = c->rows[c->picked[i]];
    tl_status status = rows ? tl_contact_polygons_find(c->model, rows, c->count, &polygons)
                            : tl_fail_memory(&c->model->error);
    if (status == TL_OK)
        status = put_columns(c, &polygons, out);
    tl_contact_polygons_free(&polygons);
    free(rows);
    return status;
}

static tl_status put_fields(const contacts *c, const tl_html *options, tl_piece *out)
{
    tl_error *error = &c->model->error;
    size_t first = options->block_field_count, count = options->contact_field_count;
    tl_status status = tl_extra_fields_check("contact_fields", options->contact_fields, count,
                                             c->listed, "contacts", error);
    for (size_t i = 0; status == TL_OK && i < count; i++)
        status = tl_scene_field(error, 1, first + i, options->contact_fields[i].values, c->picked,
                                c->count, out);
    return status;
}

tl_status tl_scene_contacts(tl_model *m, const tl_html *options, double median, tl_piece *out,
                            tl_verdict *verdict)
{
    const bool wanted = options->contacts != TL_HTML_CONTACTS_NONE;
    contacts c = {.model = m};
    tl_status status = tl_contacts_listed(m, &c.rows, &c.listed);
    if (status == TL_OK)
        status = tl_law_states_list(m, &c.states);
    if (status == TL_OK) {
        c.facts = malloc((c.listed + 1) * sizeof *c.facts);
        c.picked = malloc((c.listed + 1) * sizeof *c.picked);
        if (!c.facts || !c.picked)
            status = tl_fail_memory(&m->error);
    }
    if (status == TL_OK) {
        tl_parallel_for(m->pool, c.listed, CHUNK, find_range, &c);
        status = tl_verdict_of(m, median, c.rows, c.facts, c.listed, verdict);
    }
    if (status == TL_OK && wanted) {
        pick(&c, options->contacts);
        status = put_contacts(&c, out);
    }
    if (status == TL_OK && wanted)
        status = put_fields(&c, options, out);
    tl_law_states_free(&c.states);
    free(c.picked);
    free(c.facts);
    free(c.rows);
    return status;
}
