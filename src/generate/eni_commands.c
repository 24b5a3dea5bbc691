/* The InitCmds that take a slave through its states, in the order in which TwinCAT's exported files have them: a master
 * picks those of the transition that it makes, in the file's order. The CoE InitCmds of a transition go before them,
 * for the last thing here is to ask for the new state and to see it (ETG.1000.6 6.4.1). */
#include "core/bytes.h"
#include "generate/eni.h"
#include "generate/eni_registers.h"

enum { BLOCKS_BYTES = 256 }; /* of all FMMUs; of the sync managers and what follows them */
enum { AL_INIT = 1, AL_PREOP = 2, AL_BOOT = 3, AL_SAFEOP = 4, AL_OP = 8, AL_ACKNOWLEDGE = 0x10, AL_ERROR = 0x10 };
enum { SII_READ = 0x0100, SII_VENDOR = 0x08, SII_PRODUCT = 0x0A };
enum { RETRIES = 3, ONE_SLAVE = 1 };
/* Until a slave is in a state, ms; of the EEPROM. As TwinCAT has them without times of an ESI. */
enum { TIME_INIT = 3000, TIME_BACK_INIT = 5000, TIME_PREOP = 3000, TIME_BACK_PREOP = 5000, TIME_OP = 10000,
       TIME_BACK_SAFEOP = 200, TIME_SII = 100 };
/* The watchdog counts in 100 us: (2498 + 2) x 40 ns; 100 ms each. What a controller has after reset, so that nothing
 * of another master's remains. */
enum { WATCHDOG_TICK = 2498, WATCHDOG_TICKS = 1000, CONTROL_WATCHDOG = 0x40 };
enum { TO_INIT = CM1E_ENI_PI | CM1E_ENI_BI | CM1E_ENI_SI | CM1E_ENI_OI };

typedef struct maker {
    cm1e_arena_t *arena;
    cm1e_eni_device_t *device;
} maker_t;

static cm1e_eni_command_t *add(cm1e_arena_t *arena, cm1e_eni_command_list_t *list, uint32_t transitions, uint8_t code,
                               uint16_t address, uint16_t reg, const char *comment)
{
    cm1e_eni_command_t *command = CM1E_APPEND(arena, list);
    *command = cm1e_eni_command(code);
    command->transitions = (uint16_t)transitions;
    command->adp = address;
    command->ado = reg;
    command->comment = comment;
    command->retries = RETRIES;
    return command;
}

/* A command to the slave, by its position or by its station address. Its answer has to come from it. */
static cm1e_eni_command_t *to_slave(maker_t *maker, uint32_t transitions, uint8_t code, uint16_t reg,
                                    const char *comment)
{
    const bool by_position = code == CM1E_ENI_APRD || code == CM1E_ENI_APWR;
    cm1e_eni_command_t *command = add(maker->arena, &maker->device->commands, transitions, code,
                                      by_position ? maker->device->position : maker->device->station, reg, comment);
    command->count = ONE_SLAVE;
    return command;
}

static void set_bytes(maker_t *maker, cm1e_eni_command_t *command, const void *bytes, size_t size)
{
    command->data = (cm1e_bytes_t){cm1e_arena_bytes(maker->arena, bytes, size), size};
    command->length = (uint32_t)size;
}

static void set_number(cm1e_arena_t *arena, cm1e_eni_command_t *command, uint64_t value, size_t size)
{
    command->data = cm1e_bytes_of(arena, (int64_t)value, size);
    command->length = (uint32_t)size;
}

static void write_number(maker_t *maker, uint32_t transitions, uint8_t code, uint16_t reg, uint32_t value, size_t size,
                         const char *comment)
{
    cm1e_eni_command_t *command = to_slave(maker, transitions, code, reg, comment);
    set_number(maker->arena, command, value, size);
}

