/**
 * Slaves and masters (PLCopen Part 1 v2.0, chapter 4): each block that follows, waiting, getting in step and in step,
 * met by each block that moves, by itself again, by the loss of its own axis and of its master; what must be refused.
 * Every call is judged by 2.4.1, every set-point by the limits of its axis. Chains: test_fb_conformance_chains.
 */

#include "effort.h"
#include "quick_check.h"
#include "slave_bench.h"

static const char *const followers[] = {"MC_GearIn", "MC_CombineAxes", "MC_CamIn", "MC_GearInPos"};
enum { FOLLOWERS = sizeof followers / sizeof *followers };
static const char *const movers[] = {
    "MC_MoveAbsolute", "MC_MoveRelative", "MC_MoveAdditive", "MC_MoveVelocity", "MC_MoveContinuousAbsolute",
    "MC_MoveContinuousRelative", "MC_PositionProfile", "MC_VelocityProfile", "MC_AccelerationProfile", "MC_Halt",
    "MC_Stop", "MC_Home", "MC_StepBlock", "MC_GearIn", "MC_CombineAxes", "MC_CamIn", "MC_GearInPos"};
enum { MOVERS = sizeof movers / sizeof *movers };

static instance_t mover, follower, other, more[8];

static bool is(const instance_t *fb, const char *name) { return strcmp(name_of(fb), name) == 0; }

/* ---- phases of a follower ---------------------------------------------------------------------------------------- */

typedef enum phase { WAITING = 0, BEFORE_THE_WAY, INTO_STEP, IN_STEP, PHASES } phase_t;
static const char *const phase_names[] = {"waiting", "before its way into step", "getting in step", "in step"};

/** Axis 0 is the slave, axes 1 and 2 its masters, which turn. */
static void begin_turning(void)
{
    slaves_begin(3);
    turn(1, 4);
    turn(2, -1);
    cycles(300);
}

static void make_follower(instance_t *fb, const char *name)
{
    made_about(0, 1, fb, name);
    point_at(fb, "Master2", &judged_axes[2].reference);
}

/** FALSE: this block has no such phase. */
static bool into_phase(const char *name, phase_t phase)
{
    if (phase == BEFORE_THE_WAY && strcmp(name, "MC_GearInPos") != 0)
        return false;
    begin_turning();
    memset(&mover, 0, sizeof mover);
    if (phase == WAITING)
        make_and_start(0, -1, &mover, "MC_MoveAbsolute");
    make_follower(&follower, name);
    put(&follower, "BufferMode", phase == WAITING ? mcBuffered : mcAborting);
    if (phase == BEFORE_THE_WAY)
        put(&follower, "MasterStartDistance", 10);
    trigger(&follower, true);
    cycles(5);
    MUST(follower.now.busy && follower.now.active == (phase > BEFORE_THE_WAY), "Busy %d, Active %d, Error 0x%04X: %s",
         follower.now.busy, follower.now.active, follower.now.error_id, axes_text(0));
    if (phase == IN_STEP)
        CYCLE_UNTIL(follower.now.reached);
    if (is(&follower, "MC_GearInPos"))
        MUST(follower.memory[place_of(follower.view->type, "StartSync")] == (phase == INTO_STEP), "StartSync");
    MUST(follower.now.reached == (phase == IN_STEP), "InGear or InSync is %d", follower.now.reached);
    return true;
}

/** TRUE and a name for messages: such a phase is there. */
static bool scene(const char *what, const char *name, phase_t phase)
{
    snprintf(judged_axes[0].scene, sizeof judged_axes[0].scene, "%s, %s: %s", name, phase_names[phase], what);
    return into_phase(name, phase);
}

#define FOR_EACH_PHASE(name, phase, what)                                                                             \
    for (int i_ = 0; i_ < FOLLOWERS; i_++)                                                                            \
        for (int phase = 0; phase < PHASES; phase++)                                                                  \
            for (const char *name = followers[i_]; name; name = NULL)                                                 \
                if (scene(what, name, (phase_t)phase))

