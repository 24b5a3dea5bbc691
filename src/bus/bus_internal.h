/**
 * @file bus_internal.h
 * The bus from within: its slaves, what runs on each of them, and the functions that its files share.
 */
#ifndef CM1E_BUS_BUS_INTERNAL_H
#define CM1E_BUS_BUS_INTERNAL_H

#include "bus/al_machine.h"
#include "bus/bus_image.h"
#include "bus/coe_client.h"
#include "bus/dc.h"
#include "bus/emergency_ring.h"
#include "bus/errand.h"
#include "bus/foe_job.h"
#include "bus/hot_slave.h"
#include "bus/mapping.h"
#include "bus/overlap.h"
#include "bus/port_watch.h"
#include "bus/recognise.h"
#include "bus/recovery.h"
#include "bus/remote.h"
#include "bus/ring_watch.h"
#include "bus/slave_setup.h"
#include "bus/soem_adapter.h"

enum {
    CM1E_SDO_WAITING_MAX = 64,     /**< transfers that may wait (a power of two) */
    CM1E_DATAGRAMS_PER_CYCLE = 4,  /**< at most, beside the process data and one of supervision */
    CM1E_KIND_LENGTH = 48,
    CM1E_CHANNELS = 1 + CM1E_BRIDGE_AXES, /**< 0: the slave itself is the motor; 1 ... 4: connectors of a bridge */
};

/** Time for one state transition, and for a mailbox answer during start-up (ETG.1020: 200 ms ... 10 s by device). */
#define CM1E_STATE_TIMEOUT_NS INT64_C(3000000000)
#define CM1E_START_SDO_TIMEOUT_NS INT64_C(1000000000)
/** A frame of single datagrams that is not back by then is lost. */
#define CM1E_FRAME_LOST_NS INT64_C(2000000)
/** In operation the port counters of one slave are read in this time, in place of an AL status. */
#define CM1E_PORTS_PACE_NS INT64_C(20000000)
/** In operation one mailbox in this time is looked into for messages that nobody asked for. */
#define CM1E_LISTEN_PACE_NS INT64_C(5000000)
/** Pace of the blocking phases, once no slave has gone on for the first time below, or if a frame was lost within the
 *  second one: what is repeated then must leave a slave time. Otherwise they wait for frames only. */
#define CM1E_PUMP_PERIOD_NS INT64_C(100000)
#define CM1E_PUMP_PATIENCE_NS INT64_C(1000000)
#define CM1E_PUMP_CAREFUL_NS INT64_C(10000000)

/** Process data watchdog of the slaves: 100 ms, the power-on value of a slave controller (ETG.1000.4 table 49), written
 *  so that nothing else can have been left there. The motor is disabled (firmware >= 1.3.0) when no process data came
 *  for so long; shorter would trip on pauses that an ordinary Linux makes. */
enum { CM1E_WATCHDOG_DIVIDER = 2498 /* x 40 ns + 80 ns = 100 us */, CM1E_WATCHDOG_TIME = 1000 /* x 100 us */ };

/** Who waits for the datagram of a slave. */
typedef enum cm1e_datagram_owner {
    OWNER_NONE = 0,
    OWNER_AL,
    OWNER_COE,
    OWNER_RECOVERY,
    OWNER_ERRAND,
    OWNER_FILE,
} cm1e_datagram_owner_t;

typedef struct cm1e_signal_list cm1e_signal_list_t;

struct cm1e_bus_slave {
    /* what every cycle looks at: cm1e_bus_slave_goes_on() */
    uint32_t silent_cycles;                  /**< in a row, in which it did not take part */
    cm1e_slave_watch_t watch;
    cm1e_hot_t hot;
    /* the others */
    cm1e_slave_info_t info;
    const cm1e_slave_config_t *config;       /**< of a slave without an axis that the configuration names; else NULL */
    cm1e_setup_job_t setup;
    cm1e_signal_list_t *signals;             /**< of such a slave, from its configuration on (io_list.h) */
    bool by_pdos;                            /**< its process data are those of `mapped`, not of its SII */
    cm1e_slave_facts_t facts;
    const cm1e_firmware_info_t *firmware;    /**< NULL: unreadable */
    uint16_t axes[CM1E_CHANNELS];            /**< configured axis of each channel, 1 = first; 0: none. No channel is
                                                  beyond: cm1e_bus_config_check() */

