/*
 * Fault reset: waits until the drive takes part in the cycle, gives one short edge of controlword bit 7, and waits for
 * the fault bit to go. From V1.3.5 on clearing a power-up fault 0x7510 resets the device (UG 10.1): it leaves the bus,
 * comes back, and would do so again and again while the bit stayed set. So the bit is set once and never for long.
 */
#include "drive/drive_kind.h"
#include "drive/drive_private.h"

static const int64_t online_timeout_ns = 10000 * MS_IN_NS;
static const int64_t edge_ns = 20 * MS_IN_NS;
static const int64_t clear_timeout_ns = 2000 * MS_IN_NS;
static const int64_t settle_ns = 200 * MS_IN_NS;
static const int64_t recovery_interval_ns = 1000 * MS_IN_NS;

void cm1e_drive_reset_start(cm1e_drive_t *drive)
{
    drive->reset.phase = RESET_WAIT_ONLINE;
    drive->reset.deadline_ns = drive->now_ns + online_timeout_ns;
    drive->reset.settle_ns = 0;
    drive->reset.recovery_ns = drive->now_ns;
}

static void request_recovery(cm1e_drive_t *drive)
{
    if (cm1e_drive_operational(drive) || drive->now_ns < drive->reset.recovery_ns)
        return;
    cm1e_bus_request_recovery(drive->bus, drive->position);
    drive->reset.recovery_ns = drive->now_ns + recovery_interval_ns;
}

static void finish(cm1e_drive_t *drive, cm1e_error_t error)
{
    drive->reset.phase = RESET_IDLE;
    drive->torque.was_enabled = false;
    drive->torque.asked = false;
    if (error == CM1E_OK) {
        drive->fault = (cm1e_drive_fault_t){0};
        cm1e_drive_mode_forget(drive);
        cm1e_drive_digital_forget(drive);
        return;
    }
    drive->fault.error = CM1E_OK;
    cm1e_drive_fail(drive, error);
}

/* A slave that did not come back keeps its fault. A slave that is there and still shows a fault did not clear it. */
static void give_up(cm1e_drive_t *drive)
{
    if (drive->feedback.online)
        finish(drive, CM1E_ERROR_DRIVE_RESET_TIMEOUT);
    else if (!cm1e_drive_operational(drive))
        finish(drive, drive->watch.lost ? CM1E_ERROR_AXIS_OFFLINE : CM1E_ERROR_BUS_STATE);
    else
        finish(drive, drive_fault_allows_ramp(drive->fault.error) ? drive->fault.error : CM1E_ERROR_BUS_LOST);
}

static void wait_online(cm1e_drive_t *drive)
{
    if (drive->watch.absent) {
        finish(drive, CM1E_ERROR_AXIS_OFFLINE);
    } else if (drive->feedback.online && cm1e_bus_slave_looks(drive->bus, drive->position) == drive->looks) {
        /* Frames come back again, and what is known of its state is from before: its watchdog may have ended
         * meanwhile. */
    } else if (drive->feedback.online && !drive->feedback.fault) {
        finish(drive, CM1E_OK);
    } else if (drive->feedback.online && drive->mode.words != drive->mode.wanted->words) {
        /* The error stopped a switch of mode. That switch is given up first, because the words have no meaning until
         * then. */
    } else if (drive->feedback.online) {
        drive->reset.phase = RESET_EDGE;
        drive->reset.until_ns = drive->now_ns + edge_ns;
    } else {
        request_recovery(drive);
    }
}

static bool device_resets(const cm1e_drive_t *drive)
{
    const cm1e_device_error_t *error = drive->kind->error(drive->fault.device_code);
    const bool capable = !drive->firmware || drive->firmware->communication_fault_resets;
    return capable && error && error->restarts;
}

static void edge(cm1e_drive_t *drive)
{
    const bool cleared = drive->feedback.online && !drive->feedback.fault;
    if (drive->now_ns < drive->reset.until_ns && cm1e_drive_operational(drive) && !cleared)
        return;
    drive->reset.phase = RESET_RELEASED;
    drive->reset.deadline_ns = drive->now_ns + (device_resets(drive) ? online_timeout_ns : clear_timeout_ns);
    /* A device that is about to reset may clear its fault bit before it leaves the bus. */
    drive->reset.settle_ns = drive->now_ns + (device_resets(drive) ? settle_ns : drive->kind->reset_settle_ns);
}

static void released(cm1e_drive_t *drive)
{
    if (!drive->feedback.online)
        request_recovery(drive);
    else if (!drive->feedback.fault && drive->now_ns >= drive->reset.settle_ns)
        finish(drive, CM1E_OK);
}

void cm1e_drive_reset_step(cm1e_drive_t *drive)
{
    static void (*const steps[])(cm1e_drive_t *) = {
        [RESET_WAIT_ONLINE] = wait_online, [RESET_EDGE] = edge, [RESET_RELEASED] = released,
    };
    steps[drive->reset.phase](drive);
    if (drive->reset.phase != RESET_IDLE && drive->now_ns >= drive->reset.deadline_ns)
        give_up(drive);
}

bool cm1e_drive_resetting(const cm1e_drive_t *drive)
{
    return drive->reset.phase != RESET_IDLE || (drive->command.reset && !drive->reset.before);
}
