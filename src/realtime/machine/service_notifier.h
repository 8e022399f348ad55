// Tells systemd the state of the service (sd_notify): ready, what it does, alive, stopping.
//
// The protocol is one datagram of KEY=VALUE lines to the socket that NOTIFY_SOCKET names; systemd promises to keep it
// stable. So libsystemd, five times the size of the code that would use it, is not needed. Without the variable nothing
// happens.
//
// WATCHDOG=1 is sent only when the control tick has advanced since the last time. So systemd restarts the service when
// the control thread hangs, whatever the other threads still do. One owner, the supervisor's thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "signal/owned_descriptor.h"

namespace kadans {

class ServiceNotifier {
 public:
  // `socket`: NOTIFY_SOCKET's value, "" for none; "@" begins an abstract name.
  explicit ServiceNotifier(const std::string& socket);

  bool connected() const noexcept { return static_cast<bool>(file_); }
  void ready(std::string_view status);
  void stopping();
  // To be called twice per watchdog period. `tick` is the control engine's.
  void alive(std::uint64_t tick);

 private:
  void send(std::string_view text) noexcept;

  OwnedDescriptor file_;
  std::uint64_t last_tick_ = 0;
};

}  // namespace kadans
