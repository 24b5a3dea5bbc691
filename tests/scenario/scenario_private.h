/**
 * @file scenario_private.h
 * A running scenario: the machine, its program and its judge.
 */
#ifndef CM1E_TESTS_SCENARIO_PRIVATE_H
#define CM1E_TESTS_SCENARIO_PRIVATE_H

#include "cm1e/log.h"
#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"
#include "cm1e/sim.h"
#include "scenario.h"
#include "block_table.h"

enum { FIRST_ID = 40 /* explicit device ID of the first axis */, STRANGER_ID = 99, WIRED = 2 /* signals of a terminal */, SWITCHES = 2 /* behind them */,
        MODE_CML = 101, MODE_CMD = 120 /* as a bridge shows them */, BLOCK_ROOM = 2448, SPEEDS = 104, SPEEDS_SEEN = 64 };

#define SERVO_SPEED_COUNTS 300.0 /* counts/s of its overshoot: targets are whole counts */
#define SWITCH_COUNTS 200000.0 /* limit switches at a terminal, before the hard stops at 250,000 */

/** A block of the program, by the table of all blocks. */
typedef struct instance {
    const block_t *type;
    const step_t *step;
    bool triggered, was_busy, was_error, follows;
    int active;                           /**< cycles in a row with Active */
    int edge_at;                          /**< cycle of the last edge */
    double from;                          /**< u; where positions from outside begin */
    union {
        MC_TP_REF positions;
        MC_TV_REF velocities;
        MC_TA_REF accelerations;
        MC_CAMSWITCH_REF switches;
    } data;
    MC_OUTPUT_REF output;
    MC_INPUT_REF input;
    MC_TRIGGER_REF trigger;
    MC_CAM_REF cam;
    MC_CAM_POINT cam_points[3];
    _Alignas(16) unsigned char memory[BLOCK_ROOM];
} instance_t;

/** What an axis looked like in the cycle before, and what the judge knows of it. */
typedef struct witness {
    cm1e_axis_state_t state;
    double speeds[SPEEDS];                    /**< of the last cycles */
    double shaft[3];                          /**< of the last three, counts/s in the direction of its axis */
    double set_velocity;                  /**< counts/s, of the set-point */
    int unmoved;                          /**< cycles since that was another one than 0 */
    double rest_at;                       /**< counts; where it came to rest */
    double load;                          /**< counts in the direction of its axis: what its gear moves */
    bool unseen;                          /**< that moved while nobody saw it */
    bool cut;                             /**< a crossing of the gap, by MC_Power, and the torque has not gone since */
    int heading, turned_at;               /**< its set velocity has this sign under torque, since this cycle */
    bool pressed[SWITCHES];               /**< its limit switches at a terminal */
    int rest_cycles;                      /**< since it is to be at rest, and is */
    bool torque_on;                       /**< in the cycle before */
    int shoved_at;                        /**< cycle */
    bool was_on;                          /**< MC_Power.Status was TRUE then */
    int quiet;                            /**< cycles since something disturbed it */
    int jolted;                           /**< cycles since any network had a bad cycle */
    int caught;                           /**< cycles since it was enabled while its shaft turned, or was lied about */
    int rung;                             /**< cycles since a cable of its ring broke or was mended */
    int stopped;                          /**< cycles since a hard stop held it */
    int stalled;                          /**< cycles since the host stood still */
    int pause;                            /**< cycles of that */
    double runs_to;                       /**< counts, in the direction of its axis: to there it may go on after a pause */
    double runs;                          /**< in this direction: 1 or -1; 0: not */
    double pushed_until;                  /**< cycle until which a load may move it */
    bool kept;                            /**< the device has not lost its position since the start */
    bool coasted;                         /**< beyond a software limit, since it had no torque */
    bool shifted;                         /**< its coordinates are not those of the start any more */
    bool superimposed;                    /**< the program has a motion on top of others for it */
    bool by_itself;                       /**< the program lets its motor search an origin by itself */
    bool by_steps, by_drive;              /**< it homes by itself, or its drive does */
    bool stranger;                        /**< another device is in the place of its slave, */
    int stranger_from;                    /**< since this cycle */
    unsigned excused;                     /**< rules of the bridge's guide that may be broken by now */
    int homing;                           /**< cycles since its drive homed */
    int error_at;                         /**< cycle in which it came into ErrorStop */
    bool fails_off;                       /**< it does in this cycle, from Disabled */
    cm1e_axis_state_t logged;             /**< last state that the log told, */
    bool told;                            /**< and an error since */
    int off_cycles;                       /**< without MC_Power.Enable, or in ErrorStop, and still under torque */
    bool barred;                          /**< its block may have let it go on, or it brakes by itself, in this motion */
    int alone;                            /**< cycles in a state of motion without a block */
    bool enabled, had_torque;    /**< in the cycle before: the drive was told to have torque; it had it */
} witness_t;

