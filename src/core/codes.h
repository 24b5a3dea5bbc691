/**
 * @file codes.h
 * The tables behind cm1e_sdo_abort_text(), cm1e_al_status_text() and cm1e_foe_error_text(), and what the user does
 * about each error.
 */
#ifndef CM1E_CORE_CODES_H
#define CM1E_CORE_CODES_H

#include <stddef.h>
#include <stdint.h>

#include "cm1e/error.h"

typedef struct cm1e_code {
    uint32_t code;
    const char *text;
    const char *cure; /**< ours; the standards have none */
} cm1e_code_t;

#define CM1E_SDO_ABORT_CLAUSE "ETG.1000.6 table 41"
#define CM1E_FOE_ERROR_CLAUSE "ETG.1000.6 section 5.8"
#define CM1E_AL_STATUS_CLAUSE "ETG.1000.6 table 11, ETG.1020"

const cm1e_code_t *cm1e_sdo_abort_codes(size_t *count);
const cm1e_code_t *cm1e_al_status_codes(size_t *count);
const cm1e_code_t *cm1e_foe_error_codes(size_t *count);

/** One row of CM1E_ERRORS. */
typedef struct cm1e_error_row {
    cm1e_error_t error;
    const char *name; /**< "ERROR_AXIS_LAG" */
    const char *text;
} cm1e_error_row_t;
const cm1e_error_row_t *cm1e_error_rows(size_t *count);

/** What the user does about an error; "" where there is nothing to do. */
const char *cm1e_error_cure(cm1e_error_t error);

#endif
