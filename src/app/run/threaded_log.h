// Passes the log lines and transitions of behaviors in a live run to the record and to the supervisor. They go through
// queues, so that neither a slow disk nor a blocked terminal delays the behavior thread.
#pragma once

#include "telemetry/record/event_log.h"

namespace kadans {

class ThreadedLog final : public BehaviorLog {
 public:
  explicit ThreadedLog(BehaviorLog& record) noexcept : record_(record) {}

  // Behavior thread.
  void transition(const Transition& transition) override {
    told_.transition(transition);
    record_.transition(transition);
  }
  void message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) override {
    told_.message(time_ns, severity, behavior, text);
    record_.message(time_ns, severity, behavior, text);
  }

  EventLog& told() noexcept { return told_; }  // supervisor: pops

 private:
  EventLog told_;
  BehaviorLog& record_;
};

}  // namespace kadans
