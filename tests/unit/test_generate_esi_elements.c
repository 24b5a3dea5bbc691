/* The ESI writer with descriptions that none of our devices has: everything that a file of somebody else may state, and
 * nothing where nothing is stated. */
#include "esi_judge.h"

static cm1e_arena_t *arena;

static cm1e_description_t *add_device(uint32_t vendor, const char *type)
{
    arena = &description.arena;
    cm1e_description_t *device = CM1E_APPEND(arena, &description.devices);
    cm1e_description_init(device);
    device->vendor_id = vendor;
    device->type = device->name = type;
    device->group = "G";
    return device;
}

/* Valid where there are schemas to say so. */
static void write_valid_file(void)
{
    write_file();
    if (schema)
        TEST_ASSERT_EQUAL_STRING("", schema_error());
}

static void test_an_empty_description_is_a_valid_file(void)
{
    description.vendor_id = 0x1234;
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("#x00001234", text("/EtherCATInfo/Vendor/Id"));
    TEST_ASSERT_EQUAL_STRING("Vendor #x00001234", text("/EtherCATInfo/Vendor/Name"));
    TEST_ASSERT_EQUAL_INT(0, count(DEVICE "|" MODULE));
}

static void test_nothing_stated_is_nothing_written(void)
{
    add_device(1, "T")->group = "";
    write_valid_file();
    TEST_ASSERT_EQUAL_INT(3, count(DEVICE "/*")); /* Type, Name, GroupType: the schema wants them */
    TEST_ASSERT_EQUAL_INT(0, count(DEVICE "/Type/@*"));
    TEST_ASSERT_EQUAL_STRING("", text(DEVICE "/@Physics"));
    TEST_ASSERT_EQUAL_INT(0, count("/EtherCATInfo/Descriptions/Groups/Group"));
}

static void test_the_comment_of_the_file_stands_before_its_root(void)
{
    add_device(1, "T");
    description.comment = "what a person -- should know";
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING(" what a person - - should know ", text("/comment()"));
}

static void test_devices_of_two_vendors_are_refused(void)
{
    add_device(1, "first");
    add_device(2, "second");
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_esi_write(&file, &description, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "first has vendor 0x00000001"));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "second has 0x00000002"));
    TEST_ASSERT_NULL(file.bytes);
}

static void test_a_slot_without_modules_is_refused(void)
{
    cm1e_description_t *device = add_device(1, "T");
    cm1e_slot_t *slot = CM1E_APPEND(arena, &device->slots);
    slot->name = "";
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_esi_write(&file, &description, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "slot 1 of T"));
    TEST_ASSERT_NULL(file.bytes);
}

static void test_devices_share_groups(void)
{
    for (int i = 0; i < 4; i++) {
        cm1e_description_t *device = add_device(1, "T");
        device->group = i % 2 ? "odd" : "even";
        device->group_name = i % 2 ? "Odd ones" : NULL;
    }
    write_valid_file();
    TEST_ASSERT_EQUAL_INT(2, count("/EtherCATInfo/Descriptions/Groups/Group"));
    TEST_ASSERT_EQUAL_STRING("even", text("/EtherCATInfo/Descriptions/Groups/Group[1]/Name"));
    TEST_ASSERT_EQUAL_STRING("Odd ones", text("/EtherCATInfo/Descriptions/Groups/Group[2]/Name"));
    TEST_ASSERT_EQUAL_STRING("odd", text(DEVICE "[4]/GroupType"));
}

/* With one vendor a file can have any number of devices; modules with equal contents exist once. */
static void test_several_motors_are_in_one_file(void)
{
    static const char *const firmwares[] = {"1.2.0", "1.3.5", "1.3.5"};
    for (int i = 0; i < 3; i++) {
        cm1e_device_options_t options = {.mapping = (cm1e_mapping_t)i};
        strcpy(options.firmware, firmwares[i]);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&description, &options, CM1E_ESI_MDP, &diag));
    }
    write_valid_file();
    TEST_ASSERT_EQUAL_INT(3, count(DEVICE));
    TEST_ASSERT_EQUAL_INT(8, count(MODULE));
    for (int i = 1; i <= 8; i++)
        TEST_ASSERT_EQUAL_INT(1, count(MODULE "[Type/@ModuleIdent='%s']", text(MODULE "[%d]/Type/@ModuleIdent", i)));
}

