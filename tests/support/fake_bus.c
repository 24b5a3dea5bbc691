/* The device and the bus that it hangs on, as fake_bus.h says. */
#include "fake_bus.h"

#include <stdio.h>
#include <string.h>

#include "cm1e/clocks.h"
#include "cm1e/io.h"

void fake_bus_init(cm1e_bus_t *bus, cm1e_mapping_t mapping, cm1e_pdo_order_t order, cm1e_firmware_t firmware)
{
    memset(bus, 0, sizeof *bus);
    cm1e_clock_init_virtual(&bus->clock, 0);
    bus->config.axis_count = 1;
    bus->config.axes = bus->axes;
    bus->config.axes[0].mapping = mapping;
    snprintf(bus->config.axes[0].name, sizeof bus->config.axes[0].name, "slide");
    bus->firmware = firmware;
    cm1e_device_pdo(&bus->rx, mapping, false, order, firmware);
    cm1e_device_pdo(&bus->tx, mapping, true, order, firmware);
    bus->power = true;
    bus->state = READY_TO_SWITCH_ON;
    bus->mode = bus->sdo_mode = CM1E_MODE_CSP;
    bus->watch.al_state = CM1E_AL_OP;
}

cm1e_image_slot_t fake_find(const cm1e_pdo_t *pdo, uint16_t index)
{
    uint32_t offset = 0;
    for (unsigned i = 0; i < pdo->entry_count; i++) {
        if (pdo->entries[i].index == index)
            return (cm1e_image_slot_t){.offset = offset, .bytes = (uint8_t)(pdo->entries[i].bits / 8)};
        offset += pdo->entries[i].bits / 8u;
    }
    return (cm1e_image_slot_t){0};
}

uint32_t fake_output(const cm1e_bus_t *bus, uint16_t index, uint32_t otherwise)
{
    const cm1e_image_slot_t slot = fake_find(&bus->rx, index);
    return slot.bytes ? (uint32_t)cm1e_get_uint(bus->outputs + slot.offset, slot.bytes) : otherwise;
}

void fake_input(cm1e_bus_t *bus, uint16_t index, uint32_t value)
{
    const cm1e_image_slot_t slot = fake_find(&bus->tx, index);
    if (slot.bytes)
        cm1e_put_uint(bus->inputs + slot.offset, slot.bytes, value);
}

static uint16_t fake_statusword(const cm1e_bus_t *bus)
{
    return (uint16_t)(cm1e_fsa_table[bus->state].value | (bus->power ? STATUSWORD_VOLTAGE_ENABLED : 0) |
                      STATUSWORD_REMOTE | bus->mode_status);
}

/** Slave number n as a device of its own. */
static cm1e_bus_t *fake_slave(const cm1e_bus_t *bus, unsigned position)
{
    return position >= 2 && position <= FAKE_SLAVES && bus->others[position - 2] ? bus->others[position - 2]
                                                                                 : (cm1e_bus_t *)(uintptr_t)bus;
}

void fake_bus_show(cm1e_bus_t *bus)
{
    for (unsigned i = 0; i < FAKE_SLAVES - 1 && bus->others[i]; i++) {
        fake_bus_show(bus->others[i]);
        memcpy(bus->inputs + (i + 1) * FAKE_IMAGE, bus->others[i]->inputs, FAKE_IMAGE);
    }
    fake_input(bus, OBJ_6041_STATUSWORD, fake_statusword(bus));
    fake_input(bus, OBJ_603F_ERROR_CODE, bus->error_code);
    fake_input(bus, OBJ_6064_POSITION_ACTUAL_VALUE, (uint32_t)bus->position);
    fake_input(bus, OBJ_606C_VELOCITY_ACTUAL_VALUE, (uint32_t)bus->velocity_raw);
    fake_input(bus, OBJ_6077_TORQUE_ACTUAL_VALUE, (uint16_t)bus->torque);
    fake_input(bus, OBJ_60FD_DIGITAL_INPUTS, bus->digital_inputs);
    fake_input(bus, OBJ_6061_MODES_OF_OPERATION_DISPLAY, (uint8_t)bus->mode);
}

static void fake_follow_controlword(cm1e_bus_t *bus, uint16_t before)
{
    const uint16_t word = bus->controlword;
    if (bus->state == FAULT) {
        if ((word & CONTROLWORD_FAULT_RESET) && !(before & CONTROLWORD_FAULT_RESET)) {
            bus->reset_edges++;
            if (!bus->fault_stays) {
                bus->state = READY_TO_SWITCH_ON;
                bus->error_code = 0;
            }
        }
        return;
    }
    const uint16_t low = word & 0x000F;
    if (low == 0x000F && bus->state >= SWITCHED_ON)
        bus->state = OPERATION_ENABLED;
    else if ((low == 0x000F || low == 0x0007) && bus->state >= READY_TO_SWITCH_ON)
        bus->state = SWITCHED_ON;
    else if (low != 0x0007)
        bus->state = READY_TO_SWITCH_ON;
    if (bus->state >= SWITCHED_ON && !bus->power) {
        bus->state = FAULT;
        bus->error_code = 0xFF05;
    }
}

