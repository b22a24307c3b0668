/* create.c - a block of each solid. One that bends inward is divided into convex blocks, or refused. */
#include "solids.h"

#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>

/* Tolerance: relative difference of the volumes of a surface and of the hull of its corners. */
#define VOLUME 1e-3

/* The volume within the faces of a solid. */
static double volume_of(const solids *s, size_t i)
{
    const tl_vec3 *vertex = s->vertex + s->solid[i].vertex;
    double volume6 = 0;
    for (uint32_t f = s->solid[i].face; f < solid_faces(s, i); f++) {
        tl_vec3 a = tl_v3_sub(vertex[s->corner[s->start[f]]], vertex[0]);
        for (uint32_t h = s->start[f] + 1; h + 1 < s->start[f + 1]; h++)
            volume6 += tl_v3_dot(a, tl_v3_cross(tl_v3_sub(vertex[s->corner[h]], vertex[0]),
                                                tl_v3_sub(vertex[s->corner[h + 1]], vertex[0])));
    }
    return volume6 / 6;
}

static const char *group_of(const solids *s, size_t i)
{
    const char *group = s->soup.names + s->soup.object[s->solid[i].object].group;
    return s->group[0] ? s->group : group[0] ? group : "rock";
}

static tl_status refuse_reason(solids *s, size_t i)
{
    char text[NAME_TEXT], reason[300];
    tl_text_print(reason, sizeof reason, "%s", s->host->reason(s->host));
    s->solid[i].refused = true;
    return refuse_object(
        s, s->solid[i].object, 0, "%s%s: %s", s->done[s->solid[i].object].shells > 1 ? ", as " : "",
        s->done[s->solid[i].object].shells > 1 ? object_name(s, s->solid[i].object, s->solid[i].shell, text) : "",
        reason);
}

/* Makes joined convex blocks of a solid that bends inward. Its corners have been moved into the planes of its sides, so
 * it is cut as exactly as they lie in them. With the corners a seam of the parts lies in one plane. */
static tl_status create_parts(solids *s, size_t i)
{
    solid *o = &s->solid[i];
    const uint32_t faces = solid_faces(s, i) - o->face;
    if (!s->split && o->reflex) {
        const tl_vec3 *p = o->reflex_at;
        o->refused = true;
        return refuse_object(
            s, o->object, 0,
            " is not convex: it bends inward at the edge from {%.6g, %.6g, %.6g} to {%.6g, %.6g, %.6g}; "
            "divide it into convex solids, or set split = true",
            p[0].x, p[0].y, p[0].z, p[1].x, p[1].y, p[1].z);
    }
    uint32_t *start = malloc((faces + 1) * sizeof *start);
    if (!start)
        return soup_no_memory(&s->soup);
    for (uint32_t f = 0; f <= faces; f++)
        start[f] = s->start[o->face + f] - s->start[o->face];
    const tl_solid_shape shape = {.size = sizeof shape,
                                  .vertices = s->vertex + o->vertex,
                                  .vertex_count = solid_vertices(s, i) - o->vertex,
                                  .start = start,
                                  .loops = s->corner + s->start[o->face],
                                  .face_count = faces,
                                  .density = s->density,
                                  .group = group_of(s, i),
                                  .flat = o->off,
                                  .whole = !s->split};
    size_t parts = 0;
    tl_status status = s->host->create_solid(s->host, &shape, &parts);
    free(start);
    o->parts = (uint32_t)parts;
    return status == TL_E_GEOMETRY ? refuse_reason(s, i) : status;
}

/* Makes the hull of a solid that bends inward nowhere. One that does not hold what the faces hold is divided. */
static tl_status create_hull(solids *s, size_t i)
{
    const tl_host *host = s->host;
    const solid *o = &s->solid[i];
    double volume = volume_of(s, i);
    tl_status status =
        host->create_hull(host, s->vertex + o->vertex, solid_vertices(s, i) - o->vertex, s->density, group_of(s, i));
    if (status == TL_E_GEOMETRY)
        return create_parts(s, i);
    if (status != TL_OK)
        return status;
    s->solid[i].parts = 1;
    tl_block_info info = {.size = sizeof info};
    size_t last = host->block_count(host) - 1;
    host->block_info(host, last, &info);
    if (fabs(info.volume - volume) <= VOLUME * volume)
        return TL_OK;
    status = host->remove(host, last);
    return status == TL_OK ? create_parts(s, i) : status;
}

tl_status blocks_create(solids *s)
{
    tl_status status = TL_OK;
    for (size_t i = 0; i < s->solids && status == TL_OK; i++) {
        if (s->solid[i].refused)
            continue;
        status = s->solid[i].reflex ? create_parts(s, i) : create_hull(s, i);
        if (status == TL_OK)
            status = s->host->progress(s->host, 0.7 + 0.3 * (double)(i + 1) / (double)s->solids);
    }
    return status;
}
