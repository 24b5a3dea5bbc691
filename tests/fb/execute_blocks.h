/**
 * @file execute_blocks.h
 * The blocks of the Execute type behind one face, on axes without anything behind them. Include it once in a test
 * program.
 */
#ifndef CM1E_TESTS_EXECUTE_BLOCKS_H
#define CM1E_TESTS_EXECUTE_BLOCKS_H

#include <stdio.h>

#include "fake_axis.h"
#include "quick_check.h"

typedef struct outputs {
    BOOL done, busy, active, aborted, error;
    WORD error_id;
} outputs_t;

typedef struct block {
    const char *name;
    cm1e_command_kind_t kind;
    bool has_active, has_aborted, done_is_in_velocity;
    outputs_t (*call)(AXIS_REF_t *axis, BOOL execute);
    void (*clear)(void);
} block_t;

#define BLOCK_FUNCTIONS(TYPE, DONE, ACTIVE, ABORTED) BLOCK_FUNCTIONS_OF(TYPE, Axis, DONE, ACTIVE, ABORTED)
#define BLOCK_FUNCTIONS_OF(TYPE, AXIS, DONE, ACTIVE, ABORTED)                                                          \
    static TYPE##_t instance_##TYPE;                                                                                   \
    static outputs_t call_##TYPE(AXIS_REF_t *axis, BOOL execute)                                                       \
    {                                                                                                                  \
        TYPE##_t *fb = &instance_##TYPE;                                                                               \
        fb->AXIS = axis;                                                                                               \
        fb->Execute = execute;                                                                                         \
        TYPE(fb);                                                                                                      \
        return (outputs_t){DONE, fb->Busy, ACTIVE, ABORTED, fb->Error, fb->ErrorID};                                   \
    }                                                                                                                  \
    static void clear_##TYPE(void) { instance_##TYPE = (TYPE##_t){0}; }

BLOCK_FUNCTIONS(MC_MoveAbsolute, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_MoveRelative, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_MoveAdditive, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_MoveVelocity, fb->InVelocity, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_MoveContinuousAbsolute, fb->InEndVelocity, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_MoveContinuousRelative, fb->InEndVelocity, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_MoveSuperimposed, fb->Done, FALSE, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_HaltSuperimposed, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_Halt, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_Stop, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_Home, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_Reset, fb->Done, FALSE, FALSE)
BLOCK_FUNCTIONS_OF(MC_GearIn, Slave, fb->InGear, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS_OF(MC_GearInPos, Slave, fb->InSync, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS_OF(MC_CamIn, Slave, fb->InSync, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS_OF(MC_CombineAxes, Slave, fb->InSync, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS_OF(MC_GearOut, Slave, fb->Done, FALSE, FALSE)
BLOCK_FUNCTIONS_OF(MC_CamOut, Slave, fb->Done, FALSE, FALSE)
BLOCK_FUNCTIONS_OF(MC_PhasingAbsolute, Slave, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS_OF(MC_PhasingRelative, Slave, fb->Done, fb->Active, fb->CommandAborted)

#define BLOCK(TYPE, KIND, ACTIVE, ABORTED, VELOCITY)                                                                   \
    {#TYPE, KIND, ACTIVE, ABORTED, VELOCITY, call_##TYPE, clear_##TYPE}

static const block_t blocks[] = {
    BLOCK(MC_MoveAbsolute, CM1E_COMMAND_MOVE_ABSOLUTE, true, true, false),
    BLOCK(MC_MoveRelative, CM1E_COMMAND_MOVE_RELATIVE, true, true, false),
    BLOCK(MC_MoveVelocity, CM1E_COMMAND_MOVE_VELOCITY, true, true, true),
    BLOCK(MC_Halt, CM1E_COMMAND_HALT, true, true, false),
    BLOCK(MC_Stop, CM1E_COMMAND_STOP, true, true, false),
    BLOCK(MC_Home, CM1E_COMMAND_HOME, true, true, false),
    BLOCK(MC_Reset, CM1E_COMMAND_KIND_COUNT, false, false, false),
    BLOCK(MC_MoveAdditive, CM1E_COMMAND_MOVE_ADDITIVE, true, true, false),
    BLOCK(MC_MoveContinuousAbsolute, CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, true, true, true),
    BLOCK(MC_MoveContinuousRelative, CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE, true, true, true),
    BLOCK(MC_MoveSuperimposed, CM1E_COMMAND_MOVE_SUPERIMPOSED, false, true, false),
    BLOCK(MC_HaltSuperimposed, CM1E_COMMAND_HALT_SUPERIMPOSED, true, true, false),
    BLOCK(MC_GearIn, CM1E_COMMAND_GEAR_IN, true, true, true),
    BLOCK(MC_GearInPos, CM1E_COMMAND_GEAR_IN_POS, true, true, true),
    BLOCK(MC_CamIn, CM1E_COMMAND_CAM_IN, true, true, true),
    BLOCK(MC_CombineAxes, CM1E_COMMAND_COMBINE_AXES, true, true, true),
    BLOCK(MC_GearOut, CM1E_COMMAND_GEAR_OUT, false, false, false),
    BLOCK(MC_CamOut, CM1E_COMMAND_CAM_OUT, false, false, false),
    BLOCK(MC_PhasingAbsolute, CM1E_COMMAND_PHASING_ABSOLUTE, true, true, false),
    BLOCK(MC_PhasingRelative, CM1E_COMMAND_PHASING_RELATIVE, true, true, false),
};
enum { BLOCKS = sizeof blocks / sizeof blocks[0] };

static AXIS_REF_t x = {1}, y = {2};
static cm1e_axis_t *const axis_x = &fake_axes[0], *const axis_y = &fake_axes[1];

/** What becomes of the last command of an axis. */
static inline void fake_finish(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error)
{
    axis->status[axis->id % FAKE_COMMANDS] = (cm1e_command_status_t){.state = state, .error = error};
    axis->reset_state = state;
    axis->reset_error = error;
}

static inline const block_t *fresh(int n)
{
    fake_reset();
    blocks[n].clear();
    return &blocks[n];
}

/** The outputs as letters: D B A C E, a dot for FALSE. */
static inline const char *letters(outputs_t out)
{
    static char text[8];
    snprintf(text, sizeof text, "%c%c%c%c%c", out.done ? 'D' : '.', out.busy ? 'B' : '.', out.active ? 'A' : '.',
             out.aborted ? 'C' : '.', out.error ? 'E' : '.');
    return text;
}

static inline void expect(const block_t *block, outputs_t out, const char *expected, cm1e_error_t error, int line)
{
    char wanted[8];
    snprintf(wanted, sizeof wanted, "%s", expected);
    if (!block->has_active)
        wanted[2] = '.';
    ck_assert_msg(strcmp(letters(out), wanted) == 0, "%s, line %d: outputs %s, expected %s", block->name, line,
                  letters(out), wanted);
    ck_assert_msg(out.error_id == cm1e_error_id(error), "%s, line %d: ErrorID %#x, expected %#x", block->name, line,
                  out.error_id, cm1e_error_id(error));
}
#define EXPECT(out, expected) expect(block, out, expected, CM1E_OK, __LINE__)
#define EXPECT_ERROR(out, error) expect(block, out, "....E", error, __LINE__)

#define BUSY ".BA.."
#define DONE "D...."
#define ABORTED "...C."
#define NONE "....."

#endif
