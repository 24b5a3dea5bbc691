#include "bus/recovery.h"

#include <string.h>

#include "bus/bus_internal.h"
#include "core/bytes.h"

/** ns; between two attempts. A CM1-E needs longer than that to start (UG 4.1), and an attempt on a missing one costs
 *  one datagram. */
#define PAUSE_NS INT64_C(50000000)
/** ns; for a step that is one datagram. */
#define STEP_NS INT64_C(100000000)
#define SDO_STEP_NS INT64_C(1000000000)
#define OBJECTS_STEP_NS INT64_C(3000000000)
#define MAPPING_STEP_NS INT64_C(10000000000)
#define CLOCK_STEP_NS INT64_C(10000000000)
/** ns; short, because a device that is away has no address to give back. */
#define RELEASE_NS INT64_C(10000000)

typedef struct cm1e_recovery_action {
    int64_t time_ns;
    /** Fills a datagram, or starts and runs a sub-machine; false: nothing to send now. */
    bool (*next)(cm1e_bus_slave_t *slave, cm1e_datagram_t *datagram, int64_t now_ns);
    /** Called when the datagram is back with working counter 1. */
    void (*result)(cm1e_bus_slave_t *slave, const cm1e_datagram_t *datagram, int64_t now_ns);
    uint8_t what; /**< the state that is requested, or the sub-index that is read */
    bool (*needed)(const cm1e_bus_slave_t *slave); /**< else the step is left out, which costs no cycle; NULL: always */
} cm1e_recovery_action_t;

static const cm1e_recovery_action_t actions[RECOVERY_STEPS];

static void enter(cm1e_bus_slave_t *slave, cm1e_recovery_step_t step, int64_t now_ns)
{
    slave->recovery.step = step;
    slave->recovery.entered = false;
    slave->recovery.unanswered = 0;
    slave->recovery.doubts = false;
    slave->recovery.deadline_ns = now_ns + (step == RECOVERY_PAUSE ? PAUSE_NS : actions[step].time_ns);
}

/** Notes the success at once, so that the axis does not request the recovery again before the next supervision. */
static void succeed(cm1e_bus_slave_t *slave, uint16_t al_state, uint16_t al_status_code)
{
    cm1e_supervision_note(slave, al_state, al_status_code);
    slave->recovery.step = RECOVERY_IDLE;
    slave->recovery.failed_at = RECOVERY_IDLE;
    slave->hot.planned = false;
    slave->hot.refused = NULL;
    slave->recovery.successes++;
}

static void advance(cm1e_bus_slave_t *slave, int64_t now_ns)
{
    cm1e_recovery_step_t step = slave->recovery.step;
    if (step == RECOVERY_OP) {
        succeed(slave, slave->al.state, slave->al.code);
        return;
    }
    do
        step++;
    while (actions[step].needed && !actions[step].needed(slave));
    enter(slave, step, now_ns);
}

/** Whether the device has to give its address back. A device that is not the expected one must not keep the address:
 *  the expected one, plugged in elsewhere, would answer at the same address. Where places move, a device may have got
 *  the address of another one, and fail before it can be identified. An optional slave is searched for again in any
 *  case. */
static bool must_release(const cm1e_bus_slave_t *slave)
{
    const cm1e_recovery_t *recovery = &slave->recovery;
    const cm1e_recovery_step_t known = slave->hot.moves ? RECOVERY_INIT : RECOVERY_ID;
    const cm1e_recovery_step_t first = recovery->address_given ? RECOVERY_ADDRESS : known;
    if (slave->hot.optional && recovery->step >= RECOVERY_EEPROM && recovery->step < RECOVERY_RELEASE)
        return true;
    return recovery->step >= first && recovery->step <= RECOVERY_VERSION;
}

/** Hands an optional slave to the search again after its recovery has ended. */
static void give_to_search(cm1e_bus_slave_t *slave, const char *reason)
{
    slave->recovery.step = RECOVERY_IDLE;
    cm1e_hot_refuse(slave, slave->hot.refused ? slave->hot.refused : reason);
    cm1e_hot_lose(slave);
}

