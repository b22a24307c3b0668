/* flow.c - element "flow": water that flows in joints, and presses on their walls.
 *
 * An element is a wet joint, a cell of the network, with nodes at the corners of its polygon on both walls: the weight
 * of a corner is a third of the triangles of its fan. A corner is also put where another joint meets the side. A head
 * and a drain are elements, too, with two nodes on the ground: they bear no force and keep their flow. solve.c finds
 * the pressures; between two solutions they stay. */
#include "flow.h"

#include "crossings.h"
#include "joints.h"

/* Tolerance: over the root of the area of a joint: so far from each other may sides lie that meet. It is twice the way
 * by which blocks slide before joints are found again. */
#define MEET 2e-3
/* Tolerance: over the size of a box, by which it is wider than given: rounding of places. */
#define ON_BOX 1e-9

const tl_param flow_param_table[FLOW_PARAMS] = {
    TL_PARAM(TL_PARAM_REAL, flow_params, aperture, "m", "Hydraulic aperture of walls that just touch.",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN | TL_PARAM_PLACE, .max = 1),
    TL_PARAM(TL_PARAM_REAL, flow_params, residual, "m", "Least aperture, of a joint that is pressed.", .def = {2e-5},
             .flags = TL_PARAM_MIN_OPEN | TL_PARAM_PLACE, .max = 1),
    TL_PARAM(TL_PARAM_REAL, flow_params, maximum, "m", "Largest aperture that counts.", .def = {2e-3},
             .flags = TL_PARAM_MIN_OPEN | TL_PARAM_PLACE, .max = 1),
    TL_PARAM(TL_PARAM_REAL, flow_params, viscosity, "Pa s", "Of the water.", .def = {1e-3},
             .flags = TL_PARAM_MIN_OPEN | TL_PARAM_PLACE, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, flow_params, unit_weight, "N/m3", "Of the water.", .def = {9810.0},
             .flags = TL_PARAM_MIN_OPEN | TL_PARAM_PLACE, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, flow_params, bulk, "Pa", "Bulk modulus of the water, where flow is not steady.",
             .def = {2e9}, .flags = TL_PARAM_MIN_OPEN | TL_PARAM_PLACE, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, flow_params, initial_head, "m",
             "Head at the beginning where flow is not steady; without it the pressure begins at 0.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_REAL, flow_params, drain_gap, "m", "Mean opening beyond which a joint is dry.", .def = {0.05},
             .flags = TL_PARAM_MIN_OPEN | TL_PARAM_PLACE, .max = 1e50),
    TL_PARAM(TL_PARAM_STRING, flow_params, apertures, "",
             "Other apertures, of joints, sets or planes: \"A=1e-4,B:2=3e-4\", m; the last that fits counts.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_STRING, flow_params, joints, "", "Joints, sets or planes of them, separated by commas.",
             .def_text = "*", .flags = TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_POINTS, flow_params, heads, "m",
             "Three points a head: least and largest corner of a box, and {head, 0, 0}.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_POINTS, flow_params, drains, "m", "Three points a drain: both ends, and {radius, 0, 0}.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_INT, flow_params, every, "",
             "Steps between two solutions; 0: 100 of steady flow, 1 of stored water. With n of stored water the time "
             "step is n times shorter where walls move.",
             .def = {0}, .max = 1e9, .flags = TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_BOOL, flow_params, steady, "", "Whether water is in balance, or also stored.", .def = {1},
             .flags = TL_PARAM_PLACE)};

