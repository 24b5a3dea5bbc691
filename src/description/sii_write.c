#include "description/sii_image.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/bytes.h"
#include "description/sii_format.h"

/* The image as it grows; strings are collected first, because their category comes first and others refer to it. Data
 * that does not fit is counted, but not written. */
typedef struct writer {
    uint8_t *image;
    size_t at, size;
    const char *strings[SII_STRINGS_MAX];
    unsigned string_count;
    const cm1e_description_t *device;
    cm1e_diag_t *diag;
    bool failed;
} writer_t;

uint8_t cm1e_sii_crc8(const uint8_t *bytes, size_t count)
{
    uint8_t crc = 0xFF;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = (uint8_t)(crc & 0x80 ? crc << 1 ^ 0x07 : crc << 1);
    }
    return crc;
}

/* The first reason counts. */
__attribute__((format(printf, 2, 3)))
static void fail(writer_t *w, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (!w->failed)
        cm1e_diag_set(w->diag, CM1E_ERROR_CONFIG, 0, "no SII image of this device can be written: %s", text);
    w->failed = true;
}

static void put_u8(writer_t *w, unsigned value)
{
    if (w->at < w->size)
        w->image[w->at] = (uint8_t)value;
    w->at++;
}
static void put_u16(writer_t *w, unsigned value)
{
    put_u8(w, value & 0xFF);
    put_u8(w, value >> 8 & 0xFF);
}
static void put_u32(writer_t *w, uint32_t value)
{
    put_u16(w, value & 0xFFFF);
    put_u16(w, value >> 16);
}

static size_t category_begin(writer_t *w, unsigned type)
{
    put_u16(w, type);
    put_u16(w, 0);
    return w->at;
}

/* Categories have whole words; the length is known only now. */
static void category_end(writer_t *w, size_t start)
{
    if ((w->at - start) % 2)
        put_u8(w, 0);
    const size_t words = (w->at - start) / 2;
    if (words > UINT16_MAX)
        fail(w, "a category would have %zu words; the format has room for 65535", words);
    else if (start <= w->size)
        cm1e_put_u16(w->image + start - 2, (uint16_t)words);
}

/* ---- strings ---------------------------------------------------------------------------------------------------- */

/* The next letter of a UTF-8 text in ISO 8859-1, "?" where that lacks it; 0 at the end. */
static uint8_t next_letter(const char **text)
{
    const uint8_t *at = (const uint8_t *)*text;
    if (*at == 0)
        return 0;
    const uint8_t first = *at++;
    unsigned letter = first;
    if (first >= 0xC0)
        letter = (first == 0xC2 || first == 0xC3) && *at >> 6 == 2 ? (unsigned)(first & 0x03) << 6 | (*at & 0x3F) : '?';
    while (first >= 0xC0 && *at >> 6 == 2)
        at++;
    *text = (const char *)at;
    return (letter >= 0x20 && letter <= 0x7E) || (letter >= 0xA0 && first >= 0xC0) ? (uint8_t)letter : '?';
}

static size_t letter_count(const char *text)
{
    size_t count = 0;
    while (next_letter(&text))
        count++;
    return count;
}

static bool reads_the_same(const char *left, const char *right)
{
    uint8_t letter;
    do {
        letter = next_letter(&left);
        if (letter != next_letter(&right))
            return false;
    } while (letter);
    return true;
}

/* Number of a string (1 = first), adding it where it is new; 0: no string. */
static unsigned string_number(writer_t *w, const char *text)
{
    if (!text || !*text || w->failed)
        return 0;
    for (unsigned i = 0; i < w->string_count; i++)
        if (reads_the_same(w->strings[i], text))
            return i + 1;
    if (letter_count(text) > SII_STRING_BYTES_MAX)
        fail(w, "the name \"%.40s...\" has more than %d letters", text, SII_STRING_BYTES_MAX);
    else if (w->string_count == SII_STRINGS_MAX)
        fail(w, "it has more than %d different names", SII_STRINGS_MAX);
    if (w->failed)
        return 0;
    w->strings[w->string_count++] = text;
    return w->string_count;
}

/* If no mode switches distributed clocks on, the category is omitted, as for a device without them. */
static bool has_dc_category(const cm1e_description_t *device)
{
    for (size_t i = 0; i < device->dc_modes.count; i++)
        if (device->dc_modes.at[i].assign_activate != 0)
            return true;
    return false;
}

