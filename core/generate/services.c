/* services.c - runs a generator plugin: reads its parameters, opens a staging set, lends it the host's
 * services (tl_host of plugin.h) and commits what it made.
 *
 * What it made is committed whole or not at all. What a plugin passes in is checked here, once, so that the geometry
 * below may rely on it. */
#include "base/inside.h"
#include "base/names.h"
#include "base/random.h"
#include "base/regular.h"
#include "generate/stage.h"
#include "generate/stage_commit.h"
#include "generate/staging.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "mesh/parts.h"
#include "model/joints.h"
#include "model/model.h"
#include "model/notes.h"
#include "plugin/loader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>
#include <talus/text.h>

/* Tolerance: a cutting plane's normal may miss unit length by this: a few roundings of its components. */
#define UNIT_TOLERANCE 1e-9
/* Longest name of a joint set or a group: it goes into messages and files. */
#define LONGEST_NAME 63
/* Limit: vertices and faces of one solid. */
#define MOST_OF_SOLID 0x8000000u
/* Keeps the draws of generators apart from those of other uses of the seed. */
#define DRAW_DOMAIN 1

/* What stands behind a tl_host while a generator runs. */
typedef struct service {
    tl_model *model;
    tl_stage stage;
    const char *generator;
    size_t entry, entries; /* of a list, from 0 */
    double share;          /* of the entry's work that is done */
    tl_mesh_parts parts;   /* of the mesh that was read last */
} service;

static service *service_of(const tl_host *host)
{
    return host->impl;
}

static tl_status fail(const tl_host *host, tl_status status, const char *format, ...)
{
    char text[TL_ERROR_TEXT];
    va_list args;
    va_start(args, format);
    tl_text_vprint(text, sizeof text, format, args);
    va_end(args);
    return tl_fail(&service_of(host)->model->error, status, "%s", text);
}

static void say(const tl_host *host, const char *format, ...)
{
    char text[512];
    va_list args;
    va_start(args, format);
    tl_text_vprint(text, sizeof text, format, args);
    va_end(args);
    tl_model_say(service_of(host)->model, "generator '%s': %s", service_of(host)->generator, text);
}

static void tell_progress(const service *s)
{
    const tl_model *m = s->model;
    if (!m->show_generate)
        return;
    tl_generate_progress done = {.generator = s->generator,
                                 .share = ((double)s->entry + s->share) / (double)s->entries,
                                 .entry = s->entry + 1,
                                 .entries = s->entries,
                                 .cuts = s->stage.summary.cuts,
                                 .blocks = s->stage.count};
    m->show_generate(m->show_generate_user, &done);
}

void tl_model_watch_generate(tl_model *m, void (*fn)(void *user, const tl_generate_progress *done), void *user)
{
    m->show_generate = fn;
    m->show_generate_user = user;
}

/* Not TL_OK when the user asked to stop. Every service that makes or cuts blocks looks, so that a plugin that shows
 * no progress ends, too. */
static tl_status go_on(const tl_host *host)
{
    tell_progress(service_of(host));
    if (tl_model_interrupted(service_of(host)->model))
        return fail(host, TL_E_CANCELLED, "%s", tl_status_text(TL_E_CANCELLED));
    return TL_OK;
}

/* ---------------------------------------------------------------- blocks ----------------- */

static tl_status check_group(const tl_host *host, const char *group)
{
    if (group && strlen(group) > LONGEST_NAME)
        return fail(host, TL_E_ARGUMENT, "group '%.20s...' is longer than %d letters", group, LONGEST_NAME);
    if (group && !tl_text_is_utf8(group))
        return fail(host, TL_E_ARGUMENT, "group '%s' is not a text in UTF-8", group);
    return TL_OK;
}

static tl_status check_block(const tl_host *host, double density, const char *group)
{
    if (!(density > 0) || !isfinite(density))
        return fail(host, TL_E_ARGUMENT, "density = %g kg/m3 must be > 0", density);
    tl_status status = check_group(host, group);
    return status == TL_OK ? go_on(host) : status;
}

