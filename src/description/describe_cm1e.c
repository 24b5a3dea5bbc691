#include "description/describe.h"

#include <stdio.h>
#include <string.h>

enum { MAPPINGS = 4 };

/* Which mode a mapping starts in, and its module in MDP layout. The idents go on from those of the SSC sample code, of
 * which the device family descends; the guide names none. The dynamic mapping starts in CSP, as the EC_EXTEND of UG
 * 11.2.1 does: TwinCAT's NC writes no mode. */
static const struct {
    int8_t mode;
    uint32_t module_ident;
    const char *module;
} mappings[MAPPINGS] = {
    {8, 0x119800, "Dynamic switching of modes"},
    {8, 0x219800, "CSP"},
    {9, 0x319800, "CSV"},
    {1, 0x419800, "Profile position and velocity"},
};

static const cm1e_firmware_info_t *firmware_of(const cm1e_device_options_t *options)
{
    if (options->firmware[0] == '\0')
        return cm1e_firmware_info(CM1E_FIRMWARE_COUNT - 1);
    for (int f = 0; f < CM1E_FIRMWARE_COUNT; f++)
        if (strcmp(cm1e_firmware_info((cm1e_firmware_t)f)->version, options->firmware) == 0)
            return cm1e_firmware_info((cm1e_firmware_t)f);
    return NULL;
}

/* The name of the row of a mapping object that maps `index`: the dictionary has them in one of the two orders. */
static const char *row_name(const cm1e_described_object_t *object, uint16_t index)
{
    for (size_t i = 0; i < object->entries.count; i++) {
        const cm1e_described_entry_t *row = &object->entries.at[i];
        if (row->subindex > 0 && cm1e_bytes_unsigned(row->default_data) >> 16 == index)
            return row->name;
    }
    return "";
}

/* Rows in the order asked for, the number of them in sub-index 0. */
static void set_mapping_rows(cm1e_arena_t *arena, const cm1e_object_list_t *objects, const cm1e_pdo_t *pdo)
{
    const char *names[CM1E_PDO_MAX_ENTRIES];
    const cm1e_described_object_t *object = NULL;
    for (size_t i = 0; i < objects->count; i++)
        if (objects->at[i].index == pdo->index)
            object = &objects->at[i];
    if (!object)
        return;
    for (unsigned i = 0; i < pdo->entry_count; i++)
        names[i] = row_name(object, pdo->entries[i].index);
    cm1e_describe_default(arena, objects, pdo->index, 0, pdo->entry_count);
    for (unsigned i = 0; i < pdo->entry_count; i++) {
        cm1e_described_entry_t *row = cm1e_describe_entry_of(objects, pdo->index, (uint8_t)(i + 1));
        if (!row)
            continue;
        row->name = names[i];
        cm1e_describe_default(arena, objects, pdo->index, (uint8_t)(i + 1),
                              (int64_t)pdo->entries[i].index << 16 | pdo->entries[i].subindex << 8 |
                                  pdo->entries[i].bits);
    }
}

/* What the tables have by the newest firmware, as this one has it (UG 10.1). */
static void adapt_objects(cm1e_arena_t *arena, const cm1e_object_list_t *objects, const cm1e_device_options_t *options,
                          const cm1e_firmware_info_t *firmware)
{
    cm1e_describe_default(arena, objects, OBJ_1018_IDENTITY, 3, firmware->revision);
    cm1e_describe_default(arena, objects, OBJ_1018_IDENTITY, 4, options->serial_number);
    cm1e_describe_default(arena, objects, OBJ_1C32_SM_OUTPUT_PARAMETER, 5, firmware->shortest_cycle_ns);
    cm1e_describe_default(arena, objects, OBJ_1C33_SM_INPUT_PARAMETER, 5, firmware->shortest_cycle_ns);
    cm1e_described_entry_t *version = cm1e_describe_entry_of(objects, OBJ_100A_SOFTWARE_VERSION, 0);
    if (version)
        version->default_data =
            (cm1e_bytes_t){cm1e_arena_bytes(arena, firmware->version, version->bits / 8), version->bits / 8};
    static const uint16_t velocities[] = {OBJ_606C_VELOCITY_ACTUAL_VALUE, OBJ_60FF_TARGET_VELOCITY};
    for (int i = 0; i < 2 && firmware->velocity_in_counts_per_ms; i++) {
        cm1e_described_entry_t *entry = cm1e_describe_entry_of(objects, velocities[i], 0);
        if (!entry)
            continue;
        entry->unit = "counts/ms";
        if (entry->minimum.data)
            cm1e_describe_range(arena, entry, cm1e_bytes_signed(entry->minimum) / 1000,
                                cm1e_bytes_signed(entry->maximum) / 1000);
    }
    cm1e_describe_without_defaults(objects, OBJ_60F6_K_PARAMETERS);
    cm1e_describe_without_defaults(objects, OBJ_60FB_H_PARAMETERS);
    for (int mapping = 0; mapping < MAPPINGS; mapping++)
        for (int transmit = 0; transmit < 2; transmit++) {
            cm1e_pdo_t pdo;
            cm1e_device_pdo(&pdo, (cm1e_mapping_t)mapping, transmit, options->order, firmware->firmware);
            set_mapping_rows(arena, objects, &pdo);
        }
}

