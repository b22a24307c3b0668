/* quiet.c - element "quiet": outer faces of rigid blocks that let waves out, and let one in.
 *
 * An element is a face. Behind each of its nodes stands the half space that was cut off. Half of the block's own rock
 * is a spring, and behind it the half space is a dashpot. A node of area A moves by u, the dashpot by s and an incoming
 * wave by w:
 *
 *     f = K (u - s),    Z (s' - 2 w') = f,    force on the block = -f
 *
 * across the face K = 2 kn A and Z = A sqrt(kn rho h), along it K = 2 ks A and Z = A sqrt(ks rho h); kn and ks are
 * those of the joints, Pa/m, rho the density and h the height of the block across the face. A row of such blocks bears
 * waves as a lattice does. A dashpot alone leaves the outer half of a block as a mass. At an angular frequency
 * q it reflects (q h / 4c)^2 of the energy (Lysmer and Kuhlemeyer 1969). With the spring the first order cancels. Of
 * given velocities c of waves, kn h = rho c^2. An incoming wave acts as the traction 2 rho c w' (Joyner and Chen 1975).
 *
 * s is centred in the step: s1 - s0 = dt (f0 + f1) / (2 Z) + 2 (w1 - w0). The wave brings Z w'^2 per time; the wave
 * that leaves takes Z (s' - w')^2. Their difference is the work of the step to rounding. */
#include "half_space.h"
#include "kinds.h"

/* ---------------------------------------------------------------- kinds ------------------ */

/* What `create` makes of the parameters. */
typedef struct face_kind {
    wave wave[3]; /* first: half_space.h */
    quiet_params given;
} face_kind;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const quiet_params *p = given;
    tl_status status = half_space_check(p->kn, p->ks, p->p_velocity, p->s_velocity, report);
    if (status != TL_OK)
        return status;
    const char *const input[] = {p->input_x, p->input_y, p->input_z};
    status = half_space_create(input, sizeof(face_kind), self, report);
    face_kind *k = *self;
    if (k)
        k->given = *p;
    return status;
}

/* ---------------------------------------------------------------- placing ---------------- */

static tl_status place_face(const tl_element_host *host, const tl_element_face *f, const double row[5])
{
    tl_vec3 at[POINTS];
    tl_element_node nodes[POINTS];
    half_space_points(f, at);
    for (int i = 0; i < POINTS; i++)
        nodes[i] = (tl_element_node){f->block, at[i], f->normal, row[2] / POINTS};
    const double state[] = {f->normal.x, f->normal.y, f->normal.z, f->face + 1, row[3], row[4]};
    return host->add(
        host, &(tl_new_element){.size = sizeof(tl_new_element), .nodes = nodes, .count = POINTS, .state = state});
}

static tl_status place(const tl_element_host *host, const void *given)
{
    const quiet_params *p = given;
    const size_t numbers = half_space_numbers(p->faces, NULL);
    if (numbers == SIZE_MAX || numbers == 0 || numbers % 5)
        return host->fail(host, TL_E_ARGUMENT,
                          "faces must be rows of 5 finite numbers: block, face, area, height, density");
    double *rows = malloc(numbers * sizeof *rows);
    if (!rows)
        return host->fail(host, TL_E_MEMORY, "out of memory");
    half_space_numbers(p->faces, rows);
    const tl_element_face *faces;
    size_t count, from = 0, placed = 0;
    tl_status status = host->faces(host, NULL, tl_v3(0, 0, 0), 0, &faces, &count);
    for (size_t i = 0; status == TL_OK && i < count; i++) {
        const double *row = half_space_row(rows, 5, numbers / 5, &from, &faces[i]);
        if (row && !(row[2] > 0 && row[3] > 0 && row[4] > 0))
            status = host->fail(host, TL_E_ARGUMENT,
                                "face %u of block %u has area = %g m2, height = %g m and density = %g kg/m3: all must "
                                "be > 0",
                                faces[i].face + 1, faces[i].block, row[2], row[3], row[4]);
        else if (row) {
            status = place_face(host, &faces[i], row);
            placed++;
        }
    }
    if (status == TL_OK && placed < numbers / 5)
        status = host->fail(host, TL_E_NOT_FOUND,
                            "%zu of %zu faces are no outer faces: list faces of blocks that are there by ascending "
                            "blocks and faces",
                            numbers / 5 - placed, numbers / 5);
    free(rows);
    return status;
}

/* ---------------------------------------------------------------- acting ----------------- */

/* What was cut off behind a face of a block of that height. */
static half_space cut_off(const quiet_params *p, double height, double density, double dt)
{
    return half_space_rock(p->kn, p->ks, p->p_velocity, p->s_velocity, height, density, dt);
}

/* Cost only: nodes that act together, of elements with the same rock behind them. */
#define TILE 96

/* Normals of the nodes of a tile, and what they do in a step, J. */
typedef struct tile {
    double normal[3][TILE], stored[TILE], lost[TILE];
} tile;

