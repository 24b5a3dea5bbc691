#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "cm1e/config.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static const char temporary[] = CM1E_TEST_OUTPUT "/busfile_broken.yaml";
static cm1e_bus_config_t config, untouched;
static bool loaded; /* the configuration has axes that are to be freed */
static cm1e_diag_t diag;

static void write_file(const char *text, size_t size)
{
    FILE *file = fopen(temporary, "wb");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL(size, fwrite(text, 1, size, file));
    TEST_ASSERT_EQUAL(0, fclose(file));
}

/* Loads what is in the file; whatever comes out, a failure says something and leaves the configuration alone. */
static cm1e_error_t load(void)
{
    if (loaded)
        cm1e_bus_config_free(&config);
    memset(&config, 0x5A, sizeof config);
    memset(&diag, 0x5A, sizeof diag);
    const cm1e_error_t error = cm1e_bus_config_load(&config, temporary, &diag);
    loaded = error == CM1E_OK;
    TEST_ASSERT_EQUAL(error, diag.error);
    TEST_ASSERT_NOT_NULL(memchr(diag.text, '\0', sizeof diag.text));
    if (error != CM1E_OK) {
        TEST_ASSERT_EQUAL_MEMORY(&untouched, &config, sizeof config);
        TEST_ASSERT_EQUAL_STRING_LEN(temporary, diag.text, strlen(temporary));
        TEST_ASSERT_GREATER_THAN(strlen(temporary) + 10, strlen(diag.text));
    } else {
        TEST_ASSERT_EQUAL_STRING("", diag.text);
    }
    return error;
}

