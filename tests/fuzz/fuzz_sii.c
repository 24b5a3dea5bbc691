#include <stdio.h>
#include <stdlib.h>

#include "description/describe.h"
#include "description/sii_image.h"
#include "fuzz.h"

/* EEPROMs are small; most sizes that an input states would only cost the time to fill them. */
enum { LARGEST_EEPROM = 1 << 18 };

/* Not written is what needs more than its EEPROM has. */
bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    cm1e_description_file_t file = {0};
    cm1e_diag_t diag = {0};
    cm1e_findings_t *findings = fuzz_findings();
    const cm1e_error_t error = cm1e_sii_read(&file, bytes, size, findings, &diag);
    if (error != CM1E_OK && (must || size >= CM1E_SII_HEADER_BYTES))
        fuzz_fail("an image cannot be read: %s", diag.text);
    if (error == CM1E_OK) {
        cm1e_check_description(findings, &file);
        const cm1e_description_t *device = &file.devices.at[0];
        const size_t room = device->eeprom.byte_size;
        if (room <= LARGEST_EEPROM) {
            written->bytes = malloc(room);
            if (!written->bytes)
                fuzz_fail("no memory");
            written->size = cm1e_sii_write(written->bytes, room, device, &diag);
            if (written->size != room && (must || written->size != 0))
                fuzz_fail("what the writer wrote and the reader read cannot be written: %s", diag.text);
        }
    }
    fuzz_use_findings(findings);
    cm1e_description_file_free(&file);
    return written->size > 0;
}

static void seed(const char *name, const cm1e_description_file_t *file)
{
    uint8_t image[CM1E_SII_SIZE];
    const size_t size = cm1e_sii_write(image, sizeof image, &file->devices.at[0], NULL);
    if (size > 0)
        fuzz_seed(name, image, size);
}

void fuzz_seeds(void)
{
    size_t count;
    const cm1e_device_options_t *devices = fuzz_devices(&count);
    for (size_t i = 0; i <= count; i++) {
        cm1e_description_file_t file = {0};
        char name[64];
        snprintf(name, sizeof name, "device_%zu.bin", i);
        if (i == count)
            cm1e_describe_io_module(&file);
        else if (cm1e_describe(&file, &devices[i], CM1E_ESI_FLAT, NULL) != CM1E_OK)
            file.devices.count = 0;
        if (file.devices.count > 0)
            seed(name, &file);
        cm1e_description_file_free(&file);
    }
}
