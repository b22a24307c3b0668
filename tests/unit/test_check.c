/* test_check.c - the conformance check passes all plugins of Talus, and each of its checks finds the plugin that breaks it. */
#include "check.h"

#include <talus/check.h>
#include <talus/talus.h>

#define UNFIT TALUS_BAD_PLUGIN_DIR "/unfit.so"
#define UNFIT_SOLID TALUS_BAD_PLUGIN_DIR "/unfit_solid.so"

/* What was told of one run. */
typedef struct findings {
    size_t checks, faults;
    char list[400];  /* checks that found something, each with a blank behind */
    char fault[700]; /* the last one's sentence */
} findings;

static void hear(void *user, const tl_check_finding *f)
{
    findings *h = user;
    h->checks++;
    CHECK(f->kind && f->doc[0]);
    if (!f->fault)
        return;
    h->faults++;
    snprintf(h->list + strlen(h->list), sizeof h->list - strlen(h->list), "%s; ", f->check);
    snprintf(h->fault, sizeof h->fault, "%s", f->fault);
}

/* One fault of the plugin that has them all, in the law, the damping, the generator or the screen; the others behave. */
static findings run_unfit(const char *param, const char *fault)
{
    static const char *const params[] = {"law_fault", "damping_fault", "generator_fault", "screen_fault"};
    findings h = {0};
    tl_value values[4];
    size_t faults;
    tl_error error;
    for (int i = 0; i < 4; i++)
        values[i] = tl_arg_text(params[i], strcmp(params[i], param) == 0 ? fault : "none");
    const tl_args args = {values, 4};
    if (!CHECK_INT(tl_plugin_check(UNFIT, &args, hear, &h, &faults, &error), TL_OK))
        printf("  %s\n", error.text);
    CHECK_INT(faults, h.faults);
    return h;
}

/* One fault of the solid that has them all. */
static findings run_solid(const char *fault)
{
    findings h = {0};
    size_t faults;
    tl_error error;
    const tl_value value = tl_arg_text("solid_fault", fault);
    const tl_args args = {&value, 1};
    if (!CHECK_INT(tl_plugin_check(UNFIT_SOLID, &args, hear, &h, &faults, &error), TL_OK))
        printf("  %s\n", error.text);
    CHECK_INT(faults, h.faults);
    return h;
}

TEST(each_check_of_solids_finds_what_breaks_it)
{
    static const char *const cases[][2] = {{"none", ""},
                                           {"runs", "runs; "},
                                           {"alone", "one by one; split; "},
                                           {"split", "one by one; split; "},
                                           {"energies", "energies; "},
                                           {"writes_input", "writes; "},
                                           {"writes_behind", "writes; "},
                                           {"writes_state", "writes; "},
                                           {"adds_state", "writes; "},
                                           {"reads", "reads; "},
                                           {"finite", "finite; "},
                                           {"soft_moduli", "moduli; "},
                                           {"shear_moduli", "moduli; "},
                                           {"stored", "balance; "},
                                           {"energy", "stored; "},
                                           {"heat", "balance; "},
                                           {"cold", "balance; heat; "},
                                           {"flags", "flags; "},
                                           {"states", "states; "},
                                           {"counts", "no strain; "},
                                           {"sign", "moduli; balance; "}};
    static const char *const among[][2] = {
        {"repeats", "repeats; "}, {"still", "no strain; "}, {"turned", "turned; "}, {"cycle", "closed cycle; "}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        findings h = check_takes(i) ? run_solid(cases[i][0]) : (findings){0};
        if (check_takes(i) && !CHECK_TEXT(h.list, cases[i][1]))
            printf("  %s: %s\n", cases[i][0], h.fault);
    }
    for (size_t i = 0; i < sizeof among / sizeof *among; i++)
        if (check_takes(i))
            CHECK_CONTAINS(run_solid(among[i][0]).list, among[i][1]);
}

