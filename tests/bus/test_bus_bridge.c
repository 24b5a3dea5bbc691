/* The Cool MUSCLE Bridge on the bus: recognised, matched with its axes, mapped, in Operational beside other devices. */
#include "bridge_segment.h"

/* ---- scan ------------------------------------------------------------------------------------------------------- */

START_TEST(scan_knows_every_model_and_its_motors)
{
    static const device_kind_t devices[] = {AN_EB01, AN_EB02, AN_EB12, A_MOTOR, AN_IO_MODULE};
    static const uint8_t motors[3][4] = {{1, 1, 1, 1}, {2, 2, 2, 2}, {1, 1, 2, 2}};
    sim_config(0);
    cm1e_bus_t *bus = open_bus_on_devices(devices, 5);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    for (unsigned i = 0; i < 3; i++) {
        const cm1e_slave_info_t *info = cm1e_bus_slave(bus, i + 1);
        ck_assert(info->is_bridge);
        ck_assert(!info->is_cm1e);
        ck_assert_int_eq(info->model, CM1E_DEVICE_EB01 + (int)i);
        ck_assert_mem_eq(info->motors, motors[i], 4);
    }
    for (unsigned position = 4; position <= 5; position++) {
        ck_assert(!cm1e_bus_slave(bus, position)->is_bridge);
        ck_assert_int_eq(cm1e_bus_slave(bus, position)->model, CM1E_DEVICE_CM1E);
    }
    ck_assert(cm1e_bus_slave(bus, 4)->is_cm1e);
    ck_assert_msg(cm1e_bus_identify(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- start ------------------------------------------------------------------------------------------------------ */

static const device_kind_t mixed[] = {A_MOTOR, AN_EB12, AN_IO_MODULE, AN_EB01};

/** The CM1-E, three motors of the EB12, one of the EB01; in no order. */
static void expect_mixed(void)
{
    sim_config(5);
    expect_bridged(0, 2, 4, "CM2");
    expect_bridged(1, 4, 2, "");
    config.axes[2].address = 1;
    expect_bridged(3, 2, 1, "CM1");
    expect_bridged(4, 2, 2, "");
}

static cm1e_bus_t *start_mixed(void)
{
    expect_mixed();
    cm1e_bus_t *bus = open_bus_on_devices(mixed, 4);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

START_TEST(mixed_network_runs_with_the_process_data_of_all)
{
    cm1e_bus_t *bus = start_mixed();
    static const uint16_t positions[] = {2, 4, 1, 2, 2};
    for (uint32_t axis = 0; axis < 5; axis++)
        ck_assert_uint_eq(cm1e_bus_axis_position(bus, axis), positions[axis]);
    static const uint16_t bridges[] = {2, 4};
    uint32_t target[2][CM1E_BRIDGE_AXES];
    for (unsigned n = 0; n < 2; n++) {
        ck_assert_uint_eq(cm1e_bus_slave(bus, bridges[n])->output_bytes, 24);
        ck_assert_uint_eq(cm1e_bus_slave(bus, bridges[n])->input_bytes, 24);
        for (unsigned channel = 1; channel <= CM1E_BRIDGE_AXES; channel++) {
            const cm1e_image_slot_t word = cm1e_bus_find_output(bus, bridges[n], on_channel(channel, 0x6040), 0);
            const cm1e_image_slot_t position = cm1e_bus_find_output(bus, bridges[n], on_channel(channel, 0x607A), 0);
            ck_assert_uint_eq(word.bytes, 2);
            ck_assert_uint_eq(position.bytes, 4);
            ck_assert_uint_eq(position.offset, word.offset + 2);
            ck_assert_uint_eq(cm1e_bus_find_output(bus, bridges[n], on_channel(channel, 0x6041), 0).bytes, 0);
            ck_assert_uint_eq(cm1e_bus_find_input(bus, bridges[n], on_channel(channel, 0x6064), 0).bytes, 4);
            target[n][channel - 1] = 1000 * n + channel;
            cm1e_put_u16(cm1e_bus_outputs(bus) + word.offset, channel == 3 ? 0 : 0x0006);
            cm1e_put_u32(cm1e_bus_outputs(bus) + position.offset, target[n][channel - 1]);
        }
    }
    cm1e_put_u16(cm1e_bus_outputs(bus) + cm1e_bus_find_output(bus, 1, 0x6040, 0).offset, 0x0006);
    cycles(bus, 100);
    for (unsigned n = 0; n < 2; n++) {
        const cm1e_sim_bridge_t *bridge = bridge_at(bus, bridges[n]);
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, bridges[n]).al_state, CM1E_AL_OP);
        for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++) {
            const uint32_t at = cm1e_bus_find_input(bus, bridges[n], on_channel(i + 1, 0x6041), 0).offset;
            ck_assert_uint_eq(bridge->axes[i].controlword, i == 2 ? 0 : 6);
            ck_assert_int_eq(bridge->axes[i].target_position, (int32_t)target[n][i]);
            ck_assert_uint_eq(cm1e_get_u16(cm1e_bus_inputs(bus) + at), cm1e_sim_bridge_statusword(&bridge->axes[i]));
            ck_assert_uint_eq(cm1e_get_u16(cm1e_bus_inputs(bus) + at) & 0x4F, i == 2 ? 0x40 : 0x01);
        }
    }
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(segment_of(bus), 1, &probe);
    ck_assert_uint_eq(probe.controlword, 6);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 3).al_state, CM1E_AL_OP);
    ck_assert_uint_eq(cm1e_bus_counters(bus)->working_counter_errors, 0);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_bridge");
    TCase *tests = tcase_create("bridge");
    tcase_add_test(tests, scan_knows_every_model_and_its_motors);
    tcase_add_test(tests, mixed_network_runs_with_the_process_data_of_all);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
