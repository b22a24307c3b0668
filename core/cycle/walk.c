/* walk.c - the entries of what the phases of a step keep. What a step may undo is no entry: no call ends within it. */
#include "cycle/walk.h"

#define VALUE(keep, member) TL_WALK_VALUE(walk, TL_KEEP_##keep, "cycle.", c, member)
#define FLAG(keep, member) TL_WALK_FLAG(walk, TL_KEEP_##keep, "cycle.", c, member)
#define LIST(keep, member, count, capacity, bytes)                                                                     \
    TL_WALK_LIST(walk, TL_KEEP_##keep, "cycle.", c, member, (count), (capacity), offsetof(tl_memory, bytes))

void tl_cycle_walk(struct tl_cycle *c, const tl_walk *walk)
{
    tl_walk_table(walk, TL_KEEP_CACHE, "cycle", &c->table, offsetof(tl_memory, step));
    LIST(CACHE, reaction, &c->reaction_capacity, &c->reaction_capacity, step);
    VALUE(CACHE, reactions_for);
    VALUE(CACHE, sums);
    VALUE(STATE, kinetic_before);
    VALUE(STATE, dt);
    VALUE(CACHE, step_bounds.version);
    VALUE(CACHE, step_bounds.constraints);
    VALUE(CACHE, step_bounds.rotation);
    FLAG(CACHE, step_bounds.points);
    VALUE(CACHE, step_bounds.least_mass);
    VALUE(CACHE, step_bounds.lightest);
    FLAG(CACHE, all_held);
    VALUE(CACHE, stiffness_rates);
    VALUE(CACHE, sliver_structure);
    VALUE(CACHE, sliver);
    VALUE(CACHE, contacts);
    VALUE(STATE, mass_scale);
    VALUE(STATE, added);
    VALUE(STATE, added_block);
    VALUE(CACHE, told_share);
    FLAG(STATE, adds);
    FLAG(CACHE, long_step);
    FLAG(CACHE, fast);
    VALUE(CACHE, failing);
    VALUE(CACHE, rest_ratio);
    VALUE(STATE, ledger);
    LIST(SCRATCH, gathered, &c->gathered_capacity, &c->gathered_capacity, step);
    LIST(SCRATCH, booked, &c->booked_capacity, &c->booked_capacity, step);
    LIST(SCRATCH, heat, &c->heat_capacity, &c->heat_capacity, step);
    LIST(SCRATCH, stored, &c->stored_capacity, &c->stored_capacity, step);
    LIST(SCRATCH, motion, &c->motion_capacity, &c->motion_capacity, step);
    LIST(SCRATCH, swept, &c->swept_capacity, &c->swept_capacity, step);
}