static void cancel_jobs(cm1e_bus_slave_t *slave)
{
    cm1e_al_cancel(&slave->al);
    cm1e_recognise_cancel(&slave->recognition);
    slave->mapping.step = MAPPING_IDLE;
    cm1e_setup_cancel(&slave->setup);
}

static void fail(cm1e_bus_slave_t *slave, int64_t now_ns)
{
    const bool releases = must_release(slave);
    const bool gone = slave->recovery.step == RECOVERY_RELEASE && slave->hot.optional;
    if (slave->recovery.step != RECOVERY_RELEASE)
        slave->recovery.failed_at = slave->recovery.step;
    cancel_jobs(slave);
    cm1e_coe_cancel(&slave->coe, CM1E_ERROR_BUS_LOST);
    if (gone)
        give_to_search(slave, NULL);
    else
        enter(slave, releases ? RECOVERY_RELEASE : RECOVERY_PAUSE, now_ns);
}

/** A sub-machine has ended: the recovery goes on if all was `good`. Returns false: nothing is to be sent. */
static bool end_step(cm1e_bus_slave_t *slave, bool good, int64_t now_ns)
{
    if (good)
        advance(slave, now_ns);
    else
        fail(slave, now_ns);
    return false;
}

/** Whether the sub-machine of a step has still to be started. */
static bool begins(cm1e_bus_slave_t *slave)
{
    const bool first = !slave->recovery.entered;
    slave->recovery.entered = true;
    return first;
}

void cm1e_recovery_begin(cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    if (!cm1e_recovery_idle(&slave->recovery))
        return;
    cm1e_acyclic_wake(bus);
    slave->recovery.step = RECOVERY_PAUSE;
    slave->recovery.deadline_ns = 0; /* over */
}

void cm1e_recovery_begin_found(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, int64_t now_ns)
{
    cm1e_acyclic_wake(bus);
    slave->recovery.attempts++;
    slave->recovery.address_given = true;
    slave->recovery.failed_at = RECOVERY_IDLE;
    enter(slave, RECOVERY_EEPROM, now_ns);
}

void cm1e_recovery_cancel(cm1e_bus_slave_t *slave)
{
    slave->recovery.step = RECOVERY_IDLE;
    cancel_jobs(slave);
}

/* ---- registers ------------------------------------------------------------------------------------------------- */

static bool write_registers(const cm1e_bus_slave_t *slave, cm1e_datagram_t *d, uint16_t offset, const void *data,
                            size_t bytes)
{
    cm1e_datagram_set(d, COMMAND_FPWR, slave->facts.station, offset, (uint16_t)bytes);
    memcpy(d->data, data, bytes);
    return true;
}

static bool write_register(const cm1e_bus_slave_t *slave, cm1e_datagram_t *d, uint16_t offset, uint16_t value)
{
    uint8_t data[2];
    cm1e_put_u16(data, value);
    return write_registers(slave, d, offset, data, sizeof data);
}

/** The address by the place on the wire, which moves when optional slaves before it come and go. */
static uint16_t by_place(const cm1e_bus_slave_t *slave) { return (uint16_t)(1 - slave->hot.place); }

static bool next_find(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    (void)now_ns;
    cm1e_datagram_set(d, COMMAND_APRD, by_place(slave), REG_STATION_ADDRESS, 4);
    return true;
}

static void result_find(cm1e_bus_slave_t *slave, const cm1e_datagram_t *d, int64_t now_ns)
{
    const uint16_t station = cm1e_get_u16(d->data), alias = cm1e_get_u16(d->data + 2);
    /* Another station address means that a later slave is now at this place, and the expected one is still missing. */
    if (station == slave->facts.station && alias != slave->facts.alias)
        enter(slave, RECOVERY_RELEASE, now_ns);
    else if (station == 0 && slave->hot.moves)
        fail(slave, now_ns); /* the search gives the address to the slave that it has identified */
    else if ((station != 0 && station != slave->facts.station) || alias != slave->facts.alias)
        fail(slave, now_ns);
    else
        enter(slave, station ? RECOVERY_LOOK : RECOVERY_ADDRESS, now_ns);
}