static void describe_objects(cm1e_arena_t *arena, cm1e_object_list_t *list, const cm1e_device_options_t *options,
                             const cm1e_firmware_info_t *firmware)
{
    size_t count;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    for (size_t i = 0; i < count; i++)
        cm1e_describe_object(arena, list, &objects[i], firmware->firmware);
    adapt_objects(arena, list, options, firmware);
}

/* The alternatives of a direction exclude each other, both ways. */
static void exclude_others(cm1e_arena_t *arena, cm1e_described_pdo_t *pdo, int mapping, bool transmit)
{
    for (int other = 0; other < MAPPINGS; other++) {
        if (other == mapping)
            continue;
        cm1e_exclude_t *exclude = CM1E_APPEND(arena, &pdo->excludes);
        exclude->index = (uint16_t)((transmit ? 0x1A00 : 0x1600) + other);
    }
}

static void describe_pdos(cm1e_arena_t *arena, cm1e_pdo_list_t *list, const cm1e_object_list_t *objects,
                          const cm1e_device_options_t *options, const cm1e_firmware_info_t *firmware)
{
    for (int transmit = 0; transmit < 2; transmit++)
        for (int mapping = 0; mapping < MAPPINGS; mapping++) {
            const int manager = transmit ? CM1E_SM_NUMBER_INPUTS : CM1E_SM_NUMBER_OUTPUTS;
            const bool chosen = mapping == (int)options->mapping;
            cm1e_pdo_t pdo;
            cm1e_device_pdo(&pdo, (cm1e_mapping_t)mapping, transmit, options->order, firmware->firmware);
            exclude_others(arena, cm1e_describe_pdo(arena, list, objects, &pdo, transmit,
                                                    chosen ? manager : CM1E_NO_SYNC_MANAGER),
                           mapping, transmit);
        }
}

static cm1e_init_command_t *describe_start_mode(cm1e_arena_t *arena, cm1e_init_command_list_t *list,
                                                cm1e_mapping_t mapping)
{
    return cm1e_describe_init_command(arena, list, OBJ_6060_MODES_OF_OPERATION, 0, mappings[mapping].mode, 1,
                                      "Modes of operation");
}

static void describe_identity(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_firmware_info_t *firmware)
{
    device->vendor_id = CM1E_VENDOR_ID;
    device->vendor_name = CM1E_VENDOR_NAME;
    device->product_code = CM1E_PRODUCT_CODE;
    device->revision = firmware->revision;
    device->product_given = device->revision_given = true;
    device->type = device->name = "CM1-E";
    device->comment = cm1e_arena_format(arena, "Firmware %s. Motors %s, %s, %s, %s", firmware->version,
                                        cm1e_device_motors[0].name, cm1e_device_motors[1].name,
                                        cm1e_device_motors[2].name, cm1e_device_motors[3].name);
    device->group = "Servo motors";
    device->group_name = "Servo motors";
    device->identification_reg134 = device->identification_reg134_given = true; /* UG 4.2.2 */
    cm1e_describe_channel(arena, device);
}

/* What a module holds depends on these two besides the mapping, so that its ident tells them apart too: several devices
 * can be in one file. */
static uint32_t module_ident(int mapping, const cm1e_device_options_t *options, const cm1e_firmware_info_t *firmware)
{
    return mappings[mapping].module_ident | ((uint32_t)firmware->firmware + 1) << 4 | (uint32_t)options->order;
}

/* The drive's objects come with the module, except the parameters of the motor itself, which no mode changes. */
static bool is_of_module(uint16_t index)
{
    return cm1e_describe_is_of_axis(index) && index != OBJ_60F6_K_PARAMETERS && index != OBJ_60FB_H_PARAMETERS;
}

