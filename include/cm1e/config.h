/**
 * @file config.h
 * The configuration of a network as the application expects it: filled by hand or read from a bus file (YAML).
 * It is plain data, made before the bus is opened. Any thread may use it, one thread at a time.
 * A zero in any field selects the default that its comment names.
 */
#ifndef CM1E_CONFIG_H
#define CM1E_CONFIG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CM1E_MAX_SLAVES 512 /**< maximum number of slaves on one bus */
#define CM1E_MAX_AXES 512   /**< maximum number of axes on one bus, and of one scheduler */
#define CM1E_MAX_BUSES 4    /**< maximum number of buses of one scheduler, and of those started before they are run */
#define CM1E_NAME_LENGTH 32 /**< maximum length of an axis name, with its final 0 */

/** The devices that the library knows. */
typedef enum cm1e_device_model {
    CM1E_DEVICE_CM1E = 0, /**< the motor; all four sizes have one product code */
    CM1E_DEVICE_EB01,     /**< EtherCAT Cool MUSCLE Bridge, four CM1 */
    CM1E_DEVICE_EB02,     /**< EtherCAT Cool MUSCLE Bridge, four CM2 */
    CM1E_DEVICE_EB12,     /**< EtherCAT Cool MUSCLE Bridge, CM1 on axes 1 and 2, CM2 on axes 3 and 4 */
    CM1E_DEVICE_CIA402,   /**< a servo drive of another maker, by CiA 402 and ETG.6010 */
} cm1e_device_model_t;

/** How a slave is addressed (UG 4.2). */
typedef enum cm1e_address_kind {
    CM1E_ADDRESS_POSITION = 0, /**< by its place on the wire, 1 = first */
    CM1E_ADDRESS_ALIAS,        /**< by the configured station alias, register 0x0012 */
    CM1E_ADDRESS_EXPLICIT_ID,  /**< by the rotary switches (explicit device ID, register 0x0134), 1 ... 254 */
} cm1e_address_kind_t;

/** The four fixed PDO mappings (UG 4.4). */
typedef enum cm1e_mapping {
    CM1E_MAPPING_DYNAMIC = 0, /**< 0x1600/0x1A00: all modes of operation, which can be switched; the default */
    CM1E_MAPPING_CSP,         /**< 0x1601/0x1A01 */
    CM1E_MAPPING_CSV,         /**< 0x1602/0x1A02 */
    CM1E_MAPPING_PROFILE,     /**< 0x1603/0x1A03 */
} cm1e_mapping_t;

/** Who computes the profile of a motion. */
typedef enum cm1e_motion_backend {
    CM1E_MOTION_HOST = 0, /**< this library, with a set-point in every cycle: all blocks work; the default */
    CM1E_MOTION_DRIVE,    /**< the drive, in profile position and profile velocity mode: single moves from standstill */
} cm1e_motion_backend_t;

/** Order of the objects in the four mappings: the manual has two (UG 4.4 and UG 7.2). Used by the simulator and by file
 *  generators only; the driver reads the order from the device. */
typedef enum cm1e_pdo_order {
    CM1E_PDO_ORDER_UG_4_4 = 0,
    CM1E_PDO_ORDER_UG_7_2,
} cm1e_pdo_order_t;

/** A simple simulated device without motor and mailbox. */
typedef enum cm1e_sim_io {
    CM1E_SIM_IO_MODULE = 0, /**< 8 outputs wired to 8 inputs; it has its own state machine */
    CM1E_SIM_IO_TERMINAL,   /**< 4 outputs wired to 4 inputs, each a bit; device emulation: its controller copies AL
                                 control to AL status, the acknowledge bit too */
    CM1E_SIM_IO_COUPLER,    /**< no process data; device emulation */
} cm1e_sim_io_t;

