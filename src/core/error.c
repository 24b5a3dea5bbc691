#include "cm1e/error.h"

#include <stdarg.h>
#include <stdio.h>

#include "core/codes.h"
#include "core/text.h"

static const cm1e_error_row_t errors[] = {
#define ERROR_ROW(name, value, text) {CM1E_##name, #name, text},
    CM1E_ERRORS(ERROR_ROW)
#undef ERROR_ROW
};
enum { ERROR_COUNT = sizeof errors / sizeof errors[0] };

const cm1e_error_row_t *cm1e_error_rows(size_t *count)
{
    *count = ERROR_COUNT;
    return errors;
}

const char *cm1e_strerror(cm1e_error_t error)
{
    for (int i = 0; i < ERROR_COUNT; i++)
        if (errors[i].error == error)
            return errors[i].text;
    return "unknown error number";
}

uint16_t cm1e_error_id(cm1e_error_t error)
{
    return error == CM1E_OK ? 0 : (uint16_t)(CM1E_ERROR_ID_BASE - (int)error);
}

cm1e_error_t cm1e_error_from_id(uint16_t error_id)
{
    for (int i = 0; i < ERROR_COUNT; i++)
        if (cm1e_error_id(errors[i].error) == error_id)
            return errors[i].error;
    return CM1E_ERROR_NOT_FOUND;
}

cm1e_error_t cm1e_diag_set(cm1e_diag_t *diag, cm1e_error_t error, uint32_t foreign_code, const char *format, ...)
{
    if (diag) {
        diag->error = error;
        diag->foreign_code = foreign_code;
        va_list args;
        va_start(args, format);
        vsnprintf(diag->text, sizeof diag->text, format, args);
        va_end(args);
        cm1e_text_clean(diag->text);
    }
    return error;
}
