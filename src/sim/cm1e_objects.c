/* The objects that the drive works with: which of them an index is, and entries that differ between drives. */
#include "sim/cm1e_app.h"

/* Objects that the drive works with, in order of index. */
#define PLACE(member) (offsetof(cm1e_sim_objects_t, member) / sizeof(int32_t))
static const struct {
    uint16_t index;
    uint8_t subindex, place;
} places[] = {
    {OBJ_1001_ERROR_REGISTER, 0, PLACE(error_register)},
    {OBJ_1C32_SM_OUTPUT_PARAMETER, 2, PLACE(output_cycle_ns)},
    {OBJ_1C33_SM_INPUT_PARAMETER, 2, PLACE(input_cycle_ns)},
    {OBJ_2201_USER_VARIABLES, 1, PLACE(user_variable_1)},
    {OBJ_2301_TEMPERATURE, 0, PLACE(temperature)},
    {OBJ_603F_ERROR_CODE, 0, PLACE(error_code)},
    {OBJ_6040_CONTROLWORD, 0, PLACE(controlword)},
    {OBJ_6041_STATUSWORD, 0, PLACE(statusword)},
    {OBJ_6060_MODES_OF_OPERATION, 0, PLACE(mode)},
    {OBJ_6061_MODES_OF_OPERATION_DISPLAY, 0, PLACE(mode_display)},
    {OBJ_6064_POSITION_ACTUAL_VALUE, 0, PLACE(position)},
    {OBJ_606C_VELOCITY_ACTUAL_VALUE, 0, PLACE(velocity)},
    {OBJ_6077_TORQUE_ACTUAL_VALUE, 0, PLACE(torque)},
    {OBJ_6079_DC_LINK_VOLTAGE, 0, PLACE(dc_link)},
    {OBJ_607A_TARGET_POSITION, 0, PLACE(target_position)},
    {OBJ_607C_HOME_OFFSET, 0, PLACE(home_offset)},
    {OBJ_6081_PROFILE_VELOCITY, 0, PLACE(profile_velocity)},
    {OBJ_6083_PROFILE_ACCELERATION, 0, PLACE(profile_acceleration)},
    {OBJ_6084_PROFILE_DECELERATION, 0, PLACE(profile_deceleration)},
    {OBJ_6098_HOMING_METHOD, 0, PLACE(homing_method)},
    {OBJ_6099_HOMING_SPEEDS, 1, PLACE(homing_speed)},
    {OBJ_609A_HOMING_ACCELERATION, 0, PLACE(homing_acceleration)},
    {OBJ_60F6_K_PARAMETERS, CM1E_K_PARAMETER_HOMING_TORQUE, PLACE(homing_torque)},
    {OBJ_60FD_DIGITAL_INPUTS, 0, PLACE(digital_inputs)},
    {OBJ_60FE_DIGITAL_OUTPUTS, 0, PLACE(digital_outputs)},
    {OBJ_60FF_TARGET_VELOCITY, 0, PLACE(target_velocity)},
    {OBJ_FE00_PDO_TIMING, 1, PLACE(cycle_time_us)},
};
enum { PLACE_COUNT = sizeof places / sizeof places[0] };

int cm1e_sim_object_place(uint16_t index, uint8_t subindex)
{
    for (size_t i = 0; i < PLACE_COUNT; i++)
        if (places[i].index == index && places[i].subindex == subindex)
            return places[i].place;
    return -1;
}

/* Devices that take kpulses/s2 on the wire (UG 6.2.3) have these in place of the device tables' entries. */
static const cm1e_entry_t kpulses_entries[] = {
    {.index = OBJ_6083_PROFILE_ACCELERATION, .access = CM1E_ACCESS_READ | CM1E_ACCESS_WRITE | CM1E_ACCESS_RXPDO,
     .type = CM1E_TYPE_UDINT, .bits = 32, .name = "Profile acceleration", .unit = "kcounts/s2", .maximum = 32767,
     .kept_minimum = 1},
    {.index = OBJ_6084_PROFILE_DECELERATION, .access = CM1E_ACCESS_READ | CM1E_ACCESS_WRITE,
     .type = CM1E_TYPE_UDINT, .bits = 32, .name = "Profile deceleration", .unit = "kcounts/s2", .default_value = 25,
     .maximum = 32767, .kept_minimum = 1},
};

const cm1e_entry_t *cm1e_sim_own_entry(const cm1e_sim_cm1e_t *drive, const cm1e_entry_t *entry)
{
    if (drive->config.acceleration_in_kpulses)
        for (size_t i = 0; i < sizeof kpulses_entries / sizeof kpulses_entries[0]; i++)
            if (kpulses_entries[i].index == entry->index)
                return &kpulses_entries[i];
    return entry;
}

bool cm1e_sim_tells_itself(uint16_t index, uint8_t subindex)
{
    return !(cm1e_device_entry(index, subindex)->access & CM1E_ACCESS_WRITE);
}

void cm1e_sim_objects_reset(cm1e_sim_cm1e_t *drive)
{
    drive->objects = (cm1e_sim_objects_t){0};
    int32_t *objects = (int32_t *)&drive->objects;
    for (size_t i = 0; i < PLACE_COUNT; i++) {
        cm1e_sim_cell_t cell;
        const bool kept = !cm1e_sim_tells_itself(places[i].index, places[i].subindex) &&
                          cm1e_sim_store_find(&drive->store, places[i].index, places[i].subindex, &cell) == 0;
        const cm1e_entry_t *entry = kept ? cell.entry : cm1e_device_entry(places[i].index, places[i].subindex);
        objects[places[i].place] = (int32_t)cm1e_sim_own_entry(drive, entry)->default_value;
    }
}
