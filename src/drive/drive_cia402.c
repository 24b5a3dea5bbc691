/* A servo drive of another maker (ETG.6010): the objects that are written at start-up, and its touch probes (0x60B8 ...
 * 0x60BD). */
#include "device/cia402_drive.h"

#include "core/bytes.h"
#include "drive/drive_kind.h"
#include "drive/drive_private.h"

/* ---- start-up ---------------------------------------------------------------------------------------------------- */

enum { TOLD = 3 /* objects */ };

/* The cycle time as value * 10^index seconds in 8 bits: 1, 2, 5 or 25, in the largest unit that has it whole. */
static uint32_t cycle_time_value(const cm1e_drive_t *drive, bool index)
{
    const int64_t value = cm1e_bus_configuration(drive->bus)->cycle_time_ns;
    int64_t unit = 1000000;
    int8_t exponent = -3;
    for (; value % unit != 0; unit /= 10)
        exponent--;
    return index ? (uint8_t)exponent : (uint32_t)(value / unit);
}

/* What the drive is told before it moves: object number `n`. */
static cm1e_sdo_t told(const cm1e_drive_t *drive, unsigned n, uint8_t data[4])
{
    static const struct {
        uint16_t index;
        uint8_t subindex, bytes;
    } objects[TOLD] = {{OBJ_60C2_INTERPOLATION_TIME, 2, 1}, {OBJ_60C2_INTERPOLATION_TIME, 1, 1},
                       {OBJ_60FE_DIGITAL_OUTPUTS, 2, 4}};
    const uint32_t value = n < 2 ? cycle_time_value(drive, n == 0) : CM1E_CIA402_OUTPUTS << CM1E_CIA402_OUTPUT_SHIFT;
    cm1e_put_uint(data, objects[n].bytes, value);
    return (cm1e_sdo_t){.position = drive->position, .index = objects[n].index, .subindex = objects[n].subindex,
                        .write = true, .data = data, .size = objects[n].bytes};
}

/* A drive that does not have the object has no use for the value: its refusal is no error. */
cm1e_error_t cm1e_drive_init_cia402(cm1e_drive_t *drive, cm1e_diag_t *diag)
{
    cm1e_diag_t refusal;
    drive->foreign = calloc(1, sizeof *drive->foreign);
    if (!drive->foreign)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for axis \"%s\".", drive->config->name);
    drive->range.velocity_most = (int32_t)cm1e_unit_peak_velocity(drive->config);
    for (unsigned n = 0; n < TOLD && !cm1e_drive_is_absent(drive); n++) {
        const cm1e_sdo_t sdo = told(drive, n, drive->foreign->data);
        (void)cm1e_sdo_write(drive->bus, drive->position, sdo.index, sdo.subindex, sdo.data, sdo.size, &refusal);
    }
    drive->foreign->told = TOLD;
    return CM1E_OK;
}

/* It may have been switched off, and has forgotten it. One object after the other, beside the cycle. */
static void tell_again(cm1e_drive_t *drive)
{
    cm1e_drive_foreign_t *foreign = drive->foreign;
    const bool busy = cm1e_sdo_state(&foreign->sdo) == CM1E_SDO_BUSY;
    if (drive->watch.lost || drive->watch.absent)
        foreign->told = 0;
    if (busy || foreign->told == TOLD || !cm1e_drive_operational(drive) || drive->watch.al_state == CM1E_AL_NONE)
        return;
    foreign->sdo = told(drive, foreign->told, foreign->data);
    if (cm1e_sdo_submit(drive->bus, &foreign->sdo) == CM1E_OK)
        foreign->told++;
}

/* ---- touch probes ------------------------------------------------------------------------------------------------ */

enum { PROBES = 2, BITS = 8 };

static uint8_t edge(bool falling) { return falling ? 2 : 1; }

bool cm1e_drive_has_probe(const cm1e_drive_t *drive, int input, bool falling)
{
    return drive->kind->hardware_probe && input >= 1 && input <= PROBES && drive->image.out_probe.bytes &&
           drive->image.in_probe.bytes && drive->image.in_latched[2 * (input - 1) + falling].bytes;
}

void cm1e_drive_probe_arm(cm1e_drive_t *drive, int input, bool falling)
{
    cm1e_drive_probe_t *probe = &drive->foreign->probe[input - 1];
    probe->wanted |= edge(falling);
    probe->taken &= (uint8_t)~edge(falling);
    probe->on = false;
}

void cm1e_drive_probe_disarm(cm1e_drive_t *drive, int input, bool falling)
{
    drive->foreign->probe[input - 1].wanted &= (uint8_t)~edge(falling);
}

bool cm1e_drive_probe_taken(const cm1e_drive_t *drive, int input, bool falling, int32_t *position)
{
    const cm1e_drive_probe_t *probe = &drive->foreign->probe[input - 1];
    *position = probe->positions[falling];
    return probe->taken & edge(falling);
}

static void take_edges(cm1e_drive_t *drive, unsigned n, unsigned status)
{
    cm1e_drive_probe_t *probe = &drive->foreign->probe[n];
    const uint8_t *in = cm1e_bus_inputs(drive->bus);
    for (unsigned falling = 0; falling < 2; falling++) {
        const unsigned stored = (unsigned)CM1E_PROBE_POSITIVE_STORED << falling;
        if (!(probe->wanted & edge(falling)) || !(status & stored))
            continue;
        probe->positions[falling] = (int32_t)cm1e_get_u32(in + drive->image.in_latched[2 * n + falling].offset);
        probe->wanted &= (uint8_t)~edge(falling);
        probe->taken |= edge(falling);
    }
}

/* The enable bit goes off until the drive shows so, and on again: its rise arms the probe for one edge of each kind. */
static unsigned step(cm1e_drive_t *drive, unsigned n, unsigned status)
{
    cm1e_drive_probe_t *probe = &drive->foreign->probe[n];
    if (probe->on && status & CM1E_PROBE_ENABLED)
        take_edges(drive, n, status);
    probe->on = probe->wanted && (probe->on || !(status & CM1E_PROBE_ENABLED));
    if (!probe->on)
        return 0;
    return CM1E_PROBE_ENABLE | (probe->wanted & 1 ? CM1E_PROBE_POSITIVE : 0u) |
           (probe->wanted & 2 ? CM1E_PROBE_NEGATIVE : 0u);
}

static void step_probes(cm1e_drive_t *drive)
{
    if (!drive->image.in_probe.bytes || !drive->feedback.fresh)
        return;
    const unsigned status = cm1e_get_u16(cm1e_bus_inputs(drive->bus) + drive->image.in_probe.offset);
    unsigned function = 0;
    for (unsigned n = 0; n < PROBES; n++)
        function |= step(drive, n, status >> BITS * n & 0xFF) << BITS * n;
    drive->foreign->probe_function = (uint16_t)function;
}

void cm1e_drive_cia402_step(cm1e_drive_t *drive)
{
    tell_again(drive);
    step_probes(drive);
}
