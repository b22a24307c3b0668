/* walk.c - the entries of a model. */
#include "model/walk.h"

#include "base/params.h"
#include "model/functions.h"

#define VALUE(keep, member) TL_WALK_VALUE(walk, TL_KEEP_##keep, "model.", m, member)
#define FLAG(keep, member) TL_WALK_FLAG(walk, TL_KEEP_##keep, "model.", m, member)
#define LIST(keep, member, count, capacity)                                                                            \
    TL_WALK_LIST(walk, TL_KEEP_##keep, "model.", m, member, &m->count, &m->capacity, offsetof(tl_memory, other))

tl_settings tl_config_settings(void)
{
    tl_settings of = {.prefix = "model.config.", .offset = offsetof(tl_model, config)};
    of.params = tl_function_params("model", &of.count, NULL);
    return of;
}

tl_settings tl_timestep_settings(void)
{
    tl_settings of = {.prefix = "model.timestep.", .offset = offsetof(tl_model, timestep)};
    of.params = tl_function_params("timestep", &of.count, NULL);
    return of;
}

void *tl_setting_at(const tl_model *m, const tl_settings *of, size_t i)
{
    const tl_param *param = &of->params[i];
    char *owner = (char *)(uintptr_t)m + of->offset;
    return param->flags & TL_PARAM_PASSING ? NULL : owner + param->offset;
}

static void walk_struct(const tl_model *m, tl_settings of, const tl_walk *walk)
{
    for (size_t i = 0; i < of.count; i++) {
        const tl_entry entry = {.prefix = of.prefix,
                                .name = of.params[i].name,
                                .form = TL_ENTRY_VALUE,
                                .keep = TL_KEEP_STATE,
                                .at = tl_setting_at(m, &of, i),
                                .size = tl_param_bytes(of.params[i].type)};
        if (entry.at)
            walk->visit(walk->user, &entry);
    }
}

static void walk_settings(tl_model *m, const tl_walk *walk)
{
    walk_struct(m, tl_config_settings(), walk);
    VALUE(STATE, min_area);
    LIST(STATE, joint_min_areas, joint_min_area_count, joint_min_area_count);
    walk_struct(m, tl_timestep_settings(), walk);
    FLAG(STATE, mass_scaling);
    FLAG(STATE, relaxing);
    VALUE(STATE, still);
    VALUE(STATE, added_dt);
    VALUE(STATE, added_most);
    VALUE(STATE, said);
    VALUE(CACHE, remarked);
    VALUE(CACHE, stage);
}

void tl_model_walk(tl_model *m, const tl_walk *walk)
{
    walk_settings(m, walk);
    VALUE(STATE, origin);
    FLAG(STATE, origin_set);
    VALUE(STATE, next_id);
    VALUE(STATE, time);
    VALUE(STATE, dt);
    VALUE(STATE, gravity_before);
    FLAG(STATE, gravity_changed);
    FLAG(STATE, loads_changed);
    VALUE(STATE, cycles);
    VALUE(CACHE, gone);
    VALUE(CACHE, structure);
    VALUE(CACHE, constraints);
    VALUE(CACHE, laws);
    VALUE(CACHE, rules);
    tl_walk_table(walk, TL_KEEP_STATE, "blocks", &m->blocks.table, offsetof(tl_memory, blocks));
    tl_walk_table(walk, TL_KEEP_STATE, "bodies", &m->bodies.table, offsetof(tl_memory, bodies));
    LIST(DERIVED, members, member_capacity, member_capacity);
    VALUE(STATE, record.cuts);
    VALUE(STATE, record.refused);
    VALUE(STATE, record.coincident);
    VALUE(STATE, record.created);
    VALUE(STATE, record.deleted);
    LIST(STATE, record.list, record.listed, record.listed);
    LIST(STATE, cut_parts, cut_part_count, cut_part_capacity);
    LIST(STATE, splits, split_count, split_capacity);
    LIST(STATE, cut_out, cut_out_count, cut_out_capacity);
    LIST(STATE, face_loads, face_load_count, face_load_capacity);
    LIST(STATE, seats.list, seats.count, seats.capacity);
    FLAG(CACHE, extremes.known);
    VALUE(CACHE, extremes.total);
    VALUE(CACHE, extremes.volume);
    VALUE(CACHE, extremes.edge);
    VALUE(CACHE, extremes.face);
}
