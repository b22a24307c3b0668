/* liner.c - element "liner": shotcrete on outer faces of blocks.
 *
 * A liner is a shell of flat triangles (facet.c) that springs hold to the rock, the bond: one at each corner of each
 * triangle, for a third of its area (shell.c). At a joint the triangles of both blocks share their nodes, so the shell
 * bridges the joint. One call makes patches, of 1024 triangles at most; each is an element. Between two patches the
 * liner has a joint of its own.
 *
 * A corner debonds for good where the tension or the shear of its bond passes the strength; then it bears only what
 * presses, without friction. A triangle cracks where the tensile stress on one of its faces passes the strength of the
 * liner; then it bears no moment. Where the mean stress over the thickness passes it, it is cracked through and bears
 * nothing. What fails in a step does so worst first, until the rest holds. */
#include "mesh.h"
#include "shell.h"

#include <talus/kit.h>
#include <talus/version.h>

#include <float.h>

/* Constant: of the largest overload, the part from which on others fail with it. The matrix is factorised after each
 * such round. */
#define TOGETHER 0.8
/* Cost only: rounds in which all corners that are wrong begin or end to press at once though they become no fewer. */
#define PATIENCE 3
/* Limit: times that one corner begins to press by itself before something fails. Where a part of the shell is loose,
 * where it lies is of no account, and nothing tells whether it presses. */
#define PRESSES 2
/* Limit: triangles of one call. */
#define MOST_TRIANGLES 1e6
/* Tolerance: distance beyond a side of a face, over the length of one, that is rounding. Test:
 * lua/test_liners_at_random. */
#define ROUNDING 1e-9
/* Constant: area of a triangle over the square of the spacing, about. */
#define TRIANGLE 0.15
/* Tolerance: distance of a point from the face that it means, over the root of that face's area. Test:
 * lua/test_liner. */
#define ON_FACE 1e-3

/* Tolerance: part of the area that triangles may leave bare, of faces too small for any. Test: lua/test_liner. */
#define BARE 0.1

typedef struct params {
    tl_vec3 facing;
    tl_points faces;
    const char *rock;
    double within, thickness, young, poisson, tension;
    double bond_stiffness, bond_shear_stiffness, bond_strength, bond_shear_strength, spacing;
} params;

#define PLACED TL_PARAM_PLACE
#define REAL(member, unit, doc, least, most, more, ...)                                                                \
    TL_PARAM(TL_PARAM_REAL, params, member, unit, doc, .min = (least), .max = (most), .flags = (more), __VA_ARGS__)

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_VEC3, params, facing, "", "Outer faces that look this way are lined; without it, all.",
             .flags = PLACED),
    REAL(within, "deg", "So far their normals may be from that.", 0, 180, PLACED, .def = {45}),
    TL_PARAM(TL_PARAM_STRING, params, rock, "", "Group of the blocks that are lined; without it, all.",
             .flags = TL_PARAM_OPTIONAL | PLACED),
    TL_PARAM(TL_PARAM_POINTS, params, faces, "m", "Points, one on each face that is lined; without it, all of those.",
             .flags = TL_PARAM_OPTIONAL | PLACED),
    REAL(thickness, "m", "Of the liner.", 0, 10, TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .alias = NULL),
    REAL(young, "Pa", "Young's modulus of the liner.", 1e5, 1e13, 0, .def = {20e9}),
    REAL(poisson, "", "Poisson's ratio of the liner.", 0, 0.5, TL_PARAM_MAX_OPEN, .def = {0.2}),
    REAL(tension, "Pa", "Tensile strength of the liner.", 0, 1e12, TL_PARAM_STRENGTH, .def = {2e6}),
    REAL(bond_stiffness, "Pa/m", "Of the bond, across it.", 1e3, 1e15, 0, .def = {1e10}),
    REAL(bond_shear_stiffness, "Pa/m", "Along it; without it, the same.", 1e3, 1e15, TL_PARAM_OPTIONAL, .alias = NULL),
    REAL(bond_strength, "Pa", "Tension at which the bond fails.", 0, 1e12, TL_PARAM_STRENGTH, .def = {5e5}),
    REAL(bond_shear_strength, "Pa", "Shear at which it fails; without it, the same.", 0, 1e12,
         TL_PARAM_STRENGTH | TL_PARAM_OPTIONAL, .alias = NULL),
    REAL(spacing, "m", "Length of the sides of triangles, at most; without it, that over which the bond bears.", 1e-4,
         1e6, PLACED | TL_PARAM_OPTIONAL, .alias = NULL)};

