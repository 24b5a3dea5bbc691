/* The process data of one drive: where the objects lie, and their coding on the wire. */
#include <stdlib.h>

#include "core/bytes.h"
#include "core/rare.h"
#include "drive/drive_private.h"

#define SLOT(member) offsetof(cm1e_drive_image_t, member)
static const size_t slots[CM1E_ROLE_COUNT] = {
    [CM1E_OUT_CONTROLWORD] = SLOT(out_controlword),
    [CM1E_OUT_POSITION] = SLOT(out_position),
    [CM1E_OUT_VELOCITY] = SLOT(out_velocity),
    [CM1E_OUT_MODE] = SLOT(out_mode),
    [CM1E_OUT_DIGITAL] = SLOT(out_digital),
    [CM1E_OUT_PROFILE_VELOCITY] = SLOT(out_profile_velocity),
    [CM1E_OUT_PROFILE_ACCELERATION] = SLOT(out_profile_acceleration),
    [CM1E_IN_STATUSWORD] = SLOT(in_statusword),
    [CM1E_IN_ERROR] = SLOT(in_error),
    [CM1E_IN_POSITION] = SLOT(in_position),
    [CM1E_IN_VELOCITY] = SLOT(in_velocity),
    [CM1E_IN_TORQUE] = SLOT(in_torque),
    [CM1E_IN_DIGITAL] = SLOT(in_digital),
    [CM1E_IN_TEMPERATURE] = SLOT(in_temperature),
    [CM1E_IN_DC_LINK] = SLOT(in_dc),
    [CM1E_IN_MODE] = SLOT(in_mode),
    [CM1E_OUT_PROBE] = SLOT(out_probe),
    [CM1E_IN_PROBE] = SLOT(in_probe),
    [CM1E_IN_PROBE_1_RISING] = SLOT(in_latched[0]),
    [CM1E_IN_PROBE_1_FALLING] = SLOT(in_latched[1]),
    [CM1E_IN_PROBE_2_RISING] = SLOT(in_latched[2]),
    [CM1E_IN_PROBE_2_FALLING] = SLOT(in_latched[3]),
};

static cm1e_image_slot_t *slot_of(cm1e_drive_t *drive, const cm1e_device_object_t *object)
{
    return (cm1e_image_slot_t *)(void *)((char *)&drive->image + slots[object->role]);
}

const cm1e_image_slot_t *cm1e_drive_slot(const cm1e_drive_t *drive, cm1e_role_t role)
{
    return (const cm1e_image_slot_t *)(const void *)((const char *)&drive->image + slots[role]);
}

static const char *mapping_name(const cm1e_drive_t *drive)
{
    return drive->kind->mappings[drive->config->mapping].name;
}

static cm1e_error_t resolve_object(cm1e_drive_t *drive, const cm1e_device_object_t *object, cm1e_diag_t *diag)
{
    cm1e_image_slot_t *slot = slot_of(drive, object);
    const uint16_t index = cm1e_drive_index(drive, object->index);
    *slot = object->role < CM1E_FIRST_INPUT
                ? cm1e_bus_find_output(drive->bus, drive->position, index, object->subindex)
                : cm1e_bus_find_input(drive->bus, drive->position, index, object->subindex);
    if (slot->bytes == 0) {
        if (!(object->needed_in & 1 << drive->config->mapping))
            return CM1E_OK;
        return cm1e_diag_set(diag, CM1E_ERROR_PDO_MAPPING, index,
                             "Axis \"%s\" (slave %u): the mapping %s that was read from the device lacks object "
                             "0x%04X, %s, which this mapping needs. Choose another mapping or check the firmware.",
                             drive->config->name, drive->position, mapping_name(drive), index, object->name);
    }
    if (slot->bytes < object->least_bytes || slot->bytes > object->most_bytes)
        return cm1e_diag_set(diag, CM1E_ERROR_PDO_MAPPING, index,
                             "Axis \"%s\" (slave %u): the mapping %s has object 0x%04X, %s, with %u bytes; %u ... %u "
                             "are understood. Is this a %s?",
                             drive->config->name, drive->position, mapping_name(drive), index, object->name,
                             slot->bytes, object->least_bytes, object->most_bytes, drive->kind->name);
    return CM1E_OK;
}

/* 0x6081 and 0x6083 are zero in the image until they are written. The limits of the configuration are the initial
 * values. */
