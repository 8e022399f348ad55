#include "ctl_link.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

#include <grp.h>
#include <poll.h>
#include <pwd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// "user root and group kadans"
std::string owners(const fs::path& path) {
  struct stat found {};
  if (lstat(path.c_str(), &found) != 0) return "others";
  const passwd* user = getpwuid(found.st_uid);    // NOLINT(concurrency-mt-unsafe): a client has one thread
  const group* members = getgrgid(found.st_gid);  // NOLINT(concurrency-mt-unsafe)
  std::string text = "user " + (user != nullptr ? std::string(user->pw_name) : std::to_string(found.st_uid));
  if ((found.st_mode & S_IRWXG) == 0) return text;
  return text + " and group " + (members != nullptr ? std::string(members->gr_name) : std::to_string(found.st_gid));
}

// In /tmp anybody can make a folder with our name.
bool trusted(const fs::path& folder) {
  if (folder.parent_path() != "/tmp") return true;
  struct stat found {};
  return lstat(folder.c_str(), &found) == 0 && S_ISDIR(found.st_mode) &&
         (found.st_uid == getuid() || found.st_uid == 0);
}

}  // namespace

CtlLink::CtlLink(const fs::path& where, Role needed) {
  const bool given = !where.empty();
  const std::vector<fs::path> folders = given ? std::vector{where} : ctl_folders_for_clients();
  std::string looked;
  for (const fs::path& folder : folders) {
    looked += (looked.empty() ? "" : ", ") + folder.string();
    std::error_code ignored;
    if (fs::is_socket(folder, ignored)) {
      if (connect_to(folder)) return;
      continue;
    }
    if (!given && fs::exists(folder, ignored) && !trusted(folder)) continue;
    for (std::size_t role = static_cast<std::size_t>(needed); role < role_names.size(); ++role) {
      if (connect_to(folder / role_names[role])) return;
    }
  }
  if (!denied_.empty())
    throw InputError({.file = denied_,
                      .message = std::string("the role ") + name(needed) + " is for " + owners(denied_) +
                                 " (ls -l shows it, chgrp and chmod change it)"});
  if (!stale_.empty())
    throw InputError(
        {.file = stale_, .message = "nobody listens: its instance died; the next one takes the place over"});
  throw InputError({.message = "no running instance found; looked in " + looked +
                               ". 'kadans run ROBOT.json' starts one; --socket FOLDER names another place"});
}

CtlLink::~CtlLink() {
  if (socket_ >= 0) close(socket_);
}

bool CtlLink::connect_to(const fs::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string text = path.string();
  if (text.size() >= sizeof address.sun_path) return false;
  std::memcpy(address.sun_path, text.c_str(), text.size() + 1);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket < 0) throw std::system_error(errno, std::generic_category(), "socket");
  if (connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    socket_ = socket;
    return true;
  }
  if (errno == EACCES && denied_.empty()) denied_ = text;
  if (errno == ECONNREFUSED && stale_.empty()) stale_ = text;
  close(socket);
  return false;
}

void CtlLink::send(const std::string& line) {
  const std::string whole = line + "\n";
  for (std::size_t sent = 0; sent < whole.size();) {
    const ssize_t count = ::send(socket_, whole.data() + sent, whole.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return;  // why, it may have said
    sent += static_cast<std::size_t>(count);
  }
}

std::optional<std::string> CtlLink::receive(int timeout_ms) {
  for (;;) {
    if (const std::size_t end = in_.find('\n'); end != std::string::npos) {
      std::string line = in_.substr(0, end);
      in_.erase(0, end + 1);
      return line;
    }
    pollfd watched{.fd = socket_, .events = POLLIN, .revents = 0};
    if (poll(&watched, 1, timeout_ms) <= 0) return std::nullopt;
    std::array<char, 16384> bytes;
    const ssize_t count = recv(socket_, bytes.data(), bytes.size(), 0);
    if (count < 0 && errno == EINTR) return std::nullopt;
    if (count <= 0) throw InputError({.message = "the instance is gone"});
    in_.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace kadans
