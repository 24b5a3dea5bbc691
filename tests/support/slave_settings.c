#include "slave_settings.h"

enum { STATION = 0x0010, FMMUS = 0x0600, FMMU_BYTES = 16, LAST_BIT = 7 };
enum { SYNC_MANAGERS = 0x0800, SYNC_MANAGER_BYTES = 8, STATUS = 5, ACTIVATE = 6 };

static const struct {
    uint16_t offset, bytes;
} ranges[] = {{STATION, 2}, {0x0012, 2}, {0x0100, 4}, {0x0400, 2}, {0x0410, 2}, {0x0420, 2}, {0x0500, 1}, {FMMUS, 256},
              {SYNC_MANAGERS, 32}, {0x0934, 2}, {0x0980, 2}, {0x09A0, 8}};

/** What is set by the master; of FMMUs and sync managers their first bytes. */
static bool is_setting(uint16_t offset, bool elsewhere)
{
    if (offset >= SYNC_MANAGERS && offset < SYNC_MANAGERS + 32)
        return offset % SYNC_MANAGER_BYTES < STATUS || offset % SYNC_MANAGER_BYTES == ACTIVATE;
    if (elsewhere && offset >= FMMUS && offset < FMMUS + 256)
        return offset % FMMU_BYTES >= 4 && offset % FMMU_BYTES != LAST_BIT; /* whole bytes are kept free for it */
    return !elsewhere || offset >= STATION + 2;
}

static slave_settings_t settings_of(cm1e_bus_t *bus, uint32_t place)
{
    const uint8_t *memory = register_memory_of(bus, place);
    slave_settings_t settings = {.size = 0};
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++)
        for (uint16_t n = 0; n < ranges[i].bytes; n++)
            settings.bytes[settings.size++] = memory[ranges[i].offset + n];
    return settings;
}

static void compare(const slave_settings_t *now, const slave_settings_t *before, bool elsewhere, uint32_t place)
{
    size_t at = 0;
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++)
        for (uint16_t n = 0; n < ranges[i].bytes; n++, at++) {
            const uint16_t offset = (uint16_t)(ranges[i].offset + n);
            const bool activates = offset >= SYNC_MANAGERS && offset < SYNC_MANAGERS + 32 && offset % 8 == ACTIVATE;
            const uint8_t mask = activates ? 1 : 0xFF; /* the other bit asks for a message again */
            if (is_setting(offset, elsewhere))
                ck_assert_msg(((now->bytes[at] ^ before->bytes[at]) & mask) == 0,
                              "slave %u: register 0x%04X is %02X, before %02X", place, offset, now->bytes[at],
                              before->bytes[at]);
        }
}

void take_settings(cm1e_bus_t *bus, uint32_t place, unsigned count, slave_settings_t *settings)
{
    for (unsigned i = 0; i < count; i++)
        settings[i] = settings_of(bus, place + i);
}

void expect_settings(cm1e_bus_t *bus, uint32_t place, unsigned count, const slave_settings_t *before, bool elsewhere)
{
    for (unsigned i = 0; i < count; i++) {
        const slave_settings_t now = settings_of(bus, place + i);
        compare(&now, &before[i], elsewhere, place + i);
    }
}
