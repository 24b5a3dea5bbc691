/*
 * Moves every axis of a bus file by a swing, through the class that ROS uses, and says how far it came:
 *   cm1e_try BUS-FILE [INTERFACE [WAY [SECONDS]]]
 * WAY in u is the way of the swing (default 5), SECONDS its time (default 2). The motors turn.
 */
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>

#include "cm1e_hardware/control_bus.hpp"

namespace
{

constexpr double tau = 6.283185307179586, period_s = 0.002;

int swing(cm1e_hardware::ControlBus & bus, double way, double seconds)
{
  std::vector<double> begins, farthest;
  for (const auto & joint : bus.joints()) {
    begins.push_back(joint.command);
    farthest.push_back(0.0);
  }
  const int periods = static_cast<int>(seconds / period_s), rest = 100;
  auto next = std::chrono::steady_clock::now();
  for (int n = 0; n < periods + rest; ++n) {
    const double part = std::min(static_cast<double>(n) / periods, 1.0);
    if (!bus.read() || bus.has_fault()) {
      return EXIT_FAILURE;
    }
    for (size_t i = 0; i < begins.size(); ++i) {
      auto & joint = bus.joints()[i];
      joint.command = begins[i] + way / 2.0 * (1.0 - std::cos(tau * part));
      farthest[i] = std::max(farthest[i], std::fabs(joint.position - begins[i]));
    }
    bus.write(true);
    next += std::chrono::microseconds(static_cast<int>(period_s * 1e6));
    std::this_thread::sleep_until(next);
  }
  for (size_t i = 0; i < begins.size(); ++i) {
    const auto & joint = bus.joints()[i];
    std::printf("%s: came %.3f far and ended %.3f from where it began\n", joint.name.c_str(), farthest[i],
      joint.position - begins[i]);
  }
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char ** argv)
{
  if (argc < 2) {
    std::fprintf(stderr, "cm1e_try BUS-FILE [INTERFACE [WAY [SECONDS]]]\n");
    return EXIT_FAILURE;
  }
  cm1e_hardware::ControlBus::Settings settings;
  settings.bus_file = argv[1];
  settings.interface_name = argc > 2 ? argv[2] : "";
  settings.period_s = period_s;
  settings.delay_periods = 10.0;
  settings.timeout_s = 0.5;
  try {
    cm1e_hardware::ControlBus bus(settings);
    const bool enabled = bus.enable(5.0);
    const int result = enabled ? swing(bus, argc > 3 ? std::atof(argv[3]) : 5.0, argc > 4 ? std::atof(argv[4]) : 2.0)
      : EXIT_FAILURE;
    if (!bus.disable(5.0)) {
      std::fprintf(stderr, "cm1e_try: an axis kept its torque\n");
    }
    return result;
  } catch (const std::exception & why) {
    std::fprintf(stderr, "cm1e_try: %s\n", why.what());
    return EXIT_FAILURE;
  }
}
