/* The same group and the same program in other units of length, and inverted: the same counts in every cycle. A
 * constant that has a unit, and is not of counts, shows at once, and so does what is right in one direction only. */
#include "../support/chance.h"
#include "../support/group_bench.h"
#include "../support/units_log.h"
#include "unity.h"

enum { AXES = 3, CYCLES = 3000, PROGRAMS = 120, IDS = 8 };

static bool mirrors; /* without what is not the same both ways */
static cm1e_command_id_t ids[IDS];
static double place[AXES]; /* base units: where the last segment ends */
static unsigned long long taken, refused, moved;

void setUp(void) {}
void tearDown(void) { group_end(); }

static void make_machine(void)
{
    group_end();
    axes_describe(AXES);
    units_describe();
    for (int n = 0; n < AXES; n++) {
        cm1e_axis_config_t *c = axes_config(n);
        const double velocity = decade(2, 50), acceleration = decade(10, 100), jerk = decade(100, 2000);
        if (one_in(2))
            c->max_velocity = size(velocity), c->max_acceleration = size(acceleration), c->max_jerk = size(jerk);
        if (one_in(3))
            c->max_deceleration = size(acceleration * uniform(0.5, 1));
        if (one_in(5) && !mirrors)
            c->backlash = size(decade(0.001, 0.2));
        c->in_position_done_waits = one_in(3);
        c->invert = one_in(3) != mirrored();
        const double one = in(uniform(2, 20)), other = in(-uniform(2, 20));
        if (one_in(3))
            c->software_limit_positive = fmax(one, other), c->software_limit_negative = fmin(one, other);
        axes_bench.witness[n].strictness = AXES_UNWATCHED;
        place[n] = 0;
    }
    axes_make();
    axes_enable_all();
    group_form();
    AXES_MUST(cm1e_group_enable(group) == CM1E_OK, "%s", group_text());
}

static cm1e_group_kind_t any_kind(void)
{
    static const cm1e_group_kind_t kinds[] = {
        CM1E_GROUP_LINEAR_ABSOLUTE, CM1E_GROUP_LINEAR_ABSOLUTE, CM1E_GROUP_LINEAR_ABSOLUTE, CM1E_GROUP_LINEAR_RELATIVE,
        CM1E_GROUP_CIRCULAR_ABSOLUTE, CM1E_GROUP_CIRCULAR_ABSOLUTE, CM1E_GROUP_CIRCULAR_RELATIVE};
    return one_in(12) ? CM1E_GROUP_HALT : one_in(20) ? CM1E_GROUP_STOP : one_in(12) ? CM1E_GROUP_INTERRUPT
                                                                                   : kinds[pick(7)];
}

static cm1e_group_command_t any_command(void)
{
    static const MC_TRANSITION_MODE transitions[] = {mcTMNone, mcTMCornerDistance, mcTMMaxCornerDeviation};
    const double velocity = decade(0.2, 20), acceleration = decade(5, 100), jerk = decade(50, 2000);
    cm1e_group_command_t command = {
        .kind = any_kind(), .circ_mode = (MC_CIRC_MODE)pick(2), .path_choice = (MC_CIRC_PATHCHOICE)pick(2),
        .velocity = size(velocity), .acceleration = or_default(acceleration),
        .deceleration = or_default(acceleration * uniform(0.5, 2)), .jerk = or_default(jerk),
        .buffer_mode = one_in(6) ? mcAborting : (MC_BUFFER_MODE)(1 + pick(5)), .transition = transitions[pick(3)],
        .transition_parameter = size(decade(0.01, 0.5)),
    };
    const bool relative = command.kind == CM1E_GROUP_LINEAR_RELATIVE || command.kind == CM1E_GROUP_CIRCULAR_RELATIVE;
    const double most = decade(0.02, 2);
    const double from[] = {relative ? 0 : place[0], relative ? 0 : place[1], relative ? 0 : place[2]};
    for (int n = 0; n < AXES; n++) {
        const double way = n == 2 && one_in(2) ? 0 : uniform(-most, most);
        command.position[n] = in(from[n] + way);
        command.auxiliary[n] = in(from[n] + way / 2 + (command.circ_mode == mcBorder ? uniform(-most, most) / 3 : 0));
        if (command.kind <= CM1E_GROUP_CIRCULAR_RELATIVE)
            place[n] += way;
        if (fabs(place[n]) > 2)
            place[n] = 0;
    }
    return command;
}