typedef struct machine_axis {
    const axis_spec_t *spec;
    int number, network;
    uint32_t position;                    /**< of its slave; 0: virtual */
    unsigned channel;
    char name[16];
    AXIS_REF_t reference;
    cm1e_axis_info_t info;
    cm1e_sim_probe_t probe;
    MC_Power_t power;
    MC_Reset_t reset;
    MC_SetOverride_t override;            /**< after the program: back to 1 */
    MC_MoveRelative_t test;
    double test_from, test_by;            /**< counts; load before the last move, and what that is */
    int resets;                           /**< after the program */
    MC_CamTableSelect_t select;
    MC_CAM_ID cam_id;                     /**< of the cam that was selected last */
    MC_WriteParameter_t restore;          /**< after the program: the limits of the configuration again */
    int restored;                         /**< so many of them */
    MC_CAM_REF cam;
    MC_CAM_POINT cam_points[3];
    MC_AddAxisToGroup_t add;
    MC_ReadStatus_t status;               /**< what blocks show that only read */
    MC_ReadAxisError_t failure;
    MC_ReadMotionState_t motion;
    witness_t seen;
} machine_axis_t;

typedef enum phase {
    PHASE_PROGRAM = 0, PHASE_MEND, PHASE_RESET, PHASE_POWER, PHASE_TEST, PHASE_OFF, PHASE_END
} phase_t;

typedef struct run {
    const scenario_t *scenario;
    outcome_t *outcome;
    cm1e_bus_t *buses[SCENARIO_NETWORKS];
    cm1e_sim_segment_t *segments[SCENARIO_NETWORKS];
    int networks;
    uint32_t fixed_motors[SCENARIO_NETWORKS]; /**< slaves with motors that are not optional */
    cm1e_scheduler_t *scheduler;
    AXES_GROUP_REF_t group;
    bool grouped;                         /**< the program has blocks of a group: of the first two axes */
    MC_GroupEnable_t group_enable;
    MC_UngroupAllAxes_t ungroup;
    MC_GroupReset_t group_reset;
    MC_GroupReadStatus_t group_status;
    MC_GroupReadError_t group_failure;
    int group_alone;                      /**< cycles in GroupMoving without a block */
    machine_axis_t axes[SCENARIO_AXES];
    instance_t blocks[SCENARIO_STEPS];
    int cycle, phase_begin;
    phase_t phase;
    int bad[SCENARIO_NETWORKS];           /**< cycles without a good frame, in a row */
    uint64_t bad_before[SCENARIO_NETWORKS];
    uint64_t logged;
    int64_t logged_ns;
    uint64_t allocations;
} run_t;

/** The first rule that is broken counts; it ends the run. */
__attribute__((format(printf, 3, 4))) void scenario_fail(run_t *run, const char *rule, const char *format, ...);

/* ---- scenario_heap.c --------------------------------------------------------------------------------------------- */

/** Number of allocations of the process so far. */
uint64_t heap_allocations(void);
/** From now on what is allocated is tracked, and allocation number `failing` from here fails. */
void heap_track(uint64_t failing);
/** Whether it did. */
bool heap_failed(void);
/** Ends tracking: how many allocations were not freed. */
int heap_left(void);

/* ---- scenario_machine.c ------------------------------------------------------------------------------------------ */

/** Opens and starts the networks and the scheduler; false: the outcome says why not. */
bool scenario_open(run_t *run, cm1e_program_t program);
void scenario_close(run_t *run);
bool is_motor(const machine_axis_t *axis);

/* ---- scenario_program.c ------------------------------------------------------------------------------------------ */

void program_prepare(run_t *run);
/** One call of each block, by the steps of this cycle. */
void program_cycle(run_t *run);
/** After the program: everything is brought back, and moves once more. */
void program_recover(run_t *run);

/* ---- scenario_fault.c -------------------------------------------------------------------------------------------- */

/** Faults that begin or end in this cycle. */
void fault_cycle(run_t *run);
/** All that is still wrong with the machine is mended. */
void fault_mend(run_t *run);
/** One of the faults until now may be the reason why this axis stops. */
bool fault_explains(const run_t *run, const machine_axis_t *axis, bool of_bus);
/** The mailbox of its slave answers late, or did: a write may be on its way. */
bool fault_slows_mailbox(const run_t *run, const machine_axis_t *axis);
/** The limit switches at a terminal follow their shaft. */
void fault_switches(run_t *run);
/** Something is at this input of the terminal now; one of its inputs has changed within so many cycles. */
bool fault_drives_input(const run_t *run, int number);
bool fault_turns_input(const run_t *run, int cycles);
/** What had to be detected, was, and in time. */
void fault_judge(run_t *run);

/* ---- scenario_wire.c --------------------------------------------------------------------------------------------- */

typedef enum wire_fault { WIRE_OUT = 1, WIRE_BACK = 2, WIRE_COUNTER = 4 } wire_fault_t;

