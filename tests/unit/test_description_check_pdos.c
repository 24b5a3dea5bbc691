/* The cross-checker: what PDOs, mapping and assignment objects and start-up commands say, each broken in one way. */
#include "broken_description.h"

void setUp(void) {}
void tearDown(void) {}

#define DEVICE(file) (&(file)->devices.at[0])

/* CSP mapping, 0x1601 and 0x1A01; 0x6081 stands in 0x1603 only. */
static void make_good(cm1e_description_file_t *file)
{
    const cm1e_device_options_t options = {.mapping = CM1E_MAPPING_CSP};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(file, &options, CM1E_ESI_FLAT, NULL));
    number_places(file);
}

static cm1e_described_pdo_entry_t *mapped_6081(cm1e_description_file_t *file)
{
    return pdo_entry_in(&DEVICE(file)->pdos, 0x1603, 0x6081);
}
static cm1e_described_entry_t *entry_6081(cm1e_description_file_t *file)
{
    return entry_in(&DEVICE(file)->objects, 0x6081, 0);
}

/* A PDO that has to be right but for what is broken. */
static cm1e_described_pdo_t *add_pdo(cm1e_description_file_t *file, uint16_t index, bool transmit)
{
    cm1e_described_pdo_t *pdo = CM1E_APPEND(&file->arena, &DEVICE(file)->pdos);
    pdo->place = 6000;
    pdo->index = index;
    pdo->transmit = transmit;
    pdo->name = "added";
    pdo->sync_manager = CM1E_NO_SYNC_MANAGER;
    return pdo;
}

/* The default assignment is not stated, nor commanded. */
static void forget_assignment(cm1e_description_file_t *file)
{
    set_default(file, entry_in(&DEVICE(file)->objects, 0x1C12, 0), 0);
    set_default(file, entry_in(&DEVICE(file)->objects, 0x1C13, 0), 0);
    DEVICE(file)->init_commands.count = 0;
}

/* ---- entries ----------------------------------------------------------------------------------------------------- */

static cm1e_place_t remove_object(cm1e_description_file_t *file)
{
    cm1e_object_list_t *objects = &DEVICE(file)->objects;
    cm1e_described_object_t *object = object_in(objects, 0x6081), *end = objects->at + objects->count;
    memmove(object, object + 1, (size_t)((char *)end - (char *)(object + 1)));
    objects->count--;
    return mapped_6081(file)->place;
}
static cm1e_place_t map_missing_subindex(cm1e_description_file_t *file)
{
    set_default(file, entry_in(&DEVICE(file)->objects, 0x1603, 0), 0);
    mapped_6081(file)->subindex = 7;
    return mapped_6081(file)->place;
}
static cm1e_place_t shorten_object(cm1e_description_file_t *file)
{
    cm1e_described_entry_t *entry = entry_6081(file);
    entry->bits = 16;
    entry->type = "UINT";
    entry->minimum = entry->maximum = entry->default_data = (cm1e_bytes_t){0};
    return mapped_6081(file)->place;
}
static cm1e_place_t shorten_mapped(cm1e_description_file_t *file)
{
    mapped_6081(file)->bits = 16;
    mapped_6081(file)->type = "UINT";
    return mapped_6081(file)->place;
}
static cm1e_place_t change_type(cm1e_description_file_t *file)
{
    mapped_6081(file)->type = "UINT";
    return mapped_6081(file)->place;
}
static cm1e_place_t misspell_type(cm1e_description_file_t *file)
{
    mapped_6081(file)->type = "UDNIT";
    return mapped_6081(file)->place;
}
static cm1e_place_t forbid_mapping(cm1e_description_file_t *file)
{
    entry_6081(file)->access &= (uint8_t)~CM1E_ACCESS_RXPDO;
    return mapped_6081(file)->place;
}
static cm1e_place_t mapping_in_the_other_direction(cm1e_description_file_t *file)
{
    entry_6081(file)->access = CM1E_ACCESS_READ | CM1E_ACCESS_WRITE | CM1E_ACCESS_TXPDO;
    return mapped_6081(file)->place;
}

/* ---- PDOs -------------------------------------------------------------------------------------------------------- */

