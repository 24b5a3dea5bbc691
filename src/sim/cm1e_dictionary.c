#include <string.h>

#include "sim/cm1e_app.h"

const cm1e_entry_t *cm1e_sim_entry(void *app, uint16_t index, uint8_t subindex)
{
    const cm1e_sim_cm1e_t *drive = app;
    cm1e_sim_cell_t cell;
    return cm1e_sim_store_find(&drive->store, index, subindex, &cell) == 0 ? cm1e_sim_own_entry(drive, cell.entry)
                                                                           : NULL;
}

const cm1e_object_t *cm1e_sim_object(void *app, size_t n)
{
    return cm1e_sim_store_object(&((const cm1e_sim_cm1e_t *)app)->store, n);
}

/* ---- creation and power-on -------------------------------------------------------------------------------------- */

bool cm1e_sim_dictionary_create(cm1e_sim_cm1e_t *drive)
{
    return cm1e_sim_store_create(&drive->store, &cm1e_device_cm1e, drive->firmware->firmware);
}

static void set_value(cm1e_sim_cm1e_t *drive, uint16_t index, uint8_t subindex, int64_t value)
{
    cm1e_sim_store_set(&drive->store, index, subindex, value);
}

/* The mapping objects show the order that this device has. */
static void set_mapping_objects(cm1e_sim_cm1e_t *drive)
{
    for (int transmit = 0; transmit < 2; transmit++)
        for (int mapping = CM1E_MAPPING_DYNAMIC; mapping <= CM1E_MAPPING_PROFILE; mapping++) {
            cm1e_pdo_t pdo;
            cm1e_device_pdo(&pdo, (cm1e_mapping_t)mapping, transmit != 0, drive->order, drive->firmware->firmware);
            set_value(drive, pdo.index, 0, pdo.entry_count);
            for (uint8_t i = 0; i < pdo.entry_count; i++) {
                const cm1e_pdo_entry_t *entry = &pdo.entries[i];
                set_value(drive, pdo.index, (uint8_t)(i + 1),
                          (int64_t)entry->index << 16 | (int64_t)entry->subindex << 8 | entry->bits);
            }
        }
}

/* UG 7.5: a 17L30D (peak 0.54 Nm, 1.8 A) shows max current 120 %, rated current 1.5 A, max torque 125 %, so its rated
 * values are its peak values divided by these; the other motors are taken to be rated alike. */
enum { OBJ_6072_PEAK_TORQUE = 0x6072, OBJ_6073_MAX_CURRENT, OBJ_6075_RATED_CURRENT = 0x6075, OBJ_6076_RATED_TORQUE };

static void set_motor_objects(cm1e_sim_cm1e_t *drive)
{
    const int64_t peak_torque = cm1e_device_entry(OBJ_6072_PEAK_TORQUE, 0)->default_value;
    const int64_t max_current = cm1e_device_entry(OBJ_6073_MAX_CURRENT, 0)->default_value;
    drive->rated_torque = drive->motor->peak_torque_nm * 1000 / (double)peak_torque;
    drive->overload_gain = 1 / (drive->rated_torque * drive->rated_torque);
    const double rated_current_ma = drive->motor->peak_current_a * 1e6 / (double)max_current;
    set_value(drive, OBJ_6075_RATED_CURRENT, 0, (int64_t)(rated_current_ma + 0.5));
    set_value(drive, OBJ_6076_RATED_TORQUE, 0, (int64_t)(drive->rated_torque * 1000 + 0.5));
}

/* UG 7.3.23, 7.4.4 */
static bool non_volatile(uint16_t index) { return index == OBJ_60FB_H_PARAMETERS || index == OBJ_FF00_LED_BRIGHTNESS; }

/* Of the objects that the drive works with too. */
static void set_profile_values(cm1e_sim_cm1e_t *drive)
{
    const cm1e_sim_profile_t *profile = drive->store.profile;
    cm1e_sim_store_set_profile_values(&drive->store);
    for (size_t i = 0; profile && i < profile->entry_count; i++) {
        const int place = cm1e_sim_object_place(profile->entries[i].index, profile->entries[i].subindex);
        if (place >= 0 && profile->entries[i].has_value &&
            !cm1e_sim_tells_itself(profile->entries[i].index, profile->entries[i].subindex))
            ((int32_t *)&drive->objects)[place] = (int32_t)profile->entries[i].value;
    }
}

void cm1e_sim_dictionary_reset(cm1e_sim_cm1e_t *drive)
{
    const cm1e_sim_store_t *store = &drive->store;
    for (size_t i = 0; i < store->object_count; i++) {
        const cm1e_object_t *object = store->objects[i];
        for (uint16_t k = 0; k < object->entry_count && !non_volatile(object->index); k++)
            store->values[store->first_entry[i] + k] = cm1e_sim_own_entry(drive, &object->entries[k])->default_value;
    }
    cm1e_sim_objects_reset(drive);
    set_value(drive, OBJ_1018_IDENTITY, 3, drive->firmware->revision);
    set_value(drive, OBJ_1C32_SM_OUTPUT_PARAMETER, 5, drive->firmware->shortest_cycle_ns);
    set_value(drive, OBJ_1C33_SM_INPUT_PARAMETER, 5, drive->firmware->shortest_cycle_ns);
    set_mapping_objects(drive);
    set_motor_objects(drive);
    set_profile_values(drive);
}

