#include "description/check_private.h"

/* Slots and the modules for them (ETG.5001, ETG.2000 Slots and Modules). */

/* By their idents; NULL: there are none, or no memory. */
static cm1e_check_key_t *sorted_modules(const cm1e_check_t *check, const cm1e_description_file_t *file)
{
    const size_t count = file->modules.count;
    if (count == 0 || count > CM1E_ARENA_LIMIT / sizeof(cm1e_check_key_t))
        return NULL;
    cm1e_check_key_t *idents = cm1e_arena_take(check->arena, count * sizeof *idents);
    if (check->arena->failed)
        return NULL;
    for (size_t i = 0; i < count; i++)
        idents[i] = (cm1e_check_key_t){file->modules.at[i].ident, i};
    cm1e_check_sort(idents, count, sizeof *idents);
    return idents;
}

static bool has_ident(const cm1e_check_key_t *idents, size_t count, uint32_t ident)
{
    const size_t found = cm1e_check_first(idents, count, sizeof *idents, ident);
    return found < count && idents[found].number == ident;
}

static void check_slot(const cm1e_check_t *check, const cm1e_slot_t *slot, size_t number,
                       const cm1e_check_key_t *idents, size_t count)
{
    const char *name = slot->name ? slot->name : "";
    unsigned defaults = 0;
    for (size_t i = 0; i < slot->choices.count; i++) {
        const cm1e_slot_choice_t *choice = &slot->choices.at[i];
        const cm1e_place_t place = choice->place ? choice->place : slot->place;
        if (!has_ident(idents, count, choice->ident))
            cm1e_check_add(check, CM1E_RULE_SLOT_MODULE_MISSING, place,
                           "slot %zu %s names module 0x%08X, which is not in the file", number, name,
                           (unsigned)choice->ident);
        if (choice->is_default && ++defaults == 2)
            cm1e_check_add(check, CM1E_RULE_SLOT_DEFAULTS, place, "slot %zu %s has two default modules", number, name);
    }
    if (slot->minimum_instances > slot->maximum_instances)
        cm1e_check_add(check, CM1E_RULE_SLOT_INSTANCES, slot->place,
                       "slot %zu %s is there at least %u times, but at most %u times", number, name,
                       (unsigned)slot->minimum_instances, (unsigned)slot->maximum_instances);
    else if (slot->minimum_instances > 0 && slot->choices.count > 0 && defaults == 0)
        cm1e_check_add(check, CM1E_RULE_SLOT_NO_DEFAULT, slot->place,
                       "slot %zu %s must hold a module, but none is the default", number, name);
}

void cm1e_check_slots(const cm1e_check_t *check, const cm1e_description_file_t *file)
{
    if (check->device->slots.count == 0)
        return;
    const cm1e_check_key_t *idents = sorted_modules(check, file);
    for (size_t i = 0; i < check->device->slots.count; i++)
        check_slot(check, &check->device->slots.at[i], i, idents, idents ? file->modules.count : 0);
}

/* An entry that does not move with its slot although its object does maps the first axis's object for the second. */
static void check_dependence(const cm1e_check_t *check, const cm1e_check_seen_t objects[2], uint16_t index,
                             bool depends_on_slot, cm1e_place_t place, const char *what)
{
    const bool has = cm1e_check_has_seen(&objects[depends_on_slot], index);
    if (!has && cm1e_check_has_seen(&objects[!depends_on_slot], index))
        cm1e_check_add(check, CM1E_RULE_SLOT_DEPENDENCE, place,
                       depends_on_slot
                           ? "%s names 0x%04X as depending on the slot, which the object does not"
                           : "%s names 0x%04X as the same in every slot, but the object depends on the slot",
                       what, index);
}

static void check_slot_dependence(const cm1e_check_t *check, const cm1e_module_t *module)
{
    cm1e_check_seen_t objects[2] = {0}; /* that do not, that do depend on the slot */
    for (size_t i = 0; i < module->objects.count; i++)
        cm1e_check_seen(&objects[module->objects.at[i].depends_on_slot], module->objects.at[i].index);
    for (size_t i = 0; i < module->pdos.count; i++)
        for (size_t j = 0; j < module->pdos.at[i].entries.count; j++) {
            const cm1e_described_pdo_entry_t *entry = &module->pdos.at[i].entries.at[j];
            check_dependence(check, objects, entry->index, entry->depends_on_slot, entry->place,
                             cm1e_pdo_kind(&module->pdos.at[i]));
        }
    for (size_t i = 0; i < module->init_commands.count; i++)
        check_dependence(check, objects, module->init_commands.at[i].index, module->init_commands.at[i].depends_on_slot,
                         module->init_commands.at[i].place, "the start-up command");
}

void cm1e_check_modules(const cm1e_check_t *check, const cm1e_description_file_t *file)
{
    const cm1e_check_key_t *idents = sorted_modules(check, file);
    for (size_t i = 1; idents && i < file->modules.count; i++)
        if (idents[i].number == idents[i - 1].number)
            cm1e_check_add(check, CM1E_RULE_MODULE_TWICE, file->modules.at[idents[i].order].place,
                           "there are two modules with the ident 0x%08X", (unsigned)idents[i].number);
    /* A module's dictionary may use the types of the device. */
    cm1e_check_sorted_types_t common = {0};
    for (size_t i = 0; i < file->devices.count && common.count == 0; i++)
        common = cm1e_check_sort_types(check, &file->devices.at[i].types);
    for (size_t i = 0; i < file->modules.count; i++) {
        const cm1e_module_t *module = &file->modules.at[i];
        const cm1e_check_types_t types = {cm1e_check_sort_types(check, &module->types), common};
        cm1e_check_types(check, &module->types, &types);
        cm1e_check_objects(check, &module->objects, &types);
        if (module->objects.count > 0)
            cm1e_check_pdo_types(check, &module->pdos, &types);
        cm1e_check_own_pdos(check, &module->pdos);
        check_slot_dependence(check, module);
    }
}
