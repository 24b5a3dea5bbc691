/**
 * @file st_runtime.h
 * The run-time part of a program translated from Structured Text; it is a part of the translated program. It needs
 * -fwrapv: integers wrap at the ends of their types. What cannot go on (a wrong index, a division of integers by zero,
 * a reference to nothing, a loop without an end) is a fault: the task returns at once, no task runs again, and whoever
 * runs the program stops the axes.
 */
#ifndef CM1E_ST_RUNTIME_H
#define CM1E_ST_RUNTIME_H

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined __GNUC__
#pragma GCC diagnostic ignored "-Woverflow" /* integers wrap, constants too */
#if !defined __clang__
#if __GNUC__ >= 11
#pragma GCC diagnostic ignored "-Wstringop-overread" /* it does not see that the length of a text is looked at */
#endif
/* GCC 12 makes |x| of IF x < 0 THEN x := 0 - x, and takes that for above 0, although it wraps at the smallest
 * number. */
#pragma GCC optimize("no-ssa-phiopt")
#else
#pragma clang diagnostic ignored "-Wparentheses-equality" /* every operation has brackets */
#endif
#define ST_UNUSED __attribute__((unused))
#define ST_EXPORT __attribute__((visibility("default")))
#define ST_NO_RETURN __attribute__((noreturn, cold))
#else
#define ST_UNUSED
#define ST_EXPORT
#define ST_NO_RETURN
#endif

typedef uint8_t BOOL, BYTE, USINT;
typedef uint16_t WORD, UINT;
typedef uint32_t DWORD, UDINT;
typedef uint64_t LWORD, ULINT;
typedef int8_t SINT;
typedef int16_t INT;
typedef int32_t DINT;
typedef int64_t LINT, TIME, DATE, TOD, DT;
typedef float REAL;
typedef double LREAL;
#define TRUE 1
#define FALSE 0

/* ---- faults ------------------------------------------------------------------------------------------------------ */

static jmp_buf st_leave;
static st_fault_t st_fault;
static int64_t st_loop_limit = 1000000, st_loops_left;
#define ST_HERE __FILE__, __LINE__

ST_NO_RETURN ST_UNUSED static void st_fail(const char *file, int line, const char *text, long long a, long long b,
                                           long long c)
{
    st_fault = (st_fault_t){1, file, (unsigned)line, text, {a, b, c}};
    longjmp(st_leave, 1);
}

ST_UNUSED static inline void st_loop(const char *file, int line)
{
    if (--st_loops_left < 0)
        st_fail(file, line, "this loop, with those around and before it, has been passed more than %lld times in one "
                            "call of the task", st_loop_limit, 0, 0);
}

/** The place of an element in its array. */
ST_UNUSED static inline size_t st_at(int64_t index, int64_t first, int64_t last, const char *file, int line)
{
    if (index < first || index > last)
        st_fail(file, line, "the index %lld is outside %lld..%lld", index, first, last);
    return (size_t)(index - first);
}
#define ST_AT(index, first, last) st_at((int64_t)(index), first, last, ST_HERE)

/** ARRAY[*]: an array of a caller, and its bounds. */
typedef struct st_open {
    void *at;
    int32_t first[4], last[4];
} st_open_t;

ST_UNUSED static inline size_t st_open_at(int64_t index, const st_open_t *array, int dimension, const char *file,
                                                 int line)
{
    return st_at(index, array->first[dimension], array->last[dimension], file, line);
}
ST_UNUSED static inline size_t st_width(const st_open_t *array, int dimension)
{
    return (size_t)((int64_t)array->last[dimension] - array->first[dimension] + 1);
}

/** A value for a variable of a subrange. */
ST_UNUSED static inline int64_t st_within(int64_t value, int64_t first, int64_t last, const char *file, int line)
{
    if (value < first || value > last)
        st_fail(file, line, "the value %lld is outside the range %lld..%lld", value, first, last);
    return value;
}

ST_UNUSED static inline void *st_reach(void *to, const char *file, int line)
{
    if (!to)
        st_fail(file, line, "this reference refers to nothing (NULL)", 0, 0, 0);
    return to;
}

