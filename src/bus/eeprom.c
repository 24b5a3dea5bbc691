#include "bus/eeprom.h"

#include <string.h>

#include "bus/eeprom_interface.h"
#include "core/bytes.h"
#include "core/clock.h"

enum { EEPROM_TRIES = 3, REGISTER_TRIES = 3, LEAST_LOOKS = 20 };
#define READ_TIMEOUT_NS INT64_C(20000000)
/** A memory chip takes 10 ms at most; a processor that emulates one may have to erase a page of its flash. */
#define WRITE_TIMEOUT_NS INT64_C(500000000)
/** A memory chip takes some 100 to 300 us to read a group. */
#define EEPROM_PAUSE_NS INT64_C(50000)
#define NACK_PAUSE_NS INT64_C(1000000)

static void pause_for(int64_t time_ns)
{
    cm1e_clock_t *clock = cm1e_clock_current();
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + time_ns);
}

/** Repeats a datagram a few times if its frame was disturbed. */
static bool read_register(cm1e_eeprom_t *eeprom, uint16_t offset, uint8_t *data, uint16_t size)
{
    int answered = 0;
    for (int try = 0; try < REGISTER_TRIES && answered != 1; try++)
        answered = cm1e_soem_transfer(eeprom->soem, COMMAND_FPRD, eeprom->station, offset, data, size);
    eeprom->lost = answered != 1;
    return !eeprom->lost;
}

/** Writes a register once. A busy interface accepts no request, so a request that was accepted must not be repeated,
 *  and one that was not says nothing of the slave: the next look at the interface does. */
static bool write_register(cm1e_eeprom_t *eeprom, uint16_t offset, uint8_t *data, uint16_t size)
{
    return cm1e_soem_transfer(eeprom->soem, COMMAND_FPWR, eeprom->station, offset, data, size) == 1;
}

/** Waits until the interface is idle; one datagram reads the status and the words of the last command. false: the slave
 *  is lost, or the interface stays busy. A time that passed while this process stood still says nothing of the slave,
 *  so it is looked at often, too. */
static bool wait_idle(cm1e_eeprom_t *eeprom, int64_t timeout_ns, uint16_t *status)
{
    cm1e_clock_t *clock = cm1e_clock_current();
    const int64_t deadline_ns = cm1e_clock_now(clock) + timeout_ns;
    uint8_t bytes[EEPROM_GROUP_AT + sizeof eeprom->group];
    eeprom->ready = false;
    for (int looks = 1;; looks++) {
        if (!read_register(eeprom, REG_EEPROM_CONTROL, bytes, sizeof bytes))
            return false;
        *status = cm1e_get_u16(bytes);
        memcpy(eeprom->group, bytes + EEPROM_GROUP_AT, sizeof eeprom->group);
        eeprom->ready = !(*status & (EEPROM_BUSY | EEPROM_ERRORS));
        if (!(*status & EEPROM_BUSY))
            return true;
        if (looks >= LEAST_LOOKS && cm1e_clock_now(clock) >= deadline_ns)
            return false;
        pause_for(EEPROM_PAUSE_NS);
    }
}

/** Waits for an idle interface without errors of an earlier command. */
static bool make_ready(cm1e_eeprom_t *eeprom, int64_t timeout_ns)
{
    uint16_t status;
    uint8_t nop[2] = {EEPROM_NOP, 0};
    eeprom->group_bytes = 0;
    if (eeprom->ready)
        return true;
    if (!wait_idle(eeprom, timeout_ns, &status))
        return false;
    if (status & EEPROM_ERRORS)
        write_register(eeprom, REG_EEPROM_CONTROL, nop, sizeof nop);
    return true;
}

static bool request(cm1e_eeprom_t *eeprom, uint16_t command, uint32_t word)
{
    uint8_t bytes[6];
    eeprom->ready = false;
    cm1e_put_u16(bytes, command);
    cm1e_put_u32(bytes + 2, word);
    return write_register(eeprom, REG_EEPROM_CONTROL, bytes, sizeof bytes);
}

static bool read_group(cm1e_eeprom_t *eeprom, uint32_t word)
{
    uint16_t status;
    for (int try = 0; try < EEPROM_TRIES; try++) {
        if (!make_ready(eeprom, READ_TIMEOUT_NS))
            return false;
        if (!request(eeprom, EEPROM_READ, word))
            continue;
        if (!wait_idle(eeprom, READ_TIMEOUT_NS, &status))
            return false;
        if (status & EEPROM_NACK) {
            pause_for(NACK_PAUSE_NS); /* the memory itself was busy */
            continue;
        }
        eeprom->group_word = word;
        eeprom->group_bytes = status & EEPROM_READS_8 ? 8 : 4;
        return true;
    }
    return false;
}

bool cm1e_eeprom_read(cm1e_eeprom_t *eeprom, uint32_t word, uint8_t bytes[4])
{
    const bool behind = eeprom->group_bytes > 0 && word >= eeprom->group_word;
    const bool there = behind && word - eeprom->group_word <= (eeprom->group_bytes - 4) / 2;
    if (!there && !read_group(eeprom, word))
        return false;
    memcpy(bytes, eeprom->group + 2 * (word - eeprom->group_word), 4);
    return true;
}

/** Whether a word exists. It is read from the beginning of its group, whatever the size of groups is, so never beyond
 *  the end. */
static bool holds(cm1e_eeprom_t *eeprom, uint32_t word, uint16_t value)
{
    uint8_t bytes[4];
    return cm1e_eeprom_read(eeprom, word & ~UINT32_C(3), bytes) &&
           cm1e_eeprom_read(eeprom, word & ~UINT32_C(1), bytes) && cm1e_get_u16(bytes + 2 * (word % 2)) == value;
}

bool cm1e_eeprom_write(cm1e_eeprom_t *eeprom, uint32_t word, uint16_t value)
{
    uint16_t status;
    uint8_t bytes[2];
    for (int try = 0; try < EEPROM_TRIES; try++) {
        if (!make_ready(eeprom, WRITE_TIMEOUT_NS))
            return false;
        cm1e_put_u16(bytes, value);
        if (!write_register(eeprom, REG_EEPROM_DATA, bytes, sizeof value))
            continue;
        /* If the answer to a request is lost, the memory shows whether it was accepted. */
        request(eeprom, EEPROM_WRITE, word);
        if (!wait_idle(eeprom, WRITE_TIMEOUT_NS, &status))
            return false;
        if (status & (EEPROM_NACK | EEPROM_NOT_ENABLED)) {
            pause_for(NACK_PAUSE_NS);
            continue;
        }
        if (holds(eeprom, word, value))
            return true;
    }
    return false;
}

bool cm1e_eeprom_take(cm1e_eeprom_t *eeprom)
{
    uint8_t config;
    if (!read_register(eeprom, REG_EEPROM_CONFIG, &config, sizeof config))
        return false;
    eeprom->was_offered = config & CONFIG_OFFERED;
    config = CONFIG_FORCE; /* ends also an access that the processor never ended */
    const bool forced = write_register(eeprom, REG_EEPROM_CONFIG, &config, sizeof config);
    config = CONFIG_MASTER;
    eeprom->lost = !forced || !write_register(eeprom, REG_EEPROM_CONFIG, &config, sizeof config);
    return !eeprom->lost;
}

void cm1e_eeprom_give_back(cm1e_eeprom_t *eeprom)
{
    uint8_t config = CONFIG_OFFERED;
    if (eeprom->was_offered)
        write_register(eeprom, REG_EEPROM_CONFIG, &config, sizeof config);
}
