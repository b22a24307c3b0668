/* memory.h - what the detection holds, in bytes (memory.c). */
#ifndef TL_CONTACT_MEMORY_H
#define TL_CONTACT_MEMORY_H

#include "model/model.h"

/* Adds what the detection holds. */
void tl_detect_memory(const tl_model *m, tl_memory *memory);

#endif
