/* verdict.c - how a model stands: what has moved of it, what its joints have slipped and opened, and all that in a
 * sentence. */
#include "io/verdict.h"

#include "base/groups.h"
#include "contact/places.h"
#include "contact/sides.h"
#include "cycle/cycle_data.h"
#include "cycle/meshes.h"
#include "cycle/rest.h"
#include "force/joint_laws.h"
#include "model/body_shape.h"
#include "model/rows.h"
#include "query/meeting.h"

#include <stdlib.h>
#include <string.h>
#include <talus/elementary.h>
#include <talus/kit.h>
#include <talus/vmath.h>

/* Tolerance: the local ratio below which a model is at rest that has not been asked to come to one. */
#define REST_RATIO 1e-5
/* Tolerance: share of sum |F| |v| that the power of the unbalanced forces is where they push bodies on. */
#define PUSHES 0.5
/* Tolerance: unbalanced forces over what bodies bear below which nothing accelerates that could be told from
 * settling. */
#define LEAST_UNBALANCED 1e-3

/* Tolerance: share of the largest displacement from which a block is one of those that move. Displacement over the
 * median size of blocks below which nothing is seen. */
#define LEAST_SHARE 0.05
#define LEAST_SEEN 1e-3
/* Tolerance: pages keep displacements in single precision: what is told to have closed is more than that rounds. */
#define ABOVE (1 + 1e-6)
/* What sudden loads make of what springs bear, and more than that. A load near the edge of a face turns a block by
 * more than its springs show. */
#define SPRINGS 3
/* Tolerance: what a joint may close, over the smaller block's size: more is a corner that has sunk in. */
#define MOST_SPRUNG 0.03

/* Of a body: its volume, m3, and size, m, and how far it has moved since displacements began to count, m. One that
 * has failed has moved, however far joints may close. */
typedef struct body_facts {
    double volume, size;
    tl_vec3 way;
    bool failed;
    bool still; /* of the first of a group: it has but closed its joints */
} body_facts;

/* Sums over contacts, and what they come to. The mean point, m, is relative to the model's origin; `passed` is how
 * far b has gone from a there, m. */
typedef struct means {
    double weight;
    tl_vec3 point, passed;
} means;

/* Where two bodies meet with faces that look the same way: one contact, or one for each part of a face. */
typedef struct meeting {
    uint32_t a, b;           /* bodies, a < b */
    tl_vec3 normal;          /* from a to b */
    double area;             /* m2 */
    means by_force;          /* where normal forces act */
    means mean;              /* by area, and in the end by force where there is one */
    tl_vec3 slip;            /* of b against a, across the normal, m */
    double opening;          /* m */
    double sprung;           /* how far the springs have let them move, m */
    tl_contact_name contact; /* the first */
} meeting;

/* Tolerance: faces of a meeting look the same way up to this sine: more than those of a face that rocks and has but
 * closed. */
#define SAME_WAY 0.05

/* All meetings, what is seen, and all bodies with the groups that hang together. */
typedef struct motion_list {
    meeting *meetings;
    size_t count;
    double seen;
    body_facts *body;
    uint32_t *of; /* groups.h */
} motion_list;

/* How far a body has moved since displacements began to count, m: the mean of its parts by their volumes. */
static tl_vec3 way_of(const tl_model *m, uint32_t body, double volume)
{
    const uint32_t *rows = &m->members[m->bodies.member_start[body]];
    if (m->bodies.member_count[body] == 1)
        return tl_block_displacement(m, rows[0]);
    tl_vec3 sum = {0, 0, 0};
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++)
        sum = tl_v3_madd(sum, m->blocks.volume[rows[k]], tl_block_displacement(m, rows[k]));
    return tl_v3_scale(1 / volume, sum);
}

static void find_bodies(const tl_model *m, const motion_list *list, tl_verdict *out)
{
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        const double volume = tl_body_volume(m, body);
        const tl_vec3 way = way_of(m, body, volume);
        const bool failed = out->standing == TL_STANDING_FAILED && m->bodies.id[body] == m->cycle->failing;
        list->body[body] = (body_facts){volume, tl_cbrt(volume), way, failed, false};
        list->of[body] = body;
        if (tl_v3_norm(way) > out->displacement) {
            out->displacement = tl_v3_norm(way);
            out->farthest = m->bodies.id[body];
        }
    }
}

/* ---------------------------------------------------------------- what has but closed ---- */

/* How far the springs of a contact have let its blocks move against each other, m, times its area: pressed or pulled
 * in, and sheared. */
