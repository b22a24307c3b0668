/* talus/zones.h - deformable blocks: their solids, zones and gridpoints.
 *
 * A deformable block is divided into tetrahedra, its zones, in each of which the strain is the same everywhere. Their
 * corners are gridpoints, which have the mass and move. A solid is the material of zones: a kind from a plugin, and its
 * properties, under a name of the model's.
 *
 * Signs: stress and strain are positive in tension. Six components are xx yy zz xy yz zx, strains as of a tensor. */
#ifndef TALUS_ZONES_H
#define TALUS_ZONES_H

#include <talus/talus.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- solids ----------------- */

/* Names a solid: "granite", of the kind "mohr_coulomb" with properties. With `kind` NULL, or the kind it has already,
 * only the properties that are given change. Zones of a solid that changes keep their stress, and the states that the
 * new kind has by the same names; what they store changes, as of tl_zones_solid. TL_E_NOT_FOUND for a kind that no
 * plugin has, or a solid that is to be changed and is not there; TL_E_ARGUMENT for a bad property. */
TL_API tl_status tl_model_solid(tl_model *model, const char *name, const char *kind, const tl_args *properties);

typedef struct tl_solid_info {
    const char *name; /* valid until the model changes */
    const tl_kind *kind;
    const void *params; /* its properties now, at the offsets of kind->params */
} tl_solid_info;

/* The number of solids that were named. */
TL_API size_t tl_solid_count(const tl_model *model);
/* Solid `index`, in the order in which they were named: below tl_solid_count. */
TL_API tl_solid_info tl_solid_at(const tl_model *model, size_t index);

/* ---------------------------------------------------------------- zoning ----------------- */

/* How blocks are divided. */
typedef struct tl_zoning {
    uint32_t size; /* sizeof(tl_zoning) */
    /* the wanted edge of zones, m, > 0. Larger than a block: its corners and its centroid alone */
    double edge;
    double (*edge_at)(void *user, tl_vec3 place); /* or a function of the place; NULL: `edge` everywhere */
    void *user;                                   /* of it */
    const char *solid;                            /* name of the solid that zones are made of */
    /* or a file of tetrahedra that fill the blocks where they are, within 1e-6 of their size: VTK legacy or gmsh 2.2.
     * NULL: Talus divides them */
    const char *file;
} tl_zoning;

/* Nothing is given: an edge or a file, and a solid, have to be. */
TL_API tl_zoning tl_zoning_default(void);

/* What has been made. */
typedef struct tl_zoned {
    size_t blocks, zones, gridpoints, clusters;
    double least_altitude; /* of all zones over their largest sides, m */
    double least_share;    /* of altitudes over the wanted edges; of a file over the zone's edges (rms) */
    tl_id worst;           /* the block that has that */
    double time_step;      /* that its gridpoints would allow if nothing touched them, s */
    double inertia;        /* largest ratio of the inertia of a block's gridpoints to that of the block: 1 + 2/n2 of n
                              zones to an edge */
} tl_zoned;

/* Gives blocks zones, free of stress where the blocks are, with the blocks' velocities. A block that is held, in some
 * components or all, has gridpoints that are held so. A drive moves all gridpoints as the block; a load goes over to
 * the zone at its point, or to all gridpoints. Where faces of two blocks are the same polygon, the triangles of both
 * are. Joined blocks come all at once: where they lie on each other they share gridpoints. Nothing has changed when it
 * fails:
 *
 * TL_E_ARGUMENT: the edge is not positive, or makes too many zones; edge and file are given, or none; there is no such
 * solid. TL_E_STALE: no such block. TL_E_STATE: a block has zones, is joined to one that is not given, or is loaded on
 * its faces or at a point outside. TL_E_GEOMETRY: a block cannot be divided, or joined blocks do not lie flat on each
 * other. It is also given for a damaged file, and for tetrahedra that do not fill the blocks. TL_E_IO: a file cannot be
 * read. */
TL_API tl_status tl_blocks_deform(tl_model *model, const tl_id *blocks, size_t count, const tl_zoning *how,
                                  tl_zoned *made);

/* What a model has of deformable blocks, as they are now. */
typedef struct tl_zone_summary {
    size_t blocks, zones, gridpoints, clusters;
    size_t segments;       /* through which they touch */
    double least_altitude; /* of all zones over their largest sides, m; NaN: there are none */
    tl_id worst;           /* the block that has it, or TL_NO_ID */
} tl_zone_summary;

TL_API tl_zone_summary tl_model_zone_summary(const tl_model *model);

/* ---------------------------------------------------------------- which ------------------ */

/* Which zones, or gridpoints; all that is set must hold. */
typedef struct tl_zone_filter {
    uint32_t size;       /* sizeof(tl_zone_filter) */
    const tl_id *blocks; /* of these; NULL: of all visible ones */
    size_t block_count;
    const char *group;         /* of blocks of this group; NULL: of any */
    const tl_bounds *inside;   /* with the centroid, or the place, in this box; NULL: anywhere */
    const tl_vec3 *near;       /* the one whose centroid, or place, is nearest to this point; NULL: all */
    const tl_vec3 *containing; /* zones that have this point inside or on a side; NULL: all */
    const char *solid;         /* zones of it; NULL: of any */
    int32_t plastic;           /* 1: zones that have ever yielded, 0: that have not, -1: both */
    int32_t surface;           /* 1: gridpoints on the surface of a body, 0: inside, -1: both */
    int32_t fixed;             /* 1: gridpoints held in some component, 0: in none, -1: both */
} tl_zone_filter;

