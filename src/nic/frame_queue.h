/**
 * @file frame_queue.h
 * Frames that become ready at a time: in flight in the simulated segment, delayed or injected by the tap. A fixed
 * number of places, nothing is allocated; frames leave in order of time, equal times in order of arrival. @rt cycle
 */
#ifndef CM1E_NIC_FRAME_QUEUE_H
#define CM1E_NIC_FRAME_QUEUE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "nic/nic.h"

enum { FRAME_QUEUE_PLACES = 64 };

typedef struct queued_frame {
    int64_t ready_ns;
    int port;
    bool tapped;               /**< the tap has seen it already */
    size_t length;
    uint8_t bytes[CM1E_FRAME_MAX];
} queued_frame_t;

/** Valid when zeroed. */
typedef struct frame_queue {
    uint64_t used;                       /**< bit n: places[n] is taken */
    uint8_t order[FRAME_QUEUE_PLACES];   /**< places in order of time */
    unsigned count;
    queued_frame_t places[FRAME_QUEUE_PLACES];
} frame_queue_t;

/** A free place to be filled in (bytes, length, port) and then handed to cm1e_frame_queue_insert(); NULL: full. */
queued_frame_t *cm1e_frame_queue_place(frame_queue_t *queue);
/** Puts a place in order. `place` must come from cm1e_frame_queue_place(); one that is not inserted stays free. */
void cm1e_frame_queue_insert(frame_queue_t *queue, queued_frame_t *place, int64_t ready_ns);
/** The earliest frame; NULL: none. It stays in place until cm1e_frame_queue_remove_first(). */
static inline queued_frame_t *frame_queue_first(frame_queue_t *queue)
{
    return queue->count > 0 ? &queue->places[queue->order[0]] : NULL;
}
void cm1e_frame_queue_remove_first(frame_queue_t *queue);

#endif
