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

void RunLog::tell(const Line& line) {
  if (line.transition != nullptr) return keep(transitions_, kept_max_, *line.transition);
  errors_ = errors_ || line.severity == Severity::error;
  keep(lines_, kept_max_, {line.time_ns, line.severity, std::string(line.behavior), std::string(line.text)});
}

}  // namespace kadans
