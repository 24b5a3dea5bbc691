#include "described.h"
#include "device/bridge_facts.h"

static cm1e_description_file_t file;
static cm1e_diag_t diag;

void setUp(void) { file = (cm1e_description_file_t){0}; }
void tearDown(void) { cm1e_description_file_free(&file); }

static cm1e_device_options_t options_of(cm1e_device_model_t model, unsigned axes)
{
    return (cm1e_device_options_t){.model = model, .axes = axes, .vendor_id = 0xAA77, .product_code = 0x12345678,
                                   .revision = 0x00010002, .serial_number = 99};
}

typedef struct variant {
    cm1e_device_model_t model;
    unsigned axes; /* as in the options */
    cm1e_esi_layout_t layout;
} variant_t;

static unsigned axes_of(const variant_t *variant) { return variant->axes ? variant->axes : 4; }

static void each_variant(void (*check)(const variant_t *variant, const cm1e_description_t *device))
{
    for (int model = CM1E_DEVICE_EB01; model <= CM1E_DEVICE_EB12; model++)
        for (unsigned axes = 0; axes <= 4; axes++)
            for (int layout = 0; layout < 2; layout++) {
                const variant_t variant = {(cm1e_device_model_t)model, axes, (cm1e_esi_layout_t)layout};
                const cm1e_device_options_t options = options_of(variant.model, axes);
                TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&file, &options, variant.layout, &diag));
                TEST_ASSERT_EQUAL(1, file.devices.count);
                check(&variant, &file.devices.at[0]);
                cm1e_description_file_free(&file);
            }
}

/* ---- identity --------------------------------------------------------------------------------------------------- */

static void check_identity(const variant_t *variant, const cm1e_description_t *device)
{
    TEST_ASSERT_EQUAL_HEX32(0xAA77, device->vendor_id);
    TEST_ASSERT_EQUAL_STRING("Muscle Corporation", device->vendor_name);
    TEST_ASSERT_EQUAL_HEX32(0x12345678, device->product_code);
    TEST_ASSERT_EQUAL_HEX32(0x00010002, device->revision);
    TEST_ASSERT_TRUE(device->product_given && device->revision_given);
    TEST_ASSERT_EQUAL_STRING(cm1e_bridge_name(variant->model), device->type);
    TEST_ASSERT_NOT_NULL(strstr(device->name, device->type));
    TEST_ASSERT_FALSE(device->identification_reg134_given);
    TEST_ASSERT_EQUAL(axes_of(variant), device->channels.count);
    for (size_t i = 0; i < device->channels.count; i++) {
        TEST_ASSERT_EQUAL(402, device->channels.at[i].profile_no);
        TEST_ASSERT_EQUAL(4, device->channels.at[i].add_info);
    }
}

static void test_identity_is_that_of_the_options(void) { each_variant(check_identity); }

static void test_motors_are_named(void)
{
    const cm1e_device_options_t options = options_of(CM1E_DEVICE_EB12, 3);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&file, &options, CM1E_ESI_FLAT, &diag));
    TEST_ASSERT_EQUAL_STRING("Motors CM1 on ID1, CM1 on ID2, CM2 on ID3", file.devices.at[0].comment);
}

static void test_a_bridge_of_myostat_is_myostats(void)
{
    cm1e_device_options_t options = options_of(CM1E_DEVICE_EB01, 0);
    options.vendor_id = 0x4441;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&file, &options, CM1E_ESI_FLAT, &diag));
    TEST_ASSERT_EQUAL_STRING("Myostat Motion Control Inc.", file.devices.at[0].vendor_name);
}

/* ---- dictionary ------------------------------------------------------------------------------------------------- */

/* What the options decide; -1: the tables do. */
static int64_t adapted(const variant_t *variant, unsigned index, unsigned subindex)
{
    const unsigned axes = axes_of(variant);
    switch (index << 8 | subindex) {
    case 0x101801: return 0xAA77;
    case 0x101802: return 0x12345678;
    case 0x101803: return 0x00010002;
    case 0x101804: return 99;
    case 0x1C1200: case 0x1C1300: return axes;
    default: break;
    }
    if (index == 0x1C12 || index == 0x1C13)
        return subindex > axes ? 0 : (index == 0x1C12 ? 0x1601 : 0x1A01) + 0x10 * ((int64_t)subindex - 1);
    return -1;
}