/* ---- met by another block ---------------------------------------------------------------------------------------- */

static void check_taken_over(void)
{
    MUST(other.now.busy && other.now.active, "Busy %d, Active %d, Error 0x%04X: %s", other.now.busy, other.now.active,
         other.now.error_id, axes_text(0));
    cycle();
    MUST(follower.now.aborted && !follower.now.reached, "the follower shows Busy %d, CommandAborted %d, Error 0x%04X",
         follower.now.busy, follower.now.aborted, follower.now.error_id);
    for (int n = 0; n < 400; n++, cycle())
        MUST(!follower.now.busy && follower.now.aborted, "the follower comes back");
    MUST(axes_state(1) == CM1E_AXIS_CONTINUOUS_MOTION && axes_info(1).set_velocity == 4.0, "the master is disturbed");
}

static void check_refused(cm1e_error_t refusal)
{
    const bool busy = follower.now.busy, active = follower.now.active;
    MUST(other.now.error_id == cm1e_error_id(refusal), "Error 0x%04X, 0x%04X is right", other.now.error_id,
         cm1e_error_id(refusal));
    cycle();
    MUST(follower.now.busy == busy && follower.now.active == active, "the follower is disturbed");
}

START_TEST(test_follower_is_aborted_by_every_block_that_moves)
{
    const char *by = movers[_i];
    FOR_EACH_PHASE (name, phase, by) {
        make_follower(&other, by);
        const block_rule_t rule = other.view->type->rules[axes_state(0)];
        trigger(&other, true);
        cycle();
        if (rule.refusal != CM1E_OK)
            check_refused(rule.refusal);
        else
            check_taken_over();
    }
}
END_TEST

/** The waiting one begins when the follower is in step, of a cam at its EndOfProfile; in any mode but mcAborting. */
START_TEST(test_block_that_waits_behind_a_follower_begins_when_it_is_in_step)
{
    const char *next = movers[_i];
    const int stride = sweep_stride(1, 4); /* a sample: each block in one mode */
    for (int mode = mcBuffered + sweep_first(_i, stride); mode <= mcBlendingHigh; mode += stride)
        FOR_EACH_PHASE (name, phase, next) {
            if (phase == WAITING)
                continue;
            make_follower(&other, next);
            if (other.view->buffer_mode == NOWHERE)
                continue;
            put_out_of_reach_of_another(&other);
            put(&other, "BufferMode", mode);
            trigger(&other, true);
            cycle();
            const bool later = phase == BEFORE_THE_WAY;
            if (other.now.error) { /* it needs a rest to begin from, or another mode: said at once, no harm done */
                MUST(follower.now.busy && (follower.now.active || later), "the follower is disturbed");
                continue;
            }
            for (int n = 0; n < 8000 && !other.now.active && !other.now.done; n++) {
                MUST(follower.now.busy && (follower.now.active || later) && other.now.busy,
                     "mode %d: the follower: Busy %d; %s: Error 0x%04X", mode, follower.now.busy, next,
                     other.now.error_id);
                cycle();
            }
            MUST(other.now.active || other.now.done, "mode %d: never Active", mode);
            cycle();
            MUST(follower.now.aborted, "mode %d: the follower: CommandAborted %d, Error 0x%04X", mode,
                 follower.now.aborted, follower.now.error_id);
            cycles(200);
        }
}
END_TEST

/* ---- triggered again --------------------------------------------------------------------------------------------- */

START_TEST(test_edge_on_a_busy_follower_shows_nothing_of_the_first_command)
{
    FOR_EACH_PHASE (name, phase, "again") {
        trigger(&follower, false);
        cycles(3);
        MUST(follower.now.busy, "the falling edge ended it");
        if (phase == IN_STEP)
            MUST(follower.now.reached, "the falling edge changed it");
        put_in_reach(&follower, name);
        put(&follower, "RatioNumerator", -1);
        put(&follower, "GearRatioNumeratorM1", -1);
        trigger(&follower, true);
        for (int n = 0; n < 600; n++) {
            cycle();
            MUST(follower.now.busy && !follower.now.aborted && !follower.now.error, "Busy %d, Error 0x%04X: %s",
                 follower.now.busy, follower.now.error_id, axes_text(0));
        }
    }
}
END_TEST

