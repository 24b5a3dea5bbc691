/* How a problem is told: its path, then the names of axis and key, then what is wrong and what is expected. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "config/ranges.h"

bool cm1e_config_axis_wrong(const check_t *check, const char *key, const char *format, ...)
{
    snprintf(check->problem->path, sizeof check->problem->path, "axes[%u].%s", check->index, key);
    int length = snprintf(check->problem->text, sizeof check->problem->text, "axis %s: %s ", check->name, key);
    va_list args;
    va_start(args, format);
    vsnprintf(check->problem->text + length, sizeof check->problem->text - (size_t)length, format, args);
    va_end(args);
    return false;
}

bool cm1e_config_is_text(const char *text, size_t size)
{
    const char *end = memchr(text, '\0', size);
    if (!end)
        return false;
    for (const char *p = text; p < end; p++)
        if ((unsigned char)*p < 0x20 || *p == 0x7F)
            return false;
    return true;
}
