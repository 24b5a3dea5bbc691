#include "status_drive.h"

#include <math.h>
#include <stdio.h>

#include "cia402/cia402.h"
#include "core/bytes.h"

/** The objects to read, in the order of the printed lines, with the values of the device. */
static const struct {
    uint16_t index;
    uint8_t bytes;
    bool is_signed;
    const char *key, *label, *unit;
    double scale;
} readings[] = {
    {OBJ_6041_STATUSWORD, 2, false, "statusword", "state", "", 1},
    {OBJ_603F_ERROR_CODE, 2, false, "error_code", "error", "", 1},
    {OBJ_6061_MODES_OF_OPERATION_DISPLAY, 1, true, "mode", "mode", "", 1},
    {OBJ_6064_POSITION_ACTUAL_VALUE, 4, true, "position_counts", "position", "counts", 1},
    {OBJ_6077_TORQUE_ACTUAL_VALUE, 2, true, "torque_percent", "torque", "% of rated", 0.1},
    {OBJ_2301_TEMPERATURE, 2, true, "temperature_celsius", "temperature", "degrees C", 1},
    {OBJ_6079_DC_LINK_VOLTAGE, 4, true, "dc_link_volt", "motor supply", "V", 0.1},
    {OBJ_60FD_DIGITAL_INPUTS, 2, false, "digital_inputs", "inputs IN4...IN1", "", 1},
};
enum { STATUSWORD = 0, ERROR_CODE, MODE };
_Static_assert(sizeof readings / sizeof readings[0] == DRIVE_READINGS, "a reading in drive_status_t for each");

static void read_object(cm1e_bus_t *bus, uint16_t position, int i, reading_t *reading, cm1e_diag_t *diag)
{
    uint8_t data[64] = {0};
    reading->bytes = sizeof data;
    reading->error = cm1e_sdo_read(bus, position, readings[i].index, 0, data, &reading->bytes, diag);
    if (reading->error != CM1E_OK) {
        reading->abort_code = reading->error == CM1E_ERROR_SDO_ABORT ? diag->foreign_code : 0;
        return;
    }
    reading->valid = reading->bytes >= 1 && reading->bytes <= sizeof(uint64_t);
    if (!reading->valid) {
        reading->error = cm1e_diag_set(diag, CM1E_ERROR_BUS_MAILBOX, 0,
                                       "Slave %u: object 0x%04X has %zu bytes, which is no number; %u are right.",
                                       position, readings[i].index, reading->bytes, readings[i].bytes);
        return;
    }
    const uint64_t bits = cm1e_get_uint(data, (unsigned)reading->bytes);
    const unsigned shift = 64 - 8 * (unsigned)reading->bytes;
    reading->value =
        readings[i].scale * (readings[i].is_signed ? (double)((int64_t)(bits << shift) >> shift) : (double)bits);
}

bool read_drive(cm1e_bus_t *bus, uint16_t position, drive_status_t *drive, cm1e_diag_t *diag)
{
    cm1e_diag_t other;
    *drive = (drive_status_t){0};
    const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, position);
    drive->device = slave && slave->device ? slave->device->drives[0] : NULL;
    for (int i = 0; i < DRIVE_READINGS; i++)
        read_object(bus, position, i, &drive->readings[i], i == STATUSWORD ? diag : &other);
    return drive->readings[STATUSWORD].valid;
}

double drive_position(const drive_status_t *drive)
{
    return drive->readings[DRIVE_POSITION].valid ? drive->readings[DRIVE_POSITION].value : NAN;
}

/* ---- in words --------------------------------------------------------------------------------------------------- */

static const cm1e_device_error_t *error_of(const drive_status_t *drive)
{
    return drive->device ? drive->device->error((uint16_t)drive->readings[ERROR_CODE].value) : NULL;
}

/** 0x603F has codes that are not errors too: no mode selected, disabled by command ... (UG 7.3.1). */
static bool is_error(const drive_status_t *drive)
{
    const cm1e_device_error_t *row = error_of(drive);
    return drive->readings[ERROR_CODE].valid && (!row || row->fault);
}

const char *drive_label(const drive_status_t *drive, int i)
{
    const bool is_note = i == ERROR_CODE && drive->readings[i].valid && !is_error(drive);
    return is_note ? "note" : readings[i].label;
}