/** Defaults of MC_Home for one axis; values in axis units (u). */
typedef struct cm1e_homing_config {
    int8_t method;       /**< 0 none, -1/-2 hard stop CW/CCW, -3/-4 input 2 CW/CCW, -5/-6 input 3 CW/CCW (UG 6.2.4);
                              behind a bridge 1/2 hard stop CW/CCW, 3/4 home switch CW/CCW (BR 6.4.1) */
    double offset;       /**< u, +-3,276,700 counts; after the reference the axis moves by this distance, and its
                              position is 0 there */
    double velocity;     /**< u/s, 1,000 ... 500,000 counts/s; 0 selects 50,000. Behind a bridge: CM1 100 ...
                              500,000, 0 selects 10,000; CM2 100 ... 3,276,700, 0 selects 1,000; these defaults are
                              limited to one revolution a second */
    double acceleration; /**< u/s2, 1,000 ... 5,000,000 counts/s2, CM2 up to 32,767,000; 0 selects 100,000 */
    double torque;       /**< % of rated torque, 10 ... 100; 0 selects 30 */
    double timeout_s;    /**< s; 0 selects 60 */
} cm1e_homing_config_t;

/** The inputs to which switches are wired: 1 ... 4 are IN1 ... IN4 of the motor, CM1E_WIRED_FIRST and above are signals
 *  of other slaves (cm1e_wiring_config_t); 0: none. MC_ReadAxisInfo shows the switches, and the homing steps of the
 *  host use them. They stop nothing by themselves. */
typedef struct cm1e_input_config {
    uint8_t limit_positive;         /**< reached in the positive direction of the axis */
    uint8_t limit_negative;         /**< reached in the negative direction; not the input of limit_positive */
    uint8_t home;                   /**< may be the input of a limit switch */
    bool limits_normally_closed;    /**< true: a limit switch is active while its input is off, so a broken wire is
                                         active */
    bool home_normally_closed;      /**< true: the home switch is active while its input is off */
} cm1e_input_config_t;

#define CM1E_WIRED_FIRST 11   /**< number of the first input and of the first output of an axis on other slaves */
#define CM1E_WIRED_SIGNALS 8  /**< maximum number of such inputs, and of such outputs, of an axis */
#define CM1E_SIGNAL_LENGTH 64 /**< maximum length of "SLAVE.SIGNAL" (cm1e/io.h), with its final 0 */

/** Signals of listed slaves (cm1e_slave_config_t) that belong to an axis, as cm1e_io_find() takes their names. Blocks
 *  that read an input, wait for a trigger or write an output reach them under the numbers CM1E_WIRED_FIRST,
 *  CM1E_WIRED_FIRST + 1 and so on, in the order of the list. Each is a single bit. */
typedef struct cm1e_wiring_config {
    uint8_t input_count, output_count; /**< 0 ... CM1E_WIRED_SIGNALS */
    char inputs[CM1E_WIRED_SIGNALS][CM1E_SIGNAL_LENGTH];
    char outputs[CM1E_WIRED_SIGNALS][CM1E_SIGNAL_LENGTH];
    char encoder[CM1E_SIGNAL_LENGTH];  /**< only with the type CM1E_AXIS_ENCODER: the signal with its counts, a whole
                                            number of any bits; it needs `max_velocity`. "": the program writes them */
} cm1e_wiring_config_t;

/** The mechanics that the simulator puts behind one axis; ignored on a real network. Positions are counts of the motor
 *  shaft, from its position at power-on. A zeroed struct is a linear axis with a light load, a hard stop 250,000 counts
 *  to either side, input 2 active beyond +150,000 counts and input 3 active beyond -150,000 counts. */
typedef struct cm1e_sim_axis_config {
    double load_inertia;     /**< kg m2, reflected to the shaft; 0 selects 2e-6 */
    double friction;         /**< Nm, Coulomb friction; 0 selects 0.005 */
    double viscous_friction; /**< Nm s/rad; 0 selects 1e-5 */
    double stop_positive;    /**< counts; 0 selects +250,000 */
    double stop_negative;    /**< counts; 0 selects -250,000 */
    bool no_stops;           /**< true: no hard stops, the shaft turns without limit */
    double sensor_input2;    /**< counts; IN2 is on beyond this position, on the side away from 0; 0 selects +150,000 */
    double sensor_input3;    /**< counts; IN3 is on beyond this position, on the side away from 0; 0 selects -150,000 */
    bool no_sensors;         /**< true: nothing is wired to IN2 and IN3 */
} cm1e_sim_axis_config_t;

/** Pulses of the distributed clock of a slave (docs/CLOCKS.md). They come at whole multiples of the cycle time of the
 *  bus plus the shift, counted from the moment at which the process data passes the reference clock. */
