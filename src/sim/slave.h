/**
 * @file slave.h
 * The seam inside a simulated slave: below it the slave controller (esc_chip.h: datagrams, registers, FMMUs, sync
 * managers, SII, AL state machine, mailbox, CoE server), above it the application (a CM1-E, a bridge, an I/O module).
 * One const table of functions plus a context. Everything runs in the thread that feeds the segment frames.
 */
#ifndef CM1E_SIM_SLAVE_H
#define CM1E_SIM_SLAVE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "device/bridge_facts.h"

/** SDO abort codes (ETG.1000.6 table 41) that the simulator answers with. */
enum {
    SDO_ABORT_TOGGLE = 0x05030000, SDO_ABORT_TIMEOUT = 0x05040000, SDO_ABORT_COMMAND = 0x05040001,
    SDO_ABORT_MEMORY = 0x05040005, SDO_ABORT_UNSUPPORTED_ACCESS = 0x06010000, SDO_ABORT_WRITE_ONLY = 0x06010001,
    SDO_ABORT_READ_ONLY = 0x06010002, SDO_ABORT_SUBINDEX_0_NOT_ZERO = 0x06010003,
    SDO_ABORT_COMPLETE_ACCESS = 0x06010004, SDO_ABORT_NO_OBJECT = 0x06020000, SDO_ABORT_PDO_MAPPING = 0x06040041,
    SDO_ABORT_INCOMPATIBLE = 0x06040043,
    SDO_ABORT_HARDWARE = 0x06060000, SDO_ABORT_TYPE_LENGTH = 0x06070010, SDO_ABORT_TOO_LONG = 0x06070012,
    SDO_ABORT_TOO_SHORT = 0x06070013, SDO_ABORT_NO_SUBINDEX = 0x06090011, SDO_ABORT_RANGE = 0x06090030,
    SDO_ABORT_TOO_HIGH = 0x06090031, SDO_ABORT_TOO_LOW = 0x06090032, SDO_ABORT_GENERAL = 0x08000000,
    SDO_ABORT_LOCAL_CONTROL = 0x08000021, SDO_ABORT_STATE = 0x08000022,
};

/** AL status codes (ETG.1000.6 table 11) that the simulator answers with. */
enum {
    AL_CODE_NONE = 0, AL_CODE_INVALID_STATE_CHANGE = 0x0011, AL_CODE_UNKNOWN_STATE = 0x0012,
    AL_CODE_BOOT_NOT_SUPPORTED = 0x0013, AL_CODE_NO_VALID_FIRMWARE = 0x0014,
    AL_CODE_INVALID_MAILBOX_BOOT = 0x0015,
    AL_CODE_INVALID_MAILBOX_PREOP = 0x0016, AL_CODE_INVALID_SM_CONFIG = 0x0017, AL_CODE_NO_VALID_INPUTS = 0x0018,
    AL_CODE_NO_VALID_OUTPUTS = 0x0019, AL_CODE_SYNC_ERROR = 0x001A, AL_CODE_SM_WATCHDOG = 0x001B,
    AL_CODE_OTHER_MODULES = 0x0070,
    AL_CODE_INVALID_OUTPUT_CONFIG = 0x001D, AL_CODE_INVALID_INPUT_CONFIG = 0x001E,
    AL_CODE_INVALID_WATCHDOG_CONFIG = 0x001F, AL_CODE_FATAL_SYNC = 0x002C, AL_CODE_NO_SYNC = 0x002D,
    AL_CODE_PLL = 0x0032, AL_CODE_SYNC0_CYCLE = 0x0036,
};

/** Error codes of FoE (ETG.1000.6 section 5.8) that the simulator answers with, and other results of a request. */
enum {
    FOE_CODE_NOT_FOUND = 0x8001, FOE_CODE_ACCESS_DENIED = 0x8002, FOE_CODE_DISK_FULL = 0x8003,
    FOE_CODE_ILLEGAL = 0x8004,
    FOE_CODE_PACKET_NUMBER = 0x8005, FOE_CODE_BOOTSTRAP_ONLY = 0x8008, FOE_CODE_INVALID_FIRMWARE = 0x800D,
    FOE_CODE_FILE_INCOMPATIBLE = 0x8012, FOE_RESULT_BUSY = 1, FOE_RESULT_SILENT = 2,
};

