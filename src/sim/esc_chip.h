/**
 * @file esc_chip.h
 * The simulated EtherCAT slave controller (ESC), private to this room: one struct, worked on by one source per unit of
 * the real chip. Registers follow the Beckhoff ESC register description, states ETG.1000.6. Time comes in with every
 * call; nothing here allocates after cm1e_sim_slave_create().
 */
#ifndef CM1E_SIM_ESC_CHIP_H
#define CM1E_SIM_ESC_CHIP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/sim.h"
#include "sim/coe_server.h"
#include "sim/quirks.h"
#include "sim/esc_clock.h"
#include "sim/foe_server.h"
#include "sim/mailbox.h"
#include "sim/slave.h"

/* Register addresses. */
enum {
    ESC_TYPE = 0x0000, ESC_FMMU_COUNT = 0x0004, ESC_SM_COUNT = 0x0005, ESC_RAM_SIZE = 0x0006,
    ESC_PORT_DESCRIPTOR = 0x0007, ESC_FEATURES = 0x0008, ESC_STATION_ADDRESS = 0x0010, ESC_STATION_ALIAS = 0x0012,
    ESC_DL_CONTROL = 0x0100, ESC_DL_PORTS = 0x0101, ESC_DL_ALIAS = 0x0103, ESC_DL_STATUS = 0x0110,
    ESC_AL_CONTROL = 0x0120, ESC_AL_STATUS = 0x0130, ESC_AL_STATUS_CODE = 0x0134, ESC_PDI_CONTROL = 0x0140,
    ESC_EVENT_MASK = 0x0200, ESC_EVENT_REQUEST = 0x0210, ESC_RX_ERRORS = 0x0300, ESC_UNIT_ERRORS = 0x030C,
    ESC_LOST_LINKS = 0x0310, ESC_WATCHDOG_DIVIDER = 0x0400, ESC_WATCHDOG_PDI = 0x0410, ESC_WATCHDOG_DATA = 0x0420,
    ESC_WATCHDOG_STATUS = 0x0440, ESC_WATCHDOG_COUNTERS = 0x0442, ESC_SII_CONFIG = 0x0500, ESC_SII_PDI_ACCESS = 0x0501,
    ESC_SII_CONTROL = 0x0502, ESC_SII_ADDRESS = 0x0504, ESC_SII_DATA = 0x0508, ESC_FMMU = 0x0600, ESC_SM = 0x0800,
    ESC_DC_PORT_TIMES = 0x0900, ESC_DC_SYSTEM_TIME = 0x0910, ESC_DC_UNIT_TIME = 0x0918, ESC_DC_OFFSET = 0x0920,
    ESC_DC_DELAY = 0x0928, ESC_DC_DIFFERENCE = 0x092C, ESC_DC_SPEED_START = 0x0930, ESC_DC_SPEED_DIFF = 0x0932,
    ESC_DC_DEPTH = 0x0934, ESC_DC_SPEED_DEPTH = 0x0935, ESC_DC_CYCLIC_CONTROL = 0x0980, ESC_DC_ACTIVATION = 0x0981,
    ESC_DC_ACTIVATION_STATUS = 0x0984, ESC_DC_START = 0x0990, ESC_DC_NEXT_SYNC1 = 0x0998, ESC_DC_CYCLE_0 = 0x09A0,
    ESC_DC_CYCLE_1 = 0x09A4, ESC_DC_END = 0x0A00,
};

/* ECAT event request bits (0x0210). */
enum { ESC_EVENT_DL_STATUS = 0x0004, ESC_EVENT_AL_STATUS = 0x0008, ESC_EVENT_SM0 = 0x0010 };

enum {
    ESC_REGISTER_BYTES = 0x1000, /**< below: registers, from here: process data RAM */
    ESC_MEMORY_BYTES = 0x3000,
    ESC_FMMUS = 8,
    ESC_SYNC_MANAGERS = 4,
};

