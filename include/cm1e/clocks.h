/**
 * @file clocks.h
 * Distributed clocks of a bus (ETG.1000.4): how exact they are. docs/CLOCKS.md explains them. They are used where the
 * configuration says so: cm1e_bus_config_t.distributed_clocks, or the `dc` of an axis.
 * The functions belong to the thread that owns the bus.
 */
#ifndef CM1E_CLOCKS_H
#define CM1E_CLOCKS_H

#include "cm1e/bus.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The clocks of a bus together. */
typedef struct cm1e_bus_clocks_t {
    bool used;                  /**< false: the other members are zero */
    uint16_t reference;         /**< position of the slave whose clock all others follow; 0: none is left */
    int64_t reference_ns;       /**< its system time when the last frame passed it */
    double rate_ppm;            /**< by how much the reference clock is slower than the clock of this machine */
    int64_t phase_error_ns;     /**< how late the last frame was at the reference clock */
    double phase_mean_ns;       /**< the same, averaged over some 32 cycles */
    int64_t phase_maximum_ns;   /**< largest absolute value of the mean since Operational */
    uint64_t sync_losses;       /**< times that the clock of a slave, or the reference, was lost; only grows */
    bool led;                   /**< the reference follows that of another bus, which was started before in this thread:
                                     its deviation is in cm1e_bus_slave_clock() */
} cm1e_bus_clocks_t;

/** The clock of one slave. */
typedef struct cm1e_slave_clock_t {
    bool has_clock, is_reference;
    bool lost;                  /**< its deviation is, or was when it was last seen, beyond CM1E_CLOCK_TOLERANCE_NS */
    uint32_t delay_ns;          /**< of a frame, from the first clock to this one */
    uint32_t sync0_ns, sync1_ns; /**< periods that were set; 0: none */
    int32_t shift_ns;           /**< SYNC0 behind the frame at the reference clock */
    int32_t deviation_ns;       /**< from the reference clock, as the slave states it (0x092C) */
    uint32_t maximum_ns;        /**< largest absolute deviation since Operational */
    uint64_t losses;            /**< times that it was lost; only grows */
} cm1e_slave_clock_t;

/** A larger deviation counts as loss of synchronism. */
enum { CM1E_CLOCK_TOLERANCE_NS = 1000 };

/** Does the work of cm1e_bus_clocks(), for a program with this size of the struct. @rt cycle */
CM1E_API void cm1e_bus_clocks_sized(const cm1e_bus_t *bus, cm1e_bus_clocks_t *clocks, size_t size);
/** The clocks of a bus, as its last cycles have shown them. @rt cycle */
static inline void cm1e_bus_clocks(const cm1e_bus_t *bus, cm1e_bus_clocks_t *clocks)
{
    cm1e_bus_clocks_sized(bus, clocks, sizeof *clocks);
}
/** Does the work of cm1e_bus_slave_clock(), for a program with this size of the struct. @rt cycle */
CM1E_API void cm1e_bus_slave_clock_sized(const cm1e_bus_t *bus, uint16_t position, cm1e_slave_clock_t *clock,
                                         size_t size);
/** The clock of the slave at `position` (1 = first); zeros if there is no such slave, or clocks are not used.
 *  @rt cycle */
static inline void cm1e_bus_slave_clock(const cm1e_bus_t *bus, uint16_t position, cm1e_slave_clock_t *clock)
{
    cm1e_bus_slave_clock_sized(bus, position, clock, sizeof *clock);
}

#ifdef __cplusplus
}
#endif
#endif
