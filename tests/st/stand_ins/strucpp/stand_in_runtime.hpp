// Stands in for the run-time part of STruC++, in our own words: as much of it as declarations of blocks and a
// configuration use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace strucpp {

using BOOL_t = bool;
using SINT_t = std::int8_t;
using INT_t = std::int16_t;
using DINT_t = std::int32_t;
using UINT_t = std::uint16_t;
using UDINT_t = std::uint32_t;
using WORD_t = std::uint16_t;
using DWORD_t = std::uint32_t;
using LWORD_t = std::uint64_t;
using LREAL_t = double;
using TIME_t = std::int64_t;

// A variable that can be forced.
template <class T> class IECVar {
public:
    using value_type = T;
    IECVar(T initial = T{}) : value(initial) {}
    T get() const { return forced ? forced_value : value; }
    IECVar &operator=(T to)
    {
        if (!forced)
            value = to;
        return *this;
    }
    void force(T to)
    {
        forced = true;
        value = forced_value = to;
    }
    T *raw_ptr() { return &value; }

private:
    T value;
    bool forced = false;
    T forced_value{};
};

using IEC_BOOL = IECVar<BOOL_t>;
using IEC_SINT = IECVar<SINT_t>;
using IEC_INT = IECVar<INT_t>;
using IEC_DINT = IECVar<DINT_t>;
using IEC_UINT = IECVar<UINT_t>;
using IEC_UDINT = IECVar<UDINT_t>;
using IEC_WORD = IECVar<WORD_t>;
using IEC_DWORD = IECVar<DWORD_t>;
using IEC_LWORD = IECVar<LWORD_t>;
using IEC_LREAL = IECVar<LREAL_t>;
using IEC_TIME = IECVar<TIME_t>;

// An enumeration is wrapped twice.
template <class E> struct IEC_ENUM_Value {
    E value{};
    IEC_ENUM_Value(E from = E{}) : value(from) {}
    E get() const { return value; }
};
template <class E> using IEC_ENUM = IECVar<IEC_ENUM_Value<E>>;

template <std::size_t N> struct IECString {
    char text[N + 1] = "";
    std::size_t used = 0;
    IECString(const char *from = "") : used(std::strlen(from)) { std::memcpy(text, from, used + 1); }
    std::size_t length() const { return used; }
    const char *c_str() const { return text; }
};
template <std::size_t N> using IECStringVar = IECVar<IECString<N>>;

template <class T, int LOWER, int UPPER> struct Array1D {
    T elements[UPPER - LOWER + 1]{};
    T &at(int i) { return elements[i - LOWER]; }
    const T &at(int i) const { return elements[i - LOWER]; }
};

template <class T> struct GlobalVar {
    T value{};
};

struct ProgramBase {
    virtual ~ProgramBase() = default;
    virtual void run() = 0;
};
struct TaskInstance {
    const char *name;
    std::int64_t interval_ns;
    std::int32_t priority;
    ProgramBase **programs;
    std::size_t program_count;
};
struct ResourceInstance {
    const char *name, *processor;
    TaskInstance *tasks;
    std::size_t task_count;
};
inline std::int64_t __CURRENT_TIME_NS = 0;

} // namespace strucpp
