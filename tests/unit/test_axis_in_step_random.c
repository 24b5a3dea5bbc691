/*
 * A slave on its way into step, as the motor sees it: by the second and third differences of its set positions in every
 * cycle, whatever the axis says of its velocity and acceleration. Gears and cams over time, ways into step over the
 * master's position, and shifts of the phase, behind a master that changes its mind at random.
 * CM1E_TEST_SEED=<n> repeats one run, CM1E_TEST_SEEDS=<count> as many from there on.
 */
#include "unity.h"

#include "../support/axes_bench.h"
#include "coupling/coupling_private.h"
#include "../support/random_master.h"

enum { RUNS = 150, HISTORY = 4, LARGEST_RATIO = 3 };

void setUp(void) {}
void tearDown(void) { axes_end(); }

/* What doubles leave of a set position, counts: it counts from afar, and a difference of four of them has eight parts.
 * */
static const double rounding_counts = 2e-8;
static const double rounding = 5e-6; /* of a limit: the guard of the set-points leaves 1e-6 to each sum of doubles */

static struct seen {
    position_t set[HISTORY];     /* the newest first */
    int count;
    double worst_acceleration, worst_jerk; /* of the limit */
} seen;

/* Of what a gear of the largest ratio can follow. */
#define LARGEST_PART 0.95

static int taken, stopped, excused;
static double ratio;  /* of the gear that was begun last; 0 for cams, which leave two thirds of the limits */
static bool too_fast; /* the master: a command with less jerk than before makes it pass the velocity of the command */

static void judge(const cm1e_axis_t *axis, const double step[3])
{
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double t = axis->cycle_s, u = 1.0 / fabs(axis->position.scale);
    const double second = fmax(fabs(step[0] - step[1]) - rounding_counts, 0.0) * u / (t * t);
    const double third = fmax(fabs(step[0] - 2.0 * step[1] + step[2]) - rounding_counts, 0.0) * u / (t * t * t);
    const bool turns = step[0] * step[1] <= 0.0, faster = fabs(step[0]) > fabs(step[1]);
    const double bound = turns    ? fmax(most->acceleration, most->deceleration)
                         : faster ? most->acceleration : most->deceleration;
    const double acceleration = second / bound, jerk = third / most->jerk;
    seen.worst_acceleration = fmax(seen.worst_acceleration, acceleration);
    seen.worst_jerk = fmax(seen.worst_jerk, jerk);
    AXES_MUST(acceleration <= 1.0 + rounding, "acceleration %.9g of the limit", acceleration);
    AXES_MUST(jerk <= 1.0 + rounding, "jerk %.9g of the limit", jerk);
}

static void look(void)
{
    const cm1e_axis_t *axis = axes_axis(1);
    for (int i = HISTORY - 1; i > 0; i--)
        seen.set[i] = seen.set[i - 1];
    seen.set[0] = axis->setpoint.position;
    seen.count = axis->state == CM1E_AXIS_SYNCHRONIZED_MOTION ? seen.count + 1 : 0;
    if (seen.count < HISTORY)
        return;
    double step[HISTORY - 1];
    for (int i = 0; i < HISTORY - 1; i++)
        step[i] = cm1e_position_minus(seen.set[i], seen.set[i + 1]);
    judge(axis, step);
}

/* One that goes on in its direction. Where it turns round and comes back over the beginning of a way over its position,
 * the acceleration of the slave steps: what lies before is a straight line. */
static void drive_onwards(const random_master_t *master)
{
    const cm1e_motion_limits_t *most = &master->most;
    cm1e_command_id_t id;
    if (one_in(master->seldom))
        (void)cm1e_axis_start(axes_axis(0), &(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = most->velocity * uniform(0.1, 1.0),
            .acceleration = most->acceleration * uniform(0.1, 1.0),
            .deceleration = most->deceleration * uniform(0.1, 1.0), .jerk = most->jerk * uniform(0.05, 1.0)}, &id);
}

static void cycles(int count, const random_master_t *master, bool onwards)
{
    while (count-- > 0) {
        if (onwards)
            drive_onwards(master);
        else
            random_master_drive(master);
        axes_cycles(1);
        too_fast = too_fast || fabs(axes_axis(0)->setpoint.velocity) * ratio >
                                   LARGEST_PART * axes_axis(1)->limits.maximum.velocity;
        look();
    }
}

