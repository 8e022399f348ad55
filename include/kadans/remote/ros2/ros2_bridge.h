// A running instance as nodes of ROS 2 see one, without ROS: topics of DDS with the names, types and qualities of
// service that ROS 2 uses. Published: /joint_states, /tf, /tf_static, /robot_description, /imu, /clock; taken:
// /kadans/command, answered on /kadans/command_result (text_commands.h). docs/ros2.md says what is in them.
//
// One thread of its own at low priority, beside those that Cyclone DDS starts; none runs on the control thread's CPU.
// The control thread pays one copy of its row each published sample, as for any port (instance.h).
//
// Optional: built where Cyclone DDS was found, and loaded only when a bridge is made.
#pragma once

#include <cstdint>
#include <memory>

#include "kadans/remote/instance.h"
#include "kadans/remote/live_hub.h"
#include "kadans/remote/robot_texts.h"

namespace kadans {

struct Ros2Settings {
  std::uint32_t domain = 0;  // as ROS_DOMAIN_ID
  double rate_hz = 100;
  bool commands = false;  // obeys; DDS says of nobody who he is
  int avoid_cpu = -1;     // the control thread's; -1: none
};

class Ros2Bridge {
 public:
  struct Parts {
    Instance& instance;
    InstancePort& port;
    const RobotTexts& texts;
    LivePace* pace = nullptr;  // of a simulation
  };
  // Joins the domain. Throws InputError when it cannot, or the program was built without it.
  Ros2Bridge(const Ros2Settings& settings, const Parts& parts);
  ~Ros2Bridge();  // stops
  Ros2Bridge(const Ros2Bridge&) = delete;
  Ros2Bridge& operator=(const Ros2Bridge&) = delete;

  void start() noexcept;  // the values of the run, and commands
  void stop() noexcept;   // leaves the domain

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace kadans
