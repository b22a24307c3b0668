/* trial.c - whether a model comes to rest with its strengths divided by a factor.
 *
 * A copy of the model comes to rest with its strengths raised by 1 / TL_LEAST_FACTOR. Elastic joints settle then, and
 * nothing slips. This copy is the base. A trial has the strengths of the model divided by its factor. It begins with a
 * copy of the base, and comes to rest (cycle/relax.c), or something moves on. From then on a copy that rests is the
 * base.
 *
 * Friction bears the same weight by many sets of forces. Which of them blocks slip into hangs on the way there, and
 * where strengths are lowered at once by much, on rounding as well. A trial that rests has found one that bears. One
 * that fails has not, for it may have swung past them. So what fails counts once strengths were lowered step by step,
 * and by no more than STEP at the last. Zones yield by one way only, and each trial would strain them further: where
 * blocks deform, each begins with the first base.
 *
 * Two scales come from the model itself: u, how far its joints and elements settle under what they bear, and N, the
 * steps in which the first copy settled. Once a body has moved by SUSPECT u its springs would hold many times its
 * weight, so what moves then slips. What is held by friction slips for a while and is slower from look to look. What
 * is not held becomes faster: a body fails whose ways in GROWS looks in a row, N / 2 steps each, have not become
 * shorter, or that has gone FAR u. What slides on goes on where all others are stopped (cycle/settle.c). What elements
 * hold more and more goes on as well, though a bolt will stop it: it does not fail as long as the rise of their force
 * would bear what drives it after CAUGHT of its radius.
 *
 * Soft joints turn what lies on them as they settle, and what fails may meet something before it has gone many u. So
 * joints with which u is more than SOFT of a block are made stiffer in all copies: with the same forces, all ways
 * become shorter by as much. These copies begin as the model was cut (cycle/put_back.c), where that may be.
 *
 * The verdict of a relaxation (cycle/failing.c) counts as well once the body has gone SUSPECT u. While joints settle
 * and blocks slip until they lock, all bodies go one way. Of a sliver that is soon a multiple of its size.
 *
 * What fails is often a few bodies beside many that stand. So once a body has gone SUSPECT u, and most bodies have not
 * moved since the last look, these are held while it goes on: their contacts then cost nothing. What fails beside held
 * neighbours fails beside free ones, which bear no more. What comes to rest beside them counts only once it also does
 * with all of them let go.
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
#include "cycle/cycle_data.h"
#include "cycle/element_forces.h"
#include "cycle/element_strength.h"
#include "cycle/failing.h"
#include "cycle/joint_law.h"
#include "cycle/meshes.h"
#include "cycle/put_back.h"
#include "cycle/rest.h"
#include "model/options.h"
#include "model/rows.h"
#include "safety/asked.h"
#include "state/restore.h"
#include "zone/solids.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/talus.h>

/* Tolerance: local unbalanced force ratio that is rest. */
#define RESTS 1e-4
/* Tolerance: local unbalanced force ratio above which a model that moves is not at rest. */
#define MOVES 1e-2
/* Tolerance: way over u from which on a body is watched, and a relaxation's verdict counts. */
#define SUSPECT 10.0
/* Tolerance: way over u from which on a body fails anyway. */
#define FAR 300.0
/* Tolerance: u over the radius of the largest body above which joints are made stiffer. Test: lua/test_safety_rock. */
#define SOFT 1e-5
/* Cost only: by what joints are made stiffer until they are not soft. */
#define STIFFER 10.0
/* Limit: of stiffness of joints over that of the model. */
#define STIFFEST 1e7
/* Tolerance: way over the radius of the largest body up to which blocks have only settled, and may go back to where
 * they were cut. Test: lua/test_safety_rock. */
#define SETTLED 0.05
/* Tolerance: looks in a row in which a body that fails has not become slower. */
#define GROWS 4
/* Tolerance: way over the radius of a body within which elements that tighten are to stop it. */
#define CAUGHT 0.03
/* Tolerance: way between two looks over u below which nothing is told of a body. */
#define STANDS 0.02
/* Tolerance: likewise, below which a body stands still. A model in which all do, in STILLS looks in a row, rests.
 * Test: lua/test_safety_rock. */
