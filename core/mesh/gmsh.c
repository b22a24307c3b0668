/* gmsh.c - meshes of gmsh, format 2.2 as text (gmsh reference manual, "MSH file format version 2").
 *
 *     $MeshFormat     "2.2 0 8"
 *     $PhysicalNames  count, then dimension, number and "name" of each physical group
 *     $Nodes          count, then number and three coordinates of each
 *     $Elements       count, then number, type, count of tags, tags and nodes of each; the first tag is the physical
 *                     group (0: none), the second the entity
 *
 * Of elements the tetrahedra of four nodes count (type 4). Points, lines, triangles and quadrangles are left out. */
#include "mesh/gmsh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TETRAHEDRON 4
/* Limit: tags of an element. */
#define MOST_TAGS 1000
/* Limit: numbers of nodes and elements have 32 bits. */
#define MOST_NUMBER 4294967294.0

/* Types of less than three dimensions. */
static const uint8_t flat_types[] = {1, 2, 3, 8, 9, 10, 15, 16, 20, 21, 22, 23, 24, 25, 26, 27, 28};
/* Tetrahedra of higher order. */
static const uint8_t curved_types[] = {11, 29, 30, 31};

/* Sections that tell nothing of shapes. */
static const char *const passed_over[] = {
    "Comments", "NodeData", "ElementData", "ElementNodeData", "InterpolationScheme", "Periodic", "Interpolation"};

typedef struct numbered {
    uint32_t number, index;
} numbered;

typedef struct gmsh {
    tl_mesh_reading *r;
    numbered *node; /* ascending */
    bool nodes, elements;
} gmsh;

static bool is_among(const uint8_t *list, size_t count, double type)
{
    for (size_t k = 0; k < count; k++)
        if ((double)list[k] >= type && (double)list[k] <= type)
            return true;
    return false;
}

/* ---------------------------------------------------------------- sections --------------- */

static tl_status end_section(gmsh *g, const char *end)
{
    char word[TL_MESH_WORD];
    if (!tl_mesh_word(&g->r->text, word))
        return tl_mesh_truncated(&g->r->text, end);
    if (strcmp(word, end) != 0)
        return tl_mesh_fault(&g->r->text, "%s is expected, not '%.40s'; the file is damaged", end, word);
    return TL_OK;
}

static tl_status skip_section(gmsh *g, const char *name)
{
    char word[TL_MESH_WORD], end[TL_MESH_WORD + 4] = "$End";
    strcat(end, name);
    while (tl_mesh_word(&g->r->text, word)) {
        if (strcmp(word, end) == 0)
            return TL_OK;
        tl_mesh_next_line(&g->r->text);
    }
    return tl_mesh_truncated(&g->r->text, end);
}

static tl_status read_format(gmsh *g)
{
    tl_mesh_text *t = &g->r->text;
    double version, kind, size;
    tl_status status = tl_mesh_number(t, "the version of the format", &version);
    if (status == TL_OK && !(version >= 2 && version < 3))
        return tl_mesh_fault(t, "the file is of gmsh's format %g: save it as 2.2, as by gmsh -format msh22 -save",
                             version);
    if (status == TL_OK)
        status = tl_mesh_whole_number(t, "the type of the file", 0, 1, &kind);
    if (status == TL_OK && kind > 0)
        return tl_mesh_fault(t, "the file is binary: save it as text, without -bin");
    if (status == TL_OK)
        status = tl_mesh_whole_number(t, "the size of numbers", 1, 16, &size);
    return status == TL_OK ? end_section(g, "$EndMeshFormat") : status;
}

static tl_status read_name(gmsh *g)
{
    tl_mesh_text *t = &g->r->text;
    double dimension, number;
    tl_status status = tl_mesh_whole_number(t, "the dimension of a physical group", 0, 3, &dimension);
    if (status == TL_OK)
        status = tl_mesh_whole_number(t, "the number of a physical group", 0, MOST_NUMBER, &number);
    if (status != TL_OK)
        return status;
    const char *begin = t->at;
    while (begin < t->end && *begin != '"' && *begin != '\n')
        begin++;
    const char *end = begin + (begin < t->end);
    while (end < t->end && *end != '"' && *end != '\n')
        end++;
    if (begin >= t->end || end >= t->end)
        return tl_mesh_truncated(t, "the name of a physical group in quotes");
    if (*begin != '"' || *end != '"')
        return tl_mesh_fault(t, "the name of a physical group in quotes is expected; the file is damaged");
    t->at = end + 1;
    return dimension < 3 ? TL_OK : tl_mesh_name_group(g->r, number, begin + 1, (size_t)(end - begin - 1));
}

