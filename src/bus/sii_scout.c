#include "bus/sii_scout.h"

#include <string.h>

#include "bus/eeprom_interface.h"
#include "core/bytes.h"
#include "description/sii_image.h"

enum { ANSWER_BYTES = EEPROM_GROUP_AT + 8 };
enum { WORD_CATEGORIES = CM1E_SII_HEADER_BYTES / 2, READS_MAX = 1500, WORDS_MAX = 0x2000 };
/* ETG.2010 table 6: categories. */
enum { CATEGORY_SYNC_MANAGERS = 41, CATEGORY_TX_PDO = 50, CATEGORY_RX_PDO = 51, CATEGORY_END = 0xFFFF };
enum { SYNC_MANAGER_WORDS = 4, PDO_WORDS = 4, ENTRY_WORDS = 4 };

/** The pairs of words of the header that are read, in this order. */
static const uint8_t header_words[] = {
    CM1E_SII_VENDOR / 2, CM1E_SII_PRODUCT / 2, CM1E_SII_PRODUCT / 2 + 2, CM1E_SII_SERIAL / 2,
    CM1E_SII_MAILBOX / 2, CM1E_SII_MAILBOX / 2 + 2, CM1E_SII_MAILBOX / 2 + 4,
};
enum { HEADER_READS = sizeof header_words };

/** Phases: what the pair of words is that is read now. */
enum { HEADER = 0, CATEGORY, MANAGER_PLACE, MANAGER_CONTROL, PDO, ENTRY };

void cm1e_scout_begin(cm1e_scout_t *scout, uint16_t station, int64_t deadline_ns)
{
    *scout = (cm1e_scout_t){.station = station, .step = SCOUT_FORCE, .deadline_ns = deadline_ns,
                            .word = header_words[0]};
}

static void end(cm1e_scout_t *scout, bool good)
{
    scout->good = good;
    scout->step = SCOUT_IDLE;
}

bool cm1e_scout_next(cm1e_scout_t *scout, cm1e_datagram_t *d, int64_t now_ns)
{
    const uint16_t station = scout->station;
    if (scout->step != SCOUT_IDLE && now_ns >= scout->deadline_ns)
        end(scout, false);
    switch (scout->step) {
    case SCOUT_IDLE:
        break;
    case SCOUT_FORCE:
    case SCOUT_OWN:
        cm1e_datagram_set(d, COMMAND_FPWR, station, REG_EEPROM_CONFIG, 1);
        d->data[0] = scout->step == SCOUT_FORCE ? 2 : 0;
        return true;
    case SCOUT_READY:
        cm1e_datagram_set(d, COMMAND_FPRD, station, REG_EEPROM_CONTROL, 2);
        return true;
    case SCOUT_CLEAR:
        cm1e_datagram_set(d, COMMAND_FPWR, station, REG_EEPROM_CONTROL, 2);
        cm1e_put_u16(d->data, 0);
        return true;
    case SCOUT_ASK:
        cm1e_datagram_set(d, COMMAND_FPWR, station, REG_EEPROM_CONTROL, 6);
        cm1e_put_u16(d->data, EEPROM_READ);
        cm1e_put_u32(d->data + 2, scout->word);
        return true;
    case SCOUT_TAKE:
        cm1e_datagram_set(d, COMMAND_FPRD, station, REG_EEPROM_CONTROL, ANSWER_BYTES);
        return true;
    }
    return false;
}

/* ---- what the words say ------------------------------------------------------------------------------------------ */

static void take_header(cm1e_scout_t *scout, const uint8_t *pair)
{
    cm1e_scouted_t *found = &scout->found;
    uint32_t *const identity[] = {&found->vendor_id, &found->product_code, &found->revision, &found->serial_number};
    const uint16_t first = cm1e_get_u16(pair), second = cm1e_get_u16(pair + 2);
    if (scout->item < 4) {
        *identity[scout->item] = cm1e_get_u32(pair);
    } else if (scout->item == 4) {
        found->mailbox_out_start = first;
        found->mailbox_out_length = second;
    } else if (scout->item == 5) {
        found->mailbox_in_start = first;
        found->mailbox_in_length = second;
    } else {
        found->protocols = first;
    }
    if (++scout->item < HEADER_READS) {
        scout->word = header_words[scout->item];
    } else {
        scout->phase = CATEGORY;
        scout->word = WORD_CATEGORIES;
    }
}

static void next_category(cm1e_scout_t *scout)
{
    scout->phase = CATEGORY;
    scout->word = scout->next_category;
}

