/* Cams: slaves that follow them, against the ideal function at every sample. */
#include "unity.h"

#include "../support/axes_cam.h"
#include "motion_check.h"

void setUp(void) {}
void tearDown(void) { axes_end(); }

/* 4.1: run only once; the slave stays at the end, also when the master comes back. */
static bool gone_through;
static double hill_once(double x)
{
    gone_through = gone_through || x >= 10;
    return gone_through ? 1 : x <= 0 ? 0 : hill(x, 0.6, 1);
}

static void test_at_every_sample_the_slave_is_on_the_cam(void)
{
    static const struct { double end; bool periodic; double (*ideal)(double); } cases[] = {
        {0, true, hill_back}, {1, true, hill_on}, {1, false, hill_once}};
    for (int i = 0; i < 3; i++)
        for (int slave_first = 0; slave_first < 2; slave_first++) {
            gone_through = false;
            axes_begin(2);
            axes_bench.order[0] = slave_first ? SLAVE : MASTER;
            axes_bench.order[1] = slave_first ? MASTER : SLAVE;
            const cm1e_axis_coupling_t coupling =
                by_cam(select_hill(0.6, cases[i].end, cases[i].periodic, true, true), mcAbsolute);
            const cm1e_command_id_t id = cam_in(&coupling);
            axes_cycles(1);
            TEST_ASSERT_TRUE(axes_status(SLAVE, id).reached);
            master_wanders(8000, cases[i].ideal);
            TEST_ASSERT_TRUE(axes_status(SLAVE, id).reached);
        }
}

/* (M - offset) / scaling, then offset + scaling * cam. */
static double scaled(double x) { return 0.25 - 0.5 * hill((x - 2) / 3, 0.6, 1); }

static void test_offsets_and_scalings(void)
{
    axes_begin(2);
    cm1e_axis_coupling_t coupling = by_cam(select_hill(0.6, 1, true, true, true), mcRampIn);
    coupling.master_offset = 2;
    coupling.master_scaling = 3;
    coupling.slave_offset = 0.25;
    coupling.slave_scaling = -0.5;
    axes_wait_reached(SLAVE, cam_in(&coupling), 2000);
    master_wanders(8000, scaled);
}

/* What MC_CamTableSelect says is relative counts from where it is: of the master the cam's 0, of the slave so that it is
 * on the cam. mcRelative is relative for the slave whatever was selected. */
static void test_relative_to_where_they_are(void)
{
    for (int i = 0; i < 8; i++) {
        const bool master_absolute = i & 1, slave_absolute = i & 2, relative = (i & 4) || !slave_absolute;
        axes_begin(2);
        axes_wait(MASTER, axes_move_to(MASTER, 3, 10), 5000);
        axes_wait(SLAVE, axes_move_to(SLAVE, relative ? -7 : hill(master_absolute ? 3 : 0, 0.6, 1), 10), 5000);
        const cm1e_axis_coupling_t coupling = by_cam(select_hill(0.6, 1, true, master_absolute, slave_absolute),
                                                     i & 4 ? mcRelative : mcAbsolute);
        (void)cam_in(&coupling);
        axes_move_velocity(MASTER, -4);
        for (int n = 0; n < 6000; n++) {
            axes_cycles(1);
            if (n == 3000)
                axes_move_velocity(MASTER, 6);
            const double x = master_absolute ? set_of(MASTER) : set_of(MASTER) - 3, begin = master_absolute ? 3 : 0;
            const double ideal = hill(x, 0.6, 1) + (relative ? -7 - hill(begin, 0.6, 1) : 0);
            TEST_ASSERT_DOUBLE_WITHIN(2e-8, ideal, set_of(SLAVE));
        }
    }
}

