#include "described.h"

static cm1e_description_file_t file;
static cm1e_diag_t diag;

void setUp(void) { file = (cm1e_description_file_t){0}; }
void tearDown(void) { cm1e_description_file_free(&file); }

/* ---- every firmware, mapping, order and layout ------------------------------------------------------------------ */

typedef struct variant {
    cm1e_firmware_t firmware;
    cm1e_mapping_t mapping;
    cm1e_pdo_order_t order;
    cm1e_esi_layout_t layout;
} variant_t;

static cm1e_device_options_t options_of(const variant_t *variant)
{
    cm1e_device_options_t options = {.mapping = variant->mapping, .order = variant->order, .serial_number = 77};
    snprintf(options.firmware, sizeof options.firmware, "%s", cm1e_firmware_info(variant->firmware)->version);
    return options;
}

static void each_variant(void (*check)(const variant_t *variant, const cm1e_description_t *device))
{
    for (int f = 0; f < CM1E_FIRMWARE_COUNT; f++)
        for (int m = 0; m < 4; m++)
            for (int o = 0; o < 2; o++)
                for (int l = 0; l < 2; l++) {
                    const variant_t variant = {(cm1e_firmware_t)f, (cm1e_mapping_t)m, (cm1e_pdo_order_t)o,
                                               (cm1e_esi_layout_t)l};
                    const cm1e_device_options_t options = options_of(&variant);
                    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&file, &options, variant.layout, &diag));
                    TEST_ASSERT_EQUAL(1, file.devices.count);
                    check(&variant, &file.devices.at[0]);
                    cm1e_description_file_free(&file);
                }
}

/* ---- identity --------------------------------------------------------------------------------------------------- */

static void check_identity(const variant_t *variant, const cm1e_description_t *device)
{
    const cm1e_firmware_info_t *firmware = cm1e_firmware_info(variant->firmware);
    TEST_ASSERT_EQUAL_HEX32(0x4441, device->vendor_id);
    TEST_ASSERT_EQUAL_STRING("Myostat Motion Control Inc.", device->vendor_name);
    TEST_ASSERT_EQUAL_HEX32(0x44412002, device->product_code);
    TEST_ASSERT_EQUAL_HEX32(variant->firmware == CM1E_FIRMWARE_1_2_0 ? 0x20020001 : 0x20020103, device->revision);
    TEST_ASSERT_TRUE(device->product_given && device->revision_given);
    TEST_ASSERT_EQUAL_STRING("CM1-E", device->type);
    TEST_ASSERT_EQUAL_STRING("CM1-E", device->name);
    TEST_ASSERT_NOT_NULL(strstr(device->comment, firmware->version));
    for (int motor = 0; motor < 4; motor++)
        TEST_ASSERT_NOT_NULL(strstr(device->comment, cm1e_device_motors[motor].name));
    TEST_ASSERT_TRUE(device->identification_reg134 && device->identification_reg134_given);
    TEST_ASSERT_EQUAL(1, device->channels.count);
    TEST_ASSERT_EQUAL(402, device->channels.at[0].profile_no);
    TEST_ASSERT_EQUAL(4, device->channels.at[0].add_info);
    TEST_ASSERT_EQUAL(-1, device->dpram_bytes);
}

static void test_identity_and_revision_by_firmware(void) { each_variant(check_identity); }

/* ---- dictionary ------------------------------------------------------------------------------------------------- */

static cm1e_pdo_t pdo_of(const variant_t *variant, unsigned index)
{
    cm1e_pdo_t pdo;
    cm1e_device_pdo(&pdo, (cm1e_mapping_t)(index & 3), index >= 0x1A00, variant->order, variant->firmware);
    return pdo;
}

/* The table's row that maps an object, wherever it stands in this order. */
static const char *row_name(const cm1e_object_t *object, unsigned mapped)
{
    for (unsigned i = 1; i < object->entry_count; i++)
        if (object->entries[i].default_value >> 16 == mapped)
            return object->entries[i].name;
    return NULL;
}

