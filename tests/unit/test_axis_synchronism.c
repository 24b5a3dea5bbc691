/*
 * Synchronism, measured: in every cycle of long runs, with a master that changes velocity and direction at random, the
 * set-point of a slave is compared with the ideal function of its master's set-point. The function is computed here, in
 * long double from whole counts and the configuration's own numbers, with nothing of the axis but its set position.
 * CM1E_TEST_SEED=<n> repeats one run.
 */
#include "unity.h"

#include "../support/axes_bench.h"
#include "../support/ideal_cam.h"
#include "../support/ordinary_witness.h"
#include "../support/random_master.h"

/* Counts: what the issue demands is 1; what is kept is the rounding of the target to whole counts, not seen here. */
static const long double largest_error = 0.01L;

void setUp(void) {}
void tearDown(void) { axes_end(); }

static long double worst;

/* ---- the ideal function ------------------------------------------------------------------------------------------ */

/** Counts of one u, as the configuration says. */
static long double counts_per_u(const cm1e_axis_config_t *c)
{
    const long double amount =
        c->counts_per_unit > 0 ? (long double)c->counts_per_unit
                               : 50000.0L * (c->gear_numerator ? c->gear_numerator : 1) /
                                     ((c->units_per_revolution > 0 ? (long double)c->units_per_revolution : 1.0L) *
                                      (c->gear_denominator ? c->gear_denominator : 1));
    return c->invert ? -amount : amount;
}

/** A gear from the moment in which both were there. */
typedef struct gear {
    int master, slave;
    long double ratio;          /**< counts of the slave in one of the master */
    position_t master_at, slave_at;
} gear_t;

static gear_t gear_from_now(int slave, int master, int32_t numerator, uint32_t denominator)
{
    const long double in_units = (long double)numerator / (long double)denominator;
    return (gear_t){.master = master, .slave = slave,
                    .ratio = in_units * counts_per_u(axes_config(slave)) / counts_per_u(axes_config(master)),
                    .master_at = axes_axis(master)->setpoint.position, .slave_at = axes_axis(slave)->setpoint.position};
}

static long double way(position_t from, position_t to)
{
    return (long double)(to.counts - from.counts) + ((long double)to.fraction - (long double)from.fraction);
}

static long double gear_error(const gear_t *gear)
{
    const long double ideal = gear->ratio * way(gear->master_at, axes_axis(gear->master)->setpoint.position);
    return fabsl(way(gear->slave_at, axes_axis(gear->slave)->setpoint.position) - ideal);
}

static void judge_gear(const gear_t *gear)
{
    const cm1e_axis_t *m = axes_axis(gear->master), *s = axes_axis(gear->slave);
    const long double error = gear_error(gear);
    const double ratio = (double)(gear->ratio * counts_per_u(axes_config(gear->master)) /
                                  counts_per_u(axes_config(gear->slave)));
    worst = fmaxl(worst, error);
    axes_must_be(gear->slave, CM1E_AXIS_SYNCHRONIZED_MOTION);
    AXES_MUST(error <= largest_error, "slave %d is %Lg counts beside its gear, %Lg counts from the start",
              gear->slave, error, way(gear->slave_at, s->setpoint.position));
    const double v = ratio * m->setpoint.velocity, a = ratio * m->setpoint.acceleration;
    AXES_MUST(fabs(s->setpoint.velocity - v) <= 1e-9 * fabs(v) + 1e-12, "velocity %.15g instead of %.15g",
              s->setpoint.velocity, v);
    AXES_MUST(fabs(s->setpoint.acceleration - a) <= 1e-9 * fabs(a) + 1e-9, "acceleration %.15g instead of %.15g",
              s->setpoint.acceleration, a);
}

/* ---- cams -------------------------------------------------------------------------------------------------------- */

/** A cam as it was placed: the slave's counts at the master's. */
typedef struct placed_cam {
    int master, slave;
    ideal_cam_t table;
    long double master_scaling, slave_scaling, master_offset, slave_offset;
    position_t master_zero, slave_zero; /**< where both were when MC_CamIn began; from there relative cams count */
    int entered, left; /**< side, -1 or 1, from which the master came onto a cam that is run once, and to which, having
                            gone through it; 0: none */
} placed_cam_t;

