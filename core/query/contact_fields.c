/* contact_fields.c - what can be asked of contacts: which ones, their named fields, a block's
 * neighbours. Values are those of the last step's forces. */
#include "contact/index.h"
#include "contact/places.h"
#include "detect/detect.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum {
    F_ID,
    F_BLOCKS,
    F_JOINT,
    F_AREA,
    F_NORMAL,
    F_POINT,
    F_GAP,
    F_NORMAL_FORCE,
    F_SHEAR_FORCE,
    F_NORMAL_STRESS,
    F_SHEAR_STRESS,
    F_STATE,
    F_COUNT
};

static const tl_field fields[F_COUNT] = {
    [F_ID] = {"id", TL_FIELD_COUNT, "", "number of the contact, never used again"},
    [F_BLOCKS] = {"blocks", TL_FIELD_IDS, "", "its two blocks, the older first"},
    [F_JOINT] = {"joint", TL_FIELD_TEXT, "", "joint and plane (\"J1:3\"), or empty"},
    [F_AREA] = {"area", TL_FIELD_SCALAR, "m2",
                "of the common polygon of two faces, or of the surface of pressure"},
    [F_NORMAL] = {"normal", TL_FIELD_VEC3, "", "unit normal from the first block to the second"},
    [F_POINT] = {"point", TL_FIELD_VEC3, "m", "centroid of the polygon, or centre of pressure"},
    [F_GAP] = {"gap", TL_FIELD_SCALAR, "m", "smallest gap, negative when overlapping"},
    [F_NORMAL_FORCE] = {"normal_force", TL_FIELD_SCALAR, "N", "compression positive"},
    [F_SHEAR_FORCE] = {"shear_force", TL_FIELD_VEC3, "N", "on the second block"},
    [F_NORMAL_STRESS] = {"normal_stress", TL_FIELD_SCALAR, "Pa", "normal force over area"},
    [F_SHEAR_STRESS] = {"shear_stress", TL_FIELD_SCALAR, "Pa", "length of shear force over area"},
    [F_STATE] = {"state", TL_FIELD_TEXT, "", "\"elastic\", \"slipping\", \"open\" or \"failed\""},
};

const tl_field *tl_contact_fields(size_t *count)
{
    *count = F_COUNT;
    return fields;
}

/* The second point of a field contact has its torsion, and the normal force again. */
static void forces(const tl_detect *d, uint32_t c, double *normal, tl_vec3 *shear)
{
    const tl_points_table *p = &d->points;
    uint32_t count = d->contacts.point_count[c];
    if (d->contacts.facet[c].kind == TL_FACET_FIELD && count > TL_FIELD_TORSION)
        count = TL_FIELD_TORSION;
    *normal = 0;
    *shear = tl_v3(0, 0, 0);
    for (uint32_t k = 0; k < count; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        *normal += p->f_n[i];
        *shear = tl_v3_add(*shear, tl_v3(p->f_s[0][i], p->f_s[1][i], p->f_s[2][i]));
    }
}

/* Open when every point is, slipping when some point slips, failed when some bond is lost. */
static const char *state_of(const tl_detect *d, uint32_t c)
{
    uint32_t any = 0, all = TL_POINT_OPEN;
    for (uint32_t k = 0; k < d->contacts.point_count[c]; k++) {
        uint32_t flags = d->points.flags[tl_point_row(&d->contacts, c, k)];
        any |= flags;
        all &= flags;
    }
    if (all & TL_POINT_OPEN)
        return "open";
    if (any & TL_POINT_SLIPPING)
        return "slipping";
    return any & TL_POINT_FAILED ? "failed" : "elastic";
}

static void put_vector(tl_field_value *value, tl_vec3 v)
{
    value->number[0] = v.x;
    value->number[1] = v.y;
    value->number[2] = v.z;
}

