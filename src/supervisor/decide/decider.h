// The seam between the supervisor and what decides: decisions in this process (decisions.h), or in one of their own
// (decision_process.h).
//
// Supervisor thread, but for what is said to be before the loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "config/scenario/play_item.h"
#include "decision_questions.h"
#include "kadans/signal/signal.h"
#include "kadans/signal/status.h"
#include "script/bindings/signal_expressions.h"
#include "script/host/play_report.h"
#include "signal/byte_order.h"

namespace kadans {

class Decider {
 public:
  struct Heard {
    std::string who;  // sent the message
    std::string why;  // the decisions did not get it; "": they did
  };
  static constexpr std::size_t orders_max = 64, messages_max = 64;  // of a tick
  // What came of the last tick. The caller takes it.
  struct Decided {
    std::vector<PlayOrder> orders;      // for what plays
    std::vector<PlayedEvent> messages;  // for other robots
    std::vector<Heard> heard;           // what became of messages of other robots
    std::vector<std::unique_ptr<DecisionQuestion>> replies;
  };

  virtual ~Decider() = default;

  // Before the loop: the signals of a behavior, and the states of the chart.
  virtual void declare_signals(SignalTable& signals, std::vector<SignalState>& states) = 0;
  virtual const std::string& name() const noexcept = 0;
  virtual std::vector<std::filesystem::path> files() const = 0;  // as they were read before the loop

  // Before a tick: an event of another robot.
  virtual void hear(PlayedEvent event) noexcept = 0;
  // `snapshot` with the world model as it is now. False: nobody decided, because its process is gone or has not
  // answered yet.
  [[nodiscard]] virtual bool tick(const Snapshot& snapshot, const PlayReport& report) noexcept = 0;
  Decided& decided() noexcept { return decided_; }
  virtual bool failed() const noexcept = 0;  // nothing will be decided any more, unless the files are read again

  // Reads the files again; the running version goes on when the new one is wrong. After an error it begins anew.
  virtual void reload(const Snapshot& snapshot) noexcept = 0;
  // Before a tick: what people ask. The reply comes with a tick.
  virtual void ask(std::unique_ptr<DecisionQuestion> question, const Snapshot& snapshot) noexcept = 0;

 protected:
  Decided decided_;
};

// As bytes: whether an error ended them, then the orders, then the messages.
void put_decided(bool failed, const Decider::Decided& decided, ByteWriter& bytes);
// Adds to what is there. False: damaged, or more than a tick may ask for.
[[nodiscard]] bool take_decided(ByteReader& bytes, bool& failed, Decider::Decided& decided);

}  // namespace kadans