static void check_mapping_row(const variant_t *variant, const cm1e_object_t *object, const cm1e_entry_t *entry,
                              const cm1e_described_entry_t *described, const char *at)
{
    const cm1e_pdo_t pdo = pdo_of(variant, object->index);
    if (entry->subindex == 0) {
        check_number(entry, pdo.entry_count, described->default_data, at);
        return;
    }
    TEST_ASSERT_TRUE_MESSAGE(entry->subindex <= pdo.entry_count, at);
    const cm1e_pdo_entry_t *row = &pdo.entries[entry->subindex - 1];
    check_number(entry, (int64_t)row->index << 16 | row->subindex << 8 | row->bits, described->default_data, at);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(row_name(object, row->index), described->name, at);
}

/* Entries whose default is not that of the tables, or depends on the options. */
static bool check_adapted(const variant_t *variant, const cm1e_object_t *object, const cm1e_entry_t *entry,
                          const cm1e_described_entry_t *described, const char *at)
{
    const cm1e_firmware_info_t *firmware = cm1e_firmware_info(variant->firmware);
    if (object->index >= 0x1600 && object->index <= 0x1A03) {
        check_mapping_row(variant, object, entry, described, at);
        return true;
    }
    TEST_ASSERT_EQUAL_STRING_MESSAGE(entry->name, described->name, at);
    switch (object->index << 8 | entry->subindex) {
    case 0x101803: check_number(entry, firmware->revision, described->default_data, at); return true;
    case 0x101804: check_number(entry, 77, described->default_data, at); return true;
    case 0x1C3205:
    case 0x1C3305: /* UG 10.1: 1 ms only before V1.3.2 */
        check_number(entry, variant->firmware < CM1E_FIRMWARE_1_3_2 ? 1000000 : 200000, described->default_data, at);
        return true;
    case 0x1C1201: check_number(entry, 0x1600 + (int)variant->mapping, described->default_data, at); return true;
    case 0x1C1301: check_number(entry, 0x1A00 + (int)variant->mapping, described->default_data, at); return true;
    case 0x100A00: TEST_ASSERT_EQUAL_MEMORY(firmware->version, described->default_data.data, 5); return true;
    default: return false;
    }
}

static void check_entry(const variant_t *variant, const cm1e_object_t *object, const cm1e_entry_t *entry,
                        const cm1e_described_entry_t *described)
{
    const char *at = where("%04X:%02X, firmware %s, mapping %d, order %d", object->index, entry->subindex,
                           cm1e_firmware_info(variant->firmware)->version, (int)variant->mapping, (int)variant->order);
    const bool is_velocity = object->index == 0x606C || object->index == 0x60FF;
    const bool per_ms = is_velocity && variant->firmware < CM1E_FIRMWARE_1_3_3;
    TEST_ASSERT_EQUAL_MESSAGE(entry->subindex, described->subindex, at);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(entry->access, described->access, at);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(per_ms ? "counts/ms" : entry->unit, described->unit, at);
    check_type(entry, described, at);
    if (check_adapted(variant, object, entry, described, at))
        return;
    if (entry->default_string) {
        TEST_ASSERT_EQUAL_MESSAGE(strlen(entry->default_string), described->default_data.size, at);
        TEST_ASSERT_EQUAL_MEMORY(entry->default_string, described->default_data.data, described->default_data.size);
        return;
    }
    const bool has_range = check_range(entry, per_ms ? 1000 : 1, described, at);
    if (!has_range)
        TEST_ASSERT_NULL_MESSAGE(described->comment, at);
    if (!has_range && is_motor_parameter(object->index, entry->subindex))
        TEST_ASSERT_NULL_MESSAGE(described->default_data.data, at);
    else
        check_number(entry, entry->default_value, described->default_data, at);
}

static void check_object(const variant_t *variant, const cm1e_object_t *object,
                         const cm1e_described_object_t *described)
{
    size_t count = 0;
    TEST_ASSERT_NOT_NULL_MESSAGE(described, where("%04X is missing", object->index));
    TEST_ASSERT_EQUAL_STRING(object->name, described->name);
    TEST_ASSERT_EQUAL(object->object_code, described->code);
    for (unsigned i = 0; i < object->entry_count; i++)
        if (object->entries[i].since <= variant->firmware) {
            TEST_ASSERT_TRUE(count < described->entries.count);
            check_entry(variant, object, &object->entries[i], &described->entries.at[count++]);
        }
    TEST_ASSERT_EQUAL_MESSAGE(count, described->entries.count, where("%04X", object->index));
}

