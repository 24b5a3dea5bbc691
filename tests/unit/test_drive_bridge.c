/* A motor behind the bridge: start-up, enabling from every state, what its words say, faults and their reset. */
#include <stdlib.h>

#include "drive_bridge_bench.h"

static const cm1e_device_model_t models[] = {CM1E_DEVICE_EB01, CM1E_DEVICE_EB02, CM1E_DEVICE_EB12};

void setUp(void) { bench_open(CM1E_DEVICE_EB12, 2); }
void tearDown(void) { bench_close(); }

/* ---- start-up --------------------------------------------------------------------------------------------------- */

static void assert_refused(cm1e_error_t error, const char *part)
{
    cm1e_drive_free(&drive);
    TEST_ASSERT_EQUAL_INT_MESSAGE(error, cm1e_drive_init(&drive, &bus, 0, &diag), diag.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, part), diag.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "slide"), diag.text);
}

static void test_what_the_configuration_has_to_state(void)
{
    cm1e_axis_config_t *config = &bus.config.axes[0];
    config->k37_stated = false;
    assert_refused(CM1E_ERROR_CONFIG, "\"K37.2\"");
    config->k37_stated = true;
    config->k37 = 80; /* of a CM2 only */
    assert_refused(CM1E_ERROR_CONFIG, "a CM1 knows no K37 of 80");
    config->k37 = FAKE_BRIDGE_K37;
    config->mapping = CM1E_MAPPING_CSP;
    assert_refused(CM1E_ERROR_CONFIG, "mapping");
    config->mapping = CM1E_MAPPING_DYNAMIC;
    config->channel = 5;
    assert_refused(CM1E_ERROR_CONFIG, "1 ... 4");
    config->channel = 2;
    bus.info.device = &cm1e_device_cm1e;
    assert_refused(CM1E_ERROR_CONFIG, "Bridge");
}

static void test_an_object_that_is_not_mapped_is_named_by_its_index_on_the_channel(void)
{
    static const uint16_t indexes[] = {0x6840, 0x687A, 0x6841, 0x6864};
    for (unsigned k = 0; k < 4; k++) {
        fake_bridge_open(&bus, CM1E_DEVICE_EB01, 2);
        for (unsigned i = 0; i < bus.rx.entry_count; i++) {
            bus.rx.entries[i].index = bus.rx.entries[i].index == indexes[k] ? 0 : bus.rx.entries[i].index;
            bus.tx.entries[i].index = bus.tx.entries[i].index == indexes[k] ? 0 : bus.tx.entries[i].index;
        }
        char object[8];
        snprintf(object, sizeof object, "0x%04X", indexes[k]);
        assert_refused(CM1E_ERROR_PDO_MAPPING, object);
    }
}

static void test_a_bridge_found_in_a_dead_end_is_an_error_that_says_so(void)
{
    static const int dead[] = {CM1E_BRIDGE_MODE_CMD, CM1E_BRIDGE_MODE_CPIO, 0, 77};
    for (size_t i = 0; i < sizeof dead / sizeof dead[0]; i++) {
        fake_bridge.mode_shown = dead[i];
        char mode[12];
        snprintf(mode, sizeof mode, "mode %d", dead[i]);
        assert_refused(CM1E_ERROR_STATE, mode);
        TEST_ASSERT_NOT_NULL(strstr(diag.text, "off and on"));
    }
    fake_bridge.mode_shown = -1;
    fake_bridge.broken_sdo = 1;
    cm1e_drive_free(&drive);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_SDO_ABORT, cm1e_drive_init(&drive, &bus, 0, &diag));
}