static void fake_follow_mode(cm1e_bus_t *bus)
{
    const int8_t wanted = (int8_t)fake_output(bus, OBJ_6060_MODES_OF_OPERATION, (uint8_t)bus->sdo_mode);
    if (wanted == bus->mode)
        bus->mode_wait = bus->mode_delay;
    else if (bus->mode_wait > 0)
        bus->mode_wait--;
    else
        bus->mode = wanted;
}

static void fake_log_sdo(cm1e_bus_t *bus, const cm1e_sdo_t *sdo)
{
    if (bus->sdo_count >= FAKE_SDO_LOG || sdo->size == 0 || sdo->size > 8)
        return;
    const uint64_t raw = cm1e_get_uint(sdo->data, (unsigned)sdo->size);
    const uint64_t sign = UINT64_C(1) << (8 * sdo->size - 1);
    bus->sdo_log[bus->sdo_count++] = (fake_sdo_entry_t){sdo->index, sdo->subindex, sdo->write,
                                                        (int64_t)(raw ^ sign) - (int64_t)sign};
}

static void fake_serve_sdo(cm1e_bus_t *bus)
{
    if (!bus->sdo || bus->sdo_wait-- > 0)
        return;
    cm1e_sdo_t *sdo = bus->sdo;
    bus->sdo = bus->sdo_waiting[0];
    memmove(bus->sdo_waiting, bus->sdo_waiting + 1, sizeof bus->sdo_waiting - sizeof bus->sdo_waiting[0]);
    bus->sdo_waiting[FAKE_SDO_WAITING - 1] = NULL;
    bus->sdo_wait = bus->sdo_delay;
    const bool wrong_size = sdo->write && sdo->index == OBJ_6060_MODES_OF_OPERATION && sdo->size != 1;
    if (sdo->index == bus->sdo_abort_index || wrong_size) {
        sdo->error = CM1E_ERROR_SDO_ABORT;
        sdo->abort_code = 0x06090030;
        sdo->state = CM1E_SDO_ERROR;
        return;
    }
    if (bus->device_sdo) {
        bus->device_sdo(bus, sdo);
        fake_log_sdo(bus, sdo);
        return;
    }
    uint8_t *data = sdo->data;
    if (!sdo->write && sdo->index == OBJ_6061_MODES_OF_OPERATION_DISPLAY) {
        data[0] = (uint8_t)bus->mode;
        sdo->size = 1;
    } else if (!sdo->write && bus->sdo_read_bytes) {
        cm1e_put_uint(data, bus->sdo_read_bytes, (uint64_t)bus->sdo_read_value);
        sdo->size = bus->sdo_read_bytes;
    }
    if (sdo->write && sdo->index == OBJ_6060_MODES_OF_OPERATION)
        bus->sdo_mode = (int8_t)data[0];
    fake_log_sdo(bus, sdo);
    sdo->state = CM1E_SDO_DONE;
}

