/* polyhedron.h - convex polyhedra: building, checking, measuring.
 *
 * A polyhedron is closed and convex. Its faces are convex polygons given counter-clockwise from
 * outside, each with the plane it was made with (never refitted) and the tag of the joint that
 * made it (joint 0: none). But for seams it is immutable once made and lives in one allocation.
 *
 * Lengths: `size` of a polyhedron is the diagonal of its bounds; tolerances are relative to it. */
#ifndef TL_GEOMETRY_POLYHEDRON_H
#define TL_GEOMETRY_POLYHEDRON_H

#include <stdbool.h>
#include <talus/types.h>

/* A face whose vertices are all closer to a plane than this times the size lies on it. A block small
 * in its model knows planes to fewer digits than its own vertices: this leaves it six orders. */
#define TL_POLY_ON 1e-9
/* Faces of points given by coordinates of six digits, for a block of about one: a face bent by less is one face. */
#define TL_POLY_FLAT 1e-6
/* The corners of a face miss its plane by less than this times its size: as far as meshes give faces off their planes. */
#define TL_POLY_BENT 2e-4
/* Sine of 0.025 degrees, half of what flush faces may tilt. A facet of a face may tilt its plane by less, so that two blocks
 * lie flush on each other by such faces. */
#define TL_POLY_TILT 4.3633e-4
/* A cut that would leave a side thinner than this times the size is refused. */
#define TL_POLY_THIN 1e-5
/* Most vertices and most faces of one polyhedron. */
#define TL_POLY_MAX_VERTICES 4096
#define TL_POLY_MAX_FACES 4096

enum { TL_COVERED = 1, TL_SEAM };

/* Edge from vertex a to b in the loop of face `left`; in that of face `right` it runs from b to a. */
typedef struct tl_edge {
    uint16_t a, b, left, right;
} tl_edge;

typedef struct tl_poly {
    uint32_t vertex_count, face_count, edge_count;
    uint32_t plane_count; /* of the faces, and of outer faces of other parts (seam_planes.c) */
    bool seams;           /* some face is covered */
    double size;          /* diagonal of the bounds */
    /* [plane_count] Outward unit normal and offset: of the faces, and behind them of those outer faces of other parts of the
     * body that may be nearer to some point of this part than its own. All of the part lies behind them. */
    tl_plane *plane;
    tl_tag *tag;     /* [face_count] */
    uint16_t *start; /* [face_count + 1] into loop */
    tl_edge *edge;   /* [edge_count], a < b never assumed */
    uint16_t *loop;  /* [2 edge_count] vertex indices */
    /* Seams with the other parts of a body of several polyhedra (seam.c): zeros that all single ones share, or, where
     * `seams`, an allocation of its own. */
    const uint8_t *
        covered; /* [face_count] TL_COVERED: the face lies on other parts; TL_SEAM: as all do that it lies on */
    const uint8_t *hidden; /* [edge_count] 1: the edge is no corner of the body */
    tl_vec3 vertex[];      /* [vertex_count] */
} tl_poly;

/* The place after place h in the loop of a face. */
static inline uint32_t tl_poly_after(const tl_poly *p, uint32_t face, uint32_t h)
{
    return h + 1 < p->start[face + 1] ? h + 1u : p->start[face];
}

static inline uint32_t tl_poly_face_size(const tl_poly *p, uint32_t face)
{
    return p->start[face + 1] - p->start[face];
}

/* A polyhedron from faces: loops[start[f] .. start[f+1]) are indices into `vertices`. Derives edges.
 * Fails (TL_E_GEOMETRY) when some edge does not belong to exactly two faces. */
tl_status tl_poly_make(const tl_vec3 *vertices, size_t vertex_count, const tl_plane *planes,
                       const tl_tag *tags, const uint32_t *start, const uint16_t *loops,
                       size_t face_count, tl_poly **poly, tl_error *error);

tl_status tl_poly_box(tl_vec3 min, tl_vec3 max, tl_poly **poly, tl_error *error);

/* The convex hull of points. Triangles that lie in one plane become one face (tl_poly_flatten), and points
 * on the faces that are no corners are left out. Fails (TL_E_GEOMETRY) for fewer than four points, NaN, a
 * flat or thinner than TL_POLY_THIN set, and for a point inside the hull of the others by more than
 * TL_POLY_BENT: the sentence names the point, counted from 1. */
tl_status tl_poly_hull(const tl_vec3 *points, size_t count, tl_poly **poly, tl_error *error);
/* The same of any points: those inside are left out. */
tl_status tl_poly_hull_around(const tl_vec3 *points, size_t count, tl_poly **poly, tl_error *error);

/* Makes one face of facets with one tag that lie in one plane as far as TL_POLY_BENT and TL_POLY_TILT tell, and fits the
 * planes of faces whose corners miss them by more than TL_POLY_FLAT. What comes out keeps tl_poly_check within TL_POLY_BENT.
 * A polyhedron that has no such faces, or would be no block with them, is left as it is. */
tl_status tl_poly_flatten(tl_poly **poly, tl_error *error);

