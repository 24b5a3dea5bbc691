/* The cross-checker on modular devices: slots and modules, and the rules of flat devices once every slot is filled; and
 * the expansion itself. */
#include "broken_description.h"
#include "description/expand.h"

void setUp(void) {}
void tearDown(void) {}

#define DEVICE(file) (&(file)->devices.at[0])
enum { DYNAMIC = 0, CSP = 1, PROFILE = 3 };

/* Two axes; the second may be absent, and is by default. Modules do not share anything, so that one can be broken. */
static void make_good(cm1e_description_file_t *file)
{
    const cm1e_device_options_t options = {.mapping = CM1E_MAPPING_CSP};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(file, &options, CM1E_ESI_MDP, NULL));
    const cm1e_slot_t first = DEVICE(file)->slots.at[0];
    cm1e_slot_t *second = CM1E_APPEND(&file->arena, &DEVICE(file)->slots);
    second->name = "Second axis";
    second->maximum_instances = 1;
    for (size_t i = 0; i < first.choices.count; i++) {
        cm1e_slot_choice_t *choice = CM1E_APPEND(&file->arena, &second->choices);
        choice->ident = first.choices.at[i].ident;
    }
    for (size_t m = 0; m < file->modules.count; m++) {
        for (size_t i = 0; i < file->modules.at[m].objects.count; i++) {
            cm1e_described_object_t *object = &file->modules.at[m].objects.at[i];
            const cm1e_described_object_t shared = *object;
            object->entries.at = NULL, object->entries.count = 0;
            for (size_t j = 0; j < shared.entries.count; j++)
                *(cm1e_described_entry_t *)CM1E_APPEND(&file->arena, &object->entries) = shared.entries.at[j];
        }
        /* Of which a part is mapped: a second axis has no mapping object that says so. */
        cm1e_described_entry_t *voltage = entry_in(&file->modules.at[m].objects, 0x6079, 0);
        voltage->type = "INT";
        voltage->bits = 16;
        voltage->default_data = voltage->minimum = voltage->maximum = (cm1e_bytes_t){0};
    }
    number_places(file);
}

/* The dictionary of the device still says what PDO is assigned: not a matter of these. */
static void forget_assignment(cm1e_description_file_t *file)
{
    set_default(file, entry_in(&DEVICE(file)->objects, 0x1C12, 0), 0);
    set_default(file, entry_in(&DEVICE(file)->objects, 0x1C13, 0), 0);
    DEVICE(file)->init_commands.count = 0;
}

static cm1e_place_t name_missing_module(cm1e_description_file_t *file)
{
    DEVICE(file)->slots.at[1].choices.at[3].ident = 0x777;
    return DEVICE(file)->slots.at[1].choices.at[3].place;
}
static cm1e_place_t two_defaults(cm1e_description_file_t *file)
{
    DEVICE(file)->slots.at[0].choices.at[3].is_default = true;
    return DEVICE(file)->slots.at[0].choices.at[3].place;
}
static cm1e_place_t no_default(cm1e_description_file_t *file)
{
    forget_assignment(file);
    DEVICE(file)->slots.at[0].choices.at[CSP].is_default = false;
    return DEVICE(file)->slots.at[0].place;
}
static cm1e_place_t impossible_instances(cm1e_description_file_t *file)
{
    DEVICE(file)->slots.at[1].minimum_instances = 2;
    return DEVICE(file)->slots.at[1].place;
}
static cm1e_place_t add_module_again(cm1e_description_file_t *file)
{
    const uint32_t ident = file->modules.at[0].ident;
    cm1e_module_t *module = CM1E_APPEND(&file->arena, &file->modules);
    module->ident = ident;
    module->place = 9000;
    return 9000;
}

/* Both axes at once; what an added object and PDO of the first axis have, the increments give to the second's. */
static void choose_both_axes(cm1e_description_file_t *file)
{
    DEVICE(file)->slots.at[1].choices.at[CSP].is_default = true;
    DEVICE(file)->sync_managers.at[2].length = DEVICE(file)->sync_managers.at[3].length = 0;
    forget_assignment(file);
}
static cm1e_place_t object_in_the_place_of_the_second_axis(cm1e_description_file_t *file)
{
    choose_both_axes(file);
    cm1e_described_object_t *object = CM1E_APPEND(&file->arena, &file->modules.at[CSP].objects);
    *object = (cm1e_described_object_t){.index = 0x6502 + 0x800, .depends_on_slot = true, .name = "added", .type = ""};
    return object_in(&file->modules.at[CSP].objects, 0x6502)->place;
}
static cm1e_place_t pdo_in_the_place_of_the_second_axis(cm1e_description_file_t *file)
{
    choose_both_axes(file);
    cm1e_described_pdo_t *pdo = CM1E_APPEND(&file->arena, &file->modules.at[CSP].pdos);
    pdo->index = 0x1601 + 0x10;
    pdo->depends_on_slot = true;
    pdo->sync_manager = CM1E_NO_SYNC_MANAGER;
    return pdo_in(&file->modules.at[CSP].pdos, 0x1601)->place;
}

