#include "file_watch.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include <sys/inotify.h>
#include <unistd.h>

namespace kadans {

FileWatch::FileWatch() : fd_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
  if (!fd_) throw std::runtime_error(std::string("files cannot be watched: ") + std::strerror(errno));
}

bool FileWatch::add(const std::filesystem::path& folder) {
  if (folders_.contains(folder)) return true;
  if (inotify_add_watch(fd_.number(), folder.c_str(), IN_CLOSE_WRITE | IN_MOVED_TO) < 0) return false;
  folders_.insert(folder);
  return true;
}

bool FileWatch::drain() const noexcept {
  bool any = false;
  alignas(inotify_event) char buffer[4096];
  for (ssize_t got = ::read(fd_.number(), buffer, sizeof buffer); got > 0;
       got = ::read(fd_.number(), buffer, sizeof buffer)) {
    for (ssize_t at = 0; at < got;) {
      const auto* event = reinterpret_cast<const inotify_event*>(buffer + at);
      const std::string_view name = event->len > 0 ? std::string_view(event->name) : std::string_view();
      any = any || name.ends_with(".lua") || (event->mask & IN_Q_OVERFLOW) != 0;
      at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
    }
  }
  return any;
}

bool FileWatch::poll() noexcept {
  if (drain()) return pending_ = true, false;
  const bool quiet = pending_;
  pending_ = false;
  return quiet;
}

}  // namespace kadans