static const struct {
    const char *text;
    const char *place;   /* line:column */
    const char *parts[3]; /* of the diagnosis: what was found, what was expected */
} broken[] = {
    /* wrong keys */
    {"axes:\n  - name: X\n    speed: 3\n", "3:5", {"unknown key 'speed' in axes[0]", "one of: name, type, position"}},
    {"axes:\n  - name: X\n    speed: 3\n", "3:5", {"software_limits", "homing", "sim"}}, /* the whole list */
    {"axes:\n  - name: X\n    limit: 3\n", "3:5", {"in axes[0]; did you mean \"limits\"? Expected one of: name, type"}},
    {"axis:\n  - {}\n", "1:1", {"unknown key 'axis' in the file", "did you mean \"axes\"? Expected one of: bus, axes"}},
    {"bus:\n  intreface: sim\naxes: [{}]\n", "2:3", {"'intreface' in bus", "interface, second_interface"}},
    {"axes:\n  - name: X\n    limits:\n      velocity: 1\n      Jerk: 3\n", "5:7", {"'Jerk' in limits", "jerk"}},
    {"axes: [{}, {homing: {methode: -2}}]\n", "1:22", {"'methode' in homing", "method, offset"}},
    {"axes: [{name: X, name: Y}]\n", "1:18", {"'name' is given twice in axes[0]", "once"}},
    {"axes: [{}]\nbus: {}\naxes: [{}]\n", "3:1", {"'axes' is given twice"}},
    {"axes: [{[a]: 1}]\n", "1:9", {"unknown key a list"}},
    {"axes: [{<<: {}}]\n", "1:9", {"unknown key '<<'"}},
    {"axes: [{kkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkk: 1}]\n", "1:9", {"unknown key 'kkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkk' in"}},
    {"axes: [{kkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkk: 1}]\n", "1:9", {"unknown key 'kkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkk...' in"}},
    {"axes: [{\"na\\0me\": 1}]\n", "1:9", {"unknown key 'na?me'"}},
    /* missing things */
    {"", "1:1", {"the file is empty", "bus and axes"}},
    {"# nothing but this\n\n", "1:1", {"the file is empty"}},
    {"---\n", "2:1", {"the file is nothing", "bus, axes"}},
    {"bus: {}\n", "1:1", {"key 'axes' is missing in the file"}},
    {"\n\n  bus: {}\n", "3:3", {"key 'axes' is missing"}},
    {"axes:\n", "1:6", {"axes is nothing", "list"}},
    {"axes: []\n", "1:7", {"empty list", "at least one"}},
    {"axes:\n  - name:\n    position: 1\n", "2:10", {"name is empty", "value"}},
    {"axes: [{limits: {velocity: }}]\n", "1:28", {"velocity is empty"}},
    {"axes: [{limits: {velocity: ~}}]\n", "1:28", {"velocity is empty"}},
    {"axes: [{motor: null}]\n", "1:16", {"motor is empty"}},
    {"axes: [{motor: \"\"}]\n", "1:16", {"motor is empty"}},
    /* wrong types */
    {"just text\n", "1:1", {"the file is 'just text'", "bus, axes"}},
    {"- a\n- b\n", "1:1", {"the file is a list", "bus, axes"}},
    {"axes: 3\n", "1:7", {"axes is '3'", "a list"}},
    {"axes: {name: X}\n", "1:7", {"axes is a group of keys", "a list"}},
    {"axes: [X]\n", "1:8", {"axes[0] is 'X'", "group with the keys: name"}},
    {"axes:\n  - {}\n  -\n", "3:4", {"axes[1] is nothing", "group"}},
    {"bus: sim\naxes: [{}]\n", "1:6", {"bus is 'sim'", "group with the keys: interface"}},
    {"axes:\n  - homing: -2\n", "2:13", {"homing is '-2'", "group with the keys: method"}},
    {"axes: [{name: [X]}]\n", "1:15", {"name is a list", "single value"}},
    {"axes: [{position: {a: b}}]\n", "1:19", {"position is a group", "single value"}},
    {"axes: [{position: one}]\n", "1:19", {"position is 'one'", "whole number, 1 ... 512"}},
    {"axes: [{position: 1.0}]\n", "1:19", {"position is '1.0'", "whole number"}},
    {"axes: [{position: 010}]\n", "1:19", {"position is '010'", "whole number"}},
    {"axes: [{position: 0x1}]\n", "1:19", {"position is '0x1'", "whole number"}},
    {"axes: [{position: +1}]\n", "1:19", {"position is '+1'", "whole number"}},
    {"axes: [{position: 1 2}]\n", "1:19", {"position is '1 2'", "whole number"}},
    {"axes: [{position: \"1\"}]\n", "1:19", {"position is text in quotes", "without"}},
    {"axes: [{unit: {counts_per_unit: 5000 mm}}]\n", "1:33", {"'5000 mm'", "a number"}},
    {"axes: [{unit: {counts_per_unit: 4x}}]\n", "1:33", {"'4x'", "a number"}},
    {"axes: [{unit: {counts_per_unit: 5,5}}]\n", "1:35", {"unknown key '5' in unit", "point, not a comma: counts_per_unit: 5.5"}},
    {"axes: [{homing: {offset: -0,5e1}}]\n", "1:29", {"unknown key '5e1' in homing", "comma: offset: -0.5e1"}},
    {"axes: [{limits: {velocity: 1, 5: 2}}]\n", "1:31", {"unknown key '5' in limits; expected one of"}},
    {"axes: [{limits: {5, velocity: 1}}]\n", "1:18", {"unknown key '5' in limits; expected one of"}},
    {"axes:\n  - limits:\n      velocity: 0,5\n", "3:17", {"velocity is '0,5'; expected a number with a decimal point"}},
    {"axes: [{unit: {counts_per_unit: .nan}}]\n", "1:33", {"'.nan'", "a number"}},
    {"axes: [{unit: {counts_per_unit: nan}}]\n", "1:33", {"'nan'", "a number"}},
    {"axes: [{unit: {counts_per_unit: inf}}]\n", "1:33", {"'inf'", "a number"}},
    {"axes: [{unit: {counts_per_unit: 0x1p3}}]\n", "1:33", {"'0x1p3'", "a number"}},
    {"axes: [{unit: {counts_per_unit: 1e}}]\n", "1:33", {"'1e'", "a number"}},
    {"axes: [{unit: {counts_per_unit: .}}]\n", "1:33", {"'.'", "a number"}},
    {"axes: [{unit: {counts_per_unit: -}}]\n", NULL, {"counts_per_unit"}},
    {"axes: [{unit: {counts_per_unit: 1.2.3}}]\n", "1:33", {"'1.2.3'", "a number"}},
    {"axes: [{unit: {counts_per_unit: 1e999}}]\n", "1:33", {"'1e999'", "neither too large nor too small"}},
    {"axes: [{unit: {counts_per_unit: 1e-999}}]\n", "1:33", {"'1e-999'", "neither too large nor too small"}},
    {"axes: [{unit: {counts_per_unit: 'x\\x00y'}}]\n", "1:33", {"quotes"}},
    {"axes: [{unit: {invert: maybe}}]\n", "1:24", {"invert is 'maybe'", "true or false"}},
    {"axes: [{unit: {invert: 1}}]\n", "1:24", {"invert is '1'", "true or false"}},
    {"axes: [{mapping: CSP}]\n", "1:18", {"mapping is 'CSP'", "dynamic, csp, csv, profile"}},
    {"axes: [{mapping: 1}]\n", "1:18", {"mapping is '1'", "dynamic, csp, csv, profile"}},
    {"bus: {sim_pdo_order: ug}\naxes: [{}]\n", "1:22", {"sim_pdo_order is 'ug'", "ug_4_4, ug_7_2"}},
    {"axes: [{wire: {velocity_unit: rpm}}]\n", "1:31", {"velocity_unit is 'rpm'", "counts_per_s, counts_per_ms"}},
    {"axes: [{type: servo}]\n", "1:15", {"type is 'servo'", "motor, virtual, encoder"}},
    {"axes: [{coupling_stop: all}]\n", "1:24", {"coupling_stop is 'all'", "this_axis, coupled_axes, keep_ratio"}},
    {"axes: [{follows: gear}]\n", "1:18", {"follows is 'gear'", "any, gears, nothing"}},
    {"axes: [{follows: nothing, cam_points: 9}]\n", "1:39", {"cam_points", "follows no cams (follows: nothing)"}},
    {"axes: [{type: encoder, follows: gears}]\n", "1:33", {"follows", "no such key"}},
    {"axes: [{cam_points: 1}]\n", "1:21", {"cam_points is '1'", "2 ... 4096"}},
    {"axes: [{cam_points: 4097}]\n", "1:21", {"cam_points is '4097'", "2 ... 4096"}},
    {"axes: [{encoder_filter_s: 0}]\n", "1:27", {"encoder_filter_s", "0"}},
    {"axes: [{encoder_filter_s: 11}]\n", "1:27", {"encoder_filter_s is 11", "0.0001 ... 10 s"}},
    /* what means nothing without a motor */
    {"axes: [{type: virtual, position: 1}]\n", "1:34", {"axis axis1: position", "virtual", "no such key"}},
    {"axes: [{type: encoder, alias: 7}]\n", "1:31", {"alias", "encoder", "no such key"}},
    {"axes: [{type: virtual, explicit_id: 3}]\n", "1:37", {"explicit_id"}},
    {"axes: [{type: virtual, channel: 1}]\n", "1:33", {"channel"}},
    {"axes: [{type: virtual, motor: CM1-E-17S30D}]\n", "1:31", {"motor"}},
    {"axes: [{type: virtual, k37: 0}]\n", "1:29", {"k37"}},
    {"axes: [{type: virtual, firmware: 1.3.5}]\n", "1:34", {"firmware"}},
    {"axes: [{type: virtual, mapping: csv}]\n", "1:33", {"mapping"}},
    {"axes: [{type: virtual, motion: drive}]\n", "1:32", {"motion"}},
    {"axes: [{type: virtual, limits: {position_lag: 1}}]\n", "1:47", {"limits.position_lag"}},
    {"axes: [{type: virtual, in_position: {window: 1}}]\n", "1:46", {"in_position.window"}},
    {"axes: [{type: virtual, in_position: {time_s: 1}}]\n", "1:46", {"in_position.time_s"}},
    {"axes: [{type: encoder, in_position: {timeout_s: 1}}]\n", "1:49", {"in_position.timeout_s"}},
    {"axes: [{type: virtual, in_position: {done_waits: true}}]\n", "1:50", {"in_position.done_waits"}},
    {"axes: [{type: virtual, backlash: {gap: 0.1}}]\n", "1:40", {"backlash.gap"}},
    {"axes: [{type: virtual, inputs: {home: 1}}]\n", "1:32", {"inputs"}},
    {"axes: [{type: virtual, homing: {offset: 1}}]\n", "1:32", {"homing"}},
    {"axes: [{type: virtual, wire: {velocity_unit: counts_per_s}}]\n", "1:46", {"wire.velocity_unit"}},
    {"axes: [{type: virtual, wire: {acceleration_unit: kcounts_per_s2}}]\n", "1:50", {"wire.acceleration_unit"}},
    {"axes: [{type: virtual, sim: {no_stops: true}}]\n", "1:29", {"sim"}},
    {"axes: [{type: encoder, limits: {velocity: 1}}]\n", "1:43", {"limits.velocity", "makes no motions"}},
    {"axes: [{type: encoder, limits: {acceleration: 1}}]\n", "1:47", {"limits.acceleration"}},
    {"axes: [{type: encoder, limits: {deceleration: 1}}]\n", "1:47", {"limits.deceleration"}},
    {"axes: [{type: encoder, limits: {jerk: 1}}]\n", "1:39", {"limits.jerk"}},
    {"axes: [{type: encoder, software_limits: {positive: 1}}]\n", "1:41", {"software_limits"}},
    {"axes: [{type: encoder, jog: {slow: 1}}]\n", "1:36", {"jog.slow"}},
    {"axes: [{type: encoder, jog: {fast: 1}}]\n", "1:36", {"jog.fast"}},
    {"axes: [{type: encoder, table_profiles: true}]\n", "1:40", {"table_profiles"}},
    {"axes: [{type: encoder, cam_points: 9}]\n", "1:36", {"cam_points"}},
    {"axes: [{type: encoder, coupling_stop: keep_ratio}]\n", "1:39", {"coupling_stop"}},
    {"axes: [{type: virtual, limits: {velocity: 20001}}]\n", "1:43", {"limits.velocity is 20001", "20000"}},
    /* texts that do not fit */
    {"axes: [{name: 12345678901234567890123456789012}]\n", "1:15", {"32 bytes long", "at most 31"}},
    {"axes: [{name: \"a\\0b\"}]\n", "1:15", {"null character"}},
    {"axes: [{name: \"a\\nb\"}]\n", "1:15", {"name", "control characters"}},
    {"bus: {interface: \"\\e[2J\"}\naxes: [{}]\n", "1:18", {"interface", "control characters"}},
    /* out of range */
    {"axes: [{position: 0}]\n", "1:19", {"position is '0'", "1 ... 512"}},
    {"axes: [{position: 513}]\n", "1:19", {"position is '513'", "1 ... 512"}},
    {"axes: [{position: -1}]\n", "1:19", {"position is '-1'", "1 ... 512"}},
    {"axes: [{position: 65537}]\n", "1:19", {"position is '65537'", "1 ... 512"}},
    {"axes: [{position: 99999999999999999999}]\n", "1:19", {"1 ... 512"}},
    {"axes: [{alias: 65536}]\n", "1:16", {"alias is '65536'", "1 ... 65535"}},
    {"axes: [{explicit_id: 255}]\n", "1:22", {"explicit_id is '255'", "1 ... 254"}},
    {"axes: [{homing: {method: 1}}]\n", "1:26", {"homing.method is 1", "-6 ... 0"}},
    {"axes: [{homing: {method: -7}}]\n", "1:26", {"homing.method is -7", "-6 ... 0"}},
    {"axes: [{homing: {method: 250}}]\n", "1:26", {"method is '250'", "-128 ... 37"}},
    {"axes: [{channel: 0}]\n", "1:18", {"channel is '0'", "1 ... 4"}},
    {"axes: [{channel: 5}]\n", "1:18", {"channel is '5'", "1 ... 4"}},
    {"axes: [{channel: 1, k37: -1}]\n", "1:26", {"k37 is '-1'", "0 ... 99"}},
    {"axes: [{channel: 1, k37: 100}]\n", "1:26", {"k37 is '100'", "0 ... 99"}},
    {"axes: [{channel: 1, k37: }]\n", "1:26", {"k37 is empty"}},
    {"axes: [{inputs: {home: 5}}]\n", "1:24", {"home is '5'", "1 ... 4"}},
    {"axes: [{inputs: {home: 0}}]\n", "1:24", {"home is '0'", "1 ... 4"}},
    {"axes: [{inputs: {limit_positive: 260}}]\n", "1:34", {"limit_positive is '260'", "1 ... 4"}},
    {"axes: [{inputs: {limit_negative: -2}}]\n", "1:34", {"limit_negative is '-2'", "1 ... 4"}},
    {"axes: [{inputs: {limit_positive: 2, limit_negative: 2}}]\n", "1:53",
     {"inputs.limit_negative is 2", "expected another input"}},
    {"axes: [{jog: {slow: 0}}]\n", "1:21", {"slow is 0", "default"}},
    {"axes: [{limits: {velocity: 10}, jog: {fast: 11}}]\n", "1:45", {"jog.fast is 11", "10"}},
    {"bus: {cycle_time_us: 100}\naxes: [{}]\n", "1:22", {"cycle_time_us is '100'", "200 ... 4000"}},
    {"bus: {cycle_time_us: 300}\naxes: [{}]\n", "1:22", {"cycle_time_us is 300", "200, 250, 500 or 1000"}},
    {"bus: {lost_cycles_limit: 0}\naxes: [{}]\n", "1:26", {"lost_cycles_limit", "1 ... 250"}},
    {"bus: {lost_cycles_limit: 4294967297}\naxes: [{}]\n", "1:26", {"lost_cycles_limit", "1 ... 250"}},
    {"axes: [{limits: {velocity: 0}}]\n", "1:28", {"velocity is 0", "default"}},
    {"axes: [{limits: {jerk: -0.0}}]\n", "1:24", {"jerk is 0", "default"}},
    {"axes: [{sim: {friction_nm: 0}}]\n", "1:28", {"friction_nm is 0", "default"}},
    {"axes: [{limits: {velocity: -5}}]\n", "1:28", {"limits.velocity is -5", "counts/s"}},
    {"axes: [{unit: {counts_per_unit: -5000}}]\n", "1:33", {"unit.counts_per_unit is -5000", "0.001"}},
    {"axes: [{unit: {counts_per_unit: 1e13}}]\n", "1:33", {"unit.counts_per_unit is 1e+13"}},
    {"axes: [{limits: {acceleration: 0.01}}]\n", "1:32", {"limits.acceleration is 0.01, 500 counts/s2", "1000"}},
    {"axes: [{limits: {deceleration: 1e9}}]\n", "1:32", {"limits.deceleration is 1000000000"}},
    {"axes: [{limits: {position_lag: 1e-6}}]\n", "1:32", {"limits.position_lag"}},
    {"axes: [{in_position: {window: 1e-6}}]\n", "1:31", {"in_position.window"}},
    {"axes: [{in_position: {window: 0}}]\n", "1:31", {"window is 0", "default"}},
    {"axes: [{limits: {position_lag: 1}, in_position: {window: 1.1}}]\n", "1:58",
     {"in_position.window is 1.1", "position_lag 1"}},
    {"axes: [{in_position: {time_s: 0.0001}}]\n", "1:31", {"in_position.time_s", "0.001 ... 10 s"}},
    {"axes: [{in_position: {timeout_s: 3601}}]\n", "1:34", {"in_position.timeout_s is 3601", "0.01 ... 3600 s"}},
    {"axes: [{in_position: {time_s: 3}}]\n", "1:31", {"in_position.time_s is 3", "timeout_s, 2"}},
    {"axes: [{in_position: {timeout_s: 0.02}}]\n", "1:34", {"in_position.timeout_s is 0.02", "time_s, 0.02"}},
    {"axes: [{in_position: {done: true}}]\n", "1:23", {"done", "done_waits"}},
    {"axes:\n- unit: {counts_per_unit: 5000}\n  homing:\n    velocity: 0.1\n", "4:15",
     {"homing.velocity is 0.1, 500 counts/s", "0.2 ... 100, 1000 ... 500000 counts/s"}},
    {"axes:\n- unit: {counts_per_unit: 5000}\n  homing:\n    velocity: 100.0002\n", "4:15", {"500001 counts/s"}},
    {"axes:\n- unit: {counts_per_unit: 5000}\n  homing: {acceleration: 1001}\n", "3:26",
     {"1000 ... 5000000 counts/s2"}},
    {"axes:\n- unit: {counts_per_unit: 5000}\n  homing: {offset: 655.3402}\n", "3:20",
     {"3276701 counts", "-3276700 ... 3276700"}},
    {"axes:\n- unit: {counts_per_unit: 5000}\n  homing: {offset: -1e300}\n", "3:20", {"homing.offset"}},
    {"axes:\n- unit: {counts_per_unit: 1e12}\n  limits: {jerk: 1e308}\n", "3:18", {"limits.jerk"}},
    {"axes: [{unit: {gear_numerator: 0}}]\n", "1:32", {"gear_numerator is '0'", "1 ... 1000000"}},
    {"axes: [{unit: {gear_numerator: 2.5}}]\n", "1:32", {"gear_numerator is '2.5'", "whole number"}},
    {"axes: [{unit: {gear_denominator: 1000001}}]\n", "1:34", {"gear_denominator is '1000001'"}},
    {"axes: [{unit: {gear_denominator: -3}}]\n", "1:34", {"gear_denominator is '-3'"}},
    {"axes: [{unit: {units_per_revolution: 0}}]\n", "1:38", {"units_per_revolution is 0", "default"}},
    {"axes: [{unit: {units_per_revolution: -360}}]\n", "1:38", {"unit.units_per_revolution is -360", "1e-06 ... "}},
    {"axes: [{unit: {units_per_revolution: 1e10}}]\n", "1:38", {"unit.units_per_revolution is 1e+10"}},
    {"axes: [{unit: {units_per_revolution: 1e9, gear_denominator: 1000}}]\n", "1:38",
     {"unit.units_per_revolution makes a unit of 5e-08 counts", "0.001"}},
    {"axes: [{unit: {modulo_range: 0}}]\n", "1:30", {"modulo_range is 0", "default"}},
    {"axes: [{unit: {modulo_range: -360}}]\n", "1:30", {"unit.modulo_range is -360"}},
    {"axes: [{unit: {units_per_revolution: 360, modulo_range: 7}}]\n", "1:57",
     {"unit.modulo_range is 7, 972 counts", "1000 ... "}},
    {"axes: [{unit: {modulo_range: 2.1e7}}]\n", "1:30", {"unit.modulo_range is 21000000", "20000000"}},
    {"axes: [{unit: {modulo_range: 1.2345678901234567, gear_numerator: 999983, units_per_revolution: 12.345678901}}]\n",
     "1:30", {"unit.modulo_range is 1.23456789", "not a fraction of counts", "gear"}},
    {"axes: [{backlash: {gap: 0}}]\n", "1:25", {"gap is 0", "default"}},
    {"axes: [{backlash: {gap: -1}}]\n", "1:25", {"backlash.gap is -1", "1 ... 500000 counts"}},
    {"axes: [{backlash: {gap: 10.01}}]\n", "1:25", {"backlash.gap is 10.01, 500500 counts"}},
    {"axes: [{backlash: {gap: 1, velocity: 25.1}}]\n", "1:38", {"backlash.velocity is 25.1", "1250000 counts/s"}},
    {"axes: [{backlash: {gap: 1, velocity: -1}}]\n", "1:38", {"backlash.velocity is -1"}},
    {"axes: [{homing: {torque: 9.9}}]\n", "1:26", {"homing.torque is 9.9", "10 ... 100 %"}},
    {"axes: [{homing: {torque: 101}}]\n", "1:26", {"homing.torque is 101", "10 ... 100 %"}},
    {"axes: [{homing: {timeout_s: -1}}]\n", "1:29", {"homing.timeout_s is -1", "0.1 ... 3600 s"}},
    {"axes: [{sim: {stop_positive_counts: -1}}]\n", "1:37", {"sim.stop_positive_counts is -1", "counts"}},
    {"axes: [{sim: {stop_negative_counts: 5}}]\n", "1:37", {"sim.stop_negative_counts is 5"}},
    {"axes: [{sim: {load_inertia_kgm2: -1e-6}}]\n", "1:34", {"sim.load_inertia_kgm2", "kg m2"}},
    /* contradictions */
    {"axes:\n- position: 1\n- position: 2\n- position: 1\n", "4:13", {"position is 1, which entry 1", "one axis"}},
    {"axes:\n- position: 2\n- name: Y\n", "3:3", {"axis Y: position is 2, which entry 1"}},
    {"axes:\n- alias: 7\n- explicit_id: 7\n- alias: 7\n", "4:10", {"alias is 7, which entry 1"}},
    {"axes:\n- explicit_id: 7\n- explicit_id: 7\n", "3:16", {"explicit_id is 7, which entry 1"}},
    {"axes:\n- position: 1\n  alias: 7\n", "3:10", {"addressed twice", "one of position, alias and explicit_id"}},
    {"axes:\n- explicit_id: 9\n  alias: 7\n", "2:16", {"addressed twice"}},
    {"axes:\n- name: X\n- name: Y\n- name: X\n", "4:9", {"axis X: name is also the name of entry 1"}},
    {"axes:\n- name: feed\n- name: FEED\n", "3:9", {"axis FEED: name is also the name of entry 1"}}, /* one in IEC 61131-3 */
    {"axes:\n- name: axis2\n- position: 2\n", "3:3", {"axis axis2: name is also the name of entry 1"}},
    {"axes:\n- motor: CM1-E-17S30\n", "2:10", {"motor is 'CM1-E-17S30'", "CM1-E-17S30D", "CM1-E-23L20D"}},
    {"axes:\n- motor: CM1-E-17S30D-and-more\n", "2:10", {"21 bytes long", "at most 19"}},
    {"axes:\n- firmware: 1.3.1\n", "2:13", {"firmware is '1.3.1'", "1.2.0, 1.3.0, 1.3.2, 1.3.3, 1.3.4, 1.3.5"}},
    {"axes:\n- firmware: V1.3.5\n", "2:13", {"firmware is 'V1.3.5'", "1.3.5"}},
    {"bus: {cycle_time_us: 250}\naxes:\n- {}\n- firmware: 1.3.0\n", "4:13", {"1000 us only", "250 us"}},
    {"bus: {cycle_time_us: 250, frame_timeout_us: 251}\naxes: [{}]\n", "1:45", {"frame_timeout_us is 251", "250"}},
    {"bus: {interface: eth1, virtual_time: yes}\naxes: [{}]\n", "1:38", {"virtual_time is on", "eth1", "sim"}},
    {"bus: {interface: eth1, second_interface: eth1}\naxes: [{}]\n", "1:42", {"eth1 like the first"}},
    {"bus: {interface: eth1, second_interface: \"eth1,xdp\"}\naxes: [{}]\n", "1:42", {"eth1,xdp like the first"}},
    {"bus:\n  interface: eth1,fast\naxes: [{}]\n", "2:14", {"has \"fast\" behind its comma", "packet (as without", "xdp"}},
    {"bus: {interface: eth1, second_interface: eth2, overlap: true}\naxes: [{}]\n", "1:57", {"overlap", "a ring"}},
    /* one letter is a name, too */
    {"bus: {interface: a, second_interface: b, overlap: true}\naxes: [{}]\n", "1:51", {"overlap", "a ring"}},
    {"bus: {interface: a, second_interface: b, distributed_clocks: true}\naxes: [{}]\n", "1:39",
     {"second_interface is given together with distributed clocks"}},
    {"bus: {interface: a, second_interface: a}\naxes: [{}]\n", "1:39", {"second_interface is a like the first"}},
    {"bus: {interface: a, second_interface: b}\naxes: [{alias: 6, optional: true}]\n", "2:29",
     {"optional is true together with a second_interface: in a ring no slave may be absent"}},
    {"bus: {interface: a, second_interface: b}\nslaves: [{alias: 6, vendor: 0x2, product: 0x3, optional: true}]\n",
     "2:58", {"optional is true together with a second_interface: in a ring no slave may be absent"}},
    {"bus: {interface: a, virtual_time: true}\naxes: [{}]\n", "1:35", {"virtual_time is on with the interface a"}},
    {"bus: {overlap: true}\naxes: [{alias: 5}, {alias: 6, optional: true}]\n", "1:16",
     {"overlap", "entry 2 of the axes"}},
    {"bus: {overlap: true}\naxes: [{}]\nslaves: [{name: io, alias: 5, vendor: 0x2, product: 0x3, optional: true}]\n",
     "1:16", {"overlap", "entry 1 of the slaves"}},
    {"axes:\n- software_limits: {negative: 5, positive: -5}\n", "2:44", {"is -5, not above the negative one, 5"}},
    {"axes:\n- software_limits: {negative: 5, positive: 5}\n", "2:44", {"is 5, not above"}},
    {"axes:\n- software_limits:\n    positive: -1\n    negative: 0\n", "3:15", {"is -1, not above"}},
    {"axes:\n- software_limits: {negative: 0, positive: 1e300}\n", "2:44", {"software_limits.positive"}},
    {"axes:\n- limits: {velocity: 50.001}\n", "2:22", {"2500050 counts/s", "2e-05 ... 50, 1 ... 2500000 counts/s"}},
    {"axes:\n- limits: {velocity: 33.3334}\n  motor: CM1-E-23L20D\n", "2:22", {"1666670 counts/s", "1666666 counts/s"}},
    {"axes:\n- software_limits: {positive: 3}\n  unit: {modulo_range: 1}\n", "2:20",
     {"software_limits are given, and unit.modulo_range too", "one of them"}},
    {"axes:\n- unit: {counts_per_unit: 5000, gear_numerator: 7}\n", "2:49",
     {"unit.gear_numerator is given, and counts_per_unit too", "only counts_per_unit"}},
    {"axes:\n- unit:\n    gear_denominator: 3\n    counts_per_unit: 5000\n", "3:23",
     {"unit.gear_denominator is given"}},
    {"axes:\n- unit: {counts_per_unit: 5000, units_per_revolution: 10}\n", "2:55",
     {"unit.units_per_revolution is given, and counts_per_unit too"}},
    {"axes:\n- motion: servo\n", "2:11", {"motion is 'servo'", "host, drive"}},
    {"axes:\n- motion: drive\n  mapping: csp\n", "2:11", {"motion is drive, and the mapping has no profile modes"}},
    {"axes:\n- backlash: {gap: 0.01}\n  motion: drive\n", "3:11", {"motion is drive, and backlash is given"}},
    {"axes:\n- backlash: {velocity: 3}\n", "2:24", {"backlash.velocity is given without a gap"}},
    {"axes:\n- backlash: {gap: 0.01}\n  limits: {velocity: 49.5}\n", "3:22",
     {"limits.velocity is 49.5", "2450000 counts/s beside the compensation of backlash"}},
    {"axes:\n- backlash: {gap: 0.01, velocity: 10}\n  limits: {velocity: 41}\n", "3:22", {"2000000 counts/s beside"}},
    {"axes:\n- backlash: {gap: 0.01, velocity: 10}\n  jog: {fast: 41}\n", "3:15", {"jog.fast is 41", "40"}},
    {"axes:\n- homing: {method: -1, offset: 1}\n", "2:32", {"homing.offset is 1, beyond the hard stop", "other sign"}},
    {"axes:\n- homing: {method: -2, offset: -1}\n", "2:32", {"homing.offset is -1, beyond the hard stop"}},
    {"axes:\n- homing: {method: -2, offset: 1}\n  unit: {invert: true}\n", "2:32", {"beyond the hard stop"}},
    {"axes:\n- sim: {no_stops: true, stop_positive_counts: 5}\n", "2:19", {"no_stops is true, and a stop is given"}},
    {"axes:\n- sim: {sensor_input3_counts: -5, no_sensors: on}\n", "2:47", {"no_sensors is true, and a sensor"}},
    /* behind a bridge */
    {"axes:\n- {channel: 1}\n", "2:3", {"axis axis1: k37 is missing", "\"K37.1\" with cm1e cml"}},
    {"axes:\n- {channel: 4, k37: 9}\n", "2:21", {"k37 is 9", "0 ... 8 or 10", "80 ... 88"}},
    {"axes:\n- {channel: 4, k37: 85, motor: CM1}\n", "2:21", {"k37 is 85", "plus 20"}},
    {"axes:\n- {k37: 10}\n", "2:9", {"k37 is given without a channel"}},
    {"axes:\n- {motor: CM2}\n", "2:11", {"motor is 'CM2'", "channel of a bridge"}},
    {"axes:\n- {channel: 1, k37: 10, motor: CM1-E-17S30D}\n", "2:32", {"'CM1-E-17S30D'", "expected CM1 or CM2"}},
    {"axes:\n- {channel: 1, k37: 10, mapping: csp}\n", "2:34", {"mapping is given", "one mapping only"}},
    {"axes:\n- {channel: 1, k37: 10, motion: drive}\n", "2:33", {"motion is given", "no moves of its own"}},
    {"axes:\n- {channel: 1, k37: 10, firmware: 1.3.5}\n", "2:35", {"firmware is given"}},
    {"axes:\n- {channel: 1, k37: 10, explicit_id: 3}\n", "2:38", {"explicit_id is given", "no rotary switches"}},
    {"axes:\n- {channel: 1, k37: 10, wire: {velocity_unit: counts_per_s}}\n", "2:47", {"wire.velocity_unit is given"}},
    {"axes:\n- {channel: 1, k37: 10, wire: {acceleration_unit: kcounts_per_s2}}\n", "2:51",
     {"wire.acceleration_unit is given"}},
    {"axes:\n- {channel: 1, k37: 10, homing: {method: -1}}\n", "2:42", {"homing.method is -1", "1 ... 4 behind a bridge"}},
    {"axes:\n- {channel: 1, k37: 10, homing: {method: 1, offset: 0.1}}\n", "2:53", {"beyond the hard stop"}},
    {"bus: {cycle_time_us: 500}\naxes:\n- {channel: 1, k37: 10}\n", "3:13", {"a bridge runs at 1000 us only", "500 us"}},
    {"axes:\n- {position: 1, channel: 1, k37: 10}\n- {position: 1, channel: 1, k37: 10}\n", "3:26",
     {"channel is 1, which entry 1 of the list has already"}},
    {"axes:\n- {position: 1, channel: 1, k37: 10}\n- {position: 1}\n", "3:14", {"only one of the two has a channel"}},
    {"axes:\n- {position: 1}\n- {position: 1, channel: 1, k37: 10}\n", "3:14", {"only one of the two has a channel"}},
    {"axes:\n- {alias: 1, channel: 1, k37: 10}\n- {alias: 1, channel: 2, k37: 10, optional: true}\n", "3:45",
     {"optional differs from that of entry 1 of the list, which is on the same bridge"}},
    {"axes:\n- {channel: 1, k37: 10}\n- {alias: 1, channel: 1, k37: 10}\n- {alias: 1, channel: 2, k37: 10, recover: "
     "auto}\n", "4:44", {"recover differs from that of entry 2 of the list, which is on the same bridge"}},
    {"axes:\n- {position: 1, channel: 1, k37: 10, motor: CM2}\n- {position: 1, channel: 2, k37: 10, motor: CM1}\n",
     "3:45", {"motor is CM1 at channel 2", "no bridge has"}},
    /* YAML that has no place here, and text that is no YAML */
    {"axes:\n- &a {name: X}\n- *a\n", "2:3", {"an anchor", "not supported"}},
    {"axes:\n- *a\n", "2:3", {"an alias", "not supported"}},
    {"axes: &a [{name: X}]\n", "1:7", {"an anchor", "not supported"}},
    {"axes: [{name: &n X}]\n", "1:15", {"an anchor"}},
    {"axes: [{name: !!str X}]\n", "1:15", {"a tag", "not supported"}},
    {"axes: !axes [{}]\n", "1:7", {"a tag"}},
    {"axes: [!axis {}]\n", "1:8", {"a tag"}},
    {"axes: [{}]\n---\naxes: [{}]\n", "2:1", {"a second document"}},
    {"axes: [[[[[[[[[[[[]]]]]]]]]]]]\n", "1:14", {"nested too deeply"}},
    {"axes:\n\t- name: X\n", "2:1", {"not YAML", "a tab; expected spaces"}},
    {"axes:\n  - name: X\n  \tposition: 1\n", "3:3", {"a tab; expected spaces"}},
    {"\xEF\xBB\xBF# \xC3\xA4\r\naxes:\n  -\tname: X\n", "3:4", {"a tab; expected spaces"}},
    {"axes: [\n\t{name: X]\n", "2:10", {"did not find expected ',' or '}'"}}, /* it may stand in brackets */
    {"axes:\n  - name: X\n   position: 1\n", "3:4", {"not YAML", "did not find expected"}},
    {"axes: [\n", "2:1", {"not YAML"}},
    {"axes: [{name: \"X}]\n", "2:1", {"not YAML", "quoted scalar"}},
    {"axes: [}]\n", "1:8", {"not YAML"}},
    {"axes: [{name: X}]\n}\n", "2:1", {"not YAML"}},
    {"axes: [{name: @x}]\n", "1:15", {"not YAML"}},
    {"%YAML 7.3\n---\naxes: [{}]\n", "1:1", {"not YAML", "incompatible"}},
    {"axes: [{}]\n# \x01\n", "2:3", {"not YAML", "control characters"}},
    {"axes: [{}]\n\n  \xff\n", "3:3", {"not YAML", "UTF-8"}},
    {"axes: [{name: \xc3\x28}]\n", "1:16", {"not YAML", "UTF-8"}},
};

