/* solid_part.c - a piece without reflex edges as a convex polyhedron.
 *
 * Faces that meet at a flat edge become one face: a cut goes on in the plane of the face that it began at. It has the
 * tag that most of its outer area has. Vertices where fewer than three faces meet are left out: they lie on straight
 * edges. */
#include "geometry/solid_part.h"

#include "base/error.h"
#include "geometry/make.h"
#include "geometry/measure.h"

#include <math.h>
#include <stdlib.h>
#include <talus/vmath.h>

/* Tolerance: corners and edges of parts miss being convex by less than this times the size, beside what is flat. */
#define CONVEX 1e-8

/* What a face of the part has of one tag. */
typedef struct share {
    tl_tag tag;
    double area;
} share;

typedef struct builder {
    tl_solid_mesh *m;
    tl_error *error;
    uint32_t *list, lists, capacity;            /* first half-edges of the loops of faces */
    uint32_t *corner, corners, corner_capacity; /* vertices of all loops */
    uint32_t *start, starts, start_capacity;
    uint32_t *queue, queued, queue_capacity; /* faces of the mesh, those that become one together */
    share *share;
    uint32_t shares, share_capacity;
    tl_tag *tag;    /* of the faces */
    uint32_t *main; /* the face of the mesh of the largest area: its plane is that of the face */
    uint32_t tag_capacity, main_capacity;
} builder;

static bool list_face(builder *b, uint32_t face, uint32_t region)
{
    tl_solid_face *f = &b->m->face[face];
    if (!tl_solid_grow(&b->queue, &b->queue_capacity, b->queued, sizeof *b->queue))
        return false;
    b->queue[b->queued++] = face;
    f->mark = b->m->stamp;
    f->slot = region;
    return true;
}

/* Lists faces that meet at flat edges one after the other; `slot` becomes the place of the first of
 * them in the list. */
static bool list_regions(builder *b, const uint32_t *face, uint32_t count)
{
    tl_solid_mesh *m = b->m;
    const uint32_t stamp = tl_solid_stamp(m);
    for (uint32_t i = 0, done = 0; i < count; i++) {
        if (m->face[face[i]].mark == stamp)
            continue;
        const uint32_t region = done;
        if (!list_face(b, face[i], region))
            return false;
        for (; done < b->queued; done++)
            TL_EACH_HALF(m, b->queue[done], h, first)
            {
                const uint32_t across = m->half[m->half[h].mate].face;
                if (m->half[h].flat && m->face[across].mark != stamp && !list_face(b, across, region))
                    return false;
            }
    }
    return true;
}

/* Whether an edge lies inside a face of the part. */
static bool is_inner(const tl_solid_mesh *m, uint32_t h)
{
    return m->face[m->half[h].face].slot == m->face[m->half[m->half[h].mate].face].slot;
}

static uint32_t outline_after(const tl_solid_mesh *m, uint32_t h)
{
    uint32_t next = m->half[h].next;
    while (is_inner(m, next))
        next = m->half[m->half[next].mate].next;
    return next;
}

/* Lists the outlines of faces, and counts them at each vertex; false without memory. */
static bool list_outlines(builder *b, const uint32_t *face, uint32_t count)
{
    tl_solid_mesh *m = b->m;
    const uint32_t stamp = tl_solid_stamp(m);
    for (uint32_t i = 0; i < count; i++) {
        TL_EACH_HALF(m, face[i], h, first)
        {
            if (m->half_mark[h] == stamp || is_inner(m, h))
                continue;
            if (!tl_solid_grow(&b->list, &b->capacity, b->lists, sizeof *b->list))
                return false;
            b->list[b->lists++] = h;
            for (uint32_t k = h; m->half_mark[k] != stamp; k = outline_after(m, k)) {
                const uint32_t v = m->half[k].from;
                m->half_mark[k] = stamp;
                m->side[v] = (int8_t)(m->vertex_mark[v] == stamp ? m->side[v] < 3 ? m->side[v] + 1 : 3 : 1);
                m->vertex_mark[v] = stamp;
            }
        }
    }
    return true;
}

/* Lists the corners of the faces, without vertices on straight edges. */
static bool list_corners(builder *b)
{
    const tl_solid_mesh *m = b->m;
    for (uint32_t i = 0; i < b->lists; i++) {
        if (!tl_solid_grow(&b->start, &b->start_capacity, b->starts, sizeof *b->start))
            return false;
        b->start[b->starts++] = b->corners;
        uint32_t h = b->list[i];
        do {
            const uint32_t v = m->half[h].from;
            if (m->side[v] >= 3) {
                if (!tl_solid_grow(&b->corner, &b->corner_capacity, b->corners, sizeof *b->corner))
                    return false;
                b->corner[b->corners++] = v;
            }
            h = outline_after(m, h);
        } while (h != b->list[i]);
    }
    return tl_solid_grow(&b->start, &b->start_capacity, b->starts, sizeof *b->start);
}

static bool add_share(builder *b, tl_tag tag, double area)
{
    for (uint32_t i = 0; i < b->shares; i++)
        if (b->share[i].tag.joint == tag.joint && b->share[i].tag.plane == tag.plane) {
            b->share[i].area += area;
            return true;
        }
    if (!tl_solid_grow(&b->share, &b->share_capacity, b->shares, sizeof *b->share))
        return false;
    b->share[b->shares++] = (share){tag, area};
    return true;
}

