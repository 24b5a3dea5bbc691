/**
 * @file fake_bus.h
 * A bus for unit tests of drive and axis, without frames: one CM1-E as the process data shows it, in a few lines; with
 * fake_bus_add() more of them, each a fake bus of its own that the first one carries. In a test that calls one of these
 * functions, fake_bus.c takes the place of the bus: it has the functions of bus.h and bus_image.h that both rooms call.
 *
 * The drive behind it follows the controlword (UG 6.1), one cycle late, with motor power, faults, modes and a shaft
 * that follows the target position exactly. A test may overwrite every member at any time.
 */
#ifndef CM1E_TESTS_FAKE_BUS_H
#define CM1E_TESTS_FAKE_BUS_H

#include "bus/bus_image.h"
#include "cia402/cia402.h"
#include "core/bytes.h"

enum { FAKE_SDO_LOG = 64, FAKE_SDO_WAITING = 8, FAKE_SLAVES = 4, FAKE_IMAGE = 64 };

typedef struct fake_sdo_entry {
    uint16_t index;
    uint8_t subindex;
    bool write;
    int64_t value;
} fake_sdo_entry_t;

struct cm1e_bus {
    cm1e_bus_config_t config;
    cm1e_axis_config_t axes[CM1E_MAX_AXES]; /**< of the configuration */
    cm1e_clock_t clock;
    int64_t sent_ns;             /**< when the frame left whose answer is read next */
    cm1e_firmware_t firmware;
    bool firmware_unreadable;
    cm1e_pdo_t rx, tx;
    uint8_t outputs[FAKE_SLAVES * FAKE_IMAGE], inputs[FAKE_SLAVES * FAKE_IMAGE];
    struct cm1e_bus *others[FAKE_SLAVES - 1]; /**< slaves 2 ... behind this one, whose image has a part for each */
    cm1e_slave_watch_t watch;
    cm1e_slave_info_t info;
    cm1e_bus_counters_t counters;
    uint32_t looks;
    uint16_t missing;            /**< cm1e_bus_missing_slave() */
    unsigned recoveries;

    /* the device */
    cm1e_fsa_state_t state;
    bool power, frozen;          /**< frozen: it ignores the controlword and the mode */
    bool blocked;                /**< the shaft does not move */
    bool turns;                  /**< it moved in the last cycle, by its target */
    bool fault_stays;            /**< a reset does not clear the fault */
    uint16_t error_code, controlword, digital_outputs, digital_inputs;
    int8_t mode, sdo_mode;
    unsigned mode_delay, mode_wait; /**< cycles until a new mode shows */
    int32_t position, target_position, velocity_raw, target_velocity_raw;
    uint32_t profile_velocity, profile_acceleration;
    uint16_t mode_status;        /**< statusword bits 10, 12, 13 */
    int64_t torque_step;         /**< largest |target - position| seen while under torque */
    unsigned reset_edges;
    int16_t torque;              /**< 0.1 % of rated torque */
    void (*homing)(struct cm1e_bus *bus); /**< what the device does in HM each cycle */
    void (*world)(struct cm1e_bus *bus);  /**< what hangs on the shaft: after the motor has moved, before it shows */

    /* SDO */
    fake_sdo_entry_t sdo_log[FAKE_SDO_LOG];
    unsigned sdo_count, sdo_delay, sdo_wait;
    bool sdo_full;
    int64_t sdo_read_value;      /**< value of other objects */
    unsigned sdo_read_bytes;     /**< size of that value; 0: reads do not change the buffer */
    uint16_t sdo_abort_index;    /**< transfers of this object are aborted */
    cm1e_sdo_t *sdo, *sdo_waiting[FAKE_SDO_WAITING];

    /* another device instead of the CM1-E above; see fake_bridge.h */
    void *device;
    void (*device_cycle)(struct cm1e_bus *bus);
    void (*device_sdo)(struct cm1e_bus *bus, cm1e_sdo_t *sdo);
};

/** A CM1-E with this mapping as slave 1, ready to switch on; the clock is at 0. */
void fake_bus_init(cm1e_bus_t *bus, cm1e_mapping_t mapping, cm1e_pdo_order_t order, cm1e_firmware_t firmware);

/** `slave`, initialised by fake_bus_init(), is one more slave of the bus, and one more axis as its own configuration
 *  says. The clock of the bus is the first one's. */
void fake_bus_add(cm1e_bus_t *bus, cm1e_bus_t *slave);

/** The inputs as the devices would send them now. */
void fake_bus_show(cm1e_bus_t *bus);

/** The device takes the outputs in, time passes, and it shows its inputs. */
void fake_bus_cycle(cm1e_bus_t *bus, int64_t cycle_ns);

/** The device is in Fault with this code. */
void fake_bus_fault(cm1e_bus_t *bus, uint16_t code);

/** Where an object lies in a mapping; 0 bytes: nowhere. */
cm1e_image_slot_t fake_find(const cm1e_pdo_t *pdo, uint16_t index);

/** What the master writes to an object; `otherwise` where the mapping does not have it. */
uint32_t fake_output(const cm1e_bus_t *bus, uint16_t index, uint32_t otherwise);

/** What the device shows of an object, until it shows all anew. */
void fake_input(cm1e_bus_t *bus, uint16_t index, uint32_t value);

#endif
