// Shows a running instance on topics of ROS 2: --ros2.
#pragma once

#include <memory>
#include <string>

#include "app/assembly.h"
#include "remote/ros2/ros2_bridge.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct Ros2Options {
  std::string domain;  // "": not wanted; "-1": from ROS_DOMAIN_ID
  double rate_hz = 100;
  bool commands = false;

  bool wanted() const noexcept { return !domain.empty(); }
};
void add_ros2_service(CLI::App& command, Ros2Options& place);

class Ros2Service {
 public:
  // Make it before the loop: joins the domain. Throws InputError when it cannot. `pace` is that of a simulation, else
  // nullptr. `avoid_cpu` is the control thread's CPU; -1: none.
  Ros2Service(const Ros2Options& place, Instance& instance, const Assembly& assembly, LivePace* pace, int avoid_cpu);

  // Begins, and prints the domain on stderr.
  void start();
  void stop() noexcept;

 private:
  std::unique_ptr<Ros2Bridge> bridge_;
  std::uint32_t domain_ = 0;
};

}  // namespace kadans
