// `kadans jitter`: stretches of our own waiting and of cyclictest's take turns, so that what the machine does meanwhile
// hits both alike.
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>

#include "commands.h"
#include "jitter_report.h"
#include "kadans/realtime/keep_awake.h"
#include "kadans/realtime/machine.h"
#include "kadans/realtime/machine_load.h"
#include "kadans/realtime/memory_lock.h"
#include "kadans/realtime/posix_wait.h"
#include "kadans/realtime/rights.h"
#include "kadans/signal/input_error.h"
#include "terminal.h"

namespace kadans {
namespace {

constexpr std::size_t pairs = 10;

JitterSettings settings_of(const JitterOptions& options) {
  JitterSettings settings;
  settings.cpu = options.cpu >= 0 ? options.cpu : real_time_cpu("/");
  settings.priority = options.priority;
  const double spin_us = options.spin_us > 0 ? options.spin_us : 1e-3 * static_cast<double>(default_spin_ns);
  settings.spin_ns = options.sleep_only ? 0 : std::llround(1e3 * spin_us);
  const double beats = options.seconds * 1e9 / static_cast<double>(settings.period_ns);
  settings.samples = std::max<std::uint64_t>(2, static_cast<std::uint64_t>(beats) / pairs);
  return settings;
}

void measure(JitterRun& run) {
  for (std::size_t i = 0; i < pairs && !interrupted(); ++i) {
    if (stderr_is_terminal()) std::fprintf(stderr, "\r  pair %zu of %zu", i + 1, pairs);
    run.own.push_back(measure_jitter(run.settings));
    if (run.own.size() != run.yardstick.size() + 1) continue;
    const auto yardstick = measure_cyclictest(run.settings);
    if (yardstick) run.yardstick.push_back(*yardstick);
  }
  if (stderr_is_terminal()) std::fprintf(stderr, "\r\033[K");
  if (run.yardstick.size() < run.own.size()) run.yardstick.clear();
}

void write_svg(const std::string& file, const JitterRun& run) {
  std::ofstream stream(file);
  stream << jitter_svg(run) << std::flush;
  if (!stream) throw InputError({.file = file, .message = std::string("cannot be written: ") + std::strerror(errno)});
}

}  // namespace

int run_jitter(const JitterOptions& options) {
  JitterRun run{.settings = settings_of(options), .load = options.load, .keep_awake = options.keep_awake};
  for (const std::string& missing : missing_rights(read_rights("/"), options.priority)) {
    print_error("measured without " + missing);
  }
  catch_interrupts();
  std::unique_ptr<MachineLoad> load;
  if (options.load) load = std::make_unique<MachineLoad>();
  (void)lock_memory(std::size_t{1} << 20U);  // without the right, which has been told
  std::unique_ptr<KeepAwake> awake;
  if (options.keep_awake) awake = std::make_unique<KeepAwake>(run.settings.cpu);
  measure(run);
  if (awake) {
    run.keep_awake_ns = awake->cpu_time_ns();
    run.latency_held = awake->holds_latency();
  }
  if (run.own.empty()) return exit_interrupted;
  if (run.own.front().refused_priority != 0) run.settings.priority = 0;
  std::fputs(jitter_text(run).c_str(), stdout);
  if (!options.svg.empty()) write_svg(options.svg, run);
  if (options.json) std::puts(jitter_json(run).c_str());
  return interrupted() ? exit_interrupted : exit_passed;
}

}  // namespace kadans
