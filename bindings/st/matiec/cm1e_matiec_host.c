/* Makes what iec2c has translated a program for `cm1e run`: config_init__() once, config_run__() in every cycle of the
 * program's common time. Timers count the time of the scan. */
#include "iec_std_lib.h"

#include "accessor.h"
#include "POUS.h"
#include "cm1e_host.h"

void config_init__(void);
void config_run__(unsigned long tick);
extern unsigned long long common_ticktime__;
extern int64_t cm1e_scan_time(void); /* cm1e/scan_time.h, whose TIME is another one */

TIME __CURRENT_TIME;
BOOL __DEBUG;

#define AXIS(name) AXIS_REF *__GET_GLOBAL_##name(void);
CM1E_AXES
#undef AXIS
#define GROUP(name) AXES_GROUP_REF *__GET_GLOBAL_##name(void);
CM1E_GROUPS
#undef GROUP

static unsigned long tick;

static void run(void)
{
    const int64_t now = cm1e_scan_time();
    __CURRENT_TIME.tv_sec = (long)(now / 1000000000);
    __CURRENT_TIME.tv_nsec = (long)(now % 1000000000);
    config_run__(tick++);
}

static st_task_t tasks[] = {{"config", 0, CM1E_MIDDLE_PRIORITY, run}};

static void begin(void)
{
    st_variable_t *axis = cm1e_axes, *group = cm1e_groups;
    config_init__();
    tick = 0;
    tasks[0].interval_ns = (int64_t)common_ticktime__;
#define AXIS(name) (axis++)->data = __GET_GLOBAL_##name();
    CM1E_AXES
#undef AXIS
#define GROUP(name) (group++)->data = __GET_GLOBAL_##name();
    CM1E_GROUPS
#undef GROUP
    (void)axis;
    (void)group;
}

CM1E_HOST("config", begin, tasks, 1);
