/**
 * @file xdp_program.h
 * A program of eBPF at a network interface, which hands EtherCAT frames to an AF_XDP socket and all others to the
 * kernel. It ends with the descriptors: when the process ends, however that happens, the interface is as before.
 */
#ifndef CM1E_NIC_XDP_PROGRAM_H
#define CM1E_NIC_XDP_PROGRAM_H

/** Descriptors; -1: not made. */
typedef struct cm1e_xdp_program {
    int map;     /**< the socket by the number of its receive queue */
    int program;
    int link;    /**< between program and interface */
} cm1e_xdp_program_t;

#define CM1E_XDP_NO_PROGRAM ((cm1e_xdp_program_t){-1, -1, -1})

/** What is being done, for a diagnosis. */
typedef enum cm1e_xdp_step { CM1E_XDP_MAKE, CM1E_XDP_ATTACH } cm1e_xdp_step_t;

/** Makes the program for a socket that is bound to receive queue 0 of the interface, and attaches it. 0, or the errno
 *  of `*step`; what has been made is then to be closed. EBUSY, EEXIST of CM1E_XDP_ATTACH: there is a program already.
 *  @rt init */
int cm1e_xdp_program_attach(cm1e_xdp_program_t *made, int socket, unsigned interface_index, cm1e_xdp_step_t *step);
/** Closing what is not made does nothing. */
void cm1e_xdp_program_close(cm1e_xdp_program_t *closed);

#endif
