/* import_solid.c - generator "import": blocks of the closed solids in a file that other programs have written. */
#include "solids.h"

#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>
#include <talus/version.h>

/* Default: vertices are one, and corners on their plane, within so many units of the last digit of the file. */
#define WELD_UNITS 2
#define FLAT_UNITS 2
/* Default: these bounds of both, relative to the size of an object, hold whatever the digits are. */
#define LEAST_WELD 1e-6
#define MOST_WELD 1e-3
#define LEAST_FLAT 1e-4
#define MOST_FLAT 5e-3

typedef struct params {
    const char *file;
    double scale;
    tl_vec3 translate;
    double weld, flat;
    int32_t split, skip;
    double density;
    const char *group;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, params, file, "", "file of solids: .obj, .stl, .ply, .vtk, .json or a data file of 3DEC",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_FILE),
    TL_PARAM(TL_PARAM_REAL, params, scale, "", "factor on coordinates: 0.001 for millimetres", .def = {1},
             .flags = TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_VEC3, params, translate, "m", "added to the scaled coordinates", .def = {0, 0, 0}),
    TL_PARAM(TL_PARAM_REAL, params, weld, "m",
             "vertices of an object that are nearer are one; by the digits of the file and the sizes of objects unless "
             "given",
             .flags = TL_PARAM_OPTIONAL, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, flat, "m",
             "corners of a face may be so far off its plane; by the digits of the file and the sizes of objects unless "
             "given",
             .flags = TL_PARAM_OPTIONAL, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_BOOL, params, split, "",
             "divide solids that are not convex into joined convex blocks, or refuse them", .def = {1}),
    TL_PARAM(TL_PARAM_BOOL, params, skip, "", "leave out objects that are refused, and report them, or refuse the file",
             .def = {0}),
    TL_PARAM_POSITIVE(params, density, "kg/m3", "density of the blocks"),
    TL_PARAM(TL_PARAM_STRING, params, group, "",
             "group of the blocks; \"\": as the file names them, \"rock\" where it does not", .def_text = ""),
};

static int by_size(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* The median of the diagonals of objects. */
static tl_status median_size(const soup *s, double *median)
{
    double *size = malloc((s->objects + 1) * sizeof *size);
    if (!size)
        return soup_no_memory(s);
    for (size_t i = 0; i < s->objects; i++) {
        size_t last = i + 1 < s->objects ? s->object[i + 1].face : s->faces;
        tl_vec3 min = {INFINITY, INFINITY, INFINITY}, max = tl_v3_neg(min);
        for (uint32_t h = s->start[s->object[i].face]; h < s->start[last]; h++) {
            min = tl_v3_min(min, s->vertex[s->corner[h]]);
            max = tl_v3_max(max, s->vertex[s->corner[h]]);
        }
        size[i] = last > s->object[i].face ? tl_v3_norm(tl_v3_sub(max, min)) : 0;
    }
    qsort(size, s->objects, sizeof *size, by_size);
    *median = size[s->objects / 2];
    free(size);
    return TL_OK;
}

/* A default in the units of the last digit, within its bounds relative to a size; where it is from. */
static double pick(double digits, double least, double most, const char **from)
{
    *from = digits < least ? "by the size of objects" : "by the digits of the file";
    return fmin(fmax(digits, least), most);
}

static tl_status pick_tolerances(solids *s, const params *p)
{
    double size = 0, unit = soup_resolution(&s->soup) * p->scale;
    s->weld = p->weld;
    s->flat = p->flat;
    s->weld_from = s->flat_from = "given";
    tl_status status = isnan(p->weld) || isnan(p->flat) ? median_size(&s->soup, &size) : TL_OK;
    if (isnan(p->weld))
        s->weld = pick(WELD_UNITS * unit, LEAST_WELD * size, MOST_WELD * size, &s->weld_from);
    if (isnan(p->flat))
        s->flat = pick(FLAT_UNITS * unit, LEAST_FLAT * size, MOST_FLAT * size, &s->flat_from);
    return status;
}

/* Closes all objects, and makes solids of them. */
static tl_status close_objects(solids *s)
{
    mesh m = {0};
    tl_status status = TL_OK;
    for (uint32_t i = 0; i < s->soup.objects && status == TL_OK; i++) {
        bool taken;
        status = mesh_close(s, i, &m, &taken);
        if (status == TL_OK && taken)
            status = sides_add(s, i, &m);
        if (status == TL_OK)
            status = s->host->progress(s->host, 0.5 * (double)(i + 1) / (double)s->soup.objects);
    }
    mesh_free(&m);
    soup_drop_faces(&s->soup);
    return status;
}

static tl_status make_blocks(solids *s, const params *p)
{
    for (size_t i = 0; i < s->soup.vertices; i++)
        s->soup.vertex[i] = tl_v3_madd(p->translate, p->scale, s->soup.vertex[i]);
    tl_status status = pick_tolerances(s, p);
    s->done = calloc(s->soup.objects + 1, sizeof *s->done);
    if (status == TL_OK && !s->done)
        status = soup_no_memory(&s->soup);
    if (status == TL_OK)
        status = close_objects(s);
    if (status == TL_OK)
        status = shared_find(s);
    if (status == TL_OK)
        status = planes_make(s);
    size_t before = s->host->block_count(s->host);
    if (status == TL_OK)
        status = blocks_create(s);
    if (status == TL_OK)
        status = refusals_check(s);
    return status == TL_OK ? report_write(s, s->host->block_count(s->host) - before) : status;
}

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    solids s = {.host = host,
                .soup = {.host = host, .file = p->file},
                .split = p->split != 0,
                .skip = p->skip != 0,
                .density = p->density,
                .group = p->group};
    tl_status status = soup_read(&s.soup);
    if (status == TL_OK)
        status = make_blocks(&s, p);
    soup_free(&s.soup);
    free(s.vertex);
    free(s.corner);
    free(s.start);
    free(s.side);
    free(s.plane);
    free(s.solid);
    free(s.done);
    for (size_t i = 0; i < s.refusals; i++)
        free(s.refusal[i].reason);
    free(s.refusal);
    return status;
}

static const tl_kind kind = TL_GENERATOR_KIND(
    generate, .name = "import",
    .doc = "Creates blocks of the closed solids in a file: OBJ, STL, PLY, VTK, JSON of compas, or faces of 3DEC.",
    TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(11, kind, .id = "talus.import_solid", .version = TALUS_VERSION,
                .doc = "Import of solids that other programs have written.", .licence = "BSD-3-Clause");
