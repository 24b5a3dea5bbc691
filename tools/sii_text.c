#include "sii_text.h"

#include <stdio.h>
#include <string.h>

#include "command.h"
#include "core/json_text.h"
#include "files.h"

static const char *const sync_manager_uses[] = {
    [CM1E_SM_UNUSED] = "not used", [CM1E_SM_MAILBOX_OUT] = "mailbox out", [CM1E_SM_MAILBOX_IN] = "mailbox in",
    [CM1E_SM_OUTPUTS] = "outputs", [CM1E_SM_INPUTS] = "inputs",
};
static const char *const fmmu_uses[] = {
    [CM1E_FMMU_UNUSED] = "not used", [CM1E_FMMU_OUTPUTS] = "outputs", [CM1E_FMMU_INPUTS] = "inputs",
    [CM1E_FMMU_MAILBOX_STATE] = "mailbox state",
};
enum { PROTOCOLS = 6 };

/** The n-th of `count` texts; a number that a damaged image can hold may have none. */
#define TEXT_OF(texts, n) ((size_t)(n) < sizeof(texts) / sizeof(texts)[0] && (texts)[n] ? (texts)[n] : "?")

static const char *or_none(const char *text) { return text && *text ? text : "-"; }

static void hex_words(cm1e_bytes_t bytes, char *text, size_t size)
{
    text[0] = '\0';
    for (size_t i = 0; i + 1 < bytes.size && strlen(text) + 6 < size; i += 2)
        snprintf(text + strlen(text), size - strlen(text), "%s%02X%02X", i ? " " : "", bytes.data[i + 1],
                 bytes.data[i]);
}

/* Those that a mailbox has; the others are NULL. */
static void list_protocols(const cm1e_mailbox_protocols_t *mailbox, const char *names[PROTOCOLS])
{
    names[0] = mailbox->aoe ? "AoE" : NULL;
    names[1] = mailbox->eoe ? "EoE" : NULL;
    names[2] = mailbox->coe ? "CoE" : NULL;
    names[3] = mailbox->foe ? "FoE" : NULL;
    names[4] = mailbox->soe ? "SoE" : NULL;
    names[5] = mailbox->voe ? "VoE" : NULL;
}

static void protocol_names(const cm1e_mailbox_protocols_t *mailbox, char *text, size_t size)
{
    const char *names[PROTOCOLS];
    list_protocols(mailbox, names);
    text[0] = '\0';
    for (int i = 0; i < PROTOCOLS; i++)
        if (names[i])
            snprintf(text + strlen(text), size - strlen(text), "%s%s", text[0] ? " " : "", names[i]);
}

static void coe_details(const cm1e_mailbox_protocols_t *mailbox, char *text, size_t size)
{
    const struct {
        bool is;
        const char *name;
    } details[] = {{mailbox->sdo_info, "SDO information"}, {mailbox->pdo_assign, "PDO assignment"},
                   {mailbox->pdo_config, "PDO configuration"}, {mailbox->pdo_upload, "PDO upload"},
                   {mailbox->complete_access, "complete access"}};
    text[0] = '\0';
    for (size_t i = 0; i < sizeof details / sizeof details[0]; i++)
        if (details[i].is)
            snprintf(text + strlen(text), size - strlen(text), "%s%s", text[0] ? ", " : "", details[i].name);
}

/* ---- words ------------------------------------------------------------------------------------------------------ */

static void print_header(const cm1e_description_t *device, size_t size)
{
    const cm1e_described_eeprom_t *eeprom = &device->eeprom;
    char words[64], names[64], details[128];
    hex_words(eeprom->config_data, words, sizeof words);
    protocol_names(&device->mailbox, names, sizeof names);
    coe_details(&device->mailbox, details, sizeof details);
    printf("image           %zu bytes; EEPROM of %u bytes, version %u\n", size, (unsigned)eeprom->byte_size,
           eeprom->version);
    printf("configuration   words 0-6: %s\n", words);
    printf("identity        vendor 0x%08X, product 0x%08X, revision 0x%08X, serial number %u, alias %u\n",
           (unsigned)device->vendor_id, (unsigned)device->product_code, (unsigned)device->revision,
           (unsigned)eeprom->serial_number, eeprom->alias);
    printf("names           %s; order number %s; group %s\n", or_none(device->name), or_none(device->type),
           or_none(device->group));
    if (eeprom->mailbox_out_length == 0 && eeprom->mailbox_in_length == 0) {
        printf("mailbox         none\n");
        return;
    }
    printf("mailbox         out 0x%04X, %u bytes; in 0x%04X, %u bytes; %s\n", eeprom->mailbox_out_start,
           eeprom->mailbox_out_length, eeprom->mailbox_in_start, eeprom->mailbox_in_length, or_none(names));
    hex_words(eeprom->bootstrap, words, sizeof words);
    printf("                bootstrap (out start, length, in start, length): %s\n", or_none(words));
    printf("                CoE: %s\n", or_none(details));
}

static void print_channels(const cm1e_description_t *device)
{
    for (size_t i = 0; i < device->sync_managers.count; i++) {
        const cm1e_described_sync_manager_t *manager = &device->sync_managers.at[i];
        printf("sync manager %zu  %-11s 0x%04X, %u bytes, control 0x%02X, %s\n", i,
               TEXT_OF(sync_manager_uses, manager->use), manager->start, manager->length, manager->control,
               manager->enable & 1 ? "enabled" : "not enabled");
    }
    for (size_t i = 0; i < device->fmmus.count; i++)
        printf("FMMU %zu          %s\n", i, TEXT_OF(fmmu_uses, device->fmmus.at[i].use));
    for (size_t i = 0; i < device->dc_modes.count; i++)
        printf("DC mode         %s: activation 0x%04X\n", or_none(device->dc_modes.at[i].name),
               device->dc_modes.at[i].assign_activate);
}

