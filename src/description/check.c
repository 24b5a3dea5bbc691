#include "description/check_private.h"
#include "description/expand.h"

/* Limits against malicious files: rounds of choices of modules, and the total of objects and PDO entries in all rounds.
 * A device with hundreds of modules needs a few rounds. */
enum { ROUNDS_MAX = 512, WORK_MAX = 4000000 };

/* ---- a device ---------------------------------------------------------------------------------------------------- */

static void *take(cm1e_arena_t *arena, size_t count, size_t size)
{
    return count > 0 && count <= CM1E_ARENA_LIMIT / size ? cm1e_arena_take(arena, count * size) : NULL;
}

static void collect_entries(cm1e_check_t *check, cm1e_check_entry_t *entries)
{
    const cm1e_object_list_t objects = {check->device->objects.at, check->device->objects.count};
    for (size_t i = 0, n = 0; i < objects.count; i++)
        for (size_t j = 0; j < objects.at[i].entries.count; j++, n++) {
            const cm1e_described_entry_t *entry = &objects.at[i].entries.at[j];
            entries[n] = (cm1e_check_entry_t){
                {(uint32_t)objects.at[i].index << 8 | entry->subindex, n}, &objects.at[i], entry};
            if (entry->access & (CM1E_ACCESS_RXPDO | CM1E_ACCESS_TXPDO))
                check->states_mappability = true;
        }
    cm1e_check_sort(entries, check->entry_count, sizeof *entries);
    check->entries = entries;
}

/* Everything sorted that is searched. false: out of memory. */
static bool prepare(cm1e_check_t *check)
{
    const cm1e_description_t *device = check->device;
    const size_t objects = device->objects.count, pdos = device->pdos.count;
    check->entry_count = 0;
    for (size_t i = 0; i < objects; i++)
        check->entry_count += device->objects.at[i].entries.count;
    cm1e_check_entry_t *entries = take(check->arena, check->entry_count, sizeof *entries);
    cm1e_check_key_t *object_keys = take(check->arena, objects, sizeof *object_keys);
    cm1e_check_key_t *pdo_keys = take(check->arena, pdos, sizeof *pdo_keys);
    if (check->arena->failed)
        return false;
    for (size_t i = 0; i < objects; i++)
        object_keys[i] = (cm1e_check_key_t){device->objects.at[i].index, i};
    for (size_t i = 0; i < pdos; i++)
        pdo_keys[i] = (cm1e_check_key_t){device->pdos.at[i].index, i};
    cm1e_check_sort(object_keys, objects, sizeof *object_keys);
    cm1e_check_sort(pdo_keys, pdos, sizeof *pdo_keys);
    check->objects = object_keys;
    check->pdos = pdo_keys;
    check->has_dictionary = objects > 0;
    if (check->entry_count > 0)
        collect_entries(check, entries);
    return true;
}

static void check_flat(cm1e_check_t *check)
{
    if (!prepare(check))
        return;
    cm1e_check_dictionary(check);
    cm1e_check_pdos(check);
    cm1e_check_excludes(check);
    cm1e_check_mapping_objects(check);
    cm1e_check_init_commands(check);
    if (!check->by_default)
        return;
    cm1e_check_identity(check);
    cm1e_check_sync_managers(check);
    cm1e_check_mailbox(check);
    cm1e_check_assignment(check);
}

/* ---- choices of modules ------------------------------------------------------------------------------------------ */

/* Round 0 takes the default modules. In further rounds every place takes the next alternative of its slot, until all
 * were taken. Returns false when there is none left. */
static bool choose(const cm1e_description_t *device, unsigned round, uint32_t *idents, size_t places)
{
    if (round == 0) {
        cm1e_description_default_modules(device, idents, places);
        return true;
    }
    bool more = false;
    size_t place = 0;
    for (size_t s = 0; s < device->slots.count && place < places; s++) {
        const cm1e_slot_t *slot = &device->slots.at[s];
        const size_t first = place;
        while (place < places && cm1e_description_place(device, place) == slot)
            place++;
        const size_t instances = place - first, choices = slot->choices.count;
        for (size_t n = 0; n < instances; n++) {
            const size_t choice = (round - 1) * instances + n;
            more = more || choice < choices;
            idents[first + n] = choices > 0 ? slot->choices.at[choice % choices].ident : 0;
        }
    }
    return more;
}