static void profile_objects(cm1e_drive_t *drive)
{
    const cm1e_axis_config_t *config = drive->config;
    const double counts_per_unit = cm1e_unit_scale(config);
    const double peak = cm1e_unit_peak_velocity(config);
    double velocity = config->max_velocity * counts_per_unit;
    if (!(velocity > 0) || velocity > peak)
        velocity = peak;
    double kilo = config->max_acceleration > 0 ? config->max_acceleration * counts_per_unit / 1000.0 : 5000.0;
    if (kilo < 1.0)
        kilo = 1.0;
    if (kilo > 32767.0)
        kilo = 32767.0; /* UG 6.2.2: kept as 1 ... 32767 kpulses/s2 */
    drive->image.profile_velocity = (uint32_t)velocity;
    drive->image.profile_acceleration = (uint32_t)kilo * (config->acceleration_in_kpulses ? 1u : 1000u);
}

/* Offset of an object from another one. false: it is not mapped with this size near that one. */
static bool near(cm1e_image_slot_t slot, cm1e_image_slot_t base, unsigned bytes, uint8_t *offset)
{
    *offset = (uint8_t)(slot.offset - base.offset);
    return slot.bytes == bytes && slot.offset >= base.offset && slot.offset - base.offset <= UINT8_MAX;
}

static void find_wire(cm1e_drive_t *drive)
{
    const cm1e_drive_image_t *i = &drive->image;
    cm1e_drive_wire_t w = {.in = i->in_statusword.offset, .out = i->out_controlword.offset};
    const cm1e_image_slot_t in = i->in_statusword, out = i->out_controlword;
    const bool inputs = near(i->in_error, in, 2, &w.in_error) && near(i->in_position, in, 4, &w.in_position) &&
                        near(i->in_velocity, in, 4, &w.in_velocity) && near(i->in_torque, in, 2, &w.in_torque) &&
                        near(i->in_digital, in, 2, &w.in_digital) && near(i->in_dc, in, 2, &w.in_dc) &&
                        near(i->in_temperature, in, 2, &w.in_temperature) && near(i->in_mode, in, 1, &w.in_mode);
    const bool outputs = near(i->out_digital, out, 2, &w.out_digital) && near(i->out_mode, out, 1, &w.out_mode) &&
                         near(i->out_position, out, 4, &w.out_position) &&
                         near(i->out_velocity, out, 4, &w.out_velocity);
    const bool more = i->out_probe.bytes || i->out_profile_velocity.bytes || i->out_profile_acceleration.bytes;
    w.known = inputs && outputs && !more && in.bytes == 2 && out.bytes == 2;
    drive->wire = w;
}

cm1e_error_t cm1e_drive_resolve(cm1e_drive_t *drive, cm1e_diag_t *diag)
{
    if ((unsigned)drive->config->mapping > CM1E_MAPPING_PROFILE || !mapping_name(drive))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "Axis \"%s\": there is no PDO mapping number %d of a %s.", drive->config->name,
                             (int)drive->config->mapping, drive->kind->name);
    for (size_t i = 0; i < drive->kind->object_count; i++) {
        const cm1e_error_t error = resolve_object(drive, &drive->kind->objects[i], diag);
        if (error != CM1E_OK)
            return error;
    }
    /* One object without the other gives a switch that cannot be confirmed, or one that the process data undo. */
    if ((drive->image.out_mode.bytes == 0) != (drive->image.in_mode.bytes == 0)) {
        const bool out = drive->image.out_mode.bytes == 0;
        return cm1e_diag_set(diag, CM1E_ERROR_PDO_MAPPING,
                             out ? OBJ_6060_MODES_OF_OPERATION : OBJ_6061_MODES_OF_OPERATION_DISPLAY,
                             "Axis \"%s\" (slave %u): the mapping %s has object 0x%04X but not 0x%04X: a mode of "
                             "operation could not be switched safely.",
                             drive->config->name, drive->position, mapping_name(drive),
                             out ? 0x6061 : 0x6060, out ? 0x6060 : 0x6061);
    }
    profile_objects(drive);
    find_wire(drive);
    drive->actual = (cm1e_drive_actual_t){0};
    drive->feedback.digital_known = drive->image.in_digital.bytes > 0;
    return CM1E_OK;
}

bool cm1e_drive_carry(cm1e_drive_t *drive, uint16_t index, uint32_t raw)
{
    cm1e_drive_image_t *image = &drive->image;
    if (index == OBJ_6081_PROFILE_VELOCITY && image->out_profile_velocity.bytes)
        image->profile_velocity = raw;
    else if (index == OBJ_6083_PROFILE_ACCELERATION && image->out_profile_acceleration.bytes)
        image->profile_acceleration = raw;
    else
        return false;
    return true;
}

