#include "bus/sii.h"

#include <string.h>

#include "core/bytes.h"

/* Word addresses and category types (ETG.2010 tables 2 and 3). */
enum {
    WORD_VENDOR = 0x08, WORD_PRODUCT = 0x0A, WORD_REVISION = 0x0C, WORD_SERIAL = 0x0E,
    WORD_MAILBOX_OUT = 0x18, WORD_MAILBOX_IN = 0x1A, WORD_MAILBOX_PROTOCOLS = 0x1C, WORD_CATEGORIES = 0x40,
    CATEGORY_STRINGS = 10, CATEGORY_GENERAL = 30, CATEGORY_SYNC_MANAGERS = 41, CATEGORY_TXPDO = 50, CATEGORY_RXPDO = 51,
    CATEGORY_END = 0xFFFF,
};
/** A SII is at most 4 Mbit by its size word, but no device known needs more than this; it bounds the time of a scan. */
enum { WORDS_MAX = 0x2000, CATEGORIES_MAX = 64 };
enum { GENERAL_NAME = 3, GENERAL_COE = 5, GENERAL_FLAGS = 11, FLAG_NO_LRW = 0x02 };
enum { SM_ENTRY_BYTES = 8, PDO_HEADER_BYTES = 8, PDO_ENTRY_BYTES = 8 };

/** The bytes of one category, fetched as they are asked for. */
typedef struct cm1e_sii_view {
    cm1e_sii_reader reader;
    void *context;
    uint32_t first_word, bytes;
    uint32_t cached_word;
    uint8_t cache[4];
    bool failed;
} cm1e_sii_view_t;

/** 0 behind the end of the category and after a failure. */
static uint8_t byte_at(cm1e_sii_view_t *view, uint32_t place)
{
    const uint32_t word = view->first_word + place / 4 * 2;
    if (view->failed || place >= view->bytes)
        return 0;
    if (word != view->cached_word) {
        view->failed = !view->reader(view->context, (uint16_t)word, view->cache);
        view->cached_word = word;
    }
    return view->failed ? 0 : view->cache[place % 4];
}

static uint16_t word_at(cm1e_sii_view_t *view, uint32_t place)
{
    return (uint16_t)(byte_at(view, place) | byte_at(view, place + 1) << 8);
}

static bool read_u32(cm1e_sii_reader reader, void *context, uint16_t word, uint32_t *value)
{
    uint8_t bytes[4];
    if (!reader(context, word, bytes))
        return false;
    *value = cm1e_get_u32(bytes);
    return true;
}

cm1e_sii_result_t cm1e_sii_read_header(cm1e_sii_t *sii, cm1e_sii_reader reader, void *context)
{
    uint32_t out, in, protocols;
    memset(sii, 0, sizeof *sii);
    if (!read_u32(reader, context, WORD_VENDOR, &sii->vendor_id) ||
        !read_u32(reader, context, WORD_PRODUCT, &sii->product_code) ||
        !read_u32(reader, context, WORD_REVISION, &sii->revision) ||
        !read_u32(reader, context, WORD_SERIAL, &sii->serial_number) ||
        !read_u32(reader, context, WORD_MAILBOX_OUT, &out) || !read_u32(reader, context, WORD_MAILBOX_IN, &in) ||
        !read_u32(reader, context, WORD_MAILBOX_PROTOCOLS, &protocols))
        return SII_UNREADABLE;
    sii->mailbox_out_start = (uint16_t)out;
    sii->mailbox_out_length = (uint16_t)(out >> 16);
    sii->mailbox_in_start = (uint16_t)in;
    sii->mailbox_in_length = (uint16_t)(in >> 16);
    sii->mailbox_protocols = (uint16_t)protocols;
    return SII_OK;
}

