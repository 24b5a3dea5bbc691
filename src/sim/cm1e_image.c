#include <stdlib.h>

#include "core/bytes.h"
#include "sim/cm1e_app.h"

/* ---- assignment ------------------------------------------------------------------------------------------------- */

static uint8_t sign_shift(const cm1e_pdo_entry_t *entry)
{
    return cm1e_sim_is_signed(cm1e_device_entry(entry->index, entry->subindex)->type) ? (uint8_t)(32 - entry->bits) : 0;
}

/* Resolves the objects of a mapping once, so that the cycle need not search. */
static void resolve(const cm1e_sim_cm1e_t *drive, cm1e_sim_image_t *image, bool transmit)
{
    cm1e_pdo_t pdo = {0};
    if (image->assigned)
        cm1e_device_pdo(&pdo, (cm1e_mapping_t)(image->pdo & 0xF), transmit, drive->order, drive->firmware->firmware);
    image->slot_count = pdo.entry_count;
    image->bytes = 0;
    for (uint8_t i = 0; i < pdo.entry_count; i++) {
        const cm1e_pdo_entry_t *entry = &pdo.entries[i];
        image->slots[i] = (cm1e_sim_slot_t){
            .object = (uint8_t)cm1e_sim_object_place(entry->index, entry->subindex),
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
    resolve(drive, &drive->outputs, false);
    resolve(drive, &drive->inputs, true);
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
    resolve(drive, image, transmit);
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

static void detect_cycle_time(cm1e_sim_cm1e_t *drive, int64_t now_ns)
{
    const int64_t interval_ns = now_ns - drive->last_outputs_ns;
    drive->last_outputs_ns = now_ns;
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
    default: return (int32_t)cm1e_get_u32(data);
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
        default: cm1e_put_u32(data, value); break;
        }
        data += slot->bytes;
    }
}
