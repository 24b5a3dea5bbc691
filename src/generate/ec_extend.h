/**
 * @file ec_extend.h
 * EC_EXTEND.txt, with which Trio controllers learn of a device (UG 11.2): document, reader, writer, and the document
 * that describes our devices. No grammar of the format is public; what is known of it comes from one file of Trio's
 * (docs/TRIO.md). So a document is kept whole, as it was read, with what nobody here knows; the lists below are the
 * known part of it, to be asked and checked. Any thread.
 */
#ifndef CM1E_GENERATE_EC_EXTEND_H
#define CM1E_GENERATE_EC_EXTEND_H

#include "cm1e/generate.h"
#include "description/check.h"
#include "description/description.h"

/** The entry that may end a list of PDO entries; its length is 0. */
#define CM1E_EC_END_ENTRY "NULL"

/** A reference to something else in the document, by its name or by its Index. */
typedef struct cm1e_ec_reference {
    cm1e_place_t place;
    const char *text;        /**< NULL: there is none */
} cm1e_ec_reference_t;

typedef struct cm1e_ec_entry {
    cm1e_place_t place;
    const char *name;        /**< "CTRL_WORD"; nothing says which object it is: order and length are the contract */
    uint32_t length;         /**< bytes */
} cm1e_ec_entry_t;

typedef struct cm1e_ec_pdo {
    cm1e_place_t place;
    uint32_t index;          /**< of the list within the file, 0 = first */
    const char *name;        /**< "RXPDO_PROFILE" */
    CM1E_LIST(cm1e_ec_entry_t) entries;
} cm1e_ec_pdo_t;

/** An SDO download on the way from Pre-Operational to Safe-Operational (Transition 2). */
typedef struct cm1e_ec_command {
    cm1e_place_t place;
    uint16_t index;
    uint8_t subindex;
    uint32_t length;         /**< bytes */
    int64_t data;
    int32_t transition;
} cm1e_ec_command_t;

typedef struct cm1e_ec_command_list {
    cm1e_place_t place;
    uint32_t index;
    const char *name;        /**< "SDO_APP_CSP" */
    CM1E_LIST(cm1e_ec_command_t) entries;
} cm1e_ec_command_list_t;

typedef struct cm1e_ec_sync_manager {
    cm1e_place_t place;
    uint32_t index;          /**< 0 ... 15; stands twice where the mailbox is another one in Bootstrap */
    uint16_t start;
    int32_t size;            /**< bytes; -1: not given, it follows from the PDOs */
    uint8_t control;
    uint8_t enable;
    const char *function;    /**< "MBOXOUT" */
} cm1e_ec_sync_manager_t;

typedef struct cm1e_ec_controller {
    cm1e_place_t place;
    uint32_t index;
    CM1E_LIST(cm1e_ec_sync_manager_t) sync_managers;
} cm1e_ec_controller_t;

typedef struct cm1e_ec_slave {
    cm1e_place_t place;
    uint32_t index;
    const char *type;        /**< "SERVO", "GENERIC" */
    uint32_t axes;
    uint32_t slot_pdo_increment; /**< from the PDOs of one axis to those of the next; 0: not given */
    const char *startup_protocol;
    CM1E_LIST(cm1e_ec_reference_t) protocols; /**< "COE", "FOE" */
    cm1e_ec_reference_t controller, commands, rx_pdo, tx_pdo;
} cm1e_ec_slave_t;

typedef struct cm1e_ec_profile {
    cm1e_place_t place;
    uint32_t index;
    uint32_t vendor_id, product_code, revision;
    uint32_t drive_profile;  /**< ProfileIndex; Motion Perfect calls it DRIVE_PROFILE (UG 11.2) */
    const char *name;
    cm1e_ec_reference_t slave;
} cm1e_ec_profile_t;

typedef struct cm1e_ec_vendor {
    cm1e_place_t place;
    uint32_t vendor_id;
    const char *name;
} cm1e_ec_vendor_t;

struct _xmlDoc;

/** Valid when zeroed. */
typedef struct cm1e_ec_extend {
    cm1e_arena_t arena;
    struct _xmlDoc *doc;     /**< the document with everything in it */
    const char *warning;     /**< what the user has to know of it; NULL: nothing */
    CM1E_LIST(cm1e_ec_pdo_t) rx_pdos, tx_pdos;
    CM1E_LIST(cm1e_ec_command_list_t) commands;
    CM1E_LIST(cm1e_ec_controller_t) controllers;
    CM1E_LIST(cm1e_ec_slave_t) slaves;
    CM1E_LIST(cm1e_ec_profile_t) profiles;
    CM1E_LIST(cm1e_ec_vendor_t) vendors;
} cm1e_ec_extend_t;