struct cm1e_sim_profile;

typedef struct cm1e_sim_app_ops {
    /** Simulated time has reached now_ns; called at least before every frame. Integrates the mechanics. */
    void (*advance)(void *app, int64_t now_ns);
    /** When it has to be advanced next, though nothing arrives: INT64_MIN: it moves, INT64_MAX: it rests, and any time
     *  may pass in one step. NULL: never. */
    int64_t (*due)(const void *app);
    /** A state change asked for and allowed by the controller; 0 to agree, or an AL status code. Also called with to =
     *  from's lower state when the controller falls back by itself. With device emulation (0x0141 bit 0) the
     *  application cannot refuse: the call is a notification, and `to` is what the master wrote. */
    uint16_t (*state_change)(void *app, uint8_t from, uint8_t to);
    /** Sizes of the process data in bytes as the present PDO assignment makes them (checked against SM2/SM3). */
    void (*process_data_sizes)(void *app, uint16_t *output_bytes, uint16_t *input_bytes);
    /** New outputs arrived in SM2 (Operational only). */
    void (*outputs)(void *app, const uint8_t *data, uint16_t size, int64_t now_ns);
    /** Fill SM3 with fresh inputs (Safe-Operational and Operational). */
    void (*inputs)(void *app, uint8_t *data, uint16_t size);
    /** The process data watchdog (0x0420) expired in Operational; the controller then falls back to Safe-Operational.
     *  NULL: the device takes no notice of it (firmware before V1.3.0). */
    void (*watchdog_expired)(void *app);
    /** Object dictionary. Return 0 or an SDO abort code. `size`: in: bytes given or room; out (read): bytes of the
     *  value. `al_state` is the present AL state. */
    uint32_t (*sdo_read)(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, uint8_t *data, size_t *size);
    uint32_t (*sdo_write)(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, const uint8_t *data,
                          size_t size);
    /** Dictionary for SDO information: object number n in order of index, NULL after the last. */
    const cm1e_object_t *(*object)(void *app, size_t n);
    /** Present entry (sub-indices may depend on firmware), NULL: none. */
    const cm1e_entry_t *(*entry)(void *app, uint16_t index, uint8_t subindex);
    /** Value for register 0x0134 when AL control bit 5 asks for it. */
    uint16_t (*explicit_device_id)(void *app);
    /** The alias that the controller has taken from the EEPROM at power-on. NULL: it does not matter. */
    void (*station_alias)(void *app, uint16_t alias);
    /** A file that the master writes: its name, then its bytes from `offset` on. Return 0, an error code of FoE, BUSY
     *  (asked again later) or SILENT. NULL: the device takes no file. */
    uint32_t (*file_begin)(void *app, const char *name, uint32_t password);
    uint32_t (*file_data)(void *app, size_t offset, const uint8_t *data, size_t size, bool last);
    /** A file that the master reads: up to `*size` bytes from `offset` on. Results as above. NULL: there is none. */
    uint32_t (*file_read)(void *app, const char *name, uint32_t password, size_t offset, uint8_t *data, size_t *size);
    bool files_in_operation; /**< files from Pre-Operational on, and no Bootstrap; else in Bootstrap only */
    /** Back to power-on state. */
    void (*power_on)(void *app, int64_t now_ns);
    void (*destroy)(void *app);
    /** Takes over the dictionary of a profile and powers on; after an error nothing has changed. NULL: it cannot. */
    cm1e_error_t (*play)(void *app, const struct cm1e_sim_profile *profile, int64_t now_ns, cm1e_diag_t *diag);
    /** SYNC0 came last at this time; INT64_MAX: there is none, and it runs by its process data. NULL: never called. */
    void (*sync0)(void *app, int64_t at_ns);
    /** It runs by SYNC0 where the master activates that (esc_sync.c); else by its process data. */
    bool runs_by_sync0;
} cm1e_sim_app_ops_t;

