/* SII images as files: out of the tables, out of an ESI of either layout, out of another image. */
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "description/sii_image.h"
#include "unity.h"

static cm1e_file_t esi, sii, again;
static cm1e_description_file_t content;
static cm1e_diag_t diag;

void setUp(void) { diag = (cm1e_diag_t){0}; }
void tearDown(void)
{
    cm1e_file_free(&esi);
    cm1e_file_free(&sii);
    cm1e_file_free(&again);
    cm1e_description_file_free(&content);
}

static void generate(cm1e_file_t *file, cm1e_file_format_t format, cm1e_esi_layout_t layout,
                     const cm1e_device_options_t *device)
{
    const cm1e_generate_options_t options = {
        .format = format, .layout = layout, .devices = device, .device_count = 1};
    cm1e_file_free(file);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_generate(file, &options, &diag), diag.text);
}

static void convert(cm1e_file_t *to, const cm1e_file_t *from, cm1e_file_format_t format)
{
    cm1e_file_free(to);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_generate_from(to, from->bytes, from->size, format, 0, &diag),
                                  diag.text);
}

static const cm1e_description_t *read(const cm1e_file_t *file)
{
    cm1e_description_file_free(&content);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sii_read(&content, file->bytes, file->size, NULL, &diag));
    return &content.devices.at[0];
}

static void expect_same_bytes(const cm1e_file_t *left, const cm1e_file_t *right)
{
    TEST_ASSERT_EQUAL_size_t(left->size, right->size);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(left->bytes, right->bytes, left->size);
}

static void test_image_is_the_same_by_way_of_an_esi(void)
{
    for (int choice = 0; choice < 32; choice++) {
        const cm1e_device_options_t device = {
            .firmware = "1.3.4", .mapping = (cm1e_mapping_t)(choice & 3), .order = (cm1e_pdo_order_t)(choice >> 2 & 1),
            .distributed_clocks = choice & 8, .complete_access = choice & 16, .config_data_size = 14,
            .config_data = {0x80, 0x0E, 0x00, 0xCC, 0x88, 0x13}};
        generate(&sii, CM1E_FILE_SII, CM1E_ESI_FLAT, &device);
        generate(&esi, CM1E_FILE_ESI, CM1E_ESI_FLAT, &device);
        convert(&again, &esi, CM1E_FILE_SII);
        expect_same_bytes(&sii, &again);
        TEST_ASSERT_EQUAL_STRING("", again.warning);
        convert(&again, &sii, CM1E_FILE_SII);
        expect_same_bytes(&sii, &again);
    }
}

/* The flag of the category General (ETG.2010) is the attribute UseLrdLwr of the Type (ETG.2000). */
static void test_a_device_without_lrw_stays_one(void)
{
    const cm1e_device_options_t device = {0};
    generate(&esi, CM1E_FILE_ESI, CM1E_ESI_FLAT, &device);
    TEST_ASSERT_NULL(strstr((const char *)esi.bytes, "UseLrdLwr"));
    convert(&sii, &esi, CM1E_FILE_SII);
    TEST_ASSERT_FALSE(read(&sii)->no_lrw);
    const size_t before = (size_t)(strstr((const char *)esi.bytes, " RevisionNo=") - (const char *)esi.bytes);
    static const char attribute[] = " UseLrdLwr=\"true\"";
    cm1e_file_t changed = {.bytes = malloc(esi.size + sizeof attribute), .size = esi.size + sizeof attribute - 1};
    TEST_ASSERT_NOT_NULL(changed.bytes);
    memcpy(changed.bytes, esi.bytes, before);
    memcpy(changed.bytes + before, attribute, sizeof attribute - 1);
    memcpy(changed.bytes + before + sizeof attribute - 1, esi.bytes + before, esi.size - before + 1);
    convert(&sii, &changed, CM1E_FILE_SII);
    cm1e_file_free(&changed);
    TEST_ASSERT_TRUE(read(&sii)->no_lrw);
    convert(&esi, &sii, CM1E_FILE_ESI);
    TEST_ASSERT_NOT_NULL(strstr((const char *)esi.bytes, "UseLrdLwr=\"1\""));
    convert(&again, &esi, CM1E_FILE_SII);
    expect_same_bytes(&sii, &again);
}

