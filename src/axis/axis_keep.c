/* Outputs and motions that end when no call renews them. */
#include "axis/axis_device.h"
#include "axis/axis_extras.h"
#include "axis/axis_signals.h"
#include "drive/drive_wiring.h"

void cm1e_axis_keep(cm1e_axis_t *axis, cm1e_command_id_t id, int64_t keep_ns, double deceleration, double jerk)
{
    axis->commands.kept = id;
    axis->commands.kept_until_ns = axis->now_ns + keep_ns;
    axis->commands.kept_deceleration = deceleration;
    axis->commands.kept_jerk = jerk;
    cm1e_axis_signals_changed(axis);
}

/* Ends the motion that nobody has renewed. */
static void end_kept(cm1e_axis_t *axis)
{
    cm1e_command_id_t halt;
    const bool moves = axis->commands.kept == axis->commands.active;
    axis->commands.kept = 0;
    if (!moves)
        return;
    /* The halt must succeed, so it does not use values from the program that the axis could refuse. */
    const cm1e_axis_command_t kept = {.kind = CM1E_COMMAND_HALT, .deceleration = axis->commands.kept_deceleration,
                                      .jerk = axis->commands.kept_jerk};
    if (cm1e_axis_start(axis, &kept, &halt) != CM1E_OK)
        cm1e_axis_start(axis, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT}, &halt);
}

void cm1e_axis_signals_step(cm1e_axis_t *axis)
{
    /* A slave that left Operational may have been switched off: its output does not come on again by itself. */
    if (!cm1e_drive_operational(&axis->drive) || axis->now_ns >= axis->signals.output_until_ns)
        axis->drive.command.digital_outputs = 0;
    if (axis->drive.wiring)
        cm1e_drive_wired_expire(&axis->drive);
    if (axis->commands.kept != 0 && axis->now_ns >= axis->commands.kept_until_ns)
        end_kept(axis);
    cm1e_axis_signals_changed(axis);
}
