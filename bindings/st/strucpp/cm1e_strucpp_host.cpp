// Makes what STruC++ has translated a program for `cm1e run`: the tasks of the configuration become tasks of the
// scheduler. CM1E_HEADER is the header that STruC++ wrote, CM1E_CONFIGURATION the class of the configuration in it,
// "Configuration_CONFIG" if it is not given. Timers count the time of the scan.
#include <new>
#include <utility>

#include <cm1e/scan_time.h>
#undef TRUE
#undef FALSE
#include CM1E_HEADER
#include "cm1e_host.h"
#include "cm1e_strucpp_checks.hpp"

#ifndef CM1E_CONFIGURATION
#define CM1E_CONFIGURATION Configuration_CONFIG
#endif

namespace {

constexpr std::size_t MOST_TASKS = 16; // as cm1e run
alignas(strucpp::CM1E_CONFIGURATION) unsigned char room[sizeof(strucpp::CM1E_CONFIGURATION)];
strucpp::CM1E_CONFIGURATION *configuration;
strucpp::TaskInstance *of_program[MOST_TASKS];
st_task_t tasks[MOST_TASKS];

// A task of the scheduler is a function without arguments.
template <std::size_t N> void run()
{
    strucpp::__CURRENT_TIME_NS = cm1e_scan_time();
    for (std::size_t i = 0; i < of_program[N]->program_count; i++)
        of_program[N]->programs[i]->run();
}

template <std::size_t... N> void give_functions(std::index_sequence<N...>)
{
    ((tasks[N].run = run<N>), ...);
}

std::uint32_t count_tasks()
{
    std::uint32_t count = 0;
    configuration = new (room) strucpp::CM1E_CONFIGURATION;
    give_functions(std::make_index_sequence<MOST_TASKS>());
    for (std::size_t r = 0; r < configuration->get_resource_count(); r++) {
        strucpp::ResourceInstance &resource = configuration->get_resources()[r];
        for (std::size_t t = 0; t < resource.task_count; t++, count++) {
            if (count == MOST_TASKS)
                return MOST_TASKS + 1; // refused by cm1e run before it looks at them
            of_program[count] = &resource.tasks[t];
            tasks[count].name = resource.tasks[t].name;
            tasks[count].interval_ns = resource.tasks[t].interval_ns;
            tasks[count].priority = static_cast<std::uint32_t>(resource.tasks[t].priority);
        }
    }
    return count;
}

void begin()
{
    st_variable_t *axis = cm1e_axes, *group = cm1e_groups;
    // Handles are variables of STruC++, which begin with their value.
#define AXIS(name) (axis++)->data = strucpp::name.value.HANDLE.raw_ptr();
    CM1E_AXES
#undef AXIS
#define GROUP(name) (group++)->data = strucpp::name.value.HANDLE.raw_ptr();
    CM1E_GROUPS
#undef GROUP
    (void)axis;
    (void)group;
}

} // namespace

CM1E_HOST("configuration", begin, tasks, count_tasks());