const tl_state flow_state_table[FLOW_STATES] = {
    [0] = TL_STATE(TL_STATE_SCALAR, "pressure", "Pa", "at the node"),
    TL_STATE(TL_STATE_SCALAR, "source", "Pa", "that the wall bears over the weight of the node"),
    TL_STATE(TL_STATE_SCALAR, "touching", "m", "aperture where the walls just touch"),
    TL_STATE(TL_STATE_SCALAR, "crossing", "", "number of the line in which joints meet that begins at the corner",
             .transfer = TL_TRANSFER_RESET),
    TL_STATE(TL_STATE_WHOLE, "area", "m2", "of the wet polygon", .transfer = TL_TRANSFER_RESET),
    TL_STATE(TL_STATE_WHOLE, "opening", "m", "mean distance of the walls"),
    TL_STATE(TL_STATE_WHOLE, "dry", "", "1: it has run dry"),
    TL_STATE(TL_STATE_WHOLE, "aperture", "m", "hydraulic aperture"),
    TL_STATE(TL_STATE_WHOLE, "flow", "m3/s",
             "through the joint; of a head or drain: into the rock; of stored water the mean since the last solution"),
    TL_STATE(TL_STATE_WHOLE, "head", "m", "mean head"),
    TL_STATE(TL_STATE_WHOLE, "role", "", "0: a wet joint, 1: a head, 2: a drain", .transfer = TL_TRANSFER_RESET),
    TL_STATE(TL_STATE_WHOLE, "closed", "",
             "1: its network reaches neither a head nor a drain; of a head or drain: it reaches no joint"),
    TL_STATE(TL_STATE_WHOLE, "time", "s", "of its pressures; -1: it has none yet"),
    TL_STATE(TL_STATE_WHOLE, "water", "m3", "that is stored in the joint, at pressure 0; 0 in steady flow",
             .transfer = TL_TRANSFER_SPLIT),
    TL_STATE(TL_STATE_WHOLE, "void", "m3", "area by aperture as of `water`; 0: water has not been counted",
             .transfer = TL_TRANSFER_SPLIT)};

/* ---------------------------------------------------------------- geometry --------------- */

bool flow_in_box(tl_vec3 least, tl_vec3 most, tl_vec3 x)
{
    const double wide = tl_v3_norm(least) + tl_v3_norm(most) + tl_v3_norm(tl_v3_sub(most, least));
    const tl_vec3 grow = tl_v3(ON_BOX * wide, ON_BOX * wide, ON_BOX * wide);
    const tl_vec3 a = tl_v3_sub(x, tl_v3_sub(least, grow)), b = tl_v3_sub(tl_v3_add(most, grow), x);
    return a.x >= 0 && a.y >= 0 && a.z >= 0 && b.x >= 0 && b.y >= 0 && b.z >= 0;
}

bool flow_drain_meets(const tl_vec3 *corner, size_t count, tl_vec3 n, tl_vec3 a, tl_vec3 b, double *z)
{
    const double from = tl_v3_dot(n, tl_v3_sub(a, corner[0])), to = tl_v3_dot(n, tl_v3_sub(b, corner[0]));
    if (from == to || (from > 0 && to > 0) || (from < 0 && to < 0))
        return false;
    const tl_vec3 x = tl_v3_madd(a, from / (from - to), tl_v3_sub(b, a));
    for (size_t i = 0; i < count; i++) {
        const tl_vec3 p = corner[i], side = tl_v3_sub(corner[i + 1 < count ? i + 1 : 0], p);
        if (tl_v3_dot(n, tl_v3_cross(side, tl_v3_sub(x, p))) < 0)
            return false;
    }
    *z = x.z;
    return true;
}

static uint32_t root_of(uint32_t *root, uint32_t k)
{
    while (root[k] != k)
        k = root[k] = root[root[k]];
    return k;
}

bool flow_find_closed(size_t cells, const uint32_t *first, const uint32_t *crossing, size_t crossings,
                      const unsigned char *open, const unsigned char *drained, unsigned char *closed)
{
    uint32_t *root = malloc((crossings + 1) * sizeof *root);
    unsigned char *reached = calloc(crossings + 1, 1);
    const bool enough = root && reached;
    for (size_t c = 0; enough && c < crossings; c++)
        root[c] = (uint32_t)c;
    for (size_t i = 0; enough && i < cells; i++)
        for (uint32_t k = first[i]; !closed[i] && k + 1 < first[i + 1]; k++) {
            const uint32_t a = root_of(root, crossing[k]), b = root_of(root, crossing[k + 1]);
            root[a < b ? b : a] = a < b ? a : b;
        }
    for (size_t c = 0; enough && c < crossings; c++)
        if (open[c])
            reached[root_of(root, (uint32_t)c)] = 1;
    for (size_t i = 0; enough && i < cells; i++)
        if (drained[i] && !closed[i] && first[i] < first[i + 1])
            reached[root_of(root, crossing[first[i]])] = 1;
    for (size_t i = 0; enough && i < cells; i++)
        if (first[i] < first[i + 1] && !reached[root_of(root, crossing[first[i]])])
            closed[i] = 1;
    free(root);
    free(reached);
    return enough;
}

