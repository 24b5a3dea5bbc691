/* A motor behind an EtherCAT Cool MUSCLE Bridge: the check of its configuration, whether it is at rest, and its status
 * (F530), which is read by SDO beside the cycle. */
#include "drive/drive_bridge.h"

#include <stdlib.h>

#include "device/bridge_status.h"
#include "drive/drive_kind.h"
#include "drive/drive_private.h"

/* The 0x6064 of a motor that holds its position may vary by some pulses. With few pulses in a revolution (K37), one
 * pulse is a long way and takes time. So rest is a speed below a twentieth of a revolution per second. */
enum { REST_COUNTS = 3, REST_COUNTS_COARSE = 1, COARSE_COUNTS_PER_REVOLUTION = 5000 };
static const int64_t rest_revolution_ns = 40000 * MS_IN_NS;
enum { STATUS_TRIES = 3 };
static const int64_t rest_ns = 20 * MS_IN_NS;
static const int64_t status_timeout_ns = 300 * MS_IN_NS;
static const int64_t status_holds_ns = 3 * MS_IN_NS;

cm1e_bridge_motor_t cm1e_drive_bridge_motor(const cm1e_drive_t *drive)
{
    return cm1e_bridge_motor(drive->device->model, drive->config->channel - 1u);
}

static cm1e_error_t submit_cml(void *bus, cm1e_sdo_t *sdo) { return cm1e_sdo_submit(bus, sdo); }

static void set_rest(cm1e_drive_bridge_t *behind, int32_t counts_per_revolution)
{
    const int64_t time_ns = rest_revolution_ns / counts_per_revolution;
    behind->rest_ns = time_ns > rest_ns ? time_ns : rest_ns;
    behind->rest_counts = counts_per_revolution < COARSE_COUNTS_PER_REVOLUTION ? REST_COUNTS_COARSE : REST_COUNTS;
}

cm1e_error_t cm1e_drive_init_bridge(cm1e_drive_t *drive, cm1e_diag_t *diag)
{
    const cm1e_axis_config_t *config = drive->config;
    if (!config->k37_stated)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "Axis \"%s\" (slave %u, channel %u): K37 of the motor, its resolution, is not stated, and "
                             "counts have no meaning without it. Ask the motor with the CML string \"K37.%u\" and "
                             "state k37 in the configuration of the axis.", config->name, drive->position,
                             config->channel, config->channel);
    const cm1e_bridge_motor_t motor = cm1e_drive_bridge_motor(drive);
    drive->range.position_most = cm1e_bridge_position_limit(motor, config->k37);
    drive->range.position_least = -drive->range.position_most;
    if (drive->range.position_most == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "Axis \"%s\" (slave %u, channel %u): a %s knows no K37 of %u (BR appendix 5). Ask the "
                             "motor with the CML string \"K37.%u\".", config->name, drive->position, config->channel,
                             cm1e_bridge_motor_name(motor), config->k37, config->channel);
    drive->behind = calloc(1, sizeof *drive->behind);
    if (!drive->behind)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for axis \"%s\".", config->name);
    set_rest(drive->behind, cm1e_bridge_counts_per_revolution(config->k37));
    cm1e_drive_cml_init(&drive->behind->cml, drive->position, config->channel, submit_cml, drive->bus);
    return CM1E_OK;
}

bool cm1e_drive_rests(const cm1e_drive_t *drive)
{
    return drive->behind && drive->actual.sent_ns - drive->behind->rest_since_ns >= drive->behind->rest_ns;
}

static bool near(const cm1e_drive_bridge_t *behind, int32_t a, int32_t b)
{
    const int64_t way = (int64_t)a - b;
    return way <= behind->rest_counts && way >= -behind->rest_counts;
}

/* A target that was just written will move the motor soon. The time is that of the frames that brought the positions:
 * around a pause of the cycle two of them may be 20 cycles apart, by number, and come from nearly the same moment. */
