#include "emulated_wire.h"

#include <algorithm>
#include <limits>

namespace kadans::hostmot2 {

void EmulatedWire::send(const std::vector<std::uint8_t>& bytes, std::int64_t now_ns) {
  if (happens(faults.lost)) return;
  const std::int64_t due_ns = now_ns + delay_ns + (happens(faults.late) ? faults.late_ns : 0);
  const auto behind = std::ranges::upper_bound(replies_, due_ns, {}, &Reply::due_ns);
  replies_.insert(behind, {due_ns, bytes});
}

void EmulatedWire::receive(std::span<const std::uint8_t> datagram, std::int64_t now_ns) {
  ++sent_to_;
  if (pulled || happens(faults.lost)) return;
  const int times = happens(faults.duplicated) ? 2 : 1;
  for (int i = 0; i < times; ++i) {
    std::vector<std::uint8_t> bytes = responder.answer(datagram);
    if (bytes.empty()) continue;
    if (replace) replace(bytes);
    if (happens(faults.corrupt))
      bytes[static_cast<std::size_t>(random_.uniform() * static_cast<double>(bytes.size()))] ^= 0x10;
    send(bytes, now_ns);
    if (happens(faults.duplicated)) send(bytes, now_ns);
  }
}

std::int64_t EmulatedWire::due_ns() const noexcept {
  return replies_.empty() ? std::numeric_limits<std::int64_t>::max() : replies_.front().due_ns;
}

std::vector<std::uint8_t> EmulatedWire::take(std::int64_t now_ns) {
  if (pulled) replies_.clear();
  if (replies_.empty() || replies_.front().due_ns > now_ns) return {};
  std::vector<std::uint8_t> bytes = std::move(replies_.front().bytes);
  replies_.pop_front();
  return bytes;
}

}  // namespace kadans::hostmot2