static long double master_in_cam(const placed_cam_t *cam)
{
    const long double u = way(cam->master_zero, axes_axis(cam->master)->setpoint.position) /
                          counts_per_u(axes_config(cam->master));
    return (u - cam->master_offset) / cam->master_scaling;
}

static int side_of(const placed_cam_t *cam)
{
    const long double place = master_in_cam(cam);
    return place <= cam->table.points[0].Master ? -1 : place >= cam->table.points[cam->table.count - 1].Master;
}

/** To be called in every cycle: what was gone through is not run again (4.1). */
static void go_through(placed_cam_t *cam)
{
    const int side = side_of(cam);
    if (!cam->table.periodic && cam->left == 0 && side != cam->entered)
        cam->left = side;
}

static long double cam_error(const placed_cam_t *cam)
{
    const long double s = counts_per_u(axes_config(cam->slave));
    const long double begin = ideal_cam_at(&cam->table, -cam->master_offset / cam->master_scaling);
    const long double ends[] = {cam->table.points[0].Master, master_in_cam(cam),
                                cam->table.points[cam->table.count - 1].Master};
    const long double now = ideal_cam_at(&cam->table, ends[cam->left + 1]);
    const long double ideal = (cam->slave_offset + cam->slave_scaling * (now - begin)) * s;
    return fabsl(way(cam->slave_zero, axes_axis(cam->slave)->setpoint.position) - ideal);
}

static void judge_cam(const placed_cam_t *cam)
{
    const long double error = cam_error(cam);
    worst = fmaxl(worst, error);
    axes_must_be(cam->slave, CM1E_AXIS_SYNCHRONIZED_MOTION);
    AXES_MUST(error <= largest_error, "slave %d is %Lg counts beside its cam, curve %d", cam->slave, error,
              cam->table.curve);
}

/** Derivatives of the cam, as far as dense samples show them. */
static void steepness(const ideal_cam_t *cam, double *slope, double *curvature, double *third)
{
    const long double first = cam->points[0].Master, length = cam->points[cam->count - 1].Master - first;
    const int parts = 3000;
    const long double h = length / parts;
    *slope = *curvature = *third = 0;
    for (int i = 0; i < parts; i++) {
        long double y[4];
        for (int k = 0; k < 4; k++)
            y[k] = ideal_cam_at(cam, first + (i + k) * h);
        *slope = fmax(*slope, fabs((double)((y[1] - y[0]) / h)));
        *curvature = fmax(*curvature, fabs((double)((y[2] - 2 * y[1] + y[0]) / (h * h))));
        *third = fmax(*third, fabs((double)((y[3] - 3 * y[2] + 3 * y[1] - y[0]) / (h * h * h))));
    }
}

/** A periodic cam, or one that is run once and rests at both ends. */
static MC_CAM_REF random_table(MC_CAM_POINT *points, double length, bool periodic)
{
    const int count = 3 + pick(6);
    const MC_CAM_CURVE curve = periodic ? (MC_CAM_CURVE)pick(3) : mcCamPolynomial5;
    for (int i = 0; i < count; i++) {
        const bool end = i == 0 || i == count - 1;
        points[i] = (MC_CAM_POINT){.Master = length * (i + (end ? 0 : uniform(-0.2, 0.2))) / (count - 1),
                                   .Slave = uniform(-1, 1), .Velocity = end ? 0 : uniform(-1, 1) / length,
                                   .Acceleration = end ? 0 : uniform(-4, 4) / (length * length)};
    }
    if (one_in(2))
        points[count - 1].Slave = points[0].Slave;
    return (MC_CAM_REF){.Points = points, .NumberOfPoints = (UINT)count, .Curve = curve};
}

