#include "machine.h"

void machine_open(machine_t *machine)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    describe_axes(&config, machine->axis_count);
    for (uint32_t i = 0; i < machine->axis_count && machine->bridged; i++) {
        config.axes[i] = (cm1e_axis_config_t){.address = 1, .channel = (uint8_t)(i + 1), .motor = "CM1", .k37 = 10,
                                              .k37_stated = true};
    }
    for (uint32_t i = 0; i < machine->axis_count && !machine->bridged; i++) {
        config.axes[i].mapping = machine->mapping;
        config.axes[i].max_jerk = machine->max_jerk;
        config.axes[i].sim.load_inertia = machine->load_inertia;
    }
    for (uint32_t i = 0; i < machine->axis_count; i++)
        if (machine->types[i] != CM1E_AXIS_MOTOR)
            config.axes[i] = (cm1e_axis_config_t){.type = machine->types[i], .counts_per_unit = 1000};
    strcpy(config.second_interface, machine->ring ? "sim-second" : "");
    config.virtual_time = !machine->real_time;
    config.cycle_time_ns = machine->cycle_time_ns;
    ck_assert_msg(cm1e_bus_open(&machine->bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_start(machine->bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_scheduler_create(&machine->scheduler, machine->bus, &machine->config, &diag) == CM1E_OK, "%s",
                  diag.text);
    for (uint32_t i = 0; i < machine->axis_count; i++) {
        machine->axis[i] = cm1e_scheduler_axis(machine->scheduler, i);
        ck_assert_uint_ne(machine->axis[i].Handle, 0);
    }
}

void machine_add(machine_t *machine, const char *name, int64_t interval_ns, uint32_t priority,
                 cm1e_program_t program, void *context)
{
    cm1e_diag_t diag = {0};
    const cm1e_task_config_t task = {.name = name, .interval_ns = interval_ns, .priority = priority, .program = program,
                                     .context = context};
    ck_assert_msg(cm1e_scheduler_add_task(machine->scheduler, &task, &diag) == CM1E_OK, "%s", diag.text);
}

void machine_run(machine_t *machine, int64_t duration_ns)
{
    cm1e_diag_t diag = {0};
    ck_assert_msg(cm1e_scheduler_run(machine->scheduler, duration_ns, &diag) == CM1E_OK, "%s", diag.text);
}

void machine_close(machine_t *machine)
{
    cm1e_scheduler_destroy(machine->scheduler);
    cm1e_bus_close(machine->bus);
}
