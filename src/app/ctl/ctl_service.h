// Makes a running instance reachable: its sockets and the thread that serves them.
#pragma once

#include <optional>
#include <string>

#include "remote/ctl/ctl_server.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct CtlServiceOptions {
  std::string folder;  // "": the usual one
  bool wanted = true;
  std::string operators, developers;  // groups; "": the group of the process
};
void add_ctl_service(CLI::App& command, CtlServiceOptions& place);

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

}  // namespace kadans
