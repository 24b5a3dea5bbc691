#include "device/objects.h"

/* UG 7.3.22: 81 parameters of the motor itself, K number = 20 + sub-index. The guide explains two of them, K34 (output
 * 2, UG 7.3.25) and K47 (homing torque, UG 6.2.4), and names no range for the others. */
#define K_MEANS(sub, number, text)                                                                                  \
    ENTRY(OBJ_60F6_K_PARAMETERS, sub, RW, UINT, "K" #number, "", 0, .use = CM1E_USE_SETTING, .meaning = text)
#define K(sub, number)                                                                                              \
    K_MEANS(sub, number, "parameter of the motor without meaning in the guide: see the Cool Muscle manuals (UG 7.3.22)")

const cm1e_entry_t cm1e_device_k_parameters[1 + K_PARAMETER_COUNT] = {
    ENTRY_COUNT(OBJ_60F6_K_PARAMETERS, USINT, K_PARAMETER_COUNT, ),
    K(1, 21), K(2, 22), K(3, 23), K(4, 24), K(5, 25), K(6, 26), K(7, 27), K(8, 28), K(9, 29), K(10, 30), K(11, 31),
    K(12, 32), K(13, 33),
    K_MEANS(14, 34, "what output 2 shows: 10 in position, 20 alarm (UG 7.3.25)"),
    K(15, 35), K(16, 36), K(17, 37), K(18, 38), K(19, 39), K(20, 40), K(21, 41),
    K(22, 42), K(23, 43), K(24, 44), K(25, 45), K(26, 46),
    ENTRY_RANGE(OBJ_60F6_K_PARAMETERS, CM1E_K_PARAMETER_HOMING_TORQUE, RW, UINT, "K47", "%", 30, 10, 100,
                .use = CM1E_USE_SETTING, .meaning = "torque limit of a homing, against a hard stop or to a switch "
                                                    "(UG 6.2.4)"),
    K(28, 48), K(29, 49), K(30, 50), K(31, 51), K(32, 52), K(33, 53), K(34, 54), K(35, 55), K(36, 56), K(37, 57),
    K(38, 58), K(39, 59), K(40, 60), K(41, 61), K(42, 62), K(43, 63), K(44, 64), K(45, 65), K(46, 66), K(47, 67),
    K(48, 68), K(49, 69), K(50, 70), K(51, 71), K(52, 72), K(53, 73), K(54, 74), K(55, 75), K(56, 76), K(57, 77),
    K(58, 78), K(59, 79), K(60, 80), K(61, 81), K(62, 82), K(63, 83), K(64, 84), K(65, 85), K(66, 86), K(67, 87),
    K(68, 88), K(69, 89), K(70, 90), K(71, 91), K(72, 92), K(73, 93), K(74, 94), K(75, 95), K(76, 96), K(77, 97),
    K(78, 98), K(79, 99), K(80, 100), K(81, 101),
};
