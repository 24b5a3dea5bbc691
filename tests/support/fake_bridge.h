/**
 * @file fake_bridge.h
 * The simulated bridge behind the bus of fake_bus.h, without frames: what a drive sees is what the simulator's
 * application says, unless a test puts something else in its place.
 */
#ifndef CM1E_TESTS_FAKE_BRIDGE_H
#define CM1E_TESTS_FAKE_BRIDGE_H

#include "device/devices.h"
#include "fake_bus.h"
#include "sim/bridge_app.h"

enum { FAKE_BRIDGE_AXIS_BYTES = 6, FAKE_BRIDGE_K37 = 10 };

typedef struct fake_bridge {
    cm1e_sim_bridge_t *app;
    unsigned axis;              /**< 0 ... 3: the one that the drive is for */
    bool lost;                  /**< frames do not arrive */
    int statusword;             /**< >= 0: in place of the axis's own one */
    int mode_shown;             /**< >= 0: what 0x6061 says */
    unsigned broken_sdo;        /**< so many transfers to come end in an abort */
    int64_t largest_step;       /**< largest |target - position| with Operation enabled in csp or CPIO */
    int64_t mode_written_ns, shortest_mode_interval_ns;
} fake_bridge_t;

extern fake_bridge_t fake_bridge;

cm1e_sim_bridge_axis_t *fake_bridge_axis(void);
void fake_bridge_inputs(cm1e_bus_t *bus);
void fake_bridge_cycle(cm1e_bus_t *bus);

/** A bridge in Operational, its motors standing, in csp; the drive's is at connector `channel`. Ends the one before. */
void fake_bridge_open(cm1e_bus_t *bus, cm1e_device_model_t model, unsigned channel);
void fake_bridge_close(void);

#endif
