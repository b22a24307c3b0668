/* talus/settings.h - the parameters a model has now, those left out by the script included: part of talus/talus.h. */
#ifndef TALUS_SETTINGS_H
#define TALUS_SETTINGS_H

#include <talus/plugin.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

struct tl_model;
struct tl_timestep;
struct tl_contact_area;

/* A plugin in use and its parameters, a struct of the model's as kind->params describes it. It holds no texts or lists:
 * the loader refuses a law or damping with such parameters, which live only as long as a call. */
typedef struct tl_plugin_setting {
    const tl_kind *kind; /* NULL: none */
    const void *params;
} tl_plugin_setting;

/* The law with index i, counted from 0 in the order in which joints were given one: `*joint` is "*", "J1" or "J1:3",
 * valid until the next call. false past the last one. */
TL_API bool tl_model_law_at(struct tl_model *model, size_t i, const char **joint, tl_plugin_setting *law);
/* The joint set with index i, and the joint whose law rules it ("J1" itself or "*"; NULL: none does). Single planes may
 * have a law of their own. false past the last one. */
TL_API bool tl_model_joint_at(struct tl_model *model, size_t i, const char **name, const char **ruled_by);
/* The damping in use; with kind NULL there is none. */
TL_API tl_plugin_setting tl_model_damping_now(const struct tl_model *model);
/* With the fraction that is in use. */
TL_API struct tl_timestep tl_model_timestep_now(const struct tl_model *model);
/* The rule of the minimum area with index i: 0 of every joint, then those of single joints, whose names are valid until
 * the next call. false past the last one. */
TL_API bool tl_model_contact_area_at(struct tl_model *model, size_t i, struct tl_contact_area *rule);

#ifdef __cplusplus
}
#endif
#endif
