/* test_stiffen.c - stiffer joints: every law is as if it had been given stiffer parameters, and bears more; what fails changes nothing. */
#include "base/params.h"
#include "law_cases.h"

#include <math.h>
#include <string.h>
#include <talus/fields.h>
#include <talus/plugins.h>
#include <talus/state.h>

#define FACTOR 10.0

/* A cube on a held one, both without free components: forces follow from the law alone. */
static tl_model *pressed(const char *kind, const tl_args *args)
{
    static const double low[3] = {0, 0, 0}, high[3] = {1, 1, 1}, below[3] = {0, 0, -1}, top[3] = {1, 1, 0};
    const tl_model_config config = {.size = sizeof config, .seed = 1, .threads = 1};
    tl_value one[] = {{.key = "min", .type = TL_VALUE_NUMBERS, .data = low, .count = 3},
                      {.key = "max", .type = TL_VALUE_NUMBERS, .data = high, .count = 3},
                      NUMBER("density", 2000)};
    tl_value other[] = {{.key = "min", .type = TL_VALUE_NUMBERS, .data = below, .count = 3},
                        {.key = "max", .type = TL_VALUE_NUMBERS, .data = top, .count = 3},
                        NUMBER("density", 2000)};
    const tl_args cube = {one, 3}, base = {other, 3};
    tl_timestep step = tl_timestep_default();
    step.dt = 1e-5;
    tl_drive drive = tl_drive_default();
    drive.velocity = (tl_vec3){1e-4, 0, -1e-3};
    const tl_id moved = 1, held = 2;
    tl_error error;
    tl_model *m;
    if (tl_model_create(&config, &m, &error) != TL_OK || tl_generate(m, "box", &cube, NULL) != TL_OK ||
        tl_generate(m, "box", &base, NULL) != TL_OK || tl_blocks_fix(m, &held, 1, TL_FIX_ALL) != TL_OK ||
        tl_blocks_drive(m, &moved, 1, &drive) != TL_OK || tl_model_timestep(m, &step) != TL_OK ||
        tl_joint_law(m, "*", kind, args) != TL_OK) {
        printf("%s\n", tl_model_error(m)->text);
        exit(1);
    }
    return m;
}

/* Closes the joint by 1e-6 m and shears it by 1e-7 m; the forces, N. */
static void press(tl_model *m, double *normal, double *shear)
{
    const tl_contact_filter any = {.size = sizeof any};
    tl_contact_name *names;
    size_t count, width;
    double tangent[3] = {0, 0, 0};
    CHECK_INT(tl_model_cycle(m, 100, NULL), TL_OK);
    if (!CHECK_INT(tl_contacts_select(m, &any, &names, &count), TL_OK) || !CHECK_INT(count, 1))
        exit(1);
    CHECK_INT(tl_contacts_values(m, names, 1, "normal_force", normal, &width), TL_OK);
    CHECK_INT(tl_contacts_values(m, names, 1, "shear_force", tangent, &width), TL_OK);
    *shear = sqrt(tangent[0] * tangent[0] + tangent[1] * tangent[1] + tangent[2] * tangent[2]);
    free(names);
}

/* Whether a law is one of those that Talus comes with. */
static bool is_ours(const tl_kind *kind)
{
    return strncmp(tl_plugin_of(kind, NULL)->id, "talus.", 6) == 0;
}

TEST(every_law_has_a_case)
{
    const tl_kind *kind;
    size_t tried = 0;
    for (size_t i = 0; (kind = tl_plugin_kind(TL_KIND_LAW, i)) != NULL; i++) {
        bool found = !is_ours(kind);
        for (int number = 0; number < LAWS; number++)
            found = found || strcmp(law_cases[number].name, kind->name) == 0;
        if (!CHECK(found))
            printf("no case of law '%s'\n", kind->name);
        tried += is_ours(kind);
    }
    CHECK(tried >= 8);
}

/* "Pa/m", "Pa^(1-en)/m". */
static bool is_stiffness_unit(const char *unit)
{
    const size_t length = strlen(unit);
    return length > 3 && strncmp(unit, "Pa", 2) == 0 && strcmp(unit + length - 2, "/m") == 0;
}

