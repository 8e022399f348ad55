#include "engine/behavior_log.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <unistd.h>

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

TEST_CASE("Text sinks write no control characters of what is said, but tabs and line ends") {
  char file[] = "/tmp/kadans_linesXXXXXX";
  REQUIRE(close(mkstemp(file)) == 0);
  {
    BehaviorLog log(LogFile(file).sink());
    constexpr std::string_view said("a\033[2Jb\r\0\177c\td\n\xc3\xa9\xc2\x9b\x9b", 18);
    log.message(Line::no_time, BehaviorLog::Severity::info, "squat\a", said);
    log.transition({0, "squat", "a\b", "b", "\033c"});
  }
  std::ifstream read(file);
  CHECK(std::string(std::istreambuf_iterator<char>(read), {}) ==
        "squat?: a?[2Jb???c\td\n\xc3\xa9?\?\n     0.00 s  squat: a? -> b (?c)\n");
  std::remove(file);
}
