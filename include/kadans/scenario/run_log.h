// What the behaviors of a run said and did, kept for its report; handed on to a recorder when there is one. Of a run
// that does not end only the newest are kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kadans/engine/behavior_host.h"

namespace kadans {

struct LogLine {
  std::int64_t time_ns = 0;
  BehaviorLog::Severity severity = BehaviorLog::Severity::info;
  std::string behavior;
  std::string text;
};

class RunLog final : public BehaviorLog {
 public:
  // Keeps at least `kept_max` transitions and as many lines, at most twice that.
  explicit RunLog(BehaviorLog* next = nullptr, std::size_t kept_max = SIZE_MAX / 2)
      : next_(next), kept_max_(kept_max) {}

  void transition(const Transition& transition) override;
  void message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) override;

  const std::vector<Transition>& transitions() const noexcept { return transitions_; }
  const std::vector<LogLine>& lines() const noexcept { return lines_; }
  bool has_errors() const noexcept { return errors_; }  // also among those that are not kept any more

 private:
  BehaviorLog* next_;
  std::size_t kept_max_;
  bool errors_ = false;
  std::vector<Transition> transitions_;
  std::vector<LogLine> lines_;
};

}  // namespace kadans
