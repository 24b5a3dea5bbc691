/**
 * @file busfile.h
 * Shared declarations of this room; private to it. A bus file is loaded in these steps, each with its own diagnosis:
 * read the bytes, reject YAML features that a bus file does not use, compare every node with the schema, let libcyaml
 * fill the structures, convert, check ranges and contradictions. libcyaml alone would accept "4x" as 4, NaN as a speed
 * and "maybe" as true, and it reports the place of a wrong key only roughly; hence the comparison before it.
 */
#ifndef CM1E_BUSFILE_BUSFILE_H
#define CM1E_BUSFILE_BUSFILE_H

#include <cyaml/cyaml.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <yaml.h>

#include "config/problem.h"

/* ---- document.c: bytes and nodes --------------------------------------------------------------------------------- */

enum { CM1E_BUSFILE_MAX_SIZE = 1 << 20 };

/** Reads a whole file into memory that the caller frees. */
cm1e_error_t cm1e_busfile_read(const char *path, uint8_t **bytes, size_t *size, cm1e_config_problem_t *problem);
/** The one document in `bytes`; the caller deletes it on success. */
cm1e_error_t cm1e_busfile_parse(const uint8_t *bytes, size_t size, yaml_document_t *document,
                                cm1e_config_problem_t *problem);
/** Whether the file has several buses: the key `buses`. */
bool cm1e_busfile_has_several(yaml_document_t *document);
/** Finds line and column of the node at problem->path, or of the deepest existing node on that path. */
void cm1e_busfile_locate(yaml_document_t *document, cm1e_config_problem_t *problem);

/* ---- schema.c, differences.c: keys and types --------------------------------------------------------------------- */

enum { CM1E_BUSFILE_VELOCITY_COUNTS_PER_S = 1, CM1E_BUSFILE_VELOCITY_COUNTS_PER_MS = 2 };

/** "SLAVE.SIGNAL" */
typedef char cm1e_busfile_signal_name_t[CM1E_SIGNAL_LENGTH];

/** One axis of the file: values that are copied into the configuration, and values that are converted. */
typedef struct cm1e_busfile_axis {
    cm1e_axis_config_t axis;
    uint16_t position, alias, explicit_id;
    double *software_limit_negative, *software_limit_positive; /**< NULL: none on this side */
    uint8_t *k37;          /**< NULL: not stated */
    char outputs_pdo[8], inputs_pdo[8]; /**< "": not stated */
    char limit_positive[CM1E_SIGNAL_LENGTH], limit_negative[CM1E_SIGNAL_LENGTH], home[CM1E_SIGNAL_LENGTH];
    cm1e_busfile_signal_name_t input_signals[CM1E_WIRED_SIGNALS], output_signals[CM1E_WIRED_SIGNALS];
    uint32_t input_count, output_count;
    int velocity_unit;     /**< 0: not stated */
    int acceleration_unit; /**< 1: kcounts/s2 */
} cm1e_busfile_axis_t;

/** An object, a PDO, an entry: "0x6000:01", "0x1A00", "0x6000:01/16", "gap/8". */
typedef char cm1e_busfile_text_t[24];

typedef struct cm1e_busfile_sdo {
    cm1e_busfile_text_t object;
    char type[8], value[32];
    int before_op;
} cm1e_busfile_sdo_t;

enum { CM1E_BUSFILE_PDO_ENTRIES = 32 };

typedef struct cm1e_busfile_mapping {
    cm1e_busfile_text_t pdo;
    cm1e_busfile_text_t entries[CM1E_BUSFILE_PDO_ENTRIES];
    uint32_t count;
} cm1e_busfile_mapping_t;

typedef struct cm1e_busfile_signal {
    char name[CM1E_NAME_LENGTH];
    cm1e_busfile_text_t object; /**< "": by its bit */
    uint16_t *bit;              /**< NULL: by its object */
    uint16_t bits;
    char type[8], safe[32];     /**< "": not stated */
} cm1e_busfile_signal_t;

