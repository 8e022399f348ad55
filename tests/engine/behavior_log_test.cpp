#include "engine/behavior_log.h"

#include <string>
#include <vector>

#include <doctest/doctest.h>

using namespace kadans;

namespace {

struct Heard final : LineSink {
  void tell(const Line& line) override {
    times_ns.push_back(line.time_ns);
    severities.push_back(line.severity);
    texts.push_back(std::string(line.behavior) + "|" + std::string(line.text) +
                    (line.transition == nullptr ? "" : line.transition->from + ">" + line.transition->to));
  }
  std::vector<std::int64_t> times_ns;
  std::vector<BehaviorLog::Severity> severities;
  std::vector<std::string> texts;
};

}  // namespace

TEST_CASE("BehaviorLog hands each line with its facts to all of its sinks, also to one that was added later") {
  Heard first, later;
  BehaviorLog log{&first};
  log.message(1'500'000'000, BehaviorLog::Severity::warning, "squat", "on my way");
  log.add(later);
  log.transition({2'000'000'000, "squat", "stand", "down", "after 1 s"});
  CHECK(first.texts == std::vector<std::string>{"squat|on my way", "squat|stand>down"});
  CHECK(first.times_ns == std::vector<std::int64_t>{1'500'000'000, 2'000'000'000});
  CHECK(first.severities[0] == BehaviorLog::Severity::warning);
  CHECK(later.texts == std::vector<std::string>{"squat|stand>down"});
}
