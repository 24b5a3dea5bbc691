#include "bus/sii_reader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/io.h"
#include "core/bytes.h"
#include "core/text.h"
#include "description/sii_format.h"
#include "description/sii_image.h"

/** An SII is at most 8 MiB by its size word, but no device known needs more than this; it bounds the time of a scan. */
enum { WORDS_MAX = 0x2000, CATEGORIES_MAX = 64 };
enum { WORD_CATEGORIES = CM1E_SII_HEADER_BYTES / 2, HEADER_WORDS = 2, CATEGORY_OF_NOBODY = 0 };
/** Of General a brief reading takes what stands before this byte. */
enum { GENERAL_BRIEF_BYTES = GENERAL_FLAGS + 1 };

typedef struct source {
    cm1e_sii_reader reader;
    void *context;
    uint8_t *image;
} source_t;

/** Words are read in pairs: the image has room for one more behind an odd end. */
static bool fetch(const source_t *source, uint32_t word, uint32_t count)
{
    return count == 0 || source->reader(source->context, (uint16_t)word, (uint16_t)((count + 1) & ~1u),
                                        source->image + 2 * word);
}

static cm1e_sii_result_t describe(cm1e_description_file_t *file, const uint8_t *image, size_t size)
{
    const cm1e_error_t error = cm1e_sii_read(file, image, size, NULL, NULL);
    return error == CM1E_OK ? SII_OK : error == CM1E_ERROR_NO_MEMORY ? SII_NO_MEMORY : SII_DAMAGED;
}

cm1e_sii_result_t cm1e_sii_read_header(cm1e_sii_t *sii, cm1e_sii_reader reader, void *context)
{
    /* Identity and mailbox; the rest of the header is not needed and would cost time for every slave. */
    static const struct {
        uint8_t word, count;
    } wanted[] = {{CM1E_SII_VENDOR / 2, 8}, {CM1E_SII_MAILBOX / 2, 5}};
    uint8_t image[CM1E_SII_HEADER_BYTES] = {0};
    const source_t source = {reader, context, image};
    memset(sii, 0, sizeof *sii);
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++)
        if (!fetch(&source, wanted[i].word, wanted[i].count))
            return SII_UNREADABLE;
    cm1e_description_file_t file = {0};
    const cm1e_sii_result_t result = describe(&file, image, sizeof image);
    if (result == SII_OK) {
        const cm1e_description_t *device = &file.devices.at[0];
        sii->vendor_id = device->vendor_id;
        sii->product_code = device->product_code;
        sii->revision = device->revision;
        sii->serial_number = device->eeprom.serial_number;
        sii->mailbox_out_start = device->eeprom.mailbox_out_start;
        sii->mailbox_out_length = device->eeprom.mailbox_out_length;
        sii->mailbox_in_start = device->eeprom.mailbox_in_start;
        sii->mailbox_in_length = device->eeprom.mailbox_in_length;
        sii->coe = device->mailbox.coe;
        sii->foe = device->mailbox.foe;
    }
    cm1e_description_file_free(&file);
    return result;
}

/* ---- strings, as far as they are needed -------------------------------------------------------------------------- */

/** A category that was not fetched yet, by byte address. */
typedef struct part {
    size_t start, bytes;
} part_t;

static bool fetch_bytes(const source_t *source, size_t start, size_t count)
{
    const size_t first = start / 2, behind = (start + count + 1) / 2;
    return fetch(source, (uint32_t)first, (uint32_t)(behind - first));
}

/** Fetches the lengths of the strings before number `wanted`, and that string. `*length`: its bytes; 0: there is no
 *  such string. */
static bool fetch_string(const source_t *source, const part_t *strings, unsigned wanted, unsigned *length)
{
    const size_t end = strings->start + strings->bytes;
    *length = 0;
    if (wanted == 0 || strings->bytes == 0)
        return true;
    if (!fetch_bytes(source, strings->start, 1))
        return false;
    const unsigned count = source->image[strings->start];
    size_t at = strings->start + 1;
    for (unsigned number = 1; number <= count && number <= wanted && at < end; number++) {
        if (!fetch_bytes(source, at, 1))
            return false;
        const size_t bytes = source->image[at], there = end - at - 1;
        if (number == wanted) {
            *length = (unsigned)(bytes < there ? bytes : there);
            return fetch_bytes(source, at, 1 + *length);
        }
        at += 1 + bytes;
    }
    return true;
}

/** The name of the device; where it has none, its type (cm1e_sii_read_categories()). */
static bool fetch_name(const source_t *source, const part_t *strings, const part_t *general)
{
    const uint8_t *bytes = source->image + general->start;
    unsigned length;
    if (general->bytes <= GENERAL_NAME)
        return fetch_string(source, strings, 1, &length);
    if (!fetch_string(source, strings, bytes[GENERAL_NAME], &length))
        return false;
    return length > 0 || fetch_string(source, strings, bytes[GENERAL_ORDER], &length);
}

