/* Groups whose members are masters of slaves in gear. At random moments of a motion of the group something happens: a
 * slave or a member fails or stops, the group is disabled, told to stop or taken apart, a software limit of a member
 * changes. What every set-point keeps is judged by the witness of the bench; here, what follows from it. */
#include "unity.h"

#include "axis/axis_parameters.h"

#include "../support/axes_bench.h"
#include "../support/chance.h"
#include "../support/group_bench.h"

enum { X = 0, Y = 1, MEMBERS = 2, GEARED = 2, BACKWARDS = 3, AXES = 4 };

void setUp(void) {}
void tearDown(void) { group_end(); }

typedef enum happening {
    DISABLED = 0, UNGROUPED, STOP, HALT, OTHER_LINE, OVERRIDE, SOFTWARE_LIMIT, SLAVE_FAULT, MEMBER_FAULT, SLAVE_STOP,
    MEMBER_STOP, GEAR_OUT, SLAVE_MOVES, POWER_LOST, GEAR_ON, HAPPENINGS
} happening_t;

static const char *const names[] = {"disabled", "ungrouped", "stop", "halt", "another line", "override",
                                    "software limit", "fault of a slave", "fault of a member", "MC_Stop of a slave",
                                    "MC_Stop of a member", "MC_GearOut", "a move of a slave", "power of a slave",
                                    "gear on the way"};

/** Either is taken or refused; what is judged comes after it. */
static cm1e_command_id_t tell_axis(int n, const cm1e_axis_command_t *command)
{
    cm1e_command_id_t id = 0;
    (void)cm1e_axis_start(axes_axis(n), command, &id);
    return id;
}

static cm1e_command_id_t tell_group(const cm1e_group_command_t *command)
{
    cm1e_command_id_t id = 0;
    (void)cm1e_group_start(group, command, &id);
    return id;
}

static void gear(int slave, int master)
{
    const cm1e_axis_coupling_t c = {.master = {{.axis = axes_reference(master), .denominator = 2,
                                                .numerator = slave == GEARED ? 1 : -1}}};
    (void)tell_axis(slave, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = &c});
}

static void happen_to_group(happening_t what)
{
    cm1e_group_command_t c = {.deceleration = one_in(2) ? 0 : uniform(1, 100), .jerk = one_in(2) ? 0 : 300};
    switch (what) {
    case DISABLED: (void)cm1e_group_disable(group); break;
    case UNGROUPED: (void)cm1e_group_ungroup(group); break;
    case STOP:
        c.kind = CM1E_GROUP_STOP;
        cm1e_group_hold_stop(group, tell_group(&c), false);
        break;
    case HALT:
        c.kind = CM1E_GROUP_HALT;
        (void)tell_group(&c);
        break;
    case OTHER_LINE:
        c.position[X] = uniform(-3, 3);
        c.position[Y] = uniform(-3, 3);
        c.buffer_mode = (MC_BUFFER_MODE)pick(6);
        c.transition = one_in(2) ? mcTMNone : mcTMMaxCornerDeviation;
        c.transition_parameter = uniform(0.01, 0.5);
        (void)tell_group(&c);
        break;
    default: (void)cm1e_group_set_override(group, one_in(3) ? 0 : uniform(0, 1)); break;
    }
}

