// How a running instance is reached from outside: by `kadans ctl`, by browsers and viewers, by ROS 2.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/assembly/assembly.h"
#include "remote/ctl/ctl_server.h"
#include "remote/page/live_server.h"
#include "remote/ros2/ros2_bridge.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

// Sockets for `kadans ctl`, and the thread that serves them: --ctl.
struct CtlServiceOptions {
  std::string folder;  // "": the usual one
  bool wanted = true;
  std::string operators, developers;  // groups; "": the group of the process
};

class CtlService {
 public:
  // Make it before the loop. When the usual folder is in use by another instance, this one says so and runs without
  // being reachable. When a folder was named, it throws InputError instead.
  CtlService(const CtlServiceOptions& place, Instance& instance);

  void start();
  void stop() noexcept;

 private:
  std::optional<CtlSockets> sockets_;
  std::optional<CtlServer> server_;
};

// Serves a running instance to browsers and viewers: --live.
struct LiveServiceOptions {
  std::string port;  // "": not served; "0": any free port
  std::string address = "127.0.0.1";
  std::string token;               // "": a new token is made
  std::vector<std::string> hosts;  // additional names of the server

  bool wanted() const noexcept { return !port.empty(); }
  std::uint16_t port_number() const { return static_cast<std::uint16_t>(std::stoul(port)); }
};
void add_live_hosts(CLI::App& command, LiveServiceOptions& place);

// Shows a running instance on topics of ROS 2: --ros2.
struct Ros2Options {
  std::string domain;  // "": not wanted; "-1": from ROS_DOMAIN_ID
  double rate_hz = 100;
  bool commands = false;

  bool wanted() const noexcept { return !domain.empty(); }
};

// Of a simulation or a run.
struct ServiceOptions {
  CtlServiceOptions ctl;  // without the wall clock only when a folder is named
  LiveServiceOptions live;
  Ros2Options ros2;
};
void add_services(CLI::App& command, ServiceOptions& options);

// What viewers show of the assembled robot and of the further ones of its world.
ViewerSubjects viewer_subjects(const Assembly& assembly);
RobotTexts robot_texts(const Assembly& assembly);

// What clients are told of it. `records` is the folder of the records that they order.
Instance::Facts facts_of(const Assembly& assembly, std::string mode, std::filesystem::path records);

class LiveService {
 public:
  // Make it before the loop: opens the port. Throws InputError when it cannot. `pace` is that of a simulation, else
  // nullptr.
  LiveService(const LiveServiceOptions& place, Instance& instance, const Assembly& assembly, LivePace* pace = nullptr);

  // Starts the server and prints its address on stderr.
  void start(const std::vector<TimingSource>& timing);
  void stop() noexcept;

 private:
  std::unique_ptr<LiveHub> hub_;
  std::unique_ptr<LiveServer> server_;
};

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
