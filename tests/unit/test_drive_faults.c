/* Latching of faults, what the drive writes then, fault reset, and the words for it. */
#include <stdlib.h>
#include <string.h>

#include "cm1e/axis.h"
#include "drive/drive.h"
#include "unity.h"

#include "../support/fake_bus.h"

static const int64_t cycle_ns = 1000000;
static cm1e_bus_t bus;
static cm1e_drive_t drive;
static cm1e_diag_t diag;
static bool bus_ok;

void tearDown(void) {}

static void cycle(void)
{
    fake_bus_cycle(&bus, cycle_ns);
    cm1e_drive_read(&drive, bus_ok, bus.clock.virtual_now_ns);
    cm1e_drive_write(&drive);
}

static void cycles(int n)
{
    while (n-- > 0)
        cycle();
}

static void start(cm1e_firmware_t firmware)
{
    bus_ok = true;
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, firmware);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
    fake_bus_show(&bus);
    cycles(2);
}

void setUp(void) { start(CM1E_FIRMWARE_1_3_5); }

static void enable(void)
{
    drive.command.enable = true;
    cycles(10);
    TEST_ASSERT_TRUE(drive.feedback.enabled);
    drive.command.target_position = drive.feedback.position;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
}

/* Shutdown does not lead out of Quick stop active, but Disable voltage does. */
static uint16_t no_torque_word(void) { return drive.feedback.state == QUICK_STOP_ACTIVE ? 0x0000 : 0x0006; }

static void assert_no_torque_commanded(void)
{
    TEST_ASSERT_EQUAL_HEX16(no_torque_word(), fake_output(&bus, 0x6040, 0));
    TEST_ASSERT_EQUAL_INT32(drive.feedback.position, fake_output(&bus, 0x607A, 0));
    TEST_ASSERT_EQUAL_INT32(0, fake_output(&bus, 0x60FF, 1));
    TEST_ASSERT_FALSE(drive.feedback.enabled);
}

static void assert_text_has(const char *part)
{
    char text[1024];
    cm1e_drive_fault_text(&drive, text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, part), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "slide"), text);
    TEST_ASSERT_TRUE_MESSAGE(drive.fault.keeps_torque || !strstr(text, "still has torque"), text);
}

static bool reset(int at_most)
{
    drive.command.reset = true;
    do {
        cycle();
        drive.command.reset = false;
    } while (cm1e_drive_resetting(&drive) && at_most-- > 0);
    TEST_ASSERT_FALSE(cm1e_drive_resetting(&drive));
    return drive.fault.error == CM1E_OK;
}

static void test_every_fault_code_is_latched_with_its_cause(void)
{
    for (size_t i = 0; i < cm1e_device_error_count; i++) {
        const cm1e_device_error_t *e = &cm1e_device_errors[i];
        if (!e->fault)
            continue;
        start(CM1E_FIRMWARE_1_3_3);
        enable();
        fake_bus_fault(&bus, e->code);
        cycle();
        TEST_ASSERT_EQUAL_INT(e->code == 0xFF05 ? CM1E_ERROR_DRIVE_POWER : CM1E_ERROR_DRIVE_FAULT, drive.fault.error);
        TEST_ASSERT_EQUAL_HEX16(e->code, drive.fault.device_code);
        assert_no_torque_commanded();
        assert_text_has(e->text);
        assert_text_has(e->cure);
        assert_text_has("MC_Reset");
    }
}

static void test_codes_without_fault_bit_are_no_fault(void)
{
    enable();
    for (size_t i = 0; i < cm1e_device_error_count; i++) {
        bus.error_code = cm1e_device_errors[i].code;
        cycle();
        TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
        TEST_ASSERT_TRUE(drive.feedback.enabled);
    }
}

static void test_fault_while_disabled_is_latched_and_cleared_by_reset(void)
{
    fake_bus_fault(&bus, 0x4310);
    cycles(5);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_FAULT, drive.fault.error);
    TEST_ASSERT_EQUAL_UINT(0, bus.reset_edges);
    TEST_ASSERT_TRUE(reset(100));
    TEST_ASSERT_EQUAL_UINT(1, bus.reset_edges);
}