static bool fetch_names_of_modes(const source_t *source, const part_t *strings, const part_t *modes)
{
    unsigned length;
    for (size_t at = 0; at + DC_BYTES <= modes->bytes; at += DC_BYTES)
        if (!fetch_string(source, strings, source->image[modes->start + at + DC_NAME], &length))
            return false;
    return true;
}

/* ---- categories -------------------------------------------------------------------------------------------------- */

/** What a brief reading comes back to. */
typedef struct brief {
    part_t strings, general, modes;
} brief_t;

static void keep(part_t *part, const cm1e_sii_category_t *category)
{
    if (part->start == 0)
        *part = (part_t){category->start, category->bytes};
}

/** Bytes that a brief reading fetches of a category. One of which it fetches nothing becomes a category of nobody in
 *  the image, apart from the strings. */
static size_t brief_bytes(const source_t *source, brief_t *brief, const cm1e_sii_category_t *category)
{
    switch (category->type) {
    case SII_CATEGORY_STRINGS:
        keep(&brief->strings, category);
        return 0;
    case SII_CATEGORY_GENERAL:
        keep(&brief->general, category);
        return category->bytes < GENERAL_BRIEF_BYTES ? category->bytes : GENERAL_BRIEF_BYTES;
    case SII_CATEGORY_FMMU:
    case SII_CATEGORY_TXPDO:
    case SII_CATEGORY_RXPDO:
        cm1e_put_u16(source->image + category->start - SII_CATEGORY_HEADER_BYTES, CATEGORY_OF_NOBODY);
        return 0;
    case SII_CATEGORY_DC:
        keep(&brief->modes, category);
        return category->bytes;
    default:
        return category->bytes;
    }
}

/** Reads the categories up to the end mark; unused categories are skipped. `*size`: bytes up to the mark. `brief` NULL:
 *  all of them. */
static cm1e_sii_result_t fetch_categories(const source_t *source, brief_t *brief, size_t room, size_t *size)
{
    uint32_t word = WORD_CATEGORIES;
    for (int n = 0; n < CATEGORIES_MAX; n++) {
        cm1e_sii_category_t category;
        if (!fetch(source, word, HEADER_WORDS))
            return SII_UNREADABLE;
        if (!cm1e_sii_category_at(&category, source->image, room, 2 * word))
            return SII_DAMAGED;
        *size = category.start;
        if (category.type == CM1E_SII_CATEGORY_END)
            return SII_OK;
        word += HEADER_WORDS + (uint32_t)(category.bytes / 2);
        if (word > WORDS_MAX)
            return SII_DAMAGED;
        if (!cm1e_sii_category_is_read(category.type))
            continue;
        const size_t bytes = brief ? brief_bytes(source, brief, &category) : category.bytes;
        if (!fetch_bytes(source, category.start, bytes))
            return SII_UNREADABLE;
    }
    return SII_DAMAGED;
}

static cm1e_sii_result_t fetch_briefly(const source_t *source, size_t room, size_t *size)
{
    brief_t brief = {0};
    const cm1e_sii_result_t result = fetch_categories(source, &brief, room, size);
    if (result != SII_OK)
        return result;
    return fetch_name(source, &brief.strings, &brief.general) &&
                   fetch_names_of_modes(source, &brief.strings, &brief.modes)
               ? SII_OK
               : SII_UNREADABLE;
}

static void take_sync_managers(cm1e_sii_t *sii, const cm1e_description_t *device)
{
    for (size_t i = 0; i < device->sync_managers.count && i < CM1E_SII_SYNC_MANAGERS; i++) {
        const cm1e_described_sync_manager_t *manager = &device->sync_managers.at[i];
        sii->sync_managers[i] = (cm1e_sii_sync_manager_t){
            .start = manager->start, .length = manager->length, .control = manager->control, .enable = manager->enable,
            .use = (uint8_t)manager->use};
        sii->sync_manager_count = (uint8_t)(i + 1);
    }
}

static void take_dc_modes(cm1e_sii_t *sii, const cm1e_description_t *device)
{
    for (size_t i = 0; i < device->dc_modes.count && i < CM1E_SII_DC_MODES; i++) {
        const cm1e_dc_mode_t *mode = &device->dc_modes.at[i];
        cm1e_sii_dc_mode_t *taken = &sii->dc_modes[sii->dc_mode_count++];
        cm1e_text_of_device(taken->name, sizeof taken->name, mode->name, strlen(mode->name));
        taken->facts = (cm1e_dc_facts_t){
            .assign_activate = mode->assign_activate, .sync0_cycle_ns = mode->sync0_cycle_ns,
            .sync0_factor = mode->sync0_factor, .sync0_shift_ns = mode->sync0_shift_ns,
            .sync1_factor = mode->sync1_factor, .sync1_shift_ns = mode->sync1_shift_ns};
    }
}

/** Adds up the bits that each sync manager carries; a PDO without one is not assigned. */
static void take_pdos(cm1e_sii_t *sii, const cm1e_description_t *device)
{
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        if (pdo->sync_manager >= 0 && pdo->sync_manager < CM1E_SII_SYNC_MANAGERS)
            sii->bits[pdo->transmit][pdo->sync_manager] += cm1e_pdo_bits(pdo);
    }
}

