# A programmer with a program of their own, who wants rock in it.

test -f "$PREFIX/include/talus/talus.h"
test -f "$PREFIX/share/talus/examples/embed/slide.c"

cat >CMakeLists.txt <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(tower LANGUAGES C)
find_package(talus REQUIRED)
add_executable(tower tower.c)
set_property(TARGET tower PROPERTY C_STANDARD 17)
target_compile_options(tower PRIVATE -Wall -Wextra -Werror)
target_link_libraries(tower PRIVATE talus::talus m)
CMAKE

cat >tower.c <<'C'
/* Five cubes on a floor: the force below each is the weight of those above it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/talus.h>

static tl_model *m;

static void must(tl_status status)
{
    if (status != TL_OK) {
        fprintf(stderr, "%s\n", tl_model_error(m)->text);
        exit(EXIT_FAILURE);
    }
}

static void add_box(double bottom, double top, double half, const char *group)
{
    must(tl_generate(m, "box",
                     TL_ARGS(TL_ARG_VECTOR("min", -half, -half, bottom), TL_ARG_VECTOR("max", half, half, top),
                             tl_arg_number("density", 2000), tl_arg_text("group", group)),
                     NULL));
}

static size_t field(const tl_field *fields, size_t count, const char *name)
{
    size_t i = 0;
    while (i < count && strcmp(fields[i].name, name) != 0)
        i++;
    return i;
}

int main(void)
{
    tl_error error;
    tl_model_config config = tl_model_config_default();
    config.gravity = (tl_vec3){0, 0, -10};
    tl_plugins_load_default();
    if (tl_model_create(&config, &m, &error) != TL_OK) {
        fprintf(stderr, "%s\n", error.text);
        return EXIT_FAILURE;
    }
    add_box(-1, 0, 2, "floor");
    for (int i = 0; i < 5; i++)
        add_box(i, i + 1, 0.5, "tower");

    tl_block_filter floors = tl_block_filter_default();
    tl_id *ids;
    size_t count;
    floors.group = "floor";
    must(tl_blocks_select(m, &floors, &ids, &count));
    must(tl_blocks_fix(m, ids, count, TL_FIX_ALL));
    free(ids);

    must(tl_joint_law(m, "*", "coulomb",
                      TL_ARGS(tl_arg_number("kn", 1e9), tl_arg_number("ks", 1e9), tl_arg_number("friction", 35))));
    must(tl_model_damping(m, "local", NULL));
    tl_solve solve = tl_solve_default();
    tl_solve_result result;
    solve.ratio = 1e-6;
    must(tl_model_solve(m, &solve, &result));
    must(tl_write_vtk(m, "out/tower", NULL));

    size_t fields;
    const tl_field *of = tl_contact_fields(&fields);
    size_t force = field(of, fields, "normal_force");
    double sum = 0;
    tl_contact_name *contacts;
    must(tl_contacts_select(m, NULL, &contacts, &count));
    for (size_t i = 0; i < count; i++) {
        tl_field_value value;
        must(tl_contact_field(m, contacts[i], force, &value));
        printf("%.3f kN\n", value.number[0] / 1000);
        sum += value.number[0];
    }
    free(contacts);
    double weight = 2000 * 10, expected = (1 + 2 + 3 + 4 + 5) * weight;
    printf("sum %.3f kN, expected %.3f\n", sum / 1000, expected / 1000);

    /* a mistake is a status and a sentence, and the model is as before */
    tl_status status = tl_generate(m, "bx", TL_ARGS(tl_arg_number("density", 2000)), NULL);
    printf("%d: %s\n", status == TL_E_NOT_FOUND, tl_model_error(m)->text);
    status = tl_model_solve(m, &(tl_solve){.ratio = 1e-3}, &result);
    printf("%d: %s\n", status == TL_E_ARGUMENT, tl_model_error(m)->text);
    int good = fabs(sum - expected) < 1e-3 * expected && tl_block_count(m) == 6;
    tl_model_destroy(m);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
C

cmake -S . -B build >cmake.txt
cmake --build build >>cmake.txt 2>&1 || { cat cmake.txt; exit 1; }
build/tower | tee told.txt
test "$(grep -c '^[0-9.]* kN$' told.txt)" = 5
grep -q "^1: .*'bx'; did you mean 'box'" told.txt
grep -q "^1: tl_solve: size = 0 .*tl_solve_default()" told.txt
test "$(ls out/tower_blocks_*.vtk | wc -l)" = 1

# the same without CMake
export PKG_CONFIG_PATH="$PREFIX/lib/pkgconfig"
eval "cc -std=c17 -O2 tower.c $(pkg-config --cflags --libs talus) -lm -Wl,-rpath,'$PREFIX/lib' -o by_hand"
./by_hand >again.txt
cmp told.txt again.txt
