/*
 * Two rollers that follow a virtual shaft. The left one synchronises at once, wherever it is (MC_GearIn), the right one
 * so that its 0 degrees meet those of the shaft (MC_GearInPos). A mark on the web would show that the left one is out
 * of register. MC_PhasingRelative turns it by the remaining offset during the motion. Then the shaft goes faster,
 * reverses and stops, and both rollers follow it.
 *
 *     10_electronic_gear -i sim --svg gear.svg
 */
#include <math.h>

#include "example.h"

enum { SHAFT = 0, LEFT, RIGHT, AXES };
typedef enum step { STEP_POWER = 0, STEP_TURN, STEP_GEAR_IN, STEP_PHASING, STEP_FASTER, STEP_REVERSE, STEP_HALT,
                    STEP_OFF } step_t;
static const char *const names[AXES] = {"shaft", "left", "right"};
static const LREAL slow = 360, fast = 720; /* degrees/s */

static example_t example;
static AXIS_REF_t axes[AXES];
static MC_Power_t power[AXES];
static MC_MoveVelocity_t turn = {.Axis = &axes[SHAFT], .Velocity = slow, .Acceleration = 720};
static MC_MoveVelocity_t faster = {.Axis = &axes[SHAFT], .Velocity = fast, .Acceleration = 720};
static MC_MoveVelocity_t reverse = {.Axis = &axes[SHAFT], .Velocity = -slow, .Acceleration = 720, .Deceleration = 720};
static MC_Halt_t halt = {.Axis = &axes[SHAFT], .Deceleration = 720};
static MC_GearIn_t gear_in = {.Master = &axes[SHAFT], .Slave = &axes[LEFT], .RatioNumerator = 1, .RatioDenominator = 1,
                              .Acceleration = 1440, .Deceleration = 1440};
static MC_GearInPos_t gear_in_pos = {.Master = &axes[SHAFT], .Slave = &axes[RIGHT], .RatioNumerator = 1,
                                     .RatioDenominator = 1, .MasterSyncPosition = 0, .SlaveSyncPosition = 0,
                                     .MasterStartDistance = 180, .Velocity = 1440};
static MC_PhasingRelative_t phasing = {.Master = &axes[SHAFT], .Slave = &axes[LEFT], .Velocity = 180,
                                       .Acceleration = 720, .Deceleration = 720};
static step_t step;
static int64_t step_began_ns;
static LREAL before[AXES], after[AXES], worst[AXES]; /* degrees behind the shaft; later change of that angle */

static void describe_network(cm1e_bus_config_t *config)
{
    for (int i = 0; i < AXES; i++) {
        cm1e_axis_config_t *axis = &config->axes[i];
        snprintf(axis->name, sizeof axis->name, "%s", names[i]);
        axis->type = i == SHAFT ? CM1E_AXIS_VIRTUAL : CM1E_AXIS_MOTOR;
        axis->address = i == SHAFT ? 0 : (uint16_t)i;
        axis->units_per_revolution = 360;
        axis->modulo_range = 360;
        axis->sim.no_stops = i != SHAFT;
    }
}

/* Angle of a roller behind the shaft, -180 ... 180 degrees, by the set-points of the cycle before. */
static LREAL behind(int roller)
{
    cm1e_axis_info_t shaft, now;
    cm1e_axis_read(axes[SHAFT], &shaft);
    cm1e_axis_read(axes[roller], &now);
    return remainder(shaft.set_position - now.set_position, 360);
}

static void measure(void)
{
    for (int i = LEFT; i < AXES; i++) {
        if (step == STEP_GEAR_IN)
            before[i] = behind(i);
        if (step == STEP_PHASING && phasing.Done)
            after[i] = behind(i);
        if (step > STEP_PHASING && step < STEP_OFF)
            worst[i] = fmax(worst[i], fabs(remainder(behind(i) - after[i], 360)));
    }
}

