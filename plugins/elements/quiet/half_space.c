/* half_space.c - waves as lists of numbers, and points of faces. */
#include "half_space.h"

/* ---------------------------------------------------------------- waves ------------------ */

size_t half_space_numbers(const char *text, double *to)
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
    const size_t count = text ? half_space_numbers(text, NULL) : 0;
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
    half_space_numbers(text, all);
    *w = (wave){all[0], all[1], count / 2 - 1, all};
    if (!(w->dt > 0))
        return tl_refuse(report, "%s has dt = %g s between samples, which must be > 0", name, w->dt);
    return TL_OK;
}

void half_space_destroy(void *self)
{
    wave *w = self;
    for (int k = 0; w && k < 3; k++)
        free(w[k].sample);
    free(self);
}

tl_status half_space_create(const char *const input[3], size_t size, void **self, tl_report *report)
{
    static const char *const names[] = {"input_x", "input_y", "input_z"};
    wave *w = calloc(1, size);
    tl_status status = w ? TL_OK : TL_E_MEMORY;
    for (int k = 0; k < 3 && status == TL_OK; k++)
        status = read_wave(&w[k], names[k], input[k], report);
    if (status != TL_OK) {
        half_space_destroy(w);
        w = NULL;
    }
    *self = w;
    return status;
}

tl_status half_space_check(double kn, double ks, double p_velocity, double s_velocity, tl_report *report)
{
    const bool joint = !isnan(kn) && !isnan(ks), rock = !isnan(p_velocity) && !isnan(s_velocity);
    if (joint == rock)
        return tl_refuse(report, "give either kn and ks of the joints, or p_velocity and s_velocity of the rock");
    return half_space_order(p_velocity, s_velocity, report);
}

tl_status half_space_order(double p_velocity, double s_velocity, tl_report *report)
{
    return !(s_velocity > p_velocity)
               ? TL_OK
               : tl_refuse(report,
                           "shear waves of s_velocity = %g m/s are faster than pressure waves of p_velocity = %g m/s: "
                           "in no rock they are, so look whether the two are exchanged",
                           s_velocity, p_velocity);
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

/* Velocity of the wave at a time, m/s: what wave_at grows by. */
static double speed_at(const wave *w, double time)
{
    const double t = time - w->begin;
    if (w->count == 0 || !(t > 0))
        return 0;
    const double *first = w->sample + 2, place = t / w->dt;
    const size_t last = w->count - 1;
    if (place >= (double)last)
        return first[2 * last + 1];
    const size_t i = (size_t)place;
    const double *at = first + 2 * i, x = place - (double)i, mean = (at[2] - at[0]) / w->dt;
    return at[1] + x * (2 * (3 * mean - 2 * at[1] - at[3]) + 3 * x * (at[1] + at[3] - 2 * mean));
}

tl_vec3 half_space_speed(const wave w[3], double time)
{
    return tl_v3(speed_at(&w[0], time), speed_at(&w[1], time), speed_at(&w[2], time));
}

tl_vec3 half_space_came(const wave w[3], double time, double dt)
{
    double in[3];
    for (int k = 0; k < 3; k++)
        in[k] = dt > 0 ? wave_at(&w[k], time) - wave_at(&w[k], time - dt) : 0;
    return tl_v3(in[0], in[1], in[2]);
}

/* ---------------------------------------------------------------- faces ------------------ */

const double *half_space_row(const double *rows, size_t width, size_t count, size_t *from, const tl_element_face *f)
{
    while (*from < count) {
        const double *row = rows + width * *from;
        if (row[0] == f->block && row[1] == f->face)
            return row;
        if (row[0] > f->block || (row[0] == f->block && row[1] > f->face))
            return NULL;
        ++*from;
    }
    return NULL;
}

/* x = c + sqrt(2) L y for three unit vectors y at 120 degrees, L L^t the second moments per area. */
void half_space_points(const tl_element_face *f, tl_vec3 at[POINTS])
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
