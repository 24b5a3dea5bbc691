/* A whole machine on one bus: a coupler with eight digital terminals, an analog device each way with CoE, of which the
 * inputs run by SYNC0, a CM1-E, a servo drive of another maker and a bridge. Its start with a frame lost at every moment, and every slave going away
 * and coming back. */
#include "bus_support.h"
#include "cm1e/clocks.h"
#include "cm1e/io.h"
#include "effort.h"
#include "slave_settings.h"

enum { TERMINALS = 8, ANALOG_OUT = 10, ANALOG_IN, MOTOR, DRIVE, BRIDGE, BACK = 6000, SETTLE = 6 };

static cm1e_slave_config_t *add(unsigned position, cm1e_sim_slave_kind_t kind, unsigned inputs, unsigned outputs)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, NULL);
    slave->address = (uint16_t)position;
    slave->sim.kind = kind;
    slave->sim.inputs = (uint8_t)inputs;
    slave->sim.outputs = (uint8_t)outputs;
    return slave;
}

static void machine(bool bridge)
{
    sim_config(bridge ? 3 : 2);
    config.cycle_time_ns = bridge ? 1000000 : 250000;
    config.axes[0].address = MOTOR;
    if (!bridge) /* old firmware knows 1 ms only */
        config.axes[0].firmware[0] = '\0';
    config.axes[1].address = DRIVE;
    config.axes[1].firmware[0] = '\0';
    strcpy(config.axes[1].device, "cia402");
    config.axes[1].counts_per_revolution = 131072;
    config.axes[1].max_speed_rpm = 3000;
    if (bridge) {
        config.axes[2].address = BRIDGE;
        config.axes[2].firmware[0] = '\0';
        config.axes[2].channel = 1;
        config.axes[2].k37 = 10;
        config.axes[2].k37_stated = true;
    }
    add(1, CM1E_SIM_SLAVE_COUPLER, 0, 0);
    for (unsigned n = 0; n < TERMINALS; n += 2) { /* 2, 4, 6 and 8 bits */
        add(2 + n, CM1E_SIM_SLAVE_DIGITAL, 0, n + 2);
        cm1e_slave_config_t *inputs = add(3 + n, CM1E_SIM_SLAVE_DIGITAL, n + 2, 0);
        snprintf(inputs->sim.wired_to, sizeof inputs->sim.wired_to, "slave%u", 2 + n);
    }
    add(ANALOG_OUT, CM1E_SIM_SLAVE_ANALOG, 0, 2);
    cm1e_slave_config_t *analog = add(ANALOG_IN, CM1E_SIM_SLAVE_ANALOG, 2, 0);
    strcpy(analog->sim.wired_to, "slave10");
    analog->inputs_pdos[0] = 0x1A03;
    analog->inputs_pdos[1] = 0x1A00;
    analog->inputs_pdo_count = 2;
    analog->dc.sync0_us = bridge ? 1000 : 250; /* takes its samples by SYNC0 */
    analog->sdos[0] = (cm1e_sdo_config_t){.index = 0x8000, .subindex = 0x12, .bytes = 2, .value = 7};
    analog->sdos[1] = (cm1e_sdo_config_t){.index = 0x8010, .subindex = 0x12, .bytes = 2, .before_op = true, .value = 9};
    analog->sdo_count = 2;
}

static void put(cm1e_bus_t *bus, unsigned position, unsigned bit, unsigned bits, int64_t value)
{
    cm1e_io_t io;
    ck_assert_msg(cm1e_io_find_bits(bus, (uint16_t)position, true, bit, (uint16_t)bits,
                                    bits == 16 ? CM1E_IO_INT : CM1E_IO_USINT, &io, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_io_set_integer(&io, value), CM1E_OK);
}

static int64_t get(cm1e_bus_t *bus, unsigned position, unsigned bit, unsigned bits)
{
    cm1e_io_t io;
    ck_assert_msg(cm1e_io_find_bits(bus, (uint16_t)position, false, bit, (uint16_t)bits,
                                    bits == 16 ? CM1E_IO_INT : CM1E_IO_USINT, &io, &diag) == CM1E_OK, "%s", diag.text);
    return cm1e_io_integer(&io);
}

/** Every terminal gives its inputs what the one before it was given; the analog inputs with their settings. */
static void expect_works(cm1e_bus_t *bus, unsigned pattern)
{
    for (unsigned n = 0; n < TERMINALS; n += 2)
        put(bus, 2 + n, 0, n + 2, pattern & ((1u << (n + 2)) - 1));
    put(bus, ANALOG_OUT, 0, 16, -1000 - (int)pattern);
    put(bus, ANALOG_OUT, 16, 16, (int)pattern);
    cycles(bus, SETTLE);
    for (unsigned n = 0; n < TERMINALS; n += 2)
        ck_assert_int_eq(get(bus, 3 + n, 0, n + 2), pattern & ((1u << (n + 2)) - 1));
    ck_assert_int_eq(get(bus, ANALOG_IN, 0, 16), (int)pattern + 9);
    ck_assert_int_eq(get(bus, ANALOG_IN, 32, 16), -993 - (int)pattern);
}

START_TEST(whole_machine_runs)
{
    machine(_i == 0);
    cm1e_bus_t *bus = start_bus();
    for (unsigned pattern = 0; pattern < 256; pattern += 5)
        expect_works(bus, pattern);
    for (uint16_t position = 1; position <= cm1e_bus_slave_count(bus); position++)
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, position).al_state, CM1E_AL_OP);
    cycles(bus, 2000); /* longer than any watchdog */
    for (uint16_t position = 1; position <= cm1e_bus_slave_count(bus); position++)
        ck_assert_uint_eq(cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(bus), position)), CM1E_AL_OP);
    cm1e_slave_clock_t clock;
    cm1e_bus_slave_clock(bus, ANALOG_IN, &clock);
    ck_assert(clock.has_clock && !clock.is_reference && !clock.lost && clock.losses == 0);
    cm1e_sim_clock_t shown;
    cm1e_sim_segment_clock(segment_of(bus), ANALOG_IN, &shown);
    ck_assert_uint_gt(shown.sync0_pulses, 2000);
    cm1e_bus_close(bus);
}
END_TEST

