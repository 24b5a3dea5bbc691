/* Hostile input: frames, registers and mailboxes at random, from printed seeds. What counts is that nothing is read or
 * written out of bounds (address and undefined behaviour sanitizers) and that a power cycle brings every slave back. */
#include "sim/esc_chip.h"
#include "seeds.h"
#include "sim_fake_app.h"

enum { SLAVES = 3, ROUNDS = 60, FRAMES = 1500 };

static bench_t b;
static uint32_t state;
static uint8_t image[CM1E_SII_SIZE];

void setUp(void)
{
    fake_sii(image, 0, 0);
    bench_open_with(&b, SLAVES, image, sizeof image);
}
void tearDown(void) { bench_close(&b); }

static uint32_t next(void)
{
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}
static uint32_t below(uint32_t n) { return next() % n; }

/* In an exact allocation, so that the sanitizer sees every byte too much. */
static void send_exact(const uint8_t *frame, size_t length)
{
    uint8_t *copy = malloc(length + 1);
    memcpy(copy, frame, length);
    cm1e_sim_segment_process(b.segment, (int)below(4) - 1, copy, length, b.now_ns += below(300000));
    free(copy);
}

static void random_frame(void)
{
    uint8_t frame[FRAME_MAX];
    const size_t length = below(FRAME_MAX);
    frame_begin(frame);
    for (size_t i = below(2) ? 14 : 16; i < length; i++)
        frame[i] = (uint8_t)next();
    if (below(4))
        cm1e_put_u16(frame + 14, (uint16_t)(0x1000 | (length > 16 ? length - 16 : 0)));
    send_exact(frame, length);
}

/* Addresses that matter, each a little beside itself now and then. */
static uint16_t random_address(void)
{
    static const uint16_t places[] = {0x0000, 0x0010, 0x0100, 0x0110, 0x0120, 0x0130, 0x0300, 0x0400, 0x0420,
                                      0x0500, 0x0502, 0x0504, 0x0508, 0x0600, 0x0610, 0x0670, 0x0800, 0x0806,
                                      0x0808, 0x080E, 0x0810, 0x0818, 0x0900, 0x0910, 0x0920, 0x0FF8, 0x1000,
                                      0x1080, 0x1100, 0x1400, 0x2FF0, 0x3000, 0xFFF0};
    return (uint16_t)(places[below(sizeof places / sizeof places[0])] + (below(3) ? 0 : below(16)));
}

static size_t random_datagram(uint8_t *frame, size_t at)
{
    uint8_t data[300];
    const uint16_t length = (uint16_t)(below(4) ? below(20) : below(sizeof data));
    for (unsigned i = 0; i < length; i++)
        data[i] = (uint8_t)(below(3) ? next() : 0);
    const uint8_t command = (uint8_t)below(16);
    const bool logical = command >= LRD && command <= LRW;
    const uint32_t physical = (uint16_t)(0 - below(SLAVES + 1)) | (uint32_t)random_address() << 16;
    const uint32_t address = logical ? below(64) : physical;
    return frame_add(frame, at, command, address, data, length);
}

static void well_formed_frame(void)
{
    uint8_t frame[FRAME_MAX];
    size_t end = frame_begin(frame);
    for (unsigned n = 1 + below(4); n > 0; n--)
        end = random_datagram(frame, end);
    send_exact(frame, end);
}

/* Sync managers and FMMUs that are almost right, also while they are in use. */
static void reconfigure(void)
{
    uint8_t sm[8] = {0}, fmmu[16];
    const unsigned slave = below(SLAVES);
    cm1e_put_u16(sm, (uint16_t)(below(2) ? 0x1000 + below(0x500) : next()));
    cm1e_put_u16(sm + 2, (uint16_t)(below(4) ? below(200) : next()));
    sm[4] = (uint8_t)(below(2) ? 0x26 : next());
    sm[6] = (uint8_t)below(4);
    const uint16_t at = (uint16_t)(0x800 + 8 * below(4));
    write_u8(&b, slave, at + 6, 0);
    write_bytes(&b, slave, at, sm, sizeof sm);
    for (unsigned i = 0; i < sizeof fmmu; i++)
        fmmu[i] = (uint8_t)(below(2) ? next() : 0);
    cm1e_put_u32(fmmu, below(64));
    cm1e_put_u16(fmmu + 8, random_address());
    write_bytes(&b, slave, (uint16_t)(0x600 + 16 * below(8)), fmmu, sizeof fmmu);
}

