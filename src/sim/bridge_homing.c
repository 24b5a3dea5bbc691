#include "sim/bridge_app.h"

/* The guide does not say where the sensors are: IN2 is that of CW, IN3 that of CCW, as behind the simulated CM1-E. */
#define DEFAULT_TORQUE_PERCENT 30
#define SEARCH_LIMIT_S 60.0 /* the guide names a time-out (BR 7.1.3) and no time */
enum { K_SPEED = 42, K_ACCELERATION = 43, K_OFFSET_UNIT = 45, K_TORQUE = 47, K_OFFSET = 48 };
enum { METHODS = 4 };

/* BR 6.4.1, in the order of 0x6098. */
static const struct {
    int8_t direction;
    bool by_sensor;
} methods[METHODS] = {{+1, false}, {-1, false}, {+1, true}, {-1, true}};

static void look_at_sensor(cm1e_sim_bridge_axis_t *axis)
{
    const uint8_t input = axis->search.direction > 0 ? CM1E_SIM_INPUT_2 : CM1E_SIM_INPUT_3;
    axis->search.sensor = (cm1e_sim_bridge_inputs_of(axis) & input) != 0;
    axis->search.edge = cm1e_sim_sensors_edge(&axis->sensors, input);
}

static double offset_unit(const cm1e_sim_bridge_t *bridge, const cm1e_sim_bridge_axis_t *axis)
{
    const int unit = cm1e_bridge_offset_unit((int32_t)*cm1e_sim_bridge_k(bridge, axis->number, K_OFFSET_UNIT));
    return axis->motor == CM1E_BRIDGE_CM2 && unit ? unit : CM1E_BRIDGE_OFFSET_UNIT;
}

void cm1e_sim_bridge_search_begin(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis)
{
    if (axis->unplugged) /* it does not hear */
        return;
    const unsigned n = axis->number;
    const int64_t method = *cm1e_sim_bridge_value(bridge, n, OBJ_6098_HOMING_METHOD, 0);
    const int64_t torque = *cm1e_sim_bridge_k(bridge, n, K_TORQUE);
    axis->search = (cm1e_sim_search_t){0};
    axis->search_failed = method < 1 || method > METHODS; /* as a profile may have it */
    if (axis->search_failed)
        return;
    axis->search = (cm1e_sim_search_t){
        .direction = methods[method - 1].direction,
        .speed = CM1E_BRIDGE_SPEED_UNIT * (double)*cm1e_sim_bridge_k(bridge, n, K_SPEED) / axis->scale,
        .acceleration =
            CM1E_BRIDGE_ACCELERATION_UNIT * (double)*cm1e_sim_bridge_k(bridge, n, K_ACCELERATION) / axis->scale,
        .offset = offset_unit(bridge, axis) * (double)*cm1e_sim_bridge_k(bridge, n, K_OFFSET) / axis->scale,
    };
    axis->servo.own_profile = true;
    look_at_sensor(axis);
    cm1e_sim_search_begin(&axis->search, methods[method - 1].by_sensor);
    cm1e_sim_bridge_axis_torque(axis, torque > 0 && torque <= 100 ? (double)torque : DEFAULT_TORQUE_PERCENT);
    axis->search_s = 0;
}

void cm1e_sim_bridge_search_reset(cm1e_sim_bridge_axis_t *axis)
{
    axis->search = (cm1e_sim_search_t){0};
    axis->search_failed = false;
}

void cm1e_sim_bridge_search_abort(cm1e_sim_bridge_axis_t *axis)
{
    if (!cm1e_sim_search_running(&axis->search))
        return;
    axis->search.phase = SEARCH_IDLE;
    cm1e_servo_catch(&axis->servo, &axis->mechanics);
    axis->servo.reference_velocity = 0;
    cm1e_sim_bridge_axis_torque(axis, 0);
}

void cm1e_sim_bridge_search_step(cm1e_sim_bridge_axis_t *axis, double step_s)
{
    const cm1e_sim_searcher_t motor = {&axis->servo, &axis->mechanics, &axis->zero};
    look_at_sensor(axis);
    axis->search_s += step_s;
    cm1e_sim_search_step(&axis->search, &motor, step_s);
    if (axis->search.phase == SEARCH_DONE)
        cm1e_sim_bridge_axis_torque(axis, 0);
    axis->search_failed = cm1e_sim_search_running(&axis->search) && axis->search_s > SEARCH_LIMIT_S;
    if (axis->search_failed)
        cm1e_sim_bridge_search_abort(axis);
}
