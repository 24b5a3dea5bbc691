/* MC_CamIn, MC_GearIn and MC_GearInPos take over a slave at every moment of a move at its limits: on the way up, at its maximum
 * velocity, braking with a deceleration that is larger or smaller than its acceleration, before and behind standstill. The
 * cam and the master need next to nothing of its limits, and the witness of the bench sees every set-point. */
#include "unity.h"

#include "../support/axes_cam.h"
#include "../support/chance.h"

#define MOST_VELOCITY 15.0

void setUp(void) {}
void tearDown(void) { axes_end(); }

static const double limits[][2] = {{100.0, 100.0}, {50.0, 115.0}, {100.0, 60.0}, {50.0, 50.0}, {50.0, 150.0}, {100.0, 40.0}};

static void make_two(double acceleration, double deceleration)
{
    axes_describe(2);
    axes_config(SLAVE)->max_acceleration = acceleration;
    axes_config(SLAVE)->max_deceleration = deceleration;
    axes_config(SLAVE)->max_velocity = MOST_VELOCITY;
    axes_make();
    axes_enable_all();
    axes_move_velocity(MASTER, 1.0);
    axes_cycles(500);
}

static void moves_at(double target, double velocity, int when)
{
    axes_move_to(SLAVE, target, velocity);
    axes_cycles(when);
}

static void must_follow(cm1e_command_id_t id)
{
    for (int n = 0; n < 4000 && !axes_status(SLAVE, id).reached; n++)
        axes_cycles(1);
    AXES_MUST(axes_status(SLAVE, id).reached, "%s: %s", cm1e_axis_state_name(axes_state(SLAVE)), axes_text(SLAVE));
    axes_cycles(100);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
}

/* A hill of 0.1 u over 10 u of the master. */
static void check_cam(int i, double target, double velocity, int when)
{
    make_two(limits[i][0], limits[i][1]);
    const MC_CAM_ID id = select_hill(0.1, 0.0, true, true, true);
    const cm1e_axis_coupling_t coupling = by_cam(id, mcRampIn);
    moves_at(target, velocity, when);
    must_follow(cam_in(&coupling));
    axes_end();
}

static void test_a_cam_takes_over_at_every_moment(void)
{
    for (int i = 0; i < 6; i++)
        for (int when = 5; when < 600; when += sweep_stride(5, 45))
            for (int sign = -1; sign <= 1; sign += 2) {
                check_cam(i, sign * 8.0, MOST_VELOCITY, when);
                check_cam(i, sign * 2.0, 6.0, when);
            }
}

static void test_a_gear_takes_over_at_every_moment(void)
{
    for (int i = 0; i < 6; i++)
        for (int when = 5; when < 600; when += sweep_stride(5, 45))
            for (int sign = -1; sign <= 1; sign += 2) {
                make_two(limits[i][0], limits[i][1]);
                moves_at(sign * 8.0, MOST_VELOCITY, when);
                must_follow(axes_gear_in(SLAVE, MASTER, 1, 1));
                axes_end();
            }
}

/* The master goes on as it is: what is accepted is followed. The way may be refused, where the slave brakes harder than it
 * may accelerate, or the other way round. */
static void test_a_gear_in_pos_that_is_accepted_is_reached(void)
{
    int taken = 0;
    for (int run = 0; run < seed_count(2000); run++) {
        chance_seed(seed_of(run));
        const int i = pick(6), numerator = 1 + pick(3);
        const double ahead = uniform(0.05, 3.0), way = uniform(-3.0, 3.0);
        make_two(limits[i][0], limits[i][1]);
        moves_at(uniform(-8.0, 8.0), uniform(3.0, MOST_VELOCITY), pick(600));
        const cm1e_axis_coupling_t coupling = {
            .master = {{.axis = axes_reference(MASTER), .numerator = numerator, .denominator = 2}},
            .master_sync_position = set_of(MASTER) + ahead, .slave_sync_position = set_of(SLAVE) + way};
        cm1e_command_id_t id;
        const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_GEAR_IN_POS, .velocity = MOST_VELOCITY,
                                             .coupling = &coupling};
        if (cm1e_axis_start(axes_axis(SLAVE), &command, &id) == CM1E_OK) {
            must_follow(id);
            taken++;
        }
        axes_end();
    }
    printf("%d of %d taken\n", taken, seed_count(2000));
    TEST_ASSERT_TRUE(taken * 10 > seed_count(2000));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_cam_takes_over_at_every_moment);
    RUN_TEST(test_a_gear_takes_over_at_every_moment);
    RUN_TEST(test_a_gear_in_pos_that_is_accepted_is_reached);
    return UNITY_END();
}