static void test_fault_blocks_enable_until_reset(void)
{
    enable();
    fake_bus_fault(&bus, 0x7320);
    cycles(3);
    bus.state = READY_TO_SWITCH_ON; /* the fault goes by itself: that is no permission */
    bus.error_code = 0;
    for (int i = 0; i < 50; i++) {
        drive.command.enable = i % 3 != 0;
        cycle();
        assert_no_torque_commanded();
    }
    drive.command.enable = false;
    TEST_ASSERT_TRUE(reset(10));
    TEST_ASSERT_EQUAL_UINT(0, bus.reset_edges); /* nothing was there to clear */
    enable();
}

static void test_motor_power_lost_while_enabled(void)
{
    enable();
    bus.frozen = true; /* the device shows the lost power before its fault */
    bus.power = false;
    cycle();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_POWER, drive.fault.error);
    assert_no_torque_commanded();
    fake_bus_fault(&bus, 0xFF05);
    cycle();
    TEST_ASSERT_EQUAL_HEX16(0xFF05, drive.fault.device_code); /* a detail that came later */
    assert_text_has("24 V");
}

/* On the way up the motor may have power without torque; on the way down it may have lost its torque with the power. */
static void test_motor_power_lost_in_the_cycle_of_another_state(void)
{
    drive.command.enable = true;
    for (int i = 0; i < 10 && drive.feedback.state != SWITCHED_ON; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT(SWITCHED_ON, drive.feedback.state);
    bus.frozen = true;
    bus.power = false;
    cycle();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_POWER, drive.fault.error);

    start(CM1E_FIRMWARE_1_3_5);
    enable();
    bus.frozen = true;
    bus.power = false;
    bus.state = READY_TO_SWITCH_ON;
    cycle();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_POWER, drive.fault.error);
}

/* The first code tells the cause. A code without the fault bit is one of an earlier fault. */
static void test_the_code_of_the_device_is_the_first_one_of_a_fault(void)
{
    enable();
    fake_bus_fault(&bus, 0x4310);
    cycle();
    bus.error_code = 0x7320;
    cycle();
    TEST_ASSERT_EQUAL_HEX16(0x4310, drive.fault.device_code);

    start(CM1E_FIRMWARE_1_3_5);
    enable();
    bus.frozen = true;
    bus.state = READY_TO_SWITCH_ON;
    bus.error_code = 0x4310;
    cycles(2);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_ENABLE_LOST, drive.fault.error);
    TEST_ASSERT_EQUAL_HEX16(0, drive.fault.device_code);
}

static void test_a_latched_fault_collects_what_comes_later(void)
{
    enable();
    bus.frozen = true;
    bus.state = READY_TO_SWITCH_ON;
    cycle();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_ENABLE_LOST, drive.fault.error);
    TEST_ASSERT_FALSE(drive.fault.slave_absent);
    cycles(3);
    bus.watch.silent = true;
    cycle();
    TEST_ASSERT_TRUE(drive.feedback.online);
    TEST_ASSERT_TRUE(drive.fault.slave_absent);
}

static void test_enable_without_motor_power_waits_then_says_so(void)
{
    bus.power = false;
    drive.command.enable = true;
    cycles(1000);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    TEST_ASSERT_EQUAL_HEX16(0x0006, fake_output(&bus, 0x6040, 0)); /* 0x0007 would make the drive fault */
    cycles(1100);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_POWER, drive.fault.error);
    TEST_ASSERT_EQUAL_INT(READY_TO_SWITCH_ON, bus.state);
}

static void test_motor_power_coming_late_still_enables(void)
{
    bus.power = false;
    drive.command.enable = true;
    cycles(500);
    bus.power = true;
    cycles(10);
    TEST_ASSERT_TRUE(drive.feedback.enabled);
}

