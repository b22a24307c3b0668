/* single_blocks.c - a generator that uses the host's services for single blocks in the way it is asked to.
 * It makes a row of `count` boxes of one cubic metre from 0 along x and then works on them. */
#include <talus/plugin.h>
#include <talus/vmath.h>

enum { JOIN, JOIN_CUT, REMOVE, REMOVE_JOINED, PART, HIDE, HIDE_SHOW, BEYOND, LONG_GROUP, SKEW };

static const char *const modes[] = {"join",      "join_cut", "remove",     "remove_joined", "part", "hide",
                                    "hide_show", "beyond",   "long_group", "skew",          NULL};

typedef struct params {
    int32_t mode;
    int64_t count;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_ENUM, params, mode, "", "what to do", .def = {JOIN}, .choices = modes),
    TL_PARAM(TL_PARAM_INT, params, count, "", "number of boxes", .def = {4}, .min = 3, .max = 10),
};

static tl_status make_row(const tl_host *host, int64_t count)
{
    tl_status status = TL_OK;
    for (int64_t i = 0; i < count && status == TL_OK; i++)
        status = host->create_box(host, tl_v3((double)i, 0, 0), tl_v3((double)i + 1, 1, 1), 2000, "row");
    return status;
}

/* A joint through the middle of the height. */
static tl_status cut_flat(const tl_host *host)
{
    tl_tag tag;
    tl_status status = host->joint(host, "flat", &tag.joint);
    if (status != TL_OK)
        return status;
    tag.plane = host->next_plane(host, tag.joint);
    return host->cut(host, tl_v3(0, 0, 1), tl_v3(0, 0, 0.5), tag, 1);
}

/* A joint through the middle of what was the third box. */
static tl_status cut_upright(const tl_host *host)
{
    tl_tag tag;
    tl_status status = host->joint(host, "upright", &tag.joint);
    if (status != TL_OK)
        return status;
    tag.plane = host->next_plane(host, tag.joint);
    return host->cut(host, tl_v3(1, 0, 0), tl_v3(2.5, 0, 0), tag, 1);
}

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    static const size_t three[] = {0, 1, 2}, middle[] = {1};
    size_t above;
    tl_status status = make_row(host, p->count);
    bool joins = p->mode == JOIN || p->mode == JOIN_CUT || p->mode == REMOVE_JOINED || p->mode == PART;
    if (status == TL_OK && joins)
        status = host->join(host, three, 3);
    if (status != TL_OK)
        return status;
    switch (p->mode) {
    case JOIN_CUT: return cut_flat(host);
    case REMOVE:
    case REMOVE_JOINED: status = host->remove(host, 1); return status == TL_OK ? cut_upright(host) : status;
    case PART: return host->part(host, middle, 1);
    case HIDE:
    case HIDE_SHOW:
        status = host->hide(host, 0);
        if (status == TL_OK && host->block_count(host) != (size_t)p->count - 1)
            return host->fail(host, TL_E_STATE, "a hidden block is counted");
        if (status == TL_OK && p->mode == HIDE_SHOW)
            status = host->show(host);
        return status == TL_OK ? cut_flat(host) : status;
    case BEYOND: return host->remove(host, (size_t)p->count);
    case LONG_GROUP:
        return host->set_group(host, 0, "a name of a group that is much longer than sixty-three letters, and goes on");
    case SKEW: return host->cut_block(host, 0, tl_v3(0, 0, 2), tl_v3(0, 0, 0.5), &above);
    default: return TL_OK;
    }
}

static const tl_generator_ops ops = {.size = sizeof ops, .generate = generate};

static const tl_kind kind = TL_KIND(TL_KIND_GENERATOR, ops, .name = "single_blocks", .doc = "Works on single blocks.",
                                    TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "test.single_blocks", .version = "1", .doc = "Generator of the tests.",
          .licence = "BSD-3-Clause");