typedef struct cm1e_dc_config {
    double sync0_us;     /**< us, period of SYNC0: the cycle time of the bus, a part or a multiple of it; 0: no SYNC0,
                              the slave takes its cycle from the process data */
    double sync1_us;     /**< us, SYNC1 behind SYNC0 (register 0x09A4); 0: no SYNC1 */
    double shift_us;     /**< us, SYNC0 behind the process data, less than a cycle time to both sides; 0 selects half a
                              cycle time */
    char mode[32];       /**< name of an operation mode in the EEPROM of the slave (category DC), which gives the two
                              periods and adds to the shift; "first": its first mode with SYNC0. "": none */
} cm1e_dc_config_t;

/** The kinds of axes. */
typedef enum cm1e_axis_type {
    CM1E_AXIS_MOTOR = 0,             /**< a motor on the bus */
    CM1E_AXIS_VIRTUAL,               /**< no motor: its actual position is its set position; a master for others, or
                                          for trials */
    CM1E_AXIS_ENCODER,               /**< an encoder whose counts come from a signal of a slave (`wiring.encoder`), or
                                          from the program (cm1e_axis_write_encoder()); a master that others follow by
                                          its actual value */
} cm1e_axis_type_t;

/** What an axis does that cannot go on following its master, because of its limits or because the master failed. */
typedef enum cm1e_coupling_stop {
    CM1E_COUPLING_STOP_THIS = 0,     /**< it stops alone, with its own deceleration */
    CM1E_COUPLING_STOP_COUPLED,      /**< its master and all axes that follow the same master stop too */
    CM1E_COUPLING_STOP_KEEP_RATIO,   /**< the master is braked so that the axis can follow it down to standstill */
} cm1e_coupling_stop_t;

/** What an axis may follow. Memory for it is set aside when the axis is made. An encoder and an axis whose drive makes
 *  the motions follow nothing in any case. */
typedef enum cm1e_follows {
    CM1E_FOLLOWS_ANY = 0,            /**< gears, combinations and cams: 25 kB with cams of 128 points */
    CM1E_FOLLOWS_GEARS,              /**< MC_GearIn, MC_GearInPos, MC_CombineAxes, but no cams: 4 kB */
    CM1E_FOLLOWS_NOTHING,            /**< nothing. Others may follow this axis */
} cm1e_follows_t;

/** Types of signals, with their names in IEC 61131-3. */
typedef enum cm1e_io_type {
    CM1E_IO_BOOL = 0, /**< 1 bit */
    CM1E_IO_SINT,     /**< INTEGER8 */
    CM1E_IO_USINT,    /**< 2 ... 8 bits */
    CM1E_IO_INT,      /**< INTEGER16 */
    CM1E_IO_UINT,     /**< 9 ... 16 bits */
    CM1E_IO_DINT,     /**< INTEGER32 */
    CM1E_IO_UDINT,    /**< 17 ... 32 bits */
    CM1E_IO_LINT,     /**< INTEGER64 */
    CM1E_IO_ULINT,    /**< 33 ... 64 bits */
    CM1E_IO_REAL,     /**< REAL32 */
    CM1E_IO_LREAL,    /**< REAL64 */
    CM1E_IO_BYTES,    /**< more than 64 bits: cm1e_io_bytes() */
} cm1e_io_type_t;

/** Who brings a slave back to Operational that has left it, or an optional one that has come (docs/BUS-FILE.md). */
typedef enum cm1e_recover {
    CM1E_RECOVER_DEFAULT = 0, /**< ASK for a slave with motors, else AUTO */
    CM1E_RECOVER_NEVER,       /**< nobody, until the bus is started again */
    CM1E_RECOVER_ASK,         /**< somebody asks: MC_Reset of an axis of it, or cm1e_bus_recover() */
    CM1E_RECOVER_AUTO,        /**< the bus, as soon as the slave answers. It never enables a motor: after that its axis
                                   needs MC_Reset and MC_Power as after any loss */
} cm1e_recover_t;

/** What other programs may do with a running one through its control socket (docs/CONTROL.md). */
typedef enum cm1e_control_mode {
    CM1E_CONTROL_OBSERVE = 0,        /**< look: axes, slaves, statistics, log, reading objects */
    CM1E_CONTROL_NONE,               /**< nothing: there is no socket */
    CM1E_CONTROL_MAINTAIN,           /**< also write: objects and files of slaves whose axes the program does not
                                          command, outputs that it has not found, its variables; enable, move and
                                          reset axes that it does not command; and bring back slaves */
} cm1e_control_mode_t;

