// The log of a run. It keeps transitions and messages for the run's report. The number that is kept is
// bounded, for runs without an end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/behavior_log.h"

namespace kadans {

struct LogLine {
  std::int64_t time_ns = 0;
  BehaviorLog::Severity severity = BehaviorLog::Severity::info;
  std::string behavior;
  std::string text;
};

class RunLog final : public BehaviorLog, private LineSink {
 public:
  // Keeps the newest `kept_max` transitions and as many lines, at most twice as many. `sinks` hear all lines too.
  explicit RunLog(std::initializer_list<LineSink*> sinks = {}, std::size_t kept_max = SIZE_MAX / 2)
      : BehaviorLog(sinks), kept_max_(kept_max) {
    add(*this);
  }

  const std::vector<Transition>& transitions() const noexcept { return transitions_; }
  const std::vector<LogLine>& lines() const noexcept { return lines_; }
  bool has_errors() const noexcept { return errors_; }  // also when their lines are no longer kept

 private:
  void tell(const Line& line) override;

  std::size_t kept_max_;
  bool errors_ = false;
  std::vector<Transition> transitions_;
  std::vector<LogLine> lines_;
};

}  // namespace kadans
