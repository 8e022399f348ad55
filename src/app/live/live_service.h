// Serves a running instance to browsers and viewers: --live.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/assembly.h"
#include "remote/page/live_server.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct LiveServiceOptions {
  std::string port;  // "": not served; "0": any free port
  std::string address = "127.0.0.1";
  std::string token;               // "": a new token is made
  std::vector<std::string> hosts;  // additional names of the server

  bool wanted() const noexcept { return !port.empty(); }
  std::uint16_t port_number() const { return static_cast<std::uint16_t>(std::stoul(port)); }
};
void add_live_service(CLI::App& command, LiveServiceOptions& place);
void add_live_hosts(CLI::App& command, LiveServiceOptions& place);

ViewerSubjects viewer_subjects(const RobotConfig& robot);
// The texts about the assembled robot that viewers need.
RobotTexts robot_texts(const Assembly& assembly);

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

}  // namespace kadans