/** One axis: its address, its motor, its units and limits. */
typedef struct cm1e_axis_config {
    char name[CM1E_NAME_LENGTH];     /**< "" selects "axis<n>" */
    cm1e_axis_type_t type;           /**< an axis without a motor has no place on the bus; fields that describe a motor
                                          are then errors (docs/BUS-FILE.md) */
    cm1e_address_kind_t address_kind;
    uint16_t address;                /**< position (1 = first), alias or ID; 0 selects its place among the motors */
    uint8_t channel;                 /**< 0: the slave is the motor, a CM1-E. 1 ... 4: the motor is at this connector
                                          (ID) of an EtherCAT Cool MUSCLE Bridge; up to four axes have that address */
    char motor[20];                  /**< "CM1-E-17S30D", -17L30D, -23S30D or -23L20D; "" selects CM1-E-17S30D. Behind a
                                          bridge "CM1" or "CM2"; "" selects the kind that the bridge has there */
    uint8_t k37;                     /**< behind a bridge: K37 of the motor, its resolution and unit of speed */
    bool k37_stated;                 /**< true: `k37` is valid. An axis behind a bridge needs it to move: with another
                                          resolution the same counts are another distance */
    char firmware[12];               /**< expected or simulated firmware, "1.2.0" ... "1.3.5"; "": any; simulated
                                          1.3.5 */
    cm1e_mapping_t mapping;
    cm1e_motion_backend_t motion;
    double counts_per_unit;          /**< encoder counts (50,000 a revolution) per u; 0: the next three fields define
                                          u */
    uint32_t gear_numerator;         /**< revolutions of the motor, 1 ... 1,000,000; 0 selects 1 */
    uint32_t gear_denominator;       /**< for this number of revolutions of the load, 1 ... 1,000,000; 0 selects 1 */
    double units_per_revolution;     /**< u in one revolution of the load: 360, or the lead of a spindle; 0 selects 1 */
    double modulo_range;             /**< u; positions run from 0 to below this, the axis turns without limit; 0:
                                          linear */
    bool invert;                     /**< true: positive u is CCW */
    double backlash;                 /**< u between the two flanks, crossed at every reversal; 0: none */
    double backlash_velocity;        /**< u/s of the crossing, kept free below the peak speed; 0 selects 50,000
                                          counts/s */
    double max_velocity;             /**< u/s; 0 selects the motor's peak speed (UG 6.3), which is also the maximum */
    double max_acceleration;         /**< u/s2; 0 selects 5,000,000 counts/s2 */
    double max_deceleration;         /**< u/s2; 0 selects max_acceleration. Used for the ramp of ErrorStop too */
    double max_jerk;                 /**< u/s3; 0 selects 100,000,000 counts/s3 */
    double software_limit_positive;  /**< u; both limits 0: no limits; +INFINITY: none on this side */
    double software_limit_negative;  /**< u; -INFINITY: none on this side */
    double max_position_lag;         /**< u; 0 selects 25,000 counts (half a revolution) */
    double in_position_window;       /**< u, tolerance on either side of a set-point at standstill; 0 selects 10
                                          counts of 50,000 a revolution, at least 2 (docs/BUS-FILE.md) */
    double in_position_time_s;       /**< s for which the motor must stay in the window; 0 selects 0.02 */
    double in_position_timeout_s;    /**< s within which the motor must be in position if a Done waits; 0 selects 2 */
    bool in_position_done_waits;     /**< true: Done of a motion to a position waits until the motor is in position;
                                          false: it comes with the set-point */
    bool velocity_in_counts_per_ms;  /**< unit of 0x60FF/0x606C, if `velocity_unit_stated`; true: counts/ms */
    bool velocity_unit_stated;       /**< true: the field above is used instead of the firmware version */
    bool acceleration_in_kpulses;    /**< true: 0x6083/0x6084 take kpulses/s2 on the wire (UG 7.3.17/6.2.3) */
    double jog_slow, jog_fast;       /**< u/s, velocities of MC_Jog's own modes; 0 selects 5 % and 25 % of the
                                          maximum */
    uint16_t cam_points;             /**< maximum number of points of a cam for this axis, 2 ... 4096; 0 selects 128 */
    cm1e_coupling_stop_t coupling_stop; /**< used when the axis follows a master */
    double encoder_filter_s;         /**< s; time constant that smooths the actual position of this axis for axes that
                                          follow its actual value; 0 selects 10 cycles */
    bool table_profiles;             /**< true: memory (2 kB) for MC_PositionProfile, _VelocityProfile,
                                          _AccelerationProfile */
    cm1e_input_config_t inputs;
    cm1e_homing_config_t homing;
    cm1e_sim_axis_config_t sim;
    char device[12];                 /**< "cm1-e", "bridge" or "cia402", a servo drive of another maker; "" selects a
                                          bridge if `channel` is stated, else a CM1-E */
    uint32_t counts_per_revolution;  /**< of the motor; only with the device cia402, which needs it; 0: not stated */
    double max_speed_rpm;            /**< 1/min, of the motor; only with the device cia402, which needs it; 0: not
                                          stated */
    uint16_t outputs_pdo, inputs_pdo; /**< PDOs to assign, as 0x1600 and 0x1A00; only with the device cia402; 0 selects
                                          those that the drive has assigned itself */
    cm1e_dc_config_t dc;             /**< only with the device cia402: a CM1-E and a bridge take their cycle from the
                                          process data */
    bool optional;                   /**< true: the slave may be absent at the start, and come and go in operation; it
                                          is found by its alias or explicit ID. All axes of a bridge say the same */
    cm1e_recover_t recover;          /**< who brings its slave back; all axes of a bridge say the same */
    bool sim_absent;                 /**< simulated segment only: true: not plugged in at the start */
    cm1e_wiring_config_t wiring;     /**< signals of other slaves */
    cm1e_follows_t follows;
} cm1e_axis_config_t;

