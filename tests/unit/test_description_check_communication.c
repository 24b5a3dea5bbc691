/* The cross-checker: sync managers, FMMUs, mailbox and EEPROM, each broken in one way. */
#include "broken_description.h"

void setUp(void) {}
void tearDown(void) {}

#define DEVICE(file) (&(file)->devices.at[0])

static void make_good(cm1e_description_file_t *file)
{
    const cm1e_device_options_t options = {.mapping = CM1E_MAPPING_CSP};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(file, &options, CM1E_ESI_FLAT, NULL));
    number_places(file);
}

static cm1e_described_sync_manager_t *manager(cm1e_description_file_t *file, unsigned n)
{
    return &DEVICE(file)->sync_managers.at[n];
}

/* ---- sync managers ----------------------------------------------------------------------------------------------- */

/* Only with all three buffers: 0x1601 has 8 bytes. */
static cm1e_place_t overlap_third_buffer(cm1e_description_file_t *file)
{
    manager(file, 3)->start = manager(file, 2)->start + 8 * 3 - 1;
    return manager(file, 3)->place;
}
static cm1e_place_t overlap_mailbox(cm1e_description_file_t *file)
{
    manager(file, 0)->start = 0x1078;
    return manager(file, 1)->place;
}
static cm1e_place_t end_memory_early(cm1e_description_file_t *file)
{
    DEVICE(file)->dpram_bytes = 0x0400 + 10;
    return manager(file, 3)->place;
}
static cm1e_place_t begin_at_the_end(cm1e_description_file_t *file)
{
    manager(file, 3)->start = 0xFFFF;
    return manager(file, 3)->place;
}
static cm1e_place_t reverse_outputs(cm1e_description_file_t *file)
{
    manager(file, 2)->control = 0x20;
    return manager(file, 2)->place;
}
static cm1e_place_t reverse_inputs(cm1e_description_file_t *file)
{
    manager(file, 3)->control = 0x24;
    return manager(file, 3)->place;
}
static cm1e_place_t buffer_mailbox(cm1e_description_file_t *file)
{
    manager(file, 0)->control = 0x24;
    return manager(file, 0)->place;
}
static cm1e_place_t reverse_mailbox(cm1e_description_file_t *file)
{
    manager(file, 1)->control = 0x26;
    return manager(file, 1)->place;
}
static cm1e_place_t drop_watchdog(cm1e_description_file_t *file)
{
    manager(file, 2)->control = 0x24;
    return manager(file, 2)->place;
}
static cm1e_described_sync_manager_t *add_manager(cm1e_description_file_t *file, cm1e_sync_manager_use_t use)
{
    cm1e_described_sync_manager_t *added = CM1E_APPEND(&file->arena, &DEVICE(file)->sync_managers);
    *added = (cm1e_described_sync_manager_t){.place = 7000, .use = use, .start = 0x1800, .length = 128,
                                             .control = 0x22, .enable = 1};
    return added;
}
static cm1e_place_t mailbox_behind_the_rest(cm1e_description_file_t *file)
{
    return add_manager(file, CM1E_SM_MAILBOX_IN)->place;
}
static cm1e_place_t change_size(cm1e_description_file_t *file)
{
    manager(file, 2)->length++;
    return manager(file, 2)->place;
}
static cm1e_place_t allow_too_little(cm1e_description_file_t *file)
{
    manager(file, 2)->maximum_length = 4;
    return manager(file, 2)->place;
}
static cm1e_place_t ask_too_much(cm1e_description_file_t *file)
{
    manager(file, 1)->minimum_length = 256;
    manager(file, 1)->maximum_length = 512;
    return manager(file, 1)->place;
}
static cm1e_place_t change_type_object(cm1e_description_file_t *file)
{
    cm1e_described_entry_t *entry = entry_in(&DEVICE(file)->objects, 0x1C00, 3);
    set_default(file, entry, 4);
    return entry->place;
}
static cm1e_place_t have_three(cm1e_description_file_t *file)
{
    DEVICE(file)->sync_managers_available = 3;
    return manager(file, 3)->place;
}

