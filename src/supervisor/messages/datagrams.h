// Datagrams of the supervisor: it listens at a port and sends to some places. Nothing here ever blocks.
//
// One owner, the supervisor thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "message_channel.h"
#include "signal/owned_descriptor.h"

namespace kadans {

class Datagrams final : public MessageChannel {
 public:
  static constexpr std::size_t bytes_max = 2048;  // of a datagram; a longer one is cut off by one byte more

  // `listen`: "host:port", ":port" for every address of this machine; "": it only sends. Throws InputError that says
  // what is wrong with a place, or what the system said.
  Datagrams(const std::string& listen, const std::vector<std::string>& send_to);

  bool receive(std::int64_t now_ns, std::string_view& datagram, std::int64_t& came_ns) noexcept override;
  bool send(std::int64_t now_ns, std::string_view datagram) noexcept override;

 private:
  OwnedDescriptor listening_;
  std::vector<OwnedDescriptor> sending_;
  std::array<char, bytes_max + 1> bytes_{};
};

}  // namespace kadans
