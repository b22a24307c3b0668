/* lists.c - what there is in a model: joint sets, the laws that were set, groups. */
#include "model/model.h"

#include <talus/fields.h>

size_t tl_joint_count(const tl_model *m)
{
    return m->joint_count;
}

tl_joint_info tl_joint_at(const tl_model *m, size_t index)
{
    const tl_law *law = tl_law_of(m, (tl_tag){(uint32_t)index + 1, 0});
    return (tl_joint_info){.name = m->joints[index].name,
                           .planes = m->joints[index].planes,
                           .law = law ? law->kind : NULL};
}

size_t tl_law_count(const tl_model *m)
{
    return m->joint_law_count;
}

tl_law_info tl_law_at(const tl_model *m, size_t index)
{
    const tl_law *law = &m->joint_laws[index];
    return (tl_law_info){.joint = law->tag, .law = law->kind, .params = law->params};
}

size_t tl_group_count(const tl_model *m)
{
    return m->group_count;
}

const char *tl_group_name(const tl_model *m, size_t index)
{
    return m->groups[index];
}

void tl_groups_tally(tl_model *m, size_t *blocks, double *volumes)
{
    tl_rows_tidy(m);
    for (size_t i = 0; i < m->group_count; i++) {
        blocks[i] = 0;
        volumes[i] = 0;
    }
    for (size_t row = 0; row < m->blocks.table.rows; row++) {
        blocks[m->blocks.group[row]]++;
        volumes[m->blocks.group[row]] += m->blocks.volume[row];
    }
}