static void test_enable_timeout(void)
{
    bus.frozen = true;
    drive.command.enable = true;
    cycles(2000);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    cycle(); /* 2 s after the first one */
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_ENABLE_TIMEOUT, drive.fault.error);
    assert_no_torque_commanded();
    assert_text_has("Ready to switch on");
}

static void test_enable_lost(void)
{
    static const cm1e_fsa_state_t states[] = {NOT_READY_TO_SWITCH_ON, SWITCH_ON_DISABLED, READY_TO_SWITCH_ON,
                                              SWITCHED_ON, QUICK_STOP_ACTIVE};
    for (size_t i = 0; i < sizeof states / sizeof states[0]; i++) {
        start(CM1E_FIRMWARE_1_3_5);
        enable();
        bus.frozen = true;
        bus.state = states[i];
        cycle();
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_ENABLE_LOST, drive.fault.error);
        assert_no_torque_commanded();
        TEST_ASSERT_FALSE(drive.command.enable && drive.torque.asked);
    }
}

/** A drive that does not obey when its torque is taken away. `wanted`: it is wanted again later. */
static void keep_torque(cm1e_fsa_state_t state, bool wanted)
{
    start(CM1E_FIRMWARE_1_3_5);
    enable();
    drive.command.enable = false;
    bus.frozen = true;
    cycles(2);
    bus.state = state;
    cycles(30);
    drive.command.enable = wanted;
}

/** Nobody waits for ever, whether the torque is wanted again or not. What the drive does by itself has its time. */
static void test_a_drive_that_keeps_its_torque_is_told(void)
{
    static const cm1e_fsa_state_t states[] = {OPERATION_ENABLED, QUICK_STOP_ACTIVE};
    for (int i = 0; i < 4; i++) {
        keep_torque(states[i / 2], i % 2);
        cycles(1900);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
        cycles(150);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_KEEPS_TORQUE, drive.fault.error);
        assert_no_torque_commanded();
        assert_text_has(i / 2 ? "Quick stop active" : "Operation enabled");
        assert_text_has("Cut its motor power");
        drive.command.enable = false;
        TEST_ASSERT_TRUE(reset(3000));
        TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
        cycles(2100); /* it is told again */
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_KEEPS_TORQUE, drive.fault.error);
        bus.frozen = false;
        TEST_ASSERT_TRUE(reset(3000));
        cycles(2100);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
        enable();
    }
}

static void brake_slowly(cm1e_bus_t *motor) { motor->velocity_raw = 1000000; }

/** A drive on a ramp of its own has ten seconds. */
static void test_a_drive_that_still_brakes_keeps_its_torque_for_ten_seconds_more(void)
{
    keep_torque(QUICK_STOP_ACTIVE, true);
    bus.world = brake_slowly;
    cycles(9900);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    cycles(2200);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_KEEPS_TORQUE, drive.fault.error);
}

/** Another cause came first: the text has both. */
static void test_torque_that_stays_behind_another_fault_is_in_the_text(void)
{
    start(CM1E_FIRMWARE_1_3_5);
    enable();
    bus.frozen = true;
    bus.state = QUICK_STOP_ACTIVE;
    cycles(2100);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_ENABLE_LOST, drive.fault.error);
    assert_text_has("quick stop by itself");
    assert_text_has("still has torque");
}

static void test_mode_lost(void)
{
    enable();
    bus.frozen = true;
    bus.mode = CM1E_MODE_PV;
    cycle();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_MODE_LOST, drive.fault.error);
    assert_no_torque_commanded();
    assert_text_has("CSP");
    assert_text_has("PV");
}

static void test_mode_timeout_while_enabled_and_while_enabling(void)
{
    enable();
    bus.frozen = true;
    drive.command.mode = CM1E_MODE_HM;
    cycles(1000);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    TEST_ASSERT_FALSE(drive.feedback.enabled);
    cycle(); /* 1 s after the first one */
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_MODE_TIMEOUT, drive.fault.error);

    start(CM1E_FIRMWARE_1_3_5);
    bus.mode_delay = bus.mode_wait = 100000;
    drive.command.enable = true;
    drive.command.mode = CM1E_MODE_HM;
    cycles(2100);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_MODE_TIMEOUT, drive.fault.error);
    TEST_ASSERT_EQUAL_INT(READY_TO_SWITCH_ON, bus.state); /* no torque in the wrong mode meanwhile */
}