/** The slave scaling with which the slave needs a third of its limits where the master needs all of its own. */
static double scaling_for(const ideal_cam_t *cam, double master_scaling, int slave, const random_master_t *master)
{
    const cm1e_motion_limits_t *most = &axes_axis(slave)->limits.maximum, *its = &master->most;
    const double k = 1.0 / fabs(master_scaling), v = its->velocity * k, a = its->acceleration * k, j = its->jerk * k;
    double slope, curvature, third;
    steepness(cam, &slope, &curvature, &third);
    if (cam->curve == mcCamLinear) /* twice the slope in a cycle */
        curvature = 2 * slope / (v * axes_axis(slave)->cycle_s), third = 0;
    const double needs_a = curvature * v * v + slope * a;
    const double needs_j = third * v * v * v + 3 * curvature * v * a + slope * j;
    const double least_a = fmin(most->acceleration, most->deceleration);
    const double by_jerk = cam->curve == mcCamLinear ? INFINITY : most->jerk / needs_j;
    return 0.3 * fmin(fmin(most->velocity / (slope * v), least_a / needs_a), by_jerk);
}

/** Lets the slave follow a random cam; what it is to be from InSync on. */
static placed_cam_t random_cam_in(int slave, int master_axis, const random_master_t *master, cm1e_command_id_t *id)
{
    MC_CAM_POINT points[IDEAL_POINTS];
    const bool periodic = !one_in(4);
    const MC_CAM_REF table = random_table(points, master->most.velocity * uniform(0.2, 3), periodic);
    MC_CAM_ID cam_id = 0;
    placed_cam_t cam = {.master = master_axis, .slave = slave, .master_scaling = uniform(0.5, 2) * (one_in(2) ? 1 : -1),
                        .master_offset = uniform(-1, 1) * master->most.velocity,
                        .master_zero = axes_axis(master_axis)->setpoint.position,
                        .slave_zero = axes_axis(slave)->setpoint.position};
    ideal_cam_init(&cam.table, &table, periodic);
    const double scaling = scaling_for(&cam.table, (double)cam.master_scaling, slave, master);
    cam.slave_scaling = scaling * (one_in(2) ? 1 : -1);
    cam.slave_offset = uniform(-0.2, 0.2) * scaling;
    AXES_MUST(cm1e_axis_cam_select(axes_axis(slave), &table, periodic, false, false, &cam_id) == CM1E_OK, "%s",
              axes_text(slave));
    const cm1e_axis_coupling_t coupling = {
        .master = {{.axis = axes_reference(master_axis)}}, .cam = cam_id, .start_mode = mcRampIn,
        .master_offset = (double)cam.master_offset, .slave_offset = (double)cam.slave_offset,
        .master_scaling = (double)cam.master_scaling, .slave_scaling = (double)cam.slave_scaling};
    const bool linear = table.Curve == mcCamLinear;
    axes_bench.witness[slave].strictness = linear ? AXES_STEEP : axes_bench.witness[slave].strictness;
    *id = axes_command(slave, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN, .coupling = &coupling});
    cam.entered = side_of(&cam);
    return cam;
}

/* ---- random axes ------------------------------------------------------------------------------------------------- */

static void random_axis(cm1e_axis_config_t *axis)
{
    axis->counts_per_unit = one_in(3) ? 50000 : uniform(50, 60000);
    axis->invert = one_in(2);
    if (one_in(2)) { /* a turn that is no whole number of counts */
        axis->counts_per_unit = 0;
        axis->units_per_revolution = axis->modulo_range = 360;
        axis->gear_numerator = 1 + (uint32_t)pick(20);
        axis->gear_denominator = 1 + (uint32_t)pick(7);
    }
    const double unit = (double)fabsl(counts_per_u(axis));
    axis->max_velocity = uniform(100000, 2000000) / unit;
    axis->max_acceleration = uniform(500000, 5000000) / unit;
    axis->max_deceleration = uniform(500000, 5000000) / unit;
    axis->max_jerk = uniform(1e7, 3e8) / unit;
}