/* All zones and gridpoints of visible blocks. */
TL_API tl_zone_filter tl_zone_filter_default(void);

/* Names of the zones, or gridpoints, that pass, in the order of bodies and numbers; freed with free(). TL_E_NOT_FOUND
 * for a solid that is not there, TL_E_STALE for a block. */
TL_API tl_status tl_zones_select(tl_model *model, const tl_zone_filter *filter, tl_zone_name **names, size_t *count);
TL_API tl_status tl_gridpoints_select(tl_model *model, const tl_zone_filter *filter, tl_zone_name **names,
                                      size_t *count);

/* A point of the material, by the zone in which it lies. Its place is the sum over that zone's gridpoints of weight
 * times place, and so are its displacement and velocity. The weights add up to 1, and stay as zones deform. */
typedef struct tl_material_point {
    tl_zone_name zone;
    tl_zone_name gridpoint[4];
    double weight[4];
} tl_material_point;

/* The point of the material that is at a place now. TL_E_NOT_FOUND: it is in no zone of a visible block. */
TL_API tl_status tl_material_point_at(tl_model *model, tl_vec3 place, tl_material_point *point);

/* ---------------------------------------------------------------- fields ----------------- */

/* The fields a zone has, and a gridpoint, in the order of the reference; `*count` of them. */
TL_API const tl_field *tl_zone_fields(size_t *count);
TL_API const tl_field *tl_gridpoint_fields(size_t *count);

/* The value of field `index` of a zone, or a gridpoint. TL_E_STALE for one that is no more. */
TL_API tl_status tl_zone_field(tl_model *model, tl_zone_name zone, size_t index, tl_field_value *value);
TL_API tl_status tl_gridpoint_field(tl_model *model, tl_zone_name gridpoint, size_t index, tl_field_value *value);

/* Writes a field, by its name: component k of that of names[i] to out[width * i + k]. `*width` is set; with `out` NULL
 * that is all. A name with a component, "stress.zz" or "displacement.z", is that number alone. Of zones `name` may be a
 * state of their solids, NaN of one that has it not. TL_E_NOT_FOUND for an unknown name, TL_E_ARGUMENT for a field that
 * is a text. */
TL_API tl_status tl_zones_values(tl_model *model, const tl_zone_name *names, size_t count, const char *name,
                                 double *out, size_t *width);
TL_API tl_status tl_gridpoints_values(tl_model *model, const tl_zone_name *names, size_t count, const char *name,
                                      double *out, size_t *width);

/* Writes the corners of zones: numbers of gridpoints of the same body, those of names[i] to corners[i]. Corners 0, 1, 2
 * are counter-clockwise as seen from the side without corner 3. */
TL_API tl_status tl_zones_corners(tl_model *model, const tl_zone_name *names, size_t count, uint32_t (*corners)[4]);

/* Gives zones another solid. They keep their stress, and the states that both solids have by the same names. What they
 * store is then the energy of that stress in the new solid; the balance counts the change as work by hand. Clusters do
 * not reach across solids: near the border they are made anew. TL_E_ARGUMENT for a solid that is not there, TL_E_STALE
 * for a zone; then nothing has changed. All zones of blocks: tl_blocks_set. */
TL_API tl_status tl_zones_solid(tl_model *model, const tl_zone_name *names, size_t count, const char *solid);

/* ---------------------------------------------------------------- gridpoints ------------- */

/* Hold components of gridpoints (TL_FIX_X, _Y, _Z, added up) where they are, or let them go. */
TL_API tl_status tl_gridpoints_fix(tl_model *model, const tl_zone_name *names, size_t count, uint32_t what);
TL_API tl_status tl_gridpoints_free(tl_model *model, const tl_zone_name *names, size_t count, uint32_t what);
/* Puts a force on each, N, in the place of what it had. */
TL_API tl_status tl_gridpoints_load(tl_model *model, const tl_zone_name *names, size_t count, tl_vec3 force);
/* Gives them velocities, m/s: names[i] gets velocity[i]. Held components go on with theirs. */
TL_API tl_status tl_gridpoints_velocity(tl_model *model, const tl_zone_name *names, size_t count,
                                        const tl_vec3 *velocity);
/* Prescribes their velocity in all components, until they are let go: drive->velocity, or what its function tells in
 * the middle of each step, and drive->gradient times the place from drive->at. TL_E_STATE: their block is driven as a
 * whole. */
TL_API tl_status tl_gridpoints_drive(tl_model *model, const tl_zone_name *names, size_t count, const tl_drive *drive);
/* The force with which what holds them acts on them, N: the sum over their held components. */
TL_API tl_status tl_gridpoints_reaction(tl_model *model, const tl_zone_name *names, size_t count, tl_vec3 *force);

/* ---------------------------------------------------------------- step ------------------- */

/* The gridpoint that controls the step that the next cycle will use (tl_model_timestep_report); of body 0: none does.
 */
TL_API tl_status tl_model_timestep_gridpoint(tl_model *model, tl_zone_name *gridpoint);

/* What mass scaling to a step that was given (tl_mass_scaling) has added to gridpoints in the last step. */
typedef struct tl_gridpoints_added {
    size_t gridpoints;  /* that have been given some */
    tl_zone_name worst; /* the one that has the highest factor of all bodies and gridpoints; of body 0: it is a body */
} tl_gridpoints_added;

TL_API tl_gridpoints_added tl_model_gridpoints_added(const tl_model *model);

#ifdef __cplusplus
}
#endif
#endif