static double sprung(const tl_model *m, uint32_t contact, const tl_contact_facts *facts)
{
    const tl_detect *d = m->detect;
    const double kn = facts->law == 0 ? 0 : m->joint_laws[facts->law - 1].kn;
    const double ks = facts->law == 0 ? 0 : m->joint_laws[facts->law - 1].ks;
    double pressed = 0;
    if (tl_row_is_meeting(m, contact) && kn > 0) {
        const tl_meeting by = tl_meeting_of(m, contact);
        pressed = fabs(by.pressing - by.initial) / kn;
    }
    for (size_t k = 0; k < tl_point_count(m, contact) && kn > 0; k++) {
        const size_t i = tl_point_row(&d->contacts, contact, k);
        pressed += fabs(d->points.f_n[i] - (d->points.f_n0 ? d->points.f_n0[i] : 0)) / kn;
    }
    return pressed + (ks > 0 ? tl_v3_norm(facts->shear_force) / ks : 0);
}

/* Rotation of a body since displacements of its first block began to count. */
static tl_quat turn_of(const tl_model *m, uint32_t body)
{
    const uint32_t row = m->members[m->bodies.member_start[body]];
    return tl_q_mul(m->bodies.q[body], tl_q_conj(tl_block_base(m, row).turn));
}

/* Where a point of a body was then, which has come by `way`. */
static tl_vec3 came_from(const tl_model *m, uint32_t body, tl_vec3 way, tl_vec3 x)
{
    const tl_vec3 c = tl_v3_add(m->origin, tl_body_place(&m->bodies, body));
    const tl_vec3 arm = tl_q_rotate(tl_q_conj(turn_of(m, body)), tl_v3_sub(x, c));
    return tl_v3_add(tl_v3_sub(c, way), arm);
}

/* Whether the bodies of a meeting have moved against each other, since the stage began, by no more than its springs. */
static bool has_but_closed(const tl_model *m, const motion_list *list, const meeting *of)
{
    const body_facts *of_a = &list->body[of->a], *of_b = &list->body[of->b];
    const double size = fmin(of_a->size, of_b->size);
    /* the contacts may be younger than the stage, and their blocks may have gone to and fro */
    const tl_vec3 point = tl_v3_add(m->origin, of->mean.point);
    const double parted =
        tl_v3_norm(tl_v3_sub(came_from(m, of->b, of_b->way, point), came_from(m, of->a, of_a->way, point)));
    const double slid = sqrt(tl_v3_norm2(of->slip) + of->opening * of->opening);
    const double turned = tl_v3_norm(tl_v3_sub(tl_q_vector(turn_of(m, of->b)), tl_q_vector(turn_of(m, of->a))));
    const double most = fmin(SPRINGS * of->sprung, MOST_SPRUNG * size) + list->seen;
    return fmax(parted, slid) <= most && turned * size <= most;
}

/* Finds which bodies have but closed their joints. They hang together, by contacts that have, with one that is held
 * or has moved by less than `closed`. */
static void find_still(const tl_model *m, const motion_list *list, const tl_verdict *v)
{
    for (size_t i = 0; i < list->count; i++) {
        const meeting *of = &list->meetings[i];
        if (!list->body[of->a].failed && !list->body[of->b].failed &&
            tl_first_of(list->of, of->a) != tl_first_of(list->of, of->b) && has_but_closed(m, list, of))
            tl_put_together(list->of, of->a, of->b);
    }
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        if (tl_v3_norm(list->body[body].way) <= v->closed && !list->body[body].failed)
            list->body[tl_first_of(list->of, body)].still = true;
}

static void find_moved(const tl_model *m, const motion_list *list, tl_verdict *out)
{
    const double least = fmax(out->closed, LEAST_SHARE * out->displacement);
    double closed = out->closed;
    tl_vec3 way = {0, 0, 0};
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        const body_facts *it = &list->body[body];
        const double far = tl_v3_norm(it->way);
        if (!(far > (it->failed ? list->seen : least)))
            continue;
        if (list->body[tl_first_of(list->of, body)].still) {
            closed = fmax(closed, ABOVE * far);
            continue;
        }
        out->moved++;
        out->volume += it->volume;
        way = tl_v3_madd(way, it->volume, it->way);
    }
    out->closed = closed;
    if (tl_v3_norm(way) > 0)
        out->direction = tl_v3_unit(way);
}

