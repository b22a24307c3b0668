/* trial.c - whether a model comes to rest with its strengths divided by a factor.
 *
 * A copy of the model comes to rest with its strengths raised by 1 / RAISED. Elastic joints settle then, and nothing
 * slips. Each trial is a copy of that copy, with the strengths of the model divided by the factor. It comes to rest
 * (cycle/relax.c) or something moves on.
 *
 * Two scales come from the model itself: u, how far its joints and elements settle under what they bear, and N, the
 * steps in which the first copy settled. Once a body has moved by SUSPECT u its springs would hold many times its
 * weight, so what moves then slips. What is held by friction slips for a while and is slower from look to look. What
 * is not held becomes faster: a body fails whose ways in GROWS looks in a row, N / 2 steps each, have not become
 * shorter, or that has gone FAR u. Motion comes from kinetic stops only: leaps carry what slips as far as they may.
 * What elements hold more and more goes on as well, though a bolt will stop it: it does not fail as long as the rise
 * of their force would bear what drives it after CAUGHT of its radius.
 *
 * A body that fails may meet something and rest: how far it goes until then hangs on what stands in its way, while
 * slip that springs ask for is a multiple of u. So a trial that rests after a body has gone SLIPS u is confirmed: made
 * again with joints STIFFER times as stiff. It holds when it rests there as well, and no body has gone GROWN times as
 * many u. A search confirms its last trial that rests, and others only where that one fails (safety/narrow.c).
 *
 * The verdict of a relaxation (cycle/failing.c) counts as well once the body has gone far. While joints settle and
 * blocks slip until they lock, all bodies go one way. Of a sliver that is soon a multiple of its size.
 *
 * Where contacts chatter, forces need thousands of steps to balance while nothing moves. So a trial also rests in which
 * no body has moved by STILL u in STILLS looks in a row. A body whose unbalanced force is e of its weight goes by
 * e / 2 (w t)^2 u in a time t, with its frequency w. Less than STILL u in a look means an e below RESTS.
 *
 * What fails and is smaller than least_volume is deleted in the copy, and the trial goes on with the rest.
 *
 * Limit: a body that is turned about its centre alone is not seen before it moves. */
#include "safety/trial.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/number.h"
#include "base/strength.h"
#include "cycle/cycle_data.h"
#include "cycle/element_forces.h"
#include "cycle/element_strength.h"
#include "cycle/failing.h"
#include "cycle/joint_law.h"
#include "cycle/meshes.h"
#include "cycle/rest.h"
#include "model/joints.h"
#include "model/options.h"
#include "model/rows.h"
#include "model/scope.h"
#include "zone/solids.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>
#include <talus/talus.h>
#include <talus/workers.h>

/* Tolerance: what strengths are divided by while joints settle: nothing that holds at all slips then. */
#define RAISED 0.05
/* Tolerance: local unbalanced force ratio that is rest. */
#define RESTS 1e-4
/* Tolerance: local unbalanced force ratio above which a model that moves is not at rest. */
#define MOVES 1e-2
/* Tolerance: way over u from which on a body is watched. */
#define SUSPECT 10.0
/* Tolerance: way over u, or if less over the radius of the largest body, from which on a relaxation's verdict counts.
 * In cut rock blocks have slipped by 15 u, a hundredth of their size, and stood still. */
#define CERTAIN 30.0
#define CERTAIN_SIZE 0.05
/* Tolerance: way over u from which on a body fails anyway. */
#define FAR 300.0
/* Tolerance: way over u beyond which joints slip, and what rests may have met something. */
#define SLIPS 1.0
/* Tolerance: stiffness of joints, over that before, by which slip that springs ask for is told from motion that
 * something ends. With it a body goes GROWN times as many u or more. STIFFEST is the largest one tried. */
#define STIFFER 10.0
#define GROWN 2.0
#define STIFFEST 1000.0
/* Tolerance: looks in a row in which a body that fails has not become slower. */
#define GROWS 4
/* Tolerance: way over the radius of a body within which elements that tighten are to stop it. */
#define CAUGHT 0.03
/* Tolerance: way between two looks over u below which nothing is told of a body. */
#define STANDS 0.02
/* Tolerance: likewise, below which a body stands still. A model in which all do, in STILLS looks in a row, rests. */
#define STILL 0.005
#define STILLS 4
/* Tolerance: least number of steps in which a model settles, for each block on end. Motion crosses a block in one. */
#define STEPS_A_BLOCK 16
/* Tolerance: speed over that of the fastest body that fails, and way likewise, from which on another goes with it. */
#define ALONG 0.3
/* Tolerance: sum of contact forces over the weight below which nothing bears a body. */
#define BARE 0.01