TEST(stiffer_is_as_if_given_so)
{
    for (int number = 0; number < LAWS; number++) {
        const law_case *of = &law_cases[number];
        const tl_kind *kind = tl_plugin_find(TL_KIND_LAW, of->name);
        tl_value values[16];
        size_t stiff = 0;
        for (size_t i = 0; i < of->args.count; i++) {
            values[i] = of->args.values[i];
            for (uint32_t k = 0; k < kind->param_count; k++) {
                const tl_param p = tl_param_row(kind->params, k, kind->param_stride);
                if (strcmp(p.name, values[i].key) == 0 && is_stiffness_unit(p.unit)) {
                    values[i].number *= FACTOR;
                    stiff++;
                }
            }
        }
        CHECK(stiff >= 2);
        const tl_args given = {values, of->args.count};
        tl_model *plain = pressed(of->name, &of->args), *made = pressed(of->name, &of->args);
        tl_model *wanted = pressed(of->name, &given);
        CHECK_INT(tl_joints_stiffen(made, FACTOR), TL_OK);
        double soft[2], stiffer[2], as_given[2];
        press(plain, &soft[0], &soft[1]);
        press(made, &stiffer[0], &stiffer[1]);
        press(wanted, &as_given[0], &as_given[1]);
        for (int i = 0; i < 2; i++) {
            CHECK(soft[i] > 0);
            CHECK(stiffer[i] == as_given[i]);
            if (!CHECK(stiffer[i] > 0.9 * FACTOR * soft[i]))
                printf("%s: %g N becomes %g N\n", of->name, soft[i], stiffer[i]);
        }
        tl_model_destroy(plain);
        tl_model_destroy(made);
        tl_model_destroy(wanted);
    }
}

/* The forces and the hash of a model that was refused to be made stiffer are those of one that never was asked. */
TEST(a_refusal_changes_nothing)
{
    static const double factors[] = {0, -1, NAN, INFINITY, 1e45};
    tl_model *m = pressed("coulomb", &law_cases[1].args), *other = pressed("coulomb", &law_cases[1].args);
    char before[33], after[33];
    CHECK_INT(tl_state_hash(m, before), TL_OK);
    for (size_t i = 0; i < sizeof factors / sizeof factors[0]; i++) {
        CHECK_INT(tl_joints_stiffen(m, factors[i]), TL_E_ARGUMENT);
        CHECK_INT(tl_state_hash(m, after), TL_OK);
        CHECK_TEXT(after, before);
    }
    double a[2], b[2];
    press(m, &a[0], &a[1]);
    press(other, &b[0], &b[1]);
    CHECK(a[0] == b[0] && a[1] == b[1]);
    tl_model_destroy(m);
    tl_model_destroy(other);
}

/* ---------------------------------------------------------------- without memory ----------
 *
 * The program's own allocator fails when it is told to. With sanitizers, which have theirs, none fails. */

#if defined(__has_feature)
#define SANITIZED (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer))
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

static long asked, fails_at; /* allocations since it was told; the one that fails, 0: none */

#if defined(__GLIBC__) && !SANITIZED
#define MAY_FAIL 1

extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *p, size_t size);

static int fails(void)
{
    return fails_at && ++asked == fails_at;
}

void *malloc(size_t size)
{
    return fails() ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return fails() ? NULL : __libc_calloc(count, size);
}

void *realloc(void *p, size_t size)
{
    return fails() ? NULL : __libc_realloc(p, size);
}
#else
#define MAY_FAIL 0
#endif

/* Whichever allocation fails, none of several laws has become stiffer, and forces are those of a model that was never
 * asked. Asked again, all have. */
TEST(without_memory_no_law_changes)
{
    const tl_id upper = 1;
    tl_law_scope scope = tl_law_scope_default();
    scope.blocks[0] = &upper;
    scope.block_count[0] = 1;
    tl_model *m = pressed("coulomb", &law_cases[1].args);
    CHECK_INT(tl_joint_law_for(m, &scope, "elastic", &law_cases[0].args), TL_OK);
    double force[2], after[2];
    char before[33], now[33];
    press(m, &force[0], &force[1]);
    CHECK_INT(tl_state_hash(m, before), TL_OK);
    long refused = 0;
    tl_status status = TL_E_MEMORY;
    for (long n = 1; MAY_FAIL && status == TL_E_MEMORY; n++) {
        tl_model *other;
        CHECK_INT(tl_model_copy(m, NULL, NULL, &other), TL_OK);
        asked = 0;
        fails_at = n;
        status = tl_joints_stiffen(other, FACTOR);
        fails_at = 0;
        CHECK(status == TL_OK || status == TL_E_MEMORY);
        CHECK_INT(tl_state_hash(other, now), TL_OK);
        CHECK((strcmp(now, before) == 0) == (status != TL_OK));
        refused += status != TL_OK;
        tl_model_destroy(other);
    }
    CHECK(!MAY_FAIL || refused > 4);
    CHECK_INT(tl_joints_stiffen(m, FACTOR), TL_OK);
    for (size_t i = 0; i < 2; i++) {
        const tl_law_info of = tl_law_at(m, i);
        double kn;
        memcpy(&kn, (const char *)of.params + tl_param_row(of.law->params, 0, of.law->param_stride).offset, sizeof kn);
        CHECK_NEAR(kn, FACTOR * KN, 0);
    }
    press(m, &after[0], &after[1]);
    CHECK(after[0] > 0);
    tl_model_destroy(m);
}