/* This runs for every axis in every cycle. Objects with one possible size are read without a test of the size. Only
 * objects whose size the manual leaves open are read by their size. */
static uint16_t get_u16(const uint8_t *image, cm1e_image_slot_t slot)
{
    return slot.bytes ? cm1e_get_u16(image + slot.offset) : 0;
}

static int32_t get_i32(const uint8_t *image, cm1e_image_slot_t slot)
{
    return slot.bytes ? (int32_t)cm1e_get_u32(image + slot.offset) : 0;
}

CM1E_RARE static int32_t get_odd(const uint8_t *image, cm1e_image_slot_t slot)
{
    const uint32_t raw = (uint32_t)cm1e_get_uint(image + slot.offset, slot.bytes);
    const uint32_t sign = UINT32_C(1) << (8u * slot.bytes - 1);
    return (int32_t)(raw ^ sign) - (int32_t)sign;
}

static inline int32_t get_signed(const uint8_t *image, cm1e_image_slot_t slot)
{
    if (slot.bytes == 0)
        return 0;
    if (slot.bytes == 2)
        return (int16_t)cm1e_get_u16(image + slot.offset);
    return slot.bytes == 4 ? get_i32(image, slot) : get_odd(image, slot);
}

static int16_t get_i16(const uint8_t *image, cm1e_image_slot_t slot)
{
    const int32_t value = get_signed(image, slot);
    return (int16_t)(value > INT16_MAX ? INT16_MAX : value < INT16_MIN ? INT16_MIN : value);
}

static void put_u32(uint8_t *image, cm1e_image_slot_t slot, uint32_t value)
{
    if (slot.bytes)
        cm1e_put_u32(image + slot.offset, value);
}

static void put_by_size(uint8_t *image, cm1e_image_slot_t slot, uint32_t value)
{
    if (slot.bytes == 2)
        cm1e_put_u16(image + slot.offset, (uint16_t)value);
    else
        cm1e_put_uint(image + slot.offset, slot.bytes, value);
}

/* Frames in less time than this part of a cycle, behind a pause, are too close to each other: a count would be too
 * much. */
enum { CLOSE_PART = 4 };

/* The velocity is 0x606C, unless the mapping lacks it or the firmware shows a quarter of it (below V1.3.0 in HM and PP,
 * UG 10.1). Then it is the difference of two positions. A slave takes its position when the frame passes, so the time
 * between two of them is that between two frames: behind a pause of the cycle it is not the time of a cycle. */
static int32_t velocity_of(const cm1e_drive_t *drive, const uint8_t *in, int32_t position, int8_t mode)
{
    const bool quarter = drive->range.velocity_quarter && (mode == CM1E_MODE_HM || mode == CM1E_MODE_PP);
    if (drive->image.in_velocity.bytes && !quarter)
        return cm1e_drive_clamp((int64_t)get_i32(in, drive->image.in_velocity) * drive->range.velocity_unit);
    const int64_t elapsed_ns = cm1e_bus_sent_ns(drive->bus) - drive->actual.sent_ns;
    if (!drive->actual.seen)
        return 0;
    if (elapsed_ns <= cm1e_bus_configuration(drive->bus)->cycle_time_ns / CLOSE_PART)
        return drive->feedback.velocity;
    const int32_t step = (int32_t)((uint32_t)position - (uint32_t)drive->feedback.position);
    const int64_t velocity = (int64_t)step * INT64_C(1000000000) / elapsed_ns;
    /* A change faster than any motor is a new origin and not a motion: the end of a homing, or a counter that was
     * reset. */
    if (velocity > drive->range.velocity_believed || velocity < -drive->range.velocity_believed)
        return drive->feedback.velocity;
    return cm1e_drive_clamp(velocity);
}

/* The words of an unknown mode: no state, no torque, controlword 0000h. */
static const cm1e_device_words_t unknown_words = {0};

static void derive(cm1e_drive_t *drive)
{
    const bool same = drive->mode.words == drive->mode.wanted->words;
    drive->mode.takes_torque = same && drive->mode.wanted->torque;
    drive->mode.marked = same && drive->mode.words->mark != 0;
    drive->mode.holds = drive->mode.shown && drive->mode.shown->holds_position;
    /* While a switch over SDO is under way, either mode may act. A target that stands still is right in both. */
    drive->mode.may_hold = drive->mode.holds || drive->feedback.mode == CM1E_MODE_NONE;
}

