/* contact_damping.c - damping of contacts in proportion to their stiffness, point by point.
 *
 * A closed point that does not slip gets the force
 *
 *     f_n = beta dF_n / dt,    f_s = -beta (dF_s / dt . e) e,    e = du_s / |du_s|
 *
 * on top of its law's. dF is what the law's force has changed by in the last step, dt, as if by the law's tangent. It
 * is at least 0 and at most kn A |du_n| or ks A |du_s|, with the stiffness that the law states. So what a new polygon
 * or another law changes of the forces makes no damping, and the damping only takes energy. Where the law cannot pull,
 * law and damping together do not pull either: f_n >= -F_n.
 *
 * The law's own forces and states are not touched. The sums act on bodies with the other damping forces, and what they
 * take is in the ledger as damping. */
#include "force/contact_damping.h"

#include "force/joint_laws.h"

#include <math.h>
#include <string.h>

void tl_damping_note(const double *f_n, double *const f_s[3], size_t first, size_t count, const tl_point_forces *to)
{
    memcpy(to->normal, f_n + first, count * sizeof *f_n);
    for (int k = 0; k < 3; k++)
        memcpy(to->shear[k], f_s[k] + first, count * sizeof *f_n);
}

/* `value` as far as it lies between 0 and `most`, of either sign. */
static double between(double value, double most)
{
    return most > 0 ? fmin(fmax(value, 0), most) : fmax(fmin(value, 0), most);
}

static double normal_damping(const tl_law *law, const tl_damped_points *of, double rate, double before, size_t i)
{
    const double force = of->f_n[i];
    const double damping = rate * between(force - before, -law->kn * of->area[i] * of->du_n[i]);
    return force > 0 && !tl_law_may_pull(law, of->flags[i]) ? fmax(damping, -force) : damping;
}

/* N/m: by which the motion along the face is resisted. */
static double shear_damping(const tl_law *law, const tl_damped_points *of, double rate, const tl_point_forces *before,
                            size_t i)
{
    double along = 0, way = 0;
    for (int k = 0; k < 3; k++) {
        along -= (of->f_s[k][i] - before->shear[k][i]) * of->du_s[k][i];
        way += of->du_s[k][i] * of->du_s[k][i];
    }
    return way > 0 ? rate * fmin(fmax(along / way, 0), law->ks * of->area[i]) : 0;
}

void tl_damping_of_points(const tl_law *law, const tl_damped_points *of, double rate, const tl_point_forces *forces)
{
    for (size_t i = 0; i < of->count; i++) {
        const bool closed = of->area[i] > 0 && of->f_n[i] != 0;
        const bool sticks = closed && !(of->flags[i] & (TL_POINT_SLIPPING | TL_POINT_OPEN));
        const double normal = closed ? normal_damping(law, of, rate, forces->normal[i], i) : 0;
        const double shear = sticks ? shear_damping(law, of, rate, forces, i) : 0;
        forces->normal[i] = normal;
        for (int k = 0; k < 3; k++)
            forces->shear[k][i] = -shear * of->du_s[k][i];
    }
}
