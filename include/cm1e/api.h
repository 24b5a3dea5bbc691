/**
 * @file api.h
 * What the compiler is told beside ISO C. Other compilers than GCC and clang see plain declarations.
 */
#ifndef CM1E_API_H
#define CM1E_API_H

#ifdef __GNUC__
/** The shared library exports this function; every other symbol is hidden. */
#define CM1E_API __attribute__((visibility("default")))
/** The linker knows the function by this name, which has a prefix where the standard's name has none. */
#define CM1E_SYMBOL(name) __asm__(name)
/** Argument `text` is a format of printf(); its values begin with argument `first`. */
#define CM1E_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define CM1E_API
#define CM1E_SYMBOL(name)
#define CM1E_PRINTF(text, first)
#endif

#endif
