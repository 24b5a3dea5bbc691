/*
 * A flying shear: it cuts pieces of a moving belt without stopping it. The belt is an encoder, whose counts the program
 * writes (here it computes them; in a plant they come from an encoder on the bus). The carriage follows a periodic cam,
 * a turn of which is one piece: it accelerates to the speed of the belt, moves with it while the knife cuts, and
 * returns. While the belt runs the pieces become longer: another cam takes over between two cuts. The belt changes its
 * speed meanwhile; the cuts stay where they are.
 *
 *     11_flying_shear -i sim --svg shear.svg
 */
#include <math.h>

#include "example.h"

enum { BELT = 0, CARRIAGE, AXES, CAMS = 2, POINTS = 4, CUTS_OF_EACH = 4, COUNTS_PER_MM = 100, MOST_CUTS = 16 };
typedef enum step { STEP_POWER = 0, STEP_SELECT, STEP_FOLLOW, STEP_OUT, STEP_HALT, STEP_BACK, STEP_OFF } step_t;

/* mm. The carriage accelerates to the speed of the belt on the first 100 mm, moves with it on the next 100 mm, and
 * returns on the rest. */
static const LREAL lengths[CAMS] = {400, 600}, cut_from = 100, cut_to = 200;

static example_t example;
static AXIS_REF_t belt, carriage;
static MC_CAM_POINT points[CAMS][POINTS];
static MC_CAM_REF cams[CAMS];
static MC_Power_t power = {.Axis = &carriage, .EnablePositive = TRUE, .EnableNegative = TRUE};
static MC_CamTableSelect_t selects[CAMS];
static MC_CamIn_t cam_ins[CAMS];
static MC_CamOut_t cam_out = {.Slave = &carriage};
static MC_Halt_t halt = {.Axis = &carriage};
static MC_MoveAbsolute_t back = {.Axis = &carriage, .Position = 0, .Velocity = 200};
static step_t step;
static int cam, turns;
static double belt_mm, belt_velocity;
static LREAL cuts[MOST_CUTS], worst_slip; /* mm of belt; mm/s between knife and belt */
static int cut_count;

static void describe_network(cm1e_bus_config_t *config)
{
    cm1e_axis_config_t *b = &config->axes[BELT], *c = &config->axes[CARRIAGE];
    *b = (cm1e_axis_config_t){.name = "belt", .type = CM1E_AXIS_ENCODER, .counts_per_unit = COUNTS_PER_MM};
    snprintf(c->name, sizeof c->name, "carriage");
    c->address = 1;
    c->units_per_revolution = 60; /* a toothed belt */
    c->max_jerk = 60000;
    c->software_limit_negative = -10;
    c->software_limit_positive = 250;
    c->sim.no_stops = true;
}

static void make_cam(int i)
{
    const LREAL sync = cut_from / 2; /* half of the distance of the belt meanwhile */
    const MC_CAM_POINT p[POINTS] = {
        {0, 0, 0, 0}, {cut_from, sync, 1, 0}, {cut_to, sync + cut_to - cut_from, 1, 0}, {lengths[i], 0, 0, 0},
    };
    for (int k = 0; k < POINTS; k++)
        points[i][k] = p[k];
    cams[i] = (MC_CAM_REF){.Points = points[i], .NumberOfPoints = POINTS, .Curve = mcCamPolynomial5};
    selects[i] = (MC_CamTableSelect_t){.Master = &belt, .Slave = &carriage, .CamTable = &cams[i], .Periodic = TRUE};
    cam_ins[i] = (MC_CamIn_t){.Master = &belt, .Slave = &carriage, .StartMode = mcRelative,
                              .MasterValueSource = mcActualValue, .BufferMode = i == 0 ? mcAborting : mcBuffered};
}

/* The belt of this machine: it accelerates to 150 mm/s, later to 250, and stops at the end. */
static void drive_belt(void)
{
    const double wanted = step == STEP_FOLLOW ? (turns < 2 ? 150 : 250) : 0, most = 0.1; /* mm/s, mm/s in a cycle */
    belt_velocity += fmax(-most, fmin(wanted - belt_velocity, most));
    belt_mm += belt_velocity * 0.001;
    cm1e_axis_write_encoder(belt, (uint32_t)(int64_t)llround(belt_mm * COUNTS_PER_MM), true);
}

