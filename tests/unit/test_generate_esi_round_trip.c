/* An ESI that is written, read and written again is the same in every byte; a file of somebody else is after the first
 * time, and valid. */
#include "esi_judge.h"
#include "golden.h"

static void read_back(const cm1e_file_t *written)
{
    cm1e_description_file_free(&description);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_esi_read(&description, written->bytes, written->size, &diag), diag.text);
}

static void check_comes_back(void)
{
    cm1e_file_t first = file;
    file = (cm1e_file_t){0};
    read_back(&first);
    write_file();
    const unsigned line = golden_differing_line((char *)first.bytes, first.size, (char *)file.bytes, file.size);
    cm1e_file_free(&first);
    char message[80];
    snprintf(message, sizeof message, "read and written again the file is another one from line %u on", line);
    TEST_ASSERT_TRUE_MESSAGE(line == 0, message);
}

static void check_device(cm1e_device_options_t options)
{
    for (int choice = 0; choice < 4; choice++) {
        options.distributed_clocks = options.complete_access = choice & 1;
        options.config_data_size = choice & 1 ? 14 : 0;
        options.config_data[3] = 0xC8;
        cm1e_description_file_free(&description);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&description, &options, (cm1e_esi_layout_t)(choice >> 1), &diag));
        write_file();
        check_comes_back();
    }
}

static void test_every_cm1e_comes_back(void)
{
    for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++)
        for (int mapping = 0; mapping < 4; mapping++)
            for (int order = 0; order < 2; order++) {
                cm1e_device_options_t options = {.mapping = (cm1e_mapping_t)mapping, .order = (cm1e_pdo_order_t)order};
                strcpy(options.firmware, cm1e_firmware_info((cm1e_firmware_t)firmware)->version);
                check_device(options);
            }
}

static void test_every_bridge_comes_back(void)
{
    for (int model = CM1E_DEVICE_EB01; model <= CM1E_DEVICE_EB12; model++)
        for (uint32_t axes = 1; axes <= 4; axes++)
            check_device((cm1e_device_options_t){.model = (cm1e_device_model_t)model, .axes = axes,
                                                 .vendor_id = 0xAA77, .product_code = 1, .revision = 2});
}

static void test_several_devices_and_a_comment_come_back(void)
{
    for (int i = 0; i < 3; i++) {
        const cm1e_device_options_t options = {.mapping = (cm1e_mapping_t)i};
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&description, &options, CM1E_ESI_MDP, &diag));
    }
    description.comment = "made for -- a test";
    write_file();
    check_comes_back();
    TEST_ASSERT_EQUAL_STRING("made for - - a test", description.comment);
    TEST_ASSERT_EQUAL_INT(3, description.devices.count);
}

/* NULL: there is no such file. */
static char *load(const char *path, size_t *size)
{
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return NULL;
    fseek(stream, 0, SEEK_END);
    *size = (size_t)ftell(stream);
    rewind(stream);
    char *bytes = malloc(*size + 1);
    TEST_ASSERT_EQUAL(*size, fread(bytes, 1, *size, stream));
    fclose(stream);
    return bytes;
}

static void check_file_of_somebody_else(const char *bytes, size_t size)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_esi_read(&description, bytes, size, &diag), diag.text);
    write_file();
    if (schema)
        TEST_ASSERT_EQUAL_STRING("", schema_error());
    check_comes_back();
}

static void test_the_two_axis_device_of_the_sample_code_comes_back(void)
{
    const char *folder = getenv("CM1E_ESI_SCHEMAS");
    char path[512];
    snprintf(path, sizeof path, "%s/../reference/ssc-cia402-two-axis-esi.xml",
             folder ? folder : CM1E_SOURCE_DIR "/../shared/schemas");
    size_t size;
    char *bytes = load(path, &size);
    if (!bytes)
        TEST_IGNORE_MESSAGE("no ../reference/ssc-cia402-two-axis-esi.xml beside the folder of ETG's schemas");
    check_file_of_somebody_else(bytes, size);
    free(bytes);
    TEST_ASSERT_EQUAL_STRING("DT607DARR", text(MODULE "[1]/Profile/Dictionary/DataTypes/DataType[ArrayInfo]/Name"));
    TEST_ASSERT_EQUAL_STRING("800C8166000000001234", text(DEVICE "/Eeprom/ConfigData"));
}

static void test_a_file_with_every_element_comes_back(void)
{
    size_t size;
    char *bytes = load(CM1E_SOURCE_DIR "/tests/fuzz/seeds/esi/every_element.xml", &size);
    TEST_ASSERT_NOT_NULL(bytes);
    check_file_of_somebody_else(bytes, size);
    free(bytes);
}

int main(void)
{
    load_schema();
    UNITY_BEGIN();
    RUN_TEST(test_every_cm1e_comes_back);
    RUN_TEST(test_every_bridge_comes_back);
    RUN_TEST(test_several_devices_and_a_comment_come_back);
    RUN_TEST(test_the_two_axis_device_of_the_sample_code_comes_back);
    RUN_TEST(test_a_file_with_every_element_comes_back);
    const int failures = UNITY_END();
    free_schema();
    return failures;
}
