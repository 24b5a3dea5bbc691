#include <stdio.h>

#include "description/describe.h"
#include "fuzz.h"
#include "generate/esi.h"
#include "generate/esi_take.h"
#include "xml_mutator.h"

enum { SEED_OBJECTS = 5, SEED_ENTRIES = 4, SEED_MODULES = 1 }; /* small seeds are run more often */

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    cm1e_description_file_t file = {0};
    cm1e_diag_t diag = {0};
    if (cm1e_esi_read(&file, bytes, size, &diag) != CM1E_OK) {
        cm1e_description_file_free(&file);
        if (must)
            fuzz_fail("what the writer wrote cannot be read: %s", diag.text);
        return false;
    }
    cm1e_slave_config_t slave = {0};
    cm1e_esi_take(&slave, bytes, size, "DC", 1000000, &diag);
    cm1e_findings_t *findings = fuzz_findings();
    cm1e_check_description(findings, &file);
    fuzz_use_findings(findings);
    const cm1e_error_t error = cm1e_esi_write(written, &file, &diag);
    if (error != CM1E_OK && must)
        fuzz_fail("what the writer wrote and the reader read cannot be written: %s", diag.text);
    cm1e_description_file_free(&file);
    return error == CM1E_OK;
}

static void shorten(cm1e_object_list_t *objects)
{
    if (objects->count > SEED_OBJECTS)
        objects->count = SEED_OBJECTS;
    for (size_t i = 0; i < objects->count; i++)
        if (objects->at[i].entries.count > SEED_ENTRIES)
            objects->at[i].entries.count = SEED_ENTRIES;
}

static void write_seed(const char *name, cm1e_description_file_t *file)
{
    cm1e_file_t written = {0};
    for (size_t i = 0; i < file->devices.count; i++)
        shorten(&file->devices.at[i].objects);
    if (file->modules.count > SEED_MODULES)
        file->modules.count = SEED_MODULES;
    for (size_t i = 0; i < file->modules.count; i++)
        shorten(&file->modules.at[i].objects);
    if (cm1e_esi_write(&written, file, NULL) == CM1E_OK)
        fuzz_seed(name, written.bytes, written.size);
    cm1e_file_free(&written);
}

void fuzz_seeds(void)
{
    size_t count;
    const cm1e_device_options_t *devices = fuzz_devices(&count);
    for (size_t i = 0; i < count; i++)
        for (int layout = CM1E_ESI_FLAT; layout <= CM1E_ESI_MDP; layout++) {
            cm1e_description_file_t file = {0};
            char name[64];
            snprintf(name, sizeof name, "device_%zu_layout_%d.xml", i, layout);
            if (cm1e_describe(&file, &devices[i], (cm1e_esi_layout_t)layout, NULL) == CM1E_OK)
                write_seed(name, &file);
            cm1e_description_file_free(&file);
        }
}