enum { NUMBER, BONDED, PRESSED, BOND_TENSION, BOND_SHEAR, THRUST, PULL, MOMENT, STRESS, TORN, NODE_STATES };
enum { MOST_THRUST, MOST_MOMENT, DEBONDED, CRACKED };

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "shell", "", "number of the node of the shell, from 0"),
    TL_STATE(TL_STATE_SCALAR, "bonded", "", "1: the bond holds here", .initial = 1),
    TL_STATE(TL_STATE_SCALAR, "pressed", "", "1: debonded, and the liner presses on the rock here"),
    TL_STATE(TL_STATE_SCALAR, "bond_tension", "Pa", "of the bond, pressure negative"),
    TL_STATE(TL_STATE_SCALAR, "bond_shear", "Pa", "of the bond"),
    TL_STATE(TL_STATE_SCALAR, "thrust", "N/m", "largest pressure in the plane of the triangle"),
    TL_STATE(TL_STATE_SCALAR, "pull", "N/m", "largest tension in the plane of the triangle; below 0 there is none"),
    TL_STATE(TL_STATE_SCALAR, "moment", "N", "largest bending moment of the triangle for each metre, N m/m"),
    TL_STATE(TL_STATE_SCALAR, "stress", "Pa", "largest tensile stress on the faces of the triangle"),
    TL_STATE(TL_STATE_SCALAR, "torn", "", "1: the triangle is cracked on one face; 2: through"),
    TL_STATE(TL_STATE_WHOLE, "most_thrust", "N/m", "largest thrust of a triangle"),
    TL_STATE(TL_STATE_WHOLE, "most_moment", "N", "largest moment of a triangle, N m/m"),
    TL_STATE(TL_STATE_WHOLE, "debonded", "m2", "area where the bond has failed"),
    TL_STATE(TL_STATE_WHOLE, "cracked", "m2", "area of the triangles that are cracked, on one face or through")};

static double or_else(double given, double other)
{
    return isnan(given) ? other : given;
}

static shell_material material_of(const params *p)
{
    const double plate = p->young * p->thickness / (1 - p->poisson * p->poisson);
    return (shell_material){.facet = {plate, plate * p->thickness * p->thickness / 12, p->poisson},
                            .thickness = p->thickness,
                            .normal = p->bond_stiffness,
                            .shear = or_else(p->bond_shear_stiffness, p->bond_stiffness)};
}

/* Length in which a load on the edge of the liner dies out: (4 D / kn)^(1/4), with its bending stiffness D. */
static double spacing_of(const params *p)
{
    return or_else(p->spacing, sqrt(sqrt(4 * material_of(p).facet.bending / p->bond_stiffness)));
}

/* ---------------------------------------------------------------- placing ---------------- */

static double area_of(const tl_element_face *f)
{
    tl_vec3 sum = {0, 0, 0};
    for (size_t i = 1; i + 1 < f->corner_count; i++)
        sum = tl_v3_add(
            sum, tl_v3_cross(tl_v3_sub(f->corners[i], f->corners[0]), tl_v3_sub(f->corners[i + 1], f->corners[0])));
    return 0.5 * tl_v3_norm(sum);
}

/* How far a point in the plane of a face lies beyond its side i, whose outward normal is `out`. */
static double beyond(const tl_element_face *f, size_t i, tl_vec3 x, tl_vec3 *out)
{
    const tl_vec3 a = f->corners[i], way = tl_v3_sub(f->corners[(i + 1) % f->corner_count], a);
    *out = tl_v3_unit(tl_v3_cross(way, f->normal));
    return tl_v3_dot(*out, tl_v3_sub(x, a));
}

/* The place on a face for a point a little beside it, as nodes of the mesh may be: on the side that it lies beyond, or
 * the nearest corner. */
