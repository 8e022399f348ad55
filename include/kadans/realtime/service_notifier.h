// Tells systemd how the service is (sd_notify): ready, what it does, that it lives, that it stops.
//
// The protocol is one datagram of KEY=VALUE lines to the socket that NOTIFY_SOCKET names, promised stable by systemd;
// so libsystemd, five times the size of what it would do here, is left out. Without the variable nothing happens.
//
// WATCHDOG=1 goes out only when the control tick has advanced since the last time: a control thread that hangs gets the
// service restarted, whatever the others still do. One owner, the supervisor's thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kadans {

class ServiceNotifier {
 public:
  // `socket`: NOTIFY_SOCKET's value, "" for none; "@" begins an abstract name.
  explicit ServiceNotifier(const std::string& socket);
  ~ServiceNotifier();
  ServiceNotifier(const ServiceNotifier&) = delete;
  ServiceNotifier& operator=(const ServiceNotifier&) = delete;

  bool connected() const noexcept { return file_ >= 0; }
  void ready(std::string_view status);
  void stopping();
  // Often enough: twice a watchdog period. `tick` is the control engine's.
  void alive(std::uint64_t tick);

 private:
  void send(std::string_view text) noexcept;

  int file_ = -1;
  std::uint64_t last_tick_ = 0;
};

}  // namespace kadans