/* All that needs memory for each body. */
static bool find_motion(const tl_model *m, motion_list *list, tl_verdict *out)
{
    const size_t bodies = m->bodies.table.rows;
    list->body = malloc((bodies + 1) * sizeof *list->body);
    list->of = malloc((bodies + 1) * sizeof *list->of);
    const bool done = list->body && list->of;
    if (done) {
        find_bodies(m, list, out);
        find_still(m, list, out);
        find_moved(m, list, out);
    }
    free(list->body);
    free(list->of);
    return done;
}

/* ---------------------------------------------------------------- meetings --------------- */

/* A contact by its bodies, the lower one first. */
typedef struct between {
    uint32_t a, b;
    size_t contact;
    bool turned; /* its own first block is of b */
} between;

static int compare_between(const void *x, const void *y)
{
    const between *p = x, *q = y;
    if (p->a != q->a)
        return (p->a > q->a) - (p->a < q->a);
    if (p->b != q->b)
        return (p->b > q->b) - (p->b < q->b);
    return (p->contact > q->contact) - (p->contact < q->contact);
}

static void add_point(means *to, double weight, tl_vec3 point, tl_vec3 passed)
{
    to->weight += weight;
    to->point = tl_v3_madd(to->point, weight, point);
    to->passed = tl_v3_madd(to->passed, weight, passed);
}

/* How far b has gone from a by the facts of a contact, m. */
static tl_vec3 passed_of(const tl_contact_facts *facts)
{
    return tl_v3_madd(facts->shear_displacement, facts->opening, facts->normal);
}

/* Adds what a contact's points carry, and where; of segments what all of them do. */
static void add_forces(const tl_model *m, uint32_t contact, const tl_contact_facts *facts, double sign, means *to)
{
    const tl_detect *d = m->detect;
    if (tl_row_is_meeting(m, contact)) {
        const double force = fabs(facts->normal_force);
        if (force > 0)
            add_point(to, force, tl_v3_sub(facts->point, m->origin), tl_v3_scale(sign, passed_of(facts)));
        return;
    }
    const tl_vec3 from = tl_side_place(m, tl_contact_sides(m, contact).a);
    means own = {0};
    for (size_t k = 0; k < tl_point_count(m, contact); k++) {
        const double force = fabs(d->points.f_n[tl_point_row(&d->contacts, contact, k)]);
        if (force > 0)
            add_point(&own, force, tl_contact_point_arm(m, contact, k), tl_v3(0, 0, 0));
    }
    if (!(own.weight > 0))
        return;
    const tl_vec3 point = tl_v3_madd(from, 1 / own.weight, own.point);
    add_point(to, own.weight, point, tl_v3_scale(sign, tl_contact_passed(m, contact, point)));
}

/* Adds a contact to what two bodies have met by so far, from `first` on; sums, which are divided at the end. */
static void add_contact(const tl_model *m, motion_list *list, size_t first, const between *by, uint32_t row,
                        const tl_contact_facts *facts)
{
    const double sign = by->turned ? -1 : 1;
    const tl_vec3 normal = tl_v3_scale(sign, facts->normal);
    size_t i = first;
    while (i < list->count && !(tl_v3_dot(normal, list->meetings[i].normal) > 0 &&
                                tl_v3_norm(tl_v3_cross(normal, list->meetings[i].normal)) < SAME_WAY))
        i++;
    meeting *to = &list->meetings[i];
    if (i == list->count) {
        *to = (meeting){.a = by->a, .b = by->b, .normal = normal, .contact = {facts->a, facts->b, facts->born}};
        list->count++;
    }
    to->area += facts->area;
    to->sprung += sprung(m, row, facts);
    add_point(&to->mean, facts->area, tl_v3_sub(facts->point, m->origin), tl_v3_scale(sign, passed_of(facts)));
    add_forces(m, row, facts, sign, &to->by_force);
}

/* Makes means of the sums of a meeting. */
static void end_meeting(meeting *of)
{
    if (of->by_force.weight > 0)
        of->mean = of->by_force;
    of->mean.point = tl_v3_scale(1 / of->mean.weight, of->mean.point);
    of->mean.passed = tl_v3_scale(1 / of->mean.weight, of->mean.passed);
    of->opening = tl_v3_dot(of->mean.passed, of->normal);
    of->slip = tl_v3_madd(of->mean.passed, -of->opening, of->normal);
    of->sprung /= of->area;
}

static tl_sides bodies_of(const tl_model *m, uint32_t row, const tl_contact_facts *facts)
{
    if (!tl_row_is_meeting(m, row))
        return tl_contact_bodies(m, row);
    return (tl_sides){m->blocks.body[tl_block_row_quiet(m, facts->a)], m->blocks.body[tl_block_row_quiet(m, facts->b)]};
}

