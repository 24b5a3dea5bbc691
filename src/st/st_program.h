/**
 * @file st_program.h
 * What a program translated from Structured Text shows to the one that runs it: the symbol cm1e_st_program. This text
 * is part of every translated program, and of the command that loads it.
 */
#ifndef CM1E_ST_PROGRAM_H
#define CM1E_ST_PROGRAM_H

#include <stdint.h>

enum { ST_PROGRAM_VERSION = 3 };

typedef enum st_kind {
    ST_KIND_BOOL, ST_KIND_SINT, ST_KIND_INT, ST_KIND_DINT, ST_KIND_LINT, ST_KIND_USINT, ST_KIND_UINT, ST_KIND_UDINT,
    ST_KIND_ULINT, ST_KIND_REAL, ST_KIND_LREAL, ST_KIND_TIME, ST_KIND_STRING, ST_KIND_WSTRING, ST_KIND_OTHER,
} st_kind_t;

/** A variable by its name. Of an axis or a group: the reference that gets its handle before the program runs. */
typedef struct st_variable {
    const char *name;
    void *data;
    uint32_t size;
    st_kind_t kind;
    const char *detail; /**< type, or address */
    int bit;            /**< it is one bit of a byte: 1 = bit 0; else 0 */
    int ranged;         /**< its values are first ... last */
    int64_t first, last;
    const char *const *names;  /**< of an enumeration: its enumerators */
    const int64_t *values;
    uint32_t name_count;
} st_variable_t;

typedef struct st_task {
    const char *name;
    int64_t interval_ns; /**< 0: every cycle of the bus */
    uint32_t priority;
    void (*run)(void);   /**< returns at once after a fault */
} st_task_t;

/** Why the program was stopped. */
typedef struct st_fault {
    int happened;
    const char *file;
    unsigned line;
    const char *text;    /**< a format for the values */
    long long values[3];
} st_fault_t;

typedef struct st_list {
    const st_variable_t *first;
    uint32_t count;
} st_list_t;

typedef struct st_program {
    uint32_t version;
    uint64_t interface;       /**< of the blocks that it was translated for */
    uint64_t layout;          /**< of the retained variables */
    const char *name;
    void (*begin)(void);      /**< gives all variables their initial values */
    const st_task_t *tasks;
    uint32_t task_count;
    st_list_t variables, axes, groups, located, retained;
    uint64_t unlisted;        /**< variables for which the table was too small */
    st_fault_t *fault;
    int64_t *loop_limit;      /**< passes through loops in one call of a task */
} st_program_t;

#endif
