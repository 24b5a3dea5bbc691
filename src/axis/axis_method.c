/* What is done with a command, by how it is planned: a row for each command_plan_t. */
#include "axis/axis_coupling.h"

#define BY_PROFILE {cm1e_axis_start_move, cm1e_axis_buffer_move, NULL, cm1e_axis_begin_move, cm1e_axis_update_move}

const command_method_t cm1e_axis_methods[PLAN_COUNT] = {
    /*                     start, buffer, awaits, begin, update */
    [PLAN_TO_TARGET] = BY_PROFILE,
    [PLAN_THROUGH_TARGET] = BY_PROFILE,
    [PLAN_VELOCITY] = BY_PROFILE,
    [PLAN_STOP] = BY_PROFILE,
    [PLAN_KEEP_VELOCITY] = {cm1e_axis_decouple, NULL, NULL, NULL, cm1e_axis_update_move},
    [PLAN_TABLE] = {cm1e_axis_table_start, cm1e_axis_table_buffer, NULL, cm1e_axis_table_begin, NULL},
    [PLAN_HOMING] = {cm1e_axis_start_homing, cm1e_axis_buffer_homing, NULL, cm1e_axis_begin_homing, NULL},
    [PLAN_HOMING_STEP] = {cm1e_axis_start_step, cm1e_axis_buffer_step, NULL, cm1e_axis_begin_step, NULL},
    [PLAN_ON_TOP] = {cm1e_axis_superimpose, NULL, NULL, NULL, cm1e_axis_superimpose_update},
    [PLAN_COUPLING] = {cm1e_axis_couple, cm1e_axis_coupling_buffer, cm1e_axis_coupling_awaits,
                       cm1e_axis_coupling_begin, cm1e_axis_coupling_update},
    [PLAN_PHASING] = {cm1e_axis_phasing, NULL, NULL, NULL, NULL},
};
