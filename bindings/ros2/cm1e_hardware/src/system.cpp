#include "cm1e_hardware/system.hpp"

#include <algorithm>
#include <exception>
#include <stdexcept>

#include "hardware_interface/types/hardware_interface_type_values.hpp"
#include "pluginlib/class_list_macros.hpp"
#include "rclcpp/rclcpp.hpp"

namespace cm1e_hardware
{

namespace
{

using hardware_interface::return_type;
constexpr double enable_s = 5.0, disable_s = 15.0;

bool has_interface(const std::vector<hardware_interface::InterfaceInfo> & list, const char * name)
{
  return std::any_of(list.begin(), list.end(), [name](const auto & one) {return one.name == name;});
}

std::string text_of(const hardware_interface::HardwareInfo & info, const char * name)
{
  const auto found = info.hardware_parameters.find(name);
  return found == info.hardware_parameters.end() ? "" : found->second;
}

double number_of(const hardware_interface::HardwareInfo & info, const char * name, double otherwise)
{
  const std::string text = text_of(info, name);
  size_t used = text.size();
  const double number = text.empty() ? otherwise : std::stod(text, &used);
  if (used != text.size()) {
    throw std::invalid_argument(name);
  }
  return number;
}

}  // namespace

Cm1eSystem::CallbackReturn Cm1eSystem::on_init(const hardware_interface::HardwareComponentInterfaceParams & params)
{
  if (SystemInterface::on_init(params) != CallbackReturn::SUCCESS) {
    return CallbackReturn::ERROR;
  }
  try {
    const double rate = info_.rw_rate ? info_.rw_rate : number_of(info_, "update_rate", 0.0);
    settings_.bus_file = text_of(info_, "bus_file");
    settings_.interface_name = text_of(info_, "interface");
    settings_.period_s = rate > 0.0 ? 1.0 / rate : 0.0;
    settings_.delay_periods = number_of(info_, "delay", 0.0);
    settings_.timeout_s = number_of(info_, "timeout_ms", 500.0) * 1e-3;
    settings_.tolerance = number_of(info_, "tolerance", 0.0);
  } catch (const std::exception &) {
    RCLCPP_FATAL(get_logger(), "a parameter of the hardware is not a number");
    return CallbackReturn::ERROR;
  }
  settings_.say = [this](const std::string & sentence) {RCLCPP_WARN(get_logger(), "%s", sentence.c_str());};
  if (settings_.bus_file.empty() || settings_.period_s == 0.0) {
    RCLCPP_FATAL(get_logger(), "the hardware needs the parameters bus_file and update_rate");
    return CallbackReturn::ERROR;
  }
  for (const auto & joint : info_.joints) {
    if (joint.command_interfaces.size() != 1 ||
      !has_interface(joint.command_interfaces, hardware_interface::HW_IF_POSITION) ||
      !has_interface(joint.state_interfaces, hardware_interface::HW_IF_POSITION))
    {
      RCLCPP_FATAL(get_logger(), "joint %s needs position as its only command interface, and as a state interface",
        joint.name.c_str());
      return CallbackReturn::ERROR;
    }
    const auto axis = joint.parameters.find("axis");
    Names names;
    names.axis = axis == joint.parameters.end() ? joint.name : axis->second;
    names.position = joint.name + "/" + hardware_interface::HW_IF_POSITION;
    names.velocity = joint.name + "/" + hardware_interface::HW_IF_VELOCITY;
    names.effort = joint.name + "/" + hardware_interface::HW_IF_EFFORT;
    names.has_velocity = has_interface(joint.state_interfaces, hardware_interface::HW_IF_VELOCITY);
    names.has_effort = has_interface(joint.state_interfaces, hardware_interface::HW_IF_EFFORT);
    names_.push_back(names);
  }
  return CallbackReturn::SUCCESS;
}

Cm1eSystem::CallbackReturn Cm1eSystem::on_configure(const rclcpp_lifecycle::State &)
{
  try {
    bus_ = std::make_unique<ControlBus>(settings_);
  } catch (const std::exception & why) {
    RCLCPP_ERROR(get_logger(), "%s", why.what());
    return CallbackReturn::ERROR;
  }
  for (Names & names : names_) {
    names.joint = bus_->find(names.axis);
    if (!names.joint) {
      RCLCPP_ERROR(get_logger(), "the bus file has no axis %s", names.axis.c_str());
      close();
      return CallbackReturn::ERROR;
    }
  }
  return CallbackReturn::SUCCESS;
}

void Cm1eSystem::close()
{
  active_ = false;
  for (Names & names : names_) {
    names.joint = nullptr;
  }
  bus_.reset();
}

Cm1eSystem::CallbackReturn Cm1eSystem::on_cleanup(const rclcpp_lifecycle::State &)
{
  close();
  return CallbackReturn::SUCCESS;
}

Cm1eSystem::CallbackReturn Cm1eSystem::on_shutdown(const rclcpp_lifecycle::State &)
{
  close();
  return CallbackReturn::SUCCESS;
}

Cm1eSystem::CallbackReturn Cm1eSystem::on_error(const rclcpp_lifecycle::State &)
{
  close();
  return CallbackReturn::SUCCESS;
}

Cm1eSystem::CallbackReturn Cm1eSystem::on_activate(const rclcpp_lifecycle::State &)
{
  if (!bus_->enable(enable_s)) {
    RCLCPP_ERROR(get_logger(), "not all axes were enabled");
    (void)bus_->disable(disable_s);
    return CallbackReturn::ERROR;
  }
  for (const Names & names : names_) {  // the controllers begin where the motors stand
    set_state(names.position, names.joint->position);
    set_command(names.position, names.joint->command);
  }
  active_ = true;
  return CallbackReturn::SUCCESS;
}

Cm1eSystem::CallbackReturn Cm1eSystem::on_deactivate(const rclcpp_lifecycle::State &)
{
  active_ = false;
  return bus_->disable(disable_s) ? CallbackReturn::SUCCESS : CallbackReturn::ERROR;
}

return_type Cm1eSystem::read(const rclcpp::Time &, const rclcpp::Duration &)
{
  if (!bus_) {
    return return_type::ERROR;
  }
  if (!bus_->read()) {
    RCLCPP_ERROR(get_logger(), "%s", bus_->why());
    return return_type::ERROR;
  }
  for (const Names & names : names_) {
    set_state(names.position, names.joint->position);
    if (names.has_velocity) {
      set_state(names.velocity, names.joint->velocity);
    }
    if (names.has_effort) {
      set_state(names.effort, names.joint->effort);
    }
  }
  return active_ && bus_->has_fault() ? return_type::ERROR : return_type::OK;
}

return_type Cm1eSystem::write(const rclcpp::Time &, const rclcpp::Duration &)
{
  if (!bus_) {
    return return_type::ERROR;
  }
  for (const Names & names : names_) {
    names.joint->command = get_command<double>(names.position);
  }
  bus_->write(active_);
  return return_type::OK;
}

}  // namespace cm1e_hardware

PLUGINLIB_EXPORT_CLASS(cm1e_hardware::Cm1eSystem, hardware_interface::SystemInterface)