static void test_a_bridge_found_in_hm_or_cml_is_brought_to_csp(void)
{
    static const int8_t found[] = {CM1E_BRIDGE_MODE_HM, CM1E_BRIDGE_MODE_CML};
    for (int i = 0; i < 2; i++) {
        fake_bridge_open(&bus, CM1E_DEVICE_EB02, 3);
        fake_bridge_axis()->mode = found[i];
        bench_init();
        TEST_ASSERT_TRUE(bench_mode(CM1E_MODE_CSP, 100));
        TEST_ASSERT_EQUAL_INT8(CM1E_MODE_CSP, fake_bridge_axis()->mode);
        bench_enable();
    }
}

/* `cm1e move` after `cm1e cml --stay`: torque is asked for in the very first cycle, on a clock that runs for days. */
static void test_a_bridge_found_in_cml_is_enabled_from_the_first_cycle_on(void)
{
    fake_bridge_open(&bus, CM1E_DEVICE_EB02, 3);
    fake_bridge_axis()->mode = CM1E_BRIDGE_MODE_CML;
    bus.clock.virtual_now_ns += INT64_C(100000000000000);
    bench_init();
    drive.command.mode = CM1E_MODE_CSP;
    bench_enable();
}

/* ---- enabling --------------------------------------------------------------------------------------------------- */

static void test_every_channel_of_every_model_is_enabled_without_moving_and_follows(void)
{
    for (size_t m = 0; m < 3; m++)
        for (unsigned channel = 1; channel <= CM1E_BRIDGE_AXES; channel++) {
            bench_open(models[m], channel);
            drive.command.target_position = 1234567; /* must not reach the wire before `enabled` */
            drive.command.enable = true;
            for (int i = 0; i < 50 && !drive.feedback.enabled; i++) {
                fake_bus_cycle(&bus, CYCLE_NS);
                cm1e_drive_read(&drive, true, bus.clock.virtual_now_ns);
                if (drive.feedback.enabled)
                    break;
                cm1e_drive_write(&drive);
                TEST_ASSERT_EQUAL_INT32(drive.feedback.position, bench_target());
            }
            TEST_ASSERT_TRUE(drive.feedback.enabled);
            TEST_ASSERT_EQUAL_INT64(0, fake_bridge.largest_step);
            for (int i = 0; i < 500; i++) {
                drive.command.target_position = i * 20;
                bench_cycle();
            }
            bench_cycles(200);
            TEST_ASSERT_INT32_WITHIN(2, 499 * 20, drive.feedback.position);
            for (unsigned other = 0; other < CM1E_BRIDGE_AXES; other++)
                if (other != channel - 1) { /* not a byte of another axis is touched */
                    static const uint8_t zeros[FAKE_BRIDGE_AXIS_BYTES];
                    TEST_ASSERT_EQUAL_MEMORY(zeros, bus.outputs + other * FAKE_BRIDGE_AXIS_BYTES, sizeof zeros);
                }
            drive.command.enable = false;
            bench_cycles(5);
            TEST_ASSERT_TRUE(fake_bridge_axis()->motor_free);
            TEST_ASSERT_TRUE(drive.feedback.motor_free);
        }
}

/* One transition a cycle (BR 6.1): each word only where its state is shown. */
static void test_the_way_from_every_state_has_one_command_a_cycle(void)
{
    static const struct {
        uint16_t shown, word;
    } rows[] = {{0x0200, 0x06}, {0x0240, 0x06}, {0x0201, 0x07}, {0x0203, 0x0F}, {0x0207, 0x0F},
                {0x0231, 0x07}, {0x0223, 0x0F}, {0x0205, 0x06}, {0x0204, 0x06}, {0x0247, 0x06}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        bench_open(CM1E_DEVICE_EB01, 1);
        bench_cycles(30);
        fake_bridge.statusword = 0x0201;
        drive.command.enable = true;
        bench_cycle();
        fake_bridge.statusword = rows[i].shown;
        bench_cycle();
        TEST_ASSERT_EQUAL_HEX16(rows[i].word, bench_word());
    }
}

