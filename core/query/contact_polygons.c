/* contact_polygons.c - the polygons on which contacts act, found anew from where the blocks are. */
#include "query/contact_polygons.h"

#include "base/parallel.h"
#include "contact/kind.h"
#include "contact/pair_view.h"
#include "narrow/narrow.h"
#include "narrow/surface.h"
#include "query/meeting.h"

#include <stdlib.h>
#include <string.h>

/* Contacts that a thread takes at a time: what it finds is kept until all is put in order. */
#define CHUNK 256

/* What was found of the contacts of a chunk. */
typedef struct part {
    tl_surface surface;
    bool failed; /* out of memory */
} part;

typedef struct job {
    tl_model *model;
    const uint32_t *rows;
    tl_contact_polygons *out;
    part *parts;
} job;

/* From the frame of a side to places relative to the model's origin, rounded as the user's coordinates are. */
static void place(const tl_model *m, uint32_t side, tl_vec3 *x, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        tl_vec3 at = tl_v3_add(tl_side_place(m, side), tl_side_arm(m, side, x[i]));
        x[i] = tl_v3_sub(tl_v3_add(m->origin, at), m->origin);
    }
}

/* Adds a contact's polygons. */
static bool add_polygons(tl_model *m, uint32_t c, tl_narrow_scratch *scratch, tl_surface *surface)
{
    if (tl_row_is_meeting(m, c))
        return tl_meeting_outlines(m, c, surface);
    const size_t corners = surface->corners;
    tl_pair_view view = tl_contact_view(m, c);
    if (!tl_pair_place(&view, scratch) || !tl_contact_kind_of(m->detect, c)->place->show(m, c, &view, scratch, surface))
        return false;
    place(m, tl_contact_sides(m, c).a, surface->corner + corners, surface->corners - corners);
    return true;
}

static void find_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    const job *j = user;
    part *p = &j->parts[chunk];
    for (size_t i = begin; i < end && !p->failed; i++) {
        const size_t polygons = p->surface.polygons;
        p->failed = !add_polygons(j->model, j->rows[i], &j->model->detect->narrow[thread], &p->surface);
        if (p->failed)
            break;
        j->out->first[i] = (uint32_t)(p->surface.polygons - polygons);
    }
}

/* Turns the counts in a list into the places where what they count begins. */
static size_t begin_each(uint32_t *counts, size_t count)
{
    size_t next = 0;
    for (size_t i = 0; i < count; i++) {
        size_t here = counts[i];
        counts[i] = (uint32_t)next;
        next += here;
    }
    counts[count] = (uint32_t)next;
    return next;
}

/* Puts the chunks' findings one behind the other. */
static bool join(const part *parts, size_t chunks, tl_contact_polygons *out)
{
    for (size_t k = 0; k < chunks; k++) {
        if (parts[k].failed)
            return false;
        out->polygons += parts[k].surface.polygons;
        out->corners += parts[k].surface.corners;
    }
    if (out->corners > UINT32_MAX)
        return false;
    out->start = malloc((out->polygons + 1) * sizeof *out->start);
    out->corner = malloc((out->corners + 1) * sizeof *out->corner);
    if (!out->start || !out->corner)
        return false;
    size_t polygon = 0, corner = 0;
    for (size_t k = 0; k < chunks; k++) {
        const tl_surface *s = &parts[k].surface;
        if (s->polygons == 0)
            continue;
        memcpy(out->start + polygon, s->size, s->polygons * sizeof *s->size);
        memcpy(out->corner + corner, s->corner, s->corners * sizeof *s->corner);
        polygon += s->polygons;
        corner += s->corners;
    }
    begin_each(out->first, out->contacts);
    begin_each(out->start, out->polygons);
    return true;
}

tl_status tl_contact_polygons_find(tl_model *m, const uint32_t *rows, size_t count, tl_contact_polygons *out)
{
    size_t chunks = (count + CHUNK - 1) / CHUNK;
    *out = (tl_contact_polygons){.contacts = count};
    out->first = calloc(count + 1, sizeof *out->first);
    job j = {m, rows, out, calloc(chunks + 1, sizeof *j.parts)};
    bool found = out->first && j.parts;
    if (found) {
        tl_parallel_for(m->pool, count, CHUNK, find_range, &j);
        found = join(j.parts, chunks, out);
    }
    for (size_t k = 0; j.parts && k < chunks; k++) {
        free(j.parts[k].surface.corner);
        free(j.parts[k].surface.size);
    }
    free(j.parts);
    return found ? TL_OK : tl_fail_memory(&m->error);
}

void tl_contact_polygons_free(tl_contact_polygons *polygons)
{
    free(polygons->first);
    free(polygons->start);
    free(polygons->corner);
    *polygons = (tl_contact_polygons){0};
}
