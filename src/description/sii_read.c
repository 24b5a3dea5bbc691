#include "description/sii_image.h"

#include <string.h>

#include "core/bytes.h"
#include "description/describe.h"
#include "description/sii_format.h"

typedef struct reader {
    cm1e_arena_t *arena;
    cm1e_description_t *device;
    cm1e_findings_t *findings;
    const uint8_t *image;
    size_t size;
    const char *strings[SII_STRINGS_MAX + 1]; /* by number, 1 = first */
    unsigned string_count;
    bool cut;                 /* the present category is longer than the image, which is reported already */
    bool has_general;
    bool has_details;         /* details up to those of the mailbox protocols: */
    uint8_t coe, foe, eoe;
} reader_t;

/* The contents of a category, limited to the image. */
typedef struct part {
    const uint8_t *bytes;
    size_t size;
    size_t place;
} part_t;

#define FOUND(r, rule, place, ...)                                                                                  \
    do {                                                                                                            \
        if ((r)->findings)                                                                                          \
            cm1e_findings_add((r)->findings, CM1E_RULE_##rule, (cm1e_place_t)(place), __VA_ARGS__);                 \
    } while (0)

/* 0 behind the end. */
static uint8_t byte_of(const part_t *part, size_t at) { return at < part->size ? part->bytes[at] : 0; }
static uint16_t word_of(const part_t *part, size_t at)
{
    return (uint16_t)(byte_of(part, at) | byte_of(part, at + 1) << 8);
}
static uint32_t double_word_of(const part_t *part, size_t at)
{
    return word_of(part, at) | (uint32_t)word_of(part, at + 2) << 16;
}

static void incomplete(reader_t *r, const part_t *part, const char *category, const char *what)
{
    if (!r->cut)
        FOUND(r, SII_INCOMPLETE, part->place, "the category %s has %zu bytes: %s", category, part->size, what);
}

/* ---- strings ---------------------------------------------------------------------------------------------------- */

/* ISO 8859-1 to UTF-8, up to a zero, with which some tools fill strings up. */
static const char *take_text(reader_t *r, const part_t *part, size_t at, unsigned length)
{
    char text[2 * SII_STRING_BYTES_MAX + 1];
    size_t n = 0;
    bool clean = true;
    for (unsigned i = 0; i < length && byte_of(part, at + i) != 0; i++) {
        const uint8_t c = byte_of(part, at + i);
        const bool printable = (c >= 0x20 && c <= 0x7E) || c >= 0xA0;
        clean = clean && printable;
        if (c >= 0xA0)
            text[n++] = (char)(0xC0 | c >> 6);
        text[n++] = !printable ? '?' : c >= 0xA0 ? (char)(0x80 | (c & 0x3F)) : (char)c;
    }
    text[n] = '\0';
    if (!clean)
        FOUND(r, SII_STRING_TEXT, part->place + at,
              "string %u has control characters, here shown as \"?\": \"%s\"", r->string_count + 1, text);
    return cm1e_arena_text(r->arena, text);
}

static void read_strings(reader_t *r, const part_t *part)
{
    const unsigned count = byte_of(part, 0);
    size_t at = 1;
    for (unsigned n = 1; n <= count && at < part->size; n++) {
        const unsigned length = byte_of(part, at);
        const size_t there = part->size - at - 1;
        r->strings[n] = take_text(r, part, at + 1, length < there ? length : (unsigned)there);
        r->string_count = n;
        at += 1 + length;
    }
    if (r->string_count < count || at > part->size)
        incomplete(r, part, "Strings", "it ends before its last string does");
}

/* NULL: number 0, or there is no such string. */
static const char *string(reader_t *r, unsigned number, size_t place)
{
    if (number <= r->string_count)
        return r->strings[number];
    FOUND(r, SII_STRING_MISSING, place, "this refers to string %u; there are %u strings", number, r->string_count);
    return NULL;
}

static const char *string_or_empty(reader_t *r, unsigned number, size_t place)
{
    const char *text = string(r, number, place);
    return text ? text : "";
}

/* ---- the fixed part --------------------------------------------------------------------------------------------- */

static void read_mailbox(reader_t *r, const part_t *header)
{
    cm1e_described_eeprom_t *eeprom = &r->device->eeprom;
    const unsigned protocols = word_of(header, CM1E_SII_PROTOCOLS) & SII_PROTOCOLS_ALL;
    eeprom->mailbox_out_start = word_of(header, CM1E_SII_MAILBOX);
    eeprom->mailbox_out_length = word_of(header, CM1E_SII_MAILBOX + 2);
    eeprom->mailbox_in_start = word_of(header, CM1E_SII_MAILBOX + 4);
    eeprom->mailbox_in_length = word_of(header, CM1E_SII_MAILBOX + 6);
    r->device->mailbox = (cm1e_mailbox_protocols_t){
        .place = CM1E_SII_PROTOCOLS,
        .present = protocols != 0 || eeprom->mailbox_out_length != 0 || eeprom->mailbox_in_length != 0,
        .aoe = protocols & SII_PROTOCOL_AOE, .eoe = protocols & SII_PROTOCOL_EOE, .coe = protocols & SII_PROTOCOL_COE,
        .foe = protocols & SII_PROTOCOL_FOE, .soe = protocols & SII_PROTOCOL_SOE, .voe = protocols & SII_PROTOCOL_VOE,
    };
}

static cm1e_bytes_t copy(reader_t *r, size_t at, size_t size)
{
    return (cm1e_bytes_t){cm1e_arena_bytes(r->arena, r->image + at, size), size};
}

static void read_header(reader_t *r)
{
    const part_t header = {r->image, CM1E_SII_HEADER_BYTES, 0};
    cm1e_description_t *device = r->device;
    cm1e_described_eeprom_t *eeprom = &device->eeprom;
    device->place = device->identity_place = CM1E_SII_VENDOR;
    device->vendor_id = double_word_of(&header, CM1E_SII_VENDOR);
    device->product_code = double_word_of(&header, CM1E_SII_PRODUCT);
    device->revision = double_word_of(&header, CM1E_SII_REVISION);
    device->product_given = device->revision_given = true;
    eeprom->place = CM1E_SII_CHECKSUM;
    eeprom->byte_size = (word_of(&header, CM1E_SII_KBIT) + 1u) * CM1E_SII_BYTES_PER_KBIT;
    eeprom->config_data = copy(r, CM1E_SII_CONFIG, CM1E_SII_CONFIG_BYTES);
    eeprom->config_known = cm1e_describe_config_is_known(r->image);
    eeprom->bootstrap = copy(r, CM1E_SII_BOOTSTRAP, CM1E_SII_BOOTSTRAP_BYTES);
    eeprom->alias = word_of(&header, CM1E_SII_ALIAS);
    eeprom->serial_number = double_word_of(&header, CM1E_SII_SERIAL);
    eeprom->version = word_of(&header, CM1E_SII_VERSION);
    read_mailbox(r, &header);
    const uint8_t checksum = cm1e_sii_crc8(r->image, CM1E_SII_CONFIG_BYTES);
    if (checksum != r->image[CM1E_SII_CHECKSUM])
        FOUND(r, SII_CHECKSUM, CM1E_SII_CHECKSUM,
              "the checksum of the configuration words is 0x%02X; it should be 0x%02X. A slave controller refuses such "
              "an EEPROM", r->image[CM1E_SII_CHECKSUM], checksum);
}

/* ---- categories ------------------------------------------------------------------------------------------------- */

static const char *take_physics(reader_t *r, uint16_t ports)
{
    static const char letters[] = SII_PORT_LETTERS;
    char text[SII_PORTS + 1] = "";
    size_t length = 0;
    for (unsigned port = 0; port < SII_PORTS; port++) {
        const unsigned kind = ports >> 4 * port & 0x0F;
        text[port] = kind < sizeof letters - 1 ? letters[kind] : ' ';
        length = text[port] != ' ' ? port + 1 : length;
    }
    text[length] = '\0';
    return length > 0 ? cm1e_arena_text(r->arena, text) : NULL;
}

static void read_general(reader_t *r, const part_t *part)
{
    cm1e_description_t *device = r->device;
    const uint8_t coe = byte_of(part, GENERAL_COE), flags = byte_of(part, GENERAL_FLAGS);
    if (part->size < GENERAL_BYTES)
        incomplete(r, part, "General", "it should have 32");
    r->has_general = true;
    r->has_details = part->size > GENERAL_EOE;
    r->coe = coe & COE_SDO;
    r->foe = byte_of(part, GENERAL_FOE);
    r->eoe = byte_of(part, GENERAL_EOE);
    device->group = string_or_empty(r, byte_of(part, GENERAL_GROUP), part->place + GENERAL_GROUP);
    device->type = string_or_empty(r, byte_of(part, GENERAL_ORDER), part->place + GENERAL_ORDER);
    device->name = string_or_empty(r, byte_of(part, GENERAL_NAME), part->place + GENERAL_NAME);
    device->mailbox.sdo_info = coe & COE_SDO_INFO;
    device->mailbox.pdo_assign = coe & COE_PDO_ASSIGN;
    device->mailbox.pdo_config = coe & COE_PDO_CONFIG;
    device->mailbox.pdo_upload = coe & COE_PDO_UPLOAD;
    device->mailbox.complete_access = coe & COE_COMPLETE_ACCESS;
    device->mailbox.data_link_layer = flags & FLAG_DATA_LINK_LAYER;
    device->no_lrw = flags & FLAG_NO_LRW;
    device->identification_reg134 = flags & FLAG_ID_IN_AL_STATUS;
    device->identification_reg134_given = true;
    device->physics = take_physics(r, word_of(part, GENERAL_PORTS));
    for (unsigned n = byte_of(part, GENERAL_DRIVES); n > 0; n--) {
        cm1e_channel_t *channel = CM1E_APPEND(r->arena, &device->channels);
        channel->place = (cm1e_place_t)part->place + GENERAL_DRIVES;
        channel->profile_no = 402;
        channel->add_info = -1;
    }
}

/* 0xFF is unused too. */
static cm1e_fmmu_use_t fmmu_use(uint8_t byte)
{
    return byte <= CM1E_FMMU_MAILBOX_STATE ? (cm1e_fmmu_use_t)byte : CM1E_FMMU_UNUSED;
}

/* Unused ones at the end are what fills the last word up. */
static void read_fmmus(reader_t *r, const part_t *part)
{
    size_t count = part->size;
    while (count > 0 && fmmu_use(part->bytes[count - 1]) == CM1E_FMMU_UNUSED)
        count--;
    for (size_t i = 0; i < count; i++) {
        cm1e_described_fmmu_t *fmmu = CM1E_APPEND(r->arena, &r->device->fmmus);
        fmmu->place = (cm1e_place_t)(part->place + i);
        fmmu->use = fmmu_use(part->bytes[i]);
    }
}

static void read_sync_managers(reader_t *r, const part_t *part)
{
    for (size_t at = 0; at + SYNC_MANAGER_BYTES <= part->size; at += SYNC_MANAGER_BYTES) {
        cm1e_described_sync_manager_t *manager = CM1E_APPEND(r->arena, &r->device->sync_managers);
        const uint8_t use = byte_of(part, at + 7);
        manager->place = (cm1e_place_t)(part->place + at);
        manager->start = word_of(part, at);
        manager->length = word_of(part, at + 2);
        manager->length_given = true;
        manager->control = byte_of(part, at + 4);
        manager->enable = byte_of(part, at + 6);
        manager->use = use <= CM1E_SM_INPUTS ? (cm1e_sync_manager_use_t)use : CM1E_SM_UNUSED;
    }
    if (part->size % SYNC_MANAGER_BYTES != 0)
        incomplete(r, part, "SyncM", "a sync manager has 8");
}

static const char *take_type(reader_t *r, uint8_t code, uint32_t bits, size_t place)
{
    const char *type = code ? cm1e_type_name(r->arena, code, bits) : "";
    if (!type)
        FOUND(r, SII_DATA_TYPE, place, "0x%02X is no data type of ETG.1020", code);
    return type ? type : "";
}

static void read_pdo_entry(reader_t *r, cm1e_described_pdo_t *pdo, const part_t *part, size_t at)
{
    cm1e_described_pdo_entry_t *entry = CM1E_APPEND(r->arena, &pdo->entries);
    entry->place = (cm1e_place_t)(part->place + at);
    entry->index = word_of(part, at);
    entry->subindex = byte_of(part, at + 2);
    entry->name = string(r, byte_of(part, at + 3), entry->place);
    entry->bits = byte_of(part, at + 5);
    entry->type = take_type(r, byte_of(part, at + 4), entry->bits, entry->place);
}

static void read_pdos(reader_t *r, const part_t *part, bool transmit)
{
    const char *const category = transmit ? "TxPDO" : "RxPDO";
    size_t at = 0;
    while (at + PDO_BYTES <= part->size) {
        cm1e_described_pdo_t *pdo = CM1E_APPEND(r->arena, &r->device->pdos);
        const unsigned entries = byte_of(part, at + 2), manager = byte_of(part, at + 3), flags = word_of(part, at + 6);
        pdo->place = (cm1e_place_t)(part->place + at);
        pdo->transmit = transmit;
        pdo->index = word_of(part, at);
        pdo->name = string_or_empty(r, byte_of(part, at + 5), pdo->place);
        pdo->sync_manager = manager == PDO_NOT_CARRIED ? CM1E_NO_SYNC_MANAGER : (int)manager;
        pdo->mandatory = flags & PDO_MANDATORY;
        pdo->fixed = flags & PDO_FIXED;
        pdo->is_virtual = flags & PDO_VIRTUAL;
        pdo->depends_on_slot = flags & PDO_DEPENDS_ON_SLOT;
        at += PDO_BYTES;
        for (unsigned i = 0; i < entries; i++, at += PDO_ENTRY_BYTES) {
            if (at + PDO_ENTRY_BYTES > part->size) {
                incomplete(r, part, category, "it ends within a PDO, before its last entry");
                return;
            }
            read_pdo_entry(r, pdo, part, at);
        }
    }
    if (at != part->size)
        incomplete(r, part, category, "a PDO and an entry have 8 each");
}

static void read_dc_modes(reader_t *r, const part_t *part)
{
    for (size_t at = 0; at + DC_BYTES <= part->size; at += DC_BYTES) {
        cm1e_dc_mode_t *mode = CM1E_APPEND(r->arena, &r->device->dc_modes);
        mode->place = (cm1e_place_t)(part->place + at);
        mode->sync0_cycle_ns = (int32_t)double_word_of(part, at);
        mode->sync0_shift_ns = (int32_t)double_word_of(part, at + 4);
        mode->sync1_shift_ns = (int32_t)double_word_of(part, at + 8);
        mode->sync1_factor = (int16_t)word_of(part, at + 12);
        mode->assign_activate = word_of(part, at + 14);
        mode->sync0_factor = (int16_t)word_of(part, at + 16);
        mode->name = string_or_empty(r, byte_of(part, at + DC_NAME), mode->place);
        mode->text = string(r, byte_of(part, at + 19), mode->place);
        mode->sync0_given = mode->assign_activate & ACTIVATES_SYNC0 || mode->sync0_cycle_ns || mode->sync0_factor ||
                            mode->sync0_shift_ns;
        mode->sync1_given = mode->assign_activate & ACTIVATES_SYNC1 || mode->sync1_factor || mode->sync1_shift_ns;
    }
    if (part->size % DC_BYTES != 0)
        incomplete(r, part, "DC", "a mode has 24");
}

static void read_txpdos(reader_t *r, const part_t *part) { read_pdos(r, part, true); }
static void read_rxpdos(reader_t *r, const part_t *part) { read_pdos(r, part, false); }

/* Strings are read first, wherever they are, because the other categories refer to them. */
static const struct {
    uint16_t type;
    const char *name;
    void (*read)(reader_t *r, const part_t *part);
    bool adds_up; /* what further ones hold is read too */
} kinds[] = {
    {SII_CATEGORY_STRINGS, "Strings", read_strings, false},
    {SII_CATEGORY_GENERAL, "General", read_general, false},
    {SII_CATEGORY_FMMU, "FMMU", read_fmmus, false},
    {SII_CATEGORY_SYNC_MANAGERS, "SyncM", read_sync_managers, false},
    {SII_CATEGORY_TXPDO, "TxPDO", read_txpdos, true},
    {SII_CATEGORY_RXPDO, "RxPDO", read_rxpdos, true},
    {SII_CATEGORY_DC, "DC", read_dc_modes, true},
};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

bool cm1e_sii_category_is_read(uint16_t type)
{
    for (int kind = 0; kind < KINDS; kind++)
        if (kinds[kind].type == type)
            return true;
    return false;
}

bool cm1e_sii_category_at(cm1e_sii_category_t *category, const uint8_t *image, size_t size, size_t at)
{
    *category = (cm1e_sii_category_t){.type = CM1E_SII_CATEGORY_END, .start = at + 2};
    if (at + 2 > size)
        return false;
    category->type = cm1e_get_u16(image + at);
    if (category->type == CM1E_SII_CATEGORY_END)
        return true;
    if (at + SII_CATEGORY_HEADER_BYTES > size)
        return false;
    category->start = at + SII_CATEGORY_HEADER_BYTES;
    category->bytes = 2u * cm1e_get_u16(image + at + 2);
    return true;
}

/* Every category of a kind, or the first one. */
static void read_kind(reader_t *r, int kind)
{
    cm1e_sii_category_t category;
    bool first = true;
    for (size_t at = CM1E_SII_HEADER_BYTES; cm1e_sii_category_at(&category, r->image, r->size, at) &&
                                            category.type != CM1E_SII_CATEGORY_END;
         at = category.start + category.bytes) {
        if (category.type != kinds[kind].type)
            continue;
        const size_t rest = r->size - category.start;
        const part_t part = {r->image + category.start, category.bytes < rest ? category.bytes : rest, category.start};
        r->cut = category.bytes > rest;
        if (!first)
            FOUND(r, SII_CATEGORY_TWICE, at, "another category %s: many masters read the first one only",
                  kinds[kind].name);
        if (first || kinds[kind].adds_up)
            kinds[kind].read(r, &part);
        first = false;
    }
}

/* Whether the categories lead to their end, and that within the EEPROM. */
static void check_chain(reader_t *r)
{
    cm1e_sii_category_t category;
    size_t at = CM1E_SII_HEADER_BYTES;
    bool there;
    while ((there = cm1e_sii_category_at(&category, r->image, r->size, at)) && category.type != CM1E_SII_CATEGORY_END) {
        if (category.bytes > r->size - category.start) {
            FOUND(r, SII_CATEGORY_LENGTH, at, "the category of type %u states %zu bytes; %zu are left in the image",
                  category.type, category.bytes, r->size - category.start);
            return;
        }
        at = category.start + category.bytes;
    }
    if (!there)
        FOUND(r, SII_NO_END, at, "the categories lead to the end of the image; 0xFFFF should follow the last one");
    else if (category.start > r->device->eeprom.byte_size)
        FOUND(r, SII_SIZE, CM1E_SII_KBIT, "the categories end at byte %zu, and the EEPROM has %u bytes by word 0x3E",
              category.start, (unsigned)r->device->eeprom.byte_size);
}

/* ---- what stands there twice ------------------------------------------------------------------------------------ */

static void check_mailbox(reader_t *r, cm1e_sync_manager_use_t use, uint16_t start, uint16_t length, const char *name)
{
    const cm1e_description_t *device = r->device;
    for (size_t i = 0; i < device->sync_managers.count; i++) {
        const cm1e_described_sync_manager_t *manager = &device->sync_managers.at[i];
        if (manager->use == use && (manager->start != start || manager->length != length))
            FOUND(r, SII_MAILBOX, manager->place,
                  "sync manager %zu puts the mailbox %s at 0x%04X with %u bytes, words 0x18 to 0x1B at 0x%04X with %u; "
                  "masters go by either", i, name, manager->start, manager->length, start, length);
    }
}

static void check_protocol(reader_t *r, bool in_header, bool in_general, const char *name)
{
    if (in_header != in_general)
        FOUND(r, SII_PROTOCOLS, CM1E_SII_PROTOCOLS, "%s: %s by word 0x1C, %s by the category General", name,
              in_header ? "supported" : "not supported", in_general ? "supported" : "not supported");
}

static void check_twice_told(reader_t *r)
{
    const cm1e_mailbox_protocols_t *mailbox = &r->device->mailbox;
    const cm1e_described_eeprom_t *eeprom = &r->device->eeprom;
    check_mailbox(r, CM1E_SM_MAILBOX_OUT, eeprom->mailbox_out_start, eeprom->mailbox_out_length, "out");
    check_mailbox(r, CM1E_SM_MAILBOX_IN, eeprom->mailbox_in_start, eeprom->mailbox_in_length, "in");
    if (!r->has_details)
        return;
    check_protocol(r, mailbox->coe, r->coe, "CoE");
    check_protocol(r, mailbox->foe, r->foe, "FoE");
    check_protocol(r, mailbox->eoe, r->eoe, "EoE");
}

cm1e_error_t cm1e_sii_read(cm1e_description_file_t *file, const uint8_t *image, size_t size, cm1e_findings_t *findings,
                           cm1e_diag_t *diag)
{
    if (size < CM1E_SII_HEADER_BYTES || size > CM1E_SII_SIZE_MAX)
        return cm1e_diag_set(diag, CM1E_ERROR_FILE, 0,
                             "%zu bytes are not an SII image: one has %d bytes before its categories, and at "
                             "most 8 MiB", size, CM1E_SII_HEADER_BYTES);
    cm1e_description_t *device = CM1E_APPEND(&file->arena, &file->devices);
    if (file->arena.failed)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    reader_t reader = {.arena = &file->arena, .device = device, .findings = findings, .image = image, .size = size};
    cm1e_description_init(device);
    read_header(&reader);
    for (int kind = 0; kind < KINDS; kind++)
        read_kind(&reader, kind);
    if (!reader.has_general)
        device->name = reader.string_count > 0 ? reader.strings[1] : ""; /* as SOEM does */
    check_chain(&reader);
    check_twice_told(&reader);
    if (file->devices.count == 1) {
        file->vendor_id = device->vendor_id;
        file->vendor_place = CM1E_SII_VENDOR;
    }
    return file->arena.failed ? cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory") : CM1E_OK;
}