static void watch_rest(cm1e_drive_t *drive)
{
    cm1e_drive_bridge_t *behind = drive->behind;
    if (near(behind, drive->feedback.position, behind->rest_position) &&
        near(behind, drive->target.position, behind->rest_target))
        return;
    behind->rest_position = drive->feedback.position;
    behind->rest_target = drive->target.position;
    behind->rest_since_ns = drive->actual.sent_ns;
}

/* The error is one of the motor and not of the bus. */
static bool is_of_motor(cm1e_error_t error)
{
    return error <= CM1E_ERROR_DRIVE_FAULT && error >= CM1E_ERROR_DRIVE_RESET_TIMEOUT;
}

static void read_status(cm1e_drive_t *drive)
{
    cm1e_drive_bridge_t *behind = drive->behind;
    behind->status_sdo = (cm1e_sdo_t){
        .position = drive->position, .index = OBJ_F530_SYSTEM_INFO,
        .subindex = CM1E_BRIDGE_STATUS_SUBINDEX(drive->config->channel), .data = behind->status_data,
        .size = sizeof behind->status_data, .timeout_ns = status_timeout_ns,
    };
    behind->status_reading = cm1e_sdo_submit(drive->bus, &behind->status_sdo) == CM1E_OK;
}

static void take_status(cm1e_drive_t *drive)
{
    cm1e_drive_bridge_t *behind = drive->behind;
    const uint8_t status = behind->status_data[0]; /* UDINT, of which the guide uses eight bits */
    behind->status_sound = !cm1e_bridge_status_is_error(cm1e_drive_bridge_motor(drive), status);
    behind->status_until_ns = drive->now_ns + status_holds_ns;
    if (drive->fault.error != CM1E_OK) {
        drive->fault.motor_status = status;
        drive->fault.motor_status_known = true;
    }
}

bool cm1e_drive_bridge_sound(cm1e_drive_t *drive)
{
    cm1e_drive_bridge_t *behind = drive->behind;
    const bool known = drive->now_ns < behind->status_until_ns;
    behind->status_wanted = !known;
    return known && behind->status_sound;
}

/* BR 6.1.3, note: the statusword shows that there is an error, and F530 shows which one. F530 is read once for an
 * error, and again only if that transfer fails. */
static void ask_status(cm1e_drive_t *drive)
{
    cm1e_drive_fault_t *fault = &drive->fault;
    cm1e_drive_bridge_t *behind = drive->behind;
    if (behind->status_reading) {
        const cm1e_sdo_state_t state = cm1e_sdo_state(&behind->status_sdo);
        if (state == CM1E_SDO_BUSY)
            return;
        behind->status_reading = false;
        if (state == CM1E_SDO_DONE && behind->status_sdo.size > 0)
            take_status(drive);
        return;
    }
    if (fault->error == CM1E_OK)
        behind->status_tries = 0;
    const bool missing = is_of_motor(fault->error) && !fault->motor_status_known;
    const bool again = missing && behind->status_tries < STATUS_TRIES;
    if (!(again || behind->status_wanted) || !drive->feedback.online)
        return;
    behind->status_tries += again;
    behind->status_wanted = false;
    read_status(drive);
}

void cm1e_drive_bridge_step(cm1e_drive_t *drive)
{
    cm1e_drive_bridge_t *behind = drive->behind;
    watch_rest(drive);
    ask_status(drive);
    cm1e_drive_cmd_step(drive);
    cm1e_drive_digital_step(drive);
    /* The switch to CML itself was made after five cycles of 0000h, which stays while it is shown (BR appendix 2). */
    const bool cml = drive->feedback.mode == CM1E_BRIDGE_MODE_CML && drive->mode.words == drive->mode.wanted->words;
    cm1e_drive_cml_step(&behind->cml, drive->now_ns, cml && cm1e_drive_operational(drive));
}
