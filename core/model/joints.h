/* joints.h - names of groups and joint sets, and what is set by joint. */
#ifndef TL_MODEL_JOINTS_H
#define TL_MODEL_JOINTS_H

#include "model/model.h"

/* Index of a group's name, made when new; UINT32_MAX when out of memory. */
uint32_t tl_group_intern(tl_model *m, const char *name);
/* Number of a joint set, 0 when there is none of that name. */
uint32_t tl_joint_find(const tl_model *m, const char *name);
/* Finds or makes a joint set; 0 when out of memory. */
uint32_t tl_joint_intern(tl_model *m, const char *name);
/* Parses "*", "J1" or "J1:3"; fails with a sentence (nearest name) when the joint does not exist. */
tl_status tl_joint_parse(tl_model *m, const char *text, tl_tag *tag);
/* The same text for a tag; valid until the next call. */
const char *tl_pattern_name(tl_model *m, tl_tag tag);
/* True when `pattern` ("*": 0,0; set: j,0; plane: j,p) covers `tag`. */
bool tl_tag_matches(tl_tag pattern, tl_tag tag);
/* The law that rules a contact of this tag between the blocks of two rows, or NULL (scope.h). */
const tl_law *tl_law_of(const tl_model *m, tl_tag tag, uint32_t a, uint32_t b);
/* The law of a joint, for contacts whose blocks no law names, or NULL. */
const tl_law *tl_law_of_joint(const tl_model *m, tl_tag tag);
tl_min_area_rule tl_min_area_of(const tl_model *m, tl_tag tag);
void tl_law_clear(tl_law *law);

#endif