static const char *comment_of(const cm1e_entry_t *entry)
{
    switch (entry->availability) {
    case CM1E_AVAILABLE: return NULL;
    case CM1E_NOT_AVAILABLE: return "N/A: access is answered with an abort";
    default: return "The motor has no such parameter: access is answered with an abort";
    }
}

static void check_entry(const variant_t *variant, const cm1e_entry_t *entry, const cm1e_described_entry_t *described)
{
    const char *at = where("%s %04X:%02X", cm1e_bridge_name(variant->model), entry->index, entry->subindex);
    const int64_t value = adapted(variant, entry->index, entry->subindex);
    TEST_ASSERT_EQUAL_MESSAGE(entry->subindex, described->subindex, at);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(entry->name, described->name, at);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(entry->unit, described->unit, at);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(entry->access, described->access, at);
    check_type(entry, described, at);
    if (entry->type != CM1E_TYPE_STRING) {
        const bool has_range = check_range(entry, 1, described, at);
        if (!has_range)
            TEST_ASSERT_EQUAL_STRING_MESSAGE(comment_of(entry), described->comment, at);
        if (!has_range && is_motor_parameter(entry->index, entry->subindex))
            TEST_ASSERT_NULL_MESSAGE(described->default_data.data, at);
        else
            check_number(entry, value < 0 ? entry->default_value : value, described->default_data, at);
        return;
    }
    TEST_ASSERT_EQUAL_STRING_MESSAGE(comment_of(entry), described->comment, at);
    /* Texts that the guide does not state have no default. */
    const size_t length = strlen(entry->default_string);
    TEST_ASSERT_EQUAL_MESSAGE(length, described->default_data.size, at);
    if (length > 0)
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(entry->default_string, described->default_data.data, length, at);
}

static void check_dictionary(const variant_t *variant, const cm1e_description_t *device)
{
    const cm1e_object_t *object;
    size_t described_count = 0;
    for (size_t n = 0; (object = cm1e_bridge_object(variant->model, n)) != NULL; n++) {
        const bool of_axis = object->index >= 0x6000 && object->index < 0xF000;
        const cm1e_described_object_t *described = object_in(&device->objects, object->index);
        if (cm1e_bridge_axis_of(object->index) >= (int)axes_of(variant) || (of_axis && variant->layout)) {
            TEST_ASSERT_NULL_MESSAGE(described, where("%04X", object->index));
            continue;
        }
        described_count++;
        TEST_ASSERT_NOT_NULL_MESSAGE(described, where("%04X", object->index));
        TEST_ASSERT_EQUAL_STRING(object->name, described->name);
        TEST_ASSERT_EQUAL(object->object_code, described->code);
        TEST_ASSERT_FALSE(described->depends_on_slot);
        TEST_ASSERT_EQUAL(object->entry_count, described->entries.count);
        for (unsigned i = 0; i < object->entry_count; i++)
            check_entry(variant, &object->entries[i], &described->entries.at[i]);
    }
    TEST_ASSERT_EQUAL(described_count, device->objects.count);
}

static void test_dictionary_is_that_of_the_tables_in_every_variant(void) { each_variant(check_dictionary); }

/* ---- process data ----------------------------------------------------------------------------------------------- */

static void check_pdo(const cm1e_described_pdo_t *pdo, unsigned axis, bool transmit, bool in_module)
{
    const unsigned objects[2][2] = {{0x6040, 0x607A}, {0x6041, 0x6064}}; /* BR 6.3.3 */
    static const char *const types[2][2] = {{"UINT", "DINT"}, {"UINT", "DINT"}};
    TEST_ASSERT_EQUAL_HEX16((transmit ? 0x1A01 : 0x1601) + 0x10 * axis, pdo->index);
    TEST_ASSERT_EQUAL(transmit, pdo->transmit);
    TEST_ASSERT_EQUAL(transmit ? 3 : 2, pdo->sync_manager);
    TEST_ASSERT_TRUE(pdo->fixed);
    TEST_ASSERT_EQUAL(0, pdo->excludes.count);
    TEST_ASSERT_EQUAL(in_module, pdo->depends_on_slot);
    TEST_ASSERT_EQUAL(2, pdo->entries.count);
    for (unsigned e = 0; e < 2; e++) {
        const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[e];
        TEST_ASSERT_EQUAL_HEX16(objects[transmit][e] + 0x800 * axis, entry->index);
        TEST_ASSERT_EQUAL(0, entry->subindex);
        TEST_ASSERT_EQUAL(e == 0 ? 16 : 32, entry->bits);
        TEST_ASSERT_EQUAL_STRING(types[transmit][e], entry->type);
        TEST_ASSERT_EQUAL_STRING(cm1e_bridge_entry(CM1E_DEVICE_EB01, entry->index, 0)->name, entry->name);
        TEST_ASSERT_EQUAL(in_module, entry->depends_on_slot);
    }
}