/** A start-up SDO of a slave: written at every start, and when the slave has come back. */
typedef struct cm1e_sdo_config {
    uint16_t index;
    uint8_t subindex;
    uint8_t bytes;                   /**< 1 ... 8; 0: `size` bytes of sdo_data */
    bool before_op;                  /**< true: written in Safe-Operational; false: before that, ahead of the PDOs */
    bool complete_access;            /**< true: the whole object from `subindex` (0 or 1) on; sub-index 0 has 16 bits */
    uint16_t size;                   /**< with `bytes` 0: 1 ... CM1E_SLAVE_SDO_DATA */
    uint64_t value;                  /**< its bits; the lowest `bytes` bytes are sent, little endian. With `bytes` 0:
                                          the place of the first byte in cm1e_slave_config_t.sdo_data */
} cm1e_sdo_config_t;

/** An entry of a PDO that is written anew. The entries of one PDO stand together, in their order. */
typedef struct cm1e_pdo_entry_config {
    uint16_t pdo;                    /**< 0x1600 ... 0x17FF or 0x1A00 ... 0x1BFF */
    uint16_t index;                  /**< 0: a gap of `bits` */
    uint8_t subindex, bits;          /**< bits: 1 ... 255 */
} cm1e_pdo_entry_config_t;

/** A signal of a slave with a name of its own: an object that its PDOs map, or bits by their place. */
typedef struct cm1e_signal_config {
    char name[CM1E_NAME_LENGTH];
    bool output;
    uint16_t index;                  /**< object; 0: by place, as `bit` and `bits` say */
    uint8_t subindex;
    bool type_stated;                /**< true: `type` is valid; false: as the slave says, or by the number of bits */
    cm1e_io_type_t type;
    uint16_t bit;                    /**< from the beginning of the slave's process data of this direction, 0 = first */
    uint16_t bits;                   /**< 0 selects those of the type, or 1 */
    bool hold;                       /**< outputs: true: keeps its last value where others take their safe value */
    double safe;                     /**< outputs: the safe value (docs/BUS-FILE.md); at most 64 bits */
} cm1e_signal_config_t;

/** What the simulated segment has at the place of a slave; ignored on a real network. */
typedef enum cm1e_sim_slave_kind {
    CM1E_SIM_SLAVE_GAP = 0,          /**< the device of `sim_gaps` */
    CM1E_SIM_SLAVE_COUPLER,          /**< no process data, no mailbox */
    CM1E_SIM_SLAVE_DIGITAL,          /**< a bit per channel, no mailbox */
    CM1E_SIM_SLAVE_ANALOG,           /**< 16 bits per channel, with CoE: settings, PDOs that can be written */
    CM1E_SIM_SLAVE_MODULAR,          /**< with CoE; it has the simulated modules that `modules` names */
    CM1E_SIM_SLAVE_ENCODER,          /**< with CoE; an input is a counter of 32 bits that turns by `counts_per_s` */
} cm1e_sim_slave_kind_t;

