/* Options of a program that was compiled with fewer or more members than the library. */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/generate.h"
#include "unity.h"

static cm1e_file_t expected, file;
static cm1e_diag_t diag;

void setUp(void) {}
void tearDown(void)
{
    cm1e_file_free(&expected);
    cm1e_file_free(&file);
}

/* An older program ends before these members. What lies behind its structs is not its own. */
enum {
    OLD_SIZE = offsetof(cm1e_generate_options_t, mailbox_rate),
    OLD_DEVICE_SIZE = offsetof(cm1e_device_options_t, config_data),
    NEW_DEVICE_SIZE = sizeof(cm1e_device_options_t) + 24,
};

static const cm1e_device_options_t devices[2] = {
    {.model = CM1E_DEVICE_CM1E, .firmware = "1.2.0"},
    {.model = CM1E_DEVICE_CM1E, .firmware = "1.3.5", .complete_access = true},
};

/* The devices as a program with another size of them has them: one behind the other, and what is unknown is not zero. */
static void *devices_of_size(size_t size)
{
    unsigned char *bytes = malloc(2 * size);
    memset(bytes, 0x5A, 2 * size);
    for (size_t i = 0; i < 2; i++)
        memcpy(bytes + i * size, &devices[i], size < sizeof devices[i] ? size : sizeof devices[i]);
    return bytes;
}

static void expect_same(void)
{
    TEST_ASSERT_EQUAL(expected.size, file.size);
    TEST_ASSERT_EQUAL_MEMORY(expected.bytes, file.bytes, file.size);
}

static void generate_both(cm1e_file_format_t format, size_t device_size)
{
    const cm1e_generate_options_t options = {.format = format, .devices = devices, .device_count = 2};
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_generate(&expected, &options, &diag), diag.text);
    void *others = devices_of_size(device_size);
    unsigned char bytes[sizeof options];
    cm1e_generate_options_t other = options;
    other.devices = others;
    memset(bytes, 0x5A, sizeof bytes);
    memcpy(bytes, &other, OLD_SIZE);
    memcpy(&other, bytes, sizeof other);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_generate_sized(&file, &other, OLD_SIZE, device_size, &diag), diag.text);
    free(others);
    expect_same();
}

static void test_an_older_program_gets_defaults_for_what_it_does_not_know(void)
{
    generate_both(CM1E_FILE_ESI, OLD_DEVICE_SIZE);
    tearDown();
    generate_both(CM1E_FILE_EC_EXTEND, OLD_DEVICE_SIZE);
}

static void test_a_newer_program_has_members_that_the_library_does_not_know(void)
{
    generate_both(CM1E_FILE_ESI, NEW_DEVICE_SIZE);
}

static void test_a_program_for_a_trio_controller_takes_the_same_options(void)
{
    const cm1e_generate_options_t options = {.devices = devices, .device_count = 1};
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_generate_trio_program(&expected, &options, &diag), diag.text);
    cm1e_generate_options_t other = options;
    void *others = devices_of_size(OLD_DEVICE_SIZE);
    other.devices = others;
    other.mailbox_rate = 0x5A5A;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_generate_trio_program_sized(&file, &other, OLD_SIZE, OLD_DEVICE_SIZE, &diag));
    free(others);
    expect_same();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_older_program_gets_defaults_for_what_it_does_not_know);
    RUN_TEST(test_a_newer_program_has_members_that_the_library_does_not_know);
    RUN_TEST(test_a_program_for_a_trio_controller_takes_the_same_options);
    return UNITY_END();
}