/* In a module that nobody chooses by default, and in both slots: one mistake, one finding. */
static cm1e_place_t shorten_object_of_an_alternative(cm1e_description_file_t *file)
{
    cm1e_described_entry_t *entry = entry_in(&file->modules.at[PROFILE].objects, 0x6081, 0);
    entry->bits = 16;
    entry->type = "UINT";
    entry->minimum = entry->maximum = entry->default_data = (cm1e_bytes_t){0};
    return pdo_entry_in(&file->modules.at[PROFILE].pdos, 0x1603, 0x6081)->place;
}
static cm1e_place_t entry_of_the_first_axis(cm1e_description_file_t *file)
{
    cm1e_described_pdo_entry_t *entry = pdo_entry_in(&file->modules.at[PROFILE].pdos, 0x1603, 0x6081);
    entry->depends_on_slot = false;
    return entry->place;
}
static cm1e_place_t command_to_the_first_axis(cm1e_description_file_t *file)
{
    file->modules.at[DYNAMIC].init_commands.at[0].depends_on_slot = false;
    return file->modules.at[DYNAMIC].init_commands.at[0].place;
}
static cm1e_place_t command_in_module_too_long(cm1e_description_file_t *file)
{
    cm1e_init_command_t *command = &file->modules.at[DYNAMIC].init_commands.at[0];
    command->depends_on_slot = true;
    command->data = cm1e_bytes_of(&file->arena, 8, 2);
    return command->place;
}
static cm1e_place_t object_twice_in_module(cm1e_description_file_t *file)
{
    const cm1e_described_object_t again = *object_in(&file->modules.at[DYNAMIC].objects, 0x6502);
    cm1e_described_object_t *object = CM1E_APPEND(&file->arena, &file->modules.at[DYNAMIC].objects);
    *object = again;
    object->place = 9000;
    return 9000;
}

static cm1e_place_t device_again(cm1e_description_file_t *file)
{
    const cm1e_description_t again = file->devices.at[0];
    cm1e_description_t *device = CM1E_APPEND(&file->arena, &file->devices);
    *device = again;
    device->identity_place = 9000;
    return 9000;
}

static const broken_t breaks[] = {
    BREAKS(SLOT_MODULE_MISSING, name_missing_module,
           "slot 1 Second axis names module 0x00000777, which is not in the file"),
    BREAKS(SLOT_DEFAULTS, two_defaults, "slot 0 Axis has two default modules"),
    BREAKS(SLOT_NO_DEFAULT, no_default, "slot 0 Axis must hold a module, but none is the default"),
    BREAKS(SLOT_INSTANCES, impossible_instances, "slot 1 Second axis is there at least 2 times, but at most 1 times"),
    BREAKS(PDO_ENTRY_SIZE, shorten_object_of_an_alternative,
           "RxPDO 0x1603 maps 0x6081:00 with 32 bits; the object has 16"),
    BREAKS(SLOT_DEPENDENCE, entry_of_the_first_axis,
           "RxPDO names 0x6081 as the same in every slot, but the object depends on the slot"),
    BREAKS(SLOT_DEPENDENCE, command_to_the_first_axis,
           "the start-up command names 0x6060 as the same in every slot, but the object depends on the slot"),
    BREAKS(OBJECT_TWICE, object_in_the_place_of_the_second_axis,
           "the object 0x6D02 (Supported drive modes) is in the dictionary twice"),
    BREAKS(PDO_TWICE, pdo_in_the_place_of_the_second_axis, "there are two PDOs 0x1611"),
    BREAKS(DEVICE_TWICE, device_again,
           "there is a device of product code 0x44412002 and revision 0x20020103 before this one: which of them a "
           "master takes is not defined"),
    BREAKS(MODULE_TWICE, add_module_again, "there are two modules with the ident 0x00119860"),
    BREAKS(INIT_COMMAND_SIZE, command_in_module_too_long,
           "the start-up command writes 2 bytes to 0x6060:00, which has 8 bits, 1 byte"),
    BREAKS(OBJECT_TWICE, object_twice_in_module,
           "the object 0x6502 (Supported drive modes) is in the dictionary twice"),
};

static void test_each_mistake_is_found_once_and_where_it_is(void)
{
    for (size_t i = 0; i < sizeof breaks / sizeof breaks[0]; i++)
        assert_found(&breaks[i], make_good);
}