static void random_axes(void)
{
    axes_describe(2);
    axes_bench.cycle_ns = one_in(3) ? 250000 : 1000000;
    for (int n = 0; n < 2; n++) {
        axes_config(n)->max_velocity = uniform(5.0, 40.0);
        axes_config(n)->max_acceleration = uniform(20.0, 200.0);
        axes_config(n)->max_deceleration = one_in(2) ? 0.0 : uniform(20.0, 200.0);
        axes_config(n)->max_jerk = uniform(300.0, 6000.0);
        axes_config(n)->invert = one_in(2);
    }
    for (int n = 0; n < 2; n++)
        axes_config(n)->cam_points = 16;
    axes_make();
    axes_enable_all();
    axes_bench.witness[1].strictness = AXES_UNWATCHED; /* it is watched here */
    seen.count = 0;
}

/* ---- ways into step ---------------------------------------------------------------------------------------------- */

static double part_of(double most) { return one_in(2) ? 0.0 : uniform(0.1, 1.0) * most; }

static cm1e_axis_command_t dynamics(cm1e_command_kind_t kind, const cm1e_axis_coupling_t *coupling)
{
    const cm1e_motion_limits_t *most = &axes_axis(1)->limits.maximum;
    return (cm1e_axis_command_t){.kind = kind, .coupling = coupling, .velocity = most->velocity,
                                 .acceleration = part_of(most->acceleration),
                                 .deceleration = part_of(most->deceleration), .jerk = part_of(most->jerk)};
}

/* Refused where the slave cannot do it; it goes on as it was then. */
static bool start(const cm1e_axis_command_t *command)
{
    cm1e_command_id_t id;
    return cm1e_axis_start(axes_axis(1), command, &id) == CM1E_OK;
}

static bool geared(bool begun, const cm1e_axis_coupling_t *coupling)
{
    if (begun)
        ratio = (double)coupling->master[0].numerator / coupling->master[0].denominator;
    return begun;
}

static bool gear(void)
{
    const cm1e_axis_coupling_t coupling = {
        .master = {{.axis = axes_reference(0), .numerator = 1 + pick(LARGEST_RATIO),
                    .denominator = 1 + (uint32_t)pick(3)}}};
    const cm1e_axis_command_t command = dynamics(CM1E_COMMAND_GEAR_IN, &coupling);
    return geared(start(&command), &coupling);
}

static bool gear_in_pos(void)
{
    const double v = axes_axis(0)->setpoint.velocity;
    const cm1e_axis_coupling_t coupling = {
        .master = {{.axis = axes_reference(0), .numerator = 1, .denominator = 1 + (uint32_t)pick(3)}},
        .master_sync_position = axes_info(0).set_position + v * uniform(0.5, 3.0),
        .slave_sync_position = axes_info(1).set_position + v * uniform(0.1, 3.0)};
    const cm1e_axis_command_t command = dynamics(CM1E_COMMAND_GEAR_IN_POS, &coupling);
    return geared(start(&command), &coupling);
}

/* There and back, by polynomials that rest at both ends: the derivatives of a way of 1 in a time of 1 are 1.875, 5.77
 * and 60. Scaled so that the slave needs a third of its limits where the master has all of its own. */
static bool cam(const random_master_t *master, bool by_place)
{
    static MC_CAM_POINT points[3] = {{.Master = 0}, {.Master = 0.5, .Slave = 1}, {.Master = 1}};
    const MC_CAM_REF table = {.Points = points, .NumberOfPoints = 3, .Curve = mcCamPolynomial5};
    const cm1e_motion_limits_t *most = &axes_axis(1)->limits.maximum, *its = &master->most;
    const double length = its->velocity * uniform(0.3, 3.0), v = its->velocity / length;
    const double a = fmax(its->acceleration, its->deceleration) / length, j = its->jerk / length;
    const double slope = 1.875 * 2.0, curve = 5.77 * 4.0, third = 60.0 * 8.0;
    const double scaling =
        0.3 * fmin(most->velocity / (slope * v),
                   fmin(fmin(most->acceleration, most->deceleration) / (curve * v * v + slope * a),
                        most->jerk / (third * v * v * v + 3.0 * curve * v * a + slope * j)));
    MC_CAM_ID id = 0;
    AXES_MUST(cm1e_axis_cam_select(axes_axis(1), &table, true, false, false, &id) == CM1E_OK, "%s", axes_text(1));
    const cm1e_axis_coupling_t coupling = {
        .master = {{.axis = axes_reference(0)}}, .cam = id, .start_mode = mcRampIn, .master_scaling = length,
        .slave_scaling = scaling * (one_in(2) ? 1 : -1), .master_offset = uniform(-1.0, 1.0) * length,
        .slave_offset = uniform(-1.0, 1.0) * scaling,
        .master_start_distance = by_place ? uniform(0.2, 0.8) * length : 0.0,
        .master_sync_position = by_place ? axes_info(0).set_position + uniform(0.0, 1.0) * length : 0.0};
    const cm1e_axis_command_t command = dynamics(CM1E_COMMAND_CAM_IN, &coupling);
    return start(&command);
}

