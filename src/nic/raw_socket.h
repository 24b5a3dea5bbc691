/**
 * @file raw_socket.h
 * A packet socket that sees the EtherCAT frames of one network interface and nothing else.
 */
#ifndef CM1E_NIC_RAW_SOCKET_H
#define CM1E_NIC_RAW_SOCKET_H

#include <stddef.h>
#include <stdint.h>

#include "cm1e/error.h"

/** Opens, binds, drains. A missing privilege, an unknown interface or one that is down is diagnosed with the cure. */
cm1e_error_t cm1e_raw_socket_open(int *fd, const char *interface_name, cm1e_diag_t *diag);
/** A frame that is here already. Its length; 0: none; -1: the socket reports an error. */
int cm1e_raw_socket_receive(int fd, uint8_t *frame, size_t room);

#endif
