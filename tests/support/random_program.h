/**
 * @file random_program.h
 * A program that does anything with all blocks of some axes, and what must hold whatever it does. The test program
 * has the axes and their devices, and defines the functions of the first part.
 */
#ifndef CM1E_TESTS_RANDOM_PROGRAM_H
#define CM1E_TESTS_RANDOM_PROGRAM_H

#include "block_judge.h"
#include "chance.h"
#include "random_group.h"
#include "random_inputs.h"

/* ---- what the test program defines ------------------------------------------------------------------------------- */

/** Inputs, and MC_Power with `powers`. */
void cycle_begin(void);
/** Outputs. */
void cycle_end(void);
/** Faults of this cycle, before it. */
void act_on_device(void);
/** The power stage is on: the motor of the axis judged_at has torque. */
bool has_torque(void);
/** Nobody can tell the drive anything at present. */
bool is_deaf(void);
void judge_motor(void);
/** The time passes in which nothing is sent. */
void time_passes(int64_t time_ns);

/* ---- the program ------------------------------------------------------------------------------------------------- */

extern instance_t instances[INSTANCES_MOST];
extern int count;
extern MC_Power_t powers[JUDGED_MOST];    /**< of the axes; cycle_begin() calls them */
extern int axis_count;
extern AXIS_REF_t named[JUDGED_MOST + 1]; /**< what a block may name as a master; the last one is none */
extern unsigned long long cycles_total, done_total, edges_total, synchronised_total;
extern unsigned seen[CM1E_AXIS_STATE_COUNT];
extern bool stories_touched[JUDGED_MOST]; /**< a block of the axis itself was taken in this cycle */

bool is(const instance_t *fb, const char *name);

/** Any axis that is allowed. */
void random_axis(cm1e_axis_config_t *axis);
void begin_program(void);

double origin(void);

void act_on(instance_t *fb);
void one_cycle(void);

#endif