static void test_times_and_the_controller_are_written_where_they_are_stated(void)
{
    cm1e_description_t *device = add_device(1, "T");
    device->timeouts = (cm1e_described_timeouts_t){2000, 9000, 5000, 200, 100, 0};
    device->dpram_bytes = 8192;
    device->sync_managers_available = 8;
    device->fmmus_available = 3;
    device->url = "http://example.org/?a=1&b=2";
    device->comment = "C";
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("2000", text(DEVICE "/Info/StateMachine/Timeout/PreopTimeout"));
    TEST_ASSERT_EQUAL_STRING("9000", text(DEVICE "/Info/StateMachine/Timeout/SafeopOpTimeout"));
    TEST_ASSERT_EQUAL_STRING("5000", text(DEVICE "/Info/StateMachine/Timeout/BackToInitTimeout"));
    TEST_ASSERT_EQUAL_STRING("200", text(DEVICE "/Info/StateMachine/Timeout/BackToSafeopTimeout"));
    TEST_ASSERT_EQUAL_STRING("100", text(DEVICE "/Info/Mailbox/Timeout/RequestTimeout"));
    TEST_ASSERT_EQUAL_STRING("0", text(DEVICE "/Info/Mailbox/Timeout/ResponseTimeout"));
    TEST_ASSERT_EQUAL_STRING("8192", text(DEVICE "/Info/EtherCATController/DpramSize"));
    TEST_ASSERT_EQUAL_STRING("8", text(DEVICE "/Info/EtherCATController/SmCount"));
    TEST_ASSERT_EQUAL_STRING("3", text(DEVICE "/Info/EtherCATController/FmmuCount"));
    TEST_ASSERT_EQUAL_STRING("http://example.org/?a=1&b=2", text(DEVICE "/URL"));
    device->timeouts.back_to_init = -1; /* the schema wants all four or none */
    device->timeouts.mailbox_response = -1;
    write_valid_file();
    TEST_ASSERT_EQUAL_INT(0, count(DEVICE "/Info/StateMachine|" DEVICE "/Info/Mailbox"));
}

static void test_sync_managers_and_fmmus_of_every_use(void)
{
    cm1e_description_t *device = add_device(1, "T");
    for (int use = 0; use <= CM1E_SM_INPUTS; use++) {
        cm1e_described_sync_manager_t *manager = CM1E_APPEND(arena, &device->sync_managers);
        *manager = (cm1e_described_sync_manager_t){
            .use = (cm1e_sync_manager_use_t)use, .start = 0x1000, .control = 0x26, .enable = 1};
        if (use == CM1E_SM_OUTPUTS) {
            manager->length_given = true;
            manager->minimum_length = 36;
            manager->maximum_length = 268;
        }
    }
    for (int use = 0; use <= CM1E_FMMU_MAILBOX_STATE; use++)
        ((cm1e_described_fmmu_t *)CM1E_APPEND(arena, &device->fmmus))->use = (cm1e_fmmu_use_t)use;
    write_valid_file();
    static const char *const sync_managers[] = {"", "MBoxOut", "MBoxIn", "Outputs", "Inputs"};
    static const char *const fmmus[] = {"", "Outputs", "Inputs", "MBoxState"};
    for (int use = 0; use <= CM1E_SM_INPUTS; use++)
        TEST_ASSERT_EQUAL_STRING(sync_managers[use], text(DEVICE "/Sm[%d]", use + 1));
    for (int use = 0; use <= CM1E_FMMU_MAILBOX_STATE; use++)
        TEST_ASSERT_EQUAL_STRING(fmmus[use], text(DEVICE "/Fmmu[%d]", use + 1));
    TEST_ASSERT_EQUAL_STRING("?", text(DEVICE "/Sm[1]/@DefaultSize"));
    TEST_ASSERT_EQUAL_STRING("0", text(DEVICE "/Sm[4]/@DefaultSize"));
    TEST_ASSERT_EQUAL_STRING("36", text(DEVICE "/Sm[4]/@MinSize"));
    TEST_ASSERT_EQUAL_STRING("268", text(DEVICE "/Sm[4]/@MaxSize"));
}

