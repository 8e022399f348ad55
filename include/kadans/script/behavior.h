// One behavior that is played: its file, its Lua state, its chart and the run of the chart.
//
// Loading reads and checks everything and throws InputError; nothing has moved then. A tick is one transaction. What
// goes wrong in a tick stops the behavior: its transaction is dropped, error() says where and why. After an error in
// the script the states are left with their `exit`, as on every way out; after a breach of the budget nothing of it
// runs again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/engine/behavior_host.h"
#include "kadans/script/chart.h"
#include "kadans/script/script_error.h"
#include "kadans/script/script_limits.h"
#include "kadans/script/script_parameter.h"

namespace kadans {

class Behavior {
 public:
  struct Settings {
    std::filesystem::path root;  // of the project
    std::filesystem::path file;
    std::uint64_t seed = 1;
    ScriptLimits limits{};
    std::vector<std::string> feet{"left", "right"};  // names of the feet in the snapshot's order
  };
  // The catalog and the log must outlive the behavior. Throws InputError.
  Behavior(const Settings& settings, const Catalog& catalog, BehaviorLog& log);
  ~Behavior();
  Behavior(const Behavior&) = delete;
  Behavior& operator=(const Behavior&) = delete;

  // Behavior thread. False once it is over: finished or stopped by an error.
  bool tick(const Snapshot& snapshot, CommandSender& commands) noexcept;
  // Behavior thread: leaves all states, in a transaction of its own.
  void stop(const Snapshot& snapshot, CommandSender& commands) noexcept;
  // False: unknown to this behavior, or its queue is full.
  [[nodiscard]] bool post(const std::string& event) noexcept;

  const std::string& name() const noexcept;
  const Chart& chart() const noexcept;
  bool finished() const noexcept;             // came to a final state
  bool failed() const noexcept;               // error() says why
  std::string outcome() const;                // of the final state; "error" when it failed; "" while it runs
  std::string state() const;                  // path of the innermost active state, the first of several
  const ScriptError& error() const noexcept;  // of the last failure
  std::uint64_t transactions_refused() const noexcept;
  std::uint64_t events_unhandled() const noexcept;
  std::size_t heap_bytes() const noexcept;
  std::vector<ScriptParameter> parameters() const;
  // Behavior thread, between ticks. False, and nothing changes, on an unknown name or a value outside its range.
  [[nodiscard]] bool set_parameter(const std::string& name, double value) noexcept;

  struct Parts;

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace kadans