/* ---------------------------------------------------------------- what is given ---------- */

static tl_status check_heads(const tl_element_host *host, const flow_params *p)
{
    if (p->heads.count % 3 != 0 || p->drains.count % 3 != 0)
        return host->fail(host, TL_E_ARGUMENT, "heads and drains are lists of three points each");
    for (size_t i = 0; i < p->heads.count; i += 3) {
        const tl_vec3 size = tl_v3_sub(p->heads.at[i + 1], p->heads.at[i]);
        if (!(size.x >= 0 && size.y >= 0 && size.z >= 0))
            return host->fail(host, TL_E_ARGUMENT, "head %zu: the box ends below where it begins: give min and max",
                              i / 3 + 1);
    }
    for (size_t i = 0; i < p->drains.count; i += 3) {
        if (!(p->drains.at[i + 2].x > 0))
            return host->fail(host, TL_E_ARGUMENT, "drain %zu: its radius = %g m must be above 0", i / 3 + 1,
                              p->drains.at[i + 2].x);
        if (!(tl_v3_norm(tl_v3_sub(p->drains.at[i + 1], p->drains.at[i])) > 0))
            return host->fail(host, TL_E_ARGUMENT, "drain %zu begins where it ends", i / 3 + 1);
    }
    return TL_OK;
}

static tl_status check(const tl_element_host *host, const flow_params *p)
{
    if (!(p->aperture > p->residual))
        return host->fail(host, TL_E_ARGUMENT, "aperture = %g m must be above residual = %g m", p->aperture,
                          p->residual);
    if (!(p->maximum >= p->aperture))
        return host->fail(host, TL_E_ARGUMENT, "maximum = %g m must be at least aperture = %g m", p->maximum,
                          p->aperture);
    return check_heads(host, p);
}

/* An aperture of its own, of a wall by its name. */
typedef struct own_aperture {
    uint64_t key;
    double aperture;
} own_aperture;

typedef struct placing {
    const tl_element_host *host;
    const flow_params *p;
    own_aperture *own; /* in the order in which they were given */
    size_t own_count;
    tl_vec3 *corner; /* of all polygons, halfway between the walls */
    uint32_t *first, *wall, *which;
    double *slack, *area;
    size_t count;
    flow_crossings crossings;
} placing;

/* Reads "NAME=NUMBER" into name and number; gives what follows, or NULL. */
static const char *read_pair(const char *text, char name[256], double *number)
{
    const size_t length = strcspn(text, "=,");
    const char *end;
    if (length == 0 || length >= 256 || text[length] != '=')
        return NULL;
    memcpy(name, text, length);
    name[length] = '\0';
    *number = tl_number_read(text + length + 1, &end);
    return end == text + length + 1 || (*end && *end != ',') ? NULL : end + (*end == ',');
}

/* Adds the walls of one joint with their aperture. */
static tl_status add_own(placing *k, const char *joints, double aperture)
{
    const tl_wall_filter filter = {sizeof filter, joints, k->p->drain_gap * FORGOTTEN, MOST_TILT};
    const tl_element_wall *walls;
    size_t count;
    if (!(aperture > k->p->residual && aperture <= k->p->maximum))
        return k->host->fail(k->host, TL_E_ARGUMENT,
                             "aperture of '%s' = %g m must be above residual = %g m and at most maximum = %g m", joints,
                             aperture, k->p->residual, k->p->maximum);
    const tl_status status = k->host->walls(k->host, &filter, &walls, &count);
    if (status != TL_OK)
        return status;
    own_aperture *own = realloc(k->own, (k->own_count + count + 1) * sizeof *own);
    if (!own)
        return k->host->fail(k->host, TL_E_MEMORY, "out of memory");
    k->own = own;
    for (size_t i = 0, which = 0; i < count; i++) {
        which = i && joint_same_faces(&walls[i - 1], &walls[i]) ? which + 1 : 0;
        own[k->own_count++] = (own_aperture){joint_key(&walls[i], (uint32_t)which), aperture};
    }
    return TL_OK;
}

