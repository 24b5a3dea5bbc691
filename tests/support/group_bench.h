/**
 * @file group_bench.h
 * An axes group on axes_bench.h: ways into its states, commands, and a witness of its set-points against the programmed
 * path.
 */
#ifndef CM1E_TESTS_GROUP_BENCH_H
#define CM1E_TESTS_GROUP_BENCH_H

#include "axes_bench.h"
#include "group/group_api.h"
#include "group/group_private.h"

extern AXES_GROUP_REF_t group_reference;
extern cm1e_group_t *group;

void group_end(void);
void group_create(void);
const char *group_text(void);
void group_told(const char *words);
cm1e_group_info_t group_info(void);
void group_must_be(cm1e_group_state_t state);

/** The axes of the bench, as they are, become members in their order; GroupDisabled. */
void group_form(void);

/** `count` axes in Standstill, their group in GroupStandby. */
void group_begin(int count);
cm1e_command_id_t group_command(const cm1e_group_command_t *command);
void group_refused(const cm1e_group_command_t *command, cm1e_error_t expected);
cm1e_command_id_t group_line(double x, double y, double velocity, MC_BUFFER_MODE mode);
cm1e_command_id_t group_stop(void);
cm1e_command_state_t group_state_of(cm1e_command_id_t id);
void group_done(cm1e_command_id_t id);

/** Set-point of axis n, as the path counts. */
double group_at(int n);

/** Distance of the set-points of the first two axes from the line through a and b; u. */
double group_off_line(double ax, double ay, double bx, double by);

/** Distance of the axes from a circle. */
double group_off_circle(double cx, double cy, double radius);

#endif