/* A point that is finite and near enough to compute with; `what` begins the sentence. */
static tl_status check_point(const tl_host *host, const char *what, size_t number, tl_vec3 at)
{
    if (fabs(at.x) <= TL_FARTHEST && fabs(at.y) <= TL_FARTHEST && fabs(at.z) <= TL_FARTHEST)
        return TL_OK;
    if (!tl_v3_finite(at))
        return fail(host, TL_E_NUMERIC, "%s %zu is not finite", what, number);
    return fail(host, TL_E_NUMERIC, "%s %zu at {%g, %g, %g} m is farther from zero than %g m: is it in the wrong unit?",
                what, number, at.x, at.y, at.z, TL_FARTHEST);
}

static tl_status create_hull(const tl_host *host, const tl_vec3 *vertices, size_t count, double density,
                             const char *group)
{
    tl_status status = check_block(host, density, group);
    for (size_t i = 0; i < count && status == TL_OK; i++)
        status = check_point(host, "vertex", i + 1, vertices[i]);
    if (status != TL_OK)
        return status;
    return tl_stage_add_hull(&service_of(host)->stage, vertices, count, density, group);
}

static bool joint_exists(const tl_host *host, uint32_t number)
{
    return number >= 1 && number <= service_of(host)->model->joint_count;
}

/* Whether the generator has asked for this plane of a joint. */
static bool plane_exists(const tl_host *host, tl_tag tag)
{
    return joint_exists(host, tag.joint) && tag.plane >= 1 &&
           tag.plane <= service_of(host)->model->joints[tag.joint - 1].planes;
}

/* Counts and indices of a block or solid given by its faces: what the geometry below relies on. */
static tl_status check_faces(const tl_host *host, const tl_block_shape *s, size_t most)
{
    if (s->vertex_count < 4 || s->vertex_count > most || s->face_count < 4 || s->face_count > most)
        return fail(host, TL_E_GEOMETRY, "a block of %zu vertices and %zu faces: it needs 4 to %zu of each",
                    s->vertex_count, s->face_count, most);
    for (size_t f = 0; f < s->face_count; f++) {
        if (s->start[f + 1] < s->start[f] + 3 || s->start[f + 1] - s->start[f] > s->vertex_count)
            return fail(host, TL_E_GEOMETRY, "face %zu does not have 3 to %zu corners", f + 1, s->vertex_count);
        for (uint32_t i = s->start[f]; i < s->start[f + 1]; i++)
            if (s->loops[i] >= s->vertex_count)
                return fail(host, TL_E_GEOMETRY, "face %zu names vertex %u of %zu", f + 1, s->loops[i] + 1,
                            s->vertex_count);
        if (s->tags && s->tags[f].joint && !plane_exists(host, s->tags[f]))
            return fail(host, TL_E_PLUGIN, "face %zu has plane %u of joint %u, which was not asked for", f + 1,
                        s->tags[f].plane, s->tags[f].joint);
    }
    if (s->fixed > TL_FIX_ALL || s->start[0] != 0)
        return fail(host, TL_E_PLUGIN, "a block's faces do not start at 0, or fixed = %u", s->fixed);
    return TL_OK;
}

static tl_status create_block(const tl_host *host, const tl_block_shape *given)
{
    tl_block_shape shape = {0};
    memcpy(&shape, given, given->size < sizeof shape ? given->size : sizeof shape);
    tl_status status = check_block(host, shape.density, shape.group);
    if (status == TL_OK)
        status = check_faces(host, &shape, TL_POLY_MAX_VERTICES);
    for (size_t i = 0; i < shape.vertex_count && status == TL_OK; i++)
        status = check_point(host, "vertex", i + 1, shape.vertices[i]);
    return status == TL_OK ? tl_stage_add_faces(&service_of(host)->stage, &shape) : status;
}

static tl_status create_solid(const tl_host *host, const tl_solid_shape *given, size_t *parts)
{
    tl_solid_shape solid = {0};
    memcpy(&solid, given, given->size < sizeof solid ? given->size : sizeof solid);
    const tl_block_shape shape = {.vertices = solid.vertices,
                                  .vertex_count = solid.vertex_count,
                                  .start = solid.start,
                                  .loops = solid.loops,
                                  .face_count = solid.face_count,
                                  .tags = solid.tags,
                                  .density = solid.density,
                                  .group = solid.group,
                                  .fixed = solid.fixed,
                                  .hidden = solid.hidden};
    size_t made = 0;
    tl_status status = check_block(host, shape.density, shape.group);
    if (status == TL_OK)
        status = check_faces(host, &shape, MOST_OF_SOLID);
    for (size_t i = 0; i < shape.vertex_count && status == TL_OK; i++)
        status = check_point(host, "vertex", i + 1, shape.vertices[i]);
    if (status == TL_OK && !(solid.flat >= 0 && solid.flat <= TL_FARTHEST))
        return fail(host, TL_E_ARGUMENT, "flat = %g m must be >= 0 and finite", solid.flat);
    if (status == TL_OK)
        status = tl_stage_add_solid(&service_of(host)->stage, &shape, solid.flat, solid.whole != 0, &made);
    if (parts)
        *parts = made;
    return status;
}

