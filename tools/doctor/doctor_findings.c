#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "doctor/doctor.h"

finding_t *doctor_find(doctor_t *doctor, finding_level_t level, const char *group, const char *subject,
                       const char *format, ...)
{
    va_list arguments;
    if (doctor->count < FINDINGS_MAX)
        doctor->count++;
    finding_t *finding = &doctor->findings[doctor->count - 1];
    *finding = (finding_t){.level = level, .group = group, .subject = subject};
    va_start(arguments, format);
    vsnprintf(finding->fact, sizeof finding->fact, format, arguments);
    va_end(arguments);
    return finding;
}

void doctor_advise(finding_t *finding, const char *why, const char *action, const char *format, ...)
{
    va_list arguments;
    finding->why = why;
    snprintf(finding->action, sizeof finding->action, "%s", action);
    va_start(arguments, format);
    vsnprintf(finding->fix, sizeof finding->fix, format, arguments);
    va_end(arguments);
}

const char *doctor_level_name(finding_level_t level)
{
    static const char *const names[] = {"ok", "note", "advice", "problem"};
    return names[level];
}

static bool path_of(const doctor_t *doctor, char *path, size_t size, const char *format, va_list arguments)
{
    const int root = snprintf(path, size, "%s", doctor->root);
    const int rest =
        root >= 0 && (size_t)root < size ? vsnprintf(path + root, size - (size_t)root, format, arguments) : -1;
    return rest >= 0 && (size_t)root + (size_t)rest < size;
}

bool doctor_line(const doctor_t *doctor, char *line, size_t size, const char *format, ...)
{
    char path[512];
    va_list arguments;
    line[0] = '\0';
    va_start(arguments, format);
    const bool fits = path_of(doctor, path, sizeof path, format, arguments);
    va_end(arguments);
    FILE *file = fits ? fopen(path, "r") : NULL;
    if (!file)
        return false;
    const bool read = fgets(line, (int)size, file) != NULL;
    fclose(file);
    line[strcspn(line, "\n")] = '\0';
    return read;
}

static bool may(const doctor_t *doctor, int access_mode, const char *format, va_list arguments)
{
    char path[512];
    return path_of(doctor, path, sizeof path, format, arguments) && access(path, access_mode) == 0;
}

bool doctor_exists(const doctor_t *doctor, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const bool exists = may(doctor, F_OK, format, arguments);
    va_end(arguments);
    return exists;
}

bool doctor_may_write(const doctor_t *doctor, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const bool writable = may(doctor, W_OK, format, arguments);
    va_end(arguments);
    return writable;
}