static void test_every_broken_file_is_told_by_line_and_column(void)
{
    int failures = 0;
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++) {
        write_file(broken[i].text, strlen(broken[i].text));
        const cm1e_error_t error = load();
        char place[sizeof temporary + 40];
        snprintf(place, sizeof place, "%s:%s: ", temporary, broken[i].place ? broken[i].place : "");
        bool good = error == CM1E_ERROR_CONFIG &&
                    (!broken[i].place || strncmp(place, diag.text, strlen(place)) == 0);
        for (size_t k = 0; k < 3; k++)
            good = good && (!broken[i].parts[k] || strstr(diag.text, broken[i].parts[k]));
        if (!good) {
            printf("----\n%s=> %s (%d)\nexpected at %s: %s / %s\n", broken[i].text, diag.text + strlen(temporary),
                   error, broken[i].place, broken[i].parts[0], broken[i].parts[1] ? broken[i].parts[1] : "");
            failures++;
        }
    }
    TEST_ASSERT_EQUAL(0, failures);
}

static void test_too_many_axes_are_told_at_the_first_one_too_many(void)
{
    char text[8 * CM1E_MAX_AXES] = "axes:\n";
    for (int i = 0; i <= CM1E_MAX_AXES; i++)
        strcat(text, "- {}\n");
    write_file(text, strlen(text));
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, load());
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, ":514:3: axes has 513 entries; expected at most 512"), diag.text);
}

