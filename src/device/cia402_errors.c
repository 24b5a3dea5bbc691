#include "device/cia402_drive.h"
#include "device/device_rows.h"

/* CiA 301 and CiA 402 (IEC 61800-7-201), the codes that drives use. The cures are ours. */
#define FAULT(code, register, text, cure, ...) ERROR(code, register, true, false, text, cure, __VA_ARGS__)
static const cm1e_device_error_t errors[] = {
    ERROR(0x0000, 0x00, false, false, "No error", "nothing to do", ),
    FAULT(0x1000, 0x01, "Generic error", "look into the drive's manual for its own error code; then reset the fault", ),
    FAULT(0x2310, 0x03, "Continuous over current", "reduce load, friction or acceleration; then reset the fault", ),
    FAULT(0x2320, 0x03, "Short circuit or earth leakage", "check the motor cable and the motor before a fault reset", ),
    FAULT(0x3110, 0x05, "Mains over voltage", "check the supply; then reset the fault", ),
    FAULT(0x3120, 0x05, "Mains under voltage", "check the supply and its fuses; then reset the fault",
          .motor_power = true),
    FAULT(0x3130, 0x05, "Phase failure of the mains", "check the supply and its fuses; then reset the fault", ),
    FAULT(0x3210, 0x05, "DC link over voltage",
          "brake less, or give the drive a brake resistor; then reset the fault", ),
    FAULT(0x3220, 0x05, "DC link under voltage", "switch the motor power on and check its fuse; then reset the fault",
          .motor_power = true),
    FAULT(0x4210, 0x09, "Over temperature of the device",
          "improve the cooling or reduce the load; then reset the fault", ),
    FAULT(0x4310, 0x09, "Over temperature of the drive", "let it cool down or reduce the load; then reset the fault", ),
    /* The standard leaves to the maker which contact that is. */
    FAULT(0x5441, 0x81, "Contact 1, often the enable input or safe torque off",
          "close the safety circuit; then reset the fault", ),
    FAULT(0x7120, 0x21, "Motor", "check the motor and its cables; then reset the fault", ),
    FAULT(0x7121, 0x21, "Motor blocked", "free the axis; then reset the fault", ),
    FAULT(0x7122, 0x21, "Motor, or its commutation", "check motor, encoder and their cables; then reset the fault", ),
    FAULT(0x7305, 0x21, "Incremental sensor 1", "check the encoder and its cable; then reset the fault", ),
    FAULT(0x7310, 0x21, "Speed", "command less than the motor's maximum speed; then reset the fault", ),
    FAULT(0x7320, 0x21, "Position", "check the encoder; then reset the fault", ),
    FAULT(0x7500, 0x11, "Communication", "check cables and master; then reset the fault", ),
    FAULT(0x8100, 0x11, "Communication, monitoring", "check cables and the load of the master; then reset the fault", ),
    FAULT(0x8400, 0x21, "Velocity controller",
          "reduce load or acceleration, or tune the drive; then reset the fault", ),
    FAULT(0x8500, 0x21, "Position controller",
          "reduce load or acceleration, or tune the drive; then reset the fault", ),
    FAULT(0x8611, 0x21, "Following error",
          "look for a blocked axis, reduce load or acceleration, or tune the drive; then reset the fault", ),
    FAULT(0x8612, 0x21, "Reference limit", "move off the limit switch or the end of the range; then reset the fault", ),
    FAULT(0x8700, 0x21, "Synchronisation",
          "check the cycle time and how evenly the master keeps it; then reset the fault", ),
};

const cm1e_device_error_t *cm1e_cia402_error(uint16_t code)
{
    for (size_t i = 0; i < COUNT(errors); i++)
        if (errors[i].code == code)
            return &errors[i];
    return NULL;
}
