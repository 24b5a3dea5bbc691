#include "busfile/busfile.h"
#include "device/bridge_facts.h"

/* The keys of a bus file; docs/BUS-FILE.md explains them. A group of keys (limits, homing ...) is no structure of its
 * own in the configuration, so its fields are offsets in the whole axis. */

#define COUNT_OF(array) ((uint32_t)(sizeof(array) / sizeof(array)[0]))
#define OPTIONAL (CYAML_FLAG_OPTIONAL | CYAML_FLAG_STRICT)
#define BUS_STRING(key, member) CYAML_FIELD_STRING(key, OPTIONAL, cm1e_busfile_t, member, 1)
#define BUS_UINT(key, member) CYAML_FIELD_UINT(key, OPTIONAL, cm1e_busfile_t, member)
#define BUS_BOOL(key, member) CYAML_FIELD_BOOL(key, OPTIONAL, cm1e_busfile_t, member)
#define AXIS_STRING(key, member) CYAML_FIELD_STRING(key, OPTIONAL, cm1e_busfile_axis_t, axis.member, 1)
#define FILE_STRING(key, member) CYAML_FIELD_STRING(key, OPTIONAL, cm1e_busfile_axis_t, member, 1)
#define AXIS_FLOAT(key, member) CYAML_FIELD_FLOAT(key, OPTIONAL, cm1e_busfile_axis_t, axis.member)
#define AXIS_UINT(key, member) CYAML_FIELD_UINT(key, OPTIONAL, cm1e_busfile_axis_t, axis.member)
#define AXIS_BOOL(key, member) CYAML_FIELD_BOOL(key, OPTIONAL, cm1e_busfile_axis_t, axis.member)
#define ENUM_OF(key, structure, member, strings)                                                                    \
    CYAML_FIELD_ENUM(key, OPTIONAL, structure, member, strings, COUNT_OF(strings))
#define GROUP(key_, structure, fields_)                                                                             \
    {.key = (key_), .data_offset = 0, .value = {CYAML_VALUE_MAPPING(CYAML_FLAG_OPTIONAL, structure, fields_)}}
/* A list of entries of one kind, each required to be there. */
#define LIST_OF(key, structure, member, count, entry)                                                               \
    CYAML_FIELD_SEQUENCE_COUNT(key, OPTIONAL, structure, member, count, entry, 1, COUNT_OF(((structure *)0)->member))
#define TEXT_OF(type) {CYAML_VALUE_STRING(CYAML_FLAG_DEFAULT, type, 1, sizeof(type) - 1)}
#define AXIS_GROUP(key, fields) GROUP(key, cm1e_busfile_axis_t, fields)

static const cyaml_strval_t mappings[] = {
    {"dynamic", CM1E_MAPPING_DYNAMIC},
    {"csp", CM1E_MAPPING_CSP},
    {"csv", CM1E_MAPPING_CSV},
    {"profile", CM1E_MAPPING_PROFILE},
};
static const cyaml_strval_t motions[] = {
    {"host", CM1E_MOTION_HOST},
    {"drive", CM1E_MOTION_DRIVE},
};
static const cyaml_strval_t axis_types[] = {
    {"motor", CM1E_AXIS_MOTOR},
    {"virtual", CM1E_AXIS_VIRTUAL},
    {"encoder", CM1E_AXIS_ENCODER},
};
static const cyaml_strval_t coupling_stops[] = {
    {"this_axis", CM1E_COUPLING_STOP_THIS},
    {"coupled_axes", CM1E_COUPLING_STOP_COUPLED},
    {"keep_ratio", CM1E_COUPLING_STOP_KEEP_RATIO},
};
static const cyaml_strval_t follows[] = {
    {"any", CM1E_FOLLOWS_ANY},
    {"gears", CM1E_FOLLOWS_GEARS},
    {"nothing", CM1E_FOLLOWS_NOTHING},
};
static const cyaml_strval_t pdo_orders[] = {
    {"ug_4_4", CM1E_PDO_ORDER_UG_4_4},
    {"ug_7_2", CM1E_PDO_ORDER_UG_7_2},
};
static const cyaml_strval_t gaps[] = {
    {"module", CM1E_SIM_IO_MODULE},
    {"terminal", CM1E_SIM_IO_TERMINAL},
    {"coupler", CM1E_SIM_IO_COUPLER},
};
static const cyaml_strval_t control_modes[] = {
    {"observe", CM1E_CONTROL_OBSERVE},
    {"none", CM1E_CONTROL_NONE},
    {"maintain", CM1E_CONTROL_MAINTAIN},
};
static const cyaml_strval_t velocity_units[] = {
    {"counts_per_s", CM1E_BUSFILE_VELOCITY_COUNTS_PER_S},
    {"counts_per_ms", CM1E_BUSFILE_VELOCITY_COUNTS_PER_MS},
};
static const cyaml_strval_t acceleration_units[] = {
    {"counts_per_s2", 0},
    {"kcounts_per_s2", 1},
};

