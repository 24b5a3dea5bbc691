/**
 * @file system.hpp
 * The axes of a cm1e bus file as a system of ros2_control: command interface position, state interfaces position,
 * velocity and effort. Parameters are in README.md.
 */
#ifndef CM1E_HARDWARE__SYSTEM_HPP_
#define CM1E_HARDWARE__SYSTEM_HPP_

#include <memory>
#include <string>
#include <vector>

#include "hardware_interface/system_interface.hpp"
#include "rclcpp_lifecycle/state.hpp"

#include "cm1e_hardware/control_bus.hpp"

namespace cm1e_hardware
{

class Cm1eSystem : public hardware_interface::SystemInterface
{
public:
  using CallbackReturn = hardware_interface::CallbackReturn;

  /** Reads the parameters and checks the interfaces of the joints. */
  CallbackReturn on_init(const hardware_interface::HardwareComponentInterfaceParams & params) override;
  /** Starts the bus: the motors have no torque yet. */
  CallbackReturn on_configure(const rclcpp_lifecycle::State & previous) override;
  CallbackReturn on_cleanup(const rclcpp_lifecycle::State & previous) override;
  CallbackReturn on_shutdown(const rclcpp_lifecycle::State & previous) override;
  CallbackReturn on_error(const rclcpp_lifecycle::State & previous) override;
  /** Enables all motors where they stand. */
  CallbackReturn on_activate(const rclcpp_lifecycle::State & previous) override;
  /** Ramps down and takes the torque. */
  CallbackReturn on_deactivate(const rclcpp_lifecycle::State & previous) override;
  hardware_interface::return_type read(const rclcpp::Time & time, const rclcpp::Duration & period) override;
  hardware_interface::return_type write(const rclcpp::Time & time, const rclcpp::Duration & period) override;

private:
  struct Names
  {
    std::string axis, position, velocity, effort;
    Joint * joint = nullptr;
    bool has_velocity = false, has_effort = false;
  };

  void close();

  ControlBus::Settings settings_;
  std::unique_ptr<ControlBus> bus_;
  std::vector<Names> names_;
  bool active_ = false;
};

}  // namespace cm1e_hardware

#endif  // CM1E_HARDWARE__SYSTEM_HPP_