static void test_where_the_slave_is_not_on_the_cam_it_is_refused(void)
{
    axes_begin(2);
    const MC_CAM_ID id = select_hill(1.5, 0, true, true, true);
    cm1e_axis_coupling_t coupling = by_cam(id, mcAbsolute);
    axes_wait(SLAVE, axes_move_to(SLAVE, 0.01, 10), 5000);
    cam_refused(&coupling, CM1E_ERROR_AXIS_CAM_START);
    axes_told(SLAVE, "is at 0.01 u with 0 u/s, but the cam is at 0 u");
    axes_must_be(SLAVE, CM1E_AXIS_STANDSTILL);
    axes_wait(SLAVE, axes_move_to(SLAVE, 0, 10), 5000);
    axes_move_velocity(MASTER, 4);
    axes_cycles(600); /* the cam goes on, the slave stands */
    cam_refused(&coupling, CM1E_ERROR_AXIS_CAM_START);
    coupling.start_mode = mcRelative;
    cam_refused(&coupling, CM1E_ERROR_AXIS_CAM_START);
    coupling.start_mode = mcRampIn;
    axes_wait_reached(SLAVE, cam_in(&coupling), 5000);
}

static void test_within_ten_counts_the_slave_is_on_the_cam(void)
{
    static const double counts[] = {-9.9, 10, 10.1};
    for (int i = 0; i < 3; i++) {
        axes_begin(2);
        const cm1e_axis_coupling_t coupling = by_cam(select_hill(1.5, 0, true, true, true), mcAbsolute);
        axes_wait(SLAVE, axes_move_to(SLAVE, counts[i] / 50000, 10), 5000);
        if (i == 2)
            cam_refused(&coupling, CM1E_ERROR_AXIS_CAM_START);
        else
            (void)cam_in(&coupling);
        axes_end();
    }
}

/* The bench watches every set-point: velocity, acceleration and jerk within the slave's limits, each the derivative of
 * the next. From any place, at any phase, and also from a motion. */
static void test_ramp_in_has_no_step(void)
{
    for (int phase = 0; phase < 2500; phase += 311)
        for (int moving = 0; moving < 3; moving++) {
            axes_begin(2);
            axes_move_velocity(MASTER, 4);
            if (moving)
                axes_move_velocity(SLAVE, moving == 1 ? 6 : -6);
            axes_cycles(300 + phase);
            cm1e_axis_coupling_t coupling = by_cam(select_hill(0.6, 1, true, false, true), mcRampIn);
            const double begin = set_of(MASTER);
            coupling.slave_offset = 0.3;
            const cm1e_command_id_t id = cam_in(&coupling);
            axes_cycles(1);
            TEST_ASSERT_FALSE(axes_status(SLAVE, id).reached);
            axes_told(SLAVE, "is not in step: it makes up ");
            axes_wait_reached(SLAVE, id, 20000);
            TEST_ASSERT_EQUAL_STRING("", axes_text(SLAVE));
            for (int n = 0; n < 3000; n++) {
                if (n == 1000)
                    axes_move_velocity(MASTER, -3);
                axes_cycles(1);
                TEST_ASSERT_DOUBLE_WITHIN(2e-8, 0.3 + hill(set_of(MASTER) - begin, 0.6, 1), set_of(SLAVE));
            }
        }
}

/* Any cam that the slave can follow at this velocity: from anywhere, at any moment, it gets onto it. */
static void test_random_cams_are_got_onto(void)
{
    for (int n = 0; n < 200; n++) {
        axes_begin(2);
        const double velocity = random_between(-10, 10), height = random_between(-0.6, 0.6), end = random_between(-1, 1);
        axes_move_velocity(MASTER, velocity);
        if (!one_in(3))
            axes_move_velocity(SLAVE, random_between(-15, 15));
        axes_cycles((int)random_between(1, 2500));
        cm1e_axis_coupling_t coupling = by_cam(select_hill(height, end, true, one_in(2), one_in(2)), mcRampIn);
        coupling.slave_offset = random_between(-20, 20);
        const cm1e_command_id_t id = cam_in(&coupling);
        axes_wait_reached(SLAVE, id, 40000);
        axes_cycles(500);
        axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
    }
}