tl_status tl_contact_field(tl_model *m, tl_id contact, size_t index, tl_field_value *value)
{
    assert(index < F_COUNT);
    tl_status status = tl_detect_refresh(m);
    if (status != TL_OK)
        return status;
    tl_detect *d = m->detect;
    const tl_contacts *contacts = &d->contacts;
    uint32_t c = tl_contact_row(d, contact);
    if (c == TL_NO_ROW)
        return tl_fail(&m->error, TL_E_STALE, "contact %u no longer exists: its blocks have parted",
                       contact);
    *value = (tl_field_value){{0}, NULL};
    double normal, gap, area = contacts->area[c];
    tl_vec3 shear, direction, point;
    forces(d, c, &normal, &shear);
    tl_contact_summary(m, c, &direction, &point, &gap);
    switch (index) {
    case F_ID: value->number[0] = contact; break;
    case F_BLOCKS:
        value->number[0] = m->blocks.id[contacts->a[c]];
        value->number[1] = m->blocks.id[contacts->b[c]];
        break;
    case F_JOINT: value->text = tl_tag_name(m, contacts->tag[c]); break;
    case F_AREA: value->number[0] = contacts->area[c]; break;
    case F_NORMAL: put_vector(value, direction); break;
    case F_POINT: put_vector(value, tl_v3_add(m->origin, point)); break;
    case F_GAP: value->number[0] = gap; break;
    case F_NORMAL_FORCE: value->number[0] = normal; break;
    case F_SHEAR_FORCE: put_vector(value, shear); break;
    case F_NORMAL_STRESS: value->number[0] = area > 0 ? normal / area : 0; break;
    case F_SHEAR_STRESS: value->number[0] = area > 0 ? tl_v3_norm(shear) / area : 0; break;
    case F_STATE: value->text = state_of(d, c); break;
    default: break;
    }
    return TL_OK;
}

static int compare_id(const void *a, const void *b)
{
    tl_id x = *(const tl_id *)a, y = *(const tl_id *)b;
    return (x > y) - (x < y);
}

/* Marks [block rows] which are in a list; NULL for no list. */
static unsigned char *mark(tl_model *m, const tl_id *ids, size_t count, tl_status *status)
{
    unsigned char *marks = calloc(m->blocks.table.rows + 1, 1);
    if (!marks) {
        *status = tl_fail_memory(&m->error);
        return NULL;
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t row = tl_block_row(m, ids[i]);
        if (row == TL_NO_ROW) {
            *status = m->error.status;
            break;
        }
        marks[row] = 1;
    }
    return marks;
}

static bool is_between(const unsigned char *ma, const unsigned char *mb, uint32_t a, uint32_t b)
{
    return !ma || !mb || (ma[a] && mb[b]) || (ma[b] && mb[a]);
}

tl_status tl_contacts_select(tl_model *m, const tl_contact_filter *filter, tl_id **ids,
                             size_t *count)
{
    *ids = NULL;
    *count = 0;
    tl_tag joint = {0, 0};
    tl_status status = tl_detect_refresh(m);
    if (status == TL_OK && filter->joint)
        status = tl_joint_parse(m, filter->joint, &joint);
    unsigned char *ma = NULL, *mb = NULL;
    if (status == TL_OK && filter->between_a)
        ma = mark(m, filter->between_a, filter->count_a, &status);
    if (status == TL_OK && filter->between_b)
        mb = mark(m, filter->between_b, filter->count_b, &status);
    const tl_contacts *c = m->detect ? &m->detect->contacts : NULL;
    tl_id *list = NULL;
    if (status == TL_OK && !(list = malloc((c->table.rows + 1) * sizeof *list)))
        status = tl_fail_memory(&m->error);
    size_t n = 0;
    for (uint32_t row = 0; status == TL_OK && row < c->table.rows; row++)
        if (c->point_count[row] && tl_tag_matches(joint, c->tag[row]) &&
            is_between(ma, mb, c->a[row], c->b[row]))
            list[n++] = c->id[row];
    if (n > 1)
        qsort(list, n, sizeof *list, compare_id);
    free(ma);
    free(mb);
    *ids = list;
    *count = n;
    return status;
}

tl_status tl_block_neighbours(tl_model *m, tl_id block, tl_id **ids, size_t *count)
{
    *ids = NULL;
    *count = 0;
    uint32_t row = tl_block_row(m, block);
    if (row == TL_NO_ROW)
        return m->error.status;
    tl_status status = tl_detect_refresh(m);
    if (status != TL_OK)
        return status;
    const tl_detect *d = m->detect;
    uint32_t begin = d->by_block_start[row], end = d->by_block_start[row + 1];
    tl_id *list = malloc((end - begin + 1u) * sizeof *list);
    if (!list)
        return tl_fail_memory(&m->error);
    for (uint32_t e = begin; e < end; e++) {
        uint32_t c = d->by_block[e];
        if (d->contacts.point_count[c])
            list[(*count)++] = m->blocks.id[tl_contact_partner(&d->contacts, c, row)];
    }
    *ids = list;
    return TL_OK;
}
