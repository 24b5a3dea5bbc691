#include "description/describe.h"

#include <string.h>

#include "core/bytes.h"
#include "description/sii_image.h"

enum { FIRST_OF_AXES = 0x6000, FIRST_ABOVE_AXES = 0xF000 };
enum { PROFILE_402 = 402, TYPE_SERVO = 4 }; /* 0x1000: profile in the low word, type in the high one */
/* PDI control 0x05: SPI slave, as microcontrollers are connected. The value of the real devices is not known. */
enum { PDI_CONTROL_SPI = 0x0005 };
enum { ERASED = 0xFF };

/* ---- objects ---------------------------------------------------------------------------------------------------- */

bool cm1e_describe_is_of_axis(uint16_t index) { return index >= FIRST_OF_AXES && index < FIRST_ABOVE_AXES; }

void cm1e_describe_own_objects(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_object_list_t *objects,
                               bool (*is_of_module)(uint16_t index))
{
    for (size_t i = 0; i < objects->count; i++)
        if (!is_of_module(objects->at[i].index))
            *(cm1e_described_object_t *)CM1E_APPEND(arena, &device->objects) = objects->at[i];
}

cm1e_described_entry_t *cm1e_describe_entry_of(const cm1e_object_list_t *objects, uint16_t index, uint8_t subindex)
{
    for (size_t i = 0; i < objects->count; i++)
        for (size_t j = 0; objects->at[i].index == index && j < objects->at[i].entries.count; j++)
            if (objects->at[i].entries.at[j].subindex == subindex)
                return &objects->at[i].entries.at[j];
    return NULL;
}

void cm1e_describe_default(cm1e_arena_t *arena, const cm1e_object_list_t *objects, uint16_t index, uint8_t subindex,
                           int64_t value)
{
    cm1e_described_entry_t *entry = cm1e_describe_entry_of(objects, index, subindex);
    if (entry)
        entry->default_data = cm1e_bytes_of(arena, value, (entry->bits + 7) / 8);
}

void cm1e_describe_without_defaults(const cm1e_object_list_t *objects, uint16_t index)
{
    for (size_t i = 0; i < objects->count; i++)
        for (size_t j = 0; objects->at[i].index == index && j < objects->at[i].entries.count; j++) {
            cm1e_described_entry_t *entry = &objects->at[i].entries.at[j];
            if (entry->subindex > 0 && !entry->minimum.data)
                entry->default_data = (cm1e_bytes_t){0};
        }
}

/* ---- start-up commands ------------------------------------------------------------------------------------------ */

cm1e_init_command_t *cm1e_describe_init_command(cm1e_arena_t *arena, cm1e_init_command_list_t *list, uint16_t index,
                                                uint8_t subindex, int64_t value, size_t bytes, const char *comment)
{
    cm1e_init_command_t *command = CM1E_APPEND(arena, list);
    command->transitions = CM1E_TRANSITION_PS;
    command->index = index;
    command->subindex = subindex;
    command->data = cm1e_bytes_of(arena, value, bytes);
    command->comment = comment;
    return command;
}

/* A master replaces them if its user chose other PDOs. */
static void assign(cm1e_arena_t *arena, cm1e_init_command_list_t *list, bool transmit, unsigned subindex,
                   int64_t value, const char *comment)
{
    const uint16_t index = transmit ? OBJ_1C13_TXPDO_ASSIGN : OBJ_1C12_RXPDO_ASSIGN;
    cm1e_describe_init_command(arena, list, index, (uint8_t)subindex, value, subindex == 0 ? 1 : 2, comment)->adapts =
        true;
}

static unsigned assign_pdos(cm1e_arena_t *arena, cm1e_init_command_list_t *list, const cm1e_pdo_list_t *pdos,
                            bool transmit)
{
    unsigned count = 0;
    for (size_t i = 0; i < pdos->count; i++)
        if (pdos->at[i].transmit == transmit && pdos->at[i].sync_manager != CM1E_NO_SYNC_MANAGER)
            assign(arena, list, transmit, ++count, pdos->at[i].index, transmit ? "Assigned TxPDO" : "Assigned RxPDO");
    const char *kind = transmit ? "TxPDO" : "RxPDO";
    assign(arena, list, transmit, 0, count,
           count == 1 ? cm1e_arena_format(arena, "One %s assigned", kind)
                      : cm1e_arena_format(arena, "%u %ss assigned", count, kind));
    return count;
}

/* What is not assigned is 0. */
static void assignment_in_dictionary(cm1e_arena_t *arena, const cm1e_object_list_t *objects,
                                     const cm1e_pdo_list_t *pdos, bool transmit, unsigned count)
{
    const uint16_t index = transmit ? OBJ_1C13_TXPDO_ASSIGN : OBJ_1C12_RXPDO_ASSIGN;
    uint8_t subindex = 0;
    cm1e_describe_default(arena, objects, index, 0, count);
    for (size_t i = 0; i < pdos->count; i++)
        if (pdos->at[i].transmit == transmit && pdos->at[i].sync_manager != CM1E_NO_SYNC_MANAGER)
            cm1e_describe_default(arena, objects, index, ++subindex, pdos->at[i].index);
    while (cm1e_describe_entry_of(objects, index, ++subindex))
        cm1e_describe_default(arena, objects, index, subindex, 0);
}

/* In the order of the initialization commands of UG 11.2.1. */
void cm1e_describe_assignment(cm1e_arena_t *arena, cm1e_init_command_list_t *list, const cm1e_object_list_t *objects,
                              const cm1e_pdo_list_t *pdos)
{
    assign(arena, list, false, 0, 0, "No RxPDO assigned");
    assign(arena, list, true, 0, 0, "No TxPDO assigned");
    for (int transmit = 0; transmit < 2; transmit++) {
        const unsigned count = assign_pdos(arena, list, pdos, transmit);
        assignment_in_dictionary(arena, objects, pdos, transmit, count);
    }
}

