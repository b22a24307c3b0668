/* box3d_blocks.c - the blocks of a block model as bodies of Box3D, timed as Talus is. run.py writes them with blocks.py, and builds this
 * program where Box3D is installed (its prefix in the variable BOX3D); CMake leaves it out.
 *
 *     blocks.py wall.json wall.txt
 *     box3d_blocks file=wall.txt workload="box3d wall" size=1000 dt=2e-4 settle=500 steps=200 reps=3 recycle=on
 *     box3d_blocks file=falling.txt workload="box3d falling" dt=5e-4 down=0.1 still=0.005
 *
 * One thread, one sub-step a step, and what Box3D does by itself, but for one thing: no body sleeps. Friction is that of Talus; a
 * contact has no stiffness. recycle=off finds the points of all contacts anew in every step. A contact is a pair of bodies with
 * points that bore an impulse in the last step. `down` and `still` ask for the second kind of row: the time until blocks, slowed
 * down by `drag` (1/s) until their mean speed is `down` (m/s), move at `still`, from the first body made. Processor time; prints
 * rows of CSV. */
#include <box3d/box3d.h>

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define FRICTION 0.6f /* angle, rad */
#define GRAVITY 9.81f
#define MASS_ERROR 1e-4 /* of a hull in single precision, of its mass */
enum { MOST_CORNERS = 128, MOST_REPS = 64, LOOK = 250, MOST_STEPS = 200000 };

typedef struct options {
    const char *file, *workload, *size, *recycle;
    double dt, drag, down, still;
    int settle, warm, steps, reps;
} options;

typedef struct blocks {
    b3WorldId world;
    b3BodyId *body;
    int count, free;
} blocks;

typedef struct carried {
    double pairs, points;
} carried;

static void fail(const char *what, const char *which)
{
    fprintf(stderr, "box3d_blocks: %s%s\n", what, which);
    exit(1);
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---------------------------------------------------------------- the model */

static double number(FILE *file)
{
    double value = 0;
    if (fscanf(file, "%lf", &value) != 1)
        fail("a number is missing in the file of blocks", "");
    return value;
}

static b3Vec3 vector(FILE *file)
{
    b3Vec3 v;
    v.x = (float)number(file);
    v.y = (float)number(file);
    v.z = (float)number(file);
    return v;
}

static b3BodyId read_block(b3WorldId world, FILE *file, const options *given, bool *free_body)
{
    char kind[16];
    if (fscanf(file, "%15s", kind) != 1)
        fail("a block is missing in the file of blocks", "");
    double density = number(file), mass = number(file);
    int corners = (int)number(file);
    b3Vec3 corner[MOST_CORNERS];
    if (corners > MOST_CORNERS)
        fail("a block has too many corners", "");
    for (int i = 0; i < corners; i++)
        corner[i] = vector(file);
    b3Vec3 centre = vector(file);
    *free_body = strcmp(kind, "free") == 0;

    b3BodyDef body = b3DefaultBodyDef();
    body.type = *free_body ? b3_dynamicBody : b3_staticBody;
    body.position.x = centre.x;
    body.position.y = centre.y;
    body.position.z = centre.z;
    body.linearDamping = body.angularDamping = (float)given->drag;
    body.enableContactRecycling = strcmp(given->recycle, "off") != 0;
    b3BodyId made = b3CreateBody(world, &body);
    b3ShapeDef shape = b3DefaultShapeDef();
    shape.density = (float)density;
    shape.baseMaterial.friction = tanf(FRICTION);
    b3HullData *hull = b3CreateHull(corner, corners, MOST_CORNERS);
    if (!hull)
        fail("Box3D makes no hull of a block", "");
    b3CreateHullShape(made, &shape, hull);
    b3DestroyHull(hull);
    if (*free_body && !(fabs((double)b3Body_GetMass(made) / mass - 1) < MASS_ERROR))
        fail("the mass of a body is not the block's", "");
    return made;
}

static blocks read_blocks(const options *given)
{
    FILE *file = fopen(given->file, "r");
    if (!file)
        fail("cannot read ", given->file);
    b3WorldDef world = b3DefaultWorldDef();
    world.gravity = (b3Vec3){0, 0, -GRAVITY};
    world.enableSleep = false;
    world.workerCount = 1;
    blocks made = {.world = b3CreateWorld(&world), .count = (int)number(file)};
    made.body = calloc((size_t)made.count, sizeof *made.body);
    if (!made.body)
        fail("no memory for the bodies", "");
    for (int i = 0; i < made.count; i++) {
        bool free_body;
        made.body[i] = read_block(made.world, file, given, &free_body);
        made.free += free_body;
    }
    fclose(file);
    return made;
}

static void step(const blocks *made, const options *given, int count)
{
    for (int i = 0; i < count; i++)
        b3World_Step(made->world, (float)given->dt, 1);
}

/* ---------------------------------------------------------------- what is counted */

/* Of one body: the contacts in which it is the first, so that each counts once. */
static void count_body(b3BodyId body, carried *sum)
{
    int room = b3Body_GetContactCapacity(body);
    b3ContactData *data = calloc((size_t)room + 1, sizeof *data);
    b3ShapeId own;
    if (!data || b3Body_GetShapes(body, &own, 1) != 1)
        fail("no memory for the contacts", "");
    int count = b3Body_GetContactData(body, data, room);
    for (int i = 0; i < count; i++) {
        if (data[i].shapeIdA.index1 != own.index1)
            continue;
        int points = 0;
        for (int k = 0; k < data[i].manifoldCount; k++)
            for (int p = 0; p < data[i].manifolds[k].pointCount; p++)
                points += data[i].manifolds[k].points[p].totalNormalImpulse > 0;
        sum->points += points;
        sum->pairs += points > 0;
    }
    free(data);
}

static carried count_contacts(const blocks *made)
{
    carried sum = {0};
    for (int i = 0; i < made->count; i++)
        count_body(made->body[i], &sum);
    return sum;
}

/* Mean speed of the free bodies, m/s. */
static double mean_speed(const blocks *made)
{
    double sum = 0;
    for (int i = 0; i < made->count; i++) {
        b3Vec3 v = b3Body_GetLinearVelocity(made->body[i]);
        sum += sqrt((double)v.x * (double)v.x + (double)v.y * (double)v.y + (double)v.z * (double)v.z);
    }
    return sum / made->free;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, compare);
    return (values[(count - 1) / 2] + values[count / 2]) / 2;
}