void tl_fall_free(tl_fall *fall)
{
    free(fall->ids);
    free(fall->small);
    *fall = (tl_fall){.ids = NULL};
}

static void hush(void *user, const char *text)
{
    (void)user, (void)text;
}

/* The error of a copy becomes that of the model. */
static tl_status told(const tl_trials *t, const tl_model *copy, tl_status status)
{
    return status == TL_OK ? TL_OK : tl_fail(&t->asked->error, status, "%s: %s", t->what, copy->error.text);
}

static tl_status copy_of(const tl_trials *t, tl_model *from, tl_model **copy)
{
    const tl_status status = tl_model_copy(from, NULL, NULL, copy);
    if (status == TL_OK)
        tl_model_log(*copy, hush, NULL);
    return from == t->asked ? status : told(t, from, status);
}

static tl_status weaken(const tl_trials *t, tl_model *copy, double factor)
{
    tl_status status = tl_joints_weaken(copy, t->asked, t->which, factor);
    if (status == TL_OK && t->options.solids)
        status = tl_solids_weaken(copy, t->asked, factor);
    if (status == TL_OK && t->options.elements)
        status = tl_elements_weaken(copy, t->asked, factor);
    if (status == TL_OK && t->stiffness > 1)
        status = tl_joints_stiffen(copy, t->stiffness);
    return told(t, copy, status);
}

/* ---------------------------------------------------------------- what is asked ---------- */

static tl_status check_number(const tl_trials *t, const char *name, double value, bool good, const char *allowed)
{
    char text[TL_NUMBER_TEXT];
    tl_number_text(value, text);
    return good ? TL_OK
                : tl_fail(&t->asked->error, TL_E_ARGUMENT, "%s: %s = %s must be %s", t->what, name, text, allowed);
}

static tl_status check_options(const tl_trials *t)
{
    const tl_safety *o = &t->options;
    char from[TL_NUMBER_TEXT], to[TL_NUMBER_TEXT];
    tl_number_text(o->from, from);
    tl_number_text(o->to, to);
    tl_status status = check_number(t, "from", o->from, o->from >= RAISED && isfinite(o->from), "at least 0.05");
    if (status == TL_OK)
        status = check_number(t, "to", o->to, isfinite(o->to), "a finite number");
    if (status == TL_OK && !(o->from < o->to))
        status = tl_fail(&t->asked->error, TL_E_ARGUMENT, "%s: from = %s must be below to = %s", t->what, from, to);
    if (status == TL_OK)
        status = check_number(t, "resolution", o->resolution, o->resolution >= 1e-4 && o->resolution <= 0.5,
                              "in [1e-4, 0.5]");
    if (status == TL_OK)
        status = check_number(t, "step", o->step, o->step >= 1e-3 && isfinite(o->step), "at least 0.001");
    if (status == TL_OK)
        status = check_number(t, "least_volume", o->least_volume, o->least_volume >= 0 && isfinite(o->least_volume),
                              "a finite number >= 0");
    if (status == TL_OK)
        status = check_number(t, "max_cycles", (double)o->max_cycles, o->max_cycles >= 1, "at least 1");
    if (status == TL_OK)
        status = check_number(t, "workers", (double)o->workers, o->workers >= 1 && o->workers <= TL_MOST_WORKERS,
                              "in [1, 256]");
    return status;
}

/* Marks the laws of one name. */
static tl_status mark_laws(tl_trials *t, const char *name)
{
    tl_model *m = t->asked;
    tl_tag tag;
    char error[TL_ERROR_TEXT];
    bool some = false;
    if (tl_joint_parse(m, name, &tag) != TL_OK) {
        tl_text_print(error, sizeof error, "%s", m->error.text);
        return tl_fail(&m->error, TL_E_ARGUMENT, "%s: joints: %s", t->what, error);
    }
    for (size_t i = 0; i < m->joint_law_count; i++)
        if (tl_tag_matches(tag, m->joint_laws[i].scope.tag)) {
            t->which[i] = 1;
            some = true;
        }
    return some ? TL_OK
                : tl_fail(&m->error, TL_E_ARGUMENT,
                          "%s: joint '%s' has no law of its own whose strengths could be divided; give it one", t->what,
                          name);
}

