/**
 * @file socket_ways.h
 * Ways to send and receive Ethernet frames of one network interface from a program, for bench_socket. Each answers with how
 * many system calls it made, so that the table can tell them.
 */
#ifndef CM1E_BENCH_SOCKET_WAYS_H
#define CM1E_BENCH_SOCKET_WAYS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { WAY_FRAME_MAX = 1514, WAY_ETHERTYPE = 0x88A4, WAY_WAIT_MS = 100 };

typedef struct way {
    const char *name;
    /** Of an interface; NULL, and errno: the kernel refuses it. */
    void *(*open)(unsigned interface_index);
    bool (*send)(void *state, const uint8_t *frame, size_t length);
    /** The length of a frame; 0: none came within WAY_WAIT_MS. */
    size_t (*receive)(void *state, uint8_t *frame);
    void (*close)(void *state);
} way_t;

/** System calls of all ways so far. */
extern unsigned long way_calls;

/** A packet socket for EtherCAT frames that come in; -1: errno. */
int way_packet_socket(unsigned interface_index);
/** Sleeps until the descriptor has something, at most WAY_WAIT_MS. */
bool way_sleep(int fd);

extern const way_t way_poll_first, way_send_recv, way_spin, way_bypass, way_busy_poll, way_mmap, way_uring, way_xdp;

#endif