/* ---- communication ---------------------------------------------------------------------------------------------- */

void cm1e_describe_sync_managers(cm1e_arena_t *arena, cm1e_description_t *device,
                                 const cm1e_sync_manager_t managers[4], const cm1e_pdo_list_t *assigned)
{
    for (int n = 0; n < 4; n++) {
        cm1e_described_sync_manager_t *manager = CM1E_APPEND(arena, &device->sync_managers);
        uint32_t bits = 0;
        for (size_t i = 0; i < assigned->count; i++)
            if (assigned->at[i].sync_manager == n)
                bits += cm1e_pdo_bits(&assigned->at[i]);
        manager->use = (cm1e_sync_manager_use_t)managers[n].type;
        manager->start = managers[n].start;
        manager->length = n < 2 ? managers[n].length : (uint16_t)((bits + 7) / 8);
        manager->length_given = true;
        manager->control = managers[n].control;
        manager->enable = managers[n].enable;
    }
}

void cm1e_describe_channel(cm1e_arena_t *arena, cm1e_description_t *device)
{
    cm1e_channel_t *channel = CM1E_APPEND(arena, &device->channels);
    channel->profile_no = PROFILE_402;
    channel->add_info = TYPE_SERVO;
}

void cm1e_describe_communication(cm1e_arena_t *arena, cm1e_description_t *device,
                                 const cm1e_device_options_t *options)
{
    static const cm1e_fmmu_use_t fmmus[] = {CM1E_FMMU_OUTPUTS, CM1E_FMMU_INPUTS, CM1E_FMMU_MAILBOX_STATE};
    for (unsigned i = 0; i < 3; i++) {
        cm1e_described_fmmu_t *fmmu = CM1E_APPEND(arena, &device->fmmus);
        fmmu->use = fmmus[i];
    }
    device->physics = "YY";
    device->mailbox = (cm1e_mailbox_protocols_t){
        .present = true, .coe = true, .sdo_info = true, .pdo_assign = true, .segmented_sdo = true,
        .data_link_layer = true, .complete_access = options->complete_access};
    cm1e_dc_mode_t *mode = CM1E_APPEND(arena, &device->dc_modes);
    *mode = (cm1e_dc_mode_t){.name = "SM Synchronous", .text = "SM Synchronous"};
    if (options->distributed_clocks) {
        mode = CM1E_APPEND(arena, &device->dc_modes);
        *mode = (cm1e_dc_mode_t){.name = "DC Synchronous", .text = "DC Synchronous", .assign_activate = 0x0300,
                                 .sync0_given = true, .sync0_factor = 1};
    }
}

bool cm1e_describe_config_is_known(const uint8_t *config)
{
    bool guessed = true, blank = true;
    for (size_t i = 0; i < CM1E_SII_CONFIG_BYTES; i++) {
        const bool is_alias = i == CM1E_SII_ALIAS || i == CM1E_SII_ALIAS + 1; /* a user's, set in a guess too */
        guessed &= is_alias || config[i] == (i == 0 ? PDI_CONTROL_SPI : 0);
        blank &= is_alias || (config[i] == config[0] && (config[0] == 0 || config[0] == ERASED));
    }
    return !guessed && !blank;
}

void cm1e_describe_eeprom(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_device_options_t *options,
                          bool bootstrap)
{
    const cm1e_sync_manager_t *managers = cm1e_device_sync_managers;
    uint8_t config[CM1E_SII_CONFIG_BYTES] = {PDI_CONTROL_SPI}, mailbox[CM1E_SII_BOOTSTRAP_BYTES];
    cm1e_described_eeprom_t *eeprom = &device->eeprom;
    eeprom->config_known =
        options->config_data_size == CM1E_SII_CONFIG_BYTES && cm1e_describe_config_is_known(options->config_data);
    if (eeprom->config_known)
        memcpy(config, options->config_data, CM1E_SII_CONFIG_BYTES);
    if (options->alias != 0 || !eeprom->config_known)
        cm1e_put_u16(config + CM1E_SII_ALIAS, options->alias);
    eeprom->byte_size = CM1E_SII_SIZE;
    eeprom->version = 1;
    eeprom->alias = cm1e_get_u16(config + CM1E_SII_ALIAS);
    eeprom->serial_number = options->serial_number;
    eeprom->config_data = (cm1e_bytes_t){cm1e_arena_bytes(arena, config, sizeof config), sizeof config};
    eeprom->mailbox_out_start = managers[0].start;
    eeprom->mailbox_out_length = managers[0].length;
    eeprom->mailbox_in_start = managers[1].start;
    eeprom->mailbox_in_length = managers[1].length;
    cm1e_put_u16(mailbox, managers[0].start);
    cm1e_put_u16(mailbox + 2, managers[0].length);
    cm1e_put_u16(mailbox + 4, managers[1].start);
    cm1e_put_u16(mailbox + 6, managers[1].length);
    if (bootstrap)
        eeprom->bootstrap = (cm1e_bytes_t){cm1e_arena_bytes(arena, mailbox, sizeof mailbox), sizeof mailbox};
}

cm1e_module_t *cm1e_describe_module(cm1e_description_file_t *file, uint32_t ident, const char *name)
{
    for (size_t i = 0; i < file->modules.count; i++)
        if (file->modules.at[i].ident == ident)
            return NULL;
    cm1e_module_t *module = CM1E_APPEND(&file->arena, &file->modules);
    module->ident = ident;
    module->type = module->name = name;
    module->profile_no = PROFILE_402;
    module->profile_info = TYPE_SERVO;
    return module;
}
