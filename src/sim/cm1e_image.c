#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "sim/cm1e_app.h"

/* ---- assignment ------------------------------------------------------------------------------------------------- */

static uint8_t sign_shift(const cm1e_pdo_entry_t *entry)
{
    const cm1e_entry_t *object = cm1e_device_entry(entry->index, entry->subindex);
    return object && cm1e_sim_is_signed(object->type) && entry->bits <= 32 ? (uint8_t)(32 - entry->bits) : 0;
}

/* A mapping as the dictionary shows it. */
static void read_mapping(const cm1e_sim_cm1e_t *drive, uint16_t index, cm1e_pdo_t *pdo)
{
    cm1e_sim_cell_t cell;
    *pdo = (cm1e_pdo_t){.index = index};
    const int64_t count = cm1e_sim_store_find(&drive->store, index, 0, &cell) == 0 ? *cell.value : 0;
    for (unsigned i = 1; i <= UINT8_MAX && i <= count && pdo->entry_count < CM1E_PDO_MAX_ENTRIES; i++)
        if (cm1e_sim_store_find(&drive->store, index, (uint8_t)i, &cell) == 0)
            pdo->entries[pdo->entry_count++] = (cm1e_pdo_entry_t){
                .index = (uint16_t)(*cell.value >> 16), .subindex = (uint8_t)(*cell.value >> 8),
                .bits = (uint8_t)*cell.value};
}

/* What the drive has no object for, or in another size than a number's, is a gap. */
static uint8_t place_of(const cm1e_pdo_entry_t *entry)
{
    const bool is_number = entry->bits == 8 || entry->bits == 16 || entry->bits == 32;
    const int place = is_number ? cm1e_sim_object_place(entry->index, entry->subindex) : -1;
    return (uint8_t)(place >= 0 ? (size_t)place : offsetof(cm1e_sim_objects_t, none) / sizeof(int32_t));
}

/* Resolves the objects of a mapping once, so that the cycle need not search. */
static void resolve(const cm1e_sim_cm1e_t *drive, cm1e_sim_image_t *image)
{
    cm1e_pdo_t pdo = {0};
    if (image->assigned)
        read_mapping(drive, image->pdo, &pdo);
    image->slot_count = pdo.entry_count;
    image->bytes = 0;
    for (uint8_t i = 0; i < pdo.entry_count; i++) {
        const cm1e_pdo_entry_t *entry = &pdo.entries[i];
        image->slots[i] = (cm1e_sim_slot_t){
            .object = place_of(entry),
            .bytes = entry->bits / 8,
            .sign_shift = sign_shift(entry),
        };
        image->bytes = (uint16_t)(image->bytes + entry->bits / 8);
    }
}

void cm1e_sim_assign_default(cm1e_sim_cm1e_t *drive)
{
    drive->outputs = (cm1e_sim_image_t){.pdo = 0x1600, .assigned = 1};
    drive->inputs = (cm1e_sim_image_t){.pdo = 0x1A00, .assigned = 1};
    resolve(drive, &drive->outputs);
    resolve(drive, &drive->inputs);
}

/* One of the four fixed mappings each way (UG 4.4): sub-index 0 to 0, sub-index 1, sub-index 0 to 1. */
uint32_t cm1e_sim_assign_write(cm1e_sim_cm1e_t *drive, uint16_t index, uint8_t subindex, uint32_t value)
{
    const bool transmit = index == OBJ_1C13_TXPDO_ASSIGN;
    cm1e_sim_image_t *image = transmit ? &drive->inputs : &drive->outputs;
    const uint32_t first = transmit ? 0x1A00 : 0x1600;
    if (subindex == 0) {
        if (value > 1)
            return SDO_ABORT_TOO_HIGH;
        image->assigned = (uint8_t)value;
    } else {
        if (value < first || value > first + CM1E_MAPPING_PROFILE)
            return SDO_ABORT_PDO_MAPPING;
        if (image->assigned)
            return SDO_ABORT_SUBINDEX_0_NOT_ZERO;
        image->pdo = (uint16_t)value;
    }
    resolve(drive, image);
    return 0;
}

void cm1e_sim_process_data_sizes(void *app, uint16_t *output_bytes, uint16_t *input_bytes)
{
    const cm1e_sim_cm1e_t *drive = app;
    *output_bytes = drive->outputs.bytes;
    *input_bytes = drive->inputs.bytes;
}

/* ---- cycle time (UG 4.3) ---------------------------------------------------------------------------------------- */

enum {
    /* Frames come with jitter: an interval counts for the cycle time it is nearest to, and a cycle time is believed
     * after a few intervals in a row. Bounds half-way (in ratio) between the four, and as far outside. */
    DETECTION_INTERVALS = 4,
    BOUND_200_US = 160000, BOUND_250_US = 224000, BOUND_500_US = 354000, BOUND_1000_US = 707000, BOUND_END = 1414000,
};