/** Of this program's computing: other programs may have the machine. */
static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + (double)t.tv_nsec / 1e9;
}

/* A file of `count` times `part` between head and tail. */
static void write_repeated(const char *head, const char *part, size_t count, const char *tail)
{
    FILE *file = fopen(temporary, "wb");
    TEST_ASSERT_NOT_NULL(file);
    fputs(head, file);
    for (size_t i = 0; i < count; i++)
        fputs(part, file);
    fputs(tail, file);
    TEST_ASSERT_EQUAL(0, fclose(file));
}

static void test_huge_and_deep_files_end_in_an_error_soon(void)
{
    static const struct {
        const char *head, *part;
        size_t count;
        const char *tail;
    } files[] = {
        {"", "[", 1000000, ""},
        {"", "{", 1000000, ""},
        {"", "{a: ", 250000, ""},
        {"", "- ", 500000, ""},
        {"", "? ", 500000, ""},
        {"", "a: [", 250000, ""},
        {"", "#", 1000000, ""},
        {"", "\n", 1000000, ""},
        {"", " ", 1000000, ""},
        {"", "x", 1000000, ""},
        {"axes: [{name: \"", "x", 1000000, "\"}]"},
        {"axes: [{name: '", "\n", 1000000, "'}]"},
        {"axes: [{name: |\n", "   x\n", 200000, "\n}]"},
        {"axes: [", "{}, ", 250000, "]"},
        {"axes: [", "a, ", 300000, "]"},
        {"axes: [{", "a: 1, ", 150000, "}]"},
        {"axes: [{", "name: x, ", 100000, "}]"},
        {"axes: [{}]\n", "---\n", 250000, ""},
        {"axes: [{}]\n", "a: b\n", 200000, ""},
        {"axes: [{position: ", "1", 1000000, "}]"},
        {"axes: [{unit: {counts_per_unit: ", "9", 1000000, "}}]"},
        {"axes: [{unit: {counts_per_unit: 0.", "0", 1000000, "1}}]"},
        {"", "axes: [{}]\n", 100000, ""}, /* beyond the size */
        {"", "%YAML 1.1\n", 100000, ""},
        {"", "\xef\xbb\xbf", 300000, ""},
        {"", "\"", 1000001, ""},
        {"", "&a ", 300000, ""},
        {"", "!a ", 300000, ""},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        write_repeated(files[i].head, files[i].part, files[i].count, files[i].tail);
        const double start = seconds();
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_CONFIG, load(), files[i].part);
        const double took = seconds() - start;
        if (took > 5) {
            char text[80];
            snprintf(text, sizeof text, "'%.20s' took %.1f s", files[i].part, took);
            TEST_FAIL_MESSAGE(text);
        }
    }
}

