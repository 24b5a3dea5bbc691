#include "generate/ec_extend.h"

#include <libxml/tree.h>
#include <stdlib.h>
#include <string.h>

/* F: the names that UG 11.2 and the file of Trio's (docs/TRIO.md) show. What CiA 402 calls the same is ours. */
static const cm1e_ec_name_t names[] = {
    {"CTRL_WORD", false, OBJ_6040_CONTROLWORD},
    {"DOUT", false, OBJ_60FE_DIGITAL_OUTPUTS},
    {"TARGET_POS", false, OBJ_607A_TARGET_POSITION},
    {"TARGET_SPEED", false, OBJ_60FF_TARGET_VELOCITY},
    {"TARGET_CTRL_MODE", false, OBJ_6060_MODES_OF_OPERATION},
    {"TARGET_MAX_CURRENT", false, 0x6073},
    {"TARGET_VR_UINT", false, 0},
    {"STATUS_WORD", true, OBJ_6041_STATUSWORD},
    {"ERR_STATUS", true, OBJ_603F_ERROR_CODE},
    {"ACTUAL_POS", true, OBJ_6064_POSITION_ACTUAL_VALUE},
    {"ACTUAL_SPEED", true, OBJ_606C_VELOCITY_ACTUAL_VALUE},
    {"ACTUAL_TORQUE", true, OBJ_6077_TORQUE_ACTUAL_VALUE},
    {"DIN", true, OBJ_60FD_DIGITAL_INPUTS},
    {"ACTUAL_CTRL_MODE", true, OBJ_6061_MODES_OF_OPERATION_DISPLAY},
    {"ACTUAL_VR_INT", true, 0},
    {"ACTUAL_VR_UINT", true, 0},
};
enum { NAMES = sizeof names / sizeof names[0] };

static const char *const functions[] = {
    [CM1E_SM_UNUSED] = "UNUSED",   [CM1E_SM_MAILBOX_OUT] = "MBOXOUT", [CM1E_SM_MAILBOX_IN] = "MBOXIN",
    [CM1E_SM_OUTPUTS] = "OUTPUTS", [CM1E_SM_INPUTS] = "INPUTS",
};

const cm1e_ec_name_t *cm1e_ec_name(const char *name)
{
    for (int i = 0; i < NAMES; i++)
        if (strcmp(names[i].name, name) == 0)
            return &names[i];
    return NULL;
}

const char *cm1e_ec_name_of(const cm1e_described_pdo_entry_t *entry, bool transmit)
{
    for (int i = 0; i < NAMES; i++)
        if (names[i].object != 0 && names[i].object == entry->index && names[i].transmit == transmit)
            return names[i].name;
    if (!transmit)
        return "TARGET_VR_UINT";
    const bool is_signed = strstr(entry->type, "INT") && entry->type[0] != 'U';
    return is_signed ? "ACTUAL_VR_INT" : "ACTUAL_VR_UINT";
}

const char *cm1e_ec_function(cm1e_sync_manager_use_t use)
{
    return functions[use];
}

cm1e_sync_manager_use_t cm1e_ec_use(const char *function, bool *bootstrap)
{
    *bootstrap = strncmp(function, "BOOT", 4) == 0;
    for (int use = CM1E_SM_MAILBOX_OUT; use <= (*bootstrap ? CM1E_SM_MAILBOX_IN : CM1E_SM_INPUTS); use++)
        if (strcmp(functions[use], function + (*bootstrap ? 4 : 0)) == 0)
            return (cm1e_sync_manager_use_t)use;
    return CM1E_SM_UNUSED;
}

void cm1e_ec_extend_free(cm1e_ec_extend_t *document)
{
    xmlFreeDoc(document->doc);
    cm1e_arena_free(&document->arena);
    *document = (cm1e_ec_extend_t){0};
}

/* A reference by name, or by the Index where it is a number. */
static bool leads_to(const cm1e_ec_reference_t *reference, const char *name, uint32_t index)
{
    char *end;
    if (!reference->text)
        return false;
    if (name && strcmp(reference->text, name) == 0)
        return true;
    const bool hexadecimal = strncmp(reference->text, "0x", 2) == 0;
    const unsigned long long number = strtoull(reference->text, &end, hexadecimal ? 16 : 10);
    return *reference->text >= '0' && *reference->text <= '9' && *end == '\0' && number == index;
}

/* The first that a reference leads to. */
#define FOLLOW(list, reference, name_of)                                                                            \
    do {                                                                                                            \
        for (size_t i = 0; i < (list).count; i++)                                                                   \
            if (leads_to(&(reference), name_of, (list).at[i].index))                                                \
                return &(list).at[i];                                                                               \
        return NULL;                                                                                                \
    } while (0)

const cm1e_ec_pdo_t *cm1e_ec_extend_rx_pdo(const cm1e_ec_extend_t *document, const cm1e_ec_slave_t *slave)
{
    FOLLOW(document->rx_pdos, slave->rx_pdo, document->rx_pdos.at[i].name);
}

const cm1e_ec_pdo_t *cm1e_ec_extend_tx_pdo(const cm1e_ec_extend_t *document, const cm1e_ec_slave_t *slave)
{
    FOLLOW(document->tx_pdos, slave->tx_pdo, document->tx_pdos.at[i].name);
}

const cm1e_ec_command_list_t *cm1e_ec_extend_commands(const cm1e_ec_extend_t *document, const cm1e_ec_slave_t *slave)
{
    FOLLOW(document->commands, slave->commands, document->commands.at[i].name);
}

const cm1e_ec_controller_t *cm1e_ec_extend_controller(const cm1e_ec_extend_t *document, const cm1e_ec_slave_t *slave)
{
    FOLLOW(document->controllers, slave->controller, NULL);
}

const cm1e_ec_slave_t *cm1e_ec_extend_slave(const cm1e_ec_extend_t *document, const cm1e_ec_profile_t *profile)
{
    FOLLOW(document->slaves, profile->slave, NULL);
}

uint32_t cm1e_ec_pdo_bytes(const cm1e_ec_pdo_t *pdo)
{
    uint32_t bytes = 0;
    for (size_t i = 0; pdo && i < pdo->entries.count; i++)
        bytes += pdo->entries.at[i].length;
    return bytes;
}

uint16_t cm1e_ec_assigned_pdo(const cm1e_ec_command_list_t *commands, bool transmit, const cm1e_ec_command_t **entry)
{
    const uint16_t assignment = transmit ? OBJ_1C13_TXPDO_ASSIGN : OBJ_1C12_RXPDO_ASSIGN;
    uint16_t pdo = 0;
    for (size_t i = 0; commands && i < commands->entries.count; i++) {
        const cm1e_ec_command_t *command = &commands->entries.at[i];
        if (command->index != assignment || command->subindex != 1)
            continue;
        pdo = (uint16_t)command->data;
        if (entry)
            *entry = command;
    }
    return pdo;
}