static void start_any(void)
{
    const cm1e_group_command_t command = any_command();
    cm1e_command_id_t id;
    const cm1e_error_t error = cm1e_group_start(group, &command, &id);
    units_note(error);
    taken += error == CM1E_OK;
    refused += error != CM1E_OK;
    if (id)
        ids[id % IDS] = id;
}

static void program(void)
{
    if (one_in(40))
        start_any();
    if (one_in(300))
        units_note(cm1e_group_set_override(group, one_in(4) ? 0 : one_in(2) ? 1 : uniform(0.05, 1)));
    if (one_in(60))
        units_note(cm1e_group_continue(group));
    if (group_info().state == CM1E_GROUP_ERROR_STOP && one_in(50))
        units_note(cm1e_group_reset(group));
    if (one_in(100))
        units_note(cm1e_axis_set_override(axes_axis(pick(AXES)), one_in(2) ? 1 : uniform(0.1, 1), 1, 1));
    cm1e_group_hold_stop(group, ids[pick(IDS)], false);
}

/** Before a cycle: what the motors and the bus do to the program. */
static void world(void)
{
    for (int n = 0; n < AXES; n++) {
        cm1e_bus_t *motor = axes_motor(n);
        if (one_in(3000))
            fake_bus_fault(motor, 0x8611);
        motor->blocked = motor->blocked ? !one_in(10) : one_in(1500);
    }
    if (axes_bench.received == CM1E_OK ? one_in(400) : one_in(3))
        axes_bench.received = axes_bench.received == CM1E_OK ? CM1E_ERROR_BUS_LOST : CM1E_OK;
}

static void one_cycle(void)
{
    world();
    axes_inputs();
    program();
    if (one_in(1000)) {
        const int64_t pause_ns = (2 + pick(60)) * axes_bench.cycle_ns;
        for (int n = 0; n < AXES; n++)
            cm1e_axis_after_pause(axes_axis(n), pause_ns);
    }
    axes_outputs();
    double sum = 0;
    for (int i = 0; i < IDS; i++) {
        const cm1e_command_status_t status = cm1e_group_command_status(group, ids[i]);
        sum = sum * 17 + status.state + 6 * status.reached;
    }
    const cm1e_group_info_t info = group_info();
    double position[CM1E_GROUP_AXES], velocity[CM1E_GROUP_AXES], path = 0;
    (void)cm1e_group_values(group, mcSetValue, position, velocity, &path);
    moved += path != 0;
    units_note(sum);
    units_note(info.state);
    units_note(path / fabs(in_units));
    units_cycle();
}

static void begin(void)
{
    memset(ids, 0, sizeof ids);
    make_machine();
}

static const units_program_t random_program = {begin, one_cycle, CYCLES};

static void test_no_group_depends_on_the_unit_of_length(void)
{
    for (int i = 0; i < seed_count(PROGRAMS); i++)
        units_compare(&random_program, (int)seed_of(i), false);
    printf("%llu commands taken, %llu refused, %llu cycles on a path\n", taken, refused, moved);
    TEST_ASSERT_TRUE(seeds_given() || slowness() > EFFORT_FULL || (taken > refused && moved > CYCLES));
}

/** What is inverted, and is told everything inverted, goes the same way. */
static void test_no_group_depends_on_the_sign_of_the_unit(void)
{
    mirrors = true;
    for (int i = 0; i < seed_count(PROGRAMS); i++)
        units_compare(&random_program, (int)seed_of(i), true);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_group_depends_on_the_unit_of_length);
    RUN_TEST(test_no_group_depends_on_the_sign_of_the_unit);
    return UNITY_END();
}