void fake_bus_cycle(cm1e_bus_t *bus, int64_t cycle_ns)
{
    for (unsigned i = 0; i < FAKE_SLAVES - 1 && bus->others[i]; i++) {
        memcpy(bus->others[i]->outputs, bus->outputs + (i + 1) * FAKE_IMAGE, FAKE_IMAGE);
        fake_bus_cycle(bus->others[i], cycle_ns);
        memcpy(bus->inputs + (i + 1) * FAKE_IMAGE, bus->others[i]->inputs, FAKE_IMAGE);
    }
    bus->sent_ns = bus->clock.virtual_now_ns;
    bus->clock.virtual_now_ns += cycle_ns;
    fake_serve_sdo(bus);
    if (bus->device_cycle) {
        bus->device_cycle(bus);
        return;
    }
    const uint16_t before = bus->controlword;
    bus->controlword = (uint16_t)fake_output(bus, OBJ_6040_CONTROLWORD, 0);
    bus->target_position = (int32_t)fake_output(bus, OBJ_607A_TARGET_POSITION, 0);
    bus->target_velocity_raw = (int32_t)fake_output(bus, OBJ_60FF_TARGET_VELOCITY, 0);
    bus->digital_outputs = (uint16_t)fake_output(bus, OBJ_60FE_DIGITAL_OUTPUTS, 0);
    bus->profile_velocity = fake_output(bus, OBJ_6081_PROFILE_VELOCITY, 0);
    bus->profile_acceleration = fake_output(bus, OBJ_6083_PROFILE_ACCELERATION, 0);
    if (!bus->frozen) {
        fake_follow_controlword(bus, before);
        fake_follow_mode(bus);
    }
    if (bus->state == OPERATION_ENABLED && bus->mode == CM1E_MODE_CSP && fake_find(&bus->rx, 0x607A).bytes) {
        const int32_t step = (int32_t)((uint32_t)bus->target_position - (uint32_t)bus->position);
        const int64_t size = step < 0 ? -(int64_t)step : step;
        if (size > bus->torque_step)
            bus->torque_step = size;
        if (!bus->blocked)
            bus->position = bus->target_position;
        const int64_t unit = cm1e_firmware_info(bus->firmware)->velocity_in_counts_per_ms ? 1000 : 1;
        const int64_t moved = bus->blocked ? 0 : (int64_t)step * 1000000000 / cycle_ns / unit;
        if (moved != 0 || bus->turns) /* at rest a test may say what it likes */
            bus->velocity_raw = (int32_t)(moved > INT32_MAX ? INT32_MAX : moved < INT32_MIN ? INT32_MIN : moved);
        bus->turns = moved != 0;
    }
    if (bus->mode == CM1E_MODE_HM && bus->homing)
        bus->homing(bus);
    if (bus->world)
        bus->world(bus);
    fake_bus_show(bus);
}

void fake_bus_add(cm1e_bus_t *bus, cm1e_bus_t *slave)
{
    unsigned i = 0;
    while (bus->others[i])
        i++;
    bus->others[i] = slave;
    bus->config.axes[bus->config.axis_count++] = slave->config.axes[0];
}

void fake_bus_fault(cm1e_bus_t *bus, uint16_t code)
{
    bus->state = FAULT;
    bus->error_code = code;
}

/* ---- the seam ---------------------------------------------------------------------------------------------------- */

uint8_t *cm1e_bus_outputs(cm1e_bus_t *bus) { return bus->outputs; }
const uint8_t *cm1e_bus_inputs(const cm1e_bus_t *bus) { return bus->inputs; }
const cm1e_bus_config_t *cm1e_bus_configuration(const cm1e_bus_t *bus) { return &bus->config; }
const cm1e_bus_counters_t *cm1e_bus_counters(const cm1e_bus_t *bus) { return &bus->counters; }
const cm1e_slave_info_t *cm1e_bus_slave(const cm1e_bus_t *bus, uint32_t position)
{
    return &fake_slave(bus, position)->info;
}
uint16_t cm1e_bus_axis_position(const cm1e_bus_t *bus, uint32_t axis)
{
    return axis < bus->config.axis_count ? (uint16_t)(axis + 1) : 0;
}
cm1e_clock_t *cm1e_bus_clock(cm1e_bus_t *bus) { return &bus->clock; }
void cm1e_bus_slave_clock_sized(const cm1e_bus_t *bus, uint16_t position, cm1e_slave_clock_t *clock, size_t size)
{
    (void)bus;
    (void)position;
    memset(clock, 0, size);
}
void cm1e_bus_clocks_sized(const cm1e_bus_t *bus, cm1e_bus_clocks_t *clocks, size_t size)
{
    (void)bus;
    memset(clocks, 0, size);
}
int64_t cm1e_bus_sent_ns(const cm1e_bus_t *bus) { return bus->sent_ns; }
const cm1e_firmware_info_t *cm1e_bus_slave_firmware(const cm1e_bus_t *bus, uint16_t position)
{
    const cm1e_bus_t *slave = fake_slave(bus, position);
    return slave->firmware_unreadable ? NULL : cm1e_firmware_info(slave->firmware);
}
static cm1e_image_slot_t fake_part(const cm1e_bus_t *bus, const cm1e_bus_t *slave, uint16_t position,
                                   cm1e_image_slot_t slot)
{
    if (slave != bus && slot.bytes)
        slot.offset = (slot.offset + (position - 1u) * FAKE_IMAGE) & 0xFFFFFF;
    return slot;
}
cm1e_image_slot_t cm1e_bus_find_output(const cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex)
{
    const cm1e_bus_t *slave = fake_slave(bus, position);
    return fake_part(bus, slave, position, subindex == 0 ? fake_find(&slave->rx, index) : (cm1e_image_slot_t){0});
}
cm1e_image_slot_t cm1e_bus_find_input(const cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex)
{
    const cm1e_bus_t *slave = fake_slave(bus, position);
    return fake_part(bus, slave, position, subindex == 0 ? fake_find(&slave->tx, index) : (cm1e_image_slot_t){0});
}
cm1e_slave_watch_t cm1e_bus_slave_watch(const cm1e_bus_t *bus, uint16_t position)
{
    return fake_slave(bus, position)->watch;
}
uint16_t cm1e_bus_missing_slave(const cm1e_bus_t *bus) { return bus->missing; }
const char *cm1e_bus_slave_label(const cm1e_bus_t *bus, uint16_t position, char label[CM1E_LABEL_LENGTH])
{
    (void)bus;
    snprintf(label, CM1E_LABEL_LENGTH, "slave %u", position);
    return label;
}
uint32_t cm1e_bus_slave_looks(const cm1e_bus_t *bus, uint16_t position)
{
    return ++fake_slave(bus, position)->looks;
}
bool cm1e_bus_slave_goes_on(const cm1e_bus_t *bus, uint16_t position, const cm1e_slave_watch_t *seen)
{
    const cm1e_slave_watch_t now = fake_slave(bus, position)->watch;
    return now.al_state == seen->al_state && now.al_status_code == seen->al_status_code && now.lost == seen->lost &&
           now.silent == seen->silent && now.out == seen->out && now.bound == seen->bound &&
           now.absent == seen->absent && now.fresh == seen->fresh;
}
void cm1e_bus_request_recovery(cm1e_bus_t *bus, uint16_t position)
{
    fake_slave(bus, position)->recoveries++;
}
const char *cm1e_al_status_text(uint16_t al_status_code) { return al_status_code ? "an AL status" : "no error"; }
const char *cm1e_sdo_abort_text(uint32_t abort_code) { return abort_code ? "an abort" : "no abort"; }