static bool phasing(const random_master_t *master)
{
    const cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(0)}}};
    cm1e_axis_command_t command = dynamics(CM1E_COMMAND_PHASING_RELATIVE, &coupling);
    command.position = uniform(-0.5, 0.5) * master->most.velocity;
    command.velocity = uniform(0.1, 0.5) * master->most.velocity;
    command.acceleration = uniform(0.1, 0.5) * master->most.acceleration;
    command.deceleration = uniform(0.1, 0.5) * master->most.deceleration;
    command.jerk = uniform(0.1, 0.5) * master->most.jerk;
    return start(&command);
}

/* ---- runs -------------------------------------------------------------------------------------------------------- */

typedef enum way_in { GEARS, GEARS_IN_POSITION, CAMS, CAMS_BY_PLACE, PHASINGS } way_in_t;

static bool go(way_in_t way, const random_master_t *master)
{
    switch (way) {
    case GEARS: return gear();
    case GEARS_IN_POSITION: return gear_in_pos();
    case CAMS: return cam(master, false);
    case CAMS_BY_PLACE: return cam(master, true);
    case PHASINGS: return one_in(3) ? gear() : phasing(master);
    }
    return false;
}

static void run(way_in_t way, const char *scene)
{
    const double part = way == CAMS || way == CAMS_BY_PLACE ? 1e-9 : LARGEST_RATIO;
    random_axes();
    axes_bench.run = scene;
    ratio = 0.0;
    too_fast = false;
    random_master_t master = random_master_for(0, 1, part, uniform(0.2, way == PHASINGS ? 0.45 : LARGEST_PART));
    master.seldom = 20 + (unsigned)pick(300);
    const bool onwards = way == GEARS_IN_POSITION || way == CAMS_BY_PLACE;
    cycles(300 + pick(300), &master, onwards);
    for (int i = 0; i < 4; i++) {
        taken += go(way, &master);
        cycles(300 + pick(1500), &master, onwards);
    }
    if (axes_state(1) == CM1E_AXIS_ERROR_STOP)
        (*(too_fast ? &excused : &stopped))++; /* a master that is not too fast leaves the slave what it needs in step */
    axes_end();
}

static void run_seed(way_in_t way, const char *name, unsigned seed)
{
    char scene[64];
    snprintf(scene, sizeof scene, "%s, CM1E_TEST_SEED=%u", name, seed);
    chance_seed(seed);
    run(way, scene);
}

static void runs_of(way_in_t way, const char *name)
{
    const int runs = seed_count(RUNS);
    seen = (struct seen){.count = 0};
    taken = stopped = excused = 0;
    for (int i = 0; i < runs; i++)
        run_seed(way, name, seed_of(i));
    printf("%s: %d begun, %d in ErrorStop at the end, %d behind a master too fast; acceleration %.9f, jerk %.9f of "
           "the limit\n", name, taken, stopped, excused, seen.worst_acceleration, seen.worst_jerk);
    TEST_ASSERT_EQUAL_INT(0, stopped);
}

/* In these the slave turns round with all of its deceleration: in the first two that is larger than its acceleration, in
 * the other two smaller. */
static void test_slaves_that_turn_round(void)
{
    run_seed(GEARS_IN_POSITION, "MC_GearInPos", 10392);
    run_seed(GEARS_IN_POSITION, "MC_GearInPos", 104200);
    run_seed(GEARS_IN_POSITION, "MC_GearInPos", 458);
    run_seed(GEARS_IN_POSITION, "MC_GearInPos", 303318);
}

static void test_gears_over_time(void) { runs_of(GEARS, "MC_GearIn"); }
static void test_gears_by_place(void) { runs_of(GEARS_IN_POSITION, "MC_GearInPos"); }
static void test_cams_over_time(void) { runs_of(CAMS, "MC_CamIn, mcRampIn"); }
static void test_cams_by_place(void) { runs_of(CAMS_BY_PLACE, "MC_CamIn, MasterStartDistance"); }
static void test_phasings(void) { runs_of(PHASINGS, "MC_PhasingRelative"); }

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_gears_over_time);
    RUN_TEST(test_gears_by_place);
    RUN_TEST(test_cams_over_time);
    RUN_TEST(test_cams_by_place);
    RUN_TEST(test_phasings);
    RUN_TEST(test_slaves_that_turn_round);
    return UNITY_END();
}
