/**
 * @file sim.h
 * A simulated EtherCAT segment, library cm1e::sim: slave controllers, the CM1-E or a Cool MUSCLE Bridge on top, motors
 * and mechanics behind them. It serves a program in three ways:
 *
 * 1. Behind a bus of the same process, as the interface "sim" or "sim:<bus file>". A program that CMake links with the
 *    target cm1e::sim need not call anything for that: the simulator registers itself before main(). A program that is
 *    linked in another way calls cm1e_sim_register().
 * 2. On a network interface, for any master: cm1e_sim_server_open().
 * 3. With frames that the program brings itself: cm1e_sim_segment_process().
 *
 * Threads: one thread at a time uses a segment. The one behind a bus belongs to the thread of that bus. Time is passed
 * in, so it may be virtual. The frame path allocates nothing.
 */
#ifndef CM1E_SIM_H
#define CM1E_SIM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/bus.h"
#include "cm1e/config.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Simulated slaves on one wire. */
typedef struct cm1e_sim_segment cm1e_sim_segment_t;

/* ---- behind a bus ------------------------------------------------------------------------------------------------ */

/** Makes the interfaces "sim" and "sim:<bus file>" known to cm1e_bus_open(). Calling it again changes nothing. Not to
 *  be called while another thread opens a bus. @rt init */
CM1E_API void cm1e_sim_register(void);
/** The segment behind a bus; it lives as long as the bus. NULL: the bus is on a network interface. @rt any */
CM1E_API cm1e_sim_segment_t *cm1e_bus_segment(cm1e_bus_t *bus);
/** Executes one console command on the segment behind a bus, for example "power 2 off" ("help" lists all), and writes
 *  the answer to `answer`. Returns CM1E_ERROR_UNSUPPORTED on a network interface. @rt cycle */
CM1E_API cm1e_error_t cm1e_bus_simulate(cm1e_bus_t *bus, const char *line, char *answer, size_t size);

/* ---- a segment of one's own -------------------------------------------------------------------------------------- */

/** The network that a configuration describes: one CM1-E per axis, or one bridge for all axes that have a channel at
 *  the same address, placed by position, alias or explicit ID (aliases and IDs are set in the simulated devices in the
 *  order of the list). NULL and a diagnosis on failure. @rt init */
CM1E_API cm1e_sim_segment_t *cm1e_sim_segment_create(const cm1e_bus_config_t *config, cm1e_diag_t *diag);
/** A segment without slaves. NULL: no memory. @rt init */
CM1E_API cm1e_sim_segment_t *cm1e_sim_segment_create_empty(void);
/** NULL is allowed. @rt init */
CM1E_API void cm1e_sim_segment_destroy(cm1e_sim_segment_t *segment);
/** Adds a Cool MUSCLE Bridge with four motors (CM1E_DEVICE_EB01 ... EB12) behind the last slave. CM1E_ERROR_NO_MEMORY:
 *  nothing was added. @rt init */
CM1E_API cm1e_error_t cm1e_sim_segment_add_bridge(cm1e_sim_segment_t *segment, cm1e_device_model_t model);
/** Adds a simple device behind the last slave. CM1E_ERROR_NO_MEMORY: nothing was added. @rt init */
CM1E_API cm1e_error_t cm1e_sim_segment_add_io(cm1e_sim_segment_t *segment, cm1e_sim_io_t kind);
/** Before the first frame: slave `position` (1 = first) boots from an image of its SII, which may end behind its last
 *  category, in place of the one made from the tables. It takes whatever the image says, alias included, as long as the
 *  device can be that: the same identity, sync managers for the same uses, PDOs of the same content. CM1E_ERROR_FILE:
 *  the image is damaged or of another device, nothing has changed. @rt init */
CM1E_API cm1e_error_t cm1e_sim_segment_boot(cm1e_sim_segment_t *segment, uint32_t position, const uint8_t *image,
                                            size_t size, cm1e_diag_t *diag);

