/**
 * @file st_embedded.h
 * Files that are part of the program: the interface of the function blocks, and the run-time part of translated
 * programs.
 */
#ifndef CM1E_ST_EMBEDDED_H
#define CM1E_ST_EMBEDDED_H

typedef struct embedded {
    const char *name;
    const char *begin, *end;
    const char *symbol; /**< prefix of the symbols of its blocks */
    int library;        /**< 1: its blocks are in Structured Text, and no symbols */
} embedded_t;

/** The last one has no begin. */
extern const embedded_t cm1e_st_interface_parts[];
extern const char cm1e_st_runtime_begin[], cm1e_st_runtime_end[], cm1e_st_program_begin[], cm1e_st_program_end[];

#endif