    cm1e_datagram_t datagram;                /**< at most one on its way */
    cm1e_datagram_owner_t owner;
    cm1e_al_machine_t al;
    cm1e_coe_client_t coe;
    cm1e_emergency_ring_t emergencies;
    cm1e_recognition_t recognition;
    cm1e_bridge_facts_t bridge;              /**< as the scan found them; of a bridge only */
    cm1e_mapping_job_t mapping;
    cm1e_recovery_t recovery;
    cm1e_sdo_t version_sdo;                  /**< 0x100A, read by the scan */
    char version[64];

    cm1e_mapped_direction_t mapped[2];       /**< 0 outputs, 1 inputs; as configured */
    cm1e_slave_placement_t placement;
    cm1e_dc_config_t pulses;                 /**< as configured, or as its mode has them; all zero: none */
    uint8_t dc_control;                      /**< of register 0x0980, by its mode */
    cm1e_dc_t *dc;                           /**< the clocks of the bus; NULL: they are not used */
    cm1e_port_watch_t ports;
    unsigned unanswered;                     /**< supervision datagrams in a row that nobody answered */
    uint32_t looks;                          /**< those that it answered */
    bool eeprom_owed;                        /**< an errand has ended before its EEPROM was given back */
};

/** Looking into mailboxes in turn, without having asked (listening.c). */
typedef struct cm1e_listening {
    uint32_t place;                          /**< the slave whose mailbox was looked into last */
    int64_t due_ns;
    cm1e_datagram_t datagram;                /**< the look that rides */
    bool asks;                               /**< a look is to be sent in this cycle */
    bool sent;
    bool again;                              /**< the last look was lost */
    bool paused;                             /**< while somebody waits until all slaves are idle */
    uint64_t emergencies;                    /**< heard of all slaves */
} cm1e_listening_t;

/** The one datagram of the supervision. */
typedef struct cm1e_supervised {
    cm1e_datagram_t datagram;
    bool asks;                               /**< it is to be sent in this cycle */
    bool sent;
    uint32_t place;                          /**< of the slave whose AL status was asked for last */
    uint16_t missing;                        /**< position of the last one that was seen to take no part; 0: none yet */
    cm1e_port_turn_t ports;
} cm1e_supervised_t;

/** Transfers handed in by any thread, the cycle's own included: each fills a place; the bus empties it and writes the
 *  rest. */
typedef struct cm1e_sdo_queue {
    uintptr_t ring[CM1E_SDO_WAITING_MAX];    /**< atomic; what they hold: sdo_queue.c */
    uint32_t head, tail;                     /**< head: atomic, the place that is filled next; tail: emptied next */
    uint32_t waiting;                        /**< atomic: submitted and not begun */
    cm1e_sdo_t *list[CM1E_SDO_WAITING_MAX];  /**< taken over, in order */
    unsigned listed;
} cm1e_sdo_queue_t;

typedef enum cm1e_bus_phase {
    BUS_CLOSED = 0, BUS_OPEN, BUS_SCANNED, BUS_IDENTIFIED, BUS_CONFIGURED, BUS_OPERATING,
} cm1e_bus_phase_t;

/** The safe values of outputs (safe_outputs.c), as large as these. */
typedef struct cm1e_safe_outputs {
    uint8_t *values, *mask;                  /**< a bit of the mask: the output takes its safe value */
    uint8_t *claimed;                        /**< bits that the program has found (cm1e/io.h): no guest writes them */
    bool any;                                /**< there is a slave with such outputs */
    bool released;                           /**< the program has ended */
} cm1e_safe_outputs_t;

/** One frame of them, with the slave of each datagram. */
typedef struct cm1e_acyclic_frame {
    cm1e_bundle_t bundle;
    cm1e_bus_slave_t *slaves[CM1E_BUNDLE_DATAGRAMS];
} cm1e_acyclic_frame_t;

