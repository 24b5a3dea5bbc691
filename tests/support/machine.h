/**
 * @file machine.h
 * A bus of simulated axes with a scheduler, for tests of the whole stack. Include it once in a test program.
 */
#ifndef CM1E_TESTS_MACHINE_H
#define CM1E_TESTS_MACHINE_H

#include <check.h>
#include <stdio.h>
#include <string.h>

#include "axes_described.h"
#include "bus/bus_image.h"
#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"

enum { MACHINE_AXES = 4 };

typedef struct machine {
    uint32_t axis_count;
    bool real_time;                      /**< FALSE: virtual time */
    int64_t cycle_time_ns;               /**< 0: 1 ms */
    bool bridged;                        /**< all axes are CM1 behind one bridge */
    cm1e_axis_type_t types[MACHINE_AXES];
    cm1e_scheduler_config_t config;
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis[MACHINE_AXES];
} machine_t;

/** An Operational bus and a scheduler; the caller has filled what is above `bus`. */
static void machine_open(machine_t *machine)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    describe_axes(&config, machine->axis_count);
    for (uint32_t i = 0; i < machine->axis_count && machine->bridged; i++) {
        config.axes[i] = (cm1e_axis_config_t){.address = 1, .channel = (uint8_t)(i + 1), .motor = "CM1", .k37 = 10,
                                              .k37_stated = true};
    }
    for (uint32_t i = 0; i < machine->axis_count; i++)
        if (machine->types[i] != CM1E_AXIS_MOTOR)
            config.axes[i] = (cm1e_axis_config_t){.type = machine->types[i], .counts_per_unit = 1000};
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

static void machine_add(machine_t *machine, const char *name, int64_t interval_ns, uint32_t priority,
                        cm1e_program_t program, void *context)
{
    cm1e_diag_t diag = {0};
    const cm1e_task_config_t task = {name, interval_ns, priority, program, context};
    ck_assert_msg(cm1e_scheduler_add_task(machine->scheduler, &task, &diag) == CM1E_OK, "%s", diag.text);
}

static void machine_run(machine_t *machine, int64_t duration_ns)
{
    cm1e_diag_t diag = {0};
    ck_assert_msg(cm1e_scheduler_run(machine->scheduler, duration_ns, &diag) == CM1E_OK, "%s", diag.text);
}

static void machine_close(machine_t *machine)
{
    cm1e_scheduler_destroy(machine->scheduler);
    cm1e_bus_close(machine->bus);
}

#endif