/* ---- FMMUs ------------------------------------------------------------------------------------------------------- */

static cm1e_place_t forget_fmmu(cm1e_description_file_t *file, cm1e_fmmu_use_t use)
{
    for (size_t i = 0; i < DEVICE(file)->fmmus.count; i++)
        if (DEVICE(file)->fmmus.at[i].use == use)
            DEVICE(file)->fmmus.at[i].use = CM1E_FMMU_UNUSED;
    return DEVICE(file)->fmmus.at[0].place;
}
static cm1e_place_t forget_outputs(cm1e_description_file_t *file) { return forget_fmmu(file, CM1E_FMMU_OUTPUTS); }
static cm1e_place_t forget_inputs(cm1e_description_file_t *file) { return forget_fmmu(file, CM1E_FMMU_INPUTS); }
static cm1e_place_t forget_state(cm1e_description_file_t *file) { return forget_fmmu(file, CM1E_FMMU_MAILBOX_STATE); }
static cm1e_place_t have_two_fmmus(cm1e_description_file_t *file)
{
    DEVICE(file)->fmmus_available = 2;
    return DEVICE(file)->fmmus.at[2].place;
}

/* ---- mailbox and EEPROM ------------------------------------------------------------------------------------------ */

static cm1e_place_t no_mailbox_bytes(cm1e_description_file_t *file)
{
    manager(file, 0)->length = 0;
    return manager(file, 0)->place;
}
static cm1e_place_t mailbox_too_short_for_sdo(cm1e_description_file_t *file)
{
    manager(file, 1)->length = 15;
    return manager(file, 1)->place;
}
static cm1e_place_t mailbox_longer_than_frame(cm1e_description_file_t *file)
{
    manager(file, 1)->length = 1487;
    manager(file, 1)->start = 0x2000;
    return manager(file, 1)->place;
}
static cm1e_place_t one_way_mailbox(cm1e_description_file_t *file)
{
    manager(file, 1)->use = CM1E_SM_UNUSED;
    return DEVICE(file)->mailbox.place;
}
static cm1e_place_t mailbox_of_no_way(cm1e_description_file_t *file)
{
    manager(file, 0)->use = manager(file, 1)->use = CM1E_SM_UNUSED;
    return DEVICE(file)->mailbox.place;
}
static cm1e_place_t mailbox_without_protocol(cm1e_description_file_t *file)
{
    DEVICE(file)->mailbox = (cm1e_mailbox_protocols_t){0};
    return manager(file, 0)->place;
}
static cm1e_place_t shorten_bootstrap(cm1e_description_file_t *file)
{
    DEVICE(file)->eeprom.bootstrap.size = 6;
    return DEVICE(file)->eeprom.place;
}
static cm1e_place_t no_foe(cm1e_description_file_t *file)
{
    DEVICE(file)->mailbox.foe = false;
    return DEVICE(file)->eeprom.place;
}

