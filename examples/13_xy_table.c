/*
 * An XY table that moves along an outline: lines and arcs from a small CSV file, with their corners rounded so that the
 * table need not stop. Two motors are an axes group (PLCopen Part 4); each row of the file is a block of its own,
 * buffered behind the one before. `--outline FILE` draws the actual path over the commanded one.
 *
 *     13_xy_table -i sim examples/outline.csv --outline outline.svg
 */
#include <math.h>
#include <string.h>

#include "example.h"

enum { X = 0, Y, AXES, ROWS = 64, AHEAD = 16, SAMPLES = 20000 };
typedef enum step { STEP_POWER = 0, STEP_GROUP, STEP_ENABLE, STEP_DRAW, STEP_DISABLE, STEP_OFF } step_t;
static const char *const names[AXES] = {"X", "Y"};

/* mm, mm/s ... */
static const LREAL velocity = 80, acceleration = 600, jerk = 20000, rounding = 1;

typedef struct row {
    bool arc;
    MC_MoveLinearAbsolute_t line;
    MC_MoveCircularAbsolute_t curve;
} row_t;

static example_t example;
#ifndef OUTLINE /* where CMake does not say it, the root of the repository is the current folder */
#define OUTLINE "examples/outline.csv"
#endif
static const char *file_name = OUTLINE, *outline_file;
static AXIS_REF_t axes[AXES];
static AXES_GROUP_REF_t group;
static MC_Power_t power[AXES];
static MC_AddAxisToGroup_t add[AXES];
static MC_GroupEnable_t enable = {.AxesGroup = &group};
static MC_GroupDisable_t disable = {.AxesGroup = &group};
static row_t rows[ROWS];
static int row_count, rows_done;
static step_t step;
static struct { float set[AXES], actual[AXES]; } samples[SAMPLES];
static int sample_count;
static LREAL slowest = INFINITY; /* mm/s, between the first and the last row */

static void describe_network(cm1e_bus_config_t *config)
{
    for (int i = 0; i < AXES; i++) {
        cm1e_axis_config_t *axis = &config->axes[i];
        snprintf(axis->name, sizeof axis->name, "%s", names[i]);
        axis->units_per_revolution = 10; /* the lead of a spindle */
        axis->max_jerk = 20000;
        axis->software_limit_negative = -5;
        axis->software_limit_positive = 150;
        axis->sim.no_stops = true;
    }
}

/* ---- the file ---------------------------------------------------------------------------------------------------- */

static bool read_row(const char *text, row_t *row)
{
    char kind[8];
    LREAL x, y, via_x, via_y;
    const int count = sscanf(text, " %7[a-z] , %lf , %lf , %lf , %lf", kind, &x, &y, &via_x, &via_y);
    if (count == 3 && strcmp(kind, "line") == 0) {
        row->line = (MC_MoveLinearAbsolute_t){
            .AxesGroup = &group, .Position = {x, y}, .Velocity = velocity, .Acceleration = acceleration, .Jerk = jerk,
            .BufferMode = mcBlendingPrevious, .TransitionMode = mcTMMaxCornerDeviation,
            .TransitionParameter = rounding,
        };
        return true;
    }
    if (count != 5 || strcmp(kind, "arc") != 0)
        return false;
    row->arc = true;
    row->curve = (MC_MoveCircularAbsolute_t){
        .AxesGroup = &group, .CircMode = mcBorder, .AuxPoint = {via_x, via_y}, .EndPoint = {x, y},
        .Velocity = velocity, .Acceleration = acceleration, .Jerk = jerk, .BufferMode = mcBlendingPrevious,
        .TransitionMode = mcTMMaxCornerDeviation, .TransitionParameter = rounding,
    };
    return true;
}

