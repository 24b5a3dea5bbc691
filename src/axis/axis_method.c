/* What is done with a command, by how it is planned: a row for each command_plan_t that is not
 * one of a room above the axis. */
#include "axis/axis_commands.h"
#include "axis/axis_outside.h"
#include "axis/axis_superimpose.h"
#include "axis/axis_table.h"

#define BY_PROFILE {cm1e_axis_start_move, cm1e_axis_buffer_move, NULL, cm1e_axis_begin_move, cm1e_axis_update_move}

const command_method_t cm1e_axis_methods[PLAN_COUNT] = {
    /*                     start, buffer, awaits, begin, update */
    [PLAN_TO_TARGET] = BY_PROFILE,
    [PLAN_THROUGH_TARGET] = BY_PROFILE,
    [PLAN_VELOCITY] = BY_PROFILE,
    [PLAN_STOP] = BY_PROFILE,
    [PLAN_TABLE] = {cm1e_axis_table_start, cm1e_axis_table_buffer, NULL, cm1e_axis_table_begin, NULL},
    [PLAN_OUTSIDE] = {cm1e_axis_outside_start, NULL, NULL, NULL, NULL},
    [PLAN_ON_TOP] = {cm1e_axis_superimpose, NULL, NULL, NULL, cm1e_axis_superimpose_update},
};