static const broken_t breaks[] = {
    BREAKS(SYNC_MANAGERS_OVERLAP, overlap_third_buffer,
           "sync manager 3 begins at 0x1117, within sync manager 2, which takes 0x1100 to 0x1117, its length "
           "three times"),
    BREAKS(SYNC_MANAGERS_OVERLAP, overlap_mailbox,
           "sync manager 1 begins at 0x1080, within sync manager 0, which takes 0x1078 to 0x10F7"),
    BREAKS(SYNC_MANAGER_BEYOND_MEMORY, end_memory_early,
           "sync manager 3 takes 0x1400 to 0x142F, its length three times; the memory ends at 0x1409"),
    BREAKS(SYNC_MANAGER_BEYOND_MEMORY, begin_at_the_end,
           "sync manager 3 takes 0xFFFF to 0x1002E, its length three times; the memory ends at 0xFFFF"),
    BREAKS(SYNC_MANAGER_CONTROL, reverse_outputs,
           "sync manager 2 is for outputs, but its control byte 0x20 is of another direction; usual is 0x64"),
    BREAKS(SYNC_MANAGER_CONTROL, reverse_inputs,
           "sync manager 3 is for inputs, but its control byte 0x24 is of another direction; usual is 0x20"),
    BREAKS(SYNC_MANAGER_CONTROL, buffer_mailbox,
           "sync manager 0 is for the mailbox to the device, but its control byte 0x24 is of another mode; usual is "
           "0x26"),
    BREAKS(SYNC_MANAGER_CONTROL, reverse_mailbox,
           "sync manager 1 is for the mailbox from the device, but its control byte 0x26 is of another direction; "
           "usual is 0x22"),
    BREAKS(SYNC_MANAGER_WATCHDOG, drop_watchdog,
           "sync manager 2 is for outputs, but its control byte 0x24 lacks the watchdog (bit 6): when the master "
           "stops, the device is not told"),
    BREAKS(SYNC_MANAGER_ORDER, mailbox_behind_the_rest,
           "sync manager 4 is for the mailbox from the device; in a device with a mailbox the mailbox has sync "
           "managers 0 and 1"),
    BREAKS(SYNC_MANAGER_SIZE, change_size, "sync manager 2 has 9 bytes by default; its PDOs have 8"),
    BREAKS(SYNC_MANAGER_RANGE, allow_too_little, "sync manager 2 has 8 bytes; it may have 0 to 4"),
    BREAKS(SYNC_MANAGER_RANGE, ask_too_much, "sync manager 1 has 128 bytes; it may have 256 to 512"),
    BREAKS(SYNC_MANAGER_TYPES, change_type_object,
           "0x1C00:03 gives sync manager 2 the type 4; it is described as type 3"),
    BREAKS(SYNC_MANAGERS_TOO_MANY, have_three, "there are 4 sync managers; the controller has 3"),
    BREAKS(FMMU_MISSING, forget_outputs, "there are outputs, but no FMMU for them"),
    BREAKS(FMMU_MISSING, forget_inputs, "there are inputs, but no FMMU for them"),
    BREAKS(FMMU_MAILBOX_MISSING, forget_state,
           "no FMMU shows the state of the mailbox in the process data: a master has to poll it"),
    BREAKS(FMMUS_TOO_MANY, have_two_fmmus, "there are 3 FMMUs; the controller has 2"),
    BREAKS(MAILBOX_SIZE, no_mailbox_bytes, "the mailbox in sync manager 0 has 0 bytes; an SDO needs at least 16"),
    BREAKS(MAILBOX_SIZE, mailbox_too_short_for_sdo,
           "the mailbox in sync manager 1 has 15 bytes; an SDO needs at least 16"),
    BREAKS(MAILBOX_SIZE, mailbox_longer_than_frame,
           "the mailbox in sync manager 1 has 1487 bytes; no frame carries more than 1486"),
    BREAKS(MAILBOX_WITHOUT_SYNC_MANAGER, one_way_mailbox,
           "there is a mailbox, but no sync manager for it from the device"),
    BREAKS(MAILBOX_WITHOUT_SYNC_MANAGER, mailbox_of_no_way, "there is a mailbox, but no sync manager for it"),
    BREAKS(MAILBOX_WITHOUT_PROTOCOL, mailbox_without_protocol,
           "there are sync managers for a mailbox, but no protocol for it is described"),
    BREAKS(BOOTSTRAP_SIZE, shorten_bootstrap,
           "the bootstrap mailbox is described by 6 bytes; words 0x14 to 0x17 of the EEPROM are 8"),
    BREAKS(BOOTSTRAP_WITHOUT_FOE, no_foe,
           "there is a bootstrap mailbox, but no FoE, with which it would be used"),
};

static void test_each_mistake_is_found_once_and_where_it_is(void)
{
    for (size_t i = 0; i < sizeof breaks / sizeof breaks[0]; i++)
        assert_found(&breaks[i], make_good);
}

/* ---- what is no mistake ------------------------------------------------------------------------------------------ */

