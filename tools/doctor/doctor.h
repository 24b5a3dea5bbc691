/**
 * @file doctor.h
 * What `cm1e doctor` looks at. Every look adds findings to one list; the command prints the list. Nothing is changed on
 * the machine, and no motor moves.
 */
#ifndef CM1E_TOOLS_DOCTOR_H
#define CM1E_TOOLS_DOCTOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "attach.h"
#include "cm1e/bus.h"
#include "cm1e/config.h"

typedef enum finding_level {
    FINDING_GOOD = 0, /**< as it should be */
    FINDING_NOTE,     /**< worth knowing */
    FINDING_ADVICE,   /**< it works, and would work better */
    FINDING_PROBLEM,  /**< it does not work, or not safely */
} finding_level_t;

enum { FINDINGS_MAX = 256, FINDING_FACT_BYTES = 400 };

typedef struct finding {
    finding_level_t level;
    const char *group, *subject;    /**< "machine", "clock source"; static */
    char fact[FINDING_FACT_BYTES];  /**< what was seen */
    const char *why;                /**< why it matters; static, NULL: nothing to say */
    char action[FINDING_FACT_BYTES]; /**< what to do, in words; "" */
    char fix[FINDING_FACT_BYTES];   /**< shell commands that do it; "": a person must */
} finding_t;

typedef struct doctor {
    const char *root;               /**< folder in which proc, sys and run are looked at; "" */
    finding_t findings[FINDINGS_MAX];
    int count;
} doctor_t;

/** Adds a finding without an action; returns it. A list that is full keeps its last place for all further ones. */
finding_t *doctor_find(doctor_t *doctor, finding_level_t level, const char *group, const char *subject,
                       const char *format, ...) __attribute__((format(printf, 5, 6)));
/** Adds to a finding why it matters, what to do, and the commands that do it ("" : none). */
void doctor_advise(finding_t *finding, const char *why, const char *action, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
const char *doctor_level_name(finding_level_t level);

/** The first line of a file below the root, without its line end; false: it cannot be read. */
bool doctor_line(const doctor_t *doctor, char *line, size_t size, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/** Whether a file or folder is there. */
bool doctor_exists(const doctor_t *doctor, const char *format, ...) __attribute__((format(printf, 2, 3)));
/** Whether this user may write the file. */
bool doctor_may_write(const doctor_t *doctor, const char *format, ...) __attribute__((format(printf, 2, 3)));

/** Kernel, processors, clock, privileges. */
void doctor_look_at_machine(doctor_t *doctor);
/** How late this thread wakes up now, beside the cycle time. Takes `seconds`. */
void doctor_measure_latency(doctor_t *doctor, int64_t cycle_time_ns, double seconds);
/** The network interface, before anything is sent on it. Returns false if there is none of this name. */
bool doctor_look_at_interface(doctor_t *doctor, const char *name);
/** The slaves, their connections, and the bus file against what is there. If a program has the network, it is asked. */
void doctor_look_at_bus(doctor_t *doctor, const common_options_t *options, const cm1e_bus_config_t *config);
/** Which processors serve the interrupts of the card. */
void doctor_look_at_interrupts(doctor_t *doctor, const char *name);

#endif