static void test_enabling_survives_a_lost_frame_at_every_cycle(void)
{
    for (int lost = 0; lost < 12; lost++) {
        bench_open(CM1E_DEVICE_EB01, 4);
        drive.command.enable = true;
        for (int i = 0; i < 60; i++) {
            fake_bridge.lost = i == lost;
            bench_cycle();
        }
        TEST_ASSERT_TRUE(drive.feedback.enabled);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
        TEST_ASSERT_EQUAL_INT64(0, fake_bridge.largest_step);
    }
}

static void test_a_motor_that_stays_free_is_not_enabled(void)
{
    fake_bridge.statusword = 0x8201;
    drive.command.enable = true;
    bench_cycles(5);
    fake_bridge.statusword = 0x8207; /* the state says so, the motor does not */
    bench_cycles(100);
    TEST_ASSERT_FALSE(drive.feedback.enabled);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    bench_cycles(2000);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_ENABLE_TIMEOUT, drive.fault.error);
    TEST_ASSERT_EQUAL_HEX16(0x0006, bench_word());
}

/* BR 6.1.1, state A: no controlword frees it there. It holds where it stands, and no target of the start moves it. */
static void test_a_cm1_holds_from_power_on_until_it_was_enabled_once(void)
{
    for (unsigned channel = 1; channel <= CM1E_BRIDGE_AXES; channel++) {
        bench_open(CM1E_DEVICE_EB12, channel);
        const bool holds = cm1e_bridge_motor(CM1E_DEVICE_EB12, channel - 1) == CM1E_BRIDGE_CM1;
        drive.command.target_position = 4711;
        bench_cycles(500);
        TEST_ASSERT_EQUAL_INT(!holds, fake_bridge_axis()->motor_free);
        TEST_ASSERT_EQUAL_INT(!holds, drive.feedback.motor_free);
        TEST_ASSERT_FALSE(drive.feedback.enabled);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
        TEST_ASSERT_EQUAL_INT32(0, drive.feedback.position);
        bench_enable();
        TEST_ASSERT_EQUAL_INT64(0, fake_bridge.largest_step);
        drive.command.enable = false;
        bench_cycles(20);
        TEST_ASSERT_TRUE(fake_bridge_axis()->motor_free);
        TEST_ASSERT_TRUE(drive.feedback.motor_free);
    }
}

static void test_motor_free_while_enabled_is_a_loss(void)
{
    bench_enable();
    fake_bridge.statusword = 0x9207;
    bench_cycle();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_ENABLE_LOST, drive.fault.error);
    TEST_ASSERT_EQUAL_HEX16(0x0006, bench_word());
    bench_text_has("Operation enabled");
}

/* ---- the words over all statuswords ----------------------------------------------------------------------------- */

static cm1e_fsa_state_t state_of_profile(uint16_t word) /* BR 6.1.3, bits 6, 3 ... 0 */
{
    switch (word & 0x4F) {
    case 0x00: return NOT_READY_TO_SWITCH_ON;
    case 0x40: return SWITCH_ON_DISABLED;
    case 0x01: return READY_TO_SWITCH_ON;
    case 0x03: return SWITCHED_ON;
    case 0x07: return OPERATION_ENABLED;
    case 0x0F: return FAULT_REACTION_ACTIVE;
    case 0x08: return FAULT;
    default: return CM1E_FSA_UNKNOWN;
    }
}

static void show_word(uint32_t word)
{
    fake_bridge.statusword = (int)word;
    fake_bridge_inputs(&bus);
    cm1e_drive_read(&drive, true, bus.clock.virtual_now_ns);
}