/** What a sync manager is for (SII category 41, ETG.1000.6). */
enum { ESC_ROLE_NONE = 0, ESC_ROLE_MAILBOX_OUT, ESC_ROLE_MAILBOX_IN, ESC_ROLE_OUTPUTS, ESC_ROLE_INPUTS, ESC_ROLES };

#define ESC_NEVER INT64_MAX
/** Delay of a frame from one slave to the next: processing and cable. */
#define ESC_HOP_NS 700

/** One active FMMU in one direction, decoded. */
typedef struct esc_fmmu {
    uint32_t start;      /**< logical byte address */
    uint32_t end;        /**< one behind the last logical byte */
    uint16_t physical;
    uint8_t start_bit, end_bit, physical_bit;
    bool bytewise;       /**< whole bytes to whole bytes */
} esc_fmmu_t;

typedef struct esc_fmmu_list {
    esc_fmmu_t entries[ESC_FMMUS];
    unsigned count;
    uint32_t start, end; /**< everything lies in between */
} esc_fmmu_list_t;

typedef struct esc_sync_manager {
    uint16_t start, length;
    uint8_t number;
    bool active;         /**< enabled by the master */
    bool locked;         /**< disabled by the slave: the area is not accessible */
    bool mailbox;        /**< one buffer with handshake, else three buffers */
    bool master_writes;
    bool triggers_watchdog;
    bool open;           /**< the first byte was accessed, the last not yet */
    bool full;           /**< mailbox holds data */
    uint8_t role;
} esc_sync_manager_t;

struct cm1e_sim_slave {
    uint8_t memory[ESC_MEMORY_BYTES];
    esc_fmmu_list_t reads, writes;
    esc_sync_manager_t managers[ESC_SYNC_MANAGERS];
    uint8_t role_manager[ESC_ROLES]; /**< number of the sync manager of a role; ESC_SYNC_MANAGERS: none */

    const cm1e_sim_app_ops_t *ops;
    void *app;

    int64_t now_ns;        /**< last time given */
    int64_t powered_on_ns;
    bool detached;           /**< pulled out: its neighbours are connected to each other */
    bool attaching;          /**< put in again when it has its power */
    int64_t absent_until_ns; /**< off the bus until then; 0: present */
    bool *topology_changed;  /**< of the segment */
    bool *segment_fell_back;

    /* the frame that passes */
    int64_t frame_ns;         /**< when its first bit arrived at this slave */
    const int64_t *returns_ns; /**< of that frame: so long after it, it comes back into each port; -1: it does not */
    bool inputs_stale;        /**< the inputs in the RAM are older than now_ns */
    bool outputs_arrived;
    esc_clock_t clock;

    /* AL state machine */
    uint8_t al_state;
    bool al_error, al_id;
    bool changing_state;       /**< the application is being asked */
    bool fell_back;            /**< by itself, since somebody asked */
    uint16_t al_request;
    int64_t al_due_ns;         /**< when the request is decided */

    int64_t watchdog_due_ns;   /**< when the process data watchdog expires */

    /* SII */
    uint8_t *sii;
    size_t sii_size;
    bool sii_valid;
    bool sii_reads_8_bytes;
    int64_t sii_due_ns;        /**< when the running command ends */

    int64_t mailbox_due_ns;    /**< when the mailbox needs attention */
    mailbox_t mailbox;
    coe_server_t coe;
    foe_server_t foe;
    cm1e_sim_quirks_t quirks;   /**< kept without power */
    cm1e_sim_profile_t profile; /**< played; all of it is the slave's own */
};

/* esc_chip.c: life, memory as the master sees it */
void cm1e_sim_esc_power_on(cm1e_sim_slave_t *slave, int64_t now_ns);
/** Lets time pass: everything that is due happens, then the application moves on. */
void cm1e_sim_esc_advance(cm1e_sim_slave_t *slave, int64_t now_ns);
/** When it has to be advanced next, though nothing arrives; ESC_NEVER: not at all. */
int64_t cm1e_sim_esc_due(const cm1e_sim_slave_t *slave);
/** Reads or writes as a datagram does; true if at least one byte was accessed, which is what counts for the working
 *  counter. Bytes that cannot be read are left alone. */
