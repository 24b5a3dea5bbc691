/**
 * @file pdo_tables.h
 * The contents of the PDO mapping objects, once, for the dictionary and for cm1e_device_pdo(): X(place, index, bits,
 * name). The manual has two orders, UG 4.4 (also the EC_EXTEND of UG 11.2.1) and UG 7.2. UG 7.2 also states 6077 with
 * 32 bits and numbers of entries that do not fit its rows; both are taken for slips. Its row 2 of 0x1603 is missing:
 * there 60FE belongs. 6079 is 32 bits in the dictionary and 16 in the process data. The last row of 0x1603 and 0x1A03
 * came with V1.3.0 (UG 10.1).
 */
#ifndef CM1E_DEVICE_PDO_TABLES_H
#define CM1E_DEVICE_PDO_TABLES_H

#define PDO_1600_UG_4_4(X)                                                                                          \
    X(1, 6040, 16, "Controlword mapping")                                                                           \
    X(2, 60FE, 16, "Digital outputs mapping")                                                                       \
    X(3, 607A, 32, "Target position mapping")                                                                       \
    X(4, 60FF, 32, "Target velocity mapping")                                                                       \
    X(5, 6060, 8, "Mode of operation mapping")
#define PDO_1600_UG_7_2(X)                                                                                          \
    X(1, 6040, 16, "Controlword mapping")                                                                           \
    X(2, 607A, 32, "Target position mapping")                                                                       \
    X(3, 60FF, 32, "Target velocity mapping")                                                                       \
    X(4, 60FE, 16, "Digital outputs mapping")                                                                       \
    X(5, 6060, 8, "Mode of operation mapping")

#define PDO_1601_UG_4_4(X)                                                                                          \
    X(1, 6040, 16, "Controlword mapping")                                                                           \
    X(2, 60FE, 16, "Digital outputs mapping")                                                                       \
    X(3, 607A, 32, "Target position mapping")
#define PDO_1601_UG_7_2(X)                                                                                          \
    X(1, 6040, 16, "Controlword mapping")                                                                           \
    X(2, 607A, 32, "Target position mapping")                                                                       \
    X(3, 60FE, 16, "Digital outputs mapping")

#define PDO_1602_UG_4_4(X)                                                                                          \
    X(1, 6040, 16, "Controlword mapping")                                                                           \
    X(2, 60FE, 16, "Digital outputs mapping")                                                                       \
    X(3, 60FF, 32, "Target velocity mapping")
#define PDO_1602_UG_7_2(X)                                                                                          \
    X(1, 6040, 16, "Controlword mapping")                                                                           \
    X(2, 60FF, 32, "Target velocity mapping")                                                                       \
    X(3, 60FE, 16, "Digital outputs mapping")

#define PDO_1603_UG_4_4(X)                                                                                          \
    X(1, 6040, 16, "Controlword mapping")                                                                           \
    X(2, 60FE, 16, "Digital outputs mapping")                                                                       \
    X(3, 607A, 32, "Target position mapping")                                                                       \
    X(4, 60FF, 32, "Target velocity mapping")                                                                       \
    X(5, 6081, 32, "Profile velocity mapping")                                                                      \
    X(6, 6083, 32, "Profile acceleration mapping")                                                                  \
    X(7, 6060, 8, "Mode of operation mapping")
#define PDO_1603_UG_7_2(X) PDO_1603_UG_4_4(X)

#define PDO_1A00_UG_4_4(X)                                                                                          \
    X(1, 6041, 16, "Statusword mapping")                                                                            \
    X(2, 603F, 16, "Error code mapping")                                                                            \
    X(3, 6064, 32, "Position actual value mapping")                                                                 \
    X(4, 606C, 32, "Velocity actual value mapping")                                                                 \
    X(5, 6077, 16, "Torque actual value mapping")                                                                   \
    X(6, 60FD, 16, "Digital input mapping")                                                                         \
    X(7, 2301, 16, "Temperature-C mapping")                                                                         \
    X(8, 6079, 16, "DC voltage mapping")                                                                            \
    X(9, 6061, 8, "Modes of operation display mapping")
#define PDO_1A00_UG_7_2(X)                                                                                          \
    X(1, 6041, 16, "Statusword mapping")                                                                            \
    X(2, 6064, 32, "Position actual value mapping")                                                                 \
    X(3, 606C, 32, "Velocity actual value mapping")                                                                 \
    X(4, 6077, 16, "Torque actual value mapping")                                                                   \
    X(5, 60FD, 16, "Digital input mapping")                                                                         \
    X(6, 603F, 16, "Error code mapping")                                                                            \
    X(7, 2301, 16, "Temperature-C mapping")                                                                         \
    X(8, 6079, 16, "DC voltage mapping")                                                                            \
    X(9, 6061, 8, "Modes of operation display mapping")

/* UG 4.4.2 and 4.4.3 have the torque before the speed, unlike UG 4.4.1 and 4.4.4. */
#define PDO_1A01_UG_4_4(X)                                                                                          \
    X(1, 6041, 16, "Statusword mapping")                                                                            \
    X(2, 603F, 16, "Error code mapping")                                                                            \
    X(3, 6064, 32, "Position actual value mapping")                                                                 \
    X(4, 6077, 16, "Torque actual value mapping")                                                                   \
    X(5, 606C, 32, "Velocity actual value mapping")                                                                 \
    X(6, 60FD, 16, "Digital input mapping")
#define PDO_1A01_UG_7_2(X)                                                                                          \
    X(1, 6041, 16, "Statusword mapping")                                                                            \
    X(2, 6064, 32, "Position actual value mapping")                                                                 \
    X(3, 606C, 32, "Velocity actual value mapping")                                                                 \
    X(4, 6077, 16, "Torque actual value mapping")                                                                   \
    X(5, 60FD, 16, "Digital input mapping")                                                                         \
    X(6, 603F, 16, "Error code mapping")
#define PDO_1A02_UG_4_4(X) PDO_1A01_UG_4_4(X)
#define PDO_1A02_UG_7_2(X) PDO_1A01_UG_7_2(X)

#define PDO_1A03_UG_4_4(X) PDO_1A00_UG_4_4(X)
#define PDO_1A03_UG_7_2(X) PDO_1A00_UG_7_2(X)

#endif
