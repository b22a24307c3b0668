/* share_properties.c - the contact points of any pair of shapes in any place: areas and places are numbers, each point
 * belongs to one facet, and nothing is left over of a minimum area that holds whatever touches. */
#include "contact_scene.h"
#include "narrow/manifold.h"

static tl_poly *any_shape(uint64_t *seed)
{
    double flat = pow(10, scene_between(seed, -3, 0));
    switch ((int)(5 * check_random(seed))) {
    case 0: return scene_box_shape(1, 1, 1);
    case 1: return scene_box_shape(1, flat, 0.5 * flat);
    case 2: return scene_drum(128, 0.5, flat, 0);
    case 3: return scene_drum(3 + (size_t)(6 * check_random(seed)), 0.5, 0.7, 0);
    default: return scene_random_hull(seed, 14, tl_v3(0.5, 0.5, 0.5 * fmax(0.05, flat)));
    }
}

/* A turn, often one that lays edges and faces exactly or nearly along each other. */
static tl_quat any_attitude(uint64_t *seed)
{
    tl_quat q = {1, 0, 0, 0};
    if (check_random(seed) < 0.3)
        return scene_any_turn(seed);
    for (int k = 0; k < 3; k++) {
        tl_vec3 about = {k == 0, k == 1, k == 2};
        double part = TL_PI / 12 * floor(scene_between(seed, 0, 24));
        double off = check_random(seed) < 0.5 ? 0 : pow(10, scene_between(seed, -16, -1));
        q = tl_q_mul(scene_turn(about, (check_random(seed) < 0.5 ? 0 : part) + off), q);
    }
    return tl_q_unit(q);
}

/* Points have areas, places and couples that are numbers, each belongs to one facet, and nothing is left over of the
 * minimum area that holds whatever touches, but of blocks that are `whole`. */
static bool sound(const tl_manifold *m, const tl_share_rule *rule, bool whole, double s)
{
    size_t point = 0;
    double area = 0;
    for (size_t k = 0; k < m->facet_count; k++) {
        const tl_facet *f = &m->facets[k];
        if (f->begin != point || f->count == 0 || !isfinite(tl_v3_norm(tl_facet_swing(f))) ||
            !isfinite(tl_v3_norm(f->na) + tl_v3_norm(f->nb) + f->offset))
            return false;
        point += f->count;
    }
    for (size_t i = 0; i < m->point_count; i++) {
        if (!(m->points[i].area > 0) || !isfinite(m->points[i].area + tl_v3_norm(m->points[i].p)))
            return false;
        area += m->points[i].area;
    }
    bool all = rule->unconditional && whole && s < 0 && m->point_count > 0;
    return point == m->point_count && (!all || area > 0.99 * rule->minimum);
}

TEST(any_pair_has_a_sound_share)
{
    int with_points = 0;
    for (uint64_t s = 1; s <= 4000; s++) {
        uint64_t seed = s;
        tl_poly *a = any_shape(&seed), *b = any_shape(&seed);
        scene_pair p = scene_pair_of(a, b, any_attitude(&seed), tl_v3(0, 0, 0));
        p.shift = scene_direction(&seed);
        if (check_random(&seed) < 0.5) /* along an axis, off by a round share */
            p.shift = tl_v3(0.25 * floor(scene_between(&seed, -3, 4)),
                            0.25 * floor(scene_between(&seed, -3, 4)), 1);
        scene_press(&p, check_random(&seed) < 0.2 ? 0 : pow(10, scene_between(&seed, -12, -1)));
        uint8_t covered[512] = {0};
        if (s % 8 == 0 && a->face_count < 512) { /* part of a body */
            for (uint32_t i = 0; i < a->face_count; i++)
                covered[i] = check_random(&seed) < 0.3;
            a->covered = covered;
            a->seams = true;
        }
        const tl_pair_view *view = scene_place(&p);
        tl_axis axis = tl_axis_search(view, &p.room, NULL);
        tl_share_rule rule = {.minimum = 0.01 * view->mean_face, .reach = 1.5e-3 * view->size};
        if (s % 3 == 0)
            rule.reach = INFINITY;
        if (s % 5 == 0) {
            rule.unconditional = true;
            rule.minimum = 1;
        }
        rule.corners = s % 7 == 0;
        if (isfinite(axis.s)) { /* else parts that do not press on each other */
            tl_manifold_build(view, &axis, &rule, &p.room);
            CHECK(!p.room.manifold.failed);
            if (!CHECK(sound(&p.room.manifold, &rule, !a->seams, axis.s)))
                printf("  seed %d, axis %u\n", (int)s, axis.kind);
            with_points += p.room.manifold.point_count > 0;
        }
        a->covered = a->hidden; /* zeros, as before */
        a->seams = false;
        scene_pair_free(&p);
    }
    CHECK(with_points > 2000);
}

TEST_MAIN(RUN(any_pair_has_a_sound_share))