static const cyaml_strval_t recoveries[] = {
    {"never", CM1E_RECOVER_NEVER},
    {"ask", CM1E_RECOVER_ASK},
    {"auto", CM1E_RECOVER_AUTO},
};

static const cyaml_schema_field_t bus_fields[] = {
    BUS_STRING("interface", config.interface_name),
    BUS_STRING("second_interface", config.second_interface),
    BUS_UINT("cycle_time_us", cycle_time_us),
    BUS_UINT("frame_timeout_us", frame_timeout_us),
    BUS_UINT("lost_cycles_limit", config.lost_cycles_limit),
    BUS_STRING("pcap_file", config.pcap_file),
    BUS_BOOL("virtual_time", config.virtual_time),
    ENUM_OF("sim_pdo_order", cm1e_busfile_t, config.sim_pdo_order, pdo_orders),
    ENUM_OF("sim_gaps", cm1e_busfile_t, config.sim_gaps, gaps),
    BUS_BOOL("distributed_clocks", config.distributed_clocks),
    BUS_BOOL("overlap", config.overlap),
    ENUM_OF("control", cm1e_busfile_t, config.control, control_modes),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t unit_fields[] = {
    AXIS_FLOAT("counts_per_unit", counts_per_unit),
    AXIS_UINT("gear_numerator", gear_numerator),
    AXIS_UINT("gear_denominator", gear_denominator),
    AXIS_FLOAT("units_per_revolution", units_per_revolution),
    AXIS_FLOAT("modulo_range", modulo_range),
    AXIS_BOOL("invert", invert),
    CYAML_FIELD_END,
};
static const cyaml_schema_field_t limit_fields[] = {
    AXIS_FLOAT("velocity", max_velocity),
    AXIS_FLOAT("acceleration", max_acceleration),
    AXIS_FLOAT("deceleration", max_deceleration),
    AXIS_FLOAT("jerk", max_jerk),
    AXIS_FLOAT("position_lag", max_position_lag),
    CYAML_FIELD_END,
};
static const cyaml_schema_field_t in_position_fields[] = {
    AXIS_FLOAT("window", in_position_window),
    AXIS_FLOAT("time_s", in_position_time_s),
    AXIS_FLOAT("timeout_s", in_position_timeout_s),
    AXIS_BOOL("done_waits", in_position_done_waits),
    CYAML_FIELD_END,
};
/* Pointers, because 0 is a valid limit and cannot mark a missing key. */
#define LIMIT(key, member) CYAML_FIELD_FLOAT_PTR(key, OPTIONAL | CYAML_FLAG_POINTER, cm1e_busfile_axis_t, member)
static const cyaml_schema_field_t software_limit_fields[] = {
    LIMIT("negative", software_limit_negative),
    LIMIT("positive", software_limit_positive),
    CYAML_FIELD_END,
};
static const cyaml_schema_field_t backlash_fields[] = {
    AXIS_FLOAT("gap", backlash),
    AXIS_FLOAT("velocity", backlash_velocity),
    CYAML_FIELD_END,
};
static const cyaml_schema_field_t wire_fields[] = {
    ENUM_OF("velocity_unit", cm1e_busfile_axis_t, velocity_unit, velocity_units),
    ENUM_OF("acceleration_unit", cm1e_busfile_axis_t, acceleration_unit, acceleration_units),
    CYAML_FIELD_END,
};
static const cyaml_schema_field_t drive_fields[] = {
    AXIS_UINT("counts_per_revolution", counts_per_revolution),
    AXIS_FLOAT("max_speed_rpm", max_speed_rpm),
    FILE_STRING("outputs_pdo", outputs_pdo),
    FILE_STRING("inputs_pdo", inputs_pdo),
    CYAML_FIELD_END,
};
static const cyaml_schema_field_t dc_fields[] = {
    AXIS_FLOAT("sync0_us", dc.sync0_us),
    AXIS_FLOAT("sync1_us", dc.sync1_us),
    AXIS_FLOAT("shift_us", dc.shift_us),
    AXIS_STRING("mode", dc.mode),
    CYAML_FIELD_END,
};
static const cyaml_schema_field_t homing_fields[] = {
    CYAML_FIELD_INT("method", OPTIONAL, cm1e_busfile_axis_t, axis.homing.method),
    AXIS_FLOAT("offset", homing.offset),
    AXIS_FLOAT("velocity", homing.velocity),
    AXIS_FLOAT("acceleration", homing.acceleration),
    AXIS_FLOAT("torque", homing.torque),
    AXIS_FLOAT("timeout_s", homing.timeout_s),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t signal_name_value = TEXT_OF(cm1e_busfile_signal_name_t);
static const cyaml_schema_field_t input_fields[] = {
    FILE_STRING("limit_positive", limit_positive),
    FILE_STRING("limit_negative", limit_negative),
    FILE_STRING("home", home),
    LIST_OF("signals", cm1e_busfile_axis_t, input_signals, input_count, &signal_name_value),
    AXIS_BOOL("limits_normally_closed", inputs.limits_normally_closed),
    AXIS_BOOL("home_normally_closed", inputs.home_normally_closed),
    CYAML_FIELD_END,
};
static const cyaml_schema_field_t output_fields[] = {
    LIST_OF("signals", cm1e_busfile_axis_t, output_signals, output_count, &signal_name_value),
    CYAML_FIELD_END,
};
static const cyaml_schema_field_t jog_fields[] = {
    AXIS_FLOAT("slow", jog_slow),
    AXIS_FLOAT("fast", jog_fast),
    CYAML_FIELD_END,
};
static const cyaml_schema_field_t sim_fields[] = {
    AXIS_FLOAT("load_inertia_kgm2", sim.load_inertia),
    AXIS_FLOAT("friction_nm", sim.friction),
    AXIS_FLOAT("viscous_friction_nms", sim.viscous_friction),
    AXIS_FLOAT("stop_negative_counts", sim.stop_negative),
    AXIS_FLOAT("stop_positive_counts", sim.stop_positive),
    AXIS_BOOL("no_stops", sim.no_stops),
    AXIS_FLOAT("sensor_input2_counts", sim.sensor_input2),
    AXIS_FLOAT("sensor_input3_counts", sim.sensor_input3),
    AXIS_BOOL("no_sensors", sim.no_sensors),
    AXIS_BOOL("absent", sim_absent),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t axis_fields[] = {
    AXIS_STRING("name", name),
    ENUM_OF("type", cm1e_busfile_axis_t, axis.type, axis_types),
    CYAML_FIELD_UINT("position", OPTIONAL, cm1e_busfile_axis_t, position),
    CYAML_FIELD_UINT("alias", OPTIONAL, cm1e_busfile_axis_t, alias),
    CYAML_FIELD_UINT("explicit_id", OPTIONAL, cm1e_busfile_axis_t, explicit_id),
    AXIS_BOOL("optional", optional),
    ENUM_OF("recover", cm1e_busfile_axis_t, axis.recover, recoveries),
    AXIS_UINT("channel", channel),
    AXIS_STRING("device", device),
    AXIS_STRING("motor", motor),
    CYAML_FIELD_UINT_PTR("k37", OPTIONAL | CYAML_FLAG_POINTER, cm1e_busfile_axis_t, k37),
    AXIS_STRING("firmware", firmware),
    ENUM_OF("mapping", cm1e_busfile_axis_t, axis.mapping, mappings),
    AXIS_BOOL("table_profiles", table_profiles),
    ENUM_OF("follows", cm1e_busfile_axis_t, axis.follows, follows),
    AXIS_UINT("cam_points", cam_points),
    ENUM_OF("coupling_stop", cm1e_busfile_axis_t, axis.coupling_stop, coupling_stops),
    AXIS_FLOAT("encoder_filter_s", encoder_filter_s),
    ENUM_OF("motion", cm1e_busfile_axis_t, axis.motion, motions),
    AXIS_GROUP("unit", unit_fields),
    AXIS_GROUP("limits", limit_fields),
    AXIS_GROUP("in_position", in_position_fields),
    AXIS_GROUP("software_limits", software_limit_fields),
    AXIS_GROUP("backlash", backlash_fields),
    AXIS_GROUP("jog", jog_fields),
    AXIS_GROUP("inputs", input_fields),
    AXIS_GROUP("outputs", output_fields),
    AXIS_STRING("encoder_signal", wiring.encoder),
    AXIS_GROUP("homing", homing_fields),
    AXIS_GROUP("drive", drive_fields),
    AXIS_GROUP("dc", dc_fields),
    AXIS_GROUP("wire", wire_fields),
    AXIS_GROUP("sim", sim_fields),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t axis_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cm1e_busfile_axis_t, axis_fields),
};

#define SLAVE_UINT(key, member) CYAML_FIELD_UINT(key, OPTIONAL, cm1e_busfile_slave_t, member)
#define SLAVE_BOOL(key, member) CYAML_FIELD_BOOL(key, OPTIONAL, cm1e_busfile_slave_t, member)
#define SLAVE_GROUP(key, fields) GROUP(key, cm1e_busfile_slave_t, fields)
#define SLAVE_STRING(key, member) CYAML_FIELD_STRING(key, OPTIONAL, cm1e_busfile_slave_t, member, 1)

static const cyaml_schema_value_t text_value = TEXT_OF(cm1e_busfile_text_t);

static const cyaml_strval_t moments[] = {
    {"safe_op", 0},
    {"op", 1},
};
static const cyaml_schema_field_t sdo_fields[] = {
    CYAML_FIELD_STRING("object", CYAML_FLAG_STRICT, cm1e_busfile_sdo_t, object, 1),
    CYAML_FIELD_STRING("type", CYAML_FLAG_STRICT, cm1e_busfile_sdo_t, type, 1),
    CYAML_FIELD_STRING("value", CYAML_FLAG_STRICT, cm1e_busfile_sdo_t, value, 1),
    ENUM_OF("before", cm1e_busfile_sdo_t, before_op, moments),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t sdo_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cm1e_busfile_sdo_t, sdo_fields),
};
static const cyaml_schema_field_t mapping_fields[] = {
    CYAML_FIELD_STRING("pdo", CYAML_FLAG_STRICT, cm1e_busfile_mapping_t, pdo, 1),
    CYAML_FIELD_SEQUENCE_COUNT("entries", CYAML_FLAG_STRICT, cm1e_busfile_mapping_t, entries, count, &text_value, 1,
                               CM1E_BUSFILE_PDO_ENTRIES),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t mapping_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cm1e_busfile_mapping_t, mapping_fields),
};
#define SIGNAL_PLACE                                                                                                \
    CYAML_FIELD_STRING("name", CYAML_FLAG_STRICT, cm1e_busfile_signal_t, name, 1),                                  \
    CYAML_FIELD_STRING("object", OPTIONAL, cm1e_busfile_signal_t, object, 1),                                       \
    CYAML_FIELD_UINT_PTR("bit", OPTIONAL | CYAML_FLAG_POINTER, cm1e_busfile_signal_t, bit),                         \
    CYAML_FIELD_UINT("bits", OPTIONAL, cm1e_busfile_signal_t, bits),                                                \
    CYAML_FIELD_STRING("type", OPTIONAL, cm1e_busfile_signal_t, type, 1)
