/**
 * What a trace records beside the axes: variables of every type, objects in the process data, the cycle itself; triggers
 * against a naive search in all that happened; a file for NumPy, read back.
 */
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "cm1e/hot_connect.h"
#include "cm1e/sim.h"
#include "cm1e/trace.h"
#include "core/bytes.h"
#include "machine.h"
#include "scheduler/trace_recorder.h"

#define MS INT64_C(1000000)

static machine_t machine;
static cm1e_diag_t diag;

/* ---- a machine that turns, and a program with variables ---------------------------------------------------------- */

static struct {
    MC_Power_t power;
    MC_MoveVelocity_t turn;
    int64_t cycles, fault_at; /* 0: none */
    struct {
        char odd; /* what follows is not aligned */
        BOOL flag;
        int8_t sint;
        int16_t i;
        int32_t dint;
        int64_t lint;
        uint8_t usint;
        uint16_t u;
        uint32_t udint;
        uint64_t ulint;
        float real;
        double lreal;
    } __attribute__((packed)) v;
} plc;

static void program(void *context)
{
    const int64_t n = plc.cycles++;
    char answer[200];
    (void)context;
    plc.power.Axis = &machine.axis[0];
    plc.turn.Axis = &machine.axis[0];
    plc.power.Enable = plc.power.EnablePositive = plc.power.EnableNegative = TRUE;
    MC_Power(&plc.power);
    plc.turn.Execute = plc.power.Status;
    plc.turn.Velocity = 20;
    MC_MoveVelocity(&plc.turn);
    if (n == plc.fault_at && n > 0)
        ck_assert_int_eq(cm1e_bus_simulate(machine.bus, "error 1 0xFF05", answer, sizeof answer), CM1E_OK);
    plc.v.flag = n % 2 ? 0x80 : 0;
    plc.v.sint = n % 2 ? INT8_MIN : INT8_MAX;
    plc.v.i = n % 2 ? INT16_MIN : INT16_MAX;
    plc.v.dint = n % 2 ? INT32_MIN : INT32_MAX;
    plc.v.lint = n % 2 ? -(INT64_C(1) << 53) : INT64_C(1) << 53;
    plc.v.usint = n % 2 ? 0 : UINT8_MAX;
    plc.v.u = n % 2 ? 0 : UINT16_MAX;
    plc.v.udint = n % 2 ? 0 : UINT32_MAX;
    plc.v.ulint = n % 2 ? 0 : UINT64_C(1) << 53;
    plc.v.real = n % 2 ? -0.25F : 0.25F;
    plc.v.lreal = (double)n + 0.5;
}

static void open_machine(uint32_t capacity)
{
    memset(&plc, 0, sizeof plc);
    machine = (machine_t){.axis_count = 2, .config = {.trace_capacity = capacity}};
    machine_open(&machine);
    machine_add(&machine, "program", 0, 0, program, NULL);
}

static void expect(cm1e_error_t error, cm1e_error_t wanted, const char *word)
{
    ck_assert_msg(error == wanted && (error == CM1E_OK || (diag.error == error && strstr(diag.text, word))),
                  "%s, not %s with \"%s\": %s", cm1e_strerror(error), cm1e_strerror(wanted), word, diag.text);
    diag = (cm1e_diag_t){0};
}

static uint32_t column_of(const trace_t *trace, const char *name)
{
    for (uint32_t i = 0; i < trace->column_count; i++)
        if (strcmp(trace->columns[i].name, name) == 0)
            return i;
    ck_abort_msg("no column %s", name);
    return 0;
}

static double value_of(uint32_t n, const char *name)
{
    const trace_t *trace = cm1e_scheduler_trace(machine.scheduler);
    ck_assert_uint_lt(n, trace->used);
    return cm1e_trace_sample(trace, n)[column_of(trace, name)];
}

/* ---- variables --------------------------------------------------------------------------------------------------- */

static cm1e_error_t add(const char *name, cm1e_trace_type_t type, const void *variable)
{
    return cm1e_scheduler_trace_variable(machine.scheduler, name, NULL, type, variable, &diag);
}