/** What a simulated slave without an axis is. */
typedef struct cm1e_sim_slave_config {
    cm1e_sim_slave_kind_t kind;
    uint8_t inputs, outputs;         /**< channels, 0 ... 8; at least one of a digital or analog device */
    char wired_to[CM1E_NAME_LENGTH]; /**< the slave to whose outputs the inputs are wired, channel by channel; "": to
                                          its own outputs, if it has any */
    bool swapped;                    /**< of a device with CoE: true: inputs on sync manager 2, outputs on 3 */
    double counts_per_s;             /**< of an encoder; 0: it stands */
} cm1e_sim_slave_config_t;

#define CM1E_SLAVE_SDOS 32        /**< maximum number of start-up SDOs of a slave */
#define CM1E_SLAVE_SDO_DATA 2048  /**< maximum number of bytes of all start-up SDOs of more than 8 bytes */
#define CM1E_SLAVE_PDOS 16        /**< maximum number of PDOs that are assigned in one direction */
#define CM1E_SLAVE_PDO_ENTRIES 64 /**< maximum number of entries of all PDOs that are written anew */
#define CM1E_SLAVE_MODULES 16     /**< maximum number of modules that are stated of a slave */
#define CM1E_SLAVE_SIGNALS 64     /**< maximum number of named signals */

/** A slave without an axis: terminal, encoder, device of another maker. Slaves that are not listed run too, with the
 *  process data of their SII and with signals that a program can find. */
typedef struct cm1e_slave_config {
    char name[CM1E_NAME_LENGTH];     /**< "" selects "slave<n>"; no name of an axis, no '.' */
    cm1e_address_kind_t address_kind;
    uint16_t address;                /**< position (1 = first), alias or explicit ID */
    uint32_t vendor, product, revision; /**< checked at the start; 0: any */
    uint16_t watchdog_ms;            /**< process data watchdog, 1 ... 6000; 0 selects 100 */
    uint16_t outputs_pdo_count, inputs_pdo_count; /**< 0: those that the slave has assigned itself */
    uint16_t outputs_pdos[CM1E_SLAVE_PDOS], inputs_pdos[CM1E_SLAVE_PDOS];
    uint16_t entry_count, sdo_count, signal_count;
    cm1e_pdo_entry_config_t entries[CM1E_SLAVE_PDO_ENTRIES];
    cm1e_sdo_config_t sdos[CM1E_SLAVE_SDOS];
    cm1e_signal_config_t signals[CM1E_SLAVE_SIGNALS];
    cm1e_sim_slave_config_t sim;
    cm1e_dc_config_t dc;             /**< SYNC0 and SYNC1; all zero: it takes its cycle from the process data */
    bool optional;                   /**< true: the slave may be absent at the start, and come and go in operation. It
                                          is found by its alias or explicit ID, or as a member of a group, and it states
                                          vendor and product */
    char hot_connect[CM1E_NAME_LENGTH]; /**< name of its Hot Connect group: optional slaves that come and go together,
                                          one behind the other. The first in the list, its head, has an alias or
                                          explicit ID; the position of each other one is its place in the group, and
                                          the head is 1. "": none */
    cm1e_recover_t recover;          /**< who brings it back */
    bool sim_absent;                 /**< simulated segment only: true: not plugged in at the start */
    char esi[256];                   /**< path of the ESI file from which a bus file took what it did not state; read
                                          again only where an ENI is made. "": none */
    uint16_t sdo_data_count;         /**< bytes of `sdo_data` that are used */
    uint8_t sdo_data[CM1E_SLAVE_SDO_DATA]; /**< of start-up SDOs with `bytes` 0 */
    uint16_t described_count;        /**< entries behind the first `entry_count` that are not written, but that an ESI
                                          states of the assigned PDOs: places of signals of a slave that is absent */
    uint16_t module_count;           /**< of a modular device (ETG.5001); 0: its modules are not checked */
    uint32_t modules[CM1E_SLAVE_MODULES]; /**< idents, slot by slot: compared with what it has detected (0xF050), and
                                          written as its configuration (0xF030), where it lets it be written */
} cm1e_slave_config_t;

