/*
 * An analog terminal whose inputs are wired to its outputs: the program writes other numbers in every cycle, and reads
 * those of the cycles before.
 */
#include "cm1e/io.h"
#include "scenario_private.h"

enum { CHANNELS = 8, INPUTS = 0x6000, OUTPUTS = 0x7000, STEP = 0x10, OLDEST = 3 /* cycles; the number goes out with one frame and comes back with a later one */, CALM = 12 };

static struct terminal {
    cm1e_io_t in[CHANNELS], out[CHANNELS];
    int calm; /**< cycles in a row in which it took part, and all frames came */
} terminal;

/** Not the same one for thousands of cycles, and within what such a terminal converts. */
static int number_of(int cycle, int channel) { return (cycle * 7 + channel * 4001) % 60001 - 30000; }

static void find(run_t *run, int channels)
{
    terminal.calm = 0;
    for (int i = 0; i < 2 * channels; i++) {
        const bool output = i % 2;
        char name[32];
        snprintf(name, sizeof name, "io0%.0f.0x%X:11", run->scenario->io, (output ? OUTPUTS : INPUTS) + i / 2 * STEP);
        if (cm1e_io_find(run->buses[0], name, output ? &terminal.out[i / 2] : &terminal.in[i / 2], NULL) != CM1E_OK)
            scenario_fail(run, "analog", "there is no %s", name);
    }
}

static bool is_good(const cm1e_io_t *io) { return cm1e_io_quality(io) == CM1E_IO_GOOD; }

static void judge_input(run_t *run, int channel)
{
    const int64_t value = cm1e_io_integer(&terminal.in[channel]);
    bool known = false;
    for (int age = 1; age <= OLDEST; age++)
        known = known || value == number_of(run->cycle - age, channel);
    if (!known)
        scenario_fail(run, "analog", "input %d is %lld; written was %d in the cycle before", channel + 1, (long long)value,
                      number_of(run->cycle - 1, channel));
}

void analog_cycle(run_t *run)
{
    const int channels = (int)run->scenario->analog;
    if (channels == 0)
        return;
    if (run->cycle == 0)
        find(run, channels);
    const bool late = run->axes[0].seen.stalled == 0;
    /* That it has left Operational is seen when it is asked, as one slave of its network is in every cycle. */
    const int calm = CALM + (int)cm1e_bus_slave_count(run->buses[0]);
    const bool works = is_good(&terminal.in[0]) && is_good(&terminal.out[0]);
    terminal.calm = works && run->bad[0] == 0 && !late ? terminal.calm + 1 : 0;
    for (int i = 0; i < channels && !run->outcome->failed; i++) {
        if (terminal.calm > calm)
            judge_input(run, i);
        if (cm1e_io_set_integer(&terminal.out[i], number_of(run->cycle, i)) != CM1E_OK)
            scenario_fail(run, "analog", "output %d cannot be written", i + 1);
    }
}
