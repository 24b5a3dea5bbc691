/* ControlBus without ROS: an axis that was stopped by a fault is enabled again, also where the period of the control is
 * below the cycle of the bus; settings that cannot be meant are refused in words.
 *   again BUS-FILE */
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <string>
#include <thread>

#include "cm1e_hardware/control_bus.hpp"

using cm1e_hardware::ControlBus;

static int faults;

static void expect(bool good, const std::string & what)
{
  if (!good) {
    std::printf("%s\n", what.c_str());
    ++faults;
  }
}

static ControlBus::Settings settings_of(const char * bus_file, double period_s)
{
  ControlBus::Settings settings;
  settings.bus_file = bus_file;
  settings.interface_name = "sim";
  settings.period_s = period_s;
  settings.timeout_s = 0.5;
  settings.delay_periods = 50.0;
  settings.say = [](const std::string &) {};
  return settings;
}

static void enable_again(const char * bus_file, double period_s)
{
  ControlBus bus(settings_of(bus_file, period_s));
  for (int n = 0; n < 8; ++n) {
    expect(bus.enable(5.0), "not enabled, time " + std::to_string(n) + " at a period of " + std::to_string(period_s) + " s");
    for (int i = 0; i < 4000 && !bus.has_fault(); ++i) {  // a jump stops the axes
      bus.read();
      for (auto & joint : bus.joints()) {
        joint.command = i < 100 ? joint.command : 1e3;
      }
      bus.write(true);
      std::this_thread::sleep_for(std::chrono::duration<double>(period_s));
    }
    expect(bus.has_fault(), "a jump is a fault");
    expect(bus.disable(5.0), "the torque is off");
  }
}

static void refused(ControlBus::Settings settings, const std::string & says)
{
  try {
    ControlBus bus(settings);
    expect(false, "settings are taken: " + says);
  } catch (const std::exception & why) {
    expect(std::string(why.what()).find(says) != std::string::npos, std::string("said: ") + why.what());
  }
}

int main(int, char ** argv)
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  enable_again(argv[1], 0.0003);
  for (const double delay : {1.0, 2.9, -4.0, 101.0, 1e9, infinite, std::nan("")}) {
    auto settings = settings_of(argv[1], 0.001);
    settings.delay_periods = delay;
    refused(settings, "the delay is");
  }
  for (const double tolerance : {-1.0, infinite, std::nan("")}) {
    auto settings = settings_of(argv[1], 0.001);
    settings.tolerance = tolerance;
    refused(settings, "the tolerance is");
  }
  for (const double seconds : {-1.0, 1e30, infinite, std::nan("")}) {
    auto settings = settings_of(argv[1], 0.001);
    settings.timeout_s = seconds;
    refused(settings, "the timeout is");
    refused(settings_of(argv[1], seconds), "the period is");
  }
  return faults != 0;
}
