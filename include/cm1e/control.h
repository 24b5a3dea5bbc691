/**
 * @file control.h
 * The control socket (docs/CONTROL.md). A program that links cm1e::control and runs a scheduler can be watched by
 * others while it runs, unless its configuration says `control: none`; these functions are for the others. They wait,
 * so none of them belongs in a task. One thread uses a connection.
 */
#ifndef CM1E_CONTROL_H
#define CM1E_CONTROL_H

#include <stdbool.h>

#include "cm1e/api.h"
#include "cm1e/bus.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Gives every run of a scheduler a control socket. The CMake target and pkg-config's cm1e-control do it; a program
 *  that is linked by hand calls it before cm1e_scheduler_run(). @rt init */
CM1E_API void cm1e_control_register(void);

/** true: connections from this process may do everything, whatever `control` says of others, in runs that begin from
 *  now on. For a program that is its own control panel. @rt init */
CM1E_API void cm1e_control_serve_own(bool serve);

/** A connection to a running program. */
typedef struct cm1e_control cm1e_control_t;

/** Connects to a running program. `target` is the path of its socket or the number of its process; NULL: the program
 *  that has the network interface `interface_name`. CM1E_ERROR_NOT_FOUND: nobody has it; CM1E_ERROR_TIMEOUT: the
 *  program is suspended; CM1E_ERROR_INTERFACE_IN_USE: somebody has the interface and cannot be asked, `diag` says why.
 *  @rt block */
CM1E_API cm1e_error_t cm1e_control_connect(cm1e_control_t **control, const char *target, const char *interface_name,
                                           cm1e_diag_t *diag);
/** Sends a request and waits for its reply, both JSON texts. `*reply` is to be freed; it is set also where the program
 *  refuses the request, whose error is returned then. @rt block */
CM1E_API cm1e_error_t cm1e_control_ask(cm1e_control_t *control, const char *request, char **reply, cm1e_diag_t *diag);
/** NULL is allowed. @rt block */
CM1E_API void cm1e_control_close(cm1e_control_t *control);

/** Makes a bus of a connection, instead of cm1e_bus_open(): cm1e_bus_scan() shows the slaves as the running program
 *  found them, cm1e_sdo_read() and cm1e_sdo_write() pass through its cycle, and whatever needs the network for itself
 *  returns CM1E_ERROR_INTERFACE_IN_USE. `config` is copied. The bus owns the connection from then on, and closes it
 *  after an error too. @rt block */
CM1E_API cm1e_error_t cm1e_bus_open_attached(cm1e_bus_t **bus, const cm1e_bus_config_t *config,
                                             cm1e_control_t *control, cm1e_diag_t *diag);
/** Whether a bus is attached to another program. @rt any */
CM1E_API bool cm1e_bus_is_attached(const cm1e_bus_t *bus);

#ifdef __cplusplus
}
#endif
#endif