static void random_order(void)
{
    for (int i = axes_bench.count - 1; i > 0; i--) {
        const int other = pick(i + 1), swapped = axes_bench.order[i];
        axes_bench.order[i] = axes_bench.order[other];
        axes_bench.order[other] = swapped;
    }
}

/** Some axes, in any order, each with its counter anywhere. */
static void random_axes(int count)
{
    axes_describe(count);
    axes_bench.cycle_ns = one_in(3) ? 250000 : 1000000;
    for (int n = 0; n < count; n++)
        random_axis(axes_config(n));
    random_order();
    axes_make();
    for (int n = 0; n < count; n++)
        axes_start_far(n, one_in(2) ? 0 : (int64_t)uniform(-100000, 100000)); /* 4e14 counts: 5 years at full speed */
    axes_enable_all();
}

/** A ratio of small numbers with which neither axis is much slower than the other. */
static void random_ratio(int slave, int master, int32_t *numerator, uint32_t *denominator)
{
    const double s = axes_axis(slave)->limits.maximum.velocity, m = axes_axis(master)->limits.maximum.velocity;
    do {
        *numerator = (1 + pick(one_in(4) ? 30000 : 30)) * (one_in(2) ? 1 : -1);
        *denominator = 1 + (uint32_t)pick(one_in(4) ? 60000 : 40);
    } while (fabs(*numerator * m / *denominator) < 0.02 * s || fabs(*numerator * m / *denominator) > 20 * s);
}

static cm1e_command_id_t gear_in(int slave, int master, int32_t numerator, uint32_t denominator, double part)
{
    const cm1e_motion_limits_t *most = &axes_axis(slave)->limits.maximum;
    const cm1e_axis_coupling_t coupling = {
        .master = {{.axis = axes_reference(master), .numerator = numerator, .denominator = denominator}}};
    return axes_command(slave, &(cm1e_axis_command_t){
                                   .kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling,
                                   .acceleration = part * most->acceleration, .deceleration = part * most->deceleration,
                                   .jerk = part * most->jerk});
}

/** Names for positions of axes that may change at any time without moving anything. */
static void rename_positions(int n)
{
    cm1e_axis_t *axis = axes_axis(n);
    const position_t set = axis->setpoint.position;
    const double range = axis->position.modulo_range > 0 ? axis->position.modulo_range : 1000;
    (void)cm1e_axis_set_position(axis, uniform(0, range), false);
    AXES_MUST(way(set, axis->setpoint.position) == 0.0L, "MC_SetPosition moved the set-point of axis %d", n);
}

/* ---- gears ------------------------------------------------------------------------------------------------------- */

/* The way into the gear, the gear, another ratio while it runs, and the way out: the witness sees every step. */
static void test_slave_of_a_gear_is_where_its_master_says_in_every_cycle(void)
{
    const int runs = seed_count(120);
    worst = 0;
    for (int run = 0; run < runs; run++) {
        char scene[40];
        chance_seed(seed_of(run));
        snprintf(scene, sizeof scene, "seed %u", seed_of(run));
        axes_bench.run = NULL;
        random_axes(2);
        axes_bench.run = scene;
        random_master_t before = random_master_for(0, 1, 1e-9, 0.5);
        for (int gear = 0; gear < 3; gear++) {
            int32_t numerator;
            uint32_t denominator;
            random_ratio(1, 0, &numerator, &denominator);
            const random_master_t master = random_master_for(0, 1, (double)numerator / denominator, 0.5);
            const random_master_t both = random_master_of_both(before, &master);
            random_master_command(&both);
            for (int n = pick(2000); n > 0 || fabs(axes_axis(0)->setpoint.velocity) > master.most.velocity; n--) {
                random_master_drive(&both);
                axes_cycles(1);
            }
            const cm1e_command_id_t id = gear_in(1, 0, numerator, denominator, 0.4);
            for (int n = 0; n < 30000 && !axes_status(1, id).reached; n++) {
                random_master_drive(&master);
                axes_cycles(1);
            }
            AXES_MUST(axes_status(1, id).reached, "%d / %u: never InGear, %s: %s", (int)numerator, denominator,
                      cm1e_axis_state_name(axes_state(1)), axes_text(1));
            const gear_t ideal = gear_from_now(1, 0, numerator, denominator);
            for (int n = 0; n < 4000; n++) {
                random_master_drive(&master);
                if (one_in(1000))
                    rename_positions(pick(2));
                axes_cycles(1);
                judge_gear(&ideal);
                AXES_MUST(axes_status(1, id).reached, "no longer InGear");
            }
            before = master;
            if (one_in(3)) {
                const double velocity = axes_axis(1)->setpoint.velocity;
                cm1e_command_id_t out = 0;
                const cm1e_axis_command_t gear_out = {.kind = CM1E_COMMAND_GEAR_OUT};
                AXES_MUST(cm1e_axis_start(axes_axis(1), &gear_out, &out) == CM1E_OK, "MC_GearOut is refused");
                axes_cycles(1500);
                AXES_MUST(velocity == 0 || axes_state(1) == CM1E_AXIS_CONTINUOUS_MOTION, "%s after MC_GearOut",
                          cm1e_axis_state_name(axes_state(1)));
                AXES_MUST(fabs(axes_axis(1)->setpoint.velocity - velocity) <= 1e-9 * fabs(velocity),
                          "MC_GearOut at %.12g u/s, it goes on with %.12g", velocity, axes_axis(1)->setpoint.velocity);
            }
        }
    }
    printf("gears: %d runs, worst error %Lg counts\n", runs, worst);
}