/** One sub-index as a real device has it, for cm1e_sim_segment_play(). */
typedef struct cm1e_sim_profile_entry {
    uint16_t index;
    uint8_t subindex;
    bool missing;             /**< the device has no such entry; the other members do not count */
    bool described;           /**< type, bits and access are valid; necessary where the tables have no such entry */
    uint16_t data_type, bits; /**< CoE data type (ETG.1020) */
    uint16_t access;          /**< cm1e_info_access (sdo_info.h) */
    bool has_default, has_minimum, has_maximum, has_value;
    int64_t default_value, minimum, maximum;
    int64_t value;            /**< from power-on; without it the default */
    char name[64];            /**< "": that of the tables */
    char text[64];            /**< value of a string; "": that of the tables */
} cm1e_sim_profile_entry_t;

/** The kinds of codes that a profile can replace. */
typedef enum cm1e_sim_code_kind {
    CM1E_SIM_CODE_ABORT = 0,  /**< SDO abort code */
    CM1E_SIM_CODE_AL_STATUS,
    CM1E_SIM_CODE_ERROR,      /**< 0x603F */
} cm1e_sim_code_kind_t;

/** A code that the device answers in place of the one that the simulator would. */
typedef struct cm1e_sim_profile_code {
    cm1e_sim_code_kind_t kind;
    uint32_t ours, theirs;
} cm1e_sim_profile_code_t;

/** What a real device is where it is not as the tables say. All zero: nothing differs. */
typedef struct cm1e_sim_profile {
    const cm1e_sim_profile_entry_t *entries; /**< in any order; of two for one sub-index the last one counts */
    size_t entry_count;
    const cm1e_sim_profile_code_t *codes;
    size_t code_count;
    const uint8_t *sii;       /**< image of its EEPROM; NULL: the one made from the tables */
    size_t sii_size;
} cm1e_sim_profile_t;

/** Before the first frame: slave `position` (1 = first), a CM1-E, a bridge or a drive by CiA 402, behaves as the
 *  device of a profile, which is copied. The mappings of a CM1-E and of a drive by CiA 402 are those of its mapping
 *  objects. CM1E_ERROR_UNSUPPORTED: the slave is another device. CM1E_ERROR_STATE: it plays one already.
 *  CM1E_ERROR_FILE: the image is too short, or the type of an entry does not have a number of the profile. After an
 *  error nothing has changed. @rt init */
CM1E_API cm1e_error_t cm1e_sim_segment_play(cm1e_sim_segment_t *segment, uint32_t position,
                                            const cm1e_sim_profile_t *profile, cm1e_diag_t *diag);
/** @rt any */
CM1E_API uint32_t cm1e_sim_segment_slave_count(const cm1e_sim_segment_t *segment);

/** The secondary network interface is connected behind the last slave. @rt init */
CM1E_API void cm1e_sim_segment_close_ring(cm1e_sim_segment_t *segment);
/** Cuts (or mends) the cable before slave `position` (1 = between master and first; count + 1 = the ring's last).
 *  @rt cycle */
CM1E_API void cm1e_sim_segment_cut(cm1e_sim_segment_t *segment, uint32_t position, bool cut);

/** One console line ("help" lists them): acts on the segment and writes an answer without trailing newline. Returns
 *  CM1E_OK, or an error whose reason is the answer. @rt cycle */
CM1E_API cm1e_error_t cm1e_sim_console(cm1e_sim_segment_t *segment, const char *line, char *answer, size_t size);
/** Writes what happened by itself since the last call: a slave fell back to a lower state, and why. No trailing
 *  newline. false: nothing happened, `text` is not changed. @rt cycle */
CM1E_API bool cm1e_sim_segment_news(cm1e_sim_segment_t *segment, char *text, size_t size);

/* ---- on a network interface (`cm1e sim -i`) ---------------------------------------------------------------------- */

/** A segment that answers on a network interface. */
typedef struct cm1e_sim_server cm1e_sim_server_t;

/** File descriptors of a server's console: from which it reads lines, and to which it writes answers and notices of
 *  what happens by itself; -1: none. */
typedef struct cm1e_sim_streams {
    int lines, answers, notices;
} cm1e_sim_streams_t;

/** Takes a network interface, on which frames are answered with `segment`. CM1E_ERROR_STATE: another server has it.
 *  @rt init */
CM1E_API cm1e_error_t cm1e_sim_server_open(cm1e_sim_server_t **server, cm1e_sim_segment_t *segment,
                                           const char *interface_name, cm1e_diag_t *diag);