static tl_status create_box(const tl_host *host, tl_vec3 min, tl_vec3 max, double density, const char *group)
{
    tl_status status = check_block(host, density, group);
    if (status != TL_OK)
        return status;
    status = check_point(host, "corner", 1, min);
    if (status == TL_OK)
        status = check_point(host, "corner", 2, max);
    if (status != TL_OK)
        return status;
    if (!(min.x < max.x && min.y < max.y && min.z < max.z))
        return fail(host, TL_E_ARGUMENT, "the box from {%g, %g, %g} to {%g, %g, %g} has no volume: min must be < max",
                    min.x, min.y, min.z, max.x, max.y, max.z);
    return tl_stage_add_box(&service_of(host)->stage, min, max, density, group);
}

/* Puts the model's blocks into the staging set for a service that cannot fail: the generator does, in the end. */
static tl_stage *open_stage(const tl_host *host)
{
    tl_stage *stage = &service_of(host)->stage;
    stage->lost = tl_stage_open(stage) != TL_OK || stage->lost;
    return stage;
}

static size_t block_count(const tl_host *host)
{
    return open_stage(host)->visible_count;
}

/* A point of a staged block's shape in the user's coordinates. */
static tl_vec3 user_point(const tl_model *m, const tl_stage_block *block, tl_vec3 local)
{
    uint32_t body = tl_stage_frame(m, block);
    return body == TL_NO_ROW ? tl_v3_add(m->origin, local) : tl_model_point(m, body, local);
}

static void block_info(const tl_host *host, size_t index, tl_block_info *info)
{
    service *s = service_of(host);
    tl_block_info full = {.size = info->size, .group = ""};
    open_stage(host);
    if (index < s->stage.visible_count) {
        const tl_stage_block *block = &s->stage.blocks[s->stage.visible[index]];
        tl_mass mass = tl_poly_mass(block->shape);
        full.volume = mass.volume;
        full.centroid = user_point(s->model, block, mass.centroid);
        full.bounds.min = full.bounds.max = user_point(s->model, block, block->shape->vertex[0]);
        for (uint32_t i = 1; i < block->shape->vertex_count; i++) {
            tl_vec3 p = user_point(s->model, block, block->shape->vertex[i]);
            full.bounds.min = tl_v3_min(full.bounds.min, p);
            full.bounds.max = tl_v3_max(full.bounds.max, p);
        }
        full.group = s->model->groups[block->group];
        full.lineage = block->lineage;
        full.body = block->body;
    }
    memcpy(info, &full, info->size < sizeof full ? info->size : sizeof full);
}

/* ---------------------------------------------------------------- single blocks ---------- */

static tl_status check_index(const tl_host *host, size_t index)
{
    tl_status status = tl_stage_open(&service_of(host)->stage);
    size_t count = service_of(host)->stage.visible_count;
    if (status != TL_OK || index < count)
        return status == TL_OK ? go_on(host) : status;
    return fail(host, TL_E_PLUGIN, "it asks for block %zu of %zu, counted from 0", index, count);
}

static tl_status check_plane(const tl_host *host, tl_vec3 normal, tl_vec3 point)
{
    double length = tl_v3_norm(normal);
    if (fabs(length - 1) <= UNIT_TOLERANCE && tl_v3_norm(point) <= TL_FARTHEST)
        return TL_OK;
    return fail(host, TL_E_NUMERIC,
                "a cutting plane has the normal {%g, %g, %g}, which is not of unit length, or "
                "the point {%g, %g, %g}, which is not finite or farther from zero than %g m",
                normal.x, normal.y, normal.z, point.x, point.y, point.z, TL_FARTHEST);
}

static tl_status meets(const tl_host *host, size_t index, const tl_half_space *spaces, size_t count, bool *does)
{
    tl_stage *stage = &service_of(host)->stage;
    tl_status status = check_index(host, index);
    for (size_t i = 0; i < count && status == TL_OK; i++)
        status = check_plane(host, spaces[i].normal, spaces[i].point);
    if (status != TL_OK)
        return status;
    return tl_stage_meets(stage, stage->visible[index], spaces, count, does);
}