static cm1e_place_t add_pdo_again(cm1e_description_file_t *file)
{
    const cm1e_described_pdo_t again = *pdo_in(&DEVICE(file)->pdos, 0x1603);
    cm1e_described_pdo_t *pdo = add_pdo(file, 0x1603, false);
    *pdo = again;
    pdo->place = 6000;
    pdo->excludes.count = 0;
    return 6000;
}
static cm1e_place_t add_pdo_of_odd_index(cm1e_description_file_t *file) { return add_pdo(file, 0x1800, false)->place; }
static cm1e_place_t carry_by_missing_sync_manager(cm1e_description_file_t *file)
{
    add_pdo(file, 0x1A10, true)->sync_manager = 7;
    return 6000;
}
static cm1e_place_t carry_by_other_direction(cm1e_description_file_t *file)
{
    add_pdo(file, 0x1A10, true)->sync_manager = 2;
    forget_assignment(file);
    return 6000;
}
static cm1e_place_t mandatory_but_not_assigned(cm1e_description_file_t *file)
{
    pdo_in(&DEVICE(file)->pdos, 0x1603)->mandatory = true;
    return pdo_in(&DEVICE(file)->pdos, 0x1603)->place;
}
static cm1e_place_t assign_none(cm1e_description_file_t *file)
{
    forget_assignment(file);
    pdo_in(&DEVICE(file)->pdos, 0x1601)->sync_manager = CM1E_NO_SYNC_MANAGER;
    return DEVICE(file)->sync_managers.at[2].place;
}

/* ---- Exclude ----------------------------------------------------------------------------------------------------- */

static cm1e_place_t exclude_on_one_side(cm1e_description_file_t *file)
{
    cm1e_pdo_list_t *pdos = &DEVICE(file)->pdos;
    cm1e_described_pdo_t *pdo = pdo_in(pdos, 0x1603);
    const uint16_t forgotten = pdo->excludes.at[--pdo->excludes.count].index;
    TEST_ASSERT_EQUAL_HEX16(0x1602, forgotten);
    const cm1e_described_pdo_t *other = pdo_in(pdos, forgotten);
    return other->excludes.at[other->excludes.count - 1].place;
}
static cm1e_place_t exclude(cm1e_description_file_t *file, uint16_t index)
{
    cm1e_exclude_t *added = CM1E_APPEND(&file->arena, &pdo_in(&DEVICE(file)->pdos, 0x1603)->excludes);
    added->index = index;
    added->place = 6000;
    return 6000;
}
static cm1e_place_t exclude_missing(cm1e_description_file_t *file) { return exclude(file, 0x1650); }
static cm1e_place_t exclude_twice(cm1e_description_file_t *file) { return exclude(file, 0x1601); }
static cm1e_place_t exclude_itself(cm1e_description_file_t *file) { return exclude(file, 0x1603); }
static cm1e_place_t assign_excluded(cm1e_description_file_t *file)
{
    forget_assignment(file);
    DEVICE(file)->sync_managers.at[2].length = 0;
    pdo_in(&DEVICE(file)->pdos, 0x1603)->sync_manager = 2;
    const cm1e_described_pdo_t *pdo = pdo_in(&DEVICE(file)->pdos, 0x1601);
    return pdo->excludes.at[pdo->excludes.count - 1].place;
}

/* ---- mapping and assignment -------------------------------------------------------------------------------------- */