bool cm1e_sim_esc_read(cm1e_sim_slave_t *slave, uint32_t address, uint8_t *data, size_t length);
bool cm1e_sim_esc_write(cm1e_sim_slave_t *slave, uint32_t address, const uint8_t *data, size_t length);
static inline bool cm1e_sim_esc_present(const cm1e_sim_slave_t *slave) { return slave->absent_until_ns == 0; }

/* esc_frame.c: the datagrams of a frame */
/** Passes all datagrams between `begin` and `end` (checked by the segment) by the slave. */
void cm1e_sim_esc_frame(cm1e_sim_slave_t *slave, uint8_t *begin, const uint8_t *end);

/* esc_registers.c */
void cm1e_sim_esc_registers_power_on(cm1e_sim_slave_t *slave);
bool cm1e_sim_esc_registers_read(cm1e_sim_slave_t *slave, uint16_t address, uint8_t *data, size_t length);
bool cm1e_sim_esc_registers_write(cm1e_sim_slave_t *slave, uint16_t address, const uint8_t *data, size_t length);

/* esc_events.c */
void cm1e_sim_esc_event(cm1e_sim_slave_t *slave, uint16_t bits, bool on);
/** Links of the ports: the neighbour is there, and the port is open. */
void cm1e_sim_esc_links(cm1e_sim_slave_t *slave, const bool link[4], const bool open[4]);
/** Adds one to an 8-bit error counter, which stops at 255. */
void cm1e_sim_esc_count(cm1e_sim_slave_t *slave, uint16_t address);

/* esc_fmmu.c */
void cm1e_sim_esc_fmmu_decode(cm1e_sim_slave_t *slave);

/* esc_logical.c */
bool cm1e_sim_esc_logical_read(cm1e_sim_slave_t *slave, uint32_t address, uint8_t *data, uint16_t length);
bool cm1e_sim_esc_logical_write(cm1e_sim_slave_t *slave, uint32_t address, const uint8_t *data, uint16_t length);

/* esc_sync_manager.c */
/** Decodes the registers of a sync manager after they were written; switching it on or off empties its buffers. */
void cm1e_sim_esc_sm_decode(cm1e_sim_slave_t *slave, unsigned number);
/** Locks or unlocks the sync manager of a role from the slave's side (0x0807 bit 0). */
void cm1e_sim_esc_sm_lock(cm1e_sim_slave_t *slave, unsigned role, bool locked);
/** NULL: the slave has none. */
esc_sync_manager_t *cm1e_sim_esc_sm(cm1e_sim_slave_t *slave, unsigned role);
/** The number of bytes from `address` on that the same rule holds for, and the sync manager that rules (NULL: none). */
size_t cm1e_sim_esc_sm_span(cm1e_sim_slave_t *slave, uint32_t address, uint32_t end, esc_sync_manager_t **manager);
/** A complete buffer was written from either side: the three take turns. */
void cm1e_sim_esc_sm_next_buffer(cm1e_sim_slave_t *slave, const esc_sync_manager_t *sm);
/** Shows in the status that a complete buffer was written or read. */
void cm1e_sim_esc_sm_accessed(cm1e_sim_slave_t *slave, const esc_sync_manager_t *sm, bool written);
/** The slave's side of a mailbox: fills or empties it. */
void cm1e_sim_esc_sm_set_full(cm1e_sim_slave_t *slave, esc_sync_manager_t *sm, bool full);
/** Both mailboxes are there and set as Pre-Operational demands. */
bool cm1e_sim_esc_mailboxes_valid(cm1e_sim_slave_t *slave);
/** The sync manager of outputs or inputs carries this many bytes, as Safe-Operational demands. */
bool cm1e_sim_esc_process_data_valid(cm1e_sim_slave_t *slave, unsigned role, uint16_t bytes);

