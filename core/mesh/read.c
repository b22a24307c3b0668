/* read.c - reads the tetrahedra of a file, and tells what is wrong with them. */
#include "mesh/read.h"

#include "base/file_bytes.h"
#include "base/table.h"
#include "geometry/measure.h"
#include "mesh/gmsh.h"
#include "mesh/pair.h"
#include "mesh/vtk.h"

#include <stdlib.h>
#include <string.h>
#include <talus/number.h>
#include <talus/vmath.h>

/* Limit: larger files are refused. Points are numbered in 32 bits. */
#define MOST_BYTES ((size_t)8 << 30)
/* Tolerance: a tetrahedron is flat when its least altitude is below this times its longest edge. The roundings of
 * coordinates in single precision are as large in a mesh that is fine beside its place. */
#define FLAT 1e-9

/* ---------------------------------------------------------------- regions ---------------- */

typedef struct keyed {
    tl_mesh_key key;
    uint32_t zone;
} keyed;

static int compare_keys(const tl_mesh_key *a, const tl_mesh_key *b)
{
    const int by_group = (a->group > b->group) - (a->group < b->group);
    return by_group ? by_group : (a->part > b->part) - (a->part < b->part);
}

static int by_key(const void *a, const void *b)
{
    const keyed *x = a, *y = b;
    const int order = compare_keys(&x->key, &y->key);
    return order ? order : (x->zone > y->zone) - (x->zone < y->zone);
}

static int by_name(const void *a, const void *b)
{
    const double x = ((const tl_mesh_name *)a)->group, y = ((const tl_mesh_name *)b)->group;
    return (x > y) - (x < y);
}

/* The name of a group: that of the file, or its number. NULL: out of memory. */
static char *name_of(const tl_mesh_reading *r, double group)
{
    char number[40] = "";
    const char *text = number;
    if (group >= -INT32_MAX)
        tl_text_print(number, sizeof number, "%.17g", group);
    const tl_mesh_name wanted = {group, NULL};
    const tl_mesh_name *found =
        r->name_count > 0 ? bsearch(&wanted, r->name, r->name_count, sizeof wanted, by_name) : NULL;
    text = found ? found->text : text;
    char *copy = malloc(strlen(text) + 1);
    if (copy)
        strcpy(copy, text);
    return copy;
}

/* Numbers the regions in the order of their keys. */
static tl_status find_regions(tl_mesh_reading *r)
{
    tl_mesh *m = r->mesh;
    keyed *list = malloc(((size_t)m->zone_count + 1) * sizeof *list);
    uint32_t count = 0;
    m->region = malloc(((size_t)m->zone_count + 1) * sizeof *m->region);
    for (uint32_t z = 0; list && z < m->zone_count; z++)
        list[z] = (keyed){r->key[z], z};
    if (list)
        qsort(list, m->zone_count, sizeof *list, by_key);
    if (r->name_count > 0)
        qsort(r->name, r->name_count, sizeof *r->name, by_name);
    for (uint32_t k = 0; list && m->region && k < m->zone_count; k++) {
        count += k == 0 || compare_keys(&list[k - 1].key, &list[k].key) != 0;
        m->region[list[k].zone] = count - 1;
    }
    m->group = calloc((size_t)count + 1, sizeof *m->group);
    bool enough = list && m->region && m->group;
    for (uint32_t k = 0; enough && k < m->zone_count; k++)
        if (!m->group[m->region[list[k].zone]]) {
            m->group[m->region_count++] = name_of(r, list[k].key.group);
            enough = m->group[m->region_count - 1] != NULL;
        }
    free(list);
    return enough ? TL_OK : tl_fail_memory(r->text.error);
}

/* ---------------------------------------------------------------- tetrahedra ------------- */