/* A value of a contact's field or of a state of its law, and of vectors the length. */
static double value_of(tl_model *m, const char *name)
{
    const tl_contact_filter any = {.size = sizeof any};
    tl_contact_name *names;
    size_t count, width;
    double value[3] = {0, 0, 0};
    if (!CHECK_INT(tl_contacts_select(m, &any, &names, &count), TL_OK) || !CHECK_INT(count, 1))
        exit(1);
    CHECK_INT(tl_contacts_values(m, names, 1, name, value, &width), TL_OK);
    free(names);
    return width == 3 ? sqrt(value[0] * value[0] + value[1] * value[1] + value[2] * value[2]) : value[0];
}

/* What the curves of the head of barton_bandis.c say of the shear stress, Pa, at a displacement u, of the case. */
static double rough_strength(double stress, double u)
{
    const double jrc = 10 * pow(10, -0.2), jcs = 2e7 * pow(10, -0.3), peak = 1 / 500. * pow(jrc, 0.33), x = u / peak;
    static const double at[] = {0.3, 0.6, 1, 2, 4, 10, 25, 100}, m[] = {0, 0.75, 1, 0.85, 0.7, 0.5, 0.4, 0};
    double mobilised = 0;
    for (int k = 1; k < 8; k++)
        if (x > at[k - 1] && x <= at[k])
            mobilised = m[k - 1] + (x - at[k - 1]) * (m[k] - m[k - 1]) / (at[k] - at[k - 1]);
    const double base = x < 0.3 ? x / 0.3 : 1, degree = acos(-1) / 180;
    return stress * tan((base * FRICTION + mobilised * jrc * log10(jcs / stress)) * degree);
}

/* The displacement by which the roughness of barton_bandis is mobilised has the stretch of the shear spring, f / (A ks).
 * A spring ten times as stiff is stretched by a tenth, so a joint that slips is further back on its curve: it carries
 * what the curve says there. */
TEST(rough_joints_go_back_on_their_curve)
{
    for (int number = 0; number < LAWS; number++) {
        if (strcmp(law_cases[number].name, "barton_bandis") != 0)
            continue;
        tl_model *m = pressed(law_cases[number].name, &law_cases[number].args);
        double force[2], after[2];
        tl_drive drive = tl_drive_default();
        const tl_id moved = 1;
        for (int k = 0; k < 20; k++)
            press(m, &force[0], &force[1]);
        CHECK_INT(tl_blocks_drive(m, &moved, 1, &drive), TL_OK);
        press(m, &force[0], &force[1]);
        const double area = value_of(m, "area"), slip = value_of(m, "slip"), stress = force[0] / area;
        const double u = slip + force[1] / area / KS, back = slip + force[1] / area / (FACTOR * KS);
        CHECK(slip > 0);
        CHECK_NEAR(force[1] / area, rough_strength(stress, u), 1e-6 * stress);
        CHECK_INT(tl_joints_stiffen(m, FACTOR), TL_OK);
        press(m, &after[0], &after[1]);
        CHECK_NEAR(after[1] / area, rough_strength(stress, back), 1e-6 * stress);
        CHECK(after[1] != force[1]);
        tl_model_destroy(m);
    }
}

/* Left out are rate_state, whose force changes in time, and barton_bandis, of which the test above is. */
TEST(forces_stay_as_they_are)
{
    for (int number = 0; number < LAWS; number++) {
        if (law_cases[number].ages || strcmp(law_cases[number].name, "barton_bandis") == 0)
            continue;
        tl_model *m = pressed(law_cases[number].name, &law_cases[number].args);
        double before[2], after[2];
        press(m, &before[0], &before[1]);
        const tl_drive still = tl_drive_default();
        const tl_id moved = 1;
        CHECK_INT(tl_blocks_drive(m, &moved, 1, &still), TL_OK);
        press(m, &before[0], &before[1]);
        CHECK_INT(tl_joints_stiffen(m, FACTOR), TL_OK);
        press(m, &after[0], &after[1]);
        for (int i = 0; i < 2; i++)
            if (!CHECK_NEAR(after[i], before[i], 1e-9 * before[i]))
                printf("law '%s'\n", law_cases[number].name);
        tl_model_destroy(m);
    }
}

int main(void)
{
    tl_plugins_load_default();
    RUN(every_law_has_a_case);
    RUN(stiffer_is_as_if_given_so);
    RUN(a_refusal_changes_nothing);
    RUN(without_memory_no_law_changes);
    RUN(rough_joints_go_back_on_their_curve);
    RUN(forces_stay_as_they_are);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