/* Bits 4 and 5 are interrupts, bit 6 the watchdog; mode and direction decide. All 256 control bytes for every use. */
static void test_control_byte_is_judged_by_mode_and_direction_only(void)
{
    for (unsigned n = 0; n < 4; n++)
        for (unsigned control = 0; control < 256; control++) {
            cm1e_description_file_t file = {0};
            cm1e_findings_t *findings = cm1e_findings_create();
            make_good(&file);
            manager(&file, n)->control = (uint8_t)control;
            const bool mailbox_mode = (control & 3) == 2, buffered = (control & 3) == 0, writes = (control & 0xC) == 4,
                       reads = (control & 0xC) == 0;
            const bool right = n == 0   ? mailbox_mode && writes
                               : n == 1 ? mailbox_mode && reads
                               : n == 2 ? (mailbox_mode || buffered) && writes
                                        : (mailbox_mode || buffered) && reads;
            const bool watched = n != 2 || control & 0x40;
            cm1e_check_description(findings, &file);
            TEST_ASSERT_EQUAL(right && watched ? 0 : 1, cm1e_findings_count(findings));
            if (!right)
                TEST_ASSERT_EQUAL_STRING("sync-manager-control", cm1e_findings_at(findings, 0)->rule);
            cm1e_findings_free(findings);
            cm1e_description_file_free(&file);
        }
}

/* One buffer takes its length once. */
static void test_single_buffer_counts_once(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    manager(&file, 2)->control = 0x66;
    manager(&file, 3)->start = manager(&file, 2)->start + 8;
    assert_no_finding(&file);
    manager(&file, 3)->start--;
    assert_one_finding(&file, CM1E_RULE_SYNC_MANAGERS_OVERLAP, manager(&file, 3)->place,
                       "sync manager 3 begins at 0x1107, within sync manager 2, which takes 0x1100 to 0x1107");
    cm1e_description_file_free(&file);
}

/* Areas that touch; one far over two others. */
static void test_overlap_is_seen_over_a_neighbour(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    manager(&file, 3)->start = manager(&file, 2)->start + 3 * 8;
    assert_no_finding(&file);
    /* Sync manager 0 over 1 and 2. */
    manager(&file, 0)->length = 0x110;
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_check_description(findings, &file);
    TEST_ASSERT_EQUAL(2, cm1e_findings_count(findings));
    TEST_ASSERT_EQUAL(manager(&file, 1)->place, cm1e_findings_at(findings, 0)->line);
    TEST_ASSERT_EQUAL(manager(&file, 2)->place, cm1e_findings_at(findings, 1)->line);
    cm1e_findings_free(findings);
    cm1e_description_file_free(&file);
}

/* A size of 0 stands for what the PDOs have; a control byte that is not stated; sync managers on registers of digital
 * I/O, which take no memory; a sync manager without outputs needs no watchdog. */
static void test_what_is_not_stated_is_no_mistake(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    manager(&file, 2)->length = manager(&file, 3)->length = 0;
    manager(&file, 2)->enable = manager(&file, 3)->enable = 0;
    manager(&file, 2)->control_missing = true;
    manager(&file, 2)->control = 0;
    assert_no_finding(&file);
    manager(&file, 2)->control = 0x64;
    manager(&file, 2)->control_missing = false;
    manager(&file, 2)->start = 0x0F00;
    manager(&file, 3)->start = 0x0F01;
    assert_no_finding(&file);
    cm1e_described_sync_manager_t *added = add_manager(&file, CM1E_SM_OUTPUTS);
    added->length = 0;
    added->control = 0x24;
    assert_no_finding(&file);
    cm1e_description_file_free(&file);
}

