#include "description/describe.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "device/bridge_facts.h"

/* The guide states neither of the three; without them no master could find the file for a device. */
static cm1e_error_t check_identity(const cm1e_device_options_t *options, cm1e_diag_t *diag)
{
    char missing[48] = "";
    const struct {
        uint32_t value;
        const char *name;
    } needed[] = {
        {options->vendor_id, "vendor ID"}, {options->product_code, "product code"}, {options->revision, "revision"}};
    for (int i = 0; i < 3; i++)
        if (needed[i].value == 0)
            snprintf(missing + strlen(missing), sizeof missing - strlen(missing), "%s%s", missing[0] ? ", " : "",
                     needed[i].name);
    if (missing[0] == '\0')
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                         "%s: missing: %s; the bridge's guide does not state them, `cm1e scan` shows those of a real "
                         "one (ETG's list of vendors has Muscle Corporation as 0xAA77)",
                         cm1e_bridge_name(options->model), missing);
}

static cm1e_error_t check_options(const cm1e_device_options_t *options, cm1e_diag_t *diag)
{
    if (options->firmware[0] != '\0' || options->mapping != CM1E_MAPPING_DYNAMIC ||
        options->order != CM1E_PDO_ORDER_UG_4_4)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "%s: firmware, mapping and order of objects are the CM1-E's: a bridge has one mapping, "
                             "leave them out",
                             cm1e_bridge_name(options->model));
    if (options->axes > CM1E_BRIDGE_AXES)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%s: %" PRIu32 " axes; a bridge has 1 to %d",
                             cm1e_bridge_name(options->model), options->axes, CM1E_BRIDGE_AXES);
    return check_identity(options, diag);
}

static void describe_identity(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_device_options_t *options,
                              unsigned axes)
{
    static const char *const ids[CM1E_BRIDGE_AXES] = {"ID1", "ID2", "ID3", "ID4"};
    const char *motors = "";
    for (unsigned axis = 0; axis < axes; axis++)
        motors = cm1e_arena_format(arena, "%s%s%s on %s", motors, axis ? ", " : "",
                                   cm1e_bridge_motor_name(cm1e_bridge_motor(options->model, axis)), ids[axis]);
    device->vendor_id = options->vendor_id;
    device->vendor_name = options->vendor_id == CM1E_VENDOR_ID ? CM1E_VENDOR_NAME : "Muscle Corporation";
    device->product_code = options->product_code;
    device->revision = options->revision;
    device->product_given = device->revision_given = true;
    device->type = cm1e_bridge_name(options->model);
    device->name = cm1e_arena_format(arena, "%s EtherCAT Cool MUSCLE Bridge", device->type);
    device->comment = cm1e_arena_format(arena, "Motors %s", motors);
    device->group = device->group_name = "Servo motors";
    for (unsigned axis = 0; axis < axes; axis++)
        cm1e_describe_channel(arena, device);
}

static void without_defaults(const cm1e_object_list_t *objects, unsigned axis)
{
    const unsigned offset = axis * CM1E_BRIDGE_INDEX_INCREMENT;
    cm1e_describe_without_defaults(objects, (uint16_t)(OBJ_60F6_K_PARAMETERS + offset));
    cm1e_describe_without_defaults(objects, (uint16_t)(OBJ_60FB_H_PARAMETERS + offset));
}

/* Objects that are "N/A" are in the dictionary: the guide lists them so. Axes that the file leaves out are not, with
 * their mapping objects. */
static void describe_objects(cm1e_arena_t *arena, cm1e_object_list_t *list, const cm1e_device_options_t *options,
                             unsigned axes)
{
    const cm1e_object_t *object;
    for (size_t n = 0; (object = cm1e_bridge_object(options->model, n)) != NULL; n++)
        if (cm1e_bridge_axis_of(object->index) < (int)axes)
            cm1e_describe_object(arena, list, object, CM1E_FIRMWARE_1_2_0);
    for (unsigned axis = 0; axis < axes; axis++)
        without_defaults(list, axis);
    cm1e_describe_default(arena, list, OBJ_1018_IDENTITY, 1, options->vendor_id);
    cm1e_describe_default(arena, list, OBJ_1018_IDENTITY, 2, options->product_code);
    cm1e_describe_default(arena, list, OBJ_1018_IDENTITY, 3, options->revision);
    cm1e_describe_default(arena, list, OBJ_1018_IDENTITY, 4, options->serial_number);
}

static void describe_pdos(cm1e_arena_t *arena, cm1e_pdo_list_t *list, const cm1e_object_list_t *objects,
                          unsigned axes)
{
    for (int transmit = 0; transmit < 2; transmit++)
        for (unsigned axis = 0; axis < axes; axis++) {
            cm1e_pdo_t pdo;
            cm1e_bridge_pdo(&pdo, axis, transmit);
            cm1e_describe_pdo(arena, list, objects, &pdo, transmit,
                              transmit ? CM1E_SM_NUMBER_INPUTS : CM1E_SM_NUMBER_OUTPUTS);
        }
}

/* A bridge starts in csp, but an earlier master may have left it in another mode. */
static cm1e_init_command_t *describe_start_mode(cm1e_arena_t *arena, cm1e_init_command_list_t *list, unsigned axis)
{
    const unsigned index = OBJ_6060_MODES_OF_OPERATION + axis * CM1E_BRIDGE_INDEX_INCREMENT;
    return cm1e_describe_init_command(arena, list, (uint16_t)index, 0, CM1E_BRIDGE_MODE_CSP, 1, "Modes of Operation");
}

/* ---- modules ---------------------------------------------------------------------------------------------------- */