static uint32_t nearest_cycle_ns(const cm1e_sim_cm1e_t *drive, int64_t interval_ns)
{
    static const struct {
        int64_t from_ns;
        uint32_t cycle_ns;
    } rows[] = {{BOUND_END, 0}, {BOUND_1000_US, 1000000}, {BOUND_500_US, 500000}, {BOUND_250_US, 250000},
                {BOUND_200_US, 200000}, {INT64_MIN, 0}};
    size_t i = 0;
    while (interval_ns < rows[i].from_ns)
        i++;
    const uint32_t cycle_ns = rows[i].cycle_ns;
    return drive->firmware->all_cycle_times || cycle_ns == 1000000 ? cycle_ns : 0;
}

void cm1e_sim_period_forget(cm1e_sim_cm1e_t *drive) { drive->period = (cm1e_sim_period_t){0}; }

static void detect_cycle_time(cm1e_sim_cm1e_t *drive, int64_t now_ns)
{
    const int64_t interval_ns = now_ns - drive->period.last_ns;
    drive->period.last_ns = now_ns;
    if (drive->period.ns != 0 && interval_ns == drive->period.ns) {
        drive->period.candidate_count = 0;
        return;
    }
    const uint32_t nearest_ns = nearest_cycle_ns(drive, interval_ns);
    if (nearest_ns == drive->period.ns) {
        drive->period.candidate_count = 0;
        return;
    }
    if (nearest_ns != drive->period.candidate_ns) {
        drive->period.candidate_ns = nearest_ns;
        drive->period.candidate_count = 0;
    }
    if (++drive->period.candidate_count < DETECTION_INTERVALS)
        return;
    drive->period.candidate_count = 0;
    drive->period.ns = nearest_ns;
    drive->objects.cycle_time_us = (int32_t)(nearest_ns / 1000);
    drive->objects.output_cycle_ns = drive->objects.input_cycle_ns = (int32_t)nearest_ns;
}

/* ---- process data ----------------------------------------------------------------------------------------------- */

static int32_t get_slot(const cm1e_sim_slot_t *slot, const uint8_t *data)
{
    switch (slot->bytes) {
    case 1: return slot->sign_shift ? (int8_t)data[0] : data[0];
    case 2: return slot->sign_shift ? (int16_t)cm1e_get_u16(data) : cm1e_get_u16(data);
    case 4: return (int32_t)cm1e_get_u32(data);
    default: return 0;
    }
}

void cm1e_sim_outputs(void *app, const uint8_t *data, uint16_t size, int64_t now_ns)
{
    cm1e_sim_cm1e_t *drive = app;
    if (size < drive->outputs.bytes)
        return;
    detect_cycle_time(drive, now_ns);
    int32_t *objects = (int32_t *)&drive->objects;
    for (uint8_t i = 0; i < drive->outputs.slot_count; i++) {
        const cm1e_sim_slot_t *slot = &drive->outputs.slots[i];
        objects[slot->object] = get_slot(slot, data);
        data += slot->bytes;
    }
    cm1e_sim_fsa_outputs(drive);
}

static int32_t shown_velocity(const cm1e_sim_cm1e_t *drive)
{
    double velocity = drive->mechanics.velocity;
    const int8_t mode = (int8_t)drive->objects.mode_display;
    if (drive->firmware->velocity_quarter_in_hm_pp && (mode == CM1E_MODE_HM || mode == CM1E_MODE_PP))
        velocity /= 4; /* UG 10.1, V1.3.0: "It was 1/4 of the actual value" */
    if (drive->firmware->velocity_in_counts_per_ms)
        velocity /= 1000;
    return (int32_t)cm1e_sim_rounded(velocity);
}

void cm1e_sim_refresh(cm1e_sim_cm1e_t *drive)
{
    cm1e_sim_objects_t *objects = &drive->objects;
    objects->position = (int32_t)(uint32_t)cm1e_sim_actual_counts(drive);
    objects->velocity = shown_velocity(drive);
    objects->torque = (int32_t)cm1e_sim_rounded(drive->servo.torque * 1000 / drive->rated_torque);
    objects->digital_inputs = cm1e_sim_digital_inputs(drive);
    cm1e_sim_fsa_update_error(drive);
    objects->statusword = cm1e_sim_fsa_statusword(drive);
}

void cm1e_sim_inputs(void *app, uint8_t *data, uint16_t size)
{
    cm1e_sim_cm1e_t *drive = app;
    if (size < drive->inputs.bytes)
        return;
    cm1e_sim_refresh(drive);
    const int32_t *objects = (const int32_t *)&drive->objects;
    for (uint8_t i = 0; i < drive->inputs.slot_count; i++) {
        const cm1e_sim_slot_t *slot = &drive->inputs.slots[i];
        const uint32_t value = (uint32_t)objects[slot->object];
        switch (slot->bytes) {
        case 1: data[0] = (uint8_t)value; break;
        case 2: cm1e_put_u16(data, (uint16_t)value); break;
        case 4: cm1e_put_u32(data, value); break;
        default: memset(data, 0, slot->bytes); break;
        }
        data += slot->bytes;
    }
}
