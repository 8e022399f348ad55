#include "jitter.h"

#include <charconv>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <vector>

#include "child_process.h"
#include "realtime/posix_wait.h"
#include "realtime/task_thread.h"

namespace kadans {
namespace {

class Nothing final : public Task {
 public:
  explicit Nothing(std::uint64_t beats) : left_(beats) {}
  bool beat(const Beat&) override { return --left_ > 0; }

 private:
  std::uint64_t left_;
};

// What it says; "" when it is not there.
std::string run_cyclictest(const JitterSettings& settings) {
  std::vector<std::string> words{"cyclictest", "-m", "-t", "1", "-v", "-N"};
  words.insert(words.end(), {"-a", std::to_string(settings.cpu), "-i", std::to_string(settings.period_ns / 1000)});
  words.insert(words.end(), {"-l", std::to_string(settings.samples)});
  if (settings.priority > 0) words.insert(words.end(), {"-p", std::to_string(settings.priority)});
  try {
    return run_program(std::move(words)).out;
  } catch (const std::system_error&) {
    return {};
  }
}

}  // namespace

JitterSample measure_jitter(const JitterSettings& settings) {
  PosixWait wait(settings.spin_ns);
  Nothing nothing(settings.samples);
  const TaskSettings task{.name = "jitter",
                          .period_ns = settings.period_ns,
                          .first_ns = wait.now_ns() + 10 * settings.period_ns,
                          .priority = settings.priority,
                          .cpu = settings.cpu};
  TaskThread thread(task, nothing, wait);
  thread.start();
  thread.join();
  return {thread.statistics(), thread.cpu_time_ns(), thread.refused_priority(), thread.refused_cpu()};
}

std::optional<std::int64_t> cyclictest_lateness_ns(const std::string& line) {
  const auto first = line.find(':');
  const auto second = first == std::string::npos ? first : line.find(':', first + 1);
  if (second == std::string::npos || line.find_first_not_of(" 0123456789:\n") != std::string::npos) return {};
  const auto begin = line.find_first_not_of(' ', second + 1);
  if (begin == std::string::npos) return {};
  std::int64_t lateness_ns = 0;
  const auto [stop, error] = std::from_chars(line.data() + begin, line.data() + line.size(), lateness_ns);
  if (error != std::errc{} || stop == line.data() + begin) return {};
  return lateness_ns;
}

std::optional<YardstickSample> measure_cyclictest(const JitterSettings& settings) {
  std::istringstream lines(run_cyclictest(settings));
  YardstickSample sample;
  std::int64_t before_ns = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto lateness_ns = cyclictest_lateness_ns(line);
    if (!lateness_ns) continue;
    // When it wakes whole periods late it leaves as many out, as we do.
    const std::int64_t left_out_ns = before_ns / settings.period_ns * settings.period_ns;
    if (sample.lateness.count() > 0) sample.jitter.add(std::abs(left_out_ns + *lateness_ns - before_ns));
    sample.lateness.add(*lateness_ns);
    before_ns = *lateness_ns;
  }
  if (sample.lateness.count() == 0) return {};
  return sample;
}

}  // namespace kadans