static const char *facts_of(cm1e_arena_t *arena, const cm1e_entry_t *entry)
{
    if (entry->availability != CM1E_AVAILABLE)
        return entry->availability == CM1E_NOT_AVAILABLE ? "N/A" : "no such parameter";
    if (entry->unit[0] == '\0')
        return "available";
    return cm1e_arena_format(arena, "%" PRId64 " ... %" PRId64 " x %s, default %" PRId64, entry->minimum,
                             entry->maximum, entry->unit, entry->default_value);
}

/* An entry as a CM1 has it becomes one for both kinds of motor. */
static void widen_entry(cm1e_arena_t *arena, cm1e_described_entry_t *described, const cm1e_entry_t *cm1,
                        const cm1e_entry_t *cm2)
{
    const bool same_range = cm1->minimum == cm2->minimum && cm1->maximum == cm2->maximum &&
                            cm1->default_value == cm2->default_value && strcmp(cm1->unit, cm2->unit) == 0;
    if (same_range && cm1->availability == cm2->availability)
        return;
    described->comment = cm1e_arena_format(arena, "CM1: %s; CM2: %s", facts_of(arena, cm1), facts_of(arena, cm2));
    if (same_range)
        return;
    described->unit = "";
    described->minimum = described->maximum = (cm1e_bytes_t){0};
    if (cm1->default_value != cm2->default_value)
        described->default_data = (cm1e_bytes_t){0};
}

/* The one module, an axis with either motor. The bridge says 0x219800 of every axis (F030, F050), whatever its motor:
 * a master that looks there for the modules of the file finds this one. Two modules by motor would need two idents, and
 * no bridge reports a second one; all that differs by motor is ranges, and what is "N/A". */
static void describe_module(cm1e_arena_t *arena, cm1e_module_t *module)
{
    size_t count;
    const cm1e_object_t *cm1 = cm1e_bridge_axis_objects(CM1E_BRIDGE_CM1, 0, &count);
    const cm1e_object_t *cm2 = cm1e_bridge_axis_objects(CM1E_BRIDGE_CM2, 0, &count);
    for (size_t i = 0; i < count; i++) {
        cm1e_describe_object(arena, &module->objects, &cm1[i], CM1E_FIRMWARE_1_2_0);
        if (arena->failed)
            return;
        cm1e_described_object_t *object = &module->objects.at[module->objects.count - 1];
        object->depends_on_slot = true;
        for (size_t j = 0; j < object->entries.count; j++)
            widen_entry(arena, &object->entries.at[j], &cm1[i].entries[j], &cm2[i].entries[j]);
    }
    without_defaults(&module->objects, 0);
    describe_pdos(arena, &module->pdos, &module->objects, 1);
    for (size_t i = 0; i < module->pdos.count; i++) {
        cm1e_described_pdo_t *pdo = &module->pdos.at[i];
        pdo->depends_on_slot = true;
        pdo->name = pdo->transmit ? "csp TxPDO" : "csp RxPDO";
        for (size_t e = 0; e < pdo->entries.count; e++)
            pdo->entries.at[e].depends_on_slot = true;
    }
    describe_start_mode(arena, &module->init_commands, 0)->depends_on_slot = true;
}

static void describe_slots(cm1e_description_file_t *file, cm1e_description_t *device, unsigned axes)
{
    cm1e_arena_t *arena = &file->arena;
    device->slot_pdo_increment = CM1E_BRIDGE_PDO_INCREMENT;
    device->slot_index_increment = CM1E_BRIDGE_INDEX_INCREMENT;
    for (unsigned axis = 0; axis < axes; axis++) {
        cm1e_slot_t *slot = CM1E_APPEND(arena, &device->slots);
        slot->name = cm1e_arena_format(arena, "Axis ID%u", axis + 1);
        slot->minimum_instances = slot->maximum_instances = 1;
        cm1e_slot_choice_t *choice = CM1E_APPEND(arena, &slot->choices);
        *choice = (cm1e_slot_choice_t){.ident = CM1E_BRIDGE_MODULE_IDENT, .is_default = true};
    }
    cm1e_module_t *module = cm1e_describe_module(file, CM1E_BRIDGE_MODULE_IDENT, "Cool Muscle axis");
    if (module)
        describe_module(arena, module);
}

cm1e_error_t cm1e_describe_bridge(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                                  cm1e_esi_layout_t layout, cm1e_diag_t *diag)
{
    const cm1e_error_t error = check_options(options, diag);
    if (error != CM1E_OK)
        return error;
    const unsigned axes = options->axes ? options->axes : CM1E_BRIDGE_AXES;
    cm1e_arena_t *arena = &file->arena;
    cm1e_description_t *device = CM1E_APPEND(arena, &file->devices);
    cm1e_object_list_t objects = {0};
    cm1e_pdo_list_t pdos = {0};
    cm1e_description_init(device);
    describe_identity(arena, device, options, axes);
    describe_objects(arena, &objects, options, axes);
    describe_pdos(arena, &pdos, &objects, axes);
    cm1e_describe_communication(arena, device, options); /* CoE only: there is no Bootstrap (BR 5.2), and no FoE */
    cm1e_describe_eeprom(arena, device, options, false);
    /* The guide names the sync managers (BR 2.3) without their places: they are those of the CM1-E, which descends from
     * the same code. */
    cm1e_describe_sync_managers(arena, device, cm1e_device_sync_managers, &pdos);
    cm1e_describe_assignment(arena, &device->init_commands, &objects, &pdos);
    if (layout == CM1E_ESI_MDP) {
        cm1e_describe_own_objects(arena, device, &objects, cm1e_describe_is_of_axis);
        describe_slots(file, device, axes);
        return CM1E_OK;
    }
    device->objects = objects;
    device->pdos = pdos;
    for (unsigned axis = 0; axis < axes; axis++)
        describe_start_mode(arena, &device->init_commands, axis);
    return CM1E_OK;
}
