/* A motor that is exchanged for another one while the others run. Nothing but its firmware tells the two from each other:
 * alias and serial number are 0, as they are delivered. The unit of velocities is that of the firmware that was there
 * at the start, so a motor whose firmware behaves in another way is not taken. */
#include "bus_support.h"
#include "cm1e/hot_connect.h"
#include "device/device.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

/** On the wire: a motor, the one that was there at the start, and the one that comes in its place. */
enum { OLD = 2, NEW = 3, EXCHANGED = 2 /* position */, COMES = 5000, ASK_EVERY = 200, ID = 7 };

static cm1e_bus_config_t wire;

static void describe(cm1e_bus_config_t *to, uint32_t axes, bool optional)
{
    cm1e_bus_config_free(to);
    cm1e_bus_config_init(to, "sim", axes);
    to->virtual_time = true;
    to->sim_pdo_order = tested_order();
    for (uint32_t i = 1; i < axes && optional; i++) {
        to->axes[i].address_kind = CM1E_ADDRESS_EXPLICIT_ID;
        to->axes[i].address = ID;
        to->axes[i].optional = to == &config;
    }
    for (uint32_t i = 0; i < axes; i++)
        snprintf(to->axes[i].firmware, sizeof to->axes[i].firmware, "%s", tested_firmware());
}

static cm1e_bus_t *start_machine(const char *old, const char *new, bool optional)
{
    describe(&config, 2, optional);
    describe(&wire, 3, optional);
    config.axes[1].firmware[0] = '\0';
    snprintf(wire.axes[1].firmware, sizeof wire.axes[1].firmware, "%s", old);
    snprintf(wire.axes[2].firmware, sizeof wire.axes[2].firmware, "%s", new);
    cm1e_bus_t *bus = open_bus_on(&wire);
    cm1e_sim_segment_detach(segment_of(bus), NEW, false);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, 20);
    return bus;
}

static uint8_t state_of(cm1e_bus_t *bus, uint32_t place)
{
    return cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(bus), place));
}

static void exchange(cm1e_bus_t *bus, uint32_t from, uint32_t to)
{
    cm1e_sim_segment_detach(segment_of(bus), from, false);
    for (int n = 0; n < 300; n++)
        cycle(bus);
    cm1e_sim_segment_attach(segment_of(bus), to);
}

/** Cycles in which somebody asks for the motor again and again; true: it is known to be in Operational. */
static bool comes(cm1e_bus_t *bus, uint32_t place)
{
    for (int n = 0; n < COMES; n++) {
        cycle(bus);
        if (n % ASK_EVERY == 0)
            cm1e_bus_request_recovery(bus, EXCHANGED);
        const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(bus, EXCHANGED);
        if (watch.al_state == CM1E_AL_OP && !watch.lost && state_of(bus, place) == CM1E_AL_OP)
            return true;
    }
    return false;
}

/** Each firmware of the tables in place of each other one. */
START_TEST(a_motor_with_another_firmware_is_not_taken)
{
    const bool optional = _i >= CM1E_FIRMWARE_COUNT * CM1E_FIRMWARE_COUNT;
    const int old = _i / CM1E_FIRMWARE_COUNT % CM1E_FIRMWARE_COUNT, new = _i % CM1E_FIRMWARE_COUNT;
    const char *const versions[] = {cm1e_firmware_info((cm1e_firmware_t)old)->version,
                                    cm1e_firmware_info((cm1e_firmware_t)new)->version};
    cm1e_bus_t *bus = start_machine(versions[0], versions[1], optional);
    exchange(bus, OLD, NEW);
    ck_assert_msg(comes(bus, NEW) == (old == new), "%s in place of %s", versions[1], versions[0]);
    if (old != new) {
        ck_assert_uint_le(state_of(bus, NEW), CM1E_AL_PRE_OP);
        exchange(bus, NEW, OLD);
        ck_assert_msg(comes(bus, OLD), "%s again", versions[0]);
    }
    cycles(bus, 20);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/** Another master gave it the address of ours, and it has kept its power. Its alias tells that it is another one. */
START_TEST(a_motor_with_our_address_and_another_alias_gives_it_back)
{
    enum { ALIAS = 5, FOUND = 1000 };
    const char *version = tested_firmware();
    cm1e_bus_t *bus = start_machine(version, version, false);
    uint8_t *memory = cm1e_sim_segment_slave(segment_of(bus), NEW)->memory;
    exchange(bus, OLD, NEW);
    for (int n = 0; n < FOUND && !cm1e_sim_esc_present(cm1e_sim_segment_slave(segment_of(bus), NEW)); n++)
        cycle(bus);
    cm1e_put_u16(memory + ESC_STATION_ADDRESS, 0x1002);
    cm1e_put_u16(memory + ESC_STATION_ALIAS, ALIAS);
    ck_assert(!comes(bus, NEW));
    ck_assert_uint_eq(cm1e_get_u16(memory + ESC_STATION_ADDRESS), 0);
    ck_assert_uint_eq(state_of(bus, NEW), CM1E_AL_INIT);
    exchange(bus, NEW, OLD);
    ck_assert(comes(bus, OLD));
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_exchanged");
    TCase *tests = tcase_create("exchanged");
    tcase_set_timeout(tests, 60);
    tcase_add_loop_test(tests, a_motor_with_another_firmware_is_not_taken, 0,
                        2 * CM1E_FIRMWARE_COUNT * CM1E_FIRMWARE_COUNT);
    tcase_add_test(tests, a_motor_with_our_address_and_another_alias_gives_it_back);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
