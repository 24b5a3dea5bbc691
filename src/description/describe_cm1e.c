#include "description/describe.h"

#include <string.h>

#include "core/bytes.h"

enum { MAPPINGS = 4, SM_OUTPUTS = 2, SM_INPUTS = 3, PROFILE_402 = 402, TYPE_SERVO = 4, FIRST_DRIVE_OBJECT = 0x6000 };
/* PDI control 0x05: SPI slave, as microcontrollers are connected. The value of the real device is not known. */
enum { PDI_CONTROL_SPI = 0x0005, EEPROM_BYTES = 2048, CONFIG_BYTES = 14 };

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

static cm1e_described_entry_t *entry_of(const cm1e_object_list_t *objects, uint16_t index, uint8_t subindex)
{
    for (size_t i = 0; i < objects->count; i++)
        for (size_t j = 0; objects->at[i].index == index && j < objects->at[i].entries.count; j++)
            if (objects->at[i].entries.at[j].subindex == subindex)
                return &objects->at[i].entries.at[j];
    return NULL;
}

static void set_default(cm1e_arena_t *arena, const cm1e_object_list_t *objects, uint16_t index, uint8_t subindex,
                        int64_t value)
{
    cm1e_described_entry_t *entry = entry_of(objects, index, subindex);
    if (entry)
        entry->default_data = cm1e_bytes_of(arena, value, (entry->bits + 7) / 8);
}

/* The name of the row of a mapping object that maps `index`: the dictionary has them in one of the two orders. */
static const char *row_name(const cm1e_described_object_t *object, uint16_t index)
{
    for (size_t i = 0; i < object->entries.count; i++)
        if (object->entries.at[i].subindex > 0 && cm1e_bytes_unsigned(object->entries.at[i].default_data) >> 16 == index)
            return object->entries.at[i].name;
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
    set_default(arena, objects, pdo->index, 0, pdo->entry_count);
    for (unsigned i = 0; i < pdo->entry_count; i++) {
        cm1e_described_entry_t *row = entry_of(objects, pdo->index, (uint8_t)(i + 1));
        if (!row)
            continue;
        row->name = names[i];
        set_default(arena, objects, pdo->index, (uint8_t)(i + 1),
                    (int64_t)pdo->entries[i].index << 16 | pdo->entries[i].subindex << 8 | pdo->entries[i].bits);
    }
}