static tl_status cut_block(const tl_host *host, size_t index, tl_vec3 normal, tl_vec3 point, size_t *above)
{
    tl_stage *stage = &service_of(host)->stage;
    tl_status status = check_index(host, index);
    if (status == TL_OK)
        status = check_plane(host, normal, point);
    if (status != TL_OK)
        return status;
    status = tl_stage_cut_block(stage, stage->visible[index], normal, point, above);
    if (status == TL_OK && *above != SIZE_MAX)
        *above = stage->visible_count - 1;
    return status;
}

static tl_status set_group(const tl_host *host, size_t index, const char *group)
{
    service *s = service_of(host);
    tl_status status = check_index(host, index);
    if (status == TL_OK)
        status = check_group(host, group);
    if (status != TL_OK)
        return status;
    uint32_t number = tl_group_intern(s->model, group ? group : "");
    if (number == UINT32_MAX)
        return tl_fail_memory(&s->model->error);
    s->stage.blocks[s->stage.visible[index]].group = number;
    return TL_OK;
}

/* Marks the blocks of a body: it is to be found which of them hang together. */
static void mark_body(tl_stage *stage, uint32_t body)
{
    for (size_t i = 0; i < stage->count; i++)
        if (stage->blocks[i].body == body)
            stage->blocks[i].needs_reconnect = true;
    stage->needs_reconnect = stage->regroups = true;
}

/* Takes blocks out of their bodies: those that hang together over faces without a new joint are one body, and so is
 * what is left. */
static void part_bodies(tl_stage *stage, const size_t *indices, size_t count)
{
    uint32_t body = stage->next_body++;
    for (size_t i = 0; i < count; i++) {
        tl_stage_block *block = &stage->blocks[indices[i]];
        if (block->body == body)
            continue;
        if (block->detached_from != TL_NO_ROW)
            mark_body(stage, block->detached_from);
        block->detached_from = block->body;
        block->body = body;
        block->multi_block = block->needs_reconnect = true;
    }
    stage->needs_reconnect = stage->regroups = true;
}

/* Gives the blocks of body `from` to body `to`. */
static void move_members(tl_stage *stage, uint32_t from, uint32_t to)
{
    for (size_t i = 0; i < stage->count; i++)
        if (stage->blocks[i].body == from) {
            stage->blocks[i].body = to;
            stage->blocks[i].multi_block = true;
        }
}

/* Makes one body of all the bodies the blocks are of. */
static void join_bodies(tl_stage *stage, const size_t *indices, size_t count)
{
    if (count < 2)
        return;
    uint32_t body = stage->next_body++;
    for (size_t i = 0; i < count; i++)
        if (stage->blocks[indices[i]].body != body)
            move_members(stage, stage->blocks[indices[i]].body, body);
    uint64_t least = UINT64_MAX;
    for (size_t i = 0; i < stage->count; i++)
        if (stage->blocks[i].body == body && stage->blocks[i].lineage < least)
            least = stage->blocks[i].lineage;
    for (size_t i = 0; i < stage->count; i++)
        if (stage->blocks[i].body == body)
            stage->blocks[i].draw = least;
    stage->regroups = true;
}

/* Refused cuts that were noted name blocks by their index. */
static void forget_refused(tl_stage *stage, size_t index)
{
    size_t kept = 0;
    for (size_t i = 0; i < stage->refused_listed; i++) {
        tl_refused_cut cut = stage->refused[i];
        if (cut.block == index)
            continue;
        cut.block -= cut.block > index;
        stage->refused[kept++] = cut;
    }
    stage->refused_listed = kept;
}

/* Lists the visible blocks again from one of all on. */
static void list_visible(tl_stage *stage, size_t from)
{
    while (stage->visible_count > 0 && stage->visible[stage->visible_count - 1] >= from)
        stage->visible_count--;
    for (size_t i = from; i < stage->count; i++)
        if (!stage->blocks[i].hidden && !stage->blocks[i].hidden_by_generator)
            stage->visible[stage->visible_count++] = i;
}

