// The client of ctl_server.h: finds an instance, sends lines and receives lines.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "ctl_folder.h"

namespace kadans {

class CtlLink {
 public:
  // `where` is a folder with sockets, or one socket; "": the folders of ctl_folder.h. It connects with the lowest
  // sufficient role that the system grants. Throws InputError that says where it looked and what it found.
  CtlLink(const std::filesystem::path& where, Role needed);
  ~CtlLink();
  CtlLink(const CtlLink&) = delete;
  CtlLink& operator=(const CtlLink&) = delete;

  // Throws InputError when the instance is gone.
  void send(const std::string& line);
  // Returns a line without its newline; nullopt when no line came within timeout_ms, or when a signal interrupted the
  // wait. Throws InputError when the instance is gone.
  std::optional<std::string> receive(int timeout_ms);

 private:
  bool connect_to(const std::filesystem::path& socket);

  int socket_ = -1;
  std::string in_;
  std::string denied_, stale_;  // sockets that refused: no permission; nobody listens
};

}  // namespace kadans