/* esc_buffer.c */
bool cm1e_sim_esc_sm_read(cm1e_sim_slave_t *slave, esc_sync_manager_t *sm, uint16_t offset, uint8_t *data,
                          size_t length);
bool cm1e_sim_esc_sm_write(cm1e_sim_slave_t *slave, esc_sync_manager_t *sm, uint16_t offset, const uint8_t *data,
                           size_t length);
/** Hands outputs that arrived in this frame to the application. */
void cm1e_sim_esc_deliver_outputs(cm1e_sim_slave_t *slave);

/* esc_sii.c */
void cm1e_sim_esc_sii_power_on(cm1e_sim_slave_t *slave);
bool cm1e_sim_esc_sii_writable(const cm1e_sim_slave_t *slave);
void cm1e_sim_esc_sii_command(cm1e_sim_slave_t *slave);
void cm1e_sim_esc_sii_config(cm1e_sim_slave_t *slave);
void cm1e_sim_esc_sii_due(cm1e_sim_slave_t *slave);
/** A byte address in the SII image where the category starts (behind its header) and its bytes; 0: none. */
size_t cm1e_sim_esc_sii_category(const cm1e_sim_slave_t *slave, uint16_t type, size_t *bytes);

/* profile_answers.c: the device that is played */
/** It has no such entry, whatever the application says. */
bool cm1e_sim_profile_hides(const cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex);
void cm1e_sim_profile_free(cm1e_sim_profile_t *profile);

/* esc_dc.c: distributed clocks */
void cm1e_sim_esc_dc_power_on(cm1e_sim_slave_t *slave, int64_t now_ns);
/** Lets the clock run, and gives the pulses that are due. */
void cm1e_sim_esc_dc_advance(cm1e_sim_slave_t *slave, int64_t now_ns);
/** A frame arrives, and comes back into each port after so long (four times); -1: it does not. They stay the
 *  caller's until it has been processed. */
void cm1e_sim_esc_dc_frame(cm1e_sim_slave_t *slave, int64_t frame_ns, const int64_t *returns_ns);
void cm1e_sim_esc_dc_latch(cm1e_sim_slave_t *slave);
void cm1e_sim_esc_dc_refresh(cm1e_sim_slave_t *slave);
/** 0x0910, 0x0930 and 0x0981 were written. */
void cm1e_sim_esc_dc_received(cm1e_sim_slave_t *slave, const uint8_t *data);
void cm1e_sim_esc_dc_restart(cm1e_sim_slave_t *slave);
void cm1e_sim_esc_dc_activated(cm1e_sim_slave_t *slave);
/** The state of the clock, for a slave that is there. */
void cm1e_sim_esc_clock(const cm1e_sim_slave_t *slave, cm1e_sim_clock_t *clock);

/* esc_sync.c: a device that runs by SYNC0 */
/** 0, or the AL status code why the state `to` is refused. */
uint16_t cm1e_sim_esc_sync_check(const cm1e_sim_slave_t *slave, uint8_t to);
/** In Operational: it falls back where pulses, process data or the reference clock stay away. */
void cm1e_sim_esc_sync_supervise(cm1e_sim_slave_t *slave);

/* al_state.c */
void cm1e_sim_al_power_on(cm1e_sim_slave_t *slave);
/** The master wrote AL control. */
void cm1e_sim_al_control(cm1e_sim_slave_t *slave);
void cm1e_sim_al_due(cm1e_sim_slave_t *slave);

/* al_watchdog.c */
void cm1e_sim_al_watchdog_trigger(cm1e_sim_slave_t *slave);
void cm1e_sim_al_watchdog_due(cm1e_sim_slave_t *slave);
/** Divider or time were written. */
void cm1e_sim_al_watchdog_changed(cm1e_sim_slave_t *slave);

#endif
