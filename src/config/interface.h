/**
 * @file interface.h
 * The kinds of interface names, and what a name of a network interface has behind its last comma: the way on which
 * frames are sent and received, "eth1,xdp". A name without a comma goes through a packet socket. Linux lets an
 * interface have a comma in its own name; then the way must be stated, "odd,name,packet".
 */
#ifndef CM1E_CONFIG_INTERFACE_H
#define CM1E_CONFIG_INTERFACE_H

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "core/guest_api.h"

#define CM1E_SIM_INTERFACE "sim"
#define CM1E_SIM_FILE_PREFIX "sim:" /**< followed by the path of a bus file that describes the segment */

/** The ways to the frames of a network interface. */
typedef enum cm1e_interface_way {
    CM1E_WAY_UNKNOWN = -1,
    CM1E_WAY_PACKET = 0, /**< a packet socket: on every interface, with one privilege */
    CM1E_WAY_XDP,        /**< AF_XDP: before the network stack of the kernel */
    CM1E_WAYS,
} cm1e_interface_way_t;

/** Whether a name is that of a simulated segment. "" is one too, since "sim" is the default. Every other name is a
 *  network interface. */
static inline bool cm1e_interface_is_simulated(const char *name)
{
    return name[0] == '\0' || strcmp(name, CM1E_SIM_INTERFACE) == 0 ||
           strncmp(name, CM1E_SIM_FILE_PREFIX, sizeof CM1E_SIM_FILE_PREFIX - 1) == 0;
}

/** Length of the interface's own name, without comma and way. */
static inline size_t cm1e_interface_length(const char *name)
{
    const char *comma = cm1e_interface_is_simulated(name) ? NULL : strrchr(name, ',');
    return comma ? (size_t)(comma - name) : strlen(name);
}

/** The interface's own name, cut off where `size` ends. */
static inline void cm1e_interface_own_name(char *own, size_t size, const char *name)
{
    snprintf(own, size, "%.*s", (int)cm1e_interface_length(name), name);
}

/** Two names of one interface: "eth1" and "eth1,xdp". */
static inline bool cm1e_interface_is_same(const char *a, const char *b)
{
    const size_t length = cm1e_interface_length(a);
    return length == cm1e_interface_length(b) && strncmp(a, b, length) == 0;
}

/** The way that a name states. CM1E_WAY_UNKNOWN: it states none that exists; `wrong` (if not NULL) then says which word
 *  that is and which ways there are, to be put behind "Interface ... ". @rt init */
CM1E_GUEST_API cm1e_interface_way_t cm1e_interface_way(const char *name, char *wrong, size_t size);

#endif