static void take_category(cm1e_scout_t *scout, const uint8_t *pair)
{
    const uint16_t type = cm1e_get_u16(pair), words = cm1e_get_u16(pair + 2);
    if (type == CATEGORY_END) {
        end(scout, true);
        return;
    }
    if ((uint32_t)scout->word + 2 + words > WORDS_MAX) {
        end(scout, false);
        return;
    }
    scout->next_category = (uint16_t)(scout->word + 2 + words);
    scout->word = (uint16_t)(scout->word + 2);
    scout->items = (uint16_t)(words / SYNC_MANAGER_WORDS);
    scout->item = type == CATEGORY_RX_PDO ? 0 : 1;
    if (type == CATEGORY_SYNC_MANAGERS && words >= SYNC_MANAGER_WORDS)
        scout->phase = MANAGER_PLACE;
    else if ((type == CATEGORY_TX_PDO || type == CATEGORY_RX_PDO) && words >= PDO_WORDS)
        scout->phase = PDO;
    else
        next_category(scout);
}

static void take_manager(cm1e_scout_t *scout, const uint8_t *pair)
{
    cm1e_scouted_t *found = &scout->found;
    if (found->sync_manager_count == CM1E_SII_SYNC_MANAGERS) {
        next_category(scout);
        return;
    }
    cm1e_sii_sync_manager_t *manager = &found->sync_managers[found->sync_manager_count];
    scout->word = (uint16_t)(scout->word + 2);
    if (scout->phase == MANAGER_PLACE) {
        manager->start = cm1e_get_u16(pair);
        manager->length = cm1e_get_u16(pair + 2);
        scout->phase = MANAGER_CONTROL;
        return;
    }
    manager->control = pair[0];
    manager->enable = pair[2];
    manager->use = pair[3];
    found->sync_manager_count++;
    scout->phase = MANAGER_PLACE;
    if (--scout->items == 0)
        next_category(scout);
}

/** Index, number of entries, sync manager. In this phase and the next `item` is the direction. */
static void take_pdo(cm1e_scout_t *scout, const uint8_t *pair)
{
    scout->items = pair[2];
    scout->sync_manager = pair[3];
    scout->word = (uint16_t)(scout->word + PDO_WORDS);
    scout->phase = ENTRY;
    if (scout->items > 0 && scout->word + ENTRY_WORDS <= scout->next_category) {
        scout->word = (uint16_t)(scout->word + 2); /* the second half of an entry has its bits */
        return;
    }
    scout->phase = PDO;
    if (scout->word + PDO_WORDS > scout->next_category)
        next_category(scout);
}

static void take_entry(cm1e_scout_t *scout, const uint8_t *pair)
{
    if (scout->sync_manager < CM1E_SII_SYNC_MANAGERS) {
        uint16_t *bits = &scout->found.bits[scout->item][scout->sync_manager];
        *bits = (uint16_t)(*bits + pair[1]);
    }
    scout->word = (uint16_t)(scout->word + ENTRY_WORDS);
    if (--scout->items > 0 && scout->word + 2 <= scout->next_category)
        return;
    scout->word = (uint16_t)(scout->word - 2);
    scout->phase = PDO;
    if (scout->word + PDO_WORDS > scout->next_category)
        next_category(scout);
}

static void take_pair(cm1e_scout_t *scout, const uint8_t *pair)
{
    static void (*const takers[])(cm1e_scout_t *, const uint8_t *) = {
        [HEADER] = take_header, [CATEGORY] = take_category, [MANAGER_PLACE] = take_manager,
        [MANAGER_CONTROL] = take_manager, [PDO] = take_pdo, [ENTRY] = take_entry,
    };
    scout->step = SCOUT_ASK;
    takers[scout->phase](scout, pair);
    if (++scout->reads >= READS_MAX)
        end(scout, false);
}

/* ---- the interface ----------------------------------------------------------------------------------------------- */

void cm1e_scout_result(cm1e_scout_t *scout, const cm1e_datagram_t *d)
{
    const uint16_t status = cm1e_get_u16(d->data);
    if (d->working_counter != 1)
        return; /* repeated until the deadline */
    switch (scout->step) {
    case SCOUT_IDLE:
        break;
    case SCOUT_FORCE:
        scout->step = SCOUT_OWN;
        break;
    case SCOUT_OWN:
        scout->step = SCOUT_READY;
        break;
    case SCOUT_READY:
        if (!(status & EEPROM_BUSY))
            scout->step = status & EEPROM_ERRORS ? SCOUT_CLEAR : SCOUT_ASK;
        break;
    case SCOUT_CLEAR:
        scout->step = SCOUT_ASK;
        break;
    case SCOUT_ASK:
        scout->step = SCOUT_TAKE;
        break;
    case SCOUT_TAKE:
        if (status & EEPROM_BUSY)
            break;
        if (status & EEPROM_NACK)
            scout->step = SCOUT_CLEAR; /* the memory itself was busy */
        else
            take_pair(scout, d->data + EEPROM_GROUP_AT);
        break;
    }
}