static void test_every_statusword_in_csp_leaves_a_defined_output(void)
{
    bench_enable();
    const cm1e_drive_t enabled = drive;
    for (uint32_t word = 0; word <= 0xFFFF; word++) {
        drive = enabled;
        show_word(word);
        const cm1e_drive_feedback_t *f = &drive.feedback;
        const cm1e_fsa_state_t state = state_of_profile((uint16_t)word);
        const bool error = word & 0x4008, is_free = word & 0x8000;
        const bool good = state == OPERATION_ENABLED && !error && !is_free;
        TEST_ASSERT_EQUAL_INT(state, f->state);
        TEST_ASSERT_TRUE(f->voltage);
        TEST_ASSERT_EQUAL_INT(error, f->fault);
        TEST_ASSERT_EQUAL_INT(is_free, f->motor_free);
        TEST_ASSERT_EQUAL_INT((word & 0x0400) != 0, f->target_reached);
        TEST_ASSERT_EQUAL_INT((word & 0x1000) != 0, f->bit12);
        TEST_ASSERT_EQUAL_INT((word & 0x2000) != 0, f->bit13);
        TEST_ASSERT_EQUAL_INT(good, f->enabled);
        TEST_ASSERT_EQUAL_INT(error ? CM1E_ERROR_DRIVE_FAULT : good ? CM1E_OK : CM1E_ERROR_DRIVE_ENABLE_LOST,
                              drive.fault.error);
        cm1e_drive_write(&drive);
        TEST_ASSERT_EQUAL_HEX16(good ? 0x000F : 0x0006, bench_word());
    }
    drive = enabled;
}

static void test_every_statusword_in_cpio(void)
{
    for (unsigned channel = 2; channel <= 3; channel++) { /* a CM1, a CM2 */
        bench_open(CM1E_DEVICE_EB12, channel);
        TEST_ASSERT_TRUE(bench_mode(CM1E_BRIDGE_MODE_CPIO, 100));
        const cm1e_drive_t before = drive;
        for (uint32_t word = 0; word <= 0xFFFF; word++) {
            drive = before;
            show_word(word);
            const cm1e_drive_feedback_t *f = &drive.feedback;
            cm1e_fsa_state_t state = state_of_profile(word & 0x0F);
            if (state == NOT_READY_TO_SWITCH_ON)
                state = SWITCH_ON_DISABLED;
            TEST_ASSERT_EQUAL_INT(word >> 12 == 0xC ? state : CM1E_FSA_UNKNOWN, f->state);
            const unsigned motor = word >> 8 & 0x0F; /* BR 7.1.3 note 1: 0 running, 8 in position */
            TEST_ASSERT_EQUAL_INT((motor != 0 && motor != 8) || (word & 0x08), f->fault);
            TEST_ASSERT_EQUAL_INT((word & 0x0800) != 0, f->target_reached);
            TEST_ASSERT_FALSE(f->motor_free || f->bit12 || f->bit13);
            TEST_ASSERT_EQUAL_HEX16(word >> 4 & (channel == 2 ? 0x0E : 0x0F), f->digital_inputs);
            TEST_ASSERT_EQUAL_INT(f->state != CM1E_FSA_UNKNOWN, f->digital_known);
        }
        drive = before;
        fake_bridge.statusword = -1;
    }
}

static void test_no_statusword_in_cmd_is_a_state_or_a_fault(void)
{
    TEST_ASSERT_TRUE(bench_mode(CM1E_BRIDGE_MODE_CMD, 100));
    for (uint32_t word = 0; word <= 0xFFFF; word++) {
        show_word(word);
        cm1e_drive_write(&drive);
        TEST_ASSERT_EQUAL_INT(CM1E_FSA_UNKNOWN, drive.feedback.state);
        TEST_ASSERT_FALSE(drive.feedback.fault || drive.feedback.enabled || drive.feedback.motor_free);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
        TEST_ASSERT_EQUAL_HEX16(0, bench_word());
    }
}

/* ---- CPIO ------------------------------------------------------------------------------------------------------- */

