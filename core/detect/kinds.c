/* kinds.c - the kinds of contact that there are: patches, where a face lies on a face, and field contacts, all else. */
#include "detect/kinds.h"

#include "contact/handover.h"
#include "contact/kinds.h"
#include "force/field_press.h"
#include "force/laws.h"

static const tl_contact_kind patch = {
    .name = "patch", .place = &tl_patch_place, .force = &tl_patch_force, .make = &tl_patch_make};
static const tl_contact_kind field = {
    .name = "field", .place = &tl_field_place, .force = &tl_field_force, .make = &tl_field_make};

const tl_contact_kind *const tl_contact_kinds[TL_FACET_KINDS] = {[TL_FACET_PATCH] = &patch, [TL_FACET_FIELD] = &field};
