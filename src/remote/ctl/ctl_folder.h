// How clients find a running instance and talk to it.
//
// An instance has a folder with three sockets, one for each role. A user who may open a
// socket has its role. So ls -l shows the rights, and chmod and chgrp change them:
//
//   read      0666          look: status, lists, values, faults, watch
//   operate   0660 GROUP    also: play, stop, switch, clear faults, emergency stop, record
//   develop   0600 [GROUP]  also: parameters, reload, console
//
// When no folder is named, it is $XDG_RUNTIME_DIR/kadans. Without this variable it is /run/kadans for root (a service
// gets it by RuntimeDirectory=kadans), and /tmp/kadans-UID for other users, or ~/.cache/kadans when another user has
// taken that name. Clients look in all of these, in this order, and then in /run/kadans. A file `lock` in the folder is
// held as long as the instance lives.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "signal/owned_descriptor.h"

namespace kadans {

enum class Role : std::uint8_t { read, operate, develop };
inline constexpr std::array<const char*, 3> role_names{"read", "operate", "develop"};
inline const char* name(Role role) noexcept { return role_names[static_cast<std::size_t>(role)]; }

// The default folder of a new instance, and the folders in which clients look.
std::filesystem::path ctl_folder_for_server();
std::vector<std::filesystem::path> ctl_folders_for_clients();

// The three sockets of an instance.
class CtlSockets {
 public:
  struct Settings {
    std::filesystem::path folder;
    std::string operators, developers;  // groups; "": the group of the process
  };
  // Makes the folder and listens. Sockets that a dead instance left are replaced. Throws InputError when the folder is
  // in use by a running instance, when it belongs neither to this user nor to root, or when a group is unknown.
  explicit CtlSockets(const Settings& settings);
  ~CtlSockets();  // removes the sockets
  CtlSockets(const CtlSockets&) = delete;
  CtlSockets& operator=(const CtlSockets&) = delete;

  int listener(Role role) const noexcept { return listeners_[static_cast<std::size_t>(role)].number(); }
  const std::filesystem::path& folder() const noexcept { return folder_; }

 private:
  void lock();
  void listen_as(Role role, const std::string& group);
  void remove_all() noexcept;

  std::filesystem::path folder_;
  OwnedDescriptor lock_;
  std::array<OwnedDescriptor, 3> listeners_;
};

// The client of ctl_server.h: finds an instance, sends lines and receives lines.
class CtlLink {
 public:
  // `where` is a folder with sockets, or one socket; "": the folders of ctl_folder.h. It connects with the lowest
  // sufficient role that the system grants. Throws InputError that says where it looked and what it found.
  CtlLink(const std::filesystem::path& where, Role needed);

  // An instance that is gone is told by the next receive(), which may have why.
  void send(const std::string& line);
  // Returns a line without its newline; nullopt when no line came within timeout_ms, or when a signal interrupted the
  // wait. Throws InputError when the instance is gone.
  std::optional<std::string> receive(int timeout_ms);

 private:
  bool connect_to(const std::filesystem::path& socket);

  OwnedDescriptor socket_;
  std::string in_;
  std::string denied_, stale_;  // sockets that refused: no permission; nobody listens
};

}  // namespace kadans
