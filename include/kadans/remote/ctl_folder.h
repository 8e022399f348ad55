// Where a running instance is found: a folder with three sockets, one a role. Who may open a socket has its role, so
// ls -l shows who may do what, and chmod and chgrp change it:
//
//   read      0666          look: status, lists, values, faults, watch
//   operate   0660 GROUP    also: play, stop, switch, clear faults, emergency stop, record
//   develop   0600 [GROUP]  also: parameters, reload, console
//
// The folder is, unless somebody names one: $XDG_RUNTIME_DIR/kadans; where there is none /run/kadans for root (a
// service has it by RuntimeDirectory=kadans), /tmp/kadans-UID for others. Who looks for an instance looks in all of
// these, in this order, then in /run/kadans. A file `lock` in it is held as long as its instance lives.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kadans {

enum class Role : std::uint8_t { read, operate, develop };
inline constexpr std::array<const char*, 3> role_names{"read", "operate", "develop"};
inline const char* name(Role role) noexcept { return role_names[static_cast<std::size_t>(role)]; }

// Of a new instance; where clients look.
std::filesystem::path ctl_folder_for_server();
std::vector<std::filesystem::path> ctl_folders_for_clients();

// The three sockets of an instance.
class CtlSockets {
 public:
  struct Settings {
    std::filesystem::path folder;
    std::string operators, developers;  // groups; "" = as the process
  };
  // Makes the folder and listens. What a dead instance left is taken over. Throws InputError when the folder is another
  // instance's, is not ours, or a group is not known.
  explicit CtlSockets(const Settings& settings);
  ~CtlSockets();  // takes them away
  CtlSockets(const CtlSockets&) = delete;
  CtlSockets& operator=(const CtlSockets&) = delete;

  int listener(Role role) const noexcept { return listeners_[static_cast<std::size_t>(role)]; }
  const std::filesystem::path& folder() const noexcept { return folder_; }

 private:
  void lock();
  void listen_as(Role role, const std::string& group);
  void close_all() noexcept;

  std::filesystem::path folder_;
  int lock_ = -1;
  std::array<int, 3> listeners_{-1, -1, -1};
};

}  // namespace kadans
