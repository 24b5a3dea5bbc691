#include "nic/frame.h"

#include <string.h>

#include "core/bytes.h"
#include "nic/nic.h"

enum { ETHERTYPE_HIGH = 0x88, ETHERTYPE_LOW = 0xA4, ETHERCAT_TYPE_MASK = 0xF000, ETHERCAT_TYPE_DATAGRAMS = 0x1000 };

/** Commands of ETG.1000.4 table 13 by number; what their order means in a ring. */
static const uint8_t command_order[] = {
    [1] = FRAME_BY_POSITION,  /* APRD */
    [2] = FRAME_BY_POSITION,  /* APWR */
    [3] = FRAME_BY_POSITION,  /* APRW */
    [9] = FRAME_IN_ORDER,     /* BRW: every slave writes what the ones before it made of the data */
    [13] = FRAME_BY_POSITION, /* ARMW */
    [14] = FRAME_IN_ORDER,    /* FRMW: the addressed slave reads, the ones behind it write that */
};

bool cm1e_frame_datagram(const uint8_t *frame, size_t length, size_t *offset, datagram_t *datagram)
{
    if (length < DATAGRAM_OVERHEAD || *offset > length - DATAGRAM_OVERHEAD)
        return false;
    uint8_t *header = (uint8_t *)(uintptr_t)(frame + *offset);
    const uint16_t field = cm1e_get_u16(header + 6);
    const uint16_t data_length = field & DATAGRAM_LENGTH_MASK;
    if (data_length > length - DATAGRAM_OVERHEAD - *offset)
        return false;
    datagram->header = header;
    datagram->data = header + DATAGRAM_HEADER;
    datagram->data_length = data_length;
    datagram->working_counter = datagram->data + data_length;
    datagram->more = (field & DATAGRAM_MORE) != 0;
    *offset += DATAGRAM_OVERHEAD + (size_t)data_length;
    return true;
}

frame_order_t cm1e_frame_order(const uint8_t *frame, size_t length)
{
    frame_order_t order = FRAME_ANY_ORDER;
    datagram_t d = {.more = true};
    size_t offset = FRAME_HEADER;
    while (d.more && cm1e_frame_datagram(frame, length, &offset, &d)) {
        const uint8_t command = d.header[0];
        if (command < sizeof command_order && command_order[command] > order)
            order = command_order[command];
    }
    return order;
}

static bool is_datagrams(uint16_t header) { return (header & ETHERCAT_TYPE_MASK) == ETHERCAT_TYPE_DATAGRAMS; }

bool cm1e_frame_is_ethercat(const uint8_t *frame, size_t length)
{
    if (length < FRAME_MINIMUM || frame[12] != ETHERTYPE_HIGH || frame[13] != ETHERTYPE_LOW)
        return false;
    const uint16_t header = cm1e_get_u16(frame + ETHERNET_HEADER);
    const size_t end = (size_t)(header & DATAGRAM_LENGTH_MASK) + FRAME_HEADER;
    datagram_t d = {.more = true};
    size_t offset = FRAME_HEADER;
    while (d.more && offset < end)
        if (!cm1e_frame_datagram(frame, length, &offset, &d))
            return false;
    return is_datagrams(header) && !d.more && offset == end;
}

bool cm1e_frame_is_reply(const uint8_t *reply, size_t reply_length, const uint8_t *sent, size_t sent_length,
                         uint8_t index)
{
    if (sent_length < FRAME_MINIMUM || reply_length < sent_length)
        return false;
    if (reply[12] != ETHERTYPE_HIGH || reply[13] != ETHERTYPE_LOW)
        return false;
    const uint16_t header = cm1e_get_u16(reply + ETHERNET_HEADER), mask = ETHERCAT_TYPE_MASK | DATAGRAM_LENGTH_MASK;
    if ((header & mask) != (cm1e_get_u16(sent + ETHERNET_HEADER) & mask) ||
        !is_datagrams(header) ||
        (size_t)(header & DATAGRAM_LENGTH_MASK) + FRAME_HEADER != sent_length)
        return false;
    if (reply[FRAME_HEADER + 1] != index)
        return false;
    datagram_t d = {.more = true};
    size_t offset = FRAME_HEADER;
    while (d.more) {
        const uint8_t *r = reply + offset;
        if (!cm1e_frame_datagram(sent, sent_length, &offset, &d))
            return false;
        if (r[0] != d.header[0] || (d.header != sent + FRAME_HEADER && r[1] != d.header[1]) ||
            ((cm1e_get_u16(r + 6) ^ cm1e_get_u16(d.header + 6)) & (DATAGRAM_MORE | DATAGRAM_LENGTH_MASK)) != 0)
            return false;
    }
    return offset == sent_length;
}

