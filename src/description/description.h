/**
 * @file description.h
 * The description of a device that all file formats share: identity, mailbox, sync managers, FMMUs, PDOs, object
 * dictionary, start-up commands, modules. It is made from the tables of src/device (describe.h), from a file (ESI, SII,
 * ENI), or from a live device. It is checked (check.h), compared (compare.h) and written independent of its origin.
 * Everything that a description points to is in its arena. Not thread safe; nothing here is for the cycle.
 */
#ifndef CM1E_DESCRIPTION_DESCRIPTION_H
#define CM1E_DESCRIPTION_DESCRIPTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "description/arena.h"
#include "device/device.h"

/** Place of an item in its file: the line, 1 = first; in an SII image the byte address. 0: not from a file. */
typedef uint32_t cm1e_place_t;

/** Raw bytes, little endian where they are a number. `data` NULL: not given. */
typedef struct cm1e_bytes {
    const uint8_t *data;
    size_t size;
} cm1e_bytes_t;

/* ---- object dictionary ------------------------------------------------------------------------------------------ */

/** One sub-index as the dictionary of a file or of a device has it. */
typedef struct cm1e_described_entry {
    cm1e_place_t place;
    uint8_t subindex;
    const char *name;
    const char *type;        /**< base type as ETG.2000 and ETG.1020 spell it: "UINT", "STRING(5)"; "" unknown */
    uint32_t bits;
    uint8_t access;          /**< cm1e_access_flags (device.h) */
    const char *unit;        /**< "" none; ESI: shown in the comment */
    const char *comment;     /**< NULL: none */
    cm1e_bytes_t default_data, minimum, maximum;
} cm1e_described_entry_t;

typedef struct cm1e_described_object {
    cm1e_place_t place;
    uint16_t index;          /**< of a module: as written, before the slot's increment is added */
    bool depends_on_slot;
    uint8_t code;            /**< cm1e_object_code; 0 unknown */
    const char *name;
    const char *type;        /**< as the file names it: "DT1018"; "" where there is no such name */
    uint32_t bits;           /**< as the file states it for the whole object; 0: not stated */
    const char *comment;     /**< NULL: none */
    CM1E_LIST(cm1e_described_entry_t) entries; /**< in the file's order; arrays are resolved to their elements */
} cm1e_described_object_t;

/** A member of a type definition (ESI: DataType/SubItem). */
typedef struct cm1e_type_item {
    cm1e_place_t place;
    bool has_subindex;       /**< false: the elements of an array */
    uint8_t subindex;
    const char *name, *type;
    int64_t bits, offset;    /**< as the file states them */
    uint8_t access;          /**< cm1e_access_flags */
} cm1e_type_item_t;

/** A type definition as an ESI writes it; descriptions from other sources have none. */
typedef struct cm1e_type_definition {
    cm1e_place_t place;
    const char *name;        /**< "UINT", "DT1018", "DT6099ARR" */
    const char *base_type;   /**< NULL: none */
    int64_t bits;
    bool is_array;
    int64_t lower_bound, elements; /**< of an array */
    CM1E_LIST(cm1e_type_item_t) items;
} cm1e_type_definition_t;

typedef CM1E_LIST(cm1e_described_object_t) cm1e_object_list_t;
typedef CM1E_LIST(cm1e_type_definition_t) cm1e_type_list_t;

/* ---- process data ----------------------------------------------------------------------------------------------- */

typedef struct cm1e_described_pdo_entry {
    cm1e_place_t place;
    uint16_t index;          /**< 0: a gap */
    uint8_t subindex;
    bool depends_on_slot;
    uint32_t bits;
    const char *name;        /**< NULL: none */
    const char *type;        /**< base type; "" where there is none */
    const char *comment;     /**< NULL: none */
} cm1e_described_pdo_entry_t;

typedef struct cm1e_exclude {
    cm1e_place_t place;
    uint16_t index;
    bool depends_on_slot;
} cm1e_exclude_t;

