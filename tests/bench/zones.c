/* zones.c - how many zones one core makes of blocks in a second. Run as
 *
 *     ./bootstrap bench zones
 *
 * A cube of a million zones, 400 cubes of some 1800 each, and a slab, each with points, repair and checks. With the word
 * "quick" the cube has a hundred thousand. Processor time, so other work on the machine counts little. */
#include "geometry/make.h"
#include "geometry/zoning.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void time_box(const char *name, tl_vec3 sides, double edge, int blocks)
{
    tl_error error = {0};
    tl_poly *box = NULL;
    tl_zone_scratch *scratch = tl_zone_scratch_create();
    const tl_shape_zoning zoning = {.edge = edge};
    tl_status status = scratch ? tl_poly_box((tl_vec3){0, 0, 0}, sides, &box, &error) : TL_E_MEMORY;
    double zones = 0, share = 0;
    const double began = seconds();
    for (int i = 0; !status && i < blocks; i++) {
        tl_zone_mesh mesh;
        status = tl_zoning_make(box, &zoning, scratch, &mesh, &error);
        zones += mesh.zone_count;
        share = mesh.least_share;
        tl_zone_mesh_free(&mesh);
    }
    const double taken = seconds() - began;
    if (status) {
        printf("%s: %s\n", name, error.text);
        exit(1);
    }
    printf("%-12s %9.0f zones %6.2f s %6.2f million zones/s, least altitude %.2f of the edge\n", name, zones, taken,
           1e-6 * zones / taken, share);
    tl_poly_free(box);
    tl_zone_scratch_free(scratch);
}

int main(int count, char **words)
{
    const int quick = count > 1 && strcmp(words[1], "quick") == 0;
    time_box("cube", (tl_vec3){1, 1, 1}, quick ? 0.044 : 0.0203, 1);
    time_box("400 cubes", (tl_vec3){1, 1, 1}, 0.155, 400);
    time_box("slab", (tl_vec3){20, 20, 1}, 0.3, 1);
    return 0;
}