static bool next_address(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    (void)now_ns;
    slave->recovery.address_given = true;
    cm1e_datagram_set(d, COMMAND_APRW, by_place(slave), REG_STATION_ADDRESS, 2);
    cm1e_put_u16(d->data, slave->facts.station);
    return true;
}

static void result_address(cm1e_bus_slave_t *slave, const cm1e_datagram_t *d, int64_t now_ns)
{
    const uint16_t before = cm1e_get_u16(d->data);
    memcpy(slave->recovery.data, d->data, sizeof before);
    if (before != 0 && before != slave->facts.station) {
        enter(slave, RECOVERY_RETURN, now_ns);
        return;
    }
    cm1e_dc_was_off(slave);
    enter(slave, RECOVERY_LOOK, now_ns);
}

static bool next_return(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    (void)now_ns;
    slave->recovery.address_given = false;
    return write_registers(slave, d, REG_STATION_ADDRESS, slave->recovery.data, 2);
}

static void result_return(cm1e_bus_slave_t *slave, const cm1e_datagram_t *d, int64_t now_ns)
{
    (void)d;
    enter(slave, RECOVERY_PAUSE, now_ns);
}

/** Takes the address back by the place of the device, because another slave may answer at the address too. Where
 *  optional slaves come and go, the slave at that place may have changed meanwhile. */
static bool next_release(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    (void)now_ns;
    if (slave->hot.moves)
        return write_register(slave, d, REG_STATION_ADDRESS, 0);
    cm1e_datagram_set(d, COMMAND_APWR, by_place(slave), REG_STATION_ADDRESS, 2);
    cm1e_put_u16(d->data, 0);
    return true;
}

static void result_release(cm1e_bus_slave_t *slave, const cm1e_datagram_t *d, int64_t now_ns)
{
    (void)d;
    if (slave->hot.optional)
        give_to_search(slave, cm1e_recovery_reason(slave->recovery.failed_at));
    else
        enter(slave, RECOVERY_PAUSE, now_ns);
}

static void result_next_step(cm1e_bus_slave_t *slave, const cm1e_datagram_t *d, int64_t now_ns)
{
    (void)d;
    advance(slave, now_ns);
}

static bool next_look(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    (void)now_ns;
    cm1e_datagram_set(d, COMMAND_FPRD, slave->facts.station, REG_AL_STATUS, 6);
    return true;
}

static void result_look(cm1e_bus_slave_t *slave, const cm1e_datagram_t *d, int64_t now_ns)
{
    /* In Safe-Operational or above it kept its configuration: only the watchdog or a request took it out of OP. If that
     * failed the last time, it must start from Init (AL status codes 0x0021, 0x0022 ...). */
    const uint16_t status = cm1e_get_u16(d->data), state = status & AL_STATE_MASK;
    const bool above = state == CM1E_AL_SAFE_OP || state == CM1E_AL_OP;
    const bool configured = above && slave->recovery.failed_at != RECOVERY_OP;
    if (status == CM1E_AL_OP) {
        succeed(slave, status, 0); /* the slave was never away */
        return;
    }
    if (!configured) /* its mailbox begins anew: a transfer need not wait for that to end */
        cm1e_coe_cancel(&slave->coe, CM1E_ERROR_BUS_LOST);
    enter(slave, configured ? RECOVERY_OP : RECOVERY_EEPROM, now_ns);
}

static bool next_eeprom(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    (void)now_ns;
    return write_registers(slave, d, REG_EEPROM_CONFIG, &(uint8_t){1}, 1);
}

static bool has_fmmus(const cm1e_bus_slave_t *slave) { return slave->placement.fmmu_count > 0; }

