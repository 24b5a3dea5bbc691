#include "scheduler/clock_team.h"

static void find_leader(clock_team_t *team)
{
    team->leader = 0;
    for (uint32_t i = 1; i < team->count; i++)
        if (cm1e_bus_leads_clocks(team->buses[i], team->buses[team->leader]))
            team->leader = i;
}

void cm1e_clock_team_add(clock_team_t *team, cm1e_bus_t *bus)
{
    team->buses[team->count++] = bus;
    find_leader(team);
}

void cm1e_clock_team_cut(clock_team_t *team, uint32_t count)
{
    team->count = count < team->count ? count : team->count;
    find_leader(team);
}

void cm1e_clock_team_begin(clock_team_t *team)
{
    for (uint32_t i = 0; i < team->count; i++)
        cm1e_bus_follow_clock(team->buses[i], i == team->leader ? NULL : team->buses[team->leader]);
}

int64_t cm1e_clock_team_pace(clock_team_t *team)
{
    int64_t later_ns = 0;
    for (uint32_t i = 0; i < team->count; i++) {
        const int64_t own_ns = cm1e_bus_pace(team->buses[i]);
        later_ns = i == team->leader ? own_ns : later_ns;
    }
    return later_ns;
}