/** The whole bus. The configuration owns its axes and slaves: make it with cm1e_bus_config_init() or
 *  cm1e_bus_config_load(), add to it with cm1e_bus_config_add_axis() and cm1e_bus_config_add_slave(), and free it with
 *  cm1e_bus_config_free() when the bus is open, because the bus has a copy. Later versions add members at the end of
 *  this struct, of cm1e_axis_config_t and of cm1e_slave_config_t only. The sizes tell the library which members the
 *  program was compiled with. */
typedef struct cm1e_bus_config {
    size_t size, axis_size;          /**< bytes of this struct and of an axis; 0: the sizes that the library has */
    uint32_t axis_count;             /**< at most CM1E_MAX_AXES */
    cm1e_axis_config_t *axes;        /**< axes[0] ... axes[axis_count - 1] */
    char interface_name[64];         /**< "eth1", "sim", "sim:<bus file>"; "" selects "sim". "eth1,xdp" sends and
                                          receives by AF_XDP, "eth1,packet" by a packet socket, as "eth1" does */
    char second_interface[64];       /**< second network interface of a redundant ring, with a way of its own
                                          ("eth2,xdp"); "": none */
    int64_t cycle_time_ns;           /**< 200,000, 250,000, 500,000 or 1,000,000; 0 selects 1,000,000 */
    int64_t frame_timeout_ns;        /**< time to wait for a late frame; 0 selects a quarter of the cycle time */
    uint32_t lost_cycles_limit;      /**< bad cycles in a row until ErrorStop, at most 50 ms of cycles; 0 selects 3 */
    char pcap_file[256];             /**< file for every frame; the cycle writes it too: for tests, not for real time;
                                          "": none */
    bool virtual_time;               /**< simulated segment only: time passes only in the cycle and in waits */
    cm1e_pdo_order_t sim_pdo_order;  /**< simulated segment only */
    cm1e_sim_io_t sim_gaps;          /**< simulated segment only: the device at each place without a motor */
    cm1e_control_mode_t control;     /**< only where the program links cm1e::control */
    size_t slave_size;               /**< bytes of a slave; 0: the size that the library has */
    uint32_t slave_count;            /**< at most CM1E_MAX_SLAVES */
    cm1e_slave_config_t *slaves;     /**< slaves[0] ... slaves[slave_count - 1] */
    bool distributed_clocks;         /**< true: the cycle follows the clock of the first slave that has one, so frames
                                          arrive at a constant phase; also if an axis has `dc` */
    char name[CM1E_NAME_LENGTH];     /**< of one of several buses of a bus file; "": there is only this one */
    bool overlap;                    /**< true: in the frames the inputs of a slave take the place of its outputs, so
                                          that more motors fit into a cycle; neither with `second_interface` nor with
                                          optional slaves */
} cm1e_bus_config_t;

/** Does the work of cm1e_bus_config_init(), for a program with these sizes of the structs. @rt init */
CM1E_API cm1e_error_t cm1e_bus_config_init_sized(cm1e_bus_config_t *config, size_t size, size_t axis_size,
                                                 const char *interface_name, uint32_t axis_count);
/** Initialises a configuration with `axis_count` default axes, at positions 1 ... n, on `interface_name` (NULL selects
 *  "sim"). The content of `config` is overwritten: free an earlier configuration first. Returns CM1E_ERROR_NO_MEMORY,
 *  or CM1E_ERROR_CONFIG for more than CM1E_MAX_AXES; cm1e_bus_open() refuses the configuration then. @rt init */
static inline cm1e_error_t cm1e_bus_config_init(cm1e_bus_config_t *config, const char *interface_name,
                                                uint32_t axis_count)
{
    return cm1e_bus_config_init_sized(config, sizeof(cm1e_bus_config_t), sizeof(cm1e_axis_config_t), interface_name,
                                      axis_count);
}

/** Adds an axis with defaults and returns it; `name` NULL or "" selects "axis<n>". The pointer is valid until the next
 *  axis is added. Returns NULL if there are CM1E_MAX_AXES axes already, or no memory. @rt init */
