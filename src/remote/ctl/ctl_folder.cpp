
#include "ctl_folder.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <grp.h>
#include <poll.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "signal/input_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::array<mode_t, 3> modes{0666, 0660, 0600};
constexpr mode_t lock_mode = 0600;
constexpr int backlog = 64;

fs::path of_session() {
  const char* folder = std::getenv("XDG_RUNTIME_DIR");  // NOLINT(concurrency-mt-unsafe): before any thread is started
  return folder == nullptr || *folder == '\0' ? fs::path() : fs::path(folder) / "kadans";
}

fs::path of_system() { return "/run/kadans"; }

bool is_of_others(const fs::path& folder) {
  struct stat found {};
  return lstat(folder.c_str(), &found) == 0 && (!S_ISDIR(found.st_mode) || found.st_uid != getuid());
}

// In /tmp anybody can take our name before us; then a folder at home serves.
fs::path of_user() {
  const fs::path usual = "/tmp/kadans-" + std::to_string(getuid());
  const char* home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe): before any thread is started
  if (!is_of_others(usual) || home == nullptr || *home == '\0') return usual;
  return fs::path(home) / ".cache/kadans";
}

[[noreturn]] void fail_as_system(const fs::path& path, const std::string& what) {
  refuse(path, what + ": " + std::generic_category().message(errno));
}

// Nothing where the path is too long.
std::optional<sockaddr_un> address_of(const fs::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string text = path.string();
  if (text.size() >= sizeof address.sun_path) return std::nullopt;
  std::memcpy(address.sun_path, text.c_str(), text.size() + 1);
  return address;
}

// A folder of this user's or the system's.
bool is_own(const fs::path& folder) {
  struct stat found {};
  return lstat(folder.c_str(), &found) == 0 && S_ISDIR(found.st_mode) &&
         (found.st_uid == getuid() || found.st_uid == 0);
}

gid_t group_named(const std::string& name) {
  const group* found = getgrnam(name.c_str());  // NOLINT(concurrency-mt-unsafe): before any thread is started
  if (found == nullptr) refuse("there is no group '" + name + "' (getent group lists them)");
  return found->gr_gid;
}

}  // namespace

fs::path ctl_folder_for_server() {
  if (const fs::path session = of_session(); !session.empty()) return session;
  return getuid() == 0 ? of_system() : of_user();
}

std::vector<fs::path> ctl_folders_for_clients() {
  std::vector<fs::path> folders;
  if (const fs::path session = of_session(); !session.empty()) folders.push_back(session);
  if (getuid() != 0) folders.push_back(of_user());
  folders.push_back(of_system());
  return folders;
}

CtlSockets::CtlSockets(const Settings& settings) : folder_(fs::absolute(settings.folder).lexically_normal()) {
  const fs::path longest = folder_ / name(Role::develop);
  if (!address_of(longest))
    refuse(longest,
           "the path of a socket has at most " + std::to_string(sizeof(sockaddr_un::sun_path) - 1) + " characters");
  std::error_code failed;
  fs::create_directories(folder_, failed);
  if (failed) refuse(folder_, "cannot be made: " + failed.message());
  if (!is_own(folder_)) refuse(folder_, "is no folder of this user's or the system's, so no sockets are made in it");
  try {
    lock();
    listen_as(Role::read, settings.operators);
    listen_as(Role::operate, settings.operators);
    listen_as(Role::develop, settings.developers);
  } catch (...) {
    remove_all();
    throw;
  }
}

CtlSockets::~CtlSockets() { remove_all(); }

void CtlSockets::lock() {
  const fs::path file = folder_ / "lock";
  // Who may read it may lock it. The file stays when all is over: somebody may be about to lock it.
  lock_ = OwnedDescriptor(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, lock_mode));
  if (!lock_) fail_as_system(file, "cannot be opened");
  if (fchmod(lock_.number(), lock_mode) != 0) fail_as_system(file, "cannot be given its mode");
  if (flock(lock_.number(), LOCK_EX | LOCK_NB) == 0) return;
  if (errno != EWOULDBLOCK) fail_as_system(file, "cannot be locked");
  refuse(folder_, "another instance is reached here already; give this one a folder of its own: --ctl FOLDER");
}

// Nobody can connect before the socket has its owner and mode.
void CtlSockets::listen_as(Role role, const std::string& group) {
  const fs::path path = folder_ / name(role);
  const sockaddr_un address = address_of(path).value();
  listeners_[static_cast<std::size_t>(role)] =
      OwnedDescriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int socket = listener(role);
  if (socket < 0) fail_as_system(path, "no socket");
  (void)unlink(path.c_str());  // left by a dead one: the lock is ours
  if (bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    fail_as_system(path, "cannot be made");
  const mode_t mode = role == Role::develop && !group.empty() ? 0660 : modes[static_cast<std::size_t>(role)];
  if (!group.empty() && chown(path.c_str(), static_cast<uid_t>(-1), group_named(group)) != 0)
    fail_as_system(path, "cannot be given to the group " + group);
  if (chmod(path.c_str(), mode) != 0) fail_as_system(path, "cannot be given its mode");
  if (listen(socket, backlog) != 0) fail_as_system(path, "cannot be listened on");
}

void CtlSockets::remove_all() noexcept {
  for (std::size_t i = 0; i < listeners_.size(); ++i) {
    if (listeners_[i]) (void)unlink((folder_ / role_names[i]).c_str());
  }
}

namespace {

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
bool trusted(const fs::path& folder) { return folder.parent_path() != "/tmp" || is_own(folder); }

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
    refuse(denied_, std::string("the role ") + name(needed) + " is for " + owners(denied_) +
                        " (ls -l shows it, chgrp and chmod change it)");
  if (!stale_.empty()) refuse(stale_, "nobody listens: its instance died; the next one takes the place over");
  refuse("no running instance found; looked in " + looked +
         ". 'kadans run ROBOT.json' starts one; --socket FOLDER names another place");
}

bool CtlLink::connect_to(const fs::path& path) {
  const std::optional<sockaddr_un> address = address_of(path);
  if (!address) return false;
  OwnedDescriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!socket) throw std::system_error(errno, std::generic_category(), "socket");
  if (connect(socket.number(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address) == 0) {
    socket_ = std::move(socket);
    return true;
  }
  if (errno == EACCES && denied_.empty()) denied_ = path.string();
  if (errno == ECONNREFUSED && stale_.empty()) stale_ = path.string();
  return false;
}

void CtlLink::send(const std::string& line) {
  const std::string whole = line + "\n";
  for (std::size_t sent = 0; sent < whole.size();) {
    const ssize_t count = ::send(socket_.number(), whole.data() + sent, whole.size() - sent, MSG_NOSIGNAL);
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
    pollfd watched{.fd = socket_.number(), .events = POLLIN, .revents = 0};
    if (poll(&watched, 1, timeout_ms) <= 0) return std::nullopt;
    std::array<char, 16384> bytes;
    const ssize_t count = recv(socket_.number(), bytes.data(), bytes.size(), 0);
    if (count < 0 && errno == EINTR) return std::nullopt;
    if (count <= 0) refuse("the instance is gone");
    in_.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace kadans
