/**
 * A judge of every frame that the master puts on the simulated wire: the linker puts it in front of cm1e_sim_segment_process().
 * A frame has a datagram, and what writes registers of slaves writes whole ones, and only those that a master has to write. A
 * slave takes a byte more or less without a word, so no other test would see it.
 */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/bytes.h"
#include "sim/segment.h"

enum {
    ETHER_TYPE = 12, FIRST_DATAGRAM = 16, HEADER = 10, COUNTER = 2, LENGTH_MASK = 0x07FF, MORE_FOLLOW = 0x8000,
    REGISTERS_END = 0x1000,
};

int __real_cm1e_sim_segment_process(cm1e_sim_segment_t *segment, int port, uint8_t *frame, size_t length, int64_t now_ns);
int __wrap_cm1e_sim_segment_process(cm1e_sim_segment_t *segment, int port, uint8_t *frame, size_t length, int64_t now_ns);

/** What a master writes: so many bytes from a register on, or a multiple of them that ends before `end`. */
static const struct {
    uint16_t first, bytes, end;
} written[] = {
    {0x0010, 2, 0}, /* station address */
    {0x0101, 1, 0}, {0x0103, 1, 0}, /* ports, alias */
    {0x0120, 2, 0}, /* AL control */
    {0x0200, 2, 0}, /* mask of events */
    {0x0300, 8, 0}, /* counters of errors */
    {0x0400, 2, 0}, {0x0420, 2, 0}, /* watchdog */
    {0x0500, 1, 0}, {0x0502, 2, 0}, {0x0502, 6, 0}, {0x0508, 2, 0}, /* EEPROM */
    {0x0600, 16, 0x0700}, /* FMMUs */
    {0x0800, 8, 0x0880}, /* sync managers */
    {0x0900, 4, 0}, {0x0910, 8, 0}, {0x0920, 12, 0}, {0x0930, 2, 0}, {0x0934, 2, 0}, /* the clock */
    {0x0980, 2, 0}, {0x0981, 1, 0}, {0x0990, 8, 0}, {0x09A0, 8, 0}, /* its pulses */
};

/** A byte of a sync manager by itself: it is enabled, or a message is asked for once more. */
static bool activates(unsigned address, unsigned bytes)
{
    return address >= 0x0800 && address < 0x0880 && address % 8 == 6 && bytes == 1;
}

static bool is_written(unsigned address, unsigned bytes)
{
    for (size_t i = 0; i < sizeof written / sizeof written[0]; i++) {
        const unsigned first = written[i].first, size = written[i].bytes, end = written[i].end;
        if (end == 0 ? address == first && bytes == size
                     : address >= first && address + bytes <= end && address % size == 0 && bytes > 0 && bytes % size == 0)
            return true;
    }
    return activates(address, bytes);
}

/** A command that writes, by the address of a slave or to all of them. */
static bool writes(uint8_t command)
{
    static const bool table[] = {[2] = true, [3] = true, [5] = true, [6] = true, [8] = true, [9] = true, [13] = true, [14] = true};
    return command < sizeof table / sizeof table[0] && table[command];
}

static void judge(const uint8_t *frame, size_t length)
{
    bool more = true;
    for (size_t at = FIRST_DATAGRAM; more && at + HEADER <= length;) {
        const uint16_t size = cm1e_get_u16(frame + at + 6);
        const unsigned address = cm1e_get_u16(frame + at + 4), bytes = size & LENGTH_MASK;
        if (writes(frame[at]) && address < REGISTERS_END && !is_written(address, bytes)) {
            fprintf(stderr, "the master writes %u bytes from register 0x%04X on\n", bytes, address);
            abort();
        }
        more = size & MORE_FOLLOW;
        at += HEADER + bytes + COUNTER;
    }
}

int __wrap_cm1e_sim_segment_process(cm1e_sim_segment_t *segment, int port, uint8_t *frame, size_t length, int64_t now_ns)
{
    if (length > FIRST_DATAGRAM + HEADER && frame[ETHER_TYPE] == 0x88 && frame[ETHER_TYPE + 1] == 0xA4) {
        if ((cm1e_get_u16(frame + ETHER_TYPE + 2) & LENGTH_MASK) < HEADER + COUNTER) {
            fprintf(stderr, "the master sends a frame without a datagram\n");
            abort();
        }
        judge(frame, length);
    }
    return __real_cm1e_sim_segment_process(segment, port, frame, length, now_ns);
}