/* On the way back a slave may have left already, so an answer is not required. */
static void clear(maker_t *maker, uint32_t transitions, uint8_t code, uint16_t reg, size_t size, const char *comment)
{
    static const uint8_t zeros[64];
    cm1e_eni_command_t *command = to_slave(maker, transitions, code, reg, comment);
    set_bytes(maker, command, zeros, size < sizeof zeros ? size : sizeof zeros);
    command->count = CM1E_ENI_NOT_GIVEN;
}

static void expect(maker_t *maker, cm1e_eni_command_t *command, uint64_t value, uint64_t mask, size_t size,
                   int32_t timeout_ms)
{
    set_number(maker->arena, command, 0, size);
    command->requires = "cycle";
    command->validates = true;
    command->expected = cm1e_bytes_of(maker->arena, (int64_t)value, size);
    if (mask != 0)
        command->mask = cm1e_bytes_of(maker->arena, (int64_t)mask, size);
    command->timeout_ms = timeout_ms;
}

/* ---- states ----------------------------------------------------------------------------------------------------- */

/* Asks for a state; AL_ACKNOWLEDGE takes back an error that a slave shows. */
static void request(maker_t *maker, uint32_t transitions, uint8_t code, uint8_t al, bool must_answer,
                    const char *comment)
{
    cm1e_eni_command_t *command = to_slave(maker, transitions, code, AL_CONTROL, comment);
    set_number(maker->arena, command, al, 2);
    command->requires = "cycle";
    if (!must_answer)
        command->count = CM1E_ENI_NOT_GIVEN;
}

/* Waits for a state. On the way up an error indication (bit 4) means failure; on the way back it is ignored. A slave
 * with device emulation copies AL control to AL status, also the acknowledge bit, with which Init and Pre-Operational
 * are requested. It has no mailbox, which needs a processor: where there is one, Pre-Operational is checked
 * strictly. */
static void await(maker_t *maker, uint32_t transitions, uint8_t code, uint8_t al, bool forward, int32_t timeout_ms,
                  const char *comment)
{
    cm1e_eni_command_t *command = to_slave(maker, transitions, code, AL_STATUS, comment);
    const bool copied = al == AL_INIT || (al == AL_PREOP && !maker->device->mailbox.present);
    expect(maker, command, al, forward && !copied ? 0x0F | AL_ERROR : 0x0F, code == CM1E_ENI_APRD ? 2 : 6, timeout_ms);
    if (!forward)
        command->count = CM1E_ENI_NOT_GIVEN;
}

static void make_init(maker_t *maker, uint32_t entry)
{
    request(maker, TO_INIT, CM1E_ENI_APWR, AL_INIT | AL_ACKNOWLEDGE, false, "set device state to INIT");
    await(maker, TO_INIT, CM1E_ENI_APRD, AL_INIT, false, TIME_BACK_INIT, "check device state for INIT");
    request(maker, entry, CM1E_ENI_APWR, AL_INIT | AL_ACKNOWLEDGE, true, "set device state to INIT");
    await(maker, entry, CM1E_ENI_APRD, AL_INIT, true, TIME_INIT, "check device state for INIT");
}

/* ---- who is there ----------------------------------------------------------------------------------------------- */

/* Has the controller read two words of the EEPROM, and compares them. */
static void check_sii(maker_t *maker, uint16_t word, uint32_t value, const char *comment)
{
    cm1e_eni_command_t *command = to_slave(maker, CM1E_ENI_IP, CM1E_ENI_APWR, SII_CONTROL, comment);
    set_number(maker->arena, command, (uint64_t)word << 16 | SII_READ, 6);
    command->requires = "cycle";
    expect(maker, to_slave(maker, CM1E_ENI_IP, CM1E_ENI_APRD, SII_DATA, comment), value, 0, 4, TIME_SII);
}

/* Vendor and product, not the revision: that changes with a motor's firmware, while the start-up commands choose the
 * mapping that the file counts on. */
