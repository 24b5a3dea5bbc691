/**
 * @file rare.h
 * Marks a function that a cycle seldom needs, within code that every cycle of every axis runs. It is kept out of line,
 * so that the usual path neither saves registers for it nor jumps over it. A chain of conditions that the compiler
 * knows nothing of makes the usual path look rare.
 */
#ifndef CM1E_CORE_RARE_H
#define CM1E_CORE_RARE_H

#define CM1E_RARE __attribute__((noinline, cold))
/** The same for a function that is to be as fast as any other when its time comes, with all that it calls: what a block
 *  does at its edge. */
#define CM1E_APART __attribute__((noinline))
/** A condition that is nearly always true: what follows from it belongs to the usual path. */
#define CM1E_USUALLY(condition) __builtin_expect((condition), 1)

#endif
