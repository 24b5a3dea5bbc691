/**
 * @file diagram.h
 * Timing diagrams of the function blocks, drawn from real runs: a scenario calls its blocks scan by scan on a simulated
 * motor in virtual time, and every input and output, the state of the axis and its set velocity are recorded and drawn
 * as SVG. The members come from block_table.h, so that a scenario names only what it is about.
 */
#ifndef CM1E_TESTS_DIAGRAM_H
#define CM1E_TESTS_DIAGRAM_H

#include "axis/axis_api.h"
#include "block_table.h"
#include "cm1e/config.h"

/** The one simulated axis of a scenario: 1000 counts a unit, hard stops 10 u to either side. With masters, the axis is
 *  their slave; the masters are enabled, and have no hard stops. */
enum { TRACE_MASTERS = 2 };
typedef struct bench {
    AXIS_REF_t axis, masters[TRACE_MASTERS];
    AXES_GROUP_REF_t group;
    MC_Power_t power, master_power[TRACE_MASTERS];
    cm1e_axis_info_t info;
    int scan; /**< of 1 ms, 0 at the begin of the recording */
} bench_t;
extern bench_t bench;

/** A scenario is a function; this is where its diagram begins. The axis is in Standstill; inputs of the motor can be
 *  switched with simulate(). `about` stands above the diagram. */
void trace_begin(const char *block, const char *about);
/** trace_begin() with the axis in Disabled; the scenario calls MC_Power. */
void trace_begin_disabled(const char *block, const char *about);
/** As trace_begin(), with so many masters. */
void trace_begin_with_masters(const char *block, const char *about, int masters);
/** trace_begin() with an axes group of two axes, X, which is bench.axis, and Y, in GroupStandby. */
void trace_begin_with_group(const char *block, const char *about);
/** trace_begin() without an axis, for blocks that need none. */
void trace_begin_without_axis(const char *block, const char *about);
/** Changes the configuration of the axis of the next scenario, before it begins. */
void trace_configure(void (*configure)(cm1e_axis_config_t *config));
/** Draws all BOOL members of this instance, called `title`; `type` is the name of the block. Those that are FALSE all
 *  the time are left out. The instance must live until trace_end(). */
void trace_block(const char *type, const char *title, const void *fb);
/** Draws one number of an instance as a curve of its own. */
void trace_value(const char *type, const void *fb, const char *member, const char *unit);
/** Draws one BOOL that is no member of a block, as an output. */
void trace_signal(const char *name, const BOOL *signal);
/** Which curves of the axis are drawn; velocity if nothing is said. */
void trace_curves(bool position, bool velocity);
/** trace_curves() of a master, drawn before those of the axis. */
void trace_master_curves(int master, bool position, bool velocity);
/** The scan is over: axis, bus and recording go on by 1 ms. */
void trace_scan(void);
/** Ends the recording and writes the diagram. */
void trace_end(void);

/** A console command of the simulated motor. */
void simulate(const char *line);

/** TRUE from scan `begin` until before scan `end`. */
static inline BOOL during(int begin, int end) { return bench.scan >= begin && bench.scan < end; }

#define AXIS .Axis = &bench.axis
#define MASTER .Axis = &bench.masters[0]
#define GROUP .AxesGroup = &bench.group
#define SLAVE .Slave = &bench.axis
#define MASTER_AND_SLAVE .Master = &bench.masters[0], SLAVE
/** The scans of a scenario: its body is a program. */
#define UNTIL(END) for (; bench.scan < (END); trace_scan())

/** The scenarios of a file, and all of them. */
typedef struct scenario {
    const char *name;
    void (*run)(void);
} scenario_t;
extern const scenario_t motion_scenarios[], multi_axis_scenarios[], group_scenarios[], administrative_scenarios[], homing_scenarios[],
    bridge_scenarios[], standard_scenarios[];

/* ---- the parts that only the recording and the drawing share ---------------------------------------------------- */

enum { TRACE_LANES = 64, TRACE_CURVES = 8, TRACE_SCANS = 20000 };

typedef struct trace_lane {
    const char *name, *title; /**< title: of the instance, at its first lane; NULL: none */
    const BOOL *source;
    bool is_input, ever;
    BOOL values[TRACE_SCANS];
} trace_lane_t;

typedef struct trace_curve {
    char name[48];
    const char *unit;
    const void *source;
    block_type_t type;
    double values[TRACE_SCANS];
} trace_curve_t;

typedef struct trace {
    const char *block, *about;
    bool has_axis;
    int count; /**< scans */
    int lane_count, curve_count;
    trace_lane_t lanes[TRACE_LANES];
    trace_curve_t curves[TRACE_CURVES];
    unsigned char states[TRACE_SCANS];
} trace_t;

/** Draws into <folder>/<block>.svg; FALSE: it could not be written. */
bool trace_draw(const trace_t *trace, const char *folder);

#endif