static void make_identity(maker_t *maker, uint32_t entry, uint16_t alias)
{
    write_number(maker, entry, CM1E_ENI_APWR, SII_ACCESS, 0, 1, "assign EEPROM to ECAT");
    check_sii(maker, SII_VENDOR, maker->device->vendor_id, "check vendor id");
    check_sii(maker, SII_PRODUCT, maker->device->product_code, "check product code");
    if (alias != 0)
        expect(maker, to_slave(maker, CM1E_ENI_IP, CM1E_ENI_APRD, STATION_ALIAS, "check station alias"), alias, 0, 2,
               TIME_SII);
    write_number(maker, entry, CM1E_ENI_APWR, STATION_ADDRESS, maker->device->station, 2, "set physical address");
}

/* ---- sync managers, FMMUs, watchdog ----------------------------------------------------------------------------- */

static void set_sync_manager(maker_t *maker, uint32_t transitions, unsigned number, uint16_t start, uint16_t length,
                             uint8_t control, const char *comment)
{
    uint8_t registers[SYNC_MANAGER_BYTES] = {0};
    cm1e_put_u16(registers, start);
    cm1e_put_u16(registers + 2, length);
    registers[4] = control;
    registers[6] = 1; /* on */
    cm1e_eni_command_t *command = to_slave(maker, transitions, CM1E_ENI_FPWR,
                                           (uint16_t)(SYNC_MANAGER + number * SYNC_MANAGER_BYTES), comment);
    set_bytes(maker, command, registers, sizeof registers);
}

static void make_mailbox(maker_t *maker)
{
    const cm1e_eni_mailbox_t *mailbox = &maker->device->mailbox;
    const uint32_t boot = mailbox->has_bootstrap ? CM1E_ENI_IB : 0;
    if (!mailbox->present)
        return;
    clear(maker, CM1E_ENI_IP | boot | CM1E_ENI_PI | CM1E_ENI_SI | CM1E_ENI_OI, CM1E_ENI_FPWR, SYNC_MANAGER,
          2 * SYNC_MANAGER_BYTES, "clear sm 0/1 (mailbox out/in)");
    if (boot)
        clear(maker, CM1E_ENI_BI, CM1E_ENI_APWR, SYNC_MANAGER, 2 * SYNC_MANAGER_BYTES, "clear sm 0/1 (mailbox out/in)");
    set_sync_manager(maker, CM1E_ENI_IP, 0, mailbox->send.start, mailbox->send.length, CONTROL_MAILBOX_OUT,
                     "set sm 0 (mailbox out)");
    set_sync_manager(maker, CM1E_ENI_IP, 1, mailbox->receive.start, mailbox->receive.length, CONTROL_MAILBOX_IN,
                     "set sm 1 (mailbox in)");
    if (!boot)
        return;
    set_sync_manager(maker, CM1E_ENI_IB, 0, mailbox->boot_send.start, mailbox->boot_send.length, CONTROL_MAILBOX_OUT,
                     "set sm 0 (bootstrap out)");
    set_sync_manager(maker, CM1E_ENI_IB, 1, mailbox->boot_receive.start, mailbox->boot_receive.length,
                     CONTROL_MAILBOX_IN, "set sm 1 (bootstrap in)");
}

/* Only where outputs are watched (control byte bit 6): from V1.3.0 on the motor goes off when they stay away. */
static void make_watchdog(maker_t *maker)
{
    bool watched = false;
    for (size_t i = 0; i < maker->device->sync_managers.count; i++) {
        const cm1e_described_sync_manager_t *manager = &maker->device->sync_managers.at[i].manager;
        watched |= manager->use == CM1E_SM_OUTPUTS && (manager->control & CONTROL_WATCHDOG) != 0;
    }
    if (!watched)
        return;
    write_number(maker, CM1E_ENI_IP, CM1E_ENI_FPWR, WATCHDOG_DIVIDER, WATCHDOG_TICK, 2, "set watchdog divider");
    write_number(maker, CM1E_ENI_IP, CM1E_ENI_FPWR, WATCHDOG_PDI, WATCHDOG_TICKS, 2, "set PDI watchdog");
    write_number(maker, CM1E_ENI_IP, CM1E_ENI_FPWR, WATCHDOG_PROCESS_DATA, WATCHDOG_TICKS, 2, "set SM watchdog");
}