static void test_slave_lost_or_out_of_operational(void)
{
    static const struct {
        cm1e_slave_watch_t watch;
        cm1e_error_t error;
        const char *text;
    } rows[] = {
        {{.al_state = CM1E_AL_SAFE_OP | CM1E_AL_ERROR, .al_status_code = 0x001B}, CM1E_ERROR_BUS_STATE, "0x001B"},
        {{.al_state = CM1E_AL_INIT}, CM1E_ERROR_BUS_STATE, "state 1"},
        {{.al_state = CM1E_AL_OP, .lost = true}, CM1E_ERROR_AXIS_OFFLINE, "does not answer"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        for (int ok = 0; ok < 2; ok++) {
            start(CM1E_FIRMWARE_1_3_5);
            enable();
            bus.watch = rows[i].watch;
            bus_ok = ok;
            cycle();
            TEST_ASSERT_EQUAL_INT(rows[i].error, drive.fault.error);
            TEST_ASSERT_FALSE(drive.feedback.online);
            assert_no_torque_commanded();
            assert_text_has(rows[i].text);
        }
}

static void test_bus_lost_holds_the_target_under_torque_then_disables(void)
{
    enable();
    const int32_t held = (int32_t)fake_output(&bus, 0x607A, 0);
    bus_ok = false;
    cm1e_drive_fail(&drive, CM1E_ERROR_BUS_LOST);
    drive.command.target_position += 100;
    cycle();
    TEST_ASSERT_EQUAL_HEX16(0x000F, fake_output(&bus, 0x6040, 0));
    TEST_ASSERT_EQUAL_INT32(held, fake_output(&bus, 0x607A, 0));
    drive.command.enable = false;
    cycle();
    TEST_ASSERT_EQUAL_HEX16(0x0006, fake_output(&bus, 0x6040, 0));
    drive.command.enable = true; /* and never again before a reset, also when the bus is back */
    bus_ok = true;
    cycles(20);
    assert_no_torque_commanded();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUS_LOST, drive.fault.error);
    bus.counters.unsent_frames = 7;
    assert_text_has("did not take 7 frames");
    bus.watch.al_state = CM1E_AL_SAFE_OP; /* what the supervision finds out later is kept beside it */
    bus.watch.al_status_code = 0x001B;
    cycle();
    TEST_ASSERT_EQUAL_HEX16(0x001B, drive.fault.al_status_code);
    assert_text_has("0x001B");
    bus.watch.lost = true;
    cycle();
    assert_text_has("does not answer");
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUS_LOST, drive.fault.error);
}

/* One sign is enough: the slave does not answer at its address, or it gives no inputs while others do. */
static void test_a_slave_that_took_no_part_in_the_cycle_is_kept_in_mind(void)
{
    for (int lost = 0; lost < 2; lost++) {
        setUp();
        enable();
        bus.watch.lost = lost;
        bus.watch.silent = !lost;
        bus_ok = false;
        cycle();
        cm1e_drive_fail(&drive, CM1E_ERROR_BUS_WORKING_COUNTER);
        TEST_ASSERT_TRUE(drive.fault.slave_absent);
        TEST_ASSERT_EQUAL(lost, drive.fault.slave_lost);
        bus.watch.lost = bus.watch.silent = false; /* and stays so */
        cycle();
        TEST_ASSERT_TRUE(drive.fault.slave_absent);
    }
}