static tl_vec3 onto(const tl_element_face *f, tl_vec3 x)
{
    x = tl_v3_madd(x, -tl_v3_dot(f->normal, tl_v3_sub(x, f->corners[0])), f->normal);
    tl_vec3 at = x, out, nearest = f->corners[0];
    double most = 0;
    for (size_t i = 0; i < f->corner_count; i++) {
        const double far = beyond(f, i, at, &out);
        at = far > 0 ? tl_v3_madd(at, -far, out) : at;
    }
    for (size_t i = 0; i < f->corner_count; i++) {
        most = fmax(most, beyond(f, i, at, &out));
        const bool nearer = tl_v3_norm2(tl_v3_sub(f->corners[i], x)) < tl_v3_norm2(tl_v3_sub(nearest, x));
        nearest = nearer ? f->corners[i] : nearest;
    }
    return most <= ROUNDING * tl_v3_norm(tl_v3_sub(f->corners[1], f->corners[0])) ? at : nearest;
}

/* Whether one of the points lies on a face; notes which have found theirs. */
static bool is_meant(const tl_points *points, const tl_element_face *f, unsigned char *found)
{
    const double near = ON_FACE * sqrt(area_of(f));
    bool any = points->count == 0;
    for (size_t i = 0; i < points->count; i++)
        if (tl_v3_norm(tl_v3_sub(onto(f, points->at[i]), points->at[i])) <= near) {
            found[i] = 1;
            any = true;
        }
    return any;
}

static double area_of_triangle(const mesh *m, const mesh_triangle *t)
{
    const tl_vec3 a = m->at[t->node[0]];
    return 0.5 * tl_v3_norm(tl_v3_cross(tl_v3_sub(m->at[t->node[1]], a), tl_v3_sub(m->at[t->node[2]], a)));
}

static tl_status add_patch(const tl_element_host *host, const mesh *m, const tl_element_face *faces, size_t patch)
{
    tl_element_node nodes[TL_ELEMENT_MANY];
    uint32_t number[TL_ELEMENT_MANY];
    double state[TL_ELEMENT_MANY][NODE_STATES] = {{0}};
    const size_t begin = m->patch[patch], count = 3 * (m->patch[patch + 1] - begin);
    if (!mesh_number(m, patch, number))
        return host->fail(host, TL_E_MEMORY, "out of memory");
    for (size_t k = 0; k < count; k++) {
        const mesh_triangle *t = &m->of[begin + k / 3];
        const tl_element_face *f = &faces[t->face];
        const double share = area_of_triangle(m, t) / 3;
        nodes[k] = (tl_element_node){f->block, onto(f, m->at[t->node[k % 3]]), f->normal, share};
        state[k][NUMBER] = number[k];
        state[k][BONDED] = 1;
    }
    return host->add(host, &(tl_new_element){
                               .size = sizeof(tl_new_element), .nodes = nodes, .count = count, .node_state = state[0]});
}

static tl_status cover(const tl_element_host *host, const params *p, const tl_element_face *faces, size_t count)
{
    const double spacing = spacing_of(p);
    double area = 0;
    for (size_t i = 0; i < count; i++)
        area += area_of(&faces[i]);
    if (area > MOST_TRIANGLES * TRIANGLE * spacing * spacing)
        return host->fail(host, TL_E_ARGUMENT,
                          "%g m2 would have more than %g triangles with spacing = %g m: make it longer", area,
                          MOST_TRIANGLES, spacing);
    mesh m;
    tl_status status = TL_OK;
    if (!mesh_make(&m, faces, count, spacing))
        status = host->fail(host, TL_E_MEMORY, "out of memory");
    double covered = 0;
    for (size_t i = 0; i < m.count; i++)
        covered += area_of_triangle(&m, &m.of[i]);
    if (status == TL_OK && !(covered >= (1 - BARE) * area))
        status =
            host->fail(host, TL_E_ARGUMENT,
                       "triangles with spacing = %g m would cover %g m2 of the %g m2 of these faces: make it shorter",
                       spacing, covered, area);
    for (size_t k = 0; k < m.patches && status == TL_OK; k++)
        status = add_patch(host, &m, faces, k);
    if (status == TL_OK && m.patches > 1)
        host->log(host, "the liner has %zu patches, with joints of its own between them", m.patches);
    mesh_free(&m);
    return status;
}

