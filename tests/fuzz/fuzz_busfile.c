/* Bus files: what is loaded keeps all its ranges, what is refused is refused in words, with a line of the file. */
#include <string.h>

#include "cm1e/config.h"
#include "fuzz.h"

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    (void)written;
    (void)must;
    static cm1e_bus_config_t configs[CM1E_MAX_BUSES];
    cm1e_diag_t diag = {0};
    uint32_t count = 0;
    const cm1e_error_t error = cm1e_bus_config_load_all(configs, CM1E_MAX_BUSES, &count, fuzz_file(bytes, size), &diag);
    if (error != CM1E_OK) {
        fuzz_use_text(diag.text);
        return false;
    }
    if (count == 0 || count > CM1E_MAX_BUSES)
        fuzz_fail("%u buses", (unsigned)count);
    for (uint32_t i = 0; i < count; i++) {
        if (cm1e_bus_config_check(&configs[i], &diag) != CM1E_OK)
            fuzz_fail("loaded, but not good: %s", diag.text);
        cm1e_bus_config_free(&configs[i]);
    }
    return false;
}

void fuzz_seeds(void)
{
    static const char *const files[] = {"examples/belt.yaml", "examples/bridge.yaml", "examples/cia402.yaml",
                                        "examples/hot_connect.yaml", "examples/machine.yaml", "examples/mixed.yaml",
                                        "examples/two_buses.yaml", "examples/winder.yaml", "examples/xy_table.yaml"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        fuzz_seed_file(files[i]);
}
