/* keyblocks.c - block theory on the blocks as they are: which bodies can move out, how, and with what factor of
 * safety. After Goodman and Shi 1985 (Shi's theorem), and Warburton 1981 for the modes.
 *
 * Let n_i be the outward unit normals of the faces in contact with other bodies. A body can be moved by a translation
 * d when d . n_i <= 0 for all i. These d are its joint pyramid, a convex cone. The body is removable when the cone
 * holds more than zero. A block that is convex and finite then has its free faces on the way out. A cone other than
 * {0} holds an edge n_i x n_j or, when all normals are parallel, -n_1; so looking at these decides it.
 *
 * The active force r is the weight and the load of the body, and what elements do on it as it is now. It moves the body
 * along the direction in the cone that gains the most energy. That is the projection s of r on the cone,
 *
 *     r = s + sum N_i n_i,   N_i >= 0,   s . n_i <= 0,   N_i (s . n_i) = 0
 *
 * with no N_i (falling), one (sliding on a face) or two (sliding on two faces); s = 0 is stable whatever the friction.
 * s is one; where three faces or more lie along it, as in a prism, the N_i are not: the least safe ones count.
 * Factor of safety, with joints that do not dilate and no joint forces beyond those the active force brings about:
 *
 *     sum (N_i tan(friction_i) + cohesion_i A_i) / |s|
 *
 * A body on rollers moves in what is left of space, P. Its cone lies in P, and r and the normals are projected on it.
 * With n' = P n, N_i is then that over |n'_i|; rollers take the rest, without friction.
 *
 * The support S against the motion leaves N_i as they are. A factor F takes S = |s| - sum (...) / F, and all of |s| of
 * what falls. Outer faces have the area vector -sum A_i n_i, since that of a closed surface is zero. A pressure p on
 * them pushes against the motion, of direction d, with p (-sum A_i n_i) . d.
 *
 * The faces are those on which the body lay when it was made, for settling tilts it and parts walls (touching.c). A
 * body may have moved by more than TL_TOUCH_KEPT of its size against what it touches. Its faces are those on which it
 * lies now.
 *
 * Limits: translations only; each body alone, all others at rest. A body of several blocks is judged by its contact
 * faces alone, which is exact only when it is convex. */
#include "base/error.h"
#include "element/act.h"
#include "element/follow.h"
#include "model/joints.h"
#include "model/options.h"
#include "model/rows.h"
#include "query/touching.h"

#include <stdlib.h>

/* The faces of a body in contact that have one normal. */
typedef struct constraint {
    tl_vec3 normal;
    tl_vec3 along; /* unit: the normal's part in which the body may move; zero where that is none */
    double lean;   /* length of that part */
    double area;
    double friction; /* sum of area times tan(friction) */
    double cohesion; /* sum of area times cohesion, N */
    tl_tag joint;    /* of the largest of them */
    double largest;
} constraint;

typedef struct work {
    tl_model *model;
    const tl_keyblock_query *query;
    tl_tag *strength; /* the parsed joints of the query */
    tl_touches touches;
    constraint *faces;
    size_t count, capacity;
    tl_vec3 held[3]; /* directions in which the body is held, 0 to 2 of them */
    size_t held_count;
    size_t moved_count; /* bodies whose faces are those of now; the first */
    tl_id moved_first;
    size_t block_capacity, edge_capacity;
    tl_vec3 gravity; /* m/s2 */
    tl_vec3 *pushed; /* by elements, on each body, N; NULL: there are none */
    tl_keyblocks *result;
} work;

/* ---------------------------------------------------------------- strength --------------- */

/* Limit: gravity and cohesion beyond which products with masses and areas leave the range of numbers. */
#define LARGEST 1e100

/* How closely a joint of the query names a tag: 3 the plane, 2 the set, 1 every joint, 0 not. */
static int closeness(tl_tag pattern, tl_tag tag)
{
    if (!tl_tag_matches(pattern, tag))
        return 0;
    return pattern.joint == 0 ? 1 : pattern.plane == 0 ? 2 : 3;
}