/** Acyclic datagrams on their way (acyclic.c). */
typedef struct cm1e_acyclic {
    cm1e_acyclic_frame_t frames[CM1E_FRAMES_IN_FLIGHT]; /**< the first `count` are on their way */
    unsigned count;
    unsigned per_cycle;                      /**< in operation; fewer where the process data leave little time */
    uint32_t next;                           /**< round robin: the slave whose turn it is */
    int64_t progress_ns;                     /**< when a slave was last sent another datagram than the one before */
    int64_t careful_until_ns;                /**< after a lost frame */
    bool rests;                              /**< no slave has work since the last walk over all: cm1e_acyclic_wake() */
} cm1e_acyclic_t;

/** What others want of slaves beside SDO transfers (errand.h, foe_job.h). */
typedef struct cm1e_errands {
    cm1e_errand_t *errand;                   /**< atomic; NULL: none */
    bool sent;                               /**< CoE has the next turn of that slave */
    cm1e_foe_t *file;                        /**< atomic; NULL: none */
    const void *driver;                      /**< atomic; the thread whose scheduler runs the cycles; NULL: none */
    const char *refused;                     /**< atomic; what another thread has called meanwhile to end the bus */
} cm1e_errands_t;

/** Who took no part in the last cycle that came back. */
typedef struct cm1e_silence {
    uint8_t *markers[2];                     /**< by which the marker of each input byte differs from the last inputs */
    unsigned turn;                           /**< which of both the frame has that was sent last */
    bool single_bits;                        /**< a slave has one bit of inputs and no more */
    bool found;                              /**< its slaves were looked at */
    bool any;                                /**< a slave that counts did not take part */
    bool partly_fresh;                       /**< inputs were taken of those who did, despite the working counter */
} cm1e_silence_t;

/** Process images. */
typedef struct cm1e_layout {
    uint32_t made;                           /**< so far */
    uint32_t present;                        /**< number of the present one, from 1; 0: there is none */
} cm1e_layout_t;

struct cm1e_bus {
    cm1e_bus_config_t config;                /**< zeros of the bus itself replaced by their defaults */
    int phase;                               /**< cm1e_bus_phase_t; atomic: cm1e_sdo_submit() looks at it */
    uint32_t operations;                     /**< times that Operational was reached */
    cm1e_nic_t *nic;
    cm1e_soem_t *soem;
    cm1e_clock_t *clock;

    uint32_t slave_count;
    uint32_t scanned;                        /**< of these the scan has found; optional ones that are absent follow */
    uint32_t slave_room;                     /**< there is memory for so many: cm1e_bus_make_room() */
    cm1e_bus_slave_t *slaves;                /**< [0] is the first */
    uint16_t axis_position[CM1E_MAX_AXES];

    cm1e_layout_t layout;
    uint8_t *image;                          /**< what SOEM sends and receives: outputs, then inputs, or overlapped */
    uint8_t *sent;                           /**< outputs, or an overlapped image, as sent: to know the frame again */
    cm1e_overlap_t overlap;
    uint8_t *outputs, *inputs;               /**< what the upper rooms write and read */
    cm1e_safe_outputs_t safe;
    size_t output_bytes, input_bytes;
    int expected_working_counter;

    bool exchanging;                         /**< process data goes with every pump or cycle */
    bool in_flight;                          /**< a process data frame is on its way */
    int64_t next_cycle_ns;                   /**< blocking phases only */
    int64_t sent_ns;                         /**< of the last process data frame */
    uint32_t bad_cycles;                     /**< in a row */
    cm1e_silence_t silence;
    cm1e_error_t last_error;
    cm1e_bus_counters_t counters;

    cm1e_search_t search;                    /**< for slaves that come */
    cm1e_acyclic_t acyclic;
    cm1e_listening_t listening;
    cm1e_supervised_t supervised;
    cm1e_ring_watch_t ring;

    cm1e_sdo_queue_t queue;
    cm1e_errands_t errands;

    cm1e_dc_t dc;                            /**< distributed clocks */

    const cm1e_bus_remote_t *remote;         /**< another program runs the network: there is no nic; NULL: we do */
    void *remote_state;
    char (*remote_texts)[CM1E_PRESENCE_TEXT]; /**< how it stands with each slave, as that program says */
};