/* Names the laws that have no strengths, when none has. */
static tl_status say_unmarked(const tl_trials *t)
{
    tl_model *m = t->asked;
    char names[200] = "";
    size_t used = 0;
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const char *name = m->joint_laws[i].kind->name;
        if (t->which[i] && !strstr(names, name) && used + strlen(name) + 8 < sizeof names) {
            tl_text_print(names + used, sizeof names - used, "%s'%s'", used ? ", " : "", name);
            used = strlen(names);
        }
    }
    if (!used)
        return tl_fail(&m->error, TL_E_STATE, "%s: the model has no law whose strengths could be divided", t->what);
    return tl_fail(&m->error, TL_E_ARGUMENT,
                   "%s: no parameter of the laws %s is marked as a strength, so there is nothing to divide; a plugin "
                   "marks them with TL_PARAM_STRENGTH",
                   t->what, names);
}

static tl_status choose_laws(tl_trials *t)
{
    const tl_model *m = t->asked;
    const tl_safety *o = &t->options;
    tl_status status = TL_OK;
    bool some = false;
    t->which = calloc(m->joint_law_count + 1, 1);
    if (!t->which)
        return tl_fail_memory(&t->asked->error);
    if (o->joints)
        for (size_t k = 0; k < o->joint_count && status == TL_OK; k++)
            status = mark_laws(t, o->joints[k]);
    else
        memset(t->which, 1, m->joint_law_count);
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const bool has = tl_kind_has_strength(m->joint_laws[i].kind);
        some = some || (t->which[i] && has);
    }
    for (size_t k = 0; o->solids && m->zones && k < m->zones->solid_count; k++)
        some = some || tl_kind_has_strength(m->zones->solid[k].of.kind);
    some = some || (o->elements && tl_elements_have_strength(m));
    if (status == TL_OK && !some)
        return say_unmarked(t);
    for (size_t i = 0; i < m->joint_law_count; i++)
        t->which[i] = t->which[i] && tl_kind_has_strength(m->joint_laws[i].kind);
    return status;
}

/* Refuses what has no factor: nothing that is free, or something that is driven. */
static tl_status check_bodies(const tl_trials *t)
{
    const tl_model *m = t->asked;
    size_t free = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        free += tl_body_is_free(m, body);
        if (m->bodies.drive[body])
            return tl_fail(&t->asked->error, TL_E_STATE, "%s: block %u is driven: take the drive off first", t->what,
                           m->bodies.id[body]);
    }
    return free > 0 ? TL_OK : tl_fail(&t->asked->error, TL_E_STATE, "%s: nothing can move: no block is free", t->what);
}

static void no_job(void *user, uint64_t job, const void **data, size_t *size)
{
    (void)user, (void)job, (void)data, (void)size;
}

/* Refuses processes where there can be none, before any work is done. */
static tl_status check_processes(const tl_trials *t)
{
    tl_workers *workers = NULL;
    tl_error error;
    if (t->options.workers < 2)
        return TL_OK;
    tl_status status = tl_workers_start(1, no_job, NULL, &workers, &error);
    tl_workers_end(workers);
    return status == TL_OK ? TL_OK : tl_fail(&t->asked->error, status, "%s: %s", t->what, error.text);
}

/* Refuses a model that is under way: what would be asked is where it rests. `copy` is one of it. */
static tl_status check_rest(const tl_trials *t, tl_model *copy)
{
    const tl_bodies *b = &copy->bodies;
    uint32_t mover = TL_NO_ROW;
    for (uint32_t body = 0; body < b->table.rows && mover == TL_NO_ROW; body++)
        if (tl_body_is_free(copy, body) && (tl_v3_norm2(b->v[body]) > 0 || tl_v3_norm2(b->w[body]) > 0))
            mover = body;
    if (mover == TL_NO_ROW || (copy->cycle && copy->cycles > 0 && tl_at_rest(copy, TL_RATIO_LOCAL, MOVES)))
        return TL_OK;
    return tl_fail(&t->asked->error, TL_E_STATE,
                   "%s: the model moves (block %u at %.3g m/s): bring it to rest first, %s", t->what, b->id[mover],
                   tl_v3_norm(b->v[mover]), tl_words(t->asked, "with model:relax{}", "with tl_model_relax()"));
}

/* ---------------------------------------------------------------- made ahead ------------- */

tl_trial_ahead *tl_trials_made(const tl_trials *t, double factor)
{
    for (size_t i = 0; i < t->ahead_count; i++)
        if (t->ahead[i].trial.factor == factor)
            return &t->ahead[i];
    return NULL;
}