/** The variable that a VAR_IN_OUT of a block has; `says` is told if it has none. */
ST_UNUSED static inline void *st_given(void *to, const char *says, const char *file, int line)
{
    if (!to)
        st_fail(file, line, says, 0, 0, 0);
    return to;
}

/** A variable of an interface: the address of an instance. */
typedef void *st_interface_t;

/* ---- arithmetic -------------------------------------------------------------------------------------------------- */

/* A division of integers by zero is a fault; x MOD 0 is 0 (IEC 61131-3). The quotient that is one too large for its
 * type wraps, as a product does. */
#define ST_SIGNED_DIVISION(T)                                                                                         \
    ST_UNUSED static inline T st_div_##T(T a, T b, const char *file, int line)                                        \
    {                                                                                                                 \
        if (b == 0)                                                                                                   \
            st_fail(file, line, "%lld is divided by zero", (long long)a, 0, 0);                                       \
        return b == -1 ? (T)-a : (T)(a / b);                                                                          \
    }                                                                                                                 \
    ST_UNUSED static inline T st_mod_##T(T a, T b) { return b == 0 || b == -1 ? 0 : (T)(a % b); }                     \
    ST_UNUSED static inline T st_abs_##T(T a) { return a < 0 ? (T)(UINT64_C(0) - (uint64_t)a) : a; }
#define ST_UNSIGNED_DIVISION(T)                                                                                       \
    ST_UNUSED static inline T st_div_##T(T a, T b, const char *file, int line)                                        \
    {                                                                                                                 \
        if (b == 0)                                                                                                   \
            st_fail(file, line, "%lld is divided by zero", (long long)a, 0, 0);                                       \
        return (T)(a / b);                                                                                            \
    }                                                                                                                 \
    ST_UNUSED static inline T st_mod_##T(T a, T b) { return b == 0 ? 0 : (T)(a % b); }                                \
    ST_UNUSED static inline T st_abs_##T(T a) { return a; }
ST_SIGNED_DIVISION(SINT) ST_SIGNED_DIVISION(INT) ST_SIGNED_DIVISION(DINT) ST_SIGNED_DIVISION(LINT)
ST_UNSIGNED_DIVISION(USINT) ST_UNSIGNED_DIVISION(UINT) ST_UNSIGNED_DIVISION(UDINT) ST_UNSIGNED_DIVISION(ULINT)
ST_UNUSED static inline REAL st_abs_REAL(REAL a) { return fabsf(a); }
ST_UNUSED static inline LREAL st_abs_LREAL(LREAL a) { return fabs(a); }

#define ST_SELECTION(T)                                                                                               \
    ST_UNUSED static inline T st_min_##T(T a, T b) { return b < a ? b : a; }                                          \
    ST_UNUSED static inline T st_max_##T(T a, T b) { return b > a ? b : a; }                                          \
    ST_UNUSED static inline T st_limit_##T(T low, T value, T high)                                                    \
    {                                                                                                                 \
        return st_min_##T(st_max_##T(value, low), high);                                                              \
    }                                                                                                                 \
    ST_UNUSED static inline T st_sel_##T(BOOL which, T a, T b) { return which ? b : a; }                              \
    ST_UNUSED static inline T st_mux_##T(int64_t which, int64_t count, const T *values, const char *file, int line)   \
    {                                                                                                                 \
        return values[st_at(which, 0, count - 1, file, line)];                                                        \
    }
ST_SELECTION(BYTE) ST_SELECTION(WORD) ST_SELECTION(DWORD) ST_SELECTION(LWORD)
ST_SELECTION(SINT) ST_SELECTION(INT) ST_SELECTION(DINT) ST_SELECTION(LINT) ST_SELECTION(REAL) ST_SELECTION(LREAL)