static void test_a_cam_is_changed_for_another_while_it_runs(void)
{
    axes_begin(2);
    const cm1e_axis_coupling_t first = by_cam(select_hill(0.6, 1, true, true, true), mcAbsolute);
    cm1e_command_id_t before = cam_in(&first);
    axes_move_velocity(MASTER, 5);
    for (int i = 0; i < 40; i++) {
        axes_cycles(137);
        const double height = 0.1 * (i % 7), end = 0.5 * (i % 3);
        const cm1e_axis_coupling_t next = by_cam(select_hill(height, end, true, true, true), mcRampIn);
        const cm1e_command_id_t id = cam_in(&next);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, axes_status(SLAVE, before).state);
        before = id;
        axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
        if (i % 4)
            continue; /* the next one comes on the way */
        axes_wait_reached(SLAVE, id, 20000);
        for (int n = 0; n < 500; n++) {
            axes_cycles(1);
            TEST_ASSERT_DOUBLE_WITHIN(2e-8, hill(set_of(MASTER), height, end), set_of(SLAVE));
        }
    }
}

/* A cam that passes the present state needs no approach. */
static void test_a_cam_that_goes_on_where_the_other_is_needs_no_ramp(void)
{
    axes_begin(2);
    const cm1e_axis_coupling_t first = by_cam(select_hill(0.6, 1, true, true, true), mcAbsolute);
    (void)cam_in(&first);
    axes_move_velocity(MASTER, 5);
    axes_cycles(777);
    const cm1e_axis_coupling_t same = by_cam(select_hill(0.6, 1, true, true, true), mcAbsolute);
    const cm1e_command_id_t id = cam_in(&same);
    axes_cycles(1);
    TEST_ASSERT_TRUE(axes_status(SLAVE, id).reached);
    master_wanders(4000, hill_on);
}

/* 4.3: at every end of a period, and in reverse at every beginning. */
static void test_end_of_profile_of_a_periodic_cam(void)
{
    axes_begin(2);
    const cm1e_axis_coupling_t coupling = by_cam(select_hill(0.6, 1, true, true, true), mcAbsolute);
    const cm1e_command_id_t id = cam_in(&coupling);
    static const double stops[] = {25, 3, 10, 9, 30, 30.5, 30, -1, 0, -20};
    for (int i = 0; i < 10; i++) {
        const cm1e_command_id_t move = axes_move_to(MASTER, stops[i], 8);
        while (axes_status(MASTER, move).state == CM1E_COMMAND_ACTIVE) {
            const double before = set_of(MASTER) / 10;
            const uint32_t ends = axes_status(SLAVE, id).ends;
            axes_cycles(1);
            const double now = set_of(MASTER) / 10;
            const bool over = now > before ? floor(now) > floor(before) : ceil(now) < ceil(before);
            TEST_ASSERT_EQUAL(over, axes_status(SLAVE, id).ends - ends);
        }
    }
}

typedef struct single_move {
    double stop;  /* of the master */
    int ends;     /* that were shown on the way */
    double slave; /* at its end */
} single_move_t;

/* From where master and slave are. */
static void go_over_single_shot(double master, double slave, const single_move_t *moves, int count)
{
    axes_begin(2);
    axes_wait(MASTER, axes_move_to(MASTER, master, 8), 10000);
    axes_wait(SLAVE, axes_move_to(SLAVE, slave, 8), 10000);
    const cm1e_axis_coupling_t coupling = by_cam(select_hill(0.6, 1, false, true, true), mcAbsolute);
    const cm1e_command_id_t id = cam_in(&coupling);
    for (int i = 0; i < count; i++) {
        const uint32_t ends = axes_status(SLAVE, id).ends;
        const cm1e_command_id_t move = axes_move_to(MASTER, moves[i].stop, 8);
        while (axes_status(MASTER, move).state == CM1E_COMMAND_ACTIVE)
            axes_cycles(1);
        TEST_ASSERT_EQUAL_INT(moves[i].ends, axes_status(SLAVE, id).ends - ends);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, moves[i].slave, set_of(SLAVE));
        TEST_ASSERT_TRUE(axes_status(SLAVE, id).reached);
        axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
    }
}