static void call_blocks(void)
{
    for (int i = 0; i < AXES; i++) {
        power[i].Enable = step < STEP_OFF;
        MC_Power(&power[i]);
    }
    turn.Execute = step >= STEP_TURN;
    gear_in.Execute = gear_in_pos.Execute = step >= STEP_GEAR_IN;
    phasing.Execute = step >= STEP_PHASING;
    faster.Execute = step >= STEP_FASTER;
    reverse.Execute = step >= STEP_REVERSE;
    halt.Execute = step >= STEP_HALT;
    MC_MoveVelocity(&turn);
    MC_GearIn(&gear_in);
    MC_GearInPos(&gear_in_pos);
    MC_PhasingRelative(&phasing);
    MC_MoveVelocity(&faster);
    MC_MoveVelocity(&reverse);
    MC_Halt(&halt);
}

/* Any error ends the run: power off, which ramps down the axes that still turn. */
static void watch(void)
{
    bool failed = example_failed(&example, axes[LEFT], gear_in.Error, gear_in.ErrorID) ||
                  example_failed(&example, axes[RIGHT], gear_in_pos.Error, gear_in_pos.ErrorID) ||
                  example_failed(&example, axes[LEFT], phasing.Error, phasing.ErrorID) ||
                  example_failed(&example, axes[SHAFT], turn.Error, turn.ErrorID) ||
                  example_failed(&example, axes[SHAFT], faster.Error, faster.ErrorID) ||
                  example_failed(&example, axes[SHAFT], reverse.Error, reverse.ErrorID);
    for (int i = 0; i < AXES; i++)
        failed = example_failed(&example, axes[i], power[i].Error, power[i].ErrorID) || failed;
    if (failed)
        step = STEP_OFF;
}

static bool step_is_done(void)
{
    const bool lasted_a_second = cm1e_scheduler_time_ns(example.scheduler) - step_began_ns > 1000000000;
    switch (step) {
    case STEP_POWER: return power[SHAFT].Status && power[LEFT].Status && power[RIGHT].Status;
    case STEP_TURN: return turn.InVelocity;
    case STEP_GEAR_IN: return gear_in.InGear && gear_in_pos.InSync;
    case STEP_PHASING: return phasing.Done;
    case STEP_FASTER: return faster.InVelocity && lasted_a_second;
    case STEP_REVERSE: return reverse.InVelocity && lasted_a_second;
    case STEP_HALT: return halt.Done;
    default: return !power[LEFT].Status && !power[RIGHT].Status;
    }
}

static void program(void *context)
{
    static const char *const marks[] = {"power", "the shaft turns", "gear in", "phasing", "faster", "reverse", "halt",
                                        "off"};
    (void)context;
    if (step == STEP_PHASING && !phasing.Execute)
        phasing.PhaseShift = before[LEFT] - before[RIGHT]; /* the offset to the roller in register */
    call_blocks();
    measure();
    watch();
    if (step == STEP_PHASING && phasing.CommandAborted) { /* by a pause of the cycle: what is left is phased then */
        step = STEP_GEAR_IN;
        return;
    }
    if (!step_is_done())
        return;
    step = (step_t)example_next_step(&example, marks, step, STEP_OFF);
    step_began_ns = cm1e_scheduler_time_ns(example.scheduler);
}

int main(int argc, char **argv)
{
    cm1e_diag_t why = {0};
    example.axis_count = AXES;
    example.describe_network = describe_network;
    example_options(&example, argc, argv, "Two rollers in gear with a virtual shaft, and put in register.");
    cm1e_error_t error = example_open(&example, &why);
    for (uint32_t i = 0; error == CM1E_OK && i < AXES; i++) {
        axes[i] = cm1e_scheduler_axis(example.scheduler, i);
        power[i] = (MC_Power_t){.Axis = &axes[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
    }
    if (error == CM1E_OK)
        error = example_run(&example, program, &why);
    if (example_is_done(&example, error)) {
        printf("degrees behind the shaft   in gear   after phasing   then within\n");
        for (int i = LEFT; i < AXES; i++)
            printf("%-24s %9.3f %15.3f %13.6f\n", names[i], before[i], after[i], worst[i]);
    }
    return example_end(&example, error, &why, true);
}