static void collect_pdo_strings(writer_t *w, bool transmit)
{
    for (size_t i = 0; i < w->device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &w->device->pdos.at[i];
        if (pdo->transmit != transmit)
            continue;
        string_number(w, pdo->name);
        for (size_t e = 0; e < pdo->entries.count; e++)
            string_number(w, pdo->entries.at[e].name);
    }
}

/* The order number first: SOEM and others show string 1 as the name. */
static void collect_strings(writer_t *w)
{
    const cm1e_description_t *device = w->device;
    string_number(w, device->type);
    string_number(w, device->name);
    string_number(w, device->group);
    collect_pdo_strings(w, true);
    collect_pdo_strings(w, false);
    for (size_t i = 0; has_dc_category(device) && i < device->dc_modes.count; i++) {
        string_number(w, device->dc_modes.at[i].name);
        string_number(w, device->dc_modes.at[i].text);
    }
}

static void write_strings(writer_t *w)
{
    const size_t start = category_begin(w, SII_CATEGORY_STRINGS);
    put_u8(w, w->string_count);
    for (unsigned i = 0; i < w->string_count; i++) {
        const char *text = w->strings[i];
        put_u8(w, (unsigned)letter_count(text));
        for (uint8_t letter; (letter = next_letter(&text)) != 0;)
            put_u8(w, letter);
    }
    category_end(w, start);
}

/* ---- the fixed part --------------------------------------------------------------------------------------------- */

static const cm1e_described_sync_manager_t *sync_manager_for(const cm1e_description_t *device,
                                                             cm1e_sync_manager_use_t use)
{
    for (size_t i = 0; i < device->sync_managers.count; i++)
        if (device->sync_managers.at[i].use == use)
            return &device->sync_managers.at[i];
    return NULL;
}

static void write_mailbox(uint8_t *at, uint16_t start, uint16_t length, const cm1e_described_sync_manager_t *manager)
{
    const bool stated = length != 0 || !manager;
    cm1e_put_u16(at, stated ? start : manager->start);
    cm1e_put_u16(at + 2, stated ? length : manager->length);
}

static void write_bytes(uint8_t *at, cm1e_bytes_t bytes, size_t limit)
{
    if (bytes.data)
        memcpy(at, bytes.data, bytes.size < limit ? bytes.size : limit);
}

static void write_header(writer_t *w)
{
    const cm1e_description_t *device = w->device;
    const cm1e_described_eeprom_t *eeprom = &device->eeprom;
    const cm1e_mailbox_protocols_t *mailbox = &device->mailbox;
    uint8_t *const image = w->image;
    memset(image, 0xFF, w->size);
    memset(image, 0, CM1E_SII_HEADER_BYTES);
    write_bytes(image + CM1E_SII_CONFIG, eeprom->config_data, CM1E_SII_CONFIG_BYTES);
    if (eeprom->alias != 0)
        cm1e_put_u16(image + CM1E_SII_ALIAS, eeprom->alias);
    image[CM1E_SII_CHECKSUM] = cm1e_sii_crc8(image, CM1E_SII_CONFIG_BYTES);
    cm1e_put_u32(image + CM1E_SII_VENDOR, device->vendor_id);
    cm1e_put_u32(image + CM1E_SII_PRODUCT, device->product_code);
    cm1e_put_u32(image + CM1E_SII_REVISION, device->revision);
    cm1e_put_u32(image + CM1E_SII_SERIAL, eeprom->serial_number);
    write_bytes(image + CM1E_SII_BOOTSTRAP, eeprom->bootstrap, CM1E_SII_BOOTSTRAP_BYTES);
    if (mailbox->present) {
        write_mailbox(image + CM1E_SII_MAILBOX, eeprom->mailbox_out_start, eeprom->mailbox_out_length,
                      sync_manager_for(device, CM1E_SM_MAILBOX_OUT));
        write_mailbox(image + CM1E_SII_MAILBOX + 4, eeprom->mailbox_in_start, eeprom->mailbox_in_length,
                      sync_manager_for(device, CM1E_SM_MAILBOX_IN));
    }
    cm1e_put_u16(image + CM1E_SII_PROTOCOLS,
                 (uint16_t)((mailbox->aoe ? SII_PROTOCOL_AOE : 0) | (mailbox->eoe ? SII_PROTOCOL_EOE : 0) |
                            (mailbox->coe ? SII_PROTOCOL_COE : 0) | (mailbox->foe ? SII_PROTOCOL_FOE : 0) |
                            (mailbox->soe ? SII_PROTOCOL_SOE : 0) | (mailbox->voe ? SII_PROTOCOL_VOE : 0)));
    cm1e_put_u16(image + CM1E_SII_KBIT, (uint16_t)(w->size / CM1E_SII_BYTES_PER_KBIT - 1));
    cm1e_put_u16(image + CM1E_SII_VERSION, eeprom->version ? eeprom->version : 1);
}

