/* joints.c - polygons of wet joints: their moments and names. */
#include "joints.h"

tl_vec3 joint_middle(const joint_polygon *p, size_t i)
{
    return tl_v3_scale(0.5, tl_v3_add(p->at[0][i], p->at[1][i]));
}

joint_moments joint_moments_of(const joint_polygon *p, tl_vec3 normal)
{
    joint_moments m = {.normal = normal};
    const tl_vec3 o = joint_middle(p, 0), x = tl_v3_perpendicular(normal), y = tl_v3_cross(normal, x);
    double sx = 0, sy = 0, xx = 0, xy = 0, yy = 0;
    for (size_t i = 1; i + 1 < p->count; i++) {
        const tl_vec3 r = tl_v3_sub(joint_middle(p, i), o), s = tl_v3_sub(joint_middle(p, i + 1), o);
        const double rx = tl_v3_dot(r, x), ry = tl_v3_dot(r, y), qx = tl_v3_dot(s, x), qy = tl_v3_dot(s, y);
        const double part = 0.5 * (rx * qy - ry * qx);
        m.area += part;
        sx += part * (rx + qx) / 3;
        sy += part * (ry + qy) / 3;
        xx += part * (rx * rx + rx * qx + qx * qx) / 6;
        xy += part * (2 * rx * ry + rx * qy + qx * ry + 2 * qx * qy) / 12;
        yy += part * (ry * ry + ry * qy + qy * qy) / 6;
    }
    if (!(m.area > 0))
        return m;
    sx /= m.area;
    sy /= m.area;
    xx = xx / m.area - sx * sx;
    xy = xy / m.area - sx * sy;
    yy = yy / m.area - sy * sy;
    const double l = sqrt(fmax(xx, 0)), k = l > 0 ? xy / l : 0, n = sqrt(fmax(yy - k * k, 0));
    m.centroid = tl_v3_madd(tl_v3_madd(o, sx, x), sy, y);
    m.a = tl_v3_madd(tl_v3_scale(l, x), k, y);
    m.b = tl_v3_scale(n, y);
    return m;
}

static uint64_t mixed(uint64_t a, uint64_t b)
{
    uint64_t z = (a ^ (b + 0x9e3779b97f4a7c15u + (a << 6) + (a >> 2))) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

uint64_t joint_key(const tl_element_wall *w, uint32_t which)
{
    const uint64_t blocks = (uint64_t)w->block[0] << 32 | w->block[1], faces = (uint64_t)w->face[0] << 32 | w->face[1];
    const uint64_t key = mixed(mixed(blocks, faces), which);
    return key ? key : 1;
}

tl_vec3 joint_on_wall(const tl_element_wall *w, int k, tl_vec3 n, tl_vec3 x)
{
    const double t = tl_v3_dot(w->normal[k], tl_v3_sub(w->corners[k][0], x)) / tl_v3_dot(w->normal[k], n);
    return tl_v3_madd(x, t, n);
}

bool joint_same_faces(const tl_element_wall *a, const tl_element_wall *b)
{
    return a->block[0] == b->block[0] && a->block[1] == b->block[1] && a->face[0] == b->face[0] &&
           a->face[1] == b->face[1];
}