static void describe_module(cm1e_arena_t *arena, cm1e_module_t *module, cm1e_mapping_t mapping,
                            const cm1e_object_list_t *objects, const cm1e_pdo_list_t *pdos)
{
    for (size_t i = 0; i < objects->count; i++)
        if (is_of_module(objects->at[i].index)) {
            cm1e_described_object_t *object = CM1E_APPEND(arena, &module->objects);
            *object = objects->at[i];
            object->depends_on_slot = true;
        }
    for (size_t i = 0; i < pdos->count; i++)
        if ((pdos->at[i].index & 0xFF) == mapping) {
            cm1e_described_pdo_t *pdo = CM1E_APPEND(arena, &module->pdos);
            *pdo = pdos->at[i];
            pdo->depends_on_slot = true;
            pdo->sync_manager = pdo->transmit ? CM1E_SM_NUMBER_INPUTS : CM1E_SM_NUMBER_OUTPUTS;
            pdo->excludes.count = 0;
            for (size_t e = 0; e < pdo->entries.count; e++)
                pdo->entries.at[e].depends_on_slot = cm1e_describe_is_of_axis(pdo->entries.at[e].index);
        }
    describe_start_mode(arena, &module->init_commands, mapping)->depends_on_slot = true;
}

/* One slot for the one axis; its modules are the mappings to choose from, each with the drive's objects. */
static void describe_slot(cm1e_description_file_t *file, cm1e_description_t *device,
                          const cm1e_device_options_t *options, const cm1e_firmware_info_t *firmware,
                          const cm1e_object_list_t *objects, const cm1e_pdo_list_t *pdos)
{
    cm1e_arena_t *arena = &file->arena;
    device->slot_pdo_increment = 0x10;
    device->slot_index_increment = 0x800;
    cm1e_slot_t *slot = CM1E_APPEND(arena, &device->slots);
    slot->name = "Axis";
    slot->minimum_instances = slot->maximum_instances = 1;
    for (int m = 0; m < MAPPINGS; m++) {
        cm1e_slot_choice_t *choice = CM1E_APPEND(arena, &slot->choices);
        choice->ident = module_ident(m, options, firmware);
        choice->is_default = m == (int)options->mapping;
        cm1e_module_t *module = cm1e_describe_module(file, choice->ident, mappings[m].module);
        if (module)
            describe_module(arena, module, (cm1e_mapping_t)m, objects, pdos);
    }
}

static cm1e_error_t no_such_firmware(const char *version, cm1e_diag_t *diag)
{
    char versions[CM1E_FIRMWARE_COUNT * 8] = "";
    for (int f = 0; f < CM1E_FIRMWARE_COUNT; f++)
        snprintf(versions + strlen(versions), sizeof versions - strlen(versions), " %s",
                 cm1e_firmware_info((cm1e_firmware_t)f)->version);
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "there is no firmware \"%s\"; there are%s", version, versions);
}

cm1e_error_t cm1e_describe_cm1e(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                                cm1e_esi_layout_t layout, cm1e_diag_t *diag)
{
    const cm1e_firmware_info_t *firmware = firmware_of(options);
    if (!firmware)
        return no_such_firmware(options->firmware, diag);
    if (options->vendor_id || options->product_code || options->revision || options->axes > 1)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "vendor, product, revision and axes of a CM1-E follow from its tables: leave them 0");
    if ((unsigned)options->mapping >= MAPPINGS || (unsigned)options->order > CM1E_PDO_ORDER_UG_7_2)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "there is no such mapping or order of objects");

    cm1e_arena_t *arena = &file->arena;
    cm1e_description_t *device = CM1E_APPEND(arena, &file->devices);
    cm1e_object_list_t objects = {0};
    cm1e_pdo_list_t pdos = {0};
    cm1e_description_init(device);
    describe_identity(arena, device, firmware);
    describe_objects(arena, &objects, options, firmware);
    describe_pdos(arena, &pdos, &objects, options, firmware);
    cm1e_describe_communication(arena, device, options);
    device->mailbox.foe = true; /* update since V1.2.0 (UG 10.1), the oldest firmware of the tables */
    cm1e_describe_eeprom(arena, device, options, true);
    cm1e_describe_sync_managers(arena, device, cm1e_device_sync_managers, &pdos);
    cm1e_describe_assignment(arena, &device->init_commands, &objects, &pdos);
    if (layout == CM1E_ESI_MDP) {
        cm1e_describe_own_objects(arena, device, &objects, is_of_module);
        describe_slot(file, device, options, firmware, &objects, &pdos);
        return CM1E_OK;
    }
    device->objects = objects;
    device->pdos = pdos;
    describe_start_mode(arena, &device->init_commands, options->mapping);
    return CM1E_OK;
}