void cm1e_drive_want_mode(cm1e_drive_t *drive, const cm1e_device_mode_t *row)
{
    drive->mode.commanded = (cm1e_mode_t)row->mode;
    drive->mode.wanted = row;
    if (!drive->mode.words)
        drive->mode.words = row->words;
    derive(drive);
}

/* Until a mode is shown, the words of the last mode apply. If the old or the new words have another coding, none apply:
 * 0007h in CMD would be Switch on in csp. */
static void take_mode(cm1e_drive_t *drive, int8_t mode)
{
    drive->feedback.mode = mode;
    drive->mode.shown = cm1e_device_mode(drive->kind, mode);
    if (drive->mode.shown)
        drive->mode.words = drive->mode.shown->words;
    else if (drive->mode.words != drive->mode.wanted->words || drive->mode.words->own_coding)
        drive->mode.words = &unknown_words;
    derive(drive);
}

static void take_statusword(cm1e_drive_t *drive, uint16_t statusword)
{
    cm1e_drive_feedback_t *f = &drive->feedback;
    const cm1e_device_words_t *words = drive->mode.words;
    f->statusword = statusword;
    f->state = words->states ? cm1e_fsa_decode_by(words->states, statusword) : CM1E_FSA_UNKNOWN;
    f->voltage = !words->voltage || (statusword & words->voltage);
    f->fault = statusword & words->fault;
    f->motor_free = statusword & words->motor_free;
    drive->mode.operates = f->state == OPERATION_ENABLED && !f->motor_free;
    f->target_reached = statusword & words->target_reached;
    f->bit12 = statusword & words->bit12;
    f->bit13 = statusword & words->bit13;
}

/* The age of a position in a frame, in addition to the frame: the cycle of the drive, and the serial line to a motor
 * behind a bridge. */
static const int64_t position_age_ns = 2 * MS_IN_NS;
/* Number of good positions in a row that are required before torque, after a bad one. */
enum { POSITIONS_TO_TRUST = 3 };

/* Seconds and the rest apart, because the product of both with nanoseconds would be too large after hours. */
static int64_t way_in(int64_t counts_per_s, int64_t time_ns)
{
    return counts_per_s * (time_ns / S_IN_NS) + counts_per_s * (time_ns % S_IN_NS) / S_IN_NS;
}

int64_t cm1e_drive_farthest(const cm1e_drive_t *drive, int64_t elapsed_ns)
{
    return way_in(drive->range.velocity_possible, elapsed_ns + position_age_ns);
}

int64_t cm1e_drive_tolerance(const cm1e_drive_t *drive, int64_t elapsed_ns)
{
    return way_in(drive->range.velocity_possible, elapsed_ns) / 100;
}

/* A position too far away is no motion: it is damaged, or has another origin. Under torque only homing may set an
 * origin. */
static bool can_be_there(const cm1e_drive_t *drive, int32_t position)
{
    if (!drive->actual.seen || drive->now_ns <= drive->actual.read_ns)
        return true;
    const int64_t way = (int32_t)((uint32_t)position - (uint32_t)drive->feedback.position);
    return llabs(way) <= cm1e_drive_farthest(drive, drive->now_ns - drive->actual.read_ns);
}

/* Whether position and velocity contradict each other. Those of a turning motor agree, but for a jitter of about half a
 * cycle. */
static bool contradicts(const cm1e_drive_t *drive, int32_t position)
{
    const int64_t elapsed_ns = drive->now_ns - drive->actual.read_ns;
    const int64_t way = (int32_t)((uint32_t)position - (uint32_t)drive->feedback.position);
    return drive->actual.seen && drive->image.in_velocity.bytes > 0 &&
           cm1e_drive_ways_differ(way, way_in(drive->feedback.velocity, elapsed_ns),
                                  cm1e_drive_tolerance(drive, elapsed_ns));
}

/* A position that stays the same although the motor turns agrees with no velocity, also where the tolerance is larger
 * than the way of a slow motor. It does not end a contradiction. */
static bool stays_frozen(const cm1e_drive_t *drive, int32_t position)
{
    static const int64_t least_way = 1500000000; /* 1.5 counts, as counts/s * ns: a turning motor shows one of them */
    const int64_t elapsed_ns = drive->now_ns - drive->actual.read_ns;
    return position == drive->feedback.position && elapsed_ns > 0 &&
           llabs(drive->feedback.velocity) >= least_way / elapsed_ns;
}

