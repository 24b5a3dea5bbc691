#include <stdio.h>

#include "description/describe.h"
#include "fuzz.h"
#include "generate/esi.h"

static bool read_and_write(cm1e_file_t *written, const void *bytes, size_t size, bool must)
{
    cm1e_description_file_t file = {0};
    cm1e_diag_t diag = {0};
    if (cm1e_esi_read(&file, bytes, size, &diag) != CM1E_OK) {
        cm1e_description_file_free(&file);
        if (must)
            fuzz_fail("what the writer wrote cannot be read: %s", diag.text);
        return false;
    }
    cm1e_findings_t *findings = cm1e_findings_create();
    if (!findings)
        fuzz_fail("no memory");
    cm1e_check_description(findings, &file);
    cm1e_findings_sort(findings);
    fuzz_use_findings(findings);
    const cm1e_error_t error = cm1e_esi_write(written, &file, &diag);
    if (error != CM1E_OK && must)
        fuzz_fail("what the writer wrote and the reader read cannot be written: %s", diag.text);
    cm1e_description_file_free(&file);
    return error == CM1E_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    cm1e_file_t first = {0}, second = {0};
    if (read_and_write(&first, bytes, size, false)) {
        read_and_write(&second, first.bytes, first.size, true);
        fuzz_expect_same(&first, &second);
    }
    cm1e_file_free(&first);
    cm1e_file_free(&second);
    return 0;
}

void fuzz_seeds(void)
{
    size_t count;
    const cm1e_device_options_t *devices = fuzz_devices(&count);
    for (size_t i = 0; i < count; i++)
        for (int layout = CM1E_ESI_FLAT; layout <= CM1E_ESI_MDP; layout++) {
            cm1e_description_file_t file = {0};
            cm1e_file_t written = {0};
            char name[64];
            snprintf(name, sizeof name, "device_%zu_layout_%d.xml", i, layout);
            if (cm1e_describe(&file, &devices[i], (cm1e_esi_layout_t)layout, NULL) == CM1E_OK &&
                cm1e_esi_write(&written, &file, NULL) == CM1E_OK)
                fuzz_seed(name, written.bytes, written.size);
            cm1e_file_free(&written);
            cm1e_description_file_free(&file);
        }
}