static cm1e_place_t map_other_length(cm1e_description_file_t *file)
{
    set_default(file, entry_in(&DEVICE(file)->objects, 0x1603, 1), 0x60400020);
    return entry_in(&DEVICE(file)->objects, 0x1603, 1)->place;
}
static cm1e_place_t map_other_order(cm1e_description_file_t *file)
{
    cm1e_described_entry_t *rows[] = {entry_in(&DEVICE(file)->objects, 0x1603, 1),
                                      entry_in(&DEVICE(file)->objects, 0x1603, 2)};
    const cm1e_bytes_t first = rows[0]->default_data;
    rows[0]->default_data = rows[1]->default_data;
    rows[1]->default_data = first;
    return rows[0]->place;
}
static cm1e_place_t map_fewer(cm1e_description_file_t *file)
{
    set_default(file, entry_in(&DEVICE(file)->objects, 0x1603, 0), 6);
    return entry_in(&DEVICE(file)->objects, 0x1603, 0)->place;
}
static cm1e_place_t command_mapping(cm1e_description_file_t *file)
{
    entry_in(&DEVICE(file)->objects, 0x1603, 0)->access |= CM1E_ACCESS_WRITE;
    entry_in(&DEVICE(file)->objects, 0x1603, 1)->access |= CM1E_ACCESS_WRITE;
    add_command(file, 0x1603, 1, 0x60600008, 4)->place = 5001;
    add_command(file, 0x1603, 0, 1, 1);
    return 5001;
}
static cm1e_place_t assign_other_by_default(cm1e_description_file_t *file)
{
    set_default(file, entry_in(&DEVICE(file)->objects, 0x1C12, 1), 0x1602);
    return entry_in(&DEVICE(file)->objects, 0x1C12, 1)->place;
}
static cm1e_init_command_t *command_for(cm1e_description_file_t *file, uint16_t index, uint8_t subindex)
{
    cm1e_init_command_t *found = NULL;
    for (size_t i = 0; i < DEVICE(file)->init_commands.count; i++)
        if (DEVICE(file)->init_commands.at[i].index == index && DEVICE(file)->init_commands.at[i].subindex == subindex)
            found = &DEVICE(file)->init_commands.at[i];
    TEST_ASSERT_NOT_NULL(found);
    return found;
}
static cm1e_place_t command_other_assignment(cm1e_description_file_t *file)
{
    command_for(file, 0x1C13, 1)->data = cm1e_bytes_of(&file->arena, 0x1A02, 2);
    return command_for(file, 0x1C13, 1)->place;
}
static cm1e_place_t command_too_many(cm1e_description_file_t *file)
{
    entry_in(&DEVICE(file)->objects, 0x1C13, 0)->maximum = (cm1e_bytes_t){0};
    command_for(file, 0x1C13, 0)->data = cm1e_bytes_of(&file->arena, 2, 1);
    return command_for(file, 0x1C13, 0)->place;
}

static cm1e_place_t command_absurd_number(cm1e_description_file_t *file)
{
    entry_in(&DEVICE(file)->objects, 0x1C13, 0)->maximum = (cm1e_bytes_t){0};
    command_for(file, 0x1C13, 0)->data = cm1e_bytes_of(&file->arena, 255, 1);
    return command_for(file, 0x1C13, 0)->place;
}

/* ---- start-up commands ------------------------------------------------------------------------------------------- */

static cm1e_place_t command_missing(cm1e_description_file_t *file)
{
    return add_command(file, 0x2FFF, 1, 0, 1)->place;
}
static cm1e_place_t command_read_only(cm1e_description_file_t *file)
{
    return add_command(file, 0x6041, 0, 0, 2)->place;
}
static cm1e_place_t command_too_long(cm1e_description_file_t *file)
{
    return add_command(file, 0x6060, 0, 8, 2)->place;
}
static cm1e_place_t command_out_of_range(cm1e_description_file_t *file)
{
    return add_command(file, 0x6098, 0, 99, 1)->place;
}
static cm1e_place_t command_all_at_once(cm1e_description_file_t *file)
{
    add_command(file, 0x6099, 0, 0, 8)->complete_access = true;
    return 5000;
}

