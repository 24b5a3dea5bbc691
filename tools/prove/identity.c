/* Identity and EEPROM. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/generate.h"
#include "core/bytes.h"
#include "core/text.h"
#include "description/check.h"
#include "description/compare.h"
#include "description/sii_image.h"
#include "prove/prove.h"

static void compare_value(prove_t *prove, const char *thing, uint16_t index, uint8_t subindex, uint32_t expected)
{
    int64_t value;
    if (prove_value(prove, index, subindex, &value))
        prove_compare_number(prove, thing, expected, value & UINT32_MAX, 8);
    else
        prove_note(prove, "0x%04X:%02X cannot be read", index, subindex);
}

static void compare_text(prove_t *prove, uint16_t index, const char *expected)
{
    const seen_entry_t *entry = prove_entry(prove, index, 0);
    char thing[16], found[sizeof entry->value + 1];
    if (!entry || entry->error != CM1E_OK) {
        prove_note(prove, "0x%04X cannot be read", index);
        return;
    }
    snprintf(thing, sizeof thing, "0x%04X", index);
    cm1e_text_of_device(found, sizeof found, entry->value, entry->size);
    prove_compare(prove, thing, expected, found);
}

static void compare_firmware(prove_t *prove)
{
    char known[80] = "one of";
    const char *version = prove->slave->software_version;
    for (int n = 0; n < CM1E_FIRMWARE_COUNT; n++) {
        const size_t used = strlen(known);
        const char *other = cm1e_firmware_info((cm1e_firmware_t)n)->version;
        snprintf(known + used, sizeof known - used, " %s", other);
        if (strcmp(other, version + (version[0] == 'V')) == 0) {
            prove_compare(prove, "0x100A", version, version);
            return;
        }
    }
    prove_compare(prove, "0x100A", known, version);
}

void look_identity(prove_t *prove, const point_t *point)
{
    const cm1e_device_t *device = prove->device;
    switch (point->row) {
    case ID_VENDOR: compare_value(prove, "0x1018:01", 0x1018, 1, device->vendor_id); break;
    case ID_PRODUCT: compare_value(prove, "0x1018:02", 0x1018, 2, device->product_code); break;
    case ID_REVISION: compare_value(prove, "0x1018:03", 0x1018, 3, prove->firmware->revision); break;
    case ID_FIRMWARE: compare_firmware(prove); break;
    case ID_TYPE: compare_value(prove, "0x1000", 0x1000, 0, (uint32_t)device->entry(device, 0x1000, 0)->default_value);
        break;
    case ID_NAME: compare_text(prove, 0x1008, device->entry(device, 0x1008, 0)->default_string); break;
    default: compare_text(prove, 0x1009, device->entry(device, 0x1009, 0)->default_string); break;
    }
}

/* ---- the EEPROM -------------------------------------------------------------------------------------------------- */

static void look_at_checksum(prove_t *prove)
{
    prove_compare_number(prove, "word 7", cm1e_sii_crc8(prove->sii, CM1E_SII_CONFIG_BYTES),
                         prove->sii[CM1E_SII_CHECKSUM], 2);
}

static void look_at_identity(prove_t *prove)
{
    static const struct {
        const char *thing;
        unsigned at;
        uint8_t subindex;
    } rows[] = {{"vendor", CM1E_SII_VENDOR, 1}, {"product", CM1E_SII_PRODUCT, 2}, {"revision", CM1E_SII_REVISION, 3},
                {"serial number", CM1E_SII_SERIAL, 4}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        int64_t value;
        if (prove_value(prove, 0x1018, rows[i].subindex, &value))
            prove_compare_number(prove, rows[i].thing, value & UINT32_MAX, cm1e_get_u32(prove->sii + rows[i].at), 8);
    }
}

/** The order of the mappings that the device itself has. */
static cm1e_pdo_order_t order_of(const prove_t *prove)
{
    int64_t second;
    const int64_t dout_second = 0x60FE0010;
    const bool read = prove_value(prove, 0x1600, 2, &second);
    return read && second != dout_second ? CM1E_PDO_ORDER_UG_7_2 : CM1E_PDO_ORDER_UG_4_4;
}

static void set_options(const prove_t *prove, cm1e_device_options_t *options)
{
    *options = (cm1e_device_options_t){.model = prove->device->model, .order = order_of(prove),
                                       .serial_number = cm1e_get_u32(prove->sii + CM1E_SII_SERIAL),
                                       .alias = cm1e_get_u16(prove->sii + CM1E_SII_ALIAS)};
    memcpy(options->config_data, prove->sii, sizeof options->config_data);
    options->config_data_size = sizeof options->config_data;
    if (prove->firmware)
        snprintf(options->firmware, sizeof options->firmware, "%s", prove->firmware->version);
    if (prove->device->recognised == CM1E_BY_IDENTITY)
        return;
    options->vendor_id = prove->slave->vendor_id;
    options->product_code = prove->slave->product_code;
    options->revision = prove->slave->revision;
}

/** The identity is another point. */
static bool is_of_contents(const cm1e_finding_t *finding) { return strncmp(finding->rule, "identity", 8) != 0; }

static void tell_findings(prove_t *prove, const cm1e_findings_t *findings)
{
    for (size_t i = 0; i < cm1e_findings_count(findings); i++) {
        const cm1e_finding_t *finding = cm1e_findings_at(findings, i);
        if (is_of_contents(finding))
            prove_compare(prove, finding->rule, "as our tables say", finding->text);
    }
}

static void look_at_contents(prove_t *prove)
{
    cm1e_device_options_t options;
    cm1e_diag_t diag = {0};
    cm1e_file_t image = {0};
    cm1e_description_file_t ours = {0}, theirs = {0};
    cm1e_findings_t *findings = cm1e_findings_create(), *damage = cm1e_findings_create();
    set_options(prove, &options);
    const cm1e_generate_options_t generate = {.format = CM1E_FILE_SII, .devices = &options, .device_count = 1};
    if (!findings || !damage || cm1e_generate(&image, &generate, &diag) != CM1E_OK
        || cm1e_sii_read(&ours, image.bytes, image.size, NULL, &diag) != CM1E_OK
        || cm1e_sii_read(&theirs, prove->sii, prove->sii_size, damage, &diag) != CM1E_OK) {
        prove_note(prove, "it cannot be compared: %.300s", diag.text);
    } else {
        prove->compared++;
        cm1e_compare(findings, &ours.devices.at[0], &theirs.devices.at[0]);
        tell_findings(prove, damage);
        tell_findings(prove, findings);
    }
    cm1e_findings_free(findings);
    cm1e_findings_free(damage);
    cm1e_description_file_free(&ours);
    cm1e_description_file_free(&theirs);
    cm1e_file_free(&image);
}

void look_sii(prove_t *prove, const point_t *point)
{
    if (prove->sii_size < CM1E_SII_HEADER_BYTES)
        prove_note(prove, "the EEPROM cannot be read");
    else if (point->row == SII_CHECKSUM)
        look_at_checksum(prove);
    else if (point->row == SII_IDENTITY)
        look_at_identity(prove);
    else if (!prove->device->described && prove->device->channels == 0)
        prove_note(prove, "our tables do not describe the EEPROM of this device");
    else
        look_at_contents(prove);
}