#define CM1E_NO_SYNC_MANAGER (-1)

typedef struct cm1e_described_pdo {
    cm1e_place_t place;
    bool transmit;           /**< TxPDO: from the device to the master */
    uint16_t index;
    bool depends_on_slot;
    const char *name;        /**< "" none */
    int sync_manager;        /**< that carries it by default; CM1E_NO_SYNC_MANAGER: none */
    bool fixed, mandatory, is_virtual;
    CM1E_LIST(cm1e_exclude_t) excludes;
    CM1E_LIST(cm1e_described_pdo_entry_t) entries;
} cm1e_described_pdo_t;

typedef CM1E_LIST(cm1e_described_pdo_t) cm1e_pdo_list_t;

/* ---- communication ---------------------------------------------------------------------------------------------- */

typedef enum cm1e_sync_manager_use {
    CM1E_SM_UNUSED = 0, CM1E_SM_MAILBOX_OUT, CM1E_SM_MAILBOX_IN, CM1E_SM_OUTPUTS, CM1E_SM_INPUTS, /* as in 0x1C00 */
} cm1e_sync_manager_use_t;

static inline bool cm1e_sync_manager_is_mailbox(cm1e_sync_manager_use_t use)
{
    return use == CM1E_SM_MAILBOX_OUT || use == CM1E_SM_MAILBOX_IN;
}
/** Whether the master writes it. */
static inline bool cm1e_sync_manager_is_written(cm1e_sync_manager_use_t use)
{
    return use == CM1E_SM_MAILBOX_OUT || use == CM1E_SM_OUTPUTS;
}

typedef struct cm1e_described_sync_manager {
    cm1e_place_t place;
    cm1e_sync_manager_use_t use;
    uint16_t start;
    uint16_t length;         /**< default size in bytes */
    bool length_given;
    uint16_t minimum_length, maximum_length; /**< 0: not stated */
    uint8_t control;         /**< 0x0804 + 8 n */
    bool control_missing;    /**< the file does not state it */
    uint8_t enable;          /**< 0x0806 + 8 n, bit 0 */
} cm1e_described_sync_manager_t;

typedef enum cm1e_fmmu_use {
    CM1E_FMMU_UNUSED = 0, CM1E_FMMU_OUTPUTS, CM1E_FMMU_INPUTS, CM1E_FMMU_MAILBOX_STATE, /* as in the SII */
} cm1e_fmmu_use_t;

typedef struct cm1e_described_fmmu {
    cm1e_place_t place;
    cm1e_fmmu_use_t use;
} cm1e_described_fmmu_t;

/** Transitions of the EtherCAT state machine at which a start-up command is sent; may be combined. */
enum cm1e_transitions {
    CM1E_TRANSITION_IP = 0x01, CM1E_TRANSITION_PS = 0x02, CM1E_TRANSITION_SO = 0x04, CM1E_TRANSITION_SP = 0x08,
    CM1E_TRANSITION_OP = 0x10, CM1E_TRANSITION_OS = 0x20,
};

/** An SDO download during start-up (ESI: Mailbox/CoE/InitCmd). */
typedef struct cm1e_init_command {
    cm1e_place_t place;
    uint8_t transitions;     /**< cm1e_transitions */
    uint16_t index;
    uint8_t subindex;
    bool depends_on_slot, fixed, complete_access;
    bool adapts;             /**< ESI: AdaptAutomatically; the master replaces `data` by the choice of the user */
    cm1e_bytes_t data;
    const char *comment;     /**< NULL: none */
} cm1e_init_command_t;

typedef CM1E_LIST(cm1e_init_command_t) cm1e_init_command_list_t;

