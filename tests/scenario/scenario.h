/**
 * @file scenario.h
 * A scenario: a machine, a program of blocks and a list of faults, all from one seed. It is plain data, so it can be
 * written as text, read back, and made smaller. Everything runs on virtual time and repeats exactly.
 *
 * Each number of an axis, a step or a fault is a double, and a table names it (scenario_text.c). 0 is its default and
 * is not written, so the file of a small scenario is small.
 */
#ifndef CM1E_TESTS_SCENARIO_H
#define CM1E_TESTS_SCENARIO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { SCENARIO_AXES = 6, SCENARIO_NETWORKS = 2, SCENARIO_STEPS = 48, SCENARIO_FAULTS = 12 };

typedef enum axis_kind { AXIS_CM1E = 0, AXIS_EB01, AXIS_EB02, AXIS_EB12, AXIS_CIA402, AXIS_VIRTUAL } axis_kind_t;
enum { MAPPING_CSV = 2 };                /* as cm1e_mapping_t has it */

/** One axis of the machine. Lengths in counts of its motor, times in s; the configuration turns them into units. */
typedef struct axis_spec {
    double kind;                         /**< axis_kind_t */
    double network;                      /**< 0 or 1 */
    double channel;                      /**< behind a bridge: 1 ... 4 */
    double firmware, mapping;            /**< of a CM1-E: places in their lists of words */
    double counts_per_unit, invert;
    double velocity, acceleration, deceleration, jerk;
    double limit_negative, limit_positive; /**< software limits; both 0: none */
    double load_inertia, friction;
    double stops;                        /**< 1: hard stops and switches where the simulator has them */
    double coupling_stop;
    double motion;                       /**< 1: the drive computes its motions */
    double optional;                     /**< 1: its slave may come and go; it has an explicit device ID */
    double identified;                   /**< 1: its slave is always there, and has an explicit device ID */
    double modulo;                       /**< its positions run from 0 to below this; 0: linear */
    double done_waits;                   /**< 1: Done waits until the motor is in position */
    double start;                        /**< counts in the direction of the axis that its device shows at its power-on */
    double wired;                        /**< 1: inputs and outputs 11, 12 are those of the first terminal of the machine */
    double switched;                     /**< 1: its limit switches are at inputs 13 and 14 of that terminal */
    double backlash, backlash_velocity;  /**< counts, counts/s */
} axis_spec_t;

/** One command: at cycle `at` a block of this axis gets TRUE at Execute (or Enable), for `hold` cycles. */
typedef struct step {
    double at, axis, master;             /**< axis: 0 = first */
    double block;                        /**< place in scenario_blocks */
    double hold;                         /**< cycles; 0: until the program ends */
    double position, distance, velocity, acceleration, deceleration, jerk;
    double buffer, direction, end_velocity;
    double numerator, denominator;
    double factor, relative, value, mode;
    double x, y, aux_x, aux_y;           /**< of a path */
    double torque;                       /**< % of rated torque */
    double period, points;               /**< of a table over time, or of positions from outside: ms, number */
    double again;                        /**< cycles after which Execute is FALSE for one cycle, again and again; 0: never */
    double update;                       /**< ContinuousUpdate */
    double change, change_after;         /**< lengths and velocities get this times as large after so many cycles; 0: never */
    double parameter;                    /**< ParameterNumber */
    double source;                       /**< MasterValueSource */
    double transition, corner;           /**< TransitionMode and its parameter */
    double scaling, start_distance;      /**< of MC_CamIn: SlaveScaling, MasterStartDistance */
    double allow;                        /**< AllowMotion */
} step_t;

typedef enum fault_kind {
    FAULT_LOSE = 0, FAULT_LOSE_OUT, FAULT_LOSE_BACK, FAULT_CORRUPT, FAULT_DELAY, FAULT_COUNTER, FAULT_STALL,
    FAULT_UNPLUG, FAULT_POWER_CYCLE, FAULT_FALL_BACK, FAULT_MOTOR_POWER, FAULT_ERROR, FAULT_OVER_TORQUE,
    FAULT_TEMPERATURE, FAULT_LOAD, FAULT_JUMP, FAULT_FREEZE, FAULT_RING, FAULT_CLOCK, FAULT_BRIDGE_ERROR,
    FAULT_BRIDGE_CABLE, FAULT_SWITCH, FAULT_EEPROM, FAULT_DETACH, FAULT_STRANGER, FAULT_SWAP, FAULT_EMERGENCY,
    FAULT_INPUT, FAULT_MAILBOX, FAULT_SHOVE, FAULT_KINDS
} fault_kind_t;

