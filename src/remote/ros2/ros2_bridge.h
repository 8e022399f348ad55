// Makes a running instance visible to nodes of ROS 2 without ROS itself: DDS topics with the names, types and qualities
// of service that ROS 2 uses. It publishes /joint_states, /tf, /tf_static, /robot_description, /imu and /clock. It
// takes orders on /kadans/command and answers on /kadans/command_result (text_orders.h). docs/ros2.md describes their
// contents.
//
// It has one thread of its own at low priority, beside the threads of Cyclone DDS; none of them runs on the control
// thread's CPU. The cost for the control thread is one copy of its row for each published sample, as for any port
// (instance.h).
//
// Optional: it is built when Cyclone DDS was found, and the library is loaded only when a bridge is made.
#pragma once

#include <cstdint>
#include <memory>

#include "remote/instance/instance.h"
#include "remote/instance/run_description.h"
#include "remote/page/live_hub.h"

namespace kadans {

struct Ros2Settings {
  std::uint32_t domain = 0;  // like ROS_DOMAIN_ID
  double rate_hz = 100;
  bool commands = false;  // obey commands; DDS does not authenticate senders
  int avoid_cpu = -1;     // CPU of the control thread; -1: none
};

class Ros2Bridge {
 public:
  struct Parts {
    Instance& instance;
    InstancePort& port;
    const RobotTexts& texts;
    LivePace* pace = nullptr;  // of a simulation
  };
  // Joins the domain. Throws InputError when it cannot, or when the program was built without DDS.
  Ros2Bridge(const Ros2Settings& settings, const Parts& parts);
  ~Ros2Bridge();  // stops
  Ros2Bridge(const Ros2Bridge&) = delete;
  Ros2Bridge& operator=(const Ros2Bridge&) = delete;

  void start() noexcept;  // begins to publish values and to take commands
  void stop() noexcept;   // leaves the domain

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace kadans