static const cyaml_schema_field_t input_signal_fields[] = {SIGNAL_PLACE, CYAML_FIELD_END};
static const cyaml_schema_field_t output_signal_fields[] = {
    SIGNAL_PLACE,
    CYAML_FIELD_STRING("safe", OPTIONAL, cm1e_busfile_signal_t, safe, 1),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t input_signal_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cm1e_busfile_signal_t, input_signal_fields),
};
static const cyaml_schema_value_t output_signal_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cm1e_busfile_signal_t, output_signal_fields),
};

static const cyaml_strval_t sim_devices[] = {
    {"coupler", CM1E_SIM_SLAVE_COUPLER},
    {"digital", CM1E_SIM_SLAVE_DIGITAL},
    {"analog", CM1E_SIM_SLAVE_ANALOG},
    {"modular", CM1E_SIM_SLAVE_MODULAR},
    {"encoder", CM1E_SIM_SLAVE_ENCODER},
};
static const cyaml_schema_field_t sim_slave_fields[] = {
    CYAML_FIELD_ENUM("device", CYAML_FLAG_STRICT, cm1e_busfile_slave_t, slave.sim.kind, sim_devices,
                     COUNT_OF(sim_devices)),
    SLAVE_UINT("inputs", slave.sim.inputs),
    SLAVE_UINT("outputs", slave.sim.outputs),
    SLAVE_STRING("wired_to", slave.sim.wired_to),
    SLAVE_BOOL("swapped", slave.sim.swapped),
    CYAML_FIELD_FLOAT("counts_per_s", OPTIONAL, cm1e_busfile_slave_t, slave.sim.counts_per_s),
    SLAVE_BOOL("absent", slave.sim_absent),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t dc_slave_fields[] = {
    CYAML_FIELD_FLOAT("sync0_us", OPTIONAL, cm1e_busfile_slave_t, slave.dc.sync0_us),
    CYAML_FIELD_FLOAT("sync1_us", OPTIONAL, cm1e_busfile_slave_t, slave.dc.sync1_us),
    CYAML_FIELD_FLOAT("shift_us", OPTIONAL, cm1e_busfile_slave_t, slave.dc.shift_us),
    SLAVE_STRING("mode", slave.dc.mode),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t slave_fields[] = {
    SLAVE_STRING("name", slave.name),
    SLAVE_UINT("position", position),
    SLAVE_UINT("alias", alias),
    SLAVE_UINT("explicit_id", explicit_id),
    SLAVE_BOOL("optional", slave.optional),
    SLAVE_STRING("hot_connect", slave.hot_connect),
    ENUM_OF("recover", cm1e_busfile_slave_t, slave.recover, recoveries),
    SLAVE_STRING("vendor", vendor),
    SLAVE_STRING("product", product),
    SLAVE_STRING("revision", revision),
    SLAVE_STRING("esi", esi),
    SLAVE_STRING("esi_mode", esi_mode),
    SLAVE_UINT("watchdog_ms", slave.watchdog_ms),
    LIST_OF("sdo", cm1e_busfile_slave_t, sdos, sdo_count, &sdo_value),
    LIST_OF("mapping", cm1e_busfile_slave_t, mappings, mapping_count, &mapping_value),
    LIST_OF("outputs_pdos", cm1e_busfile_slave_t, outputs_pdos, outputs_pdo_count, &text_value),
    LIST_OF("inputs_pdos", cm1e_busfile_slave_t, inputs_pdos, inputs_pdo_count, &text_value),
    LIST_OF("modules", cm1e_busfile_slave_t, modules, module_count, &text_value),
    LIST_OF("outputs", cm1e_busfile_slave_t, outputs, output_count, &output_signal_value),
    LIST_OF("inputs", cm1e_busfile_slave_t, inputs, input_count, &input_signal_value),
    SLAVE_GROUP("dc", dc_slave_fields),
    SLAVE_GROUP("sim", sim_slave_fields),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t slave_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cm1e_busfile_slave_t, slave_fields),
};

#define ONE_BUS                                                                                                     \
    GROUP("bus", cm1e_busfile_t, bus_fields),                                                                       \
    CYAML_FIELD_SEQUENCE_COUNT("axes", OPTIONAL | CYAML_FLAG_POINTER, cm1e_busfile_t, axes, axis_count,             \
                               &axis_value, 1, CM1E_MAX_AXES),                                                      \
    CYAML_FIELD_SEQUENCE_COUNT("slaves", OPTIONAL | CYAML_FLAG_POINTER, cm1e_busfile_t, slaves, slave_count,        \
                               &slave_value, 1, CM1E_MAX_SLAVES)
static const cyaml_schema_field_t file_fields[] = {ONE_BUS, CYAML_FIELD_END};
const cyaml_schema_value_t cm1e_busfile_schema = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, cm1e_busfile_t, file_fields),
};