static bool next_unmap(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    static const uint8_t off[sizeof slave->placement.fmmus];
    (void)now_ns;
    return write_registers(slave, d, REG_FMMU0, off, slave->placement.fmmu_count * FMMU_BYTES);
}

/** A request to repeat an answer, sent before the slave lost its power, activates an empty SM1 if it comes after
 *  that. */
static bool next_clear(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    static const uint8_t inactive[4 * SYNC_MANAGER_BYTES];
    (void)now_ns;
    return write_registers(slave, d, REG_SM0, inactive, sizeof inactive);
}

static bool next_mailbox(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    (void)now_ns;
    cm1e_coe_reset(&slave->coe, CM1E_ERROR_BUS_LOST);
    return write_registers(slave, d, REG_SM0, slave->placement.sync_managers[0], 2 * SYNC_MANAGER_BYTES);
}

static bool next_process_data(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    (void)now_ns;
    return write_registers(slave, d, REG_SM2, slave->placement.sync_managers[2], 2 * SYNC_MANAGER_BYTES);
}

static bool next_fmmus(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    (void)now_ns;
    return write_registers(slave, d, REG_FMMU0, slave->placement.fmmus, slave->placement.fmmu_count * FMMU_BYTES);
}

static bool next_watchdog_divider(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    (void)now_ns;
    return write_register(slave, d, REG_WATCHDOG_DIVIDER, CM1E_WATCHDOG_DIVIDER);
}

static bool next_watchdog(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    (void)now_ns;
    return write_register(slave, d, REG_WATCHDOG_PROCESS_DATA, cm1e_bus_watchdog(slave));
}

/** Sets the clock. One that was far off comes nearer by a step with every frame. */
static bool next_clock(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    bool is_set;
    if (begins(slave))
        cm1e_dc_recover_begin(slave);
    const bool sends = cm1e_dc_recover_next(slave, d, now_ns, &is_set);
    if (is_set)
        advance(slave, now_ns);
    return sends;
}

/* ---- states ---------------------------------------------------------------------------------------------------- */

static bool next_state(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    if (begins(slave))
        cm1e_al_request(&slave->al, actions[slave->recovery.step].what, slave->recovery.deadline_ns);
    if (cm1e_al_next(&slave->al, d, now_ns))
        return true;
    return cm1e_al_idle(&slave->al) && end_step(slave, slave->al.error == CM1E_OK, now_ns);
}

static bool has_id(const cm1e_bus_slave_t *slave) { return slave->info.explicit_id != 0; }

static bool next_id(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    if (begins(slave))
        cm1e_al_read_id(&slave->al, slave->recovery.deadline_ns);
    if (cm1e_al_next(&slave->al, d, now_ns))
        return true;
    const bool good = slave->al.error == CM1E_OK && slave->al.explicit_id == slave->info.explicit_id;
    return cm1e_al_idle(&slave->al) && end_step(slave, good, now_ns);
}

static void result_al(cm1e_bus_slave_t *slave, const cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_al_result(&slave->al, d, now_ns);
}

/* ---- mailbox --------------------------------------------------------------------------------------------------- */

enum { OF_VENDOR = 1, OF_PRODUCT = 2, OF_SERIAL_NUMBER = 4 };

static bool has_coe(const cm1e_bus_slave_t *slave) { return slave->facts.coe; }
static bool has_serial(const cm1e_bus_slave_t *slave) { return has_coe(slave) && slave->info.serial_number != 0; }