/* Sync managers without PDOs stay off. */
static bool carries_data(const cm1e_eni_sync_manager_t *manager)
{
    return manager->manager.enable && manager->manager.length > 0 &&
           (manager->manager.use == CM1E_SM_OUTPUTS || manager->manager.use == CM1E_SM_INPUTS);
}

static void make_process_sync_managers(maker_t *maker)
{
    const uint32_t cleared = CM1E_ENI_IP | CM1E_ENI_SP | CM1E_ENI_SI | CM1E_ENI_OP | CM1E_ENI_OI;
    const cm1e_eni_device_t *device = maker->device;
    for (size_t i = 0; i < device->sync_managers.count; i++)
        clear(maker, cleared, CM1E_ENI_FPWR,
              (uint16_t)(SYNC_MANAGER + device->sync_managers.at[i].number * SYNC_MANAGER_BYTES), SYNC_MANAGER_BYTES,
              cm1e_arena_format(maker->arena, "clear sm %u", device->sync_managers.at[i].number));
    for (size_t i = 0; i < device->sync_managers.count; i++) {
        const cm1e_eni_sync_manager_t *manager = &device->sync_managers.at[i];
        if (!carries_data(manager))
            continue;
        set_sync_manager(maker, CM1E_ENI_PS, manager->number, manager->manager.start, manager->manager.length,
                         manager->manager.control,
                         cm1e_arena_format(maker->arena, "set sm %u (%s)", manager->number,
                                           manager->manager.use == CM1E_SM_OUTPUTS ? "outputs" : "inputs"));
    }
}

static void set_fmmu(maker_t *maker, unsigned number, const cm1e_described_sync_manager_t *manager, uint32_t logical)
{
    const bool outputs = manager->use == CM1E_SM_OUTPUTS;
    uint8_t registers[FMMU_BYTES] = {0};
    cm1e_put_u32(registers, logical);
    cm1e_put_u16(registers + 4, manager->length);
    registers[7] = 7; /* whole bytes: from bit 0 to bit 7 */
    cm1e_put_u16(registers + 8, manager->start);
    registers[11] = outputs ? FMMU_WRITE : FMMU_READ;
    registers[12] = 1; /* on */
    cm1e_eni_command_t *command =
        to_slave(maker, CM1E_ENI_PS, CM1E_ENI_FPWR, (uint16_t)(FMMU + number * FMMU_BYTES),
                 cm1e_arena_format(maker->arena, "set fmmu %u (%s)", number, outputs ? "outputs" : "inputs"));
    set_bytes(maker, command, registers, sizeof registers);
}

/* One FMMU for each sync manager. Returns how many there are. */
static unsigned make_fmmus(maker_t *maker, cm1e_eni_logical_t logical)
{
    uint32_t next[2] = {logical.outputs, logical.inputs};
    unsigned number = 0;
    for (size_t i = 0; i < maker->device->sync_managers.count; i++) {
        const cm1e_eni_sync_manager_t *manager = &maker->device->sync_managers.at[i];
        if (!carries_data(manager))
            continue;
        uint32_t *address = &next[manager->manager.use == CM1E_SM_INPUTS];
        set_fmmu(maker, number++, &manager->manager, *address);
        *address += manager->manager.length;
    }
    return number;
}

static void clear_fmmus(maker_t *maker, unsigned count)
{
    for (unsigned n = 0; n < count; n++)
        clear(maker, CM1E_ENI_SP | CM1E_ENI_SI | CM1E_ENI_OP | CM1E_ENI_OI, CM1E_ENI_FPWR,
              (uint16_t)(FMMU + n * FMMU_BYTES), FMMU_BYTES, cm1e_arena_format(maker->arena, "clear fmmu %u", n));
}

/* ---- clock ------------------------------------------------------------------------------------------------------ */

