/* stress.c - initial stress: tractions sigma n on the face patches that exist now.
 *
 * sigma(z) = stress + gradient (z - at.z), tension positive. A point of area a and normal n (A to B) gets
 * f_n = -(n . sigma n) a and f_s = -(sigma n - (n . sigma n) n) a on B, and its closure counts from now.
 * Field contacts begin without force, and so do contacts made later, but those of blocks that are cut (contact/estate.c), and faces
 * with rock between them. */
#include "force/stress.h"

#include "base/columns.h"
#include "contact/across_gap.h"
#include "contact/contacts.h"
#include "contact/detection.h"
#include "contact/places.h"

#include <math.h>

tl_sym3 tl_insitu_stress(const tl_insitu *s, double z)
{
    return tl_s3_madd(s->stress, z - s->at.z, s->gradient);
}

/* Whether the faces of a patch are together: in the mean over its area not farther apart than blocks in contact are. Faces
 * with a wedge of rock between them touch along its edge and have a patch, but the wedge carries their stress. */
static bool faces_meet(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    double size = fmin(m->blocks.size[contacts->a[c]], m->blocks.size[contacts->b[c]]);
    double area = 0, apart = 0;
    for (size_t i = 0; i < contacts->point_count[c]; i++) {
        size_t point = tl_point_row(contacts, c, i);
        area += p->area[point];
        apart -= p->area[point] * (m->detect->lanes[0].closure[i] + p->reference[point]);
    }
    return apart <= TL_CONTACT_TOLERANCE * size * area;
}

void tl_insitu_load(tl_model *m, const tl_insitu *s, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_point_lanes *lanes = &m->detect->lanes[0];
    double centroid_z = m->origin.z + tl_body_place(&m->bodies, m->blocks.body[contacts->a[c]]).z;
    tl_contact_places(m, c, lanes);
    m->detect->contacts.holds_over_gap[c] = true; /* perhaps: the next step tells */
    if (!tl_facet_is_patch(&contacts->facet[c]) || !faces_meet(m, c))
        return;
    contacts->stored[c] = NAN;
    double opening[TL_LANES];
    for (size_t i = 0; i < contacts->point_count[c]; i++) {
        if (i % TL_LANES == 0)
            tl_contact_point_openings(m, c, i, opening);
        tl_sym3 stress = tl_insitu_stress(s, centroid_z + lanes->arm[2][i]);
        tl_point_load(&m->detect->points, tl_point_row(contacts, c, i), &stress,
                      tl_columns_get(lanes->normal, i), lanes->closure[i], opening[i % TL_LANES]);
    }
}