/* Hands over a trial that was made ahead; false: there is none. */
static bool take_made(tl_trials *t, double factor, tl_safety_trial *trial, tl_fall *fall)
{
    tl_trial_ahead *made = tl_trials_made(t, factor);
    if (!made)
        return false;
    *trial = made->trial;
    *fall = made->fall;
    *made = t->ahead[--t->ahead_count];
    t->cycles += trial->cycles;
    return true;
}

/* Forgets trials that were made ahead: those to come begin with another copy. */
static void forget_made(tl_trials *t)
{
    for (size_t i = 0; i < t->ahead_count; i++)
        tl_fall_free(&t->ahead[i].fall);
    t->ahead_count = 0;
}

/* ---------------------------------------------------------------- a trial ---------------- */

/* A body from look to look. */
typedef struct look {
    tl_id body;
    tl_vec3 start, last; /* displacements */
    tl_quat turned;      /* when it began */
    double way;          /* between the last two looks, m */
    double corner;       /* how far its corners had gone by rotation at the last look, m */
    int32_t grows;       /* looks in a row in which it did not become slower */
    tl_vec3 pulled;      /* force of elements at the last look, N */
    tl_vec3 from;        /* displacement when elements tightened last, or at the start */
} look;

typedef struct watch {
    const tl_trials *t;
    look *look;       /* [bodies] */
    tl_vec3 *pull;    /* [bodies], force of elements now, N */
    int64_t looked;   /* cycle of the last look */
    int32_t still;    /* looks in a row in which all bodies stood still */
    bool rigid_trial; /* of a trial, not of a first copy, and only joints give */
    bool fails;
    tl_id verdict; /* the body of which a relaxation says that it fails, or TL_NO_ID */
    bool strained; /* ... for it is strained on and on */
    const char *why;
} watch;

static tl_status on_step(void *user, tl_model *copy)
{
    const watch *w = user;
    (void)copy;
    return tl_model_interrupted(w->t->asked) ? TL_E_CANCELLED : TL_OK;
}

static bool is_far(const watch *w, const tl_model *copy, uint32_t body)
{
    const tl_vec3 gone = tl_v3_sub(copy->bodies.pose[body].u, w->look[body].from);
    return tl_v3_norm(gone) > FAR * w->t->settles;
}

/* Whether elements stop a body that has gone by u since the last look: the work of what drives it on, over the rise of
 * their force, is short. */
static bool is_caught(const watch *w, const tl_model *copy, uint32_t body, tl_vec3 u)
{
    const tl_vec3 rise = tl_v3_sub(w->pull[body], w->look[body].pulled);
    const double way2 = tl_v3_norm2(u), tightens = -tl_v3_dot(rise, u);
    if (!(way2 > 0 && tightens > 0))
        return false;
    const double driven = tl_v3_dot(copy->bodies.force[body], u);
    return driven * sqrt(way2) <= tightens * CAUGHT * copy->bodies.radius[body];
}

/* How far the corners of a body have gone by rotation, m. */
static double turned_of(const tl_model *m, const look *l, uint32_t body)
{
    const tl_quat by = tl_q_mul(m->bodies.q[body], tl_q_conj(l->turned));
    return 2 * m->bodies.radius[body] * sqrt(by.x * by.x + by.y * by.y + by.z * by.z);
}

/* Whether all bodies have stood still in so many looks. */
static bool stands_still(const watch *w)
{
    return w->rigid_trial && w->still >= STILLS;
}

/* Looks at all bodies; true when some one fails, or all stand still. */
static bool looks(void *user, tl_model *copy)
{
    watch *w = user;
    const double settles = w->t->settles;
    bool still = true;
    w->looked = copy->cycles;
    tl_elements_pull(copy, w->pull);
    for (uint32_t body = 0; body < copy->bodies.table.rows; body++) {
        look *l = &w->look[body];
        const tl_vec3 u = copy->bodies.pose[body].u;
        const double way = tl_v3_norm(tl_v3_sub(u, l->last)), far = tl_v3_norm(tl_v3_sub(u, l->start));
        if (!tl_body_is_free(copy, body))
            continue;
        const bool grows = far > SUSPECT * settles && way >= l->way && way > STANDS * settles;
        const bool caught = is_caught(w, copy, body, tl_v3_sub(u, l->last));
        l->grows = grows && !caught ? l->grows + 1 : 0;
        l->last = u;
        l->way = way;
        const double corner = turned_of(copy, l, body);
        still = still && way + fabs(corner - l->corner) <= STILL * settles;
        l->corner = corner;
        l->pulled = w->pull[body];
        if (caught)
            l->from = u;
        if (l->grows < GROWS && !is_far(w, copy, body))
            continue;
        if (!w->fails)
            w->why = l->grows >= GROWS ? "goes on" : "far";
        w->fails = true;
    }
    w->still = still ? w->still + 1 : 0;
    return w->fails || stands_still(w);
}