/* Stable by key: of one key the last one counts. */
static int compare_own(const void *a, const void *b)
{
    const own_aperture *x = a, *y = b;
    return (x->key > y->key) - (x->key < y->key);
}

static tl_status read_apertures(placing *k)
{
    const char *text = k->p->apertures;
    char name[256];
    double aperture;
    while (text && *text) {
        text = read_pair(text, name, &aperture);
        if (!text)
            return k->host->fail(k->host, TL_E_ARGUMENT, "apertures = \"%.80s\" must be like \"A=1e-4,B:2=3e-4\", m",
                                 k->p->apertures);
        const size_t before = k->own_count;
        const tl_status status = add_own(k, name, aperture);
        if (status != TL_OK)
            return status;
        size_t kept = 0; /* what this joint had before */
        if (before > 0 && k->own_count > before) {
            qsort(k->own + before, k->own_count - before, sizeof *k->own, compare_own);
            for (size_t i = 0; i < k->own_count; i++)
                if (i >= before ||
                    !bsearch(&k->own[i], k->own + before, k->own_count - before, sizeof *k->own, compare_own))
                    k->own[kept++] = k->own[i];
            k->own_count = kept;
        }
    }
    if (k->own_count > 1)
        qsort(k->own, k->own_count, sizeof *k->own, compare_own);
    return TL_OK;
}

/* ---------------------------------------------------------------- placing ---------------- */

static tl_vec3 middle_of(const tl_element_wall *w, size_t i)
{
    return tl_v3_scale(0.5, tl_v3_add(w->corners[0][i], w->corners[1][i]));
}

/* Lists the polygons of the walls that are wet. */
static tl_status list_polygons(placing *k, const tl_element_wall *walls, size_t count)
{
    size_t corners = 0;
    for (size_t i = 0; i < count; i++)
        corners += walls[i].corner_count;
    k->corner = malloc((corners + 1) * sizeof *k->corner);
    k->first = malloc((count + 1) * sizeof *k->first);
    k->wall = malloc((count + 1) * sizeof *k->wall);
    k->which = malloc((count + 1) * sizeof *k->which);
    k->slack = malloc((count + 1) * sizeof *k->slack);
    if (!k->corner || !k->first || !k->wall || !k->which || !k->slack || corners >= UINT32_MAX)
        return k->host->fail(k->host, TL_E_MEMORY, "out of memory");
    k->first[0] = 0;
    for (size_t i = 0, which = 0; i < count; i++) {
        const tl_element_wall *w = &walls[i];
        which = i && joint_same_faces(w - 1, w) ? which + 1 : 0;
        if (!k->host->again && w->opening > k->p->drain_gap)
            continue;
        k->slack[k->count] = MEET * sqrt(w->area) + fabs(w->opening);
        k->wall[k->count] = (uint32_t)i;
        k->which[k->count] = (uint32_t)which;
        for (size_t c = 0; c < w->corner_count; c++)
            k->corner[k->first[k->count] + c] = middle_of(w, c);
        k->first[k->count + 1] = k->first[k->count] + (uint32_t)w->corner_count;
        k->count++;
    }
    return TL_OK;
}

