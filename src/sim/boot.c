#include <stdlib.h>
#include <string.h>

#include "description/sii_image.h"
#include "sim/cm1e_app.h"
#include "sim/esc_chip.h"

/* An image, and the device that boots from it instead of its own image from the tables. */
typedef struct boot {
    uint32_t position;
    cm1e_sim_slave_t *slave;
    const cm1e_description_t *image, *device;
    cm1e_diag_t *diag;
} boot_t;

#define REFUSE(boot, format, ...)                                                                                   \
    (cm1e_diag_set((boot)->diag, CM1E_ERROR_FILE, 0, "the SII image for the simulated slave %u " format,            \
                   (unsigned)(boot)->position, __VA_ARGS__), false)

static bool check_findings(const boot_t *boot, const cm1e_findings_t *findings)
{
    for (size_t i = 0; i < cm1e_findings_count(findings); i++) {
        const cm1e_finding_t *finding = cm1e_findings_at(findings, i);
        if (finding->is_error)
            return REFUSE(boot, "is damaged at byte 0x%04X: %s", (unsigned)finding->line, finding->text);
    }
    return true;
}

static bool check_identity(const boot_t *boot)
{
    const cm1e_description_t *image = boot->image, *device = boot->device;
    if (image->vendor_id != device->vendor_id || image->product_code != device->product_code)
        return REFUSE(boot, "is one of vendor 0x%08X, product 0x%08X; this slave is vendor 0x%08X, product 0x%08X",
                      (unsigned)image->vendor_id, (unsigned)image->product_code, (unsigned)device->vendor_id,
                      (unsigned)device->product_code);
    if (image->revision != device->revision)
        return REFUSE(boot, "is one of revision 0x%08X; with its firmware this slave has 0x%08X. The bus file says "
                      "which firmware it simulates", (unsigned)image->revision, (unsigned)device->revision);
    return true;
}

/* The image defines the place of the buffers, but not their purpose. */
static bool check_sync_managers(const boot_t *boot)
{
    const cm1e_description_t *image = boot->image, *device = boot->device;
    if (image->sync_managers.count != device->sync_managers.count)
        return REFUSE(boot, "has %zu sync managers; this slave has %zu", image->sync_managers.count,
                      device->sync_managers.count);
    for (size_t i = 0; i < image->sync_managers.count; i++) {
        const cm1e_described_sync_manager_t *manager = &image->sync_managers.at[i];
        if (manager->use != device->sync_managers.at[i].use)
            return REFUSE(boot, "has sync manager %zu of type %d; on this slave it is of type %d", i, manager->use,
                          device->sync_managers.at[i].use);
        if (cm1e_sync_manager_is_mailbox(manager->use) &&
            (manager->length < MAILBOX_MIN_BYTES || manager->length > MAILBOX_MAX_BYTES))
            return REFUSE(boot, "has a mailbox of %u bytes; expected %d to %d", manager->length, MAILBOX_MIN_BYTES,
                          MAILBOX_MAX_BYTES);
    }
    return true;
}

static bool same_entry(const cm1e_described_pdo_entry_t *left, const cm1e_described_pdo_entry_t *right)
{
    return left->index == right->index && left->subindex == right->subindex && left->bits == right->bits;
}

/* The image also defines the default PDOs of a sync manager. The default of the device is that of its objects 0x1C12
 * and 0x1C13, which a master writes or reads. */
static bool check_pdo(const boot_t *boot, const cm1e_described_pdo_t *pdo)
{
    const cm1e_described_pdo_t *own = cm1e_description_pdo(boot->device, pdo->index);
    if (!own || own->transmit != pdo->transmit)
        return REFUSE(boot, "has a %s 0x%04X, which this slave has not", cm1e_pdo_kind(pdo), pdo->index);
    if (pdo->entries.count != own->entries.count)
        return REFUSE(boot, "has %zu entries in PDO 0x%04X; on this slave it has %zu, by its firmware",
                      pdo->entries.count, pdo->index, own->entries.count);
    for (size_t i = 0; i < pdo->entries.count; i++) {
        const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[i], *expected = &own->entries.at[i];
        if (!same_entry(entry, expected))
            return REFUSE(boot, "has 0x%04X:%02X with %u bits as entry %zu of PDO 0x%04X; this slave has 0x%04X:%02X "
                          "with %u there. There are two orders, --pdo-order ug-4.4 and ug-7.2", entry->index,
                          entry->subindex, (unsigned)entry->bits, i + 1, pdo->index, expected->index,
                          expected->subindex, (unsigned)expected->bits);
    }
    return true;
}

static bool fits(const boot_t *boot)
{
    bool good = check_identity(boot) && check_sync_managers(boot);
    for (size_t i = 0; good && i < boot->image->pdos.count; i++)
        good = check_pdo(boot, &boot->image->pdos.at[i]);
    return good;
}

/* Cells behind the end of the file are empty. */
static cm1e_error_t take_image(const boot_t *boot, const uint8_t *image, size_t size)
{
    const size_t stated = boot->image->eeprom.byte_size, bytes = size > stated ? size : stated;
    uint8_t *copy = malloc(bytes);
    if (!copy)
        return cm1e_diag_set(boot->diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    memset(copy, 0xFF, bytes);
    memcpy(copy, image, size);
    free(boot->slave->sii);
    boot->slave->sii = copy;
    boot->slave->sii_size = bytes;
    cm1e_sim_esc_power_on(boot->slave, boot->slave->now_ns);
    return CM1E_OK;
}

cm1e_error_t cm1e_sim_segment_boot(cm1e_sim_segment_t *segment, uint32_t position, const uint8_t *image, size_t size,
                                   cm1e_diag_t *diag)
{
    if (!segment || !image)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "cm1e_sim_segment_boot() needs a segment and an image.");
    boot_t boot = {.position = position, .slave = cm1e_sim_segment_slave(segment, position), .diag = diag};
    if (!boot.slave)
        return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0,
                             "there is an SII image for the simulated slave %u; the segment has %u slaves",
                             (unsigned)position, (unsigned)cm1e_sim_segment_slave_count(segment));
    cm1e_description_file_t file = {0}, own = {0};
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_error_t error = findings ? cm1e_sii_read(&own, boot.slave->sii, boot.slave->sii_size, NULL, diag)
                                  : cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    if (error == CM1E_OK)
        error = cm1e_sii_read(&file, image, size, findings, diag);
    if (error == CM1E_OK) {
        boot.device = &own.devices.at[0];
        boot.image = &file.devices.at[0];
        error = check_findings(&boot, findings) && fits(&boot) ? take_image(&boot, image, size) : CM1E_ERROR_FILE;
    }
    cm1e_findings_free(findings);
    cm1e_description_file_free(&own);
    cm1e_description_file_free(&file);
    return error;
}
