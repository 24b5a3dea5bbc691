#include "drive/drive_kind.h"

#include "drive/drive_private.h"

enum { MAPPED_DYNAMIC = 1 << CM1E_MAPPING_DYNAMIC, MAPPED_CSP = 1 << CM1E_MAPPING_CSP,
       MAPPED_CSV = 1 << CM1E_MAPPING_CSV, MAPPED_PROFILE = 1 << CM1E_MAPPING_PROFILE,
       MAPPED_ALL = MAPPED_DYNAMIC | MAPPED_CSP | MAPPED_CSV | MAPPED_PROFILE };

#define SLOT(member) offsetof(cm1e_drive_t, member)
#define COUNT(table) (sizeof(table) / sizeof(table)[0])
#define NO_TARGET CM1E_DRIVE_NO_TARGET
#define WAYS_ALL CM1E_DRIVE_WAYS_ALL

const cm1e_drive_words_t cm1e_drive_words_unknown = {0};

/* ---- CM1-E ------------------------------------------------------------------------------------------------------ */

/* Sizes: UG 4.4 and UG 7.2 disagree on 0x6077 (16 or 32 bits), and CiA 402 has digital I/O in 32 bits. */
static const cm1e_drive_object_t cm1e_objects[] = {
    {SLOT(out_controlword), true, OBJ_6040_CONTROLWORD, 2, 2, MAPPED_ALL, "Controlword"},
    {SLOT(out_position), true, OBJ_607A_TARGET_POSITION, 4, 4, MAPPED_DYNAMIC | MAPPED_CSP | MAPPED_PROFILE,
     "Target position"},
    {SLOT(out_velocity), true, OBJ_60FF_TARGET_VELOCITY, 4, 4, MAPPED_DYNAMIC | MAPPED_CSV | MAPPED_PROFILE,
     "Target velocity"},
    {SLOT(out_mode), true, OBJ_6060_MODES_OF_OPERATION, 1, 1, MAPPED_DYNAMIC, "Modes of operation"},
    {SLOT(out_digital), true, OBJ_60FE_DIGITAL_OUTPUTS, 2, 4, 0, "Digital outputs"},
    {SLOT(out_profile_velocity), true, OBJ_6081_PROFILE_VELOCITY, 4, 4, 0, "Profile velocity"},
    {SLOT(out_profile_acceleration), true, OBJ_6083_PROFILE_ACCELERATION, 4, 4, 0, "Profile acceleration"},
    {SLOT(in_statusword), false, OBJ_6041_STATUSWORD, 2, 2, MAPPED_ALL, "Statusword"},
    {SLOT(in_error), false, OBJ_603F_ERROR_CODE, 2, 2, 0, "Error code"},
    {SLOT(in_position), false, OBJ_6064_POSITION_ACTUAL_VALUE, 4, 4, MAPPED_ALL, "Position actual value"},
    {SLOT(in_velocity), false, OBJ_606C_VELOCITY_ACTUAL_VALUE, 4, 4, 0, "Velocity actual value"},
    {SLOT(in_torque), false, OBJ_6077_TORQUE_ACTUAL_VALUE, 2, 4, 0, "Torque actual value"},
    {SLOT(in_digital), false, OBJ_60FD_DIGITAL_INPUTS, 2, 4, 0, "Digital inputs"},
    {SLOT(in_temperature), false, OBJ_2301_TEMPERATURE, 2, 4, 0, "Drive temperature"},
    {SLOT(in_dc), false, OBJ_6079_DC_LINK_VOLTAGE, 2, 4, 0, "DC link voltage"},
    {SLOT(in_mode), false, OBJ_6061_MODES_OF_OPERATION_DISPLAY, 1, 1, MAPPED_DYNAMIC, "Modes of operation display"},
};

/* UG 6.1.2, 6.1.3 */
static const cm1e_drive_words_t cm1e_words = {
    .states = cm1e_fsa_table, .voltage = STATUSWORD_VOLTAGE_ENABLED, .fault = STATUSWORD_FAULT,
    .target_reached = STATUSWORD_TARGET_REACHED, .bit12 = STATUSWORD_BIT12, .bit13 = STATUSWORD_BIT13,
    .no_torque = 0x0006, .fault_reset = 0x0086,
};