static void merge_bits(uint8_t *a, const uint8_t *b, const uint8_t *sent, size_t n)
{
    for (; n >= 8; n -= 8, a += 8, b += 8, sent += 8) {
        uint64_t x, y, s;
        memcpy(&x, a, 8);
        memcpy(&y, b, 8);
        memcpy(&s, sent, 8);
        x = s ^ ((x ^ s) | (y ^ s));
        memcpy(a, &x, 8);
    }
    for (; n > 0; n--, a++, b++, sent++)
        *a = (uint8_t)(*sent ^ ((*a ^ *sent) | (*b ^ *sent)));
}

void cm1e_frame_merge(uint8_t *a, const uint8_t *b, const uint8_t *sent, size_t length)
{
    datagram_t d = {.more = true};
    size_t offset = FRAME_HEADER - ETHERNET_HEADER;
    while (d.more && cm1e_frame_datagram(a, length, &offset, &d)) {
        const size_t at = (size_t)(d.header - a), data = at + DATAGRAM_HEADER, counter = data + d.data_length;
        merge_bits(a + data, b + data, sent + data, d.data_length);
        cm1e_put_u16(a + counter, (uint16_t)(cm1e_get_u16(a + counter) + cm1e_get_u16(b + counter)));
        cm1e_put_u16(a + at + 8, cm1e_get_u16(a + at + 8) | cm1e_get_u16(b + at + 8));
    }
}

bool cm1e_frame_is_counted(const uint8_t *frame, size_t length)
{
    datagram_t d = {.more = true};
    size_t offset = FRAME_HEADER;
    while (d.more && cm1e_frame_datagram(frame, length, &offset, &d))
        if (cm1e_get_u16(d.working_counter) != 0)
            return true;
    return false;
}

bool cm1e_frame_has_circulated(const uint8_t *frame, size_t length)
{
    datagram_t d;
    size_t offset = FRAME_HEADER;
    return cm1e_frame_datagram(frame, length, &offset, &d) && (cm1e_get_u16(d.header + 6) & DATAGRAM_CIRCULATED);
}

void cm1e_frame_mark_circulated(uint8_t *frame, size_t length)
{
    datagram_t d = {.more = true};
    size_t offset = FRAME_HEADER;
    while (d.more && cm1e_frame_datagram(frame, length, &offset, &d))
        cm1e_put_u16(d.header + 6, cm1e_get_u16(d.header + 6) | DATAGRAM_CIRCULATED);
}

void cm1e_frame_corrupt(uint8_t *frame, size_t length)
{
    for (size_t i = FRAME_HEADER; i < FRAME_HEADER + DATAGRAM_HEADER && i < length; i++)
        frame[i] = (uint8_t)~frame[i];
}

bool cm1e_frame_change_working_counter(uint8_t *frame, size_t length, unsigned n, int delta)
{
    if (length < FRAME_MINIMUM || frame[12] != ETHERTYPE_HIGH || frame[13] != ETHERTYPE_LOW)
        return false;
    datagram_t d = {.more = true};
    size_t offset = FRAME_HEADER;
    for (unsigned i = 0; d.more && cm1e_frame_datagram(frame, length, &offset, &d); i++) {
        if (i == n) {
            cm1e_put_u16(d.working_counter, (uint16_t)(cm1e_get_u16(d.working_counter) + delta));
            return true;
        }
    }
    return false;
}
