/* flush.c - faces beside which another would be the next to touch. */
#include "narrow/flush.h"

#include <talus/vmath.h>

/* Whether another outer face of a block or its body meets a face at less than twice the tilt at which springs at
 * corners end. */
static bool has_blunt_edge(const tl_poly *p, uint32_t face)
{
    const double least = 1 - 2 * TL_CORNERS_FIELD_TILT * TL_CORNERS_FIELD_TILT;
    const tl_vec3 n = p->plane[face].normal;
    for (uint32_t f = 0; f < p->plane_count; f++) {
        double cosine = tl_v3_dot(p->plane[f].normal, n);
        bool outer = f >= p->face_count || !p->covered[f];
        bool same = f == face || (f >= p->face_count && cosine > 1 - TL_POLY_TILT * TL_POLY_TILT);
        if (outer && !same && cosine > least)
            return true;
    }
    return false;
}

bool tl_at_corners(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb)
{
    return !has_blunt_edge(a, fa) && !has_blunt_edge(b, fb);
}

tl_tag tl_flush_tag(tl_tag a, tl_tag b)
{
    if (a.joint == 0 || b.joint == 0)
        return a.joint == 0 ? b : a;
    return a.joint < b.joint || (a.joint == b.joint && a.plane <= b.plane) ? a : b;
}