static const broken_t breaks[] = {
    BREAKS(PDO_ENTRY_NOT_IN_DICTIONARY, remove_object,
        "RxPDO 0x1603 maps 0x6081:00, an object that is not in the dictionary"),
    BREAKS(PDO_ENTRY_NOT_IN_DICTIONARY, map_missing_subindex,
        "RxPDO 0x1603 maps 0x6081:07, a sub-index that the object does not have"),
    BREAKS(PDO_ENTRY_SIZE, shorten_object, "RxPDO 0x1603 maps 0x6081:00 with 32 bits; the object has 16"),
    BREAKS(PDO_ENTRY_SIZE, shorten_mapped, "RxPDO 0x1603 maps 0x6081:00 with 16 bits; the object has 32"),
    BREAKS(TYPE_UNKNOWN, misspell_type, "0x6081:00 in RxPDO 0x1603 is of the type UDNIT, which is neither defined in the "
           "dictionary nor a base type"),
    BREAKS(PDO_ENTRY_TYPE, change_type, "RxPDO 0x1603 gives 0x6081:00 32 bits and the type UINT, which has 16"),
    BREAKS(PDO_ENTRY_NOT_MAPPABLE, forbid_mapping,
        "RxPDO 0x1603 maps 0x6081:00, which the dictionary does not mark as mappable in a RxPDO"),
    BREAKS(PDO_ENTRY_NOT_MAPPABLE, mapping_in_the_other_direction,
        "RxPDO 0x1603 maps 0x6081:00, which the dictionary does not mark as mappable in a RxPDO"),
    BREAKS(PDO_TWICE, add_pdo_again, "there are two PDOs 0x1603"),
    BREAKS(PDO_INDEX, add_pdo_of_odd_index, "RxPDO 0x1800: RxPDOs have the indexes 0x1600 to 0x17FF"),
    BREAKS(PDO_SYNC_MANAGER, carry_by_missing_sync_manager,
        "TxPDO 0x1A10 is assigned to sync manager 7; the device has 4"),
    BREAKS(PDO_SYNC_MANAGER, carry_by_other_direction,
        "TxPDO 0x1A10 is assigned to sync manager 2, which is not for inputs"),
    BREAKS(PDO_MANDATORY_UNASSIGNED, mandatory_but_not_assigned,
        "RxPDO 0x1603 is mandatory, but no sync manager carries it"),
    BREAKS(NO_PDO_ASSIGNED, assign_none,
        "none of the 4 RxPDOs is assigned to a sync manager: without a choice by hand there are no outputs"),
    BREAKS(EXCLUDE_ONE_SIDED, exclude_on_one_side, "RxPDO 0x1602 excludes 0x1603, but 0x1603 does not exclude 0x1602"),
    BREAKS(EXCLUDE_MISSING, exclude_missing, "RxPDO 0x1603 excludes 0x1650, which is not there"),
    BREAKS(EXCLUDE_TWICE, exclude_twice, "RxPDO 0x1603 excludes 0x1601 twice"),
    BREAKS(EXCLUDE_ITSELF, exclude_itself, "RxPDO 0x1603 excludes itself"),
    BREAKS(EXCLUDED_ASSIGNED, assign_excluded, "0x1601 and 0x1603 exclude each other, but sync manager 2 carries both"),
    BREAKS(MAPPING_OBJECT, map_other_length,
        "0x1603:01 maps by default 0x6040:00 with 32 bits; entry 1 of RxPDO 0x1603 is 0x6040:00 with 16 bits"),
    BREAKS(MAPPING_OBJECT, map_other_order,
        "0x1603:01 maps by default 0x60FE:00 with 16 bits; entry 1 of RxPDO 0x1603 is 0x6040:00 with 16 bits"),
    BREAKS(MAPPING_OBJECT, map_fewer, "0x1603:00 maps by default 6 objects; RxPDO 0x1603 has 7"),
    BREAKS(MAPPING_COMMAND, command_mapping,
        "0x1603:01 maps after start-up 0x6060:00 with 8 bits; entry 1 of RxPDO 0x1603 is 0x6040:00 with 16 bits"),
    BREAKS(ASSIGNMENT_OBJECT, assign_other_by_default,
        "0x1C12:01 is by default 0x1602; by its Sm, PDO 1 of sync manager 2 is 0x1601"),
    BREAKS(ASSIGNMENT_COMMAND, command_other_assignment,
        "0x1C13:01 becomes at start-up 0x1A02; by its Sm, PDO 1 of sync manager 3 is 0x1A01"),
    BREAKS(ASSIGNMENT_COMMAND, command_too_many,
        "0x1C13:00 becomes at start-up 2 PDOs; sync manager 3 has 1 by their Sm"),
    BREAKS(ASSIGNMENT_COMMAND, command_absurd_number,
           "0x1C13:00 becomes at start-up 255 PDOs; sync manager 3 has 1 by their Sm"),
    BREAKS(INIT_COMMAND_OBJECT, command_missing,
        "the start-up command writes 0x2FFF:01, which is not in the dictionary"),
    BREAKS(INIT_COMMAND_READ_ONLY, command_read_only, "the start-up command writes 0x6041:00, which is read-only"),
    BREAKS(INIT_COMMAND_SIZE, command_too_long,
        "the start-up command writes 2 bytes to 0x6060:00, which has 8 bits, 1 byte"),
    BREAKS(INIT_COMMAND_RANGE, command_out_of_range,
        "the start-up command writes 99 to 0x6098:00; its range is -6 to 0"),
    BREAKS(INIT_COMMAND_COMPLETE_ACCESS, command_all_at_once,
        "the start-up command writes all of 0x6099 at once, but the device does not announce complete access"),
};

