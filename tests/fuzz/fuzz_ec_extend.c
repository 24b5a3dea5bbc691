#include <stdio.h>

#include "description/describe.h"
#include "fuzz.h"
#include "generate/ec_extend.h"
#include "xml_mutator.h"

/* Every device beside the document: those of its profiles are few, and this is where the document is asked most. */
static void compare(cm1e_findings_t *findings, const cm1e_ec_extend_t *document)
{
    static cm1e_description_file_t described;
    for (int order = CM1E_PDO_ORDER_UG_4_4; described.devices.count < 2 && order <= CM1E_PDO_ORDER_UG_7_2; order++) {
        const cm1e_device_options_t options = {.order = (cm1e_pdo_order_t)order};
        if (cm1e_describe(&described, &options, CM1E_ESI_FLAT, NULL) != CM1E_OK)
            fuzz_fail("no memory");
    }
    for (size_t i = 0; i < described.devices.count; i++)
        cm1e_ec_extend_compare(findings, document, &described.devices.at[i]);
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    cm1e_ec_extend_t document = {0};
    cm1e_diag_t diag = {0};
    if (cm1e_ec_extend_read(&document, bytes, size, &diag) != CM1E_OK) {
        cm1e_ec_extend_free(&document);
        if (must || diag.text[0] == '\0')
            fuzz_fail("what the writer wrote cannot be read, or an error says nothing: %s", diag.text);
        return false;
    }
    cm1e_findings_t *findings = fuzz_findings();
    cm1e_ec_extend_check(findings, &document);
    compare(findings, &document);
    fuzz_use_findings(findings);
    if (cm1e_ec_extend_write(written, &document, &diag) != CM1E_OK)
        fuzz_fail("what was read cannot be written: %s", diag.text);
    cm1e_ec_extend_free(&document);
    return true;
}

void fuzz_seeds(void)
{
    size_t count;
    const cm1e_device_options_t *devices = fuzz_devices(&count);
    for (size_t i = 0; i <= count; i++) {
        /* Each alone, and then two in one file. */
        const cm1e_generate_options_t options = {.format = CM1E_FILE_EC_EXTEND, .devices = &devices[i < count ? i : 2],
                                                 .device_count = i < count ? 1 : 2};
        cm1e_file_t file;
        char name[64];
        snprintf(name, sizeof name, "devices_%zu.txt", i);
        if (cm1e_generate(&file, &options, NULL) == CM1E_OK)
            fuzz_seed(name, file.bytes, file.size);
        cm1e_file_free(&file);
    }
}