static void check_dictionary(const variant_t *variant, const cm1e_description_t *device)
{
    size_t count, own = 0, of_module = 0;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    for (size_t i = 0; i < count; i++) {
        if (objects[i].since > variant->firmware) {
            TEST_ASSERT_NULL(object_in(&device->objects, objects[i].index));
            continue;
        }
        if (variant->layout == CM1E_ESI_FLAT || objects[i].index < 0x6000 || objects[i].index >= 0xF000 ||
            is_motor_parameter(objects[i].index, 1)) { /* those belong to the motor in whatever mode */
            check_object(variant, &objects[i], object_in(&device->objects, objects[i].index));
            TEST_ASSERT_FALSE(object_in(&device->objects, objects[i].index)->depends_on_slot);
            own++;
            continue;
        }
        of_module++;
        for (size_t m = 0; m < file.modules.count; m++) {
            const cm1e_described_object_t *described = object_in(&file.modules.at[m].objects, objects[i].index);
            check_object(variant, &objects[i], described);
            TEST_ASSERT_TRUE(described->depends_on_slot);
        }
    }
    TEST_ASSERT_EQUAL(own, device->objects.count);
    for (size_t m = 0; m < file.modules.count; m++)
        TEST_ASSERT_EQUAL(of_module, file.modules.at[m].objects.count);
}

static void test_dictionary_is_that_of_the_tables_in_every_variant(void) { each_variant(check_dictionary); }

/* ---- process data ----------------------------------------------------------------------------------------------- */

static void check_pdo(const variant_t *variant, const cm1e_described_pdo_t *described, bool in_module)
{
    const cm1e_pdo_t pdo = pdo_of(variant, described->index);
    TEST_ASSERT_EQUAL_STRING(pdo.name, described->name);
    TEST_ASSERT_EQUAL(described->index >= 0x1A00, described->transmit);
    TEST_ASSERT_TRUE(described->fixed);
    TEST_ASSERT_FALSE(described->mandatory);
    TEST_ASSERT_EQUAL(in_module, described->depends_on_slot);
    TEST_ASSERT_EQUAL(pdo.entry_count, described->entries.count);
    for (unsigned e = 0; e < pdo.entry_count; e++) {
        const cm1e_described_pdo_entry_t *entry = &described->entries.at[e];
        const cm1e_entry_t *object = cm1e_device_entry(pdo.entries[e].index, 0);
        const char *at = where("%04X row %u", pdo.index, e + 1);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(pdo.entries[e].index, entry->index, at);
        TEST_ASSERT_EQUAL_MESSAGE(0, entry->subindex, at);
        TEST_ASSERT_EQUAL_MESSAGE(pdo.entries[e].bits, entry->bits, at);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(object->name, entry->name, at);
        const bool per_ms =
            variant->firmware < CM1E_FIRMWARE_1_3_3 && (entry->index == 0x606C || entry->index == 0x60FF);
        const char *unit = per_ms ? "counts/ms" : object->unit;
        TEST_ASSERT_EQUAL_STRING_MESSAGE(unit[0] ? unit : NULL, entry->comment, at);
        TEST_ASSERT_EQUAL_MESSAGE(pdo.entries[e].bits, cm1e_type_bits(entry->type), at);
        /* 2301 and 6079 are signed, 6079 shorter than in the dictionary */
        TEST_ASSERT_EQUAL_MESSAGE(is_signed(object), entry->type[0] != 'U', at);
        TEST_ASSERT_EQUAL_MESSAGE(in_module && entry->index >= 0x6000, entry->depends_on_slot, at);
    }
}

/* Every alternative excludes every other one of its direction. */
static void check_alternatives(const cm1e_description_t *device, const variant_t *variant)
{
    TEST_ASSERT_EQUAL(8, device->pdos.count);
    for (size_t i = 0; i < 8; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        const bool chosen = (pdo->index & 3) == (unsigned)variant->mapping;
        TEST_ASSERT_EQUAL(!chosen ? CM1E_NO_SYNC_MANAGER : pdo->transmit ? 3 : 2, pdo->sync_manager);
        TEST_ASSERT_EQUAL_HEX16((pdo->transmit ? 0x1A00 : 0x1600) + i % 4, pdo->index);
        TEST_ASSERT_EQUAL(3, pdo->excludes.count);
        unsigned excluded = 1u << (pdo->index & 3);
        for (size_t e = 0; e < 3; e++) {
            TEST_ASSERT_EQUAL_HEX16(pdo->index & 0xFF00, pdo->excludes.at[e].index & 0xFFFC);
            excluded |= 1u << (pdo->excludes.at[e].index & 3);
        }
        TEST_ASSERT_EQUAL_HEX8(0xF, excluded);
        check_pdo(variant, pdo, false);
    }
}

