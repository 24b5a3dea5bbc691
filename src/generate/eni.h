/**
 * @file eni.h
 * EtherCAT network information (ETG.2100): a whole network with the frames that start it and run it, as a configuration
 * tool hands it to a master. Document, reader, writer, checker, and the document for a network of ours. Any thread.
 *
 * What reads ENI files, and what it needs of them:
 * - acontis EC-Master (also inside Simulink Real-Time and others) runs the file: every InitCmd, the cyclic frames, the
 *   variables. It takes what TwinCAT exports, so a file has to be laid out as those are.
 * - TwinCAT exports ENI, and imports it for a simulated network only (TE1111). In its files an image is the frame
 *   itself: InputOffs and OutputOffs are where a datagram's header lies, its data lie 10 bytes behind, and BitStart and
 *   BitOffs count from the image's begin. So do ours, frame n from byte 1536 n on (seen of frame 0 only). Others, e.g.
 *   the ENI of Synapticon's Motion Master, mean the data by InputOffs; the checker takes either.
 * - SOEM 2.x (scripts/eniconv.py): AutoIncAddr, VendorId, ProductCode, RevisionNo and the CoE InitCmds. Numbers decimal
 *   or 0x but not #x there, CompleteAccess and Disabled "1" (not "true"), and a Timeout above 0: it is taken literally.
 * - KickCAT (lib ENI parser): Destination and Source of the master, Type, StartAddress, ControlByte and Enable of every
 *   sync manager, Timeout and Ccs of every CoE InitCmd; Addr or Adp and Ado, Data or DataLength, never both.
 * - Intel's ecat-enablekit: the slaves' InitCmds, sync managers and PDOs, for the IgH master.
 * - The schema (EtherCATConfig.xsd) wants the elements in its order: the writer's.
 * Ccs 1 is an SDO download, as in ETG.1000.6 and in every exported file; the table of ETG.2100 has it the other way.
 */
#ifndef CM1E_GENERATE_ENI_H
#define CM1E_GENERATE_ENI_H

#include "cm1e/config.h"
#include "cm1e/generate.h"
#include "description/check.h"
#include "description/description.h"

/** Transitions of ETG.2100, in the order in which they are written; a mask each. */
#define CM1E_ENI_TRANSITIONS(X)                                                                                     \
    X(II) X(IP) X(PP) X(PO) X(PS) X(PI) X(SS) X(SP) X(SO) X(SI) X(OS) X(OP) X(OI) X(IB) X(BI)
enum cm1e_eni_transition_bit {
#define CM1E_ENI_TRANSITION_BIT(name) CM1E_ENI_BIT_##name,
    CM1E_ENI_TRANSITIONS(CM1E_ENI_TRANSITION_BIT)
#undef CM1E_ENI_TRANSITION_BIT
};
enum cm1e_eni_transitions {
#define CM1E_ENI_TRANSITION_MASK(name) CM1E_ENI_##name = 1 << CM1E_ENI_BIT_##name,
    CM1E_ENI_TRANSITIONS(CM1E_ENI_TRANSITION_MASK)
#undef CM1E_ENI_TRANSITION_MASK
};

/** EtherCAT states in which a cyclic command is sent; may be combined. */
enum cm1e_eni_states {
    CM1E_ENI_INIT = 0x01, CM1E_ENI_PREOP = 0x02, CM1E_ENI_SAFEOP = 0x04, CM1E_ENI_OPERATIONAL = 0x08,
};

/** EtherCAT commands (ETG.1000.4 5.4). */
typedef enum cm1e_eni_command_code {
    CM1E_ENI_NOP = 0, CM1E_ENI_APRD, CM1E_ENI_APWR, CM1E_ENI_APRW, CM1E_ENI_FPRD, CM1E_ENI_FPWR, CM1E_ENI_FPRW,
    CM1E_ENI_BRD, CM1E_ENI_BWR, CM1E_ENI_BRW, CM1E_ENI_LRD, CM1E_ENI_LWR, CM1E_ENI_LRW, CM1E_ENI_ARMW, CM1E_ENI_FRMW,
} cm1e_eni_command_code_t;

#define CM1E_ENI_NOT_GIVEN (-1)

/** A datagram of an InitCmd or of a cyclic frame. */
typedef struct cm1e_eni_command {
    cm1e_place_t place;
    uint16_t transitions;      /**< InitCmd: cm1e_eni_transitions */
    uint8_t states;            /**< cyclic: cm1e_eni_states */
    bool before_slave;
    const char *comment;       /**< NULL: none */
    const char *requires;      /**< "frame", "cycle"; NULL: may share a frame */
    uint8_t code;              /**< cm1e_eni_command_code_t */
    uint16_t adp, ado;         /**< LRD, LWR, LRW: not used */
    uint32_t address;          /**< LRD, LWR, LRW */
    cm1e_bytes_t data;         /**< none: `length` zeros */
    uint32_t length;           /**< bytes of the datagram */
    int32_t count;             /**< working counter; CM1E_ENI_NOT_GIVEN: any will do */
    int32_t retries, timeout_ms; /**< CM1E_ENI_NOT_GIVEN */
    bool validates;            /**< the answer has to be `expected` where `mask` (none: everywhere) has ones */
    cm1e_bytes_t expected, mask;
    int64_t input_offset, output_offset; /**< cyclic, bytes; CM1E_ENI_NOT_GIVEN */
} cm1e_eni_command_t;

