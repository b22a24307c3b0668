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
#include <talus/kit.h>
#include <talus/version.h>

/* Limit: nodes of a face. Three of A / 3 have the second moments of its area. */
#define POINTS 3

typedef struct params {
    const char *faces;
    double kn, ks, p_velocity, s_velocity;
    const char *input_x, *input_y, *input_z;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, params, faces, "",
             "Numbers: block, face (from 0), area (m2), height (m) and density (kg/m3), of one face after the other.",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_REAL, params, kn, "Pa/m", "Normal stiffness of the joints.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, params, ks, "Pa/m", "Shear stiffness of the joints.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, params, p_velocity, "m/s", "In the place of kn: of pressure waves in what was cut off.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, params, s_velocity, "m/s", "In the place of ks: of shear waves in what was cut off.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_STRING, params, input_x, "",
             "Incoming wave along x, numbers: time of its begin (s), time between samples (s), then displacement (m) "
             "and velocity (m/s) of each sample.",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, params, input_y, "", "Incoming wave along y, likewise.", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, params, input_z, "", "Incoming wave along z, likewise.", .flags = TL_PARAM_OPTIONAL)};

enum { SHIFT_X, SHIFT_Y, SHIFT_Z };                           /* of a node */
enum { NORMAL_X, NORMAL_Y, NORMAL_Z, FACE, HEIGHT, DENSITY }; /* of the whole */

static const tl_state state_table[] = {TL_STATE(TL_STATE_SCALAR, "shift_x", "m", "displacement of the dashpot"),
                                       TL_STATE(TL_STATE_SCALAR, "shift_y", "m", "likewise"),
                                       TL_STATE(TL_STATE_SCALAR, "shift_z", "m", "likewise"),
                                       TL_STATE(TL_STATE_WHOLE, "normal_x", "", "outward normal when placed"),
                                       TL_STATE(TL_STATE_WHOLE, "normal_y", "", "likewise"),
                                       TL_STATE(TL_STATE_WHOLE, "normal_z", "", "likewise"),
                                       TL_STATE(TL_STATE_WHOLE, "face", "", "of the block, from 1"),
                                       TL_STATE(TL_STATE_WHOLE, "height", "m", "of the block across the face"),
                                       TL_STATE(TL_STATE_WHOLE, "density", "kg/m3", "of what was cut off")};

/* ---------------------------------------------------------------- waves ------------------ */

/* Displacements and velocities at equal times; in between cubic. */
typedef struct wave {
    double begin, dt;
    size_t count; /* samples; 0: no wave */
    double *sample;
} wave;

/* What `create` makes of the parameters. */
typedef struct face_kind {
    params given;
    wave wave[3];
} face_kind;

/* Reads numbers with blanks between them; how many, or SIZE_MAX when there is something else. `to` may be NULL. */
static size_t read_numbers(const char *text, double *to)
{
    size_t count = 0;
    for (;;) {
        while (*text == ' ')
            text++;
        if (!*text)
            return count;
        const char *end = text;
        const double value = tl_number_read(text, &end);
        if (end == text || !isfinite(value))
            return SIZE_MAX;
        if (to)
            to[count] = value;
        count++;
        text = end;
    }
}

static tl_status read_wave(wave *w, const char *name, const char *text, tl_report *report)
{
    const size_t count = text ? read_numbers(text, NULL) : 0;
    if (count == 0)
        return TL_OK;
    if (count == SIZE_MAX || count < 6 || count % 2)
        return tl_refuse(report,
                         "%s is no list of finite numbers {begin, dt, displacement, velocity, ...} with 2 samples or "
                         "more: give a record as input of model:boundary",
                         name);
    double *all = malloc(count * sizeof *all);
    if (!all)
        return TL_E_MEMORY;
    read_numbers(text, all);
    *w = (wave){all[0], all[1], count / 2 - 1, all};
    if (!(w->dt > 0))
        return tl_refuse(report, "%s has dt = %g s between samples, which must be > 0", name, w->dt);
    return TL_OK;
}