/* ---- expansion --------------------------------------------------------------------------------------------------- */

static void test_places_are_bounded_and_filled_by_default(void)
{
    cm1e_description_file_t file = {0};
    uint32_t idents[6];
    make_good(&file);
    cm1e_description_t *device = DEVICE(&file);
    TEST_ASSERT_EQUAL(2, cm1e_description_places(device));
    cm1e_description_default_modules(device, idents, 2);
    TEST_ASSERT_EQUAL_HEX32(file.modules.at[CSP].ident, idents[0]);
    TEST_ASSERT_EQUAL_HEX32(0, idents[1]);
    /* As many as there must be, at least the one that is the default. */
    device->slots.at[0].minimum_instances = 2;
    device->slots.at[0].maximum_instances = 3;
    device->slots.at[1].choices.at[PROFILE].is_default = true;
    TEST_ASSERT_EQUAL(4, cm1e_description_places(device));
    cm1e_description_default_modules(device, idents, 6);
    const uint32_t csp = file.modules.at[CSP].ident;
    const uint32_t expected[] = {csp, csp, 0, file.modules.at[PROFILE].ident, 0, 0};
    TEST_ASSERT_EQUAL_HEX32_ARRAY(expected, idents, 6);
    TEST_ASSERT_EQUAL_PTR(&device->slots.at[0], cm1e_description_place(device, 2));
    TEST_ASSERT_EQUAL_PTR(&device->slots.at[1], cm1e_description_place(device, 3));
    TEST_ASSERT_NULL(cm1e_description_place(device, 4));
    device->slots.at[0].maximum_instances = UINT32_MAX;
    TEST_ASSERT_EQUAL(CM1E_PLACES_MAX, cm1e_description_places(device));
    cm1e_description_file_free(&file);
}

static void test_modules_move_by_the_increments_of_their_slot(void)
{
    cm1e_description_file_t file = {0};
    cm1e_description_t expanded;
    make_good(&file);
    const size_t objects = DEVICE(&file)->objects.count, commands = DEVICE(&file)->init_commands.count;
    const cm1e_module_t *csp = &file.modules.at[CSP], *profile = &file.modules.at[PROFILE];
    const uint32_t idents[] = {csp->ident, profile->ident, 0x777};
    cm1e_description_expand(&file.arena, &expanded, &file, DEVICE(&file), idents, 3);
    TEST_ASSERT_EQUAL(0, expanded.slots.count);
    TEST_ASSERT_EQUAL(objects, DEVICE(&file)->objects.count);
    TEST_ASSERT_EQUAL(objects + csp->objects.count + profile->objects.count, expanded.objects.count);
    TEST_ASSERT_EQUAL(commands + 2, expanded.init_commands.count);
    TEST_ASSERT_NOT_NULL(cm1e_description_object(&expanded, 0x1018));
    TEST_ASSERT_NOT_NULL(cm1e_description_object(&expanded, 0x6040));
    TEST_ASSERT_NOT_NULL(cm1e_description_object(&expanded, 0x6840));
    TEST_ASSERT_NULL(cm1e_description_pdo(&expanded, 0x1603));
    const cm1e_described_pdo_t *first = cm1e_description_pdo(&expanded, 0x1601);
    const cm1e_described_pdo_t *second = cm1e_description_pdo(&expanded, 0x1613);
    TEST_ASSERT_EQUAL_HEX16(0x6040, first->entries.at[0].index);
    TEST_ASSERT_EQUAL_HEX16(0x6840, second->entries.at[0].index);
    TEST_ASSERT_EQUAL_HEX16(0x6860, expanded.init_commands.at[commands + 1].index);
    /* The file is as it was. */
    TEST_ASSERT_EQUAL_HEX16(0x6040, pdo_in(&file.modules.at[PROFILE].pdos, 0x1603)->entries.at[0].index);
    cm1e_description_file_free(&file);
}

/* A module's own mapping object says the index of the first slot, whichever slot it stands in; or that of another slot,
 * but no other. */