void cm1e_ec_extend_free(cm1e_ec_extend_t *document);
/** CM1E_ERROR_FILE: `diag` says what is wrong in which line. What cannot be written back as it stands (text beside
 *  elements, namespaces, processing instructions) is an error. */
cm1e_error_t cm1e_ec_extend_read(cm1e_ec_extend_t *document, const void *bytes, size_t size, cm1e_diag_t *diag);
/** Writes everything that was read: elements in their order, their texts to the letter, attributes, comments (one
 *  before the XML declaration moves behind it). */
cm1e_error_t cm1e_ec_extend_write(cm1e_file_t *out, const cm1e_ec_extend_t *document, cm1e_diag_t *diag);
/** The document for the devices of the options. */
cm1e_error_t cm1e_ec_extend_make(cm1e_ec_extend_t *document, const cm1e_generate_options_t *options,
                                 cm1e_diag_t *diag);
/** References that lead nowhere, lengths that do not fit, sync managers; and our own devices against their tables. */
void cm1e_ec_extend_check(cm1e_findings_t *findings, const cm1e_ec_extend_t *document);
/** Compares the profile for this device, if there is one, with what the live device says of itself. */
void cm1e_ec_extend_compare(cm1e_findings_t *findings, const cm1e_ec_extend_t *document,
                            const cm1e_description_t *device);

/* ---- for those who ask a document ------------------------------------------------------------------------------- */

/** What a reference leads to; NULL: nothing. */
const cm1e_ec_pdo_t *cm1e_ec_extend_rx_pdo(const cm1e_ec_extend_t *document, const cm1e_ec_slave_t *slave);
const cm1e_ec_pdo_t *cm1e_ec_extend_tx_pdo(const cm1e_ec_extend_t *document, const cm1e_ec_slave_t *slave);
const cm1e_ec_command_list_t *cm1e_ec_extend_commands(const cm1e_ec_extend_t *document, const cm1e_ec_slave_t *slave);
const cm1e_ec_controller_t *cm1e_ec_extend_controller(const cm1e_ec_extend_t *document, const cm1e_ec_slave_t *slave);
const cm1e_ec_slave_t *cm1e_ec_extend_slave(const cm1e_ec_extend_t *document, const cm1e_ec_profile_t *profile);
/** Bytes of all entries of a list; NULL: 0. */
uint32_t cm1e_ec_pdo_bytes(const cm1e_ec_pdo_t *pdo);
/** The PDO that the commands assign to 0x1C12 or 0x1C13, that of the first axis; 0: they assign none. `entry` (or
 *  NULL) becomes the command that does it. */
uint16_t cm1e_ec_assigned_pdo(const cm1e_ec_command_list_t *commands, bool transmit, const cm1e_ec_command_t **entry);

/** What Trio calls a piece of process data. */
typedef struct cm1e_ec_name {
    const char *name;
    bool transmit;
    uint16_t object;         /**< of CiA 402, whose value it is; 0: of none, the controller puts it into VRs or ends */
} cm1e_ec_name_t;

/** By name; NULL: not a name that is known. */
const cm1e_ec_name_t *cm1e_ec_name(const char *name);
/** What stands in a list for an entry of a PDO. */
const char *cm1e_ec_name_of(const cm1e_described_pdo_entry_t *entry, bool transmit);
/** Function of a sync manager; "UNUSED" where it has none. */
const char *cm1e_ec_function(cm1e_sync_manager_use_t use);
/** What a function says of a sync manager; CM1E_SM_UNUSED where it is not known. `bootstrap`: of the other mailbox. */
cm1e_sync_manager_use_t cm1e_ec_use(const char *function, bool *bootstrap);

/** The process data, sync managers and start-up commands of a slave beside those of a description. Returns how many
 *  findings there are; `findings` NULL: only that. */
size_t cm1e_ec_extend_beside(cm1e_findings_t *findings, cm1e_rule_t rule, const cm1e_ec_extend_t *document,
                             const cm1e_ec_slave_t *slave, const cm1e_description_t *device);

#endif