/* A slave that is another's master: no cycle is lost on the way, whatever the order of the axes. */
static void test_chain_of_gears_keeps_the_product_of_its_ratios(void)
{
    const int runs = seed_count(60);
    worst = 0;
    for (int run = 0; run < runs; run++) {
        chance_seed(seed_of(run));
        axes_bench.run = NULL;
        random_axes(4);
        int32_t n[3] = {2 + pick(5), -(1 + pick(4)), 1 + pick(3)};
        uint32_t d[3] = {1 + (uint32_t)pick(5), 2 + (uint32_t)pick(3), 1 + (uint32_t)pick(3)};
        double ratio = 1.0;
        random_master_t master = random_master_for(0, 1, 1e-9, 0.8);
        for (int i = 0; i < 3; i++) { /* the slowest of them rules */
            ratio *= (double)n[i] / d[i];
            const random_master_t one = random_master_for(0, i + 1, ratio, 0.8);
            master = random_master_of_both(master, &one);
        }
        cm1e_command_id_t ids[3];
        for (int i = 0; i < 3; i++)
            ids[i] = gear_in(i + 1, i, n[i], d[i], 0.5);
        axes_cycles(3);
        gear_t ideal[3];
        for (int i = 0; i < 3; i++) {
            AXES_MUST(axes_status(i + 1, ids[i]).reached, "at rest, and not InGear: %s", axes_text(i + 1));
            ideal[i] = gear_from_now(i + 1, 0, 1, 1);
            ideal[i].ratio = (i > 0 ? ideal[i - 1].ratio : 1.0L) * gear_from_now(i + 1, i, n[i], d[i]).ratio;
        }
        for (int cycle = 0; cycle < 5000; cycle++) {
            random_master_drive(&master);
            axes_cycles(1);
            for (int i = 0; i < 3; i++)
                judge_gear(&ideal[i]);
        }
    }
    printf("chains: %d runs, worst error %Lg counts\n", runs, worst);
}