/** Reads one sub-index of the identity object and compares it with what the scan found in the SII. */
static bool next_identity(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_recovery_t *recovery = &slave->recovery;
    const uint8_t subindex = actions[recovery->step].what;
    const uint32_t expected[] = {[OF_VENDOR] = slave->info.vendor_id, [OF_PRODUCT] = slave->info.product_code,
                                 [OF_SERIAL_NUMBER] = slave->info.serial_number};
    if (begins(slave)) {
        recovery->sdo = (cm1e_sdo_t){.position = slave->info.position, .index = OBJ_1018_IDENTITY,
                                     .subindex = subindex, .data = recovery->data, .size = sizeof recovery->data,
                                     .timeout_ns = SDO_STEP_NS, .state = CM1E_SDO_BUSY};
        cm1e_coe_begin(&slave->coe, &recovery->sdo, now_ns);
    }
    if (cm1e_coe_next(&slave->coe, d, now_ns))
        return true;
    if (!cm1e_coe_idle(&slave->coe))
        return false;
    const bool read = recovery->sdo.error == CM1E_OK && recovery->sdo.size == 4;
    const uint32_t value = read ? cm1e_get_u32(recovery->data) : 0;
    /* A device that does not have the sub-index, or a serial number of 0 there (UG 7.1.6: the default) and another one
     * in its EEPROM, leaves it unchecked. */
    const bool absent = recovery->sdo.error == CM1E_ERROR_SDO_ABORT ||
                        (read && value == 0 && subindex == OF_SERIAL_NUMBER);
    return end_step(slave, absent || (read && value == expected[subindex]), now_ns);
}

/** Begins the next transfer of a step. Without one it returns false: the step is over, and the recovery goes on if all
 *  was `good`. */
static bool begin_or_end(cm1e_bus_slave_t *slave, cm1e_sdo_t *sdo, bool good, int64_t now_ns)
{
    if (!sdo)
        return end_step(slave, good, now_ns);
    cm1e_coe_begin(&slave->coe, sdo, now_ns);
    return true;
}

static bool has_kind(const cm1e_bus_slave_t *slave)
{
    const cm1e_device_t *device = slave->info.device;
    return device && (device->recognised == CM1E_BY_OBJECTS ||
                      (device->recognised == CM1E_BY_PROFILE && slave->hot.planned));
}

/** Reads the objects that tell the kind of the device: the identity of a bridge does not tell its motors, and that of a
 *  foreign drive does not tell that it is a drive. */
static bool next_objects(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_recognition_t *job = &slave->recognition;
    if (begins(slave))
        cm1e_recognise_begin(job, slave->info.position, slave->recovery.deadline_ns);
    if (cm1e_coe_idle(&slave->coe)) {
        cm1e_sdo_t *sdo = cm1e_recognise_next(job, now_ns);
        if (!begin_or_end(slave, sdo, sdo || cm1e_recovery_is_recognised(slave), now_ns))
            return false;
    }
    return cm1e_coe_next(&slave->coe, d, now_ns);
}

static bool has_version(const cm1e_bus_slave_t *slave)
{
    return slave->facts.coe && (slave->hot.planned || cm1e_recovery_has_firmware(slave));
}

static bool next_version(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    if (begins(slave)) {
        memset(slave->version, 0, sizeof slave->version);
        slave->version_sdo = (cm1e_sdo_t){.position = slave->info.position, .index = OBJ_100A_SOFTWARE_VERSION,
                                          .data = slave->version, .size = sizeof slave->version - 1,
                                          .timeout_ns = SDO_STEP_NS, .state = CM1E_SDO_BUSY};
        cm1e_coe_begin(&slave->coe, &slave->version_sdo, now_ns);
    }
    if (cm1e_coe_next(&slave->coe, d, now_ns))
        return true;
    return cm1e_coe_idle(&slave->coe) && end_step(slave, cm1e_recovery_takes_version(slave), now_ns);
}

static bool is_planned(const cm1e_bus_slave_t *slave) { return slave->hot.planned; }

/** Places the process data. A slave without a PDO mapping that can be read has the process data of its SII. */
static bool next_place(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    (void)d;
    return end_step(slave, cm1e_hot_place(slave), now_ns);
}

/** Most slaves have nothing written. */
static bool has_setup(const cm1e_bus_slave_t *slave)
{
    return cm1e_setup_is_needed(cm1e_bus_setup_of(slave), cm1e_bus_setup_pulses(slave), false);
}