START_TEST(test_follower_goes_on_when_its_block_is_gone)
{
    FOR_EACH_PHASE (name, phase, "forgotten") {
        called_count = 0;
        memset(&follower, 0xA5, sizeof follower);
        axes_cycles(3000);
        MUST(axes_state(0) == CM1E_AXIS_SYNCHRONIZED_MOTION, "the axis is in %s: %s",
             cm1e_axis_state_name(axes_state(0)), axes_text(0));
    }
}
END_TEST

START_TEST(test_instance_serves_one_slave_after_the_other)
{
    for (int i = 0; i < FOLLOWERS; i++) {
        if (!scene("serves another", followers[i], IN_STEP))
            continue;
        point_at_axis(&follower, &judged_axes[2].reference);
        cycle();
        MUST(follower.now.error_id == cm1e_error_id(CM1E_ERROR_FB_AXIS_CHANGED), "Error 0x%04X", follower.now.error_id);
        trigger(&follower, false);
        cycles(100);
        MUST(axes_state(0) == CM1E_AXIS_SYNCHRONIZED_MOTION && axes_axis(0)->setpoint.reached,
             "the first slave is disturbed");
        MUST(axes_state(2) == CM1E_AXIS_CONTINUOUS_MOTION, "the second is touched");
        follower.of = judged_at = 2;
        judged.master = axes_reference(1);
        point_at(&follower, "Master2", &judged_axes[1].reference);
        put_in_reach(&follower, followers[i]);
        trigger(&follower, true);
        CYCLE_UNTIL(follower.now.reached);
        MUST(axes_state(0) == CM1E_AXIS_SYNCHRONIZED_MOTION && axes_axis(0)->setpoint.reached,
             "the first slave is disturbed");
    }
}
END_TEST

/* ---- losses ------------------------------------------------------------------------------------------------------ */

typedef enum loss {
    LOSS_SLAVE_OFF = 0, LOSS_SLAVE_FAULT, LOSS_SLAVE_VOLTAGE, LOSS_SLAVE_GONE,
    LOSS_MASTER_OFF, LOSS_MASTER_FAULT, LOSS_MASTER_VOLTAGE, LOSS_MASTER_GONE, LOSSES
} loss_t;
static const char *const loss_names[] = {"slave off", "slave: fault", "slave: no voltage", "slave gone", "master off",
                                         "master: fault", "master: no voltage", "master gone"};

static void strike(loss_t loss)
{
    const int n = loss >= LOSS_MASTER_OFF;
    switch (loss) {
    case LOSS_SLAVE_OFF:
    case LOSS_MASTER_OFF: axes_power(n, false); break;
    case LOSS_SLAVE_FAULT:
    case LOSS_MASTER_FAULT: fake_bus_fault(axes_motor(n), 0x2310); break;
    case LOSS_SLAVE_VOLTAGE:
    case LOSS_MASTER_VOLTAGE: axes_motor(n)->power = false; break;
    default: axes_motor(n)->watch = (cm1e_slave_watch_t){.al_state = CM1E_AL_PRE_OP}; break;
    }
}

/** Its own axis is lost: 2.2.2 case 1, 2.1 note 2. The master goes on. */
static void check_slave_lost(loss_t loss)
{
    cycles(40);
    const bool off = loss == LOSS_SLAVE_OFF;
    MUST(axes_state(0) == (off ? CM1E_AXIS_DISABLED : CM1E_AXIS_ERROR_STOP), "the slave is in %s",
         cm1e_axis_state_name(axes_state(0)));
    MUST(follower.now.aborted == off && follower.now.error == !off && !follower.now.busy,
         "CommandAborted %d, Error 0x%04X", follower.now.aborted, follower.now.error_id);
    cycles(500);
    MUST(axes_state(1) == CM1E_AXIS_CONTINUOUS_MOTION && axes_info(1).set_velocity == 4.0, "the master is disturbed");
    MUST(!axes_axis(0)->commands.active, "a command is left");
}