static void test_each_mistake_is_found_once_and_where_it_is(void)
{
    for (size_t i = 0; i < sizeof breaks / sizeof breaks[0]; i++)
        assert_found(&breaks[i], make_good);
}

/* ---- what is no mistake ------------------------------------------------------------------------------------------ */

/* Gaps between entries, in the PDO in one piece and in the mapping object in two. */
static void test_gaps_may_be_cut_differently(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    cm1e_described_pdo_t *pdo = pdo_in(&DEVICE(&file)->pdos, 0x1603);
    pdo->entries.at[3].index = 0;
    pdo->entries.at[3].type = "";
    pdo->entries.at[4].index = 0;
    pdo->entries.at[4].type = "";
    pdo->entries.at[3].bits = 48;
    pdo->entries.at[4].bits = 16;
    set_default(&file, entry_in(&DEVICE(&file)->objects, 0x1603, 4), 32);
    set_default(&file, entry_in(&DEVICE(&file)->objects, 0x1603, 5), 32);
    assert_no_finding(&file);
    cm1e_description_file_free(&file);
}

/* UG 7.2.5: the device maps 16 bits of 0x6079, which has 32. */
static void test_device_may_map_part_of_an_object_but_never_more(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    mapped_6081(&file)->bits = 16;
    mapped_6081(&file)->type = "UINT";
    set_default(&file, entry_in(&DEVICE(&file)->objects, 0x1603, 5), 0x60810010);
    assert_no_finding(&file);
    mapped_6081(&file)->bits = 64;
    mapped_6081(&file)->type = "ULINT";
    set_default(&file, entry_in(&DEVICE(&file)->objects, 0x1603, 5), 0x60810040);
    assert_one_finding(&file, CM1E_RULE_PDO_ENTRY_SIZE, mapped_6081(&file)->place,
                       "RxPDO 0x1603 maps 0x6081:00 with 64 bits; the object has 32");
    cm1e_description_file_free(&file);
}

/* A device without dictionary (SII); one that does not state what can be mapped, nor the default mapping. */
static void test_what_is_not_stated_is_no_mistake(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    cm1e_description_t *device = DEVICE(&file);
    const size_t objects = device->objects.count;
    device->objects.count = 0;
    assert_no_finding(&file);
    device->objects.count = objects;
    for (size_t i = 0; i < objects; i++)
        for (size_t j = 0; j < device->objects.at[i].entries.count; j++) {
            cm1e_described_entry_t *entry = &device->objects.at[i].entries.at[j];
            entry->access &= (uint8_t)~(CM1E_ACCESS_RXPDO | CM1E_ACCESS_TXPDO);
            if (device->objects.at[i].index >= 0x1600 && device->objects.at[i].index < 0x1A00)
                entry->default_data = (cm1e_bytes_t){0};
        }
    assert_no_finding(&file);
    cm1e_description_file_free(&file);
}

/* A text may be written shorter than its room, a number may not. */
static void test_command_may_write_a_shorter_text(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    entry_in(&DEVICE(&file)->objects, 0x1008, 0)->access |= CM1E_ACCESS_WRITE;
    cm1e_init_command_t *command = add_command(&file, 0x1008, 0, -6, 1);
    assert_no_finding(&file);
    command->index = 0x6098;
    assert_no_finding(&file);
    command->index = 0x6081;
    assert_one_finding(&file, CM1E_RULE_INIT_COMMAND_SIZE, command->place,
                       "the start-up command writes 1 byte to 0x6081:00, which has 32 bits, 4 bytes");
    cm1e_description_file_free(&file);
}

