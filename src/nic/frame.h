/**
 * @file frame.h
 * EtherCAT in an Ethernet frame (ETG.1000.4 5.3): Ethernet header 14, EtherCAT header 2, then datagrams of header 10,
 * data, working counter 2. Reading of frames that came from outside never leaves `length`. @rt cycle
 */
#ifndef CM1E_NIC_FRAME_H
#define CM1E_NIC_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    ETHERNET_HEADER = 14,
    FRAME_HEADER = 16,         /**< Ethernet and EtherCAT header: the first datagram begins here */
    DATAGRAM_HEADER = 10,
    DATAGRAM_OVERHEAD = 12,    /**< datagram header and working counter */
    FRAME_MINIMUM = FRAME_HEADER + DATAGRAM_OVERHEAD,
    DATAGRAM_LENGTH_MASK = 0x07FF,
    DATAGRAM_CIRCULATED = 0x4000,
    DATAGRAM_MORE = 0x8000,
};

/** One datagram; pointers into the frame. */
typedef struct datagram {
    uint8_t *header;           /**< command, index, address 4, length 2, event 2 */
    uint8_t *data;
    uint16_t data_length;
    uint8_t *working_counter;
    bool more;                 /**< another one follows */
} datagram_t;

/** The datagram at `offset`; false where none fits into `length`. The next one is at *offset afterwards. */
bool cm1e_frame_datagram(const uint8_t *frame, size_t length, size_t *offset, datagram_t *datagram);

/** Which slaves may process a frame in which order. */
typedef enum cm1e_frame_order {
    FRAME_ANY_ORDER = 0,       /**< two halves of a ring may process copies of it at the same time */
    FRAME_IN_ORDER,            /**< later slaves depend on what earlier ones did to it (ARMW, FRMW, BRW) */
    FRAME_BY_POSITION,         /**< slaves count their place in it (APRD, APWR, APRW, ARMW) */
} frame_order_t;
frame_order_t cm1e_frame_order(const uint8_t *frame, size_t length);

/** `reply` is what a segment makes of `sent`: EtherCAT, long enough, the same datagrams (commands, indices, lengths)
 *  with the first one's index = `index`. Addresses, data and working counters may differ, and the circulating bit,
 *  which a slave sets whose port 0 is closed. */
bool cm1e_frame_is_reply(const uint8_t *reply, size_t reply_length, const uint8_t *sent, size_t sent_length,
                         uint8_t index);

/** Frame bodies (from the EtherCAT header on, without Ethernet header) of two halves of a ring that processed copies of
 *  `sent` are merged into `a`. Every bit of data belongs to one slave at most, or is ORed (broadcast read): the result
 *  has the bits that either half changed. Working counters are added. All have `length` bytes and passed
 *  cm1e_frame_is_reply(). */
void cm1e_frame_merge(uint8_t *a, const uint8_t *b, const uint8_t *sent, size_t length);

/** EtherCAT with datagrams that fill the length it states. */
bool cm1e_frame_is_ethercat(const uint8_t *frame, size_t length);
/** The working counter of any datagram is not 0. */
bool cm1e_frame_is_counted(const uint8_t *frame, size_t length);
/** Its datagrams are marked as having circulated (ETG.1000.4 5.4.1.2). */
bool cm1e_frame_has_circulated(const uint8_t *frame, size_t length);
void cm1e_frame_mark_circulated(uint8_t *frame, size_t length);

/** Damages a frame as the console asks for. There is no FCS here, which has damaged frames thrown away on a wire: so
 *  the damage is put where the receiver finds it, in the first datagram's header, and never makes believable data. */
void cm1e_frame_corrupt(uint8_t *frame, size_t length);

#endif