static void watch_end(watch *w)
{
    free(w->look);
    free(w->pull);
    w->look = NULL;
    w->pull = NULL;
}

static bool watch_begin(watch *w, const tl_trials *t, const tl_model *copy)
{
    *w = (watch){.t = t,
                 .looked = copy->cycles,
                 .verdict = TL_NO_ID,
                 .look = calloc(copy->bodies.table.rows + 1, sizeof *w->look),
                 .pull = calloc(copy->bodies.table.rows + 1, sizeof *w->pull)};
    if (!w->look || !w->pull) {
        watch_end(w);
        return false;
    }
    tl_elements_pull(copy, w->pull);
    for (uint32_t body = 0; body < copy->bodies.table.rows; body++)
        w->look[body] = (look){.body = copy->bodies.id[body],
                               .start = copy->bodies.pose[body].u,
                               .from = copy->bodies.pose[body].u,
                               .last = copy->bodies.pose[body].u,
                               .turned = copy->bodies.q[body],
                               .pulled = w->pull[body]};
    return true;
}

static double gone_of(const watch *w, const tl_model *m, uint32_t body)
{
    return tl_v3_norm(tl_v3_sub(m->bodies.pose[body].u, w->look[body].start));
}

static bool body_fails(const watch *w, const tl_model *m, uint32_t body)
{
    const look *l = &w->look[body];
    return l->body == w->verdict || l->grows >= GROWS || is_far(w, m, body);
}

/* The fastest of the bodies that fail; where none does, of all. */
static uint32_t fastest_of(const watch *w, const tl_model *m)
{
    uint32_t fastest = TL_NO_ROW;
    bool fails = false;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        if (!tl_body_is_free(m, body))
            continue;
        const bool here = body_fails(w, m, body);
        if (fastest == TL_NO_ROW || here > fails || (here == fails && w->look[body].way > w->look[fastest].way)) {
            fastest = body;
            fails = here;
        }
    }
    return fastest;
}

/* Sum of the sizes of forces that bear a body, N: of contacts and, of a deformable one, of what holds its points. */
static double borne_by(const tl_model *m, uint32_t body)
{
    const tl_body_mesh *mesh = tl_mesh_of_body(m, body);
    return mesh ? tl_mesh_whole_of(m, mesh).borne : m->cycle->contact_force[body];
}

/* Lists what goes together, with its volume, direction and mode: bodies about as fast as the fastest, and about as far.
 * While what is small falls, the rest may settle as fast, but not as far. */
static tl_status list_fall(const watch *w, tl_model *m, tl_fall *fall)
{
    const uint32_t fastest = fastest_of(w, m);
    if (fastest == TL_NO_ROW)
        return TL_OK;
    const double fast = w->look[fastest].way, far = gone_of(w, m, fastest);
    tl_addends volume = {.count = 0}, sum[3] = {{.count = 0}, {.count = 0}, {.count = 0}};
    tl_addends ways = {.count = 0}, turns = {.count = 0}, bears = {.count = 0}, weighs = {.count = 0};
    fall->ids = malloc((m->blocks.table.rows + 1) * sizeof *fall->ids);
    if (!fall->ids)
        return tl_fail_memory(&w->t->asked->error);
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        const uint32_t body = m->blocks.body[row];
        const look *l = &w->look[body];
        if (!tl_body_is_free(m, body) || !(l->way >= ALONG * fast && gone_of(w, m, body) >= ALONG * far))
            continue;
        const tl_vec3 gone = tl_v3_sub(m->bodies.pose[body].u, l->start);
        const double own = m->blocks.volume[row], share = own / m->bodies.mass[body];
        fall->ids[fall->count++] = m->blocks.id[row];
        tl_addends_put(&volume, own);
        tl_addends_put(&sum[0], own * gone.x);
        tl_addends_put(&sum[1], own * gone.y);
        tl_addends_put(&sum[2], own * gone.z);
        tl_addends_put(&ways, own * tl_v3_norm(gone));
        tl_addends_put(&turns, own * turned_of(m, l, body));
        tl_addends_put(&bears, share * borne_by(m, body));
        tl_addends_put(&weighs, own * tl_v3_norm(m->config.gravity));
    }
    fall->volume = tl_addends_sum(&volume);
    fall->way = tl_v3_unit(tl_v3(tl_addends_sum(&sum[0]), tl_addends_sum(&sum[1]), tl_addends_sum(&sum[2])));
    fall->mode = w->strained                                               ? TL_SAFETY_YIELDS
                 : tl_addends_sum(&bears) < BARE * tl_addends_sum(&weighs) ? TL_SAFETY_FALLS
                 : tl_addends_sum(&turns) > tl_addends_sum(&ways)          ? TL_SAFETY_TURNS
                                                                           : TL_SAFETY_SLIDES;
    return TL_OK;
}