/* While the working counter is wrong and then the bus is lost, nothing shows that the slave hears again. */
static void test_a_bus_lost_after_a_wrong_working_counter_leaves_no_sign_of_the_slave(void)
{
    static const struct {
        cm1e_error_t first, then;
        bool deaf;
    } rows[] = {
        {CM1E_ERROR_BUS_WORKING_COUNTER, CM1E_ERROR_BUS_LOST, true},
        {CM1E_ERROR_BUS_WORKING_COUNTER, CM1E_ERROR_BUS_WORKING_COUNTER, false},
        {CM1E_ERROR_BUS_LOST, CM1E_ERROR_BUS_LOST, false},
        {CM1E_ERROR_BUS_LOST, CM1E_ERROR_BUS_WORKING_COUNTER, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        enable();
        cm1e_drive_fail(&drive, rows[i].first);
        TEST_ASSERT_FALSE(drive.fault.slave_absent);
        cm1e_drive_fail(&drive, rows[i].then);
        TEST_ASSERT_EQUAL(rows[i].deaf, drive.fault.slave_absent);
    }
}

static void test_a_reset_asks_for_a_slave_that_left_operational_once_a_second(void)
{
    enable();
    bus.watch.al_state = CM1E_AL_SAFE_OP;
    cycles(3);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUS_STATE, drive.fault.error);
    TEST_ASSERT_EQUAL_UINT(0, bus.recoveries);
    drive.command.reset = true;
    cycles(900);
    TEST_ASSERT_EQUAL_UINT(1, bus.recoveries);
    cycles(200);
    TEST_ASSERT_EQUAL_UINT(2, bus.recoveries);
}

static void test_reset_is_one_bounded_edge(void)
{
    bus.fault_stays = true;
    fake_bus_fault(&bus, 0x2310);
    cycles(3);
    drive.command.reset = true;
    int set = 0, edges = 0;
    bool before = false;
    for (int i = 0; i < 4000; i++) {
        cycle();
        const bool bit = fake_output(&bus, 0x6040, 0) & CONTROLWORD_FAULT_RESET;
        set += bit;
        edges += bit && !before;
        before = bit;
    }
    TEST_ASSERT_FALSE(cm1e_drive_resetting(&drive));
    TEST_ASSERT_EQUAL_INT(1, edges);
    TEST_ASSERT_INT_WITHIN(2, 20, set);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_RESET_TIMEOUT, drive.fault.error);
    TEST_ASSERT_EQUAL_HEX16(0x2310, drive.fault.device_code);
    assert_text_has("torque overload");
    drive.command.reset = false; /* a new command is a new edge */
    cycle();
    bus.fault_stays = false;
    TEST_ASSERT_TRUE(reset(100));
}

static void test_reset_survives_a_lost_frame_at_every_cycle(void)
{
    for (int lost = 0; lost < 12; lost++) {
        start(CM1E_FIRMWARE_1_3_3);
        fake_bus_fault(&bus, 0x2310);
        cycles(3);
        drive.command.reset = true;
        for (int i = 0; i < 60; i++) {
            bus_ok = i != lost;
            cycle();
        }
        TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
        TEST_ASSERT_EQUAL_UINT(1, bus.reset_edges);
        bus_ok = true;
    }
}

/* V1.3.5 and a power-up 0x7510: the device leaves the bus after the edge and comes back. */
static void reset_with_restart(int away_cycles, bool fault_returns)
{
    fake_bus_fault(&bus, 0x7510);
    cycles(3);
    drive.command.reset = true;
    cycles(5);
    TEST_ASSERT_EQUAL_UINT(1, bus.reset_edges);
    TEST_ASSERT_TRUE(cm1e_drive_resetting(&drive)); /* the fault bit is gone, but the device is about to go, too */
    bus.watch = (cm1e_slave_watch_t){.lost = true};
    bus_ok = false;
    for (int i = 0; i < away_cycles && cm1e_drive_resetting(&drive); i++) {
        cycle();
        TEST_ASSERT_EQUAL_HEX16(0x0006, fake_output(&bus, 0x6040, 0));
    }
    if (!cm1e_drive_resetting(&drive))
        return;
    TEST_ASSERT_GREATER_THAN_UINT(0, bus.recoveries);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(1 + away_cycles / 1000, bus.recoveries);
    bus.watch = (cm1e_slave_watch_t){.al_state = CM1E_AL_OP};
    bus_ok = true;
    if (fault_returns)
        fake_bus_fault(&bus, 0x7510);
    cycles(11000);
}