/* 4.1, 4.3: run only once, in either direction. Back over the end by which it came, a master has not run it. */
static void test_end_of_profile_of_a_single_shot(void)
{
    static const single_move_t up[] = {{-5, 0, 0}, {5, 0, 0.6}, {-3, 1, 0}, {5, 0, 0.6}, {15, 1, 1},
                                       {30, 0, 1}, {8, 0, 1},   {-3, 0, 1}, {20, 0, 1}};
    static const single_move_t down[] = {{15, 0, 1}, {5, 0, 0.6}, {11, 1, 1}, {-3, 1, 0}, {5, 0, 0}, {15, 0, 0}};
    static const single_move_t from_within[] = {{7, 0, NAN}, {-1, 1, 0}, {5, 0, 0}, {15, 0, 0}};
    single_move_t within[4];
    memcpy(within, from_within, sizeof within);
    within[0].slave = hill(7, 0.6, 1);
    go_over_single_shot(0, 0, up, 9);
    go_over_single_shot(10, 1, down, 6);
    go_over_single_shot(5, 0.6, within, 4);
}

/* Table 4: a command behind a cam begins at EndOfProfile. A relative one counts from that very end, which lay inside a
 * cycle. */
static void test_what_waits_begins_at_the_end_of_the_profile(void)
{
    for (int periodic = 0; periodic < 2; periodic++) {
        axes_begin(2);
        const cm1e_axis_coupling_t coupling = by_cam(select_hill(0.6, 1, periodic, true, true), mcAbsolute);
        const cm1e_axis_coupling_t next = by_cam(select_hill(1, 2, true, false, false), mcRelative);
        const cm1e_command_id_t id = cam_in(&coupling);
        const cm1e_axis_command_t behind = {.kind = CM1E_COMMAND_CAM_IN, .coupling = &next, .buffer_mode = mcBuffered};
        const cm1e_command_id_t waits = axes_command(SLAVE, &behind);
        axes_move_velocity(MASTER, 5);
        while (axes_status(SLAVE, waits).state == CM1E_COMMAND_BUFFERED) {
            TEST_ASSERT_TRUE(set_of(MASTER) < 10);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, axes_status(SLAVE, id).state);
            axes_cycles(1);
        }
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, axes_status(SLAVE, id).state);
        axes_wait_reached(SLAVE, waits, 10);
        TEST_ASSERT_DOUBLE_WITHIN(0.03, 10, set_of(MASTER));
        axes_cycles(4000);
        TEST_ASSERT_DOUBLE_WITHIN(2e-8, 1 + hill(set_of(MASTER) - 10, 1, 2), set_of(SLAVE));
    }
}

static void test_out_of_a_cam_the_velocity_stays(void)
{
    axes_begin(2);
    const cm1e_axis_coupling_t coupling = by_cam(select_hill(0.6, 1, true, true, true), mcAbsolute);
    const cm1e_command_id_t id = cam_in(&coupling);
    axes_move_velocity(MASTER, 5);
    axes_cycles(800);
    const double velocity = axes_info(SLAVE).set_velocity;
    TEST_ASSERT_TRUE(fabs(velocity) > 0.1);
    axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_OUT});
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, axes_status(SLAVE, id).state);
    axes_must_be(SLAVE, CM1E_AXIS_CONTINUOUS_MOTION);
    axes_cycles(500);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, velocity, axes_info(SLAVE).set_velocity);
}

/* The master moves already. The slave does not take its velocity first and its place afterwards. */
static void test_ramp_in_leads_to_place_and_velocity_at_once(void)
{
    axes_begin(2);
    axes_move_velocity(MASTER, 4);
    axes_cycles(1000);
    points[0] = (MC_CAM_POINT){0, 0, 0, 0};
    points[1] = (MC_CAM_POINT){100, 100, 0, 0};
    const MC_CAM_REF table = {points, 2, mcCamLinear};
    const cm1e_axis_coupling_t coupling = by_cam(selected(SLAVE, &table, false, true), mcRampIn);
    const cm1e_command_id_t id = cam_in(&coupling);
    for (int i = 0; i < 2000 && axes_info(SLAVE).set_velocity < 4; i++)
        axes_cycles(1);
    TEST_ASSERT_TRUE(axes_axis(SLAVE)->setpoint.acceleration > 1); /* it is behind, and gets faster still */
    axes_wait_reached(SLAVE, id, 2000);
    TEST_ASSERT_EQUAL_DOUBLE(4, axes_info(SLAVE).set_velocity);
}

