/* cuts.c - how many cuts of a polyhedron one core makes in a second, for each kind of plane. Run as
 *
 *     ./bootstrap bench cuts
 *
 * Each kind cuts the same blocks, those that a box falls into when it is cut a few times at random; a
 * cut makes both children, and they are freed. Planes that miss or fall on a face are cheaper: the share
 * of cuts that were made is told. Processor time, so other work on the machine counts little. */
#include "cut_planes.h"
#include "geometry/cut.h"
#include "geometry/make.h"

#include <time.h>

enum { BLOCKS = 1024, ROUNDS = 100 };

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void cut(const tl_poly *p, tl_plane plane, tl_cut *result)
{
    tl_error error;
    if (tl_poly_cut(p, plane, 0, (tl_tag){1, 1}, result, &error) != TL_OK) {
        printf("%s\n", error.text);
        exit(1);
    }
}

static void make_blocks(tl_poly **block)
{
    tl_error error;
    if (tl_poly_box(tl_v3(-4, -4, -4), tl_v3(4, 4, 4), &block[0], &error) != TL_OK)
        exit(1);
    for (size_t count = 1; count < BLOCKS;) {
        tl_poly **p = &block[pick((uint32_t)count)];
        tl_cut result;
        cut(*p, random_plane(*p, ANY), &result);
        if (result.result != TL_CUT_MADE)
            continue;
        tl_poly_free(*p);
        *p = result.below;
        block[count++] = result.above;
    }
}

/* Cuts per second; adds the time and the cuts to the sums. */
static void time_kind(const char *name, kind which, tl_poly *const *block, double *time, double *cuts)
{
    static tl_plane plane[BLOCKS];
    size_t made = 0;
    for (size_t i = 0; i < BLOCKS; i++)
        plane[i] = random_plane(block[i], which);
    double began = seconds();
    for (int round = 0; round < ROUNDS; round++)
        for (size_t i = 0; i < BLOCKS; i++) {
            tl_cut result;
            cut(block[i], plane[i], &result);
            made += result.result == TL_CUT_MADE;
            tl_poly_free(result.below);
            tl_poly_free(result.above);
        }
    double taken = seconds() - began, all = (double)BLOCKS * ROUNDS;
    printf("%-28s %6.2f million cuts/s, %3.0f%% made\n", name, 1e-6 * all / taken, 100 * (double)made / all);
    *time += taken;
    *cuts += all;
}

int main(void)
{
    static const struct {
        const char *name;
        kind which;
    } kinds[] = {{"random", ANY},
                 {"through a vertex", VERTEX},
                 {"through an edge", EDGE},
                 {"through three vertices", DIAGONAL},
                 {"along a face", PARALLEL},
                 {"coincident with a face", COINCIDENT},
                 {"grid", GRID},
                 {"nearly along a face", TILTED},
                 {"nearly through a vertex", TOUCHING}};
    static tl_poly *block[BLOCKS];
    make_blocks(block);
    double time = 0, cuts = 0;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        time_kind(kinds[i].name, kinds[i].which, block, &time, &cuts);
    printf("%-28s %6.2f million cuts/s\n", "all", 1e-6 * cuts / time);
    for (size_t i = 0; i < BLOCKS; i++)
        tl_poly_free(block[i]);
    return 0;
}
