/**
 * @file veth.h
 * For tests with real network interfaces: a network namespace of the test's own with a veth pair "wire0" - "wire1",
 * which vanishes with the test. Where the machine does not allow that, veth_make() is false and the test is skipped.
 */
#ifndef CM1E_TEST_VETH_H
#define CM1E_TEST_VETH_H

#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

bool veth_make(void);

#endif