/* What the tables have by the newest firmware, as this one has it (UG 10.1). */
static void adapt_objects(cm1e_arena_t *arena, const cm1e_object_list_t *objects, const cm1e_device_options_t *options,
                          const cm1e_firmware_info_t *firmware)
{
    set_default(arena, objects, OBJ_1018_IDENTITY, 3, firmware->revision);
    set_default(arena, objects, OBJ_1018_IDENTITY, 4, options->serial_number);
    set_default(arena, objects, OBJ_1C12_RXPDO_ASSIGN, 1, 0x1600 + (int)options->mapping);
    set_default(arena, objects, OBJ_1C13_TXPDO_ASSIGN, 1, 0x1A00 + (int)options->mapping);
    cm1e_described_entry_t *version = entry_of(objects, OBJ_100A_SOFTWARE_VERSION, 0);
    if (version)
        version->default_data =
            (cm1e_bytes_t){cm1e_arena_bytes(arena, firmware->version, version->bits / 8), version->bits / 8};
    static const uint16_t velocities[] = {OBJ_606C_VELOCITY_ACTUAL_VALUE, OBJ_60FF_TARGET_VELOCITY};
    for (int i = 0; i < 2 && firmware->velocity_in_counts_per_ms; i++) {
        cm1e_described_entry_t *entry = entry_of(objects, velocities[i], 0);
        if (entry)
            entry->unit = "counts/ms";
    }
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
static void exclude_others(cm1e_arena_t *arena, cm1e_described_pdo_t *pdo)
{
    for (int other = 0; other < MAPPINGS; other++) {
        const uint16_t index = (uint16_t)((pdo->transmit ? 0x1A00 : 0x1600) + other);
        if (index == pdo->index)
            continue;
        cm1e_exclude_t *exclude = CM1E_APPEND(arena, &pdo->excludes);
        exclude->index = index;
    }
}

static void describe_pdos(cm1e_arena_t *arena, cm1e_pdo_list_t *list, const cm1e_object_list_t *objects,
                          const cm1e_device_options_t *options, const cm1e_firmware_info_t *firmware)
{
    for (int transmit = 0; transmit < 2; transmit++)
        for (int mapping = 0; mapping < MAPPINGS; mapping++) {
            const bool chosen = mapping == (int)options->mapping;
            cm1e_pdo_t pdo;
            cm1e_device_pdo(&pdo, (cm1e_mapping_t)mapping, transmit, options->order, firmware->firmware);
            exclude_others(arena, cm1e_describe_pdo(arena, list, objects, &pdo, transmit,
                                                    !chosen ? CM1E_NO_SYNC_MANAGER : transmit ? SM_INPUTS : SM_OUTPUTS));
        }
}

static void init_command(cm1e_arena_t *arena, cm1e_init_command_list_t *list, uint16_t index, uint8_t subindex,
                         int64_t value, size_t bytes, const char *comment)
{
    cm1e_init_command_t *command = CM1E_APPEND(arena, list);
    command->transitions = CM1E_TRANSITION_PS;
    command->index = index;
    command->subindex = subindex;
    command->data = cm1e_bytes_of(arena, value, bytes);
    command->adapts = index < FIRST_DRIVE_OBJECT;
    command->comment = comment;
}

/* In the order of the initialization commands of UG 11.2.1. A master whose user chose another mapping adapts them. */
static void describe_assignment(cm1e_arena_t *arena, cm1e_init_command_list_t *list, cm1e_mapping_t mapping)
{
    init_command(arena, list, OBJ_1C12_RXPDO_ASSIGN, 0, 0, 1, "No RxPDO assigned");
    init_command(arena, list, OBJ_1C13_TXPDO_ASSIGN, 0, 0, 1, "No TxPDO assigned");
    init_command(arena, list, OBJ_1C12_RXPDO_ASSIGN, 1, 0x1600 + (int)mapping, 2, "Assigned RxPDO");
    init_command(arena, list, OBJ_1C12_RXPDO_ASSIGN, 0, 1, 1, "One RxPDO assigned");
    init_command(arena, list, OBJ_1C13_TXPDO_ASSIGN, 1, 0x1A00 + (int)mapping, 2, "Assigned TxPDO");
    init_command(arena, list, OBJ_1C13_TXPDO_ASSIGN, 0, 1, 1, "One TxPDO assigned");
}

static void describe_start_mode(cm1e_arena_t *arena, cm1e_init_command_list_t *list, cm1e_mapping_t mapping)
{
    init_command(arena, list, OBJ_6060_MODES_OF_OPERATION, 0, mappings[mapping].mode, 1, "Modes of operation");
}

static void describe_identity(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_firmware_info_t *firmware)
{
    device->vendor_id = CM1E_VENDOR_ID;
    device->vendor_name = "Myostat Motion Control Inc.";
    device->product_code = CM1E_PRODUCT_CODE;
    device->revision = firmware->revision;
    device->product_given = device->revision_given = true;
    device->type = "CM1-E";
    device->name = cm1e_arena_format(arena, "CM1-E (firmware %s)", firmware->version);
    device->comment = cm1e_arena_format(arena, "Motors %s, %s, %s, %s", cm1e_device_motors[0].name,
                                        cm1e_device_motors[1].name, cm1e_device_motors[2].name,
                                        cm1e_device_motors[3].name);
    device->group = "Servo motors";
    device->group_name = "Servo motors";
    device->physics = "YY";
    device->identification_reg134 = device->identification_reg134_given = true; /* UG 4.2.2 */
    cm1e_channel_t *channel = CM1E_APPEND(arena, &device->channels);
    channel->profile_no = PROFILE_402;
    channel->add_info = TYPE_SERVO;
}

static void describe_communication(cm1e_arena_t *arena, cm1e_description_t *device,
                                   const cm1e_device_options_t *options)
{
    static const cm1e_fmmu_use_t fmmus[] = {CM1E_FMMU_OUTPUTS, CM1E_FMMU_INPUTS, CM1E_FMMU_MAILBOX_STATE};
    for (unsigned i = 0; i < 3; i++) {
        cm1e_described_fmmu_t *fmmu = CM1E_APPEND(arena, &device->fmmus);
        fmmu->use = fmmus[i];
    }
    device->mailbox = (cm1e_mailbox_protocols_t){
        .present = true, .coe = true, .sdo_info = true, .pdo_assign = true, .segmented_sdo = true,
        .foe = true, /* update since V1.2.0 (UG 10.1), the oldest firmware of the tables */
        .data_link_layer = true, .complete_access = options->complete_access};
    cm1e_dc_mode_t *mode = CM1E_APPEND(arena, &device->dc_modes);
    *mode = (cm1e_dc_mode_t){.name = "SM Synchronous", .text = "SM Synchronous"};
    if (options->distributed_clocks) {
        mode = CM1E_APPEND(arena, &device->dc_modes);
        *mode = (cm1e_dc_mode_t){.name = "DC Synchronous", .text = "DC Synchronous", .assign_activate = 0x0300,
                                 .sync0_given = true, .sync0_factor = 1};
    }
}

static void describe_eeprom(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_device_options_t *options)
{
    const cm1e_sync_manager_t *managers = cm1e_device_sync_managers;
    uint8_t config[CONFIG_BYTES] = {PDI_CONTROL_SPI}, bootstrap[8];
    cm1e_described_eeprom_t *eeprom = &device->eeprom;
    eeprom->config_known = options->config_data_size == CONFIG_BYTES;
    if (eeprom->config_known)
        memcpy(config, options->config_data, CONFIG_BYTES);
    if (options->alias != 0 || !eeprom->config_known)
        cm1e_put_u16(config + 8, options->alias);
    eeprom->byte_size = EEPROM_BYTES;
    eeprom->version = 1;
    eeprom->alias = cm1e_get_u16(config + 8);
    eeprom->serial_number = options->serial_number;
    eeprom->config_data = (cm1e_bytes_t){cm1e_arena_bytes(arena, config, sizeof config), sizeof config};
    cm1e_put_u16(bootstrap, managers[0].start);
    cm1e_put_u16(bootstrap + 2, managers[0].length);
    cm1e_put_u16(bootstrap + 4, managers[1].start);
    cm1e_put_u16(bootstrap + 6, managers[1].length);
    eeprom->bootstrap = (cm1e_bytes_t){cm1e_arena_bytes(arena, bootstrap, sizeof bootstrap), sizeof bootstrap};
    eeprom->mailbox_out_start = managers[0].start;
    eeprom->mailbox_out_length = managers[0].length;
    eeprom->mailbox_in_start = managers[1].start;
    eeprom->mailbox_in_length = managers[1].length;
}

/* One slot for the one axis; its modules are the mappings to choose from, each with the drive's objects. */
static void describe_modules(cm1e_description_file_t *file, cm1e_description_t *device,
                             const cm1e_device_options_t *options, const cm1e_object_list_t *objects,
                             const cm1e_pdo_list_t *pdos)
{
    cm1e_arena_t *arena = &file->arena;
    device->slot_pdo_increment = 0x10;
    device->slot_index_increment = 0x800;
    cm1e_slot_t *slot = CM1E_APPEND(arena, &device->slots);
    slot->name = "Axis";
    slot->minimum_instances = slot->maximum_instances = 1;
    for (int m = 0; m < MAPPINGS; m++) {
        cm1e_slot_choice_t *choice = CM1E_APPEND(arena, &slot->choices);
        choice->ident = mappings[m].module_ident;
        choice->is_default = m == (int)options->mapping;
        cm1e_module_t *module = CM1E_APPEND(arena, &file->modules);
        module->ident = mappings[m].module_ident;
        module->type = module->name = mappings[m].module;
        module->profile_no = PROFILE_402;
        module->profile_info = TYPE_SERVO;
        for (size_t i = 0; i < objects->count; i++)
            if (objects->at[i].index >= FIRST_DRIVE_OBJECT && objects->at[i].index < 0xF000) {
                cm1e_described_object_t *object = CM1E_APPEND(arena, &module->objects);
                *object = objects->at[i];
                object->depends_on_slot = true;
            }
        for (size_t i = 0; i < pdos->count; i++)
            if ((pdos->at[i].index & 0xFF) == m) {
                cm1e_described_pdo_t *pdo = CM1E_APPEND(arena, &module->pdos);
                *pdo = pdos->at[i];
                pdo->depends_on_slot = true;
                pdo->sync_manager = pdo->transmit ? SM_INPUTS : SM_OUTPUTS;
                pdo->excludes.count = 0;
                for (size_t e = 0; e < pdo->entries.count; e++)
                    pdo->entries.at[e].depends_on_slot = pdo->entries.at[e].index >= FIRST_DRIVE_OBJECT;
            }
        describe_start_mode(arena, &module->init_commands, (cm1e_mapping_t)m);
    }
}

cm1e_error_t cm1e_describe_cm1e(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                                cm1e_esi_layout_t layout, cm1e_diag_t *diag)
{
    const cm1e_firmware_info_t *firmware = firmware_of(options);
    if (!firmware)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "there is no firmware \"%s\"; there are 1.2.0 1.3.0 1.3.2 1.3.3 1.3.4 1.3.5",
                             options->firmware);
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
    describe_communication(arena, device, options);
    describe_eeprom(arena, device, options);
    cm1e_describe_sync_managers(arena, device, cm1e_device_sync_managers, &pdos);
    describe_assignment(arena, &device->init_commands, options->mapping);
    if (layout == CM1E_ESI_MDP) {
        for (size_t i = 0; i < objects.count; i++)
            if (objects.at[i].index < FIRST_DRIVE_OBJECT || objects.at[i].index >= 0xF000)
                *(cm1e_described_object_t *)CM1E_APPEND(arena, &device->objects) = objects.at[i];
        describe_modules(file, device, options, &objects, &pdos);
        return CM1E_OK;
    }
    device->objects = objects;
    device->pdos = pdos;
    describe_start_mode(arena, &device->init_commands, options->mapping);
    return CM1E_OK;
}