/* Finds the meetings; edges that only touch are none. false: out of memory. */
static bool find_meetings(const tl_model *m, const uint32_t *rows, const tl_contact_facts *facts, size_t count,
                          motion_list *list)
{
    size_t many = 0, first = 0;
    between *list_of = malloc((count + 1) * sizeof *list_of);
    list->meetings = malloc((count + 1) * sizeof *list->meetings);
    if (!list_of || !list->meetings) {
        free(list_of);
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        const tl_sides on = bodies_of(m, rows[i], &facts[i]);
        if (facts[i].area > 0)
            list_of[many++] = on.a < on.b ? (between){on.a, on.b, i, false} : (between){on.b, on.a, i, true};
    }
    qsort(list_of, many, sizeof *list_of, compare_between);
    for (size_t i = 0; i < many; i++) {
        const between *by = &list_of[i];
        if (i > 0 && (by->a != by[-1].a || by->b != by[-1].b))
            first = list->count;
        add_contact(m, list, first, by, rows[by->contact], &facts[by->contact]);
    }
    free(list_of);
    for (size_t i = 0; i < list->count; i++)
        end_meeting(&list->meetings[i]);
    return true;
}

static void find_slip(const motion_list *list, tl_verdict *out)
{
    for (size_t i = 0; i < list->count; i++) {
        const meeting *of = &list->meetings[i];
        const double slip = tl_v3_norm(of->slip);
        if (slip > out->slip) {
            out->slip = slip;
            out->slipped = of->contact;
        }
        if (of->opening > out->opening) {
            out->opening = of->opening;
            out->opened = of->contact;
        }
    }
}

/* The unbalanced force on a body, what it bears, N, and its velocity; of a mesh those of the whole. */
typedef struct push {
    tl_vec3 force, velocity;
    double borne;
} push;

static push push_of(const tl_model *m, uint32_t body, double gravity)
{
    const tl_bodies *b = &m->bodies;
    const tl_body_mesh *mesh = tl_mesh_of_body(m, body);
    if (!mesh)
        return (push){b->force[body], b->v[body], tl_borne(m, body, tl_weight_of(b, body, gravity))};
    const tl_mesh_whole whole = tl_mesh_whole_of(m, mesh);
    return (push){whole.force, whole.velocity, fmax(whole.borne, whole.weight)};
}

/* Whether the unbalanced forces push bodies on, the way they go. */
static bool accelerates(const tl_model *m)
{
    const double gravity = tl_v3_norm(m->config.gravity);
    tl_addends power = {.count = 0}, most = {.count = 0}, unbalanced = {.count = 0}, borne = {.count = 0};
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        if (!tl_body_is_free(m, body))
            continue;
        const push of = push_of(m, body, gravity);
        const double force = tl_v3_norm(of.force);
        tl_addends_put(&power, tl_v3_dot(of.force, of.velocity));
        tl_addends_put(&most, force * tl_v3_norm(of.velocity));
        tl_addends_put(&unbalanced, force);
        tl_addends_put(&borne, of.borne);
    }
    return tl_addends_sum(&power) > PUSHES * tl_addends_sum(&most) &&
           tl_addends_sum(&unbalanced) > LEAST_UNBALANCED * tl_addends_sum(&borne);
}

/* How the model stands: at rest, failed, or on its way; as of the last step. Nothing changes. */
static tl_standing standing_of(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    if (!c || m->cycles == 0)
        return TL_STANDING_UNKNOWN;
    const uint32_t worst = c->sums.worst; /* to ask changes nothing */
    const bool rests = tl_at_rest(m, TL_RATIO_LOCAL, c->rest_ratio > 0 ? c->rest_ratio : REST_RATIO);
    c->sums.worst = worst;
    if (rests)
        return TL_STANDING_AT_REST;
    if (c->failing != TL_NO_ID)
        return TL_STANDING_FAILED;
    return accelerates(m) ? TL_STANDING_ACCELERATING : TL_STANDING_MOVING;
}

tl_status tl_verdict_of(tl_model *m, double median, const uint32_t *rows, const tl_contact_facts *facts, size_t count,
                        tl_verdict *out)
{
    motion_list list = {.seen = LEAST_SEEN * median};
    *out = (tl_verdict){.farthest = TL_NO_ID};
    out->standing = standing_of(m);
    out->ratio = tl_model_balance(m).ratio_local;
    out->closed = list.seen;
    memcpy(out->stage, m->stage, sizeof out->stage);
    out->contacts = count;
    for (size_t i = 0; i < count; i++)
        out->slipping += facts[i].state == TL_CONTACT_SLIPPING;
    const bool done = find_meetings(m, rows, facts, count, &list) && find_motion(m, &list, out);
    if (done)
        find_slip(&list, out);
    free(list.meetings);
    return done ? TL_OK : tl_fail_memory(&m->error);
}