/* Moves the dashpots of nodes [first, first + count) along, and puts the forces on the block. */
TL_VECTORIZED static void act(const half_space *behind, const tl_element_batch *b, uint32_t first, uint32_t count,
                              tl_vec3 in, tile *t)
{
    const half_space h = *behind;
    const double *restrict area = b->weight + first;
    const double *restrict u[3] = {b->u[0] + first, b->u[1] + first, b->u[2] + first};
    const double *restrict du[3] = {b->du[0] + first, b->du[1] + first, b->du[2] + first};
    double *restrict shift[3], *restrict force[3];
    for (int k = 0; k < 3; k++) {
        shift[k] = b->state[QUIET_SHIFT_X + k] + first;
        force[k] = b->force[k] + first;
    }
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const tl_vec3 n = {t->normal[0][i], t->normal[1][i], t->normal[2][i]}, at = {u[0][i], u[1][i], u[2][i]};
        const tl_vec3 way = {du[0][i], du[1][i], du[2][i]}, s = {shift[0][i], shift[1][i], shift[2][i]};
        const tl_vec3 now = half_space_follow(&h, s, at, way, in, n);
        const tl_vec3 d = tl_v3_sub(at, now), out = tl_v3_sub(tl_v3_sub(now, s), in);
        const tl_vec3 f = tl_v3_scale(area[i], half_space_parts(h.k, d, n));
        t->stored[i] = 0.5 * tl_v3_dot(f, d);
        t->lost[i] = area[i] * half_space_square(h.z, out, n);
        force[0][i] = -f.x;
        force[1][i] = -f.y;
        force[2][i] = -f.z;
        shift[0][i] = now.x;
        shift[1][i] = now.y;
        shift[2][i] = now.z;
    }
}

/* Half of the work of the blocks on the nodes of element e in a step, with the forces as they are. */
static double half_work(const tl_element_batch *b, uint32_t e)
{
    double sum = 0;
    for (uint32_t i = b->start[e]; i < b->start[e + 1]; i++)
        for (int k = 0; k < 3; k++)
            sum -= 0.5 * b->force[k][i] * b->du[k][i];
    return sum;
}

/* Whether a part of the blocks of elements [begin, end) has gone, and with it what the springs there held. */
TL_VECTORIZED static bool is_gone(const tl_element_batch *b, uint32_t begin, uint32_t end)
{
    const double *restrict area = b->weight;
    double gone = 0;
#pragma omp simd reduction(+ : gone)
    for (uint32_t i = b->start[begin]; i < b->start[end]; i++)
        gone += area[i] == 0 ? 1 : 0;
    return gone > 0;
}

/* Puts what the nodes of element e, from lane `first` of the tile on, do in a step into its books. `per`: 1/s; `gone`:
 * where a part of the block may have gone. */
static void book(const half_space *h, const tl_element_batch *b, uint32_t e, tl_vec3 in, double per, const tile *t,
                 uint32_t first, bool gone)
{
    const tl_vec3 n = {t->normal[0][first], t->normal[1][first], t->normal[2][first]};
    double stored = 0, lost = 0, area = 0;
    for (uint32_t k = b->start[e], i = first; k < b->start[e + 1]; k++, i++) {
        stored += t->stored[i];
        lost += t->lost[i];
        area += b->weight[k];
    }
    b->given[e] = per * area * half_space_square(h->z, in, n);
    b->lost[e] =
        gone && is_gone(b, e, e + 1) ? b->stored[e] + b->lost[e] + half_work(b, e) + b->given[e] - stored : per * lost;
    b->stored[e] = stored;
}

/* The element behind those from e on that act together: with the same rock behind them, as most faces of a side. */
static uint32_t alike_until(const tl_element_batch *b, uint32_t e)
{
    const double *height = b->element_state[QUIET_HEIGHT], *density = b->element_state[QUIET_DENSITY];
    uint32_t end = e + 1;
    while (end < b->count && height[end] == height[e] && density[end] == density[e] &&
           b->start[end + 1] - b->start[e] <= TILE)
        end++;
    return end;
}

static tl_status update(const void *self, const tl_element_batch *b, tl_report *report)
{
    (void)report;
    const face_kind *kind = self;
    const tl_vec3 in = half_space_came(kind->wave, b->time, b->dt);
    const double per = b->dt > 0 ? 1 / b->dt : 0;
    double *const *of = b->element_state;
    tile t;
    for (uint32_t begin = 0, end; begin < b->count; begin = end) {
        end = alike_until(b, begin);
        const uint32_t first = b->start[begin];
        const half_space h = cut_off(&kind->given, of[QUIET_HEIGHT][begin], of[QUIET_DENSITY][begin], b->dt);
        const bool gone = is_gone(b, begin, end);
        for (uint32_t e = begin; e < end; e++) {
            if (gone && is_gone(b, e, e + 1))
                b->lost[e] = half_work(b, e); /* the half that is known before forces are found */
            const double x = of[QUIET_NORMAL_X][e], y = of[QUIET_NORMAL_Y][e], z = of[QUIET_NORMAL_Z][e];
            for (uint32_t i = b->start[e] - first; i < b->start[e + 1] - first; i++) {
                t.normal[0][i] = x;
                t.normal[1][i] = y;
                t.normal[2][i] = z;
            }
        }
        act(&h, b, first, b->start[end] - first, in, &t);
        for (uint32_t e = begin; e < end; e++)
            book(&h, b, e, in, per, &t, b->start[e] - first, gone);
    }
    return TL_OK;
}

static void stiffness(const void *self, const tl_element_batch *b, double *k, double *c)
{
    const face_kind *kind = self;
    (void)c;
    for (uint32_t e = 0; e < b->count; e++) {
        const half_space h =
            cut_off(&kind->given, b->element_state[QUIET_HEIGHT][e], b->element_state[QUIET_DENSITY][e], 0);
        for (uint32_t i = b->start[e]; i < b->start[e + 1]; i++)
            k[i] = fmax(h.k[0], h.k[1]) * b->weight[i];
    }
}

const tl_element_ops quiet_ops = {.size = sizeof quiet_ops,
                                  .create = create,
                                  .place = place,
                                  .update = update,
                                  .stiffness = stiffness,
                                  .destroy = half_space_destroy,
                                  .never_fails = 1};
