#include "description/compare.h"

#include <stdio.h>
#include <string.h>

#include "description/sii_image.h"

enum { FIRST_MAPPING_OBJECT = 0x1600, LAST_MAPPING_OBJECT = 0x1BFF };

typedef struct comparison {
    cm1e_findings_t *findings;
    const cm1e_description_t *file, *device; /* the file's: one of its variants */
} comparison_t;

#define DIFFERS(c, rule, place, ...) cm1e_findings_add((c)->findings, CM1E_RULE_##rule, place, __VA_ARGS__)

/* ---- identity, EEPROM ------------------------------------------------------------------------------------------- */

static void compare_identity(const comparison_t *c)
{
    const cm1e_description_t *file = c->file, *device = c->device;
    if (file->vendor_id != device->vendor_id)
        DIFFERS(c, DIFFERS_IDENTITY, file->identity_place, "The vendor is 0x%08X in the file, 0x%08X in the device.",
                (unsigned)file->vendor_id, (unsigned)device->vendor_id);
    if (file->product_given && file->product_code != device->product_code)
        DIFFERS(c, DIFFERS_IDENTITY, file->identity_place,
                "The product code is 0x%08X in the file, 0x%08X in the device.", (unsigned)file->product_code,
                (unsigned)device->product_code);
    if (file->revision_given && file->revision != device->revision)
        DIFFERS(c, DIFFERS_IDENTITY, file->identity_place,
                "The revision is 0x%08X in the file, 0x%08X in the device: masters match a file by it.",
                (unsigned)file->revision, (unsigned)device->revision);
}

/** Compares what both sides state: an ESI may state only the beginning. Bytes `from` ... `to` - 1 are ignored. */
static bool same_bytes(cm1e_bytes_t a, cm1e_bytes_t b, size_t from, size_t to)
{
    for (size_t i = 0; a.data && b.data && i < a.size && i < b.size; i++)
        if ((i < from || i >= to) && a.data[i] != b.data[i])
            return false;
    return true;
}

static void compare_eeprom(const comparison_t *c)
{
    enum { ALIAS = CM1E_SII_ALIAS, BEHIND_ALIAS = CM1E_SII_ALIAS + 2 }; /* each device has its own */
    const cm1e_described_eeprom_t *file = &c->file->eeprom, *device = &c->device->eeprom;
    if (file->config_known && !same_bytes(file->config_data, device->config_data, ALIAS, BEHIND_ALIAS))
        DIFFERS(c, DIFFERS_EEPROM, file->place,
                "The configuration words of the EEPROM differ: those of the file are not for this device; never write "
                "them into it.");
    if (!same_bytes(file->bootstrap, device->bootstrap, 0, 0))
        DIFFERS(c, DIFFERS_EEPROM, file->place, "The bootstrap mailbox differs from that in the device's EEPROM.");
    if (file->byte_size && device->byte_size && file->byte_size != device->byte_size)
        DIFFERS(c, DIFFERS_EEPROM, file->place, "The EEPROM has %u bytes in the file, %u in the device.",
                (unsigned)file->byte_size, (unsigned)device->byte_size);
}

/* ---- communication ---------------------------------------------------------------------------------------------- */

static void compare_mailbox(const comparison_t *c)
{
    const cm1e_mailbox_protocols_t *file = &c->file->mailbox, *device = &c->device->mailbox;
    const struct {
        const char *name;
        bool file, device, of_coe;
    } abilities[] = {
        {"CoE", file->coe, device->coe, false},
        {"FoE", file->foe, device->foe, false},
        {"EoE", file->eoe, device->eoe, false},
        {"SoE", file->soe, device->soe, false},
        {"VoE", file->voe, device->voe, false},
        {"AoE", file->aoe, device->aoe, false},
        {"SDO information", file->sdo_info, device->sdo_info, true},
        {"PDO assignment", file->pdo_assign, device->pdo_assign, true},
        {"PDO configuration", file->pdo_config, device->pdo_config, true},
        {"SDO complete access", file->complete_access, device->complete_access, true},
    };
    if (file->present != device->present) {
        DIFFERS(c, DIFFERS_MAILBOX, file->place, "%s has a mailbox, %s has none.",
                file->present ? "The file" : "The device", file->present ? "the device" : "the file");
        return;
    }
    /* An ENI names the protocols alone. */
    const bool has_details = file->sdo_info || file->pdo_assign || file->pdo_config || file->complete_access;
    for (size_t i = 0; file->present && i < sizeof abilities / sizeof abilities[0]; i++)
        if (abilities[i].file != abilities[i].device &&
            (!abilities[i].of_coe || (file->coe && device->coe && has_details)))
            DIFFERS(c, DIFFERS_MAILBOX, file->place, "%s announces %s, %s does not.",
                    abilities[i].file ? "The file" : "The device's SII", abilities[i].name,
                    abilities[i].file ? "the device's SII" : "the file");
}