/* Into a cam, along it, into another one while it runs, and out: the witness sees every step. */
static void test_slave_of_a_cam_is_where_its_table_says_in_every_cycle(void)
{
    const int runs = seed_count(120);
    worst = 0;
    for (int run = 0; run < runs; run++) {
        char scene[40];
        chance_seed(seed_of(run));
        snprintf(scene, sizeof scene, "seed %u", seed_of(run));
        axes_bench.run = NULL;
        random_axes(2);
        axes_bench.run = scene;
        random_master_t master = random_master_for(0, 1, 1e-9, 0.5);
        master.most.velocity *= 0.3; /* a cam needs time */
        random_master_command(&master);
        for (int cams = 0; cams < 3; cams++) {
            cm1e_command_id_t id;
            placed_cam_t cam = random_cam_in(1, 0, &master, &id);
            for (int n = 0; n < 20000 && !axes_status(1, id).reached; n++) {
                random_master_drive(&master);
                axes_cycles(1);
                go_through(&cam);
            }
            AXES_MUST(axes_status(1, id).reached, "never InSync, %s: %s", cm1e_axis_state_name(axes_state(1)),
                      axes_text(1));
            for (int n = 0; n < 4000; n++) {
                random_master_drive(&master);
                if (one_in(1000))
                    rename_positions(pick(2));
                axes_cycles(1);
                go_through(&cam);
                judge_cam(&cam);
            }
            if (one_in(3)) {
                const double velocity = axes_axis(1)->setpoint.velocity;
                cm1e_command_id_t out = 0;
                const cm1e_axis_command_t cam_out = {.kind = CM1E_COMMAND_CAM_OUT};
                AXES_MUST(cm1e_axis_start(axes_axis(1), &cam_out, &out) == CM1E_OK, "MC_CamOut is refused");
                axes_cycles(1500);
                AXES_MUST(fabs(axes_axis(1)->setpoint.velocity - velocity) <= 1e-9 * fabs(velocity),
                          "MC_CamOut at %.12g u/s, it goes on with %.12g", velocity, axes_axis(1)->setpoint.velocity);
            }
        }
    }
    printf("cams: %d runs, worst error %Lg counts\n", runs, worst);
}

/* In real cycles, 50 revolutions a second: a rotary master behind a gear whose turn is no whole number of counts, and a
 * rotary slave with another such turn. */
static void test_million_revolutions_of_the_master_leave_no_drift(void)
{
    const long long revolutions = 1000000 / slowness();
    worst = 0;
    chance_seed(1);
    axes_describe(2);
    for (int n = 0; n < 2; n++) {
        axes_config(n)->units_per_revolution = axes_config(n)->modulo_range = 360;
        axes_config(n)->gear_numerator = n ? 7 : 1;
        axes_config(n)->gear_denominator = n ? 11 : 3;
    }
    axes_config(1)->invert = true;
    axes_make();
    axes_enable_all();
    const cm1e_command_id_t id = gear_in(1, 0, 17, 101, 0.5);
    axes_cycles(2);
    TEST_ASSERT_TRUE(axes_status(1, id).reached);
    const gear_t ideal = gear_from_now(1, 0, 17, 101);
    random_master_t master = random_master_for(0, 1, 17.0 / 101, 0.9);
    long double turned = 0;
    position_t last = axes_axis(0)->setpoint.position;
    for (long long cycle = 0; turned < 50000.0L * (long double)revolutions; cycle++) {
        if (cycle % 100000 == 50000) { /* now and then it turns round for a while */
            random_master_command(&master);
        } else if (cycle % 100000 == 51000 || cycle == 0) {
            (void)axes_move_velocity(0, axes_axis(0)->limits.maximum.velocity);
        }
        axes_cycles(1);
        turned += fabsl(way(last, axes_axis(0)->setpoint.position));
        last = axes_axis(0)->setpoint.position;
        judge_gear(&ideal);
        const double modulo = axes_info(1).set_position;
        AXES_MUST(modulo >= 0 && modulo < 360, "the slave is at %.17g", modulo);
    }
    printf("%lld revolutions, worst error %Lg counts\n", revolutions, worst);
}

int main(void)
{
    axes_compared_every = 23; /* most of the time went there */
    UNITY_BEGIN();
    RUN_TEST(test_slave_of_a_gear_is_where_its_master_says_in_every_cycle);
    RUN_TEST(test_chain_of_gears_keeps_the_product_of_its_ratios);
    RUN_TEST(test_slave_of_a_cam_is_where_its_table_says_in_every_cycle);
    RUN_TEST(test_million_revolutions_of_the_master_leave_no_drift);
    return UNITY_END();
}
