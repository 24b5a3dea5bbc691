#include <stdio.h>

#include "description/describe.h"
#include "fuzz.h"
#include "generate/eni.h"
#include "xml_mutator.h"

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    cm1e_eni_t document = {0};
    cm1e_diag_t diag = {0};
    if (cm1e_eni_read(&document, bytes, size, &diag) != CM1E_OK) {
        cm1e_eni_free(&document);
        if (must)
            fuzz_fail("what the writer wrote cannot be read: %s", diag.text);
        return false;
    }
    cm1e_findings_t *findings = fuzz_findings();
    cm1e_eni_check(findings, &document);
    for (uint16_t position = 1; position <= document.devices.count && position <= 3; position++) {
        cm1e_arena_t arena = {0};
        const cm1e_description_t device = cm1e_eni_describe(&arena, &document.devices.at[position - 1]);
        if (!arena.failed)
            cm1e_eni_compare(findings, &document, position, &device);
        cm1e_arena_free(&arena);
    }
    fuzz_use_findings(findings);
    const cm1e_error_t error = cm1e_eni_write(written, &document, &diag);
    if (error != CM1E_OK && must)
        fuzz_fail("what the writer wrote and the reader read cannot be written: %s", diag.text);
    cm1e_eni_free(&document);
    return error == CM1E_OK;
}

/* Every device between two I/O modules. */
void fuzz_seeds(void)
{
    size_t count;
    const cm1e_device_options_t *devices = fuzz_devices(&count);
    for (size_t i = 0; i < count; i++) {
        cm1e_description_file_t described = {0};
        cm1e_eni_t document = {0};
        cm1e_file_t written = {0};
        char name[64];
        cm1e_describe_io_module(&described);
        if (cm1e_describe(&described, &devices[i], CM1E_ESI_FLAT, NULL) == CM1E_OK) {
            cm1e_describe_io_module(&described);
            const cm1e_eni_slave_t slaves[] = {{.device = &described.devices.at[0], .name = "first", .alias = 0},
                                               {.device = &described.devices.at[1], .name = "middle",
                                                .alias = (uint16_t)i},
                                               {.device = &described.devices.at[2], .name = "last", .alias = 0}};
            snprintf(name, sizeof name, "network_%zu.xml", i);
            if (cm1e_eni_make(&document, slaves, 3, 1000000, NULL) == CM1E_OK &&
                cm1e_eni_write(&written, &document, NULL) == CM1E_OK)
                fuzz_seed(name, written.bytes, written.size);
        }
        cm1e_file_free(&written);
        cm1e_eni_free(&document);
        cm1e_description_file_free(&described);
    }
}
