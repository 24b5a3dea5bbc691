/**
 * @file machine.h
 * A bus of simulated axes with a scheduler, for tests of the whole stack.
 */
#ifndef CM1E_TESTS_MACHINE_H
#define CM1E_TESTS_MACHINE_H

#include <stdio.h>
#include <string.h>

#include "axes_described.h"
#include "bus/bus_image.h"
#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"
#include "quick_check.h"

enum { MACHINE_AXES = 4 };

typedef struct machine {
    uint32_t axis_count;
    bool real_time;                      /**< FALSE: virtual time */
    int64_t cycle_time_ns;               /**< 0: 1 ms */
    bool ring;                           /**< a second interface behind the last motor */
    bool bridged;                        /**< all axes are CM1 behind one bridge */
    cm1e_axis_type_t types[MACHINE_AXES];
    cm1e_mapping_t mapping;              /**< of all motors */
    double max_jerk;                     /**< u/s3, of all motors; 0: the default */
    double load_inertia;                 /**< kg m2, of all motors; 0: the default */
    cm1e_scheduler_config_t config;
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis[MACHINE_AXES];
} machine_t;

/** An Operational bus and a scheduler; the caller has filled what is above `bus`. */
void machine_open(machine_t *machine);

void machine_add(machine_t *machine, const char *name, int64_t interval_ns, uint32_t priority,
                 cm1e_program_t program, void *context);

void machine_run(machine_t *machine, int64_t duration_ns);

void machine_close(machine_t *machine);

#endif
