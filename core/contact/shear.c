/* shear.c - the shear of a contact: its sum over the points, and what becomes of its energy when their areas change. */
#include "contact/shear.h"

#include "base/columns.h"
#include "contact/kind.h"
#include "contact/places.h"
#include "contact/sides.h"

double tl_contact_area_of_points(const tl_detect *d, uint32_t c)
{
    double area = 0;
    for (size_t k = 0; k < tl_contact_areas(d, c); k++)
        area += d->points.area[tl_point_row(&d->contacts, c, k)];
    return area;
}

tl_shear tl_shear_of(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    const tl_facing_place place = tl_contact_place(m, c);
    tl_shear sum = {0};
    for (size_t k = 0; k < contacts->point_count[c]; k++) {
        size_t i = tl_point_row(contacts, c, k);
        tl_vec3 arm = tl_v3_add(tl_m3_mul(&place.to, tl_columns_get(p->p, i)), place.at);
        tl_shear_add(&sum, p->area[i], arm, tl_columns_get(p->f_s, i));
    }
    return sum;
}

void tl_shear_add_field(const tl_model *m, uint32_t c, tl_shear *sum)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    for (size_t k = 0; k < TL_FIELD_POINTS; k++) {
        size_t i = tl_point_row(contacts, c, k);
        sum->energy += tl_shear_energy(tl_v3_norm2(tl_columns_get(p->f_s, i)), p->area[i]);
    }
    tl_vec3 turning = tl_columns_get(p->f_s, tl_point_row(contacts, c, TL_FIELD_TORSION));
    sum->torsion = tl_press_row_of(m, c)->press.radius * tl_v3_dot(contacts->facet[c].last, turning);
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

double tl_shear_kept(const tl_model *m, uint32_t c)
{
    const tl_detect *d = m->detect;
    uint32_t column = tl_shear_kept_column(m, d->contacts.law[c]);
    double sum = 0;
    for (size_t k = 0; column != TL_NO_ROW && k < d->contacts.point_count[c]; k++)
        sum += d->points.state[column][tl_point_row(&d->contacts, c, k)];
    return sum;
}

void tl_shear_keep(tl_model *m, uint32_t c, double energy)
{
    tl_detect *d = m->detect;
    uint32_t column = tl_shear_kept_column(m, d->contacts.law[c]);
    if (column == TL_NO_ROW)
        return;
    double area = tl_contact_area_of_points(d, c);
    for (size_t k = 0; k < tl_contact_areas(d, c) && area > 0; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        d->points.state[column][i] = energy * (d->points.area[i] / area);
    }
    d->contacts.released[c] += area > 0 ? 0 : energy;
}