bool cm1e_sim_dictionary_renew(cm1e_sim_cm1e_t *drive)
{
    const cm1e_sim_store_t before = drive->store;
    cm1e_sim_store_t renewed = {0};
    if (!cm1e_sim_store_create(&renewed, &cm1e_device_cm1e, drive->firmware->firmware)) {
        cm1e_sim_store_destroy(&renewed);
        return false;
    }
    for (size_t i = 0; i < before.object_count; i++)
        for (uint16_t k = 0; k < before.objects[i]->entry_count && non_volatile(before.objects[i]->index); k++)
            cm1e_sim_store_set(&renewed, before.objects[i]->index, before.objects[i]->entries[k].subindex,
                               before.values[before.first_entry[i] + k]);
    cm1e_sim_store_destroy(&drive->store);
    drive->store = renewed;
    cm1e_sim_dictionary_reset(drive);
    return true;
}

/* ---- access ----------------------------------------------------------------------------------------------------- */

static int64_t present_value(const cm1e_sim_cm1e_t *drive, const cm1e_sim_cell_t *cell)
{
    const cm1e_entry_t *entry = cell->entry;
    if (entry->index == OBJ_1C12_RXPDO_ASSIGN || entry->index == OBJ_1C13_TXPDO_ASSIGN) {
        const cm1e_sim_image_t *image = entry->index == OBJ_1C12_RXPDO_ASSIGN ? &drive->outputs : &drive->inputs;
        return entry->subindex == 0 ? image->assigned : image->pdo;
    }
    const int place = cm1e_sim_object_place(entry->index, entry->subindex);
    return place >= 0 ? ((const int32_t *)&drive->objects)[place] : *cell->value;
}

/* The version that the tables have is the newest one. */
static const char *present_text(const cm1e_sim_cm1e_t *drive, const cm1e_entry_t *entry)
{
    const cm1e_entry_t *ours = cm1e_device_entry(entry->index, entry->subindex);
    const bool is_of_tables = ours && ours->default_string && strcmp(ours->default_string, entry->default_string) == 0;
    return entry->index == OBJ_100A_SOFTWARE_VERSION && is_of_tables ? drive->firmware->version : entry->default_string;
}

static bool is_refused(const cm1e_sim_cm1e_t *drive, uint16_t index, uint8_t subindex)
{
    const cm1e_sim_refusal_t *refusal = &drive->troubles.refusal;
    return refusal->writing && refusal->index == index && refusal->subindex == subindex;
}

uint32_t cm1e_sim_sdo_read(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, uint8_t *data, size_t *size)
{
    (void)al_state; /* the dictionary is there in every state since V1.2.0 (UG 10.1) */
    cm1e_sim_cm1e_t *drive = app;
    cm1e_sim_cell_t cell;
    const uint32_t missing = cm1e_sim_store_find_readable(&drive->store, index, subindex, &cell);
    if (missing)
        return missing;
    if (drive->troubles.refusal.missing && is_refused(drive, index, subindex))
        return SDO_ABORT_NO_SUBINDEX;
    if (cell.entry->type == CM1E_TYPE_STRING)
        return cm1e_sim_give_text(present_text(drive, cell.entry), data, size);
    cm1e_sim_refresh(drive);
    return cm1e_sim_give_number(cell.entry, present_value(drive, &cell), data, size);
}

static uint32_t check_value(const cm1e_entry_t *entry, int64_t value)
{
    const uint32_t abort_code = cm1e_sim_check_range(entry, value);
    if (abort_code == 0 && entry->index == OBJ_6060_MODES_OF_OPERATION && value != CM1E_MODE_NONE &&
        !cm1e_mode_find((int8_t)value))
        return SDO_ABORT_RANGE;
    return abort_code;
}

uint32_t cm1e_sim_sdo_write(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, const uint8_t *data,
                            size_t size)
{
    cm1e_sim_cm1e_t *drive = app;
    cm1e_sim_cell_t cell;
    const uint32_t missing = cm1e_sim_store_find(&drive->store, index, subindex, &cell);
    if (missing)
        return missing;
    const cm1e_entry_t *entry = cm1e_sim_own_entry(drive, cell.entry);
    if (is_refused(drive, index, subindex))
        return drive->troubles.refusal.missing ? SDO_ABORT_NO_SUBINDEX : SDO_ABORT_HARDWARE;
    uint32_t abort_code = entry->type == CM1E_TYPE_STRING ? SDO_ABORT_READ_ONLY
                                                          : cm1e_sim_check_write(entry, al_state, size);
    if (abort_code)
        return abort_code;
    int64_t value = cm1e_sim_take_number(entry, data);
    if (index == OBJ_1C12_RXPDO_ASSIGN || index == OBJ_1C13_TXPDO_ASSIGN)
        return cm1e_sim_assign_write(drive, index, subindex, (uint32_t)value);
    abort_code = check_value(entry, value);
    if (abort_code)
        return abort_code;
    value = cm1e_entry_round(entry, value);
    const int place = cm1e_sim_object_place(index, subindex);
    if (place >= 0)
        ((int32_t *)&drive->objects)[place] = (int32_t)value;
    else
        *cell.value = value;
    if (index == OBJ_6060_MODES_OF_OPERATION)
        cm1e_sim_fsa_request_mode(drive);
    return 0;
}