/* UG 6.2; homing needs no special mapping (UG 6.2.4). */
static const cm1e_drive_mode_t cm1e_mode_rows[] = {
    {.mode = CM1E_MODE_PP, .abbreviation = "PP", .words = &cm1e_words, .target = SLOT(out_position), .torque = true,
     .holds_position = true, .halts = true, .ways = WAYS_ALL},
    {.mode = CM1E_MODE_PV, .abbreviation = "PV", .words = &cm1e_words, .target = SLOT(out_velocity), .torque = true,
     .halts = true, .ways = WAYS_ALL},
    {.mode = CM1E_MODE_HM, .abbreviation = "HM", .words = &cm1e_words, .target = NO_TARGET, .torque = true,
     .halts = true, .ways = WAYS_ALL},
    {.mode = CM1E_MODE_CSP, .abbreviation = "CSP", .words = &cm1e_words, .target = SLOT(out_position), .torque = true,
     .holds_position = true, .ways = WAYS_ALL},
    {.mode = CM1E_MODE_CSV, .abbreviation = "CSV", .words = &cm1e_words, .target = SLOT(out_velocity), .torque = true,
     .ways = WAYS_ALL},
};

const cm1e_drive_kind_t cm1e_drive_kind_cm1e = {
    .name = "CM1-E",
    .objects = cm1e_objects, .object_count = COUNT(cm1e_objects),
    .mappings = {
        [CM1E_MAPPING_DYNAMIC] = {"dynamic (0x1600/0x1A00)", CM1E_MODE_CSP},
        [CM1E_MAPPING_CSP] = {"CSP (0x1601/0x1A01)", CM1E_MODE_CSP},
        [CM1E_MAPPING_CSV] = {"CSV (0x1602/0x1A02)", CM1E_MODE_CSV},
        [CM1E_MAPPING_PROFILE] = {"profile (0x1603/0x1A03)", CM1E_MODE_CSP},
    },
    .modes = cm1e_mode_rows, .mode_count = COUNT(cm1e_mode_rows),
    .refusal = "Check the mapping and the firmware",
    .init = cm1e_drive_init_cm1e,
};

/* ---- a motor behind a bridge ------------------------------------------------------------------------------------ */

/* BR 6.3.1; appendix 6 gives the words 32 bits, which nothing else does. */
static const cm1e_drive_object_t bridge_objects[] = {
    {SLOT(out_controlword), true, OBJ_6040_CONTROLWORD, 2, 2, MAPPED_ALL, "Controlword"},
    {SLOT(out_position), true, OBJ_607A_TARGET_POSITION, 4, 4, MAPPED_ALL, "Target position"},
    {SLOT(in_statusword), false, OBJ_6041_STATUSWORD, 2, 2, MAPPED_ALL, "Statusword"},
    {SLOT(in_position), false, OBJ_6064_POSITION_ACTUAL_VALUE, 4, 4, MAPPED_ALL, "Position actual value"},
};

/* BR 6.1.2, 6.1.3: an error shows as bit 14, and as a state with bit 3. */
#define PROFILE_STATUSWORD                                                                                          \
    .states = cm1e_fsa_bridge_table, .fault = CM1E_BRIDGE_STATUSWORD_ERROR | STATUSWORD_FAULT,                      \
    .motor_free = CM1E_BRIDGE_STATUSWORD_FREE,                                                                      \
    .target_reached = STATUSWORD_TARGET_REACHED, .bit12 = STATUSWORD_BIT12, .bit13 = STATUSWORD_BIT13
static const cm1e_drive_words_t profile_words = {PROFILE_STATUSWORD, .no_torque = 0x0006, .fault_reset = 0x0086};
/* Strings go over the serial line only while no controlword does (BR appendix 2). */
static const cm1e_drive_words_t cml_words = {PROFILE_STATUSWORD, .no_torque = 0x0000};
/* BR 7.1.3: no state. */
static const cm1e_drive_words_t cmd_words = {.commands = true, .own_coding = true};
/* BR 7.1.2, 7.1.3: the state in four bits, what the motor says in bits 8 to 11: 1, 2, 4 and 1111b are errors, 1000b is
 * in position. Bit 7 is an output here: there is no fault reset. */
