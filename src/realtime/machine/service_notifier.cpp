#include "service_notifier.h"

#include <cstddef>
#include <cstring>

#include <sys/socket.h>
#include <sys/un.h>

namespace kadans {

ServiceNotifier::ServiceNotifier(const std::string& socket) {
  sockaddr_un address{};
  if (socket.empty() || socket.size() >= sizeof address.sun_path) return;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, socket.data(), socket.size());
  if (socket.front() == '@') address.sun_path[0] = '\0';
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket.size());
  OwnedDescriptor file(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (file && connect(file.number(), reinterpret_cast<const sockaddr*>(&address), size) == 0) file_ = std::move(file);
}

void ServiceNotifier::send(std::string_view text) noexcept {
  if (file_) (void)!::send(file_.number(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

void ServiceNotifier::ready(std::string_view status) { send("READY=1\nSTATUS=" + std::string(status)); }

void ServiceNotifier::stopping() { send("STOPPING=1"); }

void ServiceNotifier::alive(std::uint64_t tick) {
  if (tick == last_tick_) return;
  last_tick_ = tick;
  send("WATCHDOG=1");
}

}  // namespace kadans