/* Displacement of the wave at a time, m. Velocities that are quadratic between samples have it exactly. */
static double wave_at(const wave *w, double time)
{
    const double t = time - w->begin;
    if (w->count == 0 || !(t > 0))
        return 0;
    const double *first = w->sample + 2, place = t / w->dt;
    const size_t last = w->count - 1;
    if (place >= (double)last)
        return first[2 * last] + first[2 * last + 1] * (t - (double)last * w->dt) - first[0];
    const size_t i = (size_t)place;
    const double *at = first + 2 * i, x = place - (double)i, rise = at[2] - at[0];
    const double v = at[1] * w->dt, after = at[3] * w->dt;
    return (at[0] - first[0]) + x * (v + x * ((3 * rise - 2 * v - after) + x * (v + after - 2 * rise)));
}

static void destroy(void *self)
{
    face_kind *k = self;
    for (int i = 0; k && i < 3; i++)
        free(k->wave[i].sample);
    free(k);
}

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    const bool joint = !isnan(p->kn) && !isnan(p->ks), rock = !isnan(p->p_velocity) && !isnan(p->s_velocity);
    if (joint == rock)
        return tl_refuse(report, "give either kn and ks of the joints, or p_velocity and s_velocity of the rock");
    face_kind *k = calloc(1, sizeof *k);
    if (!k)
        return TL_E_MEMORY;
    k->given = *p;
    tl_status status = read_wave(&k->wave[0], "input_x", p->input_x, report);
    if (status == TL_OK)
        status = read_wave(&k->wave[1], "input_y", p->input_y, report);
    if (status == TL_OK)
        status = read_wave(&k->wave[2], "input_z", p->input_z, report);
    if (status != TL_OK) {
        destroy(k);
        return status;
    }
    *self = k;
    return TL_OK;
}

/* ---------------------------------------------------------------- placing ---------------- */

/* Three points of a polygon in its plane, of weight A / 3 each, with its centroid and second moments: x = c + sqrt(2) L
 * y for three unit vectors y at 120 degrees, L L^t the second moments per area. */
static void points_of(const tl_element_face *f, tl_vec3 at[POINTS])
{
    static const double way[POINTS][2] = {{1, 0}, {-0.5, 0.86602540378443864676}, {-0.5, -0.86602540378443864676}};
    const tl_vec3 o = f->corners[0], t = tl_v3_unit(tl_v3_sub(f->corners[1], o)), b = tl_v3_cross(f->normal, t);
    double area = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;
    for (size_t i = 1; i + 1 < f->corner_count; i++) {
        const tl_vec3 p = tl_v3_sub(f->corners[i], o), q = tl_v3_sub(f->corners[i + 1], o);
        const double pu = tl_v3_dot(p, t), pv = tl_v3_dot(p, b), qu = tl_v3_dot(q, t), qv = tl_v3_dot(q, b);
        const double a = 0.5 * (pu * qv - pv * qu);
        area += a;
        u += a * (pu + qu) / 3;
        v += a * (pv + qv) / 3;
        uu += a * (pu * pu + pu * qu + qu * qu) / 6;
        uv += a * (2 * pu * pv + pu * qv + qu * pv + 2 * qu * qv) / 12;
        vv += a * (pv * pv + pv * qv + qv * qv) / 6;
    }
    u /= area;
    v /= area;
    uu = uu / area - u * u;
    uv = uv / area - u * v;
    vv = vv / area - v * v;
    const double l = sqrt(fmax(uu, 0)), k = l > 0 ? uv / l : 0, n = sqrt(fmax(vv - k * k, 0)), far = sqrt(2);
    for (int i = 0; i < POINTS; i++)
        at[i] = tl_v3_madd(tl_v3_madd(o, u + far * way[i][0] * l, t), v + far * (way[i][0] * k + way[i][1] * n), b);
}

