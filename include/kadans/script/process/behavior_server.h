// The far end of ProcessHost, in the process in which behaviors are played: waits for a request, ticks the host,
// answers. Between the two it does nothing. One thread.
#pragma once

#include <string>
#include <vector>

#include "kadans/engine/transaction.h"
#include "kadans/realtime/doorbell.h"
#include "kadans/script/process/behavior_link.h"
#include "kadans/script/script_host.h"
#include "kadans/signal/byte_order.h"

namespace kadans {

// What behaviors say, into the shared memory; what does not fit is dropped, counted and told of.
class SpokenLines final : public BehaviorLog {
 public:
  explicit SpokenLines(BehaviorLink& link) : link_(link) {}

  void transition(const Transition& transition) override;
  void message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) override;

 private:
  void begin(std::uint8_t kind, const std::string& behavior);
  bool push();

  BehaviorLink& link_;
  ByteWriter line_;
  std::uint64_t dropped_ = 0;
};

class BehaviorServer {
 public:
  // The host's log must be `lines`, or lead there. The catalog is that of the host.
  BehaviorServer(BehaviorLink& link, Doorbell& bell, ScriptHost& host, SpokenLines& lines, const Catalog& catalog);

  // Until the runtime lets go of the doorbell; returns the process's exit code: 0, or 1 when the host cannot go on with
  // what was kept.
  int serve();

 private:
  bool answer();
  void take_order();
  void tell_status();
  void keep(std::int64_t time_ns);

  BehaviorLink& link_;
  Doorbell& bell_;
  ScriptHost& host_;
  SpokenLines& lines_;
  CommandSender commands_;
  Snapshot snapshot_;
  ByteWriter kept_;
  std::vector<std::byte> kept_last_;
  std::string unkept_;  // why the state cannot be kept, said last
  std::uint32_t done_ = 0;
};

}  // namespace kadans