/* Excluded by one side only, and both assigned: two findings, whichever side it is. */
static void test_one_sided_exclusion_counts(void)
{
    for (int side = 0; side < 2; side++) {
        cm1e_description_file_t file = {0};
        cm1e_findings_t *findings = cm1e_findings_create();
        make_good(&file);
        forget_assignment(&file);
        DEVICE(&file)->sync_managers.at[2].length = 0;
        for (size_t i = 0; i < DEVICE(&file)->pdos.count; i++)
            DEVICE(&file)->pdos.at[i].excludes.count = 0;
        pdo_in(&DEVICE(&file)->pdos, 0x1603)->sync_manager = 2;
        cm1e_described_pdo_t *pdo = pdo_in(&DEVICE(&file)->pdos, side ? 0x1601 : 0x1603);
        pdo->excludes.count = 1;
        pdo->excludes.at[0].index = side ? 0x1603 : 0x1601;
        cm1e_check_description(findings, &file);
        TEST_ASSERT_EQUAL(2, cm1e_findings_count(findings));
        TEST_ASSERT_EQUAL_STRING("exclude-one-sided", cm1e_findings_at(findings, 0)->rule);
        TEST_ASSERT_EQUAL_STRING("excluded-assigned", cm1e_findings_at(findings, 1)->rule);
        cm1e_findings_free(findings);
        cm1e_description_file_free(&file);
    }
}

/* A row of 0 is filled in by the device. */
static void test_row_that_the_device_fills_in_is_no_mistake(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    entry_in(&DEVICE(&file)->objects, 0x1C12, 1)->minimum = (cm1e_bytes_t){0};
    set_default(&file, entry_in(&DEVICE(&file)->objects, 0x1C12, 1), 0);
    set_default(&file, entry_in(&DEVICE(&file)->objects, 0x1603, 1), 0);
    assert_no_finding(&file);
    cm1e_description_file_free(&file);
}

static void test_virtual_pdo_maps_what_it_likes(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    cm1e_described_pdo_t *pdo = add_pdo(&file, 0x1A10, true);
    pdo->is_virtual = true;
    cm1e_described_pdo_entry_t *entry = CM1E_APPEND(&file.arena, &pdo->entries);
    entry->index = 0x5555;
    entry->bits = 16;
    assert_no_finding(&file);
    cm1e_description_file_free(&file);
}

/* Complete access writes count and rows of an assignment at once. */
static void test_assignment_by_complete_access_is_understood(void)
{
    static const uint8_t right[] = {1, 0, 0x01, 0x16}, wrong[] = {1, 0, 0x02, 0x16};
    cm1e_description_file_t file = {0};
    make_good(&file);
    DEVICE(&file)->mailbox.complete_access = true;
    DEVICE(&file)->init_commands.count = 0;
    cm1e_init_command_t *command = add_command(&file, 0x1C12, 0, 0, 1);
    command->complete_access = true;
    command->data = (cm1e_bytes_t){right, sizeof right};
    assert_no_finding(&file);
    command->data = (cm1e_bytes_t){wrong, sizeof wrong};
    assert_one_finding(&file, CM1E_RULE_ASSIGNMENT_COMMAND, command->place,
                       "0x1C12:01 becomes at start-up 0x1602; by its Sm, PDO 1 of sync manager 2 is 0x1601");
    cm1e_description_file_free(&file);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_mistake_is_found_once_and_where_it_is);
    RUN_TEST(test_gaps_may_be_cut_differently);
    RUN_TEST(test_device_may_map_part_of_an_object_but_never_more);
    RUN_TEST(test_what_is_not_stated_is_no_mistake);
    RUN_TEST(test_command_may_write_a_shorter_text);
    RUN_TEST(test_one_sided_exclusion_counts);
    RUN_TEST(test_row_that_the_device_fills_in_is_no_mistake);
    RUN_TEST(test_virtual_pdo_maps_what_it_likes);
    RUN_TEST(test_assignment_by_complete_access_is_understood);
    return UNITY_END();
}