/* How far the joints of a copy settle, m, by what they bear now. */
static double settles_now(const tl_model *copy)
{
    tl_watch *w = tl_watch_begin(copy);
    double elements;
    const double settles = w && tl_elements_settlement(copy, &elements) ? tl_watch_settlement(w, copy) + elements : 0;
    if (w)
        tl_watch_end(w);
    return settles;
}

static double largest_radius(const tl_model *m)
{
    double largest = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        largest = fmax(largest, tl_body_is_free(m, body) ? m->bodies.radius[body] : 0);
    return largest;
}

/* Whether the verdict of a relaxation is more than the settling of its joints. */
static bool confirmed(const watch *w, const tl_model *copy, tl_id failing)
{
    const double settles = w->t->measured ? w->t->settles : settles_now(copy);
    const double least = fmax(SUSPECT * settles, fmin(CERTAIN * settles, CERTAIN_SIZE * largest_radius(copy)));
    bool far = copy->cycle->fails_strained;
    for (uint32_t body = 0; body < copy->bodies.table.rows; body++)
        if (copy->bodies.id[body] == failing)
            far = far || gone_of(w, copy, body) > least;
    return far;
}

/* Deletes what is small and has failed, and goes on with the watch of all others. */
static tl_status take_out(watch *w, tl_model *copy, tl_fall *fall)
{
    const size_t before = copy->bodies.table.rows, all = fall->small_count + fall->count;
    if (!tl_grow(&fall->small, &fall->small_capacity, all, sizeof *fall->small))
        return tl_fail_memory(&w->t->asked->error);
    memcpy(fall->small + fall->small_count, fall->ids, fall->count * sizeof *fall->ids);
    fall->small_count = all;
    const tl_status status = told(w->t, copy, tl_blocks_delete(copy, fall->ids, fall->count));
    free(fall->ids);
    fall->ids = NULL;
    fall->count = 0;
    const look *old = w->look;
    watch next;
    if (status != TL_OK)
        return status;
    if (!watch_begin(&next, w->t, copy))
        return tl_fail_memory(&w->t->asked->error);
    next.rigid_trial = w->rigid_trial;
    for (uint32_t body = 0; body < copy->bodies.table.rows; body++)
        for (size_t row = 0; row < before; row++)
            if (old[row].body == next.look[body].body)
                next.look[body] = old[row];
    watch_end(w);
    *w = next;
    return TL_OK;
}

/* What a relaxation of a copy has ended with. *over: nothing is to be done any more. */
static tl_status judge(watch *w, tl_model *copy, const tl_relax_result *r, tl_safety_trial *trial, tl_fall *fall,
                       bool *over)
{
    const tl_trials *t = w->t;
    const tl_solve_reason reason = r->run.reason;
    const bool left = trial->cycles < t->options.max_cycles;
    trial->holds = reason == TL_SOLVE_REST || (!w->fails && stands_still(w));
    if (reason == TL_SOLVE_OVERLAP)
        return tl_fail(&t->asked->error, TL_E_STATE, "%s: %s; let %s take them as fitting first", t->what, r->message,
                       tl_words(t->asked, "model:seat{}", "tl_model_seat()"));
    const bool fails = reason == TL_SOLVE_FAILURE && confirmed(w, copy, r->run.failing);
    *over = trial->holds || w->fails || fails || !left;
    trial->why = trial->holds ? "at rest" : w->fails ? w->why : fails ? "fails" : "undecided";
    trial->undecided = *over && !trial->holds && !w->fails && !fails;
    if (trial->holds || !*over)
        return TL_OK;
    if (fails)
        w->verdict = r->run.failing;
    w->strained = fails && copy->cycle->fails_strained;
    if (copy->cycles > w->looked)
        looks(w, copy); /* the ways since the last look */
    tl_status status = list_fall(w, copy, fall);
    if (status != TL_OK || trial->undecided || !left || !(fall->volume < t->options.least_volume))
        return status;
    *over = false;
    return take_out(w, copy, fall);
}