static void check_process_data(const variant_t *variant, const cm1e_description_t *device)
{
    const unsigned axes = axes_of(variant);
    check_sync_managers(device, 6 * axes, 6 * axes); /* BR 6.3.1: 24 bytes with four */
    if (variant->layout == CM1E_ESI_MDP) {
        TEST_ASSERT_EQUAL(0, device->pdos.count);
        TEST_ASSERT_EQUAL(2, file.modules.at[0].pdos.count);
        check_pdo(&file.modules.at[0].pdos.at[0], 0, false, true);
        check_pdo(&file.modules.at[0].pdos.at[1], 0, true, true);
        return;
    }
    TEST_ASSERT_EQUAL(2 * axes, device->pdos.count);
    for (unsigned axis = 0; axis < axes; axis++) {
        check_pdo(&device->pdos.at[axis], axis, false, false);
        check_pdo(&device->pdos.at[axes + axis], axis, true, false);
    }
}

static void test_process_data_are_those_of_the_guide_in_every_variant(void) { each_variant(check_process_data); }

/* ---- start-up commands ------------------------------------------------------------------------------------------ */

static void check_start(const variant_t *variant, const cm1e_description_t *device)
{
    const unsigned axes = axes_of(variant);
    init_row_t rows[16];
    size_t count = 0;
    rows[count++] = (init_row_t){0x1C12, 0, 1, 0};
    rows[count++] = (init_row_t){0x1C13, 0, 1, 0};
    for (unsigned axis = 0; axis < axes; axis++)
        rows[count++] = (init_row_t){0x1C12, (uint8_t)(axis + 1), 2, 0x1601 + 0x10 * axis};
    rows[count++] = (init_row_t){0x1C12, 0, 1, axes};
    for (unsigned axis = 0; axis < axes; axis++)
        rows[count++] = (init_row_t){0x1C13, (uint8_t)(axis + 1), 2, 0x1A01 + 0x10 * axis};
    rows[count++] = (init_row_t){0x1C13, 0, 1, axes};
    if (variant->layout == CM1E_ESI_MDP) {
        const init_row_t mode = {0x6060, 0, 1, 8};
        check_init_commands(&mode, 1, &file.modules.at[0].init_commands);
        TEST_ASSERT_TRUE(file.modules.at[0].init_commands.at[0].depends_on_slot);
    }
    for (unsigned axis = 0; axis < axes && variant->layout == CM1E_ESI_FLAT; axis++)
        rows[count++] = (init_row_t){(uint16_t)(0x6060 + 0x800 * axis), 0, 1, 8};
    check_init_commands(rows, count, &device->init_commands);
    for (size_t i = 0; i < count; i++)
        TEST_ASSERT_FALSE(device->init_commands.at[i].depends_on_slot);
}

static void test_start_up_assigns_all_axes_and_chooses_csp(void) { each_variant(check_start); }

/* ---- modules ---------------------------------------------------------------------------------------------------- */