static void test_reset_of_a_restarting_device_waits_for_it(void)
{
    reset_with_restart(3000, false);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    TEST_ASSERT_EQUAL_UINT(1, bus.reset_edges);
}

static void test_reset_of_a_restarting_device_gives_up(void)
{
    reset_with_restart(3000, true);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_RESET_TIMEOUT, drive.fault.error);
    TEST_ASSERT_EQUAL_UINT(1, bus.reset_edges); /* never a second restart */
    start(CM1E_FIRMWARE_1_3_5);
    reset_with_restart(12000, false);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_OFFLINE, drive.fault.error);
}

static void test_reset_while_the_bus_is_away_keeps_the_cause(void)
{
    enable();
    bus_ok = false;
    cm1e_drive_fail(&drive, CM1E_ERROR_BUS_WORKING_COUNTER);
    drive.command.enable = false;
    cycles(5);
    TEST_ASSERT_FALSE(reset(11000));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUS_WORKING_COUNTER, drive.fault.error);
    bus_ok = true;
    TEST_ASSERT_TRUE(reset(10));
}

static void test_reset_with_enable_held_enables_again_without_a_jump(void)
{
    enable();
    fake_bus_fault(&bus, 0x2310);
    cycles(3);
    bus.position = 777777;
    bus.torque_step = 0;
    drive.command.target_position = 5;
    drive.command.reset = true;
    for (int i = 0; i < 50 && !drive.feedback.enabled; i++) {
        cm1e_drive_write(&drive);
        fake_bus_cycle(&bus, cycle_ns);
        cm1e_drive_read(&drive, true, bus.clock.virtual_now_ns);
    }
    TEST_ASSERT_TRUE(drive.feedback.enabled);
    TEST_ASSERT_EQUAL_INT64(0, bus.torque_step);
}

static void test_every_status_word_leaves_a_defined_output(void)
{
    for (uint32_t word = 0; word <= 0xFFFF; word++) {
        start(CM1E_FIRMWARE_1_3_5);
        enable();
        fake_input(&bus, OBJ_6041_STATUSWORD, word);
        cm1e_drive_read(&drive, true, bus.clock.virtual_now_ns + 1);
        cm1e_drive_write(&drive);
        const bool good = cm1e_fsa_decode((uint16_t)word) == OPERATION_ENABLED && (word & STATUSWORD_VOLTAGE_ENABLED);
        TEST_ASSERT_EQUAL_INT(good, drive.feedback.enabled);
        TEST_ASSERT_EQUAL_INT(good, drive.fault.error == CM1E_OK);
        TEST_ASSERT_EQUAL_HEX16(good ? 0x000F : no_torque_word(), fake_output(&bus, 0x6040, 0));
    }
}

static void test_text_fits_any_buffer_and_is_empty_without_fault(void)
{
    char text[256];
    cm1e_drive_fault_text(&drive, text, sizeof text);
    TEST_ASSERT_EQUAL_STRING("", text);
    fake_bus_fault(&bus, 0x1234); /* not in the manual */
    cycles(3);
    assert_text_has("0x1234");
    cm1e_drive_fault_text(&drive, text, sizeof text);
    const size_t whole = strlen(text);
    for (size_t size = 0; size < sizeof text; size++) {
        memset(text, 'x', sizeof text);
        cm1e_drive_fault_text(&drive, text, size);
        if (size)
            TEST_ASSERT_EQUAL_size_t(size - 1 < whole ? size - 1 : whole, strlen(text));
        TEST_ASSERT_EQUAL_INT('x', text[size]);
    }
}

/** The fake's text of an AL status code is shorter than the longest real one (83 characters). */
static void test_another_master_is_told_where_one_was_seen(void)
{
    fake_bus_fault(&bus, 0x4310);
    cycle();
    char text[1024];
    cm1e_drive_fault_text(&drive, text, sizeof text);
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "Another master"), text);
    bus.counters.foreign_frames = 1;
    assert_text_has("Another master sends on this network: 1 of its frames");
}