/* ---- categories ------------------------------------------------------------------------------------------------- */

static unsigned ports_of(const char *physics)
{
    static const char letters[] = SII_PORT_LETTERS;
    unsigned ports = 0;
    for (unsigned port = 0; physics && port < SII_PORTS && physics[port]; port++) {
        const char *letter = strchr(letters, physics[port]);
        ports |= (letter ? (unsigned)(letter - letters) : 0) << 4 * port;
    }
    return ports;
}

static unsigned drives_of(const cm1e_description_t *device)
{
    unsigned drives = 0;
    for (size_t i = 0; i < device->channels.count && drives < UINT8_MAX; i++)
        drives += device->channels.at[i].profile_no == 402;
    return drives;
}

static void write_general(writer_t *w)
{
    const cm1e_description_t *device = w->device;
    const cm1e_mailbox_protocols_t *mailbox = &device->mailbox;
    const size_t start = category_begin(w, SII_CATEGORY_GENERAL);
    put_u8(w, string_number(w, device->group));
    put_u8(w, 0); /* picture */
    put_u8(w, string_number(w, device->type));
    put_u8(w, string_number(w, device->name));
    put_u8(w, 0);
    put_u8(w, (mailbox->coe ? COE_SDO : 0u) | (mailbox->sdo_info ? COE_SDO_INFO : 0u) |
                  (mailbox->pdo_assign ? COE_PDO_ASSIGN : 0u) | (mailbox->pdo_config ? COE_PDO_CONFIG : 0u) |
                  (mailbox->pdo_upload ? COE_PDO_UPLOAD : 0u) | (mailbox->complete_access ? COE_COMPLETE_ACCESS : 0u));
    put_u8(w, mailbox->foe);
    put_u8(w, mailbox->eoe);
    put_u8(w, 0); /* SoE channels */
    put_u8(w, drives_of(device));
    put_u8(w, 0);
    put_u8(w, (device->no_lrw ? FLAG_NO_LRW : 0u) | (mailbox->data_link_layer ? FLAG_DATA_LINK_LAYER : 0u) |
                  (device->identification_reg134 ? FLAG_ID_IN_AL_STATUS : 0u));
    put_u16(w, 0); /* current on the E-bus */
    put_u16(w, string_number(w, device->group));
    put_u16(w, ports_of(device->physics));
    while (w->at < start + GENERAL_BYTES)
        put_u8(w, 0);
    category_end(w, start);
}

static void write_fmmus(writer_t *w)
{
    const size_t start = category_begin(w, SII_CATEGORY_FMMU);
    for (size_t i = 0; i < w->device->fmmus.count; i++)
        put_u8(w, w->device->fmmus.at[i].use);
    category_end(w, start);
}

static unsigned length_of(writer_t *w, size_t manager)
{
    if (w->device->sync_managers.at[manager].length_given)
        return w->device->sync_managers.at[manager].length;
    const uint32_t bytes = cm1e_description_process_bytes(w->device, (unsigned)manager);
    if (bytes > UINT16_MAX)
        fail(w, "sync manager %zu carries %u bytes; the format has room for 65535", manager, (unsigned)bytes);
    return bytes;
}

static void write_sync_managers(writer_t *w)
{
    const size_t start = category_begin(w, SII_CATEGORY_SYNC_MANAGERS);
    for (size_t i = 0; i < w->device->sync_managers.count; i++) {
        const cm1e_described_sync_manager_t *manager = &w->device->sync_managers.at[i];
        put_u16(w, manager->start);
        put_u16(w, length_of(w, i));
        put_u8(w, manager->control);
        put_u8(w, 0); /* status */
        put_u8(w, manager->enable);
        put_u8(w, manager->use);
    }
    category_end(w, start);
}

