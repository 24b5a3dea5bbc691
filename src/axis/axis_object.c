/* Vendor parameters: objects of the drive by number, over SDO. Requests wait in a ring and are handled one after the
 * other, with a step in each cycle. A block polls its request by a ticket, so it may vanish at any time. */
#include <math.h>
#include <stdio.h>

#include "axis/axis_device.h"
#include "axis/axis_extras.h"
#include "axis/axis_parameters.h"
#include "axis/axis_text.h"
#include "core/bytes.h"

/* docs/DEVICE.md has the same table in words. No commands: what moves the motor goes through the blocks for it. */
static const cm1e_axis_objects_t table[] = {
    {1021, 1101, OBJ_60F6_K_PARAMETERS, 1}, /* K21 ... K101 */
    {1200, 1208, OBJ_60FB_H_PARAMETERS, 1}, /* H0 ... H8 */
    {1301, 1304, OBJ_2201_USER_VARIABLES, 1},
    {1400, 1400, OBJ_607C_HOME_OFFSET, 0},
    {1401, 1401, OBJ_6098_HOMING_METHOD, 0},
    {1402, 1402, OBJ_6099_HOMING_SPEEDS, 1},
    {1403, 1403, OBJ_609A_HOMING_ACCELERATION, 0},
    {1404, 1404, OBJ_6099_HOMING_SPEEDS, 2},
    {1410, 1410, OBJ_6081_PROFILE_VELOCITY, 0},
    {1411, 1411, OBJ_6083_PROFILE_ACCELERATION, 0},
    {1412, 1412, OBJ_6084_PROFILE_DECELERATION, 0},
    {1420, 1420, 0x605A, 0},
    {1421, 1421, 0x605B, 0},
    {1422, 1422, 0x605C, 0},
    {1423, 1423, 0x605E, 0},
    {1500, 1500, OBJ_2301_TEMPERATURE, 0},
    {1501, 1501, OBJ_6079_DC_LINK_VOLTAGE, 0},
    {1502, 1502, OBJ_6077_TORQUE_ACTUAL_VALUE, 0},
    {1503, 1503, OBJ_6064_POSITION_ACTUAL_VALUE, 0},
    {1504, 1504, OBJ_606C_VELOCITY_ACTUAL_VALUE, 0},
    {1505, 1505, OBJ_6041_STATUSWORD, 0},
    {1506, 1506, OBJ_603F_ERROR_CODE, 0},
    {1507, 1507, OBJ_1001_ERROR_REGISTER, 0},
    {1508, 1508, OBJ_6061_MODES_OF_OPERATION_DISPLAY, 0},
    {1509, 1509, OBJ_60FD_DIGITAL_INPUTS, 0},
    {1510, 1510, OBJ_60FE_DIGITAL_OUTPUTS, 0},
    {1520, 1520, 0x6072, 0},
    {1521, 1521, 0x6073, 0},
    {1522, 1522, 0x6075, 0},
    {1523, 1523, 0x6076, 0},
    {1524, 1524, OBJ_6502_SUPPORTED_DRIVE_MODES, 0},
    {1530, 1530, OBJ_F530_SYSTEM_INFO, CM1E_BRIDGE_STATUS_SUBINDEX(1)},
    {1531, 1531, OBJ_F530_SYSTEM_INFO, 1},
    {1532, 1532, OBJ_F530_SYSTEM_INFO, 9},
    {1533, 1533, OBJ_F530_SYSTEM_INFO, 13},
    {1534, 1537, OBJ_F530_SYSTEM_INFO, 17},
    {1600, 1600, OBJ_FF00_LED_BRIGHTNESS, 0},
    {1601, 1601, OBJ_FF01_LED_OVERRIDE, 0},
    {1610, 1610, OBJ_FE00_PDO_TIMING, 1},
    {1700, 1700, OBJ_1000_DEVICE_TYPE, 0},
    {1701, 1704, OBJ_1018_IDENTITY, 1},
};

const cm1e_axis_objects_t *cm1e_axis_object_table(size_t *count)
{
    *count = sizeof table / sizeof table[0];
    return table;
}

static const cm1e_axis_objects_t *row_of(int number)
{
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++)
        if (number >= table[i].first && number <= table[i].last)
            return &table[i];
    return NULL;
}

enum { F530_OF_DEVICE = 17 }; /* before it, sub-indexes of the four motors stand side by side (BR 7.4) */

/* The entry of a parameter; NULL: no such number, or the drive has no such object. */
static const cm1e_entry_t *entry_of(const cm1e_axis_t *axis, int number)
{
    const cm1e_axis_objects_t *row = row_of(number);
    if (!row)
        return NULL;
    const unsigned channel = axis->config->channel;
    unsigned first = row->subindex;
    if (row->index == OBJ_60FE_DIGITAL_OUTPUTS && !cm1e_drive_is_virtual(&axis->drive))
        first = axis->drive.kind->signals.output_subindex;
    if (channel && row->index == OBJ_F530_SYSTEM_INFO && row->subindex < F530_OF_DEVICE)
        first += channel - 1;
    return cm1e_drive_entry(&axis->drive, row->index, (uint8_t)(first + (unsigned)(number - row->first)));
}