/* Brings a copy to rest, or finds what fails. */
static tl_status settle(tl_trials *t, tl_model *copy, bool leaps, tl_safety_trial *trial, tl_fall *fall)
{
    watch w;
    tl_status status = TL_OK;
    *trial = (tl_safety_trial){.why = "undecided"};
    if (!watch_begin(&w, t, copy))
        return tl_fail_memory(&t->asked->error);
    w.rigid_trial = !leaps && !tl_model_deforms(copy) && !copy->elements;
    for (bool over = false; status == TL_OK && !over;) {
        tl_relax relax = tl_relax_default();
        tl_relax_result r;
        relax.ratio = RESTS;
        relax.max_cycles = t->options.max_cycles - trial->cycles;
        relax.every = t->window;
        relax.each = on_step;
        relax.stop = looks;
        relax.user = &w;
        if (copy->cycle)
            copy->cycle->only_stops = !leaps;
        status = tl_model_relax(copy, &relax, &r);
        t->cycles += r.run.cycles;
        trial->cycles += r.run.cycles;
        if (r.run.reason == TL_SOLVE_INTERRUPT || tl_model_interrupted(t->asked))
            status = tl_fail(&t->asked->error, TL_E_CANCELLED, "%s: stopped; the model is as it was", t->what);
        else
            status = told(t, copy, status);
        if (status == TL_OK)
            status = judge(&w, copy, &r, trial, fall, &over);
    }
    t->moved = 0;
    for (uint32_t body = 0; status == TL_OK && body < copy->bodies.table.rows; body++)
        if (tl_body_is_free(copy, body))
            t->moved = fmax(t->moved, gone_of(&w, copy, body) / t->settles);
    watch_end(&w);
    return status;
}

/* How far joints settle, and the steps that this takes. */
static tl_status measure(tl_trials *t, int64_t settled)
{
    double elements;
    tl_watch *w = tl_elements_settlement(t->base, &elements) ? tl_watch_begin(t->base) : NULL;
    if (!w)
        return tl_fail_memory(&t->asked->error);
    const double on_end = tl_watch_on_end(w);
    const double steps = fmax((double)settled, STEPS_A_BLOCK * on_end);
    t->settles = tl_watch_settlement(w, t->base) + elements;
    t->measured = true;
    t->window = 1 + (int64_t)(0.5 * steps);
    tl_watch_end(w);
    return TL_OK;
}

static void end_stiffer(tl_trials *t)
{
    if (!t->stiffer)
        return;
    end_stiffer(t->stiffer);
    if (t->stiffer->base)
        tl_model_destroy(t->stiffer->base);
    free(t->stiffer);
    t->stiffer = NULL;
}

tl_status tl_trials_rest(tl_trials *t, tl_fall *fall)
{
    tl_safety_trial trial;
    forget_made(t);
    end_stiffer(t);
    tl_status status = settle(t, t->base, true, &trial, fall);
    if (status == TL_OK && trial.holds)
        status = measure(t, trial.cycles > 2 * t->window ? trial.cycles : 2 * t->window);
    return status;
}

tl_status tl_trials_begin(tl_trials *t, const char *what, tl_model *m, const tl_safety *given, tl_fall *fall)
{
    *t = (tl_trials){.what = what, .asked = m, .stiffness = 1, .began = tl_clock()};
    *fall = (tl_fall){.ids = NULL};
    tl_status status = TL_OPTIONS_READ(tl_safety, given, &t->options, &m->error);
    if (status == TL_OK)
        status = tl_model_may_set(m, "find a factor of safety");
    if (status == TL_OK)
        status = check_options(t);
    if (status == TL_OK)
        status = choose_laws(t);
    if (status == TL_OK)
        status = check_bodies(t);
    if (status == TL_OK)
        status = check_processes(t);
    atomic_store(&m->interrupted, false);
    if (status == TL_OK)
        status = copy_of(t, m, &t->base);
    if (status == TL_OK)
        status = check_rest(t, t->base);
    if (status == TL_OK)
        status = weaken(t, t->base, RAISED);
    if (status != TL_OK)
        return status;
    tl_safety_trial trial;
    t->window = 100;
    t->settles = largest_radius(t->base) / SUSPECT; /* before the first rest only the size of bodies says what is far */
    status = settle(t, t->base, true, &trial, fall);
    return status == TL_OK && trial.holds ? measure(t, trial.cycles) : status;
}

