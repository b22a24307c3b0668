/* rates.h - what each body asks of the time step; and searches for an extreme row. */
#ifndef TL_CYCLE_RATES_H
#define TL_CYCLE_RATES_H

#include "cycle/cycle_data.h"

/* A row of contacts or bodies and what was looked for in it; TL_NO_ROW: there is none. */
typedef struct tl_row_value {
    double value;
    uint32_t row;
} tl_row_value;

/* A search for the row of the largest value: user data of a parallel loop, and the first member of what a search adds
 * to it. Of several rows with equal values the first one counts, so which thread took which rows makes no difference. */
typedef struct tl_row_search {
    tl_model *m;
    tl_row_value found[TL_MAX_THREADS];
} tl_row_search;

tl_row_value tl_row_search_run(tl_row_search *s, size_t rows, size_t chunk, tl_range_fn range);
/* Notes the best row of a range. */
void tl_row_search_note(tl_row_search *s, unsigned thread, tl_row_value found);

/* The stiffness of the stiffest law, Pa/m. */
double tl_stiffest_law(const tl_model *m);

/* Whether the rates count contact points, or only faces. */
bool tl_rates_points(const tl_model *m);

/* Whether a body counts for the rules: one that can move or, where none can, any. */
static inline bool tl_body_counts(const tl_model *m, uint32_t body)
{
    return m->cycle->all_held || m->bodies.fixed[body] != TL_FIX_ALL;
}

/* Brings up to date what the rules know of the bodies without their contacts; first of all. */
void tl_rates_count(tl_model *m);
/* The highest rate, with mass scaling the lowest; brings the kept rates up to date. Rates up to `known` are told from above only, as
 * what the body asks for at the most: 0 where all count. */
tl_row_value tl_rates_keep(tl_model *m, double known);
/* The same, all looked at anew and nothing kept. */
tl_row_value tl_rates_anew(tl_model *m, double known);
/* The rates that the next step will keep, for the contacts as they are, of all bodies. Kept are those of before; noted in
 * m->detect, a copy that is thrown away, is that bodies have been rated. */
void tl_rates_try(tl_model *m, double known, double *rate, double *turn_rate);
/* Whether the step follows from rates that were kept: these are then part of the model's state. */
bool tl_rates_are_state(const tl_model *m);
/* The stiffness that a body's rate comes from, N/m: of its contacts, or of the part of its largest face that counts. */
double tl_rate_stiffness(const tl_model *m, uint32_t body);
/* The stiffest law of a body's contacts or, without any, of the model, Pa/m. */
double tl_rate_law(const tl_model *m, uint32_t body);

#endif
