#include "device/device_rows.h"

/* UG 7.3.1, in the manual's order. The cures are ours. */
const cm1e_device_error_t cm1e_device_errors[] = {
    ERROR(0x0000, 0x00, false, false, "No error", "nothing to do", ),
    ERROR(0x2310, 0x03, true, false, "Continuous over current error (torque overload)",
     "reduce load, friction or acceleration, or use a larger motor; then reset the fault",
     .cause = "the motor needs more torque than it can give for so long: too much load, friction or acceleration"),
    ERROR(0x4310, 0x09, true, false, "Drive over temperature",
     "let the motor cool down, improve the cooling or reduce the load; then reset the fault",
     .cause = "the motor has got too hot: too much load, or too little cooling"),
    ERROR(0x4502, 0x00, false, false, "No mode selected (0x6060=0)", "write a mode of operation to 0x6060",
     .only_off = true,
     .cause = "the master has not written a mode to 0x6060 yet"),
    ERROR(0x7310, 0x81, true, false, "Over speed error",
     "command less than the motor's peak speed and check for a load that drives the motor; then reset the fault",
     .cause = "the motor turns faster than its peak speed: commanded so, or driven by its load"),
    ERROR(0x7320, 0x81, true, false, "Position Error overflow",
     "look for a blocked axis, reduce load or acceleration, or retune the motor; then reset the fault",
     .cause = "the motor does not follow its set-point: blocked, overloaded, accelerated too much, or badly tuned"),
    ERROR(0x7500, 0x11, true, false, "Motor communication error",
     "reset the fault; if it comes back, switch the motor's control power off and on",
     .cause = "the electronics of the motor do not answer each other"),
    ERROR(0x7510, 0x11, true, false, "Motor drive to EtherCAT slave communication error",
     "reset the fault (after power-up the device then restarts and leaves the bus for a moment); if it comes back, "
     "switch the motor's control power off and on", .restarts = true,
     .cause = "the part of the motor that speaks EtherCAT and the part that drives it do not answer each other"),
    ERROR(0x8611, 0x00, false, false, "Motor not currently following commanded position",
     "nothing to do while the drive is not in Operation enabled; otherwise look for a blocked or overloaded axis",
     .only_off = true,
     .cause = "the drive is not in Operation enabled, or the motor cannot follow"),
    ERROR(0xFF01, 0x00, false, false, "Motor disabled by command", "enable the drive", .only_off = true,
     .cause = "the controlword has taken the enable away"),
    ERROR(0xFF04, 0x81, true, false, "Emergency stop active", "release the emergency stop; then reset the fault",
     .cause = "the emergency stop input of the motor is active"),
    ERROR(0xFF05, 0x11, true, true, "24V drive power not present",
     "switch the 24 V motor power on and check its fuse and wiring; then reset the fault",
     .motor_power = true,
     .cause = "the motor has control power, but no 24 V at its power input"),
};
const size_t cm1e_device_error_count = sizeof cm1e_device_errors / sizeof cm1e_device_errors[0];

const cm1e_device_error_t *cm1e_device_error(uint16_t code)
{
    for (size_t i = 0; i < cm1e_device_error_count; i++)
        if (cm1e_device_errors[i].code == code)
            return &cm1e_device_errors[i];
    return NULL;
}
