// `kadans jitter`: measurements of our own waiting and of cyclictest take turns, so that other activity of the machine
// affects both in the same way.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "campaign/work/durable_file.h"
#include "jitter_report.h"
#include "realtime/machine/keep_awake.h"
#include "realtime/machine/machine.h"
#include "realtime/machine/machine_load.h"
#include "realtime/machine/memory_lock.h"
#include "realtime/machine/rights.h"
#include "realtime/posix_wait.h"

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

}  // namespace

void add_jitter(CLI::App& app, JitterOptions& options) {
  CLI::App* jitter = app.add_subcommand("jitter", "Measure the timing of this machine, and compare it with cyclictest");
  jitter->add_option("--seconds", options.seconds, "Seconds of samples at 1 kHz (default: 60)")
      ->type_name("S")
      ->check(number_within(0.1, 1000.0));
  jitter->add_flag("--load", options.load,
                   "Load the machine meanwhile: processes that compute, fill memory, write, switch, set timers");
  CLI::Option* sleep =
      jitter->add_flag("--sleep-only", options.sleep_only, "Sleep until the next tick, without spinning");
  jitter->add_option("--spin-us", options.spin_us, "Time to spin after sleeping")
      ->type_name("US")
      ->check(number_within(1.0, 900.0))
      ->excludes(sleep);
  jitter->add_flag("!--no-keep-awake", options.keep_awake, "Let the CPU idle between the beats");
  jitter->add_option("--cpu", options.cpu, "CPU to measure on (default: an isolated one, else the last)")
      ->type_name("N")
      ->check(whole_within(0, 1023));
  jitter->add_option("--priority", options.priority, "Priority of SCHED_FIFO (default: 90)")
      ->type_name("N")
      ->check(whole_within(1, 99));
  jitter->add_option("--svg", options.svg, "Draw the histogram into a file")->type_name("FILE");
  jitter->add_flag("--json", options.json, "Print one JSON object instead of text");
}

int run_jitter(const JitterOptions& options) {
  JitterRun run{.settings = settings_of(options), .load = options.load, .keep_awake = options.keep_awake};
  for (const std::string& missing : missing_rights(read_rights("/"), options.priority)) {
    print_error("measured without " + missing);
  }
  catch_interrupts();
  std::unique_ptr<MachineLoad> load;
  if (options.load) load = std::make_unique<MachineLoad>();
  (void)lock_memory(std::size_t{1} << 20U);  // fails without the right, which has been reported
  std::unique_ptr<KeepAwake> awake;
  if (options.keep_awake) awake = std::make_unique<KeepAwake>(run.settings.cpu);
  measure(run);
  if (awake) {
    run.keep_awake_ns = awake->cpu_time_ns();
    run.latency_held = awake->holds_latency();
  }
  if (run.own.empty()) return exit_interrupted;
  if (run.own.front().refused_priority != 0) run.settings.priority = 0;
  if (!options.svg.empty()) write_durably(options.svg, jitter_svg(run));
  std::fputs(options.json ? (jitter_json(run) + "\n").c_str() : jitter_text(run).c_str(), stdout);
  return interrupted() ? exit_interrupted : exit_passed;
}

}  // namespace kadans
