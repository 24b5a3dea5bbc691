/* What another program answers at its control socket, which any program of the same user can be: a bus that is attached to
 * it, and a recording of its signals. Each line of an input is the body of an answer; a line that begins with "!" is sent
 * as it is, without its length. */
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "attach.h"
#include "cm1e/foe.h"
#include "cm1e/sdo_info.h"
#include "cm1e/sii.h"
#include "control/message.h"
#include "fuzz_complain.h"
#include "recording.h"

static void send_line(int fd, const uint8_t *line, size_t length)
{
    const uint8_t head[CM1E_MESSAGE_HEADER] = {0, 0, (uint8_t)(length >> 8), (uint8_t)length};
    const bool raw = length > 0 && line[0] == '!';
    if (!raw && send(fd, head, sizeof head, MSG_NOSIGNAL | MSG_DONTWAIT) < 0)
        return;
    send(fd, line + raw, length - raw, MSG_NOSIGNAL | MSG_DONTWAIT);
}

/** Answers whatever it will be asked with one line after the other: what the client does not read waits in the socket. */
static void answer(int fd, const uint8_t *bytes, size_t size)
{
    const uint8_t *end = bytes + size;
    for (const uint8_t *at = bytes, *next; at < end; at = next + 1) {
        next = memchr(at, '\n', (size_t)(end - at));
        next = next ? next : end;
        send_line(fd, at, (size_t)(next - at));
    }
    shutdown(fd, SHUT_WR);
}

/** Its address; the listener is there for all inputs. */
static const char *listen_here(int *listener)
{
    static struct sockaddr_un address = {.sun_family = AF_UNIX};
    static int fd = -1;
    if (fd < 0) {
        snprintf(address.sun_path, sizeof address.sun_path, "/tmp/fuzz_attached_%d", (int)getpid());
        unlink(address.sun_path);
        fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (fd < 0 || bind(fd, (struct sockaddr *)&address, sizeof address) != 0 || listen(fd, 1) != 0)
            fuzz_fail("no socket");
    }
    *listener = fd;
    return address.sun_path;
}

static void check(cm1e_error_t error, const cm1e_diag_t *diag, const char *what)
{
    if (error != CM1E_OK && (diag->error == CM1E_OK || !diag->text[0])) /* the text may be the other program's: short */
        fuzz_fail("%s fails (%d) and says %d, \"%s\"", what, (int)error, (int)diag->error, diag->text);
    if (error != CM1E_OK)
        fuzz_use_text(diag->text);
    (void)cm1e_strerror(error);
}

static void check_slaves(cm1e_bus_t *bus)
{
    for (uint32_t i = 1; i <= cm1e_bus_slave_count(bus); i++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, i);
        if (!memchr(slave->name, 0, sizeof slave->name) || slave->position != i)
            fuzz_fail("slave %u has the position %u, or a name without an end", i, slave->position);
        if (slave->name[0])
            fuzz_use_text(slave->name);
    }
}

/** All that a command asks an attached bus. */
static void use_bus(cm1e_control_t *control)
{
    cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus;
    uint8_t data[40];
    uint16_t list[16];
    size_t size = sizeof data, count = 16;
    cm1e_object_info_t object;
    cm1e_entry_info_t entry;
    if (cm1e_bus_config_init(&config, "sim", 1) != CM1E_OK)
        fuzz_fail("no memory");
    check(cm1e_bus_open_attached(&bus, &config, control, &diag), &diag, "an attached bus");
    cm1e_bus_config_free(&config);
    if (!bus)
        return;
    check(cm1e_bus_scan(bus, &diag), &diag, "a scan");
    check_slaves(bus);
    check(cm1e_sdo_read(bus, 1, 0x1018, 1, data, &size, &diag), &diag, "a read");
    if (size > sizeof data)
        fuzz_fail("%zu bytes read into %zu", size, sizeof data);
    check(cm1e_sdo_write(bus, 1, 0x6081, 0, data, 4, &diag), &diag, "a write");
    check(cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, list, &count, &diag), &diag, "a list of objects");
    check(cm1e_sdo_info_object(bus, 1, 0x1018, &object, &diag), &diag, "the description of an object");
    check(cm1e_sdo_info_entry(bus, 1, 0x6040, 0, &entry, &diag), &diag, "the description of an entry");
    size = sizeof data;
    check(cm1e_sii_read_device(bus, 1, data, &size, &diag), &diag, "an SII");
    cm1e_bus_close(bus);
}

static void record(cm1e_control_t *control)
{
    cm1e_diag_t diag = {0};
    recording_t recording = {.seconds = 1};
    const cm1e_trace_trigger_t none = {0};
    const bool begun = recording_begin(&recording, control, 1, json_array(), NULL, &none, &diag);
    if (!begun)
        check(CM1E_ERROR_IO, &diag, "a recording");
    for (int n = 0; begun && n < 4; n++)
        if (!recording_take(&recording, control, &diag)) {
            check(CM1E_ERROR_IO, &diag, "samples");
            break;
        }
    recording_free(&recording);
    cm1e_control_close(control);
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    (void)written, (void)must;
    cm1e_diag_t diag = {0};
    cm1e_control_t *control;
    int listener;
    if (size == 0)
        return false;
    if (cm1e_control_connect(&control, listen_here(&listener), NULL, &diag) != CM1E_OK)
        fuzz_fail("no connection: %s", diag.text);
    const int fd = accept(listener, NULL, NULL);
    if (fd < 0)
        fuzz_fail("no connection");
    answer(fd, bytes + 1, size - 1);
    if (bytes[0] % 2)
        record(control);
    else
        use_bus(control);
    close(fd); /* last: else the client would be told that nobody reads */
    return false;
}

void fuzz_seeds(void)
{
    static const char *const texts[] = {
        "0{\"ok\":true,\"slaves\":[{\"name\":\"CM1-E\",\"coe\":true,\"vendor_id\":1964,\"product_code\":1,\"model\":1,"
        "\"al_state\":8,\"presence\":2,\"emergencies\":[{\"number\":1,\"code\":8976,\"data\":[1,2]}],\"clock\":{"
        "\"delay_ns\":5}}],\"ring\":{\"broken\":true,\"behind\":0,\"before\":1},\"strangers\":[{\"place\":1}]}\n"
        "{\"ok\":true,\"data\":\"01020304\"}\n{\"ok\":true,\"data\":null}\n{\"ok\":true,\"data\":\"18100000\"}\n"
        "{\"ok\":false,\"error\":{\"code\":-30,\"foreign_code\":1,\"text\":\"no\"}}",
        "1{\"ok\":true,\"record\":{\"cycle_ns\":1000000,\"every\":1,\"axes\":[\"X\"],\"columns\":[]}}\n"
        "{\"ok\":true,\"samples\":{\"samples\":0,\"lost\":1,\"data\":\"\"}}",
        "0!\001\002", "1{\"ok\":true}", "0{\"ok\":true,\"slaves\":{}}\n{}",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char name[] = "answers0";
        name[7] = (char)('0' + i);
        fuzz_seed(name, texts[i], strlen(texts[i]));
    }
}
