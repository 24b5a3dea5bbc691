/**
 * @file eni.h
 * EtherCAT network information (ETG.2100): a whole network with the frames that start it and run it, as a configuration
 * tool hands it to a master. Any thread.
 */
#ifndef CM1E_GENERATE_ENI_H
#define CM1E_GENERATE_ENI_H

#include "cm1e/generate.h"
#include "description/check.h"
#include "description/description.h"

/** The document. Valid when zeroed. */
typedef struct cm1e_eni {
    cm1e_arena_t arena;
} cm1e_eni_t;

/** One slave of the network that an ENI is made for, in the order of the wire. */
typedef struct cm1e_eni_slave {
    const cm1e_description_t *device; /**< identity, sync managers, PDOs with their default assignment, start-up commands */
    const char *name;                 /**< in the network: "x_axis"; must be unique */
    uint16_t alias;                   /**< configured station alias by which it is to be found; 0: by position */
} cm1e_eni_slave_t;

void cm1e_eni_free(cm1e_eni_t *document);
cm1e_error_t cm1e_eni_read(cm1e_eni_t *document, const void *bytes, size_t size, cm1e_diag_t *diag);
cm1e_error_t cm1e_eni_write(cm1e_file_t *out, const cm1e_eni_t *document, cm1e_diag_t *diag);
cm1e_error_t cm1e_eni_make(cm1e_eni_t *document, const cm1e_eni_slave_t *slaves, size_t count, int64_t cycle_time_ns,
                           cm1e_diag_t *diag);
void cm1e_eni_check(cm1e_findings_t *findings, const cm1e_eni_t *document);
/** Compares the slave at `position` (1 = first) with what the live device says of itself. */
void cm1e_eni_compare(cm1e_findings_t *findings, const cm1e_eni_t *document, uint16_t position,
                      const cm1e_description_t *device);

#endif