/* Shifting by all bits or more leaves 0, by a negative number nothing changes. */
#define ST_SHIFTS(T, BITS)                                                                                            \
    ST_UNUSED static inline T st_shl_##T(T a, int64_t n) { return n <= 0 ? a : n >= BITS ? 0 : (T)((T)a << n); }      \
    ST_UNUSED static inline T st_shr_##T(T a, int64_t n) { return n <= 0 ? a : n >= BITS ? 0 : (T)(a >> n); }         \
    ST_UNUSED static inline T st_rol_##T(T a, int64_t n)                                                              \
    {                                                                                                                 \
        const int places = n <= 0 ? 0 : (int)(n % BITS);                                                              \
        return places == 0 ? a : (T)((T)(a << places) | (T)(a >> (BITS - places)));                                   \
    }                                                                                                                 \
    ST_UNUSED static inline T st_ror_##T(T a, int64_t n)                                                              \
    {                                                                                                                 \
        const int places = n <= 0 ? 0 : (int)(n % BITS);                                                              \
        return places == 0 ? a : (T)((T)(a >> places) | (T)(a << (BITS - places)));                                   \
    }
ST_SHIFTS(BYTE, 8) ST_SHIFTS(WORD, 16) ST_SHIFTS(DWORD, 32) ST_SHIFTS(LWORD, 64)

/* ---- conversions ------------------------------------------------------------------------------------------------- */

/** To the nearest integer, halves to the even one; beyond the type its end; 0 of what is no number. */
ST_UNUSED static inline int64_t st_round(double value, int64_t low, int64_t high)
{
    const double rounded = nearbyint(value);
    if (rounded != rounded)
        return 0;
    return rounded <= (double)low ? low : rounded >= (double)high ? high : (int64_t)rounded;
}

ST_UNUSED static inline uint64_t st_round_unsigned(double value)
{
    const double rounded = nearbyint(value);
    if (!(rounded > 0))
        return 0;
    return rounded >= 18446744073709551616.0 ? UINT64_MAX : (uint64_t)rounded;
}

ST_UNUSED static inline TIME st_time_scaled(TIME time, double factor)
{
    return st_round((double)time * factor, INT64_MIN, INT64_MAX);
}

ST_UNUSED static inline TIME st_time_divided(TIME time, double divisor, const char *file, int line)
{
    if (divisor == 0)
        st_fail(file, line, "a time is divided by zero", 0, 0, 0);
    return st_round((double)time / divisor, INT64_MIN, INT64_MAX);
}

#define ST_DAY INT64_C(86400000000000)
ST_UNUSED static inline int64_t st_time_of_day(int64_t time) { return (time % ST_DAY + ST_DAY) % ST_DAY; }

ST_UNUSED static inline DATE st_date_of(DT time) { return time - st_time_of_day(time); }

/** Time of the scan. */
int64_t cm1e_scan_time(void);

/** Members of an AXIS_REF that TwinCAT has, and the input Override of its MC_Power. */
LREAL cm1e_tc2_axis_value(UINT handle, UINT number);
void cm1e_tc2_override(UINT handle, LREAL percent);

/* ---- texts: at most 255 bytes and a final 0 ---------------------------------------------------------------------- */

typedef struct STRING_255 {
    char text[256];
} STRING_255;

/** A WSTRING: at most 255 characters of 16 bits (UTF-16 in the order of the machine). */
typedef struct WSTRING_255 {
    uint16_t text[256];
} WSTRING_255;

ST_UNUSED static inline size_t st_length(const char *text) { return strlen(text); }
ST_UNUSED static inline size_t st_wlength(const uint16_t *text)
{
    size_t length = 0;
    while (text[length])
        length++;
    return length;
}

/* The functions of both kinds of texts. ASSIGN cuts off what does not fit into `size` bytes. MID: `count` characters
 * from position `at` (1 = first); what is outside the text is left out. REPLACE: without `count` characters from
 * position `at`, with `put` in their place. */
