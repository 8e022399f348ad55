// A robot of two motors on threads and virtual time that is seen from outside: engines, behaviors, record, supervisor
// and the server of ctl; and clients of it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "realtime/live_robot.h"
#include "remote/ctl/ctl_folder.h"
#include "remote/ctl/ctl_server.h"
#include "remote/instance/behavior_side.h"
#include "remote/instance/control_side.h"
#include "remote/instance/record_side.h"
#include "supervisor/decide/supervisor.h"
#include "temporary_folder.h"

namespace kadans::remote_test {

using Json = nlohmann::json;

inline constexpr const char* hip_kp = "posture.hip.kp_Nm_per_rad";  // its value is 40 at first

// Gone with the test. Holds a project: a configuration with comments, a behavior "nod" and one that never ends, "wait".
struct Project {
  test::TemporaryFolder folder;
  std::filesystem::path root = folder.path();
  Project();
  void write(const std::string& file, const std::string& text) const;
  std::string read(const std::string& file) const;
  std::filesystem::path configuration() const { return root / "config/bench/robot.json"; }
};

struct Supervisor final : Task {
  Instance& instance;
  EngineExchange& exchange;
  Safety& safety;
  RecordSide& record;
  Supervisor(Instance& of, EngineExchange& sees, Safety& hears, RecordSide& writes)
      : instance(of), exchange(sees), safety(hears), record(writes) {}
  bool beat(const Beat&) override;
};

struct LiveInstance {
  Project project;
  LiveRobot robot;
  LineEcho echo;
  BehaviorLog log{&echo};
  ScriptHost host;
  Instance instance;
  ControlSide control_side{instance};
  RecordSide record_side{instance, control_side, {}};
  BehaviorSide behavior_side{{instance, &host, nullptr, robot.behaviors, *robot.exchange, echo, log}};
  CtlSockets sockets{{.folder = project.root / "ctl"}};
  std::unique_ptr<CtlServer> server;
  Supervisor supervisor{instance, *robot.exchange, robot.safety, record_side};
  std::unique_ptr<Wait> record_wait = robot.time.make_wait();
  TaskThread supervisor_thread{{.name = "supervisor", .period_ns = 20 * tick_ns}, supervisor, *robot.supervisor};
  TaskThread record_thread{{.name = "record", .period_ns = 20 * tick_ns}, record_side, *record_wait};

  explicit LiveInstance(const CtlServer::Settings& settings = {});
  ~LiveInstance();
  LiveInstance(const LiveInstance&) = delete;
  LiveInstance& operator=(const LiveInstance&) = delete;

  // Threads that a test wants to be dead are not started.
  void start(bool with_behaviors = true);
  std::filesystem::path socket(Role role) const { return sockets.folder() / name(role); }
  // One request over a connection of its own.
  Json ask(const Json& request, Role role = Role::develop) const;
  // Asks again until the answer is as wanted; gives up after 20 s of wall time.
  Json ask_until(const Json& request, bool (*wanted)(const Json&)) const;

 private:
  bool started_ = false, with_behaviors_ = true;
};

// A client that keeps no rules.
class RawClient {
 public:
  explicit RawClient(const std::filesystem::path& socket);
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool connected() const noexcept { return socket_ >= 0; }
  bool send(std::string_view bytes);       // false: not all of it, the other side closed
  bool send_some(std::string_view bytes);  // without waiting; false: nothing of it
  std::optional<std::string> line();       // nothing: the other side closed
  void end_of_questions() noexcept;        // half of the connection
  void close() noexcept;

 private:
  int socket_ = -1;
  std::string in_;
};

}  // namespace kadans::remote_test