static void print_pdo(const cm1e_described_pdo_t *pdo)
{
    printf("%s 0x%04X    %s, %u bits, ", cm1e_pdo_kind(pdo), pdo->index, or_none(pdo->name),
           (unsigned)cm1e_pdo_bits(pdo));
    if (pdo->sync_manager == CM1E_NO_SYNC_MANAGER)
        printf("not assigned\n");
    else
        printf("sync manager %d\n", pdo->sync_manager);
    for (size_t i = 0; i < pdo->entries.count; i++) {
        const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[i];
        printf("    0x%04X:%02X  %3u bits  %-8s %s\n", entry->index, entry->subindex, (unsigned)entry->bits,
               or_none(entry->type), entry->index ? or_none(entry->name) : "(gap)");
    }
}

void print_sii(const cm1e_description_t *device, size_t size, const cm1e_findings_t *findings)
{
    print_header(device, size);
    print_channels(device);
    for (size_t i = 0; i < device->pdos.count; i++)
        print_pdo(&device->pdos.at[i]);
    for (size_t i = 0; i < cm1e_findings_count(findings); i++) {
        const cm1e_finding_t *finding = cm1e_findings_at(findings, i);
        printf("%s at byte 0x%04X: %s [%s]\n", finding_severity(finding), (unsigned)finding->line,
               finding->text, finding->rule);
    }
}

/* ---- JSON ------------------------------------------------------------------------------------------------------- */

static json_t *pdo_as_json(const cm1e_described_pdo_t *pdo)
{
    json_t *entries = json_array();
    for (size_t i = 0; i < pdo->entries.count; i++) {
        const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[i];
        json_array_append_new(entries, json_pack("{s:i, s:i, s:i, s:o, s:o}", "index", entry->index, "subindex",
                                                 entry->subindex, "bits", (int)entry->bits, "type",
                                                 cm1e_json_text(entry->type), "name", cm1e_json_text(entry->name)));
    }
    return json_pack("{s:i, s:s, s:o, s:i, s:o}", "index", pdo->index, "direction", pdo->transmit ? "Tx" : "Rx", "name",
                     cm1e_json_text(pdo->name), "sync_manager", pdo->sync_manager, "entries", entries);
}

static json_t *channels_as_json(const cm1e_description_t *device)
{
    json_t *managers = json_array(), *fmmus = json_array(), *modes = json_array();
    for (size_t i = 0; i < device->sync_managers.count; i++) {
        const cm1e_described_sync_manager_t *manager = &device->sync_managers.at[i];
        json_array_append_new(managers, json_pack("{s:s, s:i, s:i, s:i, s:b}", "use",
                                                  TEXT_OF(sync_manager_uses, manager->use), "start", manager->start,
                                                  "length", manager->length, "control", manager->control, "enabled",
                                                  manager->enable & 1));
    }
    for (size_t i = 0; i < device->fmmus.count; i++)
        json_array_append_new(fmmus, json_string(TEXT_OF(fmmu_uses, device->fmmus.at[i].use)));
    for (size_t i = 0; i < device->dc_modes.count; i++)
        json_array_append_new(modes, json_pack("{s:o, s:i}", "name", cm1e_json_text(device->dc_modes.at[i].name),
                                               "assign_activate", device->dc_modes.at[i].assign_activate));
    return json_pack("{s:o, s:o, s:o}", "sync_managers", managers, "fmmus", fmmus, "dc_modes", modes);
}

static json_t *mailbox_as_json(const cm1e_description_t *device)
{
    const cm1e_described_eeprom_t *eeprom = &device->eeprom;
    const char *protocols[PROTOCOLS];
    json_t *names = json_array();
    list_protocols(&device->mailbox, protocols);
    for (int i = 0; i < PROTOCOLS; i++)
        if (protocols[i])
            json_array_append_new(names, json_string(protocols[i]));
    return json_pack("{s:i, s:i, s:i, s:i, s:o}", "out_start", eeprom->mailbox_out_start, "out_length",
                     eeprom->mailbox_out_length, "in_start", eeprom->mailbox_in_start, "in_length",
                     eeprom->mailbox_in_length, "protocols", names);
}

json_t *sii_as_json(const cm1e_description_t *device, size_t size, const cm1e_findings_t *findings)
{
    const cm1e_described_eeprom_t *eeprom = &device->eeprom;
    char words[64];
    hex_words(eeprom->config_data, words, sizeof words);
    json_t *object = json_pack(
        "{s:I, s:I, s:i, s:s, s:I, s:I, s:I, s:I, s:i, s:o, s:o, s:o, s:o}", "image_bytes", (json_int_t)size,
        "eeprom_bytes", (json_int_t)eeprom->byte_size, "version", eeprom->version, "configuration", words, "vendor_id",
        (json_int_t)device->vendor_id, "product_code", (json_int_t)device->product_code, "revision",
        (json_int_t)device->revision, "serial_number", (json_int_t)eeprom->serial_number, "alias", eeprom->alias,
        "name", cm1e_json_text(device->name), "order_number", cm1e_json_text(device->type), "group",
        cm1e_json_text(device->group), "mailbox", mailbox_as_json(device));
    json_t *channels = channels_as_json(device), *pdos = json_array();
    json_object_update(object, channels);
    json_decref(channels);
    for (size_t i = 0; i < device->pdos.count; i++)
        json_array_append_new(pdos, pdo_as_json(&device->pdos.at[i]));
    json_object_set_new(object, "pdos", pdos);
    json_object_set_new(object, "findings", findings_as_list(findings, "byte"));
    return object;
}
