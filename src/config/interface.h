/**
 * @file interface.h
 * The kinds of interface names.
 */
#ifndef CM1E_CONFIG_INTERFACE_H
#define CM1E_CONFIG_INTERFACE_H

#include <stdbool.h>
#include <string.h>

#define CM1E_SIM_INTERFACE "sim"
#define CM1E_SIM_FILE_PREFIX "sim:" /**< followed by the path of a bus file that describes the segment */

/** Whether a name is that of a simulated segment. "" is one too, since "sim" is the default. Every other name is a
 *  network interface. */
static inline bool cm1e_interface_is_simulated(const char *name)
{
    return name[0] == '\0' || strcmp(name, CM1E_SIM_INTERFACE) == 0 ||
           strncmp(name, CM1E_SIM_FILE_PREFIX, sizeof CM1E_SIM_FILE_PREFIX - 1) == 0;
}

#endif
