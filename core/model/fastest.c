/* fastest.c - which velocities are taken from a user. */
#include "model/model.h"

static bool is_motion(tl_vec3 v)
{
    return fabs(v.x) <= TL_FASTEST && fabs(v.y) <= TL_FASTEST && fabs(v.z) <= TL_FASTEST;
}

static tl_status bad_motion(tl_error *error, const char *verb, const char *name, tl_vec3 v,
                            const char *unit)
{
    return tl_fail(error, TL_E_ARGUMENT,
                   "%s: %s = {%g, %g, %g} %s must be three finite numbers of at most %g: no model "
                   "can run with more",
                   verb, name, v.x, v.y, v.z, unit, TL_FASTEST);
}

tl_status tl_check_motion(tl_error *error, const char *verb, tl_vec3 velocity,
                          tl_vec3 angular_velocity)
{
    if (!is_motion(velocity))
        return bad_motion(error, verb, "velocity", velocity, "m/s");
    if (!is_motion(angular_velocity))
        return bad_motion(error, verb, "angular_velocity", angular_velocity, "rad/s");
    return TL_OK;
}