/** One slave of the file: values that are copied into the configuration, and values that are converted. */
typedef struct cm1e_busfile_slave {
    cm1e_slave_config_t slave;
    uint16_t position, alias, explicit_id;
    char vendor[12], product[12], revision[12];
    char esi[256], esi_mode[64]; /**< "": not stated */
    uint32_t sdo_count, mapping_count, outputs_pdo_count, inputs_pdo_count, output_count, input_count,
        module_count;
    cm1e_busfile_text_t modules[CM1E_SLAVE_MODULES];
    cm1e_busfile_sdo_t sdos[CM1E_SLAVE_SDOS];
    cm1e_busfile_mapping_t mappings[CM1E_SLAVE_PDOS];
    cm1e_busfile_text_t outputs_pdos[CM1E_SLAVE_PDOS], inputs_pdos[CM1E_SLAVE_PDOS];
    cm1e_busfile_signal_t outputs[CM1E_SLAVE_SIGNALS], inputs[CM1E_SLAVE_SIGNALS];
} cm1e_busfile_slave_t;

typedef struct cm1e_busfile {
    cm1e_bus_config_t config; /**< without axes and slaves */
    uint32_t cycle_time_us, frame_timeout_us;
    uint32_t axis_count;
    cm1e_busfile_axis_t *axes;
    uint32_t slave_count;
    cm1e_busfile_slave_t *slaves;
} cm1e_busfile_t;

/** A file with `buses`. */
typedef struct cm1e_busfile_several {
    cm1e_busfile_t *buses;
    uint32_t count;
} cm1e_busfile_several_t;

extern const cyaml_schema_value_t cm1e_busfile_schema, cm1e_busfile_several_schema;

/** Range of a whole number by its key. */
typedef struct cm1e_busfile_integer_range {
    const char *key;
    int64_t minimum, maximum;
} cm1e_busfile_integer_range_t;
extern const cm1e_busfile_integer_range_t cm1e_busfile_integer_ranges[];
/** Keys of numbers for which 0 is a valid value; for the others 0 would silently select the default. Ends with NULL. */
extern const char *const cm1e_busfile_zero_allowed[];

/** Compares every node of the document with the schema. Numbers are read in the thread's locale: it must be "C". */
bool cm1e_busfile_compare(yaml_document_t *document, const cyaml_schema_value_t *schema,
                          cm1e_config_problem_t *problem);

/* ---- load*.c: conversion -------------------------------------------------------------------------------------- */

/** The configurations that are loaded from a file. */
typedef struct cm1e_busfile_loaded {
    cm1e_bus_config_t buses[CM1E_MAX_BUSES];
    uint32_t count;
    const char *path; /**< of the file */
} cm1e_busfile_loaded_t;

/** Makes the configuration of one bus. Axes without a name are numbered from `first_axis` on. */
bool cm1e_busfile_convert(cm1e_bus_config_t *config, const cm1e_busfile_t *from, uint32_t first_axis,
                          const char *path, cm1e_config_problem_t *problem);
/** Makes the configurations of several buses, and checks what they have in common. */
bool cm1e_busfile_convert_several(cm1e_busfile_loaded_t *loaded, const cm1e_busfile_several_t *from,
                                  cm1e_config_problem_t *problem);

/** There is no memory; returns false. */
bool cm1e_busfile_no_memory(cm1e_config_problem_t *problem);
/** Takes the one address that is stated of position, alias and explicit ID; 0: the others are. false: more than one
 *  is. `list`: "axes" or "slaves". */
bool cm1e_busfile_convert_address(const uint16_t stated[3], cm1e_address_kind_t *kind, uint16_t *address,
                                  const char *list, uint32_t index, cm1e_config_problem_t *problem);
/** Takes the inputs of switches, by number or by signal, and the signals on other slaves (load_wiring.c). `index`: of
 *  the axis in the list. */
bool cm1e_busfile_convert_wiring(cm1e_axis_config_t *axis, const cm1e_busfile_axis_t *from, uint32_t index,
                                 cm1e_config_problem_t *problem);
/** Adds the slaves of the file to the configuration. The path of an ESI is as seen from the folder of `path`, the bus
 *  file. */
bool cm1e_busfile_convert_slaves(cm1e_bus_config_t *config, const cm1e_busfile_t *from, const char *path,
                                 cm1e_config_problem_t *problem);

#endif