static void write_zeros(maker_t *maker, uint16_t reg, size_t size, const char *comment)
{
    write_number(maker, CM1E_ENI_PS, CM1E_ENI_FPWR, reg, 0, size, comment);
}

/* Offset, delay and start time are of the moment: a file has the place for them, and the master puts its values there
 * (TwinCAT's files have the start time so). */
static void make_clock(maker_t *maker, uint16_t assign_activate)
{
    const cm1e_eni_dc_t *dc = &maker->device->dc;
    uint8_t cycles[8];
    if (!dc->present)
        return;
    write_zeros(maker, DC_OFFSET, 8, "set dc system time offset (of the master)");
    write_zeros(maker, DC_DELAY, 4, "set dc propagation delay (of the master)");
    if (dc->cycle0_ns == 0)
        return;
    cm1e_put_u32(cycles, (uint32_t)dc->cycle0_ns);
    cm1e_put_u32(cycles + 4, (uint32_t)dc->cycle1_ns);
    write_zeros(maker, DC_CONTROL, 2, "clear dc activation");
    set_bytes(maker, to_slave(maker, CM1E_ENI_PS, CM1E_ENI_FPWR, DC_CYCLES, "set dc cycle time"), cycles,
              sizeof cycles);
    write_zeros(maker, DC_START, 8, "set dc start time (of the master)");
    write_number(maker, CM1E_ENI_PS, CM1E_ENI_FPWR, DC_CONTROL, assign_activate, 2, "set dc activation");
    clear(maker, CM1E_ENI_SP | CM1E_ENI_SI | CM1E_ENI_OP | CM1E_ENI_OI, CM1E_ENI_FPWR, DC_CONTROL, 2,
          "clear dc activation");
}

/* ---- a slave ---------------------------------------------------------------------------------------------------- */

static void make_forward(maker_t *maker, uint32_t entry)
{
    const uint32_t boot = entry & CM1E_ENI_IB;
    write_number(maker, entry, CM1E_ENI_FPWR, SII_ACCESS, 1, 1, "assign EEPROM to PDI");
    clear(maker, CM1E_ENI_II, CM1E_ENI_APWR, SII_ACCESS, 1, "assign EEPROM back to ECAT");
    request(maker, CM1E_ENI_IP, CM1E_ENI_FPWR, AL_PREOP | AL_ACKNOWLEDGE, true, "set device state to PREOP");
    await(maker, CM1E_ENI_IP, CM1E_ENI_FPRD, AL_PREOP, true, TIME_PREOP, "check device state for PREOP");
    clear(maker, CM1E_ENI_IP | (boot ? CM1E_ENI_BI : 0), CM1E_ENI_APWR, SII_ACCESS, 1, "assign EEPROM back to ECAT");
    if (boot) {
        request(maker, boot, CM1E_ENI_FPWR, AL_BOOT | AL_ACKNOWLEDGE, true, "set device state to BOOT");
        await(maker, boot, CM1E_ENI_FPRD, AL_BOOT, true, TIME_PREOP, "check device state for BOOT");
    }
    request(maker, CM1E_ENI_PS, CM1E_ENI_FPWR, AL_SAFEOP, true, "set device state to SAFEOP");
    await(maker, CM1E_ENI_PS, CM1E_ENI_FPRD, AL_SAFEOP, true, TIME_OP, "check device state for SAFEOP");
    await(maker, CM1E_ENI_OS, CM1E_ENI_FPRD, AL_SAFEOP, false, TIME_BACK_SAFEOP, "check device state for SAFEOP");
    request(maker, CM1E_ENI_SO, CM1E_ENI_FPWR, AL_OP, true, "set device state to OP");
    await(maker, CM1E_ENI_SO, CM1E_ENI_FPRD, AL_OP, true, TIME_OP, "check device state for OP");
}

