/**
 * @file safety_bench.h
 * A bus of simulated axes, CM1-Es and motors behind bridges, with a witness who believes nobody: every process data
 * frame is decoded by the device's own tables, not by what the bus resolved, and what goes to a drive is judged before
 * the drive gets it. With CM1E_TEST_OVERLAP in the environment, process data are overlapped.
 */
#ifndef CM1E_TESTS_SAFETY_BENCH_H
#define CM1E_TESTS_SAFETY_BENCH_H

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "axis/axis_api.h"
#include "bus/bus_image.h"
#include "chance.h"
#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"
#include "device/unit.h"
#include "nic/nic.h"
#include "quick_check.h"
#include "sim/segment_backend.h"
#include "sim/bridge_app.h"
#include "sim/cm1e_app.h"
#include "sim/esc_chip.h"

enum { BENCH_AXES = 3, BENCH_MOST = 8, LRW = 12, LRW_DATA = 26, SLAVE_WORKING_COUNTER = 3 };

typedef struct bench bench_t;

/* ---- the witness ------------------------------------------------------------------------------------------------- */

/** One axis, as the frames show it. Offsets into the data of the LRW datagram; -1: not mapped. */
typedef struct witness {
    bool bridged;
    int out_controlword, out_position, out_velocity, out_mode;
    int in_statusword, in_position, in_mode;
    double velocity_unit;              /**< counts/s of one unit of 0x60FF */
    double max_step, max_gain, max_loss; /**< counts a cycle, and more or less of it a cycle */
    double peak_step;                    /**< counts a cycle: the motor can do no more */
    double max_lag;                    /**< counts */
    int8_t mode;                       /**< of the set-points */
    bool shown;                        /**< the drive has shown something */
    uint16_t statusword;
    int32_t position, position_before;
    int cycle_shown;                   /**< of `position` */
    double shaft;                      /**< counts a cycle, from the one position to the other */
    int8_t mode_shown;
    bool enabling, holding;            /**< of the last frame sent: controlword bit 3; its set-points count */
    uint16_t controlword;
    int32_t target;
    double step;
    double ramp_step;                  /**< NAN, or `step` if the ramp of a motor that turned when it got its torque has
                                            just begun where the motor is, which was ahead of its target */
    double velocity;                   /**< counts/s that 0x60FF asks for */
    bool silent;                       /**< no answer since `step`: the drive may hold this target or an earlier one */
    double direction;                  /**< the last step that was one */
    bool turning;                      /**< it has changed not long ago */
    int eased_cycles;
    unsigned enablings, set_points, new_beginnings;
} witness_t;

struct bench {
    cm1e_bus_config_t config;
    cm1e_scheduler_config_t scheduler_config;
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    cm1e_sim_segment_t *segment;
    AXIS_REF_t axis[BENCH_MOST];
    witness_t witness[BENCH_MOST];
    int image_bytes, output_bytes, slaves;
    uint8_t last_index;
    uint8_t last_sent[512];
    /** What happens to a process data frame; NULL: nothing. Called before the witness looks at what is sent. */
    cm1e_tap_verdict_t (*fault)(bench_t *bench, cm1e_tap_frame_t *frame);
    /** What the master is told in place of what the witness has seen; NULL: the truth. */
    void (*lie)(bench_t *bench, uint8_t *data);
    void (*started)(bench_t *bench);   /**< before the first cycle; NULL: nothing */
    bool paused;                       /**< the frame that comes now is the first after a pause of the master */
    bool answered;                     /**< the last frame came back in time, with every slave's part in it */
    bool frames_late;                  /**< frames are delayed: what the drive showed may be one frame older */
    void (*program)(bench_t *bench);
    void *context;
    int cycle;
    uint64_t process_frames;           /**< sent */
    char scene[160];                   /**< which run this is, for messages */
};

__attribute__((format(printf, 2, 3), noreturn)) void bench_fail(const bench_t *bench, const char *format, ...);

/* Check's own assertions tell their parent process about every one that holds: too slow for each cycle. */
#define MUST(bench, condition, ...)                                                                                 \
    do {                                                                                                            \
        if (!(condition))                                                                                           \
            bench_fail((bench), __VA_ARGS__);                                                                       \
    } while (0)

const cm1e_firmware_info_t *bench_firmware(const cm1e_axis_config_t *axis);

bool is_bridge(const bench_t *bench, uint32_t position);

uint16_t word_at(const uint8_t *data, int place);

int32_t long_at(const uint8_t *data, int place);

bool is_process_data(const bench_t *bench, const cm1e_tap_frame_t *frame);

cm1e_sim_cm1e_t *bench_drive(const bench_t *bench, uint32_t n);

/** NULL: not behind a bridge. */
cm1e_sim_bridge_axis_t *bench_motor(const bench_t *bench, uint32_t n);

/** Where a motor did not follow, braking or holding may begin anew where it is: such a target pulls at nothing. Nor
 *  does one that stands. A load may turn the shaft faster than the axis may go, and what is shown is a cycle old. */
bool began_anew(const bench_t *bench, uint32_t n, const witness_t *w, double step);

/** Operation enabled in a mode that takes targets (UG 6.1.3; BR 6.1.3, 7.1.3). */
bool takes_targets(const witness_t *w);

cm1e_tap_verdict_t bench_tap(void *context, cm1e_tap_frame_t *frame);

/* ---- the bench --------------------------------------------------------------------------------------------------- */

/** An axis of any firmware since `oldest`, with any mapping, scale and limits. */
void bench_random_axis(cm1e_axis_config_t *axis, cm1e_firmware_t oldest);

/** Axes of 1000 counts a unit with the library's default limits; the caller changes what it wants in bench->config. */
void bench_describe(bench_t *bench, uint32_t axes);

void bench_cycle(void *context);

void bench_open(bench_t *bench);

void bench_start(bench_t *bench);

/** What the shaft does, whatever anybody is told. */
cm1e_sim_probe_t bench_probe(const bench_t *bench, uint32_t n);

void bench_probe_reset(const bench_t *bench, uint32_t n);

cm1e_axis_info_t bench_info(const bench_t *bench, uint32_t n);

__attribute__((format(printf, 2, 3))) void bench_console(bench_t *bench, const char *format, ...);

/** The master sends nothing for so many nanoseconds beyond its cycle: call it in the program of a cycle. */
void bench_miss(bench_t *bench, int64_t silence_ns);

/** Runs until the program stops it. Then no drive is under torque, and every slave that can hear is in Init. */
cm1e_error_t bench_run(bench_t *bench, cm1e_diag_t *diag);

void bench_close(bench_t *bench);

#endif