/** Refuses a function that was called without a bus. */
static inline cm1e_error_t cm1e_bus_missing(const char *function, cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "%s needs a bus.", function);
}
/** A bus with its configuration and no network yet. */
cm1e_error_t cm1e_bus_make(cm1e_bus_t **bus, const cm1e_bus_config_t *config, cm1e_diag_t *diag);
/** Memory for the slaves that answer, and for all of the configuration that may come later. Slaves that are known are
 *  forgotten where it grows. */
cm1e_error_t cm1e_bus_make_room(cm1e_bus_t *bus, uint32_t answering, cm1e_diag_t *diag);
/** remote.c: the same of a bus that another program runs. The last one refuses; CM1E_OK: the bus is our own. */
cm1e_error_t cm1e_bus_scan_remote(cm1e_bus_t *bus, cm1e_diag_t *diag);
cm1e_error_t cm1e_bus_transfer_remote(cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_sdo_t *sdo,
                                      cm1e_diag_t *diag);
/** An errand of a slave; an error is diagnosed. */
cm1e_error_t cm1e_bus_errand_remote(cm1e_bus_t *bus, cm1e_errand_t *errand, cm1e_diag_t *diag);
cm1e_error_t cm1e_bus_refuse_attached(const cm1e_bus_t *bus, const char *function, cm1e_diag_t *diag);

static inline cm1e_bus_slave_t *cm1e_bus_at(const cm1e_bus_t *bus, uint32_t position)
{
    return bus && position >= 1 && position <= bus->slave_count ? &bus->slaves[position - 1] : NULL;
}
/** NULL: none is configured there. */
static inline const cm1e_axis_config_t *cm1e_bus_axis_of(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave,
                                                         unsigned channel)
{
    return slave->axes[channel] ? &bus->config.axes[slave->axes[channel] - 1] : NULL;
}
/** An axis is configured there. */
static inline bool cm1e_bus_is_used(const cm1e_bus_slave_t *slave)
{
    for (unsigned channel = 0; channel < CM1E_CHANNELS; channel++)
        if (slave->axes[channel])
            return true;
    return false;
}
/** It moves something: it is started and brought back with the care that this needs. */
static inline bool cm1e_bus_has_motors(const cm1e_bus_slave_t *slave)
{
    return slave->info.device && (slave->info.device->extra_is_error || cm1e_bus_is_used(slave));
}

/** It was there at the start, or has come since. */
static inline bool cm1e_bus_was_there(const cm1e_bus_slave_t *slave) { return !slave->hot.planned; }

/** Ordered with the ring of transfers: see cm1e_sdo_submit(). */
static inline void cm1e_bus_set_phase(cm1e_bus_t *bus, cm1e_bus_phase_t phase)
{
    __atomic_store_n(&bus->phase, (int)phase, __ATOMIC_SEQ_CST);
}

/** A diagnosis that ends with what the scan found (identify.c). */
cm1e_error_t cm1e_bus_identity_error(const cm1e_bus_t *bus, cm1e_diag_t *diag, const char *problem);
/** A slave that the configuration expects at an address, and the words for it: `what` "Axis" with this `name`. */
typedef struct cm1e_expected {
    const char *what, *name;
    cm1e_address_kind_t kind;
    uint16_t address;
    bool optional;
    const char *device;
} cm1e_expected_t;
/** The one slave at an address; an optional one is planned if there is none. NULL, diagnosed: none, or several. */
cm1e_bus_slave_t *cm1e_bus_find_expected(cm1e_bus_t *bus, const cm1e_expected_t *expected, cm1e_diag_t *diag);
/** Finds the slaves that the configuration names beside the axes: the optional ones, or the others
 *  (identify_slaves.c). */
