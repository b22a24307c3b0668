/* settings.c - tells the parameters that a model has now. */
#include "cycle/cycle_data.h"
#include "cycle/timestep.h"
#include "model/joints.h"
#include "model/scope.h"

bool tl_model_law_at(tl_model *m, size_t i, const char **joint, tl_plugin_setting *law)
{
    if (i >= m->joint_law_count)
        return false;
    const tl_scope *scope = &m->joint_laws[i].scope;
    *joint = scope->names ? tl_scope_text(m, scope, m->name) : tl_pattern_name(m, scope->tag);
    *law = (tl_plugin_setting){m->joint_laws[i].kind, m->joint_laws[i].params};
    return true;
}

bool tl_model_joint_at(tl_model *m, size_t i, const char **name, const char **ruled_by)
{
    if (i >= m->joint_count)
        return false;
    *name = m->joints[i].name;
    const tl_law *law = tl_law_of_joint(m, (tl_tag){(uint32_t)i + 1, 0});
    *ruled_by = law ? tl_pattern_name(m, law->scope.tag) : NULL;
    return true;
}

tl_plugin_setting tl_model_damping_now(const tl_model *m)
{
    return (tl_plugin_setting){m->damping, m->damping_params};
}

tl_timestep tl_model_timestep_now(const tl_model *m)
{
    tl_timestep now = m->timestep;
    now.fraction = tl_timestep_fraction(m);
    return now;
}

bool tl_model_contact_area_at(tl_model *m, size_t i, tl_contact_area *rule)
{
    if (i > m->joint_min_area_count)
        return false;
    const tl_min_area_rule *from = i ? &m->joint_min_areas[i - 1].rule : &m->min_area;
    *rule = tl_contact_area_default();
    rule->fraction = from->fraction;
    rule->absolute = from->absolute;
    rule->joint = i ? tl_pattern_name(m, m->joint_min_areas[i - 1].tag) : NULL;
    return true;
}
