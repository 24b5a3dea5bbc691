/**
 * @file io_device.h
 * A simulated device with up to 8 inputs and outputs, as the bus file describes it: a coupler, digital channels of one
 * bit without mailbox, analog channels of 16 bits or counters of 32 bits with CoE. Private to the simulator. Files:
 *   io_device.c            life, process data, wires
 *   io_device_objects.c    the dictionary of a device with CoE: settings, PDOs that can be chosen and written
 */
#ifndef CM1E_SIM_IO_DEVICE_H
#define CM1E_SIM_IO_DEVICE_H

#include "device/module_kinds.h"
#include "sim/segment.h"
#include "sim/slave.h"

enum { IO_CHANNELS = 8, IO_OBJECTS = 128, IO_ENTRIES = 512, IO_SLOTS = 128, IO_MAPPED = 8 };

/** An entry of the process image. */
typedef struct cm1e_sim_io_slot {
    int64_t *value; /**< NULL: a gap */
    uint16_t bit, bits;
} cm1e_sim_io_slot_t;

typedef struct cm1e_sim_io_image {
    unsigned slot_count;
    uint32_t bits;
    cm1e_sim_io_slot_t slots[IO_SLOTS];
} cm1e_sim_io_image_t;

/** The dictionary of an analog device: entries and, at the same places, their values. */
typedef struct cm1e_sim_io_objects {
    size_t object_count, entry_count;
    cm1e_object_t objects[IO_OBJECTS];
    cm1e_entry_t entries[IO_ENTRIES];
    int64_t values[IO_ENTRIES];
} cm1e_sim_io_objects_t;

typedef struct cm1e_sim_io_device {
    cm1e_sim_slave_config_t config;
    uint16_t id;                             /**< explicit device ID; 0: none */
    int64_t outputs[IO_CHANNELS];            /**< at the terminals */
    int64_t held[IO_CHANNELS];               /**< of inputs that the console holds */
    bool is_held[IO_CHANNELS];
    const struct cm1e_sim_io_device *source; /**< whose outputs the inputs are wired to; NULL: nobody's */
    cm1e_sim_io_image_t images[2];           /**< outputs, inputs */
    cm1e_sim_io_objects_t *objects;          /**< NULL: no CoE */
    int64_t digital[2][IO_CHANNELS];         /**< values of the process data without CoE */
    uint8_t module_count;                    /**< of a modular device */
    const cm1e_module_kind_t *modules[IO_CHANNELS];
    int64_t now_ns, power_on_ns;             /**< of an encoder, which counts since its power-on */
    int64_t sync0_ns;                        /**< of the last SYNC0, which takes the counts; INT64_MAX: frames do */
} cm1e_sim_io_device_t;

/** The device that a slave of the configuration names, with its identity and address. NULL: no memory. */
cm1e_sim_slave_t *cm1e_sim_io_device_create(const cm1e_slave_config_t *slave);
/** NULL: it is another device. */
cm1e_sim_io_device_t *cm1e_sim_io_device_of(cm1e_sim_slave_t *slave);
/** What comes to the terminal of an input (0 = first). */
int64_t cm1e_sim_io_terminal(const cm1e_sim_io_device_t *device, unsigned channel);

/* io_device_objects.c */
bool cm1e_sim_io_objects_create(cm1e_sim_io_device_t *device, const cm1e_slave_config_t *slave);
/** Values and process data as at power-on. */
void cm1e_sim_io_objects_power_on(cm1e_sim_io_device_t *device);
/** Values from the objects of outputs to the terminals, and from the terminals to the objects of inputs. */
void cm1e_sim_io_objects_give(cm1e_sim_io_device_t *device);
void cm1e_sim_io_objects_take(cm1e_sim_io_device_t *device);
uint32_t cm1e_sim_io_objects_read(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, uint8_t *data,
                                  size_t *size);
uint32_t cm1e_sim_io_objects_write(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, const uint8_t *data,
                                   size_t size);
/** Outputs of a modular device off. */
void cm1e_sim_io_objects_release(cm1e_sim_io_device_t *device);
/** Whether the modules that are configured (0xF030) are those that it has, or none are configured. */
bool cm1e_sim_io_objects_modules_agree(const cm1e_sim_io_device_t *device);
const cm1e_object_t *cm1e_sim_io_objects_at(void *app, size_t n);
const cm1e_entry_t *cm1e_sim_io_objects_entry(void *app, uint16_t index, uint8_t subindex);

#endif