static const cm1e_drive_words_t cpio_words = {
    .states = cm1e_fsa_cpio_table, .fault = 0x0700 | STATUSWORD_FAULT, .target_reached = 0x0800,
    .inputs = 0x00F0, .outputs = 0x00F0, .mark = 0xC000, .no_torque = 0x0006, .fault_reset = 0x0006,
    .own_coding = true,
};

/* The drawing of BR 6: three arrows lead into each of CMD, CML and CPIO, two into csp, one into hm. */
enum { CSP = 0, HM, CML, CMD, CPIO };
static const cm1e_drive_mode_t bridge_mode_rows[] = {
    [CSP] = {.mode = CM1E_BRIDGE_MODE_CSP, .abbreviation = "CSP", .words = &profile_words,
             .target = SLOT(out_position), .torque = true, .holds_position = true, .rest = true,
             .ways = 1 << HM | 1 << CML},
    [HM] = {.mode = CM1E_BRIDGE_MODE_HM, .abbreviation = "HM", .words = &profile_words, .target = NO_TARGET,
            .torque = true, .rest = true, .ways = 1 << CSP},
    [CML] = {.mode = CM1E_BRIDGE_MODE_CML, .abbreviation = "CML", .words = &cml_words, .target = NO_TARGET,
             .rest = true, .ways = 1 << CSP | 1 << CMD | 1 << CPIO,
             .cure = "In CML the bridge takes no controlword: end the error with a CML string (\"(\") or switch the "
                     "bridge off and on"},
    [CMD] = {.mode = CM1E_BRIDGE_MODE_CMD, .abbreviation = "CMD", .words = &cmd_words, .target = NO_TARGET,
             .ways = 1 << CSP | 1 << CML | 1 << CPIO, .leaves_abnormal = true,
             .cure = "In CMD an error is ended by the command Motor enable, or by switching the bridge off and on"},
    [CPIO] = {.mode = CM1E_BRIDGE_MODE_CPIO, .abbreviation = "CPIO", .words = &cpio_words,
              .target = SLOT(out_position), .torque = true, .holds_position = true, .rest = true,
              .ways = 1 << CSP | 1 << CML | 1 << CMD, .leaves_abnormal = true,
              .cure = "In CPIO the bridge has no fault reset: switch it off and on"},
};

const cm1e_drive_kind_t cm1e_drive_kind_bridge = {
    .name = "motor behind an EtherCAT Cool MUSCLE Bridge",
    .objects = bridge_objects, .object_count = COUNT(bridge_objects),
    .mappings = {[CM1E_MAPPING_DYNAMIC] = {"csp (0x1601/0x1A01 ...)", CM1E_MODE_CSP}},
    .modes = bridge_mode_rows, .mode_count = COUNT(bridge_mode_rows),
    .no_way = "HM is reached from CSP only, CSP from HM and CML only, the other modes from each other and from CSP "
              "(BR 6): from CMD and CPIO the way back to CSP is switching the bridge off and on",
    .refusal = "The bridge switches when the motor stands, without an error of the motor, and not from every mode to "
               "every other one: look at its state with cm1e status; from CMD and CPIO there is no way back but "
               "switching it off and on",
    .asks_mode_first = true, .mode_supervised = true,
    /* A motor that does not answer is missed after some exchanges only; until then 0x6064 is where it was once. */
    .reset_settle_ns = 100 * MS_IN_NS,
    .init = cm1e_drive_init_bridge, .step = cm1e_drive_bridge_step,
};

/* ---- no device --------------------------------------------------------------------------------------------------- */

static const cm1e_drive_words_t virtual_words = {.states = cm1e_fsa_table};
static const cm1e_drive_mode_t virtual_mode_rows[] = {
    {.mode = CM1E_MODE_CSP, .abbreviation = "CSP", .words = &virtual_words, .target = NO_TARGET, .torque = true,
     .holds_position = true, .ways = WAYS_ALL},
};

const cm1e_drive_kind_t cm1e_drive_kind_virtual = {
    .name = "virtual axis", .modes = virtual_mode_rows, .mode_count = COUNT(virtual_mode_rows),
};

const cm1e_drive_mode_t *cm1e_drive_mode_row(const cm1e_drive_kind_t *kind, int8_t mode)
{
    for (size_t i = 0; i < kind->mode_count; i++)
        if (kind->modes[i].mode == mode)
            return &kind->modes[i];
    return NULL;
}
