/**
 * @file st.h
 * The translator of Structured Text (IEC 61131-3, 3rd edition): sources in, C11 out. It knows the function blocks of
 * the library from fb/interface/, which is Structured Text itself. One thread uses a translation at a time.
 */
#ifndef CM1E_ST_H
#define CM1E_ST_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "cm1e/error.h"

typedef struct st st_t;

/** A translation without sources, which knows the blocks of the library. */
st_t *cm1e_st_new(void);
/** A translation that knows no blocks and begins faster: for tests. */
st_t *cm1e_st_new_bare(void);
void cm1e_st_free(st_t *st);
/** How many variables others see by their names while the program runs (10000). */
void cm1e_st_list_most(st_t *st, uint64_t count);
/** Adds a source file. Errors within it are reported; an error of this function is one of reading the file. */
cm1e_error_t cm1e_st_add_file(st_t *st, const char *path, cm1e_diag_t *diag);
/** Adds a source that is in memory. */
void cm1e_st_add_text(st_t *st, const char *name, const char *text, size_t size);
/** Checks all sources together. True: there are no errors. */
bool cm1e_st_check(st_t *st);
/** After a cm1e_st_check() without errors: whether a PROGRAM runs. */
bool cm1e_st_runs(const st_t *st);
/** Writes the program as one C file, after cm1e_st_check(). */
void cm1e_st_emit(st_t *st, FILE *file, const char *name);
/** Number of errors that are kept; further ones are counted by cm1e_st_suppressed(). */
unsigned cm1e_st_errors(const st_t *st);
unsigned cm1e_st_suppressed(const st_t *st);
/** Error `n` (0 = first) by line: "program.st:3:5: error: ...", then the line and a mark below the column. */
void cm1e_st_print_error(const st_t *st, unsigned n, FILE *file);
/** Error `n` alone: file, line, column and text. */
typedef struct st_error {
    const char *file, *text;
    uint32_t line, column;
} st_error_t;
st_error_t cm1e_st_error(const st_t *st, unsigned n);
/** What a literal means. */
typedef struct st_literal {
    const char *type;  /**< "TIME", "INT" ...; "": a number without a type */
    bool is_real, is_time;
    bool huge;         /**< above 2^63 - 1: `integer` is it less 2^64 */
    int64_t integer;   /**< also of a BOOL; of times in ns */
    double real;
} st_literal_t;
/** Reads a literal as a program has it: 16#FF, T#1m5s, INT#5. False: it is none, `why` says what is right. */
bool cm1e_st_read_literal(const char *text, st_literal_t *literal, char *why, size_t size);
/** A number that changes with the interface of the blocks: a program runs only with the library it was made for. */
uint64_t cm1e_st_interface(void);

#endif