/* ---------------------------------------------------------------- rows */

static void row(const options *given, const blocks *made, carried contacts)
{
    printf("workload,size,blocks,contacts,points,threads,reuse,rate,unit,block_steps_per_s,speed\n"
           "%s,%s,%d,%.0f,%.0f,1,%s,",
           given->workload, given->size, made->free, contacts.pairs, contacts.points, given->recycle);
}

/* Stretches of steps, one after the other, each with the mean of the contacts at its beginning and its end. */
static void measure(const options *given)
{
    blocks made = read_blocks(given);
    double pairs[MOST_REPS], points[MOST_REPS], rates[MOST_REPS], times[MOST_REPS];
    step(&made, given, given->settle + given->warm);
    carried before = count_contacts(&made);
    for (int i = 0; i < given->reps; i++) {
        double began = seconds();
        step(&made, given, given->steps);
        times[i] = (seconds() - began) / given->steps;
        carried after = count_contacts(&made);
        pairs[i] = (before.pairs + after.pairs) / 2;
        points[i] = (before.points + after.points) / 2;
        rates[i] = pairs[i] / times[i];
        before = after;
    }
    row(given, &made, (carried){median(pairs, given->reps), median(points, given->reps)});
    printf("%.5g,contacts/s,%.5g,%.3g\n", median(rates, given->reps), made.free / median(times, given->reps),
           mean_speed(&made));
}

static void fall(options given)
{
    double began = seconds();
    blocks made = read_blocks(&given);
    bool slowed = true;
    int steps = 0;
    for (;;) {
        step(&made, &given, LOOK);
        steps += LOOK;
        double speed = mean_speed(&made);
        if (slowed && steps > LOOK && speed < given.down) {
            slowed = false;
            for (int i = 0; i < made.count; i++) {
                b3Body_SetLinearDamping(made.body[i], 0);
                b3Body_SetAngularDamping(made.body[i], 0);
            }
        } else if (!slowed && speed < given.still) {
            break;
        }
        if (steps > MOST_STEPS)
            fail("the blocks do not come to rest", "");
    }
    double taken = seconds() - began;
    char size[32];
    snprintf(size, sizeof size, "%d steps", steps);
    given.size = size;
    row(&given, &made, count_contacts(&made));
    printf("%.5g,s,,%.3g\n", taken, mean_speed(&made));
}

static options read_options(int count, char **words)
{
    options given = {
        .file = "blocks.txt", .workload = "box3d", .size = "", .recycle = "on", .dt = 2e-4, .steps = 100, .reps = 3};
    const struct {
        const char *name, **text;
        double *real;
        int *whole;
    } known[] = {{"file", &given.file, NULL, NULL},     {"workload", &given.workload, NULL, NULL},
                 {"size", &given.size, NULL, NULL},     {"recycle", &given.recycle, NULL, NULL},
                 {"dt", NULL, &given.dt, NULL},         {"drag", NULL, &given.drag, NULL},
                 {"down", NULL, &given.down, NULL},     {"still", NULL, &given.still, NULL},
                 {"settle", NULL, NULL, &given.settle}, {"warm", NULL, NULL, &given.warm},
                 {"steps", NULL, NULL, &given.steps},   {"reps", NULL, NULL, &given.reps}};
    for (int i = 1; i < count; i++) {
        const char *equals = strchr(words[i], '=');
        size_t length = equals ? (size_t)(equals - words[i]) : 0;
        size_t k = 0, all = sizeof known / sizeof known[0];
        while (k < all && (!equals || strlen(known[k].name) != length || strncmp(words[i], known[k].name, length) != 0))
            k++;
        if (k == all)
            fail("unknown argument ", words[i]);
        if (known[k].text)
            *known[k].text = equals + 1;
        else if (known[k].real)
            *known[k].real = strtod(equals + 1, NULL);
        else
            *known[k].whole = (int)strtol(equals + 1, NULL, 10);
    }
    if (given.reps < 1 || given.reps > MOST_REPS || given.steps < 1)
        fail("steps must be 1 or more, reps from 1 to 64", "");
    return given;
}

int main(int count, char **words)
{
    options given = read_options(count, words);
    if (given.still > 0)
        fall(given);
    else
        measure(&given);
    return 0;
}