tl_status tl_model_verdict(tl_model *m, tl_verdict *out)
{
    uint32_t *rows;
    size_t count, meetings;
    tl_status status = tl_contacts_listed(m, &rows, &count, &meetings);
    if (status != TL_OK)
        return status;
    tl_contact_facts *facts = malloc((count + 1) * sizeof *facts);
    for (size_t i = 0; facts && i < count; i++)
        facts[i] = tl_contact_facts_of(m, rows[i]);
    double median;
    status = facts && tl_median_size(m, &median) ? tl_verdict_of(m, median, rows, facts, count, out)
                                                 : tl_fail_memory(&m->error);
    free(facts);
    free(rows);
    return status;
}

/* ---------------------------------------------------------------- text ------------------- */

const char *tl_standing_name(tl_standing standing)
{
    static const char *const names[] = {[TL_STANDING_UNKNOWN] = "unknown",
                                        [TL_STANDING_AT_REST] = "at rest",
                                        [TL_STANDING_MOVING] = "moving",
                                        [TL_STANDING_ACCELERATING] = "accelerating",
                                        [TL_STANDING_FAILED] = "failed"};
    return (size_t)standing < sizeof names / sizeof names[0] ? names[standing] : "unknown";
}

/* Trend and plunge of a direction as 270/33, degrees; upward plunges are negative. */
static void put_direction(tl_vec3 way, char *text, size_t size)
{
    double trend = tl_atan2(way.x, way.y) / TL_DEGREE;
    double plunge = tl_atan2(-way.z, sqrt(way.x * way.x + way.y * way.y)) / TL_DEGREE;
    int down = (int)floor(plunge + 0.5);
    int whole = abs(down) == 90 ? 0 : (int)floor(trend + 0.5); /* straight down has no trend */
    tl_text_print(text, size, "%03d/%s%02d", (whole + 360) % 360, down < 0 ? "-" : "", abs(down));
}

/* How little everything has moved: not at all, by less than is seen, or by what its joints close. */
static void put_still(const tl_verdict *v, const char *since, char *text, size_t size)
{
    if (v->displacement == 0)
        tl_text_print(text, size, "no block has moved%s", since);
    else if (ABOVE * v->displacement < v->closed)
        tl_text_print(text, size, "no block has moved%s by more than %.2g m", since, v->displacement);
    else
        tl_text_print(text, size, "no block has moved%s by more than its joints close (%.2g m)", since,
                      v->displacement);
}

/* What has moved, and where to. */
static void put_moved(const tl_verdict *v, char *text, size_t size)
{
    char way[16], since[TL_STAGE_NAME + 24] = "";
    if (v->stage[0])
        tl_text_print(since, sizeof since, " since stage \"%s\"", v->stage);
    if (v->moved == 0) {
        put_still(v, since, text, size);
        return;
    }
    const bool one = v->moved == 1;
    put_direction(v->direction, way, sizeof way);
    tl_text_print(text, size, "%zu %s (%.3g m3) %s moved%s, towards %s, block %u the farthest, by %.3g m", v->moved,
                  one ? "block" : "blocks", v->volume, one ? "has" : "have", since, way, v->farthest, v->displacement);
}

void tl_verdict_text(const tl_verdict *v, char *text, size_t size)
{
    char moved[256], joints[96] = "";
    if (v->standing == TL_STANDING_UNKNOWN) {
        tl_text_print(text, size, "No step has been made.");
        return;
    }
    put_moved(v, moved, sizeof moved);
    const bool slipped = v->moved > 0 && v->slip > v->closed;
    const bool opened = v->moved > 0 && v->opening > v->closed;
    if (slipped)
        tl_text_print(joints, sizeof joints, "; largest slip %.3g m", v->slip);
    const size_t length = strlen(joints);
    if (opened)
        tl_text_print(joints + length, sizeof joints - length, "%s opening %.3g m", slipped ? "," : "; largest",
                      v->opening);
    tl_text_print(text, size, "The model %s %s: %s%s.", v->standing == TL_STANDING_FAILED ? "has" : "is",
                  tl_standing_name(v->standing), moved, joints);
}