static const char *use_name(cm1e_sync_manager_use_t use)
{
    static const char *const names[] = {"unused", "mailbox out", "mailbox in", "outputs", "inputs"};
    return (unsigned)use < sizeof names / sizeof names[0] ? names[use] : "unknown";
}

static void compare_sync_manager(const comparison_t *c, unsigned n)
{
    const cm1e_described_sync_manager_t *file = &c->file->sync_managers.at[n];
    const cm1e_described_sync_manager_t *device = &c->device->sync_managers.at[n];
    const bool of_mailbox = cm1e_sync_manager_is_mailbox(file->use);
    if (file->use != device->use)
        DIFFERS(c, DIFFERS_SYNC_MANAGER, file->place, "Sync manager %u is for %s in the file, for %s in the device.", n,
                use_name(file->use), use_name(device->use));
    if (file->start != device->start)
        DIFFERS(c, DIFFERS_SYNC_MANAGER, file->place,
                "Sync manager %u begins at 0x%04X in the file, at 0x%04X in the device.", n, file->start,
                device->start);
    if (file->control != device->control)
        DIFFERS(c, DIFFERS_SYNC_MANAGER, file->place,
                "The control byte of sync manager %u is 0x%02X in the file, 0x%02X in the device.", n, file->control,
                device->control);
    if ((file->enable & 1) != (device->enable & 1))
        DIFFERS(c, DIFFERS_SYNC_MANAGER, file->place,
                "Sync manager %u is %senabled in the file, %senabled in the device.", n,
                file->enable & 1 ? "" : "not ", device->enable & 1 ? "" : "not ");
    /* That of process data follows from the assignment. */
    if (of_mailbox && file->length_given && device->length_given && file->length != device->length)
        DIFFERS(c, DIFFERS_SYNC_MANAGER, file->place,
                "Sync manager %u, the mailbox, has %u bytes in the file, %u in the device.", n, file->length,
                device->length);
}

static void compare_sync_managers(const comparison_t *c)
{
    const size_t file = c->file->sync_managers.count, device = c->device->sync_managers.count;
    for (unsigned n = 0; n < file && n < device; n++)
        compare_sync_manager(c, n);
    if (file > 0 && device > 0 && file != device)
        DIFFERS(c, DIFFERS_SYNC_MANAGER, file > device ? c->file->sync_managers.at[device].place : c->file->place,
                "The file has %zu sync managers, the device %zu.", file, device);
}

/* ---- process data ----------------------------------------------------------------------------------------------- */

static void compare_mapping(const comparison_t *c, const cm1e_described_pdo_t *file, const cm1e_described_pdo_t *device)
{
    const size_t common = file->entries.count < device->entries.count ? file->entries.count : device->entries.count;
    for (size_t i = 0; i < common; i++) {
        const cm1e_described_pdo_entry_t *a = &file->entries.at[i], *b = &device->entries.at[i];
        if (a->index != b->index || (a->index && a->subindex != b->subindex) || a->bits != b->bits)
            DIFFERS(c, DIFFERS_PDO, a->place,
                    "Entry %zu of %s 0x%04X is 0x%04X:%02X with %u bits in the file, 0x%04X:%02X with %u bits in the "
                    "device.", i + 1, cm1e_pdo_kind(file), file->index, a->index, a->subindex, (unsigned)a->bits,
                    b->index, b->subindex, (unsigned)b->bits);
    }
    if (file->entries.count != device->entries.count)
        DIFFERS(c, DIFFERS_PDO, file->place,
                "%s 0x%04X has %zu entries (%u bits) in the file, %zu (%u bits) in the device.", cm1e_pdo_kind(file),
                file->index, file->entries.count, (unsigned)cm1e_pdo_bits(file), device->entries.count,
                (unsigned)cm1e_pdo_bits(device));
}

static void compare_pdos(const comparison_t *c)
{
    for (size_t i = 0; i < c->file->pdos.count; i++) {
        const cm1e_described_pdo_t *file = &c->file->pdos.at[i];
        const cm1e_described_pdo_t *device = cm1e_description_pdo(c->device, file->index);
        if (!device)
            DIFFERS(c, DIFFERS_PDO, file->place, "The device has no %s 0x%04X.", cm1e_pdo_kind(file), file->index);
        else if (device->transmit != file->transmit)
            DIFFERS(c, DIFFERS_PDO, file->place, "0x%04X is among the %ss in the file, the %ss in the device.",
                    file->index, cm1e_pdo_kind(file), cm1e_pdo_kind(device));
        else
            compare_mapping(c, file, device);
    }
}

