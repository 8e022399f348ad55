// The server's end of one connection: whole lines in, whole lines out, both bounded.
//
// The next line is looked at only when the answer to the last is on its way, so a client that asks without reading
// keeps nobody but itself, and what waits for it is one answer and one sample. Server thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "kadans/remote/ctl_folder.h"
#include "kadans/signal/signal.h"

namespace kadans {

// Of all clients so far. Written by the server's thread, read by any.
struct CtlCounts {
  std::atomic<std::uint32_t> served{0};   // that found a place
  std::atomic<std::uint32_t> refused{0};  // that found none
  std::atomic<std::uint32_t> dropped{0};  // too slow, or too much
};

class CtlSession {
 public:
  static constexpr std::size_t line_bytes_max = std::size_t{64} * 1024;

  CtlSession(int socket, Role role, std::uint64_t number, std::int64_t now_ns);
  ~CtlSession();
  CtlSession(const CtlSession&) = delete;
  CtlSession& operator=(const CtlSession&) = delete;

  int socket() const noexcept { return socket_; }
  Role role() const noexcept { return role_; }
  std::uint64_t number() const noexcept { return number_; }
  std::uint32_t user() const noexcept { return user_; }         // uid; of nobody where the system does not say
  std::int64_t heard_ns() const noexcept { return heard_ns_; }  // when it last said something
  const std::string& who() const noexcept { return who_; }      // "uid 1000 (develop)"

  // Reads what came. False: the client is gone, or sent a line that is too long (then too_long()).
  [[nodiscard]] bool receive(std::int64_t now_ns);
  [[nodiscard]] bool transmit(std::int64_t now_ns);  // false: the client is gone
  bool wants_to_read() const noexcept { return !ended_ && out_.empty() && order == 0 && !has_line(); }
  bool wants_to_write() const noexcept { return !out_.empty(); }
  // It has said its last word and got all answers.
  bool finished() const noexcept { return ended_ && out_.empty() && order == 0 && watched.empty() && !has_line(); }
  bool too_long() const noexcept { return std::min(in_.find('\n'), in_.size()) > line_bytes_max; }

  // A line, when there is one and nothing waits to be answered or read.
  [[nodiscard]] bool take_line(std::string& line, std::int64_t now_ns);
  void say(const std::string& line, std::int64_t now_ns);

  // Half a line for longer than that, or an answer that nobody reads.
  bool half_since(std::int64_t before_ns) const noexcept { return half_ns_ < before_ns; }
  bool unread_since(std::int64_t before_ns) const noexcept { return wants_to_write() && progress_ns_ < before_ns; }

  std::uint64_t order = 0;  // whose answer it waits for; 0: none
  std::int64_t ordered_ns = 0;
  bool has_console = false;
  bool leaves = false;  // the client is gone; what it said last may still be here
  std::vector<SignalId> watched{};
  std::uint32_t every_ticks = 0;
  std::uint64_t next_tick = 0;  // of a sample

 private:
  bool has_line() const noexcept { return in_.find('\n') != std::string::npos; }
  void note_half(std::int64_t now_ns) noexcept;

  int socket_;
  Role role_;
  std::uint64_t number_;
  std::uint32_t user_ = UINT32_MAX;
  std::int64_t heard_ns_;
  std::string who_, in_, out_;
  bool ended_ = false;
  std::int64_t half_ns_ = INT64_MAX;  // since when half a line is there
  std::int64_t progress_ns_ = 0;
};

}  // namespace kadans