static void test_file_that_is_none_is_told(void)
{
    static const struct {
        const char *path;
        cm1e_error_t error;
    } paths[] = {
        {CM1E_TEST_OUTPUT "/no_such_file.yaml", CM1E_ERROR_NOT_FOUND},
        {CM1E_TEST_OUTPUT "/no_such_directory/file.yaml", CM1E_ERROR_NOT_FOUND},
        {"", CM1E_ERROR_NOT_FOUND},
        {CM1E_TEST_OUTPUT, CM1E_ERROR_IO},
        {"/dev/zero", CM1E_ERROR_IO},
        {"/dev/null", CM1E_ERROR_IO},
    };
    for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++) {
        loaded = false;
        memset(&config, 0x5A, sizeof config);
        TEST_ASSERT_EQUAL_MESSAGE(paths[i].error, cm1e_bus_config_load(&config, paths[i].path, &diag), paths[i].path);
        TEST_ASSERT_EQUAL_MEMORY(&untouched, &config, sizeof config);
        const size_t length = strlen(paths[i].path), cut = length > 160 ? length - 160 : 0;
        TEST_ASSERT_TRUE_MESSAGE(strstr(diag.text, paths[i].path + cut) == diag.text + (cut ? 3 : 0), diag.text);
    }
}

static void test_fifo_without_a_writer_does_not_hang(void)
{
    static const char fifo[] = CM1E_TEST_OUTPUT "/busfile_fifo";
    unlink(fifo);
    TEST_ASSERT_EQUAL(0, mkfifo(fifo, 0600));
    TEST_ASSERT_EQUAL(CM1E_ERROR_IO, cm1e_bus_config_load(&config, fifo, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "not a regular file"));
    unlink(fifo);
}