/** Its master is lost: an error of the slave as soon as it follows. What waits may not know of it yet. */
static void check_master_lost(phase_t phase)
{
    int left = 4000;
    while (follower.now.busy && --left)
        cycle();
    MUST(left > 0, "the follower stays Busy, the slave is in %s", cm1e_axis_state_name(axes_state(0)));
    MUST(follower.now.error && !follower.now.aborted, "CommandAborted %d, Error 0x%04X", follower.now.aborted,
         follower.now.error_id);
    if (phase != WAITING) {
        MUST(axes_state(0) == CM1E_AXIS_ERROR_STOP, "the slave is in %s", cm1e_axis_state_name(axes_state(0)));
        MUST(axes_axis(0)->fault.error == CM1E_ERROR_AXIS_MASTER_LOST, "%s", axes_text(0));
    }
    cycles(1500);
    MUST(axes_info(0).set_velocity == 0.0 && axes_info(2).set_velocity == -1.0, "the slave moves on: %g u/s",
         axes_info(0).set_velocity);
}

START_TEST(test_loss_of_an_axis_in_every_phase)
{
    const loss_t loss = (loss_t)_i;
    FOR_EACH_PHASE (name, phase, loss_names[loss]) {
        if (loss >= LOSS_MASTER_OFF && phase == BEFORE_THE_WAY)
            continue; /* it may still go on by its motion before: tested where it is made */
        strike(loss);
        if (loss < LOSS_MASTER_OFF)
            check_slave_lost(loss);
        else
            check_master_lost((phase_t)phase);
    }
}
END_TEST

/** The drive moves a master that homes, so it has no set value; other coordinates are no motion. */
START_TEST(test_master_that_is_homed_is_lost_and_one_that_is_renamed_is_not)
{
    FOR_EACH_PHASE (name, phase, "MC_SetPosition of master and slave") {
        if (phase != IN_STEP)
            continue;
        const double velocity = axes_info(0).set_velocity;
        for (int n = 0; n < 2; n++) {
            made_about(n, -1, &more[n], "MC_SetPosition");
            put(&more[n], "Position", 1000.0 * (n + 1));
            trigger(&more[n], true);
        }
        cycles(2);
        MUST(more[0].now.done && more[1].now.done, "Error 0x%04X, 0x%04X", more[0].now.error_id, more[1].now.error_id);
        cycles(50);
        MUST(follower.now.reached && (fabs(axes_info(0).set_velocity - velocity) < 1e-6 || is(&follower, "MC_CamIn")),
             "velocity %g instead of %g", axes_info(0).set_velocity, velocity);
    }
    snprintf(judged_axes[0].scene, sizeof judged_axes[0].scene, "the master homes");
    slaves_begin(2);
    make_and_start(0, 1, &follower, "MC_GearIn");
    CYCLE_UNTIL(follower.now.reached);
    make_and_start(1, -1, &other, "MC_Home");
    MUST(other.now.busy, "Error 0x%04X: %s", other.now.error_id, axes_text(1));
    CYCLE_UNTIL(!follower.now.busy);
    MUST(follower.now.error && axes_axis(0)->fault.error == CM1E_ERROR_AXIS_MASTER_LOST, "Error 0x%04X",
         follower.now.error_id);
}
END_TEST

/** After the error: MC_Reset, and it follows again. */
START_TEST(test_slave_follows_again_after_reset)
{
    FOR_EACH_PHASE (name, phase, "reset") {
        if (phase != IN_STEP)
            continue;
        fake_bus_fault(axes_motor(0), 0x2310);
        cycles(800);
        MUST(axes_state(0) == CM1E_AXIS_ERROR_STOP && follower.now.error, "the slave is in %s",
             cm1e_axis_state_name(axes_state(0)));
        trigger(&follower, false);
        cycle();
        trigger(&follower, true);
        cycle();
        MUST(follower.now.error_id == cm1e_error_id(CM1E_ERROR_AXIS_ERROR_STOP), "ErrorID 0x%04X",
             follower.now.error_id);
        make_and_start(0, -1, &other, "MC_Reset");
        CYCLE_UNTIL(axes_state(0) == CM1E_AXIS_STANDSTILL);
        cycles(300);
        MUST(axes_info(0).set_velocity == 0.0 && !follower.now.busy, "it follows by itself");
        trigger(&follower, false);
        cycle();
        about(0, 1);
        put_in_reach(&follower, name);
        trigger(&follower, true);
        CYCLE_UNTIL(follower.now.reached);
    }
}
END_TEST

