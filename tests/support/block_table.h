/**
 * @file block_table.h
 * Every function block of the public headers as data, for tests that walk all of them: block_table.c is generated from
 * the ST declarations in fb/interface/. Linking it proves that no declared block lacks its function.
 */
#ifndef CM1E_TESTS_BLOCK_TABLE_H
#define CM1E_TESTS_BLOCK_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "cm1e/iec.h"
#include "cm1e/plcopen.h"

typedef enum block_section { BLOCK_IN_OUT = 0, BLOCK_INPUT, BLOCK_OUTPUT } block_section_t;

typedef enum block_type {
    BLOCK_BOOL = 0, BLOCK_INT, BLOCK_UINT, BLOCK_DINT, BLOCK_UDINT, BLOCK_WORD, BLOCK_DWORD, BLOCK_LREAL, BLOCK_TIME,
    BLOCK_ENUM, BLOCK_STRUCT, BLOCK_POINTER, BLOCK_STRING,
} block_type_t;

typedef struct block_member {
    const char *name;
    block_section_t section;
    block_type_t type;
    size_t offset, size;
} block_member_t;

/** What becomes of a command that is given in a state (fb/interface/classes.md). */
typedef struct block_rule {
    bool unchanged;         /**< the block never changes the state */
    cm1e_error_t refusal;   /**< CM1E_OK: taken, and the axis is in `next` then */
    cm1e_axis_state_t next;
} block_rule_t;

typedef struct block {
    const char *name;
    size_t size;
    void (*call)(void *fb);
    const block_member_t *members;
    size_t member_count;
    const block_rule_t *rules; /**< by cm1e_axis_state_t; NULL: the block's page says it in words */
    const cm1e_error_t *errors; /**< those of its page; CM1E_OK ends them */
} block_t;

extern const block_t block_table[];
extern const size_t block_count;

#endif
