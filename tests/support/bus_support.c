#include "bus_support.h"

#include "description/sii_image.h"
#include "nic/frame.h"
#include "sim/esc_chip.h"

cm1e_bus_config_t config;
cm1e_diag_t diag;

const char *tested_firmware(void)
{
    const char *firmware = getenv("CM1E_TEST_FIRMWARE");
    return firmware ? firmware : "1.3.5";
}

cm1e_pdo_order_t tested_order(void)
{
    const char *order = getenv("CM1E_TEST_PDO_ORDER");
    return order && strcmp(order, "ug-7.2") == 0 ? CM1E_PDO_ORDER_UG_7_2 : CM1E_PDO_ORDER_UG_4_4;
}

cm1e_bus_config_t *sim_config(uint32_t axes)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", axes);
    config.virtual_time = true;
    config.sim_pdo_order = tested_order();
    for (uint32_t i = 0; i < axes; i++)
        snprintf(config.axes[i].firmware, sizeof config.axes[i].firmware, "%s", tested_firmware());
    return &config;
}

cm1e_bus_t *open_bus(void)
{
    cm1e_bus_t *bus = NULL;
    memset(&diag, 0, sizeof diag);
    ck_assert_msg(cm1e_bus_open(&bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

cm1e_bus_t *open_scanned_bus(uint32_t axes)
{
    sim_config(axes);
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

cm1e_sim_segment_t *segment_of(cm1e_bus_t *bus) { return cm1e_bus_segment(bus); }

uint8_t *register_memory_of(cm1e_bus_t *bus, uint32_t position)
{
    return cm1e_sim_segment_slave(segment_of(bus), position)->memory;
}

uint8_t *sii_memory_of(cm1e_bus_t *bus, uint32_t position)
{
    return cm1e_sim_segment_slave(segment_of(bus), position)->sii;
}

void forget_lrw(cm1e_bus_t *bus, uint32_t position)
{
    enum { GENERAL = 30, AT_FLAGS = 11, NO_LRW = 2 };
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(segment_of(bus), position);
    cm1e_sii_category_t category = {0};
    size_t at = CM1E_SII_HEADER_BYTES;
    while (cm1e_sii_category_at(&category, slave->sii, slave->sii_size, at) && category.type != GENERAL)
        at = category.start + category.bytes;
    ck_assert_uint_eq(category.type, GENERAL);
    slave->sii[category.start + AT_FLAGS] |= NO_LRW;
}

cm1e_bus_t *open_bus_on(const cm1e_bus_config_t *segment_config)
{
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create(segment_config, &diag);
    ck_assert_msg(segment != NULL, "%s", diag.text);
    cm1e_sim_replace_segment(cm1e_bus_nic(bus), segment);
    return bus;
}

cm1e_bus_t *start_bus(void)
{
    cm1e_bus_t *bus = open_bus();
    const cm1e_error_t error = cm1e_bus_start(bus, &diag);
    ck_assert_msg(error == CM1E_OK, "%s: %s", cm1e_strerror(error), diag.text);
    return bus;
}

int64_t now_of(cm1e_bus_t *bus) { return cm1e_clock_now(cm1e_bus_clock(bus)); }

cm1e_error_t cycle(cm1e_bus_t *bus)
{
    const int64_t next_ns = now_of(bus) + cm1e_bus_configuration(bus)->cycle_time_ns;
    const cm1e_error_t error = cm1e_bus_receive(bus);
    cm1e_bus_send(bus);
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), next_ns);
    return error;
}

void cycles(cm1e_bus_t *bus, unsigned n)
{
    for (unsigned i = 0; i < n; i++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
}

void simulate(cm1e_bus_t *bus, const char *line)
{
    char answer[256] = "";
    ck_assert_msg(cm1e_bus_simulate(bus, line, answer, sizeof answer) == CM1E_OK, "%s: %s", line, answer);
}

int find_read(const cm1e_tap_frame_t *frame, uint16_t offset, uint16_t *station)
{
    enum { FPRD = 4 };
    datagram_t d = {.more = true};
    size_t at = FRAME_HEADER;
    for (int n = 0; d.more && cm1e_frame_datagram(frame->bytes, frame->length, &at, &d); n++)
        if (d.header[0] == FPRD && cm1e_get_u16(d.header + 4) == offset) {
            *station = cm1e_get_u16(d.header + 2);
            return n;
        }
    return -1;
}

unsigned finish_sdo(cm1e_bus_t *bus, const cm1e_sdo_t *sdo)
{
    unsigned n = 0;
    while (cm1e_sdo_state(sdo) == CM1E_SDO_BUSY) {
        cycle(bus);
        ck_assert_uint_lt(++n, 20000);
    }
    return n;
}

int run_suite(Suite *suite)
{
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
