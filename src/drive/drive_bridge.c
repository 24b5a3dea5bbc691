/* A motor behind an EtherCAT Cool MUSCLE Bridge: what its configuration has to state, and what of it is asked over SDO
 * beside the cycle. */
#include "drive/drive_kind.h"
#include "drive/drive_private.h"

/* 0x6064 of a motor that holds may swing by some pulses. */
enum { REST_COUNTS = 3 };
enum { STATUS_OF_AXIS_1 = 5, STATUS_TRIES = 3 };
static const int64_t status_timeout_ns = 300 * MS_IN_NS;

cm1e_bridge_motor_t cm1e_drive_bridge_motor(const cm1e_drive_t *drive)
{
    return cm1e_bridge_motor(drive->bridge, drive->config->channel - 1u);
}

cm1e_error_t cm1e_drive_init_bridge(cm1e_drive_t *drive, cm1e_diag_t *diag)
{
    const cm1e_axis_config_t *config = drive->config;
    const cm1e_slave_info_t *slave = cm1e_bus_slave(drive->bus, drive->position);
    if (config->channel > CM1E_BRIDGE_AXES || !slave || !slave->is_bridge)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "Axis \"%s\" (slave %u): channel %u is configured; the slave would have to be an EtherCAT "
                             "Cool MUSCLE Bridge, which has channels 1 ... %u.", config->name, drive->position,
                             config->channel, CM1E_BRIDGE_AXES);
    drive->bridge = slave->model;
    if (!config->k37_stated)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "Axis \"%s\" (slave %u, channel %u): K37 of the motor, its resolution, is not stated, and "
                             "counts have no meaning without it. Ask the motor with the CML string \"K37.%u\" and state "
                             "k37 in the configuration of the axis.", config->name, drive->position, config->channel,
                             config->channel);
    const cm1e_bridge_motor_t motor = cm1e_drive_bridge_motor(drive);
    drive->position_most = cm1e_bridge_position_limit(motor, config->k37);
    drive->position_least = -drive->position_most;
    if (drive->position_most == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "Axis \"%s\" (slave %u, channel %u): a %s knows no K37 of %u (BR appendix 5). Ask the motor "
                             "with the CML string \"K37.%u\".", config->name, drive->position, config->channel,
                             cm1e_bridge_motor_name(motor), config->k37, config->channel);
    return CM1E_OK;
}

static void watch_rest(cm1e_drive_t *drive)
{
    const int32_t position = drive->feedback.position;
    const int64_t way = (int64_t)position - drive->rest_position;
    if (!drive->feedback.fresh || (way <= REST_COUNTS && way >= -REST_COUNTS))
        return;
    drive->rest_position = position;
    drive->rest_since_ns = drive->now_ns;
}

/* BR 6.1.3, note: the statusword shows that there is an error, F530 which. One question, asked again where the answer
 * fails; it is not worth more than that. */
static void ask_status(cm1e_drive_t *drive)
{
    cm1e_drive_fault_t *fault = &drive->fault;
    if (drive->status_reading) {
        const cm1e_sdo_state_t state = cm1e_sdo_state(&drive->status_sdo);
        if (state == CM1E_SDO_BUSY)
            return;
        drive->status_reading = false;
        if (state == CM1E_SDO_DONE && drive->status_sdo.size > 0 && fault->error) {
            fault->motor_status = drive->status_data[0]; /* UDINT, of which the guide uses eight bits */
            fault->motor_status_known = true;
        }
        return;
    }
    if (fault->error == CM1E_OK)
        drive->status_tries = 0;
    else if (!fault->motor_status_known && drive->status_tries < STATUS_TRIES && drive->feedback.online) {
        drive->status_tries++;
        drive->status_sdo = (cm1e_sdo_t){
            .position = drive->position, .index = OBJ_F530_SYSTEM_INFO,
            .subindex = (uint8_t)(STATUS_OF_AXIS_1 + drive->config->channel - 1), .data = drive->status_data,
            .size = sizeof drive->status_data, .timeout_ns = status_timeout_ns,
        };
        drive->status_reading = cm1e_sdo_submit(drive->bus, &drive->status_sdo) == CM1E_OK;
    }
}

void cm1e_drive_bridge_step(cm1e_drive_t *drive)
{
    watch_rest(drive);
    ask_status(drive);
    cm1e_drive_cmd_step(drive);
    cm1e_drive_digital_step(drive);
}