static const struct {
    const char *name;
    cm1e_trace_type_t type;
    const void *variable;
    double even, odd; /* its value in such a cycle */
} variables[] = {
    {"bool", CM1E_TRACE_BOOL, &plc.v.flag, 0, 1},
    {"sint", CM1E_TRACE_SINT, &plc.v.sint, INT8_MAX, INT8_MIN},
    {"int", CM1E_TRACE_INT, &plc.v.i, INT16_MAX, INT16_MIN},
    {"dint", CM1E_TRACE_DINT, &plc.v.dint, INT32_MAX, INT32_MIN},
    {"lint", CM1E_TRACE_LINT, &plc.v.lint, 9007199254740992.0, -9007199254740992.0},
    {"usint", CM1E_TRACE_USINT, &plc.v.usint, UINT8_MAX, 0},
    {"uint", CM1E_TRACE_UINT, &plc.v.u, UINT16_MAX, 0},
    {"udint", CM1E_TRACE_UDINT, &plc.v.udint, UINT32_MAX, 0},
    {"ulint", CM1E_TRACE_ULINT, &plc.v.ulint, 9007199254740992.0, 0},
    {"real", CM1E_TRACE_REAL, &plc.v.real, 0.25, -0.25},
};
enum { VARIABLES = sizeof variables / sizeof variables[0] };

START_TEST(test_variables_of_every_type_are_recorded_in_every_cycle)
{
    open_machine(200); /* with the end of the run */
    for (int i = 0; i < VARIABLES; i++)
        expect(add(variables[i].name, variables[i].type, variables[i].variable), CM1E_OK, "");
    expect(add("lreal", CM1E_TRACE_TYPE_OF(plc.v.lreal), &plc.v.lreal), CM1E_OK, "");
    machine_run(&machine, 30 * MS);
    for (uint32_t n = 0; n < 30; n++) {
        ck_assert_double_eq(value_of(n, "lreal"), n + 0.5);
        for (int i = 0; i < VARIABLES; i++)
            ck_assert_msg(value_of(n, variables[i].name) == (n % 2 ? variables[i].odd : variables[i].even),
                          "%s in cycle %u: %.17g", variables[i].name, n, value_of(n, variables[i].name));
    }
    machine_close(&machine);
}
END_TEST

START_TEST(test_the_type_of_a_variable_is_that_of_the_compiler)
{
    ck_assert_int_eq(CM1E_TRACE_TYPE_OF(plc.v.sint), CM1E_TRACE_SINT);
    ck_assert_int_eq(CM1E_TRACE_TYPE_OF(plc.v.i), CM1E_TRACE_INT);
    ck_assert_int_eq(CM1E_TRACE_TYPE_OF(plc.v.dint), CM1E_TRACE_DINT);
    ck_assert_int_eq(CM1E_TRACE_TYPE_OF(plc.v.lint), CM1E_TRACE_LINT);
    ck_assert_int_eq(CM1E_TRACE_TYPE_OF(plc.turn.Busy), CM1E_TRACE_USINT);
    ck_assert_int_eq(CM1E_TRACE_TYPE_OF(plc.v.u), CM1E_TRACE_UINT);
    ck_assert_int_eq(CM1E_TRACE_TYPE_OF(plc.v.udint), CM1E_TRACE_UDINT);
    ck_assert_int_eq(CM1E_TRACE_TYPE_OF(plc.v.ulint), CM1E_TRACE_ULINT);
    ck_assert_int_eq(CM1E_TRACE_TYPE_OF(plc.v.real), CM1E_TRACE_REAL);
    ck_assert_int_eq(CM1E_TRACE_TYPE_OF((bool)true), CM1E_TRACE_BOOL);
    ck_assert_int_eq(CM1E_TRACE_TYPE_OF(plc.turn.Velocity), CM1E_TRACE_LREAL);
}
END_TEST

