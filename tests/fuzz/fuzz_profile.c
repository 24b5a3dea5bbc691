#include <string.h>

#include "cm1e/sim.h"
#include "fuzz_complain.h"
#include "prove/profile_file.h"
#include "sim/coe_server.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

/* Device profiles: what can be read is played by every device that plays profiles, whose objects are then read and
 * written, and whose process data goes both ways, as far as a homing. Nothing is written anew. */

enum { SLAVES = 3, IMAGE_BYTES = 4096, STEP_NS = 10000000, CYCLES_EACH = 6, CYCLES = 12 * CYCLES_EACH };

/** A CM1-E, a bridge with a motor, a drive by CiA 402. */
static cm1e_sim_segment_t *make_segment(void)
{
    cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    if (cm1e_bus_config_init(&config, "sim", SLAVES) != CM1E_OK)
        fuzz_fail("no memory");
    for (uint16_t i = 0; i < SLAVES; i++)
        config.axes[i].address = (uint16_t)(i + 1);
    config.axes[1].channel = 1;
    config.axes[1].k37 = 10;
    strcpy(config.axes[2].device, "cia402");
    config.axes[2].counts_per_revolution = 131072;
    config.axes[2].max_speed_rpm = 3000;
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create(&config, &diag);
    cm1e_bus_config_free(&config);
    if (!segment)
        fuzz_fail("no segment: %s", diag.text);
    return segment;
}

static void use_object(cm1e_sim_slave_t *slave, const cm1e_object_t *object)
{
    uint8_t data[256];
    for (uint16_t i = 0; i < object->entry_count; i++) {
        const cm1e_entry_t *entry = &object->entries[i];
        size_t size = sizeof data;
        const uint32_t code = cm1e_sim_coe_read(slave, entry->index, entry->subindex, false, data, &size);
        if (code == 0 && size > sizeof data)
            fuzz_fail("object 0x%04X has %zu bytes", entry->index, size);
        if (code == 0)
            slave->ops->sdo_write(slave->app, entry->index, entry->subindex, 2, data, size);
    }
}

/** In the middle the watchdog of the process data ends, as if outputs had stayed away. */
static void use(cm1e_sim_slave_t *slave)
{
    static const uint16_t controlwords[] = {0, 0x06, 0x07, 0x0F, 0x0F, 0x1F, 0x1F, 0x0F, 0x0F, 0x1F, 0x0F, 0};
    static uint8_t image[IMAGE_BYTES];
    const uint8_t homing = 6;
    uint16_t outputs, inputs;
    const cm1e_object_t *object;
    for (size_t n = 0; (object = slave->ops->object(slave->app, n)) != NULL; n++)
        use_object(slave, object);
    slave->ops->process_data_sizes(slave->app, &outputs, &inputs);
    if (outputs > IMAGE_BYTES || inputs > IMAGE_BYTES)
        fuzz_fail("%u and %u bytes of process data", outputs, inputs);
    slave->ops->sdo_write(slave->app, 0x6060, 0, 2, &homing, sizeof homing);
    for (int cycle = 0; cycle < CYCLES; cycle++) {
        const uint16_t word = controlwords[cycle / CYCLES_EACH];
        for (int i = 0; i < IMAGE_BYTES; i++) /* in whichever place the controlword is */
            image[i] = (uint8_t)(i % 2 ? word >> 8 : word);
        slave->ops->outputs(slave->app, image, outputs, cycle * STEP_NS);
        slave->ops->advance(slave->app, cycle * STEP_NS);
        slave->ops->inputs(slave->app, image, inputs);
        if (cycle == CYCLES / 2 && slave->ops->watchdog_expired)
            slave->ops->watchdog_expired(slave->app);
    }
}

static void ask_console(cm1e_sim_segment_t *segment, uint32_t position)
{
    static char answer[4096];
    char show[20];
    snprintf(show, sizeof show, "show %u", (unsigned)position);
    cm1e_sim_console(segment, show, answer, sizeof answer);
    cm1e_sim_console(segment, "status", answer, sizeof answer);
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    (void)written, (void)must;
    const unsigned before = complaints;
    profile_file_t *file = profile_file_read("profile", bytes, size);
    if (!file && complaints == before)
        fuzz_fail("a file is refused without a complaint");
    if (!file)
        return false;
    cm1e_sim_segment_t *segment = make_segment();
    for (uint32_t position = 1; position <= SLAVES; position++) {
        cm1e_diag_t diag = {0};
        if (cm1e_sim_segment_play(segment, position, profile_file_content(file), &diag) == CM1E_OK)
            use(cm1e_sim_segment_slave(segment, position)), ask_console(segment, position);
        else if (!diag.text[0])
            fuzz_fail("a profile is refused without a reason");
    }
    profile_file_free(file);
    cm1e_sim_segment_destroy(segment);
    return false;
}

void fuzz_seeds(void)
{
    static const char *const profiles[] = {
        "{\"cm1e_profile\":1}",
        "{\"cm1e_profile\":1,\"entries\":[{\"entry\":\"0x100A\",\"text\":\"1.4.0\"},"
        "{\"entry\":\"0x6084\",\"default\":1000},{\"entry\":\"0x1601:00\",\"value\":2},"
        "{\"entry\":\"0x605D\",\"type\":3,\"bits\":16,\"access\":63,\"name\":\"Halt option code\"}],"
        "\"missing\":[\"0x60FB:09\"],\"codes\":{\"aborts\":{\"0x06070012\":\"0x06070010\"},"
        "\"al_status\":{\"0x0011\":\"0x0001\"},\"errors\":{\"0x4502\":\"0x0000\"}}}",
        "{\"cm1e_profile\":1,\"device\":\"drive\",\"firmware\":\"1\",\"sii\":\"0000\",\"entries\":["
        "{\"entry\":\"0x6065\",\"default\":7,\"minimum\":1,\"maximum\":9},"
        "{\"entry\":\"0x1600:01\",\"value\":1614807056},{\"entry\":\"0x1C12:01\",\"default\":5633}]}",
        "{\"cm1e_profile\":1,\"entries\":[{\"entry\":\"0x6098\",\"value\":-2}]}",
        "{\"cm1e_profile\":1,\"entries\":[{\"entry\":\"0x6061\",\"default\":8}],\"codes\":{\"errors\":{"
        "\"0x4502\":\"0x5555\"}}}",
    };
    for (size_t i = 0; i < sizeof profiles / sizeof *profiles; i++) {
        char name[] = "profile0";
        name[7] = (char)('0' + i);
        fuzz_seed(name, profiles[i], strlen(profiles[i]));
    }
}