/** One fault. What `value` is depends on the kind; see the table in scenario_fault.c. */
typedef struct fault {
    double at, kind, axis, network;
    double length;                       /**< cycles that it lasts; frames that it hits */
    double value;
} fault_t;

typedef struct scenario {
    uint64_t seed;                       /**< where it comes from; 0: written by hand */
    double cycles;                       /**< of the program, before the machine is brought back */
    double cycle_us, lost_limit, ring, clocks, io, overlap;
    double analog;                       /**< channels of an analog terminal behind the others, where there are some; 0: none */
    double memory;                       /**< the allocation that fails in a set-up before the run; 0: none */
    int axis_count, step_count, fault_count;
    axis_spec_t axes[SCENARIO_AXES];
    step_t steps[SCENARIO_STEPS];
    fault_t faults[SCENARIO_FAULTS];
} scenario_t;

/* ---- scenario_random.c ------------------------------------------------------------------------------------------- */

void scenario_make(scenario_t *scenario, uint64_t seed);

/* ---- scenario_varied.c ------------------------------------------------------------------------------------------- */

/** After all draws of scenario_make(): modulo axes, blocks that are triggered again, and much more. */
void scenario_vary(scenario_t *scenario);

/* ---- scenario_beside.c ------------------------------------------------------------------------------------------- */

/** After scenario_vary(): what is read, said and wired beside the motions. */
void scenario_beside(scenario_t *scenario);

/* ---- scenario_plant.c -------------------------------------------------------------------------------------------- */

/** After scenario_beside(): backlash, late mailboxes, limit switches at a terminal, motors that move by themselves. */
void scenario_plant(scenario_t *scenario);

/* ---- scenario_shove.c -------------------------------------------------------------------------------------------- */

/** After scenario_plant(): motors that turn when they get their torque. */
void scenario_shove(scenario_t *scenario);

/* ---- scenario_text.c --------------------------------------------------------------------------------------------- */

extern const char *const fault_names[FAULT_KINDS + 1];
extern const char *const scenario_blocks[];
/** -1: there is none of this name. */
int scenario_block(const char *name);

void scenario_write(const scenario_t *scenario, FILE *file);
/** False: `text` says which line is wrong, and why. */
bool scenario_read(scenario_t *scenario, FILE *file, char *text, size_t size);

/* ---- scenario_run.c ---------------------------------------------------------------------------------------------- */

/** Of the faults of one kind: how long it took until every axis that had to stop was in ErrorStop. */
typedef struct fault_outcome {
    int cycles;                          /**< to detection; -1: nothing had to be detected */
} fault_outcome_t;

/** What lets a shaft be faster than the maximum velocity of its axis (docs/SAFETY.md). */
typedef enum speed_reason {
    SPEED_OF_SERVO = 0,   /**< overshoot of the servo alone */
    SPEED_OF_NETWORK,     /**< targets come late, because the frame of another network was waited for */
    SPEED_AFTER_SILENCE,  /**< lost frames */
    SPEED_OF_LOAD,        /**< lost frames, and a load that the motor cannot stop meanwhile */
    SPEED_IN_RING,        /**< a cable of a ring breaks or is mended */
    SPEED_AFTER_PAUSE,    /**< of the host */
    SPEED_FROM_STOP,      /**< a hard stop held it */
    SPEED_OF_HOMING,      /**< the drive's own, which has its own velocity */
    SPEED_REASONS
} speed_reason_t;

typedef struct outcome {
    bool failed;
    char rule[32];                       /**< which rule was broken: what a smaller scenario must break too */
    char text[400];
    int cycle;
    uint64_t hash;                       /**< of all states, set-points and shafts in all cycles */
    double over_speed[SPEED_REASONS];    /**< largest speed of a shaft over the maximum of its axis */
    double over_tolerance;               /**< the same beyond what the servo does by itself; below 0: never */
    double over_gain;                    /**< largest gain of speed over the maximum, as a share of it */
    int cycles;
    int recoveries;                      /**< axes that were in ErrorStop after the program, and were brought back */
    fault_outcome_t faults[SCENARIO_FAULTS];
} outcome_t;

void scenario_run(const scenario_t *scenario, outcome_t *outcome);
/** As scenario_run(), in a process of its own: a crash, or no end within `limit_s`, is a failure like others. */
void scenario_run_apart(const scenario_t *scenario, outcome_t *outcome, unsigned limit_s);
/** Every cycle is written there; NULL: none. */
extern FILE *scenario_trace;

/* ---- scenario_shrink.c ------------------------------------------------------------------------------------------- */

/** Removes faults, steps and axes and shortens it, as long as the same rule is broken. Returns the number of tries. */
int scenario_shrink(scenario_t *scenario, const outcome_t *failure, unsigned limit_s);

#endif
