#include "device/bridge_tables.h"

/*
 * The table of one axis, bridge_axis_objects.inc, for all axes and both kinds of motor: 0x800 lies between the axes,
 * and what differs by motor is there in pairs (CM1, CM2).
 */

#define INDEX(index) ((index) + CM1E_BRIDGE_INDEX_INCREMENT * AXIS)

#define JOIN_TOKENS(a, b) a##b
#define JOIN(a, b) JOIN_TOKENS(a, b)
#define OF_CM1(cm1, cm2) cm1
#define OF_CM2(cm1, cm2) cm2
#define OF_MOTOR(cm1, cm2) JOIN(OF_, MOTOR)(cm1, cm2)

/* Origin search (BR 6.4.1, notes 1 to 3): unit, default, least, greatest. */
#define K42_CM1 "100 pulses/s", 100, 1, 5000
#define K42_CM2 "100 pulses/s", 10, 1, 32767
#define K43_CM1 "1000 pulses/s2", 100, 1, 5000
#define K43_CM2 "1000 pulses/s2", 100, 1, 32767
#define K48_CM1 "100 pulses", 0, -32767, 32767
#define K48_CM2 "100, 10 or 1 pulses by K45", 0, -32767, 32767
#define RANGE(parameter) JOIN(parameter##_, MOTOR)

/* ENTRY_RANGE() with a RANGE() among its arguments. */
#define ROW(...) ENTRY_RANGE(__VA_ARGS__)

#define AXIS_VAR(index, name, access, type, unit, value) VAR(INDEX(index), name, access, type, unit, value)
#define AXIS_RANGE(index, name, type, ...)                                                                          \
    OBJECT_SINCE(INDEX(index), CM1E_OBJECT_VAR, name, 0, CM1E_FIRMWARE_1_2_0,                                       \
                 ROW(INDEX(index), 0, RW, type, name, __VA_ARGS__, ))
#define AXIS_NA(index, name, access, type, unit)                                                                    \
    OBJECT_SINCE(INDEX(index), CM1E_OBJECT_VAR, name, 0, CM1E_FIRMWARE_1_2_0,                                       \
                 ENTRY(INDEX(index), 0, access, type, name, unit, 0, NA))

#define METHOD(sub, name) ENTRY(INDEX(0x60E3), sub, RO, INT, name, "", sub, )
/* K48 may be negative, so all of them are signed: they are elements of one array. */
#define KEPT(text) .use = CM1E_USE_KEPT, .meaning = text
#define K_MEANS(sub, number, cm1, cm2, text)                                                                        \
    ENTRY(INDEX(0x60F6), sub, RW, DINT, "K" #number, "", 0, OF_MOTOR(cm1, cm2), KEPT(text))
#define K(sub, number, cm1, cm2)                                                                                    \
    K_MEANS(sub, number, cm1, cm2, "parameter of the motor: see the Cool Muscle manuals; kept (BR 7.5)")
#define K_INPUT "what an input does: written while it is on, the motor may move; kept (BR 7.5)"
#define K_RANGE(sub, number, text) ROW(INDEX(0x60F6), sub, RW, DINT, "K" #number, RANGE(K##number), KEPT(text))
#define STIFFNESS(sub, name, cm2)                                                                                   \
    ENTRY(INDEX(0x60FB), sub, RW, DINT, name, "", 0, OF_MOTOR(NA, cm2), KEPT("stiffness of the servo; kept (BR 7.5)"))

#define AXIS 0
#define MOTOR CM1
static const cm1e_object_t axis_0_cm1[] = {
#include "device/bridge_axis_objects.inc"
};
#undef MOTOR
#define MOTOR CM2
static const cm1e_object_t axis_0_cm2[] = {
#include "device/bridge_axis_objects.inc"
};
#undef AXIS
#define AXIS 1
static const cm1e_object_t axis_1_cm2[] = {
#include "device/bridge_axis_objects.inc"
};
#undef MOTOR
#define MOTOR CM1
static const cm1e_object_t axis_1_cm1[] = {
#include "device/bridge_axis_objects.inc"
};
#undef AXIS
#define AXIS 2
static const cm1e_object_t axis_2_cm1[] = {
#include "device/bridge_axis_objects.inc"
};
#undef MOTOR
#define MOTOR CM2
static const cm1e_object_t axis_2_cm2[] = {
#include "device/bridge_axis_objects.inc"
};
#undef AXIS
#define AXIS 3
static const cm1e_object_t axis_3_cm2[] = {
#include "device/bridge_axis_objects.inc"
};
#undef MOTOR
#define MOTOR CM1
static const cm1e_object_t axis_3_cm1[] = {
#include "device/bridge_axis_objects.inc"
};
enum { OBJECT_COUNT = sizeof axis_0_cm1 / sizeof axis_0_cm1[0] };

static const cm1e_object_t *const axes[CM1E_BRIDGE_AXES][2] = {
    {axis_0_cm1, axis_0_cm2},
    {axis_1_cm1, axis_1_cm2},
    {axis_2_cm1, axis_2_cm2},
    {axis_3_cm1, axis_3_cm2},
};

const cm1e_object_t *cm1e_bridge_axis_objects(cm1e_bridge_motor_t motor, unsigned axis, size_t *count)
{
    *count = OBJECT_COUNT;
    return axes[axis][motor == CM1E_BRIDGE_CM2];
}
