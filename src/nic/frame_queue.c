#include "nic/frame_queue.h"

#include <string.h>

queued_frame_t *cm1e_frame_queue_place(frame_queue_t *queue)
{
    if (queue->count >= FRAME_QUEUE_PLACES)
        return NULL;
    return &queue->places[__builtin_ctzll(~queue->used)];
}

void cm1e_frame_queue_insert(frame_queue_t *queue, queued_frame_t *place, int64_t ready_ns)
{
    const unsigned n = (unsigned)(place - queue->places);
    unsigned at = queue->count;
    while (at > 0 && queue->places[queue->order[at - 1]].ready_ns > ready_ns)
        at--;
    memmove(queue->order + at + 1, queue->order + at, queue->count - at);
    queue->order[at] = (uint8_t)n;
    queue->used |= UINT64_C(1) << n;
    queue->count++;
    place->ready_ns = ready_ns;
}

void cm1e_frame_queue_remove_first(frame_queue_t *queue)
{
    if (queue->count == 0)
        return;
    queue->used &= ~(UINT64_C(1) << queue->order[0]);
    queue->count--;
    memmove(queue->order, queue->order + 1, queue->count);
}