/* Finds tag and plane of a face of the part. */
static bool find_tag(builder *b, uint32_t number)
{
    const tl_solid_mesh *m = b->m;
    const uint32_t region = m->face[m->half[b->list[number]].face].slot;
    double largest = -INFINITY;
    b->shares = 0;
    for (uint32_t k = region; k < b->queued && m->face[b->queue[k]].slot == region; k++) {
        const tl_solid_face *f = &m->face[b->queue[k]];
        const tl_vec3 n = tl_solid_normal(m, b->queue[k]);
        double area = 0;
        for (uint32_t first = f->first; first != TL_SOLID_NONE; first = m->half[first].ring)
            area += tl_v3_dot(n, tl_solid_loop_area(m, first));
        if (area > largest) {
            largest = area;
            b->main[number] = b->queue[k];
        }
        /* a needle lies on any plane through it */
        if (!f->inside && area > m->on * f->radius && !add_share(b, f->tag, area))
            return false;
    }
    share most = {{0, 0}, -INFINITY};
    for (uint32_t k = 0; k < b->shares; k++)
        if (b->share[k].area > most.area)
            most = b->share[k];
    b->tag[number] = most.tag;
    return true;
}

/* Finds tags and planes of the faces. */
static bool list_tags(builder *b)
{
    for (uint32_t i = 0; i < b->lists; i++)
        if (!tl_solid_grow(&b->tag, &b->tag_capacity, i, sizeof *b->tag) ||
            !tl_solid_grow(&b->main, &b->main_capacity, i, sizeof *b->main) || !find_tag(b, i))
            return false;
    return true;
}

static tl_status refuse(const builder *b, const char *why)
{
    const tl_vec3 at = b->lists ? tl_solid_shown(b->m, b->m->half[b->list[0]].from) : tl_v3(0, 0, 0);
    return tl_fail(
        b->error, TL_E_GEOMETRY,
        "the solid could not be divided into convex parts: one at {%g, %g, %g} %s; its faces may be bent or lie "
        "on each other",
        at.x, at.y, at.z, why);
}

/* What tl_poly_make takes. */
typedef struct tables {
    tl_vec3 *vertex;
    tl_plane *plane;
    tl_tag *tag;
    uint16_t *loop;
} tables;

static uint32_t fill_tables(const builder *b, const tables *t)
{
    tl_solid_mesh *m = b->m;
    const uint32_t stamp = tl_solid_stamp(m);
    uint32_t vertices = 0;
    for (uint32_t i = 0; i < b->corners; i++) {
        const uint32_t v = b->corner[i];
        if (m->vertex_mark[v] != stamp) {
            m->vertex_mark[v] = stamp;
            m->height[v] = vertices; /* its number in the part */
            t->vertex[vertices++] = m->vertex[v];
        }
        t->loop[i] = (uint16_t)m->height[v];
    }
    for (uint32_t i = 0; i < b->starts; i++) {
        const uint32_t face = b->main[i];
        const tl_vec3 n = tl_solid_normal(m, face);
        const double offset = m->plane[m->face[face].plane].offset;
        t->plane[i] = (tl_plane){n, m->face[face].turned ? -offset : offset};
        t->tag[i] = b->tag[i];
    }
    return vertices;
}

static tl_status check_part(const builder *b, const tl_poly *part)
{
    tl_error why;
    const tl_status status = tl_poly_check(part, CONVEX + 4 * b->m->on / part->size, &why);
    return status == TL_E_GEOMETRY ? refuse(b, "is not convex") : status;
}

static tl_status make_part(builder *b, tl_poly **part)
{
    if (b->starts > TL_POLY_MAX_FACES || b->corners > 2 * TL_POLY_MAX_EDGES)
        return refuse(b, "has more than 4096 faces or corners");
    b->start[b->starts] = b->corners;
    const size_t n = (size_t)b->corners + 1;
    const tables t = {malloc(n * sizeof *t.vertex), malloc(((size_t)b->starts + 1) * sizeof *t.plane),
                      malloc(((size_t)b->starts + 1) * sizeof *t.tag), malloc(n * sizeof *t.loop)};
    tl_status status = TL_E_MEMORY;
    if (t.vertex && t.plane && t.tag && t.loop) {
        const uint32_t vertices = fill_tables(b, &t);
        status = tl_poly_make(t.vertex, vertices, t.plane, t.tag, b->start, t.loop, b->starts, part, NULL);
    }
    free(t.vertex);
    free(t.plane);
    free(t.tag);
    free(t.loop);
    if (status != TL_OK)
        return status == TL_E_MEMORY ? tl_fail_memory(b->error) : refuse(b, "does not close");
    status = check_part(b, *part);
    if (status != TL_OK) {
        tl_poly_free(*part);
        *part = NULL;
    }
    return status;
}

tl_status tl_solid_part(tl_solid_mesh *m, const uint32_t *face, uint32_t count, tl_poly **part, tl_error *error)
{
    builder b = {.m = m, .error = error};
    *part = NULL;
    const tl_status status =
        list_regions(&b, face, count) && list_outlines(&b, face, count) && list_corners(&b) && list_tags(&b)
            ? make_part(&b, part)
            : tl_fail_memory(error);
    free(b.list);
    free(b.corner);
    free(b.start);
    free(b.queue);
    free(b.share);
    free(b.tag);
    free(b.main);
    return status;
}