static void test_layout_is_an_affair_of_the_esi(void)
{
    const cm1e_device_options_t device = {.mapping = CM1E_MAPPING_CSV};
    generate(&sii, CM1E_FILE_SII, CM1E_ESI_FLAT, &device);
    generate(&again, CM1E_FILE_SII, CM1E_ESI_MDP, &device);
    expect_same_bytes(&sii, &again);
}

/* Of a modular device the modules that stand in its slots when nobody chooses. */
static void test_image_of_a_modular_esi_has_the_default_modules(void)
{
    static const cm1e_device_options_t devices[] = {
        {.mapping = CM1E_MAPPING_CSP},
        {.model = CM1E_DEVICE_EB01, .vendor_id = 0xAA77, .product_code = 1, .revision = 1},
    };
    static const struct {
        size_t pdos;
        uint16_t last; /* TxPDO */
        uint32_t bytes[2];
    } expected[] = {{2, 0x1A01, {8, 16}}, {8, 0x1A31, {24, 24}}};
    for (size_t i = 0; i < sizeof devices / sizeof devices[0]; i++) {
        generate(&esi, CM1E_FILE_ESI, CM1E_ESI_MDP, &devices[i]);
        convert(&sii, &esi, CM1E_FILE_SII);
        const cm1e_description_t *device = read(&sii);
        TEST_ASSERT_EQUAL_size_t(expected[i].pdos, device->pdos.count);
        TEST_ASSERT_NOT_NULL(cm1e_description_pdo(device, expected[i].last));
        for (unsigned n = 0; n < 2; n++) {
            TEST_ASSERT_EQUAL_UINT32(expected[i].bytes[n], cm1e_description_process_bytes(device, 2 + n));
            TEST_ASSERT_EQUAL_UINT16(expected[i].bytes[n], device->sync_managers.at[2 + n].length);
        }
    }
}

/* A wrong one can make a device unreachable. */
static void test_an_image_with_guessed_configuration_words_says_so(void)
{
    const cm1e_device_options_t device = {0};
    generate(&sii, CM1E_FILE_SII, CM1E_ESI_FLAT, &device);
    TEST_ASSERT_NOT_NULL(strstr(sii.warning, "do not write an EEPROM"));
    generate(&esi, CM1E_FILE_ESI, CM1E_ESI_FLAT, &device);
    convert(&sii, &esi, CM1E_FILE_SII);
    TEST_ASSERT_NOT_NULL(strstr(sii.warning, "do not write an EEPROM"));
}

static void test_the_file_is_as_long_as_the_eeprom_that_the_image_states(void)
{
    generate(&sii, CM1E_FILE_SII, CM1E_ESI_FLAT, &(cm1e_device_options_t){.config_data_size = 14});
    cm1e_put_u16(sii.bytes + 0x7C, 1); /* 256 bytes, too few */
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, cm1e_generate_from(&again, sii.bytes, sii.size, CM1E_FILE_SII, 0, NULL));
    TEST_ASSERT_NULL(again.bytes);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, cm1e_generate_from(&again, sii.bytes, sii.size, CM1E_FILE_SII, 0, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "its EEPROM has 256"), diag.text);
    cm1e_put_u16(sii.bytes + 0x7C, 0xFFFF); /* 8 MiB */
    convert(&again, &sii, CM1E_FILE_SII);
    TEST_ASSERT_EQUAL_size_t(CM1E_SII_SIZE_MAX, again.size);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_image_is_the_same_by_way_of_an_esi);
    RUN_TEST(test_a_device_without_lrw_stays_one);
    RUN_TEST(test_layout_is_an_affair_of_the_esi);
    RUN_TEST(test_image_of_a_modular_esi_has_the_default_modules);
    RUN_TEST(test_an_image_with_guessed_configuration_words_says_so);
    RUN_TEST(test_the_file_is_as_long_as_the_eeprom_that_the_image_states);
    return UNITY_END();
}