static void delete_block(tl_stage *stage, size_t index)
{
    tl_stage_block gone = stage->blocks[index];
    stage->created_volume -= tl_poly_mass(gone.shape).volume;
    if (gone.owned)
        tl_poly_free(gone.shape);
    stage->count--;
    memmove(&stage->blocks[index], &stage->blocks[index + 1], (stage->count - index) * sizeof *stage->blocks);
    memmove(&stage->balls[index], &stage->balls[index + 1], (stage->count - index) * sizeof *stage->balls);
    forget_refused(stage, index);
    if (gone.multi_block)
        mark_body(stage, gone.body);
    list_visible(stage, index);
}

/* Calls `change` with the places in the stage of visible blocks. */
static tl_status change_bodies(const tl_host *host, const size_t *indices, size_t count,
                               void (*change)(tl_stage *, const size_t *, size_t))
{
    tl_stage *stage = &service_of(host)->stage;
    tl_status status = TL_OK;
    for (size_t i = 0; i < count && status == TL_OK; i++)
        status = check_index(host, indices[i]);
    if (status != TL_OK)
        return status;
    size_t *rows = malloc((count + 1) * sizeof *rows);
    if (!rows)
        return tl_fail_memory(&service_of(host)->model->error);
    for (size_t i = 0; i < count; i++)
        rows[i] = stage->visible[indices[i]];
    change(stage, rows, count);
    free(rows);
    return TL_OK;
}

static tl_status part(const tl_host *host, const size_t *indices, size_t count)
{
    return change_bodies(host, indices, count, part_bodies);
}

static tl_status join(const tl_host *host, const size_t *indices, size_t count)
{
    return change_bodies(host, indices, count, join_bodies);
}

static tl_status remove_block(const tl_host *host, size_t index)
{
    tl_stage *stage = &service_of(host)->stage;
    tl_status status = check_index(host, index);
    if (status == TL_OK)
        delete_block(stage, stage->visible[index]);
    return status;
}

static tl_status hide(const tl_host *host, size_t index)
{
    tl_stage *stage = &service_of(host)->stage;
    tl_status status = check_index(host, index);
    if (status != TL_OK)
        return status;
    stage->blocks[stage->visible[index]].hidden_by_generator = true;
    list_visible(stage, 0);
    return TL_OK;
}

static tl_status show(const tl_host *host)
{
    tl_stage *stage = &service_of(host)->stage;
    for (size_t i = 0; i < stage->count; i++)
        stage->blocks[i].hidden_by_generator = false;
    list_visible(stage, 0);
    return TL_OK;
}

/* ---------------------------------------------------------------- joints ----------------- */

/* "J1:3" and "*" mean something else where a joint is named. */
static bool is_joint_name(const char *name)
{
    size_t length = name ? strlen(name) : 0;
    if (length == 0 || length > LONGEST_NAME)
        return false;
    for (const char *c = name; *c; c++)
        if (*c == ':' || *c == '*' || (unsigned char)*c < ' ')
            return false;
    return tl_text_is_utf8(name);
}

static tl_status joint(const tl_host *host, const char *name, uint32_t *number)
{
    if (!is_joint_name(name))
        return fail(host, TL_E_ARGUMENT, "joint = '%.80s' is not a name: 1 to %d letters in UTF-8 without ':' and '*'",
                    name ? name : "", LONGEST_NAME);
    *number = tl_joint_intern(service_of(host)->model, name);
    return *number ? TL_OK : tl_fail_memory(&service_of(host)->model->error);
}

/* Takes the number, so that two planes never share one. */
static uint32_t next_plane(const tl_host *host, uint32_t number)
{
    return joint_exists(host, number) ? ++service_of(host)->model->joints[number - 1].planes : 0;
}

static tl_status cut_fracture(const tl_host *host, const tl_fracture *fracture, tl_tag tag, double persistence,
                              size_t *met)
{
    if (!plane_exists(host, tag))
        return fail(host, TL_E_PLUGIN, "it cuts by plane %u of joint %u, which it did not ask for", tag.plane,
                    tag.joint);
    tl_status status = check_plane(host, fracture->normal, fracture->point);
    if (status == TL_OK)
        status = go_on(host);
    if (status != TL_OK)
        return status;
    if (!(persistence >= 0 && persistence <= 1))
        return fail(host, TL_E_ARGUMENT, "persistence = %g is outside [0, 1]", persistence);
    if (!(fracture->radius > 0))
        return fail(host, TL_E_ARGUMENT, "radius = %g m must be > 0", fracture->radius);
    size_t blocks = 0;
    status = tl_stage_cut_fracture(&service_of(host)->stage, fracture, tag, persistence, &blocks);
    if (met)
        *met = blocks;
    return status;
}

