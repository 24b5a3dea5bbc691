#include "generate/live.h"

#include <stdlib.h>
#include <string.h>

#include "cm1e/sdo_info.h"
#include "cm1e/sii.h"
#include "core/bytes.h"
#include "description/describe.h"
#include "description/sii_image.h"

enum { OBJECTS_MAX = 0x10000, ENTRIES_MAX = 254 };
enum { RXPDO_FIRST = 0x1600, RXPDO_LAST = 0x17FF, TXPDO_FIRST = 0x1A00, TXPDO_LAST = 0x1BFF };
/* 0x1800:06 is that of the PDO 0x1A00 (ETG.1000.6) */
enum { TO_PARAMETER = 0x200, EXCLUDES = 6, EXCLUDED_BYTES = 128 };

typedef struct live {
    cm1e_bus_t *bus;
    uint16_t position;
    cm1e_arena_t *arena;
    cm1e_description_t *device;
    cm1e_findings_t *findings;
    cm1e_diag_t *diag;
} live_t;

/** A refusal concerns one object; every other error would repeat for the next one. */
static bool goes_on(cm1e_error_t error) { return error == CM1E_OK || error == CM1E_ERROR_SDO_ABORT; }

/* ---- SII -------------------------------------------------------------------------------------------------------- */

static cm1e_error_t describe_sii(live_t *live, cm1e_description_file_t *file)
{
    uint8_t *image = malloc(CM1E_SII_IMAGE_MAX);
    size_t size = CM1E_SII_IMAGE_MAX;
    if (!image)
        return cm1e_diag_set(live->diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    cm1e_error_t error = cm1e_sii_read_device(live->bus, live->position, image, &size, live->diag);
    if (error == CM1E_OK)
        error = cm1e_sii_read(file, image, size, NULL, live->diag);
    free(image);
    if (error == CM1E_OK)
        live->device = &file->devices.at[file->devices.count - 1];
    return error;
}

/* ---- dictionary ------------------------------------------------------------------------------------------------- */

static uint8_t access_of(uint16_t told)
{
    const unsigned later = CM1E_INFO_WRITE_SAFEOP | CM1E_INFO_WRITE_OP;
    unsigned access = 0;
    if (told & (CM1E_INFO_READ_PREOP | CM1E_INFO_READ_SAFEOP | CM1E_INFO_READ_OP))
        access |= CM1E_ACCESS_READ;
    if (told & (CM1E_INFO_WRITE_PREOP | later))
        access |= CM1E_ACCESS_WRITE;
    if (told & CM1E_INFO_WRITE_PREOP && !(told & later))
        access |= CM1E_ACCESS_WRITE_PREOP_ONLY;
    if (told & CM1E_INFO_RXPDO)
        access |= CM1E_ACCESS_RXPDO;
    if (told & CM1E_INFO_TXPDO)
        access |= CM1E_ACCESS_TXPDO;
    return (uint8_t)access;
}

static cm1e_bytes_t told_bytes(live_t *live, const cm1e_info_value_t *value)
{
    cm1e_bytes_t bytes = {0};
    if (value->size > 0)
        bytes = (cm1e_bytes_t){cm1e_arena_bytes(live->arena, value->bytes, value->size), value->size};
    return bytes;
}

static cm1e_error_t describe_entry(live_t *live, cm1e_described_object_t *object, uint8_t subindex)
{
    cm1e_entry_info_t info;
    const cm1e_error_t error =
        cm1e_sdo_info_entry(live->bus, live->position, object->index, subindex, &info, live->diag);
    if (error != CM1E_OK)
        return error; /* a gap in the sub-indexes is refused */
    cm1e_described_entry_t *entry = CM1E_APPEND(live->arena, &object->entries);
    const char *type = cm1e_type_name(live->arena, info.data_type, info.bits);
    entry->subindex = subindex;
    entry->name = cm1e_arena_text(live->arena, info.name);
    entry->type = type ? type : "";
    entry->bits = info.bits;
    entry->access = access_of(info.access);
    entry->unit = "";
    entry->default_data = told_bytes(live, &info.default_value);
    entry->minimum = told_bytes(live, &info.minimum);
    entry->maximum = told_bytes(live, &info.maximum);
    return CM1E_OK;
}

static cm1e_error_t describe_object(live_t *live, uint16_t index)
{
    cm1e_object_info_t info;
    cm1e_error_t error = cm1e_sdo_info_object(live->bus, live->position, index, &info, live->diag);
    if (error == CM1E_ERROR_SDO_ABORT)
        cm1e_findings_add(live->findings, CM1E_RULE_NOT_COMPARED, 0,
                          "The device lists object 0x%04X and refuses to describe it.", index);
    if (error != CM1E_OK || cm1e_description_object(live->device, index))
        return error; /* a device that lists one twice */
    cm1e_described_object_t *object = CM1E_APPEND(live->arena, &live->device->objects);
    object->index = index;
    object->code = info.code;
    object->name = cm1e_arena_text(live->arena, info.name);
    object->type = "";
    const unsigned highest = info.code == CM1E_OBJECT_VAR ? 0 : info.highest_subindex;
    for (unsigned subindex = 0; subindex <= highest && goes_on(error); subindex++)
        error = describe_entry(live, object, (uint8_t)subindex);
    return error;
}

static cm1e_error_t describe_dictionary(live_t *live)
{
    uint16_t *indexes = calloc(OBJECTS_MAX, sizeof *indexes);
    size_t count = OBJECTS_MAX;
    if (!indexes)
        return cm1e_diag_set(live->diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    cm1e_error_t error =
        cm1e_sdo_info_list(live->bus, live->position, CM1E_OBJECTS_ALL, indexes, &count, live->diag);
    if (error != CM1E_OK) {
        cm1e_findings_add(live->findings, CM1E_RULE_NOT_COMPARED, 0, "The dictionary is not compared. %s",
                          live->diag->text);
        count = 0;
        error = CM1E_OK;
    }
    for (size_t i = 0; i < count && goes_on(error) && !live->arena->failed; i++)
        error = describe_object(live, indexes[i]);
    free(indexes);
    return goes_on(error) ? CM1E_OK : error;
}

/* ---- process data ----------------------------------------------------------------------------------------------- */

/** A number of the dictionary; false: refused, or of another size. */
static bool read_number(live_t *live, uint16_t index, uint8_t subindex, size_t bytes, uint32_t *value,
                        cm1e_error_t *error)
{
    uint8_t data[4] = {0};
    size_t size = sizeof data;
    *error = cm1e_sdo_read(live->bus, live->position, index, subindex, data, &size, live->diag);
    *value = cm1e_get_u32(data);
    return *error == CM1E_OK && size >= bytes;
}

/** The sync manager that 0x1C12 or 0x1C13 assigns a PDO to. */
static void assign(cm1e_description_t *device, uint16_t index, int sync_manager)
{
    for (size_t i = 0; i < device->pdos.count; i++)
        if (device->pdos.at[i].index == index)
            device->pdos.at[i].sync_manager = sync_manager;
}

static cm1e_error_t read_assignment(live_t *live, uint16_t index, int sync_manager)
{
    uint32_t count, pdo;
    cm1e_error_t error = CM1E_OK;
    if (!read_number(live, index, 0, 1, &count, &error))
        return goes_on(error) ? CM1E_OK : error;
    for (unsigned n = 1; n <= (count & 0xFF) && goes_on(error); n++)
        if (read_number(live, index, (uint8_t)n, 2, &pdo, &error))
            assign(live->device, (uint16_t)pdo, sync_manager);
    return goes_on(error) ? CM1E_OK : error;
}

static void name_entry(live_t *live, cm1e_described_pdo_entry_t *entry)
{
    const cm1e_described_entry_t *known = cm1e_description_entry(live->device, entry->index, entry->subindex);
    entry->name = known ? known->name : NULL;
    entry->type = known && known->bits == entry->bits ? known->type : "";
}

/** The PDOs that must not be assigned beside it, where the device has an object for that: two octets each. */
static cm1e_error_t read_excludes(live_t *live, cm1e_described_pdo_t *pdo)
{
    uint8_t data[EXCLUDED_BYTES];
    size_t size = sizeof data;
    if (!cm1e_description_entry(live->device, (uint16_t)(pdo->index - TO_PARAMETER), EXCLUDES))
        return CM1E_OK;
    const cm1e_error_t error = cm1e_sdo_read(live->bus, live->position, (uint16_t)(pdo->index - TO_PARAMETER), EXCLUDES,
                                             data, &size, live->diag);
    for (size_t at = 0; at + 2 <= size && error == CM1E_OK; at += 2) {
        cm1e_exclude_t *exclude = CM1E_APPEND(live->arena, &pdo->excludes);
        exclude->index = cm1e_get_u16(data + at);
    }
    return goes_on(error) ? CM1E_OK : error;
}

/** A mapping object as the device has it; one that cannot be read is as the SII says. */
static cm1e_error_t read_mapping(live_t *live, uint16_t index, cm1e_pdo_list_t *pdos)
{
    uint32_t count, mapped;
    cm1e_error_t error = CM1E_OK;
    const cm1e_described_object_t *object = cm1e_description_object(live->device, index);
    const cm1e_described_pdo_t *of_sii = cm1e_description_pdo(live->device, index);
    const bool readable = read_number(live, index, 0, 1, &count, &error);
    if (!goes_on(error) || (!readable && !of_sii))
        return goes_on(error) ? CM1E_OK : error;
    cm1e_described_pdo_t *pdo = CM1E_APPEND(live->arena, pdos);
    if (of_sii)
        *pdo = *of_sii;
    if (!readable)
        return CM1E_OK;
    pdo->index = index;
    pdo->transmit = index >= TXPDO_FIRST;
    pdo->name = of_sii ? of_sii->name : object ? object->name : "";
    pdo->sync_manager = CM1E_NO_SYNC_MANAGER;
    pdo->entries.at = NULL;
    pdo->entries.count = pdo->excludes.count = 0;
    for (unsigned n = 1; n <= (count & 0xFF) && n <= ENTRIES_MAX && goes_on(error); n++) {
        if (!read_number(live, index, (uint8_t)n, 4, &mapped, &error))
            continue;
        cm1e_described_pdo_entry_t *entry = CM1E_APPEND(live->arena, &pdo->entries);
        entry->index = (uint16_t)(mapped >> 16);
        entry->subindex = (uint8_t)(mapped >> 8);
        entry->bits = (uint8_t)mapped;
        name_entry(live, entry);
    }
    return goes_on(error) ? read_excludes(live, pdo) : error;
}

static bool is_mapping(uint16_t index)
{
    return (index >= RXPDO_FIRST && index <= RXPDO_LAST) || (index >= TXPDO_FIRST && index <= TXPDO_LAST);
}

/** Reads the mapping objects instead of the PDOs of the SII, because the device uses them. The dictionary lists them;
 *  without a dictionary the SII does. */
static cm1e_error_t describe_pdos(live_t *live)
{
    const cm1e_description_t *device = live->device;
    cm1e_pdo_list_t pdos = {0};
    cm1e_error_t error = CM1E_OK;
    for (size_t i = 0; i < device->objects.count && error == CM1E_OK; i++)
        if (is_mapping(device->objects.at[i].index))
            error = read_mapping(live, device->objects.at[i].index, &pdos);
    for (size_t i = 0; device->objects.count == 0 && i < device->pdos.count && error == CM1E_OK; i++)
        error = read_mapping(live, device->pdos.at[i].index, &pdos);
    if (error != CM1E_OK || pdos.count == 0)
        return error;
    live->device->pdos = pdos;
    error = read_assignment(live, OBJ_1C12_RXPDO_ASSIGN, CM1E_SM_NUMBER_OUTPUTS);
    if (error == CM1E_OK)
        error = read_assignment(live, OBJ_1C13_TXPDO_ASSIGN, CM1E_SM_NUMBER_INPUTS);
    return error;
}

/* ---- both ------------------------------------------------------------------------------------------------------- */

/** A firmware update without its SII, or the reverse, makes a device that masters take for another one. */
static cm1e_error_t compare_identity(live_t *live)
{
    const cm1e_description_t *device = live->device;
    const struct {
        uint8_t subindex;
        uint32_t of_sii;
        const char *name;
    } parts[] = {{1, device->vendor_id, "vendor"}, {2, device->product_code, "product code"},
                 {3, device->revision, "revision"}};
    cm1e_error_t error = CM1E_OK;
    for (size_t i = 0; i < sizeof parts / sizeof parts[0] && goes_on(error); i++) {
        uint32_t value;
        if (read_number(live, OBJ_1018_IDENTITY, parts[i].subindex, 4, &value, &error) && value != parts[i].of_sii)
            cm1e_findings_add(live->findings, CM1E_RULE_DIFFERS_IDENTITY, 0,
                              "The device contradicts itself: the %s is 0x%08X in its SII, 0x%08X in its object "
                              "0x1018:%02X. Was its firmware updated without its SII?", parts[i].name,
                              (unsigned)parts[i].of_sii, (unsigned)value, parts[i].subindex);
    }
    return goes_on(error) ? CM1E_OK : error;
}

cm1e_error_t cm1e_live_describe(cm1e_description_file_t *file, cm1e_bus_t *bus, uint16_t position,
                                cm1e_findings_t *findings, cm1e_diag_t *diag)
{
    cm1e_diag_t own = {0};
    live_t live = {.bus = bus, .position = position, .arena = &file->arena, .findings = findings,
                   .diag = diag ? diag : &own};
    cm1e_error_t error = describe_sii(&live, file);
    if (error != CM1E_OK || !live.device->mailbox.coe)
        return error;
    error = describe_dictionary(&live);
    if (error == CM1E_OK)
        error = describe_pdos(&live);
    if (error == CM1E_OK)
        error = compare_identity(&live);
    if (error == CM1E_OK && file->arena.failed)
        error = cm1e_diag_set(live.diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    return error;
}
