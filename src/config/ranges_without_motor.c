/* Keys that an axis without a motor must not have. */
#include "config/ranges.h"

static bool any_input(const cm1e_input_config_t *inputs)
{
    return inputs->limit_positive || inputs->limit_negative || inputs->home || inputs->limits_normally_closed ||
           inputs->home_normally_closed;
}

static bool any_homing(const cm1e_homing_config_t *homing)
{
    return homing->method != 0 || homing->offset != 0 || homing->velocity != 0 || homing->acceleration != 0 ||
           homing->torque != 0 || homing->timeout_s != 0;
}

static bool any_sim(const cm1e_sim_axis_config_t *sim)
{
    return sim->load_inertia != 0 || sim->friction != 0 || sim->viscous_friction != 0 || sim->stop_positive != 0 ||
           sim->stop_negative != 0 || sim->no_stops || sim->sensor_input2 != 0 || sim->sensor_input3 != 0 ||
           sim->no_sensors;
}

/* Keys without a meaning for an axis without a motor, and for an encoder also the keys of motions. */
bool cm1e_config_check_without_motor(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const bool encoder = axis->type == CM1E_AXIS_ENCODER, by_position = axis->address_kind == CM1E_ADDRESS_POSITION;
    const struct {
        const char *key;
        bool given;
    } keys[] = {
        {"position", by_position && axis->address != 0},
        {"alias", axis->address_kind == CM1E_ADDRESS_ALIAS},
        {"explicit_id", axis->address_kind == CM1E_ADDRESS_EXPLICIT_ID},
        {"optional", axis->optional},
        {"recover", axis->recover != CM1E_RECOVER_DEFAULT},
        {"sim.absent", axis->sim_absent},
        {"channel", axis->channel != 0},
        {"device", axis->device[0] != '\0'},
        {"motor", axis->motor[0] != '\0'},
        {"k37", axis->k37_stated},
        {"firmware", axis->firmware[0] != '\0'},
        {"mapping", axis->mapping != CM1E_MAPPING_DYNAMIC},
        {"motion", axis->motion != CM1E_MOTION_HOST},
        {"limits.position_lag", axis->max_position_lag != 0},
        {"in_position.window", axis->in_position_window != 0},
        {"in_position.time_s", axis->in_position_time_s != 0},
        {"in_position.timeout_s", axis->in_position_timeout_s != 0},
        {"in_position.done_waits", axis->in_position_done_waits},
        {"backlash.gap", axis->backlash != 0},
        {"backlash.velocity", axis->backlash_velocity != 0},
        {"inputs", any_input(&axis->inputs)},
        {"homing", any_homing(&axis->homing)},
        {"drive", axis->counts_per_revolution || axis->max_speed_rpm != 0 || axis->outputs_pdo || axis->inputs_pdo},
        {"dc", cm1e_config_has_pulses(&axis->dc)},
        {"wire.velocity_unit", axis->velocity_unit_stated},
        {"wire.acceleration_unit", axis->acceleration_in_kpulses},
        {"sim", any_sim(&axis->sim)},
        {"limits.velocity", encoder && axis->max_velocity != 0 && axis->wiring.encoder[0] == '\0'},
        {"limits.acceleration", encoder && axis->max_acceleration != 0},
        {"limits.deceleration", encoder && axis->max_deceleration != 0},
        {"limits.jerk", encoder && axis->max_jerk != 0},
        {"software_limits", encoder && (axis->software_limit_negative != 0 || axis->software_limit_positive != 0)},
        {"jog.slow", encoder && axis->jog_slow != 0},
        {"jog.fast", encoder && axis->jog_fast != 0},
        {"table_profiles", encoder && axis->table_profiles},
        {"cam_points", encoder && axis->cam_points != 0},
        {"follows", encoder && axis->follows != CM1E_FOLLOWS_ANY},
        {"coupling_stop", encoder && axis->coupling_stop != CM1E_COUPLING_STOP_THIS},
    };
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
        if (keys[i].given)
            return axis_wrong(check, keys[i].key, encoder ? "is given, and the axis is an encoder, which has no slave "
                              "on the bus and makes no motions; expected no such key"
                              : "is given, and the axis is virtual, without a motor on the bus; expected no such key");
    return true;
}