/** Whether any RxPDO, any TxPDO is assigned. */
static void find_assigned(bool assigned[2], const cm1e_description_t *description)
{
    for (size_t i = 0; i < description->pdos.count; i++)
        if (description->pdos.at[i].sync_manager >= 0)
            assigned[description->pdos.at[i].transmit] = true;
}

/** Which PDOs are in use: a warning, because masters assign them anew at start-up. */
static void compare_assignment(const comparison_t *c)
{
    bool in_file[2] = {false}, in_device[2] = {false};
    find_assigned(in_file, c->file);
    find_assigned(in_device, c->device);
    for (size_t i = 0; i < c->file->pdos.count; i++) {
        const cm1e_described_pdo_t *file = &c->file->pdos.at[i];
        const cm1e_described_pdo_t *device = cm1e_description_pdo(c->device, file->index);
        if (!device || !in_file[file->transmit] || !in_device[file->transmit])
            continue;
        if (file->sync_manager >= 0 && device->sync_manager < 0)
            DIFFERS(c, DIFFERS_ASSIGNMENT, file->place,
                    "%s 0x%04X is assigned by default in the file, and not in the device now.", cm1e_pdo_kind(file),
                    file->index);
        else if (file->sync_manager >= 0 && file->sync_manager != device->sync_manager)
            DIFFERS(c, DIFFERS_PDO, file->place,
                    "%s 0x%04X belongs to sync manager %d in the file, to sync manager %d in the device.",
                    cm1e_pdo_kind(file), file->index, file->sync_manager, device->sync_manager);
        else if (file->sync_manager < 0 && device->sync_manager >= 0)
            DIFFERS(c, DIFFERS_ASSIGNMENT, file->place,
                    "%s 0x%04X is not assigned by default in the file, but it is in the device now.",
                    cm1e_pdo_kind(file), file->index);
    }
}

/* ---- dictionary ------------------------------------------------------------------------------------------------- */

static void compare_name(const comparison_t *c, cm1e_place_t place, const char *what, const char *file,
                         const char *device)
{
    /* Devices leave names out, or cut them, where their mailbox is small. */
    if (!file || !device || !*file || !*device || strncmp(file, device, strlen(device)) == 0)
        return;
    DIFFERS(c, DIFFERS_NAME, place, "%s is called \"%s\" in the file, \"%s\" in the device.", what, file, device);
}

static const char *access_text(uint8_t access)
{
    static const char *const texts[] = {"no access", "read", "write", "read and write", "write in Pre-Operational",
                                        "read", "write in Pre-Operational", "read, and write in Pre-Operational"};
    return texts[access & (CM1E_ACCESS_READ | CM1E_ACCESS_WRITE | CM1E_ACCESS_WRITE_PREOP_ONLY)];
}

static const char *mapping_text(uint8_t access)
{
    static const char *const texts[] = {"into no PDO", "into RxPDOs", "into TxPDOs", "into RxPDOs and TxPDOs"};
    return texts[(access & CM1E_ACCESS_RXPDO ? 1 : 0) | (access & CM1E_ACCESS_TXPDO ? 2 : 0)];
}

static void compare_access(const comparison_t *c, const char *what, const cm1e_described_entry_t *file,
                           const cm1e_described_entry_t *device)
{
    enum { MAPPABLE = CM1E_ACCESS_RXPDO | CM1E_ACCESS_TXPDO };
    if ((file->access & ~MAPPABLE) != (device->access & ~MAPPABLE))
        DIFFERS(c, DIFFERS_OBJECT, file->place, "%s allows %s in the file, %s in the device.", what,
                access_text(file->access), access_text(device->access));
    if ((file->access & MAPPABLE) != (device->access & MAPPABLE))
        DIFFERS(c, DIFFERS_OBJECT, file->place, "%s can be mapped %s in the file, %s in the device.", what,
                mapping_text(file->access), mapping_text(device->access));
}

static void compare_entry(const comparison_t *c, const cm1e_described_object_t *object,
                          const cm1e_described_entry_t *file)
{
    const cm1e_described_entry_t *device = cm1e_description_entry(c->device, object->index, file->subindex);
    char what[16];
    snprintf(what, sizeof what, "0x%04X:%02X", object->index, file->subindex);
    if (!device) {
        DIFFERS(c, DIFFERS_OBJECT, file->place, "The device has no sub-index %s (\"%s\").", what,
                file->name ? file->name : "");
        return;
    }
    const uint16_t of_file = cm1e_type_code(file->type), of_device = cm1e_type_code(device->type);
    if (of_file && of_device && of_file != of_device)
        DIFFERS(c, DIFFERS_OBJECT, file->place, "%s is of type %s in the file, %s in the device.", what, file->type,
                device->type);
    if (file->bits != device->bits)
        DIFFERS(c, DIFFERS_OBJECT, file->place, "%s has %u bits in the file, %u in the device.", what,
                (unsigned)file->bits, (unsigned)device->bits);
    compare_access(c, what, file, device);
    /* A variable has the name of its object; rows of mappings have the name of the mapped object, or none. */
    const bool in_mapping = object->index >= FIRST_MAPPING_OBJECT && object->index <= LAST_MAPPING_OBJECT;
    if (object->code != CM1E_OBJECT_VAR && !in_mapping)
        compare_name(c, file->place, what, file->name, device->name);
}

