/**
 * @file generate.h
 * Files for other masters and tools: ESI for TwinCAT and its like (ETG.2000), EC_EXTEND for Trio controllers, SII
 * images (ETG.2010), ENI (ETG.2100). Written from the device tables that driver and simulator use; read and checked,
 * ours and anyone's. The same input gives the same bytes. Any thread, one at a time for one object; nothing here is for
 * the cycle.
 */
#ifndef CM1E_GENERATE_H
#define CM1E_GENERATE_H

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

typedef enum cm1e_file_format {
    CM1E_FILE_UNKNOWN = 0,
    CM1E_FILE_ESI,       /**< EtherCAT slave information, XML */
    CM1E_FILE_EC_EXTEND, /**< Trio Motion Perfect, EC_EXTEND.txt */
    CM1E_FILE_SII,       /**< image of a slave's EEPROM */
    CM1E_FILE_ENI,       /**< EtherCAT network information, XML */
} cm1e_file_format_t;

/** How an ESI shows the PDO mappings (facts: ETG.2000, ETG.5001). */
typedef enum cm1e_esi_layout {
    CM1E_ESI_FLAT = 0, /**< all mappings in the device */
    CM1E_ESI_MDP,      /**< slots, and modules to choose for them */
} cm1e_esi_layout_t;

/** Which device a file is to describe. A zero in any field means the default that its comment names. */
typedef struct cm1e_device_options {
    cm1e_device_model_t model;
    char firmware[12];            /**< CM1-E: "1.2.0" ... "1.3.5"; "": 1.3.5 */
    cm1e_mapping_t mapping;       /**< CM1-E: the mapping that the file chooses */
    cm1e_pdo_order_t order;       /**< CM1-E: order of the objects in the mappings */
    uint32_t axes;                /**< bridge: 1 ... 4; 0: 4 */
    uint32_t vendor_id;           /**< bridge: needed, its guide does not state it; CM1-E: must be 0 */
    uint32_t product_code;        /**< bridge: needed; CM1-E: must be 0 */
    uint32_t revision;            /**< bridge: needed; CM1-E: must be 0, it follows from the firmware */
    uint32_t serial_number;       /**< SII */
    uint16_t alias;               /**< SII: configured station alias; 0: none */
    bool complete_access;         /**< announce SDO complete access, which the guides do not mention */
    bool distributed_clocks;      /**< offer "DC Synchronous" (SYNC0) beside "SM Synchronous"; the guides name none */
    uint8_t config_data[14];      /**< words 0-6 of the EEPROM of a real device, as `cm1e sii read` brings them ... */
    uint8_t config_data_size;     /**< ... 14; 0: not known, the file says that it is not for an EEPROM */
} cm1e_device_options_t;

/** What to write. A zero in any field means the default that its comment names. */
typedef struct cm1e_generate_options {
    cm1e_file_format_t format;
    cm1e_esi_layout_t layout;              /**< ESI */
    const cm1e_device_options_t *devices;  /**< ESI, EC_EXTEND: one or more; SII: one; NULL: one CM1-E of defaults.
                                                ENI: the identity of its bridges, a device for each model */
    size_t device_count;
    const cm1e_bus_config_t *network;      /**< ENI: where the axes stand; needed */
    uint16_t dc_mode;                      /**< EC_EXTEND Dc/Mode; 0: 0x0300 */
    uint16_t mailbox_rate;                 /**< EC_EXTEND MbxRate; 0: 100 */
} cm1e_generate_options_t;

/** A file in memory; the caller frees it with cm1e_file_free(). */
typedef struct cm1e_file {
    uint8_t *bytes;        /**< with a 0 behind them that does not count */
    size_t size;
    char warning[512];     /**< what the user has to know about it; "": nothing */
} cm1e_file_t;

/** Frees what a file holds; a zeroed one is allowed. @rt init */
CM1E_API void cm1e_file_free(cm1e_file_t *file);

/** Writes a file. CM1E_ERROR_CONFIG: the options do not fit together, `diag` says which and what would be right.
 *  @rt init */
CM1E_API cm1e_error_t cm1e_generate(cm1e_file_t *file, const cm1e_generate_options_t *options, cm1e_diag_t *diag);

