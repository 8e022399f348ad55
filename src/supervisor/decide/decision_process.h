// Decisions in a process of their own: the runtime's side, and that process's side. The world model, perception and
// messages stay with the runtime; what the process gets are the snapshot with the world model in it, what plays, and
// events. What comes back are orders and messages, which are checked as any others.
//
// Whatever happens to that process, behaviors go on; when it does not decide for lost_after_s, what the configuration
// says happens (supervised_host.h). The next process goes on where the last complete answer ended (process_host.h).
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "decider.h"
#include "decisions.h"
#include "engine/behavior_inputs.h"
#include "kadans/signal/status.h"
#include "script/host/served_host.h"
#include "script/process/process_host.h"
#include "signal/byte_order.h"

namespace kadans {

// Supervisor thread.
class DecisionProcess final : public Decider {
 public:
  // Starts the process, which reads the same files, and logs to this log. A tick comes once in this period.
  using Start = std::function<std::unique_ptr<ProcessHost>(BehaviorLog& log, std::int64_t period_ns)>;

  // Reads the files, too: throws InputError with what is wrong in them, or when the process does not start.
  DecisionProcess(const Behavior::Settings& settings, Catalog& catalog, BehaviorLog& log, const Start& start,
                  std::int64_t period_ns);

  // Before the loop: what the decisions took is told tick by tick, with what they saw of the world; nullptr: to nobody.
  void take_inputs_by(BehaviorInputs* inputs, const SeenEntries* seen) noexcept { inputs_ = inputs, seen_ = seen; }

  void declare_signals(SignalTable& signals, std::vector<SignalState>& states) override;
  const std::string& name() const noexcept override { return name_; }
  std::vector<std::filesystem::path> files() const override { return files_; }
  void hear(PlayedEvent event) noexcept override;
  bool tick(const Snapshot& snapshot, const PlayReport& report) noexcept override;
  bool failed() const noexcept override { return failed_ || process_->down(); }
  void reload(const Snapshot& snapshot) noexcept override;
  void ask(std::unique_ptr<DecisionQuestion> question, const Snapshot& snapshot) noexcept override;

  const ProcessHost& process() const noexcept { return *process_; }

 private:
  struct Asked {
    std::uint32_t number;
    std::string who;
  };

  bool take_decided();
  bool tell_taken();
  bool may_play(const PlayOrder& order) const;
  void take_replies();

  std::filesystem::path root_;
  Catalog& catalog_;
  std::unique_ptr<Decisions> read_;  // until its signals are declared
  std::string name_;
  std::vector<std::filesystem::path> files_;
  std::unique_ptr<ProcessHost> process_;
  std::deque<Asked> asked_;  // messages that wait for their answer
  std::deque<std::pair<std::uint32_t, std::unique_ptr<DecisionQuestion>>> questions_;  // likewise
  std::uint64_t answers_ = 0, takeovers_ = 0;
  BehaviorInputs* inputs_ = nullptr;
  const SeenEntries* seen_ = nullptr;
  Snapshot asked_with_;  // the time of the last request's snapshot, and what was seen then
  SeenEntries seen_with_{};
  CommandQueue nowhere_;  // decisions send no commands
  CommandSender silence_{nowhere_};
  bool failed_ = false;
};

// The thread of that process.
class ServedDecisions final : public ServedHost {
 public:
  // Goes on from the kept bytes in its first tick, if there are any; they must live until then. `inputs` is told what
  // the decisions take, and tells it on; nullptr: nobody records it.
  ServedDecisions(Decisions& decisions, BehaviorLog& log, std::span<const std::byte> kept, BehaviorInputs* inputs)
      : decisions_(decisions), log_(log), kept_(kept), inputs_(inputs) {
    status_.phase.store(1, std::memory_order_relaxed);
  }

  void order(const PlayOrder& order) override;
  std::size_t size() const noexcept override { return 1; }
  const Behavior& behavior(std::size_t /*index*/) const noexcept override { return decisions_.behavior(); }
  const PlayStatus& status() const noexcept override { return status_; }
  void before_tick(const Snapshot& snapshot) noexcept override;
  void show(const PlayReport& plays) noexcept override { plays_ = plays; }
  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override;
  const std::string& lost() const noexcept override { return lost_; }
  BehaviorReply reply(const BehaviorQuestion& question, const Snapshot& snapshot) override;
  std::string keep(ByteWriter& bytes, std::int64_t time_ns) override;
  std::span<const std::byte> decided() const noexcept override { return bytes_.bytes(); }
  std::span<const std::byte> told() noexcept override;

 private:
  Decisions& decisions_;
  BehaviorLog& log_;
  std::span<const std::byte> kept_;
  BehaviorInputs* inputs_;
  PlayStatus status_;
  PlayReport plays_;
  ByteWriter bytes_, told_;
  std::string lost_;
};

}  // namespace kadans