/* Friction and cohesion of a tag: each by the closest entry that gives it. */
static tl_status strength_of(work *w, tl_tag tag, double *friction, double *cohesion)
{
    int friction_by = 0, cohesion_by = 0;
    *friction = NAN;
    *cohesion = 0;
    for (size_t i = 0; i < w->query->count; i++) {
        const tl_joint_strength *s = &w->query->strength[i];
        int close = closeness(w->strength[i], tag);
        if (close > friction_by && !isnan(s->friction)) {
            friction_by = close;
            *friction = s->friction;
        }
        if (close > cohesion_by && !isnan(s->cohesion)) {
            cohesion_by = close;
            *cohesion = s->cohesion;
        }
    }
    if (friction_by == 0)
        return tl_fail(&w->model->error, TL_E_ARGUMENT,
                       "keyblocks: no friction is given for the faces of joint '%s'; give it, or one for '*'",
                       tl_tag_name(w->model, tag));
    return TL_OK;
}

static tl_status parse_strength(work *w)
{
    w->strength = malloc((w->query->count + 1) * sizeof *w->strength);
    if (!w->strength)
        return tl_fail_memory(&w->model->error);
    tl_status status = TL_OK;
    for (size_t i = 0; i < w->query->count && status == TL_OK; i++) {
        const tl_joint_strength *s = &w->query->strength[i];
        status = tl_joint_parse(w->model, s->joint, &w->strength[i]);
        if (status == TL_OK && !isnan(s->friction) && !(s->friction >= 0 && s->friction < 90))
            status = tl_fail(&w->model->error, TL_E_ARGUMENT,
                             "keyblocks: joint '%s': friction = %g deg is outside [0, 90)", s->joint, s->friction);
        if (status == TL_OK && !isnan(s->cohesion) && !(s->cohesion >= 0 && s->cohesion <= LARGEST))
            status =
                tl_fail(&w->model->error, TL_E_ARGUMENT, "keyblocks: joint '%s': cohesion = %g Pa is outside [0, %g]",
                        s->joint, s->cohesion, LARGEST);
    }
    return status;
}

/* The acceleration that is asked for, or that of the model. */
static tl_status find_gravity(work *w)
{
    w->gravity = isnan(w->query->gravity.x) ? w->model->config.gravity : w->query->gravity;
    const tl_vec3 g = w->gravity;
    const double most = fmax(fmax(fabs(g.x), fabs(g.y)), fabs(g.z));
    if (most == 0 || (most >= 1 / LARGEST && most <= LARGEST))
        return TL_OK;
    return tl_fail(&w->model->error, TL_E_ARGUMENT, "keyblocks: gravity of %g m/s2 must be 0 or within [%g, %g]", most,
                   1 / LARGEST, LARGEST);
}

/* ---------------------------------------------------------------- faces ------------------ */

/* What is left of a vector in the directions in which the body may move. */
static tl_vec3 part_along(const work *w, tl_vec3 v)
{
    for (size_t k = 0; k < w->held_count; k++)
        v = tl_v3_madd(v, -tl_v3_dot(v, w->held[k]), w->held[k]);
    return v;
}

static tl_status add_face(work *w, const tl_touch *touch, tl_vec3 normal)
{
    double friction, cohesion;
    tl_status status = strength_of(w, touch->joint, &friction, &cohesion);
    if (status != TL_OK)
        return status;
    size_t i = 0;
    while (i < w->count && !(tl_v3_norm(tl_v3_sub(w->faces[i].normal, normal)) <= TL_TOUCH_ALONG))
        i++;
    if (i == w->count) {
        if (!tl_grow(&w->faces, &w->capacity, w->count + 1, sizeof *w->faces))
            return tl_fail_memory(&w->model->error);
        tl_vec3 along = part_along(w, normal);
        double lean = tl_v3_norm(along);
        w->faces[w->count++] =
            (constraint){.normal = normal,
                         .along = lean > TL_TOUCH_ALONG ? tl_v3_scale(1 / lean, along) : tl_v3(0, 0, 0),
                         .lean = lean};
    }
    constraint *face = &w->faces[i];
    face->area += touch->area;
    face->friction += touch->area * tl_sin_degrees(friction) / tl_cos_degrees(friction);
    face->cohesion += touch->area * cohesion;
    if (touch->area > face->largest) {
        face->largest = touch->area;
        face->joint = touch->joint;
    }
    return TL_OK;
}

