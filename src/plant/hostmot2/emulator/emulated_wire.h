// The cable between a host and an emulated board, in time that the caller passes, and what may happen to datagrams on
// it, by seeded chance.
//
// One owner, one thread at a time.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "kadans/signal/random.h"
#include "lbp16_responder.h"

namespace kadans::hostmot2 {

struct WireFaults {  // shares of the datagrams, in each direction
  double lost = 0, corrupt = 0, duplicated = 0, late = 0;
  std::int64_t late_ns = 3'000'000;
};

class EmulatedWire {
 public:
  EmulatedWire(EmulatedBoard& board, std::uint64_t seed) : responder(board), random_(seed, "wire") {}

  Lbp16Responder responder;
  WireFaults faults;
  std::int64_t delay_ns = 0;                                // there and back
  bool pulled = false;                                      // the cable
  std::function<void(std::vector<std::uint8_t>&)> replace;  // what else happens to a reply

  // The host sends this datagram now.
  void receive(std::span<const std::uint8_t> datagram, std::int64_t now_ns);
  // When the host has the next reply; INT64_MAX: none is on the way.
  std::int64_t due_ns() const noexcept;
  // The next reply that the host has now; empty: none.
  std::vector<std::uint8_t> take(std::int64_t now_ns);
  void drop_replies() noexcept { replies_.clear(); }
  std::uint64_t sent_to() const noexcept { return sent_to_; }  // datagrams of the host, those that were lost, too

 private:
  struct Reply {
    std::int64_t due_ns;
    std::vector<std::uint8_t> bytes;
  };
  void send(const std::vector<std::uint8_t>& bytes, std::int64_t now_ns);
  bool happens(double share) { return share > 0 && random_.uniform() < share; }

  RandomStream random_;
  std::deque<Reply> replies_;  // by their times
  std::uint64_t sent_to_ = 0;
};

}  // namespace kadans::hostmot2