static void check_slots(const variant_t *variant, const cm1e_description_t *device)
{
    if (variant->layout == CM1E_ESI_FLAT) {
        TEST_ASSERT_EQUAL(0, device->slots.count);
        TEST_ASSERT_EQUAL(0, file.modules.count);
        return;
    }
    TEST_ASSERT_EQUAL_HEX16(0x800, device->slot_index_increment);
    TEST_ASSERT_EQUAL_HEX16(0x10, device->slot_pdo_increment);
    TEST_ASSERT_EQUAL(axes_of(variant), device->slots.count);
    TEST_ASSERT_EQUAL(1, file.modules.count);
    TEST_ASSERT_EQUAL_HEX32(0x219800, file.modules.at[0].ident);
    TEST_ASSERT_EQUAL(402, file.modules.at[0].profile_no);
    TEST_ASSERT_EQUAL(4, file.modules.at[0].profile_info);
    for (size_t i = 0; i < device->slots.count; i++) {
        const cm1e_slot_t *slot = &device->slots.at[i];
        TEST_ASSERT_EQUAL_STRING(where("Axis ID%u", (unsigned)i + 1), slot->name);
        TEST_ASSERT_EQUAL(1, slot->minimum_instances);
        TEST_ASSERT_EQUAL(1, slot->maximum_instances);
        TEST_ASSERT_EQUAL(1, slot->choices.count);
        TEST_ASSERT_TRUE(slot->choices.at[0].is_default);
        /* what the bridge says of itself (BR appendix 6) */
        const int64_t ident = cm1e_bridge_entry(variant->model, 0xF050, (uint8_t)(i + 1))->default_value;
        TEST_ASSERT_EQUAL_HEX32(ident, slot->choices.at[0].ident);
        TEST_ASSERT_NOT_NULL(module_of(&file, slot->choices.at[0].ident));
    }
}

static void test_a_slot_for_each_axis_with_the_module_that_the_bridge_reports(void) { each_variant(check_slots); }

/* What differs between a CM1 and a CM2 is a comment. */
static void test_the_module_holds_for_both_motors(void)
{
    size_t count;
    const cm1e_object_t *cm1 = cm1e_bridge_axis_objects(CM1E_BRIDGE_CM1, 0, &count);
    const cm1e_object_t *cm2 = cm1e_bridge_axis_objects(CM1E_BRIDGE_CM2, 0, &count);
    const cm1e_device_options_t options = options_of(CM1E_DEVICE_EB12, 0);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&file, &options, CM1E_ESI_MDP, &diag));
    const cm1e_object_list_t *objects = &file.modules.at[0].objects;
    TEST_ASSERT_EQUAL(count, objects->count);
    for (size_t i = 0; i < count; i++) {
        const cm1e_described_object_t *object = object_in(objects, cm1[i].index);
        TEST_ASSERT_TRUE(object->depends_on_slot);
        TEST_ASSERT_EQUAL(cm1[i].entry_count, object->entries.count);
        for (unsigned j = 0; j < cm1[i].entry_count; j++) {
            const cm1e_entry_t *a = &cm1[i].entries[j], *b = &cm2[i].entries[j];
            const cm1e_described_entry_t *entry = &object->entries.at[j];
            const char *at = where("%04X:%02X", a->index, a->subindex);
            const bool range = a->minimum == b->minimum && a->maximum == b->maximum && strcmp(a->unit, b->unit) == 0;
            TEST_ASSERT_EQUAL_STRING_MESSAGE(a->name, entry->name, at);
            TEST_ASSERT_EQUAL_HEX8_MESSAGE(a->access, entry->access, at);
            check_type(a, entry, at);
            TEST_ASSERT_EQUAL_MESSAGE(a->default_value == b->default_value &&
                                          !is_motor_parameter(a->index, a->subindex),
                                      entry->default_data.data != NULL, at);
            if (range && check_range(a, 1, entry, at))
                continue;
            if (!range)
                TEST_ASSERT_TRUE_MESSAGE(entry->minimum.data == NULL && entry->maximum.data == NULL, at);
            if (range && a->availability == b->availability && a->default_value == b->default_value)
                TEST_ASSERT_EQUAL_STRING_MESSAGE(comment_of(a), entry->comment, at);
            else
                TEST_ASSERT_NOT_NULL_MESSAGE(strstr(entry->comment, "CM2: "), at);
        }
    }
    const cm1e_described_object_t *k = object_in(objects, 0x60F6), *stiffness = object_in(objects, 0x60FB);
    TEST_ASSERT_EQUAL_STRING("CM1: available; CM2: N/A", k->entries.at[0x20].comment);
    TEST_ASSERT_EQUAL_STRING("CM1: no such parameter; CM2: available", k->entries.at[0x30].comment);
    TEST_ASSERT_EQUAL_STRING("CM1: 1 ... 5000 x 100 pulses/s, default 100; CM2: 1 ... 32767 x 100 pulses/s, default 10",
                             k->entries.at[0x16].comment);
    TEST_ASSERT_EQUAL_STRING("CM1: N/A; CM2: available", stiffness->entries.at[1].comment);
}

