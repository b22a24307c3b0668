/* face_loads.c - what tractions on faces put on blocks, kept so that their parts get their shares.
 *
 * Of a load that comes of a traction on a face, force F and moment M about the centroid c of the face are noted. Parts of the face get
 * what brings a uniform plate along that F and M act on: with the area A and its second moments I, each part p
 *
 *     F_p = A_p (F/A + w x (c_p - c)),    M_p = I_p w,    I w = M
 *
 * A traction that is uniform, or normal to the face and linear, is the same on each part. Sums are those of the whole for any. */
#include "model/face_loads.h"

#include "model/inertia.h"

#include <stdlib.h>

/* ---------------------------------------------------------------- lumps ------------------ */

void tl_lump_add(tl_lump *sum, const tl_lump *part)
{
    sum->mass += part->mass;
    sum->place = tl_v3_madd(sum->place, part->mass, part->place);
}

void tl_lump_close(tl_lump *sum)
{
    if (sum->mass > 0)
        sum->place = tl_v3_scale(1 / sum->mass, sum->place);
}

void tl_lump_add_inertia(tl_lump *sum, const tl_lump *part)
{
    tl_sym3 add = tl_inertia_about(part->inertia, part->mass, tl_v3_sub(part->place, sum->place));
    tl_sym3 *to = &sum->inertia;
    *to = (tl_sym3){to->xx + add.xx, to->yy + add.yy, to->zz + add.zz,
                    to->xy + add.xy, to->yz + add.yz, to->zx + add.zx};
}

tl_wrench tl_lump_share(const tl_lump *part, const tl_lump *all, tl_wrench whole)
{
    const tl_sym3 *a = &all->inertia;
    tl_vec3 turn = tl_solve3(tl_v3(a->xx, a->xy, a->zx), tl_v3(a->xy, a->yy, a->yz),
                             tl_v3(a->zx, a->yz, a->zz), whole.moment);
    tl_vec3 goes = tl_v3_scale(1 / all->mass, whole.force);
    goes = tl_v3_add(goes, tl_v3_cross(turn, tl_v3_sub(part->place, all->place)));
    return (tl_wrench){tl_v3_scale(part->mass, goes), tl_s3_mul(part->inertia, turn)};
}

tl_lump tl_face_plate(const tl_model *m, uint32_t row, uint32_t face)
{
    const tl_poly *p = m->blocks.shape[row];
    uint32_t body = m->blocks.body[row], first = p->start[face];
    const tl_mat3 *r = &m->bodies.pose[body].r;
    tl_vec3 at = tl_m3_mul(r, p->vertex[p->loop[first]]);
    tl_lump out = {.mass = 0};
    double square[6] = {0}; /* of places from the first corner */
    for (uint32_t i = first + 1; i + 1 < p->start[face + 1]; i++) {
        tl_vec3 e = tl_v3_sub(tl_m3_mul(r, p->vertex[p->loop[i]]), at);
        tl_vec3 f = tl_v3_sub(tl_m3_mul(r, p->vertex[p->loop[i + 1]]), at);
        double third = tl_v3_norm(tl_v3_cross(e, f)) / 6;
        const tl_vec3 middle[3] = {tl_v3_scale(0.5, e), tl_v3_scale(0.5, tl_v3_add(e, f)),
                                   tl_v3_scale(0.5, f)};
        for (int k = 0; k < 3; k++) {
            tl_vec3 x = middle[k];
            const double products[] = {x.x * x.x, x.y * x.y, x.z * x.z,
                                       x.x * x.y, x.y * x.z, x.z * x.x};
            out.mass += third;
            out.place = tl_v3_madd(out.place, third, x);
            for (int j = 0; j < 6; j++)
                square[j] += third * products[j];
        }
    }
    tl_lump_close(&out);
    tl_vec3 c = out.place;
    const double own[] = {c.x * c.x, c.y * c.y, c.z * c.z, c.x * c.y, c.y * c.z, c.z * c.x};
    for (int j = 0; j < 6; j++)
        square[j] -= out.mass * own[j];
    out.inertia = (tl_sym3){square[1] + square[2],
                            square[2] + square[0],
                            square[0] + square[1],
                            -square[3],
                            -square[4],
                            -square[5]};
    out.place = tl_v3_add(tl_body_place(&m->bodies, body), tl_v3_add(at, c));
    return out;
}

/* ---------------------------------------------------------------- the list --------------- */

static int compare(const void *x, const void *y)
{
    const tl_face_load *p = x, *q = y;
    return p->block != q->block ? (p->block > q->block) - (p->block < q->block)
                                : (p->face > q->face) - (p->face < q->face);
}

void tl_face_loads_set(tl_model *m, tl_face_load *list, size_t count, size_t capacity)
{
    size_t kept = 0;
    if (count > 1)
        qsort(list, count, sizeof *list, compare);
    for (size_t i = 0; i < count; i++) {
        tl_face_load *last = kept ? &list[kept - 1] : NULL;
        if (tl_block_row_quiet(m, list[i].block) == TL_NO_ROW)
            continue;
        if (last && compare(last, &list[i]) == 0) {
            last->force = tl_v3_add(last->force, list[i].force);
            last->moment = tl_v3_add(last->moment, list[i].moment);
        } else {
            list[kept++] = list[i];
        }
    }
    if (list != m->face_loads)
        free(m->face_loads);
    m->face_loads = list;
    m->face_load_count = kept;
    m->face_load_capacity = capacity;
}

bool tl_face_loads_forget(tl_model *m, const tl_id *ids, size_t count)
{
    size_t kept = 0;
    if (m->face_load_count == 0)
        return true;
    uint8_t *meant = calloc(m->bodies.table.rows + 1, sizeof *meant);
    if (!meant)
        return false;
    for (size_t i = 0; i < count; i++)
        meant[m->blocks.body[m->row_of[ids[i]]]] = 1;
    for (size_t i = 0; i < m->face_load_count; i++) {
        uint32_t row = tl_block_row_quiet(m, m->face_loads[i].block);
        if (row != TL_NO_ROW && !meant[m->blocks.body[row]])
            m->face_loads[kept++] = m->face_loads[i];
    }
    m->face_load_count = kept;
    free(meant);
    return true;
}

/* ---------------------------------------------------------------- loads ------------------ */

void tl_load_add(tl_model *m, uint32_t body, tl_wrench more, tl_vec3 place)
{
    tl_body_load *load = &m->bodies.load[body];
    const tl_mat3 *r = &m->bodies.pose[body].r;
    tl_vec3 to = tl_v3_sub(place, tl_body_place(&m->bodies, body)), at = tl_m3_mul(r, load->arm);
    double had = tl_v3_norm(load->force), has = tl_v3_norm(more.force), all = had + has;
    if (had == 0) { /* without roundings */
        *load = (tl_body_load){more.force, tl_v3_add(load->moment, more.moment), tl_m3_tmul(r, to)};
        return;
    }
    tl_vec3 arm = tl_v3_add(tl_v3_scale(had, at), tl_v3_scale(has, to));
    arm = tl_v3_scale(all > 0 ? 1 / all : 0, arm);
    tl_vec3 moment = tl_v3_add(load->moment, tl_v3_cross(at, load->force));
    moment = tl_v3_add(moment, tl_v3_add(more.moment, tl_v3_cross(to, more.force)));
    load->force = tl_v3_add(load->force, more.force);
    load->moment = tl_v3_sub(moment, tl_v3_cross(arm, load->force));
    load->arm = tl_m3_tmul(r, arm);
}