#define ST_TEXTS(w, UNIT, TEXT)                                                                                       \
    ST_UNUSED static inline void st_##w##assign(UNIT *to, size_t size, const UNIT *from)                              \
    {                                                                                                                 \
        const size_t room = size / sizeof(UNIT) - 1, whole = st_##w##length(from);                                    \
        const size_t length = whole < room ? whole : room;                                                            \
        memmove(to, from, length * sizeof(UNIT));                                                                     \
        to[length] = 0;                                                                                               \
    }                                                                                                                 \
    ST_UNUSED static inline TEXT st_##w##mid(const UNIT *text, int64_t count, int64_t at)                             \
    {                                                                                                                 \
        TEXT result = {{0}};                                                                                          \
        const int64_t length = (int64_t)st_##w##length(text);                                                         \
        if (at < 1 || at > length || count <= 0)                                                                      \
            return result;                                                                                            \
        if (count > length - at + 1)                                                                                  \
            count = length - at + 1;                                                                                  \
        memcpy(result.text, text + at - 1, (size_t)count * sizeof(UNIT));                                             \
        return result;                                                                                                \
    }                                                                                                                 \
    ST_UNUSED static inline TEXT st_##w##left(const UNIT *text, int64_t count) { return st_##w##mid(text, count, 1); } \
    ST_UNUSED static inline TEXT st_##w##right(const UNIT *text, int64_t count)                                       \
    {                                                                                                                 \
        const int64_t length = (int64_t)st_##w##length(text);                                                         \
        return st_##w##mid(text, count, count >= length ? 1 : count < 0 ? length + 1 : length - count + 1);           \
    }                                                                                                                 \
    ST_UNUSED static inline TEXT st_##w##concat(const UNIT *a, const UNIT *b)                                         \
    {                                                                                                                 \
        TEXT result = {{0}};                                                                                          \
        st_##w##assign(result.text, sizeof result.text, a);                                                           \
        const size_t used = st_##w##length(result.text);                                                              \
        st_##w##assign(result.text + used, sizeof result.text - used * sizeof(UNIT), b);                              \
        return result;                                                                                                \
    }                                                                                                                 \
    ST_UNUSED static inline TEXT st_##w##replace(const UNIT *text, const UNIT *put, int64_t count, int64_t at)        \
    {                                                                                                                 \
        const int64_t length = (int64_t)st_##w##length(text);                                                         \
        if (count < 0 || at < 1 || at > length + 1)                                                                   \
            return st_##w##mid(text, length, 1);                                                                      \
        const TEXT before = st_##w##left(text, at - 1), joined = st_##w##concat(before.text, put);                    \
        return count >= length - at + 1 ? joined : st_##w##concat(joined.text, text + at - 1 + count);                \
    }                                                                                                                 \
    ST_UNUSED static inline TEXT st_##w##insert(const UNIT *text, const UNIT *put, int64_t behind)                    \
    {                                                                                                                 \
        return behind < 0 ? st_##w##replace(text, put, -1, 1) : st_##w##replace(text, put, 0, behind + 1);            \
    }                                                                                                                 \
    ST_UNUSED static inline TEXT st_##w##delete(const UNIT *text, int64_t count, int64_t at)                          \
    {                                                                                                                 \
        return st_##w##replace(text, (const UNIT[1]){0}, count, at);                                                  \
    }                                                                                                                 \
    ST_UNUSED static inline TEXT st_##w##mux(int64_t which, int64_t count, const UNIT *const *texts,                  \
                                             const char *file, int line)                                              \
    {                                                                                                                 \
        TEXT result = {{0}};                                                                                          \
        st_##w##assign(result.text, sizeof result.text, texts[st_at(which, 0, count - 1, file, line)]);               \
        return result;                                                                                                \
    }                                                                                                                 \
    ST_UNUSED static inline INT st_##w##find(const UNIT *text, const UNIT *part)                                      \
    {                                                                                                                 \
        const size_t length = st_##w##length(text), wanted = st_##w##length(part);                                    \
        for (size_t i = 0; wanted > 0 && i + wanted <= length; i++)                                                   \
            if (memcmp(text + i, part, wanted * sizeof(UNIT)) == 0)                                                   \
                return (INT)(i + 1);                                                                                  \
        return 0;                                                                                                     \
    }
ST_TEXTS(, char, STRING_255)
ST_TEXTS(w, uint16_t, WSTRING_255)

ST_UNUSED static inline int st_wcompare(const uint16_t *a, const uint16_t *b)
{
    while (*a && *a == *b)
        a++, b++;
    return *a - *b;
}