/* Places the wet joint of polygon i. */
static tl_status place_joint(const placing *k, const tl_element_wall *w, size_t i)
{
    tl_element_node nodes[2 * MOST_CORNERS];
    double state[2 * MOST_CORNERS][4], weight[MOST_CORNERS] = {0};
    joint_polygon all = {.count = 0};
    double crossing[MOST_CORNERS];
    for (uint32_t c = k->first[i]; c < k->first[i + 1]; c++)
        for (uint32_t s = k->crossings.first[c]; s < k->crossings.first[c + 1]; s++) {
            const size_t from = c - k->first[i], to = from + 1 < w->corner_count ? from + 1 : 0;
            if (all.count + 1 >= MOST_CORNERS)
                return k->host->fail(k->host, TL_E_ARGUMENT,
                                     "the joint of blocks %u and %u meets others in more than %d places: cut the "
                                     "blocks",
                                     w->block[0], w->block[1], MOST_CORNERS - 1);
            for (int side = 0; side < 2; side++)
                all.at[side][all.count] = tl_v3_madd(w->corners[side][from], k->crossings.piece[s].from,
                                                     tl_v3_sub(w->corners[side][to], w->corners[side][from]));
            crossing[all.count++] = k->crossings.piece[s].crossing;
        }
    const tl_vec3 n = tl_v3_unit(tl_v3_sub(w->normal[0], w->normal[1]));
    const joint_moments m = joint_moments_of(&all, n);
    for (size_t c = 1; c + 1 < all.count; c++) {
        const tl_vec3 o = joint_middle(&all, 0), a = tl_v3_sub(joint_middle(&all, c), o);
        const double part = tl_v3_dot(n, tl_v3_cross(a, tl_v3_sub(joint_middle(&all, c + 1), o))) / 6;
        weight[0] += part;
        weight[c] += part;
        weight[c + 1] += part;
    }
    const own_aperture key = {joint_key(w, k->which[i]), 0};
    const own_aperture *own = k->own_count ? bsearch(&key, k->own, k->own_count, sizeof key, compare_own) : NULL;
    for (size_t c = 0; c < 2 * all.count; c++) {
        const int side = c >= all.count;
        const size_t at = side ? c - all.count : c;
        const double start = k->p->initial_head - all.at[side][at].z;
        nodes[c] = (tl_element_node){w->block[side], all.at[side][at], w->normal[side],
                                     fmax(0, weight[at] / fabs(tl_v3_dot(n, w->normal[side])))};
        state[c][FLOW_PRESSURE] = state[c][FLOW_SOURCE] =
            isnan(k->p->initial_head) || k->p->steady ? 0 : fmax(0, k->p->unit_weight * start);
        state[c][FLOW_TOUCHING] = own ? own->aperture : k->p->aperture;
        state[c][FLOW_CROSSING] = side ? 0 : crossing[at];
    }
    const double whole[] = {m.area, w->opening, w->opening > k->p->drain_gap, 0, 0, 0, FLOW_JOINT, 0, -1, 0, 0};
    return k->host->add(k->host, &(tl_new_element){.size = sizeof(tl_new_element),
                                                   .nodes = nodes,
                                                   .count = 2 * all.count,
                                                   .node_state = *state,
                                                   .state = whole,
                                                   .key = key.key});
}

/* Places heads or drains, as elements on the ground. */
static tl_status place_ends(const placing *k, const tl_points *of, int role)
{
    tl_status status = TL_OK;
    for (size_t i = 0; i < of->count && status == TL_OK; i += 3) {
        const double number = of->at[i + 2].x;
        const tl_element_node nodes[2] = {{0, of->at[i], {0, 0, 0}, role == FLOW_AT_DRAIN ? number : 0},
                                          {0, of->at[i + 1], {0, 0, 0}, role == FLOW_AT_DRAIN ? number : 0}};
        const double whole[] = {0, 0, 0, 0, 0, role == FLOW_AT_HEAD ? number : 0, role, 0, -1, 0, 0};
        status = k->host->add(
            k->host, &(tl_new_element){.size = sizeof(tl_new_element), .nodes = nodes, .count = 2, .state = whole});
    }
    return status;
}

/* The middle of side c of polygon i, or of a piece of it: pieces are looked at by their middles. */
static tl_vec3 piece_middle(const placing *k, size_t i, uint32_t c, uint32_t s)
{
    const tl_vec3 a = k->corner[c], b = k->corner[c + 1 < k->first[i + 1] ? c + 1 : k->first[i]];
    const double from = k->crossings.piece[s].from;
    const double to = s + 1 < k->crossings.first[c + 1] ? k->crossings.piece[s + 1].from : 1;
    return tl_v3_madd(a, 0.5 * (from + to), tl_v3_sub(b, a));
}

/* What heads and drains reach. */
typedef struct reach {
    unsigned char *open, *drained, *closed;
    uint32_t *first, *crossing;
} reach;

