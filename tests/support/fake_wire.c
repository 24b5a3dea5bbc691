#include "fake_wire.h"

fake_wire_t wire;

static void wire_datagram(int n, uint8_t *d, bool closed_port)
{
    fake_slave_t *s = &wire.slave[n];
    uint16_t address = (uint16_t)(d[2] | d[3] << 8), length = (uint16_t)((d[6] | d[7] << 8) & 0x7FF);
    uint8_t *data = d + 10, *counter = data + length;
    const int reg = d[4] % 32;
    const bool here = address == 0, mine = address == WIRE_STATION + n - 1;
    int count = 0;
    if (length > 32 && d[0] != 12)
        length = 32;
    switch (d[0]) {
    case 1: case 2: case 13: /* APRD, APWR, ARMW */
        if (d[0] != 2 && here) { memcpy(data, s->registers + reg, length); count = 1; }
        if ((d[0] == 2 && here) || (d[0] == 13 && !here)) {
            memcpy(s->registers + reg, data, length);
            s->writes++;
            count = 1;
        }
        address++;
        break;
    case 4: case 5: case 14: /* FPRD, FPWR, FRMW */
        if (d[0] != 5 && mine) { memcpy(data, s->registers + reg, length); count = 1; }
        if ((d[0] == 5 && mine) || (d[0] == 14 && !mine)) {
            memcpy(s->registers + reg, data, length);
            s->writes++;
            count = 1;
        }
        break;
    case 7: /* BRD */
        for (int i = 0; i < length; i++)
            data[i] |= s->registers[reg + i];
        count = 1;
        address++;
        break;
    case 8: /* BWR */
        memcpy(s->registers + reg, data, length);
        count = 1;
        address++;
        break;
    case 12: /* LRW */
        if (length >= 2 * wire.slaves) {
            s->output = data[n - 1];
            data[wire.slaves + n - 1] = s->input;
            count = 3;
        }
        break;
    default:
        break;
    }
    d[2] = (uint8_t)address;
    d[3] = (uint8_t)(address >> 8);
    const int wkc = (counter[0] | counter[1] << 8) + count;
    counter[0] = (uint8_t)wkc;
    counter[1] = (uint8_t)(wkc >> 8);
    if (closed_port)
        d[7] |= 0x40;
}

/** One slave processes a frame; `closed_port`: its port 0 is closed. False: it destroys a frame that circulates. */
static bool wire_slave(int n, uint8_t *frame, size_t length, bool closed_port)
{
    wire.slave[n].frames++;
    frame[6] |= 0x02;
    for (size_t at = 16; at + 12 <= length;) {
        uint8_t *d = frame + at;
        const size_t size = (size_t)((d[6] | d[7] << 8) & 0x7FF) + 12;
        const bool more = (d[7] & 0x80) != 0;
        if (closed_port && (d[7] & 0x40))
            return false;
        if (at + size > length)
            break;
        wire_datagram(n, d, closed_port);
        if (!more)
            break;
        at += size;
    }
    return true;
}

/** Through the slaves; where it comes out, -1: nowhere. */
static int wire_path(int port, uint8_t *frame, size_t length, int *passed)
{
    const int n = wire.slaves;
    *passed = 0;
    if (port == 0) {
        if (wire.cut[1])
            return -1;
        for (int i = 1; i <= n; i++) {
            ++*passed;
            if (!wire_slave(i, frame, length, false))
                return -1;
            if (wire.cut[i + 1])
                return 0;
        }
        return 1;
    }
    if (wire.cut[n + 1])
        return -1;
    int first = n;
    while (first >= 1 && !wire.cut[first])
        first--;
    if (first < 1)
        return 0;
    for (int i = first; i <= n; i++) {
        ++*passed;
        if (!wire_slave(i, frame, length, i == first))
            return -1;
    }
    return 1;
}

static bool wire_matches(const char *name) { return name != NULL; }

static cm1e_error_t wire_open(cm1e_nic_link_t *link, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    (void)config;
    (void)diag;
    cm1e_clock_init_virtual(&wire.clock, 1000000);
    link->clock = &wire.clock;
    return CM1E_OK;
}

static void wire_close(cm1e_nic_link_t *link) { (void)link; }

static bool wire_send(cm1e_nic_link_t *link, int port, const uint8_t *frame, size_t length)
{
    if (wire.refuse)
        return false;
    wire.sent[port]++;
    queued_frame_t *f = cm1e_frame_queue_place(&wire.queue);
    if (!f)
        return true;
    memcpy(f->bytes, frame, length);
    f->length = length;
    int passed;
    f->port = wire_path(port, f->bytes, length, &passed);
    if (f->port < 0 || wire.mute)
        return true;
    cm1e_frame_queue_insert(&wire.queue, f, cm1e_clock_now(link->clock) + WIRE_BASE_NS + passed * WIRE_SLAVE_NS);
    return true;
}

static size_t wire_receive(cm1e_nic_link_t *link, int *port, uint8_t *frame, int64_t deadline_ns)
{
    queued_frame_t *f = frame_queue_first(&wire.queue);
    if (!f || (f->ready_ns > deadline_ns && f->ready_ns > cm1e_clock_now(link->clock))) {
        if (deadline_ns > 0)
            cm1e_clock_sleep_until(link->clock, deadline_ns);
        return 0;
    }
    cm1e_clock_sleep_until(link->clock, f->ready_ns);
    const size_t length = f->length;
    *port = f->port;
    memcpy(frame, f->bytes, length);
    cm1e_frame_queue_remove_first(&wire.queue);
    return length;
}

static const cm1e_nic_backend_t wire_backend = {"wire", wire_matches, wire_open, wire_send, wire_receive, wire_close};

cm1e_nic_t *wire_start(bool ring)
{
    static cm1e_bus_config_t config;
    memset(&wire, 0, sizeof wire);
    wire.slaves = WIRE_SLAVES;
    wire.cut[WIRE_SLAVES + 1] = !ring;
    for (int i = 1; i <= WIRE_SLAVES; i++) {
        wire.slave[i].input = (uint8_t)(0xA0 + i);
        for (int r = 0; r < WIRE_REGISTERS; r++)
            wire.slave[i].registers[r] = (uint8_t)(i * 16 + r % 16);
    }
    strcpy(config.second_interface, ring ? "second" : "");
    cm1e_nic_t *nic = NULL;
    cm1e_nic_open_backend(&nic, &wire_backend, &config, NULL);
    return nic;
}