typedef struct cm1e_mailbox_protocols {
    cm1e_place_t place;      /**< of the mailbox's description */
    bool present;            /**< there is a mailbox */
    bool coe, foe, eoe, soe, voe, aoe;
    bool sdo_info, pdo_assign, pdo_config, pdo_upload, complete_access, segmented_sdo; /**< of CoE */
    bool data_link_layer;
} cm1e_mailbox_protocols_t;

typedef struct cm1e_dc_mode {
    cm1e_place_t place;
    const char *name, *text; /**< ESI: Name, Desc; `text` NULL: none */
    uint16_t assign_activate;/**< registers 0x0980, 0x0981 */
    bool sync0_given, sync1_given;
    int32_t sync0_cycle_ns, sync0_factor, sync0_shift_ns, sync1_cycle_ns, sync1_factor, sync1_shift_ns;
} cm1e_dc_mode_t;

/** What the first words of the SII hold, and an ESI's Eeprom element (ETG.1000.6 table 16, ETG.2010). */
typedef struct cm1e_described_eeprom {
    cm1e_place_t place;
    uint32_t byte_size;      /**< 0: not stated */
    cm1e_bytes_t config_data;/**< words 0-6 (14 bytes), ESI: ConfigData (often 7 ... 14) */
    bool config_known;       /**< false: config_data is a guess and must not be written into a device */
    cm1e_bytes_t bootstrap;  /**< words 0x14-0x17 (8 bytes) */
    uint16_t mailbox_out_start, mailbox_out_length, mailbox_in_start, mailbox_in_length; /**< words 0x18-0x1B; SII */
    uint16_t alias;          /**< word 4 */
    uint32_t serial_number;
    uint16_t version;        /**< word 0x3F */
} cm1e_described_eeprom_t;

/* ---- modules (ETG.5001 MDP) ------------------------------------------------------------------------------------- */

typedef struct cm1e_slot_choice {
    cm1e_place_t place;
    uint32_t ident;          /**< of a module */
    bool is_default;
} cm1e_slot_choice_t;

typedef struct cm1e_slot {
    cm1e_place_t place;
    const char *name;        /**< "" none */
    uint32_t minimum_instances, maximum_instances;
    CM1E_LIST(cm1e_slot_choice_t) choices;
} cm1e_slot_t;

typedef struct cm1e_module {
    cm1e_place_t place;
    uint32_t ident;
    const char *type, *name;
    int32_t profile_no, profile_info;  /**< -1: not given */
    cm1e_type_list_t types;
    cm1e_object_list_t objects;
    cm1e_pdo_list_t pdos;
    cm1e_init_command_list_t init_commands;
} cm1e_module_t;

/* ---- a device --------------------------------------------------------------------------------------------------- */

typedef struct cm1e_channel {
    cm1e_place_t place;
    int32_t profile_no, add_info; /**< add_info -1: not given */
} cm1e_channel_t;

/** Times in ms that an ESI states; -1: not stated. */
typedef struct cm1e_described_timeouts {
    int32_t preop, safeop_op, back_to_init, back_to_safeop, mailbox_request, mailbox_response;
} cm1e_described_timeouts_t;