/* A module without a dictionary cannot be checked for the objects of its PDOs and commands. */
static void mark_silent(cm1e_check_t *check, const cm1e_description_file_t *file, const cm1e_description_t *device,
                        const uint32_t *idents, size_t places)
{
    bool *pdos = take(check->arena, check->device->pdos.count, sizeof *pdos);
    bool *commands = take(check->arena, check->device->init_commands.count, sizeof *commands);
    size_t pdo = device->pdos.count, command = device->init_commands.count;
    for (size_t place = 0; place < places && !check->arena->failed; place++) {
        const cm1e_module_t *module = idents[place] ? cm1e_description_module(file, idents[place]) : NULL;
        for (size_t i = 0; module && i < module->pdos.count; i++)
            pdos[pdo++] = module->objects.count == 0;
        for (size_t i = 0; module && i < module->init_commands.count; i++)
            commands[command++] = module->objects.count == 0;
    }
    check->silent_pdos = pdos;
    check->silent_commands = commands;
}

static size_t work_of(const cm1e_description_t *device)
{
    size_t work = 1 + device->objects.count + device->pdos.count + device->init_commands.count;
    for (size_t i = 0; i < device->objects.count; i++)
        work += device->objects.at[i].entries.count;
    for (size_t i = 0; i < device->pdos.count; i++)
        work += device->pdos.at[i].entries.count;
    return work;
}

/* Checks one choice of modules; returns the amount of work. */
static size_t check_choice(const cm1e_check_t *of_device, const cm1e_description_file_t *file, const uint32_t *idents,
                           size_t places, bool by_default)
{
    cm1e_arena_t arena = {0};
    cm1e_description_t expanded;
    cm1e_description_expand(&arena, &expanded, file, of_device->device, idents, places);
    cm1e_check_t check = *of_device;
    check.arena = &arena;
    check.device = &expanded;
    check.by_default = by_default;
    mark_silent(&check, file, of_device->device, idents, places);
    if (!arena.failed)
        check_flat(&check);
    if (arena.failed && by_default) /* alternatives are skipped if there is no memory */
        check.findings->arena.failed = true;
    const size_t work = work_of(&expanded) + places * file->modules.count;
    cm1e_arena_free(&arena);
    return work;
}

static void check_choices(const cm1e_check_t *of_device, const cm1e_description_file_t *file, size_t *work)
{
    uint32_t idents[CM1E_PLACES_MAX];
    const size_t places = cm1e_description_places(of_device->device);
    for (unsigned round = 0; round == 0 || (round < ROUNDS_MAX && *work < WORK_MAX); round++) {
        if (!choose(of_device->device, round, idents, places))
            return;
        *work += check_choice(of_device, file, idents, places, round == 0);
    }
}

static void check_device(const cm1e_check_t *of_file, const cm1e_description_file_t *file,
                         const cm1e_description_t *device, size_t *work)
{
    cm1e_check_t check = *of_file;
    check.device = device;
    check.is_modular = device->slots.count > 0;
    check.slot_index_increment = device->slot_index_increment;
    const cm1e_check_types_t types = {.own = cm1e_check_sort_types(&check, &device->types)};
    cm1e_check_types(&check, &device->types, &types);
    cm1e_check_objects(&check, &device->objects, &types);
    if (device->objects.count > 0)
        cm1e_check_pdo_types(&check, &device->pdos, &types);
    cm1e_check_own_pdos(&check, &device->pdos);
    cm1e_check_slots(&check, file);
    check_choices(&check, file, work);
}

void cm1e_check_description(cm1e_findings_t *findings, const cm1e_description_file_t *file)
{
    cm1e_arena_t arena = {0};
    const cm1e_check_t check = {.findings = findings, .arena = &arena};
    size_t work = 0;
    cm1e_check_devices(&check, file);
    for (size_t i = 0; i < file->devices.count && findings->list.count < CM1E_FINDINGS_MAX && !findings->arena.failed;
         i++)
        check_device(&check, file, &file->devices.at[i], &work);
    cm1e_check_modules(&check, file);
    if (arena.failed)
        findings->arena.failed = true;
    cm1e_arena_free(&arena);
}