cm1e_sdo_state_t cm1e_sdo_state(const cm1e_sdo_t *sdo) { return (cm1e_sdo_state_t)sdo->state; }
cm1e_error_t cm1e_sdo_submit(cm1e_bus_t *bus, cm1e_sdo_t *sdo)
{
    unsigned waiting = 0;
    bus = fake_slave(bus, sdo->position);
    while (waiting < FAKE_SDO_WAITING && bus->sdo_waiting[waiting])
        waiting++;
    if (bus->sdo_full || waiting == FAKE_SDO_WAITING)
        return CM1E_ERROR_FULL;
    sdo->state = CM1E_SDO_BUSY;
    if (bus->sdo) {
        bus->sdo_waiting[waiting] = sdo;
        return CM1E_OK;
    }
    bus->sdo = sdo;
    bus->sdo_wait = bus->sdo_delay;
    return CM1E_OK;
}
cm1e_error_t cm1e_sdo_write(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex, const void *data,
                            size_t size, cm1e_diag_t *diag)
{
    uint8_t copy[8] = {0};
    memcpy(copy, data, size < sizeof copy ? size : sizeof copy);
    cm1e_sdo_t sdo = {.position = position, .index = index, .subindex = subindex, .write = true, .data = copy,
                      .size = size};
    bus = fake_slave(bus, position);
    bus->sdo = &sdo;
    bus->sdo_wait = 0;
    fake_serve_sdo(bus);
    if (sdo.state != CM1E_SDO_DONE)
        return cm1e_diag_set(diag, sdo.error, sdo.abort_code, "write refused");
    bus->mode = bus->sdo_mode;
    return CM1E_OK;
}
cm1e_error_t cm1e_sdo_read(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex, void *data,
                           size_t *size, cm1e_diag_t *diag)
{
    cm1e_sdo_t sdo = {.position = position, .index = index, .subindex = subindex, .data = data, .size = *size};
    bus = fake_slave(bus, position);
    bus->sdo = &sdo;
    bus->sdo_wait = 0;
    fake_serve_sdo(bus);
    if (sdo.state != CM1E_SDO_DONE)
        return cm1e_diag_set(diag, sdo.error, sdo.abort_code, "read refused");
    *size = sdo.size;
    return CM1E_OK;
}

/* Signals of other slaves: the fake bus has none. */
cm1e_error_t cm1e_io_find(cm1e_bus_t *bus, const char *name, cm1e_io_t *io, cm1e_diag_t *diag)
{
    (void)bus;
    *io = (cm1e_io_t){0};
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "\"%s\" names no slave.", name);
}
cm1e_io_quality_t cm1e_io_quality(const cm1e_io_t *io) { return io->bus ? CM1E_IO_GOOD : CM1E_IO_INVALID; }
bool cm1e_io_bool(const cm1e_io_t *io) { return cm1e_io_integer(io) != 0; }
int64_t cm1e_io_integer(const cm1e_io_t *io) { return io->shift; }
cm1e_error_t cm1e_io_set_bool(const cm1e_io_t *io, bool value)
{
    (void)value;
    return io->bus ? CM1E_OK : CM1E_ERROR_STATE;
}
