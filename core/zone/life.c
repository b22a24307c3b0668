/* life.c - the tables of zones come and go. */
#include "zone/life.h"

#include "zone/body_verbs.h"
#include "zone/solids.h"

#include <stdlib.h>

static void add_columns(struct tl_zones *z)
{
    tl_gridpoints *p = &z->points;
    tl_table_init(&p->table, p);
    for (int k = 0; k < 3; k++) {
        TL_COLUMN(&p->table, p, ref[k], TL_COLUMN_STATE);
        TL_COLUMN(&p->table, p, u[k], TL_COLUMN_STATE);
        TL_COLUMN(&p->table, p, v[k], TL_COLUMN_STATE);
        TL_COLUMN(&p->table, p, moved[k], TL_COLUMN_STATE);
        TL_COLUMN(&p->table, p, force[k], TL_COLUMN_STEP);
    }
    TL_COLUMN(&p->table, p, mass, TL_COLUMN_STATE);
    TL_COLUMN(&p->table, p, bears, TL_COLUMN_STEP);
    TL_COLUMN(&p->table, p, touched, TL_COLUMN_STEP);
    TL_COLUMN(&p->table, p, zones, 0);
    TL_COLUMN(&p->table, p, stiffness, 0);
    TL_COLUMN(&p->table, p, floor, 0);
    TL_COLUMN(&p->table, p, holds, 0);
    TL_COLUMN(&p->table, p, rounded, 0);
    TL_COLUMN(&p->table, p, mesh, 0);
    TL_COLUMN(&p->table, p, fixed, TL_COLUMN_STATE);
    TL_COLUMN(&p->table, p, bare, 0);

    tl_zone_table *t = &z->zones;
    tl_table_init(&t->table, t);
    for (int k = 0; k < 4; k++)
        TL_COLUMN(&t->table, t, corner[k], 0);
    for (int k = 0; k < 6; k++)
        TL_COLUMN(&t->table, t, stress[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&t->table, t, flags, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&t->table, t, number, 0);

    tl_parcels *parcels = &z->parcels;
    tl_table_init(&parcels->table, parcels);
    TL_COLUMN(&parcels->table, parcels, of, 0);
    TL_COLUMN(&parcels->table, parcels, stored, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&parcels->table, parcels, heat, TL_COLUMN_STEP);
    TL_COLUMN(&parcels->table, parcels, most_strain, TL_COLUMN_STATE | TL_COLUMN_STEP);
}

tl_status tl_zones_begin(tl_model *m)
{
    if (m->zones)
        return TL_OK;
    m->zones = calloc(1, sizeof *m->zones);
    if (!m->zones)
        return tl_fail_memory(&m->error);
    m->zones_destroy = tl_zones_free;
    m->zone_verbs = &tl_zone_body_verbs;
    add_columns(m->zones);
    return TL_OK;
}

void tl_zones_free(struct tl_zones *z)
{
    tl_table_free(&z->points.table);
    tl_table_free(&z->zones.table);
    tl_table_free(&z->parcels.table);
    void *const owned[] = {z->group, z->listed, z->slot,    z->use,     z->use_start, z->row_of,
                           z->part,  z->mesh,   z->meeting, z->scratch, z->motion,    z->outer};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    tl_solids_free(z);
    free(z);
}