/* The knife comes down in the middle of the motion with the belt. */
static void cut(void)
{
    static LREAL position_before;
    const LREAL knife = 100;
    cm1e_axis_info_t now;
    cm1e_axis_read(carriage, &now);
    if (position_before < knife && now.set_position >= knife && now.set_velocity > 0 && cut_count < MOST_CUTS) {
        cuts[cut_count++] = belt_mm - now.set_position;
        worst_slip = fmax(worst_slip, fabs(now.set_velocity - belt_velocity));
        cm1e_scheduler_mark(example.scheduler, "cut");
    }
    position_before = now.set_position;
}

static void call_blocks(void)
{
    power.Enable = step < STEP_OFF;
    MC_Power(&power);
    for (int i = 0; i < CAMS; i++) {
        selects[i].Execute = step >= STEP_SELECT;
        MC_CamTableSelect(&selects[i]);
        cam_ins[i].CamTableID = selects[i].CamTableID;
        cam_ins[i].Execute = step == STEP_FOLLOW && cam >= i;
        MC_CamIn(&cam_ins[i]);
    }
    cam_out.Execute = step >= STEP_OUT;
    halt.Execute = step >= STEP_HALT;
    back.Execute = step >= STEP_BACK;
    MC_CamOut(&cam_out);
    MC_Halt(&halt);
    MC_MoveAbsolute(&back);
}

static void watch(void)
{
    bool failed = example_failed(&example, carriage, power.Error, power.ErrorID) ||
                  example_failed(&example, carriage, cam_out.Error, cam_out.ErrorID) ||
                  example_failed(&example, carriage, halt.Error, halt.ErrorID) ||
                  example_failed(&example, carriage, back.Error, back.ErrorID);
    for (int i = 0; i < CAMS; i++)
        failed = example_failed(&example, carriage, selects[i].Error, selects[i].ErrorID) ||
                 example_failed(&example, carriage, cam_ins[i].Error, cam_ins[i].ErrorID) || failed;
    if (failed)
        step = STEP_OFF;
}

static void count_turns(void)
{
    if (step != STEP_FOLLOW || !(cam_ins[0].EndOfProfile || cam_ins[1].EndOfProfile))
        return;
    turns++;
    if (turns == CUTS_OF_EACH - 1) /* the other cam waits for the end of the next turn */
        cam = 1;
}

static bool step_is_done(void)
{
    switch (step) {
    case STEP_POWER: return power.Status;
    case STEP_SELECT: return selects[0].Done && selects[1].Done;
    case STEP_FOLLOW: return turns == 2 * CUTS_OF_EACH;
    case STEP_OUT: return cam_out.Done;
    case STEP_HALT: return halt.Done;
    case STEP_BACK: return back.Done;
    default: return !power.Status;
    }
}

static void program(void *context)
{
    static const char *const marks[] = {"power", "select", "follow", "out", "halt", "back", "off"};
    (void)context;
    drive_belt();
    call_blocks();
    watch();
    cut();
    count_turns();
    if (step_is_done())
        step = (step_t)example_next_step(&example, marks, step, STEP_OFF);
}

static void print_report(void)
{
    for (int i = 1; i < cut_count; i++)
        printf("piece %d: %8.3f mm\n", i, cuts[i] - cuts[i - 1]);
    printf("while it cut, the knife went with the belt within %.3f mm/s\n", worst_slip);
}

int main(int argc, char **argv)
{
    cm1e_diag_t why = {0};
    example.axis_count = AXES;
    example.describe_network = describe_network;
    for (int i = 0; i < CAMS; i++)
        make_cam(i);
    example_options(&example, argc, argv, "A flying shear: pieces of two lengths from a belt that does not stop.");
    cm1e_error_t error = example_open(&example, &why);
    if (error == CM1E_OK) {
        belt = cm1e_scheduler_axis(example.scheduler, BELT);
        carriage = cm1e_scheduler_axis(example.scheduler, CARRIAGE);
        error = example_run(&example, program, &why);
    }
    if (example_is_done(&example, error))
        print_report();
    return example_end(&example, error, &why, true);
}