/** String number `wanted`, from 1. */
static void take_string(cm1e_sii_t *sii, cm1e_sii_view_t *view, unsigned wanted)
{
    const unsigned count = byte_at(view, 0);
    uint32_t place = 1;
    for (unsigned n = 1; n <= count && n < wanted; n++)
        place += 1u + byte_at(view, place);
    const unsigned length = wanted >= 1 && wanted <= count ? byte_at(view, place) : 0;
    unsigned i = 0;
    for (; i < length && i < CM1E_SII_NAME - 1; i++) {
        const uint8_t c = byte_at(view, place + 1 + i);
        if (c == 0)
            break;
        sii->name[i] = c >= ' ' && c <= '~' ? (char)c : '?';
    }
    sii->name[i] = 0;
}

static void take_sync_managers(cm1e_sii_t *sii, cm1e_sii_view_t *view)
{
    const uint32_t count = view->bytes / SM_ENTRY_BYTES;
    sii->sync_manager_count = (uint8_t)(count < CM1E_SII_SYNC_MANAGERS ? count : CM1E_SII_SYNC_MANAGERS);
    for (unsigned i = 0; i < sii->sync_manager_count; i++) {
        const uint32_t place = i * SM_ENTRY_BYTES;
        sii->sync_managers[i] = (cm1e_sii_sync_manager_t){
            .start = word_at(view, place),
            .length = word_at(view, place + 2),
            .control = byte_at(view, place + 4),
            .enable = byte_at(view, place + 6),
        };
    }
}

/** Adds up the bits that each sync manager carries; a PDO without one (0xFF) is not assigned. */
static void take_pdos(cm1e_sii_t *sii, cm1e_sii_view_t *view, int direction)
{
    for (uint32_t place = 0; place + PDO_HEADER_BYTES <= view->bytes && !view->failed;) {
        const unsigned entries = byte_at(view, place + 2), sm = byte_at(view, place + 3);
        place += PDO_HEADER_BYTES;
        for (unsigned i = 0; i < entries; i++, place += PDO_ENTRY_BYTES) {
            if (sm < CM1E_SII_SYNC_MANAGERS)
                sii->bits[direction][sm] += byte_at(view, place + 5);
        }
    }
}

/** One category; the strings are taken when the general one has told which of them is the name. */
static void take(cm1e_sii_t *sii, uint16_t type, cm1e_sii_view_t *view, cm1e_sii_view_t *strings, unsigned *name)
{
    switch (type) {
    case CATEGORY_STRINGS:
        *strings = *view;
        break;
    case CATEGORY_GENERAL:
        *name = byte_at(view, GENERAL_NAME);
        sii->coe_details = byte_at(view, GENERAL_COE);
        sii->no_lrw = byte_at(view, GENERAL_FLAGS) & FLAG_NO_LRW;
        break;
    case CATEGORY_SYNC_MANAGERS:
        take_sync_managers(sii, view);
        break;
    case CATEGORY_TXPDO:
        take_pdos(sii, view, 1);
        break;
    case CATEGORY_RXPDO:
        take_pdos(sii, view, 0);
        break;
    default:
        break;
    }
}

cm1e_sii_result_t cm1e_sii_read_categories(cm1e_sii_t *sii, cm1e_sii_reader reader, void *context)
{
    cm1e_sii_view_t strings = {.reader = reader, .context = context, .cached_word = UINT32_MAX};
    unsigned name = 0;
    uint32_t word = WORD_CATEGORIES;
    for (int n = 0; n < CATEGORIES_MAX; n++) {
        uint32_t header;
        if (!read_u32(reader, context, (uint16_t)word, &header))
            return SII_UNREADABLE;
        const uint16_t type = (uint16_t)header;
        if (type == CATEGORY_END) {
            take_string(sii, &strings, name ? name : 1);
            return strings.failed ? SII_UNREADABLE : SII_OK;
        }
        cm1e_sii_view_t view = {.reader = reader, .context = context, .first_word = word + 2,
                                .bytes = 2 * (header >> 16), .cached_word = UINT32_MAX};
        word += 2 + (header >> 16);
        if (word > WORDS_MAX)
            return SII_DAMAGED;
        take(sii, type, &view, &strings, &name);
        if (view.failed)
            return SII_UNREADABLE;
    }
    return SII_DAMAGED;
}
