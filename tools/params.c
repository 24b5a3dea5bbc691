#include "params.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "core/near.h"
#include "device/bridge_facts.h"
#include "device/cml_command.h"

static bool is_parameter(const cm1e_entry_t *entry, unsigned channel)
{
    return entry->use != CM1E_USE_COMMAND && entry->availability == CM1E_AVAILABLE &&
           (channel == 0 || cm1e_bridge_axis_of(entry->index) == (int)channel - 1);
}

void params_of(const cm1e_slave_info_t *slave, unsigned channel, params_t *params)
{
    const cm1e_device_t *device = slave->device;
    const cm1e_object_t *object;
    params->count = 0;
    for (size_t n = 0; device && (object = device->object(device, n)) != NULL; n++)
        for (uint16_t i = 0; i < object->entry_count; i++)
            if (is_parameter(&object->entries[i], channel) && params->count < PARAMS_MAX)
                params->at[params->count++] = (param_t){.entry = &object->entries[i]};
}

bool param_can_move(const cm1e_entry_t *entry)
{
    return cm1e_bridge_axis_of(entry->index) >= 0 && entry->name[0] == 'K' &&
           cm1e_cml_parameter_can_move((unsigned)strtoul(entry->name + 1, NULL, 10));
}

/* ---- names ------------------------------------------------------------------------------------------------------- */

/** Whether a word is the name; blanks, "_" and "-" are the same, and case does not count. */
static bool is_name(const char *name, const char *word)
{
    for (; *name && *word; name++, word++) {
        const bool gap = *name == ' ' && (*word == '_' || *word == '-' || *word == ' ');
        if (!gap && tolower((unsigned char)*name) != tolower((unsigned char)*word))
            return false;
    }
    return *name == *word;
}

static bool is_number(const cm1e_entry_t *entry, const char *word)
{
    uint16_t index;
    uint8_t subindex;
    return read_object(word, &index, &subindex) && index == entry->index && subindex == entry->subindex;
}

const cm1e_entry_t *param_find(const params_t *params, const char *word)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = word};
    for (size_t i = 0; i < params->count; i++) {
        if (is_name(params->at[i].entry->name, word) || is_number(params->at[i].entry, word))
            return params->at[i].entry;
        cm1e_near_look(&near, params->at[i].entry->name);
    }
    complain("there is no parameter \"%s\"%s", word, cm1e_near_text(&near, text, sizeof text));
    return NULL;
}

const char *param_number(const cm1e_entry_t *entry, char text[16])
{
    snprintf(text, 16, "0x%04X:%02X", entry->index, entry->subindex);
    return text;
}

const char *param_range(const cm1e_entry_t *entry, char *text, size_t size)
{
    char steps[40] = "";
    if (entry->round_to > 1)
        snprintf(steps, sizeof steps, ", in steps of %u", (unsigned)entry->round_to);
    snprintf(text, size, "%" PRId64 " ... %" PRId64 "%s%s%s", entry->minimum, entry->maximum, entry->unit[0] ? " " : "",
             entry->unit, steps);
    return text;
}

/* ---- values ------------------------------------------------------------------------------------------------------ */

bool param_parse(const cm1e_entry_t *entry, const char *word, int64_t *value)
{
    long long number;
    char what[PARAM_NAME + 24];
    snprintf(what, sizeof what, "the value of %s", entry->name);
    if (!parse_number(word, what, entry->minimum, entry->maximum, &number))
        return false;
    *value = number;
    return true;
}

bool param_parse_setting(const params_t *params, const char *word, param_t *param)
{
    char name[PARAM_NAME];
    const char *equals = strchr(word, '=');
    if (!equals || (size_t)(equals - word) >= sizeof name) {
        complain("\"%s\": expected NAME=VALUE, as K47=30", word);
        return false;
    }
    snprintf(name, sizeof name, "%.*s", (int)(equals - word), word);
    *param = (param_t){.entry = param_find(params, name)};
    return param->entry && param_parse(param->entry, equals + 1, &param->value);
}

static bool is_signed(const cm1e_entry_t *entry)
{
    return entry->type == CM1E_TYPE_SINT || entry->type == CM1E_TYPE_INT || entry->type == CM1E_TYPE_DINT;
}

bool param_read(cm1e_bus_t *bus, uint16_t position, const cm1e_entry_t *entry, int64_t *value, cm1e_diag_t *diag)
{
    uint8_t data[8] = {0};
    size_t size = sizeof data;
    if (cm1e_sdo_read(bus, position, entry->index, entry->subindex, data, &size, diag) != CM1E_OK)
        return false;
    if (size != entry->bits / 8u) {
        cm1e_diag_set(diag, CM1E_ERROR_BUS_MAILBOX, 0, "Slave %u: %s (0x%04X:%02X) has %zu bytes; expected %u.",
                      position,
                      entry->name, entry->index, entry->subindex, size, entry->bits / 8u);
        return false;
    }
    const unsigned shift = 64 - entry->bits;
    const uint64_t bits = cm1e_get_uint(data, (unsigned)size);
    *value = is_signed(entry) ? (int64_t)(bits << shift) >> shift : (int64_t)bits;
    return true;
}

bool param_write(cm1e_bus_t *bus, uint16_t position, param_t *param, cm1e_diag_t *diag)
{
    const cm1e_entry_t *entry = param->entry;
    const int64_t wanted = cm1e_entry_round(entry, param->value);
    uint8_t data[8];
    int64_t now;
    cm1e_put_uint(data, entry->bits / 8u, (uint64_t)param->value);
    if (cm1e_sdo_write(bus, position, entry->index, entry->subindex, data, entry->bits / 8u, diag) != CM1E_OK
        || !param_read(bus, position, entry, &now, diag))
        return false;
    if (now == wanted) {
        param->value = now;
        return true;
    }
    cm1e_diag_set(diag, CM1E_ERROR_BUS_MAILBOX, 0, "Slave %u: %s was written with %" PRId64 ", and reads back as %"
                  PRId64
                  ".", position, entry->name, param->value, now);
    return false;
}
