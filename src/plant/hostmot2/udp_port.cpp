#include <utility>

#include <poll.h>
#include <sys/socket.h>

#include "datagram_port.h"
#include "kadans/signal/input_error.h"
#include "plant/socket_address.h"

namespace kadans::hostmot2 {

UdpPort::UdpPort(BoardSettings board) : board_(std::move(board)) {
  const std::string place = board_place(board_.address);
  try {
    descriptor_ = OwnedDescriptor(connected_socket(place));
  } catch (const InputError& error) {
    const std::string why = why_silent();
    throw InputError(board_.place.with(
        "board '" + board_.name + "' cannot be reached: " + (why.empty() ? error.problems().front().message : why)));
  }
}

std::string UdpPort::why_silent() const {
  const PlantType::Finding card = examine_card(board_);
  return card.good ? "" : card.is + ": " + card.how;
}

bool UdpPort::send(Octets datagram) noexcept {
  return ::sendto(descriptor_.number(), datagram.data(), datagram.size(), MSG_DONTWAIT | MSG_NOSIGNAL, nullptr, 0) ==
         static_cast<ssize_t>(datagram.size());
}

std::size_t UdpPort::receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept {
  for (;;) {
    const ssize_t got =
        ::recvfrom(descriptor_.number(), into.data(), into.size(), MSG_DONTWAIT | MSG_TRUNC, nullptr, nullptr);
    if (got > 0) return static_cast<std::size_t>(got);
    // None, an empty one, or the news that nobody listens there.
    if (now_ns() >= until_ns) return 0;
  }
}

void UdpPort::await(std::int64_t until_ns) noexcept {
  const std::int64_t left_ms = (until_ns - now_ns()) / 1'000'000;
  pollfd wanted{descriptor_.number(), POLLIN, 0};
  if (left_ms > 0) (void)poll(&wanted, 1, static_cast<int>(left_ms));
}

}  // namespace kadans::hostmot2