/* The faces of a body in contact, by normal. */
static tl_status gather_faces(work *w, uint32_t body)
{
    const tl_model *m = w->model;
    const uint32_t *member = m->members + m->bodies.member_start[body];
    const size_t count = m->bodies.member_count[body];
    const bool now = tl_touches_moved(m, &w->touches, body);
    if (now && w->moved_count++ == 0)
        w->moved_first = m->blocks.id[member[0]];
    w->held_count = tl_held_axes(m, body, w->held);
    w->count = 0;
    tl_status status = TL_OK;
    for (size_t k = 0; k < count && status == TL_OK; k++)
        for (size_t i = w->touches.start[member[k]]; i < w->touches.start[member[k] + 1] && status == TL_OK; i++) {
            const tl_touch *touch = &w->touches.at[i];
            status = add_face(w, touch, tl_touch_normal(m, touch, now));
        }
    return status;
}

/* ---------------------------------------------------------------- pyramid ---------------- */

/* Whether a motion along the unit vector d runs into no face, those on `d` by construction aside. */
static bool is_free(const work *w, tl_vec3 d, size_t i, size_t j)
{
    for (size_t k = 0; k < w->count; k++)
        if (k != i && k != j && tl_v3_dot(d, w->faces[k].along) > TL_TOUCH_ALONG)
            return false;
    return true;
}

static tl_status add_edge(work *w, size_t first, tl_vec3 d)
{
    tl_keyblocks *r = w->result;
    for (size_t i = first; i < r->edge_count; i++)
        if (tl_v3_norm(tl_v3_sub(r->edges[i], d)) <= TL_TOUCH_ALONG)
            return TL_OK;
    if (!tl_grow(&r->edges, &w->edge_capacity, r->edge_count + 1, sizeof *r->edges))
        return tl_fail_memory(&w->model->error);
    r->edges[r->edge_count++] = d;
    return TL_OK;
}

/* Adds both directions of a line, where they are free. */
static tl_status add_line(work *w, size_t first, tl_vec3 line, size_t i, size_t j)
{
    if (tl_v3_norm(line) <= TL_TOUCH_ALONG)
        return TL_OK;
    tl_vec3 d = tl_v3_unit(line);
    tl_status status = TL_OK;
    for (int side = 0; side < 2 && status == TL_OK; side++, d = tl_v3_neg(d))
        if (is_free(w, d, i, j))
            status = add_edge(w, first, d);
    return status;
}

/* Whether the normals leave a line, or in space a plane, that all of them are across. */
static bool leaves_room(const work *w)
{
    const constraint *one = NULL;
    bool parallel = true;
    for (size_t i = 0; i < w->count; i++) {
        if (tl_v3_is_zero(w->faces[i].along))
            continue;
        one = one ? one : &w->faces[i];
        parallel = parallel && tl_v3_norm(tl_v3_cross(one->along, w->faces[i].along)) <= TL_TOUCH_ALONG;
    }
    return !one || (parallel && w->held_count < 2);
}

/* Lists the edges of the joint pyramid from `first` on; *empty tells that it holds only zero. */
static tl_status find_pyramid(work *w, size_t first, bool *empty)
{
    tl_status status = TL_OK;
    for (size_t i = 0; i < w->count && status == TL_OK; i++) {
        if (w->held_count == 1)
            status = add_line(w, first, tl_v3_cross(w->faces[i].along, w->held[0]), i, i);
        for (size_t j = i + 1; j < w->count && w->held_count == 0 && status == TL_OK; j++)
            status = add_line(w, first, tl_v3_cross(w->faces[i].along, w->faces[j].along), i, j);
    }
    if (w->held_count == 2 && status == TL_OK)
        status = add_line(w, first, tl_v3_cross(w->held[0], w->held[1]), SIZE_MAX, SIZE_MAX);
    /* without edges: no face, one face, or faces that are all parallel */
    *empty = w->result->edge_count == first && !leaves_room(w);
    return status;
}

/* ---------------------------------------------------------------- mode ------------------- */

/* Begins a way to slide; what was found before may be less safe. */
static tl_keyblock other_way(const tl_keyblock *block, int32_t mode)
{
    tl_keyblock way = *block;
    way.mode = mode;
    way.face_count = 0;
    return way;
}

static void put_face(const work *w, tl_keyblock *block, size_t face, double normal_force)
{
    const constraint *c = &w->faces[face];
    block->faces[block->face_count++] = (tl_keyblock_face){c->joint, c->normal, c->area, normal_force / c->lean};
}

