/**
 * @file generate.h
 * Files for other masters and tools: ESI for TwinCAT and others (ETG.2000), EC_EXTEND for Trio controllers, SII images
 * (ETG.2010), ENI (ETG.2100). They are written from the device tables that driver and simulator use. Files from any
 * source can be read and checked. Equal input gives equal bytes. Any thread may call these functions, one thread at a
 * time for one object; none of them is for the cycle.
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

/** The formats of files that can be told apart and checked. */
typedef enum cm1e_file_format {
    CM1E_FILE_UNKNOWN = 0,
    CM1E_FILE_ESI,       /**< EtherCAT slave information, XML */
    CM1E_FILE_EC_EXTEND, /**< Trio Motion Perfect, EC_EXTEND.txt */
    CM1E_FILE_SII,       /**< image of a slave's EEPROM */
    CM1E_FILE_ENI,       /**< EtherCAT network information, XML */
} cm1e_file_format_t;

/** How an ESI describes the PDO mappings (ETG.2000, ETG.5001). */
typedef enum cm1e_esi_layout {
    CM1E_ESI_FLAT = 0, /**< all mappings in the device */
    CM1E_ESI_MDP,      /**< slots, with a module for each mapping */
} cm1e_esi_layout_t;

/** The device that a file describes. A zero in any field selects the default that its comment names. */
typedef struct cm1e_device_options {
    cm1e_device_model_t model;
    char firmware[12];            /**< CM1-E: "1.2.0" ... "1.3.5"; "" selects 1.3.5 */
    cm1e_mapping_t mapping;       /**< CM1-E: the mapping that the file chooses */
    cm1e_pdo_order_t order;       /**< CM1-E: order of the objects in the mappings */
    uint32_t axes;                /**< bridge: 1 ... 4; 0 selects 4 */
    uint32_t vendor_id;           /**< bridge: mandatory, its guide does not state it; CM1-E: must be 0 */
    uint32_t product_code;        /**< bridge: mandatory; CM1-E: must be 0 */
    uint32_t revision;            /**< bridge: mandatory; CM1-E: must be 0, it follows from the firmware */
    uint32_t serial_number;       /**< SII */
    uint16_t alias;               /**< SII: configured station alias; 0: none */
    bool complete_access;         /**< true: announce SDO complete access, which the guides do not mention */
    bool distributed_clocks;      /**< true: offer "DC Synchronous" (SYNC0) too; the guides name only "SM
                                       Synchronous" */
    uint8_t config_data[14];      /**< words 0-6 of the EEPROM of a real device, as `cm1e sii read` reads them */
    uint8_t config_data_size;     /**< 14; 0: not known, and the file says that it is not for an EEPROM */
} cm1e_device_options_t;

/** The file to write. A zero in any field selects the default that its comment names. */
typedef struct cm1e_generate_options {
    cm1e_file_format_t format;
    cm1e_esi_layout_t layout;              /**< ESI */
    const cm1e_device_options_t *devices;  /**< ESI, EC_EXTEND: one or more; SII: one; NULL selects one CM1-E with
                                                defaults. ENI: the identity of its bridges, a device for each model */
    size_t device_count;
    const cm1e_bus_config_t *network;      /**< ENI: the axes and their addresses; mandatory */
    uint16_t dc_mode;                      /**< EC_EXTEND Dc/Mode; 0 selects 0x0300 */
    uint16_t mailbox_rate;                 /**< EC_EXTEND MbxRate; 0 selects 100 */
} cm1e_generate_options_t;

/** A file in memory; the caller frees it with cm1e_file_free(). */
typedef struct cm1e_file {
    uint8_t *bytes;        /**< followed by a 0 that is not counted in `size` */
    size_t size;
    char warning[512];     /**< what the user has to know about the file; "": nothing */
} cm1e_file_t;

/** Frees the bytes of a file; a zeroed struct is allowed. @rt init */
CM1E_API void cm1e_file_free(cm1e_file_t *file);

/* Both structs of options may grow at their ends in later versions. The functions ..._sized() are told the sizes that
 * the program was compiled with. */

/** Does the work of cm1e_generate(), for a program with these sizes of the options and of a device. @rt init */
CM1E_API cm1e_error_t cm1e_generate_sized(cm1e_file_t *file, const cm1e_generate_options_t *options, size_t size,
                                          size_t device_size, cm1e_diag_t *diag);
/** Writes a file. Returns CM1E_ERROR_CONFIG if the options contradict each other; `diag` says which, and what would be
 *  right. @rt init */
static inline cm1e_error_t cm1e_generate(cm1e_file_t *file, const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    return cm1e_generate_sized(file, options, sizeof(cm1e_generate_options_t), sizeof(cm1e_device_options_t), diag);
}

/** Does the work of cm1e_generate_trio_program(), for a program with these sizes of the options and of a device.
 *  @rt init */