/* Makes a trial on a copy. */
static tl_status make_one(tl_trials *t, double factor, tl_safety_trial *trial, tl_fall *fall)
{
    tl_model *copy = NULL;
    tl_status status = copy_of(t, t->base, &copy);
    if (status == TL_OK)
        status = weaken(t, copy, factor);
    if (status == TL_OK)
        status = settle(t, copy, false, trial, fall);
    if (copy)
        tl_model_destroy(copy);
    return status;
}

/* Trials with stiffer joints, which have come to rest as the first copy has; *usable: they did. */
static tl_status make_stiffer(tl_trials *t, bool *usable)
{
    *usable = t->stiffer && t->stiffer->measured;
    if (t->stiffer || t->stiffness * STIFFER > STIFFEST)
        return TL_OK;
    tl_trials *s = t->stiffer = malloc(sizeof *s);
    if (!s)
        return tl_fail_memory(&t->asked->error);
    *s = (tl_trials){.what = t->what,
                     .asked = t->asked,
                     .options = t->options,
                     .which = t->which,
                     .stiffness = STIFFER * t->stiffness,
                     .settles = t->settles,
                     .window = t->window};
    tl_safety_trial trial;
    tl_fall fall = {.ids = NULL};
    tl_status status = copy_of(s, t->base, &s->base);
    if (status == TL_OK)
        status = weaken(s, s->base, RAISED);
    if (status == TL_OK)
        status = settle(s, s->base, true, &trial, &fall);
    if (status == TL_OK && trial.holds)
        status = measure(s, trial.cycles);
    *usable = s->measured;
    tl_fall_free(&fall);
    return status;
}

/* Makes a trial that has come to rest again, with stiffer and stiffer joints while it rests, and may rest only because
 * they are soft. */
static tl_status confirm(tl_trials *t, tl_safety_trial *trial, tl_fall *fall)
{
    const double factor = trial->factor;
    int64_t cycles = trial->cycles;
    double moved = fall->moved, before = 0;
    tl_status status = TL_OK;
    for (tl_trials *at = t; trial->holds && moved > fmax(SLIPS, GROWN * before);) {
        bool usable;
        before = moved;
        status = make_stiffer(at, &usable);
        at = at->stiffer;
        if (status != TL_OK || !usable)
            break;
        tl_fall_free(fall);
        status = make_one(at, factor, trial, fall);
        if (status != TL_OK)
            break;
        moved = at->moved;
        cycles += trial->cycles;
        t->cycles += trial->cycles;
    }
    trial->cycles = cycles;
    trial->factor = factor;
    return status;
}

static tl_status make(tl_trials *t, double factor, tl_safety_trial *trial, tl_fall *fall)
{
    tl_status status = make_one(t, factor, trial, fall);
    trial->factor = factor;
    fall->moved = t->moved;
    if (status == TL_OK && t->confirms)
        status = confirm(t, trial, fall);
    return status;
}

/* Counts a trial, and tells of it. */
static tl_status finish(tl_trials *t, tl_status status, const tl_safety_trial *trial, tl_fall *fall)
{
    t->undecided += status == TL_OK && trial->undecided ? 1 : 0;
    if (status == TL_OK && t->options.on_trial) {
        tl_model_only_read(t->asked, true);
        status = t->options.on_trial(t->options.user, trial);
        tl_model_only_read(t->asked, false);
    }
    if (status != TL_OK)
        tl_fall_free(fall);
    return status;
}

tl_status tl_trials_try(tl_trials *t, double factor, tl_safety_trial *trial, tl_fall *fall)
{
    *fall = (tl_fall){.ids = NULL};
    tl_status status = TL_OK;
    if (!take_made(t, factor, trial, fall))
        status = make(t, factor, trial, fall);
    return finish(t, status, trial, fall);
}

tl_status tl_trials_confirm(tl_trials *t, double factor, double moved, tl_safety_trial *trial, tl_fall *fall)
{
    *fall = (tl_fall){.moved = moved};
    *trial = (tl_safety_trial){.factor = factor, .holds = 1, .why = "at rest"};
    const tl_status status = confirm(t, trial, fall);
    return status == TL_OK && trial->cycles == 0 ? status : finish(t, status, trial, fall);
}

void tl_trials_confirm_all(tl_trials *t, bool all)
{
    if (t->confirms != all)
        forget_made(t);
    t->confirms = all;
}

void tl_trials_end(tl_trials *t)
{
    if (t->base)
        tl_model_destroy(t->base);
    forget_made(t);
    end_stiffer(t);
    free(t->ahead);
    free(t->which);
    t->ahead = NULL;
    t->base = NULL;
    t->which = NULL;
}
