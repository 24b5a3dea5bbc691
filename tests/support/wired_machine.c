#include "wired_machine.h"

#include "cm1e/io.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

AXIS_REF_t motor, wheel, line;

cm1e_slave_config_t *add_slave(const char *name, cm1e_sim_slave_kind_t kind, unsigned in, unsigned out)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, name);
    slave->address = (uint16_t)(SLAVE_MOTOR + config.slave_count);
    slave->sim = (cm1e_sim_slave_config_t){.kind = kind, .inputs = (uint8_t)in, .outputs = (uint8_t)out};
    return slave;
}

static void name_input(cm1e_axis_config_t *of, const char *name)
{
    snprintf(of->wiring.inputs[of->wiring.input_count++], CM1E_SIGNAL_LENGTH, "%s", name);
}

static void name_output(cm1e_axis_config_t *of, const char *name)
{
    snprintf(of->wiring.outputs[of->wiring.output_count++], CM1E_SIGNAL_LENGTH, "%s", name);
}

void describe_machine(void)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    config.lost_cycles_limit = LOST_CYCLES;
    describe_up_to(AXES);
    cm1e_axis_config_t *of = &config.axes[MOTOR];
    of->address = SLAVE_MOTOR;
    of->sim.no_stops = of->sim.no_sensors = true;
    for (int n = 1; n <= 4; n++) {
        char name[CM1E_SIGNAL_LENGTH];
        snprintf(name, sizeof name, "switches.input %d", n);
        name_input(of, name);
    }
    name_output(of, "valves.output 1");
    name_output(of, "valves.output 2");
    of->inputs = (cm1e_input_config_t){.home = HOME, .limit_positive = LIMIT_POSITIVE,
                                       .limit_negative = LIMIT_NEGATIVE};
    config.axes[WHEEL].type = CM1E_AXIS_ENCODER;
    config.axes[WHEEL].counts_per_unit = 1000.0;
    config.axes[WHEEL].max_velocity = 200.0; /* 200 counts in a cycle */
    snprintf(config.axes[WHEEL].wiring.encoder, CM1E_SIGNAL_LENGTH, "counter.input 1");
    name_input(&config.axes[WHEEL], "switches.input 5");
    config.axes[LINE].type = CM1E_AXIS_VIRTUAL;
    name_output(&config.axes[LINE], "valves.output 3");
    add_slave("valves", CM1E_SIM_SLAVE_DIGITAL, 0, 4);
    add_slave("switches", CM1E_SIM_SLAVE_DIGITAL, 8, 0);
    add_slave("counts", CM1E_SIM_SLAVE_ANALOG, 0, 1);
    cm1e_slave_config_t *counter = add_slave("counter", CM1E_SIM_SLAVE_ANALOG, 1, 0);
    counter->inputs_pdos[0] = 0x1A01; /* the value alone: 16 bits */
    counter->inputs_pdo_count = 1;
    snprintf(counter->sim.wired_to, sizeof counter->sim.wired_to, "counts");
}

void take_references(void)
{
    motor = cm1e_axis_reference(axes[MOTOR]);
    wheel = cm1e_axis_reference(axes[WHEEL]);
    line = cm1e_axis_reference(axes[LINE]);
}

void begin(void)
{
    describe_machine();
    open_segment();
    take_references();
    cycles(300);
}

void enable_motor(void)
{
    ck_assert_int_eq(cm1e_axis_power(axes[MOTOR], &owner, true, true, true), CM1E_OK);
    cycles(300);
    ck_assert_msg(info_of(MOTOR).state == CM1E_AXIS_STANDSTILL, "%s", text_of(MOTOR));
}

void set_input(int number, bool on)
{
    char words[40];
    snprintf(words, sizeof words, "input %d %d %s", SWITCHES, number, on ? "on" : "off");
    simulate(words);
}

void take_away(unsigned slave, unsigned ms)
{
    char words[40];
    snprintf(words, sizeof words, "power-cycle %u %u", slave, ms);
    simulate(words);
}

void fall_back(unsigned position)
{
    static const uint8_t safe_op[] = {CM1E_AL_SAFE_OP, 0};
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(cm1e_bus_segment(bus), position);
    if (position == SWITCHES)
        ck_assert(cm1e_sim_esc_write(slave, ESC_AL_CONTROL, safe_op, sizeof safe_op));
    else
        cm1e_sim_slave_fall_back(slave, CM1E_AL_SAFE_OP, 0x001B);
}

WORD id_of(cm1e_error_t error) { return cm1e_error_id(error); }

bool sent(const char *name)
{
    cm1e_io_t io;
    ck_assert_msg(cm1e_io_find(bus, name, &io, &diag) == CM1E_OK, "%s", diag.text);
    return cm1e_io_bool(&io);
}

cm1e_command_id_t go(double velocity)
{
    cm1e_command_id_t id;
    const cm1e_axis_command_t c = {.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = velocity};
    ck_assert_msg(cm1e_axis_start(axes[MOTOR], &c, &id) == CM1E_OK, "%s", text_of(MOTOR));
    return id;
}