typedef CM1E_LIST(cm1e_eni_command_t) cm1e_eni_command_list_t;

/** An SDO transfer (Mailbox/CoE/InitCmds/InitCmd). */
typedef struct cm1e_eni_sdo {
    cm1e_place_t place;
    uint16_t transitions;
    const char *comment;       /**< NULL: none */
    uint32_t timeout_ms;
    uint8_t specifier;         /**< Ccs: 1 download, 2 upload */
    uint16_t index;
    uint8_t subindex;
    bool fixed, complete_access, disabled;
    cm1e_bytes_t data;
} cm1e_eni_sdo_t;

/** Where a slave's process data lie in an image of the master, in bits. */
typedef struct cm1e_eni_range {
    cm1e_place_t place;
    uint32_t start, length;
} cm1e_eni_range_t;

typedef struct cm1e_eni_sync_manager {
    uint8_t number;            /**< 0 ... 15 */
    cm1e_described_sync_manager_t manager; /**< use, start, control, enable; length where there is a DefaultSize */
    CM1E_LIST(uint16_t) pdos;
} cm1e_eni_sync_manager_t;

typedef struct cm1e_eni_mailbox_area {
    uint16_t start, length;
} cm1e_eni_mailbox_area_t;

typedef struct cm1e_eni_mailbox {
    cm1e_place_t place;
    bool present, data_link_layer;
    cm1e_eni_mailbox_area_t send, receive; /**< of the master: `send` is the slave's SM0 */
    int32_t poll_ms;           /**< CM1E_ENI_NOT_GIVEN */
    int64_t status_bit;        /**< logical bit address of the mailbox's state; CM1E_ENI_NOT_GIVEN */
    bool has_bootstrap;
    cm1e_eni_mailbox_area_t boot_send, boot_receive;
    bool aoe, eoe, coe, foe, soe, voe; /**< Protocol */
    CM1E_LIST(cm1e_eni_sdo_t) sdos;
} cm1e_eni_mailbox_t;

typedef struct cm1e_eni_previous_port {
    cm1e_place_t place;
    bool selected;             /**< the cable is there; otherwise it could be */
    char port;                 /**< 'A' ... 'D', of the device before */
    int32_t station;           /**< its PhysAddr; CM1E_ENI_NOT_GIVEN */
} cm1e_eni_previous_port_t;

typedef struct cm1e_eni_dc {
    cm1e_place_t place;
    bool present, potential_reference, reference;
    int64_t cycle0_ns, cycle1_ns, shift_ns;
} cm1e_eni_dc_t;

typedef struct cm1e_eni_device {
    cm1e_place_t place;
    const char *name;
    uint16_t station;          /**< PhysAddr */
    uint16_t position;         /**< AutoIncAddr: 0, 65535, 65534 ... */
    bool position_given;
    const char *physics;       /**< "" not given */
    uint32_t vendor_id, product_code, revision, serial_number;
    bool has_send, has_receive;
    cm1e_eni_range_t send, receive; /**< in the image of outputs, of inputs */
    CM1E_LIST(cm1e_eni_sync_manager_t) sync_managers;
    cm1e_pdo_list_t pdos;      /**< TxPDOs, then RxPDOs */
    cm1e_eni_mailbox_t mailbox;
    cm1e_eni_command_list_t commands;
    CM1E_LIST(cm1e_eni_previous_port_t) previous;
    cm1e_eni_dc_t dc;
} cm1e_eni_device_t;

typedef struct cm1e_eni_frame {
    cm1e_place_t place;
    cm1e_eni_command_list_t commands;
} cm1e_eni_frame_t;

typedef struct cm1e_eni_cyclic {
    cm1e_place_t place;
    const char *comment;       /**< NULL: none */
    int64_t cycle_time_us;     /**< CM1E_ENI_NOT_GIVEN */
    int32_t priority;          /**< CM1E_ENI_NOT_GIVEN */
    const char *task;          /**< NULL: none */
    CM1E_LIST(cm1e_eni_frame_t) frames;
} cm1e_eni_cyclic_t;

typedef struct cm1e_eni_variable {
    cm1e_place_t place;
    const char *name, *comment, *type; /**< comment, type NULL: none */
    uint32_t bits, offset;     /**< bits */
} cm1e_eni_variable_t;

typedef struct cm1e_eni_image {
    cm1e_place_t place;
    uint32_t bytes;
    CM1E_LIST(cm1e_eni_variable_t) variables;
} cm1e_eni_image_t;