static void test_pdos_with_all_that_they_can_have(void)
{
    cm1e_description_t *device = add_device(1, "T");
    cm1e_described_pdo_t *pdo = CM1E_APPEND(arena, &device->pdos);
    *pdo = (cm1e_described_pdo_t){.transmit = true, .index = 0x1A00, .name = "second", .sync_manager = 3,
                                  .mandatory = true, .is_virtual = true};
    ((cm1e_exclude_t *)CM1E_APPEND(arena, &pdo->excludes))->index = 0x1A01;
    *(cm1e_described_pdo_entry_t *)CM1E_APPEND(arena, &pdo->entries) = (cm1e_described_pdo_entry_t){
        .index = 0x6041, .subindex = 2, .bits = 16, .name = "Statusword", .type = "UINT", .comment = "read me"};
    *(cm1e_described_pdo_entry_t *)CM1E_APPEND(arena, &pdo->entries) =
        (cm1e_described_pdo_entry_t){.bits = 8, .type = ""}; /* a gap */
    pdo = CM1E_APPEND(arena, &device->pdos);
    *pdo = (cm1e_described_pdo_t){.index = 0x1600, .name = "first", .sync_manager = CM1E_NO_SYNC_MANAGER};
    write_valid_file();
    TEST_ASSERT_EQUAL_INT(1, count(DEVICE "/RxPdo[following-sibling::TxPdo]"));
    TEST_ASSERT_EQUAL_INT(0, count(DEVICE "/RxPdo/@*"));
    TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/TxPdo/@Mandatory"));
    TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/TxPdo/@Virtual"));
    TEST_ASSERT_EQUAL_STRING("?", text(DEVICE "/TxPdo/@Fixed"));
    TEST_ASSERT_EQUAL_STRING("#x1A01", text(DEVICE "/TxPdo/Exclude"));
    TEST_ASSERT_EQUAL_STRING("2", text(DEVICE "/TxPdo/Entry[1]/SubIndex"));
    TEST_ASSERT_EQUAL_STRING("read me", text(DEVICE "/TxPdo/Entry[1]/Comment"));
    TEST_ASSERT_EQUAL_STRING("#x0000", text(DEVICE "/TxPdo/Entry[2]/Index"));
    TEST_ASSERT_EQUAL_INT(2, count(DEVICE "/TxPdo/Entry[2]/*")); /* Index and BitLen */
}

static void test_mailbox_with_every_protocol(void)
{
    cm1e_description_t *device = add_device(1, "T");
    device->mailbox = (cm1e_mailbox_protocols_t){.present = true, .coe = true, .foe = true, .eoe = true, .soe = true,
                                                 .voe = true, .aoe = true, .pdo_config = true, .pdo_upload = true};
    cm1e_init_command_t *command = CM1E_APPEND(arena, &device->init_commands);
    *command = (cm1e_init_command_t){
        .transitions = CM1E_TRANSITION_IP | CM1E_TRANSITION_PS | CM1E_TRANSITION_SO | CM1E_TRANSITION_SP |
                       CM1E_TRANSITION_OP | CM1E_TRANSITION_OS,
        .index = 0x8000, .subindex = 255, .fixed = true, .complete_access = true, .adapts = true,
        .data = cm1e_bytes_of(arena, 0x0123456789ABCDEF, 8)};
    command = CM1E_APPEND(arena, &device->init_commands);
    *command = (cm1e_init_command_t){.transitions = CM1E_TRANSITION_PS, .comment = "no data"};
    write_valid_file();
    TEST_ASSERT_EQUAL_INT(6, count(DEVICE "/Mailbox/*"));
    TEST_ASSERT_EQUAL_STRING("0", text(DEVICE "/Mailbox/@DataLinkLayer"));
    TEST_ASSERT_EQUAL_STRING("0", text(DEVICE "/Mailbox/CoE/@SdoInfo"));
    TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/Mailbox/CoE/@PdoConfig"));
    TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/Mailbox/CoE/@PdoUpload"));
    static const char *const transitions[] = {"IP", "PS", "SO", "SP", "OP", "OS"};
    for (int i = 0; i < 6; i++)
        TEST_ASSERT_EQUAL_STRING(transitions[i], text(DEVICE "/Mailbox/CoE/InitCmd[1]/Transition[%d]", i + 1));
    TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/Mailbox/CoE/InitCmd[1]/@Fixed"));
    TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/Mailbox/CoE/InitCmd[1]/@CompleteAccess"));
    TEST_ASSERT_EQUAL_STRING("255", text(DEVICE "/Mailbox/CoE/InitCmd[1]/SubIndex"));
    TEST_ASSERT_EQUAL_STRING("EFCDAB8967452301", text(DEVICE "/Mailbox/CoE/InitCmd[1]/Data"));
    TEST_ASSERT_EQUAL_STRING("", text(DEVICE "/Mailbox/CoE/InitCmd[2]/Data"));
    TEST_ASSERT_EQUAL_STRING("no data", text(DEVICE "/Mailbox/CoE/InitCmd[2]/Comment"));
}

