/* solid.c - creates a block of each closed surface of a file.
 *
 * A closed surface bounds a convex solid when it bends outward at every edge and goes round once: the hull of its
 * corners has then its volume. Faces that lie along each other, as the triangles of a flat side do, are one side; a
 * vertex where fewer than three sides meet is no corner and is left out. Rounding may have put it inside the hull of
 * the others. */
#include "mesh.h"

#include <stdlib.h>
#include <talus/vmath.h>

/* Rounding of coordinates in files, relative to the largest: seven digits. */
#define ROUNDING 1e-6
/* Faces that bend by more than this, over the longest edge, always bend: far from zero the rounding of the
 * coordinates cannot be told from a bend any more. */
#define BEND 1e-3
/* The surface may bend inward by less than this over the longest edge: so far the fourth corner of a face is above the
 * plane of the others when all miss the plane of the face by 1e-4. */
#define INWARD 4e-4
/* Relative difference of the volumes of a surface and of the hull of its corners: what bends within the
 * tolerances above may add up to. */
#define VOLUME 1e-3
/* A surface holds no volume below this times the cube of its size. */
#define EMPTY 1e-12
#define MOST_CORNERS_OF_BLOCK 4096

/* The faces of all solids, solid by solid, and scratch for one of them. */
typedef struct solids {
    const mesh *m;
    uint32_t *face;  /* [faces] */
    size_t *first;   /* [solids + 1] into face */
    uint32_t *side;  /* [faces] a face of the same side, its own for one of each side */
    uint64_t *meets; /* [corners] vertex and side of each corner of a solid */
    tl_vec3 *corner; /* [most corners] */
} solids;

static void solids_free(solids *s)
{
    free(s->face);
    free(s->first);
    free(s->side);
    free(s->meets);
    free(s->corner);
}

static bool solids_begin(const mesh *m, solids *s)
{
    *s = (solids){.m = m,
                  .face = malloc(m->faces * sizeof *s->face),
                  .first = calloc(m->solids + 2, sizeof *s->first),
                  .side = malloc(m->faces * sizeof *s->side),
                  .meets = malloc(m->corners * sizeof *s->meets),
                  .corner = malloc(MOST_CORNERS_OF_BLOCK * sizeof *s->corner)};
    if (!s->face || !s->first || !s->side || !s->meets || !s->corner)
        return false;
    /* first[i + 2] counts, then first[i + 1] is where solid i is filled in, and at last its end */
    for (size_t f = 0; f < m->faces; f++)
        s->first[m->face[f].solid + 2]++;
    for (size_t i = 2; i < m->solids + 2; i++)
        s->first[i] += s->first[i - 1];
    for (size_t f = 0; f < m->faces; f++)
        s->face[s->first[m->face[f].solid + 1]++] = (uint32_t)f;
    return true;
}

static tl_status fault(const solids *s, size_t solid, const char *what, const char *remedy)
{
    const mesh *m = s->m;
    uint32_t face = s->face[s->first[solid]];
    tl_vec3 at = m->vertex[m->corner[m->start[face]]];
    return MESH_FAULT(m, ": solid %zu, from face %u at {%g, %g, %g} on, %s; %s", solid + 1, face + 1, at.x, at.y, at.z,
                      what, remedy);
}

/* ---------------------------------------------------------------- volume ----------------- */

static double volume_of(const solids *s, size_t solid, double *size)
{
    const mesh *m = s->m;
    tl_vec3 zero = m->vertex[m->corner[m->start[s->face[s->first[solid]]]]];
    double volume6 = 0;
    *size = 0;
    for (size_t i = s->first[solid]; i < s->first[solid + 1]; i++) {
        uint32_t from = m->start[s->face[i]], to = m->start[s->face[i] + 1];
        tl_vec3 a = tl_v3_sub(m->vertex[m->corner[from]], zero);
        for (uint32_t h = from + 1; h + 1 < to; h++) {
            tl_vec3 b = tl_v3_sub(m->vertex[m->corner[h]], zero);
            tl_vec3 c = tl_v3_sub(m->vertex[m->corner[h + 1]], zero);
            volume6 += tl_v3_dot(a, tl_v3_cross(b, c));
            *size = fmax(*size, fmax(tl_v3_norm(b), tl_v3_norm(c)));
        }
    }
    return volume6 / 6;
}

/* ---------------------------------------------------------------- sides ------------------ */

static uint32_t side_root(const solids *s, uint32_t face)
{
    while (s->side[face] != face)
        face = s->side[face] = s->side[s->side[face]];
    return face;
}

/* How far the corners of face `other` lie above and below the plane of `face`. */
static void look_across(const mesh *m, uint32_t face, uint32_t other, double *above, double *below)
{
    *above = *below = 0;
    tl_vec3 on = m->vertex[m->corner[m->start[face]]];
    for (uint32_t h = m->start[other]; h < m->start[other + 1]; h++) {
        double off = tl_v3_dot(m->face[face].normal, tl_v3_sub(m->vertex[m->corner[h]], on));
        *above = fmax(*above, off);
        *below = fmin(*below, off);
    }
}

