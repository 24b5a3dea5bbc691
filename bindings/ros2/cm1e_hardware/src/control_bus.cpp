#include "cm1e_hardware/control_bus.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace cm1e_hardware
{

namespace
{

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds least_stale{50};  // as in the component for LinuxCNC
constexpr int stale_periods = 3;

Clock::duration duration_of(double period_s)
{
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_s > 0.0 ? period_s : 1e-3));
}

std::string lower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) {return std::tolower(c);});
  return text;
}

void say(void * context, const char * sentence)
{
  (*static_cast<std::function<void(const std::string &)> *>(context))(sentence);
}

int64_t nanoseconds(const char * what, double seconds)
{
  if (!(seconds >= 0.0 && seconds <= 1e6)) {
    throw std::runtime_error(std::string("the ") + what + " is " + std::to_string(seconds) + " s; 0 ... 1000000 s are right.");
  }
  return static_cast<int64_t>(std::llround(seconds * 1e9));
}

}  // namespace

ControlBus::ControlBus(const Settings & settings)
: settings_(settings)
{
  char why[1024] = "";
  stream_host_config_t config{};
  config.bus_file = settings_.bus_file.c_str();
  config.interface_name = settings_.interface_name.c_str();
  config.period_ns = nanoseconds("period", settings_.period_s);
  config.delay_periods = settings_.delay_periods;
  config.timeout_ns = nanoseconds("timeout", settings_.timeout_s);
  config.tolerance = settings_.tolerance;
  config.say = settings_.say ? say : nullptr;
  config.context = &settings_.say;
  host_.reset(stream_host_open(&config, why, sizeof why));
  if (!host_) {
    throw std::runtime_error(why);
  }
  for (uint32_t i = 0; i < stream_host_axis_count(host_.get()); ++i) {
    Joint joint;
    joint.name = stream_host_axis_name(host_.get(), i);
    joints_.push_back(joint);
  }
}

ControlBus::~ControlBus() = default;

Joint * ControlBus::find(const std::string & name)
{
  const std::string wanted = lower(name);
  for (Joint & joint : joints_) {
    if (joint.name == wanted) {
      return &joint;
    }
  }
  return nullptr;
}

bool ControlBus::read()
{
  const auto now = Clock::now();
  const auto period = duration_of(settings_.period_s);
  // A pause of the control itself, or of the whole machine, counts as one period: the bus could not give anything in it.
  age_ += std::min<Clock::duration>(now - looked_, period);
  looked_ = now;
  if (stream_host_read(host_.get(), &state_)) {
    age_ = age_.zero();
    heard_ = true;
    for (size_t i = 0; i < joints_.size(); ++i) {
      const stream_axis_state_t & axis = state_.axes[i];
      Joint & joint = joints_[i];
      joint.position = axis.position;
      joint.velocity = axis.velocity;
      joint.effort = axis.torque;
      joint.enabled = (axis.flags & STREAM_ENABLED) != 0;
      joint.powered = (axis.flags & STREAM_POWERED) != 0;
      joint.fault = (axis.flags & STREAM_FAULT) != 0;
      joint.error = axis.error;
    }
  }
  why_ = !stream_host_runs(host_.get()) ? "the bus does not run any more" :
    heard_ && age_ >= std::max<Clock::duration>(least_stale, stale_periods * period) ?
    "the bus stands still: it gives no states any more" : "";
  return why_[0] == '\0';
}

void ControlBus::write(bool enable)
{
  command_.enable = 0;
  for (size_t i = 0; i < joints_.size(); ++i) {
    Joint & joint = joints_[i];
    if (enable) {
      command_.enable |= 1u << i;
    } else {
      joint.command = std::nan("");
    }
    if (!std::isnan(joint.command)) {
      command_.positions[i] = joint.command;
    } else if (!enable) {  // an enabled joint without a command stays at its last one
      command_.positions[i] = joint.position;
    }
  }
  stream_host_write(host_.get(), &command_);
}

bool ControlBus::has_fault() const
{
  return std::any_of(joints_.begin(), joints_.end(), [](const Joint & joint) {return joint.fault;});
}

bool ControlBus::step_until(bool enable, double seconds, const std::function<bool()> & done)
{
  const auto period = duration_of(settings_.period_s);
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  for (auto next = Clock::now(); next < end; next += period) {
    if (!read()) {
      return false;
    }
    if (done()) {
      return true;
    }
    write(enable);
    std::this_thread::sleep_until(next + period);
  }
  return false;
}

bool ControlBus::enable(double seconds)
{
  // Some periods without torque first: the commands become the positions of the motors, and a fault is acknowledged.
  int periods = 0;
  (void)step_until(false, seconds, [&periods]() {return ++periods > 20;});
  const auto heard = Clock::now() + std::chrono::milliseconds(50);  // the states before that may be older than the command
  const bool ended = step_until(true, seconds, [this, heard]() {
      if (has_fault() && Clock::now() > heard) {
        return true;
      }
      return std::all_of(joints_.begin(), joints_.end(), [](const Joint & joint) {return joint.enabled;});
    });
  for (size_t i = 0; i < joints_.size(); ++i) {
    joints_[i].command = command_.positions[i];
  }
  return ended && !has_fault();
}

bool ControlBus::disable(double seconds)
{
  return step_until(false, seconds, [this]() {
      return std::none_of(joints_.begin(), joints_.end(), [](const Joint & joint) {return joint.powered;});
    });
}

}  // namespace cm1e_hardware
