// Keeps the transitions and log lines of a run's behaviors for its report, and passes them on to a recorder when there
// is one. The number that is kept is bounded, for runs without an end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/behavior_host.h"

namespace kadans {

struct LogLine {
  std::int64_t time_ns = 0;
  BehaviorLog::Severity severity = BehaviorLog::Severity::info;
  std::string behavior;
  std::string text;
};

class RunLog final : public BehaviorLog {
 public:
  // Keeps the newest `kept_max` transitions and as many lines, at most twice as many.
  explicit RunLog(BehaviorLog* next = nullptr, std::size_t kept_max = SIZE_MAX / 2)
      : next_(next), kept_max_(kept_max) {}

  void transition(const Transition& transition) override;
  void message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) override;

  const std::vector<Transition>& transitions() const noexcept { return transitions_; }
  const std::vector<LogLine>& lines() const noexcept { return lines_; }
  bool has_errors() const noexcept { return errors_; }  // also when their lines are no longer kept

 private:
  BehaviorLog* next_;
  std::size_t kept_max_;
  bool errors_ = false;
  std::vector<Transition> transitions_;
  std::vector<LogLine> lines_;
};

}  // namespace kadans
