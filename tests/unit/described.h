/**
 * @file described.h
 * What tests of descriptions share: an entry beside that of the tables, start-up commands beside a table, and so on.
 */
#ifndef DESCRIBED_H
#define DESCRIBED_H

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "description/describe.h"
#include "unity.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static char described_place[120];
__attribute__((format(printf, 1, 2))) static const char *where(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(described_place, sizeof described_place, format, arguments);
    va_end(arguments);
    return described_place;
}

static const cm1e_described_object_t *object_in(const cm1e_object_list_t *objects, uint16_t index)
{
    const cm1e_described_object_t *found = NULL;
    for (size_t i = 0; i < objects->count; i++)
        if (objects->at[i].index == index) {
            TEST_ASSERT_NULL_MESSAGE(found, where("%04X is there twice", index));
            found = &objects->at[i];
        }
    return found;
}

static const cm1e_module_t *module_of(const cm1e_description_file_t *file, uint32_t ident)
{
    const cm1e_module_t *found = NULL;
    for (size_t i = 0; i < file->modules.count; i++)
        if (file->modules.at[i].ident == ident) {
            TEST_ASSERT_NULL_MESSAGE(found, where("module %08X is there twice", (unsigned)ident));
            found = &file->modules.at[i];
        }
    return found;
}

static bool is_signed(const cm1e_entry_t *entry)
{
    return entry->type == CM1E_TYPE_SINT || entry->type == CM1E_TYPE_INT || entry->type == CM1E_TYPE_DINT;
}

static int64_t number_of(const cm1e_entry_t *entry, cm1e_bytes_t bytes)
{
    return is_signed(entry) ? cm1e_bytes_signed(bytes) : (int64_t)cm1e_bytes_unsigned(bytes);
}

/* ETG.1020 */
static void check_type(const cm1e_entry_t *entry, const cm1e_described_entry_t *described, const char *at)
{
    static const struct {
        cm1e_data_type_t type;
        const char *name;
    } types[] = {{CM1E_TYPE_BOOL, "BOOL"}, {CM1E_TYPE_SINT, "SINT"}, {CM1E_TYPE_INT, "INT"}, {CM1E_TYPE_DINT, "DINT"},
                 {CM1E_TYPE_USINT, "USINT"}, {CM1E_TYPE_UINT, "UINT"}, {CM1E_TYPE_UDINT, "UDINT"}};
    char name[16];
    snprintf(name, sizeof name, "STRING(%u)", entry->bits / 8u);
    for (size_t i = 0; i < COUNT(types); i++)
        if (types[i].type == entry->type)
            snprintf(name, sizeof name, "%s", types[i].name);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(name, described->type, at);
    TEST_ASSERT_EQUAL_MESSAGE(entry->bits, described->bits, at);
}

/* A range is stated where a value can be written and the type alone allows more; a person finds it in the comment,
 * except where masters write (below 0x2000). False: none is stated. */
static bool check_range(const cm1e_entry_t *entry, int64_t divisor, const cm1e_described_entry_t *described,
                        const char *at)
{
    const int64_t least = is_signed(entry) ? -((int64_t)1 << (entry->bits - 1)) : 0;
    const int64_t most = ((int64_t)1 << (entry->bits - is_signed(entry))) - 1;
    const bool given = (entry->access & CM1E_ACCESS_WRITE) && (entry->minimum > least || entry->maximum < most);
    TEST_ASSERT_EQUAL_MESSAGE(given, described->minimum.data != NULL, at);
    TEST_ASSERT_EQUAL_MESSAGE(given, described->maximum.data != NULL, at);
    if (!given)
        return false;
    const int64_t minimum = entry->minimum / divisor, maximum = entry->maximum / divisor;
    char comment[80];
    snprintf(comment, sizeof comment, "%" PRId64 " ... %" PRId64, minimum, maximum);
    if (entry->round_to > 1)
        snprintf(comment + strlen(comment), sizeof comment - strlen(comment), ", rounded to %" PRIu32, entry->round_to);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(minimum, number_of(entry, described->minimum), at);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(maximum, number_of(entry, described->maximum), at);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(entry->index < 0x2000 ? NULL : comment, described->comment, at);
    return true;
}

