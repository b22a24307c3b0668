/* joint_law.c - setting the law of a joint. */
#include "cycle/cycle_data.h"
#include "cycle/kept_force.h"

#include "contact/presses.h"
#include "detect/asked.h"
#include "detect/detect.h"
#include "force/joint_laws.h"

#include <stdlib.h>

static bool is_field(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    return contacts->facet[c].kind == TL_FACET_FIELD && contacts->point_count[c] > 0 &&
           contacts->law[c] != TL_NO_ROW;
}

/* Field contacts that get a law that presses otherwise. */
typedef struct fields {
    uint32_t *contact;
    size_t count;
} fields;

/* false: out of memory. */
static bool find_fields(tl_model *m, const tl_law *law, fields *out)
{
    const size_t rows = m->detect->contacts.table.rows;
    bool enough = true;
    out->contact = malloc((rows + 1) * sizeof *out->contact);
    for (uint32_t c = 0; c < rows && out->contact && enough; c++)
        if (is_field(m, c) && tl_law_rebases(m, law, c)) {
            enough = tl_may_keep_field_force(m, c);
            out->contact[out->count++] = c;
        }
    return out->contact && enough;
}

/* Brings contacts up to the present places, where a step that failed has left them already, and makes room for what a
 * law needs of their points: all that can fail before it takes its place. */
static tl_status prepare_contacts(tl_model *m, const tl_law *law, fields *out)
{
    tl_asked_end(m);
    if (!m->detect)
        return TL_OK;
    tl_status status = tl_detect_update(m);
    if (status != TL_OK)
        return status;
    return tl_law_reserve(m, law) && find_fields(m, law, out) ? TL_OK : tl_fail_memory(&m->error);
}

/* After the law has taken its place. */
static void keep_forces(tl_model *m, const fields *of)
{
    for (size_t k = 0; k < of->count; k++)
        tl_keep_field_force(m, of->contact[k]);
}

static tl_law *exact_law(tl_model *m, tl_tag tag)
{
    for (size_t i = 0; i < m->joint_law_count; i++)
        if (m->joint_laws[i].tag.joint == tag.joint && m->joint_laws[i].tag.plane == tag.plane)
            return &m->joint_laws[i];
    return NULL;
}

tl_status tl_joint_law(tl_model *m, const char *joint, const char *law, const tl_args *args)
{
    tl_tag tag;
    tl_status status = tl_model_may_set(m, "set a law or its properties");
    if (status == TL_OK)
        status = tl_joint_parse(m, joint, &tag);
    if (status != TL_OK)
        return status;
    const tl_law *ruling = tl_law_of(m, tag);
    const tl_kind *kind = law ? tl_plugin_find(TL_KIND_LAW, law) : ruling ? ruling->kind : NULL;
    if (law && !kind)
        return tl_unknown_kind(m, TL_KIND_LAW, law);
    if (!kind)
        return tl_fail(
            &m->error, TL_E_STATE,
            m->speaks_lua
                ? "joint '%s' has no law yet: name one, as in model:joint(\"%s\", LAW, {...})"
                : "joint '%s' has no law yet: give tl_joint_law() one for \"%s\"",
            joint, joint);
    tl_law fresh;
    status = tl_law_make_for(m, tag, joint, kind, args, law ? NULL : ruling, &fresh);
    if (status != TL_OK)
        return status;
    tl_law *place = exact_law(m, tag);
    if (!place) {
        tl_law *joint_laws = realloc(m->joint_laws, (m->joint_law_count + 1) * sizeof *joint_laws);
        if (!joint_laws) {
            tl_law_clear(&fresh);
            return tl_fail_memory(&m->error);
        }
        m->joint_laws = joint_laws;
    }
    fields kept = {NULL, 0};
    status = prepare_contacts(m, &fresh, &kept);
    if (status != TL_OK) {
        free(kept.contact);
        tl_law_clear(&fresh);
        return status;
    }
    tl_remark_friction(m, joint, &fresh);
    tl_law_rebase(m, &fresh);
    if (place) {
        if (place->kind != fresh.kind)
            tl_law_reset(m, (uint32_t)(place - m->joint_laws), fresh.kind);
        tl_law_clear(place);
        *place = fresh;
    } else {
        m->joint_laws[m->joint_law_count++] = fresh;
    }
    keep_forces(m, &kept);
    free(kept.contact);
    m->laws++;
    if (m->cycle)
        m->cycle->dt = 0;
    return TL_OK;
}