cm1e_error_t cm1e_bus_identify_slaves(cm1e_bus_t *bus, bool optional, cm1e_diag_t *diag);
/** configure_slaves.c: writes what the configuration states for them; then reads which process data they have. */
cm1e_error_t cm1e_bus_set_up_slaves(cm1e_bus_t *bus, bool before_op, cm1e_diag_t *diag);
cm1e_error_t cm1e_bus_read_pdos(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Takes what a finished mapping job has found over into its slave. */
cm1e_error_t cm1e_bus_take_mapping(const cm1e_bus_t *bus, cm1e_bus_slave_t *slave, cm1e_diag_t *diag);
/** safe_outputs.c: where safe values go; puts them where they are needed in this cycle. */
cm1e_error_t cm1e_bus_prepare_safe_outputs(cm1e_bus_t *bus, cm1e_diag_t *diag);
void cm1e_bus_make_outputs_safe(cm1e_bus_t *bus);
/** What a setup of the slave writes: for an axis only what its clock needs. */
static inline const cm1e_slave_config_t *cm1e_bus_setup_of(const cm1e_bus_slave_t *slave)
{
    static const cm1e_slave_config_t nothing;
    return slave->config ? slave->config : &nothing;
}
/** The pulses by which its objects of synchronisation are set. */
static inline cm1e_setup_pulses_t cm1e_bus_setup_pulses(const cm1e_bus_slave_t *slave)
{
    if (!slave->facts.coe || slave->pulses.sync0_us == 0)
        return CM1E_SETUP_NO_PULSES;
    return slave->pulses.sync1_us != 0 ? CM1E_SETUP_SYNC1 : CM1E_SETUP_SYNC0;
}
/** Process data watchdog of a slave, in units of 100 us. */
static inline uint16_t cm1e_bus_watchdog(const cm1e_bus_slave_t *slave)
{
    const bool stated = slave->config && slave->config->watchdog_ms;
    return stated ? (uint16_t)(slave->config->watchdog_ms * 10) : CM1E_WATCHDOG_TIME;
}

/** What kind of slave it is: "bridge EB12", else the name in its SII. */
const char *cm1e_bus_kind(const cm1e_bus_slave_t *slave, char kind[CM1E_KIND_LENGTH]);
/** 'slave 2 ("axis2", CM1-E)', 'slave 3 ("X", "Y", bridge EB12)': how a slave is named in every diagnosis; at the begin
 *  of a sentence with a capital. */
const char *cm1e_bus_label(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, char label[CM1E_LABEL_LENGTH]);
const char *cm1e_bus_label_first(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, char label[CM1E_LABEL_LENGTH]);
/** Makes the bus's clock the one SOEM uses in this thread, and tells the time. */
int64_t cm1e_bus_enter(cm1e_bus_t *bus);

/** Hands in transfers to idle CoE clients, sends datagrams of the slaves in need (at most `limit`), as many as
 *  fit into each frame. */
void cm1e_acyclic_send(cm1e_bus_t *bus, int64_t now_ns, unsigned limit);
/** Takes in what is back; waits at most `wait_ns` for each. */
void cm1e_acyclic_receive(cm1e_bus_t *bus, int64_t wait_ns);
/** Keeps the emergency that the CoE client took last, if it is a new one. A datagram brings at most one. */
void cm1e_bus_keep_emergency(cm1e_bus_t *bus, cm1e_bus_slave_t *slave);
/** In operation slaves are passed over once none of them has work. Who gives work to one says so. */
static inline void cm1e_acyclic_wake(cm1e_bus_t *bus) { bus->acyclic.rests = false; }
/** Forgets everything under way. */
void cm1e_acyclic_cancel(cm1e_bus_t *bus);
/** One round of a blocking phase: a cycle when process data is exchanged, else datagrams at the pump's pace. */
void cm1e_bus_pump(cm1e_bus_t *bus);
/** How long the process data are about to be on the wire in a cycle. */
int64_t cm1e_bus_wire_ns(const cm1e_bus_t *bus);
/** Such a cycle without the wait for its end. */
void cm1e_bus_pump_cycle(cm1e_bus_t *bus);
/** Pumps until every slave's AL machine, jobs and CoE client are idle; false: not until `deadline_ns`. */
bool cm1e_bus_pump_until_idle(cm1e_bus_t *bus, int64_t deadline_ns);

/** The SDO queue: begins the next transfer for a slave whose client is idle; ends all that wait. */
void cm1e_sdo_queue_serve(cm1e_bus_t *bus, int64_t now_ns);
void cm1e_sdo_queue_cancel(cm1e_bus_t *bus, cm1e_error_t error);

/** Marks the place of the inputs of slaves in a frame: a slave that takes part in the cycle overwrites all of it. The
 *  marker is made of the inputs that came last, so that no inputs are like it for long, whatever they are. */
void cm1e_bus_mark_inputs(const cm1e_bus_t *bus, uint8_t *place, uint32_t input_offset, size_t bytes);
/** The markers of the next frame are the other ones. */
void cm1e_bus_turn_markers(cm1e_bus_t *bus);
/** Fills in the markers, when the places of all inputs are known. Bits that a slave is not mapped to stay 0. */
void cm1e_bus_make_markers(cm1e_bus_t *bus);
/** Inputs that change may be like their marker in one cycle, if they are few. Others never are. */
enum { CM1E_UNMISTAKABLE_BYTES = 4 };
static inline bool cm1e_bus_is_unmistakable(const cm1e_bus_slave_t *slave)
{
    return slave->placement.input_bytes >= CM1E_UNMISTAKABLE_BYTES;
}
/** Whether a slave left its inputs in the frame that came back as they were sent: it took no part, or it has few inputs
 *  and the working counter has to tell (cycle.c). */
bool cm1e_bus_is_silent(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave);
/** Notes of each slave whether it is silent, once in a cycle. */
void cm1e_bus_find_silence(cm1e_bus_t *bus);
/** Supervision: one slave's AL status in every cycle. It chooses the question before the process data are sent, because
 *  it rides in their frame if that has room, and if the last one came back; else it has a frame of its own. */
void cm1e_supervision_ask(cm1e_bus_t *bus, int64_t now_ns);
void cm1e_supervision_send(cm1e_bus_t *bus, int64_t now_ns);
void cm1e_supervision_receive(cm1e_bus_t *bus, int64_t now_ns);
/** Gives up the question that is on its way. */
void cm1e_supervision_forget(cm1e_bus_t *bus);
/** Notes that a slave is lost. An optional one is then searched for. */
void cm1e_supervision_lose(cm1e_bus_t *bus, cm1e_bus_slave_t *slave);
void cm1e_supervision_note(cm1e_bus_slave_t *slave, uint16_t al_state, uint16_t al_status_code);

/** Looks into mailboxes in turn (listening.c), as the supervision does. A look that finds no room in the frame of the
 *  process data has a frame of its own. One that is lost is repeated. */
void cm1e_listen_ask(cm1e_bus_t *bus, int64_t now_ns);
void cm1e_listen_send(cm1e_bus_t *bus, int64_t now_ns);
void cm1e_listen_receive(cm1e_bus_t *bus, int64_t now_ns);
void cm1e_listen_forget(cm1e_bus_t *bus);

/** Brings all slaves to a state together; the first failure is diagnosed. */
cm1e_error_t cm1e_bus_all_to_state(cm1e_bus_t *bus, uint8_t target, int64_t timeout_ns, cm1e_diag_t *diag);
/** " Another master sends ...", or "" if none was seen; for the end of a diagnosis. */
enum { CM1E_OTHER_MASTER_LENGTH = 160 };
const char *cm1e_bus_other_master(const cm1e_bus_t *bus, char text[CM1E_OTHER_MASTER_LENGTH]);
/** Reads registers of one slave, also of a bus that another program runs (up to CM1E_ERRAND_REGISTERS_END there).
 *  false: it does not answer. Not while our own cycle runs. */
bool cm1e_bus_read_registers(cm1e_bus_t *bus, uint16_t position, uint16_t address, uint8_t *data, uint16_t size);
/** Whether each controller has the FMMUs and sync managers that the mapping uses. */
cm1e_error_t cm1e_bus_check_resources(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** As cm1e_bus_topology(), without its checks. */
cm1e_error_t cm1e_bus_read_topology(cm1e_bus_t *bus, cm1e_slave_place_t *places, size_t room, cm1e_diag_t *diag);
/** Diagnosis of a failed transfer or transition. */
cm1e_error_t cm1e_bus_diagnose_sdo(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, const cm1e_sdo_t *sdo,
                                   const char *purpose, cm1e_diag_t *diag);
cm1e_error_t cm1e_bus_diagnose_state(cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_diag_t *diag);
/** Frees the process image. */
void cm1e_bus_free_image(cm1e_bus_t *bus);

#endif
