/**
 * @file config.h
 * What hangs where: the network as the application expects it. Filled by hand or read from a bus file (YAML).
 * Plain data, made before the bus is opened; any thread, one at a time.
 * A zero in any field means the default that its comment names.
 */
#ifndef CM1E_CONFIG_H
#define CM1E_CONFIG_H

#include <stdbool.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CM1E_MAX_SLAVES 128 /**< slaves on one bus */
#define CM1E_MAX_AXES 128   /**< axes on one bus */
#define CM1E_NAME_LENGTH 32 /**< longest axis name, with its final 0 */

/** A device of which the library knows what it is. */
typedef enum cm1e_device_model {
    CM1E_DEVICE_CM1E = 0, /**< the motor, all four sizes: they have one product code */
    CM1E_DEVICE_EB01,     /**< EtherCAT Cool MUSCLE Bridge, four CM1 */
    CM1E_DEVICE_EB02,     /**< ... four CM2 */
    CM1E_DEVICE_EB12,     /**< ... CM1 on axes 1 and 2, CM2 on axes 3 and 4 */
} cm1e_device_model_t;

/** How a slave is found (UG 4.2). */
typedef enum cm1e_address_kind {
    CM1E_ADDRESS_POSITION = 0, /**< by its place on the wire, 1 = first */
    CM1E_ADDRESS_ALIAS,        /**< by the configured station alias, register 0x0012 */
    CM1E_ADDRESS_EXPLICIT_ID,  /**< by the rotary switches (explicit device ID, register 0x0134), 1 ... 254 */
} cm1e_address_kind_t;

/** Which of the four fixed PDO mappings (UG 4.4) the slave runs with. */
typedef enum cm1e_mapping {
    CM1E_MAPPING_DYNAMIC = 0, /**< 0x1600/0x1A00: every mode, switchable; the default */
    CM1E_MAPPING_CSP,         /**< 0x1601/0x1A01 */
    CM1E_MAPPING_CSV,         /**< 0x1602/0x1A02 */
    CM1E_MAPPING_PROFILE,     /**< 0x1603/0x1A03 */
} cm1e_mapping_t;

/** Who makes the way of a motion. */
typedef enum cm1e_motion_backend {
    CM1E_MOTION_HOST = 0, /**< this library, a set-point every cycle: everything that the blocks offer; the default */
    CM1E_MOTION_DRIVE,    /**< the drive, in profile position and profile velocity mode: single moves from standstill */
} cm1e_motion_backend_t;

/** Order of the objects in the four mappings: the manual gives two (UG 4.4 and UG 7.2). Simulator only; the driver
 *  reads the order from the device. */
typedef enum cm1e_pdo_order {
    CM1E_PDO_ORDER_UG_4_4 = 0,
    CM1E_PDO_ORDER_UG_7_2,
} cm1e_pdo_order_t;

/** A simple device that is no motor and has no mailbox, as the simulated segment plays it. */
typedef enum cm1e_sim_io {
    CM1E_SIM_IO_MODULE = 0, /**< 8 outputs wired to 8 inputs; a state machine of its own */
    CM1E_SIM_IO_TERMINAL,   /**< 4 outputs wired to 4 inputs, each a bit; device emulation: its controller copies AL
                                 control to AL status, the acknowledge bit too */
    CM1E_SIM_IO_COUPLER,    /**< no process data; device emulation */
} cm1e_sim_io_t;

/** Defaults of MC_Home for one axis; values in axis units (u). */
typedef struct cm1e_homing_config {
    int8_t method;       /**< 0 none, -1/-2 hard stop CW/CCW, -3/-4 input 2 CW/CCW, -5/-6 input 3 CW/CCW (UG 6.2.4);
                              behind a bridge 1/2 hard stop CW/CCW, 3/4 home switch CW/CCW (BR 6.4.1) */
    double offset;       /**< u; the axis moves there after the reference, then calls it 0; +-3,276,700 counts */
    double velocity;     /**< u/s; 0: 50,000 counts/s; 1,000 ... 500,000 counts/s. Behind a bridge CM1 0: 10,000,
                              100 ... 500,000; CM2 0: 1,000, 100 ... 3,276,700; 0: at most a revolution a second */
    double acceleration; /**< u/s2; 0: 100,000 counts/s2; 1,000 ... 5,000,000 counts/s2, CM2 ... 32,767,000 */
    double torque;       /**< % of rated torque, 10 ... 100; 0: 30 */
    double timeout_s;    /**< s; 0: 60 */
} cm1e_homing_config_t;

