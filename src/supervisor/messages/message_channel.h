// The seam between messages and what carries them: datagrams of a network, or a simulated network. Supervisor thread.
#pragma once

#include <cstdint>
#include <string_view>

namespace kadans {

class MessageChannel {
 public:
  virtual ~MessageChannel() = default;
  // The next datagram that has come by now, valid until the next call, and when it came. False: none has.
  virtual bool receive(std::int64_t now_ns, std::string_view& datagram, std::int64_t& came_ns) noexcept = 0;
  // To all others; false when it was not taken.
  virtual bool send(std::int64_t now_ns, std::string_view datagram) noexcept = 0;
};

}  // namespace kadans
