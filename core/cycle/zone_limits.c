/* zone_limits.c - no step turns a zone inside out.
 *
 * Strains of a zone need volumes above 0, half-way and at the end of a motion (zone/pass.c). They are known before the
 * motion: places are x + v dt, v the velocity after the kick. While zones strain slowly none can be turned inside out
 * in a step. So only fast steps look at volumes. */
#include "cycle/zone_limits.h"

#include "base/parallel.h"
#include "cycle/cycle_data.h"
#include "cycle/gridpoints.h"
#include "geometry/measure.h"
#include "zone/zones.h"

#include <math.h>
#include <talus/number.h>

/* Tolerance: strain of a zone in a step from which the next one may turn it inside out. */
#define FAST_STRAIN 1e-3

bool tl_zones_are_fast(const tl_model *m)
{
    const struct tl_zones *z = m->zones;
    bool fast = z && z->steps_kept > 0;
    for (size_t k = 0; z && !fast && k < z->parcels.table.rows; k++)
        fast = !(z->parcels.most_strain[k] < FAST_STRAIN * FAST_STRAIN);
    return fast;
}

typedef struct check_job {
    tl_model *m;
    double dt;
} check_job;

/* The largest change of an edge over its length. */
static double most_change(const tl_vec3 now[4], const tl_vec3 then[4])
{
    double most = 0;
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < a; b++) {
            const double length = tl_v3_norm(tl_v3_sub(now[a], now[b]));
            most = fmax(most, fabs(tl_v3_norm(tl_v3_sub(then[a], then[b])) - length) / length);
        }
    return most;
}

static void note_zone(const check_job *job, size_t parcel, size_t row, const tl_vec3 now[4], const tl_vec3 then[4])
{
    tl_model *m = job->m;
    const tl_vec3 sum = tl_v3_add(tl_v3_add(now[0], now[1]), tl_v3_add(now[2], now[3]));
    const tl_vec3 at = tl_v3_madd(m->origin, 0.25, sum);
    char text[TL_ERROR_TEXT / 2];
    tl_text_print(
        text, sizeof text,
        "zone %u at (%.4g, %.4g, %.4g) would be turned inside out, its edges change by %.3g of their length in "
        "this step: give stiffer joints or solids, lower velocities or a shorter time step",
        m->zones->zones.number[row], at.x, at.y, at.z, most_change(now, then));
    tl_failure_note(&m->cycle->failure, parcel, TL_E_NUMERIC, row, text);
}

/* false: the zone of a row would be turned inside out. */
static bool check_zone(const check_job *job, const tl_parcel *of, size_t parcel, size_t row)
{
    const struct tl_zones *z = job->m->zones;
    tl_vec3 now[4], half[4], then[4];
    for (int a = 0; a < 4; a++) {
        const uint32_t point = z->listed[of->point_begin + z->zones.corner[a][row]];
        const tl_vec3 v = tl_gridpoint_to_come(job->m, point, job->dt);
        now[a] = tl_gridpoint_place(&z->points, point);
        half[a] = tl_v3_madd(now[a], 0.5 * job->dt, v);
        then[a] = tl_v3_madd(now[a], job->dt, v);
    }
    if (tl_tetrahedron_volume(half) > 0 && tl_tetrahedron_volume(then) > 0)
        return true;
    note_zone(job, parcel, row, now, then);
    return false;
}

static void check_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const check_job *job = user;
    const struct tl_zones *z = job->m->zones;
    for (size_t parcel = begin; parcel < end; parcel++) {
        const tl_parcel *of = &z->parcels.of[parcel];
        bool sound = true;
        for (uint32_t k = of->group_begin; k < of->group_end && sound; k++)
            for (size_t i = 0; i < (size_t)z->group[k].depth * TL_LANES && sound; i++)
                if (z->zones.number[z->group[k].start + i] != TL_NO_ROW)
                    sound = check_zone(job, of, parcel, z->group[k].start + i);
    }
}

tl_status tl_zones_check(tl_model *m, double dt)
{
    check_job job = {m, dt};
    if (!tl_model_deforms(m) || !tl_zones_are_fast(m))
        return TL_OK;
    tl_parallel_for(m->pool, m->zones->parcels.table.rows, 1, check_range, &job);
    const tl_status status = m->cycle->failure.error.status;
    return status == TL_OK ? TL_OK : tl_zones_failed(m, status);
}

tl_status tl_zones_failed(tl_model *m, tl_status status)
{
    tl_failure *failure = &m->cycle->failure;
    const struct tl_zones *z = m->zones;
    const tl_parcel *of = &z->parcels.of[failure->chunk];
    const tl_named_solid *solid = &z->solid[of->solid];
    failure->error.status = TL_OK;
    return tl_fail(&m->error, status, "cycle %lld, solid '%s' (%s) of block %u: %s", (long long)m->cycles + 1,
                   solid->name, solid->of.kind->name, z->mesh[of->mesh].body, failure->error.text);
}