CM1E_API cm1e_axis_config_t *cm1e_bus_config_add_axis(cm1e_bus_config_t *config, const char *name);

/** Does the work of cm1e_bus_config_add_slave(), for a program with this size of the struct. @rt init */
CM1E_API cm1e_slave_config_t *cm1e_bus_config_add_slave_sized(cm1e_bus_config_t *config, size_t slave_size,
                                                              const char *name);
/** Adds a slave without an axis and returns it, with defaults and without an address; `name` NULL or "" selects
 *  "slave<n>". The pointer is valid until the next slave is added. Returns NULL if there are CM1E_MAX_SLAVES slaves
 *  already, or no memory. @rt init */
static inline cm1e_slave_config_t *cm1e_bus_config_add_slave(cm1e_bus_config_t *config, const char *name)
{
    return cm1e_bus_config_add_slave_sized(config, sizeof(cm1e_slave_config_t), name);
}

/** Frees the axes and slaves; the configuration has none then. NULL is allowed. @rt init */
CM1E_API void cm1e_bus_config_free(cm1e_bus_config_t *config);

/** Does the work of cm1e_bus_config_load(), for a program with these sizes of the structs. @rt init */
CM1E_API cm1e_error_t cm1e_bus_config_load_sized(cm1e_bus_config_t *config, size_t size, size_t axis_size,
                                                 const char *path, cm1e_diag_t *diag);
/** Does the work of cm1e_bus_config_load_all(), for a program with these sizes of the structs. @rt init */
CM1E_API cm1e_error_t cm1e_bus_config_load_all_sized(cm1e_bus_config_t *configs, size_t size, size_t axis_size,
                                                     uint32_t room, uint32_t *count, const char *path,
                                                     cm1e_diag_t *diag);
/** Gives the slaves of a configuration the size that the program has for them. After a failure, CM1E_ERROR_NO_MEMORY,
 *  the configuration is freed. @rt init */
CM1E_API cm1e_error_t cm1e_bus_config_size_slaves(cm1e_bus_config_t *config, size_t slave_size, cm1e_diag_t *diag);
/** Makes a configuration from a bus file (YAML; docs/BUS-FILE.md describes it), instead of cm1e_bus_config_init(): free
 *  an earlier configuration first. After a failure `config` is unchanged, and `diag` names file, line, column, what was
 *  found and what was expected. @rt init */
static inline cm1e_error_t cm1e_bus_config_load(cm1e_bus_config_t *config, const char *path, cm1e_diag_t *diag)
{
    const cm1e_error_t error = cm1e_bus_config_load_sized(config, sizeof(cm1e_bus_config_t), sizeof(cm1e_axis_config_t),
                                                          path, diag);
    return error != CM1E_OK ? error : cm1e_bus_config_size_slaves(config, sizeof(cm1e_slave_config_t), diag);
}
/** As cm1e_bus_config_load(), for a bus file with several buses (`buses`) too: fills in configs[0] ... configs[*count
 *  - 1], in the order of the file, each to be freed. A file of one bus has a count of 1. `room`: of the array,
 *  CM1E_MAX_BUSES is always enough; a file with more buses is refused. After a failure there is nothing to be freed.
 *  Open and start the buses one after the other, then cm1e_scheduler_create() and cm1e_scheduler_add_bus(). @rt init */
static inline cm1e_error_t cm1e_bus_config_load_all(cm1e_bus_config_t *configs, uint32_t room, uint32_t *count,
                                                    const char *path, cm1e_diag_t *diag)
{
    cm1e_error_t error = cm1e_bus_config_load_all_sized(configs, sizeof(cm1e_bus_config_t), sizeof(cm1e_axis_config_t),
                                                        room, count, path, diag);
    for (uint32_t i = 0; error == CM1E_OK && i < *count; i++)
        error = cm1e_bus_config_size_slaves(&configs[i], sizeof(cm1e_slave_config_t), diag);
    for (uint32_t i = 0; error == CM1E_ERROR_NO_MEMORY && i < *count; i++)
        cm1e_bus_config_free(&configs[i]);
    return error;
}

/** Checks a configuration made by hand for ranges and contradictions; a bus file is checked when it is loaded. Returns
 *  CM1E_ERROR_CONFIG with the reason in `diag`. @rt init */
CM1E_API cm1e_error_t cm1e_bus_config_check(const cm1e_bus_config_t *config, cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