static tl_status place(const tl_element_host *host, const void *given)
{
    const params *p = given;
    const tl_element_face *list;
    size_t count, kept = 0;
    tl_status status = host->faces(host, p->rock, p->facing, p->within, &list, &count);
    if (status != TL_OK)
        return status;
    tl_element_face *faces = malloc((count + 1) * sizeof *faces);
    unsigned char *found = calloc(p->faces.count + 1, 1);
    if (!faces || !found)
        status = host->fail(host, TL_E_MEMORY, "out of memory");
    for (size_t i = 0; i < count && status == TL_OK; i++)
        if (is_meant(&p->faces, &list[i], found))
            faces[kept++] = list[i];
    for (size_t i = 0; i < p->faces.count && count > 0 && status == TL_OK; i++)
        if (!found[i])
            status = host->fail(host, TL_E_NOT_FOUND,
                                "point %zu of faces, (%g, %g, %g), lies on none of %zu outer faces: give centroids of "
                                "faces that model:boundary finds",
                                i + 1, p->faces.at[i].x, p->faces.at[i].y, p->faces.at[i].z, count);
    if (status == TL_OK && kept > 0)
        status = cover(host, p, faces, kept);
    else if (status == TL_OK)
        status = host->fail(host, TL_E_NOT_FOUND,
                            "no outer face %s%s%slooks along facing = (%g, %g, %g) within %g degrees: take another "
                            "direction or a larger angle",
                            p->rock ? "of group '" : "", p->rock ? p->rock : "", p->rock ? "' " : "", p->facing.x,
                            p->facing.y, p->facing.z, p->within);
    free(faces);
    free(found);
    return status;
}

/* ---------------------------------------------------------------- failing ---------------- */

/* A patch in a step. */
typedef struct patch {
    const params *p;
    shell_material of;
    const tl_element_batch *b;
    uint32_t e, first, corners;
    shell *s;
    unsigned char held[TL_ELEMENT_MANY], now[TL_ELEMENT_MANY], torn[TL_ELEMENT_MANY / 3];
} patch;

/* Forces in a triangle: principal values, and the largest tensile stress. */
typedef struct inside {
    double force[2], moment, stress;
} inside;

static inside look_into(const patch *x, uint32_t triangle)
{
    double force[3], moment[3], value[2];
    inside in = {.stress = 0};
    shell_stress(x->s, &x->of, triangle, force, moment);
    facet_principal(force, in.force);
    facet_principal(moment, value);
    in.moment = fmax(fabs(value[0]), fabs(value[1]));
    const double t = x->of.thickness;
    for (int side = -1; side <= 1; side += 2) {
        double fibre[3];
        for (int i = 0; i < 3; i++)
            fibre[i] = force[i] / t + side * 6 * moment[i] / (t * t);
        facet_principal(fibre, value);
        in.stress = fmax(in.stress, value[0]);
    }
    return in;
}

/* Load over strength. */
static double ratio(double load, double strength)
{
    return load <= 0 ? 0 : strength > 0 ? load / strength : INFINITY;
}

static double bond_ratio(const patch *x, uint32_t corner)
{
    double tension, shear;
    if (x->held[corner] != SHELL_BONDED)
        return 0;
    shell_bond(x->s, &x->of, corner, &tension, &shear);
    return fmax(ratio(tension, x->p->bond_strength),
                ratio(shear, or_else(x->p->bond_shear_strength, x->p->bond_strength)));
}

static double crack_ratio(const patch *x, uint32_t triangle)
{
    if (x->torn[triangle] == SHELL_THROUGH)
        return 0;
    return ratio(look_into(x, triangle).stress, x->p->tension);
}

/* Lets what is loaded most beyond its strength fail; whether there is any. */
static bool fail_worst(patch *x)
{
    double worst = 1;
    for (uint32_t c = 0; c < x->corners; c++)
        worst = fmax(worst, bond_ratio(x, c));
    for (uint32_t t = 0; t < x->corners / 3; t++)
        worst = fmax(worst, crack_ratio(x, t));
    if (!(worst > 1))
        return false;
    const double least = fmin(fmax(1, TOGETHER * worst), DBL_MAX);
    for (uint32_t c = 0; c < x->corners; c++)
        if (bond_ratio(x, c) >= least)
            x->held[c] = SHELL_PRESSED;
    for (uint32_t t = 0; t < x->corners / 3; t++)
        if (crack_ratio(x, t) >= least)
            x->torn[t] =
                ratio(look_into(x, t).force[0] / x->of.thickness, x->p->tension) > 1 || x->torn[t] == SHELL_HINGE
                    ? SHELL_THROUGH
                    : SHELL_HINGE;
    return true;
}

