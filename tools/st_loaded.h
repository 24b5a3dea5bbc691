/**
 * @file st_loaded.h
 * A program that was translated from Structured Text, loaded into this process: its tasks become tasks of a scheduler,
 * its axes get their handles by the names of the bus file, its variables can be traced.
 */
#ifndef CM1E_TOOLS_ST_LOADED_H
#define CM1E_TOOLS_ST_LOADED_H

#include "cm1e/scheduler.h"
#include "scheduler/variables.h"
#include "st/st_program.h"
#include "st_located.h"
#include "st_retain.h"

typedef struct st_loaded {
    void *library;
    const st_program_t *program;
    cm1e_scheduler_t *scheduler;
    struct st_running_task {
        struct st_loaded *loaded;
        void (*run)(void);
    } tasks[CM1E_MAX_TASKS];
    st_located_t located;
    st_retain_t retain;
    variable_t *variables;    /**< those of the program, for others; owned */
    const char *const *paths; /**< variables that the trace records, or instances of which it records all; 0: the first */
    int path_count;
    uint32_t untraced;        /**< variables beyond what a trace can have */
} st_loaded_t;

/** Loads the program. CM1E_ERROR_NOT_FOUND: there is no file that can be read; CM1E_ERROR_INVALID_ARGUMENT: its name is that
 *  of a source; CM1E_ERROR_IO: it is no program, or not a whole one; CM1E_ERROR_UNSUPPORTED: it was made for another version
 *  of the library. @rt init */
cm1e_error_t st_load(st_loaded_t *loaded, const char *path, cm1e_diag_t *diag);
/** Adds an axis of each name that the program has to a configuration without axes: a machine to try the program on. At
 *  least one, because an empty segment has nothing to run. @rt init */
cm1e_error_t st_simulated_machine(const st_loaded_t *loaded, cm1e_bus_config_t *config, cm1e_diag_t *diag);
/** Binds axes and located variables, and adds the tasks. @rt init */
cm1e_error_t st_attach(st_loaded_t *loaded, cm1e_scheduler_t *scheduler, cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Before anything is started: gives the variables their initial values, and the RETAIN variables those of the file.
 *  @rt init */
cm1e_error_t st_begin(st_loaded_t *loaded, const char *retain_path, bool cold, cm1e_diag_t *diag);
/** "" or why the program was stopped: "machine.st:12: the index 11 is outside 1..10". @rt block */
void st_fault_text(const st_loaded_t *loaded, char *text, size_t size);
void st_unload(st_loaded_t *loaded);

#endif