static bool has_setup_op(const cm1e_bus_slave_t *slave)
{
    return cm1e_setup_is_needed(cm1e_bus_setup_of(slave), cm1e_bus_setup_pulses(slave), true);
}

static bool next_setup(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_setup_job_t *job = &slave->setup;
    if (begins(slave))
        cm1e_setup_begin(job, slave->info.position, cm1e_bus_setup_of(slave), cm1e_bus_setup_pulses(slave),
                         slave->recovery.step == RECOVERY_SETUP_OP, slave->facts.swapped);
    if (cm1e_coe_idle(&slave->coe)) {
        cm1e_sdo_t *sdo = cm1e_setup_next(job);
        if (!begin_or_end(slave, sdo, job->error == CM1E_OK, now_ns))
            return false;
    }
    return cm1e_coe_next(&slave->coe, d, now_ns);
}

static bool has_mapping(const cm1e_bus_slave_t *slave)
{
    return cm1e_bus_has_motors(slave) || slave->by_pdos || (slave->hot.planned && slave->facts.coe);
}

/** Assigns the PDOs again; the layout must not change, because the image of the running bus is fixed. */
static bool next_mapping(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_mapping_job_t *job = &slave->mapping;
    const bool motors = cm1e_bus_has_motors(slave);
    if (begins(slave)) {
        const cm1e_pdo_choice_t choice = slave->hot.planned && motors ? slave->info.device->pdos(slave->hot.axis)
                                                                      : job->choice;
        if (motors)
            cm1e_mapping_begin(job, slave->info.position, &choice);
        else
            cm1e_mapping_begin_any(job, slave->info.position, slave->facts.swapped);
    }
    if (cm1e_coe_idle(&slave->coe)) {
        cm1e_sdo_t *sdo = cm1e_mapping_next(job);
        if (!begin_or_end(slave, sdo, !sdo && job->error == CM1E_OK && cm1e_recovery_takes_mapping(slave), now_ns))
            return false;
    }
    return cm1e_coe_next(&slave->coe, d, now_ns);
}

static void result_coe(cm1e_bus_slave_t *slave, const cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_coe_result(&slave->coe, d, now_ns);
}

/* ---- the sequence ---------------------------------------------------------------------------------------------- */

static const cm1e_recovery_action_t actions[RECOVERY_STEPS] = {
    [RECOVERY_FIND] = {STEP_NS, next_find, result_find},
    [RECOVERY_ADDRESS] = {STEP_NS, next_address, result_address},
    [RECOVERY_RETURN] = {STEP_NS, next_return, result_return},
    [RECOVERY_LOOK] = {STEP_NS, next_look, result_look},
    [RECOVERY_EEPROM] = {STEP_NS, next_eeprom, result_next_step},
    [RECOVERY_INIT] = {CM1E_STATE_TIMEOUT_NS, next_state, result_al, .what = CM1E_AL_INIT},
    [RECOVERY_UNMAP] = {STEP_NS, next_unmap, result_next_step, .needed = has_fmmus},
    [RECOVERY_CLEAR] = {STEP_NS, next_clear, result_next_step},
    [RECOVERY_MAILBOX] = {STEP_NS, next_mailbox, result_next_step},
    [RECOVERY_PRE_OP] = {CM1E_STATE_TIMEOUT_NS, next_state, result_al, .what = CM1E_AL_PRE_OP},
    [RECOVERY_ID] = {STEP_NS, next_id, result_al, .needed = has_id},
    [RECOVERY_VENDOR] = {SDO_STEP_NS, next_identity, result_coe, .what = OF_VENDOR, .needed = has_coe},
    [RECOVERY_PRODUCT] = {SDO_STEP_NS, next_identity, result_coe, .what = OF_PRODUCT, .needed = has_coe},
    [RECOVERY_SERIAL] = {SDO_STEP_NS, next_identity, result_coe, .what = OF_SERIAL_NUMBER, .needed = has_serial},
    [RECOVERY_OBJECTS] = {OBJECTS_STEP_NS, next_objects, result_coe, .needed = has_kind},
    [RECOVERY_VERSION] = {SDO_STEP_NS, next_version, result_coe, .needed = has_version},
    [RECOVERY_SETUP] = {MAPPING_STEP_NS, next_setup, result_coe, .needed = has_setup},
    [RECOVERY_MAPPING] = {MAPPING_STEP_NS, next_mapping, result_coe, .needed = has_mapping},
    [RECOVERY_PLACE] = {STEP_NS, next_place, result_next_step, .needed = is_planned},
    [RECOVERY_PROCESS_DATA] = {STEP_NS, next_process_data, result_next_step},
    [RECOVERY_FMMUS] = {STEP_NS, next_fmmus, result_next_step, .needed = has_fmmus},
    [RECOVERY_WATCHDOG_DIVIDER] = {STEP_NS, next_watchdog_divider, result_next_step},
    [RECOVERY_WATCHDOG] = {STEP_NS, next_watchdog, result_next_step},
    [RECOVERY_CLOCK] = {CLOCK_STEP_NS, next_clock, cm1e_dc_recovered},
    [RECOVERY_SAFE_OP] = {CM1E_STATE_TIMEOUT_NS, next_state, result_al, .what = CM1E_AL_SAFE_OP},
    [RECOVERY_SETUP_OP] = {MAPPING_STEP_NS, next_setup, result_coe, .needed = has_setup_op},
    [RECOVERY_OP] = {CM1E_STATE_TIMEOUT_NS, next_state, result_al, .what = CM1E_AL_OP},
    [RECOVERY_RELEASE] = {RELEASE_NS, next_release, result_release},
};