TEST(each_check_finds_what_breaks_it)
{
    /* what is broken; the checks that must find it, and no others */
    static const struct {
        const char *param, *fault, *found;
    } cases[] = {
        {"law_fault", "none", ""},
        {"law_fault", "runs", "runs; "},
        {"law_fault", "alone", "one by one; split; "},
        {"law_fault", "split", "one by one; split; "},
        {"law_fault", "energies", "energies; "},
        {"law_fault", "writes_input", "writes; "},
        {"law_fault", "writes_behind", "writes; "},
        {"law_fault", "writes_state", "writes; "},
        {"law_fault", "plane", "plane; no motion; "},
        {"law_fault", "turned", "turned; "},
        {"law_fault", "softer", "stiffness; "},
        {"law_fault", "shear_softer", "stiffness; "},
        {"law_fault", "cycle", "closed cycle; balance; "},
        {"law_fault", "adds_state", "writes; "},
        {"law_fault", "reads", "reads; "},
        {"law_fault", "stored", "balance; "},
        {"law_fault", "heat", "balance; heat; "},
        {"law_fault", "lost", "balance; "},
        {"law_fault", "area", "area; "},
        {"law_fault", "flags", "flags; "},
        {"law_fault", "states", "states; "},
        {"law_fault", "stateless", "states; "},
        {"law_fault", "pulls", "flags; pulls; "},
        {"damping_fault", "runs", "runs; "},
        {"damping_fault", "alone", "one by one; split; "},
        {"damping_fault", "split", "one by one; split; "},
        {"damping_fault", "writes", "writes; "},
        {"damping_fault", "moving", "writes; "},
        {"damping_fault", "grows", "masses; "},
        {"damping_fault", "brakes", "one by one; split; brakes; "},
        {"damping_fault", "alpha", "brakes; "},
        {"damping_fault", "rests", "rests; turned; masses; "},
        {"damping_fault", "factor", "step factor; "},
        {"damping_fault", "states", "states; "},
        {"generator_fault", "repeats", "repeats; "},
        {"generator_fault", "parameters", "parameters; "},
        {"generator_fault", "failures", "failures; "},
        {"generator_fault", "goes_on", "failures; "},
        {"screen_fault", "opens", "opens; "},
        {"screen_fault", "address", "address; "},
        {"screen_fault", "nobody", "nobody looks; "},
        {"screen_fault", "shows", "shows; "},
        {"screen_fault", "hasty", "waits; "},
        {"screen_fault", "made_up", "waits; "},
        {"screen_fault", "parameters", "writes; "},
        {"screen_fault", "behind", "writes; "},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (!check_takes(i))
            continue;
        findings h = run_unfit(cases[i].param, cases[i].fault);
        if (!CHECK_TEXT(h.list, cases[i].found))
            printf("  %s = %s: %s\n", cases[i].param, cases[i].fault, h.fault);
    }
}

/* Those that go wrong in more than one way. */
TEST(others_are_found_among_the_rest)
{
    static const char *const cases[][3] = {
        {"law_fault", "repeats", "repeats; "},  {"law_fault", "padding", "padding; "},
        {"law_fault", "finite", "finite; "},    {"law_fault", "unwritten", "reads; "},
        {"law_fault", "still", "no motion; "},  {"damping_fault", "repeats", "repeats; "},
        {"damping_fault", "state", "writes; "}, {"damping_fault", "finite", "finite; "},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (!check_takes(i))
            continue;
        findings h = run_unfit(cases[i][0], cases[i][1]);
        CHECK_CONTAINS(h.list, cases[i][2]);
    }
}

TEST(a_fault_tells_its_parameters)
{
    findings h = run_unfit("law_fault", "softer");
    CHECK_CONTAINS(h.fault, "law_fault = softer");
    CHECK_CONTAINS(h.fault, "but stiffness() says");
}

TEST(the_plugins_of_talus_pass)
{
    static const struct {
        const char *name;
        size_t checks;
    } plugins[] = {{"elastic", 24},
                   {"coulomb", 24},
                   {"coulomb_tensile", 24},
                   {"slip_weakening", 24},
                   {"cohesive", 24},
                   {"barton_bandis", 24},
                   {"continuously_yielding", 24},
                   {"rate_state", 24},
                   {"none", 14},
                   {"local", 14},
                   {"viscous", 14},
                   {"adaptive", 14},
                   {"combined", 14},
                   {"kinetic", 14},
                   {"solid_elastic", 18},
                   {"solid_transverse", 18},
                   {"solid_mohr_coulomb", 18},
                   {"solid_ubiquitous", 18},
                   {"solid_drucker_prager", 18},
                   {"solid_hoek_brown", 18},
                   {"box", 3},
                   {"tetrahedron", 3},
                   {"polyhedron", 3},
                   {"drum", 3},
                   {"joint", 3}};
    for (size_t i = 0; i < sizeof plugins / sizeof *plugins; i++) {
        char path[1024];
        findings h = {0};
        size_t faults = 1;
        tl_error error;
        snprintf(path, sizeof path, "%s/%s.so", TALUS_TEST_PLUGIN_DIR, plugins[i].name);
        CHECK_INT(tl_plugin_check(path, NULL, hear, &h, &faults, &error), TL_OK);
        CHECK_INT(h.checks, plugins[i].checks);
        if (!CHECK_INT(faults, 0))
            printf("  %s: %s%s\n", plugins[i].name, h.list, h.fault);
    }
}