/** Which of the inputs IN1 ... IN4 of the motor is which switch; 0: none. The switches are shown by MC_ReadAxisInfo and
 *  used by the homing steps of the host; by themselves they stop nothing. */
typedef struct cm1e_input_config {
    uint8_t limit_positive;         /**< 1 ... 4; hit in the axis's positive direction */
    uint8_t limit_negative;         /**< 1 ... 4, another one than limit_positive */
    uint8_t home;                   /**< 1 ... 4; may be the input of a limit switch */
    bool limits_normally_closed;    /**< TRUE: a limit switch is active while its input is off (a broken wire too) */
    bool home_normally_closed;      /**< the same for the home switch */
} cm1e_input_config_t;

/** The mechanics that the simulator puts behind one axis; ignored on a wire. Positions in counts of the motor shaft,
 *  measured from the power-on position. All zero: a linear axis with a hard stop 250,000 counts to either side, input 2
 *  active beyond +150,000 counts and input 3 active beyond -150,000 counts, a light load. */
typedef struct cm1e_sim_axis_config {
    double load_inertia;     /**< kg m2, reflected to the shaft; 0: 2e-6 */
    double friction;         /**< Nm, Coulomb; 0: 0.005 */
    double viscous_friction; /**< Nm s/rad; 0: 1e-5 */
    double stop_positive;    /**< counts; 0: +250,000 */
    double stop_negative;    /**< counts; 0: -250,000 */
    bool no_stops;           /**< TRUE: turns for ever */
    double sensor_input2;    /**< counts; IN2 is on beyond it, away from 0; 0: +150,000 */
    double sensor_input3;    /**< counts; IN3 is on beyond it, away from 0; 0: -150,000 */
    bool no_sensors;         /**< TRUE: nothing is wired to IN2 and IN3 */
} cm1e_sim_axis_config_t;

/** What is behind an axis. */
typedef enum cm1e_axis_type {
    CM1E_AXIS_MOTOR = 0,             /**< a motor on the bus */
    CM1E_AXIS_VIRTUAL,               /**< nothing: it is where its set-point is; a master for others, or for trials */
    CM1E_AXIS_ENCODER,               /**< an encoder whose counts the program brings (cm1e_axis_write_encoder()): a
                                          master that others follow by its actual value */
} cm1e_axis_type_t;

/** What an axis that follows a master does where it cannot go on so: its limits, or the master failed. */
typedef enum cm1e_coupling_stop {
    CM1E_COUPLING_STOP_THIS = 0,     /**< it stops alone, with its own deceleration */
    CM1E_COUPLING_STOP_COUPLED,      /**< so do its master and all that follow the same one */
    CM1E_COUPLING_STOP_KEEP_RATIO,   /**< the master is braked so that it can follow, and it follows to the end */
} cm1e_coupling_stop_t;