static tl_status read_names(gmsh *g)
{
    double count;
    tl_status status = tl_mesh_whole_number(&g->r->text, "the number of physical groups", 0, MOST_NUMBER, &count);
    for (double k = 0; status == TL_OK && k < count; k++)
        status = read_name(g);
    return status == TL_OK ? end_section(g, "$EndPhysicalNames") : status;
}

/* ---------------------------------------------------------------- nodes ------------------ */

static int by_number(const void *a, const void *b)
{
    const uint32_t x = ((const numbered *)a)->number, y = ((const numbered *)b)->number;
    return (x > y) - (x < y);
}

static tl_status read_node(gmsh *g)
{
    tl_mesh_text *t = &g->r->text;
    tl_mesh *m = g->r->mesh;
    double number, x[3];
    tl_status status = tl_mesh_whole_number(t, "the number of a node", 0, MOST_NUMBER, &number);
    for (int i = 0; status == TL_OK && i < 3; i++)
        status = tl_mesh_number(t, "a coordinate of a node", &x[i]);
    if (status == TL_OK)
        status = tl_mesh_check_place(t, (tl_vec3){x[0], x[1], x[2]}, "node", (size_t)number);
    if (status != TL_OK)
        return status;
    g->node[m->point_count] = (numbered){(uint32_t)number, m->point_count};
    m->node[m->point_count] = (uint32_t)number;
    m->point[m->point_count++] = (tl_vec3){x[0], x[1], x[2]};
    return TL_OK;
}

static tl_status read_nodes(gmsh *g)
{
    tl_mesh_text *t = &g->r->text;
    tl_mesh *m = g->r->mesh;
    double count;
    if (g->nodes)
        return tl_mesh_fault(t, "$Nodes is there twice; the file is damaged");
    tl_status status = tl_mesh_whole_number(t, "the number of nodes", 1, TL_MESH_MOST, &count);
    if (status == TL_OK) /* four numbers, and a space after each */
        status = tl_mesh_room(t, count, 8, "nodes");
    if (status == TL_OK)
        status = tl_mesh_hold_points(g->r, (size_t)count);
    if (status == TL_OK)
        g->node = malloc(((size_t)count + 1) * sizeof *g->node);
    if (status == TL_OK && !g->node)
        status = tl_fail_memory(t->error);
    for (double k = 0; status == TL_OK && k < count; k++)
        status = read_node(g);
    if (status == TL_OK)
        status = end_section(g, "$EndNodes");
    if (status != TL_OK)
        return status;
    g->nodes = true;
    qsort(g->node, m->point_count, sizeof *g->node, by_number);
    for (uint32_t k = 1; k < m->point_count; k++)
        if (g->node[k].number == g->node[k - 1].number)
            return tl_mesh_fault(t, "two nodes before it have the number %u: renumber the mesh", g->node[k].number);
    return TL_OK;
}

/* ---------------------------------------------------------------- elements --------------- */

static tl_status check_type(gmsh *g, double type, double number)
{
    if (is_among(curved_types, sizeof curved_types, type))
        return tl_mesh_fault(
            &g->r->text,
            "element %.17g is a tetrahedron of higher order (type %g): save the mesh in first order, as "
            "by gmsh -order 1",
            number, type);
    return tl_mesh_fault(&g->r->text,
                         "element %.17g is of type %g: zones are tetrahedra of four nodes (type 4); mesh the volumes "
                         "with them",
                         number, type);
}

/* The index of a node by its number, or TL_MESH_NONE. */
static uint32_t find_node(const gmsh *g, uint32_t number)
{
    const numbered key = {number, 0};
    const numbered *found = bsearch(&key, g->node, g->r->mesh->point_count, sizeof *g->node, by_number);
    return found ? found->index : TL_MESH_NONE;
}