static void check_process_data(const variant_t *variant, const cm1e_description_t *device)
{
    /* UG 4.4; before V1.3.0 without the mode in the profile mapping (UG 10.1). */
    static const unsigned bytes[4][2] = {{13, 21}, {8, 16}, {8, 16}, {21, 21}};
    const unsigned less = variant->mapping == CM1E_MAPPING_PROFILE && variant->firmware < CM1E_FIRMWARE_1_3_0;
    check_sync_managers(device, bytes[variant->mapping][0] - less, bytes[variant->mapping][1] - less);
    if (variant->layout == CM1E_ESI_FLAT) {
        check_alternatives(device, variant);
        return;
    }
    TEST_ASSERT_EQUAL(0, device->pdos.count);
    for (size_t m = 0; m < 4; m++) {
        const cm1e_module_t *module = &file.modules.at[m];
        TEST_ASSERT_EQUAL(2, module->pdos.count);
        for (size_t i = 0; i < 2; i++) {
            TEST_ASSERT_EQUAL_HEX16((i ? 0x1A00 : 0x1600) + m, module->pdos.at[i].index);
            TEST_ASSERT_EQUAL(i ? 3 : 2, module->pdos.at[i].sync_manager);
            TEST_ASSERT_EQUAL(0, module->pdos.at[i].excludes.count);
            check_pdo(variant, &module->pdos.at[i], true);
        }
    }
}

static void test_process_data_are_those_of_the_tables_in_every_variant(void) { each_variant(check_process_data); }

/* ---- start-up commands: UG 11.2.1 ------------------------------------------------------------------------------- */

static void check_start(const variant_t *variant, const cm1e_description_t *device)
{
    static const uint32_t modes[4] = {8, 8, 9, 1};
    const uint32_t m = (uint32_t)variant->mapping;
    const init_row_t rows[] = {
        {0x1C12, 0, 1, 0}, {0x1C13, 0, 1, 0}, {0x1C12, 1, 2, 0x1600 + m}, {0x1C12, 0, 1, 1},
        {0x1C13, 1, 2, 0x1A00 + m}, {0x1C13, 0, 1, 1}, {0x6060, 0, 1, modes[m]},
    };
    if (variant->layout == CM1E_ESI_FLAT) {
        check_init_commands(rows, 7, &device->init_commands);
        TEST_ASSERT_FALSE(device->init_commands.at[6].depends_on_slot);
        return;
    }
    check_init_commands(rows, 6, &device->init_commands);
    for (size_t i = 0; i < 4; i++) {
        const init_row_t mode = {0x6060, 0, 1, modes[i]};
        check_init_commands(&mode, 1, &file.modules.at[i].init_commands);
        TEST_ASSERT_TRUE(file.modules.at[i].init_commands.at[0].depends_on_slot);
    }
}

static void test_start_up_commands_are_those_of_the_guide(void) { each_variant(check_start); }

/* ---- modules ---------------------------------------------------------------------------------------------------- */

static void check_slot(const variant_t *variant, const cm1e_description_t *device)
{
    if (variant->layout == CM1E_ESI_FLAT) {
        TEST_ASSERT_EQUAL(0, device->slots.count);
        TEST_ASSERT_EQUAL(0, file.modules.count);
        return;
    }
    TEST_ASSERT_EQUAL(1, device->slots.count);
    TEST_ASSERT_EQUAL_HEX16(0x800, device->slot_index_increment);
    TEST_ASSERT_EQUAL_HEX16(0x10, device->slot_pdo_increment);
    const cm1e_slot_t *slot = &device->slots.at[0];
    TEST_ASSERT_EQUAL(1, slot->minimum_instances);
    TEST_ASSERT_EQUAL(1, slot->maximum_instances);
    TEST_ASSERT_EQUAL(4, slot->choices.count);
    TEST_ASSERT_EQUAL(4, file.modules.count);
    for (size_t i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL(i == (size_t)variant->mapping, slot->choices.at[i].is_default);
        const cm1e_module_t *module = module_of(&file, slot->choices.at[i].ident);
        TEST_ASSERT_EQUAL_PTR(&file.modules.at[i], module);
        TEST_ASSERT_EQUAL(402, module->profile_no);
        TEST_ASSERT_EQUAL(4, module->profile_info);
        TEST_ASSERT_TRUE(module->type[0] != '\0' && module->name[0] != '\0');
    }
}

