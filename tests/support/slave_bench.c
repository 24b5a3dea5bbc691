#include "slave_bench.h"

call_order_t call_order;

/* What the test itself has done to an axis is not judged. */
static void adopt(void)
{
    for (int n = 0; n < axes_bench.count; n++)
        judged_axes[n].state = axes_state(n);
}

static void judge_all(void)
{
    for (judged_at = 0; judged_at < axes_bench.count; judged_at++)
        judge_cycle();
    judged_at = 0;
}

static void call_blocks(void)
{
    for (int i = 0; i < called_count; i++) {
        const int mixed = (int)((axes_bench.cycle * 7 + (unsigned)i) % (unsigned)called_count);
        call(called[call_order == ORDER_BACKWARDS ? called_count - 1 - i : call_order == ORDER_MIXED ? mixed : i]);
    }
    judged_at = 0;
}

void cycle(void)
{
    axes_inputs();
    adopt(); /* what power, faults and the bus may do is judged where it is tested */
    call_blocks();
    axes_outputs();
    judge_all();
    judged.number++;
}

void cycles(int count)
{
    while (count-- > 0)
        cycle();
}

void about(int n, int master)
{
    judged_at = n;
    judged.master = master < 0 ? (AXIS_REF_t){.Handle = 0} : axes_reference(master);
}

void made_about(int n, int master, instance_t *fb, const char *name)
{
    static const char *const masters[] = {"Master", "Master1", "Master2", NULL};
    about(n, master);
    make(fb, name);
    for (const char *const *one = masters; *one && master >= 0; one++)
        point_at(fb, *one, &judged_axes[master].reference);
    judged_at = 0;
}

void make_and_start(int n, int master, instance_t *fb, const char *name)
{
    made_about(n, master, fb, name);
    trigger(fb, true);
    cycle();
}

void expect_error(const instance_t *fb, cm1e_error_t error)
{
    MUST(fb->now.error && fb->now.error_id == cm1e_error_id(error), "%s: Error 0x%04X, 0x%04X is right", name_of(fb),
         fb->now.error_id, cm1e_error_id(error));
}

/* So many axes as axes_describe() makes them, changed by `configure` before, in Standstill; no blocks yet. */
static void slaves_begin_with(int count, void (*configure)(void))
{
    char scene[sizeof judged.scene];
    snprintf(scene, sizeof scene, "%s", judged_axes[0].scene);
    memset(judged_axes, 0, sizeof judged_axes);
    judged_at = 0;
    called_count = 0;
    call_order = ORDER_MADE;
    axes_describe(count);
    for (int n = 0; n < count; n++) {
        axes_config(n)->table_profiles = true;
        axes_config(n)->homing.method = -1;
    }
    if (configure)
        configure();
    axes_make();
    for (int n = 0; n < count; n++) {
        judged_axes[n] = (struct judged_axis){.axis = axes_axis(n), .reference = axes_reference(n),
                                              .cycle_ns = axes_bench.cycle_ns};
        snprintf(judged_axes[n].scene, sizeof judged_axes[n].scene, "%s", scene);
    }
    axes_bench.run = judged_axes[0].scene;
    begin_blocks();
    axes_enable_all();
    adopt();
}

void slaves_begin(int count) { slaves_begin_with(count, NULL); }

void turn(int n, double velocity)
{
    (void)axes_move_velocity(n, velocity);
    adopt();
}
