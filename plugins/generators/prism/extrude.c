/* extrude.c - one body of a plane polygon and the same moved by a vector: a block for each of its convex parts, joined. The
 * faces in which the parts meet are no joints: nothing slides there, and no contact is looked for. */
#include "prism.h"

#include <talus/vmath.h>

#include <stdlib.h>

static tl_status refuse(const tl_host *host, const char *name, convex_status why, size_t one,
                        size_t other, size_t count)
{
    switch (why) {
    case CONVEX_MEMORY: return host->fail(host, TL_E_MEMORY, "out of memory");
    case CONVEX_COINCIDE:
        return host->fail(host, TL_E_GEOMETRY, "%s: points %zu and %zu coincide; leave one out",
                          name, one + 1, other + 1);
    case CONVEX_CROSSES:
        return host->fail(
            host, TL_E_GEOMETRY,
            "%s crosses or touches itself: the edge from point %zu to %zu meets the one "
            "from point %zu to %zu; a section with a hole is given as several without",
            name, one + 1, (one + 1) % count + 1, other + 1, (other + 1) % count + 1);
    case CONVEX_EMPTY:
        return host->fail(host, TL_E_GEOMETRY,
                          "%s: its %zu points enclose no area; give the corners of a polygon in "
                          "order",
                          name, count);
    case CONVEX_DONE:
    case CONVEX_FAILED:
    default:
        return host->fail(host, TL_E_GEOMETRY,
                          "%s could not be divided into convex parts; give it in several pieces",
                          name);
    }
}

/* Creates the block of one part. */
static tl_status create_part(const tl_host *host, tl_points points, const size_t *corner,
                             size_t count, tl_vec3 axis, double density, const char *group)
{
    tl_vec3 *ends = malloc(2 * count * sizeof *ends);
    if (!ends)
        return host->fail(host, TL_E_MEMORY, "out of memory");
    for (size_t i = 0; i < count; i++) {
        ends[i] = points.at[corner[i]];
        ends[count + i] = tl_v3_add(ends[i], axis);
    }
    tl_status status = host->create_hull(host, ends, 2 * count, density, group);
    free(ends);
    return status;
}

/* Makes one body of the blocks from `first` on. */
static tl_status join_from(const tl_host *host, size_t first, size_t count)
{
    size_t *index = malloc(count * sizeof *index);
    if (!index)
        return host->fail(host, TL_E_MEMORY, "out of memory");
    for (size_t i = 0; i < count; i++)
        index[i] = first + i;
    tl_status status = host->join(host, index, count);
    free(index);
    return status;
}

tl_status prism_extrude(const tl_host *host, const char *name, tl_points points, const flat *at,
                        tl_vec3 axis, double density, const char *group)
{
    convex_parts parts;
    size_t one = 0, other = 0;
    convex_status divided = convex_divide(at, points.count, &parts, &one, &other);
    if (divided != CONVEX_DONE)
        return refuse(host, name, divided, one, other, points.count);
    size_t first = parts.parts > 1 ? host->block_count(host) : 0;
    tl_status status = TL_OK;
    for (size_t p = 0; p < parts.parts && status == TL_OK; p++)
        status = create_part(host, points, parts.corner + parts.start[p],
                             parts.start[p + 1] - parts.start[p], axis, density, group);
    if (status == TL_OK && parts.parts > 1)
        status = join_from(host, first, parts.parts);
    free(parts.corner);
    free(parts.start);
    return status;
}
