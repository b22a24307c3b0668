/* field_lanes.h - eight polygons of a pressure field side by side: their lines, and the integrals over them. */
#ifndef TL_NARROW_FIELD_LANES_H
#define TL_NARROW_FIELD_LANES_H

#include <talus/plugin.h>

/* The line that one other plane draws in each of eight polygons. */
typedef struct tl_field_line {
    double gt[TL_LANES], gs[TL_LANES], c[TL_LANES]; /* unit normal, offset */
    double from[TL_LANES], to[TL_LANES];            /* places between which the line bounds the polygon */
} tl_field_line;

/* Eight polygons. */
typedef struct tl_field_lanes {
    double n[3][TL_LANES], h[TL_LANES]; /* plane */
    double between[TL_LANES]; /* 1: between two cells; n = n_a - n_b and h are yet to be divided by the length of n */
    double length[TL_LANES];  /* that; of a border minus the cosine of both planes */
    double face_n[3][TL_LANES], face_c[TL_LANES];    /* the face whose depth counts */
    double one_plane[TL_LANES];                      /* offset within which planes are one */
    double share[TL_LANES];                          /* of the integrals: 1; 1/2 for a tie; 0 for none */
    double t[3][TL_LANES], s[3][TL_LANES];           /* axes in the plane */
    double d0[TL_LANES], dt[TL_LANES], ds[TL_LANES]; /* depth in the plane: d0 + dt x_t + ds x_s */
    /* integrals of d^3 and d^4; |grad d|^2 times them by lines; of d^2 and d^3 times x_t and x_s */
    double flat[2][TL_LANES], steep[2][TL_LANES], power_t[2][TL_LANES], power_s[2][TL_LANES];
    double origin_t[TL_LANES], origin_s[TL_LANES];     /* a corner; d0 and the rest are about it */
    double area[TL_LANES], it[TL_LANES], is[TL_LANES]; /* integrals of 1, x_t, x_s, ... */
    double itt[TL_LANES], its[TL_LANES], iss[TL_LANES];
    double d1[TL_LANES], d2[TL_LANES]; /* |grad d|^2 times the integrals of d and d^2 */
    double open[TL_LANES];             /* 1: it has no end */
    double deepest[TL_LANES], deepest_t[TL_LANES], deepest_s[TL_LANES];
} tl_field_lanes;

/* What each polygon gives, times its share. */
typedef struct tl_field_parts {
    double area[TL_LANES], d[TL_LANES], dd[TL_LANES];     /* int dS, int d dS, int d^2 dS */
    double force[3][TL_LANES], moment[3][TL_LANES];       /* int d n dS, int d x cross n dS */
    double swept[3][TL_LANES], swept_moment[3][TL_LANES]; /* int n dS, int x cross n dS */
    double pressed[3][TL_LANES], first[3][TL_LANES];      /* int d x dS, int x dS */
    double second[TL_LANES];                              /* int x . x dS */
    double deepest_at[3][TL_LANES];
    double cube[TL_LANES], fourth[TL_LANES]; /* int d^3 dS, int d^4 dS */
    double power_moment[2][3][TL_LANES];     /* int d^2 x cross n dS, int d^3 x cross n dS */
} tl_field_parts;

/* A plane n . x = c for each polygon. */
typedef struct tl_field_plane {
    double n[3][TL_LANES], c[TL_LANES];
    double face[TL_LANES]; /* 1: a face, 0: a border */
} tl_field_plane;

/* Planes of eight polygons: the k-th of each is in row k. */
typedef struct tl_field_rows {
    tl_field_plane *row;
    uint32_t most;
} tl_field_rows;

/* What bounds eight polygons, and what is found of that. */
typedef struct tl_field_bounds {
    bool flat;                    /* the polygons are K's own faces */
    bool powers;                  /* the integrals of higher powers of d are wanted */
    tl_field_rows planes, others; /* planes that bound polygons; faces that are to bound none */
    tl_field_line *line;          /* room for a line of each plane and one more */
    size_t lines;                 /* drawn */
    uint32_t beyond;              /* lanes, a bit each, of which a corner with d = 0 lies beyond one of the others */
} tl_field_bounds;

/* Tolerance: length of n_a - n_b below which two directions are the same: such faces have no surface between them. */
#define TL_FIELD_ALIKE 1e-7

/* Tolerance: slope of d within a polygon's plane from which integrals of d are taken by its gradient: nothing cancels
 * in thin slivers. */
#define TL_FIELD_STEEP 0.1

/* Constant: offset of a plane that is none: it lies behind everything. */
#define TL_FIELD_FAR 1e290

/* Draws the lines of the planes and integrates the polygons that they bound. Polygons between cells lie where no face
 * is nearer than theirs, and theirs is not passed: line[0] is that of d = 0. Others, with `flat`, lie on a face and
 * within all other planes. */
void tl_field_integrate_lanes(tl_field_lanes *p, tl_field_bounds *by, tl_field_parts *out);

#endif