/* A mailbox with a plausible begin. */
static void random_mailbox(void)
{
    static const uint8_t commands[] = {0x00, 0x01, 0x10, 0x20, 0x21, 0x22, 0x23, 0x2F,
                                       0x30, 0x31, 0x40, 0x50, 0x60, 0x70, 0x80};
    static const uint16_t indices[] = {0x1000, 0x1008, 0x1009, 0x2000, 0x2001, 0x2003, 0x2010, 0x2011, 0x2012, 0x5555,
                                       0x100A, 0x1018, 0x1600, 0x1A03, 0x1C12, 0x1C13, 0x6040, 0x6060, 0x60F6, 0xFE00};
    uint8_t box[128], answer[128] = {0};
    for (unsigned i = 0; i < sizeof box; i++)
        box[i] = (uint8_t)(below(4) ? 0 : next());
    cm1e_put_u16(box, (uint16_t)(below(3) ? 10 : below(3) ? below(123) : next()));
    box[5] = (uint8_t)(below(8) ? 3 | below(8) << 4 : next());
    const uint16_t index = indices[below(sizeof indices / sizeof indices[0])];
    if (below(4)) {
        cm1e_put_u16(box + 6, (uint16_t)(below(20) ? 0x2000 : next()));
        box[8] = below(4) ? commands[below(sizeof commands)] : (uint8_t)next();
        cm1e_put_u16(box + 9, index);
        box[11] = (uint8_t)below(4);
    } else { /* SDO information */
        cm1e_put_u16(box + 6, 0x8000);
        box[8] = (uint8_t)below(8);
        cm1e_put_u16(box + 12, below(2) ? index : (uint16_t)below(8));
        box[14] = (uint8_t)below(4);
        box[15] = (uint8_t)next();
    }
    const unsigned slave = below(SLAVES);
    write_bytes(&b, slave, 0x1000, box, sizeof box);
    bench_wait(&b, below(400000));
    if (below(4))
        send_to(&b, APRD, (uint16_t)-slave, 0x1080, answer, sizeof answer);
    if (below(8) == 0)
        write_u8(&b, slave, 0x080E, (uint8_t)(1 | below(2) << 1));
}

static void from_the_application(void)
{
    static const uint8_t more[5] = {0};
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(b.segment, 1 + below(SLAVES));
    if (below(2))
        cm1e_sim_slave_emergency(slave, (uint16_t)next(), 0, more);
    else if (below(20) == 0)
        cm1e_sim_slave_fall_back(slave, (uint8_t)(1u << below(4)), (uint16_t)next());
    else if (below(20) == 0)
        cm1e_sim_slave_reset(slave, b.now_ns + below(2000000));
}

static void change_cables(void)
{
    if (below(20) == 0)
        cm1e_sim_segment_close_ring(b.segment);
    cm1e_sim_segment_cut(b.segment, below(SLAVES + 2), below(4) == 0);
}

static void change_state(void)
{
    const unsigned slave = below(SLAVES);
    if (below(3) == 0) {
        static const uint8_t off = 0;
        for (uint16_t at = 0x806; at < 0x820; at += 8)
            write_bytes(&b, slave, at, &off, 1);
        uint8_t sm[32] = {0x00, 0x10, 128, 0, 0x26, 0, 1, 0, 0x80, 0x10, 128, 0, 0x22, 0, 1, 0,
                          0x00, 0x11, 13,  0, 0x64, 0, 1, 0, 0x00, 0x14, 21,  0, 0x20, 0, 1, 0};
        write_bytes(&b, slave, 0x800, sm, sizeof sm);
    }
    for (uint16_t to = 1; to <= 8; to *= 2) {
        write_u16(&b, slave, 0x0120, to | 0x10);
        bench_wait(&b, 300000);
    }
}

static void power_cycle_brings_them_back(void)
{
    for (uint32_t i = 1; i <= SLAVES; i++) {
        cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(b.segment, i);
        memcpy(slave->sii, image, sizeof image); /* a master may overwrite it */
        cm1e_sim_slave_reset(slave, b.now_ns + 10);
    }
    for (uint32_t i = 1; i <= SLAVES + 1; i++)
        cm1e_sim_segment_cut(b.segment, i, false);
    bench_wait(&b, 5000000);
    for (unsigned i = 0; i < SLAVES; i++)
        bring_to(&b, i, CM1E_AL_OP);
}

static void attack(void)
{
    static void (*const acts[])(void) = {
        random_frame, well_formed_frame, well_formed_frame, reconfigure, random_mailbox, random_mailbox, random_mailbox,
        from_the_application, change_state, change_cables,
    };
    for (int round = 0; round < seeds_of(ROUNDS); round++) {
        state = 0x9E3779B9u * seed_of(round);
        printf("seed %u\n", seed_of(round));
        for (int i = 0; i < FRAMES; i++)
            acts[below(sizeof acts / sizeof acts[0])]();
        power_cycle_brings_them_back();
    }
}

static void test_nothing_that_arrives_does_harm(void) { attack(); }

static void test_nothing_that_arrives_does_harm_to_a_drive(void)
{
    cm1e_bus_config_t config;
    cm1e_sim_segment_t *const doubles = b.segment;
    cm1e_bus_config_init(&config, "sim", SLAVES);
    b.segment = cm1e_sim_segment_create(&config, NULL);
    cm1e_bus_config_free(&config);
    TEST_ASSERT_NOT_NULL(b.segment);
    attack();
    cm1e_sim_segment_destroy(b.segment);
    b.segment = doubles;
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_that_arrives_does_harm);
    RUN_TEST(test_nothing_that_arrives_does_harm_to_a_drive);
    return UNITY_END();
}