START_TEST(test_signals_that_cannot_be_are_refused_in_words)
{
    char long_name[CM1E_TRACE_NAME_BYTES + 1], name[32];
    memset(long_name, 'n', sizeof long_name - 1);
    long_name[sizeof long_name - 1] = '\0';
    open_machine(20);
    expect(add(NULL, CM1E_TRACE_BOOL, &plc.v.flag), CM1E_ERROR_INVALID_ARGUMENT, "name");
    expect(add("", CM1E_TRACE_BOOL, &plc.v.flag), CM1E_ERROR_INVALID_ARGUMENT, "name");
    expect(add("flag", CM1E_TRACE_BOOL, NULL), CM1E_ERROR_INVALID_ARGUMENT, "variable");
    expect(add("flag", (cm1e_trace_type_t)(CM1E_TRACE_LREAL + 1), &plc.v.flag), CM1E_ERROR_INVALID_ARGUMENT, "type");
    expect(add("flag", (cm1e_trace_type_t)-1, &plc.v.flag), CM1E_ERROR_INVALID_ARGUMENT, "type");
    expect(add(long_name, CM1E_TRACE_BOOL, &plc.v.flag), CM1E_ERROR_INVALID_ARGUMENT, "79");
    expect(cm1e_scheduler_trace_variable(machine.scheduler, "flag", "0123456789abcdef", CM1E_TRACE_BOOL, &plc.v.flag,
                                         &diag), CM1E_ERROR_INVALID_ARGUMENT, "15");
    expect(add("overruns", CM1E_TRACE_BOOL, &plc.v.flag), CM1E_ERROR_INVALID_ARGUMENT, "\"overruns\" already");
    expect(add("time", CM1E_TRACE_BOOL, &plc.v.flag), CM1E_ERROR_INVALID_ARGUMENT, "\"time\" already");
    expect(add("a\tb", CM1E_TRACE_BOOL, &plc.v.flag), CM1E_ERROR_INVALID_ARGUMENT, "UTF-8");
    expect(add("gr\xFC\xDF", CM1E_TRACE_BOOL, &plc.v.flag), CM1E_ERROR_INVALID_ARGUMENT, "UTF-8");
    expect(cm1e_scheduler_trace_variable(machine.scheduler, "flag", "\xB5m", CM1E_TRACE_BOOL, &plc.v.flag, &diag),
           CM1E_ERROR_INVALID_ARGUMENT, "UTF-8");
    for (int i = 0; i < CM1E_TRACE_VARIABLES; i++) {
        snprintf(name, sizeof name, "flag %d", i);
        expect(add(name, CM1E_TRACE_BOOL, &plc.v.flag), CM1E_OK, "");
    }
    expect(add("one more", CM1E_TRACE_BOOL, &plc.v.flag), CM1E_ERROR_NO_MEMORY, "256");
    machine_run(&machine, 10 * MS);
    expect(add("late", CM1E_TRACE_BOOL, &plc.v.flag), CM1E_ERROR_STATE, "before the scheduler runs");
    expect(cm1e_scheduler_trace_trigger(machine.scheduler, &(cm1e_trace_trigger_t){0}, &diag), CM1E_ERROR_STATE,
           "before the scheduler runs");
    machine_close(&machine);
    open_machine(0);
    expect(add("flag", CM1E_TRACE_BOOL, &plc.v.flag), CM1E_OK, ""); /* for others who attach */
    expect(cm1e_scheduler_trace_trigger(machine.scheduler, &(cm1e_trace_trigger_t){0}, &diag), CM1E_ERROR_STATE,
           "trace_capacity");
    machine_run(&machine, 10 * MS);
    expect(add("late", CM1E_TRACE_BOOL, &plc.v.flag), CM1E_ERROR_STATE, "before the scheduler runs");
    expect(cm1e_scheduler_write_csv(machine.scheduler, "never.csv", &diag), CM1E_ERROR_STATE, "trace_capacity");
    machine_close(&machine);
}
END_TEST

/* ---- objects ----------------------------------------------------------------------------------------------------- */

