/**
 * @file fuzz_complain.h
 * For targets of what the command reads: its complaints say something. Included by one source of a target, which has the
 * sources of the command that it needs, but not the command's own complain().
 */
#ifndef CM1E_TESTS_FUZZ_COMPLAIN_H
#define CM1E_TESTS_FUZZ_COMPLAIN_H

#include <stdarg.h>
#include <stdio.h>

#include "command.h"
#include "fuzz.h"

static unsigned complaints;

void complain(const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    complaints++;
    if (length <= 0)
        fuzz_fail("a complaint that says nothing");
}

int fail(const cm1e_diag_t *diag)
{
    complain("%s", diag->text[0] ? diag->text : cm1e_strerror(diag->error));
    return EXIT_FAILED;
}

#endif