/** ETG.1020 base data types that a handle has a type for; any other is taken by its number of bits. */
static cm1e_io_type_t type_of(const cm1e_described_pdo_entry_t *entry)
{
    static const struct {
        const char *name;
        uint8_t bits;
        cm1e_io_type_t type;
    } known[] = {
        {"SINT", 8, CM1E_IO_SINT}, {"INT", 16, CM1E_IO_INT}, {"DINT", 32, CM1E_IO_DINT}, {"LINT", 64, CM1E_IO_LINT},
        {"REAL", 32, CM1E_IO_REAL}, {"LREAL", 64, CM1E_IO_LREAL},
    };
    for (size_t i = 0; entry->type && i < sizeof known / sizeof known[0]; i++)
        if (entry->bits == known[i].bits && strcmp(entry->type, known[i].name) == 0)
            return known[i].type;
    return cm1e_io_type_of_bits(entry->bits);
}

static void name_signal(cm1e_sii_signal_t *signal, const cm1e_described_pdo_t *pdo, const char *entry)
{
    const char *words[2] = {pdo->name && pdo->name[0] ? pdo->name : NULL, entry && entry[0] ? entry : NULL};
    char name[2 * CM1E_SII_SIGNAL_NAME];
    snprintf(name, sizeof name, "%.60s%s%.60s", words[0] ? words[0] : "", words[0] && words[1] ? " " : "",
             words[1] ? words[1] : "");
    cm1e_text_of_device(signal->name, sizeof signal->name, name, strlen(name));
}

/** Where the process data of a sync manager begin: each has whole bytes. */
static uint32_t begin_of(const cm1e_sii_t *sii, int direction, int sync_manager)
{
    uint32_t bits = 0;
    for (int sm = 0; sm < sync_manager; sm++)
        bits += (sii->bits[direction][sm] + 7) / 8 * 8;
    return bits;
}

static void take_entries(cm1e_sii_t *sii, const cm1e_described_pdo_t *pdo, uint32_t *at)
{
    for (size_t n = 0; n < pdo->entries.count; n++) {
        const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[n];
        if (entry->index != 0 && entry->bits > 0 && entry->bits <= UINT16_MAX) {
            cm1e_sii_signal_t *signal = &sii->signals->at[sii->signals->count++];
            *signal = (cm1e_sii_signal_t){.input = pdo->transmit, .index = entry->index, .subindex = entry->subindex,
                                          .type = (uint8_t)type_of(entry), .bits = (uint16_t)entry->bits,
                                          .bit_offset = *at};
            name_signal(signal, pdo, entry->name);
        }
        *at += entry->bits;
    }
}

/** After take_pdos(). In a sync manager PDOs lie one behind the other in the order of the SII. */
static bool take_signals(cm1e_sii_t *sii, const cm1e_description_t *device)
{
    size_t entries = 0;
    for (size_t i = 0; i < device->pdos.count; i++)
        entries += device->pdos.at[i].entries.count;
    if (entries == 0)
        return true;
    sii->signals = calloc(1, sizeof *sii->signals + entries * sizeof sii->signals->at[0]);
    if (!sii->signals)
        return false;
    uint32_t at[2][CM1E_SII_SYNC_MANAGERS];
    for (int direction = 0; direction < 2; direction++)
        for (int sm = 0; sm < CM1E_SII_SYNC_MANAGERS; sm++)
            at[direction][sm] = begin_of(sii, direction, sm);
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        if (pdo->sync_manager >= 0 && pdo->sync_manager < CM1E_SII_SYNC_MANAGERS)
            take_entries(sii, pdo, &at[pdo->transmit][pdo->sync_manager]);
    }
    return true;
}

cm1e_sii_result_t cm1e_sii_read_categories(cm1e_sii_t *sii, bool brief, cm1e_sii_reader reader, void *context)
{
    uint8_t image[2 * (WORDS_MAX + HEADER_WORDS)] = {0};
    const source_t source = {reader, context, image};
    size_t size = 0;
    cm1e_sii_result_t result = brief ? fetch_briefly(&source, sizeof image, &size)
                                     : fetch_categories(&source, NULL, sizeof image, &size);
    if (result != SII_OK)
        return result;
    cm1e_description_file_t file = {0};
    result = describe(&file, image, size);
    if (result == SII_OK) {
        const cm1e_description_t *device = &file.devices.at[0];
        const char *name = device->name[0] ? device->name : device->type;
        cm1e_text_of_device(sii->name, sizeof sii->name, name, strlen(name));
        sii->complete_access = device->mailbox.complete_access;
        sii->no_lrw = device->no_lrw;
        take_sync_managers(sii, device);
        take_dc_modes(sii, device);
        take_pdos(sii, device);
        if (!take_signals(sii, device))
            result = SII_NO_MEMORY;
    }
    cm1e_description_file_free(&file);
    return result;
}

void cm1e_sii_free(cm1e_sii_t *sii)
{
    free(sii->signals);
    sii->signals = NULL;
}