START_TEST(test_objects_in_both_directions_of_the_process_data)
{
    open_machine(400);
    const struct {
        uint16_t index;
        const char *name;
    } objects[] = {{0x6077, "axis1 0x6077:00 "}, {0x6064, "axis1 0x6064:00 "}, {0x6041, "axis1 0x6041:00 "},
                   {0x6040, "axis1 0x6040:00 "}, {0x607A, "axis1 0x607A:00 "}};
    const char *columns[5];
    const trace_t *trace = cm1e_scheduler_trace(machine.scheduler);
    for (int i = 0; i < 5; i++) {
        expect(cm1e_scheduler_trace_object(machine.scheduler, machine.axis[0], objects[i].index, 0, &diag), CM1E_OK, "");
        columns[i] = trace->columns[trace->column_count - 1].name;
        ck_assert_msg(strstr(columns[i], cm1e_axis_name(machine.axis[0])) == columns[i], "%s", columns[i]);
        ck_assert_uint_gt(strlen(columns[i]), strlen(objects[i].name)); /* with the name of the object */
    }
    machine_run(&machine, 300 * MS);
    double most = 0;
    for (uint32_t n = 0; n < 300; n++) {
        char torque[80];
        snprintf(torque, sizeof torque, "%s torque", cm1e_axis_name(machine.axis[0]));
        ck_assert_double_eq_tol(value_of(n, columns[0]) / 10, value_of(n, torque), 1e-9); /* per mille, signed */
        most = fmax(most, fabs(value_of(n, columns[0])));
        ck_assert_double_eq(value_of(n, columns[1]), (int32_t)value_of(n, columns[1]));
        ck_assert_double_ge(value_of(n, columns[2]), 0);
    }
    ck_assert_double_gt(most, 1);
    ck_assert_int_eq((int)value_of(299, columns[2]) & 0x6F, 0x27); /* Operation enabled */
    ck_assert_int_eq((int)value_of(299, columns[3]) & 0xF, 0xF);
    ck_assert_double_gt(value_of(299, columns[4]), value_of(250, columns[4]));
    expect(cm1e_scheduler_trace_object(machine.scheduler, machine.axis[0], 0x6064, 0, &diag), CM1E_ERROR_STATE,
           "before the scheduler runs");
    machine_close(&machine);
}
END_TEST

/** A mode has 8 bits and a sign; 32 inputs have none. */
START_TEST(test_objects_have_the_size_and_the_sign_of_the_dictionary)
{
    memset(&plc, 0, sizeof plc);
    machine = (machine_t){.axis_count = 1, .mapping = CM1E_MAPPING_DYNAMIC, .config = {.trace_capacity = 400}};
    machine_open(&machine);
    machine_add(&machine, "program", 0, 0, program, NULL);
    const trace_t *trace = cm1e_scheduler_trace(machine.scheduler);
    expect(cm1e_scheduler_trace_object(machine.scheduler, machine.axis[0], 0x6061, 0, &diag), CM1E_OK, "");
    const uint32_t mode = trace->column_count - 1;
    expect(cm1e_scheduler_trace_object(machine.scheduler, machine.axis[0], 0x60FD, 0, &diag), CM1E_OK, "");
    const uint32_t inputs = trace->column_count - 1;
    ck_assert_int_eq(trace->columns[mode].type, CM1E_TRACE_SINT);
    ck_assert(trace->columns[inputs].type == CM1E_TRACE_UDINT || trace->columns[inputs].type == CM1E_TRACE_UINT);
    machine_run(&machine, 300 * MS);
    ck_assert_double_eq(cm1e_trace_sample(trace, 299)[mode], 8); /* CSP */
    const cm1e_image_slot_t slot = cm1e_bus_find_input(machine.bus, 1, 0x60FD, 0);
    const uint8_t *bytes = cm1e_bus_inputs(machine.bus) + slot.offset;
    ck_assert_double_eq(cm1e_trace_sample(trace, trace->used - 1)[inputs], (double)cm1e_get_uint(bytes, slot.bytes));
    machine_close(&machine);
}
END_TEST

/** Plugs the second motor in, and asks for it. */
static void plug_in(void *context)
{
    const int64_t n = plc.cycles++;
    char answer[200];
    (void)context;
    if (n == 50)
        ck_assert_int_eq(cm1e_bus_simulate(machine.bus, "attach 2", answer, sizeof answer), CM1E_OK);
    if (n > 50 && n % 50 == 0)
        (void)cm1e_bus_recover(machine.bus, 2, &diag);
}

