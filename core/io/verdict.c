/* verdict.c - how a model stands: what has moved of it, what its joints have slipped and opened, and all that in a sentence. */
#include "io/verdict.h"

#include "base/groups.h"
#include "contact/detection.h"
#include "cycle/standing.h"
#include "force/joint_laws.h"
#include "model/body_shape.h"

#include <stdlib.h>
#include <string.h>
#include <talus/elementary.h>
#include <talus/kit.h>
#include <talus/vmath.h>

/* Share of the largest displacement below which a block goes with those that move, and displacement over the median size of blocks below which
 * nothing is seen. */
#define LEAST_SHARE 0.05
#define LEAST_SEEN 1e-3
/* Displacement over the median size that is more than settling, but where a block goes with those on which it lies. */
#define MOST_SETTLED 0.01
/* Pages keep displacements in single precision: what is told to have closed is more than that rounds. */
#define ABOVE (1 + 1e-6)
/* What sudden loads make of what springs bear, and more than that: a load near the edge of a face turns a block by more than its springs show. */
#define SPRINGS 3
/* What a joint may close, over the smaller block's size: more is a corner that has sunk in. */
#define MOST_SPRUNG 0.03

/* Of a body: its volume, m3, and size, m; how far it has moved since displacements began to count, m; and whether it has failed, which is to have
 * moved, however far joints may close. */
typedef struct body_facts {
    double volume, size;
    tl_vec3 way;
    bool failed;
    bool still; /* of the first of a group: it has but closed its joints */
} body_facts;

/* Contacts with points, their facts, what is seen, and all bodies with the groups that hang together. */
typedef struct contact_list {
    const uint32_t *rows;
    const tl_contact_facts *facts;
    size_t count;
    double seen;
    body_facts *body;
    uint32_t *of; /* groups.h */
} contact_list;

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

bool tl_median_size(const tl_model *m, double *median)
{
    size_t n = 0;
    double *sizes = malloc((m->bodies.table.rows + 1) * sizeof *sizes);
    if (!sizes)
        return false;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        if (m->bodies.fixed[body] != TL_FIX_ALL)
            sizes[n++] = tl_body_size(m, body);
    qsort(sizes, n, sizeof *sizes, compare);
    *median = n ? sizes[n / 2] : 0;
    free(sizes);
    return true;
}

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

static void find_bodies(const tl_model *m, const contact_list *list, tl_verdict *out)
{
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        const double volume = tl_body_volume(m, body);
        const tl_vec3 way = way_of(m, body, volume);
        const bool failed =
            out->standing == TL_STANDING_FAILED && m->bodies.id[body] == tl_model_failing(m);
        list->body[body] = (body_facts){volume, tl_cbrt(volume), way, failed, false};
        list->of[body] = body;
        if (tl_v3_norm(way) > out->displacement) {
            out->displacement = tl_v3_norm(way);
            out->farthest = m->bodies.id[body];
        }
    }
}

/* ---------------------------------------------------------------- what has but closed ---- */

/* How far the springs of a contact may have let its blocks move against each other, m: the most that a point is pressed or pulled in, and
 * what is sheared. */
static double sprung(const tl_model *m, uint32_t contact, const tl_contact_facts *facts)
{
    const tl_detect *d = m->detect;
    const uint32_t law = d->contacts.law[contact];
    const double kn = law == TL_NO_ROW ? 0 : m->joint_laws[law].kn;
    const double ks = law == TL_NO_ROW ? 0 : m->joint_laws[law].ks;
    double most = 0;
    for (size_t k = 0; k < d->contacts.point_count[contact] && kn > 0; k++) {
        const size_t i = tl_point_row(&d->contacts, contact, k);
        const double area = d->points.area[i], initial = d->points.f_n0 ? d->points.f_n0[i] : 0;
        most = fmax(most, area > 0 ? fabs(d->points.f_n[i] - initial) / (kn * area) : 0);
    }
    return most +
           (ks > 0 && facts->area > 0 ? tl_v3_norm(facts->shear_force) / (ks * facts->area) : 0);
}

/* Rotation of a block since displacements began to count. */
static tl_quat turn_of(const tl_model *m, uint32_t row)
{
    const tl_quat q = m->bodies.q[m->blocks.body[row]];
    return m->blocks.base_turn ? tl_q_mul(q, tl_q_conj(m->blocks.base_turn[row])) : q;
}

/* Where a point of a block's body was then, which has come by `way`. */
static tl_vec3 came_from(const tl_model *m, uint32_t row, tl_vec3 way, tl_vec3 x)
{
    const tl_vec3 c = tl_v3_add(m->origin, tl_body_place(&m->bodies, m->blocks.body[row]));
    const tl_vec3 arm = tl_q_rotate(tl_q_conj(turn_of(m, row)), tl_v3_sub(x, c));
    return tl_v3_add(tl_v3_sub(c, way), arm);
}

