// Collects the log messages while an order is carried out, so that the answer can repeat them. It passes everything on.
// Behavior thread.
#pragma once

#include <string>
#include <vector>

#include "engine/behavior_host.h"

namespace kadans {

class EchoLog final : public BehaviorLog {
 public:
  struct Line {
    Severity severity = Severity::info;
    std::string behavior, text;
  };

  explicit EchoLog(BehaviorLog* next = nullptr) noexcept : next_(next) {}

  void transition(const Transition& transition) override {
    if (next_ != nullptr) next_->transition(transition);
  }
  void message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) override {
    if (listens_ && lines_.size() < lines_max) lines_.push_back({severity, behavior, text});
    if (next_ != nullptr) next_->message(time_ns, severity, behavior, text);
  }

  void listen() {
    if (!listens_) lines_.clear();
    listens_ = true;
  }
  // Returns the messages since listen(), and stops listening.
  std::vector<Line> take() {
    listens_ = false;
    return std::move(lines_);
  }

 private:
  static constexpr std::size_t lines_max = 64;
  BehaviorLog* next_;
  bool listens_ = false;
  std::vector<Line> lines_;
};

}  // namespace kadans
