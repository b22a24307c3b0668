/* bolts.c - how long the update of a bolt of 30 nodes takes on one core. Run as
 *
 *     ./bootstrap bench elements
 *
 * 1,000 bolts across a joint that opens and shears a little in each step: while all is elastic, and while grout slips and
 * steel yields. The target is 1.5 us a bolt and step, and 120 bytes of states a node. Processor time. */
#include "../../plugins/elements/bolt/bolt.c"
#include "../../plugins/elements/bolt/chain.c"

#include <time.h>

#define BOLTS 1000
#define NODES 30
#define COUNT (BOLTS * NODES)

static double rest[3][COUNT], u[3][COUNT], du[3][COUNT], v[3][COUNT], normal[3][COUNT], force[3][COUNT], weight[COUNT];
static double state[NODE_STATES][COUNT], whole[WHOLE_STATES][BOLTS], stored[BOLTS], lost[BOLTS], given[BOLTS];
static uint32_t start[BOLTS + 1], flags[BOLTS];

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Bolts of 2.8 m along x, with the joint in the middle. */
static void lay_bolts(void)
{
    memset(u, 0, sizeof u);
    memset(state, 0, sizeof state);
    memset(whole, 0, sizeof whole);
    for (uint32_t i = 0; i < COUNT; i++) {
        const uint32_t k = i % NODES;
        rest[0][i] = 0.1 * (k < NODES / 2 ? k : k - 1);
        rest[1][i] = i / NODES;
        weight[i] = state[GROUTED][i] = k == 0 || k == NODES / 2 - 1 || k == NODES / 2 || k == NODES - 1 ? 0.05 : 0.1;
        state[CROSSES][i] = k == NODES / 2 - 1;
    }
    for (uint32_t e = 0; e <= BOLTS; e++)
        start[e] = e * NODES;
}

/* us for each bolt and step, in which the joint opens by `way` m and shears by half of that. */
static double time_steps(double way, int steps)
{
    static const params p = {.diameter = 0.025,
                             .young = 200e9,
                             .yield = 2.4e5,
                             .rupture_strain = 0.1,
                             .grout_stiffness = 1e9,
                             .grout_strength = 4e5,
                             .grout_residual = 2e5,
                             .grouted_to = 1,
                             .plate_stiffness = 5e7,
                             .plate_strength = 2e5,
                             .dowel_stiffness = 1e8,
                             .dowel_strength = 1e5,
                             .dowel_rupture = 0.05,
                             .active_length = 0.05,
                             .spacing = 0.1};
    double *states[NODE_STATES], *wholes[WHOLE_STATES];
    tl_report report = {.size = sizeof report};
    tl_element_batch b = {.size = sizeof b, .count = BOLTS, .dt = 1e-4, .start = start, .weight = weight};
    lay_bolts();
    for (int k = 0; k < 3; k++) {
        b.rest[k] = rest[k];
        b.u[k] = u[k];
        b.du[k] = du[k];
        b.v[k] = v[k];
        b.normal[k] = normal[k];
        b.force[k] = force[k];
    }
    for (int k = 0; k < NODE_STATES; k++)
        states[k] = state[k];
    for (int k = 0; k < WHOLE_STATES; k++)
        wholes[k] = whole[k];
    b.state = states;
    b.element_state = wholes;
    b.flags = flags;
    b.stored = stored;
    b.lost = lost;
    b.given = given;
    double taken = 0;
    for (int n = 0; n < steps; n++) {
        for (uint32_t i = 0; i < COUNT; i++) {
            const double far = i % NODES >= NODES / 2 ? way : 0;
            du[0][i] = far;
            du[1][i] = 0.5 * far;
            u[0][i] += far;
            u[1][i] += 0.5 * far;
        }
        const double began = seconds();
        update(&p, &b, &report);
        taken += seconds() - began;
    }
    return 1e6 * taken / steps / BOLTS;
}

int main(void)
{
    printf("elastic   %6.2f us a bolt and step\n", time_steps(1e-8, 500));
    printf("slipping  %6.2f us a bolt and step\n", time_steps(1e-5, 500));
    printf("states    %6zu bytes a node\n", NODE_STATES * sizeof(double));
    return 0;
}
