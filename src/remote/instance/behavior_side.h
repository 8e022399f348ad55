// The behavior thread's part of an instance: carries out orders between two ticks of the behaviors. An order to the
// control thread is one transaction; it is answered when the control engine has applied or refused the transaction. An
// order to the behaviors is answered when their next tick is over. Every change is logged with the name of the client
// that asked for it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/behavior_engine.h"
#include "engine/behavior_log.h"
#include "instance.h"
#include "parameter_history.h"
#include "realtime/engine_tasks.h"
#include "script/console/console.h"
#include "script/host/script_host.h"
#include "script/process/process_host.h"
#include "supervisor/decide/decision_questions.h"

namespace kadans {

// Collects the log messages while an order is carried out, so that the answer can repeat them. Behavior thread.
class LineEcho final : public LineSink {
 public:
  struct Heard {
    BehaviorLog::Severity severity;
    std::string behavior, text;
  };

  void tell(const Line& line) override {
    if (!listens_ || line.transition != nullptr || lines_.size() == lines_max) return;
    lines_.push_back({line.severity, std::string(line.behavior), std::string(line.text)});
  }

  void listen() {
    if (!listens_) lines_.clear();
    listens_ = true;
  }
  // Returns the messages since listen(), and stops listening.
  std::vector<Heard> take() {
    listens_ = false;
    return std::move(lines_);
  }

 private:
  static constexpr std::size_t lines_max = 64;
  bool listens_ = false;
  std::vector<Heard> lines_;
};

class BehaviorSide final : public BesideTick {
 public:
  struct Parts {
    Instance& instance;
    ScriptHost* host;      // the behaviors run in this host ...
    ProcessHost* process;  // ... or in this process; the other pointer is nullptr
    BehaviorEngine& engine;
    EngineExchange& exchange;
    LineEcho& echo;                          // a sink of the behaviors' log, which is `log`
    BehaviorLog& log;                        // changes are logged here
    DecisionQuestions* decisions = nullptr;  // of what decides over the behaviors; nullptr: nothing does
  };
  static constexpr std::size_t consoles_max = 4;
  static constexpr std::int64_t led_again_ns = 1'000'000'000;  // moving set-points are logged once in this time

  // All parts must outlive this object. `next` is called after it in every tick.
  explicit BehaviorSide(const Parts& parts, BesideTick* next = nullptr) : p_(parts), next_(next) {}

  void beside_tick(std::int64_t time_ns) override;

 private:
  // An order that has been begun and not yet answered.
  struct Pending {
    std::unique_ptr<OrderCase> order;
    OrderQueue* from;
    std::int64_t asked_ns;
    std::uint64_t asked_tick;    // tick of the behaviors; a simulation does not run them in each of its own ticks
    std::uint32_t sequence = 0;  // of its transaction; 0: the order waits for the end of a tick
    ParameterChange change{};    // for set_parameter and undo
    PlayOrder::Kind given{};     // for orders to the list of behaviors: what it was told
    std::uint16_t lifts = 0;     // for clear_faults: SafetyStatus::lifts before it
    std::uint32_t asked = 0;     // number of what the behaviors' process was asked; 0: nothing, or it has replied
    JointMask joints = 0;        // for orders to drives
    bool logged = false;         // likewise: the log has it
    bool failed = false;         // the behaviors' process has refused it; the answer's text says why
  };

  // An order that the decisions have to answer, too; what the behaviors said is in its answer.
  struct AskedDecisions {
    std::unique_ptr<OrderCase> order;
    OrderQueue* from;
    std::int64_t asked_ns;
    std::uint32_t number;
  };

  void carry_out(std::unique_ptr<OrderCase> order, OrderQueue& from);
  bool concerns_decisions(const Order& order) const noexcept;
  void answer(std::unique_ptr<OrderCase> order, OrderQueue& from);
  void ask_decisions(std::unique_ptr<OrderCase> order, OrderQueue& from);
  void settle_decisions();
  bool begin(Pending& pending);
  void settle();
  void heed_stop();
  bool waits_for_tick(const Pending& pending) const noexcept;
  bool settled(Pending& pending, const Snapshot& snapshot);
  void finish(Pending& pending);
  void say(const std::string& who, const std::string& what);

  OrderTaker& orders() const noexcept { return p_.host != nullptr ? static_cast<OrderTaker&>(*p_.host) : *p_.process; }
  bool ask(Pending& pending, const BehaviorQuestion& question);
  bool ask_why(Pending& pending);
  static void take(Pending& pending, BehaviorReply&& reply);
  void hear(Pending& pending);
  void give(Pending& pending, PlayOrder::Kind kind);
  void set_parameter(Pending& pending, const std::string& name, double value);
  void send(Pending& pending, std::span<const Command> commands);
  std::vector<Command> set_points_of(const Order& order) const;
  JointMask joints_of(const Order& order) const;
  void order_drives(Pending& pending);
  std::string told(const Pending& pending, bool& done);  // by lines_

  void evaluate(const Order& order, Answer& answer);
  Console& console_of(const Order& order);

  Parts p_;
  BesideTick* next_;
  bool stopped_ = false;                   // by the emergency stop, as of the last tick
  std::uint16_t lifts_ = 0;                // of the emergency stop, as of the last tick
  std::optional<std::uint64_t> why_tick_;  // in which a `why` was answered last
  std::vector<Pending> pending_;
  std::vector<AskedDecisions> asked_decisions_;
  std::uint32_t decision_questions_ = 0;  // so far
  ParameterHistory tuning_;
  std::map<std::uint64_t, std::unique_ptr<Console>> consoles_;  // by client
  std::vector<double> parameters_;
  std::vector<LineEcho::Heard> lines_;                 // messages of the last tick, when it carried out an order
  std::int64_t time_ns_ = 0, led_ns_ = -led_again_ns;  // led_ns_: when a set-point was last logged
};

}  // namespace kadans