/* ---- by actual values -------------------------------------------------------------------------------------------- */

/** A hand wheel: the master has no torque, and somebody turns it. */
START_TEST(test_master_without_torque_is_followed_by_its_actual_value)
{
    static const char *const names[] = {"MC_GearIn", "MC_CombineAxes"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(judged_axes[0].scene, sizeof judged_axes[0].scene, "%s of a hand wheel", names[i]);
        slaves_begin(2);
        axes_bench.witness[0].strictness = AXES_STEEP;
        axes_power(1, false);
        cycles(20);
        make_and_start(0, 1, &follower, names[i]);
        expect_error(&follower, CM1E_ERROR_AXIS_MASTER_LOST); /* its set value is none */
        trigger(&follower, false);
        cycle();
        put(&follower, "MasterValueSource", mcActualValue);
        put(&follower, "MasterValueSourceM1", mcActualValue);
        put(&follower, "MasterValueSourceM2", mcActualValue);
        trigger(&follower, true);
        CYCLE_UNTIL(follower.now.reached);
        const double from = axes_info(0).set_position;
        const int32_t start = axes_motor(1)->position;
        for (int n = 0; n <= 1000; n++) {
            axes_motor(1)->position = start + (int32_t)lround(5000.0 * (1.0 - cos(n * acos(-1.0) / 1000.0)));
            cycle();
            MUST(follower.now.busy && axes_state(0) == CM1E_AXIS_SYNCHRONIZED_MOTION, "Error 0x%04X: %s",
                 follower.now.error_id, axes_text(0));
        }
        cycles(200);
        const double way = 10000.0 / axes_axis(1)->position.scale * (i == 0 ? 0.5 : 0.75);
        MUST(fabs(axes_info(0).set_position - from - way) < 2.0 / fabs(axes_axis(0)->position.scale),
             "it has gone %g u, not %g", axes_info(0).set_position - from, way);
        for (int on = 1; on >= 0; on--) { /* its torque is of no matter, whenever that comes and goes */
            axes_power(1, on);
            cycles(100);
            MUST(follower.now.reached && axes_state(1) == (on ? CM1E_AXIS_STANDSTILL : CM1E_AXIS_DISABLED),
                 "InGear %d, the master is in %s", follower.now.reached, cm1e_axis_state_name(axes_state(1)));
        }
        make_and_start(0, -1, &other, "MC_Halt");
        cycles(2);
        MUST(follower.now.aborted && axes_state(1) == CM1E_AXIS_DISABLED, "CommandAborted %d", follower.now.aborted);
    }
}
END_TEST

/* ---- what is refused --------------------------------------------------------------------------------------------- */

