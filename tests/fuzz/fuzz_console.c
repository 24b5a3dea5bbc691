/* Lines for the console of the simulator, which `cm1e sim` reads and tests send: each gets an answer, time passes, and the
 * segment still answers. The first byte chooses the network, a line that is a number of up to 3 digits lets so many ms
 * pass. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/sim.h"
#include "fuzz.h"

enum { LINES = 40, FRAME_BYTES = 60, ANSWER_BYTES = 2048 };
#define MS_NS INT64_C(1000000)

/** A CM1-E, a bridge with a motor, a drive by CiA 402; or a CM1-E and terminals. */
static cm1e_sim_segment_t *make_segment(unsigned kind)
{
    cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    const uint16_t axes = kind % 2 ? 3 : 1;
    if (cm1e_bus_config_init(&config, "sim", axes) != CM1E_OK)
        fuzz_fail("no memory");
    for (uint16_t i = 0; i < axes; i++)
        config.axes[i].address = (uint16_t)(i + 1);
    if (axes == 3) {
        config.axes[1].channel = 1;
        config.axes[1].k37 = 10;
        strcpy(config.axes[2].device, "cia402");
        config.axes[2].counts_per_revolution = 131072;
        config.axes[2].max_speed_rpm = 3000;
    }
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create(&config, &diag);
    cm1e_bus_config_free(&config);
    if (!segment)
        fuzz_fail("no segment: %s", diag.text);
    if (axes == 1 && (cm1e_sim_segment_add_io(segment, CM1E_SIM_IO_TERMINAL) != CM1E_OK ||
                      cm1e_sim_segment_add_io(segment, CM1E_SIM_IO_COUPLER) != CM1E_OK))
        fuzz_fail("no memory");
    return segment;
}

static void pass(cm1e_sim_segment_t *segment, int64_t *now_ns, long ms)
{
    /* BRD of the AL status of all slaves */
    uint8_t frame[FRAME_BYTES] = {[12] = 0x88, [13] = 0xA4, [14] = 0x0E, [15] = 0x10, [16] = 0x07, [20] = 0x30,
                                  [21] = 0x01, [22] = 0x02};
    for (long n = 0; n < ms; n++) {
        *now_ns += MS_NS;
        cm1e_sim_segment_advance(segment, *now_ns);
    }
    cm1e_sim_segment_process(segment, 0, frame, sizeof frame, *now_ns);
    for (uint32_t position = 1; position <= cm1e_sim_segment_slave_count(segment); position++)
        for (unsigned channel = 0; channel < 2; channel++) {
            cm1e_sim_probe_t probe = {0};
            cm1e_sim_probe_channel(segment, position, channel, &probe);
            if (!isfinite(probe.position_counts) || !isfinite(probe.velocity_counts_per_s))
                fuzz_fail("the shaft of slave %u is at %g, and turns at %g", position, probe.position_counts,
                          probe.velocity_counts_per_s);
        }
}

static void say(cm1e_sim_segment_t *segment, const char *line, char *answer, size_t size)
{
    memset(answer, 0x55, size);
    const cm1e_error_t error = cm1e_sim_console(segment, line, answer, size);
    if (size > 0 && !memchr(answer, 0, size))
        fuzz_fail("\"%s\": an answer without an end", line);
    if (error != CM1E_OK && size > 1 && !answer[0])
        fuzz_fail("\"%s\" is refused without a reason", line);
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    (void)written, (void)must;
    if (size < 2)
        return false;
    cm1e_sim_segment_t *segment = make_segment(bytes[0]);
    const size_t room = bytes[1] % 8 == 0 ? bytes[1] / 4u : ANSWER_BYTES; /* short ones too */
    char *text = strndup((const char *)bytes + 2, size - 2), *answer = malloc(room + 1), *rest = text, *line;
    int64_t now_ns = 0;
    if (!text || !answer)
        fuzz_fail("no memory");
    for (int n = 0; n < LINES && (line = strsep(&rest, "\n")); n++) {
        const size_t digits = strspn(line, "0123456789");
        if (digits > 0 && digits <= 3 && !line[digits])
            pass(segment, &now_ns, strtol(line, NULL, 10));
        else
            say(segment, line, answer, room);
    }
    pass(segment, &now_ns, 2);
    free(text);
    free(answer);
    cm1e_sim_segment_destroy(segment);
    return false;
}

void fuzz_seeds(void)
{
    static const char *const lines[] = {
        "1Ahelp\nstatus\nshow 1\npower 1 on\n20\nload 1 0.01\n100\nload 1 -3\npower 1 off\n300\nshow 1",
        "1Aswitches 1 2A\nsensor 1 3 on\nrefuse 1 6060:00\nfirmware 1 busy 3\nover-torque 1\n5\ntemperature 1 90\n5",
        "1Aerror 1 2310 hold\nerror 1 clear\nemergency 1 8130 1 2\npower-up-fault 1 2\npower-cycle 1 5\n20\n",
        "1Amotor 2 1 off\nmotor 2 1 error 4\nunplug 2\n3\nreplug 2\ndetach 2 powered\n9\nattach 2\nclock 1 drift 30\n9",
        "0Ainput 2 1 on\ninput 3 2 wire\nquirk 1 nothing\nquirk 2 al-status 2\ndamage 1 3\nlose 2\ncorrupt 1\ndelay 2 100\n3",
        "1@show 1\nhelp\nclock 3 step 1e9\nclock 1 jitter -1\nsensor 3 1 auto\nerror 3 FF10\n40\nmotor 2 1 turn 100\n30",
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        char name[] = "console0";
        name[7] = (char)('0' + i);
        fuzz_seed(name, lines[i], strlen(lines[i]));
    }
}
