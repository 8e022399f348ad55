// A k.decisions that runs: a chart as behaviors are, one level up. It sees what behaviors see, the world model and what
// plays; what it asks for is orders to what plays. It has no control objects, and sends no commands.
//
// Supervisor thread, or that of a process of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "decider.h"
#include "engine/behavior_log.h"
#include "engine/transaction.h"
#include "kadans/control/catalog.h"
#include "script/behavior/behavior.h"

namespace kadans {

class Decisions final : public Decider {
 public:
  // Loads the file. Throws InputError, also when it is no k.decisions.
  Decisions(Behavior::Settings settings, const Catalog& catalog, BehaviorLog& log);

  void declare_signals(SignalTable& signals, std::vector<SignalState>& states) override;
  const std::string& name() const noexcept override { return behavior_->name(); }
  std::vector<std::filesystem::path> files() const override { return behavior_->files(); }
  void hear(PlayedEvent event) noexcept override;
  // Always true. An error that ends it is logged.
  bool tick(const Snapshot& snapshot, const PlayReport& report) noexcept override;
  bool failed() const noexcept override { return behavior_->failed(); }
  void reload(const Snapshot& snapshot) noexcept override { (void)read_again(snapshot); }
  void ask(std::unique_ptr<DecisionQuestion> question, const Snapshot& snapshot) noexcept override;

  // Between two ticks. Throws InputError.
  BehaviorReply reply(const BehaviorQuestion& question, const Snapshot& snapshot);
  // "", or why the event is refused: nobody declares it, or its data is another.
  std::string refusal(PlayedEvent event);

  // For another process that goes on: its state as bytes. Returns "", or why it cannot be kept.
  std::string keep(ByteWriter& bytes);
  // Before the first tick: goes on from bytes of keep(). Returns "", or why not.
  std::string go_on(ByteReader& bytes, const Snapshot& snapshot) noexcept;
  // Between two ticks: as another process goes on that takes over, from the beginning where there was no tick yet.
  // Returns "", or why not. Throws InputError: the files are wrong by now.
  std::string take_over(const Snapshot& snapshot, bool from_beginning);

  Behavior& behavior() noexcept { return *behavior_; }
  const Behavior& behavior() const noexcept { return *behavior_; }

 private:
  std::unique_ptr<Behavior> load() const;
  void load_anew();
  BehaviorReply read_again(const Snapshot& snapshot) noexcept;
  void hear(const PlayReport& report) noexcept;
  void tell(const char* event, const std::string& why = "") noexcept;
  void take_decided(const PlayReport& report) noexcept;

  Behavior::Settings settings_;
  const Catalog& catalog_;
  BehaviorLog& log_;
  CommandQueue nowhere_;  // decisions send no commands
  CommandSender silence_{nowhere_};
  std::unique_ptr<Behavior> behavior_;
  std::uint32_t refused_ = 0, not_done_ = 0, taken_over_ = 0;  // as the report had them
  bool asked_ = false;                                         // something was played whose end was not told yet
};

}  // namespace kadans