/* Refuses a head whose box holds no side of a wet joint. */
static tl_status check_boxes(const placing *k, reach *r)
{
    for (size_t h = 0; h < k->p->heads.count; h += 3) {
        bool found = false;
        for (size_t i = 0; i < k->count; i++)
            for (uint32_t c = k->first[i]; c < k->first[i + 1]; c++)
                for (uint32_t s = k->crossings.first[c]; s < k->crossings.first[c + 1]; s++)
                    if (flow_in_box(k->p->heads.at[h], k->p->heads.at[h + 1], piece_middle(k, i, c, s))) {
                        r->open[k->crossings.piece[s].crossing] = 1;
                        found = true;
                    }
        if (!found)
            return k->host->fail(k->host, TL_E_NOT_FOUND,
                                 "head %zu: no edge of a wet joint has its middle in the box: widen the box",
                                 h / 3 + 1);
    }
    return TL_OK;
}

/* Refuses a drain that meets no wet joint, or one that is too small for it. */
static tl_status check_drains(const placing *k, const tl_element_wall *walls, reach *r)
{
    for (size_t d = 0; d < k->p->drains.count; d += 3) {
        bool found = false;
        for (size_t i = 0; i < k->count; i++) {
            const tl_element_wall *w = &walls[k->wall[i]];
            const double most = FLOW_WELL_RADIUS * sqrt(w->area), radius = k->p->drains.at[d + 2].x;
            double z;
            if (!flow_drain_meets(k->corner + k->first[i], w->corner_count, w->normal[0], k->p->drains.at[d],
                                  k->p->drains.at[d + 1], &z))
                continue;
            r->drained[i] = 1;
            found = true;
            if (!(radius < 0.9 * most))
                return k->host->fail(k->host, TL_E_ARGUMENT,
                                     "drain %zu: its radius = %g m must be below %g m, 0.18 of the root of the area of "
                                     "the joint of blocks %u and %u",
                                     d / 3 + 1, radius, 0.9 * most, w->block[0], w->block[1]);
        }
        if (!found)
            return k->host->fail(k->host, TL_E_NOT_FOUND, "drain %zu passes no wet joint: move it", d / 3 + 1);
    }
    return TL_OK;
}

/* Tells of networks that reach neither a head nor a drain. */
static tl_status tell_closed(const placing *k, const tl_element_wall *walls, reach *r)
{
    size_t closed = 0, which = 0;
    for (size_t i = 0; i <= k->count; i++)
        r->first[i] = k->crossings.first[k->first[i]];
    for (uint32_t s = 0; s < r->first[k->count]; s++)
        r->crossing[s] = k->crossings.piece[s].crossing;
    if (!flow_find_closed(k->count, r->first, r->crossing, k->crossings.count, r->open, r->drained, r->closed))
        return k->host->fail(k->host, TL_E_MEMORY, "out of memory");
    for (size_t i = k->count; i-- > 0;) {
        closed += r->closed[i];
        which = r->closed[i] ? i : which;
    }
    const tl_element_wall *w = &walls[k->wall[which]];
    if (closed == k->count)
        return k->host->fail(
            k->host, TL_E_ARGUMENT,
            "the network of joints between blocks %u and %u, '%s', reaches neither a head nor a drain, "
            "so steady flow has no pressure: give heads = {{inside = box, head = m}} with the edge of "
            "a joint inside the box",
            w->block[0], w->block[1], w->joint);
    if (closed > 0)
        k->host->log(k->host,
                     "%zu wet joint%s, the first between blocks %u and %u, '%s', reach%s neither a head nor a drain: "
                     "closed there, water keeps its pressure",
                     closed, closed == 1 ? "" : "s", w->block[0], w->block[1], w->joint, closed == 1 ? "es" : "");
    return TL_OK;
}

/* Checks what heads and drains reach. */
static tl_status check_reach(const placing *k, const tl_element_wall *walls)
{
    const uint32_t pieces = k->crossings.first[k->first[k->count]];
    reach r = {calloc(k->crossings.count + 1, 1), calloc(k->count + 1, 1), calloc(k->count + 1, 1),
               malloc((k->count + 1) * sizeof *r.first), malloc((pieces + (size_t)1) * sizeof *r.crossing)};
    tl_status status = r.open && r.drained && r.closed && r.first && r.crossing
                           ? TL_OK
                           : k->host->fail(k->host, TL_E_MEMORY, "out of memory");
    if (status == TL_OK)
        status = check_boxes(k, &r);
    if (status == TL_OK)
        status = check_drains(k, walls, &r);
    if (status == TL_OK && k->p->steady)
        status = tell_closed(k, walls, &r);
    void *const owned[] = {r.open, r.drained, r.closed, r.first, r.crossing};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++)
        free(owned[i]);
    return status;
}

