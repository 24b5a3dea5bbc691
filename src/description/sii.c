#include "description/sii.h"

#include <string.h>

#include "core/bytes.h"

/* Word addresses and categories: ETG.1000.6 tables 16 and 17, ETG.2010. */
enum {
    WORD_PDI_CONTROL = 0x00, WORD_ALIAS = 0x04, WORD_CHECKSUM = 0x07, WORD_VENDOR = 0x08, WORD_PRODUCT = 0x0A,
    WORD_REVISION = 0x0C, WORD_SERIAL = 0x0E, WORD_BOOT_MAILBOX = 0x14, WORD_MAILBOX = 0x18,
    WORD_MAILBOX_PROTOCOLS = 0x1C, WORD_SIZE = 0x3E, WORD_VERSION = 0x3F, WORD_CATEGORIES = 0x40,
};
enum {
    CATEGORY_STRINGS = 10, CATEGORY_GENERAL = 30, CATEGORY_FMMU = 40, CATEGORY_SYNC_MANAGERS = 41, CATEGORY_TXPDO = 50,
    CATEGORY_RXPDO = 51, CATEGORY_DC = 60, CATEGORY_END = 0xFFFF,
};
enum { PROTOCOL_COE = 0x04, PROTOCOL_FOE = 0x08 };
enum { COE_SDO = 0x01, COE_SDO_INFO = 0x02, COE_PDO_ASSIGN = 0x04, COE_COMPLETE_ACCESS = 0x20 };
enum { PDO_FIXED = 0x0010, SYNC_MANAGER_NONE = 0xFF, SYNC_MANAGER_OUTPUTS = 2, SYNC_MANAGER_INPUTS = 3 };
/* PDI control 0x05: SPI slave, as microcontrollers are connected. The value of the real device is not known. */
enum { PDI_CONTROL_SPI = 0x0005, PDI_CONTROL_DIGITAL_IO = 0x0004 };
enum { PORTS_TWO_MII = 0x0011, MAPPINGS = 4, STRINGS_MAX = 64 };

