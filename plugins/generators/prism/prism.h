/* prism.h - what the generators of this plugin share. */
#ifndef PRISM_PRISM_H
#define PRISM_PRISM_H

#include "convex.h"

#include <talus/kit.h>

#define MOST_SIDES 1000

extern const tl_kind prism_kind, profile_kind; /* prism.c, profile.c */

/* Makes one body of the convex parts of a plane polygon, each with the same moved by `axis`: extrude.c. `points` are its
 * corners, at[i] where points.at[i] lies in its plane; `name` is its name in messages. */
tl_status prism_extrude(const tl_host *host, const char *name, tl_points points, const flat *at,
                        tl_vec3 axis, double density, const char *group);

#endif
