#include "bus/sii_fetch.h"

#include <string.h>

#include "bus/eeprom_interface.h"
#include "core/bytes.h"

enum { GROUP_TRIES = 3, SILENT_LIMIT = 3, GROUP_BYTES_MAX = 8 };
/** For one group. A memory chip takes some 100 to 300 us. */
#define GROUP_NS INT64_C(60000000)
/** When the master itself stands still, it does not look at the slave: such a time counts as so much. */
#define LOOK_NS_MAX INT64_C(5000000)
#define NACK_PAUSE_NS INT64_C(1000000)

static bool is_known(const cm1e_sii_fetch_t *fetch, unsigned word) { return fetch->known[word / 8] >> word % 8 & 1; }

/** Goes to the first word that is still to be fetched. */
static void go_on(cm1e_sii_fetch_t *fetch)
{
    while (fetch->word < fetch->end && is_known(fetch, fetch->word))
        fetch->word++;
    fetch->tries = 0;
    fetch->looked_ns = fetch->waited_ns = 0;
    fetch->step = fetch->word == fetch->end ? FETCH_IDLE : FETCH_ASK;
}

bool cm1e_sii_fetched(void *context, uint16_t word, uint16_t count, uint8_t *bytes)
{
    cm1e_sii_fetch_t *fetch = context;
    if (fetch->failed || (unsigned)word + count > CM1E_FETCH_WORDS)
        return false;
    fetch->word = word;
    fetch->end = (uint16_t)(word + count);
    go_on(fetch);
    if (fetch->step != FETCH_IDLE) {
        fetch->step = FETCH_READY;
        return false;
    }
    memcpy(bytes, fetch->image + 2 * (size_t)word, 2 * (size_t)count);
    return true;
}

static void fail(cm1e_sii_fetch_t *fetch, bool lost)
{
    fetch->failed = true;
    fetch->lost = lost;
    fetch->step = FETCH_IDLE;
}

bool cm1e_sii_fetch_next(cm1e_sii_fetch_t *fetch, cm1e_datagram_t *d, int64_t now_ns)
{
    const uint16_t station = fetch->station;
    const int64_t since_ns = fetch->looked_ns == 0 ? 0 : now_ns - fetch->looked_ns;
    fetch->looked_ns = now_ns;
    fetch->waited_ns += since_ns < LOOK_NS_MAX ? since_ns : LOOK_NS_MAX;
    if (fetch->step != FETCH_IDLE && fetch->waited_ns >= GROUP_NS)
        fail(fetch, fetch->silent > 0);
    if (now_ns < fetch->not_before_ns)
        return false;
    switch (fetch->step) {
    case FETCH_IDLE:
        break;
    case FETCH_READY:
    case FETCH_TAKE:
        cm1e_datagram_set(d, COMMAND_FPRD, station, REG_EEPROM_CONTROL, EEPROM_GROUP_AT + GROUP_BYTES_MAX);
        return true;
    case FETCH_CLEAR:
        cm1e_datagram_set(d, COMMAND_FPWR, station, REG_EEPROM_CONTROL, 2);
        cm1e_put_u16(d->data, EEPROM_NOP);
        return true;
    case FETCH_ASK:
        cm1e_datagram_set(d, COMMAND_FPWR, station, REG_EEPROM_CONTROL, EEPROM_GROUP_AT);
        cm1e_put_u16(d->data, EEPROM_READ);
        cm1e_put_u32(d->data + 2, fetch->word);
        return true;
    }
    return false;
}

static void take_group(cm1e_sii_fetch_t *fetch, const uint8_t *group, unsigned bytes)
{
    for (unsigned i = 0; i < bytes / 2 && fetch->word + i < CM1E_FETCH_WORDS; i++) {
        const unsigned word = fetch->word + i;
        memcpy(fetch->image + 2 * (size_t)word, group + 2 * (size_t)i, 2);
        fetch->known[word / 8] |= (uint8_t)(1u << word % 8);
    }
    go_on(fetch);
}

/** Between two tries the slave has told its status, so it is not lost: its interface refuses, as a busy one does. */
static void try_again(cm1e_sii_fetch_t *fetch, cm1e_fetch_step_t step)
{
    if (++fetch->tries >= GROUP_TRIES)
        fail(fetch, false);
    else
        fetch->step = step;
}

/** A request that was not answered may have been accepted; reading the same words twice does no harm. */
static void not_answered(cm1e_sii_fetch_t *fetch)
{
    fetch->silent++;
    if (fetch->step == FETCH_ASK || fetch->step == FETCH_CLEAR)
        try_again(fetch, FETCH_READY);
    else if (fetch->silent >= SILENT_LIMIT)
        fail(fetch, true);
}

void cm1e_sii_fetch_result(cm1e_sii_fetch_t *fetch, const cm1e_datagram_t *d, int64_t now_ns)
{
    const uint16_t status = cm1e_get_u16(d->data);
    if (d->working_counter != 1) {
        not_answered(fetch);
        return;
    }
    fetch->silent = 0;
    switch (fetch->step) {
    case FETCH_IDLE:
        break;
    case FETCH_READY:
        if (!(status & EEPROM_BUSY))
            fetch->step = status & EEPROM_ERRORS ? FETCH_CLEAR : FETCH_ASK;
        break;
    case FETCH_CLEAR:
        fetch->step = FETCH_ASK;
        break;
    case FETCH_ASK:
        fetch->step = FETCH_TAKE;
        break;
    case FETCH_TAKE:
        if (status & EEPROM_BUSY)
            break;
        if (!(status & EEPROM_NACK)) {
            take_group(fetch, d->data + EEPROM_GROUP_AT, status & EEPROM_READS_8 ? 8 : 4);
            break;
        }
        fetch->not_before_ns = now_ns + NACK_PAUSE_NS; /* the memory itself was busy */
        try_again(fetch, FETCH_READY);
        break;
    }
}
