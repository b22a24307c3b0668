/* my_generator.c - generator "my_generator": a wall of bricks in quarter bond.
 *
 *     course k begins at origin + (k odd ? a quarter of a brick : 0, 0, k height)
 *
 * Bricks lie along x. All blocks are made in a staging set that becomes the model when the function returns TL_OK. */
#include <talus/plugin.h>

#include <math.h>

/* What a script gives; the host fills it in from the table below, checked and with defaults. */
typedef struct params {
    tl_vec3 origin, brick;
    int64_t courses, number;
    double density;
    const char *group;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_VEC3, params, origin, "m", "lowest corner of the first brick", .def = {0, 0, 0}),
    TL_PARAM(TL_PARAM_VEC3, params, brick, "m", "length, width and height of a brick", .def = {0.4, 0.2, 0.2},
             .flags = TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_INT, params, courses, "", "courses on top of each other", .def = {4}, .min = 1, .max = 1000),
    TL_PARAM(TL_PARAM_INT, params, number, "", "bricks of a course", .def = {5}, .min = 1, .max = 1000),
    TL_PARAM(TL_PARAM_REAL, params, density, "kg/m3", "density of the bricks",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_STRING, params, group, "", "group of the bricks", .def_text = "wall"),
};

/* Every function of the host that fails has written its sentence: its status is returned at once. */
static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    for (int64_t k = 0; k < p->courses; k++) {
        double shift = k % 2 ? p->brick.x / 4 : 0;
        for (int64_t i = 0; i < p->number; i++) {
            tl_vec3 min = {p->origin.x + shift + (double)i * p->brick.x, p->origin.y,
                           p->origin.z + (double)k * p->brick.z};
            tl_vec3 max = {min.x + p->brick.x, min.y + p->brick.y, min.z + p->brick.z};
            tl_status status = host->create_box(host, min, max, p->density, p->group);
            if (status != TL_OK)
                return status;
        }
        /* shows progress, and ends when the user asks for it */
        tl_status status = host->progress(host, (double)(k + 1) / (double)p->courses);
        if (status != TL_OK)
            return status;
    }
    return TL_OK;
}

static const tl_generator_ops ops = {.size = sizeof ops, .generate = generate};

static const tl_kind kind = TL_KIND(TL_KIND_GENERATOR, ops, .name = "my_generator", .doc = "Creates a wall of bricks.",
                                    TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "example.my_generator", .version = "1.0", .doc = "Brick walls.", .licence = "BSD-3-Clause");
