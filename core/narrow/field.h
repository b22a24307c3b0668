/* field.h - the pressure field of two convex blocks: energy, force and moment of what they have in common.
 *
 * The depth d(x) of a point in a block is its least distance from the planes of the block's faces. Blocks A and B with
 * the common volume K store the energy
 *
 *     U = 2 kn G,    G = int over K of min(d_A, d_B) dV
 *
 * (after Elandt, Drumwright, Sherman and Ruina, "A pressure field model for fast, robust approximation of net contact
 * force and moment between nominally rigid objects", IROS 2019). Its gradient is a traction on the surface S inside K
 * where d_A = d_B = d. S is plane where face a of A and face b of B are the nearest:
 *
 *     force on B = 2 kn int over S of d n dS,    n = (n_a - n_b) / |n_a - n_b|
 *
 * Two flush faces of common area A that overlap by o give U = kn A o^2 / 2 and the force kn A o.
 *
 * A *border* is a face that bounds K and does not count for the depth: the seam of a joined body. The gradient then has
 * a share on the borders, too.
 *
 * Normals are unit vectors that point out of their block; a face's plane is n . x = c. All is in one frame, whose
 * origin should lie near K: the relative error of the sums is some roundings of the distance from it over the size of
 * K. */
#ifndef TL_NARROW_FIELD_H
#define TL_NARROW_FIELD_H

#include <stdbool.h>
#include <stddef.h>
#include <talus/types.h>

/* The planes that bound K, in this order: faces of A, faces of B, borders of A, borders of B. Others may be among them. For
 * blocks that are apart, all planes are needed to tell that they are; for others a face may be left out that lies wholly
 * outside one face of the other block. With a border all faces are needed, for beyond it the nearest need not bound K. */
typedef struct tl_field_faces {
    uint32_t a, b, border_a, border_b; /* how many of each */
    double *n[3], *c;                  /* [all of them] */
} tl_field_faces;

/* Memory that the functions below work in; zero at first. */
typedef struct tl_field_room {
    double *numbers;
    size_t count;
} tl_field_room;

/* Integrals over S, moments about the origin. Force and moment include the borders; the others do not. */
typedef struct tl_field_sums {
    tl_vec3 force, moment;     /* -dG: int d n dS, int d x cross n dS; on B; m^3, m^4 */
    tl_vec3 area, area_moment; /* -dV of the volume of K: int n dS, int x cross n dS; m^2, m^3 */
    double pressure;           /* int d dS; m^3 */
    tl_vec3 pressed;           /* int d x dS; m^4 */
    double extent;             /* int dS; m^2 */
    tl_vec3 first;             /* int x dS; m^3 */
    double second;             /* int x . x dS; m^4 */
    double
        stiffness;  /* int 2 / |n_a - n_b| dS: times kn the stiffness against motion along n; m^2 */
    double deepest; /* largest d; m */
    uint32_t polygons; /* how many S consists of */
} tl_field_sums;

/* Integrals over K. */
typedef struct tl_field_volume {
    double volume; /* m^3 */
    double energy; /* G; m^4 */
} tl_field_volume;

/* Both return false without memory. */
bool tl_field_surface(const tl_field_faces *faces, tl_field_room *room, tl_field_sums *sums);
bool tl_field_integrate(const tl_field_faces *faces, tl_field_room *room, tl_field_volume *volume);
void tl_field_free(tl_field_room *room);

#endif
