#include "sim/esc_chip.h"

#include <string.h>

#include "core/bytes.h"

/* Datagram header (ETG.1000.4 5.4.1). */
enum {
    AT_COMMAND = 0, AT_ADDRESS = 2, AT_OFFSET = 4, AT_LENGTH = 6, AT_EVENT = 8, AT_DATA = 10, COUNTER_BYTES = 2,
    LENGTH_MASK = 0x07FF, DATA_MAX = 2047,
};

enum addressing { BY_POSITION, BY_ADDRESS, BROADCAST, LOGICAL, MULTIPLE_BY_POSITION, MULTIPLE_BY_ADDRESS };
enum access { READS = 1, WRITES = 2 };

typedef struct command {
    uint8_t addressing, access;
} command_t;

/* By number. Without an access the slave passes the datagram on. */
static const command_t commands[] = {
    [1] = {BY_POSITION, READS},              /* APRD */
    [2] = {BY_POSITION, WRITES},             /* APWR */
    [3] = {BY_POSITION, READS | WRITES},     /* APRW */
    [4] = {BY_ADDRESS, READS},               /* FPRD */
    [5] = {BY_ADDRESS, WRITES},              /* FPWR */
    [6] = {BY_ADDRESS, READS | WRITES},      /* FPRW */
    [7] = {BROADCAST, READS},                /* BRD */
    [8] = {BROADCAST, WRITES},               /* BWR */
    [9] = {BROADCAST, READS | WRITES},       /* BRW */
    [10] = {LOGICAL, READS},                 /* LRD */
    [11] = {LOGICAL, WRITES},                /* LWR */
    [12] = {LOGICAL, READS | WRITES},        /* LRW */
    [13] = {MULTIPLE_BY_POSITION, READS | WRITES}, /* ARMW */
    [14] = {MULTIPLE_BY_ADDRESS, READS | WRITES},  /* FRMW */
};
enum { COMMANDS = sizeof commands / sizeof commands[0] };

static bool has_address(const cm1e_sim_slave_t *slave, uint16_t address)
{
    return address == cm1e_get_u16(slave->memory + ESC_STATION_ADDRESS) ||
           ((slave->memory[ESC_DL_ALIAS] & 0x01) && address == cm1e_get_u16(slave->memory + ESC_STATION_ALIAS));
}

/* A read after the write of the same datagram returns the old content, so it goes through a copy. Working counter of a
 * command that does both: 1 for the read, 2 for the write; alone each counts 1. */
static unsigned access_physical(cm1e_sim_slave_t *slave, unsigned access, bool collect, uint16_t offset, uint8_t *data,
                                uint16_t length)
{
    uint8_t found[DATA_MAX];
    bool was_read = false, was_written = false;
    if (access & READS) {
        if (access == READS && !collect)
            return cm1e_sim_esc_read(slave, offset, data, length);
        /* A broadcast collects the content of all slaves by OR; else what cannot be read stays as it came. */
        if (collect)
            memset(found, 0, length);
        else
            memcpy(found, data, length);
        was_read = cm1e_sim_esc_read(slave, offset, found, length);
    }
    if (access & WRITES)
        was_written = cm1e_sim_esc_write(slave, offset, data, length);
    if (was_read) {
        if (collect)
            for (unsigned i = 0; i < length; i++)
                data[i] |= found[i];
        else
            memcpy(data, found, length);
    }
    return access == WRITES ? was_written : (unsigned)was_read + 2u * was_written;
}

/* The write comes first: bytes that are both written and read leave with what was read. */
static unsigned access_logical(cm1e_sim_slave_t *slave, unsigned access, uint32_t address, uint8_t *data,
                               uint16_t length)
{
    const bool was_written = (access & WRITES) && cm1e_sim_esc_logical_write(slave, address, data, length);
    const bool was_read = (access & READS) && cm1e_sim_esc_logical_read(slave, address, data, length);
    return access == WRITES ? was_written : (unsigned)was_read + 2u * was_written;
}

static unsigned execute(cm1e_sim_slave_t *slave, const command_t *command, uint8_t *datagram, uint16_t length)
{
    uint8_t *data = datagram + AT_DATA;
    if (command->addressing == LOGICAL)
        return access_logical(slave, command->access, cm1e_get_u32(datagram + AT_ADDRESS), data, length);

    const uint16_t address = cm1e_get_u16(datagram + AT_ADDRESS), offset = cm1e_get_u16(datagram + AT_OFFSET);
    const bool by_position = command->addressing != BY_ADDRESS && command->addressing != MULTIPLE_BY_ADDRESS;
    const bool addressed = by_position ? address == 0 : has_address(slave, address);
    /* Every slave counts the auto-increment address up, that of a broadcast too. */
    if (by_position)
        cm1e_put_u16(datagram + AT_ADDRESS, (uint16_t)(address + 1));
    switch (command->addressing) {
    case BROADCAST:
        return access_physical(slave, command->access, true, offset, data, length);
    case MULTIPLE_BY_POSITION:
    case MULTIPLE_BY_ADDRESS:
        return access_physical(slave, addressed ? READS : WRITES, false, offset, data, length);
    default:
        return addressed ? access_physical(slave, command->access, false, offset, data, length) : 0;
    }
}

void cm1e_sim_esc_frame(cm1e_sim_slave_t *slave, uint8_t *begin, const uint8_t *end)
{
    for (uint8_t *datagram = begin; datagram < end;) {
        const uint16_t length = cm1e_get_u16(datagram + AT_LENGTH) & LENGTH_MASK;
        uint8_t *counter = datagram + AT_DATA + length;
        const uint8_t number = datagram[AT_COMMAND];
        if (number < COMMANDS && commands[number].access) {
            const unsigned count = execute(slave, &commands[number], datagram, length);
            if (count)
                cm1e_put_u16(counter, (uint16_t)(cm1e_get_u16(counter) + count));
        }
        const uint16_t events = cm1e_get_u16(slave->memory + ESC_EVENT_REQUEST) &
                                cm1e_get_u16(slave->memory + ESC_EVENT_MASK);
        if (events)
            cm1e_put_u16(datagram + AT_EVENT, (uint16_t)(cm1e_get_u16(datagram + AT_EVENT) | events));
        datagram = counter + COUNTER_BYTES;
    }
    /* After the whole frame: its inputs are those from before its outputs. */
    cm1e_sim_esc_deliver_outputs(slave);
}
