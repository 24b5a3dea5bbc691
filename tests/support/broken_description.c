#include "broken_description.h"

static const char *const rule_names[CM1E_RULE_COUNT] = {CM1E_RULES(RULE_NAME_ROW)};

/* ---- places ------------------------------------------------------------------------------------------------------ */

static void number_objects(cm1e_object_list_t *objects, cm1e_place_t *next)
{
    for (size_t i = 0; i < objects->count; i++) {
        objects->at[i].place = ++*next;
        for (size_t j = 0; j < objects->at[i].entries.count; j++)
            objects->at[i].entries.at[j].place = ++*next;
    }
}

static void number_pdos(cm1e_pdo_list_t *pdos, cm1e_place_t *next)
{
    for (size_t i = 0; i < pdos->count; i++) {
        pdos->at[i].place = ++*next;
        for (size_t j = 0; j < pdos->at[i].excludes.count; j++)
            pdos->at[i].excludes.at[j].place = ++*next;
        for (size_t j = 0; j < pdos->at[i].entries.count; j++)
            pdos->at[i].entries.at[j].place = ++*next;
    }
}

static void number_types(cm1e_type_list_t *types, cm1e_place_t *next)
{
    for (size_t i = 0; i < types->count; i++) {
        types->at[i].place = ++*next;
        for (size_t j = 0; j < types->at[i].items.count; j++)
            types->at[i].items.at[j].place = ++*next;
    }
}

static void number_commands(cm1e_init_command_list_t *commands, cm1e_place_t *next)
{
    for (size_t i = 0; i < commands->count; i++)
        commands->at[i].place = ++*next;
}

static void number_slots(cm1e_description_t *device, cm1e_place_t *next)
{
    for (size_t i = 0; i < device->slots.count; i++) {
        device->slots.at[i].place = ++*next;
        for (size_t j = 0; j < device->slots.at[i].choices.count; j++)
            device->slots.at[i].choices.at[j].place = ++*next;
    }
}

void number_places(cm1e_description_file_t *file)
{
    cm1e_place_t next = 0;
    for (size_t i = 0; i < file->devices.count; i++) {
        cm1e_description_t *device = &file->devices.at[i];
        device->place = ++next;
        device->mailbox.place = ++next;
        device->eeprom.place = ++next;
        for (size_t n = 0; n < device->fmmus.count; n++)
            device->fmmus.at[n].place = ++next;
        for (size_t n = 0; n < device->sync_managers.count; n++)
            device->sync_managers.at[n].place = ++next;
        number_types(&device->types, &next);
        number_objects(&device->objects, &next);
        number_pdos(&device->pdos, &next);
        number_commands(&device->init_commands, &next);
        number_slots(device, &next);
    }
    for (size_t i = 0; i < file->modules.count; i++) {
        file->modules.at[i].place = ++next;
        number_objects(&file->modules.at[i].objects, &next);
        number_pdos(&file->modules.at[i].pdos, &next);
        number_commands(&file->modules.at[i].init_commands, &next);
    }
}

/* ---- parts to break ---------------------------------------------------------------------------------------------- */

cm1e_described_object_t *object_in(cm1e_object_list_t *objects, uint16_t index)
{
    for (size_t i = 0; i < objects->count; i++)
        if (objects->at[i].index == index)
            return &objects->at[i];
    TEST_FAIL_MESSAGE("the good description lacks the object that was to be broken");
    return NULL;
}

cm1e_described_entry_t *entry_in(cm1e_object_list_t *objects, uint16_t index, uint8_t subindex)
{
    cm1e_described_object_t *object = object_in(objects, index);
    for (size_t i = 0; i < object->entries.count; i++)
        if (object->entries.at[i].subindex == subindex)
            return &object->entries.at[i];
    TEST_FAIL_MESSAGE("the good description lacks the sub-index that was to be broken");
    return NULL;
}

cm1e_described_pdo_t *pdo_in(cm1e_pdo_list_t *pdos, uint16_t index)
{
    for (size_t i = 0; i < pdos->count; i++)
        if (pdos->at[i].index == index)
            return &pdos->at[i];
    TEST_FAIL_MESSAGE("the good description lacks the PDO that was to be broken");
    return NULL;
}

cm1e_described_pdo_entry_t *pdo_entry_in(cm1e_pdo_list_t *pdos, uint16_t pdo_index, uint16_t index)
{
    cm1e_described_pdo_t *pdo = pdo_in(pdos, pdo_index);
    for (size_t i = 0; i < pdo->entries.count; i++)
        if (pdo->entries.at[i].index == index)
            return &pdo->entries.at[i];
    TEST_FAIL_MESSAGE("the good description lacks the entry of a PDO that was to be broken");
    return NULL;
}

void set_default(cm1e_description_file_t *file, cm1e_described_entry_t *entry, int64_t value)
{
    entry->default_data = cm1e_bytes_of(&file->arena, value, (entry->bits + 7) / 8);
}

cm1e_init_command_t *add_command(cm1e_description_file_t *file, uint16_t index, uint8_t subindex,
                                 int64_t value, size_t bytes)
{
    cm1e_init_command_t *command = CM1E_APPEND(&file->arena, &file->devices.at[0].init_commands);
    command->place = 5000;
    command->transitions = CM1E_TRANSITION_PS;
    command->index = index;
    command->subindex = subindex;
    command->data = cm1e_bytes_of(&file->arena, value, bytes);
    return command;
}

/* ---- judging ----------------------------------------------------------------------------------------------------- */

void print_findings(const cm1e_findings_t *findings)
{
    for (size_t i = 0; i < cm1e_findings_count(findings); i++) {
        const cm1e_finding_t *finding = cm1e_findings_at(findings, i);
        printf("  %u: %s: %s\n", (unsigned)finding->line, finding->rule, finding->text);
    }
}

void assert_one_finding(const cm1e_description_file_t *file, cm1e_rule_t rule, cm1e_place_t place,
                        const char *text)
{
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_check_description(findings, file);
    if (cm1e_findings_count(findings) != 1)
        print_findings(findings);
    TEST_ASSERT_EQUAL_MESSAGE(1, cm1e_findings_count(findings), rule_names[rule]);
    const cm1e_finding_t *finding = cm1e_findings_at(findings, 0);
    TEST_ASSERT_EQUAL_STRING(rule_names[rule], finding->rule);
    TEST_ASSERT_EQUAL_STRING(text, finding->text);
    TEST_ASSERT_EQUAL_MESSAGE(place, finding->line, rule_names[rule]);
    cm1e_findings_free(findings);
}

void assert_no_finding(const cm1e_description_file_t *file)
{
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_check_description(findings, file);
    print_findings(findings);
    TEST_ASSERT_EQUAL(0, cm1e_findings_count(findings));
    cm1e_findings_free(findings);
}

void assert_found(const broken_t *broken, void (*make_good)(cm1e_description_file_t *file))
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    assert_no_finding(&file);
    const cm1e_place_t place = broken->breaks(&file);
    assert_one_finding(&file, broken->rule, place, broken->text);
    cm1e_description_file_free(&file);
}