static cm1e_error_t read_file(cm1e_diag_t *why)
{
    char text[200];
    FILE *file = fopen(file_name, "r");
    if (!file)
        return cm1e_diag_set(why, CM1E_ERROR_IO, 0, "%s cannot be read.", file_name);
    cm1e_error_t error = CM1E_OK;
    for (int number = 1; error == CM1E_OK && fgets(text, sizeof text, file); number++) {
        if (text[strspn(text, " \t\r\n")] == '\0' || text[0] == '#')
            continue;
        if (row_count == ROWS || !read_row(text, &rows[row_count]))
            error = cm1e_diag_set(why, CM1E_ERROR_FILE, 0, "%s:%d: not \"line, x, y\" or \"arc, x, y, x, y\" with "
                                  "numbers in mm, or more than %d of them.", file_name, number, ROWS);
        row_count++;
    }
    fclose(file);
    return error;
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

static BOOL row_is_done(const row_t *row) { return row->arc ? row->curve.Done : row->line.Done; }

/* A few rows are given ahead of the active one, so that the look-ahead knows where to slow down. */
static void call_rows(void)
{
    for (int i = 0; i < row_count; i++) {
        row_t *row = &rows[i];
        row->line.Execute = row->curve.Execute = step == STEP_DRAW && i < rows_done + AHEAD;
        if (row->arc)
            MC_MoveCircularAbsolute(&row->curve);
        else
            MC_MoveLinearAbsolute(&row->line);
    }
    while (rows_done < row_count && row_is_done(&rows[rows_done]))
        rows_done++;
}

static void call_blocks(void)
{
    for (int i = 0; i < AXES; i++) {
        power[i].Enable = step < STEP_OFF;
        MC_Power(&power[i]);
        add[i].Execute = step >= STEP_GROUP;
        MC_AddAxisToGroup(&add[i]);
    }
    enable.Execute = step >= STEP_ENABLE;
    MC_GroupEnable(&enable);
    call_rows();
    disable.Execute = step == STEP_DISABLE;
    MC_GroupDisable(&disable);
}

static void record(void)
{
    cm1e_group_info_t now;
    if (step != STEP_DRAW || sample_count == SAMPLES)
        return;
    for (int i = 0; i < AXES; i++) {
        cm1e_axis_info_t axis;
        cm1e_axis_read(axes[i], &axis);
        samples[sample_count].set[i] = (float)axis.set_position;
        samples[sample_count].actual[i] = (float)axis.actual_position;
    }
    sample_count++;
    cm1e_group_read(group, &now);
    if (rows_done > 0 && rows_done < row_count - 1)
        slowest = fmin(slowest, now.path_velocity);
}

static void watch(void)
{
    bool failed = example_failed(&example, axes[X], enable.Error, enable.ErrorID);
    for (int i = 0; i < AXES; i++)
        failed = example_failed(&example, axes[i], power[i].Error, power[i].ErrorID) ||
                 example_failed(&example, axes[i], add[i].Error, add[i].ErrorID) || failed;
    for (int i = 0; i < row_count; i++)
        failed = example_failed(&example, axes[X], rows[i].line.Error, rows[i].line.ErrorID) ||
                 example_failed(&example, axes[X], rows[i].curve.Error, rows[i].curve.ErrorID) || failed;
    if (failed)
        step = STEP_OFF;
}

static bool step_is_done(void)
{
    switch (step) {
    case STEP_POWER: return power[X].Status && power[Y].Status;
    case STEP_GROUP: return add[X].Done && add[Y].Done;
    case STEP_ENABLE: return enable.Done;
    case STEP_DRAW: return rows_done == row_count;
    case STEP_DISABLE: return disable.Done;
    default: return !power[X].Status && !power[Y].Status;
    }
}

static void program(void *context)
{
    static const char *const marks[] = {"power", "group", "enable", "draw", "disable", "off"};
    (void)context;
    call_blocks();
    record();
    watch();
    if (step_is_done())
        step = (step_t)example_next_step(&example, marks, step, STEP_OFF);
}

/* ---- the drawing ------------------------------------------------------------------------------------------------- */

static void draw_curve(FILE *file, const char *style, bool actual)
{
    fprintf(file, "<polyline style=\"fill:none;%s\" points=\"", style);
    for (int i = 0; i < sample_count; i++) {
        const float *p = actual ? samples[i].actual : samples[i].set;
        fprintf(file, "%.3f,%.3f ", p[X], -p[Y]);
    }
    fprintf(file, "\"/>\n");
}

static cm1e_error_t draw(cm1e_diag_t *why)
{
    FILE *file = fopen(outline_file, "w");
    if (!file)
        return cm1e_diag_set(why, CM1E_ERROR_IO, 0, "%s cannot be written.", outline_file);
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-5 -75 120 80\" width=\"960\" height=\"640\">\n"
                  "<rect x=\"-5\" y=\"-75\" width=\"120\" height=\"80\" fill=\"white\"/>\n");
    draw_curve(file, "stroke:#2fa8a0;stroke-width:0.6", true);
    draw_curve(file, "stroke:#222;stroke-width:0.15", false);
    for (int i = 0; i < row_count; i++) {
        const LREAL *end = rows[i].arc ? rows[i].curve.EndPoint : rows[i].line.Position;
        fprintf(file, "<circle cx=\"%.3f\" cy=\"%.3f\" r=\"0.7\" fill=\"#d5343b\"/>\n", end[X], -end[Y]);
    }
    fprintf(file, "<text x=\"0\" y=\"3\" font-size=\"3\">mm; black: set positions, green: the motors, red: ends of the "
                  "rows of %s</text>\n</svg>\n", strrchr(file_name, '/') ? strrchr(file_name, '/') + 1 : file_name);
    const bool good = !ferror(file);
    return fclose(file) == 0 && good ? CM1E_OK : cm1e_diag_set(why, CM1E_ERROR_IO, 0, "%s: disk full?", outline_file);
}

