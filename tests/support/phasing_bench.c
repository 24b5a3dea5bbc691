#include "phasing_bench.h"

cm1e_axis_coupling_t seen;

cm1e_axis_command_t shift(bool relative, double position, double velocity)
{
    seen = (cm1e_axis_coupling_t){.master = {{.axis = axes_reference(MASTER)}}};
    return (cm1e_axis_command_t){
        .kind = relative ? CM1E_COMMAND_PHASING_RELATIVE : CM1E_COMMAND_PHASING_ABSOLUTE, .position = position,
        .velocity = velocity, .coupling = &seen,
    };
}

cm1e_command_id_t to_shift(double position, double velocity)
{
    const cm1e_axis_command_t c = shift(false, position, velocity);
    return axes_command(SLAVE, &c);
}

cm1e_command_id_t by_shift(double position, double velocity)
{
    const cm1e_axis_command_t c = shift(true, position, velocity);
    return axes_command(SLAVE, &c);
}

cm1e_command_state_t state_of(cm1e_command_id_t id) { return axes_status(SLAVE, id).state; }

/* What F is measured from: in step, without a shift. */
static struct reference {
    position_t master, slave;
    double counts_ratio;
} zero;

void in_step(int32_t numerator, uint32_t denominator)
{
    const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, numerator, denominator);
    axes_wait_reached(SLAVE, gear, 2000);
    axes_cycles(1);
    zero = (struct reference){axes_axis(MASTER)->setpoint.position, axes_axis(SLAVE)->setpoint.position,
                              (double)numerator / denominator * axes_axis(SLAVE)->position.scale /
                                  axes_axis(MASTER)->position.scale};
}

double off(double shifted)
{
    const double master = cm1e_position_minus(axes_axis(MASTER)->setpoint.position, zero.master);
    return cm1e_position_minus(axes_axis(SLAVE)->setpoint.position, zero.slave) -
           (master + shifted * axes_axis(MASTER)->position.scale) * zero.counts_ratio;
}