static void test_longest_text_fits_the_size_that_is_promised(void)
{
    enum { LONGER_AL_TEXT = 90 };
    char text[2 * CM1E_AXIS_ERROR_TEXT_BYTES];
    size_t longest = 0;
    memset(bus.config.axes[0].name, 'n', CM1E_NAME_LENGTH - 1);
    for (int error = -1; cm1e_error_from_id(cm1e_error_id((cm1e_error_t)error)) == error; error--)
        for (size_t i = 0; i < cm1e_device_error_count; i++) {
            drive.fault = (cm1e_drive_fault_t){.error = (cm1e_error_t)error,
                                               .device_code = cm1e_device_errors[i].code, .statusword = 0xFFFF,
                                               .mode_commanded = 8, .mode_shown = -100, .al_state = 0x14,
                                               .al_status_code = 0x001B, .keeps_torque = true};
            cm1e_drive_fault_text(&drive, text, sizeof text);
            longest = strlen(text) > longest ? strlen(text) : longest;
            TEST_ASSERT_EQUAL_STRING("reset the axis with MC_Reset.", strstr(text, "reset the axis"));
        }
    TEST_ASSERT_GREATER_THAN_size_t(512, longest);
    TEST_ASSERT_LESS_THAN_size_t(CM1E_AXIS_ERROR_TEXT_BYTES - LONGER_AL_TEXT, longest);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_fault_code_is_latched_with_its_cause);
    RUN_TEST(test_codes_without_fault_bit_are_no_fault);
    RUN_TEST(test_fault_while_disabled_is_latched_and_cleared_by_reset);
    RUN_TEST(test_fault_blocks_enable_until_reset);
    RUN_TEST(test_motor_power_lost_while_enabled);
    RUN_TEST(test_motor_power_lost_in_the_cycle_of_another_state);
    RUN_TEST(test_the_code_of_the_device_is_the_first_one_of_a_fault);
    RUN_TEST(test_a_latched_fault_collects_what_comes_later);
    RUN_TEST(test_enable_without_motor_power_waits_then_says_so);
    RUN_TEST(test_motor_power_coming_late_still_enables);
    RUN_TEST(test_enable_timeout);
    RUN_TEST(test_enable_lost);
    RUN_TEST(test_a_drive_that_keeps_its_torque_is_told);
    RUN_TEST(test_a_drive_that_still_brakes_keeps_its_torque_for_ten_seconds_more);
    RUN_TEST(test_torque_that_stays_behind_another_fault_is_in_the_text);
    RUN_TEST(test_mode_lost);
    RUN_TEST(test_mode_timeout_while_enabled_and_while_enabling);
    RUN_TEST(test_slave_lost_or_out_of_operational);
    RUN_TEST(test_bus_lost_holds_the_target_under_torque_then_disables);
    RUN_TEST(test_a_slave_that_took_no_part_in_the_cycle_is_kept_in_mind);
    RUN_TEST(test_a_bus_lost_after_a_wrong_working_counter_leaves_no_sign_of_the_slave);
    RUN_TEST(test_a_reset_asks_for_a_slave_that_left_operational_once_a_second);
    RUN_TEST(test_reset_is_one_bounded_edge);
    RUN_TEST(test_reset_survives_a_lost_frame_at_every_cycle);
    RUN_TEST(test_reset_of_a_restarting_device_waits_for_it);
    RUN_TEST(test_reset_of_a_restarting_device_gives_up);
    RUN_TEST(test_reset_while_the_bus_is_away_keeps_the_cause);
    RUN_TEST(test_reset_with_enable_held_enables_again_without_a_jump);
    RUN_TEST(test_every_status_word_leaves_a_defined_output);
    RUN_TEST(test_another_master_is_told_where_one_was_seen);
    RUN_TEST(test_longest_text_fits_the_size_that_is_promised);
    RUN_TEST(test_text_fits_any_buffer_and_is_empty_without_fault);
    return UNITY_END();
}
