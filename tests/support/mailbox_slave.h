/**
 * @file mailbox_slave.h
 * A slave's mailbox made by hand, for tests of the CoE client without a simulated segment: two sync managers with
 * full bits, counters and repeat request, and a small SDO server that is right unless a test tells it to lie. It
 * checks every request that it gets.
 */
#ifndef CM1E_TESTS_MAILBOX_SLAVE_H
#define CM1E_TESTS_MAILBOX_SLAVE_H

#include <string.h>
#include <unity.h>

#include "bus/datagram.h"
#include "core/bytes.h"

enum { STATION = 0x1001, OUT = 0x1000, IN = 0x1080, MAILBOX = 64, STORE = 2048 };

typedef struct slave slave_t;
/** Changes an answer (mailbox header included) before it is put into SM1; false: it is not sent at all. */
typedef bool (*lie_fn)(slave_t *slave, uint8_t *answer);

struct slave {
    bool out_full, in_full, acknowledge, lock_in;
    uint8_t out[MAILBOX], in[MAILBOX], last[MAILBOX], queued[MAILBOX];
    bool last_valid, queued_valid;
    uint8_t activate, seen_counter, counter;
    unsigned latency, wait; /* datagrams between the request and its answer */
    uint8_t store[STORE];   /* the one object, 0x2000:01 */
    size_t size;
    uint8_t incoming[STORE];
    size_t incoming_size, incoming_total, outgoing;
    unsigned writes;        /* finished downloads */
    unsigned requests;      /* SDO requests executed */
    lie_fn lie;
    unsigned lies, lie_from; /* answers seen by `lie`; from which one on it lies */
    bool strict;            /* refuses (mailbox error 7, no more memory) to begin while a transfer is open */
    bool open;              /* a transfer in segments */
    unsigned aborts;        /* received */
    uint32_t abort_code;    /* of the last */
    uint16_t abort_index;
    bool rejects_aborts;    /* answers them by a mailbox error */
    unsigned emergency_before; /* an emergency goes out before that answer */
    void (*serve_information)(slave_t *slave, const uint8_t *request, uint16_t length); /* NULL: it has none */
    void (*send_more)(slave_t *slave); /* when SM1 is empty: what else there is to send */
};

/* ---- the server ------------------------------------------------------------------------------------------------ */

void put_in(slave_t *s, const uint8_t *message);

void send_answer(slave_t *s, uint8_t *answer, uint16_t body_bytes);

void serve(slave_t *s);

/* ---- the controller -------------------------------------------------------------------------------------------- */

void handle(slave_t *s, cm1e_datagram_t *d);

#endif
