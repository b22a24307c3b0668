/* joints.c - names of groups and joint sets, and which rule holds for which joint. */
#include "model/joints.h"

#include "base/hash.h"
#include "base/inside.h"
#include "model/options.h"
#include "model/rows.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/fields.h>

/* The slot at which the search for a name begins. */
static size_t group_slot(const tl_group_index *index, const char *name)
{
    tl_hash hash = tl_hash_start();
    tl_hash_bytes(&hash, name, strlen(name));
    return (size_t)hash.a & (index->slots - 1);
}

/* Enters a group in the first free slot; there is one. */
static void enter_group(tl_group_index *index, const char *name, size_t group)
{
    size_t at = group_slot(index, name);
    while (index->slot[at])
        at = (at + 1) & (index->slots - 1);
    index->slot[at] = (uint32_t)group + 1;
    index->used++;
}

/* Keeps at least half of the slots free, with those of groups that are gone left out. */
static bool reserve_group_slot(tl_model *m)
{
    tl_group_index *index = &m->group_index;
    if (2 * (index->used + 1) <= index->slots)
        return true;
    tl_group_index wider = {.slots = 16};
    while (wider.slots < 4 * (m->group_count + 1))
        wider.slots *= 2;
    wider.slot = calloc(wider.slots, sizeof *wider.slot);
    if (!wider.slot)
        return false;
    for (size_t i = 0; i < m->group_count; i++)
        enter_group(&wider, m->groups[i], i);
    free(index->slot);
    *index = wider;
    return true;
}

uint32_t tl_group_intern(tl_model *m, const char *name)
{
    if (!reserve_group_slot(m))
        return UINT32_MAX;
    const tl_group_index *index = &m->group_index;
    for (size_t at = group_slot(index, name); index->slot[at]; at = (at + 1) & (index->slots - 1)) {
        uint32_t group = index->slot[at] - 1;
        if (group < m->group_count && strcmp(m->groups[group], name) == 0)
            return group;
    }
    char *copy = strdup(name);
    char **groups = realloc(m->groups, (m->group_count + 1) * sizeof *groups);
    if (groups)
        m->groups = groups;
    if (!copy || !groups) {
        free(copy);
        return UINT32_MAX;
    }
    m->groups[m->group_count] = copy;
    enter_group(&m->group_index, name, m->group_count);
    return (uint32_t)m->group_count++;
}

uint32_t tl_joint_find(const tl_model *m, const char *name)
{
    for (size_t i = 0; i < m->joint_count; i++)
        if (strcmp(m->joints[i].name, name) == 0)
            return (uint32_t)i + 1;
    return 0;
}

uint32_t tl_joint_intern(tl_model *m, const char *name)
{
    uint32_t found = tl_joint_find(m, name);
    if (found)
        return found;
    char *copy = strdup(name);
    tl_joint_set *joints = realloc(m->joints, (m->joint_count + 1) * sizeof *joints);
    if (joints)
        m->joints = joints;
    if (!copy || !joints) {
        free(copy);
        return 0;
    }
    m->joints[m->joint_count++] = (tl_joint_set){copy, 0};
    return (uint32_t)m->joint_count;
}

/* "unknown joint 'J9'; the model has 'J1', 'J2'" */
static tl_status unknown_joint(tl_model *m, const char *text)
{
    if (m->joint_count == 0)
        return tl_fail(&m->error, TL_E_NOT_FOUND,
                       "unknown joint '%s': the model has no joints yet; generate them first, or "
                       "use \"*\" for every contact",
                       text);
    const char **names = malloc((m->joint_count + 1) * sizeof *names);
    if (!names)
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < m->joint_count; i++)
        names[i] = m->joints[i].name;
    names[m->joint_count] = NULL;
    const char *nearest = tl_nearest_name(text, names, m->joint_count);
    tl_fail(&m->error, TL_E_NOT_FOUND, "unknown joint '%s'; %s '%s' (or use \"*\" for every contact)", text,
            nearest ? "did you mean" : "the first of the model's joints is", nearest ? nearest : names[0]);
    free(names);
    return m->error.status;
}

/* The plane number after the colon: digits only, from 1; 0 when it is none. */
static uint32_t plane_number(const char *digits)
{
    char *end;
    if (*digits < '0' || *digits > '9')
        return 0;
    unsigned long number = strtoul(digits, &end, 10);
    return *end == '\0' && number < UINT32_MAX ? (uint32_t)number : 0;
}

