/**
 * @file port_private.h
 * What ring.c needs of port.c. @rt cycle
 */
#ifndef CM1E_NIC_PORT_PRIVATE_H
#define CM1E_NIC_PORT_PRIVATE_H

#include <stdbool.h>
#include <stdint.h>

#include "nicdrv.h"

/** The number of frames that one wait takes in beyond its deadline. So many may be here already, and a flood must
 *  end. */
enum { PORT_FRAME_BUDGET = 64 };

/** Takes in the next frame before the deadline, for any waiter; false: none came. */
bool cm1e_port_take_in(ecx_portt *port, int64_t deadline_ns);
/** Marks an Ethernet frame as sent by interface 0 (PRI) or 1 (SEC), with the stamp of its transmission. */
void cm1e_port_stamp(ecx_portt *port, uint8_t *frame, uint8 idx, int source, uint32_t transmission);
/** Sends on an interface and counts. */
bool cm1e_port_send(ecx_portt *port, int interface, const uint8_t *frame, int length);
/** The answer in rxbuf[idx] goes to the caller: its working counter. */
int cm1e_port_complete(ecx_portt *port, uint8 idx);

#endif
