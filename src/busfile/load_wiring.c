/* The inputs of switches, and the signals on other slaves, of an axis in a bus file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "busfile/busfile.h"

/* The number of a signal on another slave, which the list gets if it has not got it; 0: the list is full. */
static uint8_t number_of(cm1e_wiring_config_t *wiring, const char *name)
{
    for (unsigned i = 0; i < wiring->input_count; i++)
        if (strcasecmp(wiring->inputs[i], name) == 0)
            return (uint8_t)(CM1E_WIRED_FIRST + i);
    if (wiring->input_count == CM1E_WIRED_SIGNALS)
        return 0;
    snprintf(wiring->inputs[wiring->input_count], CM1E_SIGNAL_LENGTH, "%s", name);
    return (uint8_t)(CM1E_WIRED_FIRST + wiring->input_count++);
}

/* "3" is an input of the motor, "switches.home" a signal. */
static bool convert_switch(uint8_t *input, const char *text, const char *key, cm1e_wiring_config_t *wiring,
                           uint32_t index, cm1e_config_problem_t *problem)
{
    const bool by_number = text[strspn(text, "0123456789")] == '\0';
    const unsigned long number = by_number ? strtoul(text, NULL, 10) : 0;
    if (text[0] == '\0')
        return true;
    *input = (uint8_t)number;
    if (!by_number && strchr(text, '.'))
        *input = number_of(wiring, text);
    else if (number > 4)
        *input = 0;
    if (*input != 0)
        return true;
    const bool full = !by_number && strchr(text, '.');
    snprintf(problem->path, sizeof problem->path, "axes[%u].inputs.%s", index, key);
    snprintf(problem->text, sizeof problem->text, "%s is '%s'; expected %s", key, text,
             full ? "fewer signals: an axis has at most eight" : "1 ... 4, or a signal of a slave as in switches.home");
    return false;
}

bool cm1e_busfile_convert_wiring(cm1e_axis_config_t *axis, const cm1e_busfile_axis_t *from, uint32_t index,
                                 cm1e_config_problem_t *problem)
{
    cm1e_wiring_config_t *wiring = &axis->wiring;
    const struct {
        const char *key, *text;
        uint8_t *input;
    } switches[] = {{"limit_positive", from->limit_positive, &axis->inputs.limit_positive},
                    {"limit_negative", from->limit_negative, &axis->inputs.limit_negative},
                    {"home", from->home, &axis->inputs.home}};
    wiring->input_count = (uint8_t)from->input_count;
    wiring->output_count = (uint8_t)from->output_count;
    memcpy(wiring->inputs, from->input_signals, sizeof wiring->inputs);
    memcpy(wiring->outputs, from->output_signals, sizeof wiring->outputs);
    for (int i = 0; i < 3; i++)
        if (!convert_switch(switches[i].input, switches[i].text, switches[i].key, wiring, index, problem))
            return false;
    return true;
}
