/* The working counter of the slaves that are there. A slave that may come and go is counted while it takes part in
 * Operational. Its inputs show when it has left: a slave that takes part overwrites the marker in them. */
#include <string.h>

#include "bus/bus_internal.h"

/** A slave is asked so often before it counts as lost; a question and its answer take so many cycles more. */
enum { ASKED_TIMES = 3, ON_THE_WAY = 4 };

static int takes(const cm1e_bus_slave_t *slave) { return slave->placement.output_bytes > 0 ? 2 : 0; }
static int gives(const cm1e_bus_slave_t *slave) { return slave->placement.input_bytes > 0; }

static bool is_operational(const cm1e_bus_slave_t *slave) { return slave->watch.al_state == CM1E_AL_OP; }

void cm1e_hot_count_begin(cm1e_bus_t *bus)
{
    bus->expected_working_counter = cm1e_soem_expected_working_counter(bus->soem);
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        slave->hot.counted = !slave->hot.planned;
        slave->hot.outputs_begin = slave->placement.output_offset;
        slave->hot.inputs_begin = (uint32_t)bus->output_bytes + slave->placement.input_offset;
        if (slave->hot.planned)
            bus->expected_working_counter -= takes(slave) + gives(slave);
    }
}

/** A slave that is not counted may take part all the same: it is on its way to Operational, or was refused there. */
static bool may_take_part(const cm1e_bus_slave_t *slave)
{
    return !slave->hot.counted && !(slave->hot.planned && slave->hot.bound == 0);
}

/** What is missing in the working counter for those that are counted, as far as inputs show who else takes part. */
static int missing_of(const cm1e_bus_t *bus, int working_counter)
{
    int missing = bus->expected_working_counter - working_counter;
    for (uint32_t i = 0; i < bus->slave_count; i++)
        missing += may_take_part(&bus->slaves[i]) && gives(&bus->slaves[i]) && bus->slaves[i].silent_cycles == 0;
    return missing;
}

/** What those count together that seem to be silent. */
static int share_of_silent(const cm1e_bus_t *bus)
{
    int share = 0;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (slave->hot.counted && slave->silent_cycles > 0)
            share += takes(slave) + gives(slave);
    }
    return share;
}

static void take_out_one(cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    slave->hot.counted = false;
    slave->hot.out_since = bus->counters.cycles;
    bus->expected_working_counter -= takes(slave) + gives(slave);
    cm1e_hot_note(bus, slave);
}

/** Those whose inputs show that they have left are taken out. Without inputs nothing shows it: the supervision does. A
 *  few inputs may be like their marker by chance, so these have left only if as much is missing as all count that seem
 *  to be silent, also those that are always there. */
static void take_out(cm1e_bus_t *bus, int working_counter)
{
    for (int few = 0; few < 2; few++) {
        if (few && share_of_silent(bus) > missing_of(bus, working_counter))
            return;
        for (uint32_t i = 0; i < bus->slave_count; i++) {
            cm1e_bus_slave_t *slave = &bus->slaves[i];
            const bool silent = slave->silent_cycles > 0 && (few || cm1e_bus_is_unmistakable(slave));
            if (slave->hot.optional && slave->hot.counted && (silent || slave->watch.lost))
                take_out_one(bus, slave);
        }
    }
}

/** Those that take part again are counted, as far as the working counter shows it. */
static void take_in(cm1e_bus_t *bus, int working_counter)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        const int share = takes(slave) + gives(slave);
        if (slave->hot.counted || slave->hot.away || !is_operational(slave) || slave->silent_cycles > 0 ||
            !cm1e_recovery_idle(&slave->recovery) || working_counter - bus->expected_working_counter < share)
            continue;
        slave->hot.counted = true;
        bus->expected_working_counter += share;
        cm1e_hot_note(bus, slave);
    }
}

/** A slave that is always there, and whose inputs show that it took no part: whatever else counts does not make up for
 *  it. Optional ones have been taken out before. With few inputs one slave makes an odd number missing, and an even one
 *  needs two; `unseen` may make up for one without showing it, and `most` for two. */
static bool misses_one(const cm1e_bus_t *bus, int missing, int unseen, int most)
{
    unsigned few = 0;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        const bool silent = slave->hot.counted && slave->silent_cycles > 0;
        if (silent && cm1e_bus_is_unmistakable(slave))
            return true;
        few += silent;
    }
    return (few >= 1 && (unseen > 0 || (missing > 0 && missing % 2))) || (few >= 2 && (missing > 0 || most > 0));
}

/** Slaves that are not counted may take part or not: on their way to Operational first the inputs count, then the
 *  outputs, also of one that was refused on its way, until the search has met it again. A slave that is counted may
 *  have stopped to take outputs, or may have left if it has no inputs: nothing shows which one it is, so the optional
 *  ones are asked for their state at once. Until each of them can have answered, the others go on; after that the
 *  working counter is wrong. */
static bool explains(cm1e_bus_t *bus, int working_counter)
{
    const int more = -missing_of(bus, working_counter);
    int most = 0, least = 0, unseen = 0;
    unsigned asked = 0;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        const bool optional = slave->hot.optional && slave->hot.counted;
        most += may_take_part(slave) ? takes(slave) : 0;
        unseen += may_take_part(slave) && !slave->hot.away && gives(slave) && slave->silent_cycles > 0 &&
                  !cm1e_bus_is_unmistakable(slave);
        least -= optional ? takes(slave) : 0;
        asked += optional && takes(slave);
    }
    bus->search.in_doubt = false;
    if (misses_one(bus, -more, unseen, most) || (more % 2 != 0 && (more < 0 || unseen == 0)) || more > most + unseen ||
        more < least)
        return false;
    bus->search.doubt = more < 0 ? bus->search.doubt + 1 : 0;
    if (bus->search.doubt > ASKED_TIMES * asked + ON_THE_WAY)
        return false;
    bus->search.in_doubt = bus->search.doubt > 0;
    return true;
}

/** Whether one of those that are counted may take no part, although the working counter is the expected one: another
 *  one that comes back may make up for it. */
static bool hides_one(const cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (slave->hot.counted &&
            ((slave->hot.optional && slave->watch.lost) || (gives(slave) && cm1e_bus_is_silent(bus, slave))))
            return true;
    }
    return false;
}

bool cm1e_hot_judge(cm1e_bus_t *bus, int working_counter)
{
    const bool same = working_counter == bus->expected_working_counter;
    if (!bus->search.used || (same && !hides_one(bus))) {
        bus->search.doubt = 0;
        bus->search.in_doubt = false;
        return same;
    }
    cm1e_bus_find_silence(bus);
    take_out(bus, working_counter);
    take_in(bus, working_counter);
    return explains(bus, working_counter);
}

void cm1e_hot_take_inputs(cm1e_bus_t *bus)
{
    const uint8_t *inputs = bus->image + bus->output_bytes;
    if (!bus->search.used) {
        memcpy(bus->inputs, inputs, bus->input_bytes);
        return;
    }
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        const cm1e_slave_placement_t *placement = &slave->placement;
        if (slave->hot.counted)
            memcpy(bus->inputs + placement->input_offset, inputs + placement->input_offset, placement->input_bytes);
    }
}