START_TEST(test_wrong_masters_and_ratios_are_refused_and_move_nothing)
{
    static AXIS_REF_t nobody = {.Handle = 999};
    static const struct {
        const char *name, *input;
        double value;
        cm1e_error_t error;
    } wrong[] = {
        {"MC_GearIn", "RatioNumerator", 0, CM1E_ERROR_AXIS_RATIO},
        {"MC_GearIn", "RatioDenominator", 0, CM1E_ERROR_AXIS_RATIO},
        {"MC_GearIn", "Acceleration", -1, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
        {"MC_GearIn", "Jerk", NAN, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
        {"MC_GearInPos", "RatioNumerator", 0, CM1E_ERROR_AXIS_RATIO},
        {"MC_GearInPos", "Velocity", 0, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {"MC_CamIn", "CamTableID", 77, CM1E_ERROR_AXIS_CAM_ID},
        {"MC_CamIn", "CamTableID", 0, CM1E_ERROR_AXIS_CAM_ID},
        {"MC_CombineAxes", "GearRatioNumeratorM1", 0, CM1E_ERROR_AXIS_RATIO},
        {"MC_CombineAxes", "GearRatioDenominatorM2", 0, CM1E_ERROR_AXIS_RATIO},
        {"MC_GearIn", "Master", 0, CM1E_ERROR_AXIS_MASTER},
        {"MC_CombineAxes", "Master1", 0, CM1E_ERROR_AXIS_MASTER},
        {"MC_CombineAxes", "Master2", 0, CM1E_ERROR_AXIS_MASTER},
        {"MC_GearInPos", "Master", 0, CM1E_ERROR_AXIS_MASTER},
        {"MC_CamIn", "Master", 0, CM1E_ERROR_AXIS_MASTER},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        snprintf(judged_axes[0].scene, sizeof judged_axes[0].scene, "%s.%s = %g", wrong[i].name, wrong[i].input,
                 wrong[i].value);
        begin_turning();
        make_follower(&other, wrong[i].name);
        if (strncmp(wrong[i].input, "Master", 6) == 0)
            point_at(&other, wrong[i].input, &nobody);
        else
            put(&other, wrong[i].input, wrong[i].value);
        trigger(&other, true);
        cycle();
        expect_error(&other, wrong[i].error);
        cycles(5);
        MUST(axes_state(0) == CM1E_AXIS_STANDSTILL && axes_info(0).set_velocity == 0.0, "it acted");
    }
}
END_TEST

/* ---- MC_GearOut, MC_CamOut --------------------------------------------------------------------------------------- */

START_TEST(test_way_out_keeps_the_velocity_and_is_for_its_own_kind)
{
    static const char *const ways[] = {"MC_GearOut", "MC_CamOut"};
    FOR_EACH_PHASE (name, phase, "out") {
        const int right = strcmp(name, "MC_CamIn") == 0;
        if (phase == WAITING || phase == BEFORE_THE_WAY)
            continue;
        make_and_start(0, -1, &other, ways[!right]);
        expect_error(&other, CM1E_ERROR_AXIS_NOT_COUPLED);
        cycle();
        MUST(follower.now.busy && follower.now.active, "the follower is disturbed");
        const double velocity = axes_info(0).set_velocity;
        make_and_start(0, -1, &more[0], ways[right]);
        MUST(more[0].now.busy, "Error 0x%04X: %s", more[0].now.error_id, axes_text(0));
        cycle();
        MUST(more[0].now.done && follower.now.aborted && !follower.now.error, "Done %d, CommandAborted %d",
             more[0].now.done, follower.now.aborted);
        MUST(axes_state(0) == CM1E_AXIS_CONTINUOUS_MOTION, "the slave is in %s", cm1e_axis_state_name(axes_state(0)));
        cycles(300);
        if (phase == IN_STEP && !right)
            MUST(fabs(axes_info(0).set_velocity - velocity) < 1e-6, "velocity %g instead of %g",
                 axes_info(0).set_velocity, velocity);
        made_about(0, -1, &more[1], ways[right]);
        trigger(&more[1], true);
        cycle();
        expect_error(&more[1], CM1E_ERROR_AXIS_NOT_COUPLED);
        make_and_start(0, -1, &more[2], "MC_Halt");
        CYCLE_UNTIL(more[2].now.done);
        MUST(axes_state(0) == CM1E_AXIS_STANDSTILL, "the slave is in %s", cm1e_axis_state_name(axes_state(0)));
    }
}
END_TEST

/* ---- phasing ----------------------------------------------------------------------------------------------------- */

START_TEST(test_phasing_is_beside_the_follower_and_ends_with_it)
{
    static const char *const ends[] = {"Done", "aborted", "MC_Halt", "MC_GearOut", "fault", "power", "master"};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        for (int relative = 0; relative < 2; relative++) {
            const char *name = relative ? "MC_PhasingRelative" : "MC_PhasingAbsolute";
            if (!scene(ends[i], "MC_GearIn", IN_STEP))
                continue;
            make_and_start(0, 1, &more[0], name);
            MUST(more[0].now.busy, "Error 0x%04X: %s", more[0].now.error_id, axes_text(0));
            cycles(20);
            MUST(more[0].now.active && follower.now.active, "Active %d, the follower's %d", more[0].now.active,
                 follower.now.active);
            bool error = false, aborted = true;
            if (i == 0) {
                CYCLE_UNTIL(more[0].now.done);
                MUST(follower.now.reached, "the follower is not in gear");
                continue;
            }
            if (i == 1)
                make_and_start(0, 1, &more[1], name);
            else if (i <= 3)
                make_and_start(0, -1, &more[1], ends[i]);
            else if (i == 5)
                axes_power(0, false);
            else {
                fake_bus_fault(axes_motor(i == 6), 0x2310);
                error = true;
                aborted = false;
            }
            cycles(10);
            MUST(more[0].now.error == error && more[0].now.aborted == aborted, "%s: CommandAborted %d, Error 0x%04X",
                 name, more[0].now.aborted, more[0].now.error_id);
            cycles(500);
        }
}
END_TEST

/* ---- what is shown of a slave ------------------------------------------------------------------------------------ */

START_TEST(test_status_of_a_slave)
{
    if (!scene("status", "MC_GearIn", INTO_STEP))
        return;
    MC_ReadStatus_t status = {.Axis = &judged_axes[0].reference, .Enable = TRUE};
    MC_ReadMotionState_t motion[3];
    for (int source = 0; source < 3; source++)
        motion[source] = (MC_ReadMotionState_t){.Axis = &judged_axes[0].reference, .Enable = TRUE,
                                                .Source = (MC_SOURCE)source};
    bool accelerated = false;
    for (int n = 0; n < 600; n++) {
        cycle();
        MC_ReadStatus(&status);
        MUST(status.Valid && status.SynchronizedMotion && !status.Standstill && !status.ContinuousMotion, "status");
        for (int source = 0; source < 3; source++) {
            MC_ReadMotionState(&motion[source]);
            MUST(motion[source].Valid && !(motion[source].Accelerating && motion[source].Decelerating), "source %d",
                 source);
        }
        accelerated = accelerated || (motion[mcSetValue].Accelerating && motion[mcCommandedValue].Accelerating);
        MUST(motion[mcSetValue].Accelerating == (axes_info(0).set_acceleration != 0.0), "Accelerating %d at %g u/s2",
             motion[mcSetValue].Accelerating, axes_info(0).set_acceleration);
    }
    MUST(accelerated && follower.now.reached, "it never accelerated, or is not in gear");
    for (int source = 0; source < 3; source++)
        MUST(motion[source].ConstantVelocity && motion[source].DirectionPositive, "source %d", source);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("conformance: slaves and masters");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_loop_test(all, test_follower_is_aborted_by_every_block_that_moves, 0, MOVERS);
    tcase_add_loop_test(all, test_block_that_waits_behind_a_follower_begins_when_it_is_in_step, 0, MOVERS);
    tcase_add_loop_test(all, test_loss_of_an_axis_in_every_phase, 0, LOSSES);
    const TTest *const single[] = {
        test_edge_on_a_busy_follower_shows_nothing_of_the_first_command,
        test_follower_goes_on_when_its_block_is_gone,
        test_instance_serves_one_slave_after_the_other,
        test_slave_follows_again_after_reset,
        test_master_that_is_homed_is_lost_and_one_that_is_renamed_is_not,
        test_master_without_torque_is_followed_by_its_actual_value,
        test_wrong_masters_and_ratios_are_refused_and_move_nothing,
        test_way_out_keeps_the_velocity_and_is_for_its_own_kind,
        test_phasing_is_beside_the_follower_and_ends_with_it,
        test_status_of_a_slave,
    };
    for (size_t i = 0; i < sizeof single / sizeof *single; i++)
        tcase_add_test(all, single[i]);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