/* What just fits. */
static void test_limits_may_be_used_up(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    manager(&file, 2)->minimum_length = manager(&file, 2)->maximum_length = 8;
    DEVICE(&file)->sync_managers_available = 4;
    DEVICE(&file)->fmmus_available = 3;
    DEVICE(&file)->dpram_bytes = 0x0400 + 3 * 16;
    manager(&file, 0)->length = manager(&file, 1)->length = 16;
    assert_no_finding(&file);
    manager(&file, 1)->start = 0x3000;
    manager(&file, 1)->length = 1486;
    DEVICE(&file)->dpram_bytes = 0;
    assert_no_finding(&file);
    cm1e_description_file_free(&file);
}

/* A device that has inputs only needs no FMMU for outputs, though another sync manager is there. */
static void test_fmmu_is_needed_for_what_is_used(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    cm1e_description_t *device = DEVICE(&file);
    size_t kept = 0;
    for (size_t i = 0; i < device->pdos.count; i++)
        if (device->pdos.at[i].transmit)
            device->pdos.at[kept++] = device->pdos.at[i];
    device->pdos.count = kept;
    device->init_commands.count = device->objects.count = 0;
    device->fmmus.at[0].use = CM1E_FMMU_UNUSED;
    assert_no_finding(&file);
    cm1e_description_file_free(&file);
}

/* A file that states no FMMU says nothing of them. */
static void test_fmmus_that_no_file_states_are_no_mistake(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    DEVICE(&file)->fmmus.count = 0;
    assert_no_finding(&file);
    cm1e_description_file_free(&file);
}

/* Digital inputs of a controller without processor: 0x1000 to 0x1003, a byte each, without buffers. */
static void test_digital_inputs_have_no_buffers(void)
{
    cm1e_description_file_t file = {0};
    cm1e_describe_io_module(&file);
    number_places(&file);
    manager(&file, 0)->start = 0x0F00;
    manager(&file, 1)->start = 0x1000;
    cm1e_described_sync_manager_t *second = add_manager(&file, CM1E_SM_INPUTS);
    second->start = 0x1001;
    second->length = 1;
    second->control = 0x00;
    assert_no_finding(&file);
    manager(&file, 1)->start = 0x1004;
    second->start = 0x1005;
    assert_one_finding(&file, CM1E_RULE_SYNC_MANAGERS_OVERLAP, 7000,
                       "sync manager 2 begins at 0x1005, within sync manager 1, which takes 0x1004 to 0x1006, its "
                       "length three times");
    cm1e_description_file_free(&file);
}

/* The order of sync managers is fixed by 0x1C12 and 0x1C13; a device without mailbox has no such order. */
static void test_order_is_of_devices_with_a_mailbox(void)
{
    cm1e_description_file_t file = {0};
    cm1e_describe_io_module(&file);
    number_places(&file);
    assert_no_finding(&file);
    cm1e_description_file_free(&file);

    make_good(&file);
    const cm1e_described_sync_manager_t outputs = *manager(&file, 2);
    *manager(&file, 2) = *manager(&file, 3);
    *manager(&file, 3) = outputs;
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_check_description(findings, &file);
    bool seen = false;
    for (size_t i = 0; i < cm1e_findings_count(findings); i++)
        seen = seen || strcmp(cm1e_findings_at(findings, i)->text,
                              "sync manager 2 is for inputs; in a device with a mailbox 0 and 1 are the mailbox, 2 is "
                              "for outputs, 3 for inputs") == 0;
    TEST_ASSERT_TRUE(seen);
    cm1e_findings_free(findings);
    cm1e_description_file_free(&file);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_mistake_is_found_once_and_where_it_is);
    RUN_TEST(test_control_byte_is_judged_by_mode_and_direction_only);
    RUN_TEST(test_single_buffer_counts_once);
    RUN_TEST(test_overlap_is_seen_over_a_neighbour);
    RUN_TEST(test_what_is_not_stated_is_no_mistake);
    RUN_TEST(test_limits_may_be_used_up);
    RUN_TEST(test_fmmu_is_needed_for_what_is_used);
    RUN_TEST(test_fmmus_that_no_file_states_are_no_mistake);
    RUN_TEST(test_digital_inputs_have_no_buffers);
    RUN_TEST(test_order_is_of_devices_with_a_mailbox);
    return UNITY_END();
}