/* Makes one side of faces along each other; false when the surface bends inward at half-edge h. */
static bool look_at_bend(const solids *s, uint32_t h)
{
    const mesh *m = s->m;
    uint32_t a = m->face_of[h], b = m->face_of[m->mate[h]];
    double above, below, above_b, below_b;
    look_across(m, a, b, &above, &below);
    look_across(m, b, a, &above_b, &below_b);
    double longest = fmax(m->face[a].longest, m->face[b].longest), height = fmin(m->face[a].height, m->face[b].height);
    /* a plane that is off at a low triangle is off by more at the far end of its neighbour */
    double rounding = ROUNDING * m->reach * (1 + longest / height);
    double tolerance = fmin(rounding, BEND * longest);
    /* a sliver hardly knows its plane: how deep a bend is, the other face tells */
    if (fmin(above, above_b) > fmax(tolerance, INWARD * longest))
        return false;
    if (fmin(below, below_b) >= -tolerance && fmax(above, above_b) <= tolerance &&
        tl_v3_dot(m->face[a].normal, m->face[b].normal) > 0)
        s->side[side_root(s, b)] = side_root(s, a);
    return true;
}

static tl_status find_sides(const solids *s, size_t solid)
{
    const mesh *m = s->m;
    for (size_t i = s->first[solid]; i < s->first[solid + 1]; i++)
        s->side[s->face[i]] = s->face[i];
    for (size_t i = s->first[solid]; i < s->first[solid + 1]; i++) {
        uint32_t face = s->face[i];
        for (uint32_t h = m->start[face]; h < m->start[face + 1]; h++) {
            if (h < m->mate[h] && !look_at_bend(s, h)) {
                tl_vec3 p = m->vertex[m->corner[h]], q = m->vertex[m->corner[mesh_next(m, h)]];
                return MESH_FAULT(m,
                                  ": solid %zu is not convex: it bends inward at the edge from {%g, %g, %g} to {%g, "
                                  "%g, %g} of face %u; divide it into convex solids",
                                  solid + 1, p.x, p.y, p.z, q.x, q.y, q.z, face + 1);
            }
        }
    }
    return TL_OK;
}

/* ---------------------------------------------------------------- corners ---------------- */

static int by_value(const void *left, const void *right)
{
    uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return (a > b) - (a < b);
}

/* The vertices of a solid where three sides or more meet. */
static tl_status find_corners(const solids *s, size_t solid, size_t *count)
{
    const mesh *m = s->m;
    size_t meets = 0;
    *count = 0;
    for (size_t i = s->first[solid]; i < s->first[solid + 1]; i++) {
        uint32_t face = s->face[i], side = side_root(s, face);
        for (uint32_t h = m->start[face]; h < m->start[face + 1]; h++)
            s->meets[meets++] = (uint64_t)m->corner[h] << 32 | side;
    }
    qsort(s->meets, meets, sizeof *s->meets, by_value);
    for (size_t from = 0, to = 0; from < meets; from = to) {
        size_t sides = 0;
        for (; to < meets && s->meets[to] >> 32 == s->meets[from] >> 32; to++)
            sides += to == from || s->meets[to] != s->meets[to - 1];
        if (sides < 3)
            continue;
        if (*count == MOST_CORNERS_OF_BLOCK)
            return fault(s, solid, "has more than 4096 corners", "give it fewer and larger faces");
        s->corner[(*count)++] = m->vertex[s->meets[from] >> 32];
    }
    return TL_OK;
}

/* ---------------------------------------------------------------- blocks ----------------- */

/* The block made last holds what the surface holds. */
static tl_status check_volume(const solids *s, size_t solid, double volume)
{
    const tl_host *host = s->m->host;
    tl_block_info info = {.size = sizeof info};
    host->block_info(host, host->block_count(host) - 1, &info);
    if (fabs(info.volume - volume) <= VOLUME * volume)
        return TL_OK;
    return fault(s, solid, "is not convex: the hull of its corners has another volume",
                 "divide it into convex solids whose faces do not cross");
}

static tl_status create(const solids *s, size_t solid, double scale, tl_vec3 translate, double density,
                        const char *group)
{
    const mesh *m = s->m;
    double size, volume = volume_of(s, solid, &size);
    size_t count;
    if (!(fabs(volume) > EMPTY * size * size * size))
        return fault(s, solid, "holds no volume", "remove it, or give it thickness");
    if (volume < 0)
        return fault(s, solid, "is turned inside out: all its faces face inward",
                     "turn the order of the corners of every face round");
    tl_status status = find_sides(s, solid);
    if (status == TL_OK)
        status = find_corners(s, solid, &count);
    if (status != TL_OK)
        return status;
    if (count < 4)
        return fault(s, solid, "has no corners to speak of: it is flat within the rounding of its coordinates",
                     "remove it, or write its coordinates with more digits");
    for (size_t i = 0; i < count; i++)
        s->corner[i] = tl_v3_madd(translate, scale, s->corner[i]);
    status = m->host->create_hull(m->host, s->corner, count, density, group);
    return status == TL_OK ? check_volume(s, solid, scale * scale * scale * volume) : status;
}

tl_status solids_create(const mesh *m, double scale, tl_vec3 translate, double density, const char *group)
{
    solids s;
    tl_status status = solids_begin(m, &s) ? TL_OK : mesh_no_memory(m);
    for (size_t i = 0; i < m->solids && status == TL_OK; i++) {
        status = create(&s, i, scale, translate, density, group);
        if (status == TL_OK)
            status = m->host->progress(m->host, (double)(i + 1) / (double)m->solids);
    }
    solids_free(&s);
    return status;
}
