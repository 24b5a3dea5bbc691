/**
 * @file ec_extend.h
 * EC_EXTEND.txt, with which Trio controllers learn of a device (UG 11.2): document, reader, writer, and the document
 * that describes our devices. Any thread.
 */
#ifndef CM1E_GENERATE_EC_EXTEND_H
#define CM1E_GENERATE_EC_EXTEND_H

#include "cm1e/generate.h"
#include "description/check.h"
#include "description/description.h"

/** The document as it stands in the file. Valid when zeroed. */
typedef struct cm1e_ec_extend {
    cm1e_arena_t arena;
} cm1e_ec_extend_t;

void cm1e_ec_extend_free(cm1e_ec_extend_t *document);
cm1e_error_t cm1e_ec_extend_read(cm1e_ec_extend_t *document, const void *bytes, size_t size, cm1e_diag_t *diag);
cm1e_error_t cm1e_ec_extend_write(cm1e_file_t *out, const cm1e_ec_extend_t *document, cm1e_diag_t *diag);
/** The document for the devices of the options. */
cm1e_error_t cm1e_ec_extend_make(cm1e_ec_extend_t *document, const cm1e_generate_options_t *options,
                                 cm1e_diag_t *diag);
/** References that lead nowhere, lengths that do not fit, sync managers; and our own devices against their tables. */
void cm1e_ec_extend_check(cm1e_findings_t *findings, const cm1e_ec_extend_t *document);
/** Compares the profile for this device, if there is one, with what the live device says of itself. */
void cm1e_ec_extend_compare(cm1e_findings_t *findings, const cm1e_ec_extend_t *document,
                            const cm1e_description_t *device);

#endif