/* Of the motor's own parameters the guides give no values, except where they give a range. */
static bool is_motor_parameter(uint16_t index, uint8_t subindex)
{
    return subindex > 0 && ((index & 0x67FF) == 0x60F6 || (index & 0x67FF) == 0x60FB);
}

static void check_number(const cm1e_entry_t *entry, int64_t value, cm1e_bytes_t bytes, const char *at)
{
    TEST_ASSERT_EQUAL_MESSAGE((entry->bits + 7) / 8, bytes.size, at);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(value, number_of(entry, bytes), at);
}

typedef struct init_row {
    uint16_t index;
    uint8_t subindex, bytes;
    uint32_t value;
} init_row_t;

static void check_init_commands(const init_row_t *rows, size_t count, const cm1e_init_command_list_t *commands)
{
    TEST_ASSERT_EQUAL(count, commands->count);
    for (size_t i = 0; i < count; i++) {
        const cm1e_init_command_t *command = &commands->at[i];
        const char *at = where("start-up command %u", (unsigned)i);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(rows[i].index, command->index, at);
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].subindex, command->subindex, at);
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].bytes, command->data.size, at);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(rows[i].value, cm1e_bytes_unsigned(command->data), at);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(CM1E_TRANSITION_PS, command->transitions, at);
        /* The user's choice of PDOs takes the place of ours. */
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].index < 0x6000, command->adapts, at);
        TEST_ASSERT_FALSE_MESSAGE(command->fixed || command->complete_access, at);
        TEST_ASSERT_NOT_NULL_MESSAGE(command->comment, at);
    }
}

static void check_sync_managers(const cm1e_description_t *device, unsigned outputs, unsigned inputs)
{
    const struct {
        unsigned use, start, length, control;
    } rows[] = {{CM1E_SM_MAILBOX_OUT, 0x1000, 128, 0x26}, {CM1E_SM_MAILBOX_IN, 0x1080, 128, 0x22},
                {CM1E_SM_OUTPUTS, 0x1100, outputs, 0x64}, {CM1E_SM_INPUTS, 0x1400, inputs, 0x20}};
    TEST_ASSERT_EQUAL(4, device->sync_managers.count);
    for (size_t i = 0; i < 4; i++) {
        const cm1e_described_sync_manager_t *manager = &device->sync_managers.at[i];
        const char *at = where("sync manager %u", (unsigned)i);
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].use, manager->use, at);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(rows[i].start, manager->start, at);
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].length, manager->length, at);
        TEST_ASSERT_TRUE_MESSAGE(manager->length_given, at);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(rows[i].control, manager->control, at);
        TEST_ASSERT_EQUAL_MESSAGE(1, manager->enable, at);
    }
    TEST_ASSERT_EQUAL(3, device->fmmus.count);
    TEST_ASSERT_EQUAL(CM1E_FMMU_OUTPUTS, device->fmmus.at[0].use);
    TEST_ASSERT_EQUAL(CM1E_FMMU_INPUTS, device->fmmus.at[1].use);
    TEST_ASSERT_EQUAL(CM1E_FMMU_MAILBOX_STATE, device->fmmus.at[2].use);
}

static void check_refused(const cm1e_device_options_t *options, const char *text)
{
    cm1e_description_file_t file = {0};
    cm1e_diag_t diag = {0};
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_CONFIG, cm1e_describe(&file, options, CM1E_ESI_FLAT, &diag), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, text), diag.text);
    TEST_ASSERT_EQUAL(0, file.devices.count);
    cm1e_description_file_free(&file);
}

/* Memory ends sooner and sooner while the device is described: at last at once. */
static void check_memory_ends(const cm1e_device_options_t *options)
{
    enum { STEP = 16384 }; /* the arena's block */
    for (int layout = 0; layout < 2; layout++)
        for (int blocks = 0;; blocks++) {
            cm1e_description_file_t file = {.arena = {.used = CM1E_ARENA_LIMIT - (size_t)blocks * STEP}};
            cm1e_diag_t diag = {0};
            const cm1e_error_t error = cm1e_describe(&file, options, (cm1e_esi_layout_t)layout, &diag);
            cm1e_description_file_free(&file);
            if (error == CM1E_OK) {
                TEST_ASSERT_GREATER_THAN(2, blocks);
                break;
            }
            TEST_ASSERT_EQUAL(CM1E_ERROR_NO_MEMORY, error);
        }
}

#endif
