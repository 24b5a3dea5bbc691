/**
 * @file describe.h
 * Descriptions of our own devices, made from the tables of src/device. Any thread.
 */
#ifndef CM1E_DESCRIPTION_DESCRIBE_H
#define CM1E_DESCRIPTION_DESCRIBE_H

#include "cm1e/generate.h"
#include "description/description.h"

/** Appends the device of the options to the file, in MDP layout its modules too. CM1E_ERROR_CONFIG: the options do not
 *  fit together. */
cm1e_error_t cm1e_describe(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                           cm1e_esi_layout_t layout, cm1e_diag_t *diag);

/** Appends a simple device of the simulator, with no mailbox and vendor 0. */
void cm1e_describe_io(cm1e_description_file_t *file, cm1e_sim_io_t kind);
/** Appends the module with 1 byte out and 1 byte in, which has its own state machine. */
static inline void cm1e_describe_io_module(cm1e_description_file_t *file)
{
    cm1e_describe_io(file, CM1E_SIM_IO_MODULE);
}

/** Gives the identity and alias of a slave of the configuration to the last device of the file; what it does not state
 *  stays. */
void cm1e_describe_io_identity(cm1e_description_file_t *file, const cm1e_slave_config_t *slave);
/** Appends the simulated device of a slave of the configuration, with its identity: a coupler, digital or analog. */
void cm1e_describe_io_device(cm1e_description_file_t *file, const cm1e_slave_config_t *slave);

/** The sync managers that carry process data: 0x1C12 and 0x1C13 assign PDOs to them. */
enum { CM1E_SM_NUMBER_OUTPUTS = 2, CM1E_SM_NUMBER_INPUTS = 3 };

/* ---- private to this room: one model each, `options` already checked by cm1e_describe() ------------------------- */

cm1e_error_t cm1e_describe_cm1e(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                                cm1e_esi_layout_t layout, cm1e_diag_t *diag);
cm1e_error_t cm1e_describe_bridge(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                                  cm1e_esi_layout_t layout, cm1e_diag_t *diag);

cm1e_error_t cm1e_describe_cia402(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                                  cm1e_esi_layout_t layout, cm1e_diag_t *diag);

/** An object of the device tables as a description has it; entries that the firmware does not have are left out. */
void cm1e_describe_object(cm1e_arena_t *arena, cm1e_object_list_t *list, const cm1e_object_t *object,
                          cm1e_firmware_t firmware);
/** The range of an entry's values, also in its comment. */
void cm1e_describe_range(cm1e_arena_t *arena, cm1e_described_entry_t *described, int64_t minimum, int64_t maximum);
/** A PDO of the device tables; names and types come from the objects that are already in `device`. */
cm1e_described_pdo_t *cm1e_describe_pdo(cm1e_arena_t *arena, cm1e_pdo_list_t *list, const cm1e_object_list_t *objects,
                                        const cm1e_pdo_t *pdo, bool transmit, int sync_manager);
/** An object that an axis has, and a module in MDP layout; below are those of communication, above the device's own. */
bool cm1e_describe_is_of_axis(uint16_t index);
/** Those of `objects` that are not of a module, in MDP layout. */
void cm1e_describe_own_objects(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_object_list_t *objects,
                               bool (*is_of_module)(uint16_t index));
/** NULL: there is no such entry. */
cm1e_described_entry_t *cm1e_describe_entry_of(const cm1e_object_list_t *objects, uint16_t index, uint8_t subindex);
/** Replaces the default of the tables; does nothing if there is no such entry. */
void cm1e_describe_default(cm1e_arena_t *arena, const cm1e_object_list_t *objects, uint16_t index, uint8_t subindex,
                           int64_t value);
/** Parameters of the motor itself: the guides give no values, except where they give a range. */
void cm1e_describe_without_defaults(const cm1e_object_list_t *objects, uint16_t index);
/** A start-up command from Pre-Operational to Safe-Operational. */
cm1e_init_command_t *cm1e_describe_init_command(cm1e_arena_t *arena, cm1e_init_command_list_t *list, uint16_t index,
                                                uint8_t subindex, int64_t value, size_t bytes, const char *comment);
/** The PDOs that have a sync manager, as the dictionary's 0x1C12 and 0x1C13 have them and as start-up commands. */
void cm1e_describe_assignment(cm1e_arena_t *arena, cm1e_init_command_list_t *list, const cm1e_object_list_t *objects,
                              const cm1e_pdo_list_t *pdos);
/** An axis by CiA 402: profile 402, a servo drive. */
void cm1e_describe_channel(cm1e_arena_t *arena, cm1e_description_t *device);
/** FMMUs, mailbox with CoE, ways to synchronise. */
void cm1e_describe_communication(cm1e_arena_t *arena, cm1e_description_t *device,
                                 const cm1e_device_options_t *options);
/** false: the configuration words 0-6 (14 bytes) are the ones that we guess, as an image of ours holds them, or there
 *  are none: they must not get from there into a device as if they were those of a real one. */
bool cm1e_describe_config_is_known(const uint8_t *config);
/** Adds the other contents of the EEPROM. `bootstrap`: there is a mailbox in the state Bootstrap. */
void cm1e_describe_eeprom(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_device_options_t *options,
                          bool bootstrap);
/** A module of a drive; NULL: the file already has it. Modules with one ident have to have one content. */
cm1e_module_t *cm1e_describe_module(cm1e_description_file_t *file, uint32_t ident, const char *name);
/** Process data sync managers get the length of the PDOs that are assigned to them. */
void cm1e_describe_sync_managers(cm1e_arena_t *arena, cm1e_description_t *device,
                                 const cm1e_sync_manager_t managers[4], const cm1e_pdo_list_t *assigned);

#endif
