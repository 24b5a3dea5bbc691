#include "device/device.h"

#include "device/pdo_tables.h"

enum { MAPPINGS = 4, ORDERS = 2 };

#define PDO_ENTRY(place, index, bits, name) {0x##index, 0, bits},
#define PDO_COUNT(place, index, bits, name) +1
#define PDO(index, name, order)                                                                                     \
    {0x##index, name, 0 PDO_##index##_##order(PDO_COUNT), {PDO_##index##_##order(PDO_ENTRY)}}
#define PDO_ORDERS(index, name) {PDO(index, name, UG_4_4), PDO(index, name, UG_7_2)}

static const cm1e_pdo_t receive_pdos[MAPPINGS][ORDERS] = {
    PDO_ORDERS(1600, "RxPDO Dynamic switching of modes"),
    PDO_ORDERS(1601, "RxPDO CSP mode"),
    PDO_ORDERS(1602, "RxPDO CSV mode"),
    PDO_ORDERS(1603, "RxPDO Profile mode"),
};
static const cm1e_pdo_t transmit_pdos[MAPPINGS][ORDERS] = {
    PDO_ORDERS(1A00, "TxPDO Dynamic switching of modes"),
    PDO_ORDERS(1A01, "TxPDO CSP mode"),
    PDO_ORDERS(1A02, "TxPDO CSV mode"),
    PDO_ORDERS(1A03, "TxPDO Profile mode"),
};

void cm1e_device_pdo(cm1e_pdo_t *pdo, cm1e_mapping_t mapping, bool transmit, cm1e_pdo_order_t order,
                     cm1e_firmware_t firmware)
{
    *pdo = transmit ? transmit_pdos[mapping][order] : receive_pdos[mapping][order];
    /* The mode is the last entry of 0x1603 and 0x1A03, and new with V1.3.0 (UG 10.1). */
    if (mapping == CM1E_MAPPING_PROFILE && !cm1e_firmware_info(firmware)->mode_in_profile_pdo)
        pdo->entries[--pdo->entry_count] = (cm1e_pdo_entry_t){0};
}

/* EC_EXTEND of UG 11.2.1; start and length of SM0 are blank there and follow from SM1. Process data: 0x1600/0x1A00. */
const cm1e_sync_manager_t cm1e_device_sync_managers[4] = {
    {.start = 0x1000, .length = 128, .control = 0x26, .enable = 1, .type = 1},
    {.start = 0x1080, .length = 128, .control = 0x22, .enable = 1, .type = 2},
    {.start = 0x1100, .length = 13, .control = 0x64, .enable = 1, .type = 3},
    {.start = 0x1400, .length = 21, .control = 0x20, .enable = 1, .type = 4},
};
