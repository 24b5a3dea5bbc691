/**
 * @file st_retain.h
 * The RETAIN variables of a program in Structured Text, in a file. The cycle copies them once a second, a thread writes
 * the copy, so at most the last seconds before a power failure are lost; the file is always a whole one.
 */
#ifndef CM1E_TOOLS_ST_RETAIN_H
#define CM1E_TOOLS_ST_RETAIN_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#include "cm1e/error.h"
#include "st/st_program.h"

typedef struct st_retain {
    const st_program_t *program;
    char path[4096];
    unsigned char *copy, *written; /**< owned; what the cycle has copied, and what the file has */
    size_t size;
    int file;                      /**< the present file, locked; -1: there is none yet */
    atomic_int state;              /**< 0: the cycle may copy; 1: the thread may write */
    int64_t copied_ns;             /**< when the cycle copied last */
    atomic_bool end, failed;
    bool started;                  /**< the thread runs */
    pthread_t thread;
} st_retain_t;

/** Takes the values of the file, if there is one and `cold` is false. CM1E_ERROR_CONFIG: it is of another layout;
 *  CM1E_ERROR_STATE: another program that runs has it; CM1E_ERROR_IO: it cannot be read, is damaged, or cannot be written. `program` has begun. @rt init */
cm1e_error_t st_retain_begin(st_retain_t *retain, const st_program_t *program, const char *path, bool cold,
                             cm1e_diag_t *diag);
/** At the end of a task. @rt cycle */
void st_retain_cycle(st_retain_t *retain, int64_t now_ns);
/** After the run: writes the last values. @rt init */
cm1e_error_t st_retain_end(st_retain_t *retain, cm1e_diag_t *diag);

#endif