/** STRING to WSTRING: a STRING is UTF-8. A byte that belongs to no character becomes the character of its number. */
ST_UNUSED static inline WSTRING_255 st_widen(const char *text)
{
    WSTRING_255 result = {{0}};
    size_t used = 0;
    for (const uint8_t *at = (const uint8_t *)text; *at && used < 255;) {
        const int more = *at < 0xC2 ? 0 : *at < 0xE0 ? 1 : *at < 0xF0 ? 2 : *at < 0xF5 ? 3 : 0;
        uint32_t c = more ? *at & (0x3Fu >> more) : *at;
        int good = 0;
        while (good < more && (at[good + 1] & 0xC0) == 0x80)
            c = c << 6 | (at[++good] & 0x3Fu);
        c = good < more ? *at : c;
        at += good < more ? 1 : more + 1;
        if (c < 0x10000) {
            result.text[used++] = (uint16_t)c;
        } else if (used < 254) {
            result.text[used++] = (uint16_t)(0xD7C0 + (c >> 10));
            result.text[used++] = (uint16_t)(0xDC00 | (c & 0x3FF));
        } else {
            break;
        }
    }
    return result;
}

/** WSTRING to STRING, in UTF-8: what does not fit is left out. */
ST_UNUSED static inline STRING_255 st_narrow(const uint16_t *text)
{
    STRING_255 result = {{0}};
    size_t used = 0;
    for (; *text; text++) {
        uint32_t c = *text;
        if ((c & 0xFC00) == 0xD800 && (text[1] & 0xFC00) == 0xDC00)
            c = 0x10000 + ((c & 0x3FF) << 10) + (*++text & 0x3FFu);
        const size_t count = c < 0x80 ? 1 : c < 0x800 ? 2 : c < 0x10000 ? 3 : 4;
        if (used + count > 255)
            break;
        for (size_t i = count; i > 1; c >>= 6)
            result.text[used + --i] = (char)(0x80 | (c & 0x3F));
        result.text[used] = (char)(count == 1 ? c : (0xF00u >> count & 0xFF) | c);
        used += count;
    }
    return result;
}

ST_UNUSED static inline STRING_255 st_text_of_integer(int64_t value)
{
    STRING_255 result;
    snprintf(result.text, sizeof result.text, "%lld", (long long)value);
    return result;
}
ST_UNUSED static inline STRING_255 st_text_of_unsigned(uint64_t value)
{
    STRING_255 result;
    snprintf(result.text, sizeof result.text, "%llu", (unsigned long long)value);
    return result;
}
ST_UNUSED static inline STRING_255 st_text_of_real(double value, int digits)
{
    STRING_255 result;
    snprintf(result.text, sizeof result.text, "%.*g", digits, value);
    return result;
}
static const struct { const char *name; uint64_t ns; } st_time_units[] = {
    {"d", UINT64_C(86400000000000)}, {"h", UINT64_C(3600000000000)}, {"m", UINT64_C(60000000000)}, {"s", 1000000000},
    {"ms", 1000000}, {"us", 1000}, {"ns", 1},
};
enum { ST_TIME_UNITS = sizeof st_time_units / sizeof st_time_units[0] };
/** The literal of the value: T#1h2m3s4ms, without units of which there are 0. TwinCAT and CODESYS document T#12ms for
 *  a TIME; how they write others is not known. An LTIME is a TIME here, and begins with T#, too. */