static tl_status place_face(const tl_element_host *host, const tl_element_face *f, const double row[5])
{
    tl_vec3 at[POINTS];
    tl_element_node nodes[POINTS];
    points_of(f, at);
    for (int i = 0; i < POINTS; i++)
        nodes[i] = (tl_element_node){f->block, at[i], f->normal, row[2] / POINTS};
    const double state[] = {f->normal.x, f->normal.y, f->normal.z, f->face + 1, row[3], row[4]};
    return host->add(
        host, &(tl_new_element){.size = sizeof(tl_new_element), .nodes = nodes, .count = POINTS, .state = state});
}

/* The row of a face in the list, NULL: it is not in it. Both go by ascending blocks and faces. */
static const double *row_of(const double *rows, size_t count, size_t *from, const tl_element_face *f)
{
    while (*from < count) {
        const double *row = rows + 5 * *from;
        if (row[0] == f->block && row[1] == f->face)
            return row;
        if (row[0] > f->block || (row[0] == f->block && row[1] > f->face))
            return NULL;
        ++*from;
    }
    return NULL;
}

static tl_status place(const tl_element_host *host, const void *given)
{
    const params *p = given;
    const size_t numbers = read_numbers(p->faces, NULL);
    if (numbers == SIZE_MAX || numbers == 0 || numbers % 5)
        return host->fail(host, TL_E_ARGUMENT,
                          "faces must be rows of 5 finite numbers: block, face, area, height, density");
    double *rows = malloc(numbers * sizeof *rows);
    if (!rows)
        return host->fail(host, TL_E_MEMORY, "out of memory");
    read_numbers(p->faces, rows);
    const tl_element_face *faces;
    size_t count, from = 0, placed = 0;
    tl_status status = host->faces(host, NULL, tl_v3(0, 0, 0), 0, &faces, &count);
    for (size_t i = 0; status == TL_OK && i < count; i++) {
        const double *row = row_of(rows, numbers / 5, &from, &faces[i]);
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

/* Stiffness k and impedance z of a unit area, across the face and along it. a = k dt / (2 z) is the part of the way of
 * the block by which the dashpot follows in half a step; inverse = 1 / (1 + a). */
typedef struct half_space {
    double k[2], z[2], a[2], inverse[2];
} half_space;

static half_space half_space_of(const params *p, double height, double density, double dt)
{
    const bool rock = isnan(p->kn);
    const double modulus = density / height, mass = density * height;
    const double kn = rock ? modulus * p->p_velocity * p->p_velocity : p->kn;
    const double ks = rock ? modulus * p->s_velocity * p->s_velocity : p->ks;
    half_space h = {.k = {2 * kn, 2 * ks}, .z = {sqrt(kn * mass), sqrt(ks * mass)}};
    for (int i = 0; i < 2; i++) {
        h.a[i] = 0.5 * dt * h.k[i] / h.z[i];
        h.inverse[i] = 1 / (1 + h.a[i]);
    }
    return h;
}

/* The form c[1] x . x + (c[0] - c[1]) (x . n)^2: c[0] counts across a face and c[1] along it. */
static double square(const double c[2], tl_vec3 x, tl_vec3 n)
{
    const double across = tl_v3_dot(x, n);
    return c[1] * tl_v3_dot(x, x) + (c[0] - c[1]) * across * across;
}

/* What the nodes of an element do in a step, J: `work` is that of the blocks on them. */
typedef struct sums {
    double stored, lost, work, area;
} sums;

/* Moves the dashpot of node i along, and puts the force on the block. */
static void act(const half_space *h, const tl_element_batch *b, uint32_t i, tl_vec3 n, tl_vec3 in, sums *sum)
{
    const double area = b->weight[i], per = b->dt > 0 ? 1 / b->dt : 0;
    const tl_vec3 u = {b->u[0][i], b->u[1][i], b->u[2][i]}, du = {b->du[0][i], b->du[1][i], b->du[2][i]};
    const tl_vec3 s = {b->state[SHIFT_X][i], b->state[SHIFT_Y][i], b->state[SHIFT_Z][i]};
    /* s1 (1 + a) = s + 2 in + a (u0 - s + u1) */
    const tl_vec3 p = tl_v3_madd(s, 2, in), r = tl_v3_add(tl_v3_sub(u, s), tl_v3_sub(u, du));
    const double pn = tl_v3_dot(p, n), rn = tl_v3_dot(r, n);
    const double across = h->inverse[0] * (pn + h->a[0] * rn) - h->inverse[1] * (pn + h->a[1] * rn);
    const tl_vec3 now = tl_v3_madd(tl_v3_scale(h->inverse[1], tl_v3_madd(p, h->a[1], r)), across, n);
    const tl_vec3 d = tl_v3_sub(u, now), out = tl_v3_sub(tl_v3_sub(now, s), in);
    const tl_vec3 f = tl_v3_madd(tl_v3_scale(area * h->k[1], d), area * (h->k[0] - h->k[1]) * tl_v3_dot(d, n), n);
    sum->stored += 0.5 * area * square(h->k, d, n);
    sum->lost += per * area * square(h->z, out, n);
    sum->area += area;
    double force[] = {-f.x, -f.y, -f.z};
    for (int k = 0; k < 3; k++) {
        sum->work -= 0.5 * (b->force[k][i] + force[k]) * b->du[k][i];
        b->force[k][i] = force[k];
    }
    b->state[SHIFT_X][i] = now.x;
    b->state[SHIFT_Y][i] = now.y;
    b->state[SHIFT_Z][i] = now.z;
}

static tl_status update(const void *self, const tl_element_batch *b, tl_report *report)
{
    (void)report;
    const face_kind *kind = self;
    double in[3];
    for (int k = 0; k < 3; k++)
        in[k] = b->dt > 0 ? wave_at(&kind->wave[k], b->time) - wave_at(&kind->wave[k], b->time - b->dt) : 0;
    const tl_vec3 wave_in = {in[0], in[1], in[2]};
    for (uint32_t e = 0; e < b->count; e++) {
        double *const *of = b->element_state;
        const half_space h = half_space_of(&kind->given, of[HEIGHT][e], of[DENSITY][e], b->dt);
        const tl_vec3 n = {of[NORMAL_X][e], of[NORMAL_Y][e], of[NORMAL_Z][e]};
        sums sum = {0, 0, 0, 0};
        bool gone = false; /* a part of the block, and with it what the springs there hold */
        for (uint32_t i = b->start[e]; i < b->start[e + 1]; i++) {
            gone = gone || b->weight[i] == 0;
            act(&h, b, i, n, wave_in, &sum);
        }
        b->given[e] = b->dt > 0 ? sum.area * square(h.z, wave_in, n) / b->dt : 0;
        b->lost[e] = gone ? b->stored[e] + sum.work + b->given[e] - sum.stored : sum.lost;
        b->stored[e] = sum.stored;
    }
    return TL_OK;
}

static void stiffness(const void *self, const tl_element_batch *b, double *k, double *c)
{
    const face_kind *kind = self;
    (void)c;
    for (uint32_t e = 0; e < b->count; e++) {
        const half_space h = half_space_of(&kind->given, b->element_state[HEIGHT][e], b->element_state[DENSITY][e], 0);
        for (uint32_t i = b->start[e]; i < b->start[e + 1]; i++)
            k[i] = fmax(h.k[0], h.k[1]) * b->weight[i];
    }
}

static const tl_element_ops ops = {.size = sizeof ops,
                                   .create = create,
                                   .place = place,
                                   .update = update,
                                   .stiffness = stiffness,
                                   .destroy = destroy,
                                   .never_fails = 1};

static const tl_kind kind = TL_KIND(TL_KIND_ELEMENT, ops, .name = "quiet",
                                    .doc = "Outer faces of rigid blocks that let waves out: model:boundary.",
                                    TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN_SINCE(13, kind, .id = "talus.quiet", .version = TALUS_VERSION, .doc = "Quiet faces.",
                .licence = "BSD-3-Clause");