/* Rounds in which corners begin or end to press. */
typedef struct rounds {
    uint32_t fewest; /* corners that were wrong in a round */
    int patience;
    unsigned char presses[TL_ELEMENT_MANY]; /* how often each has begun to press by itself */
} rounds;

static void begin_rounds(rounds *r)
{
    r->fewest = UINT32_MAX;
    r->patience = PATIENCE;
    memset(r->presses, 0, sizeof r->presses);
}

/* How a corner is to be held, by the tension between shell and rock now. */
static unsigned char held_now(const patch *x, uint32_t corner, double *tension)
{
    double shear;
    *tension = 0;
    if (x->held[corner] == SHELL_BONDED || x->b->weight[x->first + corner] == 0)
        return x->held[corner];
    shell_bond(x->s, &x->of, corner, tension, &shear);
    return *tension < 0 ? SHELL_PRESSED : SHELL_FREE;
}

/* Lets debonded corners press where shell and rock have met, and go where they part. Whether any does. All that are
 * wrong do so at once. Where these do not become fewer for long, only the one that is most so does, until they do
 * (Judice and Pires 1994). */
static bool touch(patch *x, rounds *r)
{
    uint32_t wrong = 0, worst = UINT32_MAX;
    double most = 0;
    for (uint32_t c = 0; c < x->corners; c++) {
        double tension;
        x->now[c] = held_now(x, c, &tension);
        if (x->now[c] == x->held[c])
            continue;
        wrong++;
        if (fabs(tension) > most && (x->now[c] == SHELL_FREE || r->presses[c] < PRESSES)) {
            most = fabs(tension);
            worst = c;
        }
    }
    const bool fewer = wrong < r->fewest;
    r->fewest = fewer ? wrong : r->fewest;
    r->patience = fewer ? PATIENCE : r->patience - (r->patience > 0);
    if (wrong == 0 || (r->patience == 0 && worst == UINT32_MAX))
        return false;
    if (r->patience > 0) {
        memcpy(x->held, x->now, x->corners);
        return true;
    }
    x->held[worst] = x->now[worst];
    r->presses[worst] = (unsigned char)(r->presses[worst] + (x->now[worst] == SHELL_PRESSED));
    return true;
}

/* ---------------------------------------------------------------- acting ----------------- */

/* How it was held in the last step. Whether rock has gone since. */
static bool recall(patch *x)
{
    bool lost = false;
    for (uint32_t c = 0; c < x->corners; c++) {
        const uint32_t i = x->first + c;
        const bool gone = x->b->weight[i] == 0;
        double *bonded = &x->b->state[BONDED][i], *pressed = &x->b->state[PRESSED][i];
        lost = lost || (gone && (*bonded != 0 || *pressed != 0));
        *bonded = gone ? 0 : *bonded;
        *pressed = gone ? 0 : *pressed;
        x->held[c] = *bonded != 0 ? SHELL_BONDED : *pressed != 0 ? SHELL_PRESSED : SHELL_FREE;
    }
    for (uint32_t t = 0; t < x->corners / 3; t++) {
        const double torn = x->b->state[TORN][x->first + 3 * t];
        x->torn[t] = torn >= 2 ? SHELL_THROUGH : torn >= 1 ? SHELL_HINGE : SHELL_SOUND;
    }
    return lost;
}

/* Finds the balance, and the energy that is stored. Whether something has failed. */
static bool settle(patch *x, double *energy)
{
    rounds r;
    bool failed = false, again;
    begin_rounds(&r);
    do {
        shell_hold(x->s, x->b, x->e, &x->of, x->held, x->torn);
        *energy = shell_solve(x->s, x->b, x->e, &x->of);
        again = touch(x, &r);
        if (!again && fail_worst(x)) {
            failed = again = true;
            begin_rounds(&r);
        }
    } while (again);
    return failed;
}