static tl_status place_all(placing *k, const tl_element_wall *walls, size_t count)
{
    const tl_element_host *host = k->host;
    tl_status status = list_polygons(k, walls, count);
    const flow_polygons polygons = {k->corner, k->first, k->slack, k->count};
    if (status == TL_OK && k->count == 0 && !host->again)
        return host->fail(host, TL_E_NOT_FOUND,
                          "no joint of '%s' has water: no two blocks face each other there within drain_gap = %g m",
                          k->p->joints, k->p->drain_gap);
    if (status == TL_OK && !flow_crossings_find(&polygons, &k->crossings))
        status = host->fail(host, TL_E_MEMORY, "out of memory");
    if (status == TL_OK && !host->again)
        status = check_reach(k, walls);
    if (status == TL_OK && !host->again && !k->p->steady && k->p->every > 1)
        host->log(host,
                  "every = %lld: between its solutions stored water does not feel walls that move, so the time step is "
                  "%lld times shorter: leave every out unless the walls are held",
                  (long long)k->p->every, (long long)k->p->every);
    if (status == TL_OK)
        status = place_ends(k, &k->p->heads, FLOW_AT_HEAD);
    if (status == TL_OK)
        status = place_ends(k, &k->p->drains, FLOW_AT_DRAIN);
    for (size_t i = 0; i < k->count && status == TL_OK; i++)
        status = place_joint(k, &walls[k->wall[i]], i);
    return status;
}

static tl_status place(const tl_element_host *host, const void *given)
{
    placing k = {.host = host, .p = given};
    const tl_wall_filter filter = {sizeof filter, k.p->joints, k.p->drain_gap * FORGOTTEN, MOST_TILT};
    const tl_element_wall *walls;
    size_t count;
    tl_status status = check(host, k.p);
    if (status == TL_OK)
        status = read_apertures(&k);
    if (status == TL_OK)
        status = host->walls(host, &filter, &walls, &count);
    if (status == TL_OK)
        status = place_all(&k, walls, count);
    flow_crossings_free(&k.crossings);
    void *const owned[] = {k.own, k.corner, k.first, k.wall, k.which, k.slack};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++)
        free(owned[i]);
    return status;
}

/* ---------------------------------------------------------------- acting ----------------- */

static tl_status update(const void *self, const tl_element_batch *b, tl_report *report)
{
    (void)self, (void)report;
    for (uint32_t e = 0; e < b->count; e++) {
        double given = 0;
        const bool dry = b->element_state[FLOW_DRY][e] != 0;
        for (uint32_t i = b->start[e]; i < b->start[e + 1]; i++) {
            const double pressure = dry ? 0 : b->state[FLOW_SOURCE][i];
            for (int k = 0; k < 3; k++) {
                const double force = -pressure * b->weight[i] * b->normal[k][i];
                given += 0.5 * (b->force[k][i] + force) * b->du[k][i];
                b->force[k][i] = force;
            }
        }
        b->given[e] = given;
    }
    return TL_OK;
}

static uint32_t every(const void *self)
{
    const flow_params *p = self;
    return p->every > 0 ? (uint32_t)p->every : p->steady ? 100 : 1;
}

/* Water that is stored resists the walls: they press it together. Its layer is at least as thick as the residual. When
 * it is asked every n steps, these steps together must be as short as one. */
static void stiffness(const void *self, const tl_element_batch *b, double *k, double *c)
{
    const flow_params *p = self;
    const double steps = every(self);
    (void)c;
    for (uint32_t i = 0; !p->steady && i < b->start[b->count]; i++)
        k[i] = steps * steps * p->bulk * b->weight[i] / p->residual;
}

const tl_element_ops flow_ops = {.size = sizeof flow_ops,
                                 .place = place,
                                 .update = update,
                                 .stiffness = stiffness,
                                 .never_fails = 1,
                                 .lays_again = 1,
                                 .steady = 1,
                                 .together = flow_solve,
                                 .every = every};