CM1E_API cm1e_error_t cm1e_generate_trio_program_sized(cm1e_file_t *file, const cm1e_generate_options_t *options,
                                                       size_t size, size_t device_size, cm1e_diag_t *diag);
/** Writes the TrioBASIC start program for an EC_EXTEND file of these devices: axis set-up, move and reset for each axis
 *  (UG 11.2.1). @rt init */
static inline cm1e_error_t cm1e_generate_trio_program(cm1e_file_t *file, const cm1e_generate_options_t *options,
                                                      cm1e_diag_t *diag)
{
    return cm1e_generate_trio_program_sized(file, options, sizeof(cm1e_generate_options_t),
                                            sizeof(cm1e_device_options_t), diag);
}

/** Writes the ENI of the network that a scan found. A CM1-E that is a configured axis gets the name and mapping of the
 *  axis; the others get `mapping`. A bridge gets the names of its axes. Other devices are described by their SII. The
 *  caller owns the bus, which must be scanned and not in operation. Returns CM1E_ERROR_STATE if the scan found no
 *  slave, CM1E_ERROR_UNSUPPORTED if the firmware of a CM1-E cannot be read. @rt block */
CM1E_API cm1e_error_t cm1e_generate_eni_of_bus(cm1e_file_t *file, cm1e_bus_t *bus, cm1e_mapping_t mapping,
                                               cm1e_diag_t *diag);

/** Reads a file of any format and writes it in `format`: its own format, or ESI from SII and SII from ESI. `device` is
 *  the device of the ESI for which the SII is written, 0 = first. A file that cm1e_generate() wrote keeps its bytes;
 *  `warning` names elements of another one that the new file of the same format does not have, such as pictures.
 *  Returns CM1E_ERROR_NOT_FOUND if the ESI has no such device, CM1E_ERROR_FILE if the file cannot be read (`diag` says
 *  where), CM1E_ERROR_UNSUPPORTED if `format` needs data that the file does not have. @rt init */
CM1E_API cm1e_error_t cm1e_generate_from(cm1e_file_t *file, const void *bytes, size_t size, cm1e_file_format_t format,
                                         size_t device, cm1e_diag_t *diag);

/* ---- reading and checking --------------------------------------------------------------------------------------- */

/** Format of a file, by its content and not by its name. @rt any */
CM1E_API cm1e_file_format_t cm1e_file_recognise(const void *bytes, size_t size);
/** Name of a format: "ESI", "EC_EXTEND", "SII", "ENI", "unknown". Static storage. @rt any */
CM1E_API const char *cm1e_file_format_name(cm1e_file_format_t format);

/** One finding of a check or of a comparison. */
typedef struct cm1e_finding {
    const char *rule;   /**< name of the rule: docs/CHECK-RULES.md has all of them */
    bool is_error;      /**< false: a warning, the file can be right */
    uint32_t line;      /**< line of the file, 1 = first; byte address of an SII; 0: no single place */
    const char *text;   /**< sentence: what is wrong there, and what would be right */
} cm1e_finding_t;
/** All findings of a check. Free them with cm1e_findings_free(). */
typedef struct cm1e_findings cm1e_findings_t;

/** Finding `n`, 0 = first, in the order of lines. The pointer is valid as long as `findings`. @rt any */
CM1E_API const cm1e_finding_t *cm1e_findings_at(const cm1e_findings_t *findings, size_t n);
/** Number of findings. @rt any */
CM1E_API size_t cm1e_findings_count(const cm1e_findings_t *findings);
/** Frees the findings. NULL is allowed. @rt init */
CM1E_API void cm1e_findings_free(cm1e_findings_t *findings);

/** Checks a file of any format by every rule of docs/CHECK-RULES.md. Returns CM1E_OK if the file was read; `*findings`
 *  then has what is wrong with it, and the caller frees it. Returns CM1E_ERROR_FILE if the file cannot be read; `diag`
 *  says where. @rt init */
CM1E_API cm1e_error_t cm1e_check_file(cm1e_findings_t **findings, const void *bytes, size_t size, cm1e_diag_t *diag);

/** Compares a file with the device at `position`: dictionary, mapping and SII, as far as the file states them. If an
 *  ENI and the network have different numbers of slaves, the finding is reported at the last slave that both have. The
 *  caller owns the bus, which must be scanned and not in operation. Returns CM1E_OK with the differences in
 *  `*findings`, which the caller frees. Returns CM1E_ERROR_NOT_FOUND if the file does not describe this device,
 *  CM1E_ERROR_FILE if the file cannot be read. @rt block */
CM1E_API cm1e_error_t cm1e_diff_file(cm1e_findings_t **findings, const void *bytes, size_t size, cm1e_bus_t *bus,
                                     uint16_t position, cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
