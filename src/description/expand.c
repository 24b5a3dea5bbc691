#include "description/expand.h"

/* PDO mapping objects move with their PDOs (ETG.5001): 0x1600 ... 0x1BFF. */
enum { FIRST_MAPPING_OBJECT = 0x1600, LAST_MAPPING_OBJECT = 0x1BFF };

/* Increment of the slot for the parts of a module that depend on it. */
typedef struct offset {
    uint32_t index, pdo;
} offset_t;

static size_t instances(const cm1e_slot_t *slot)
{
    return slot->maximum_instances < CM1E_PLACES_MAX ? slot->maximum_instances : CM1E_PLACES_MAX;
}

size_t cm1e_description_places(const cm1e_description_t *device)
{
    size_t places = 0;
    for (size_t i = 0; i < device->slots.count && places < CM1E_PLACES_MAX; i++)
        places += instances(&device->slots.at[i]);
    return places < CM1E_PLACES_MAX ? places : CM1E_PLACES_MAX;
}

const cm1e_slot_t *cm1e_description_place(const cm1e_description_t *device, size_t place)
{
    size_t first = 0;
    for (size_t i = 0; i < device->slots.count && first < CM1E_PLACES_MAX; i++) {
        first += instances(&device->slots.at[i]);
        if (place < first)
            return &device->slots.at[i];
    }
    return NULL;
}

const cm1e_module_t *cm1e_description_module(const cm1e_description_file_t *file, uint32_t ident)
{
    for (size_t i = 0; i < file->modules.count; i++)
        if (file->modules.at[i].ident == ident)
            return &file->modules.at[i];
    return NULL;
}

static uint32_t default_choice(const cm1e_slot_t *slot)
{
    for (size_t i = 0; i < slot->choices.count; i++)
        if (slot->choices.at[i].is_default)
            return slot->choices.at[i].ident;
    return 0;
}

/* The minimum number of instances of a slot; a default module is there at least once. */
void cm1e_description_default_modules(const cm1e_description_t *device, uint32_t *idents, size_t count)
{
    size_t place = 0;
    for (size_t i = 0; i < device->slots.count && place < count; i++) {
        const cm1e_slot_t *slot = &device->slots.at[i];
        const uint32_t ident = default_choice(slot);
        const size_t filled = slot->minimum_instances > 1 ? slot->minimum_instances : 1;
        for (size_t n = 0; n < instances(slot) && place < count; n++)
            idents[place++] = n < filled ? ident : 0;
    }
    while (place < count)
        idents[place++] = 0;
}

static uint16_t moved(uint16_t index, bool depends_on_slot, const offset_t *offset)
{
    if (!depends_on_slot)
        return index;
    const bool mapping = index >= FIRST_MAPPING_OBJECT && index <= LAST_MAPPING_OBJECT;
    return (uint16_t)(index + (mapping ? offset->pdo : offset->index));
}

static void add_pdo(cm1e_arena_t *arena, cm1e_description_t *expanded, const cm1e_described_pdo_t *pdo,
                    const offset_t *offset)
{
    cm1e_described_pdo_t *added = CM1E_APPEND(arena, &expanded->pdos);
    *added = *pdo;
    added->index = (uint16_t)(pdo->index + (pdo->depends_on_slot ? offset->pdo : 0));
    added->entries.at = NULL, added->entries.count = 0;
    added->excludes.at = NULL, added->excludes.count = 0;
    for (size_t i = 0; i < pdo->entries.count; i++) {
        cm1e_described_pdo_entry_t *entry = CM1E_APPEND(arena, &added->entries);
        *entry = pdo->entries.at[i];
        entry->index = entry->index ? moved(entry->index, entry->depends_on_slot, offset) : 0;
    }
    for (size_t i = 0; i < pdo->excludes.count; i++) {
        cm1e_exclude_t *exclude = CM1E_APPEND(arena, &added->excludes);
        *exclude = pdo->excludes.at[i];
        exclude->index = (uint16_t)(exclude->index + (exclude->depends_on_slot ? offset->pdo : 0));
    }
}

static void add_module(cm1e_arena_t *arena, cm1e_description_t *expanded, const cm1e_module_t *module,
                       const offset_t *offset)
{
    for (size_t i = 0; i < module->objects.count; i++) {
        cm1e_described_object_t *object = CM1E_APPEND(arena, &expanded->objects);
        *object = module->objects.at[i];
        object->index = moved(object->index, object->depends_on_slot, offset);
    }
    for (size_t i = 0; i < module->pdos.count; i++)
        add_pdo(arena, expanded, &module->pdos.at[i], offset);
    for (size_t i = 0; i < module->init_commands.count; i++) {
        cm1e_init_command_t *command = CM1E_APPEND(arena, &expanded->init_commands);
        *command = module->init_commands.at[i];
        command->index = moved(command->index, command->depends_on_slot, offset);
    }
}

#define COPY_LIST(arena, to, from, type)                                                                            \
    do {                                                                                                            \
        (to)->at = NULL, (to)->count = 0;                                                                           \
        for (size_t i_ = 0; i_ < (from)->count; i_++)                                                               \
            *(type *)CM1E_APPEND(arena, to) = (from)->at[i_];                                                       \
    } while (0)

void cm1e_description_expand(cm1e_arena_t *arena, cm1e_description_t *expanded, const cm1e_description_file_t *file,
                             const cm1e_description_t *device, const uint32_t *idents, size_t count)
{
    *expanded = *device;
    expanded->slots.at = NULL, expanded->slots.count = 0;
    /* Own lists, because appending to those of the device would write behind their end. */
    COPY_LIST(arena, &expanded->objects, &device->objects, cm1e_described_object_t);
    COPY_LIST(arena, &expanded->pdos, &device->pdos, cm1e_described_pdo_t);
    COPY_LIST(arena, &expanded->init_commands, &device->init_commands, cm1e_init_command_t);
    for (size_t place = 0; place < count && !arena->failed; place++) {
        const cm1e_module_t *module = idents[place] ? cm1e_description_module(file, idents[place]) : NULL;
        const offset_t offset = {.index = (uint32_t)place * device->slot_index_increment,
                                 .pdo = (uint32_t)place * device->slot_pdo_increment};
        if (module)
            add_module(arena, expanded, module, &offset);
    }
}
