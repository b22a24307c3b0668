/* path.h - the legs of a tunnel whose profile follows a path (path.c). */
#ifndef TUNNEL_PATH_H
#define TUNNEL_PATH_H

#include <stdbool.h>
#include <talus/kit.h>

/* Tolerance: corners are given with six digits or more. Places closer than this times the size of the tunnel are the
 * same, and what is bent by less is flat. Test: lua/test_tunnel. */
#define TUNNEL_FIT 1e-6

typedef struct tunnel_path {
    tl_vec3 *corners; /* [legs][2][corners of the profile]: both ends of each leg */
    size_t legs;
    bool closed; /* the last leg ends where the first begins, in the same plane */
} tunnel_path;

/* Lays the ends of the legs of a path. The profile, {across to the right, up, 0}, does not cross itself; places closer
 * than `near`, m, are the same. Free `corners`. */
tl_status tunnel_path_lay(const tl_host *host, const tl_points *profile, const tl_points *points, double near,
                          tunnel_path *made);

#endif
