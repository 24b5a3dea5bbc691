/* Files of `cm1e params`, for each kind of motor: what can be read is within the ranges of the device, and is written anew
 * with the same bytes; what cannot be read is complained of. The first byte of an input chooses the device. */
#include <stdlib.h>
#include <string.h>

#include "fuzz_complain.h"
#include "params.h"

/** A CM1-E, connectors of bridges, drives of other makers, which have no settings. */
static void known_of(unsigned kind, params_t *known)
{
    static const struct {
        cm1e_device_model_t model;
        unsigned channel;
    } devices[] = {{CM1E_DEVICE_CM1E, 0}, {CM1E_DEVICE_EB01, 1}, {CM1E_DEVICE_EB12, 3}, {CM1E_DEVICE_EB02, 4}};
    cm1e_slave_info_t slave = {.device = cm1e_device_of_model(devices[kind % 4].model)};
    params_of(&slave, devices[kind % 4].channel, known);
}

static void check(const params_t *params)
{
    for (size_t i = 0; i < params->count; i++) {
        const param_t *param = &params->at[i];
        if (param->value < param->entry->minimum || param->value > param->entry->maximum || param->line == 0)
            fuzz_fail("%s is %lld, in line %zu", param->entry->name, (long long)param->value, param->line);
        for (size_t k = 0; k < i; k++)
            if (params->at[k].entry == param->entry)
                fuzz_fail("%s is there twice", param->entry->name);
    }
}

static params_head_t head; /* of the file that is read */

static bool keep_head(const params_head_t *of_file, const void *context)
{
    (void)context;
    head = *of_file;
    return true;
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    static params_t known, params;
    if (size == 0)
        return false;
    const unsigned before = complaints;
    known_of(bytes[0], &known);
    if (!params_read_file(fuzz_file(bytes + 1, size - 1), &known, keep_head, NULL, &params)) {
        if (must || complaints == before)
            fuzz_fail(must ? "a file of ours cannot be read" : "a file is refused without a complaint");
        return false;
    }
    check(&params);
    char *text = params_as_yaml(&head, &params);
    if (!text)
        fuzz_fail("no memory");
    written->size = strlen(text) + 1;
    written->bytes = malloc(written->size);
    if (!written->bytes)
        fuzz_fail("no memory");
    written->bytes[0] = bytes[0];
    memcpy(written->bytes + 1, text, written->size - 1);
    free(text);
    return true;
}

/** What a backup writes of each device, and a file by hand. */
void fuzz_seeds(void)
{
    static const char by_hand[] = "\1device: {kind: eb01, serial: 0x12}\nparameters:\n  K23: 30\n  0x607C: -5 # home\n";
    static const params_head_t of_backup = {.kind = "cm1e", .name = "CM1-E", .firmware = "1.3.5", .serial = 4711};
    static params_t known;
    for (unsigned kind = 0; kind < 4; kind++) {
        char name[] = "backup0", *text, whole[65536];
        known_of(kind, &known);
        for (size_t i = 0; i < known.count; i++)
            known.at[i].value = known.at[i].entry->minimum;
        text = params_as_yaml(&of_backup, &known);
        name[6] = (char)('0' + kind);
        const int length = snprintf(whole, sizeof whole, "%c%.4000s", (char)('0' + kind), text ? text : "");
        fuzz_seed(name, whole, (size_t)length);
        free(text);
    }
    fuzz_seed("by_hand", by_hand, sizeof by_hand - 1);
}