static void test_mapping_object_of_a_module_is_of_any_slot(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    cm1e_module_t *module = &file.modules.at[PROFILE];
    cm1e_described_object_t *object = CM1E_APPEND(&file.arena, &module->objects);
    *object = (cm1e_described_object_t){.index = 0x1605, .depends_on_slot = true, .name = "added", .type = ""};
    for (uint8_t subindex = 0; subindex < 2; subindex++) {
        cm1e_described_entry_t *row = CM1E_APPEND(&file.arena, &object->entries);
        *row = (cm1e_described_entry_t){.place = 9001u + subindex, .subindex = subindex, .name = "added",
                                        .type = subindex ? "UDINT" : "USINT", .bits = subindex ? 32 : 8};
        set_default(&file, row, subindex ? 0x60400010 : 1);
    }
    cm1e_described_pdo_t *pdo = CM1E_APPEND(&file.arena, &module->pdos);
    *pdo = (cm1e_described_pdo_t){.index = 0x1605, .depends_on_slot = true, .sync_manager = CM1E_NO_SYNC_MANAGER};
    cm1e_described_pdo_entry_t *entry = CM1E_APPEND(&file.arena, &pdo->entries);
    *entry = (cm1e_described_pdo_entry_t){.index = 0x6040, .depends_on_slot = true, .bits = 16, .type = "UINT"};
    assert_no_finding(&file);
    set_default(&file, &object->entries.at[1], 0x60600010);
    assert_one_finding(&file, CM1E_RULE_MAPPING_OBJECT, 9002,
                       "0x1605:01 maps by default 0x6060:00 with 16 bits; entry 1 of RxPDO 0x1605 is 0x6040:00 with 16 "
                       "bits");
    cm1e_description_file_free(&file);
}

/* A module that states no objects may map anything; one with alternatives in hundreds is judged as well. */
static void test_module_without_dictionary_is_no_mistake(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    file.modules.at[PROFILE].objects.count = 0;
    assert_no_finding(&file);
    cm1e_description_file_free(&file);
}

static void test_every_alternative_has_its_turn(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    const cm1e_module_t good = file.modules.at[PROFILE];
    for (uint32_t i = 0; i < 200; i++) {
        cm1e_module_t *module = CM1E_APPEND(&file.arena, &file.modules);
        *module = good;
        module->ident = 0x10000 + i;
        cm1e_slot_choice_t *choice = CM1E_APPEND(&file.arena, &DEVICE(&file)->slots.at[1].choices);
        choice->ident = module->ident;
    }
    assert_no_finding(&file);
    cm1e_module_t *last = &file.modules.at[file.modules.count - 1];
    last->pdos.at = NULL, last->pdos.count = 0;
    cm1e_described_pdo_t *pdo = CM1E_APPEND(&file.arena, &last->pdos);
    *pdo = (cm1e_described_pdo_t){.index = 0x1605, .depends_on_slot = true, .sync_manager = 9, .place = 9000};
    assert_one_finding(&file, CM1E_RULE_PDO_SYNC_MANAGER, 9000,
                       "RxPDO 0x1615 is assigned to sync manager 9; the device has 4");
    cm1e_description_file_free(&file);
}

/* Slots, choices and modules as many as a file likes: the work is bounded. */
static void test_work_is_bounded(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    const cm1e_module_t good = file.modules.at[PROFILE];
    DEVICE(&file)->slots.at[1].maximum_instances = UINT32_MAX;
    for (uint32_t i = 0; i < 20000; i++) {
        cm1e_module_t *module = CM1E_APPEND(&file.arena, &file.modules);
        *module = good;
        module->ident = 0x10000 + i;
        cm1e_slot_choice_t *choice = CM1E_APPEND(&file.arena, &DEVICE(&file)->slots.at[1].choices);
        choice->ident = module->ident;
    }
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_check_description(findings, &file);
    TEST_ASSERT_FALSE(findings->arena.failed);
    cm1e_findings_free(findings);
    cm1e_description_file_free(&file);
}

/* A modular device may have the profile of its one channel in <Profile> and 5001 in 0x1000 (ETG.5001). */
static void test_modular_profile_beside_one_channel_is_no_mistake(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    cm1e_described_entry_t *type = &object_in(&file.devices.at[0].objects, 0x1000)->entries.at[0];
    type->default_data = cm1e_bytes_of(&file.arena, 5001, 4);
    assert_no_finding(&file);
    type->default_data = cm1e_bytes_of(&file.arena, 5002, 4);
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_check_description(findings, &file);
    TEST_ASSERT_EQUAL_STRING("device-type", cm1e_findings_at(findings, 0)->rule);
    cm1e_findings_free(findings);
    cm1e_description_file_free(&file);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_mistake_is_found_once_and_where_it_is);
    RUN_TEST(test_places_are_bounded_and_filled_by_default);
    RUN_TEST(test_modules_move_by_the_increments_of_their_slot);
    RUN_TEST(test_mapping_object_of_a_module_is_of_any_slot);
    RUN_TEST(test_module_without_dictionary_is_no_mistake);
    RUN_TEST(test_every_alternative_has_its_turn);
    RUN_TEST(test_work_is_bounded);
    RUN_TEST(test_modular_profile_beside_one_channel_is_no_mistake);
    return UNITY_END();
}