int cm1e_axis_number_of_object(uint16_t index, uint8_t subindex)
{
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        const int number = table[i].first + subindex - table[i].subindex;
        if (table[i].index == index && number >= table[i].first && number <= table[i].last)
            return number;
    }
    return 0;
}

static object_request_t *request_of(cm1e_axis_t *axis, uint16_t sequence)
{
    return &axis->objects.requests[sequence % OBJECT_REQUESTS];
}

static cm1e_error_t check_write(const cm1e_axis_t *axis, const cm1e_entry_t *entry, double value)
{
    /* Outputs that are reached by SDO are written as objects too, but by who keeps them. */
    const bool outputs = entry->index == cm1e_drive_index(&axis->drive, OBJ_60FE_DIGITAL_OUTPUTS);
    if (!(entry->access & CM1E_ACCESS_WRITE) || (outputs && axis->drive.kind->signals.by_sdo))
        return CM1E_ERROR_AXIS_PARAMETER_READ_ONLY;
    /* The next cycle would write something else. */
    if (cm1e_bus_find_output(axis->drive.bus, axis->drive.position, entry->index, entry->subindex).bytes)
        return CM1E_ERROR_AXIS_PARAMETER_READ_ONLY;
    return value == floor(value) && value >= (double)entry->minimum && value <= (double)entry->maximum
               ? CM1E_OK : CM1E_ERROR_AXIS_PARAMETER_RANGE;
}

static cm1e_error_t check(const cm1e_axis_t *axis, int number, bool write, double value)
{
    const cm1e_entry_t *entry = entry_of(axis, number);
    if (cm1e_drive_is_virtual(&axis->drive) && row_of(number))
        return CM1E_ERROR_AXIS_VIRTUAL;
    if (!entry)
        return row_of(number) ? CM1E_ERROR_UNSUPPORTED : CM1E_ERROR_AXIS_PARAMETER;
    if (axis->drive.firmware && entry->since > axis->drive.firmware->firmware)
        return CM1E_ERROR_UNSUPPORTED;
    const cm1e_error_t error = write ? check_write(axis, entry, value) : CM1E_OK;
    if (error != CM1E_OK)
        return error;
    /* One less than there are: a result stays for a cycle at least. */
    return (uint16_t)(axis->objects.next - axis->objects.head) < OBJECT_REQUESTS - 1 ? CM1E_OK : CM1E_ERROR_FULL;
}

/* A block that reads asks in every call: what it is told again does not hide a later refusal. */
static void remember(cm1e_axis_t *axis, const object_request_t *request, not_set_t what)
{
    what.value = request->value;
    if (request->write)
        cm1e_axis_remember_not_set(axis, what);
    else
        cm1e_axis_remember_repeated(axis, what, !request->again);
}