typedef struct cm1e_sim_slave cm1e_sim_slave_t;

/** A slave controller (esc_chip.c) with an application on top, started from an SII image (copied). NULL: no memory.
 *  The slave owns `app` and calls its destroy(). */
cm1e_sim_slave_t *cm1e_sim_slave_create(const uint8_t *sii, size_t sii_size, const cm1e_sim_app_ops_t *ops, void *app);
void cm1e_sim_slave_destroy(cm1e_sim_slave_t *slave);
void *cm1e_sim_slave_app(cm1e_sim_slave_t *slave);
/** The table of its creation; it shows the kind of application of cm1e_sim_slave_app(). */
const cm1e_sim_app_ops_t *cm1e_sim_slave_ops(const cm1e_sim_slave_t *slave);

/** For the application: queue a CoE emergency (ETG.1000.6 5.6.4); false: the queue is full and it is dropped. */
bool cm1e_sim_slave_emergency(cm1e_sim_slave_t *slave, uint16_t error_code, uint8_t error_register,
                              const uint8_t data[5]);
/** For the application: fall back to a lower state by itself with an AL status code (error flag set). */
void cm1e_sim_slave_fall_back(cm1e_sim_slave_t *slave, uint8_t al_state, uint16_t al_status_code);
/** For the application: the device resets and is absent from the bus until `until_ns`. */
void cm1e_sim_slave_reset(cm1e_sim_slave_t *slave, int64_t until_ns);
uint8_t cm1e_sim_slave_al_state(const cm1e_sim_slave_t *slave);
/** The code that the device of a profile has in place of this one (profile_answers.c); NULL is allowed. */
uint32_t cm1e_sim_slave_code(const cm1e_sim_slave_t *slave, int kind, uint32_t code);

/** A servo drive by CiA 402 with its mechanical axis; counts and speed are those of the configuration. */
cm1e_sim_slave_t *cm1e_sim_cia402_create(const cm1e_axis_config_t *config, uint16_t alias);
/** The applications: a CM1-E with its mechanical axis; simple devices without mailbox. */
cm1e_sim_slave_t *cm1e_sim_cm1e_create(const cm1e_axis_config_t *config, cm1e_pdo_order_t order, uint16_t alias,
                                       uint8_t rotary_switches);
/** With identity and alias of a slave of the configuration; NULL: its own. */
cm1e_sim_slave_t *cm1e_sim_io_create_as(cm1e_sim_io_t kind, const cm1e_slave_config_t *slave);
static inline cm1e_sim_slave_t *cm1e_sim_io_create(cm1e_sim_io_t kind) { return cm1e_sim_io_create_as(kind, NULL); }
static inline cm1e_sim_slave_t *cm1e_sim_io_module_create(void) { return cm1e_sim_io_create(CM1E_SIM_IO_MODULE); }
/** A Cool MUSCLE Bridge (CM1E_DEVICE_EB01 ... EB12) with its four motors. Of the axis at each connector K37 and `sim`
 *  are played; NULL, one or all of them: the defaults of cm1e/config.h, and K37 = 10. NULL: no bridge, or no memory. */
cm1e_sim_slave_t *cm1e_sim_bridge_create(cm1e_device_model_t model,
                                         const cm1e_axis_config_t *const axes[CM1E_BRIDGE_AXES], uint16_t alias);
/** Identity of the simulated bridge; its guide states none. The vendor is Muscle Corporation in ETG's list, the rest
 *  belongs to the simulator. */
#define CM1E_SIM_BRIDGE_VENDOR_ID 0x0000AA77u
#define CM1E_SIM_BRIDGE_REVISION 0x00010000u
/** 0xEB01, 0xEB02, 0xEB12 */
uint32_t cm1e_sim_bridge_product_code(cm1e_device_model_t model);

#endif