static tl_status cut_disc(const tl_host *host, tl_vec3 normal, tl_vec3 point, double radius, tl_tag tag,
                          double persistence, size_t *met)
{
    const tl_fracture disc = tl_fracture_disc(normal, point, radius);
    return cut_fracture(host, &disc, tag, persistence, met);
}

static tl_status cut_polygon(const tl_host *host, const tl_vec3 *corners, size_t count, tl_tag tag, double persistence,
                             size_t *met)
{
    tl_fracture polygon;
    tl_status status = TL_OK;
    for (size_t i = 0; i < count && status == TL_OK; i++)
        status = check_point(host, "corner", i + 1, corners[i]);
    if (status == TL_OK)
        status = tl_fracture_polygon(corners, count, &polygon, &service_of(host)->model->error);
    return status == TL_OK ? cut_fracture(host, &polygon, tag, persistence, met) : status;
}

static tl_status cut(const tl_host *host, tl_vec3 normal, tl_vec3 point, tl_tag tag, double persistence)
{
    return cut_disc(host, normal, point, (double)INFINITY, tag, persistence, NULL);
}

static double draw_uniform(const tl_host *host, uint32_t number, int64_t plane, uint32_t draw)
{
    /* By the joint's name: its number depends on the order in which sets are made. */
    uint64_t key = tl_key(DRAW_DOMAIN, host->seed);
    if (joint_exists(host, number))
        key = tl_key_text(key, service_of(host)->model->joints[number - 1].name);
    return tl_uniform(tl_key(tl_key(key, (uint64_t)plane), draw));
}

static tl_status progress(const tl_host *host, double fraction)
{
    service *s = service_of(host);
    s->share = fraction >= 0 && fraction <= 1 ? fraction : s->share;
    return go_on(host);
}

static tl_status read_mesh(const tl_host *host, const char *file, const tl_mesh_part **parts, size_t *count)
{
    service *s = service_of(host);
    tl_mesh_parts_free(&s->parts);
    *parts = NULL;
    *count = 0;
    tl_status status = go_on(host);
    if (status == TL_OK)
        status = tl_mesh_parts_read(file, &s->parts, &s->model->error);
    if (status == TL_OK) {
        *parts = s->parts.list;
        *count = s->parts.count;
    }
    return status;
}

/* ---------------------------------------------------------------- report ----------------- */

static tl_status note(const tl_host *host, const char *object, const char *key, double number, const char *text)
{
    tl_model *m = service_of(host)->model;
    if (!key || !tl_text_is_utf8(key) || (object && !tl_text_is_utf8(object)) || (text && !tl_text_is_utf8(text)))
        return fail(host, TL_E_ARGUMENT, "a note has no key, or a text that is not in UTF-8");
    return tl_notes_add(m->notes, object, key, number, text) ? TL_OK : tl_fail_memory(&m->error);
}

static const char *reason(const tl_host *host)
{
    return service_of(host)->model->error.text;
}

/* ---------------------------------------------------------------- tl_generate ------------ */

/* The services, for a generator of the model's. */
static tl_host host_of(service *s)
{
    return (tl_host){.size = sizeof(tl_host),
                     .impl = s,
                     .seed = (uint64_t)s->model->config.seed,
                     .create_hull = create_hull,
                     .create_block = create_block,
                     .create_box = create_box,
                     .joint = joint,
                     .next_plane = next_plane,
                     .cut = cut,
                     .block_count = block_count,
                     .block_info = block_info,
                     .random = draw_uniform,
                     .progress = progress,
                     .log = say,
                     .fail = fail,
                     .cut_disc = cut_disc,
                     .meets = meets,
                     .cut_block = cut_block,
                     .set_group = set_group,
                     .part = part,
                     .join = join,
                     .remove = remove_block,
                     .hide = hide,
                     .show = show,
                     .read_mesh = read_mesh,
                     .create_solid = create_solid,
                     .note = note,
                     .reason = reason,
                     .cut_polygon = cut_polygon};
}