/** A motor that was absent at the start has its objects in the one order or in the other. */
START_TEST(test_objects_of_a_motor_that_comes_are_where_it_has_them)
{
    static const uint16_t objects[] = {0x6041, 0x6061, 0x6064, 0x60FD, 0x607A};
    enum { OBJECTS = sizeof objects / sizeof objects[0], CYCLES = 3000 };
    static cm1e_bus_config_t config;
    memset(&plc, 0, sizeof plc);
    machine = (machine_t){.axis_count = 2, .config = {.trace_capacity = CYCLES}};
    ck_assert_int_eq(cm1e_bus_config_init(&config, "sim", 2), CM1E_OK);
    config.virtual_time = true;
    config.sim_pdo_order = _i ? CM1E_PDO_ORDER_UG_7_2 : CM1E_PDO_ORDER_UG_4_4;
    config.axes[1].address_kind = CM1E_ADDRESS_ALIAS;
    config.axes[1].address = 17;
    config.axes[1].optional = config.axes[1].sim_absent = true;
    expect(cm1e_bus_open(&machine.bus, &config, &diag), CM1E_OK, "");
    expect(cm1e_bus_start(machine.bus, &diag), CM1E_OK, "");
    expect(cm1e_scheduler_create(&machine.scheduler, machine.bus, &machine.config, &diag), CM1E_OK, "");
    machine_add(&machine, "program", 0, 0, plug_in, NULL);
    const trace_t *trace = cm1e_scheduler_trace(machine.scheduler);
    const uint32_t first = trace->column_count;
    for (int i = 0; i < OBJECTS; i++)
        expect(cm1e_scheduler_trace_object(machine.scheduler, cm1e_scheduler_axis(machine.scheduler, 1), objects[i], 0,
                                           &diag), CM1E_OK, "");
    machine_run(&machine, CYCLES * MS);
    ck_assert_uint_eq(trace->used, CYCLES);
    ck_assert_double_eq(cm1e_trace_sample(trace, 0)[first], 0);
    ck_assert_int_eq((int)cm1e_trace_sample(trace, CYCLES - 1)[first] & 0x6F, 0x21); /* Ready to switch on */
    ck_assert_double_eq(cm1e_trace_sample(trace, CYCLES - 1)[first + 1], 8); /* CSP */
    ck_assert_double_eq(cm1e_trace_sample(trace, CYCLES - 1)[first + 3], 0); /* no input is on */
    machine_close(&machine);
    cm1e_bus_config_free(&config);
}
END_TEST

START_TEST(test_objects_that_no_cycle_brings_are_refused)
{
    open_machine(20);
    expect(cm1e_scheduler_trace_object(machine.scheduler, machine.axis[0], 0x607C, 0, &diag), CM1E_ERROR_PDO_MAPPING,
           "0x607C:00 is not in the process data");
    expect(cm1e_scheduler_trace_object(machine.scheduler, (AXIS_REF_t){0}, 0x6064, 0, &diag),
           CM1E_ERROR_INVALID_ARGUMENT, "does not belong to this scheduler");
    expect(cm1e_scheduler_trace_object(machine.scheduler, machine.axis[0], 0x6064, 0, &diag), CM1E_OK, "");
    expect(cm1e_scheduler_trace_object(machine.scheduler, machine.axis[0], 0x6064, 0, &diag),
           CM1E_ERROR_INVALID_ARGUMENT, "already");
    machine_close(&machine);
}
END_TEST

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

static void slow_program(void *context)
{
    if (plc.cycles == 10)
        cm1e_clock_sleep_until(cm1e_clock_current(), cm1e_clock_now(cm1e_clock_current()) + 5 * MS / 2);
    program(context);
}

