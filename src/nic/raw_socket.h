/**
 * @file raw_socket.h
 * A packet socket that sees the EtherCAT frames of one network interface and nothing else.
 */
#ifndef CM1E_NIC_RAW_SOCKET_H
#define CM1E_NIC_RAW_SOCKET_H

#include <stddef.h>
#include <stdint.h>

#include "cm1e/error.h"
#include "nic/interface_lock.h"

/** Whoever sends on an interface owns it: there is no socket without the lock. */
typedef struct cm1e_raw_socket {
    int fd;                        /**< -1: closed */
    cm1e_interface_lock_t lock;
} cm1e_raw_socket_t;

#define CM1E_RAW_SOCKET_CLOSED ((cm1e_raw_socket_t){-1, {-1, -1}})

/** Locks, opens, binds, drains. `interface_name` is the interface's own, without a way. An interface that is in use,
 *  unknown or down, and a missing privilege, are diagnosed with the cure. */
cm1e_error_t cm1e_raw_socket_open(cm1e_raw_socket_t *made, const char *interface_name, cm1e_diag_t *diag);
/** As cm1e_raw_socket_open(), but nothing is received: for another way to the frames, which needs the lock, an
 *  interface that is up, and one that takes frames for any address. */
cm1e_error_t cm1e_raw_socket_hold(cm1e_raw_socket_t *made, const char *interface_name, cm1e_diag_t *diag);
/** Closing a closed socket does nothing. */
void cm1e_raw_socket_close(cm1e_raw_socket_t *closed);
/** A frame that is here already. Its length; 0: none; -1: the socket reports an error. */
int cm1e_raw_socket_receive(int fd, uint8_t *frame, size_t room);

#endif