/* The files that are to be read must be such as end; those that are not there are left to the plugin. */
static tl_status check_files(tl_model *m, const tl_kind *kind, const void *params, const char *context)
{
    for (uint32_t i = 0; i < kind->param_count; i++) {
        const tl_param *p = &kind->params[i];
        const char *file = NULL;
        if (p->type != TL_PARAM_STRING || !(p->flags & TL_PARAM_FILE))
            continue;
        memcpy(&file, (const char *)params + p->offset, sizeof file);
        const char *other = file ? tl_not_regular(file) : NULL;
        if (other)
            return tl_fail(&m->error, TL_E_IO, "%s: %s '%.200s' is %s: only regular files are read", context, p->name,
                           file, other);
    }
    return TL_OK;
}

/* Calls the plugin with parameters on the staging set. `entry`: ", entry 3" of a list, or nothing. */
static tl_status call(service *s, const tl_kind *kind, const tl_args *args, void *params, const char *entry)
{
    tl_model *m = s->model;
    const tl_generator_ops *ops = kind->ops;
    tl_host host = host_of(s);
    char context[TL_ERROR_TEXT / 4];
    snprintf(context, sizeof context, "generator '%s'%s", kind->name, entry);
    memset(params, 0, kind->params_size);
    tl_status status =
        tl_args_read(kind->params, kind->param_count, kind->param_stride, args, false, params, context, &m->error);
    if (status == TL_OK)
        status = check_files(m, kind, params, context);
    if (status != TL_OK)
        return status;
    m->error = (tl_error){TL_OK, ""};
    tl_enter(kind, "generate");
    status = ops->generate(&host, params);
    tl_leave();
    if (status == TL_OK) /* the plugin may not have asked */
        status = go_on(&host);
    if (s->stage.lost)
        status = tl_fail_memory(&m->error);
    if (status == TL_OK)
        return TL_OK;
    if (m->error.text[0] == '\0')
        tl_fail(&m->error, status, "no reason given (status %d: %s)", (int)status, tl_status_text(status));
    m->error.status = status;
    tl_error_prefix(&m->error, "generator '%s' of plugin '%s'%s: ", kind->name, tl_plugin_id(kind), entry);
    return status;
}

/* Calls the plugin with each of several sets of parameters, and closes the staging set. */
static tl_status run(service *s, const tl_kind *kind, const tl_args *args, size_t count, bool list)
{
    tl_model *m = s->model;
    void *params = malloc(kind->params_size + 1);
    tl_status status = params ? tl_stage_begin_empty(m, &s->stage) : tl_fail_memory(&m->error);
    if (status != TL_OK) {
        free(params);
        return status;
    }
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        char entry[40] = "";
        s->entry = i;
        s->share = 0;
        if (list)
            snprintf(entry, sizeof entry, ", entry %zu", i + 1);
        status = call(s, kind, &args[i], params, entry);
    }
    free(params);
    if (status != TL_OK) {
        tl_stage_end(&s->stage);
        return status;
    }
    status = tl_stage_commit(&s->stage);
    if (status != TL_OK)
        tl_error_prefix(&m->error, "generator '%s' of plugin '%s': ", kind->name, tl_plugin_id(kind));
    return status;
}

static tl_status generate(tl_model *m, const char *generator, const tl_args *args, size_t count, bool list,
                          tl_generate_summary *summary)
{
    tl_status status = tl_model_may_change(m, "create blocks");
    if (status != TL_OK)
        return status;
    const tl_kind *kind = tl_plugin_find(TL_KIND_GENERATOR, generator);
    if (!kind)
        return tl_kind_unknown(&m->error, TL_KIND_GENERATOR, generator);
    service s = {.model = m, .generator = kind->name, .entries = count};
    atomic_store(&m->interrupted, false);
    tl_notes_free(m->notes);
    m->notes = tl_notes_new();
    status = m->notes ? run(&s, kind, args, count, list) : tl_fail_memory(&m->error);
    tl_mesh_parts_free(&s.parts);
    if (status != TL_OK) {
        tl_notes_free(m->notes);
        m->notes = NULL;
    }
    if (status == TL_OK && summary)
        *summary = s.stage.summary;
    return status;
}

tl_status tl_generate(tl_model *m, const char *generator, const tl_args *args, tl_generate_summary *summary)
{
    return generate(m, generator, args, 1, false, summary);
}

tl_status tl_generate_list(tl_model *m, const char *generator, const tl_args *args, size_t count,
                           tl_generate_summary *summary)
{
    return generate(m, generator, args, count, true, summary);
}
