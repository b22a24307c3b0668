/* press_slope.h - how a press changes with the place of B. */
#ifndef TL_NARROW_PRESS_SLOPE_H
#define TL_NARROW_PRESS_SLOPE_H

#include "narrow/press.h"

/* Derivatives by B's moves along the axes of A's frame, and then by its turns about them through the press's point. */
typedef struct tl_press_slope {
    tl_vec3 force[6], moment[6], point[6];
    double area[6], radius[6], deepest[6];
    bool known; /* false: they have not been found, or nothing is pressed within the way that they are made for */
} tl_press_slope;

/* Presses that are found for the slopes of one. */
enum { TL_PRESS_SLOPE_COST = 12 };

/* Slopes of force and moment by those of the field (tl_press_query). The point rides half-way between A and B. Area,
 * radius and depth stay what they are. */
tl_press_slope tl_press_slope_of(const tl_press *at, const tl_field_slope *field);
/* Way at the rim of the area for a turn of 1. Of a corner the area is smaller than its overlap. */
double tl_press_lever(const tl_press *at);
/* Whether B has moved between two places by no more than `reach` times the overlap of the press: along, and by turns at
 * the rim of its area. */
bool tl_press_stays(const tl_press *at, const tl_pair_pose *from, const tl_pair_pose *to, double reach);
/* Slopes at a place where the press was found for a query. false: out of memory. */
bool tl_press_slope_find(const tl_press_query *query, const tl_press *at, tl_narrow_scratch *scratch,
                         tl_press_slope *slope);
/* The press when B has moved a little from where its slopes were found. false: by more than `reach` times the
 * overlap. */
bool tl_press_near(const tl_press *at, const tl_press_slope *slope, const tl_pair_pose *from, const tl_pair_pose *to,
                   double reach, tl_press *out);

/* Tolerance: motion, over the overlap, up to which slopes are used of what rests. The force is wrong by its square,
 * then. At 1e-4 an arch near its limit swings for ever by 1e-5 of its forces. Test: property/press_properties,
 * lua/test_arch_rest. */
#define TL_PRESS_NEAR 3e-5
/* Tolerance: the same of what moves, where the energy balance is watched, and for how many steps. The energy of what
 * presses is wrong by 8 times its cube at the most, less than 1e-4 of itself. Test: property/press_properties. */
#define TL_PRESS_REACH 0.02
#define TL_PRESS_STEPS 8

#endif