START_TEST(test_the_cycle_itself_is_recorded)
{
    memset(&plc, 0, sizeof plc);
    machine = (machine_t){.axis_count = 1, .config = {.trace_capacity = 100}};
    machine_open(&machine);
    machine_add(&machine, "program", 0, 0, slow_program, NULL);
    machine_run(&machine, 40 * MS);
    ck_assert_double_eq(value_of(10, "overruns"), 0);
    ck_assert_double_eq(value_of(10, "execution time"), 0); /* of the cycle before, on virtual time */
    ck_assert_double_eq(value_of(11, "overruns"), 1);
    ck_assert_double_eq_tol(value_of(11, "execution time"), 2500, 1e-6);
    ck_assert_double_eq(value_of(12, "execution time"), 0);
    const trace_t *trace = cm1e_scheduler_trace(machine.scheduler);
    ck_assert_int_eq(cm1e_trace_time_ns(trace, 10), 10 * MS);
    ck_assert_int_eq(cm1e_trace_time_ns(trace, 11), 13 * MS); /* two were left out */
    machine_close(&machine);
}
END_TEST

/* ---- triggers ---------------------------------------------------------------------------------------------------- */

static uint64_t seed;

static uint32_t dice(uint32_t sides)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(seed >> 33) % sides;
}

static bool comes(const cm1e_trace_trigger_t *trigger, double before, double now)
{
    switch (trigger->kind) {
    case CM1E_TRACE_ON_RISING: return before < trigger->level && now >= trigger->level;
    case CM1E_TRACE_ON_FALLING: return before > trigger->level && now <= trigger->level;
    case CM1E_TRACE_ON_CHANGE: return now != before;
    default: return false;
    }
}

