/* Slaves with device emulation between the motors: AL control is copied to AL status, the acknowledge bit too. And when
 * an acknowledgement is sent at all: to who shows an error. */
#include "bus_support.h"
#include "sim/esc_chip.h"

static const cm1e_sim_io_t kinds[] = {CM1E_SIM_IO_TERMINAL, CM1E_SIM_IO_COUPLER};
enum { KINDS = 2, SLAVES = 5, MOTOR = 2, SIMPLE = 3, ACKNOWLEDGE = 0x10 };

/** Motors at 2 and 5, simple devices before, between them. */
static cm1e_bus_t *open_mixed_bus(int kind)
{
    sim_config(2);
    config.sim_gaps = kinds[kind];
    config.axes[0].address = MOTOR;
    config.axes[1].address = SLAVES;
    return open_bus();
}

static cm1e_sim_slave_t *slave_at(cm1e_bus_t *bus, uint32_t position)
{
    return cm1e_sim_segment_slave(segment_of(bus), position);
}

static uint16_t al_status(cm1e_bus_t *bus, uint32_t position)
{
    return cm1e_get_u16(slave_at(bus, position)->memory + ESC_AL_STATUS);
}

static void check_all_in(cm1e_bus_t *bus, uint16_t state)
{
    for (uint16_t position = 1; position <= SLAVES; position++) {
        ck_assert_uint_eq(al_status(bus, position), state);
        ck_assert_uint_eq(cm1e_bus_slave(bus, position)->al_state, state);
    }
}

/** Counts requests with the acknowledge bit. */
static cm1e_tap_verdict_t count_acknowledgements(void *context, cm1e_tap_frame_t *frame)
{
    const uint8_t command = frame->bytes[16];
    const bool write = command == 2 || command == 5 || command == 8; /* APWR, FPWR, BWR */
    if (frame->direction == CM1E_TAP_SENT && write && cm1e_get_u16(frame->bytes + 20) == 0x0120)
        *(unsigned *)context += (frame->bytes[26] & ACKNOWLEDGE) != 0;
    return CM1E_TAP_PASS;
}

START_TEST(scan_start_and_stop_work_beside_device_emulation)
{
    unsigned acknowledgements = 0;
    cm1e_bus_t *bus = open_mixed_bus(_i);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), count_acknowledgements, &acknowledgements);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), SLAVES);
    ck_assert_int_lt(now_of(bus), INT64_C(1500000000));
    check_all_in(bus, CM1E_AL_PRE_OP);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, 100);
    check_all_in(bus, CM1E_AL_OP);
    cm1e_bus_stop(bus);
    check_all_in(bus, CM1E_AL_INIT);
    ck_assert_uint_eq(acknowledgements, 0); /* nobody has shown an error */
    cm1e_bus_close(bus);
}
END_TEST

/** What another master, or our own of yesterday, has left: every state, with the bit. */
START_TEST(error_that_is_an_acknowledgement_does_not_stay)
{
    static const uint8_t states[] = {CM1E_AL_INIT, CM1E_AL_PRE_OP, CM1E_AL_BOOT, CM1E_AL_SAFE_OP, CM1E_AL_OP};
    cm1e_bus_t *bus = open_mixed_bus(_i);
    for (size_t i = 0; i < sizeof states; i++) {
        cm1e_put_u16(slave_at(bus, SIMPLE)->memory + ESC_AL_CONTROL, states[i] | ACKNOWLEDGE);
        cm1e_sim_al_control(slave_at(bus, SIMPLE));
        ck_assert_uint_eq(al_status(bus, SIMPLE), states[i] | ACKNOWLEDGE);
        ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "from 0x%02X: %s", states[i], diag.text);
        cycles(bus, 20);
        check_all_in(bus, CM1E_AL_OP);
        cm1e_bus_stop(bus);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** While it runs: asked back to Operational without a word from us. */
START_TEST(simple_device_that_shows_an_acknowledgement_comes_back)
{
    cm1e_bus_t *bus = open_mixed_bus(_i);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, 20);
    cm1e_put_u16(slave_at(bus, SIMPLE)->memory + ESC_AL_CONTROL, CM1E_AL_SAFE_OP | ACKNOWLEDGE);
    cm1e_sim_al_control(slave_at(bus, SIMPLE));
    for (int n = 0; n < 2000; n++)
        cycle(bus);
    check_all_in(bus, CM1E_AL_OP);
    cycles(bus, 10);
    cm1e_bus_close(bus);
}
END_TEST

/** The error of a motor is acknowledged on the way down and on the way up, wherever it is shown. */
START_TEST(error_of_a_motor_is_acknowledged_beside_device_emulation)
{
    static const uint8_t states[] = {CM1E_AL_INIT, CM1E_AL_PRE_OP, CM1E_AL_SAFE_OP};
    cm1e_bus_t *bus = open_mixed_bus(_i);
    for (size_t i = 0; i < sizeof states; i++) {
        ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
        cycles(bus, 20);
        cm1e_sim_slave_fall_back(slave_at(bus, MOTOR), states[i], 0x0021);
        cm1e_bus_stop(bus);
        check_all_in(bus, CM1E_AL_INIT);
    }
    for (size_t i = 0; i < sizeof states; i++) {
        ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
        cycles(bus, 20);
        cm1e_bus_close(bus);
        bus = open_mixed_bus(_i);
        cm1e_sim_slave_fall_back(slave_at(bus, MOTOR), CM1E_AL_INIT, 0x0021);
        ck_assert_uint_eq(al_status(bus, MOTOR), CM1E_AL_INIT | ACKNOWLEDGE);
    }
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

/** An error in a state whose configuration the scan has cleared: acknowledged by Init, which needs none. */
START_TEST(error_in_safe_operational_is_acknowledged_by_a_scan)
{
    cm1e_bus_t *bus = open_mixed_bus(_i);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_sim_slave_t *motor = slave_at(bus, MOTOR);
    cm1e_put_u16(motor->memory + ESC_AL_CONTROL, CM1E_AL_OP); /* refused from Pre-Operational */
    cm1e_sim_al_control(motor);
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), now_of(bus) + 1000000);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, 20);
    check_all_in(bus, CM1E_AL_OP);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_emulation");
    TCase *tests = tcase_create("emulation");
    tcase_add_loop_test(tests, scan_start_and_stop_work_beside_device_emulation, 0, KINDS);
    tcase_add_loop_test(tests, error_that_is_an_acknowledgement_does_not_stay, 0, KINDS);
    tcase_add_loop_test(tests, simple_device_that_shows_an_acknowledgement_comes_back, 0, KINDS);
    tcase_add_loop_test(tests, error_of_a_motor_is_acknowledged_beside_device_emulation, 0, KINDS);
    tcase_add_loop_test(tests, error_in_safe_operational_is_acknowledged_by_a_scan, 0, KINDS);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