/* Whether the bodies of contact i have moved against each other, since the stage began, by no more than its springs. */
static bool has_but_closed(const tl_model *m, const contact_list *list, size_t i)
{
    const uint32_t c = list->rows[i];
    const uint32_t a = m->detect->contacts.a[c], b = m->detect->contacts.b[c];
    const body_facts *of_a = &list->body[m->blocks.body[a]], *of_b = &list->body[m->blocks.body[b]];
    const tl_contact_facts *facts = &list->facts[i];
    const double size = fmin(of_a->size, of_b->size);
    /* the contact may be younger than the stage, and its blocks may have gone to and fro */
    const double parted = tl_v3_norm(tl_v3_sub(came_from(m, b, of_b->way, facts->point),
                                               came_from(m, a, of_a->way, facts->point)));
    const double slid =
        sqrt(tl_v3_norm2(facts->shear_displacement) + facts->opening * facts->opening);
    const double turned =
        tl_v3_norm(tl_v3_sub(tl_q_vector(turn_of(m, b)), tl_q_vector(turn_of(m, a))));
    const double most = fmin(SPRINGS * sprung(m, c, facts), MOST_SPRUNG * size) + list->seen;
    return fmax(parted, slid) <= most && turned * size <= most;
}

/* Finds which bodies have but closed their joints: those that hang together, by contacts that have, with one that is held or has moved by less
 * than `closed`. */
static void find_still(const tl_model *m, const contact_list *list, const tl_verdict *v)
{
    for (size_t i = 0; i < list->count; i++) {
        const uint32_t a = m->blocks.body[m->detect->contacts.a[list->rows[i]]];
        const uint32_t b = m->blocks.body[m->detect->contacts.b[list->rows[i]]];
        if (!list->body[a].failed && !list->body[b].failed &&
            tl_first_of(list->of, a) != tl_first_of(list->of, b) && has_but_closed(m, list, i))
            tl_put_together(list->of, a, b);
    }
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        if (tl_v3_norm(list->body[body].way) <= v->closed && !list->body[body].failed)
            list->body[tl_first_of(list->of, body)].still = true;
}

static void find_moved(const tl_model *m, const contact_list *list, tl_verdict *out)
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
static bool find_motion(const tl_model *m, contact_list *list, tl_verdict *out)
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

static void find_slip(const tl_contact_facts *facts, size_t count, tl_verdict *out)
{
    out->contacts = count;
    for (size_t i = 0; i < count; i++) {
        out->slipping += facts[i].state == TL_CONTACT_SLIPPING;
        if (!(facts[i].area > 0))
            continue; /* edges that touch: parts of a body meet its neighbours with them, too */
        const double slip = tl_v3_norm(facts[i].shear_displacement);
        if (slip > out->slip) {
            out->slip = slip;
            out->slipped = facts[i].id;
        }
        if (facts[i].opening > out->opening) {
            out->opening = facts[i].opening;
            out->opened = facts[i].id;
        }
    }
}

tl_status tl_verdict_of(tl_model *m, double median, const uint32_t *rows,
                        const tl_contact_facts *facts, size_t count, tl_verdict *out)
{
    contact_list list = {rows, facts, count, LEAST_SEEN * median, NULL, NULL};
    *out = (tl_verdict){.farthest = TL_NO_ID, .slipped = TL_NO_ID, .opened = TL_NO_ID};
    out->standing = tl_model_stands(m);
    out->ratio = tl_model_balance(m).ratio_local;
    out->closed = list.seen;
    if (out->standing != TL_STANDING_UNKNOWN)
        out->closed = fmax(list.seen, fmin(tl_closed_by_weight(m), MOST_SETTLED * median));
    memcpy(out->stage, m->stage, sizeof out->stage);
    find_slip(facts, count, out);
    return find_motion(m, &list, out) ? TL_OK : tl_fail_memory(&m->error);
}

tl_status tl_model_verdict(tl_model *m, tl_verdict *out)
{
    uint32_t *rows;
    size_t count;
    tl_status status = tl_contacts_listed(m, &rows, &count);
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

/* What has moved, and where to. */
static void put_moved(const tl_verdict *v, char *text, size_t size)
{
    char way[16], since[TL_STAGE_NAME + 24] = "";
    if (v->stage[0])
        tl_text_print(since, sizeof since, " since stage \"%s\"", v->stage);
    if (v->moved == 0) {
        tl_text_print(text, size, "no block has moved by more than its joints close%s (%.2g m)",
                      since, v->closed);
        return;
    }
    const bool one = v->moved == 1;
    put_direction(v->direction, way, sizeof way);
    tl_text_print(text, size,
                  "%zu %s (%.3g m3) %s moved%s, towards %s, block %u the farthest, by %.3g m",
                  v->moved, one ? "block" : "blocks", v->volume, one ? "has" : "have", since, way,
                  v->farthest, v->displacement);
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
        tl_text_print(joints + length, sizeof joints - length, "%s opening %.3g m",
                      slipped ? "," : "; largest", v->opening);
    tl_text_print(text, size, "The model %s %s: %s%s.",
                  v->standing == TL_STANDING_FAILED ? "has" : "is", tl_standing_name(v->standing),
                  moved, joints);
}
