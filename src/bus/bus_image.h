/**
 * @file bus_image.h
 * The interface of the bus for the drive room: the process image, with objects located once at start-up.
 */
#ifndef CM1E_BUS_BUS_IMAGE_H
#define CM1E_BUS_BUS_IMAGE_H

#include "cm1e/bus.h"
#include "core/clock.h"
#include "device/device.h"

/** Where an object lies in the process image. `bytes` 0: it is not mapped. */
typedef struct cm1e_image_slot {
    uint32_t offset : 24; /**< from cm1e_bus_outputs() or cm1e_bus_inputs() */
    uint32_t bytes : 8;   /**< 1 ... 4 */
} cm1e_image_slot_t;

/** Finds an object in the mapping read from slave `position`; bytes 0 where it is not mapped. @rt init */
cm1e_image_slot_t cm1e_bus_find_output(const cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex);
cm1e_image_slot_t cm1e_bus_find_input(const cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex);

/** The image itself, valid from cm1e_bus_configure() on. @rt cycle */
uint8_t *cm1e_bus_outputs(cm1e_bus_t *bus);
const uint8_t *cm1e_bus_inputs(const cm1e_bus_t *bus);

/** AL state and status code of a slave as last seen by the supervision in the cycle (0: not seen yet); `lost`: it does
 *  not answer at its address. @rt cycle */
typedef struct cm1e_slave_watch {
    uint16_t al_state, al_status_code;
    bool lost;
    bool silent; /**< it gave no inputs for more cycles than are tolerated, while other slaves did */
    bool out;    /**< it may come and go, and takes no part now: a good cycle is one of the others */
    uint32_t bound; /**< number of times that its process data were placed in operation, because it came for the first
                         time: what was located before must be located again */
    bool absent; /**< it is optional, and nothing on the wire is identified as this slave */
    bool fresh;  /**< its own inputs are those of this cycle, even if the working counter is wrong */
} cm1e_slave_watch_t;
cm1e_slave_watch_t cm1e_bus_slave_watch(const cm1e_bus_t *bus, uint16_t position);
/** A slave that takes no part in the cycle, though it is not optional and absent, by what the supervision has seen: its
 *  position; 0: none. @rt cycle */
uint16_t cm1e_bus_missing_slave(const cm1e_bus_t *bus);
enum { CM1E_LABEL_LENGTH = 224 }; /**< four names of axes */
/** 'slave 2 ("axis2", CM1-E)'; "slave 9" if there is none. @rt any */
const char *cm1e_bus_slave_label(const cm1e_bus_t *bus, uint16_t position, char label[CM1E_LABEL_LENGTH]);
/** How often the supervision has seen its AL status. @rt cycle */
uint32_t cm1e_bus_slave_looks(const cm1e_bus_t *bus, uint16_t position);
/** Whether this cycle is a good one, and cm1e_bus_slave_watch() would give what it gave before (`seen`) of a slave that
 *  is there. It costs less. @rt cycle */
bool cm1e_bus_slave_goes_on(const cm1e_bus_t *bus, uint16_t position, const cm1e_slave_watch_t *seen);
/** Asks the supervision to bring a slave that came back (reset, power cycle, replug) to Operational again, with its
 *  configuration, while the cycle runs. Progress is seen through cm1e_bus_slave_watch(). Until it is seen in
 *  Operational it gets outputs of zeros, whatever is in the image. Devices that are no CM1-E come back without being
 *  asked. @rt cycle */
void cm1e_bus_request_recovery(cm1e_bus_t *bus, uint16_t position);

/** The program has ended: from the next frame on the outputs of the slaves that the configuration names take their safe
 *  values (docs/BUS-FILE.md). @rt cycle */
void cm1e_bus_release_outputs(cm1e_bus_t *bus);
/** What the next cycle begins later than planned, in ns, so that the cycle follows the reference clock; 0 without
 *  distributed clocks. Taken once a cycle, behind cm1e_bus_receive(). @rt cycle */
int64_t cm1e_bus_pace(cm1e_bus_t *bus);
/** Whether the distributed clocks of `bus` lead those of `other`, or `other` uses none. @rt init */
bool cm1e_bus_leads_clocks(const cm1e_bus_t *bus, const cm1e_bus_t *other);
/** One of the two leads the other, or a third one leads both, or one of them uses no clocks. @rt init */
bool cm1e_bus_follow_one_clock(const cm1e_bus_t *bus, const cm1e_bus_t *other);
/** From now on they are led by another bus whose cycles are run with its own, or by none. @rt init */
void cm1e_bus_follow_clock(cm1e_bus_t *bus, const cm1e_bus_t *leader);
/** The first start of a cycle from `now_ns` on that has the phase of the reference clock; `now_ns` itself without
 *  distributed clocks. @rt init */
int64_t cm1e_bus_next_start(const cm1e_bus_t *bus, int64_t now_ns);

/** Number of the present operation, from 1: the number of times that cm1e_bus_operate() succeeded. 0: the bus is not in
 *  Operational. Locations that were resolved in one operation are not valid in the next. @rt init */
uint32_t cm1e_bus_operation(const cm1e_bus_t *bus);
cm1e_clock_t *cm1e_bus_clock(cm1e_bus_t *bus);
/** When the frame of the last inputs was sent. Read behind cm1e_bus_receive(). @rt cycle */
int64_t cm1e_bus_sent_ns(const cm1e_bus_t *bus);
/** A sentence for diagnoses; its value is cm1e_bus_counters_t.foreign_frames as unsigned long long. */
#define CM1E_OTHER_MASTER_TEXT " Another master sends on this network: %llu of its frames were seen since the start. " \
                               "Only one master may: find that program and end it."
/** The firmware of a slave as object 0x100A tells; NULL: unreadable. @rt init */
const cm1e_firmware_info_t *cm1e_bus_slave_firmware(const cm1e_bus_t *bus, uint16_t position);
/** It has a mailbox with CoE, so its objects can be read. @rt any */
CM1E_GUEST_API bool cm1e_bus_slave_has_coe(const cm1e_bus_t *bus, uint16_t position);
/** The ports of a slave that were open when the bus reached Operational, bit 0 = port 0; 0: its place is not known,
 *  or it may leave it, because it is optional. @rt any */
CM1E_GUEST_API unsigned cm1e_bus_open_ports(const cm1e_bus_t *bus, uint16_t position);
/** The nic below: the simulator finds its segment by it. @rt any */
CM1E_GUEST_API struct cm1e_nic *cm1e_bus_nic(cm1e_bus_t *bus);

#endif
