#include "datagram_socket.h"

#include <cerrno>
#include <chrono>

#include <poll.h>

namespace kadans {

void DatagramSocket::wait(int milliseconds) const noexcept {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + std::chrono::milliseconds(milliseconds);
  for (int left = milliseconds; left >= 0;) {
    pollfd wanted{descriptor_.number(), POLLIN, 0};
    if (poll(&wanted, 1, left) <= 0 || (wanted.revents & POLLIN) != 0) return;
    int error = 0;  // that nobody listens there is no reason to wait less: somebody may soon
    socklen_t size = sizeof error;
    if (getsockopt(descriptor_.number(), SOL_SOCKET, SO_ERROR, &error, &size) != 0 || error == 0) return;
    left = static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count());
  }
}

std::size_t DatagramSocket::receive() noexcept {
  for (std::size_t i = 0; i < batch_max; ++i) {
    batch_->parts[i] = {batch_->bytes[i].data(), batch_->bytes[i].size()};
    msghdr& head = batch_->messages[i].msg_hdr;
    head = {};
    head.msg_name = &batch_->from[i].address;
    head.msg_namelen = sizeof batch_->from[i].address;
    head.msg_iov = &batch_->parts[i];
    head.msg_iovlen = 1;
  }
  int count = recvmmsg(descriptor_.number(), batch_->messages.data(), batch_max, MSG_DONTWAIT, nullptr);
  // The answer to something sent before (nobody listens there) is told once and stands before what came.
  if (count < 0 && errno == ECONNREFUSED)
    count = recvmmsg(descriptor_.number(), batch_->messages.data(), batch_max, MSG_DONTWAIT, nullptr);
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    batch_->from[at].size = batch_->messages[at].msg_hdr.msg_namelen;
  }
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

Bytes DatagramSocket::datagram(std::size_t index) const noexcept {
  const std::size_t length = batch_->messages[index].msg_len;
  if (length > wire_bytes_max) return {};
  return {batch_->bytes[index].data(), length};
}

const PeerAddress& DatagramSocket::from(std::size_t index) const noexcept { return batch_->from[index]; }

bool DatagramSocket::send(Bytes datagram) const noexcept { return send(datagram, {}); }

bool DatagramSocket::send(Bytes datagram, const PeerAddress& to) const noexcept {
  const auto* const address = to.size == 0 ? nullptr : reinterpret_cast<const sockaddr*>(&to.address);
  const ssize_t sent =
      sendto(descriptor_.number(), datagram.data(), datagram.size(), MSG_DONTWAIT | MSG_NOSIGNAL, address, to.size);
  return sent == static_cast<ssize_t>(datagram.size());
}

}  // namespace kadans
