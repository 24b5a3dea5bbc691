/* Makes what RuSTy has compiled a program for `cm1e run`: one PROGRAM (CM1E_PROGRAM, "Main" if it is not given) in every
 * cycle. CM1E_INIT is the function that initialises the variables of a project, where the compiler wants it called. */
#include "cm1e_host.h"

#ifndef CM1E_PROGRAM
#define CM1E_PROGRAM Main
#endif
#define PASTE_(a, b) a##b
#define PASTE(a, b) PASTE_(a, b)
#define TEXT_(a) #a
#define TEXT(a) TEXT_(a)

/* A program is a function of its one instance. */
extern char PASTE(CM1E_PROGRAM, _instance)[];
void CM1E_PROGRAM(void *instance);
#ifdef CM1E_INIT
void CM1E_INIT(void);
#endif

#define AXIS(name) extern uint16_t name; /* AXIS_REF is a struct of its Handle */
#define GROUP(name) AXIS(name)
CM1E_AXES
CM1E_GROUPS
#undef AXIS
#undef GROUP

static void run(void)
{
    CM1E_PROGRAM(PASTE(CM1E_PROGRAM, _instance));
}

static void begin(void)
{
    st_variable_t *axis = cm1e_axes, *group = cm1e_groups;
#ifdef CM1E_INIT
    CM1E_INIT();
#endif
#define AXIS(name) (axis++)->data = &name;
    CM1E_AXES
#undef AXIS
#define GROUP(name) (group++)->data = &name;
    CM1E_GROUPS
#undef GROUP
    (void)axis;
    (void)group;
}

static const st_task_t tasks[] = {{TEXT(CM1E_PROGRAM), CM1E_INTERVAL_NS, CM1E_MIDDLE_PRIORITY, run}};
CM1E_HOST(TEXT(CM1E_PROGRAM), begin, tasks, 1);