static void test_cpio_has_outputs_and_positions_in_its_words(void)
{
    for (unsigned outputs = 0; outputs < 0x20; outputs++) {
        bench_open(CM1E_DEVICE_EB12, 1 + outputs % 4);
        drive.command.digital_outputs = (uint16_t)outputs;
        TEST_ASSERT_FALSE(cm1e_drive_signals_in_cycle(&drive));
        TEST_ASSERT_TRUE(bench_mode(CM1E_BRIDGE_MODE_CPIO, 100));
        TEST_ASSERT_TRUE(cm1e_drive_signals_in_cycle(&drive));
        TEST_ASSERT_EQUAL_STRING("CPIO", cm1e_drive_mode_name(&drive, drive.feedback.mode));
        TEST_ASSERT_NULL(cm1e_drive_mode_name(&drive, CM1E_MODE_NONE));
        const unsigned mask = outputs % 4 < 2 ? 0x02 : 0x0F;
        bench_cycles(2);
        TEST_ASSERT_EQUAL_HEX16(0xC006 | (outputs & mask) << 4, bench_word());
        TEST_ASSERT_EQUAL_HEX8(outputs & mask, fake_bridge_axis()->outputs);
        TEST_ASSERT_EQUAL_INT(CM1E_DRIVE_OUTPUTS_SET, cm1e_drive_outputs(&drive));
        bench_enable();
        TEST_ASSERT_EQUAL_HEX16(0xC00F | (outputs & mask) << 4, bench_word());
        for (int i = 0; i < 300; i++) {
            drive.command.target_position += 10;
            bench_cycle();
        }
        bench_cycles(200);
        TEST_ASSERT_INT32_WITHIN(2, 3000, drive.feedback.position);
        TEST_ASSERT_TRUE(drive.feedback.target_reached);
        drive.command.enable = false;
        bench_cycles(5);
        TEST_ASSERT_TRUE(fake_bridge_axis()->motor_free);
        TEST_ASSERT_EQUAL_HEX16(0xC006 | (outputs & mask) << 4, bench_word());
    }
}

/* Bit 7 is an output there. */
static void test_cpio_has_no_fault_reset_and_says_so(void)
{
    bench_open(CM1E_DEVICE_EB02, 1);
    TEST_ASSERT_TRUE(bench_mode(CM1E_BRIDGE_MODE_CPIO, 100));
    bench_enable();
    cm1e_sim_bridge_axis_error(fake_bridge_axis(), BRIDGE_STATUS_OVERLOAD);
    bench_cycles(20);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_FAULT, drive.fault.error);
    TEST_ASSERT_EQUAL_HEX8(BRIDGE_STATUS_OVERLOAD, drive.fault.motor_status);
    drive.command.reset = true;
    for (int i = 0; i < 3000; i++) {
        bench_cycle();
        TEST_ASSERT_EQUAL_HEX16(0xC006, bench_word());
    }
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_RESET_TIMEOUT, drive.fault.error);
    bench_text_has("CPIO");
    bench_text_has("off and on");
}

/* ---- faults ----------------------------------------------------------------------------------------------------- */

static void test_errors_of_the_motor_are_told_in_its_own_words(void)
{
    static const uint8_t errors[] = {BRIDGE_STATUS_POSITION_OVERFLOW, BRIDGE_STATUS_OVER_SPEED, BRIDGE_STATUS_OVERLOAD,
                                     BRIDGE_STATUS_SERIAL_ERROR};
    for (unsigned channel = 1; channel <= 4; channel++)
        for (size_t i = 0; i < sizeof errors; i++) {
            bench_open(CM1E_DEVICE_EB12, channel);
            bench_enable();
            bus.sdo_delay = 3;
            cm1e_sim_bridge_axis_error(fake_bridge_axis(), errors[i]);
            bench_cycles(2);
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_FAULT, drive.fault.error);
            TEST_ASSERT_EQUAL_HEX16(0x0006, bench_word());
            TEST_ASSERT_FALSE(drive.fault.motor_status_known);
            bench_cycles(20);
            TEST_ASSERT_TRUE(drive.fault.motor_status_known);
            TEST_ASSERT_EQUAL_HEX8(errors[i], drive.fault.motor_status);
            char words[CM1E_BRIDGE_STATUS_TEXT];
            bench_text_has(cm1e_bridge_status_text(cm1e_bridge_motor(CM1E_DEVICE_EB12, channel - 1), errors[i], words,
                                                   sizeof words));
            bench_text_has(channel <= 2 ? "CM1" : "CM2");
            bench_text_has("MC_Reset");
            drive.command.enable = false;
            TEST_ASSERT_TRUE(bench_reset(250));
            TEST_ASSERT_EQUAL_HEX8(0, fake_bridge_axis()->error);
            TEST_ASSERT_TRUE(bench_mode(CM1E_MODE_CSP, 50));
            fake_bridge.largest_step = 0;
            bench_enable();
            TEST_ASSERT_EQUAL_INT64(0, fake_bridge.largest_step);
        }
}

