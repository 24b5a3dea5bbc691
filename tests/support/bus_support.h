/**
 * @file bus_support.h
 * What the tests of the bus share: buses on simulated segments in virtual time, cycles, and a tap that does to frames
 * what a test asks for.
 */
#ifndef CM1E_TESTS_BUS_SUPPORT_H
#define CM1E_TESTS_BUS_SUPPORT_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_image.h"
#include "cm1e/generate.h"
#include "cm1e/sii.h"
#include "core/bytes.h"
#include "nic/nic.h"
#include "quick_check.h"
#include "sim/segment_backend.h"
#include "sim/slave.h"

/** One configuration at a time is enough for a test; it is too large for a stack. */
extern cm1e_bus_config_t config;
extern cm1e_diag_t diag;

/** The devices that this run of a test is about: ctest runs each on both PDO orders, with old and new firmware. */
const char *tested_firmware(void);

cm1e_pdo_order_t tested_order(void);

cm1e_bus_config_t *sim_config(uint32_t axes);

cm1e_bus_t *open_bus(void);
/** A bus with so many CM1-E, opened and scanned. */
cm1e_bus_t *open_scanned_bus(uint32_t axes);

/** The segment of an open bus. */
cm1e_sim_segment_t *segment_of(cm1e_bus_t *bus);

/** Registers and SII of a simulated slave, for tests that do not see its struct. */
uint8_t *register_memory_of(cm1e_bus_t *bus, uint32_t position);
uint8_t *sii_memory_of(cm1e_bus_t *bus, uint32_t position);
/** Lets the SII of a slave say that its controller cannot do LRW. */
void forget_lrw(cm1e_bus_t *bus, uint32_t position);

/** A bus whose segment was made from `segment_config`, while the bus expects `config`. */
cm1e_bus_t *open_bus_on(const cm1e_bus_config_t *segment_config);

cm1e_bus_t *start_bus(void);

int64_t now_of(cm1e_bus_t *bus);

/** One cycle as the scheduler does it; on virtual time the sleep is what lets time pass. */
cm1e_error_t cycle(cm1e_bus_t *bus);

void cycles(cm1e_bus_t *bus, unsigned n);

void simulate(cm1e_bus_t *bus, const char *line);

/** The datagram of a frame that reads this register of one slave: its place in the frame and its slave; -1: none. */
int find_read(const cm1e_tap_frame_t *frame, uint16_t offset, uint16_t *station);

/** Runs the cycle until a transfer has ended; returns how many cycles that took. */
unsigned finish_sdo(cm1e_bus_t *bus, const cm1e_sdo_t *sdo);

/** Check: one program, one suite. */
int run_suite(Suite *suite);

#endif
