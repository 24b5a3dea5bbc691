/**
 * @file rare.h
 * For a function that a cycle seldom needs, within one that every cycle of every axis needs: it is kept out of line, so
 * that the usual way neither saves registers for it nor jumps over it.
 */
#ifndef CM1E_CORE_RARE_H
#define CM1E_CORE_RARE_H

#define CM1E_RARE __attribute__((noinline, cold))

#endif