/* A random signal through a random trigger: what is kept is what a search in the whole of it says. */
static void check_random_trigger(void)
{
    enum { LONGEST = 120 };
    static double values[LONGEST];
    static const char *const no_axes[1];
    double now = 0;
    trace_t trace;
    const uint32_t capacity = 1 + dice(30), length = 1 + dice(LONGEST);
    const cm1e_trace_trigger_t trigger = {.kind = (cm1e_trace_trigger_kind_t)(CM1E_TRACE_ON_RISING + dice(3)),
                                          .signal = "x", .level = dice(4), .samples_before = dice(capacity)};
    const trace_column_t column = {.name = "x", .type = CM1E_TRACE_LREAL, .value = &now};
    ck_assert_int_eq(cm1e_trace_init(&trace, no_axes, 0, capacity, 1, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_trace_add(&trace, &column, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_trace_set_trigger(&trace, &trigger, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_trace_begin(&trace, &diag), CM1E_OK);
    uint32_t came = length;
    for (uint32_t n = 0; n < length; n++) {
        values[n] = now = dice(4);
        if (came == length && n > 0 && comes(&trigger, values[n - 1], now))
            came = n;
        cm1e_trace_record(&trace, NULL, n * MS);
    }
    uint32_t end = length;
    if (came < length && came + capacity - trigger.samples_before < length)
        end = came + capacity - trigger.samples_before;
    const uint32_t first = end > capacity ? end - capacity : 0;
    ck_assert_msg(trace.used == end - first, "seed %llu: %u samples, not %u", (unsigned long long)seed, trace.used,
                  end - first);
    for (uint32_t n = 0; n < trace.used; n++) {
        ck_assert_int_eq(cm1e_trace_time_ns(&trace, n), (first + n) * MS);
        ck_assert_double_eq(cm1e_trace_sample(&trace, n)[column_of(&trace, "x")], values[first + n]);
    }
    ck_assert_uint_eq(trace.mark_count, came < length);
    if (came < length) {
        ck_assert_str_eq(cm1e_trace_mark_at(&trace, 0)->text, "trigger: x");
        ck_assert_int_eq(cm1e_trace_mark_at(&trace, 0)->time_ns, came * MS);
    }
    cm1e_trace_free(&trace);
}

START_TEST(test_triggers_keep_what_a_search_in_the_whole_signal_says)
{
    for (seed = 1; seed < 20000;) {
        const uint64_t of_this = seed;
        check_random_trigger();
        seed = of_this + 1;
    }
}
END_TEST

START_TEST(test_an_axis_in_error_stop_ends_the_recording)
{
    open_machine(100);
    plc.fault_at = 300;
    expect(cm1e_scheduler_trace_trigger(machine.scheduler, &(cm1e_trace_trigger_t){
               .kind = CM1E_TRACE_ON_ERROR_STOP, .samples_before = 60}, &diag), CM1E_OK, "");
    machine_run(&machine, 600 * MS);
    const trace_t *trace = cm1e_scheduler_trace(machine.scheduler);
    ck_assert_uint_eq(trace->used, 100);
    char state[80], error[80];
    snprintf(state, sizeof state, "%s state", trace->names[0]);
    snprintf(error, sizeof error, "%s error", trace->names[0]);
    for (uint32_t n = 0; n < 100; n++) {
        ck_assert_int_eq(value_of(n, state) == CM1E_AXIS_ERROR_STOP, n >= 60);
        ck_assert_int_eq(value_of(n, error) != 0, n >= 60);
    }
    ck_assert_str_eq(cm1e_trace_mark_at(trace, 0)->text, "trigger: ErrorStop");
    ck_assert_int_eq(cm1e_trace_mark_at(trace, 0)->time_ns, cm1e_trace_time_ns(trace, 60));
    machine_close(&machine);
}
END_TEST

/* A trigger that is refused leaves the one that was set before. */
START_TEST(test_a_trigger_that_is_refused_changes_nothing)
{
    open_machine(100);
    plc.fault_at = 300;
    expect(cm1e_scheduler_trace_trigger(machine.scheduler, &(cm1e_trace_trigger_t){
               .kind = CM1E_TRACE_ON_ERROR_STOP, .samples_before = 60}, &diag), CM1E_OK, "");
    expect(cm1e_scheduler_trace_trigger(machine.scheduler, &(cm1e_trace_trigger_t){
               .kind = CM1E_TRACE_ON_CHANGE, .signal = "none of these"}, &diag), CM1E_ERROR_INVALID_ARGUMENT, "no signal");
    machine_run(&machine, 600 * MS);
    ck_assert_str_eq(cm1e_trace_mark_at(cm1e_scheduler_trace(machine.scheduler), 0)->text, "trigger: ErrorStop");
    machine_close(&machine);
}
END_TEST

START_TEST(test_an_axis_that_enters_error_stop_as_another_one_leaves_it_ends_the_recording)
{
    static const char *const names[] = {"A", "B"};
    static double sample[100];
    trace_t trace;
    ck_assert_int_eq(cm1e_trace_init(&trace, names, 2, 4, 1, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_trace_set_trigger(&trace, &(cm1e_trace_trigger_t){.kind = CM1E_TRACE_ON_ERROR_STOP}, &diag),
                     CM1E_OK);
    ck_assert_int_eq(cm1e_trace_begin(&trace, &diag), CM1E_OK);
    for (int n = 0; n < 3; n++) { /* A is in it from the beginning */
        sample[TRACE_STATE] = n < 2 ? CM1E_AXIS_ERROR_STOP : CM1E_AXIS_STANDSTILL;
        sample[TRACE_AXIS_COLUMNS + TRACE_STATE] = n < 2 ? CM1E_AXIS_STANDSTILL : CM1E_AXIS_ERROR_STOP;
        ck_assert(cm1e_trace_take(&trace, sample, n * MS));
        ck_assert_int_eq(trace.trigger.seen, n == 2);
    }
    cm1e_trace_free(&trace);
}
END_TEST

START_TEST(test_triggers_that_cannot_be_are_refused)
{
    static const struct {
        cm1e_trace_trigger_t trigger;
        const char *word;
    } cases[] = {
        {{.kind = CM1E_TRACE_ON_RISING, .signal = "no such"}, "\"no such\""},
        {{.kind = CM1E_TRACE_ON_CHANGE}, "no signal \"\""},
        {{.kind = CM1E_TRACE_ON_RISING, .signal = "overruns", .level = NAN}, "not a number"},
        {{.kind = (cm1e_trace_trigger_kind_t)9, .signal = "overruns"}, "kind of the trigger is unknown"},
        {{.kind = CM1E_TRACE_ON_RISING, .signal = "overruns", .level = 1, .samples_before = 20}, "trace_capacity is 20"},
    };
    open_machine(20);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        expect(cm1e_scheduler_trace_trigger(machine.scheduler, &cases[i].trigger, &diag), CM1E_ERROR_INVALID_ARGUMENT,
               cases[i].word);
    expect(cm1e_scheduler_trace_trigger(machine.scheduler, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT, "missing");
    machine_run(&machine, 30 * MS); /* none of them is in force */
    ck_assert_uint_eq(cm1e_scheduler_trace(machine.scheduler)->mark_count, 0);
    machine_close(&machine);
}
END_TEST

/* ---- NumPy ------------------------------------------------------------------------------------------------------- */

START_TEST(test_a_numpy_file_has_a_header_that_fits_and_every_value)
{
    static const char path[] = CM1E_TEST_OUTPUT "/trace-signals.npy";
    static unsigned char bytes[200000];
    open_machine(50);
    expect(add("it's a \\ name", CM1E_TRACE_LREAL, &plc.v.lreal), CM1E_OK, "");
    machine_run(&machine, 30 * MS);
    expect(cm1e_scheduler_write_npy(machine.scheduler, path, &diag), CM1E_OK, "");
    FILE *file = fopen(path, "rb");
    ck_assert_ptr_nonnull(file);
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    const trace_t *trace = cm1e_scheduler_trace(machine.scheduler);
    ck_assert_mem_eq(bytes, "\x93NUMPY\x03\0", 8);
    const size_t header = (size_t)bytes[8] | (size_t)bytes[9] << 8;
    ck_assert_uint_eq((12 + header) % 64, 0);
    ck_assert_uint_eq(bytes[12 + header - 1], '\n');
    ck_assert_uint_eq(size, 12 + header + trace->used * (trace->column_count + 1) * sizeof(double));
    bytes[12 + header - 1] = '\0';
    const char *text = (const char *)bytes + 12;
    char shape[40];
    snprintf(shape, sizeof shape, "'shape': (%u,), }", trace->used);
    ck_assert_ptr_nonnull(strstr(text, "{'descr': [('time', '<f8'), ("));
    ck_assert_ptr_nonnull(strstr(text, "('it\\'s a \\\\ name', '<f8')"));
    ck_assert_ptr_nonnull(strstr(text, shape));
    for (uint32_t n = 0; n < trace->used; n++) {
        double row[200];
        ck_assert_uint_lt(trace->column_count, 199);
        memcpy(row, bytes + 12 + header + n * (trace->column_count + 1) * sizeof(double), sizeof row);
        ck_assert_double_eq(row[0], (double)cm1e_trace_time_ns(trace, n) * 1e-9);
        ck_assert_mem_eq(row + 1, cm1e_trace_sample(trace, n), trace->column_count * sizeof(double));
    }
    machine_close(&machine);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("signals of the trace");
    TCase *tests = tcase_create("trace");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, test_variables_of_every_type_are_recorded_in_every_cycle);
    tcase_add_test(tests, test_the_type_of_a_variable_is_that_of_the_compiler);
    tcase_add_test(tests, test_signals_that_cannot_be_are_refused_in_words);
    tcase_add_test(tests, test_objects_in_both_directions_of_the_process_data);
    tcase_add_test(tests, test_objects_have_the_size_and_the_sign_of_the_dictionary);
    tcase_add_loop_test(tests, test_objects_of_a_motor_that_comes_are_where_it_has_them, 0, 2);
    tcase_add_test(tests, test_objects_that_no_cycle_brings_are_refused);
    tcase_add_test(tests, test_the_cycle_itself_is_recorded);
    tcase_add_test(tests, test_triggers_keep_what_a_search_in_the_whole_signal_says);
    tcase_add_test(tests, test_an_axis_in_error_stop_ends_the_recording);
    tcase_add_test(tests, test_a_trigger_that_is_refused_changes_nothing);
    tcase_add_test(tests, test_an_axis_that_enters_error_stop_as_another_one_leaves_it_ends_the_recording);
    tcase_add_test(tests, test_triggers_that_cannot_be_are_refused);
    tcase_add_test(tests, test_a_numpy_file_has_a_header_that_fits_and_every_value);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