static void test_a_mailbox_without_coe_has_no_coe(void)
{
    cm1e_description_t *device = add_device(1, "T");
    device->mailbox = (cm1e_mailbox_protocols_t){.present = true, .foe = true, .data_link_layer = true};
    write_valid_file();
    TEST_ASSERT_EQUAL_INT(1, count(DEVICE "/Mailbox/*"));
    TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/Mailbox/@DataLinkLayer"));
}

static void test_clock_modes_with_all_that_they_can_have(void)
{
    cm1e_description_t *device = add_device(1, "T");
    *(cm1e_dc_mode_t *)CM1E_APPEND(arena, &device->dc_modes) = (cm1e_dc_mode_t){
        .name = "DC", .assign_activate = 0x0730, .sync0_given = true, .sync1_given = true, .sync0_cycle_ns = 1000000,
        .sync0_factor = -2, .sync0_shift_ns = 250000, .sync1_factor = 3, .sync1_shift_ns = -1};
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("?", text(DEVICE "/Dc/OpMode/Desc"));
    TEST_ASSERT_EQUAL_STRING("#x0730", text(DEVICE "/Dc/OpMode/AssignActivate"));
    TEST_ASSERT_EQUAL_STRING("1000000", text(DEVICE "/Dc/OpMode/CycleTimeSync0"));
    TEST_ASSERT_EQUAL_STRING("-2", text(DEVICE "/Dc/OpMode/CycleTimeSync0/@Factor"));
    TEST_ASSERT_EQUAL_STRING("250000", text(DEVICE "/Dc/OpMode/ShiftTimeSync0"));
    TEST_ASSERT_EQUAL_STRING("3", text(DEVICE "/Dc/OpMode/CycleTimeSync1/@Factor"));
    TEST_ASSERT_EQUAL_STRING("-1", text(DEVICE "/Dc/OpMode/ShiftTimeSync1"));
}

static void test_a_module_with_the_least_that_it_can_have(void)
{
    add_device(1, "T");
    cm1e_module_t *module = CM1E_APPEND(arena, &description.modules);
    *module = (cm1e_module_t){.ident = 7, .profile_no = -1, .profile_info = -1};
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("#x00000007", text(MODULE "/Type/@ModuleIdent"));
    TEST_ASSERT_EQUAL_INT(2, count(MODULE "/*"));
    module->profile_no = 402;
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("402", text(MODULE "/Profile/ProfileNo"));
    TEST_ASSERT_EQUAL_STRING("?", text(MODULE "/Profile/AddInfo"));
}

static void test_an_eeprom_with_other_than_14_bytes_is_kept(void)
{
    static const uint8_t config[] = {0x80, 0x0C, 0x81, 0x66, 0, 0, 0, 0, 0, 0};
    cm1e_description_t *device = add_device(1, "T");
    device->eeprom = (cm1e_described_eeprom_t){.byte_size = 4096, .config_data = {config, sizeof config},
                                               .config_known = true};
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("4096", text(DEVICE "/Eeprom/ByteSize"));
    TEST_ASSERT_EQUAL_STRING("800C8166000000000000", text(DEVICE "/Eeprom/ConfigData"));
    TEST_ASSERT_EQUAL_STRING("?", text(DEVICE "/Eeprom/BootStrap"));
    device->eeprom.config_data.data = NULL;
    write_valid_file();
    TEST_ASSERT_EQUAL_INT(0, count(DEVICE "/Eeprom"));
}

int main(void)
{
    load_schema();
    UNITY_BEGIN();
    RUN_TEST(test_an_empty_description_is_a_valid_file);
    RUN_TEST(test_nothing_stated_is_nothing_written);
    RUN_TEST(test_the_comment_of_the_file_stands_before_its_root);
    RUN_TEST(test_devices_of_two_vendors_are_refused);
    RUN_TEST(test_a_slot_without_modules_is_refused);
    RUN_TEST(test_devices_share_groups);
    RUN_TEST(test_several_motors_are_in_one_file);
    RUN_TEST(test_times_and_the_controller_are_written_where_they_are_stated);
    RUN_TEST(test_sync_managers_and_fmmus_of_every_use);
    RUN_TEST(test_pdos_with_all_that_they_can_have);
    RUN_TEST(test_mailbox_with_every_protocol);
    RUN_TEST(test_a_mailbox_without_coe_has_no_coe);
    RUN_TEST(test_clock_modes_with_all_that_they_can_have);
    RUN_TEST(test_a_module_with_the_least_that_it_can_have);
    RUN_TEST(test_an_eeprom_with_other_than_14_bytes_is_kept);
    const int failures = UNITY_END();
    free_schema();
    return failures;
}
