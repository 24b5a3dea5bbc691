/**
 * @file console_call.h
 * One line of the console of a simulated segment, and what its commands share. Private to this room.
 *   console.c        the grammar, the table, commands on drives and bridges
 *   console_slave.c  commands on any slave, its supply and cables, and on the frames
 */
#ifndef CM1E_SIM_CONSOLE_CALL_H
#define CM1E_SIM_CONSOLE_CALL_H

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sim/cia402_app.h"
#include "sim/cm1e_app.h"
#include "sim/segment.h"

enum { LINE_MAX_BYTES = 128, WORDS_MAX = 6 };

typedef struct call {
    cm1e_sim_segment_t *segment;
    char words[WORDS_MAX][LINE_MAX_BYTES];
    int count;               /* words */
    uint32_t position;       /* of the slave named, where the command takes one */
    cm1e_sim_slave_t *slave;
    cm1e_sim_cm1e_t *drive;
    cm1e_sim_cia402_t *other; /* a drive of another maker */
    char *answer;
    size_t size, used;
    bool cut;                /* the answer was longer than its room */
} call_t;

__attribute__((format(printf, 2, 3))) static inline void say(call_t *call, const char *format, ...)
{
    if (call->used + 1 >= call->size) {
        call->cut = true;
        return;
    }
    va_list args;
    va_start(args, format);
    const int length = vsnprintf(call->answer + call->used, call->size - call->used, format, args);
    va_end(args);
    const size_t room = call->size - call->used - 1;
    if (length <= 0)
        return;
    call->cut |= (size_t)length > room;
    call->used += (size_t)length < room ? (size_t)length : room;
}

#define REFUSE(call, ...) (say(call, __VA_ARGS__), CM1E_ERROR_INVALID_ARGUMENT)

/* ---- words into numbers ----------------------------------------------------------------------------------------- */

/* The n-th argument behind command and slave, "" where it is missing. */
static inline const char *argument(const call_t *call, int n)
{
    const int i = n + (call->slave ? 2 : 1);
    return i < call->count ? call->words[i] : "";
}

static inline bool parse_whole(const char *word, int base, long least, long most, long *value)
{
    char *end;
    if (base == 16 && (word[0] == '0') && (word[1] == 'x' || word[1] == 'X'))
        word += 2;
    for (const char *c = word; *c; c++)
        if (*c == ' ' || (base == 16 && (*c == '-' || *c == '+' || *c == 'x' || *c == 'X')))
            return false;
    *value = strtol(word, &end, base);
    return end != word && *end == '\0' && *value >= least && *value <= most;
}

static inline bool parse_real(const char *word, double least, double most, double *value)
{
    char *end;
    *value = strtod(word, &end);
    return end != word && *end == '\0' && isfinite(*value) && *value >= least && *value <= most;
}

/* The place of a word in a list that ends with NULL; -1: not there. */
static inline int choice(const char *word, const char *const *list)
{
    for (int i = 0; list[i]; i++)
        if (strcmp(word, list[i]) == 0)
            return i;
    return -1;
}

/* ---- console_slave.c -------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_console_emergency(call_t *call);
cm1e_error_t cm1e_console_quirk(call_t *call);
cm1e_error_t cm1e_console_power_cycle(call_t *call);
cm1e_error_t cm1e_console_unplug(call_t *call);
cm1e_error_t cm1e_console_replug(call_t *call);
cm1e_error_t cm1e_console_detach(call_t *call);
cm1e_error_t cm1e_console_attach(call_t *call);
cm1e_error_t cm1e_console_damage(call_t *call);
cm1e_error_t cm1e_console_lose(call_t *call);
cm1e_error_t cm1e_console_corrupt(call_t *call);
cm1e_error_t cm1e_console_delay(call_t *call);
cm1e_error_t cm1e_console_firmware(call_t *call);
cm1e_error_t cm1e_console_clock(call_t *call);
cm1e_error_t cm1e_console_input(call_t *call);

#endif