static void compare_object(const comparison_t *c, const cm1e_described_object_t *file)
{
    const cm1e_described_object_t *device = cm1e_description_object(c->device, file->index);
    char what[16];
    snprintf(what, sizeof what, "0x%04X", file->index);
    if (!device) {
        DIFFERS(c, DIFFERS_OBJECT, file->place, "The device has no object %s (\"%s\").", what,
                file->name ? file->name : "");
        return;
    }
    /* Arrays and records are the same thing in an ESI. */
    if (file->code && device->code && (file->code == CM1E_OBJECT_VAR) != (device->code == CM1E_OBJECT_VAR))
        DIFFERS(c, DIFFERS_OBJECT, file->place, "Object %s is a variable %s, and has sub-indexes %s.", what,
                file->code == CM1E_OBJECT_VAR ? "in the file" : "in the device",
                file->code == CM1E_OBJECT_VAR ? "in the device" : "in the file");
    compare_name(c, file->place, what, file->name, device->name);
    for (size_t i = 0; i < file->entries.count; i++)
        compare_entry(c, file, &file->entries.at[i]);
}

/* ---- what only the device has ----------------------------------------------------------------------------------- */

static bool any_has_entry(const cm1e_description_t *variants, size_t count, uint16_t index, uint8_t subindex)
{
    for (size_t i = 0; i < count; i++)
        if (cm1e_description_entry(&variants[i], index, subindex))
            return true;
    return false;
}

static void compare_device_object(const comparison_t *c, const cm1e_description_t *variants, size_t count,
                                  const cm1e_described_object_t *device)
{
    const cm1e_described_object_t *file = NULL;
    for (size_t i = 0; i < count && !file; i++)
        file = cm1e_description_object(&variants[i], device->index);
    if (!file) {
        DIFFERS(c, DIFFERS_OBJECT, c->file->place, "The file lacks object 0x%04X (\"%s\"), which the device has.",
                device->index, device->name ? device->name : "");
        return;
    }
    for (size_t i = 0; i < device->entries.count; i++) {
        const cm1e_described_entry_t *entry = &device->entries.at[i];
        if (!any_has_entry(variants, count, device->index, entry->subindex))
            DIFFERS(c, DIFFERS_OBJECT, file->place,
                    "The file lacks sub-index 0x%04X:%02X (\"%s\"), which the device has.", device->index,
                    entry->subindex, entry->name ? entry->name : "");
    }
}

/** Only of a file that has a dictionary: others name what they use. */
static void compare_device_side(const comparison_t *c, const cm1e_description_t *variants, size_t count)
{
    for (size_t i = 0; i < c->device->objects.count; i++)
        compare_device_object(c, variants, count, &c->device->objects.at[i]);
    for (size_t i = 0; i < c->device->pdos.count; i++) {
        bool found = false;
        for (size_t n = 0; n < count && !found; n++)
            found = cm1e_description_pdo(&variants[n], c->device->pdos.at[i].index) != NULL;
        if (!found)
            DIFFERS(c, DIFFERS_PDO, c->file->place, "The file does not offer %s 0x%04X (\"%s\"), which the device has.",
                    cm1e_pdo_kind(&c->device->pdos.at[i]), c->device->pdos.at[i].index, c->device->pdos.at[i].name);
    }
}

void cm1e_compare_variants(cm1e_findings_t *findings, const cm1e_description_t *variants, size_t compared, size_t count,
                           const cm1e_description_t *device)
{
    comparison_t c = {.findings = findings, .file = &variants[0], .device = device};
    compare_identity(&c);
    compare_eeprom(&c);
    compare_mailbox(&c);
    compare_sync_managers(&c);
    compare_assignment(&c);
    for (size_t n = 0; n < compared; n++) {
        c.file = &variants[n];
        compare_pdos(&c);
        for (size_t i = 0; device->objects.count > 0 && i < c.file->objects.count; i++)
            compare_object(&c, &c.file->objects.at[i]);
    }
    c.file = &variants[0];
    if (device->objects.count > 0 && c.file->objects.count > 0)
        compare_device_side(&c, variants, count);
}

void cm1e_compare(cm1e_findings_t *findings, const cm1e_description_t *file, const cm1e_description_t *device)
{
    cm1e_compare_variants(findings, file, 1, 1, device);
}
