/* kinds.h - patches and field contacts: contact/kind.h. */
#ifndef TL_CONTACT_KINDS_H
#define TL_CONTACT_KINDS_H

#include "contact/kind.h"

extern const tl_kind_place tl_patch_place, tl_field_place;

#endif
