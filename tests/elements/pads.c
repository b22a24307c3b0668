/* pads.c - element "pads": cushions between walls that share one pressure, as somebody else may have written it.
 *
 * A pad is filled to a pressure of its own, which grows with its height z. All pads of a call are joined by pipes: their
 * common pressure is the mean of their own ones, weighted by their areas. It presses both walls apart. */
#include <talus/kit.h>

typedef struct params {
    double pressure, gradient;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, pressure, "Pa", "Pressure of a pad at z = 0.",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, params, gradient, "Pa/m", "By which it grows upwards.", .def = {1}, .max = 1e50)};

enum { AREA, HEIGHT, SHARED };

static const tl_state state_table[] = {TL_STATE(TL_STATE_WHOLE, "area", "m2", "of the pad"),
                                       TL_STATE(TL_STATE_WHOLE, "height", "m", "z of its first corner, and y"),
                                       TL_STATE(TL_STATE_WHOLE, "shared", "Pa", "pressure of all pads")};

static tl_status place(const tl_element_host *host, const void *given)
{
    const tl_wall_filter filter = {sizeof filter, "*", 0.1, 5};
    const tl_element_wall *walls;
    size_t count;
    (void)given;
    tl_status status = host->walls(host, &filter, &walls, &count);
    for (size_t i = 0; status == TL_OK && i < count; i++) {
        const tl_element_wall *w = &walls[i];
        tl_element_node nodes[2];
        for (int k = 0; k < 2; k++)
            nodes[k] = (tl_element_node){w->block[k], w->corners[k][0], w->normal[k], w->area};
        const double state[] = {w->area, w->corners[0][0].y + w->corners[0][0].z, 0};
        status = host->add(
            host, &(tl_new_element){.size = sizeof(tl_new_element), .nodes = nodes, .count = 2, .state = state});
    }
    return status;
}

static double own_pressure(const params *p, const tl_element_batch *b, uint32_t e)
{
    return p->pressure + p->gradient * b->element_state[HEIGHT][e];
}

static tl_status together(const void *self, const tl_element_batch *b, tl_report *report)
{
    (void)report;
    double sum = 0, area = 0;
    for (uint32_t e = 0; e < b->count; e++) {
        sum += b->element_state[AREA][e] * own_pressure(self, b, e);
        area += b->element_state[AREA][e];
    }
    for (uint32_t e = 0; e < b->count; e++)
        b->element_state[SHARED][e] = sum / area;
    return TL_OK;
}

static tl_status update(const void *self, const tl_element_batch *b, tl_report *report)
{
    (void)self, (void)report;
    for (uint32_t e = 0; e < b->count; e++) {
        double given = 0;
        for (uint32_t i = b->start[e]; i < b->start[e + 1]; i++)
            for (int k = 0; k < 3; k++) {
                const double force = -b->element_state[SHARED][e] * b->weight[i] * b->normal[k][i];
                given += 0.5 * (b->force[k][i] + force) * b->du[k][i];
                b->force[k][i] = force;
            }
        b->given[e] = given;
    }
    return TL_OK;
}

static void stiffness(const void *self, const tl_element_batch *b, double *k, double *c)
{
    (void)self, (void)b, (void)k, (void)c;
}

static const tl_element_ops ops = {.size = sizeof ops,
                                   .place = place,
                                   .update = update,
                                   .stiffness = stiffness,
                                   .never_fails = 1,
                                   .together = together};

static const tl_kind kind = TL_KIND(TL_KIND_ELEMENT, ops, .name = "pads", .doc = "Pads that share one pressure.",
                                    TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN_SINCE(15, kind, .id = "elsewhere.pads", .version = "1.0", .doc = "Pads between walls.", .licence = "MIT");
