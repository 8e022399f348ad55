// A client's end of ctl_server.h: finds an instance, sends lines, gets lines. It waits as long as it is told to.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "kadans/remote/ctl_folder.h"

namespace kadans {

class CtlLink {
 public:
  // `where`: a folder with sockets, or one socket; "" = where an instance may be. Takes the lowest role that suffices
  // and is granted. Throws InputError that says where it looked and what it found.
  CtlLink(const std::filesystem::path& where, Role needed);
  ~CtlLink();
  CtlLink(const CtlLink&) = delete;
  CtlLink& operator=(const CtlLink&) = delete;

  // Throws InputError when the instance is gone.
  void send(const std::string& line);
  // A line without its end; nothing: none came in time, or a signal did. Throws InputError when the instance is gone.
  std::optional<std::string> receive(int timeout_ms);

 private:
  bool connect_to(const std::filesystem::path& socket);

  int socket_ = -1;
  std::string in_;
  std::string denied_, stale_;  // what was found instead
};

}  // namespace kadans
