#include "ordinary_witness.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "axis/axis_extras.h"
#include "axis/axis_setpoint.h"

unsigned long long cycles_advanced, cycles_ordinary;

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

static void compare(cm1e_axis_t *brief, const cm1e_axis_t *full)
{
    const unsigned char *a = (const unsigned char *)brief, *b = (const unsigned char *)full;
    const double until_s = brief->setpoint.ordinary_until_s;
    brief->setpoint.ordinary_until_s = full->setpoint.ordinary_until_s; /* only the short way writes it */
    for (size_t i = 0; memcmp(a, b, sizeof *brief) != 0 && i < sizeof *brief; i++)
        must(a[i] == b[i], "the short way and the long way differ", i);
    brief->setpoint.ordinary_until_s = until_s;
}

void ordinary_outputs(cm1e_axis_t *axis)
{
    static struct cm1e_axis copy;
    judge_extras(axis);
    if (!axis->advanced && axis->setpoint.source == &cm1e_source_profile) {
        memcpy(&copy, axis, sizeof copy);
        cycles_advanced++;
        if (cm1e_axis_ordinary_step(axis)) {
            cycles_ordinary++;
            axis->advanced = true;
            cm1e_axis_advance_any(&copy);
            compare(axis, &copy);
        }
    }
    cm1e_axis_outputs(axis);
}
