#include "run_log.h"

#include <utility>

namespace kadans {
namespace {

template <typename T>
void keep(std::vector<T>& all, std::size_t kept_max, T one) {
  if (all.size() >= 2 * kept_max) all.erase(all.begin(), all.end() - static_cast<std::ptrdiff_t>(kept_max));
  all.push_back(std::move(one));
}

}  // namespace

void RunLog::transition(const Transition& transition) {
  keep(transitions_, kept_max_, transition);
  if (next_ != nullptr) next_->transition(transition);
}

void RunLog::message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) {
  errors_ = errors_ || severity == Severity::error;
  keep(lines_, kept_max_, {time_ns, severity, behavior, text});
  if (next_ != nullptr) next_->message(time_ns, severity, behavior, text);
}

}  // namespace kadans