tl_status tl_joint_parse(tl_model *m, const char *text, tl_tag *tag)
{
    *tag = (tl_tag){0, 0};
    if (strcmp(text, "*") == 0)
        return TL_OK;
    tag->joint = tl_joint_find(m, text);
    if (tag->joint)
        return TL_OK;
    const char *colon = strrchr(text, ':');
    if (!colon)
        return unknown_joint(m, text);
    char *name = strndup(text, (size_t)(colon - text));
    if (!name)
        return tl_fail_memory(&m->error);
    tag->joint = tl_joint_find(m, name);
    tl_status status = tag->joint ? TL_OK : unknown_joint(m, name);
    free(name);
    if (status != TL_OK)
        return status;
    tag->plane = plane_number(colon + 1);
    uint32_t planes = m->joints[tag->joint - 1].planes;
    if (tag->plane < 1 || tag->plane > planes)
        return tl_fail(&m->error, TL_E_NOT_FOUND, "unknown plane '%s': joint '%s' has planes 1 to %u", text,
                       m->joints[tag->joint - 1].name, planes);
    return TL_OK;
}

bool tl_tag_matches(tl_tag pattern, tl_tag tag)
{
    return pattern.joint == 0 || (pattern.joint == tag.joint && (pattern.plane == 0 || pattern.plane == tag.plane));
}

tl_min_area_rule tl_min_area_of(const tl_model *m, tl_tag tag)
{
    tl_min_area_rule rule = m->min_area;
    int best = 0;
    for (size_t i = 0; i < m->joint_min_area_count; i++)
        if (tl_tag_matches(m->joint_min_areas[i].tag, tag) && tl_tag_closeness(m->joint_min_areas[i].tag) > best) {
            best = tl_tag_closeness(m->joint_min_areas[i].tag);
            rule = m->joint_min_areas[i].rule;
        }
    return rule;
}

const char *tl_pattern_name(tl_model *m, tl_tag tag)
{
    if (tag.joint == 0)
        return "*";
    return tag.plane == 0 ? m->joints[tag.joint - 1].name : tl_tag_name(m, tag);
}

const char *tl_tag_name(tl_model *m, tl_tag tag)
{
    static const char none[] = "";
    if (tag.joint == 0)
        return none;
    snprintf(m->name, sizeof m->name, "%s:%u", m->joints[tag.joint - 1].name, tag.plane);
    return m->name;
}

/* Puts the rule of a joint in the place of the one it has, or adds it; false when out of memory. */
static bool set_joint_area(tl_model *m, const tl_joint_min_area *entry)
{
    for (size_t i = 0; i < m->joint_min_area_count; i++)
        if (m->joint_min_areas[i].tag.joint == entry->tag.joint &&
            m->joint_min_areas[i].tag.plane == entry->tag.plane) {
            m->joint_min_areas[i] = *entry;
            return true;
        }
    tl_joint_min_area *joint_min_areas =
        realloc(m->joint_min_areas, (m->joint_min_area_count + 1) * sizeof *joint_min_areas);
    if (!joint_min_areas)
        return false;
    m->joint_min_areas = joint_min_areas;
    m->joint_min_areas[m->joint_min_area_count++] = *entry;
    return true;
}

tl_status tl_model_contact_area(tl_model *m, const tl_contact_area *given)
{
    tl_contact_area read;
    const tl_contact_area *area = &read;
    tl_status status = TL_OPTIONS_READ(tl_contact_area, given, &read, &m->error);
    if (status == TL_OK)
        status = tl_model_may_set(m, "set contact_area");
    if (status != TL_OK)
        return status;
    if (!(area->fraction >= 0) || !isfinite(area->fraction))
        return tl_fail(&m->error, TL_E_ARGUMENT, "contact_area: fraction = %g must be >= 0", area->fraction);
    if (!isnan(area->absolute) && !(area->absolute >= 0 && isfinite(area->absolute)))
        return tl_fail(&m->error, TL_E_ARGUMENT, "contact_area: absolute = %g must be >= 0", area->absolute);
    if (!isnan(area->absolute) && area->fraction != TL_AREA_FRACTION)
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "contact_area: fraction = %g and absolute = %g m2 are both given: give one", area->fraction,
                       area->absolute);
    tl_joint_min_area entry = {.rule = {area->fraction, area->absolute}};
    status = tl_joint_parse(m, area->joint ? area->joint : "*", &entry.tag);
    if (status != TL_OK)
        return status;
    if (entry.tag.joint == 0)
        m->min_area = entry.rule;
    else if (!set_joint_area(m, &entry))
        return tl_fail_memory(&m->error);
    m->laws++;
    m->rules++;
    return TL_OK;
}

/* ---------------------------------------------------------------- what there is ----------- */

size_t tl_joint_count(const tl_model *m)
{
    return m->joint_count;
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