/* Either by measured planes or by a mean: no single parameter is required. */
TEST(generators_of_several_ways_pass_with_one)
{
    static const char *const names[] = {"jointset", "dfn"};
    const tl_value given[] = {tl_arg_number("dip", 30), tl_arg_number("dip_direction", 200), tl_arg_number("number", 3),
                              tl_arg_number("size_mean", 1)};
    for (size_t i = 0; i < 2; i++) {
        char path[1024];
        findings h = {0};
        size_t faults = 1;
        tl_error error;
        const tl_args args = {given, i == 0 ? 3 : 4};
        snprintf(path, sizeof path, "%s/%s.so", TALUS_TEST_PLUGIN_DIR, names[i]);
        CHECK_INT(tl_plugin_check(path, &args, hear, &h, &faults, &error), TL_OK);
        CHECK_INT(h.checks, 3);
        if (!CHECK_INT(faults, 0))
            printf("  %s: %s%s\n", names[i], h.list, h.fault);
    }
}

TEST(a_screen_that_is_there_passes)
{
    findings h = {0};
    size_t faults = 1;
    tl_error error;
    if (!tl_plugin_find(TL_KIND_SCREEN, "browser")) /* not built without its library */
        return;
    const tl_value given[] = {tl_arg_number("port", 0)}, wrong[] = {tl_arg_number("port", 65536)};
    const tl_args args = {given, 1}, wrong_args = {wrong, 1};
    const char *path = TALUS_TEST_PLUGIN_DIR "/browser.so";
    CHECK_INT(tl_plugin_check(path, &args, hear, &h, &faults, &error), TL_OK);
    CHECK_INT(h.checks, 6);
    if (!CHECK_INT(faults, 0))
        printf("  %s%s\n", h.list, h.fault);
    CHECK_INT(tl_plugin_check(path, &wrong_args, NULL, NULL, &faults, &error), TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, "port = 65536");
}

TEST(points_are_parameters_too)
{
    static const double base[] = {0, 0, 0, 2, 0, 0, 0, 2, 0}, axis[] = {0, 0, 1};
    tl_value values[] = {tl_arg_numbers("base", base, 3), tl_arg_numbers("axis", axis, 3),
                         tl_arg_numbers("section", base, 3), tl_arg_number("to", 1)};
    size_t faults;
    tl_error error;
    values[0].type = TL_VALUE_POINTS;
    values[2].type = TL_VALUE_FLAT;
    const tl_args args = {values, 4};
    CHECK_INT(tl_plugin_check(TALUS_TEST_PLUGIN_DIR "/prism.so", &args, NULL, NULL, &faults, &error), TL_OK);
    CHECK_INT(faults, 0);
}

TEST(a_wrong_mark_of_a_strength_is_found)
{
    findings h = {0};
    size_t faults;
    tl_error error;
    CHECK_INT(tl_plugin_check(TALUS_BAD_PLUGIN_DIR "/half_marked.so", NULL, hear, &h, &faults, &error), TL_OK);
    CHECK_CONTAINS(h.list, "strengths; ");
}

TEST(what_cannot_be_tried_is_told)
{
    size_t faults;
    tl_error error;
    const tl_value odd[] = {tl_arg_number("weight", 3)}, wrong[] = {tl_arg_number("kn", -3)};
    const tl_args odd_args = {odd, 1}, wrong_args = {wrong, 1};
    CHECK_INT(tl_plugin_check("no/such.so", NULL, NULL, NULL, &faults, &error), TL_E_PLUGIN);
    CHECK_CONTAINS(error.text, "no/such.so");
    CHECK_INT(tl_plugin_check(UNFIT, &odd_args, NULL, NULL, &faults, &error), TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, "no kind of plugin 'bad.unfit' has a parameter 'weight'");
    CHECK_INT(tl_plugin_check(UNFIT, &wrong_args, NULL, NULL, &faults, &error), TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, "kn = -3");
    /* a generator that needs a file */
    CHECK(tl_plugin_check(TALUS_TEST_PLUGIN_DIR "/import_solid.so", NULL, NULL, NULL, &faults, &error) != TL_OK);
    CHECK_CONTAINS(error.text, "file");
}

TEST_MAIN(RUN(each_check_of_solids_finds_what_breaks_it), RUN(each_check_finds_what_breaks_it),
          RUN(others_are_found_among_the_rest), RUN(a_fault_tells_its_parameters), RUN(the_plugins_of_talus_pass),
          RUN(generators_of_several_ways_pass_with_one), RUN(a_screen_that_is_there_passes),
          RUN(points_are_parameters_too), RUN(a_wrong_mark_of_a_strength_is_found), RUN(what_cannot_be_tried_is_told))
