/**
 * @file axis_segment.h
 * Axes on the simulated segment, through the real bus and the real frames, on virtual time; for tests with Check.
 */
#ifndef CM1E_TESTS_AXIS_SEGMENT_H
#define CM1E_TESTS_AXIS_SEGMENT_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assembly/assembly.h"
#include "axis/axis_api.h"
#include "bus/bus_image.h"
#include "cm1e/sim.h"
#include "nic/nic.h"
#include "quick_check.h"

extern cm1e_bus_config_t config;
extern cm1e_diag_t diag;
extern cm1e_bus_t *bus;
extern cm1e_axis_t *axes[8];
#define axis axes[0] /* what a test with one axis means */
extern int owner;

void describe(const char *firmware, cm1e_mapping_t mapping, cm1e_pdo_order_t order, int64_t cycle_ns);

/** Adds axes with defaults until there are `count`. */
void describe_up_to(uint32_t count);
void open_segment(void);
void close_segment(void);
cm1e_axis_info_t info_of(int n);
cm1e_axis_info_t info(void);
const char *text_of(int n);
const char *text(void);
cm1e_sim_probe_t probe_of(int n);
cm1e_sim_probe_t probe(void);
void simulate(const char *line);
void inputs(void);
void outputs(void);
void cycles(int n);
int cycles_of(double seconds);
void power(bool enable);
void enable(void);
cm1e_command_id_t command(const cm1e_axis_command_t *c);
void await(cm1e_command_id_t id, double seconds);
void move_to(double position, double velocity);

#endif
