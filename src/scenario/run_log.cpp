#include "kadans/scenario/run_log.h"

#include <algorithm>

namespace kadans {

void RunLog::transition(const Transition& transition) {
  transitions_.push_back(transition);
  if (next_ != nullptr) next_->transition(transition);
}

void RunLog::message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) {
  lines_.push_back({time_ns, severity, behavior, text});
  if (next_ != nullptr) next_->message(time_ns, severity, behavior, text);
}

bool RunLog::has_errors() const noexcept {
  return std::any_of(lines_.begin(), lines_.end(),
                     [](const LogLine& line) { return line.severity == Severity::error; });
}

}  // namespace kadans
