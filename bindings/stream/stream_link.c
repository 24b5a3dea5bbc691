#include "stream_link.h"

#include <string.h>

void stream_link_init(stream_link_t *link, int64_t period_ns)
{
    memset(link, 0, sizeof *link);
    link->version = STREAM_VERSION;
    link->bytes = sizeof *link;
    link->period_ns = period_ns;
}

static uint32_t waiting(stream_ends_t *ends)
{
    return atomic_load_explicit(&ends->written, memory_order_acquire) -
           atomic_load_explicit(&ends->taken, memory_order_relaxed);
}

/* The place to write to; -1: all are taken. */
static int place_to_write(stream_ends_t *ends)
{
    const uint32_t written = atomic_load_explicit(&ends->written, memory_order_relaxed);
    if (written - atomic_load_explicit(&ends->taken, memory_order_acquire) < STREAM_DEPTH)
        return (int)(written % STREAM_DEPTH);
    atomic_fetch_add_explicit(&ends->refused, 1, memory_order_relaxed);
    return -1;
}

static void written_one(stream_ends_t *ends) { atomic_fetch_add_explicit(&ends->written, 1, memory_order_release); }

static int place_to_read(const stream_ends_t *ends)
{
    return (int)(atomic_load_explicit(&ends->taken, memory_order_relaxed) % STREAM_DEPTH);
}

static void took(stream_ends_t *ends, uint32_t count)
{
    atomic_fetch_add_explicit(&ends->taken, count, memory_order_release);
}

bool stream_put_command(stream_link_t *link, const stream_command_t *command)
{
    const int place = place_to_write(&link->command_ends);
    if (place < 0)
        return false;
    link->commands[place] = *command;
    written_one(&link->command_ends);
    return true;
}

bool stream_take_command(stream_link_t *link, stream_command_t *command)
{
    if (waiting(&link->command_ends) == 0)
        return false;
    *command = link->commands[place_to_read(&link->command_ends)];
    took(&link->command_ends, 1);
    return true;
}

bool stream_put_state(stream_link_t *link, const stream_state_t *state)
{
    const int place = place_to_write(&link->state_ends);
    if (place < 0)
        return false;
    link->states[place] = *state;
    written_one(&link->state_ends);
    return true;
}

bool stream_take_state(stream_link_t *link, stream_state_t *state)
{
    const uint32_t count = waiting(&link->state_ends);
    if (count == 0)
        return false;
    took(&link->state_ends, count - 1);
    *state = link->states[place_to_read(&link->state_ends)];
    took(&link->state_ends, 1);
    return true;
}
