/* slivers.h - bodies that make the time step short by being small or thin, and a filter that takes enough of them. */
#ifndef TL_MODEL_SLIVERS_H
#define TL_MODEL_SLIVERS_H

#include "model/model.h"

/* Whether a block of a volume, m3, is very thin, or very small beside the mean volume of blocks. */
bool tl_is_sliver(const tl_poly *shape, double volume, double mean);

/* Limits of a filter, and what is beyond them. */
typedef struct tl_sliver_limits {
    double volume, aspect; /* smallest volume, m3, and worst aspect; NaN: no limit */
    size_t count;          /* bodies beyond one of the limits */
    double share;          /* theirs of the rock, by volume */
    double gain;           /* how many times longer a step the others allow, >= 1 */
    double fastest;        /* highest of the rates */
    bool by_shape;         /* the rates are those of shapes */
} tl_sliver_limits;

/* The filter that takes least and gains nearly the most. The step goes with 1 / sqrt of the highest `rate`, [bodies];
 * bodies of rate 0 do not count. `stays`, [bodies], marks those that no filter takes. Without limits where no filter
 * gains enough. TL_E_MEMORY. */
tl_status tl_slivers_choose(tl_model *m, const double *rate, const unsigned char *stays, tl_sliver_limits *out);

/* The same where all joints are equally stiff: by area over volume of each body, 1/m. TL_E_MEMORY. */
tl_status tl_slivers_by_shape(tl_model *m, tl_sliver_limits *out);

#endif
