/* sound.h - whether the rows of a model that were read from a file fit together (sound.c). */
#ifndef TL_STATE_SOUND_H
#define TL_STATE_SOUND_H

#include "cycle/cycle_data.h"
#include "model/model.h"

/* What is wrong with settings, blocks and bodies, before there are polyhedra; NULL: nothing. */
const char *tl_rows_unsound(const tl_model *m, size_t groups, size_t drives);
/* The same of what the phases of a step keep; what is known there of rows that have gone is forgotten. */
const char *tl_cycle_unsound(const tl_model *m, struct tl_cycle *c);

#endif
