// What the behaviors of a run said and did, kept for its report; handed on to a recorder when there is one.
#pragma once

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
  explicit RunLog(BehaviorLog* next = nullptr) : next_(next) {}

  void transition(const Transition& transition) override;
  void message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) override;

  const std::vector<Transition>& transitions() const noexcept { return transitions_; }
  const std::vector<LogLine>& lines() const noexcept { return lines_; }
  bool has_errors() const noexcept;

 private:
  BehaviorLog* next_;
  std::vector<Transition> transitions_;
  std::vector<LogLine> lines_;
};

}  // namespace kadans
