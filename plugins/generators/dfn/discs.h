/* discs.h - the discs of a network, and the files that they may come from. */
#ifndef DFN_DISCS_H
#define DFN_DISCS_H

#include <talus/poles.h>

/* Limit: discs of a network: more would cut no model that can be worked on. */
#define MOST_DISCS 1000000

typedef struct disc {
    tl_vec3 center, normal; /* the normal of unit length, upward */
    double radius;          /* m */
    double area;            /* m2, inside the bounds of the blocks */
    size_t number;          /* in the order in which they were made, from 0 */
} disc;

typedef struct discs {
    disc *at;
    size_t count, capacity;
    size_t polygons; /* that became discs of their area */
    size_t line;     /* of the file that is read, from 1 */
} discs;

/* Area of the part of a disc that is in a box. */
double disc_area_in_box(const disc *d, const tl_bounds *box);
/* Adds a disc; TL_E_MEMORY without memory. */
tl_status discs_add(const tl_host *host, discs *all, tl_vec3 center, tl_vec3 normal, double radius);
/* Reads a file of discs: .fab of FracMan, or a table with x, y, z, dip, dip_direction and radius. */
tl_status discs_read(const tl_host *host, const char *file, discs *all);
/* Read the text of a table and of a .fab file, which ends in a zero byte. */
tl_status table_read(const tl_host *host, const char *file, const char *text, discs *all);
tl_status fab_read(const tl_host *host, const char *file, const char *text, discs *all);

#endif
