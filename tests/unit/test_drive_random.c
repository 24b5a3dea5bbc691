/* A device that says anything: whatever the inputs are, what the drive writes keeps its rules. */
#include "drive/drive.h"
#include "unity.h"

#include "../support/fake_bus.h"
#include "../support/seeds.h"
#include "../support/xorshift.h"

enum { CYCLES = 4000 };
static const int64_t cycle_ns = 1000000;
static cm1e_bus_t bus;
static cm1e_drive_t drive;

static uint64_t seed;
static unsigned number; /* of the run, from which the seed is made */

void setUp(void) {}
void tearDown(void)
{
    if (Unity.CurrentTestFailed)
        printf("it was seed %u\n", number);
}

static uint32_t draw(uint32_t below)
{
    return (uint32_t)(xorshift(&seed) >> 33) % below;
}

/* Mostly something near the truth, so that the drive gets far enough to be wrong. */
static void lie(void)
{
    if (draw(40) == 0)
        for (size_t i = 0; i < sizeof bus.inputs; i++)
            bus.inputs[i] = (uint8_t)draw(256);
    if (draw(60) == 0)
        fake_input(&bus, OBJ_6041_STATUSWORD, draw(0x10000));
    if (draw(60) == 0)
        fake_input(&bus, OBJ_6061_MODES_OF_OPERATION_DISPLAY, draw(256));
    if (draw(60) == 0)
        fake_input(&bus, OBJ_6064_POSITION_ACTUAL_VALUE, draw(UINT32_MAX));
    if (draw(200) == 0)
        fake_bus_fault(&bus, draw(2) ? cm1e_device_errors[draw((uint32_t)cm1e_device_error_count)].code
                                     : (uint16_t)draw(0x10000));
    if (draw(100) == 0)
        bus.power = draw(3) > 0;
    if (draw(200) == 0)
        bus.frozen = draw(3) == 0;
    if (draw(200) == 0)
        bus.watch = (cm1e_slave_watch_t){.al_state = draw(2) ? CM1E_AL_OP : (uint16_t)draw(32),
                                         .al_status_code = (uint16_t)draw(64), .lost = draw(4) == 0};
    else if (draw(50) == 0)
        bus.watch = (cm1e_slave_watch_t){.al_state = CM1E_AL_OP};
    bus.fault_stays = draw(5) == 0;
}

static void command(void)
{
    static const int modes[] = {0, 1, 3, 6, 8, 9, 8, 8, -1, 77};
    cm1e_drive_command_t *c = &drive.command;
    if (draw(30) == 0)
        c->enable = draw(4) > 0;
    if (draw(100) == 0)
        c->mode = (cm1e_mode_t)modes[draw(10)];
    c->reset = draw(20) == 0;
    c->homing_start = draw(3) > 0;
    c->halt = draw(10) == 0;
    c->target_position = draw(3) ? drive.feedback.position + (int32_t)draw(50) - 25 : (int32_t)draw(UINT32_MAX);
    c->target_velocity = (int32_t)draw(UINT32_MAX);
    if (draw(300) == 0)
        cm1e_drive_fail(&drive, draw(2) ? CM1E_ERROR_BUS_LOST : CM1E_ERROR_BUS_WORKING_COUNTER);
}

static unsigned reset_bit_cycles;
static int32_t target_before;

static void check(bool enabled_before)
{
    const cm1e_drive_feedback_t *f = &drive.feedback;
    const uint16_t word = (uint16_t)fake_output(&bus, OBJ_6040_CONTROLWORD, 0);
    const int32_t target = (int32_t)fake_output(&bus, OBJ_607A_TARGET_POSITION, (uint32_t)f->position);
    const int32_t velocity = (int32_t)fake_output(&bus, OBJ_60FF_TARGET_VELOCITY, 0);
    const bool torque = (word & 0x000F) == 0x000F || (word & 0x000F) == 0x0007;
    TEST_ASSERT_TRUE((word & 0x000F) == 0x0006 || (word & 0x000F) == 0x0007 || (word & 0x000F) == 0x000F ||
                     (word & 0x000F) == 0x0000);
    if (!drive.command.enable)
        TEST_ASSERT_FALSE(torque);
    const bool rampable = drive.fault.error == CM1E_ERROR_BUS_LOST ||
                          drive.fault.error == CM1E_ERROR_BUS_WORKING_COUNTER ||
                          drive.fault.error == CM1E_ERROR_DRIVE_POSITION;
    if (drive.fault.error && !rampable)
        TEST_ASSERT_FALSE(torque);
    if (torque && f->state != OPERATION_ENABLED) { /* on the way: actual position, no velocity, the right mode shown */
        TEST_ASSERT_EQUAL_INT32(f->position, target);
        TEST_ASSERT_EQUAL_INT32(0, velocity);
        TEST_ASSERT_EQUAL_INT8(drive.mode.commanded, f->mode);
        TEST_ASSERT_TRUE(f->voltage && f->online);
    }
    if (!f->enabled) { /* a target of the caller never passes: the actual one, or the one it is holding */
        TEST_ASSERT_TRUE(target == f->position || (target == target_before && f->state == OPERATION_ENABLED));
        TEST_ASSERT_EQUAL_INT32(0, velocity);
    } else {
        TEST_ASSERT_TRUE(enabled_before);
        TEST_ASSERT_EQUAL_INT(OPERATION_ENABLED, f->state);
    }
    reset_bit_cycles = word & CONTROLWORD_FAULT_RESET ? reset_bit_cycles + 1 : 0;
    TEST_ASSERT_LESS_OR_EQUAL_UINT(21, reset_bit_cycles);
    TEST_ASSERT_LESS_OR_EQUAL_INT32(2500000, velocity);
    TEST_ASSERT_GREATER_OR_EQUAL_INT32(-2500000, velocity);
    target_before = target;
}

static unsigned run(void)
{
    seed = UINT64_C(0x9E3779B97F4A7C15) * (number + 1);
    fake_bus_init(&bus, (cm1e_mapping_t)draw(4), (cm1e_pdo_order_t)draw(2), (cm1e_firmware_t)draw(CM1E_FIRMWARE_COUNT));
    bus.sdo_delay = draw(10);
    bus.mode_delay = draw(10);
    cm1e_diag_t diag;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
    fake_bus_show(&bus);
    unsigned enabled_cycles = 0;
    char text[300];
    reset_bit_cycles = 0;
    for (int i = 0; i < CYCLES; i++) {
        fake_bus_cycle(&bus, cycle_ns);
        lie();
        cm1e_drive_read(&drive, draw(20) > 0, bus.clock.virtual_now_ns);
        const bool enabled = drive.feedback.enabled;
        enabled_cycles += enabled;
        command();
        cm1e_drive_write(&drive);
        check(enabled);
        if (i % 50 == 0)
            cm1e_drive_fault_text(&drive, text, sizeof text);
    }
    return enabled_cycles;
}

static void test_any_inputs_keep_the_rules(void)
{
    unsigned enabled_cycles = 0;
    for (int i = 0; i < seeds_of(200); i++) {
        number = seed_of(i);
        enabled_cycles += run();
    }
    printf("%u of %d cycles enabled\n", enabled_cycles, seeds_of(200) * CYCLES);
    TEST_ASSERT_TRUE(seeds_given() || enabled_cycles > 20000); /* else the lies were too thick to test anything */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_any_inputs_keep_the_rules);
    return UNITY_END();
}