static cm1e_error_t start(cm1e_axis_t *axis, int number, object_request_t request, uint32_t *ticket)
{
    *ticket = 0;
    const cm1e_error_t error = check(axis, number, request.write, request.value);
    if (error != CM1E_OK) {
        if (error != CM1E_ERROR_FULL)
            remember(axis, &request, (not_set_t){.error = error, .number = number});
        return error;
    }
    const uint16_t sequence = axis->objects.next++;
    *ticket = (uint32_t)number << 16 | sequence;
    request.ticket = *ticket;
    request.state = CM1E_COMMAND_BUFFERED;
    *request_of(axis, sequence) = request;
    cm1e_axis_set_extra(axis, EXTRA_OBJECTS, true);
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_object_start(cm1e_axis_t *axis, int number, bool write, double value, uint32_t *ticket)
{
    return start(axis, number, (object_request_t){.write = write, .value = value}, ticket);
}

cm1e_error_t cm1e_axis_object_read_again(cm1e_axis_t *axis, int number, uint32_t *ticket)
{
    return start(axis, number, (object_request_t){.again = true}, ticket);
}

cm1e_command_state_t cm1e_axis_object_state(const cm1e_axis_t *axis, uint32_t ticket, double *value,
                                            cm1e_error_t *error)
{
    const object_request_t *request = &axis->objects.requests[(uint16_t)ticket % OBJECT_REQUESTS];
    const bool mine = ticket != 0 && request->ticket == ticket;
    *value = mine ? request->value : 0.0;
    *error = mine ? (cm1e_error_t)request->error : CM1E_OK;
    return mine ? (cm1e_command_state_t)request->state : CM1E_COMMAND_UNKNOWN;
}

/* ---- the transfer ------------------------------------------------------------------------------------------------ */

static bool is_signed(const cm1e_entry_t *entry)
{
    return entry->type == CM1E_TYPE_SINT || entry->type == CM1E_TYPE_INT || entry->type == CM1E_TYPE_DINT;
}

static void finish(cm1e_axis_t *axis, object_request_t *request, cm1e_error_t error)
{
    objects_t *objects = &axis->objects;
    request->state = error != CM1E_OK ? CM1E_COMMAND_ERROR : CM1E_COMMAND_DONE;
    request->error = (int16_t)error;
    objects->submitted = false;
    objects->head++;
    cm1e_axis_set_extra(axis, EXTRA_OBJECTS, objects->head != objects->next);
    if (error != CM1E_OK)
        remember(axis, request, (not_set_t){.error = error, .number = cm1e_axis_object_number(request->ticket),
                                            .abort_code = objects->sdo.abort_code});
}

static void submit(cm1e_axis_t *axis, object_request_t *request, const cm1e_entry_t *entry)
{
    objects_t *objects = &axis->objects;
    const unsigned bytes = entry->bits / 8u;
    if (request->write)
        cm1e_put_uint(objects->data, bytes, (uint32_t)(int64_t)request->value);
    objects->sdo = (cm1e_sdo_t){.position = axis->drive.position, .index = entry->index, .subindex = entry->subindex,
                                .write = request->write, .data = objects->data,
                                .size = request->write ? bytes : sizeof objects->data};
    const cm1e_error_t error = cm1e_sdo_submit(axis->drive.bus, &objects->sdo);
    if (error == CM1E_OK) {
        objects->submitted = true;
        request->state = CM1E_COMMAND_ACTIVE;
    } else if (error != CM1E_ERROR_FULL) { /* if the queue is full, it is tried again */
        finish(axis, request, error);
    }
}

static double decode(const objects_t *objects, const cm1e_entry_t *entry)
{
    const unsigned bytes = (unsigned)objects->sdo.size;
    const uint64_t raw = cm1e_get_uint(objects->data, bytes), sign = UINT64_C(1) << (8 * bytes - 1);
    return is_signed(entry) ? (double)((int64_t)(raw ^ sign) - (int64_t)sign) : (double)raw;
}

void cm1e_axis_objects_step(cm1e_axis_t *axis)
{
    objects_t *objects = &axis->objects;
    object_request_t *request = request_of(axis, objects->head);
    const cm1e_entry_t *entry = entry_of(axis, cm1e_axis_object_number(request->ticket));
    if (!objects->submitted) {
        submit(axis, request, entry);
        return;
    }
    const cm1e_sdo_state_t state = cm1e_sdo_state(&objects->sdo);
    if (state == CM1E_SDO_ERROR) {
        finish(axis, request, objects->sdo.error);
    } else if (state == CM1E_SDO_DONE) {
        if (!request->write && (objects->sdo.size == 0 || objects->sdo.size > sizeof objects->data)) {
            finish(axis, request, CM1E_ERROR_BUS_MAILBOX);
            return;
        }
        if (!request->write)
            request->value = decode(objects, entry);
        finish(axis, request, CM1E_OK);
    }
}

/* Explains a number that only other drives have. */
static void lacking_text(const cm1e_axis_t *axis, const cm1e_axis_objects_t *row, char *text, size_t size)
{
    const int number = axis->not_set.number;
    const cm1e_drive_t *drive = &axis->drive;
    if (row->index == OBJ_60F6_K_PARAMETERS)
        snprintf(text, size, "Axis \"%s\": parameter %d: %sa %s has no K%d.", axis->config->name, number,
                 drive->kind->place, drive->kind->short_name, number - CM1E_PARAMETER_VENDOR);
    else
        snprintf(text, size, "Axis \"%s\": parameter %d: %sa %s has no object 0x%04X:%02X.", axis->config->name, number,
                 drive->kind->place, drive->kind->short_name, row->index,
                 (unsigned)(row->subindex + number - row->first));
}

void cm1e_axis_object_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const not_set_t *refused = &axis->not_set;
    const cm1e_entry_t *entry = entry_of(axis, refused->number);
    const char *name = axis->config->name;
    if (!entry && row_of(refused->number))
        lacking_text(axis, row_of(refused->number), text, size);
    else if (!entry)
        snprintf(text, size, "Axis \"%s\": parameter %d: %s. Right is %s.", name, refused->number,
                 cm1e_strerror(refused->error), CM1E_PARAMETER_NUMBERS);
    else if (refused->error == CM1E_ERROR_SDO_ABORT)
        snprintf(text, size, "Axis \"%s\": parameter %d, object 0x%04X:%02X \"%s\": the drive refused with SDO abort "
                 "code 0x%08X (%s).", name, refused->number, entry->index, entry->subindex, entry->name,
                 (unsigned)refused->abort_code, cm1e_sdo_abort_text(refused->abort_code));
    else if (refused->error == CM1E_ERROR_AXIS_PARAMETER_RANGE)
        snprintf(text, size, "Axis \"%s\": parameter %d, object 0x%04X:%02X \"%s\": %.10g was given; a whole number, "
                 "%lld ... %lld is right.", name, refused->number, entry->index, entry->subindex, entry->name,
                 refused->value, (long long)entry->minimum, (long long)entry->maximum);
    else
        snprintf(text, size, "Axis \"%s\": parameter %d, object 0x%04X:%02X \"%s\": %s.", name, refused->number,
                 entry->index, entry->subindex, entry->name, cm1e_strerror(refused->error));
}