static void happen_to_axis(happening_t what)
{
    const int slave = GEARED + pick(2), member = pick(MEMBERS);
    const cm1e_axis_command_t stop = {.kind = CM1E_COMMAND_STOP}, out = {.kind = CM1E_COMMAND_GEAR_OUT};
    const cm1e_axis_command_t move = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = uniform(-2, 2),
                                      .velocity = uniform(0.1, 20)};
    switch (what) {
    case SOFTWARE_LIMIT:
        (void)cm1e_axis_write_parameter(axes_axis(member), CM1E_PARAMETER_SW_LIMIT_POS, uniform(-1, 4));
        (void)cm1e_axis_write_parameter(axes_axis(member), CM1E_PARAMETER_ENABLE_LIMIT_POS, 1);
        break;
    case SLAVE_FAULT: fake_bus_fault(axes_motor(slave), 0x2310); break;
    case MEMBER_FAULT: fake_bus_fault(axes_motor(member), 0x2310); break;
    case SLAVE_STOP: cm1e_axis_hold_stop(axes_axis(slave), tell_axis(slave, &stop), false); break;
    case MEMBER_STOP: cm1e_axis_hold_stop(axes_axis(member), tell_axis(member, &stop), false); break;
    case GEAR_OUT: (void)tell_axis(slave, &out); break;
    case SLAVE_MOVES: (void)tell_axis(slave, &move); break;
    case POWER_LOST: axes_power(slave, false); break;
    default: gear(slave, member); break;
    }
}

static void line(double x, double y)
{
    (void)group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {x, y},
                                                .buffer_mode = mcBlendingHigh, .transition = mcTMMaxCornerDeviation,
                                                .transition_parameter = 0.2});
}

static char text[300]; /* what has happened */

static void judge(void)
{
    const cm1e_group_info_t info = group_info();
    if (info.state == CM1E_GROUP_ERROR_STOP)
        AXES_MUST(strlen(group_text()) > 20, "the group fails without a word");
    for (int n = 0; n < AXES; n++) {
        if (axes_state(n) == CM1E_AXIS_ERROR_STOP)
            AXES_MUST(strlen(axes_text(n)) > 20, "axis %d fails without a word", n);
        AXES_MUST(axes_state(n) != CM1E_AXIS_SYNCHRONIZED_MOTION || n >= GEARED || info.state != CM1E_GROUP_STANDBY,
                  "axis %d is led in GroupStandby", n);
    }
}

static void run(void)
{
    group_end();
    axes_describe(AXES);
    for (int n = 0; n < AXES; n++) {
        axes_config(n)->max_velocity = 10;
        axes_config(n)->max_acceleration = n < MEMBERS ? 100 : 400;
        axes_config(n)->max_deceleration = n < MEMBERS ? (one_in(2) ? 60 : 100) : 400;
    }
    axes_make();
    axes_enable_all();
    group_create();
    for (int n = 0; n < MEMBERS; n++)
        AXES_MUST(cm1e_group_add(group, axes_reference(n), 0) == CM1E_OK, "%s", group_text());
    AXES_MUST(cm1e_group_enable(group) == CM1E_OK, "%s", group_text());
    if (!one_in(4)) {
        gear(GEARED, X);
        gear(BACKWARDS, Y);
    }
    axes_cycles(30);
    axes_bench.run = text;
    line(2, 0.7), line(1, 2), line(-1, 1);
    const int count = 1 + pick(3);
    for (int i = 0; i < count; i++) {
        axes_cycles(1 + pick(i ? 60 : 800));
        judge();
        const happening_t what = (happening_t)pick(HAPPENINGS);
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s in %llu; ", names[what], axes_bench.cycle);
        if (what <= OVERRIDE)
            happen_to_group(what);
        else
            happen_to_axis(what);
    }
    for (int i = 0; i < 150; i++) {
        axes_cycles(20);
        judge();
    }
    (void)cm1e_group_set_override(group, 1);
    axes_cycles(3000);
    judge();
    for (int n = 0; n < MEMBERS; n++)
        AXES_MUST(axes_info(n).set_velocity == 0, "axis %d still moves", n);
    const cm1e_group_state_t state = group_info().state;
    AXES_MUST(state != CM1E_GROUP_MOVING && state != CM1E_GROUP_STOPPING, "the group is still in %s",
              cm1e_group_state_name(state));
}

static void test_whatever_happens_to_members_that_are_masters(void)
{
    for (int i = 0; i < seed_count(1200); i++) {
        chance_seed(seed_of(i));
        snprintf(text, sizeof text, "seed %u: ", seed_of(i));
        run();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_whatever_happens_to_members_that_are_masters);
    return UNITY_END();
}