/* The image as it grows; strings are collected first, because their category comes first and others refer to it. */
typedef struct writer {
    uint8_t *image;
    size_t at;
    const char *strings[STRINGS_MAX];
    size_t string_count;
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

static void put_u8(writer_t *w, unsigned value)
{
    if (w->at < CM1E_SII_SIZE)
        w->image[w->at++] = (uint8_t)value;
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
static void put_word_at(writer_t *w, unsigned word, uint16_t value) { cm1e_put_u16(w->image + 2 * word, value); }
static void put_dword_at(writer_t *w, unsigned word, uint32_t value) { cm1e_put_u32(w->image + 2 * word, value); }

/* Number of a string (1 = first), adding it where it is new; 0: no string. */
static unsigned string_number(writer_t *w, const char *text)
{
    if (!text || !*text)
        return 0;
    for (size_t i = 0; i < w->string_count; i++)
        if (strcmp(w->strings[i], text) == 0)
            return (unsigned)i + 1;
    if (w->string_count == STRINGS_MAX)
        return 0;
    w->strings[w->string_count++] = text;
    return (unsigned)w->string_count;
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
    cm1e_put_u16(w->image + start - 2, (uint16_t)((w->at - start) / 2));
}

static void write_strings(writer_t *w)
{
    const size_t start = category_begin(w, CATEGORY_STRINGS);
    put_u8(w, (unsigned)w->string_count);
    for (size_t i = 0; i < w->string_count; i++) {
        const size_t length = strlen(w->strings[i]);
        put_u8(w, (unsigned)length);
        for (size_t c = 0; c < length; c++)
            put_u8(w, (uint8_t)w->strings[i][c]);
    }
    category_end(w, start);
}

static void write_general(writer_t *w, const char *name, const char *group, unsigned coe_details, bool foe,
                          unsigned drives)
{
    const size_t start = category_begin(w, CATEGORY_GENERAL);
    put_u8(w, string_number(w, group));
    put_u8(w, 0); /* picture */
    put_u8(w, string_number(w, name)); /* order number */
    put_u8(w, string_number(w, name));
    put_u8(w, 0);
    put_u8(w, coe_details);
    put_u8(w, foe ? 1 : 0);
    put_u8(w, 0); /* EoE */
    put_u8(w, 0); /* SoE */
    put_u8(w, drives);
    put_u8(w, 0);
    put_u8(w, 0); /* flags: LRW allowed, Safe-Operational supported */
    put_u16(w, 0); /* no E-bus */
    put_u16(w, string_number(w, group));
    put_u16(w, PORTS_TWO_MII);
    while (w->at < start + 32)
        put_u8(w, 0);
    category_end(w, start);
}

static void write_fmmus(writer_t *w, bool mailbox)
{
    const size_t start = category_begin(w, CATEGORY_FMMU);
    put_u8(w, 1); /* outputs */
    put_u8(w, 2); /* inputs */
    if (mailbox)
        put_u8(w, 3); /* state of the mailbox */
    category_end(w, start);
}

static void write_sync_managers(writer_t *w, const cm1e_sync_manager_t *managers, unsigned count)
{
    const size_t start = category_begin(w, CATEGORY_SYNC_MANAGERS);
    for (unsigned i = 0; i < count; i++) {
        put_u16(w, managers[i].start);
        put_u16(w, managers[i].length);
        put_u8(w, managers[i].control);
        put_u8(w, 0);
        put_u8(w, managers[i].enable);
        put_u8(w, managers[i].type);
    }
    category_end(w, start);
}

static const cm1e_entry_t *dictionary_entry(const cm1e_pdo_entry_t *mapped)
{
    return mapped->index ? cm1e_device_entry(mapped->index, mapped->subindex) : NULL;
}

/* The type on the wire: that of the dictionary, unless the mapping has another length (0x6079: UG 7.2). */
static unsigned entry_type(const cm1e_pdo_entry_t *mapped)
{
    const cm1e_entry_t *entry = dictionary_entry(mapped);
    if (entry && entry->bits == mapped->bits)
        return entry->type;
    if (mapped->index == 0)
        return 0; /* a gap */
    if (entry)
        return mapped->bits == 8 ? CM1E_TYPE_SINT : mapped->bits == 16 ? CM1E_TYPE_INT : CM1E_TYPE_DINT;
    return mapped->bits == 8 ? CM1E_TYPE_USINT : mapped->bits == 16 ? CM1E_TYPE_UINT : CM1E_TYPE_UDINT;
}

static const char *entry_name(const cm1e_pdo_entry_t *mapped)
{
    const cm1e_entry_t *entry = dictionary_entry(mapped);
    return entry ? entry->name : NULL;
}

static void write_pdo(writer_t *w, const cm1e_pdo_t *pdo, unsigned sync_manager)
{
    put_u16(w, pdo->index);
    put_u8(w, pdo->entry_count);
    put_u8(w, sync_manager);
    put_u8(w, 0); /* synchronisation */
    put_u8(w, string_number(w, pdo->name));
    put_u16(w, PDO_FIXED);
    for (unsigned i = 0; i < pdo->entry_count; i++) {
        put_u16(w, pdo->entries[i].index);
        put_u8(w, pdo->entries[i].subindex);
        put_u8(w, string_number(w, entry_name(&pdo->entries[i])));
        put_u8(w, entry_type(&pdo->entries[i]));
        put_u8(w, pdo->entries[i].bits);
        put_u16(w, 0);
    }
}

/* All PDOs of a direction in one category: masters look at the first of a kind only. */
static void write_pdos(writer_t *w, bool transmit, const cm1e_sii_options_t *options)
{
    const unsigned default_manager = transmit ? SYNC_MANAGER_INPUTS : SYNC_MANAGER_OUTPUTS;
    const size_t start = category_begin(w, transmit ? CATEGORY_TXPDO : CATEGORY_RXPDO);
    for (int mapping = 0; mapping < MAPPINGS; mapping++) {
        cm1e_pdo_t pdo;
        cm1e_device_pdo(&pdo, (cm1e_mapping_t)mapping, transmit, options->order, options->firmware);
        write_pdo(w, &pdo, mapping == (int)options->mapping ? default_manager : SYNC_MANAGER_NONE);
    }
    category_end(w, start);
}

static uint16_t mapping_bytes(bool transmit, const cm1e_sii_options_t *options)
{
    cm1e_pdo_t pdo;
    unsigned bits = 0;
    cm1e_device_pdo(&pdo, options->mapping, transmit, options->order, options->firmware);
    for (unsigned i = 0; i < pdo.entry_count; i++)
        bits += pdo.entries[i].bits;
    return (uint16_t)((bits + 7) / 8);
}

static void collect_pdo_strings(writer_t *w, const cm1e_sii_options_t *options)
{
    for (int transmit = 1; transmit >= 0; transmit--)
        for (int mapping = 0; mapping < MAPPINGS; mapping++) {
            cm1e_pdo_t pdo;
            cm1e_device_pdo(&pdo, (cm1e_mapping_t)mapping, transmit, options->order, options->firmware);
            string_number(w, pdo.name);
            for (unsigned i = 0; i < pdo.entry_count; i++)
                string_number(w, entry_name(&pdo.entries[i]));
        }
}

static const char *const dc_mode_names[] = {"SM Synchron", "DC Synchron"};
static const uint16_t dc_mode_activation[] = {0x0000, 0x0300};

static void write_dc_modes(writer_t *w)
{
    const size_t start = category_begin(w, CATEGORY_DC);
    for (unsigned i = 0; i < 2; i++) {
        put_u32(w, 0); /* SYNC0 cycle time: that of the master */
        put_u32(w, 0);
        put_u32(w, 0);
        put_u16(w, 0);
        put_u16(w, dc_mode_activation[i]);
        put_u16(w, 0);
        put_u8(w, string_number(w, dc_mode_names[i]));
        put_u8(w, string_number(w, dc_mode_names[i]));
        put_u32(w, 0);
    }
    category_end(w, start);
}

static void begin(writer_t *w, uint8_t *image, uint16_t pdi_control, uint16_t alias)
{
    *w = (writer_t){.image = image, .at = 2 * WORD_CATEGORIES};
    memset(image, 0xFF, CM1E_SII_SIZE);
    memset(image, 0, 2 * WORD_CATEGORIES);
    put_word_at(w, WORD_PDI_CONTROL, pdi_control);
    put_word_at(w, WORD_ALIAS, alias);
    put_word_at(w, WORD_CHECKSUM, cm1e_sii_crc8(image, 2 * WORD_CHECKSUM));
    put_word_at(w, WORD_SIZE, CM1E_SII_SIZE * 8 / 1024 - 1);
    put_word_at(w, WORD_VERSION, 1);
}

/* Receive offset and size, send offset and size. */
static void put_mailbox_at(writer_t *w, unsigned word, const cm1e_sync_manager_t *managers)
{
    put_word_at(w, word, managers[0].start);
    put_word_at(w, word + 1, managers[0].length);
    put_word_at(w, word + 2, managers[1].start);
    put_word_at(w, word + 3, managers[1].length);
}

size_t cm1e_generate_sii(uint8_t *image, size_t room, const cm1e_sii_options_t *options)
{
    static const char name[] = "CM1-E", group[] = "Servo motors";
    if (room < CM1E_SII_SIZE)
        return 0;
    writer_t w;
    begin(&w, image, PDI_CONTROL_SPI, options->alias);
    put_dword_at(&w, WORD_VENDOR, CM1E_VENDOR_ID);
    put_dword_at(&w, WORD_PRODUCT, CM1E_PRODUCT_CODE);
    put_dword_at(&w, WORD_REVISION, cm1e_firmware_info(options->firmware)->revision);
    put_dword_at(&w, WORD_SERIAL, options->serial_number);
    put_mailbox_at(&w, WORD_BOOT_MAILBOX, cm1e_device_sync_managers);
    put_mailbox_at(&w, WORD_MAILBOX, cm1e_device_sync_managers);
    /* Update by FoE exists since V1.2.0 (UG 10.1), the oldest firmware of the tables. */
    put_word_at(&w, WORD_MAILBOX_PROTOCOLS, PROTOCOL_COE | PROTOCOL_FOE);

    cm1e_sync_manager_t managers[4];
    memcpy(managers, cm1e_device_sync_managers, sizeof managers);
    managers[SYNC_MANAGER_OUTPUTS].length = mapping_bytes(false, options);
    managers[SYNC_MANAGER_INPUTS].length = mapping_bytes(true, options);

    /* Masters show string 1 as the name. */
    string_number(&w, name);
    string_number(&w, group);
    collect_pdo_strings(&w, options);
    for (unsigned i = 0; options->distributed_clocks && i < 2; i++)
        string_number(&w, dc_mode_names[i]);
    write_strings(&w);
    const unsigned complete_access = options->complete_access ? COE_COMPLETE_ACCESS : 0;
    write_general(&w, name, group, COE_SDO | COE_SDO_INFO | COE_PDO_ASSIGN | complete_access, true, 1);
    write_fmmus(&w, true);
    write_sync_managers(&w, managers, 4);
    write_pdos(&w, true, options);
    write_pdos(&w, false, options);
    if (options->distributed_clocks)
        write_dc_modes(&w);
    put_u16(&w, CATEGORY_END);
    return CM1E_SII_SIZE;
}

size_t cm1e_generate_sii_io_module(uint8_t *image, size_t room)
{
    static const char name[] = "Digital I/O 8+8", group[] = "Digital I/O";
    /* As such modules have them: buffered, outputs with watchdog. */
    static const cm1e_sync_manager_t managers[2] = {
        {.start = 0x1000, .length = 1, .control = 0x44, .enable = 1, .type = 3},
        {.start = 0x1100, .length = 1, .control = 0x00, .enable = 1, .type = 4},
    };
    static const cm1e_pdo_t outputs = {0x1600, "Outputs", 1, {{0x7000, 1, 8}}};
    static const cm1e_pdo_t inputs = {0x1A00, "Inputs", 1, {{0x6000, 1, 8}}};
    if (room < CM1E_SII_SIZE)
        return 0;
    writer_t w;
    begin(&w, image, PDI_CONTROL_DIGITAL_IO, 0);
    put_dword_at(&w, WORD_PRODUCT, 0x00000808);
    put_dword_at(&w, WORD_REVISION, 1);
    string_number(&w, name);
    string_number(&w, group);
    string_number(&w, inputs.name);
    string_number(&w, outputs.name);
    write_strings(&w);
    write_general(&w, name, group, 0, false, 0);
    write_fmmus(&w, false);
    write_sync_managers(&w, managers, 2);
    size_t start = category_begin(&w, CATEGORY_TXPDO);
    write_pdo(&w, &inputs, 1);
    category_end(&w, start);
    start = category_begin(&w, CATEGORY_RXPDO);
    write_pdo(&w, &outputs, 0);
    category_end(&w, start);
    put_u16(&w, CATEGORY_END);
    return CM1E_SII_SIZE;
}

size_t cm1e_sii_write(uint8_t *image, size_t room, const cm1e_description_t *device, cm1e_diag_t *diag)
{
    (void)image, (void)room, (void)device;
    cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "not there yet");
    return 0;
}

cm1e_error_t cm1e_sii_read(cm1e_description_file_t *file, const uint8_t *image, size_t size, cm1e_findings_t *findings,
                           cm1e_diag_t *diag)
{
    (void)file, (void)image, (void)size, (void)findings;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "not there yet");
}
