/* scene_head.c - HEAD: what does not change with the blocks, as JSON. */
#include "base/params.h"
#include "io/json.h"
#include "io/scene_parts.h"

#include <string.h>

static void put_vector(tl_piece *to, tl_vec3 v)
{
    const double numbers[3] = {v.x, v.y, v.z};
    for (int i = 0; i < 3; i++) {
        tl_json_put(to, i ? ", " : "[");
        tl_json_number(to, numbers[i]);
    }
    tl_json_put(to, "]");
}

/* "name": NAME, "unit": UNIT */
static void put_named(tl_piece *to, const char *name, const char *unit)
{
    tl_json_put(to, "\"name\": ");
    tl_json_text(to, name);
    tl_json_put(to, ", \"unit\": ");
    tl_json_text(to, unit ? unit : "");
}

static void put_fields(tl_piece *to, const tl_html *options)
{
    size_t blocks = options->block_field_count, count = blocks + options->contact_field_count;
    tl_json_put(to, ", \"fields\": [");
    for (size_t i = 0; i < count; i++) {
        const tl_extra_field *field =
            i < blocks ? &options->block_fields[i] : &options->contact_fields[i - blocks];
        tl_json_put(to, i ? ", {" : "{");
        put_named(to, field->name, field->unit);
        tl_json_put(to, i < blocks ? ", \"of\": \"blocks\"}" : ", \"of\": \"contacts\"}");
    }
    tl_json_put(to, "]");
}

/* A list that is begun, of named things with units. */
typedef struct list {
    tl_piece *to;
    bool begun;
} list;

static void put_history(void *user, const char *name, const char *unit, double value)
{
    (void)value;
    list *l = user;
    tl_json_put(l->to, l->begun ? ", {" : "{");
    put_named(l->to, name, unit);
    tl_json_put(l->to, "}");
    l->begun = true;
}

/* The friction angle of a law, degrees; NaN where it has none. */
static double friction_of(const tl_law *law)
{
    for (uint32_t i = 0; law && i < law->kind->param_count; i++) {
        tl_param p = tl_param_row(law->kind->params, i, law->kind->param_stride);
        double value;
        if (p.type != TL_PARAM_REAL || strcmp(p.name, "friction") != 0 ||
            strcmp(p.unit, "deg") != 0)
            continue;
        memcpy(&value, (const char *)law->params + p.offset, sizeof value);
        return value;
    }
    return NAN;
}

/* That of all planes of a joint; NaN where they differ. */
static double friction_of_joint(const tl_model *m, uint32_t joint)
{
    double friction = friction_of(tl_law_of(m, (tl_tag){joint, 0}));
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const tl_law *law = &m->joint_laws[i];
        if (law->tag.joint == joint && law->tag.plane != 0 && !(friction_of(law) == friction))
            return NAN;
    }
    return friction;
}

static void put_friction(tl_piece *to, const tl_model *m)
{
    tl_json_put(to, ", \"friction\": [null");
    for (size_t i = 0; i < m->joint_count; i++) {
        double friction = friction_of_joint(m, (uint32_t)i + 1);
        tl_json_put(to, ", ");
        if (isfinite(friction))
            tl_json_number(to, friction);
        else
            tl_json_put(to, "null");
    }
    tl_json_put(to, "]");
}

void tl_scene_head(const tl_model *m, const tl_html *options, const tl_scene *scene, tl_piece *text)
{
    text->length = 0;
    tl_json_put(text, "{\"format\": 1, \"program\": \"Talus " TALUS_VERSION "\", \"title\": ");
    tl_json_text(text, options->title ? options->title : "");
    tl_json_put(text, ", \"origin\": ");
    put_vector(text, m->origin);
    tl_json_put(text, ", \"gravity\": ");
    put_vector(text, m->config.gravity);
    tl_json_put(text, ", \"size\": ");
    tl_json_number(text, scene->next.median);
    if (options->safety_limit > 0) {
        tl_json_put(text, ", \"safety_limit\": ");
        tl_json_number(text, options->safety_limit);
    }
    tl_json_put(text, ", \"groups\": [");
    for (size_t i = 0; i < m->group_count; i++) {
        tl_json_put(text, i ? ", " : "");
        tl_json_text(text, m->groups[i]);
    }
    tl_json_put(text, "], \"joints\": [\"\"");
    for (size_t i = 0; i < m->joint_count; i++) {
        tl_json_put(text, ", ");
        tl_json_text(text, m->joints[i].name);
    }
    tl_json_put(text, "]");
    put_friction(text, m);
    put_fields(text, options);
    tl_json_put(text, ", \"histories\": [");
    tl_scene_histories(m, put_history, &(list){text, false});
    tl_json_put(text, "]");
    if (scene->live)
        tl_json_put(text, ", \"live\": true");
    if (scene->live == TL_SCENE_COMMANDS)
        tl_json_put(text, ", \"commands\": true");
    tl_json_put(text, "}");
}