/** Loses the frame of one number, of those that the master sends. */
typedef struct loss {
    unsigned at, sent;
} loss_t;

static cm1e_tap_verdict_t lose_one(void *context, cm1e_tap_frame_t *frame)
{
    loss_t *loss = context;
    return frame->direction == CM1E_TAP_SENT && ++loss->sent == loss->at ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

/** A start with a lost frame succeeds, and then all works, or it is an error in words; then the next start succeeds. */
START_TEST(start_with_a_frame_lost_at_every_moment)
{
    machine(true);
    loss_t loss = {0};
    cm1e_bus_t *bus = open_bus();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_one, &loss);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
    const unsigned frames = loss.sent;
    ck_assert_uint_gt(frames, 500);
    const int stride = sweep_stride(8, 64);
    unsigned refused = 0, starts = 0;
    for (unsigned at = (unsigned)sweep_first(0, stride) + 1; at <= frames; at += (unsigned)stride, starts++) {
        loss = (loss_t){.at = at};
        bus = open_bus();
        cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_one, &loss);
        const cm1e_error_t error = cm1e_bus_start(bus, &diag);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
        if (error != CM1E_OK) {
            refused++;
            ck_assert_msg(strlen(diag.text) > 20, "frame %u: %s", at, diag.text);
            ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "after frame %u: %s", at, diag.text);
        }
        cycle(bus); /* the lost frame may be the one that the start has left on its way */
        expect_works(bus, at & 255);
        cm1e_bus_close(bus);
    }
    ck_assert_uint_le(refused, starts / 10 + 1);
}
END_TEST

/** Slaves in front of it go on in every cycle; it and those behind it come back, all works as before, and every register is
 *  set as it was. */
START_TEST(every_slave_goes_away_and_comes_back)
{
    const unsigned position = (unsigned)_i;
    char line[32];
    machine(true);
    cm1e_bus_t *bus = start_bus();
    expect_works(bus, 0x5A);
    slave_settings_t before[BRIDGE];
    take_settings(bus, 1, BRIDGE, before);
    snprintf(line, sizeof line, "power-cycle %u 50", position);
    simulate(bus, line);
    for (unsigned n = 0; n < BACK; n++) {
        cycle(bus);
        for (unsigned at = MOTOR; at <= BRIDGE; at++) /* as their axes ask for it */
            if (at >= position && cm1e_bus_slave_watch(bus, (uint16_t)at).al_state != CM1E_AL_OP && n > 500)
                cm1e_bus_request_recovery(bus, (uint16_t)at);
        for (unsigned at = 3; at < position && at <= ANALOG_IN && n > 5; at += 2) {
            cm1e_io_t io;
            ck_assert_int_eq(cm1e_io_find_bits(bus, (uint16_t)at, false, 0, 1, CM1E_IO_BOOL, &io, &diag), CM1E_OK);
            ck_assert_msg(cm1e_io_quality(&io) == CM1E_IO_GOOD, "slave %u away, cycle %u: slave %u is %s", position, n,
                          at, cm1e_io_quality_name(cm1e_io_quality(&io)));
        }
    }
    expect_works(bus, 0xA5);
    expect_settings(bus, 1, BRIDGE, before, false);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus machine");
    TCase *tests = tcase_create("machine");
    tcase_set_timeout(tests, 300);
    tcase_add_loop_test(tests, whole_machine_runs, 0, 2);
    tcase_add_test(tests, start_with_a_frame_lost_at_every_moment);
    tcase_add_loop_test(tests, every_slave_goes_away_and_comes_back, 1, BRIDGE + 1);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