void tl_poly_free(tl_poly *poly);
/* Bytes of its allocation, and of its seams. */
size_t tl_poly_bytes(const tl_poly *poly);

/* The same once more; NULL when out of memory. */
tl_poly *tl_poly_copy(const tl_poly *poly);

/* A copy with every vertex x replaced by R x + t (R a rotation; NULL is the identity). */
tl_status tl_poly_transformed(const tl_poly *poly, const tl_mat3 *rotation, tl_vec3 translation,
                              tl_poly **copy, tl_error *error);

/* Euler's formula, closed, convex and every vertex on its faces' planes within `tolerance` times the
 * size, positive volume. */
tl_status tl_poly_check(const tl_poly *poly, double tolerance, tl_error *error);

/* Volume, centroid and inertia at density 1 about the centroid, exact up to rounding (sums over
 * tetrahedra, taken about a vertex so that an offset costs no digits). */
typedef struct tl_mass {
    double volume;
    tl_vec3 centroid;
    tl_sym3 inertia;
} tl_mass;

tl_mass tl_poly_mass(const tl_poly *poly);

tl_bounds tl_poly_bounds(const tl_poly *poly);
/* Sets `size` by the vertices as they are. */
void tl_poly_find_size(tl_poly *poly);
double tl_poly_face_area(const tl_poly *poly, uint32_t face);
tl_vec3 tl_poly_face_centroid(const tl_poly *poly, uint32_t face);
/* Distance of a point from a face, measured in the face's plane; 0 for a point over the face. */
double tl_poly_face_distance(const tl_poly *poly, uint32_t face, tl_vec3 point);
double tl_poly_shortest_edge(const tl_poly *poly);
/* Largest distance between two vertices. */
double tl_poly_diameter(const tl_poly *poly);
/* Smallest extent along the normal of a face. (Between two crossing edges it may be less, 0.87 of this
 * in a regular tetrahedron; but what is thin is thin along a face.) */
double tl_poly_thickness(const tl_poly *poly);
/* Vertex farthest in a direction (the lowest index among equals). */
uint32_t tl_poly_support(const tl_poly *poly, tl_vec3 direction);
/* Within `tolerance` (a length) of the inside. */
bool tl_poly_contains(const tl_poly *poly, tl_vec3 point, double tolerance);

/* Eigenvalues (ascending in `moments`) and the rotation from principal axes to the given ones. The
 * identity for a diagonal tensor's own axes up to their order. */
void tl_principal_axes(tl_sym3 tensor, tl_vec3 *moments, tl_quat *axes);

/* Area common to face fa of a and face fb of b, given in one frame, when they lie in one plane and face each other; else 0.
 * false when out of memory. */
bool tl_poly_shared_area(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb,
                         double *area);

/* Marks the seams of a body made of `count` parts given in one frame: faces that lie on other parts over
 * their whole area, and edges of such faces where the body's surface goes on flat or turns inward. */
tl_status tl_poly_mark_seams(tl_poly *const *parts, size_t count, tl_error *error);
/* Gives parts whose seams are marked the planes of outer faces of the others that count for them. */
tl_status tl_poly_share_planes(tl_poly *const *parts, size_t count, tl_error *error);

/* Whether faces of this tag keep parts apart that share them. */
typedef bool (*tl_sever_fn)(const void *user, tl_tag tag);

/* Which of the parts of a body hang together over faces that lie on each other, as closely as blocks do that have settled before they
 * were joined: label[i] is the lowest index of its group.
 * Faces that `severs` (NULL: none does) do not count. */
tl_status tl_poly_connected(tl_poly *const *parts, size_t count, tl_sever_fn severs,
                            const void *user, uint32_t *label, tl_error *error);

/* ---- cutting: cut.c ---- */

typedef enum tl_cut_result {
    TL_CUT_MISS,       /* the plane does not cross the polyhedron */
    TL_CUT_MADE,       /* below and above are set */
    TL_CUT_COINCIDENT, /* the plane falls on a face: `face` is set */
    TL_CUT_REFUSED /* a side would be thinner than TL_POLY_THIN; `face` is set when the thin side
                      lies along one face, else it is UINT32_MAX */
} tl_cut_result;

typedef struct tl_cut {
    tl_cut_result result;
    tl_poly *below, *above; /* normal . x < offset, > offset */
    uint32_t face;
    /* When refused: of the thinner side along the plane's normal, and what is asked of it. */
    double thickness, limit;
} tl_cut;

/* Cuts by a plane. Vertices are never moved; each crossed edge gets one new vertex, shared bit for bit
 * by both sides; faces keep their planes; the cap gets the cutting plane and `tag`. `reach` is the
 * largest coordinate the plane's offset was computed from: a vertex within rounding of the plane is a
 * corner of the cap as it is (0: nothing larger than the offset and the vertices themselves).
 * The volume of both sides is that of the polyhedron to rounding, a few DBL_EPSILON of the farthest
 * coordinate times the surface. TL_E_MEMORY is the only failure. */
tl_status tl_poly_cut(const tl_poly *poly, tl_plane plane, double reach, tl_tag tag, tl_cut *cut,
                      tl_error *error);

#endif
