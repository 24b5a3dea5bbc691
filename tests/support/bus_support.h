/**
 * @file bus_support.h
 * What the tests of the bus share: buses on simulated segments in virtual time, cycles, and a tap that does to frames
 * what a test asks for.
 */
#ifndef CM1E_TESTS_BUS_SUPPORT_H
#define CM1E_TESTS_BUS_SUPPORT_H

#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_image.h"
#include "cm1e/generate.h"
#include "cm1e/sii.h"
#include "core/bytes.h"
#include "nic/nic.h"
#include "sim/backend.h"
#include "sim/slave.h"

/** One configuration at a time is enough for a test; it is too large for a stack. */
static cm1e_bus_config_t config;
static cm1e_diag_t diag;

/** The devices that this run of a test is about: ctest runs each on both PDO orders, with old and new firmware. */
static inline const char *tested_firmware(void)
{
    const char *firmware = getenv("CM1E_TEST_FIRMWARE");
    return firmware ? firmware : "1.3.5";
}

static inline cm1e_pdo_order_t tested_order(void)
{
    const char *order = getenv("CM1E_TEST_PDO_ORDER");
    return order && strcmp(order, "ug-7.2") == 0 ? CM1E_PDO_ORDER_UG_7_2 : CM1E_PDO_ORDER_UG_4_4;
}

static inline cm1e_bus_config_t *sim_config(uint32_t axes)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", axes);
    config.virtual_time = true;
    config.sim_pdo_order = tested_order();
    for (uint32_t i = 0; i < axes; i++)
        snprintf(config.axes[i].firmware, sizeof config.axes[i].firmware, "%s", tested_firmware());
    return &config;
}

static inline cm1e_bus_t *open_bus(void)
{
    cm1e_bus_t *bus = NULL;
    memset(&diag, 0, sizeof diag);
    ck_assert_msg(cm1e_bus_open(&bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

/** The segment of an open bus. */
static inline cm1e_sim_segment_t *segment_of(cm1e_bus_t *bus) { return cm1e_bus_segment(bus); }

/** A bus whose segment was made from `segment_config`, while the bus expects `config`. */
static inline cm1e_bus_t *open_bus_on(const cm1e_bus_config_t *segment_config)
{
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create(segment_config, &diag);
    ck_assert_msg(segment != NULL, "%s", diag.text);
    cm1e_sim_replace_segment(cm1e_bus_nic(bus), segment);
    return bus;
}

static inline cm1e_bus_t *start_bus(void)
{
    cm1e_bus_t *bus = open_bus();
    const cm1e_error_t error = cm1e_bus_start(bus, &diag);
    ck_assert_msg(error == CM1E_OK, "%s: %s", cm1e_strerror(error), diag.text);
    return bus;
}

static inline int64_t now_of(cm1e_bus_t *bus) { return cm1e_clock_now(cm1e_bus_clock(bus)); }

/** One cycle as the scheduler does it; on virtual time the sleep is what lets time pass. */
static inline cm1e_error_t cycle(cm1e_bus_t *bus)
{
    const int64_t next_ns = now_of(bus) + cm1e_bus_configuration(bus)->cycle_time_ns;
    const cm1e_error_t error = cm1e_bus_receive(bus);
    cm1e_bus_send(bus);
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), next_ns);
    return error;
}

static inline void cycles(cm1e_bus_t *bus, unsigned n)
{
    for (unsigned i = 0; i < n; i++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
}

static inline void simulate(cm1e_bus_t *bus, const char *line)
{
    char answer[256] = "";
    ck_assert_msg(cm1e_bus_simulate(bus, line, answer, sizeof answer) == CM1E_OK, "%s: %s", line, answer);
}

/** Runs the cycle until a transfer has ended; returns how many cycles that took. */
static inline unsigned finish_sdo(cm1e_bus_t *bus, const cm1e_sdo_t *sdo)
{
    unsigned n = 0;
    while (cm1e_sdo_state(sdo) == CM1E_SDO_BUSY) {
        cycle(bus);
        ck_assert_uint_lt(++n, 20000);
    }
    return n;
}

/** Check: one program, one suite. */
static inline int run_suite(Suite *suite)
{
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

#endif
