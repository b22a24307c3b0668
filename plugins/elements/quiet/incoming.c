/* incoming.c - element "incoming": waves that come in through quiet faces of deformable blocks.
 *
 * Dashpots of a quiet face act with -rho c v on a gridpoint that moves by v (Lysmer and Kuhlemeyer 1969). A wave of the
 * velocity w that comes in through it acts with 2 rho c w (Joyner and Chen 1975). A node is a gridpoint and a third of
 * the area A of the triangles of the face about it. With the face's normal n, along it and across,
 *
 *     f = 2 A (Z_p n (n . w) + Z_s (w - n (n . w))),    Z = rho c
 *
 * What it brings in is the work on the block; what leaves again is in the heat of the dashpots. */
#include "half_space.h"
#include "kinds.h"

/* Limit: numbers of a node in the list: block, face, place, normal, area and both impedances. */
#define ROW 11

/* What `create` makes of the parameters. */
typedef struct wave_kind {
    wave wave[3]; /* first: half_space.h */
    incoming_params given;
} wave_kind;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const incoming_params *p = given;
    const char *const input[] = {p->input_x, p->input_y, p->input_z};
    const tl_status status = half_space_create(input, sizeof(wave_kind), self, report);
    wave_kind *k = *self;
    if (k)
        k->given = *p;
    return status;
}

/* Makes the elements of one face: rows [from, to) of the list. */
static tl_status place_face(const tl_element_host *host, const double *row, size_t count)
{
    tl_element_node node[TL_ELEMENT_NODES];
    double state[TL_ELEMENT_NODES * INCOMING_NODE_STATES];
    tl_status status = TL_OK;
    for (size_t done = 0; done < count && status == TL_OK;) {
        size_t n = 0;
        const double *first = row + ROW * done;
        for (; n < TL_ELEMENT_NODES && done < count; n++, done++) {
            const double *of = row + ROW * done;
            node[n] =
                (tl_element_node){(tl_id)of[0], tl_v3(of[2], of[3], of[4]), tl_v3(of[5], of[6], of[7]), fmax(of[8], 0)};
            state[INCOMING_NODE_STATES * n + INCOMING_ALONG] = of[9];
            state[INCOMING_NODE_STATES * n + INCOMING_ACROSS] = of[10];
        }
        const double whole[] = {first[5], first[6], first[7], first[1] + 1};
        status = host->add(
            host, &(tl_new_element){
                      .size = sizeof(tl_new_element), .nodes = node, .count = n, .node_state = state, .state = whole});
    }
    return status;
}

static tl_status place(const tl_element_host *host, const void *given)
{
    const incoming_params *p = given;
    const size_t numbers = half_space_numbers(p->nodes, NULL);
    if (numbers == SIZE_MAX || numbers == 0 || numbers % ROW)
        return host->fail(host, TL_E_ARGUMENT,
                          "nodes must be rows of %d finite numbers: block, face, place, normal, area and impedances",
                          ROW);
    double *rows = malloc(numbers * sizeof *rows);
    if (!rows)
        return host->fail(host, TL_E_MEMORY, "out of memory");
    half_space_numbers(p->nodes, rows);
    tl_status status = TL_OK;
    for (size_t i = 0, end; i < numbers / ROW && status == TL_OK; i = end) {
        const double *first = rows + ROW * i;
        for (end = i; end < numbers / ROW; end++)
            if (rows[ROW * end] != first[0] || rows[ROW * end + 1] != first[1])
                break;
        status = place_face(host, first, end - i);
    }
    free(rows);
    return status;
}

static tl_status update(const void *self, const tl_element_batch *b, tl_report *report)
{
    (void)report;
    const wave_kind *kind = self;
    const tl_vec3 w = half_space_speed(kind->wave, b->time);
    for (uint32_t e = 0; e < b->count; e++) {
        double work = 0;
        for (uint32_t i = b->start[e]; i < b->start[e + 1]; i++) {
            const tl_vec3 n = {b->normal[0][i], b->normal[1][i], b->normal[2][i]};
            const double z[2] = {b->state[INCOMING_ALONG][i], b->state[INCOMING_ACROSS][i]};
            const tl_vec3 f = tl_v3_scale(2 * b->weight[i], half_space_parts(z, w, n));
            const double force[] = {f.x, f.y, f.z};
            for (int k = 0; k < 3; k++) {
                work += 0.5 * (b->force[k][i] + force[k]) * b->du[k][i];
                b->force[k][i] = force[k];
            }
        }
        b->given[e] = work;
    }
    return TL_OK;
}

/* Forces do not depend on what the block does. */
static void stiffness(const void *self, const tl_element_batch *b, double *k, double *c)
{
    (void)self, (void)b, (void)k, (void)c;
}

const tl_element_ops incoming_ops = {.size = sizeof incoming_ops,
                                     .create = create,
                                     .place = place,
                                     .update = update,
                                     .stiffness = stiffness,
                                     .destroy = half_space_destroy,
                                     .never_fails = 1};