typedef struct cm1e_description {
    cm1e_place_t place;
    uint32_t vendor_id;
    const char *vendor_name;  /**< NULL: not stated */
    uint32_t product_code, revision;
    bool product_given, revision_given;
    cm1e_place_t identity_place;
    const char *type;         /**< ESI: text of Type, "CM1-E"; SII: order number */
    const char *name;         /**< ESI: Name; SII: name */
    const char *comment;      /**< NULL: none */
    const char *url;          /**< NULL: none */
    const char *group;        /**< ESI: GroupType; SII: group */
    const char *group_name;   /**< NULL: not stated */
    const char *physics;      /**< "YY": two MII ports; NULL: not stated */
    int32_t dpram_bytes, sync_managers_available, fmmus_available; /**< -1: not stated */
    bool no_lrw;              /**< the device cannot do LRW (ESI: Type/@UseLrdLwr) */
    bool identification_reg134, identification_reg134_given; /**< explicit device ID (register 0x0134) */
    cm1e_described_timeouts_t timeouts;

    CM1E_LIST(cm1e_channel_t) channels;
    cm1e_type_list_t types;
    cm1e_object_list_t objects;
    CM1E_LIST(cm1e_described_fmmu_t) fmmus;
    CM1E_LIST(cm1e_described_sync_manager_t) sync_managers;
    cm1e_pdo_list_t pdos;     /**< RxPDOs and TxPDOs, each kind in the file's order */
    cm1e_mailbox_protocols_t mailbox;
    cm1e_init_command_list_t init_commands;
    CM1E_LIST(cm1e_dc_mode_t) dc_modes;
    cm1e_described_eeprom_t eeprom;

    /* MDP only */
    uint16_t slot_pdo_increment, slot_index_increment;
    CM1E_LIST(cm1e_slot_t) slots; /**< what they can hold: the file's modules, by ident */
} cm1e_description_t;

/** The contents of a file. Valid when zeroed; cm1e_description_file_free() frees everything. */
typedef struct cm1e_description_file {
    cm1e_arena_t arena;
    uint32_t vendor_id;
    const char *vendor_name;
    cm1e_place_t vendor_place;
    const char *comment;      /**< note for a reader of the file; NULL: none */
    CM1E_LIST(cm1e_description_t) devices;
    CM1E_LIST(cm1e_module_t) modules; /**< of the whole file (ESI: Descriptions/Modules) */
} cm1e_description_file_t;

/** @rt init */
void cm1e_description_file_free(cm1e_description_file_t *file);

/** Initialises a description: every field has its "not stated" value. @rt any */
void cm1e_description_init(cm1e_description_t *device);

/* ---- asking a description --------------------------------------------------------------------------------------- */

/** NULL: there is none. @rt any */
const cm1e_described_object_t *cm1e_description_object(const cm1e_description_t *device, uint16_t index);
const cm1e_described_entry_t *cm1e_description_entry(const cm1e_description_t *device, uint16_t index,
                                                     uint8_t subindex);
const cm1e_described_pdo_t *cm1e_description_pdo(const cm1e_description_t *device, uint16_t index);
cm1e_described_pdo_t *cm1e_pdo_find(const cm1e_pdo_list_t *list, uint16_t index);

/** "RxPDO" or "TxPDO". @rt any */
const char *cm1e_pdo_kind(const cm1e_described_pdo_t *pdo);
/** Bits of all entries of a PDO. @rt any */
uint32_t cm1e_pdo_bits(const cm1e_described_pdo_t *pdo);
/** Bytes that the PDOs of a sync manager have together, by the default assignment. @rt any */
uint32_t cm1e_description_process_bytes(const cm1e_description_t *device, unsigned sync_manager);

/** The CoE data type of a name ("UINT": 6, "STRING(5)": 9; ETG.1020 table 64 "Base data types"); 0: not a base type.
 *  @rt any */
uint16_t cm1e_type_code(const char *name);
/** Bits of a base type by name ("UINT": 16, "BIT3": 3, "STRING(5)": 40, "ARRAY [0..3] OF BYTE": 32); 0: not a base
 *  type. @rt any */
uint32_t cm1e_type_bits(const char *name);
/** The name of a CoE data type of `bits` bits; NULL: not known. Lives in the arena or for ever. @rt init */
const char *cm1e_type_name(cm1e_arena_t *arena, uint16_t code, uint32_t bits);

/** An unsigned (signed) little-endian number of up to 8 bytes. @rt any */
uint64_t cm1e_bytes_unsigned(cm1e_bytes_t bytes);
int64_t cm1e_bytes_signed(cm1e_bytes_t bytes);
/** `bytes` bytes of a number, in the arena. @rt init */
cm1e_bytes_t cm1e_bytes_of(cm1e_arena_t *arena, int64_t value, size_t bytes);

#endif