static void test_long_path_leaves_room_for_the_text(void)
{
    char path[3000];
    memset(path, 'p', sizeof path - 1);
    path[sizeof path - 1] = '\0';
    TEST_ASSERT_NOT_EQUAL(CM1E_OK, cm1e_bus_config_load(&config, path, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "cannot be read"));
    TEST_ASSERT_EQUAL_STRING_LEN("...ppp", diag.text, 6);
}

static void test_no_arguments_and_no_diagnosis_are_survived(void)
{
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_bus_config_load(NULL, temporary, &diag));
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_bus_config_load(&config, NULL, &diag));
    TEST_ASSERT_EQUAL(CM1E_ERROR_NOT_FOUND, cm1e_bus_config_load(&config, "/no/such/file", NULL));
}

/* ---- random damage ----------------------------------------------------------------------------------------------- */

static uint64_t seed;

static uint32_t random_below(uint32_t bound)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(seed >> 33) % bound;
}

static void test_damaged_files_load_or_are_refused(void)
{
    enum { ROUNDS = 3000, MAX = 1 << 14 };
    static char original[MAX], text[MAX + 64];
    static const char bytes[] = "{}[]:,-&*!|>'\"%@`#? \n\t\r~0123456789.eE+xyz\\\x80\xff\xc3\x01";
    FILE *file = fopen(CM1E_SOURCE_DIR "/docs/BUS-FILE.md", "rb");
    TEST_ASSERT_NOT_NULL(file);
    original[fread(original, 1, MAX - 1, file)] = '\0';
    fclose(file);
    char *begin = strstr(original, "```yaml\n") + 8;
    const size_t length = (size_t)(strstr(begin, "```") - begin);
    const char *given = getenv("CM1E_TEST_SEED");
    const uint64_t start = given ? strtoull(given, NULL, 0) : (uint64_t)time(NULL);
    printf("seed %llu (CM1E_TEST_SEED=)\n", (unsigned long long)start);
    seed = start;
    int refused = 0;
    for (int round = 0; round < ROUNDS; round++) {
        size_t size = length;
        memcpy(text, begin, length);
        for (uint32_t damage = random_below(4); damage < 4; damage++) {
            const size_t at = random_below((uint32_t)size);
            switch (random_below(4)) {
            case 0: text[at] = bytes[random_below(sizeof bytes)]; break;
            case 1: text[at] = (char)random_below(256); break;
            case 2: size = at + 1; break;
            default:
                memmove(text + at + 1, text + at, size - at);
                text[at] = bytes[random_below(sizeof bytes)];
                size++;
                break;
            }
        }
        write_file(text, size);
        const cm1e_error_t error = load();
        TEST_ASSERT_TRUE(error == CM1E_OK || error == CM1E_ERROR_CONFIG);
        if (error == CM1E_OK)
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_bus_config_check(&config, NULL));
        refused += error != CM1E_OK;
    }
    TEST_ASSERT_GREATER_THAN(ROUNDS / 4, refused);
}

int main(void)
{
    memset(&untouched, 0x5A, sizeof untouched);
    UNITY_BEGIN();
    RUN_TEST(test_every_broken_file_is_told_by_line_and_column);
    RUN_TEST(test_too_many_axes_are_told_at_the_first_one_too_many);
    RUN_TEST(test_huge_and_deep_files_end_in_an_error_soon);
    RUN_TEST(test_file_that_is_none_is_told);
    RUN_TEST(test_fifo_without_a_writer_does_not_hang);
    RUN_TEST(test_long_path_leaves_room_for_the_text);
    RUN_TEST(test_no_arguments_and_no_diagnosis_are_survived);
    RUN_TEST(test_damaged_files_load_or_are_refused);
    return UNITY_END();
}
