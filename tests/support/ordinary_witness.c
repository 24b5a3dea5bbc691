#include "ordinary_witness.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "axis/axis_extras.h"
#include "axis/axis_guard.h"
#include "axis/axis_lead.h"
#include "axis/axis_plan.h"
#include "axis/axis_setpoint.h"
#include "bus/bus_image.h"
#include "coupling/coupling_private.h"
#include "group/group_private.h"

enum { OUTPUTS_MOST = 64 };

unsigned long long cycles_advanced, cycles_ordinary, inputs_seen, inputs_ordinary;
unsigned long long cycles_followed, cycles_followed_ordinary, cycles_led, cycles_led_ordinary, cycles_led_short;

#ifdef __SANITIZE_ADDRESS__ /* it looks at each byte that is copied */
unsigned axes_compared_every = 7;
#else
unsigned axes_compared_every = 1;
#endif
unsigned followers_compared_every = 23, led_compared_every = 23;

/* The axis that takes the long way. */
static struct cm1e_axis copy;

/* What is called for an axis, one in axes_compared_every. */
static bool is_compared(void)
{
    static unsigned long long calls;
    return calls++ % axes_compared_every == 0;
}

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
    must(axis_has_extra(axis, EXTRA_DISTURBED) == (!axis_acts(axis) || cm1e_axis_held(axis) || cm1e_axis_was_silent(axis)),
         "EXTRA_DISTURBED", 0);
}

/* Only the short ways use these, and only the long ways renew some of them. Bytes between members may differ where a
 * struct was copied as a whole. */
static void set_aside(cm1e_axis_t *axis)
{
    axis->setpoint.ordinary_until_s = 0.0;
    axis->setpoint.course = 0;
    axis->guarding.kept_course = axis->guarding.own_course = axis->guarding.leaders_course = 0;
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

/* Without bytes between members. */
static own_probes_t probes_of(const own_probes_t *probes)
{
    enum { USED = offsetof(probe_sample_t, inputs) + sizeof probes->last.inputs };
    own_probes_t p;
    memcpy(&p, probes, sizeof p);
    memset((char *)&p.last + USED, 0, sizeof(probe_sample_t) - USED);
    return p;
}

/* The probes of the motor are beside the axis, so the long way gets them as they were before. */
static void compare_inputs(cm1e_axis_t *axis, own_probes_t *probes, cm1e_error_t received, cm1e_error_t health,
                           int64_t now_ns)
{
    copy.signals.own = probes;
    cm1e_axis_inputs_any(&copy, received, health, now_ns);
    const own_probes_t brief = probes_of(axis->signals.own), full = probes_of(probes);
    must(memcmp(&brief, &full, sizeof full) == 0, "the probes of the short way and of the long way differ", 0);
    copy.signals.own = axis->signals.own;
    compare(axis);
}

void ordinary_inputs(cm1e_axis_t *axis, cm1e_error_t received, cm1e_error_t health, int64_t now_ns)
{
    static own_probes_t probes;
    if (!is_compared()) {
        cm1e_axis_inputs(axis, received, health, now_ns);
        return;
    }
    memcpy(&copy, axis, sizeof copy);
    memcpy(&probes, axis->signals.own, sizeof probes);
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
    compare_inputs(axis, &probes, received, health, now_ns);
}

/* A copy without bytes between members, and without what only the short way uses. */
static coupling_t coupling_of(const coupling_t *coupling)
{
    coupling_t c;
    memcpy(&c, coupling, sizeof c);
    c.ordinary = false;
    c.course = c.masters_course = 0;
    for (int i = 0; i < FOLLOWS * LINKS; i++) {
        master_view_t *seen = &c.follows[i / LINKS].links[i % LINKS].seen;
        memset((char *)seen + offsetof(master_view_t, jumps) + sizeof seen->jumps, 0,
               sizeof *seen - offsetof(master_view_t, jumps) - sizeof seen->jumps);
    }
    return c;
}

/* The coupling is beside the axis, so the long way gets it as it was before. */
static void advance_follower(cm1e_axis_t *axis)
{
    static coupling_t before, brief, full;
    if (cycles_followed++ % followers_compared_every != 0) {
        cm1e_axis_advance(axis);
        return;
    }
    memcpy(&copy, axis, sizeof copy);
    memcpy(&before, axis->coupling, sizeof before);
    if (!cm1e_axis_led_ordinary_step(axis)) {
        cm1e_axis_advance(axis);
        return;
    }
    cycles_followed_ordinary++;
    axis->advanced = true;
    memcpy(&brief, axis->coupling, sizeof brief);
    memcpy(axis->coupling, &before, sizeof before);
    cm1e_axis_advance_any(&copy);
    compare(axis);
    full = coupling_of(axis->coupling);
    memcpy(axis->coupling, &brief, sizeof brief);
    brief = coupling_of(&brief);
    must(memcmp(&full, &brief, sizeof full) == 0, "the couplings of the short way and of the long way differ", 0);
}

static bool is_decided(const cm1e_axis_t *axis)
{
    return axis_led(axis) && cm1e_axis_guard_kept(axis, axis->leader->course);
}

/* The group is beside the axis, so the long way gets it as it was before. */
static void compare_led(cm1e_axis_t *axis)
{
    static cm1e_group_t before, brief;
    cm1e_group_t *group = axis->leader->context;
    memcpy(&before, group, sizeof before);
    if (!cm1e_axis_led_ordinary_step(axis)) {
        cm1e_axis_advance(axis);
        return;
    }
    cycles_led_short++;
    axis->advanced = true;
    memcpy(&brief, group, sizeof brief);
    memcpy(group, &before, sizeof before);
    cm1e_axis_advance_any(&copy);
    compare(axis);
    must(memcmp(group, &brief, sizeof brief) == 0, "the groups of the short way and of the long way differ", 0);
    memcpy(group, &brief, sizeof brief);
}

/* A set-point that the guard was not asked for, because it was decided ahead, is one that it lets pass. */
static void advance_led(cm1e_axis_t *axis)
{
    static struct cm1e_axis at_first;
    memcpy(&copy, axis, sizeof copy);
    memcpy(&at_first, axis, sizeof at_first);
    if (cycles_led++ % led_compared_every == 0 && axis->leader->ordinary) /* a group: other leaders have no short way */
        compare_led(axis);
    else
        cm1e_axis_advance(axis);
    if (!is_decided(axis) || at_first.setpoint.course != axis->setpoint.course)
        return;
    cycles_led_ordinary++;
    const from_t point = from_set(axis);
    must(!cm1e_axis_guard(&at_first, &point, true).limit, "a set-point of a leader was decided ahead and breaks a limit", 0);
}

static void advance(cm1e_axis_t *axis)
{
    if (axis_follows(axis)) {
        advance_follower(axis);
        return;
    }
    if (axis_led(axis)) {
        advance_led(axis);
        return;
    }
    if (!is_compared()) {
        cm1e_axis_advance(axis);
        return;
    }
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
    if (axis->drive.ordinary.calm && !axis->setpoint.source->write && is_compared())
        write_both(axis);
    else
        cm1e_axis_outputs(axis);
}