static void test_the_slot_offers_the_four_mappings(void) { each_variant(check_slot); }

static void test_devices_in_one_file_share_modules_only_where_they_are_alike(void)
{
    size_t devices = 0;
    for (int f = 0; f < CM1E_FIRMWARE_COUNT; f++)
        for (int o = 0; o < 2; o++)
            for (int m = 0; m < 4; m++) {
                const variant_t variant = {(cm1e_firmware_t)f, (cm1e_mapping_t)m, (cm1e_pdo_order_t)o, CM1E_ESI_MDP};
                const cm1e_device_options_t options = options_of(&variant);
                TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&file, &options, CM1E_ESI_MDP, &diag));
                devices++;
            }
    TEST_ASSERT_EQUAL(devices, file.devices.count);
    TEST_ASSERT_EQUAL(4 * 2 * CM1E_FIRMWARE_COUNT, file.modules.count);
    for (size_t d = 0; d < devices; d++)
        for (size_t i = 0; i < 4; i++)
            TEST_ASSERT_NOT_NULL(module_of(&file, file.devices.at[d].slots.at[0].choices.at[i].ident));
}

/* ---- options ---------------------------------------------------------------------------------------------------- */

static const cm1e_description_t *describe(const cm1e_device_options_t *options)
{
    cm1e_description_file_free(&file);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&file, options, CM1E_ESI_FLAT, &diag));
    return &file.devices.at[0];
}

static void test_nothing_asked_for_is_the_newest_firmware(void)
{
    const cm1e_device_options_t options = {0};
    const cm1e_description_t *device = describe(&options);
    TEST_ASSERT_NOT_NULL(strstr(device->comment, "1.3.5"));
    TEST_ASSERT_NOT_NULL(object_in(&device->objects, 0x2201));
    TEST_ASSERT_EQUAL_HEX16(0x1600, cm1e_bytes_unsigned(device->init_commands.at[2].data));
}

static void test_mailbox_and_ways_to_synchronise(void)
{
    cm1e_device_options_t options = {0};
    const cm1e_description_t *device = describe(&options);
    const cm1e_mailbox_protocols_t *mailbox = &device->mailbox;
    TEST_ASSERT_TRUE(mailbox->present && mailbox->coe && mailbox->foe && mailbox->sdo_info && mailbox->pdo_assign);
    TEST_ASSERT_FALSE(mailbox->eoe || mailbox->soe || mailbox->voe || mailbox->aoe || mailbox->pdo_config);
    TEST_ASSERT_FALSE(mailbox->complete_access);
    TEST_ASSERT_EQUAL(1, device->dc_modes.count);
    TEST_ASSERT_EQUAL_HEX16(0, device->dc_modes.at[0].assign_activate);
    options.complete_access = options.distributed_clocks = true;
    device = describe(&options);
    TEST_ASSERT_TRUE(device->mailbox.complete_access);
    TEST_ASSERT_EQUAL(2, device->dc_modes.count);
    TEST_ASSERT_EQUAL_HEX16(0, device->dc_modes.at[0].assign_activate);
    TEST_ASSERT_EQUAL_HEX16(0x0300, device->dc_modes.at[1].assign_activate);
}