/* Sets direction and factor of safety from the sliding force s and the faces put. */
static void put_sliding(const work *w, tl_keyblock *block, tl_vec3 s, size_t i, size_t j)
{
    const size_t faces[2] = {i, j};
    block->driving = tl_v3_norm(s);
    block->direction = tl_v3_unit(s);
    double held = 0;
    for (size_t k = 0; k < block->face_count; k++) {
        const constraint *c = &w->faces[faces[k]];
        held += block->faces[k].normal_force * (c->friction / c->area) + c->cohesion;
    }
    block->safety = held / block->driving;
}

/* Where a face bears nothing, ways with it and without it differ by rounding: that of fewer faces stays. */
static void keep_less_safe(tl_keyblock *block, const tl_keyblock *way)
{
    if (way->safety < (1 - TL_TOUCH_ALONG) * block->safety)
        *block = *way;
}

static void slide_on_one(const work *w, tl_vec3 r, tl_keyblock *block)
{
    double size = tl_v3_norm(r);
    for (size_t i = 0; i < w->count; i++) {
        double normal_force = tl_v3_dot(r, w->faces[i].along);
        tl_vec3 s = tl_v3_madd(r, -normal_force, w->faces[i].along);
        if (!(normal_force > 0) || tl_v3_norm(s) <= TL_TOUCH_ALONG * size || !is_free(w, tl_v3_unit(s), i, i))
            continue;
        tl_keyblock way = other_way(block, TL_KEYBLOCK_SLIDING);
        put_face(w, &way, i, normal_force);
        put_sliding(w, &way, s, i, i);
        keep_less_safe(block, &way);
    }
}

static void slide_on_two(const work *w, tl_vec3 r, tl_keyblock *block)
{
    double size = tl_v3_norm(r);
    for (size_t i = 0; i < w->count; i++)
        for (size_t j = i + 1; j < w->count; j++) {
            tl_vec3 ni = w->faces[i].along, nj = w->faces[j].along;
            tl_vec3 line = tl_v3_cross(ni, nj);
            double sine2 = tl_v3_norm2(line), cosine = tl_v3_dot(ni, nj);
            if (sine2 <= TL_TOUCH_ALONG * TL_TOUCH_ALONG)
                continue;
            tl_vec3 s = tl_v3_scale(tl_v3_dot(r, line) / sine2, line);
            double ri = tl_v3_dot(r, ni), rj = tl_v3_dot(r, nj);
            double force_i = (ri - cosine * rj) / sine2, force_j = (rj - cosine * ri) / sine2;
            if (!(force_i > 0 && force_j > 0) || tl_v3_norm(s) <= TL_TOUCH_ALONG * size ||
                !is_free(w, tl_v3_unit(s), i, j))
                continue;
            tl_keyblock way = other_way(block, TL_KEYBLOCK_SLIDING_ON_TWO);
            put_face(w, &way, i, force_i);
            put_face(w, &way, j, force_j);
            put_sliding(w, &way, s, i, j);
            keep_less_safe(block, &way);
        }
}

static void find_mode(const work *w, tl_vec3 r, tl_keyblock *block)
{
    block->mode = TL_KEYBLOCK_STABLE;
    block->safety = INFINITY;
    if (!(tl_v3_norm2(r) > 0))
        return;
    if (is_free(w, tl_v3_unit(r), SIZE_MAX, SIZE_MAX)) {
        block->mode = TL_KEYBLOCK_FALLING;
        put_sliding(w, block, r, SIZE_MAX, SIZE_MAX);
        return;
    }
    slide_on_one(w, r, block);
    slide_on_two(w, r, block);
}

/* ---------------------------------------------------------------- all -------------------- */

/* What support brings the factor that is asked for. */
static void find_support(const work *w, tl_keyblock *block)
{
    const double target = w->query->target;
    double area = 0, all = 0;
    block->support = block->support_pressure = NAN;
    if (isnan(target))
        return;
    const double held = block->mode == TL_KEYBLOCK_STABLE ? INFINITY : block->safety * block->driving;
    block->support = fmax(0, block->driving - held / target);
    for (size_t i = 0; i < w->count; i++) {
        area -= w->faces[i].area * tl_v3_dot(w->faces[i].normal, block->direction);
        all += w->faces[i].area;
    }
    if (block->support == 0)
        block->support_pressure = 0;
    else if (area > TL_TOUCH_ALONG * all)
        block->support_pressure = block->support / area;
}

