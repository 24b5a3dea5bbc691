#include "ordinary_witness.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "axis/axis_extras.h"
#include "axis/axis_setpoint.h"
#include "bus/bus_image.h"

enum { OUTPUTS_MOST = 64 };

unsigned long long cycles_advanced, cycles_ordinary, inputs_seen, inputs_ordinary;

/* The axis that takes the long way. */
static struct cm1e_axis copy;

static void must(bool condition, const char *what, size_t place)
{
    if (condition)
        return;
    fprintf(stderr, "%s: byte %zu of the axis (setpoint begins at %zu), cycle %llu\n", what, place,
            offsetof(struct cm1e_axis, setpoint), cycles_advanced);
    abort();
}

/* Each bit is set where there is something of its kind. EXTRA_SIGNALS may stay for a cycle longer. */
static void judge_extras(const cm1e_axis_t *axis)
{
    const bool signals = axis->commands.kept != 0 || axis->drive.command.digital_outputs != 0 || axis->drive.wiring;
    must(!signals || axis_has_extra(axis, EXTRA_SIGNALS), "EXTRA_SIGNALS", 0);
    must(axis_has_extra(axis, EXTRA_ON_TOP) == (axis->superimposed.id != 0), "EXTRA_ON_TOP", 0);
    must(axis_has_extra(axis, EXTRA_BACKLASH) == (axis->backlash.gap > 0.0), "EXTRA_BACKLASH", 0);
    must(axis_has_extra(axis, EXTRA_OBJECTS) == (axis->objects.head != axis->objects.next), "EXTRA_OBJECTS", 0);
}

/* Only the short ways use these, and only the long ways renew some of them. Bytes between members may differ where a
 * struct was copied as a whole. */
static void set_aside(cm1e_axis_t *axis)
{
    enum { USED = offsetof(probe_sample_t, inputs) + sizeof axis->signals.probe_sample.inputs };
    memset((char *)&axis->signals.probe_sample + USED, 0, sizeof(probe_sample_t) - USED);
    axis->setpoint.ordinary_until_s = 0.0;
    axis->drive.ordinary = (cm1e_drive_ordinary_t){0};
}

static void compare(const cm1e_axis_t *axis)
{
    static struct cm1e_axis brief;
    memcpy(&brief, axis, sizeof brief);
    set_aside(&brief);
    set_aside(&copy);
    const unsigned char *a = (const unsigned char *)&brief, *b = (const unsigned char *)&copy;
    for (size_t i = 0; memcmp(a, b, sizeof brief) != 0 && i < sizeof brief; i++)
        must(a[i] == b[i], "the short way and the long way differ", i);
}

void ordinary_inputs(cm1e_axis_t *axis, cm1e_error_t received, cm1e_error_t health, int64_t now_ns)
{
    memcpy(&copy, axis, sizeof copy);
    inputs_seen++;
    if (!cm1e_axis_inputs_ordinary(axis, received, health, now_ns)) {
        cm1e_axis_inputs(axis, received, health, now_ns);
        return;
    }
    inputs_ordinary++;
    /* What is not in the axis itself would be changed twice: that of couplings, of other slaves, and of the axes that
     * an error concerns too. */
    if (axis->observed || axis->signals.wired || axis->fault.error != copy.fault.error)
        return;
    cm1e_axis_inputs_any(&copy, received, health, now_ns);
    compare(axis);
}

static void advance(cm1e_axis_t *axis)
{
    memcpy(&copy, axis, sizeof copy);
    cycles_advanced += axis->setpoint.source == &cm1e_source_profile;
    if (!cm1e_axis_ordinary_step(axis)) {
        cm1e_axis_advance(axis);
        return;
    }
    cycles_ordinary++;
    axis->advanced = true;
    cm1e_axis_advance_any(&copy);
    compare(axis);
}

/* The outputs of the drive, after those of the copy, which are the same. */
static void write_both(cm1e_axis_t *axis)
{
    const cm1e_drive_wire_t *wire = &axis->drive.wire;
    const uint8_t *out = cm1e_bus_outputs(axis->drive.bus) + wire->out;
    const size_t bytes = wire->out_velocity + 4u > wire->out_mode + 1u ? wire->out_velocity + 4u : wire->out_mode + 1u;
    uint8_t full[OUTPUTS_MOST];
    memcpy(&copy, axis, sizeof copy);
    cm1e_axis_write_set_point(&copy);
    cm1e_drive_write(&copy.drive);
    memcpy(full, out, bytes);
    cm1e_axis_outputs(axis);
    must(memcmp(full, out, bytes) == 0, "the outputs of the short way and of the long way differ", 0);
    compare(axis);
}

void ordinary_outputs(cm1e_axis_t *axis)
{
    judge_extras(axis);
    if (!axis->advanced)
        advance(axis);
    if (axis->drive.ordinary.calm && !axis->setpoint.source->write)
        write_both(axis);
    else
        cm1e_axis_outputs(axis);
}
