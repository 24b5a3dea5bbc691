/**
 * @file xdp_socket.h
 * The EtherCAT frames of one network interface by AF_XDP: in memory that the kernel and this process share, taken from
 * the driver before the network stack. A frame that has come in is read without a system call; one that goes out is
 * copied and sent by one sendto(), within this call and on this processor.
 *
 * The kernel copies each frame (XDP_COPY), also where a driver offers zero-copy. With zero-copy the frame would be sent
 * by the interrupt of the card, on its processor and at its priority, which is less exact than the time that copying
 * 1.5 KB saves. Frames of other protocols go to the kernel as before. Programs that listen with packet sockets, tcpdump
 * for example, see none of the EtherCAT frames.
 */
#ifndef CM1E_NIC_XDP_SOCKET_H
#define CM1E_NIC_XDP_SOCKET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/error.h"

typedef struct cm1e_xdp_socket cm1e_xdp_socket_t;

/** Locks the interface, and opens. `interface_name` is the interface's own, without a way. What a packet socket is
 *  refused for is diagnosed as there; also a missing privilege, a kernel without AF_XDP, several receive queues, and a
 *  program that is at the interface already, each with the cure. Drivers that reset their link for this are waited for.
 *  @rt block */
cm1e_error_t cm1e_xdp_socket_open(cm1e_xdp_socket_t **made, const char *interface_name, cm1e_diag_t *diag);
/** NULL does nothing. @rt block */
void cm1e_xdp_socket_close(cm1e_xdp_socket_t *closed);
/** To be waited for with ppoll(). */
int cm1e_xdp_socket_fd(const cm1e_xdp_socket_t *x);
/** false: not sent, because the interface is down, away or too slow. One system call, after a frame that was not sent
 *  two. @rt cycle */
bool cm1e_xdp_socket_send(cm1e_xdp_socket_t *x, const uint8_t *frame, size_t length);
/** A frame that is here already. Its length, `room` at most; 0: none. No system call. @rt cycle */
size_t cm1e_xdp_socket_receive(cm1e_xdp_socket_t *x, uint8_t *frame, size_t room);

#endif