/** What the console of the simulator does not offer; the only source with headers of the library's rooms. */
void wire_attach(run_t *run);
void wire_set(int network, wire_fault_t faults, bool on);
/** The actual position of this axis is the one of its network that may be untrue. */
void wire_watch(run_t *run, const machine_axis_t *axis);
bool wire_watches(const machine_axis_t *axis);
void wire_lie(const machine_axis_t *axis, bool on, bool freeze, double offset);
void wire_forget(void);
void wire_stall(run_t *run, double cycles);
/** A motor without torque turns at this velocity from now on, counts/s. */
void wire_shove(const run_t *run, const machine_axis_t *axis, double velocity);
void wire_fall_back(run_t *run, int network, uint32_t position);

/* ---- scenario_judge.c -------------------------------------------------------------------------------------------- */

void judge_begin(run_t *run);
/** Before the program: what the machine shows now. */
void judge_look(run_t *run);
/** After the program. */
void judge_cycle(run_t *run);
void judge_end(run_t *run);
bool at_rest(const machine_axis_t *axis);
/** A turning shaft was enabled not long ago: the servo catches it, as hard as it can. */
bool is_caught(const run_t *run, const machine_axis_t *axis);

/* ---- scenario_analog.c ------------------------------------------------------------------------------------------- */

/** What the program does with the analog terminal, and what it has to read there. */
void analog_cycle(run_t *run);

/* ---- scenario_judge_load.c --------------------------------------------------------------------------------------- */

/** Counts/s, at which a motor crosses its gear's backlash, on top of its motion. */
double crossing_speed(const axis_spec_t *spec);
/** Counts/s2; it is added to that of the motion, as its speed is. */
double crossing_acceleration(const axis_spec_t *spec);
/** A motor pushes its load with either flank of the gap: at the start with the one of the positive direction. */
void judge_move_load(const run_t *run, machine_axis_t *axis);

/* ---- scenario_judge_enable.c ------------------------------------------------------------------------------------- */

/** Counts/s of the shaft, in the direction of its axis. */
double signed_speed(const machine_axis_t *axis);
/** A motor that turns when it gets its torque is braked from its velocity, while its axis is Disabled still. Where an error
 *  comes in the same cycle, it has the torque for that ramp as for any ramp of ErrorStop (docs/SAFETY.md). */
bool is_braked_first(const machine_axis_t *axis, double velocity);
/** MC_Power.Status is not TRUE before the motor rests. */
void judge_enable(run_t *run, machine_axis_t *axis);
/** Something that is not a motion has happened to it not long ago, and it comes back to its set-point. */
bool was_disturbed(const run_t *run, const witness_t *seen);

/* ---- scenario_judge_blocks.c ------------------------------------------------------------------------------------- */

/** After a call of a block. */
void judge_block(run_t *run, instance_t *block);
/** After all blocks of a cycle. */
void judge_blocks(run_t *run);

/** Two numbers are the same but for rounding, where numbers are as large as `largest`. */
bool close_to(double one, double other, double largest);

/* ---- scenario_judge_bridge.c ------------------------------------------------------------------------------------- */

extern const char *const own_motions[]; /**< strings and commands that may move a motor */
/** In CML or CMD, while its axis is Disabled: a motor of which the program has such commands. */
bool moves_by_itself(const machine_axis_t *axis);
void judge_bridge(run_t *run, machine_axis_t *axis);

/* ---- scenario_judge_reading.c ------------------------------------------------------------------------------------ */

/** After a call of a block that reads. */
void judge_reading(run_t *run, const instance_t *block, const machine_axis_t *axis);

/* ---- scenario_data.c --------------------------------------------------------------------------------------------- */

/** Tables over time and cam switches, from the numbers of the step. */
void data_prepare(const run_t *run, instance_t *block);
/** Position of this cycle for CM_FollowPosition; inputs that change. */
void data_cycle(const run_t *run, instance_t *block);

/* ---- scenario_blocks.c ------------------------------------------------------------------------------------------- */

/** The program has one of these blocks for the axis; NULL ends the list. */
bool program_has(const scenario_t *scenario, int axis, const char *const *blocks);
/** Another program comes. */
void program_forget(void);
extern const char *const step_homings[];  /**< homings in steps, by the axis itself */
extern const char *const table_blocks[];
extern const char *const origin_blocks[]; /**< they give an axis another origin */
extern const char *const limit_blocks[];  /**< they change its limits */

const block_t *block_type(const char *name);
const block_member_t *block_member(const block_t *type, const char *name);
/** `name` is a literal, here and below. */
bool block_flag(const instance_t *block, const char *name);
void block_put(instance_t *block, const char *name, double value);
/** Value of an LREAL; 0: it has none of this name. */
double block_number(const instance_t *block, const char *name);
bool block_is(const instance_t *block, const char *name);
void block_point(instance_t *block, const char *name, const void *what);

#endif