ST_UNUSED static inline STRING_255 st_text_of_time(int64_t value)
{
    STRING_255 result;
    uint64_t left = value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
    int used = snprintf(result.text, sizeof result.text, "T#%s%s", value < 0 ? "-" : "", left ? "" : "0ms");
    for (size_t i = 0; left > 0; left %= st_time_units[i++].ns)
        if (left >= st_time_units[i].ns)
            used += snprintf(result.text + used, sizeof result.text - (size_t)used, "%llu%s",
                             (unsigned long long)(left / st_time_units[i].ns), st_time_units[i].name);
    return result;
}
/** The literal: D#2024-02-29, TOD#01:02:03.5, DT#2024-02-29-01:02:03, with a fraction where there is one. */
ST_UNUSED static inline STRING_255 st_text_of_date(int64_t value, int date, int clock)
{
    STRING_255 result;
    const int64_t of_day = st_time_of_day(value);
    const int64_t days = value / ST_DAY - (value % ST_DAY < 0) + 719468; /* since 1 March of the year 0 */
    const int64_t era = days / 146097, in_era = days % 146097; /* of 400 years */
    const int64_t year = (in_era - in_era / 1460 + in_era / 36524 - in_era / 146096) / 365;
    const int64_t day = in_era - (365 * year + year / 4 - year / 100), month = (5 * day + 2) / 153;
    const int number = (int)(month < 10 ? month + 3 : month - 9);
    int used = snprintf(result.text, sizeof result.text, "%s", date && clock ? "DT#" : date ? "D#" : "TOD#");
    if (date)
        used += snprintf(result.text + used, sizeof result.text - (size_t)used, "%lld-%02d-%02d%s",
                         (long long)(era * 400 + year + (number <= 2)), number, (int)(day - (153 * month + 2) / 5 + 1),
                         clock ? "-" : "");
    if (clock)
        used += snprintf(result.text + used, sizeof result.text - (size_t)used, "%02d:%02d:%02d",
                         (int)(of_day / INT64_C(3600000000000)), (int)(of_day / INT64_C(60000000000) % 60),
                         (int)(of_day / 1000000000 % 60));
    if (clock && of_day % 1000000000 != 0) {
        used += snprintf(result.text + used, sizeof result.text - (size_t)used, ".%09d", (int)(of_day % 1000000000));
        while (result.text[used - 1] == '0')
            result.text[--used] = '\0';
    }
    return result;
}
ST_UNUSED static inline STRING_255 st_text_of_bool(BOOL value)
{
    return value ? (STRING_255){"TRUE"} : (STRING_255){"FALSE"};
}

/* Texts are read as literals: 1_000, 16#FF, T#2h. What is behind the value does not count; a text that begins with none
 * is 0. */

