/**
 * A judge of every diagnosis that any test meets: the linker puts it in front of cm1e_diag_set(). The foreign code is one of the
 * kind that its error has (cm1e/error.h), or 0, and an error has a text.
 */
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/error.h"

cm1e_error_t __real_cm1e_diag_set(cm1e_diag_t *diag, cm1e_error_t error, uint32_t foreign_code, const char *format, ...);
cm1e_error_t __wrap_cm1e_diag_set(cm1e_diag_t *diag, cm1e_error_t error, uint32_t foreign_code, const char *format, ...);

static bool may_have(cm1e_error_t error, uint32_t code)
{
    enum { FIRST_OBJECT = 0x1000, LAST_OBJECT = 0xFFFF };
    switch (error) {
    case CM1E_ERROR_SDO_ABORT:
    case CM1E_ERROR_BUS_STATE:
    case CM1E_ERROR_BUS_MAILBOX:
    case CM1E_ERROR_INTERFACE_IN_USE:
    case CM1E_ERROR_IO: return true;
    case CM1E_ERROR_PDO_MAPPING:
    case CM1E_ERROR_CONFIG: return code >= FIRST_OBJECT && code <= LAST_OBJECT;
    default: return false;
    }
}

cm1e_error_t __wrap_cm1e_diag_set(cm1e_diag_t *diag, cm1e_error_t error, uint32_t foreign_code, const char *format, ...)
{
    char text[4 * sizeof diag->text];
    va_list args;
    va_start(args, format);
    const int length = vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if ((length <= 0 && error != CM1E_OK) || (foreign_code != 0 && !may_have(error, foreign_code))) {
        fprintf(stderr, "a diagnosis of \"%s\" with the foreign code 0x%X: %s\n", cm1e_strerror(error),
                (unsigned)foreign_code, text);
        abort();
    }
    return __real_cm1e_diag_set(diag, error, foreign_code, "%s", text);
}