static tl_status test_body(work *w, uint32_t body)
{
    tl_model *m = w->model;
    tl_keyblocks *result = w->result;
    tl_status status = gather_faces(w, body);
    size_t first = result->edge_count;
    bool empty = true;
    if (status == TL_OK)
        status = find_pyramid(w, first, &empty);
    if (status != TL_OK || empty)
        return status;
    if (!tl_grow(&result->blocks, &w->block_capacity, result->count + 1, sizeof *result->blocks))
        return tl_fail_memory(&m->error);
    uint32_t lowest = m->members[m->bodies.member_start[body]];
    tl_keyblock block = {.block = m->blocks.id[lowest],
                         .mass = m->bodies.mass[body],
                         .edge_start = first,
                         .edge_count = result->edge_count - first};
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++)
        block.volume += m->blocks.volume[m->members[m->bodies.member_start[body] + k]];
    block.force = tl_v3_madd(tl_load_of(&m->bodies, body).force, block.mass, w->gravity);
    if (w->pushed)
        block.force = tl_v3_add(block.force, w->pushed[body]);
    find_mode(w, part_along(w, block.force), &block);
    find_support(w, &block);
    result->blocks[result->count++] = block;
    return TL_OK;
}

void tl_keyblocks_free(tl_keyblocks *keyblocks)
{
    free(keyblocks->blocks);
    free(keyblocks->edges);
    *keyblocks = (tl_keyblocks){0};
}

/* What elements do on bodies as they are. */
static tl_status find_pushed(work *w)
{
    tl_model *m = w->model;
    if (!tl_model_has_elements(m))
        return TL_OK;
    const tl_status status = tl_elements_ready(m);
    if (status != TL_OK)
        return status;
    w->pushed = calloc(m->bodies.table.rows + 1, sizeof *w->pushed);
    return w->pushed ? tl_elements_sum(m, w->pushed) : tl_fail_memory(&m->error);
}

/* Says what was left out, and whose faces are those of now. */
static void say(const work *w, size_t driven, tl_id first_driven)
{
    if (driven)
        tl_model_say(w->model, "keyblocks: %zu driven %s (first: block %u) %s left out", driven,
                     driven == 1 ? "body" : "bodies", first_driven, driven == 1 ? "is" : "are");
    bool one = w->moved_count == 1;
    if (w->moved_count)
        tl_model_say(w->model,
                     "keyblocks: %zu %s (first: block %u) %s moved against what %s by more than "
                     "%g %% of %s size: the faces are those that lie on each other now",
                     w->moved_count, one ? "body" : "bodies", w->moved_first, one ? "has" : "have",
                     one ? "it touches or touched" : "they touch or touched", 100 * TL_TOUCH_KEPT,
                     one ? "its" : "their");
}

tl_status tl_model_keyblocks(tl_model *m, const tl_keyblock_query *given, tl_keyblocks *result)
{
    *result = (tl_keyblocks){0};
    tl_keyblock_query query;
    work w = {.model = m, .query = &query, .result = result};
    size_t driven = 0;
    tl_id first_driven = TL_NO_ID;
    tl_status status = TL_OPTIONS_READ(tl_keyblock_query, given, &query, &m->error);
    tl_rows_tidy(m);
    if (status == TL_OK)
        status = find_gravity(&w);
    if (status == TL_OK && !isnan(query.target) && !(query.target > 0 && isfinite(query.target)))
        status =
            tl_fail(&m->error, TL_E_ARGUMENT, "keyblocks: target = %g must be a finite number above 0", query.target);
    if (status == TL_OK)
        status = parse_strength(&w);
    if (status == TL_OK)
        status = tl_touches_find(m, &w.touches);
    if (status == TL_OK)
        status = find_pushed(&w);
    for (uint32_t body = 0; body < m->bodies.table.rows && status == TL_OK; body++) {
        if (m->bodies.drive[body] && driven++ == 0)
            first_driven = m->bodies.id[body];
        if (!m->bodies.drive[body] && tl_held_axes(m, body, w.held) < 3)
            status = test_body(&w, body);
    }
    if (status == TL_OK)
        say(&w, driven, first_driven);
    free(w.strength);
    tl_touches_free(&w.touches);
    free(w.faces);
    free(w.pushed);
    if (status != TL_OK)
        tl_keyblocks_free(result);
    return status;
}