static void test_eeprom_of_a_device_not_seen_is_marked_as_a_guess(void)
{
    const cm1e_device_options_t options = {.alias = 0x1234, .serial_number = 5};
    const cm1e_described_eeprom_t *eeprom = &describe(&options)->eeprom;
    static const uint8_t bootstrap[8] = {0x00, 0x10, 128, 0, 0x80, 0x10, 128, 0};
    TEST_ASSERT_FALSE(eeprom->config_known);
    TEST_ASSERT_EQUAL(14, eeprom->config_data.size);
    TEST_ASSERT_EQUAL_HEX8(0x34, eeprom->config_data.data[8]);
    TEST_ASSERT_EQUAL_HEX16(0x1234, eeprom->alias);
    TEST_ASSERT_EQUAL(5, eeprom->serial_number);
    TEST_ASSERT_EQUAL(8, eeprom->bootstrap.size);
    TEST_ASSERT_EQUAL_MEMORY(bootstrap, eeprom->bootstrap.data, 8);
    TEST_ASSERT_EQUAL_HEX16(0x1000, eeprom->mailbox_out_start);
    TEST_ASSERT_EQUAL_HEX16(0x1080, eeprom->mailbox_in_start);
    TEST_ASSERT_EQUAL(128, eeprom->mailbox_out_length);
    TEST_ASSERT_EQUAL(128, eeprom->mailbox_in_length);
    TEST_ASSERT_EQUAL(2048, eeprom->byte_size);
}

static void test_eeprom_words_of_a_real_device_are_kept(void)
{
    cm1e_device_options_t options = {.config_data_size = 14};
    for (int i = 0; i < 14; i++)
        options.config_data[i] = (uint8_t)(0xA0 + i);
    const cm1e_described_eeprom_t *eeprom = &describe(&options)->eeprom;
    TEST_ASSERT_TRUE(eeprom->config_known);
    TEST_ASSERT_EQUAL_MEMORY(options.config_data, eeprom->config_data.data, 14);
    TEST_ASSERT_EQUAL_HEX16(0xA9A8, eeprom->alias);
    options.alias = 0x0102; /* asked for, it takes the place of the device's */
    eeprom = &describe(&options)->eeprom;
    TEST_ASSERT_EQUAL_HEX16(0x0102, eeprom->alias);
    TEST_ASSERT_EQUAL_HEX8(0x02, eeprom->config_data.data[8]);
    TEST_ASSERT_EQUAL_HEX8(0xAA, eeprom->config_data.data[10]);
}

static void test_options_that_do_not_fit_are_refused_by_name(void)
{
    check_refused(&(cm1e_device_options_t){.firmware = "1.3.1"}, "no firmware \"1.3.1\"; there are 1.2.0 1.3.0 1.3.2 ");
    check_refused(&(cm1e_device_options_t){.firmware = "1.3.1"}, " 1.3.3 1.3.4 1.3.5");
    check_refused(&(cm1e_device_options_t){.firmware = "V1.3.5"}, "no firmware \"V1.3.5\"");
    check_refused(&(cm1e_device_options_t){.vendor_id = 1}, "leave them 0");
    check_refused(&(cm1e_device_options_t){.product_code = 1}, "leave them 0");
    check_refused(&(cm1e_device_options_t){.revision = 1}, "leave them 0");
    check_refused(&(cm1e_device_options_t){.axes = 2}, "leave them 0");
    check_refused(&(cm1e_device_options_t){.mapping = (cm1e_mapping_t)4}, "mapping or order");
    check_refused(&(cm1e_device_options_t){.order = (cm1e_pdo_order_t)2}, "mapping or order");
    check_refused(&(cm1e_device_options_t){.model = (cm1e_device_model_t)5}, "no such device model");
    check_refused(&(cm1e_device_options_t){.config_data_size = 13}, "14 bytes");
}

static void test_no_memory_is_an_error(void)
{
    const cm1e_device_options_t options = {0};
    check_memory_ends(&options);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_identity_and_revision_by_firmware);
    RUN_TEST(test_dictionary_is_that_of_the_tables_in_every_variant);
    RUN_TEST(test_process_data_are_those_of_the_tables_in_every_variant);
    RUN_TEST(test_start_up_commands_are_those_of_the_guide);
    RUN_TEST(test_the_slot_offers_the_four_mappings);
    RUN_TEST(test_devices_in_one_file_share_modules_only_where_they_are_alike);
    RUN_TEST(test_nothing_asked_for_is_the_newest_firmware);
    RUN_TEST(test_mailbox_and_ways_to_synchronise);
    RUN_TEST(test_eeprom_of_a_device_not_seen_is_marked_as_a_guess);
    RUN_TEST(test_eeprom_words_of_a_real_device_are_kept);
    RUN_TEST(test_options_that_do_not_fit_are_refused_by_name);
    RUN_TEST(test_no_memory_is_an_error);
    return UNITY_END();
}
