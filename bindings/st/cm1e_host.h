/**
 * @file cm1e_host.h
 * What the hosts of the three compilers share: a program that another compiler has made becomes one that `cm1e run` runs.
 * It needs CM1E_AXES, the names of the global variables of type AXIS_REF, which are those of the axes in the bus file:
 *
 *     -D'CM1E_AXES=AXIS(X) AXIS(Y)'
 *
 * CM1E_GROUPS are those of type AXES_GROUP_REF. CM1E_INTERVAL_NS is the cycle of a program whose compiler tells none; 0
 * stands for every cycle of the bus.
 */
#ifndef CM1E_HOST_H
#define CM1E_HOST_H

#include <stdint.h>

#include "cm1e_interface.h"
#include "st_program.h"

#ifndef CM1E_AXES
#error "which axes has the program? -D'CM1E_AXES=AXIS(X) AXIS(Y)'"
#endif
#ifndef CM1E_GROUPS
#define CM1E_GROUPS
#endif
#ifndef CM1E_INTERVAL_NS
#define CM1E_INTERVAL_NS 0
#endif
enum { CM1E_MIDDLE_PRIORITY = 65535 };

#define CM1E_COUNT_ONE(name) +1
#define AXIS(name) CM1E_COUNT_ONE(name)
#define GROUP(name) CM1E_COUNT_ONE(name)
enum { CM1E_AXIS_COUNT = 0 CM1E_AXES, CM1E_GROUP_COUNT = 0 CM1E_GROUPS };
#undef AXIS
#undef GROUP

#define CM1E_ROW(axis) {.name = #axis, .size = sizeof(uint16_t), .kind = ST_KIND_OTHER, .detail = #axis},
#define AXIS(name) CM1E_ROW(name)
#define GROUP(name) CM1E_ROW(name)
/** The references, which get their handles before the program runs. begin() says where they are. */
static st_variable_t cm1e_axes[] = {CM1E_AXES {.name = 0}};
static st_variable_t cm1e_groups[] = {CM1E_GROUPS {.name = 0}};
#undef AXIS
#undef GROUP

static st_fault_t cm1e_fault;     /* these compilers tell none */
static int64_t cm1e_loop_limit;

#ifdef __cplusplus
#define CM1E_HOST_EXPORT extern "C" __attribute__((visibility("default")))
#else
#define CM1E_HOST_EXPORT __attribute__((visibility("default"))) extern
#endif

/** What `cm1e run` looks for. */
#define CM1E_HOST(NAME, BEGIN, TASKS, TASK_COUNT) \
    CM1E_HOST_EXPORT const st_program_t cm1e_st_program; \
    const st_program_t cm1e_st_program = { \
        .version = ST_PROGRAM_VERSION, .interface = CM1E_ST_INTERFACE, .name = NAME, .begin = BEGIN, .tasks = TASKS, \
        .task_count = TASK_COUNT, .axes = {cm1e_axes, CM1E_AXIS_COUNT}, .groups = {cm1e_groups, CM1E_GROUP_COUNT}, \
        .fault = &cm1e_fault, .loop_limit = &cm1e_loop_limit}

#endif