static tl_status check_zone(const tl_mesh *m, uint32_t zone, tl_error *error)
{
    char where[TL_MESH_WHERE];
    tl_vec3 x[4];
    double longest2 = 0, largest2 = 0;
    for (int a = 0; a < 4; a++)
        x[a] = m->point[m->zone[zone][a]];
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < a; b++)
            longest2 = fmax(longest2, tl_v3_norm2(tl_v3_sub(x[a], x[b])));
    for (int a = 0; a < 4; a++) {
        const uint8_t *s = tl_mesh_side[a];
        largest2 = fmax(largest2, tl_v3_norm2(tl_v3_cross(tl_v3_sub(x[s[1]], x[s[0]]), tl_v3_sub(x[s[2]], x[s[0]]))));
    }
    const double volume = tl_tetrahedron_volume(x), altitude = largest2 > 0 ? 6 * volume / sqrt(largest2) : 0;
    if (altitude > FLAT * sqrt(longest2))
        return TL_OK;
    if (altitude < -FLAT * sqrt(longest2))
        return tl_fail(
            error, TL_E_GEOMETRY,
            "%s is turned inside out: its volume is %.6g m3; give its corners the other way round, or mend the "
            "mesh",
            tl_mesh_where(m, zone, where), volume);
    return tl_fail(
        error, TL_E_GEOMETRY,
        "%s is flat: its altitude is %.3g m, its longest edge %.6g m; mend the mesh, or move it nearer to the "
        "origin",
        tl_mesh_where(m, zone, where), altitude, sqrt(longest2));
}

static tl_status check_zones(const tl_mesh *m, tl_error *error)
{
    tl_status status = TL_OK;
    if (m->zone_count == 0)
        return tl_fail(error, TL_E_GEOMETRY,
                       "file '%.200s' has no tetrahedra: mesh the volumes, and save them with their elements", m->file);
    for (uint32_t z = 0; status == TL_OK && z < m->zone_count; z++)
        status = check_zone(m, z, error);
    return status;
}

/* ---------------------------------------------------------------- the file --------------- */

static tl_status read_format(tl_mesh_reading *r)
{
    static const char vtk[] = "# vtk DataFile", gmsh[] = "$MeshFormat", vtu[] = "<";
    const char *at = r->text.at;
    if (strncmp(at, vtk, sizeof vtk - 1) == 0)
        return tl_mesh_read_vtk(r);
    if (strncmp(at, gmsh, sizeof gmsh - 1) == 0 || strncmp(at, "$Comments", 9) == 0)
        return tl_mesh_read_gmsh(r);
    if (strncmp(at, vtu, sizeof vtu - 1) == 0)
        return tl_fail(r->text.error, TL_E_GEOMETRY, "file '%.200s' is XML: save it as legacy VTK, or as gmsh 2.2",
                       r->text.file);
    return tl_fail(r->text.error, TL_E_GEOMETRY,
                   "file '%.200s' is no mesh that Talus knows: legacy VTK begins with '# vtk DataFile', gmsh 2.2 with "
                   "'$MeshFormat'",
                   r->text.file);
}

tl_status tl_mesh_read(const char *file, tl_mesh *mesh, tl_error *error)
{
    char *bytes = NULL;
    size_t count = 0;
    *mesh = (tl_mesh){.file = file};
    tl_status status = tl_file_read(file, MOST_BYTES, &bytes, &count, error);
    if (status == TL_OK) {
        tl_mesh_reading r = {.text = {.file = file, .at = bytes, .end = bytes + count, .line = 1, .error = error},
                             .mesh = mesh};
        status = read_format(&r);
        if (status == TL_OK)
            status = check_zones(mesh, error);
        if (status == TL_OK)
            status = find_regions(&r);
        for (size_t k = 0; k < r.name_count; k++)
            free(r.name[k].text);
        free(r.name);
        free(r.key);
    }
    free(bytes);
    return status;
}

void tl_mesh_free(tl_mesh *m)
{
    free(m->point);
    free(m->node);
    free(m->zone);
    free(m->number);
    free(m->line);
    free(m->region);
    for (uint32_t k = 0; m->group && k < m->region_count; k++)
        free(m->group[k]);
    free(m->group);
    *m = (tl_mesh){0};
}