/* false: the position is rejected. It becomes neither a target, nor a lag, nor a captured position. */
static bool take_position(cm1e_drive_t *drive, const uint8_t *in, int32_t position, int8_t mode)
{
    cm1e_drive_feedback_t *f = &drive->feedback;
    cm1e_drive_actual_t *actual = &drive->actual;
    const bool possible = can_be_there(drive, position);
    const bool own_targets = drive->mode.shown && drive->mode.shown->target != CM1E_NO_ROLE;
    if (!possible && drive->torque.was_enabled && own_targets) {
        if (actual->rejected < UINT8_MAX)
            actual->rejected++;
        f->fresh = false;
        return false;
    }
    actual->rejected = 0;
    actual->distrusted = (uint8_t)(possible ? actual->distrusted - (actual->distrusted > 0) : POSITIONS_TO_TRUST);
    f->velocity = velocity_of(drive, in, position, mode);
    if (!contradicts(drive, position))
        actual->contradictions = (uint8_t)(actual->contradictions -
                                           (actual->contradictions > 0 && !stays_frozen(drive, position)));
    else if (actual->contradictions < UINT8_MAX)
        actual->contradictions++;
    f->position = position;
    actual->read_ns = drive->now_ns;
    actual->sent_ns = cm1e_bus_sent_ns(drive->bus);
    actual->seen = true;
    return true;
}

void cm1e_drive_decode(cm1e_drive_t *drive)
{
    const uint8_t *in = cm1e_bus_inputs(drive->bus);
    cm1e_drive_feedback_t *f = &drive->feedback;
    const int8_t mode = drive->image.in_mode.bytes ? (int8_t)in[drive->image.in_mode.offset] : drive->change.shown;
    const uint16_t statusword = get_u16(in, drive->image.in_statusword);
    if (mode != f->mode || statusword != f->statusword || !drive->actual.seen) {
        take_mode(drive, mode);
        take_statusword(drive, statusword);
    }
    f->error_code = get_u16(in, drive->image.in_error);
    if (!take_position(drive, in, get_i32(in, drive->image.in_position), mode))
        return;
    f->torque = get_i16(in, drive->image.in_torque);
    f->digital_inputs = (uint16_t)get_signed(in, drive->image.in_digital);
    f->temperature = get_i16(in, drive->image.in_temperature);
    f->dc_link_decivolt = get_signed(in, drive->image.in_dc);
}

/* Clamps the target to the peak speed of the motor (UG 6.3). In counts/ms the bound is the whole number below. */
int32_t cm1e_drive_velocity_on_wire(const cm1e_drive_t *drive, int32_t counts_per_s)
{
    const int32_t half = counts_per_s < 0 ? -drive->range.velocity_unit / 2 : drive->range.velocity_unit / 2;
    const int64_t value = drive->range.velocity_unit == 1 ? counts_per_s
                                                    : ((int64_t)counts_per_s + half) / drive->range.velocity_unit;
    const int32_t most = drive->range.velocity_most;
    return (int32_t)(value > most ? most : value < -most ? -most : value);
}

void cm1e_drive_encode(cm1e_drive_t *drive, uint16_t controlword, int32_t position, int32_t velocity)
{
    uint8_t *out = cm1e_bus_outputs(drive->bus);
    cm1e_put_u16(out + drive->image.out_controlword.offset, controlword);
    put_u32(out, drive->image.out_position, (uint32_t)position);
    put_u32(out, drive->image.out_velocity, (uint32_t)cm1e_drive_velocity_on_wire(drive, velocity));
    if (drive->image.out_mode.bytes)
        out[drive->image.out_mode.offset] = (uint8_t)drive->mode.commanded;
    if (drive->image.out_digital.bytes)
        put_by_size(out, drive->image.out_digital,
                    (uint32_t)drive->command.digital_outputs << drive->kind->signals.output_shift);
    if (drive->image.out_probe.bytes && drive->foreign)
        cm1e_put_u16(out + drive->image.out_probe.offset, drive->foreign->probe_function);
    put_u32(out, drive->image.out_profile_velocity, drive->image.profile_velocity);
    put_u32(out, drive->image.out_profile_acceleration, drive->image.profile_acceleration);
    drive->target.position = position;
    drive->target.velocity = velocity;
}
