/* slide.c - a program that embeds Talus: blocks, a law, steps, contacts, files for ParaView.
 *
 *     slide [FOLDER]        the folder for the files, "out" when left out
 *
 * A slab on a table, cut in two by a joint; gravity is tilted by 25 degrees instead of the table. With a friction of 40
 * degrees it comes to rest; with 15 degrees it then slides, with the acceleration
 *
 *     a = g (sin 25 - cos 25 tan 15) = 1.798 m/s2,   g = 10 m/s2
 *
 * README.md in this folder tells how to build it. */
#include <stdio.h>
#include <stdlib.h>
#include <talus/talus.h>

/* Ends the program with the model's sentence when a call has failed. */
static void must(const tl_model *model, tl_status status)
{
    if (status == TL_OK)
        return;
    fprintf(stderr, "slide: %s\n", tl_model_error(model)->text);
    exit(EXIT_FAILURE);
}

static tl_model *new_model(void)
{
    tl_error error;
    tl_model *model;
    tl_model_config config = tl_model_config_default();
    config.gravity = (tl_vec3){4.22618261740699436, 0, -9.06307787036649963}; /* 10 sin, cos 25 */
    if (tl_model_create(&config, &model, &error) != TL_OK) {
        fprintf(stderr, "slide: %s\n", error.text);
        exit(EXIT_FAILURE);
    }
    return model;
}

/* The slab, its joint, and the table, which is held. Gives the id of one of the two blocks above. */
static tl_id build(tl_model *model)
{
    must(model, tl_generate(model, "box",
                            TL_ARGS(TL_ARG_VECTOR("min", 1, 1, 1), TL_ARG_VECTOR("max", 5, 3, 2),
                                    tl_arg_number("density", 2500)),
                            NULL));
    must(model, tl_generate(model, "joint",
                            TL_ARGS(tl_arg_text("joint", "middle"), tl_arg_number("dip", 90),
                                    tl_arg_number("dip_direction", 0), TL_ARG_VECTOR("origin", 2, 2, 1)),
                            NULL));
    must(model, tl_generate(model, "box",
                            TL_ARGS(TL_ARG_VECTOR("min", 0, 0, 0), TL_ARG_VECTOR("max", 20, 4, 1),
                                    tl_arg_number("density", 2500), tl_arg_text("group", "table")),
                            NULL));
    must(model,
         tl_joint_law(model, "*", "coulomb",
                      TL_ARGS(tl_arg_number("kn", 1e9), tl_arg_number("ks", 1e9), tl_arg_number("friction", 40))));

    tl_block_filter filter = tl_block_filter_default();
    tl_id *ids;
    size_t count;
    filter.group = "table";
    must(model, tl_blocks_select(model, &filter, &ids, &count));
    must(model, tl_blocks_fix(model, ids, count, TL_FIX_ALL));
    free(ids);

    filter = tl_block_filter_default();
    filter.fixed = 0;
    must(model, tl_blocks_select(model, &filter, &ids, &count));
    tl_id above = ids[0];
    printf("%zu blocks, %zu of them free\n", tl_block_count(model), count);
    free(ids);
    return above;
}

/* A field of a block or contact by its name; the program ends when there is none. */
static size_t field_index(const tl_field *fields, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++) {
        const char *a = fields[i].name, *b = name;
        while (*a && *a == *b)
            a++, b++;
        if (*a == *b)
            return i;
    }
    fprintf(stderr, "slide: no field '%s'\n", name);
    exit(EXIT_FAILURE);
}

static double speed(tl_model *model, tl_id block)
{
    size_t count;
    const tl_field *fields = tl_block_fields(&count);
    tl_field_value v;
    must(model, tl_block_field(model, block, field_index(fields, count, "velocity"), &v));
    return v.number[0];
}

static void print_contacts(tl_model *model)
{
    size_t field_count, count;
    const tl_field *fields = tl_contact_fields(&field_count);
    size_t force = field_index(fields, field_count, "normal_force");
    tl_contact_name *contacts;
    must(model, tl_contacts_select(model, NULL, &contacts, &count));
    for (size_t i = 0; i < count; i++) {
        tl_field_value value;
        must(model, tl_contact_field(model, contacts[i], force, &value));
        printf("contact of blocks %u and %u: normal force %.0f kN\n", (unsigned)contacts[i].a, (unsigned)contacts[i].b,
               value.number[0] / 1000);
    }
    free(contacts);
}

int main(int argc, char **argv)
{
    char prefix[4096];
    snprintf(prefix, sizeof prefix, "%s/slide", argc > 1 ? argv[1] : "out");
    printf("Talus %s\n", tl_version());
    tl_plugins_load_default();
    tl_model *model = new_model();
    tl_id above = build(model);

    tl_relax relax = tl_relax_default();
    tl_relax_result found;
    relax.ratio = 1e-6;
    must(model, tl_model_relax(model, &relax, &found));
    printf("%s: %s\n", tl_solve_reason_name(found.run.reason), found.message);
    must(model, tl_write_vtk(model, prefix, NULL));

    /* `law` NULL: a change of the law there is */
    must(model, tl_joint_law(model, "*", NULL, TL_ARGS(tl_arg_number("friction", 15))));
    double t = tl_model_time(model);
    must(model, tl_model_cycle(model, 2000, NULL));
    must(model, tl_write_vtk(model, prefix, NULL));
    print_contacts(model);
    printf("acceleration %.3f m/s2, expected 1.798\n", speed(model, above) / (tl_model_time(model) - t));
    tl_model_destroy(model);
    return EXIT_SUCCESS;
}
