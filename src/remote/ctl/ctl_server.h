// Serves `kadans ctl` and other clients with the same protocol: JSON objects, one on each line, over the sockets of
// ctl_folder.h. It has a thread of its own at normal priority, which reaches the engines only through its port
// (instance.h).
//
//   {"verb":"set","name":"posture.l_knee.kp_Nm_per_rad","value":50}
//   {"ok":true,"name":"posture.l_knee.kp_Nm_per_rad","before":40,"now":50}
//   {"ok":false,"error":"..."}
//
// docs/ctl.md lists the verbs. A line has at most 64 kB, and a client has one request under way at a time. A client
// that leaves a line unfinished for too long, or does not read for too long, is dropped and counted. A client that
// finds no place is refused with a message. The number of clients is bounded for each role, so clients of one role
// cannot keep out those of another.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <pthread.h>

#include "ctl_session.h"
#include "engine/clock.h"
#include "remote/instance/instance.h"
#include "signal/owned_descriptor.h"

namespace kadans {

class CtlServer {
 public:
  struct Settings {
    std::array<std::size_t, 3> clients_max{32, 16, 16};  // for each role
    std::int64_t half_line_max_ns = 5'000'000'000;
    std::int64_t unread_max_ns = 5'000'000'000;
    std::int64_t answer_max_ns = 10'000'000'000;  // time for the behavior thread to answer
    std::int64_t report_max_ns = 2'000'000'000;   // the same for a report of the behaviors
  };

  // Make it before the loop; it opens a port. `instance` and `sockets` must outlive it.
  CtlServer(Instance& instance, const CtlSockets& sockets, const Settings& settings);
  ~CtlServer() { stop(); }
  CtlServer(const CtlServer&) = delete;
  CtlServer& operator=(const CtlServer&) = delete;

  void start();  // throws std::system_error
  void stop() noexcept;
  const CtlCounts& counts() const noexcept { return counts_; }  // any thread

 private:
  struct Guest {
    std::unique_ptr<CtlSession> session;
    bool gone = false;
  };

  void run();
  void wait();
  void accept_all(Role role);
  void accept_waiting();
  void heed_last_lines(CtlSession& session);
  bool make_room(Role role, std::uint32_t user);
  void serve(Guest& guest, short events);
  void answer_requests(Guest& guest);
  void take_answers();
  void send_samples();
  void expire();
  void drop(Guest& guest, const std::string& why);
  int patience_ms() const noexcept;

  const CtlSockets& sockets_;
  Settings settings_;
  WallClock clock_;
  InstancePort& port_;
  CtlCounts counts_;
  CtlRequests requests_;
  std::vector<Guest> guests_;
  std::uint64_t next_number_ = 1;
  std::int64_t now_ns_ = 0, deaf_until_ns_ = 0;
  OwnedDescriptor wake_;
  pthread_t thread_{};
  bool running_ = false;
  std::atomic<bool> stop_{false};
};

}  // namespace kadans