#define STILL 0.005
#define STILLS 4
/* Limit: looks after which bodies that are held for others are let go: they may help what chatters to rest. */
#define HELD_LOOKS 64
/* Tolerance: least number of steps in which a model settles, for each block on end. Motion crosses a block in one. */
#define STEPS_A_BLOCK 16
/* Tolerance: speed over that of the fastest body that fails, and way likewise, from which on another goes with it. */
#define ALONG 0.3
/* Tolerance: sum of contact forces over the weight below which nothing bears a body. */
#define BARE 0.01
/* Tolerance: the factor of a trial that fails over that of the one before it, at most.
 * Test: lua/test_safety_random. */
#define STEP 1.02

void tl_fall_free(tl_fall *fall)
{
    free(fall->ids);
    free(fall->small);
    *fall = (tl_fall){.ids = NULL};
}

void tl_trial_ahead_free(tl_trial_ahead *made)
{
    tl_fall_free(&made->fall);
    free(made->state);
    made->state = NULL;
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

/* ---------------------------------------------------------------- a trial ---------------- */

/* A body from look to look. */
typedef struct look {
    tl_id body;
    tl_vec3 start, last; /* displacements */
    tl_quat turned;      /* when it began */
    double way;          /* between the last two looks, m */
    double corner;       /* how far its corners had gone by rotation at the last look, m */
    double moves;        /* way of the body and its corners between these, m */
    bool stands;         /* it has not moved since the look before, and nothing holds it */
    int32_t grows;       /* looks in a row in which it did not become slower */
    tl_vec3 pulled;      /* force of elements at the last look, N */
    tl_vec3 from;        /* displacement when elements tightened last, or at the start */
} look;

typedef struct watch {
    const tl_trials *t;
    look *look;       /* [bodies] */
    tl_vec3 *pull;    /* [bodies], force of elements now, N */
    int32_t still;    /* looks in a row in which all bodies stood still */
    bool weakened;    /* of a trial, not of a first copy */
    bool rigid_trial; /* ... in which only joints give */
    int64_t looked;   /* cycle of the last look */
    bool fails;
    tl_id *held; /* a block of each body that is held while others go on */
    size_t held_count;
    int32_t held_looks; /* since then */
    bool few;           /* few bodies have moved since the last look, and one of them may fail */
    tl_id verdict;      /* the body of which a relaxation says that it fails, or TL_NO_ID */
    bool strained;      /* ... for it is strained on and on */
    const char *why;
} watch;

static tl_status on_step(void *user, tl_model *copy)
{
    const watch *w = user;
    (void)copy;
    return tl_model_interrupted(w->t->asked) ? TL_E_CANCELLED : TL_OK;
}

static double gone_of(const watch *w, const tl_model *m, uint32_t body)
{
    return tl_v3_norm(tl_v3_sub(m->bodies.pose[body].u, w->look[body].start));
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

/* Whether what is held is to be let go before what moves has failed or come to rest. */
static bool lets_go(const watch *w)
{
    return w->held_count > 0 && w->held_looks >= HELD_LOOKS;
}

/* Whether, since the last look, most bodies have not moved beside one that may fail: notes which. */
static bool few_move(watch *w, const tl_model *copy)
{
    const tl_bodies *b = &copy->bodies;
    const double settles = w->t->settles;
    size_t stand = 0, move = 0;
    bool suspect = false;
    for (uint32_t body = 0; body < b->table.rows; body++) {
        look *l = &w->look[body];
        const bool moves = tl_body_is_free(copy, body) && l->moves > STANDS * settles;
        l->stands = !b->fixed[body] && !moves;
        stand += l->stands;
        move += moves;
        suspect = suspect || (moves && gone_of(w, copy, body) > SUSPECT * settles);
    }
    return suspect && stand > move;
}

/* Looks at all bodies; true when some one fails, all stand still, or others are to be held. */
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
        l->moves = way + fabs(corner - l->corner);
        still = still && l->moves <= STILL * settles;
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
    w->held_looks++;
    w->few = w->weakened && !tl_model_deforms(copy) && few_move(w, copy);
    return w->fails || stands_still(w) || w->few || lets_go(w);
}

/* Holds the bodies that stand. */
static tl_status hold_others(watch *w, tl_model *copy)
{
    const size_t before = w->held_count;
    for (uint32_t body = 0; body < copy->bodies.table.rows; body++)
        if (w->look[body].stands) {
            w->held[w->held_count++] = copy->blocks.id[tl_body_blocks(copy, body)[0]];
            w->look[body].stands = false;
        }
    w->held_looks = 0;
    w->few = false;
    return told(w->t, copy, tl_blocks_fix(copy, w->held + before, w->held_count - before, TL_FIX_ALL));
}

/* Lets go what is held. */
static tl_status release(watch *w, tl_model *copy)
{
    const size_t count = w->held_count;
    w->held_count = 0;
    w->still = 0;
    return told(w->t, copy, tl_blocks_free(copy, w->held, count));
}

static void watch_end(watch *w)
{
    free(w->look);
    free(w->pull);
    free(w->held);
    w->look = NULL;
    w->pull = NULL;
    w->held = NULL;
}

static bool watch_begin(watch *w, const tl_trials *t, const tl_model *copy)
{
    *w = (watch){.t = t,
                 .looked = copy->cycles,
                 .verdict = TL_NO_ID,
                 .look = calloc(copy->bodies.table.rows + 1, sizeof *w->look),
                 .pull = calloc(copy->bodies.table.rows + 1, sizeof *w->pull),
                 .held = calloc(copy->bodies.table.rows + 1, sizeof *w->held)};
    if (!w->look || !w->pull || !w->held) {
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
    bool far = copy->cycle->fails_strained;
    for (uint32_t body = 0; body < copy->bodies.table.rows; body++)
        if (copy->bodies.id[body] == failing)
            far = far || gone_of(w, copy, body) > SUSPECT * settles;
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
    tl_status status = told(w->t, copy, tl_blocks_delete(copy, fall->ids, fall->count));
    free(fall->ids);
    fall->ids = NULL;
    fall->count = 0;
    const look *old = w->look;
    watch next;
    if (status == TL_OK)
        status = release(w, copy);
    if (status != TL_OK)
        return status;
    if (!watch_begin(&next, w->t, copy))
        return tl_fail_memory(&w->t->asked->error);
    next.weakened = w->weakened;
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
    const bool rests = reason == TL_SOLVE_REST || (!w->fails && stands_still(w));
    if (left && !w->fails && w->few)
        return hold_others(w, copy);
    if (left && !w->fails && ((rests && w->held_count > 0) || lets_go(w)))
        return release(w, copy);
    trial->holds = rests && w->held_count == 0;
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

/* Brings a copy to rest, with high strengths or `weakened`, or finds what fails. */
static tl_status settle(tl_trials *t, tl_model *copy, bool weakened, tl_safety_trial *trial, tl_fall *fall)
{
    watch w;
    tl_status status = TL_OK;
    *trial = (tl_safety_trial){.why = "undecided"};
    if (!watch_begin(&w, t, copy))
        return tl_fail_memory(&t->asked->error);
    w.weakened = weakened;
    w.rigid_trial = weakened && !tl_model_deforms(copy) && !copy->elements;
    for (bool over = false; status == TL_OK && !over;) {
        tl_relax relax = tl_relax_default();
        tl_relax_result r;
        relax.ratio = RESTS;
        if (copy->cycle)
            copy->cycle->slides_on = weakened;
        relax.max_cycles = t->options.max_cycles - trial->cycles;
        relax.every = t->window;
        relax.each = on_step;
        relax.stop = looks;
        relax.user = &w;
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

/* Forgets trials that were made ahead: those to come begin with another copy. */
static void forget_made(tl_trials *t)
{
    for (size_t i = 0; i < t->ahead_count; i++)
        tl_trial_ahead_free(&t->ahead[i]);
    t->ahead_count = 0;
}

tl_model *tl_trials_go_on(tl_trials *t)
{
    forget_made(t);
    t->small_count = 0;
    return t->base;
}

tl_status tl_trials_rest(tl_trials *t, tl_fall *fall)
{
    tl_safety_trial trial;
    tl_status status = weaken(t, t->base, TL_LEAST_FACTOR);
    if (status == TL_OK)
        status = settle(t, t->base, false, &trial, fall);
    if (status == TL_OK && trial.holds)
        status = measure(t, 2 * t->window);
    return status;
}

/* Makes the copy of which trials are copies. *rests: it has come to rest with high strengths; else `fall` has what does
 * not. */
static tl_status make_base(tl_trials *t, tl_fall *fall, bool *rests)
{
    tl_safety_trial trial;
    t->base = NULL;
    t->reached = TL_LEAST_FACTOR;
    t->measured = false;
    t->window = 100;
    tl_status status = copy_of(t, t->asked, &t->base);
    if (status == TL_OK)
        status = check_rest(t, t->base);
    if (status == TL_OK && t->stiffness > 1)
        tl_put_back(t->base);
    if (status == TL_OK)
        status = weaken(t, t->base, TL_LEAST_FACTOR);
    if (status != TL_OK)
        return status;
    t->settles = largest_radius(t->base) / SUSPECT; /* before the first rest only the size of bodies says what is far */
    status = settle(t, t->base, false, &trial, fall);
    *rests = status == TL_OK && trial.holds;
    if (*rests)
        t->may_put_back = tl_may_put_back(t->asked, SETTLED * largest_radius(t->base));
    return *rests ? measure(t, trial.cycles) : status;
}

/* Whether joints are to be stiffer. Beside zones and elements they stay as they are: what each of them bears hangs on
 * all their stiffnesses. */
static bool is_soft(const tl_trials *t)
{
    return !tl_model_deforms(t->base) && !t->base->elements && t->settles > SOFT * largest_radius(t->base) &&
           t->may_put_back;
}

/* Makes the copy anew, with joints so stiff that it is not soft. Where that cannot be, or does not rest, the first one
 * stays. */
static tl_status stiffen(tl_trials *t, tl_fall *fall)
{
    tl_trials stiff = *t;
    tl_fall loose = {.ids = NULL};
    bool rests = false;
    for (double of = t->settles; of > SOFT * largest_radius(t->base) && stiff.stiffness < STIFFEST; of /= STIFFER)
        stiff.stiffness *= STIFFER;
    tl_status status = make_base(&stiff, &loose, &rests);
    if (status == TL_E_ARGUMENT) /* a law has no stiffness that may be higher */
        status = TL_OK;
    tl_model *other = rests ? t->base : stiff.base;
    t->cycles = stiff.cycles;
    if (rests) {
        *t = stiff;
        tl_fall_free(fall);
        *fall = loose;
    } else
        tl_fall_free(&loose);
    if (other)
        tl_model_destroy(other);
    return status;
}

tl_status tl_trials_begin(tl_trials *t, const char *what, tl_model *m, const tl_safety *given, tl_fall *fall)
{
    *t = (tl_trials){.what = what, .asked = m, .stiffness = 1, .began = tl_clock()};
    *fall = (tl_fall){.ids = NULL};
    tl_status status = TL_OPTIONS_READ(tl_safety, given, &t->options, &m->error);
    if (status == TL_OK)
        status = tl_asked_check(m, what, &t->options, &t->which);
    atomic_store(&m->interrupted, false);
    bool rests = false;
    if (status == TL_OK)
        status = make_base(t, fall, &rests);
    if (status == TL_OK && rests && is_soft(t))
        status = stiffen(t, fall);
    return status;
}

bool tl_trials_by_steps(const tl_trials *t)
{
    return !tl_model_deforms(t->base);
}

/* A copy that has come to rest at a factor, after what `fall` lists as small had failed: the next trial begins with it.
 */
static tl_status keep(tl_trials *t, tl_model *copy, double factor, const tl_fall *fall)
{
    if (!tl_grow(&t->small, &t->small_capacity, fall->small_count + 1, sizeof *t->small))
        return tl_fail_memory(&t->asked->error);
    forget_made(t);
    if (fall->small_count > 0)
        memcpy(t->small, fall->small, fall->small_count * sizeof *t->small);
    t->small_count = fall->small_count;
    tl_model_destroy(t->base);
    t->base = copy;
    t->reached = factor;
    return TL_OK;
}

/* Lists what was small and failed before. */
static tl_status begin_fall(const tl_trials *t, tl_fall *fall)
{
    tl_fall_free(fall);
    if (!tl_grow(&fall->small, &fall->small_capacity, t->small_count + 1, sizeof *fall->small))
        return tl_fail_memory(&t->asked->error);
    if (t->small_count > 0)
        memcpy(fall->small, t->small, t->small_count * sizeof *fall->small);
    fall->small_count = t->small_count;
    return TL_OK;
}

/* Makes a trial at once. */
static tl_status make_one(tl_trials *t, double factor, tl_safety_trial *trial, tl_fall *fall)
{
    tl_model *copy = NULL;
    tl_status status = begin_fall(t, fall);
    if (status == TL_OK)
        status = copy_of(t, t->base, &copy);
    if (status == TL_OK)
        status = weaken(t, copy, factor);
    if (status == TL_OK)
        status = settle(t, copy, true, trial, fall);
    if (status == TL_OK && trial->holds && tl_trials_by_steps(t))
        status = keep(t, copy, factor, fall);
    if (copy && copy != t->base)
        tl_model_destroy(copy);
    return status;
}

/* STEP to the power of 2^k, and 1 for k < 0. */
static double below(int k)
{
    double over = STEP;
    for (int i = 0; i < k; i++)
        over *= over;
    return k < 0 ? 1 : over;
}

/* Makes a trial that has failed at once again, by steps, each half as long as the one before. */
static tl_status make_by_steps(tl_trials *t, double factor, tl_safety_trial *trial, tl_fall *fall)
{
    int64_t cycles = trial->cycles;
    tl_status status = TL_OK;
    int k = 0;
    while (factor / below(k + 1) > t->reached)
        k++;
    trial->holds = 1;
    for (; k >= -1 && status == TL_OK && trial->holds; k--) {
        status = make_one(t, factor / below(k), trial, fall);
        cycles += trial->cycles;
    }
    trial->cycles = cycles;
    return status;
}

static tl_status make(tl_trials *t, double factor, bool sure, tl_safety_trial *trial, tl_fall *fall)
{
    tl_status status = make_one(t, factor, trial, fall);
    if (status == TL_OK && sure && !trial->holds && tl_trials_by_steps(t) && factor / STEP > t->reached)
        status = make_by_steps(t, factor, trial, fall);
    trial->factor = factor;
    return status;
}

/* Takes over a copy that has come to rest in another process. */
static tl_status take_state(tl_trials *t, tl_trial_ahead *made)
{
    tl_model *copy;
    tl_status status = tl_model_of_bytes(&made->state, made->state_bytes, &copy, &t->asked->error);
    if (status != TL_OK)
        return status;
    tl_model_log(copy, hush, NULL);
    tl_model_speak_lua(copy, t->asked->speaks_lua);
    copy->interrupt_asked = t->asked->interrupt_asked;
    status = keep(t, copy, made->trial.factor, &made->fall);
    if (status != TL_OK)
        tl_model_destroy(copy);
    return status;
}

tl_trial_ahead *tl_trials_made(const tl_trials *t, double factor)
{
    for (size_t i = 0; i < t->ahead_count; i++)
        if (t->ahead[i].trial.factor == factor)
            return &t->ahead[i];
    return NULL;
}

/* Hands over a trial that was made ahead. */
static tl_status take_made(tl_trials *t, tl_trial_ahead *at, tl_safety_trial *trial, tl_fall *fall)
{
    tl_trial_ahead made = *at;
    *at = t->ahead[--t->ahead_count];
    t->cycles += made.trial.cycles;
    const tl_status status = made.state ? take_state(t, &made) : TL_OK;
    *trial = made.trial;
    *fall = made.fall;
    made.fall = (tl_fall){.ids = NULL};
    tl_trial_ahead_free(&made);
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

tl_status tl_trials_try(tl_trials *t, double factor, bool sure, tl_safety_trial *trial, tl_fall *fall)
{
    *fall = (tl_fall){.ids = NULL};
    tl_trial_ahead *made = tl_trials_made(t, factor);
    const tl_status status = made ? take_made(t, made, trial, fall) : make(t, factor, sure, trial, fall);
    return finish(t, status, trial, fall);
}

void tl_trials_end(tl_trials *t)
{
    forget_made(t);
    if (t->base)
        tl_model_destroy(t->base);
    free(t->small);
    free(t->ahead);
    free(t->which);
    t->ahead = NULL;
    t->base = NULL;
    t->which = NULL;
}