static tl_status read_corners(gmsh *g, double number, tl_mesh_key key)
{
    tl_mesh_text *t = &g->r->text;
    uint32_t corner[4];
    for (int a = 0; a < 4; a++) {
        double node;
        const tl_status status = tl_mesh_whole_number(t, "a node of a tetrahedron", 0, MOST_NUMBER, &node);
        if (status != TL_OK)
            return status;
        corner[a] = find_node(g, (uint32_t)node);
        if (corner[a] == TL_MESH_NONE)
            return tl_mesh_fault(t, "element %.17g has the node %.17g, which is not among the %u nodes", number, node,
                                 g->r->mesh->point_count);
    }
    return tl_mesh_add(g->r, corner, (uint32_t)number, (uint32_t)t->line, key);
}

static tl_status read_element(gmsh *g)
{
    tl_mesh_text *t = &g->r->text;
    double number, type, tags, tag[2] = {0, 0}; /* 0: none */
    tl_status status = tl_mesh_whole_number(t, "the number of an element", 0, MOST_NUMBER, &number);
    if (status == TL_OK)
        status = tl_mesh_whole_number(t, "the type of an element", 0, MOST_NUMBER, &type);
    if (status == TL_OK && is_among(flat_types, sizeof flat_types, type)) {
        tl_mesh_next_line(t);
        return TL_OK;
    }
    if (status == TL_OK && !(type >= TETRAHEDRON && type <= TETRAHEDRON))
        return check_type(g, type, number);
    if (status == TL_OK)
        status = tl_mesh_whole_number(t, "the number of tags", 0, MOST_TAGS, &tags);
    for (double k = 0; status == TL_OK && k < tags; k++) {
        double value;
        status = tl_mesh_number(t, "a tag of an element", &value);
        if (k < 2)
            tag[(int)k] = value;
    }
    return status == TL_OK ? read_corners(g, number, (tl_mesh_key){tag[0] > 0 ? tag[0] : -INFINITY, tag[1]}) : status;
}

static tl_status read_elements(gmsh *g)
{
    tl_mesh_text *t = &g->r->text;
    double count;
    if (!g->nodes || g->elements)
        return tl_mesh_fault(t, g->elements ? "$Elements is there twice; the file is damaged"
                                            : "$Elements comes before $Nodes; the file is damaged");
    tl_status status = tl_mesh_whole_number(t, "the number of elements", 0, TL_MESH_MOST, &count);
    if (status == TL_OK) /* number, type, no tags, a node */
        status = tl_mesh_room(t, count, 8, "elements");
    for (double k = 0; status == TL_OK && k < count; k++)
        status = read_element(g);
    g->elements = true;
    return status == TL_OK ? end_section(g, "$EndElements") : status;
}

static tl_status read_section(gmsh *g, const char *word)
{
    if (strcmp(word, "$MeshFormat") == 0)
        return read_format(g);
    if (strcmp(word, "$PhysicalNames") == 0)
        return read_names(g);
    if (strcmp(word, "$Nodes") == 0)
        return read_nodes(g);
    if (strcmp(word, "$Elements") == 0)
        return read_elements(g);
    for (size_t k = 0; *word == '$' && k < sizeof passed_over / sizeof *passed_over; k++)
        if (strcmp(word + 1, passed_over[k]) == 0)
            return skip_section(g, passed_over[k]);
    return tl_mesh_fault(&g->r->text,
                         "'%.40s' is no section of gmsh 2.2: Talus reads $MeshFormat, $PhysicalNames, $Nodes and "
                         "$Elements, and passes over $Comments, $Periodic and data",
                         word);
}

tl_status tl_mesh_read_gmsh(tl_mesh_reading *r)
{
    gmsh g = {.r = r};
    char word[TL_MESH_WORD];
    tl_status status = TL_OK;
    r->mesh->cell = "element";
    while (status == TL_OK && tl_mesh_word(&r->text, word))
        status = read_section(&g, word);
    if (status == TL_OK && !g.elements)
        status = tl_mesh_truncated(&r->text, g.nodes ? "$Elements" : "$Nodes");
    free(g.node);
    return status;
}
