/**
 * @file control_bus.hpp
 * The axes of a cm1e bus file for a control loop in C++. It needs no ROS: system.hpp is what ROS sees of it. A control
 * loop calls write() and read() once per period; neither waits.
 */
#ifndef CM1E_HARDWARE__CONTROL_BUS_HPP_
#define CM1E_HARDWARE__CONTROL_BUS_HPP_

#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "stream_host.h"

namespace cm1e_hardware
{

/** A joint: its name in the bus file, what it shall do and what it does. u is the unit of the bus file. */
struct Joint
{
  std::string name;
  double command = std::nan("");  ///< u; not a number: it stays where it is
  double position = 0.0;          ///< u, of the motor
  double velocity = 0.0;          ///< u/s
  double effort = 0.0;            ///< % of rated torque; 0 if it is unknown
  bool enabled = false;           ///< it follows `command`
  bool powered = false;
  bool fault = false;
  int error = 0;                  ///< cm1e_error_t
};

class ControlBus
{
public:
  struct Settings
  {
    std::string bus_file;
    std::string interface_name;   ///< empty: that of the bus file
    double period_s = 0.0;        ///< of the control loop; 0: the cycle of the bus
    double delay_periods = 0.0;   ///< that the motors are behind the commands; 0: 4
    double timeout_s = 0.0;       ///< silence of the control that stops all axes; 0: 20 ms, or 10 periods
    double tolerance = 0.0;       ///< u between command and motor when it is enabled; 0: 1,000 counts
    /// Gets what happens, sentence by sentence, in a thread of its own. Empty: the standard error output.
    std::function<void(const std::string &)> say;
  };

  /** Starts the bus, and returns when it runs. Throws std::runtime_error with the reason if it does not. */
  explicit ControlBus(const Settings & settings);
  /** Ramps down, disables and stops. */
  ~ControlBus();
  ControlBus(const ControlBus &) = delete;
  ControlBus & operator=(const ControlBus &) = delete;

  std::vector<Joint> & joints() {return joints_;}
  /** The joint with this name, without regard to upper and lower case; NULL: there is none. */
  Joint * find(const std::string & name);
  /** Takes over the newest state of all joints. False: the bus does not run any more, or stands still: since its first
   *  state it has given none for 50 ms, or 3 periods of the control where these are longer. The positions are old then, and
   *  why() says which of the two it is. */
  bool read();
  /** Why read() has returned false; "" before. */
  const char * why() const {return why_;}
  /** Commands all joints for this period: all enabled, or none. */
  void write(bool enable);
  /** Calls read() and write() in the period of the control until all joints are enabled, each where it stands; then
   *  `command` of each joint is that position. False: not within `seconds`, or one has a fault. Not for a real-time
   *  thread. */
  bool enable(double seconds);
  /** Until no joint has torque. */
  bool disable(double seconds);
  bool has_fault() const;

private:
  bool step_until(bool enable, double seconds, const std::function<bool()> & done);

  Settings settings_;
  std::vector<Joint> joints_;
  stream_command_t command_{};
  stream_state_t state_{};
  std::chrono::steady_clock::time_point looked_{};  ///< of the last read()
  std::chrono::nanoseconds age_{0};                 ///< of the newest state
  bool heard_ = false;                              ///< there was one
  const char * why_ = "";
  struct Close
  {
    void operator()(stream_host_t * host) const {stream_host_close(host);}
  };
  std::unique_ptr<stream_host_t, Close> host_;
};

}  // namespace cm1e_hardware

#endif  // CM1E_HARDWARE__CONTROL_BUS_HPP_