static void write_pdo(writer_t *w, const cm1e_described_pdo_t *pdo)
{
    const bool carried = pdo->sync_manager != CM1E_NO_SYNC_MANAGER;
    if (pdo->entries.count > UINT8_MAX)
        fail(w, "PDO 0x%04X has %zu entries; the format has room for 255", pdo->index, pdo->entries.count);
    if (carried && (pdo->sync_manager < 0 || pdo->sync_manager >= PDO_NOT_CARRIED))
        fail(w, "PDO 0x%04X is carried by sync manager %d, which cannot be", pdo->index, pdo->sync_manager);
    put_u16(w, pdo->index);
    put_u8(w, (unsigned)pdo->entries.count);
    put_u8(w, carried ? (unsigned)pdo->sync_manager : PDO_NOT_CARRIED);
    put_u8(w, 0); /* synchronisation */
    put_u8(w, string_number(w, pdo->name));
    put_u16(w, (pdo->mandatory ? PDO_MANDATORY : 0u) | (carried ? PDO_DEFAULT : 0u) | (pdo->fixed ? PDO_FIXED : 0u) |
                   (pdo->is_virtual ? PDO_VIRTUAL : 0u) | (pdo->depends_on_slot ? PDO_DEPENDS_ON_SLOT : 0u));
    for (size_t i = 0; i < pdo->entries.count; i++) {
        const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[i];
        const uint16_t type = cm1e_type_code(entry->type);
        if (entry->bits > UINT8_MAX)
            fail(w, "PDO 0x%04X maps 0x%04X:%u with %u bits; the format has room for 255", pdo->index, entry->index,
                 entry->subindex, (unsigned)entry->bits);
        put_u16(w, entry->index);
        put_u8(w, entry->subindex);
        put_u8(w, string_number(w, entry->name));
        put_u8(w, type <= UINT8_MAX ? type : 0);
        put_u8(w, entry->bits);
        put_u16(w, 0);
    }
}

/* All PDOs of a direction in one category: masters look at the first of a kind only. */
static void write_pdos(writer_t *w, bool transmit)
{
    const size_t start = category_begin(w, transmit ? SII_CATEGORY_TXPDO : SII_CATEGORY_RXPDO);
    for (size_t i = 0; i < w->device->pdos.count; i++)
        if (w->device->pdos.at[i].transmit == transmit)
            write_pdo(w, &w->device->pdos.at[i]);
    if (w->at > start)
        category_end(w, start);
    else /* SOEM takes the first PDO of a category for granted */
        w->at = start - SII_CATEGORY_HEADER_BYTES;
}

static unsigned factor(writer_t *w, const cm1e_dc_mode_t *mode, int32_t value)
{
    if (value < INT16_MIN || value > INT16_MAX)
        fail(w, "the cycle factor %d of the DC mode %s has more than 16 bits", value, mode->name);
    return (unsigned)value & 0xFFFF;
}

static void write_dc_modes(writer_t *w)
{
    const size_t start = category_begin(w, SII_CATEGORY_DC);
    for (size_t i = 0; i < w->device->dc_modes.count; i++) {
        const cm1e_dc_mode_t *mode = &w->device->dc_modes.at[i];
        put_u32(w, (uint32_t)mode->sync0_cycle_ns);
        put_u32(w, (uint32_t)mode->sync0_shift_ns);
        put_u32(w, (uint32_t)mode->sync1_shift_ns);
        put_u16(w, factor(w, mode, mode->sync1_factor));
        put_u16(w, mode->assign_activate);
        put_u16(w, factor(w, mode, mode->sync0_factor));
        put_u8(w, string_number(w, mode->name));
        put_u8(w, string_number(w, mode->text));
        put_u32(w, 0);
    }
    category_end(w, start);
}

size_t cm1e_sii_write(uint8_t *image, size_t room, const cm1e_description_t *device, cm1e_diag_t *diag)
{
    writer_t w = {.image = image, .at = CM1E_SII_HEADER_BYTES, .device = device, .diag = diag};
    w.size = device->eeprom.byte_size ? device->eeprom.byte_size : CM1E_SII_SIZE;
    if (w.size % CM1E_SII_BYTES_PER_KBIT != 0 || w.size > CM1E_SII_SIZE_MAX)
        fail(&w, "its EEPROM has %zu bytes; expected a multiple of 128 (1 kbit), at most 8 MiB", w.size);
    else if (w.size > room)
        fail(&w, "its EEPROM has %zu bytes; there is room for %zu", w.size, room);
    if (w.failed)
        return 0;
    write_header(&w);
    collect_strings(&w);
    write_strings(&w);
    write_general(&w);
    if (device->fmmus.count > 0)
        write_fmmus(&w);
    if (device->sync_managers.count > 0)
        write_sync_managers(&w);
    write_pdos(&w, true);
    write_pdos(&w, false);
    if (has_dc_category(device))
        write_dc_modes(&w);
    put_u16(&w, CM1E_SII_CATEGORY_END);
    if (w.at > w.size)
        fail(&w, "it needs %zu bytes; its EEPROM has %zu", w.at, w.size);
    return w.failed ? 0 : w.size;
}