/** Writes the TrioBASIC start program that goes with an EC_EXTEND file of these devices: axis set-up, move and reset
 *  for each axis (UG 11.2.1). @rt init */
CM1E_API cm1e_error_t cm1e_generate_trio_program(cm1e_file_t *file, const cm1e_generate_options_t *options,
                                                 cm1e_diag_t *diag);

/** Writes the ENI of the network that a scan found. A CM1-E that is a configured axis has its name and mapping; the
 *  others run with `mapping`; a bridge has the names of its axes; devices of another kind by their SII. The bus has
 *  been scanned and does not operate; the caller owns it. CM1E_ERROR_STATE: it knows no slave; CM1E_ERROR_UNSUPPORTED:
 *  a CM1-E does not tell its firmware. @rt block */
CM1E_API cm1e_error_t cm1e_generate_eni_of_bus(cm1e_file_t *file, cm1e_bus_t *bus, cm1e_mapping_t mapping,
                                               cm1e_diag_t *diag);

/** Reads a file of any of the formats and writes it anew in `format`: the same one, or ESI and SII out of each other.
 *  `device` is the one of an ESI that an SII is for, 0 = first; CM1E_ERROR_NOT_FOUND: there is none of that number. A
 *  file that cm1e_generate() wrote comes back as it was. CM1E_ERROR_FILE: it cannot be read, `diag` says where;
 *  CM1E_ERROR_UNSUPPORTED: `format` needs what this file does not have. @rt init */
CM1E_API cm1e_error_t cm1e_generate_from(cm1e_file_t *file, const void *bytes, size_t size, cm1e_file_format_t format,
                                         size_t device, cm1e_diag_t *diag);

/* ---- reading and checking --------------------------------------------------------------------------------------- */

/** By the content, whatever the file is called. @rt any */
CM1E_API cm1e_file_format_t cm1e_file_recognise(const void *bytes, size_t size);
/** "ESI", "EC_EXTEND", "SII", "ENI", "unknown". @rt any */
CM1E_API const char *cm1e_file_format_name(cm1e_file_format_t format);

/** What a check or a comparison found. */
typedef struct cm1e_finding {
    const char *rule;   /**< "pdo-entry-not-in-dictionary": docs/CHECK-RULES.md has them all */
    bool is_error;      /**< FALSE: worth knowing, but the file can be right */
    uint32_t line;      /**< in the file, 1 = first; SII: byte address; 0: no one place */
    const char *text;   /**< a sentence: what is wrong there, and what would be right */
} cm1e_finding_t;
typedef struct cm1e_findings cm1e_findings_t;

/** In the order of lines. Lives as long as `findings`. @rt any */
CM1E_API const cm1e_finding_t *cm1e_findings_at(const cm1e_findings_t *findings, size_t n);
/** @rt any */
CM1E_API size_t cm1e_findings_count(const cm1e_findings_t *findings);
/** NULL is allowed. @rt init */
CM1E_API void cm1e_findings_free(cm1e_findings_t *findings);

/** Checks a file of any of the formats by every rule of docs/CHECK-RULES.md. CM1E_OK: it was read, `*findings` (to be
 *  freed) says what is wrong with its content; CM1E_ERROR_FILE: it cannot be read, `diag` says where. @rt init */
CM1E_API cm1e_error_t cm1e_check_file(cm1e_findings_t **findings, const void *bytes, size_t size, cm1e_diag_t *diag);

/** Compares a file with the device at `position`: dictionary, mapping, SII, as far as the file speaks of them. Slaves
 *  that an ENI has and the network has not, or the other way round, are told at the last slave that both have. The
 *  bus has been scanned and does not operate; the caller owns it. CM1E_OK: `*findings`, to be freed, are the
 *  differences; CM1E_ERROR_NOT_FOUND: the file does not describe this device; CM1E_ERROR_FILE: it cannot be read.
 *  @rt block */
CM1E_API cm1e_error_t cm1e_diff_file(cm1e_findings_t **findings, const void *bytes, size_t size, cm1e_bus_t *bus,
                                     uint16_t position, cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
