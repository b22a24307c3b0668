/* shear.c - the shear of a contact, and what becomes of it when its area changes. */
#include "contact/shear.h"

#include "base/columns.h"
#include "contact/detection.h"

tl_contact_motion tl_contact_moved(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    uint32_t body_a = m->blocks.body[contacts->a[c]], body_b = m->blocks.body[contacts->b[c]];
    const tl_pose *a = &m->bodies.pose[body_a], *b = &m->bodies.pose[body_b];
    tl_vec3 apart = tl_body_apart(&m->bodies, body_a, body_b);
    tl_vec3 way = tl_v3_sub(tl_v3_sub(b->v_moved, tl_v3_cross(b->w_moved, apart)), a->v_moved);
    return (tl_contact_motion){tl_v3_scale(m->dt, way),
                               tl_v3_scale(m->dt, tl_v3_sub(b->w_moved, a->w_moved))};
}

tl_shear tl_shear_of(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    const tl_mat3 *turn = &m->bodies.pose[m->blocks.body[contacts->a[c]]].r;
    tl_shear sum = {0};
    for (size_t k = 0; k < contacts->point_count[c]; k++) {
        size_t i = tl_point_row(contacts, c, k);
        tl_vec3 force = tl_columns_get(p->f_s, i), arm = tl_m3_mul(turn, tl_columns_get(p->p, i));
        sum.area += p->area[i];
        sum.energy += p->area[i] > 0 ? tl_v3_norm2(force) / p->area[i] : 0;
        sum.force = tl_v3_add(sum.force, force);
        sum.moment = tl_v3_add(sum.moment, tl_v3_cross(arm, force));
    }
    return sum;
}

void tl_shear_release(tl_model *m, uint32_t c, const tl_shear *before, const tl_shear *now)
{
    tl_contacts *contacts = &m->detect->contacts;
    uint32_t law = contacts->law[c];
    double ks = law == TL_NO_ROW ? 0 : m->joint_laws[law].ks;
    if (!(ks > 0))
        return;
    if (tl_law_has_own_shear(&m->joint_laws[law])) {
        contacts->handed_over[c] = true;
        return;
    }
    tl_contact_motion moved = tl_contact_moved(m, c);
    double work = tl_v3_dot(tl_v3_sub(before->force, now->force), moved.way) +
                  tl_v3_dot(tl_v3_sub(before->moment, now->moment), moved.turn);
    contacts->released[c] += 0.5 * ((before->energy - now->energy) / ks - work);
}

void tl_shear_resized(tl_model *m, uint32_t c, const tl_shear *before, const tl_shear *resized)
{
    tl_points_table *p = &m->detect->points;
    tl_shear now = *resized;
    double keep = now.area > before->area ? before->area / now.area : 1;
    if (keep * keep * now.energy > before->energy)
        keep = sqrt(before->energy / now.energy);
    for (size_t k = 0; keep < 1 && k < m->detect->contacts.point_count[c]; k++) {
        size_t i = tl_point_row(&m->detect->contacts, c, k);
        tl_columns_put(p->f_s, i, tl_v3_scale(keep, tl_columns_get(p->f_s, i)));
    }
    now.energy *= keep * keep;
    now.force = tl_v3_scale(keep, now.force);
    now.moment = tl_v3_scale(keep, now.moment);
    tl_shear_release(m, c, before, &now);
}

static uint32_t energy_column(const tl_model *m, uint32_t c)
{
    uint32_t law = m->detect->contacts.law[c];
    return law == TL_NO_ROW ? TL_NO_ROW : m->joint_laws[law].energy;
}

double tl_shear_kept(const tl_model *m, uint32_t c)
{
    const tl_points_table *p = &m->detect->points;
    uint32_t column = energy_column(m, c);
    double sum = 0;
    for (size_t k = 0; column < p->state_columns && k < m->detect->contacts.point_count[c]; k++)
        sum += p->state[column][tl_point_row(&m->detect->contacts, c, k)];
    return sum;
}

void tl_shear_keep(tl_model *m, uint32_t c, double energy)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    uint32_t column = energy_column(m, c);
    if (column >= p->state_columns)
        return;
    bool field = contacts->facet[c].kind == TL_FACET_FIELD;
    size_t count = field && contacts->point_count[c] ? 1 : contacts->point_count[c];
    double area = 0;
    for (size_t k = 0; k < count; k++)
        area += p->area[tl_point_row(contacts, c, k)];
    for (size_t k = 0; k < count && area > 0; k++) {
        size_t i = tl_point_row(contacts, c, k);
        p->state[column][i] = energy * (p->area[i] / area);
    }
    contacts->released[c] += area > 0 ? 0 : energy;
}
