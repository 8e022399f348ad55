// Many clients of a live server, all subscribed to everything: half of them read, the others never do. A thread of
// their own, at low priority: they stand for other machines.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bench/live/web_socket.h"

namespace kadans::bench {

// What a server advertised: the numbers of its channels.
struct Channels {
  std::size_t count = 0;
  std::uint32_t timing = 0, joint = 0;
};
// Of a client that has just connected: reads what the server says first.
Channels introduce(WebSocket& client);
std::string subscription(std::uint32_t first, std::uint32_t last);

class Crowd {
 public:
  Crowd(std::uint16_t port, std::size_t clients);
  ~Crowd();  // all leave
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;

  std::uint64_t rows() const noexcept { return rows_.load(); }    // of the joints, that those who read got
  std::uint64_t bytes() const noexcept { return bytes_.load(); }  // of whole messages
  std::size_t readers() const noexcept { return readers_.size(); }
  bool all_there() const noexcept { return !lost_.load(); }  // nobody who reads was sent away

 private:
  void read();
  void take_messages(WebSocket& client);

  std::vector<std::unique_ptr<WebSocket>> readers_, others_;
  std::uint32_t joint_ = 0;
  std::atomic<std::uint64_t> rows_{0}, bytes_{0};
  std::atomic<bool> over_{false}, lost_{false};
  std::thread thread_;
};

}  // namespace kadans::bench