/** One axis: where it is, which motor, which units and limits. */
typedef struct cm1e_axis_config {
    char name[CM1E_NAME_LENGTH];     /**< "": "axis<n>" */
    cm1e_axis_type_t type;           /**< other than a motor: it has no place on the bus, and what is said of a motor is
                                          an error beside it (docs/BUS-FILE.md) */
    cm1e_address_kind_t address_kind;
    uint16_t address;                /**< position 1 ..., alias or ID; 0: position = its place among the motors */
    uint8_t channel;                 /**< 0: the slave is the motor, a CM1-E. 1 ... 4: the motor at this connector (ID)
                                          of an EtherCAT Cool MUSCLE Bridge; up to four axes have its address then */
    char motor[20];                  /**< "CM1-E-17S30D", -17L30D, -23S30D or -23L20D; "": CM1-E-17S30D. Behind a
                                          bridge "CM1" or "CM2"; "": whichever the bridge has there */
    uint8_t k37;                     /**< behind a bridge: the motor's K37, its resolution and unit of speed */
    bool k37_stated;                 /**< TRUE: the field above holds. An axis behind a bridge needs it to move: with
                                          another resolution the same counts are another way */
    char firmware[12];               /**< expected, or played by the simulator: "1.2.0" ... "1.3.5"; "": any, 1.3.5 */
    cm1e_mapping_t mapping;
    cm1e_motion_backend_t motion;
    double counts_per_unit;          /**< encoder counts (50,000 a revolution) per unit u; 0: by the three below */
    uint32_t gear_numerator;         /**< revolutions of the motor ... 1 ... 1,000,000; 0: 1 */
    uint32_t gear_denominator;       /**< ... in so many revolutions of the load; 1 ... 1,000,000; 0: 1 */
    double units_per_revolution;     /**< u in one revolution of the load: 360, or the lead of a spindle; 0: 1 */
    double modulo_range;             /**< u; positions run from 0 to below it, the axis turns for ever; 0: linear */
    bool invert;                     /**< TRUE: positive u is CCW */
    double backlash;                 /**< u between the two flanks, taken up at every reversal; 0: none */
    double backlash_velocity;        /**< u/s of it, kept free below the peak speed; 0: 50,000 counts/s */
    double max_velocity;             /**< u/s; 0: the motor's peak speed (UG 6.3), which is also the upper bound */
    double max_acceleration;         /**< u/s2; 0: 5,000,000 counts/s2 */
    double max_deceleration;         /**< u/s2; 0: as max_acceleration. Also the ramp of an error stop */
    double max_jerk;                 /**< u/s3; 0: 100,000,000 counts/s3 */
    double software_limit_positive;  /**< u; both limits 0: none; +INFINITY: none on this side */
    double software_limit_negative;  /**< u; -INFINITY: none on this side */
    double max_position_lag;         /**< u; 0: 25,000 counts (half a revolution) */
    double in_position_window;       /**< u to either side of a set-point that stands, within which the motor is there;
                                          0: 10 counts of 50,000 a revolution, at least 2 (docs/BUS-FILE.md) */
    double in_position_time_s;       /**< s that the motor stays inside the window to be there; 0: 0.02 */
    double in_position_timeout_s;    /**< s after which a motor that a Done waits for is an error; 0: 2 */
    bool in_position_done_waits;     /**< TRUE: Done of what ends at a position waits until the motor is there; FALSE:
                                          it comes with the set-point */
    bool velocity_in_counts_per_ms;  /**< states the unit of 0x60FF/0x606C where object 0x100A cannot be read */
    bool velocity_unit_stated;       /**< TRUE: the field above is used instead of the firmware version */
    bool acceleration_in_kpulses;    /**< TRUE: 0x6083/0x6084 take kpulses/s2 on the wire (UG 7.3.17/6.2.3) */
    double jog_slow, jog_fast;       /**< u/s, MC_Jog's own velocities; 0: 5 % and 25 % of the maximum velocity */
    uint16_t cam_points;             /**< most points of a cam that the axis follows, 2 ... 4096; 0: 128 */
    cm1e_coupling_stop_t coupling_stop; /**< when it follows a master */
    double encoder_filter_s;         /**< s; time constant with which masters' actual values are smoothed, for this
                                          axis as a master; 0: 10 cycles */
    bool table_profiles;             /**< TRUE: MC_PositionProfile and its like have their 2 kB of memory */
    cm1e_input_config_t inputs;
    cm1e_homing_config_t homing;
    cm1e_sim_axis_config_t sim;
} cm1e_axis_config_t;

/** The whole bus. */
typedef struct cm1e_bus_config {
    char interface_name[64];         /**< "eth1", "sim", "sim:<bus file>"; "": "sim" */
    char second_interface[64];       /**< second network interface of a redundant ring; "": none */
    int64_t cycle_time_ns;           /**< 200,000, 250,000, 500,000 or 1,000,000; 0: 1,000,000 */
    int64_t frame_timeout_ns;        /**< wait for a lost frame in the cycle; 0: a quarter of the cycle time */
    uint32_t lost_cycles_limit;      /**< bad cycles in a row that put the axes in ErrorStop, at most 50 ms; 0: 3 */
    char pcap_file[256];             /**< every frame is written there, by the cycle too: for tests, not real time; "":
                                          none */
    bool virtual_time;               /**< simulated segment only: time passes only inside the cycle and in waits */
    cm1e_pdo_order_t sim_pdo_order;  /**< simulated segment only */
    cm1e_sim_io_t sim_gaps;          /**< simulated segment only: the device at each place where no motor is */
    uint32_t axis_count;
    cm1e_axis_config_t axes[CM1E_MAX_AXES];
} cm1e_bus_config_t;

/** A configuration of `axis_count` default axes, at positions 1 ... n, on `interface_name` (NULL: "sim"). @rt init */
CM1E_API void cm1e_bus_config_init(cm1e_bus_config_t *config, const char *interface_name, uint32_t axis_count);

/** Reads a bus file (YAML; format: docs/BUS-FILE.md). On failure `config` is untouched and `diag` names file, line,
 *  column, what was found and what was expected. @rt init */
CM1E_API cm1e_error_t cm1e_bus_config_load(cm1e_bus_config_t *config, const char *path, cm1e_diag_t *diag);

/** Checks ranges and contradictions of a configuration made by hand (a bus file is checked on loading). @rt init */
CM1E_API cm1e_error_t cm1e_bus_config_check(const cm1e_bus_config_t *config, cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
