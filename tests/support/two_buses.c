#include "two_buses.h"

#include "cm1e/sim.h"

cm1e_bus_t *buses[BUSES];
cm1e_scheduler_t *scheduler;
AXIS_REF_t axes[BUSES];
cm1e_diag_t diag;

void must(cm1e_error_t error) { ck_assert_msg(error == CM1E_OK, "%s", diag.text); }

cm1e_axis_info_t see(int i)
{
    cm1e_axis_info_t info;
    cm1e_axis_read(axes[i], &info);
    return info;
}

void simulate(int bus, const char *line)
{
    char answer[200];
    ck_assert_msg(cm1e_bus_simulate(buses[bus], line, answer, sizeof answer) == CM1E_OK, "%s: %s", line, answer);
}

void open_scheduler(void)
{
    must(cm1e_scheduler_create(&scheduler, buses[A], NULL, &diag));
    must(cm1e_scheduler_add_bus(scheduler, buses[B], &diag));
    for (int i = 0; i < BUSES; i++)
        axes[i] = cm1e_scheduler_axis(scheduler, (uint32_t)i);
}

void close_all(void)
{
    cm1e_scheduler_destroy(scheduler);
    for (int i = 0; i < BUSES; i++)
        cm1e_bus_close(buses[i]);
    scheduler = NULL;
}
