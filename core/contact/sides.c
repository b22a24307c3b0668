/* sides.c - the sides of contacts with deformable blocks. */
#include "contact/sides.h"

tl_sides tl_carried_sides(const tl_contacts *c, uint32_t contact, tl_sides own)
{
    const bool a = c->carrier[0][contact].on, b = c->carrier[1][contact].on;
    return (tl_sides){a ? TL_CARRIED | 2 * contact : own.a, b ? TL_CARRIED | (2 * contact + 1) : own.b};
}

static double odometer_of(const tl_model *m, uint32_t side)
{
    const tl_carrier *by = tl_side_carrier(m, side);
    return by ? by->odometer : m->bodies.odometer[side];
}

double tl_carried_odometer(const tl_model *m, uint32_t contact)
{
    const tl_sides s = tl_contact_sides(m, contact);
    return odometer_of(m, s.a) + odometer_of(m, s.b);
}
