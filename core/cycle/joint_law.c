/* joint_law.c - setting the law of a joint. */
#include "cycle/cycle_room.h"

#include "detect/detect.h"
#include "force/materials.h"

#include <stdlib.h>

/* Brings contacts up to the present places, where a step that failed has left them already, and makes room for what a
 * material needs of their points: all that can fail before it takes its place. */
static tl_status prepare_contacts(tl_model *m, const tl_material *material)
{
    if (!m->detect)
        return TL_OK;
    tl_status status = tl_detect_update(m);
    if (status != TL_OK)
        return status;
    return tl_material_reserve(m, material) ? TL_OK : tl_fail_memory(&m->error);
}

static tl_material *exact_material(tl_model *m, tl_tag tag)
{
    for (size_t i = 0; i < m->material_count; i++)
        if (m->materials[i].tag.joint == tag.joint && m->materials[i].tag.plane == tag.plane)
            return &m->materials[i];
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
    const tl_material *ruling = tl_material_of(m, tag);
    const tl_kind *kind = law ? tl_plugin_find(TL_KIND_LAW, law) : ruling ? ruling->kind : NULL;
    if (law && !kind)
        return tl_unknown_kind(m, TL_KIND_LAW, law);
    if (!kind)
        return tl_fail(&m->error, TL_E_STATE,
                       "joint '%s' has no law yet: name one, as in model:joint(\"%s\", LAW, {...})",
                       joint, joint);
    tl_material fresh;
    status = tl_material_make(m, tag, joint, kind, args, law ? NULL : ruling, &fresh);
    if (status != TL_OK)
        return status;
    tl_material *place = exact_material(m, tag);
    if (!place) {
        tl_material *materials = realloc(m->materials, (m->material_count + 1) * sizeof *materials);
        if (!materials) {
            tl_material_clear(&fresh);
            return tl_fail_memory(&m->error);
        }
        m->materials = materials;
    }
    status = prepare_contacts(m, &fresh);
    if (status != TL_OK) {
        tl_material_clear(&fresh);
        return status;
    }
    tl_remark_friction(m, joint, &fresh);
    tl_material_rebase(m, &fresh);
    if (place) {
        if (place->kind != fresh.kind)
            tl_material_reset(m, (uint32_t)(place - m->materials), fresh.kind);
        tl_material_clear(place);
        *place = fresh;
    } else {
        m->materials[m->material_count++] = fresh;
    }
    m->laws++;
    if (m->cycle)
        m->cycle->dt = 0;
    return TL_OK;
}