bool cm1e_recovery_next(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_recovery_t *recovery = &slave->recovery;
    if (recovery->step == RECOVERY_PAUSE) {
        if (now_ns < recovery->deadline_ns)
            return false;
        recovery->attempts++;
        recovery->address_given = false;
        enter(slave, RECOVERY_FIND, now_ns);
    } else if (now_ns >= recovery->deadline_ns) {
        fail(slave, now_ns);
        return false;
    }
    if (recovery->doubts) {
        cm1e_datagram_set(d, COMMAND_FPRD, slave->facts.station, REG_AL_STATUS, 2);
        return true;
    }
    return actions[recovery->step].next(slave, d, now_ns);
}

/** Whether the slave has lost its power again: its controller answers every question for a register at once, while the
 *  time of a step is that of its processor, up to 10 s. A mailbox does not answer while it is full: then the controller
 *  is asked for a register. */
static bool is_gone(cm1e_recovery_t *recovery, const cm1e_datagram_t *d)
{
    enum { UNANSWERED_LIMIT = 10, REGISTERS_END = 0x1000 };
    recovery->doubts = d->working_counter == 0 && d->offset >= REGISTERS_END;
    if (d->working_counter > 0)
        recovery->unanswered = 0;
    else if (d->working_counter == 0 && d->offset < REGISTERS_END)
        recovery->unanswered++;
    return recovery->step > RECOVERY_LOOK && recovery->step != RECOVERY_RELEASE &&
           recovery->unanswered >= UNANSWERED_LIMIT;
}

void cm1e_recovery_result(cm1e_bus_slave_t *slave, const cm1e_datagram_t *d, int64_t now_ns)
{
    const cm1e_recovery_step_t step = slave->recovery.step;
    const bool doubted = slave->recovery.doubts;
    if (step > RECOVERY_PAUSE && is_gone(&slave->recovery, d))
        fail(slave, now_ns);
    if (step <= RECOVERY_PAUSE || slave->recovery.step != step || doubted)
        return;
    /* The sub-machines handle losses themselves; a register without an answer is read again until the deadline. */
    const bool machine = actions[step].result == result_al || actions[step].result == result_coe;
    if (machine || d->working_counter == (d->command == COMMAND_APRW ? 3 : 1))
        actions[step].result(slave, d, now_ns);
}
