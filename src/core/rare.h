/**
 * @file rare.h
 * Marks a function that a cycle seldom needs, within code that every cycle of every axis runs. It is kept out of line,
 * so that the usual path neither saves registers for it nor jumps over it.
 */
#ifndef CM1E_CORE_RARE_H
#define CM1E_CORE_RARE_H

#define CM1E_RARE __attribute__((noinline, cold))

#endif
