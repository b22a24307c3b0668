/* aside.c - what a change of many rows needs so that it can be taken back: copies of the rows as they were. The model must look
 * as if nothing had been tried, to the counts of changes, by which caches tell that they are out of date. */
#include "model/model.h"

bool tl_rows_set_aside(tl_model *m, tl_aside *aside)
{
    tl_rows_tidy(m);
    aside->blocks = m->blocks;
    aside->bodies = m->bodies;
    bool blocks = tl_table_copy(&aside->blocks.table, &aside->blocks, &m->blocks.table);
    bool bodies = tl_table_copy(&aside->bodies.table, &aside->bodies, &m->bodies.table);
    if (!blocks || !bodies) {
        tl_table_free(&aside->blocks.table);
        tl_table_free(&aside->bodies.table);
        return false;
    }
    aside->next_id = m->next_id;
    aside->structure = m->structure;
    aside->constraints = m->constraints;
    tl_drives_hold(m);
    return true;
}

void tl_rows_take_back(tl_model *m, tl_aside *aside)
{
    tl_table_free(&m->blocks.table);
    tl_table_free(&m->bodies.table);
    m->blocks = aside->blocks;
    m->bodies = aside->bodies;
    m->blocks.table.owner = &m->blocks;
    m->bodies.table.owner = &m->bodies;
    m->next_id = aside->next_id;
    m->extremes.known = false;
    tl_rows_refresh(m);
    tl_drives_settle(m);
    m->structure = aside->structure;
    m->constraints = aside->constraints;
}

void tl_rows_settle(tl_model *m, tl_aside *aside)
{
    tl_table_free(&aside->blocks.table);
    tl_table_free(&aside->bodies.table);
    tl_drives_settle(m);
}