/** As cm1e_sim_server_open(), for a redundant ring: the second interface is connected behind the last slave. While an
 *  interface has no link, the cable there counts as cut. CM1E_ERROR_INVALID_ARGUMENT: both names are the same.
 *  @rt init */
CM1E_API cm1e_error_t cm1e_sim_server_open_ring(cm1e_sim_server_t **server, cm1e_sim_segment_t *segment,
                                                const char *first, const char *second, cm1e_diag_t *diag);
/** Serves until `*stop` is not 0. If an interface goes down or vanishes, a notice says so, and the server waits for it.
 *
 *  A frame that came from another simulated segment, where the two face each other, would go round for ever. Slave
 *  controllers break that with the circulating bit, where a port has no link. Here a frame that slaves have processed
 *  already (source address 0x02, ETG.1000.4) passes once: it leaves marked as circulated, and one that arrives so is
 *  destroyed. Masters send neither mark. One whose own address has that bit is told apart by its working counters: they
 *  are 0 in a new frame, and not in what a segment gave back. @rt block */
CM1E_API void cm1e_sim_server_run(cm1e_sim_server_t *server, const cm1e_sim_streams_t *console,
                                  const volatile int *stop);
/** NULL is allowed. The segment stays the caller's. @rt init */
CM1E_API void cm1e_sim_server_close(cm1e_sim_server_t *server);

/* ---- with frames of one's own ------------------------------------------------------------------------------------ */

enum { CM1E_SIM_PORT_PRIMARY = 0, CM1E_SIM_PORT_SECONDARY = 1, CM1E_SIM_PORT_LOST = -1 };

/** Sends an Ethernet frame (from destination MAC on, without FCS) through the segment, in place; returns the port at
 *  which it comes out, or CM1E_SIM_PORT_LOST. A line gives it back at the entry port; a closed ring
 *  (cm1e_sim_segment_close_ring()) at the other one. Frames that are not EtherCAT are lost. @rt cycle */
CM1E_API int cm1e_sim_segment_process(cm1e_sim_segment_t *segment, int entry_port, uint8_t *frame, size_t length,
                                      int64_t now_ns);
/** Lets simulated time pass without a frame (watchdogs, mechanics). @rt cycle */
CM1E_API void cm1e_sim_segment_advance(cm1e_sim_segment_t *segment, int64_t now_ns);
/** The time at which cm1e_sim_segment_advance() has to be called next, even if no frame comes. INT64_MIN: at once, a
 *  motor moves. INT64_MAX: never, all is at rest. @rt cycle */
CM1E_API int64_t cm1e_sim_segment_due(const cm1e_sim_segment_t *segment);

/** What the console has set to happen to the next frames. */
typedef enum cm1e_frame_fault {
    CM1E_FRAME_OK = 0, CM1E_FRAME_LOSE, CM1E_FRAME_CORRUPT, CM1E_FRAME_DELAY,
} cm1e_frame_fault_t;
/** What is to happen to the frame that is delivered now; asked once a frame. @rt cycle */
CM1E_API cm1e_frame_fault_t cm1e_sim_segment_next_frame_fault(cm1e_sim_segment_t *segment, int64_t *delay_ns);
/** Sets a fault on the next `count` frames (`delay_ns`: CM1E_FRAME_DELAY only); replaces what was set before.
 *  @rt cycle */
CM1E_API void cm1e_sim_segment_set_frame_fault(cm1e_sim_segment_t *segment, cm1e_frame_fault_t kind, uint32_t count,
                                               int64_t delay_ns);

/* ---- what tests measure behind a drive (NULL-safe; position 1 = first; no motor there: zeros) ------------------- */

/** Rules of the bridge's guide that a master broke. The guide does not say what a bridge does then, so a good master
 *  breaks none; tests check that. */