ST_UNUSED static inline const char *st_sign_of(const char *text, int *negative)
{
    text += strspn(text, " \t\r\n");
    *negative = *text == '-';
    return text + (*text == '-' || *text == '+');
}
/** The value of a digit; 99: it is none. */
ST_UNUSED static inline unsigned st_digit_of(char digit)
{
    return digit >= '0' && digit <= '9' ? (unsigned)(digit - '0')
         : digit >= 'A' && digit <= 'F' ? (unsigned)(digit - 'A') + 10
         : digit >= 'a' && digit <= 'f' ? (unsigned)(digit - 'a') + 10 : 99;
}
/** Digits; what has more than 64 bits is the largest number. */
ST_UNUSED static inline uint64_t st_digits_of(const char **text, unsigned base)
{
    uint64_t value = 0;
    for (; st_digit_of(**text) < base || (**text == '_' && st_digit_of((*text)[1]) < base); ++*text) {
        const unsigned digit = st_digit_of(**text);
        if (**text != '_')
            value = value > (UINT64_MAX - digit) / base ? UINT64_MAX : value * base + digit;
    }
    return value;
}
ST_UNUSED static inline uint64_t st_number_of(const char *text)
{
    const uint64_t value = st_digits_of(&text, 10);
    const int based = *text == '#' && (value == 2 || value == 8 || value == 16);
    text += based;
    return based ? st_digits_of(&text, (unsigned)value) : value;
}
ST_UNUSED static inline int64_t st_integer_of(const char *text, int64_t low, int64_t high)
{
    int negative;
    const uint64_t number = st_number_of(st_sign_of(text, &negative));
    if (negative)
        return number > 0 - (uint64_t)low ? low : (int64_t)(0 - number);
    return number > (uint64_t)high ? high : (int64_t)number;
}
ST_UNUSED static inline uint64_t st_unsigned_of(const char *text)
{
    int negative;
    const uint64_t number = st_number_of(st_sign_of(text, &negative));
    return negative ? 0 : number;
}
ST_UNUSED static inline double st_real_of(const char *text)
{
    char number[256]; /* without underscores, and without what C reads and ST does not */
    size_t used = 0;
    int negative;
    for (text = st_sign_of(text, &negative); *text && strchr("0123456789_.eE+-", *text) &&
         used < sizeof number - 1; text++)
        if (*text != '_')
            number[used++] = *text;
    number[used] = '\0';
    if (st_digit_of(number[0]) > 9 && number[0] != '.')
        return 0;
    return negative ? -strtod(number, NULL) : strtod(number, NULL);
}
/** Whether a text begins with `length` characters of a word, in upper or lower case. */
ST_UNUSED static inline int st_begins(const char *text, const char *word, size_t length)
{
    for (size_t i = 0; i < length; i++)
        if (text[i] != word[i] && (text[i] ^ word[i]) != ('a' ^ 'A'))
            return 0;
    return 1;
}
ST_UNUSED static inline size_t st_letters_of(const char *text)
{
    return strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
}
ST_UNUSED static inline BOOL st_bool_of(const char *text)
{
    text += strspn(text, " \t\r\n");
    return (BOOL)(st_letters_of(text) == 4 && st_begins(text, "TRUE", 4) && text[4] != '_' && st_digit_of(text[4]) > 9);
}
/** Digits, and a fraction. */
ST_UNUSED static inline long double st_count_of(const char **text)
{
    long double count = (long double)st_digits_of(text, 10), place = 1;
    if (**text == '.')
        for (++*text; st_digit_of(**text) < 10; ++*text)
            count += (long double)st_digit_of(**text) * (place /= 10);
    return count;
}
/** "1h2m3.5s" */
ST_UNUSED static inline TIME st_duration_of(const char *text)
{
    long double sum = 0;
    int negative;
    for (text = st_sign_of(text, &negative); st_digit_of(*text) < 10;) {
        const long double count = st_count_of(&text);
        const size_t length = st_letters_of(text);
        size_t unit = 0;
        while (unit < ST_TIME_UNITS && (strlen(st_time_units[unit].name) != length ||
                                        !st_begins(text, st_time_units[unit].name, length)))
            unit++;
        if (unit == ST_TIME_UNITS)
            break;
        sum += count * (long double)st_time_units[unit].ns;
        text += length;
        text += *text == '_' && st_digit_of(text[1]) < 10;
    }
    const long double ns = roundl(negative ? -sum : sum);
    return ns <= (long double)INT64_MIN ? INT64_MIN : ns >= (long double)INT64_MAX ? INT64_MAX : (TIME)ns;
}
ST_UNUSED static inline TIME st_time_of(const char *text)
{
    static const char *const begins[] = {"LTIME#", "TIME#", "LT#", "T#"};
    text += strspn(text, " \t\r\n");
    for (size_t i = 0; i < sizeof begins / sizeof begins[0]; i++)
        if (st_begins(text, begins[i], strlen(begins[i])))
            return st_duration_of(text + strlen(begins[i]));
    return 0;
}

/* ---- loops ------------------------------------------------------------------------------------------------------- */

/** A FOR loop counts in 64 bits, so that it ends at the end of any type. */
typedef struct st_for {
    int64_t now, to, by;
    int ended;
} st_for_t;

ST_UNUSED static inline st_for_t st_for(int64_t from, int64_t to, int64_t by, const char *file, int line)
{
    if (by == 0)
        st_fail(file, line, "a FOR in steps of 0 would not end", 0, 0, 0);
    return (st_for_t){from, to, by, 0};
}
ST_UNUSED static inline int st_goes(const st_for_t *loop)
{
    return !loop->ended && (loop->by > 0 ? loop->now <= loop->to : loop->now >= loop->to);
}
ST_UNUSED static inline void st_next(st_for_t *loop)
{
    loop->ended = loop->by > 0 ? loop->now > INT64_MAX - loop->by : loop->now < INT64_MIN - loop->by;
    if (!loop->ended)
        loop->now += loop->by;
}

#endif