static void turn_at(double velocity)
{
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = velocity,
                                                .acceleration = 5000, .jerk = 100000});
}

/* Both turn for ever, from far away, in units that no double holds; a period is not a turn of either. */
static void test_modulo_axes_over_many_turns(void)
{
    axes_describe(2);
    for (int n = 0; n < 2; n++) {
        axes_config(n)->units_per_revolution = 360;
        axes_config(n)->modulo_range = n == MASTER ? 360 : 100;
        axes_config(n)->invert = n == SLAVE;
    }
    axes_make();
    axes_start_far(MASTER, 1000);
    axes_start_far(SLAVE, -3000);
    axes_enable_all();
    points[0] = (MC_CAM_POINT){0, 0, 0, 0};
    points[1] = (MC_CAM_POINT){250, 3, 0, 0};
    points[2] = (MC_CAM_POINT){1000.0 / 3, 1, 0, 0};
    const MC_CAM_REF table = {points, 3, mcCamPolynomial5};
    const cm1e_axis_coupling_t coupling = by_cam(selected(SLAVE, &table, true, true), mcRampIn);
    const double first = set_of(MASTER);
    axes_wait_reached(SLAVE, cam_in(&coupling), 5000);
    turn_at(1200);
    long double way = 0;
    double before = set_of(MASTER);
    for (int i = 0; i < 400000; i++) {
        if (i == 350000)
            turn_at(-1200);
        axes_cycles(1);
        const double now = set_of(MASTER);
        way += remainder(now - before, 360);
        before = now;
        const long double x = first + way, period = 1000.0L / 3, turn = floorl(x / period), phase = x - turn * period;
        const double rise = phase < 250 ? 3 * smooth_step((double)phase / 250)
                                        : 3 - 2 * smooth_step((double)(phase - 250) / (1000.0 / 3 - 250));
        const double ideal = (double)fmodl(turn + rise + 100000, 100);
        TEST_ASSERT_DOUBLE_WITHIN(0.5 * 360 / 50000, 0, remainder(set_of(SLAVE) - ideal, 100));
    }
    TEST_ASSERT_TRUE(fabs((double)way) > 800 * 360);
}

static cm1e_error_t updated(cm1e_command_id_t id, const cm1e_axis_coupling_t *coupling)
{
    return cm1e_axis_update(axes_axis(SLAVE), id, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN,
                                                                         .coupling = coupling});
}

/* ContinuousUpdate: other offsets and scalings, without a step (the bench watches), and as if they had been there from
 * the beginning. */
