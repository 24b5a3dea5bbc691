/* How the axes of the configuration use a signal of another slave. */
#include <stdio.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "bus/io_guest.h"
#include "config/switches.h"

/** What is told of one axis: "feed: input 11, home switch". */
typedef struct use_text {
    char *text;
    size_t size, used;
} use_text_t;

static void say(use_text_t *use, const char *format, const char *word, int number)
{
    if (use->used >= use->size)
        return;
    const int length = snprintf(use->text + use->used, use->size - use->used, format, word, number);
    use->used += length > 0 ? (size_t)length : 0;
}

static bool is_signal(cm1e_bus_t *bus, const char *name, const cm1e_io_info_t *info)
{
    cm1e_io_t named, listed;
    if (cm1e_io_guest_find(bus, name, &named, NULL) != CM1E_OK ||
        cm1e_io_guest_take(bus, info, &listed, NULL) != CM1E_OK || named.output != listed.output)
        return false;
    const uint32_t first = named.byte * 8 + named.shift, listed_first = listed.byte * 8 + listed.shift;
    return first < listed_first + listed.bits && listed_first < first + named.bits;
}

static void say_switches(use_text_t *use, const cm1e_input_config_t *inputs, int number)
{
    cm1e_switch_t switches[CM1E_SWITCHES];
    cm1e_switches_of(inputs, switches);
    for (int i = 0; i < CM1E_SWITCHES; i++)
        if (switches[i].input == number)
            say(use, switches[i].closed ? ", %s (normally closed)" : ", %s", switches[i].name, 0);
}

static void say_axis(cm1e_bus_t *bus, const cm1e_axis_config_t *axis, const cm1e_io_info_t *info, use_text_t *use)
{
    const cm1e_wiring_config_t *wiring = &axis->wiring;
    const char *begin = use->used ? "; %s: " : "%s: ";
    for (int i = 0; i < wiring->input_count && !info->output; i++) {
        if (!is_signal(bus, wiring->inputs[i], info))
            continue;
        say(use, begin, axis->name, 0);
        say(use, "%sinput %d", "", CM1E_WIRED_FIRST + i);
        say_switches(use, &axis->inputs, CM1E_WIRED_FIRST + i);
        begin = "; %s: ";
    }
    for (int i = 0; i < wiring->output_count && info->output; i++) {
        if (!is_signal(bus, wiring->outputs[i], info))
            continue;
        say(use, begin, axis->name, 0);
        say(use, "%soutput %d", "", CM1E_WIRED_FIRST + i);
        begin = "; %s: ";
    }
    if (!info->output && wiring->encoder[0] && is_signal(bus, wiring->encoder, info))
        say(use, use->used ? "; %s: encoder" : "%s: encoder", axis->name, 0);
}

bool cm1e_io_use(cm1e_bus_t *bus, const cm1e_io_info_t *info, char *text, size_t size)
{
    use_text_t use = {.text = text, .size = size};
    if (!text)
        use.size = size = 0;
    if (size)
        text[0] = '\0';
    for (uint32_t i = 0; bus && info && i < bus->config.axis_count; i++)
        say_axis(bus, &bus->config.axes[i], info, &use);
    return use.used > 0;
}