static void test_a_status_that_cannot_be_read_is_asked_for_three_times(void)
{
    fake_bridge.broken_sdo = 1000;
    cm1e_sim_bridge_axis_error(fake_bridge_axis(), BRIDGE_STATUS_OVERLOAD);
    bench_cycles(100);
    TEST_ASSERT_EQUAL_UINT(1000 - 3, fake_bridge.broken_sdo);
    TEST_ASSERT_FALSE(drive.fault.motor_status_known);
    bench_text_has("reports a fault");
}

static void test_an_error_that_stays_is_a_reset_timeout(void)
{
    fake_bridge.statusword = 0x4208;
    bench_cycles(5);
    drive.command.reset = true;
    int set = 0, edges = 0;
    for (int i = 0; i < 3000; i++) {
        const bool before = bench_word() & CONTROLWORD_FAULT_RESET;
        bench_cycle();
        const bool bit = bench_word() & CONTROLWORD_FAULT_RESET;
        set += bit;
        edges += bit && !before;
    }
    TEST_ASSERT_EQUAL_INT(1, edges);
    TEST_ASSERT_INT_WITHIN(2, 20, set);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_RESET_TIMEOUT, drive.fault.error);
}

/* ---- positions -------------------------------------------------------------------------------------------------- */

static void test_a_target_beyond_k37_is_never_written(void)
{
    static const int32_t beyond[] = {999999999 + 1, -999999999 - 1, INT32_MAX, INT32_MIN};
    for (int i = 0; i < 4; i++) {
        bench_open(CM1E_DEVICE_EB01, 1);
        bench_enable();
        drive.command.target_position = 100;
        bench_cycle();
        drive.command.target_position = beyond[i];
        bench_cycle();
        TEST_ASSERT_EQUAL_INT32(100, bench_target());
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, drive.fault.error);
        bench_text_has("K37");
        bench_cycle();
        TEST_ASSERT_EQUAL_HEX16(0x0006, bench_word());
    }
    bench_open(CM1E_DEVICE_EB01, 1); /* the limit itself may be a target */
    bench_enable();
    drive.command.target_position = 999999999;
    cm1e_drive_write(&drive);
    TEST_ASSERT_EQUAL_INT32(999999999, bench_target());
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
}

/* Its target would be cut to the limit: a jump. */
static void test_a_motor_beyond_k37_is_not_enabled(void)
{
    fake_bridge_axis()->zero -= 1000000000;
    bench_cycles(3);
    drive.command.enable = true;
    for (int i = 0; i < 20; i++) {
        bench_cycle();
        TEST_ASSERT_EQUAL_HEX16(0x0006, bench_word());
    }
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, drive.fault.error);
}

/* ---- away ------------------------------------------------------------------------------------------------------- */

static void test_a_new_origin_is_no_velocity(void)
{
    fake_bridge_axis()->zero += 100000; /* the counter of the motor is another one from one cycle to the next */
    for (int i = 0; i < 5; i++) {
        bench_cycle();
        TEST_ASSERT_INT_WITHIN(1000, 0, drive.feedback.velocity);
    }
    TEST_ASSERT_INT_WITHIN(10, -100000, drive.feedback.position);
}

