/* half_way.c - a generator that loads well and then misbehaves in the way it is asked to, after it has
 * made a block, a joint and a cut. What it made must not be seen in the model. */
#include <talus/plugin.h>
#include <talus/vmath.h>

enum { FAIL, SILENT, NORMAL, TAG, PERSISTENCE, DENSITY, LOOK };

static const char *const modes[] = {"fail", "silent", "normal", "tag", "persistence", "density", "look", NULL};

typedef struct params {
    int32_t mode;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_ENUM, params, mode, "", "what to do wrong", .def = {FAIL}, .choices = modes),
};

/* Sums what the host says about the visible blocks and compares it with the box made here. */
static tl_status look(const tl_host *host)
{
    double volume = 0;
    tl_bounds all = {tl_v3(INFINITY, INFINITY, INFINITY), tl_v3(-INFINITY, -INFINITY, -INFINITY)};
    size_t count = host->block_count(host);
    /* Forwards and backwards: the answer may not depend on the question before. */
    for (size_t i = 0; i < 2 * count; i++) {
        tl_block_info info = {.size = sizeof info};
        host->block_info(host, i < count ? i : 2 * count - 1 - i, &info);
        volume += 0.5 * info.volume;
        all.min = tl_v3_min(all.min, info.bounds.min);
        all.max = tl_v3_max(all.max, info.bounds.max);
        if (info.group[0] == '\0' || info.lineage == 0)
            return host->fail(host, TL_E_STATE, "block %zu has no group or lineage", i);
    }
    host->log(host, "%zu blocks", count);
    return host->fail(host, TL_E_STATE, "%zu blocks of volume %.6f from %g,%g,%g to %g,%g,%g", count, volume, all.min.x,
                      all.min.y, all.min.z, all.max.x, all.max.y, all.max.z);
}

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    tl_tag tag;
    tl_status status = host->create_box(host, tl_v3(10, 10, 10), tl_v3(11, 12, 13), 2000, "half_way");
    if (status == TL_OK)
        status = host->joint(host, "new", &tag.joint);
    if (status != TL_OK)
        return status;
    tag.plane = host->next_plane(host, tag.joint);
    tl_vec3 up = tl_v3(0, 0, 1), middle = tl_v3(0, 0, 11);
    status = host->cut(host, up, middle, tag, 1);
    if (status != TL_OK)
        return status;
    switch (p->mode) {
    case SILENT: return TL_E_GEOMETRY;
    case NORMAL: return host->cut(host, tl_v3(0, 0, 2), middle, tag, 1);
    case TAG: return host->cut(host, up, middle, (tl_tag){tag.joint, tag.plane + 1}, 1);
    case PERSISTENCE: return host->cut(host, up, middle, tag, 1.5);
    case DENSITY: return host->create_box(host, tl_v3(0, 0, 0), up, NAN, NULL);
    case LOOK: return look(host);
    default: return host->fail(host, TL_E_STATE, "went %s", "half way");
    }
}

static const tl_generator_ops ops = {.size = sizeof ops, .generate = generate};

static const tl_kind kind = TL_KIND(TL_KIND_GENERATOR, ops, .name = "half_way",
                                    .doc = "A generator that never succeeds.", TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "bad.half_way", .version = "1", .doc = "A plugin for the test of the host's services.",
          .licence = "BSD-3-Clause");