/* Each entry of `buses` has what a file of that bus alone would have, and a name. */
static const cyaml_schema_field_t entry_fields[] = {
    CYAML_FIELD_STRING("name", CYAML_FLAG_STRICT, cm1e_busfile_t, config.name, 1),
    ONE_BUS,
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t entry_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cm1e_busfile_t, entry_fields),
};
static const cyaml_schema_field_t several_fields[] = {
    CYAML_FIELD_SEQUENCE_COUNT("buses", CYAML_FLAG_STRICT | CYAML_FLAG_POINTER, cm1e_busfile_several_t, buses, count,
                               &entry_value, 1, CM1E_MAX_BUSES),
    CYAML_FIELD_END,
};
const cyaml_schema_value_t cm1e_busfile_several_schema = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, cm1e_busfile_several_t, several_fields),
};

const cm1e_busfile_integer_range_t cm1e_busfile_integer_ranges[] = {
    {"cycle_time_us", 200, 4000},
    {"frame_timeout_us", 1, 4000},
    {"lost_cycles_limit", 1, 250},
    {"position", 1, CM1E_MAX_SLAVES},
    {"alias", 1, 65535},
    {"explicit_id", 1, 254}, /* UG 4.2.3 */
    {"channel", 1, CM1E_BRIDGE_AXES},
    {"k37", 0, 99},
    {"method", -128, 37},    /* CiA 402; of a CM1-E and behind a bridge less, see its check */
    {"counts_per_revolution", 100, 1 << 30},
    {"gear_numerator", 1, 1000000}, {"gear_denominator", 1, 1000000},
    {"cam_points", CM1E_CAM_POINTS_MINIMUM, CM1E_CAM_POINTS_MAXIMUM},
    {"watchdog_ms", 1, 6000},
    {"bit", 0, 8 * 1486 - 1}, {"bits", 1, 8 * 1486}, {"inputs", 1, 8}, {"outputs", 1, 8},
    {NULL, INT32_MIN, INT32_MAX},
};

const char *const cm1e_busfile_zero_allowed[] = {"method", "offset", "negative", "positive", NULL};
