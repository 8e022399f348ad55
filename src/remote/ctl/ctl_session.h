// The server's side of a connection, and the requests that come over it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "ctl_folder.h"
#include "kadans/signal/signal.h"
#include "remote/instance/instance.h"
#include "signal/owned_descriptor.h"

namespace kadans {

struct OrderRequest;

// Counts of all clients so far. Written by the server's thread, read by any thread.
struct CtlCounts {
  std::atomic<std::uint32_t> served{0};   // clients that found a place
  std::atomic<std::uint32_t> refused{0};  // clients that found no place
  std::atomic<std::uint32_t> dropped{0};  // clients that were too slow, sent too much, or made room for another
};

// The server's side of one connection: it reads and writes whole lines, and both directions are bounded.
//
// The next line is read only when the answer to the last line has been handed to the system. So a client that sends
// without reading holds up only itself, and at most one answer and one sample wait for it. Server thread.
class CtlSession {
 public:
  static constexpr std::size_t line_bytes_max = std::size_t{64} * 1024;

  CtlSession(int socket, Role role, std::uint64_t number, std::int64_t now_ns);

  int socket() const noexcept { return socket_.number(); }
  Role role() const noexcept { return role_; }
  std::uint64_t number() const noexcept { return number_; }
  std::uint32_t user() const noexcept { return user_; }         // uid; UINT32_MAX when the system does not tell it
  std::int64_t heard_ns() const noexcept { return heard_ns_; }  // when the client last sent something
  const std::string& who() const noexcept { return who_; }      // "uid 1000 (develop)"

  // Reads the bytes that came. False: the client is gone, or it sent a line that is too long (then too_long()).
  [[nodiscard]] bool receive(std::int64_t now_ns);
  [[nodiscard]] bool transmit(std::int64_t now_ns);  // false: the client is gone
  bool wants_to_read() const noexcept { return !ended_ && out_.empty() && order == 0 && !has_line(); }
  bool wants_to_write() const noexcept { return !out_.empty(); }
  // True when the client has closed its side and has received all answers.
  bool finished() const noexcept { return ended_ && out_.empty() && order == 0 && watched.empty() && !has_line(); }
  bool too_long() const noexcept { return std::min(in_.find('\n'), in_.size()) > line_bytes_max; }

  // Takes a line, if there is one and no answer is pending.
  [[nodiscard]] bool take_line(std::string& line, std::int64_t now_ns);
  void say(const std::string& line, std::int64_t now_ns);
  // What a client that is gone still said, bounded, also while an answer is pending.
  std::vector<std::string> last_lines(std::int64_t now_ns);

  // True when an unfinished line, or an answer that is not read, is older than before_ns.
  bool half_since(std::int64_t before_ns) const noexcept { return half_ns_ < before_ns; }
  bool unread_since(std::int64_t before_ns) const noexcept { return wants_to_write() && progress_ns_ < before_ns; }

  std::uint64_t order = 0;  // number of the order whose answer it waits for; 0: none
  std::int64_t ordered_ns = 0;
  bool has_console = false;
  bool leaves = false;  // the client is gone; its last lines may still be unread
  std::vector<SignalId> watched{};
  std::uint32_t every_ticks = 0;
  std::uint64_t next_tick = 0;  // of the next sample

 private:
  bool has_line() const noexcept { return in_.find('\n') != std::string::npos; }
  void note_half(std::int64_t now_ns) noexcept;

  OwnedDescriptor socket_;
  Role role_;
  std::uint64_t number_;
  std::uint32_t user_ = UINT32_MAX;
  std::int64_t heard_ns_;
  std::string who_, in_, out_;
  bool ended_ = false;
  std::int64_t half_ns_ = INT64_MAX;  // time since which a line is unfinished
  std::int64_t progress_ns_ = 0;
};

// Handles the request lines of ctl_server.h. A request is answered at once, or it becomes an order and its answer
// becomes the line. Server thread.
class CtlRequests {
 public:
  CtlRequests(Instance& instance, InstancePort& port, const CtlCounts& counts);
  ~CtlRequests();
  CtlRequests(const CtlRequests&) = delete;
  CtlRequests& operator=(const CtlRequests&) = delete;

  // Returns the answering line; "" when the request became an order, whose number is session.order.
  std::string take(CtlSession& session, const std::string& line);
  // Returns the line for an answer that has come. `answer` is nullptr when the wait was given up.
  std::string answered(CtlSession& session, const Answer* answer);
  // True when the session only waits for a report of the behaviors.
  bool reports(const CtlSession& session) const;
  // The newest sample of the watched signals; "" when there is no newer one.
  std::string sample(CtlSession& session);
  // To be called when the session ends.
  void forget(const CtlSession& session);
  // Empties the port; to be called now and then.
  void upkeep();

 private:
  struct Seen {  // how often a fault was seen
    std::uint32_t count = 0;
    Fault last;
  };

  bool known_here(const OrderRequest& request) const;
  std::string at_once(CtlSession& session, const OrderRequest& request);
  std::string send(CtlSession& session, const OrderRequest& request);
  std::string status(const Answer* report);
  std::string watch(CtlSession& session, const OrderRequest& request);
  void watches_fast(const CtlSession& session, bool fast);
  std::string faults();
  std::string told(const CtlSession& session, const OrderRequest& request, const Answer& answer);
  std::string get(const std::string& name, const Answer& report);
  std::string save(const CtlSession& session, const std::string& preset, const Answer& answer);

  Instance& instance_;
  InstancePort& port_;
  const CtlCounts& counts_;
  std::map<std::uint64_t, OrderRequest> asked_;  // the pending request of each session
  std::vector<std::uint64_t> leaving_;           // clients whose consoles must be closed
  std::set<std::uint64_t> fast_;                 // sessions that watch faster than the usual row
  std::set<std::uint64_t> readers_;              // sessions with the role read whose orders wait
  std::map<std::tuple<FaultCode, std::uint16_t, std::uint16_t>, Seen> faults_;  // by code, joint and robot
};

}  // namespace kadans
