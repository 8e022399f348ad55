// The counterpart of ProcessHost in the process in which behaviors play: waits for a request, ticks the host, answers.
// Between an answer and the next request it only waits. One thread.
#pragma once

#include <string>
#include <vector>

#include "behavior_link.h"
#include "engine/transaction.h"
#include "kadans/control/control_sets.h"
#include "realtime/machine/shared_memory.h"
#include "script/host/served_host.h"
#include "signal/byte_order.h"

namespace kadans {

// Writes the log lines of behaviors into the shared memory. Lines that do not fit are dropped and counted; the count is
// told behind the next line that fits, or by tell_dropped().
class SpokenLines final : public LineSink {
 public:
  explicit SpokenLines(BehaviorLink& link) : link_(link) {}

  void tell(const Line& line) override;
  void tell_dropped(std::int64_t time_ns);
  void tell_active(const ActiveStates& active) override;
  void tell_emitted(const EmittedEvent& event) override;

 private:
  bool push(const auto& told);

  BehaviorLink& link_;
  ByteWriter line_;
  std::uint64_t dropped_ = 0;
};

class BehaviorServer {
 public:
  // `log` and `catalog` are those of the host, `sets` those of the catalog; `lines` is a sink of the log.
  BehaviorServer(BehaviorLink& link, Doorbell& bell, ServedHost& host, BehaviorLog& log, SpokenLines& lines,
                 Catalog& catalog, ControlSets& sets);

  // Serves until the runtime closes the doorbell. Returns the exit code of the process: 0, or 1 when the host cannot
  // continue from the kept state.
  int serve();

 private:
  bool answer();
  void take_parameters() noexcept;
  void take_orders();
  void answer_questions();
  void put(std::uint32_t number, const BehaviorReply& reply);
  void tell_plays() noexcept;
  void tell_status();
  void keep(std::int64_t time_ns);

  BehaviorLink& link_;
  Doorbell& bell_;
  ServedHost& host_;
  BehaviorLog& log_;
  SpokenLines& lines_;
  Catalog& catalog_;
  ControlSets& sets_;
  CommandSender commands_;
  Snapshot snapshot_;
  ByteWriter kept_, replies_;
  std::vector<std::byte> kept_last_;
  std::string unkept_;  // the last logged reason why the state cannot be kept
  std::uint32_t done_ = 0;
};

}  // namespace kadans