static error_t option(int key, char *argument, struct argp_state *state)
{
    switch (key) {
    case ARGP_KEY_INIT: state->child_inputs[0] = &example; return 0;
    case 'o': outline_file = argument; return 0;
    case ARGP_KEY_ARG:
        if (state->arg_num > 0)
            argp_usage(state);
        file_name = argument;
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

int main(int argc, char **argv)
{
    static const struct argp common = {example_option_list, example_option, NULL, NULL, NULL, NULL, NULL};
    static const struct argp_child children[] = {{&common, 0, NULL, 0}, {0}};
    static const struct argp_option options[] = {
        {"outline", 'o', "FILE", 0, "draw where the table has been", 0}, {0}};
    static const struct argp argp = {options, option, "[CSV FILE]", "An XY table that goes along an outline.", children,
                                     NULL, NULL};
    cm1e_diag_t why = {0};
    example.axis_count = AXES;
    example.describe_network = describe_network;
    argp_parse(&argp, argc, argv, 0, NULL, NULL);
    cm1e_error_t error = read_file(&why);
    if (error == CM1E_OK)
        error = example_open(&example, &why);
    if (error == CM1E_OK)
        error = cm1e_group_create(&group, &(cm1e_group_config_t){.name = "table"}, &why);
    for (uint32_t i = 0; error == CM1E_OK && i < AXES; i++) {
        axes[i] = cm1e_scheduler_axis(example.scheduler, i);
        power[i] = (MC_Power_t){.Axis = &axes[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
        add[i] = (MC_AddAxisToGroup_t){.AxesGroup = &group, .Axis = &axes[i],
                                       .IdentInGroup = (MC_IDENT_IN_GROUP)(i + 1)};
    }
    if (error == CM1E_OK)
        error = example_run(&example, program, &why);
    if (error == CM1E_OK && outline_file)
        error = draw(&why);
    if (example_is_done(&example, error))
        printf("%d rows of %s; between the first and the last one never slower than %.1f mm/s\n", rows_done, file_name,
               slowest);
    if (example.error_id != 0) {
        char text[CM1E_GROUP_ERROR_TEXT_BYTES];
        cm1e_group_error_text(group, text, sizeof text);
        fprintf(stderr, "%s\n", text);
    }
    cm1e_group_destroy(group); /* before its axes */
    return example_end(&example, error, &why, true);
}