static const char *mode_name(const drive_status_t *drive)
{
    const cm1e_mode_row_t *mode = cm1e_mode_find((int8_t)drive->readings[MODE].value);
    return mode ? mode->name : "no mode selected";
}

static const char *state_name(const drive_status_t *drive)
{
    const cm1e_fsa_row_t *states = drive->device ? drive->device->modes[0].words->states : cm1e_fsa_table;
    return cm1e_fsa_name(cm1e_fsa_decode_by(states, (uint16_t)drive->readings[STATUSWORD].value));
}

static const char *error_name(const cm1e_device_error_t *error)
{
    return error ? error->text : "not a code of the manual";
}

static int unreadable_text(const reading_t *reading, char *text, size_t size)
{
    if (reading->abort_code)
        return snprintf(text, size, "not readable: SDO abort 0x%08X, %s", (unsigned)reading->abort_code,
                        cm1e_sdo_abort_text(reading->abort_code));
    if (reading->error == CM1E_ERROR_BUS_MAILBOX && reading->bytes > 0)
        return snprintf(text, size, "not readable: %zu bytes are no number", reading->bytes);
    return snprintf(text, size, "not readable: %s", cm1e_strerror(reading->error));
}

static int value_text(const drive_status_t *drive, int i, char *text, size_t size)
{
    const reading_t *reading = &drive->readings[i];
    const int value = (int)(int64_t)reading->value;
    if (i == STATUSWORD)
        return snprintf(text, size, "%s (0x%04X), motor power %s", state_name(drive), (unsigned)value & 0xFFFF,
                        value & STATUSWORD_VOLTAGE_ENABLED ? "on" : "off");
    if (i == ERROR_CODE) {
        const cm1e_device_error_t *error = error_of(drive);
        const char *cure = is_error(drive) && error && error->cure ? error->cure : "";
        return snprintf(text, size, "0x%04X %s%s%s", (unsigned)value & 0xFFFF, error_name(error), cure[0] ? ": " : "",
                        cure);
    }
    if (i == MODE)
        return snprintf(text, size, "%s", mode_name(drive));
    if (readings[i].index == OBJ_60FD_DIGITAL_INPUTS)
        return snprintf(text, size, "%d %d %d %d", value >> 3 & 1, value >> 2 & 1, value >> 1 & 1, value & 1);
    return snprintf(text, size, "%.*f %s", readings[i].scale < 1 ? 1 : 0, reading->value, readings[i].unit);
}

const char *drive_text(const drive_status_t *drive, int i, char *text, size_t size)
{
    const reading_t *reading = &drive->readings[i];
    if (!reading->valid) {
        unreadable_text(reading, text, size);
        return text;
    }
    const int length = value_text(drive, i, text, size);
    if (reading->bytes != readings[i].bytes && length >= 0 && (size_t)length < size)
        snprintf(text + length, size - (size_t)length, " (%zu bytes; in the guide %u)", reading->bytes,
                 readings[i].bytes);
    return text;
}

/* ---- as JSON ---------------------------------------------------------------------------------------------------- */

static json_t *reading_as_json(const reading_t *reading, bool is_whole)
{
    if (!reading->valid)
        return json_null();
    return is_whole ? json_integer((json_int_t)reading->value) : json_real(reading->value);
}

json_t *drive_status_as_json(const cm1e_slave_info_t *slave, const drive_status_t *drive)
{
    const char *code = error_name(error_of(drive));
    const struct {
        int reading;
        const char *key, *word;
    } words[] = {
        {STATUSWORD, "state", state_name(drive)},
        {ERROR_CODE, "error", is_error(drive) ? code : ""},
        {ERROR_CODE, "note", is_error(drive) ? "" : code},
        {MODE, "mode_name", mode_name(drive)},
    };
    json_t *object = json_pack("{s:i, s:s, s:s}", "position", slave->position, "name", slave->name, "firmware",
                               slave->software_version);
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        json_object_set_new(object, words[i].key,
                            drive->readings[words[i].reading].valid ? json_string(words[i].word) : json_null());
    for (int i = 0; i < DRIVE_READINGS; i++)
        json_object_set_new(object, readings[i].key, reading_as_json(&drive->readings[i], readings[i].scale == 1));
    return object;
}