static void test_offsets_and_scalings_change_while_it_runs(void)
{
    axes_begin(2);
    axes_wait(MASTER, axes_move_to(MASTER, 3, 10), 5000);
    axes_wait(SLAVE, axes_move_to(SLAVE, -2, 10), 5000);
    cm1e_axis_coupling_t coupling = by_cam(select_hill(0.6, 1, true, false, false), mcRelative);
    const cm1e_command_id_t id = cam_in(&coupling);
    axes_move_velocity(MASTER, 4);
    for (int i = 0; i < 60; i++) {
        coupling.master_offset = i % 5 * 0.7;
        coupling.slave_offset = i % 3 * 0.2;
        coupling.master_scaling = i % 4 ? 0 : 1.5;
        coupling.slave_scaling = i % 7 ? 1 : -0.5;
        TEST_ASSERT_EQUAL_INT(CM1E_OK, updated(id, &coupling));
        TEST_ASSERT_FALSE(axes_status(SLAVE, id).reached); /* from now on, not from the next set-point on */
        axes_cycles(1);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, axes_status(SLAVE, id).state);
        axes_cycles(i % 6 ? 97 : 1000);
        if (i % 6)
            continue; /* the next ones come on the way */
        axes_wait_reached(SLAVE, id, 5000);
        for (int n = 0; n < 100; n++) {
            TEST_ASSERT_EQUAL_INT(CM1E_OK, updated(id, &coupling)); /* the same again changes nothing */
            axes_cycles(1);
            const double x = (set_of(MASTER) - 3 - coupling.master_offset) / (i % 4 ? 1 : 1.5);
            const double ideal = -2 + coupling.slave_offset + coupling.slave_scaling * hill(x, 0.6, 1);
            TEST_ASSERT_DOUBLE_WITHIN(2e-8, ideal, set_of(SLAVE));
            TEST_ASSERT_TRUE(axes_status(SLAVE, id).reached);
        }
    }
    axes_wait_reached(SLAVE, id, 5000);
    cm1e_axis_coupling_t bad = coupling;
    bad.slave_offset = NAN;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, updated(id, &bad));
    bad = coupling;
    bad.master_scaling = INFINITY;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_RATIO, updated(id, &bad));
    axes_cycles(10);
    TEST_ASSERT_TRUE(axes_status(SLAVE, id).reached);
}

/* The phase shift goes through the cam: the slave sees the master where it is, and the shift more. */
static void test_a_phase_shift_acts_through_the_cam(void)
{
    axes_begin(2);
    const cm1e_axis_coupling_t coupling = by_cam(select_hill(0.6, 1, true, true, true), mcAbsolute);
    (void)cam_in(&coupling);
    axes_move_velocity(MASTER, 2);
    axes_cycles(500);
    axes_wait(SLAVE, axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_PHASING_ABSOLUTE, .position = 3,
                                                                .velocity = 1, .coupling = &coupling}), 0);
    axes_cycles(8000);
    for (int n = 0; n < 3000; n++) {
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(2e-8, hill(set_of(MASTER) + 3, 0.6, 1), set_of(SLAVE));
    }
    /* and into another one */
    const cm1e_axis_coupling_t same = by_cam(select_hill(0.6, 1, true, true, true), mcAbsolute);
    const cm1e_command_id_t id = cam_in(&same);
    axes_cycles(1);
    TEST_ASSERT_TRUE(axes_status(SLAVE, id).reached);
    TEST_ASSERT_DOUBLE_WITHIN(2e-8, hill(set_of(MASTER) + 3, 0.6, 1), set_of(SLAVE));
}

int main(void)
{
    UNITY_BEGIN();
    seed_random();
    RUN_TEST(test_at_every_sample_the_slave_is_on_the_cam);
    RUN_TEST(test_offsets_and_scalings);
    RUN_TEST(test_relative_to_where_they_are);
    RUN_TEST(test_where_the_slave_is_not_on_the_cam_it_is_refused);
    RUN_TEST(test_within_ten_counts_the_slave_is_on_the_cam);
    RUN_TEST(test_ramp_in_has_no_step);
    RUN_TEST(test_random_cams_are_got_onto);
    RUN_TEST(test_a_cam_is_changed_for_another_while_it_runs);
    RUN_TEST(test_a_cam_that_goes_on_where_the_other_is_needs_no_ramp);
    RUN_TEST(test_end_of_profile_of_a_periodic_cam);
    RUN_TEST(test_end_of_profile_of_a_single_shot);
    RUN_TEST(test_what_waits_begins_at_the_end_of_the_profile);
    RUN_TEST(test_out_of_a_cam_the_velocity_stays);
    RUN_TEST(test_ramp_in_leads_to_place_and_velocity_at_once);
    RUN_TEST(test_modulo_axes_over_many_turns);
    RUN_TEST(test_offsets_and_scalings_change_while_it_runs);
    RUN_TEST(test_a_phase_shift_acts_through_the_cam);
    return UNITY_END();
}