/** The document. Valid when zeroed. */
typedef struct cm1e_eni {
    cm1e_arena_t arena;
    const char *master_name;
    cm1e_bytes_t destination, source, ether_type; /**< 6, 6 and 2 bytes (0x88A4 as A4 88) */
    bool has_mailbox_states;
    uint32_t mailbox_states_start, mailbox_states_count;
    cm1e_eni_command_list_t commands; /**< of the master */
    CM1E_LIST(cm1e_eni_device_t) devices;
    CM1E_LIST(cm1e_eni_cyclic_t) cyclics;
    bool has_image;
    cm1e_eni_image_t inputs, outputs;
} cm1e_eni_t;

/** One slave of the network that an ENI is made for, in the order of the wire. */
typedef struct cm1e_eni_slave {
    const cm1e_description_t *device; /**< its PDOs by the default assignment; outlives the document */
    const char *name;                 /**< in the network: "x_axis"; must be unique */
    uint16_t alias;                   /**< configured station alias by which it is to be found; 0: by position */
    bool has_clock;                   /**< its distributed clock is used; the first one is the reference */
    cm1e_dc_config_t pulses;          /**< of that clock; all zero: none */
    uint16_t assign_activate;         /**< registers 0x0980 and 0x0981 with pulses; 0: what they need */
} cm1e_eni_slave_t;

void cm1e_eni_free(cm1e_eni_t *document);
cm1e_error_t cm1e_eni_read(cm1e_eni_t *document, const void *bytes, size_t size, cm1e_diag_t *diag);
cm1e_error_t cm1e_eni_write(cm1e_file_t *out, const cm1e_eni_t *document, cm1e_diag_t *diag);
/** A line of slaves, in the given order. CM1E_ERROR_CONFIG: a name twice, or process data
 *  that no frame can hold. */
cm1e_error_t cm1e_eni_make(cm1e_eni_t *document, const cm1e_eni_slave_t *slaves, size_t count, int64_t cycle_time_ns,
                           cm1e_diag_t *diag);
void cm1e_eni_check(cm1e_findings_t *findings, const cm1e_eni_t *document);
/** Compares the slave at `position` (1 = first) with what the live device says of itself. */
void cm1e_eni_compare(cm1e_findings_t *findings, const cm1e_eni_t *document, uint16_t position,
                      const cm1e_description_t *device);

/* ---- private to this format ------------------------------------------------------------------------------------- */

#define CM1E_ENI_TRANSITION_COUNT (CM1E_ENI_BIT_BI + 1)
#define CM1E_ENI_STATE_COUNT 4
#define CM1E_ENI_DATAGRAM_HEADER 10     /**< before the data of a datagram; 2 bytes of working counter behind them */
#define CM1E_ENI_DATAGRAM_OVERHEAD 12
#define CM1E_ENI_FRAME_BYTES 1498       /**< of all datagrams: Ethernet's 1500 less the EtherCAT header */
#define CM1E_ENI_DATAGRAM_BYTES (CM1E_ENI_FRAME_BYTES - CM1E_ENI_DATAGRAM_OVERHEAD) /**< data of the longest datagram */

extern const char *const cm1e_eni_transition_names[CM1E_ENI_TRANSITION_COUNT];
extern const char *const cm1e_eni_state_names[CM1E_ENI_STATE_COUNT];

/** A zeroed command with every "not given". */
cm1e_eni_command_t cm1e_eni_command(uint8_t code);
/** LRD, LWR, LRW. */
bool cm1e_eni_is_logical(uint8_t code);
/** Whether the command sets a sync manager or FMMU block of registers, number `n` of `size` bytes from `first` on. */
bool cm1e_eni_sets(const cm1e_eni_command_t *command, uint16_t first, unsigned size, unsigned *n);
/** Adds the bits of the PDOs that a sync manager carries; false: it names none, or one that the file does not have. */
bool cm1e_eni_add_pdo_bits(const cm1e_eni_device_t *device, const cm1e_eni_sync_manager_t *manager, uint32_t *bits);
/** A slave of the file in the words of descriptions, in `arena`. */
cm1e_description_t cm1e_eni_describe(cm1e_arena_t *arena, const cm1e_eni_device_t *device);
/** Logical addresses of the process data of a slave. */
typedef struct cm1e_eni_logical {
    uint32_t outputs, inputs;
} cm1e_eni_logical_t;
/** The InitCmds that start a slave of our making; its addresses, sync managers, PDOs and mailbox are already there.
 *  `alias` 0: none. */
void cm1e_eni_make_commands(cm1e_arena_t *arena, cm1e_eni_device_t *device, cm1e_eni_logical_t logical, uint16_t alias,
                            uint16_t assign_activate);
/** `clocks`: there is a slave whose clock is used. */
void cm1e_eni_make_master_commands(cm1e_arena_t *arena, cm1e_eni_command_list_t *list, bool clocks);
/** The rules about cyclic frames and images. */
void cm1e_eni_check_frames(cm1e_findings_t *findings, const cm1e_eni_t *document);

#endif