enum cm1e_sim_broken_rule {
    CM1E_SIM_MODE_TOO_SOON = 0x001,   /**< 0x6060 within 5 ms of the last time (BR 6.2.2, note 2) */
    CM1E_SIM_MODE_IN_MOTION = 0x002,  /**< 0x6060 while the motor moved (note 1) */
    CM1E_SIM_MODE_IN_ERROR = 0x004,   /**< 0x6060 with an error of the motor (BR appendix 3) */
    CM1E_SIM_MODE_NO_WAY = 0x008,     /**< 0x6060 for a mode without a way in BR 6, or the motor has been in CMD or
                                           CPIO and is to follow targets in csp (note 2) */
    CM1E_SIM_QUICK_STOP = 0x010,      /**< "Do not send Quick Stop command" (BR 6.1.1) */
    CM1E_SIM_STEP_AT_START = 0x020,   /**< the target was not the actual position when the motor began to follow it */
    CM1E_SIM_STEP_IN_CYCLE = 0x040,   /**< further from one target to the next than the motor's peak speed carries */
    CM1E_SIM_CML_LINE_BUSY = 0x080,   /**< a string without 0000h for five cycles before it (BR appendix 2) */
    CM1E_SIM_CML_TOO_SOON = 0x100,    /**< a string less than 4 or 8 ms after the last (BR 7.2.2) */
    CM1E_SIM_CML_LINE_END = 0x200,    /**< a string with CR or LF (BR 7.2.2) */
    CM1E_SIM_OUTPUT_IN_VAIN = 0x400,  /**< 0x60FE where it does nothing: not in csp, or no power (BR 6.5) */
    CM1E_SIM_HOMING_TOO_SOON = 0x800, /**< homing within 100 ms of its last setting (BR appendix 4.1) */
};

/** What a simulated motor does, seen from outside of the protocol. */
typedef struct cm1e_sim_probe_t {
    double position_counts;   /**< of the shaft, exact, since the start (homing does not change it); behind a bridge
                                   pulses by the motor's K37 */
    double velocity_counts_per_s;
    double torque_nm;         /**< motor torque */
    bool torque_on;           /**< the output stage is on (Section C, UG 6.1.1); behind a bridge: not motor free */
    uint16_t statusword, controlword;
    uint16_t error_code;      /**< 0x603F; behind a bridge the motor's error as in F530:5 ... 8, 0: none */
    int8_t mode;
    uint16_t digital_inputs, digital_outputs;
    double peak_velocity_counts_per_s; /**< largest absolute value since the last cm1e_sim_probe_reset() */
    double travel_counts;     /**< sum of absolute movement since the last reset */
    unsigned broken_rules;    /**< behind a bridge: cm1e_sim_broken_rule since the last reset */
} cm1e_sim_probe_t;
/** Of a CM1-E. @rt any */
CM1E_API void cm1e_sim_probe(cm1e_sim_segment_t *segment, uint32_t position, cm1e_sim_probe_t *probe);
/** The largest values, sums and broken rules begin anew. @rt any */
CM1E_API void cm1e_sim_probe_reset(cm1e_sim_segment_t *segment, uint32_t position);
/** Of the motor at channel 1 ... 4 of a bridge; channel 0: of a CM1-E. @rt any */
CM1E_API void cm1e_sim_probe_channel(cm1e_sim_segment_t *segment, uint32_t position, unsigned channel,
                                     cm1e_sim_probe_t *probe);
/** cm1e_sim_probe_reset() of one motor. @rt any */
CM1E_API void cm1e_sim_probe_reset_channel(cm1e_sim_segment_t *segment, uint32_t position, unsigned channel);

/* ---- distributed clocks ------------------------------------------------------------------------------------------ */

/** The distributed clock of a slave, as somebody sees it who has the exact time of the simulation. The console lets it
 *  drift, jump or lose its reference ("clock"). */
typedef struct cm1e_sim_clock_t {
    int64_t time_ns;       /**< simulated time of this state */
    int64_t system_ns;     /**< the local copy of the system time then */
    double drift_ppm;      /**< of the crystal now, positive: it is fast */
    uint64_t sync0_pulses, sync1_pulses; /**< since they were activated */
    int64_t next_sync0_ns; /**< system time of the next pulse; 0: none will come */
} cm1e_sim_clock_t;
/** NULL-safe; no such slave, or it is away: zeros. @rt any */
CM1E_API void cm1e_sim_segment_clock(cm1e_sim_segment_t *segment, uint32_t position, cm1e_sim_clock_t *result);

#ifdef __cplusplus
}
#endif
#endif