void cm1e_eni_make_commands(cm1e_arena_t *arena, cm1e_eni_device_t *device, cm1e_eni_logical_t logical, uint16_t alias,
                            uint16_t assign_activate)
{
    maker_t maker = {arena, device};
    const uint32_t entry = CM1E_ENI_IP | (device->mailbox.has_bootstrap ? CM1E_ENI_IB : 0);
    make_init(&maker, entry);
    make_identity(&maker, entry, alias);
    make_watchdog(&maker);
    make_mailbox(&maker);
    request(&maker, CM1E_ENI_SP | CM1E_ENI_OP, CM1E_ENI_FPWR, AL_PREOP | AL_ACKNOWLEDGE, false,
            "set device state to PREOP");
    make_process_sync_managers(&maker);
    const unsigned fmmus = make_fmmus(&maker, logical);
    request(&maker, CM1E_ENI_OS, CM1E_ENI_FPWR, AL_SAFEOP, false, "set device state to SAFEOP");
    clear_fmmus(&maker, fmmus);
    await(&maker, CM1E_ENI_SP | CM1E_ENI_OP, CM1E_ENI_FPRD, AL_PREOP, false, TIME_BACK_PREOP,
          "check device state for PREOP");
    make_clock(&maker, assign_activate);
    make_forward(&maker, entry);
}

/* ---- the master ------------------------------------------------------------------------------------------------- */

/* Before any slave, to all of them at once: what another master may have left. How many answer is not stated, since
 * a controller need not have every register. */
void cm1e_eni_make_master_commands(cm1e_arena_t *arena, cm1e_eni_command_list_t *list, bool clocks)
{
    enum { FMMU_TRANSITIONS = CM1E_ENI_IP | TO_INIT };
    static const struct {
        uint32_t transitions;
        uint8_t code;
        uint16_t reg;
        uint32_t value;
        uint16_t size;
        const char *comment;
    } rows[] = {
        {CM1E_ENI_IP, CM1E_ENI_BRD, AL_STATUS, 0, 2, "read slave count"},
        {CM1E_ENI_IP, CM1E_ENI_BWR, ECAT_EVENT_MASK, 0x0004, 2, "enable ECAT IRQ"},
        {CM1E_ENI_IP, CM1E_ENI_BWR, STATION_ADDRESS, 0, 2, "clear configured addresses"},
        {CM1E_ENI_IP, CM1E_ENI_BWR, RX_ERRORS, 0, 8, "clear crc register"},
        {FMMU_TRANSITIONS, CM1E_ENI_BWR, FMMU, 0, BLOCKS_BYTES, "clear fmmu"},
        {CM1E_ENI_IP, CM1E_ENI_BWR, SYNC_MANAGER, 0, BLOCKS_BYTES, "clear sm"},
        {CM1E_ENI_IP, CM1E_ENI_BWR, DC_SYSTEM_TIME, 0, 32, "clear dc system time"},
        {CM1E_ENI_IP, CM1E_ENI_BWR, DC_ACTIVATION, 0, 1, "clear dc cycle cfg"},
        {CM1E_ENI_IP, CM1E_ENI_BWR, DC_SPEED, 0x1000, 2, "reset dc speed"},
        {CM1E_ENI_IP, CM1E_ENI_BWR, DC_FILTER, 0x0C00, 2, "configure dc filter"},
        {CM1E_ENI_IP, CM1E_ENI_BWR, DL_CONTROL_ALIAS, 0, 1, "disable second physical address"},
        {CM1E_ENI_PS, CM1E_ENI_BWR, DC_RECEIVE_TIMES, 0, 4, "latch dc receive times"}, /* with clocks only */
    };
    const size_t count = sizeof rows / sizeof rows[0] - !clocks;
    for (size_t i = 0; i < count; i++) {
        cm1e_eni_command_t *command =
            add(arena, list, rows[i].transitions, rows[i].code, 0, rows[i].reg, rows[i].comment);
        command->before_slave = true;
        command->requires = "cycle";
        if (rows[i].size > sizeof(uint64_t))
            command->length = rows[i].size; /* zeros */
        else
            set_number(arena, command, rows[i].value, rows[i].size);
    }
}
