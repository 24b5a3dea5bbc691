/*
 * A winder: a wire comes at the speed of a line (a virtual axis), the spool takes it up, and a guide lays it turn
 * beside turn. With every pair of layers the spool gets thicker, and its gear ratio smaller (MC_GearIn with
 * ContinuousUpdate), so that the surface keeps the speed of the wire. The guide follows the spool, which is the line's
 * slave and the guide's master, by a cam that goes there and back with rounded ends.
 *
 *     12_winder -i sim --svg winder.svg
 */
#include <math.h>

#include "example.h"

enum { LINE = 0, SPOOL, GUIDE, AXES, POINTS = 7, LAYERS = 8, PER_UNIT = 1000000000 };
typedef enum step { STEP_POWER = 0, STEP_SELECT, STEP_COUPLE, STEP_WIND, STEP_HALT, STEP_OFF } step_t;
static const char *const names[AXES] = {"line", "spool", "guide"};

/* mm, mm/s, turns of the spool. */
static const LREAL core = 60, wire = 2, line_velocity = 400, turns_of_layer = 8, turns_of_end = 1;

static example_t example;
static AXIS_REF_t axes[AXES];
static MC_CAM_POINT points[POINTS];
static MC_CAM_REF lay = {.Points = points, .NumberOfPoints = POINTS, .Curve = mcCamPolynomial5};
static MC_Power_t power[AXES];
static MC_CamTableSelect_t select_cam = {.Master = &axes[SPOOL], .Slave = &axes[GUIDE], .CamTable = &lay,
                                     .Periodic = TRUE};
static MC_GearIn_t gear_in = {.Master = &axes[LINE], .Slave = &axes[SPOOL], .ContinuousUpdate = TRUE,
                              .RatioDenominator = PER_UNIT, .Acceleration = 2};
static MC_CamIn_t cam_in = {.Master = &axes[SPOOL], .Slave = &axes[GUIDE], .StartMode = mcRelative};
static MC_MoveVelocity_t run_line = {.Axis = &axes[LINE], .Velocity = line_velocity, .Acceleration = 400};
static MC_Halt_t halt = {.Axis = &axes[LINE], .Deceleration = 400};
static step_t step;
static LREAL diameter = core, worst; /* mm; of the surface's speed beside the wire's, relative, where in gear */
static int layers;

static void describe_network(cm1e_bus_config_t *config)
{
    for (int i = 0; i < AXES; i++) {
        cm1e_axis_config_t *axis = &config->axes[i];
        snprintf(axis->name, sizeof axis->name, "%s", names[i]);
        axis->type = i == LINE ? CM1E_AXIS_VIRTUAL : CM1E_AXIS_MOTOR;
        axis->address = i == LINE ? 0 : (uint16_t)i;
        axis->units_per_revolution = i == LINE ? 100 : i == GUIDE ? 10 : 1; /* the spool counts turns */
        axis->sim.no_stops = i != LINE;
    }
}

/* There and back; between the ends the guide moves by the thickness of the wire in every turn. */
static void make_cam(void)
{
    const LREAL t = turns_of_layer, r = turns_of_end, s = wire * r / 2, width = wire * (t - r);
    const MC_CAM_POINT p[POINTS] = {
        {0, 0, 0, 0}, {r, s, wire, 0}, {t - r, width - s, wire, 0}, {t, width, 0, 0},
        {t + r, width - s, -wire, 0}, {2 * t - r, s, -wire, 0}, {2 * t, 0, 0, 0},
    };
    for (int i = 0; i < POINTS; i++)
        points[i] = p[i];
}

static void call_blocks(void)
{
    for (int i = 0; i < AXES; i++) {
        power[i].Enable = step < STEP_OFF;
        MC_Power(&power[i]);
    }
    select_cam.Execute = step >= STEP_SELECT;
    MC_CamTableSelect(&select_cam);
    gear_in.RatioNumerator = (DINT)lround(PER_UNIT / (M_PI * diameter)); /* turns of the spool per mm of wire */
    gear_in.Execute = step >= STEP_COUPLE;
    MC_GearIn(&gear_in);
    cam_in.CamTableID = select_cam.CamTableID;
    cam_in.Execute = step >= STEP_COUPLE;
    MC_CamIn(&cam_in);
    run_line.Execute = step >= STEP_WIND;
    halt.Execute = step >= STEP_HALT;
    MC_MoveVelocity(&run_line);
    MC_Halt(&halt);
}

static void measure(void)
{
    cm1e_axis_info_t line, spool;
    cm1e_axis_read(axes[LINE], &line);
    cm1e_axis_read(axes[SPOOL], &spool);
    const LREAL surface = M_PI * diameter * spool.set_velocity;
    if (gear_in.InGear && run_line.InVelocity)
        worst = fmax(worst, fabs(surface / line.set_velocity - 1));
    if (cam_in.EndOfProfile && step == STEP_WIND) {
        layers += 2;
        diameter += 4 * wire; /* two layers, on both sides */
    }
}

static void watch(void)
{
    bool failed = example_failed(&example, axes[GUIDE], select_cam.Error, select_cam.ErrorID) ||
                  example_failed(&example, axes[SPOOL], gear_in.Error, gear_in.ErrorID) ||
                  example_failed(&example, axes[GUIDE], cam_in.Error, cam_in.ErrorID) ||
                  example_failed(&example, axes[LINE], run_line.Error, run_line.ErrorID);
    for (int i = 0; i < AXES; i++)
        failed = example_failed(&example, axes[i], power[i].Error, power[i].ErrorID) || failed;
    if (failed)
        step = STEP_OFF;
}

static bool step_is_done(void)
{
    switch (step) {
    case STEP_POWER: return power[LINE].Status && power[SPOOL].Status && power[GUIDE].Status;
    case STEP_SELECT: return select_cam.Done;
    case STEP_COUPLE: return gear_in.InGear && cam_in.InSync;
    case STEP_WIND: return layers == LAYERS;
    case STEP_HALT: return halt.Done;
    default: return !power[SPOOL].Status && !power[GUIDE].Status;
    }
}

static void program(void *context)
{
    static const char *const marks[] = {"power", "select", "couple", "wind", "halt", "off"};
    (void)context;
    call_blocks();
    measure();
    watch();
    if (step_is_done())
        step = (step_t)example_next_step(&example, marks, step, STEP_OFF);
}

int main(int argc, char **argv)
{
    cm1e_diag_t why = {0};
    example.axis_count = AXES;
    example.describe_network = describe_network;
    make_cam();
    example_options(&example, argc, argv, "A spool that grows while it takes up a wire, and a guide that lays it.");
    cm1e_error_t error = example_open(&example, &why);
    for (uint32_t i = 0; error == CM1E_OK && i < AXES; i++) {
        axes[i] = cm1e_scheduler_axis(example.scheduler, i);
        power[i] = (MC_Power_t){.Axis = &axes[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
    }
    if (error == CM1E_OK)
        error = example_run(&example, program, &why);
    if (example_is_done(&example, error))
        printf("%d layers: from %g mm to %g mm; the surface goes with the wire within %.1e of its speed\n", layers,
               core, diameter, worst);
    return example_end(&example, error, &why, true);
}
