/* ControlBus without ROS: an axis that was stopped by a fault is enabled again, also where the period of the control is
 * below the cycle of the bus; a bus that stands still is told within 50 ms; settings that cannot be meant are refused in words.
 *   again BUS-FILE */
#include <dlfcn.h>

#include <atomic>
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

/* The sleep of the cycle, in place of that of the C library: it can be made to last. */
static std::atomic<bool> hold{false};
static const auto main_thread = std::this_thread::get_id();

extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec * until, timespec * rest)
{
  using function = int (*)(clockid_t, int, const timespec *, timespec *);
  static const auto real = reinterpret_cast<function>(dlsym(RTLD_NEXT, "clock_nanosleep"));
  while (hold && std::this_thread::get_id() != main_thread) {
    const timespec moment{0, 1000000};
    real(CLOCK_MONOTONIC, 0, &moment, nullptr);
  }
  return real(clock, flags, until, rest);
}

static void stands_still(const char * bus_file)
{
  using Clock = std::chrono::steady_clock;
  ControlBus bus(settings_of(bus_file, 0.001));
  expect(bus.enable(5.0), "not enabled");
  auto read_for = [&bus](int periods) {
      bool good = true;
      for (int i = 0; i < periods && good; ++i) {
        good = bus.read();
        bus.write(true);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      return good;
    };
  expect(read_for(200) && bus.why()[0] == '\0', std::string("a bus that runs: ") + bus.why());
  const auto begin = Clock::now();
  hold = true;
  const bool good = read_for(500);
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  hold = false;
  expect(!good && std::string(bus.why()).find("stands still") != std::string::npos, std::string("a bus that stands still: ") +
    bus.why());
  expect(seconds > 0.05 && seconds < 0.4, "told after " + std::to_string(seconds) + " s");
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  expect(bus.read(), "a bus that goes on is read again");
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
  stands_still(argv[1]);
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
