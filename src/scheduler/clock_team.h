/**
 * @file clock_team.h
 * The distributed clocks of the buses of a scheduler: the cycle follows the reference clock of one of them, which
 * leads, and the clocks of the others follow that clock too (docs/CLOCKS.md). Buses without clocks are members as well.
 */
#ifndef CM1E_SCHEDULER_CLOCK_TEAM_H
#define CM1E_SCHEDULER_CLOCK_TEAM_H

#include "bus/bus_image.h"
#include "cm1e/clocks.h"
#include "cm1e/scheduler.h"

/** Valid when zeroed. */
typedef struct clock_team {
    cm1e_bus_t *buses[CM1E_MAX_BUSES];
    uint32_t count, leader;
} clock_team_t;

/** The bus whose clocks lead; without clocks the first one. */
static inline const cm1e_bus_t *clock_team_leader(const clock_team_t *team) { return team->buses[team->leader]; }
/** @rt init */
void cm1e_clock_team_add(clock_team_t *team, cm1e_bus_t *bus);
/** Only the first `count` stay. @rt init */
void cm1e_clock_team_cut(clock_team_t *team, uint32_t count);
/** Before the first cycle: a bus that led until now may be none of these. @rt init */
void cm1e_clock_team_begin(clock_team_t *team);
/** What the next cycle begins later, in ns. What the cycles of the other buses would be corrected by is left out.
 *  @rt cycle */
int64_t cm1e_clock_team_pace(clock_team_t *team);

#endif