static void test_models_in_one_file_share_the_module(void)
{
    for (int model = CM1E_DEVICE_EB01; model <= CM1E_DEVICE_EB12; model++) {
        const cm1e_device_options_t options = options_of((cm1e_device_model_t)model, 0);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&file, &options, CM1E_ESI_MDP, &diag));
    }
    TEST_ASSERT_EQUAL(3, file.devices.count);
    TEST_ASSERT_EQUAL(1, file.modules.count);
}

static void test_a_cm1e_in_the_same_file_has_modules_of_its_own(void)
{
    const cm1e_device_options_t bridge = options_of(CM1E_DEVICE_EB01, 0), motor = {0};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&file, &motor, CM1E_ESI_MDP, &diag));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&file, &bridge, CM1E_ESI_MDP, &diag));
    TEST_ASSERT_EQUAL(5, file.modules.count);
    for (size_t i = 0; i < 5; i++)
        TEST_ASSERT_EQUAL_PTR(&file.modules.at[i], module_of(&file, file.modules.at[i].ident));
}

/* ---- options ---------------------------------------------------------------------------------------------------- */

static void test_mailbox_is_coe_only(void)
{
    const cm1e_device_options_t options = options_of(CM1E_DEVICE_EB02, 0);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&file, &options, CM1E_ESI_FLAT, &diag));
    const cm1e_description_t *device = &file.devices.at[0];
    const cm1e_mailbox_protocols_t *mailbox = &device->mailbox;
    TEST_ASSERT_TRUE(mailbox->present && mailbox->coe && mailbox->pdo_assign && !mailbox->pdo_config);
    TEST_ASSERT_FALSE(mailbox->foe || mailbox->eoe || mailbox->soe || mailbox->voe || mailbox->aoe);
    TEST_ASSERT_EQUAL(0, device->eeprom.bootstrap.size);
    TEST_ASSERT_FALSE(device->eeprom.config_known);
    TEST_ASSERT_EQUAL(1, device->dc_modes.count);
}

static void test_what_is_missing_is_named(void)
{
    cm1e_device_options_t options = options_of(CM1E_DEVICE_EB01, 0);
    options.vendor_id = 0;
    check_refused(&options, "EB01: missing: vendor ID;");
    check_refused(&options, "0xAA77");
    options.revision = 0;
    check_refused(&options, "missing: vendor ID, revision;");
    options.product_code = 0;
    check_refused(&options, "missing: vendor ID, product code, revision;");
    options.vendor_id = 1;
    check_refused(&options, "missing: product code, revision;");
}

static void test_options_of_the_cm1e_are_refused(void)
{
    cm1e_device_options_t options = options_of(CM1E_DEVICE_EB12, 5);
    check_refused(&options, "EB12: 5 axes; a bridge has 1 to 4");
    options = options_of(CM1E_DEVICE_EB12, 0);
    options.mapping = CM1E_MAPPING_CSP;
    check_refused(&options, "one mapping");
    options = options_of(CM1E_DEVICE_EB12, 0);
    options.order = CM1E_PDO_ORDER_UG_7_2;
    check_refused(&options, "one mapping");
    options = options_of(CM1E_DEVICE_EB12, 0);
    snprintf(options.firmware, sizeof options.firmware, "1.3.5");
    check_refused(&options, "firmware");
}

static void test_no_memory_is_an_error(void)
{
    const cm1e_device_options_t options = options_of(CM1E_DEVICE_EB12, 0);
    check_memory_ends(&options);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_identity_is_that_of_the_options);
    RUN_TEST(test_motors_are_named);
    RUN_TEST(test_a_bridge_of_myostat_is_myostats);
    RUN_TEST(test_dictionary_is_that_of_the_tables_in_every_variant);
    RUN_TEST(test_process_data_are_those_of_the_guide_in_every_variant);
    RUN_TEST(test_start_up_assigns_all_axes_and_chooses_csp);
    RUN_TEST(test_a_slot_for_each_axis_with_the_module_that_the_bridge_reports);
    RUN_TEST(test_the_module_holds_for_both_motors);
    RUN_TEST(test_models_in_one_file_share_the_module);
    RUN_TEST(test_a_cm1e_in_the_same_file_has_modules_of_its_own);
    RUN_TEST(test_mailbox_is_coe_only);
    RUN_TEST(test_what_is_missing_is_named);
    RUN_TEST(test_options_of_the_cm1e_are_refused);
    RUN_TEST(test_no_memory_is_an_error);
    return UNITY_END();
}
