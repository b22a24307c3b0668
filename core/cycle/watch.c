/* watch.c - telling steady failure from slow convergence.
 *
 * At the end of every window of steps each free body's motion in the window is compared with that in the
 * window before: a body fails steadily when over three windows it has moved on in one direction, each
 * time nearly as far as before or farther, and farther than a contact's tolerance, while the unbalanced
 * force ratio has not halved. A body that swings turns back; one that settles moves less and less. */
#include "cycle/cycle_room.h"

#include <stdlib.h>
#include <string.h>

/* Steps of a window. */
#define WINDOW 400
#define WINDOWS 3
/* A window's motion counts as no less than the one before from this share on. */
#define NO_LESS 0.95
/* cos of the largest change of direction between windows. */
#define ONE_WAY 0.7

struct tl_watch {
    size_t bodies;
    uint64_t structure;
    int64_t steps;
    tl_vec3 *place[WINDOWS + 1]; /* displacements at the ends of the last windows, newest first */
    double ratio[WINDOWS + 1];
    int windows;
    tl_id failing;
};

tl_watch *tl_watch_begin(const tl_model *m)
{
    tl_watch *w = calloc(1, sizeof *w);
    if (!w)
        return NULL;
    w->bodies = m->bodies.table.rows;
    w->structure = m->structure;
    for (int k = 0; k <= WINDOWS; k++) {
        w->place[k] = malloc((w->bodies + 1) * sizeof *w->place[k]);
        if (!w->place[k]) {
            tl_watch_end(w);
            return NULL;
        }
    }
    return w;
}

void tl_watch_end(tl_watch *w)
{
    if (!w)
        return;
    for (int k = 0; k <= WINDOWS; k++)
        free(w->place[k]);
    free(w);
}

/* True when the body has gone on in every window as the head of the file says. */
static bool goes_on(const tl_watch *w, const tl_model *m, uint32_t body)
{
    double size = m->blocks.size[m->members[m->bodies.member_start[body]]];
    tl_vec3 later = tl_v3_sub(w->place[0][body], w->place[1][body]);
    if (tl_v3_norm(later) < TL_CONTACT_TOLERANCE * size)
        return false;
    for (int k = 1; k < WINDOWS; k++) {
        tl_vec3 earlier = tl_v3_sub(w->place[k][body], w->place[k + 1][body]);
        double a = tl_v3_norm(later), b = tl_v3_norm(earlier);
        if (!(b > 0) || a < NO_LESS * b || tl_v3_dot(later, earlier) < ONE_WAY * a * b)
            return false;
        later = earlier;
    }
    return true;
}

static tl_id find_failing(const tl_watch *w, const tl_model *m)
{
    if (w->ratio[0] < 0.5 * w->ratio[WINDOWS])
        return TL_NO_ID;
    tl_id failing = TL_NO_ID;
    double fastest = 0;
    for (uint32_t body = 0; body < w->bodies; body++) {
        double speed = tl_v3_norm(m->bodies.v[body]);
        if (m->bodies.fixed[body] != TL_FIX_ALL && speed > fastest && goes_on(w, m, body)) {
            fastest = speed;
            failing = m->bodies.id[body];
        }
    }
    return failing;
}

tl_id tl_watch_step(tl_watch *w, const tl_model *m)
{
    if (++w->steps % WINDOW != 0 || w->structure != m->structure)
        return w->failing;
    tl_vec3 *oldest = w->place[WINDOWS];
    memmove(&w->place[1], &w->place[0], WINDOWS * sizeof w->place[0]);
    memmove(&w->ratio[1], &w->ratio[0], WINDOWS * sizeof w->ratio[0]);
    w->place[0] = oldest;
    for (uint32_t body = 0; body < w->bodies; body++)
        oldest[body] = m->bodies.pose[body].u;
    w->ratio[0] = tl_unbalanced_ratio(m, TL_RATIO_AVERAGE);
    w->failing = ++w->windows > WINDOWS ? find_failing(w, m) : TL_NO_ID;
    return w->failing;
}
