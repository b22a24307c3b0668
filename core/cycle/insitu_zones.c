/* insitu_zones.c - initial stress in deformable blocks: sigma at the centroids of zones, sigma n at points of segments.
 *
 * Forces on gridpoints are integrals of shape functions that are linear. So a stress that is linear in space is in
 * equilibrium with weight and with tractions on the surface (zone/outer.c), to rounding. What the zones store is what
 * their solids tell of the stress. */
#include "cycle/insitu_zones.h"

#include "segment/act.h"
#include "segment/gather.h"
#include "segment/lay.h"
#include "segment/preload.h"
#include "zone/solids.h"

#include <math.h>

/* An initial stress, with the height of the model's origin over `at`. */
typedef struct field {
    const tl_insitu *insitu;
    double height;
} field;

static tl_sym3 stress_at(const void *user, tl_vec3 place)
{
    const field *of = user;
    return tl_s3_madd(of->insitu->stress, of->height + place.z, of->insitu->gradient);
}

/* The corners of a zone. */
static void corners_of(const struct tl_zones *z, const tl_parcel *of, size_t row, tl_vec3 x[4])
{
    for (int a = 0; a < 4; a++)
        x[a] = tl_gridpoint_place(&z->points, z->listed[of->point_begin + z->zones.corner[a][row]]);
}

static void load_row(struct tl_zones *z, const tl_parcel *of, size_t row, const field *from)
{
    tl_vec3 x[4];
    corners_of(z, of, row, x);
    const tl_vec3 centre = tl_v3_scale(0.25, tl_v3_add(tl_v3_add(x[0], x[1]), tl_v3_add(x[2], x[3])));
    const tl_sym3 s = stress_at(from, centre);
    const double number[6] = {s.xx, s.yy, s.zz, s.xy, s.yz, s.zx};
    for (int k = 0; k < 6; k++)
        z->zones.stress[k][row] = number[k];
}

bool tl_insitu_zones_prepare(tl_model *m)
{
    return !m->segments || tl_segments_hold_initial(m->segments);
}

tl_id tl_insitu_pulls(const tl_model *m, double share)
{
    const struct tl_zones *z = m->zones;
    double most = 0;
    for (int pass = 0; z && pass < 2; pass++)
        for (size_t k = 0; k < z->parcels.table.rows; k++) {
            const tl_parcel *of = &z->parcels.of[k];
            const size_t begin = z->group[of->group_begin].start;
            const size_t end = of->group_end < z->group_count ? z->group[of->group_end].start : z->zones.table.rows;
            for (size_t row = begin; row < end; row++) {
                double *const *s = z->zones.stress;
                const double mean = (s[0][row] + s[1][row] + s[2][row]) / 3;
                if (pass == 0)
                    most = fmax(most, fabs(mean));
                else if (mean > share * most)
                    return of->block;
            }
        }
    return TL_NO_ID;
}

/* Whether a block is meant. */
static bool is_meant(const tl_model *m, const uint8_t *chosen, tl_id block)
{
    return !chosen || chosen[tl_block_row_quiet(m, block)];
}

void tl_insitu_zones(tl_model *m, const tl_insitu *insitu, const uint8_t *chosen)
{
    struct tl_zones *z = m->zones;
    const field from = {insitu, m->origin.z - insitu->at.z};
    if (!tl_model_deforms(m))
        return;
    for (size_t k = 0; k < z->parcels.table.rows; k++) {
        const tl_parcel *of = &z->parcels.of[k];
        if (!is_meant(m, chosen, of->block))
            continue;
        for (uint32_t g = of->group_begin; g < of->group_end; g++) {
            const size_t begin = z->group[g].start, end = begin + (size_t)z->group[g].depth * TL_LANES;
            for (size_t row = begin; row < end; row++)
                load_row(z, of, row, &from);
        }
        z->parcels.stored[k] = tl_parcel_stored(z, of);
    }
    for (size_t k = 0; m->segments && k < m->segments->meet_count; k++) {
        const tl_meet *meet = &m->segments->meet[k];
        if ((!is_meant(m, chosen, meet->a) && !is_meant(m, chosen, meet->b)) || !tl_meet_is_together(m, meet))
            continue;
        for (uint32_t row = meet->begin; row < meet->end; row++)
            if (m->segments->table.of[row].meet == k)
                tl_segment_preload(m, row, stress_at, &from);
    }
    z->steps_kept = TL_STEPS_KEPT;
}