static void keep_corners(const patch *x)
{
    const tl_element_batch *b = x->b;
    double debonded = 0;
    bool any = false, gone = false;
    for (uint32_t c = 0; c < x->corners; c++) {
        const uint32_t i = x->first + c;
        const bool held = x->held[c] != SHELL_FREE, bonded = x->held[c] == SHELL_BONDED;
        double tension, shear;
        shell_bond(x->s, &x->of, c, &tension, &shear);
        b->state[BONDED][i] = bonded;
        b->state[PRESSED][i] = x->held[c] == SHELL_PRESSED;
        b->state[BOND_TENSION][i] = held ? tension : 0;
        b->state[BOND_SHEAR][i] = bonded ? shear : 0;
        debonded += bonded ? 0 : b->weight[i];
        any = any || bonded;
        gone = gone || b->weight[i] == 0;
    }
    b->element_state[DEBONDED][x->e] = debonded;
    if (debonded > 0)
        b->flags[x->e] |= (uint32_t)TL_ELEMENT_YIELDED;
    if (!any && !gone)
        b->flags[x->e] |= (uint32_t)TL_ELEMENT_BROKEN;
}

static void keep_facets(const patch *x)
{
    const tl_element_batch *b = x->b;
    double thrust = 0, moment = 0, cracked = 0;
    for (uint32_t t = 0; t < x->corners / 3; t++) {
        const inside in = look_into(x, t);
        for (uint32_t i = x->first + 3 * t; i < x->first + 3 * t + 3; i++) {
            b->state[THRUST][i] = -in.force[1];
            b->state[PULL][i] = in.force[0];
            b->state[MOMENT][i] = in.moment;
            b->state[STRESS][i] = in.stress;
            b->state[TORN][i] = x->torn[t];
        }
        thrust = fmax(thrust, -in.force[1]);
        moment = fmax(moment, in.moment);
        cracked += x->torn[t] != SHELL_SOUND ? x->s->facet[t].area : 0;
        if (x->torn[t] != SHELL_SOUND)
            b->flags[x->e] |= (uint32_t)TL_ELEMENT_YIELDED;
        if (x->torn[t] == SHELL_THROUGH)
            b->flags[x->e] |= (uint32_t)TL_ELEMENT_BROKEN;
    }
    b->element_state[MOST_THRUST][x->e] = thrust;
    b->element_state[MOST_MOMENT][x->e] = moment;
    b->element_state[CRACKED][x->e] = cracked;
}

/* Work of the rock in this step: the half of one end of it. */
static double work_on(const patch *x)
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        for (uint32_t i = x->first; i < x->first + x->corners; i++)
            sum -= 0.5 * x->b->force[k][i] * x->b->du[k][i];
    return sum;
}

static tl_status update(const void *self, const tl_element_batch *b, tl_report *report)
{
    (void)report;
    const params *p = self;
    patch x = {.p = p, .of = material_of(p), .b = b};
    for (uint32_t e = 0; e < b->count; e++) {
        double energy;
        x.e = e;
        x.first = b->start[e];
        x.s = shell_open(b->memory[e], b, e, b->state[NUMBER]);
        x.corners = x.s->corners;
        const bool gone = recall(&x);
        const bool failed = settle(&x, &energy) || gone;
        const double before = failed ? work_on(&x) : 0;
        shell_push(x.s, b, e);
        /* what has failed turns what it held to heat */
        b->lost[e] = failed ? before + work_on(&x) - (energy - b->stored[e]) : 0;
        b->stored[e] = energy;
        keep_corners(&x);
        keep_facets(&x);
    }
    return TL_OK;
}

static void stiffness(const void *self, const tl_element_batch *b, double *k, double *c)
{
    const shell_material of = material_of(self);
    (void)c;
    for (uint32_t i = 0; i < b->start[b->count]; i++)
        k[i] = fmax(of.normal, of.shear) * b->weight[i];
}

static void memory(const void *self, const tl_element_batch *b, size_t *bytes)
{
    (void)self;
    for (uint32_t e = 0; e < b->count; e++)
        bytes[e] = shell_bytes(b, e, b->state[NUMBER]);
}

static const tl_element_ops ops = {.size = sizeof ops,
                                   .place = place,
                                   .update = update,
                                   .stiffness = stiffness,
                                   .never_fails = 1,
                                   .memory = memory,
                                   .triangles = 1};

static const tl_kind kind = TL_KIND(TL_KIND_ELEMENT, ops, .name = "liner",
                                    .doc = "Shotcrete on outer faces of blocks: a shell that a bond holds.",
                                    TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN_SINCE(16, kind, .id = "talus.liner", .version = TALUS_VERSION, .doc = "Shotcrete on outer faces.",
                .licence = "BSD-3-Clause");