static void test_a_slave_that_left_takes_the_torque_with_it(void)
{
    bench_enable();
    bus.watch = (cm1e_slave_watch_t){.al_state = CM1E_AL_SAFE_OP | CM1E_AL_ERROR, .al_status_code = 0x001B};
    bench_cycle();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUS_STATE, drive.fault.error);
    TEST_ASSERT_EQUAL_HEX16(0x0006, bench_word());
}

static void test_the_longest_text_fits_the_size_that_is_promised(void)
{
    char text[4096];
    size_t longest = 0;
    memset(bus.config.axes[0].name, 'n', CM1E_NAME_LENGTH - 1);
    for (int error = -1; cm1e_error_from_id(cm1e_error_id((cm1e_error_t)error)) == error; error--)
        for (int status = 0; status < 0x100; status++)
            for (int shown = 0; shown < 128; shown += shown == 8 ? 93 : shown == 101 ? 19 : 1) {
                drive.fault = (cm1e_drive_fault_t){.error = (cm1e_error_t)error, .statusword = 0xFFFF,
                                                   .mode_commanded = 8, .mode_shown = (int8_t)shown, .al_state = 0x14,
                                                   .al_status_code = 0x001B, .motor_status = (uint8_t)status,
                                                   .motor_status_known = true};
                cm1e_drive_fault_text(&drive, text, sizeof text);
                longest = strlen(text) > longest ? strlen(text) : longest;
            }
    TEST_ASSERT_GREATER_THAN_size_t(400, longest);
    TEST_ASSERT_LESS_THAN_size_t(1024 - 90, longest);
    drive.fault = (cm1e_drive_fault_t){0};
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_the_configuration_has_to_state);
    RUN_TEST(test_an_object_that_is_not_mapped_is_named_by_its_index_on_the_channel);
    RUN_TEST(test_a_bridge_found_in_a_dead_end_is_an_error_that_says_so);
    RUN_TEST(test_a_bridge_found_in_hm_or_cml_is_brought_to_csp);
    RUN_TEST(test_a_bridge_found_in_cml_is_enabled_from_the_first_cycle_on);
    RUN_TEST(test_every_channel_of_every_model_is_enabled_without_moving_and_follows);
    RUN_TEST(test_the_way_from_every_state_has_one_command_a_cycle);
    RUN_TEST(test_enabling_survives_a_lost_frame_at_every_cycle);
    RUN_TEST(test_a_motor_that_stays_free_is_not_enabled);
    RUN_TEST(test_a_cm1_holds_from_power_on_until_it_was_enabled_once);
    RUN_TEST(test_motor_free_while_enabled_is_a_loss);
    RUN_TEST(test_every_statusword_in_csp_leaves_a_defined_output);
    RUN_TEST(test_every_statusword_in_cpio);
    RUN_TEST(test_no_statusword_in_cmd_is_a_state_or_a_fault);
    RUN_TEST(test_cpio_has_outputs_and_positions_in_its_words);
    RUN_TEST(test_cpio_has_no_fault_reset_and_says_so);
    RUN_TEST(test_errors_of_the_motor_are_told_in_its_own_words);
    RUN_TEST(test_a_status_that_cannot_be_read_is_asked_for_three_times);
    RUN_TEST(test_an_error_that_stays_is_a_reset_timeout);
    RUN_TEST(test_a_target_beyond_k37_is_never_written);
    RUN_TEST(test_a_motor_beyond_k37_is_not_enabled);
    RUN_TEST(test_a_new_origin_is_no_velocity);
    RUN_TEST(test_a_slave_that_left_takes_the_torque_with_it);
    RUN_TEST(test_the_longest_text_fits_the_size_that_is_promised);
    return UNITY_END();
}
