// A running instance made reachable: its sockets and the thread that serves them.
#pragma once

#include <optional>
#include <string>

#include "kadans/remote/ctl_server.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct CtlPlace {
  std::string folder;  // "" = the usual one
  bool wanted = true;
  std::string operators, developers;  // groups; "" = as the process
};
void add_ctl_place(CLI::App& command, CtlPlace& place);

class CtlService {
 public:
  // Before the loop. At the usual place there may be another instance already: this one then says so and goes on
  // unreachable. Where a folder was named it throws InputError.
  CtlService(const CtlPlace& place, Instance& instance);

  void start();
  void stop() noexcept;

 private:
  std::optional<CtlSockets> sockets_;
  std::optional<CtlServer> server_;
};

}  // namespace kadans
