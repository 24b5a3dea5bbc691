/* The cross-checker has nothing to say about our own devices: every firmware, mapping, order and layout, and every
 * model of the bridge. */
#include <stdio.h>
#include <string.h>

#include "description/check.h"
#include "description/describe.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static void assert_nothing_found(const cm1e_device_options_t *options, cm1e_esi_layout_t layout)
{
    cm1e_description_file_t file = {0};
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_diag_t diag;
    char text[1200];
    const cm1e_error_t error = cm1e_describe(&file, options, layout, &diag);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, error, diag.text);
    cm1e_check_description(findings, &file);
    TEST_ASSERT_FALSE(findings->arena.failed);
    if (cm1e_findings_count(findings) > 0) {
        const cm1e_finding_t *first = cm1e_findings_at(findings, 0);
        snprintf(text, sizeof text,
                 "model %d, firmware %s, mapping %d, order %d, layout %d: %zu findings, first %s: %s",
                 (int)options->model, options->firmware, (int)options->mapping, (int)options->order, (int)layout,
                 cm1e_findings_count(findings), first->rule, first->text);
        TEST_FAIL_MESSAGE(text);
    }
    cm1e_findings_free(findings);
    cm1e_description_file_free(&file);
}

static void test_every_cm1e_is_right(void)
{
    for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++)
        for (int mapping = 0; mapping < 4; mapping++)
            for (int choice = 0; choice < 16; choice++) {
                cm1e_device_options_t options = {.mapping = (cm1e_mapping_t)mapping,
                                                 .order = choice & 1 ? CM1E_PDO_ORDER_UG_7_2 : CM1E_PDO_ORDER_UG_4_4,
                                                 .distributed_clocks = choice & 2,
                                                 .complete_access = choice & 4};
                snprintf(options.firmware, sizeof options.firmware, "%s",
                         cm1e_firmware_info((cm1e_firmware_t)firmware)->version);
                assert_nothing_found(&options, choice & 8 ? CM1E_ESI_MDP : CM1E_ESI_FLAT);
            }
}

static void test_every_bridge_is_right(void)
{
    for (int model = CM1E_DEVICE_EB01; model <= CM1E_DEVICE_EB12; model++)
        for (uint32_t axes = 1; axes <= 4; axes++)
            for (int layout = CM1E_ESI_FLAT; layout <= CM1E_ESI_MDP; layout++) {
                const cm1e_device_options_t options = {.model = (cm1e_device_model_t)model, .axes = axes,
                                                       .vendor_id = 0xAA77, .product_code = 1, .revision = 1};
                assert_nothing_found(&options, (cm1e_esi_layout_t)layout);
            }
}

static void test_the_simple_devices_are_right(void)
{
    cm1e_description_file_t file = {0};
    cm1e_findings_t *findings = cm1e_findings_create();
    for (int kind = CM1E_SIM_IO_MODULE; kind <= CM1E_SIM_IO_COUPLER; kind++)
        cm1e_describe_io(&file, (cm1e_sim_io_t)kind);
    cm1e_check_description(findings, &file);
    TEST_ASSERT_EQUAL(0, cm1e_findings_count(findings));
    cm1e_findings_free(findings);
    cm1e_description_file_free(&file);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_cm1e_is_right);
    RUN_TEST(test_every_bridge_is_right);
    RUN_TEST(test_the_simple_devices_are_right);
    return UNITY_END();
}
