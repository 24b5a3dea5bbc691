/**
 * @file dc.h
 * The distributed clocks of a bus: which slave is the reference, what the others deviate, SYNC0 and SYNC1. Set up by
 * dc.c before Safe-Operational, kept by dc_cycle.c in every cycle.
 */
#ifndef CM1E_BUS_DC_H
#define CM1E_BUS_DC_H

#include "bus/datagram.h"
#include "bus/dc_pace.h"
#include "cm1e/clocks.h"

enum {
    REG_FEATURES = 0x0008, REG_DL_STATUS_PORTS = 0x0110, REG_DC_TIMES = 0x0900, REG_DC_SYSTEM_TIME = 0x0910,
    REG_DC_OFFSET = 0x0920, REG_DC_DELAY = 0x0928, REG_DC_DIFFERENCE = 0x092C, REG_DC_SPEED_START = 0x0930,
    REG_DC_FILTERS = 0x0934, REG_DC_CONTROL = 0x0980, REG_DC_ACTIVATION = 0x0981, REG_DC_START = 0x0990,
    REG_DC_CYCLES = 0x09A0,
};
enum { DC_SPEED_START = 0x1000, DC_FILTERS = 0x0C00 /* of the difference 0, of the speed 12 */ };
enum { DC_ACTIVATE = 0x01, DC_SYNC0 = 0x02, DC_SYNC1 = 0x04 };

typedef struct cm1e_dc_slave {
    cm1e_slave_clock_t clock;
    uint8_t beyond;       /**< number of looks in a row that found the clock beyond its tolerance */
    bool seen;            /**< looked at since the clocks were set up: only the cycle looks */
    uint8_t control;      /**< register 0x0980: who has the unit for SYNC and latch */
    uint8_t step;         /**< step of the recovery of the clock (dc_recovery.c) */
    int64_t deadline_ns;
    uint64_t offset;
} cm1e_dc_slave_t;

typedef struct cm1e_dc {
    bool used;
    const struct cm1e_bus *leader; /**< the bus whose reference clock ours follows; NULL: ours leads */
    cm1e_datagram_t steering; /**< tells our reference the time of that clock */
    bool steers;          /**< the datagram `steering` is on its way */
    uint16_t reference;   /**< position; 0: none */
    cm1e_dc_pace_t pace;
    int64_t reference_ns; /**< time of the reference in the last frame that brought it */
    int64_t sent_ns;      /**< when that frame was sent */
    int64_t frame_ns;     /**< when the frame that is on its way was sent */
    int64_t predicted_ns; /**< what that frame carries to a reference that does not answer */
    int64_t correction_ns; /**< for the next cycle, not yet taken */
    bool marked;          /**< the frame on its way is one of every second frames */
    unsigned silent;      /**< frames in a row that came back without the time of the reference */
    bool abandoned;       /**< the reference was off: another one is taken before the next frame */
    uint16_t candidate;   /**< a slave whose clock was set while there was no reference; 0: none */
    uint16_t looked;      /**< slave whose deviation was read last */
    bool turn;            /**< supervision looks at a clock next, not at an AL status */
    int64_t pulses_ns;    /**< system time by which the first pulses of all slaves have come */
    int64_t phase_maximum_ns;
    uint64_t losses;
    cm1e_dc_slave_t slaves[CM1E_MAX_SLAVES];
} cm1e_dc_t;

struct cm1e_bus_slave;

/* dc.c */
/** Measures delays, sets offsets and pulses. CM1E_OK without a frame where the configuration asks for no clocks. */
cm1e_error_t cm1e_dc_set_up(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Ends the pulses. */
void cm1e_dc_stop(cm1e_bus_t *bus);

/* dc_modes.c */
/** Takes the pulses of each slave from the configuration, or from the mode in its SII. Called before the slaves are
 *  written. */
cm1e_error_t cm1e_dc_find_pulses(cm1e_bus_t *bus, cm1e_diag_t *diag);

/* dc_pulses.c */
/** First pulse and periods, as registers have them; `now_ns` is the system time. */
void cm1e_dc_put_pulses(const cm1e_dc_t *dc, const cm1e_slave_clock_t *clock, int64_t now_ns, uint8_t start[8],
                        uint8_t cycles[8]);
/** Value of register 0x0981 that starts its pulses. */
static inline unsigned cm1e_dc_activation(const cm1e_slave_clock_t *clock)
{
    return DC_ACTIVATE | DC_SYNC0 | (clock->sync1_ns ? DC_SYNC1 : 0u);
}

/* dc_start.c */
/** Gives the plan of the cycle the phase of the reference clock. Called before the first exchange. */
void cm1e_dc_begin(cm1e_bus_t *bus);
/** Exchanges until all clocks and the cycle are within their tolerances. */
cm1e_error_t cm1e_dc_wait(cm1e_bus_t *bus, cm1e_diag_t *diag);

/* dc_cycle.c */
/** One datagram that keeps the clocks together while no cycle runs. */
void cm1e_dc_keep(cm1e_bus_t *bus);
/** Called before and after an exchange. @rt cycle */
void cm1e_dc_send(cm1e_bus_t *bus, int64_t now_ns);
void cm1e_dc_receive(cm1e_bus_t *bus, bool returned);
/** Called when the AL status code of a slave has changed. A code of synchronism counts as a loss. @rt cycle */
void cm1e_dc_note_status(struct cm1e_bus_slave *slave, uint16_t al_status_code);
/** Fills the datagram of the supervision with a look at a clock; false: it is not the turn of the clocks. @rt cycle */
bool cm1e_dc_next_look(cm1e_bus_t *bus, cm1e_datagram_t *datagram);
void cm1e_dc_looked(cm1e_bus_t *bus, const cm1e_datagram_t *datagram);
/** ns; what a clock may deviate. */
uint32_t cm1e_dc_tolerance(const cm1e_dc_t *dc, const cm1e_slave_clock_t *clock);

/** The system time of the reference clock at the time `now_ns` of this machine. If the reference is silent, the rate
 *  that the cycle has learnt gives it. @rt cycle */
int64_t cm1e_dc_time(const cm1e_dc_t *dc, int64_t now_ns);

/* dc_recovery.c */
void cm1e_dc_recover_begin(struct cm1e_bus_slave *slave);
/** Notes that the slave was off, and its clock with it, because it has no station address any more. */
void cm1e_dc_was_off(struct cm1e_bus_slave *slave);
/** Fills the datagram with the next register of a slave whose clock is set again; false: nothing to send now.
 *  `*is_set`: the clock is set, or the slave has none. */
bool cm1e_dc_recover_next(struct cm1e_bus_slave *slave, cm1e_datagram_t *datagram, int64_t now_ns, bool *is_set);
void cm1e_dc_recovered(struct cm1e_bus_slave *slave, const cm1e_datagram_t *datagram, int64_t now_ns);

#endif
