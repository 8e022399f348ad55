// `kadans jitter`: measurements of our own waiting and of cyclictest take turns, so that other activity of the machine
// affects both in the same way.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "realtime/machine/jitter.h"
#include "realtime/machine/keep_awake.h"
#include "realtime/machine/machine.h"
#include "realtime/machine/machine_load.h"
#include "realtime/machine/placement.h"
#include "realtime/posix_wait.h"
#include "run_report.h"
#include "signal/durable_file.h"
#include "signal/number_text.h"
#include "telemetry/plot.h"

namespace kadans {
namespace {

struct JitterOptions {
  double seconds = 60;  // of our own samples; cyclictest takes the same time again
  bool load = false;
  bool sleep_only = false;
  bool keep_awake = true;
  bool json = false;
  int cpu = -1;  // -1: the CPU that `kadans run` takes
  int priority = 90;
  double spin_us = 0;  // 0: the default of `kadans run`
  std::string svg;     // "" = none
};

// The result of a timing test, for people and for programs.

struct JitterRun {
  JitterSettings settings;
  bool load = false, keep_awake = true, latency_held = false;
  std::vector<JitterSample> own;           // our measurements, in turn with those of cyclictest
  std::vector<YardstickSample> yardstick;  // as many measurements, or none
  std::int64_t keep_awake_ns = 0;          // CPU time of all measurements together
};

constexpr double verdict_share = 0.01;  // share of the period: the bound of 2008

using Json = nlohmann::ordered_json;

constexpr std::array quantiles{p50, p90, p99, p999, p9999, p99999};
constexpr std::array compared{p50, p99, p999};
constexpr std::array<std::int64_t, 10> band_ends_us{1, 2, 5, 10, 20, 50, 100, 200, 500, 1000};
constexpr int longest_bar = 40;

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

template <typename Stretches, typename Value>
double median_of(const Stretches& stretches, Value value) {
  std::vector<double> values;
  for (const auto& stretch : stretches) values.push_back(value(stretch));
  return median(values);
}

// The median of the pairs' ratios, because other activity of the machine changes both values of a pair.
double ratio(const JitterRun& run, const TickQuantile& quantile) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < run.yardstick.size(); ++i) {
    ratios.push_back(run.own[i].statistics.lateness.percentile_ns(quantile.share) /
                     std::max(run.yardstick[i].lateness.percentile_ns(quantile.share), 1.0));
  }
  return median(ratios);
}

std::string row(const char* name, const TickStatistics& s) {
  std::string text = printed("  %-22s %8.2f %8.2f", name, in_us(s.min_ns()), in_us(s.mean_ns()));
  for (const TickQuantile& quantile : quantiles) text += printed(" %8.2f", in_us(s, quantile));
  return text + printed(" %9.2f\n", in_us(s.max_ns()));
}

std::string table(const JitterSample& own, const YardstickSample& yardstick) {
  std::string text = printed("  %-22s %8s %8s", "us", "min", "mean");
  for (const TickQuantile& quantile : quantiles) text += printed(" %8s", quantile.name);
  text += printed(" %9s\n", "max");
  text += row("lateness", own.statistics.lateness);
  if (yardstick.lateness.count() > 0) text += row("  of cyclictest", yardstick.lateness);
  text += row("jitter", own.statistics.jitter);
  if (yardstick.jitter.count() > 0) text += row("  of cyclictest", yardstick.jitter);
  return text + row("execution", own.statistics.execution);
}

// One line for each band of lateness: how many wake-ups were late by that much.
std::string histogram(const TickStatistics& jitter, std::int64_t period_ns) {
  std::string text;
  std::uint64_t before = 0;
  const auto total = static_cast<double>(std::max<std::uint64_t>(jitter.count(), 1));
  const auto band = [&](const std::string& name, std::uint64_t until) {
    const double share = static_cast<double>(until - before) / total;
    // Logarithmic, so that a thousandth is still visible: a full bar is all, and each factor of ten is a sixth of the
    // bar less.
    const double length = share > 0 ? std::max(1.0, longest_bar * (1 + std::log10(share) / 6)) : 0;
    text += printed("  %-22s %10llu %9.4f %%  ", name.c_str(), static_cast<unsigned long long>(until - before),
                    100 * share);
    text += std::string(static_cast<std::size_t>(length), '#') + "\n";
    before = until;
  };
  for (const std::int64_t end_us : band_ends_us) {
    const double percent = 1e5 * static_cast<double>(end_us) / static_cast<double>(period_ns);
    band(printed("<= %4lld us, %g %%", static_cast<long long>(end_us), percent), jitter.count_until(end_us * 1000));
  }
  band("more", jitter.count());
  return text;
}

std::string verdict(const TickStatistics& jitter, std::int64_t period_ns) {
  const auto bound_ns = static_cast<std::int64_t>(verdict_share * static_cast<double>(period_ns));
  const double within = static_cast<double>(jitter.count_until(bound_ns)) /
                        static_cast<double>(std::max<std::uint64_t>(jitter.count(), 1));
  const bool all = jitter.max_ns() <= bound_ns;
  return printed("verdict: %.4f %% of the jitter within 1 %% of the period (%g us): %s\n", 100 * within,
                 in_us(bound_ns),
                 all               ? "every beat keeps the bound"
                 : within >= 0.999 ? "the bound is kept but for single beats"
                 : within >= 0.9   ? "the bound is kept most of the time"
                                   : "the bound is not kept");
}

std::string comparison(const JitterRun& run) {
  if (run.yardstick.empty()) return "cyclictest is not there (package rt-tests): nothing to compare with\n";
  std::string text = printed("medians of %zu alternating pairs, lateness in us\n  %-22s", run.own.size(), "");
  for (const TickQuantile& quantile : compared) text += printed(" %8s", quantile.name);
  text += printed("\n  %-22s", "kadans");
  for (const TickQuantile& quantile : compared) {
    text += printed(" %8.2f",
                    median_of(run.own, [&](const JitterSample& s) { return in_us(s.statistics.lateness, quantile); }));
  }
  text += printed("\n  %-22s", "cyclictest");
  for (const TickQuantile& quantile : compared) {
    text += printed(" %8.2f",
                    median_of(run.yardstick, [&](const YardstickSample& s) { return in_us(s.lateness, quantile); }));
  }
  text += printed("\n  %-22s", "ratio");
  for (const TickQuantile& quantile : compared) text += printed(" %8.3f", ratio(run, quantile));
  return text + "\n";
}

std::string mode(const JitterRun& run) {
  std::string text =
      run.settings.spin_ns > 0 ? printed("sleep, then spin %g us", in_us(run.settings.spin_ns)) : "sleep";
  text += printed(", CPU %d, ", run.settings.cpu);
  text += run.settings.priority > 0 ? printed("SCHED_FIFO %d", run.settings.priority) : "no real-time priority";
  text += run.keep_awake ? ", kept awake" : "";
  text += run.latency_held ? ", cpu_dma_latency 0" : "";
  return text + (run.load ? ", under load" : ", no load made");
}

// All measurements as one sample.
JitterSample together(const std::vector<JitterSample>& stretches) {
  JitterSample all;
  for (const JitterSample& one : stretches) {
    all.statistics.lateness.add_all(one.statistics.lateness);
    all.statistics.jitter.add_all(one.statistics.jitter);
    all.statistics.execution.add_all(one.statistics.execution);
    all.statistics.overruns.add(one.statistics.overruns.get());
    all.statistics.late_wakes.add(one.statistics.late_wakes.get());
    all.statistics.missed.add(one.statistics.missed.get());
    all.cpu_time_ns += one.cpu_time_ns;
  }
  return all;
}

YardstickSample together(const std::vector<YardstickSample>& stretches) {
  YardstickSample all;
  for (const YardstickSample& one : stretches) {
    all.lateness.add_all(one.lateness);
    all.jitter.add_all(one.jitter);
  }
  return all;
}

std::string jitter_text(const JitterRun& run) {
  const JitterSample own = together(run.own);
  const TaskStatistics& s = own.statistics;
  std::string text = printed("%llu beats of %g us: ", static_cast<unsigned long long>(s.lateness.count()),
                             in_us(run.settings.period_ns)) +
                     mode(run) + "\n\n" + table(own, together(run.yardstick)) + "\n";
  text += printed("  overruns %llu, wakes a period late or more %llu, beats left out %llu\n",
                  static_cast<unsigned long long>(s.overruns.get()),
                  static_cast<unsigned long long>(s.late_wakes.get()), static_cast<unsigned long long>(s.missed.get()));
  text += printed("  CPU time: task %.3f s, keep-awake %.3f s\n\n", 1e-9 * static_cast<double>(own.cpu_time_ns),
                  1e-9 * static_cast<double>(run.keep_awake_ns));
  return text + "jitter\n" + histogram(s.jitter, run.settings.period_ns) + verdict(s.jitter, run.settings.period_ns) +
         "\n" + comparison(run);
}

// One line.
std::string jitter_json(const JitterRun& run) {
  const JitterSample own = together(run.own);
  const TaskStatistics& s = own.statistics;
  Json json{{"samples", s.lateness.count()},
            {"lateness_us", tick_json(s.lateness, quantiles)},
            {"jitter_us", tick_json(s.jitter, quantiles)},
            {"execution_us", tick_json(s.execution, quantiles)},
            {"overruns", s.overruns.get()},
            {"late_wakes", s.late_wakes.get()},
            {"missed", s.missed.get()},
            {"period_us", in_us(run.settings.period_ns)},
            {"spin_us", in_us(run.settings.spin_ns)},
            {"cpu", run.settings.cpu},
            {"priority", run.settings.priority},
            {"load", run.load},
            {"keep_awake", run.keep_awake},
            {"cpu_time_s",
             {{"task", 1e-9 * static_cast<double>(own.cpu_time_ns)},
              {"keep_awake", 1e-9 * static_cast<double>(run.keep_awake_ns)}}}};
  if (!run.yardstick.empty()) {
    const YardstickSample yardstick = together(run.yardstick);
    json["cyclictest"] = {{"samples", yardstick.lateness.count()},
                          {"lateness_us", tick_json(yardstick.lateness, quantiles)},
                          {"jitter_us", tick_json(yardstick.jitter, quantiles)}};
    json["pairs"] = run.own.size();
    for (const TickQuantile& quantile : compared) json["ratio"][quantile.name] = ratio(run, quantile);
  }
  return json_text(json);
}

// Draws the histograms: lateness to the right, shares upwards, both logarithmic, ours beside that of cyclictest.

constexpr double ns_min = 10, ns_max = 1e8, share_min = 1e-6;
constexpr int bins = 84;  // 12 a decade

PlotLine curve(const char* label, const TickStatistics& statistics) {
  const auto total = static_cast<double>(std::max<std::uint64_t>(statistics.count(), 1));
  PlotLine line{.label = label, .points = {}};
  std::uint64_t before = 0;
  for (int i = 0; i < bins; ++i) {
    const double from_ns = ns_min * std::pow(10, i / 12.0), to_ns = ns_min * std::pow(10, (i + 1) / 12.0);
    const std::uint64_t until = statistics.count_until(static_cast<std::int64_t>(to_ns));
    const double share = std::max(static_cast<double>(until - before) / total, share_min);
    line.points.push_back({from_ns, share});
    line.points.push_back({to_ns, share});
    before = until;
  }
  return line;
}

std::string jitter_svg(const JitterRun& run) {
  Plot plot{.title = "lateness of wake-ups, and its share of all",
            .x = {.range = {ns_min, ns_max}, .logarithmic = true},
            .y = {.range = {share_min, 1}, .logarithmic = true},
            .lines = {curve("kadans", together(run.own).statistics.lateness)}};
  double ns = ns_min;
  for (const char* time : {"10 ns", "100 ns", "1 us", "10 us", "100 us", "1 ms", "10 ms", "100 ms"}) {
    plot.x.ticks.push_back({ns, time});
    ns *= 10;
  }
  double share = 1;
  for (const char* name : {"100 %", "10 %", "1 %", "0.1 %", "0.01 %", "1e-5", "1e-6"}) {
    plot.y.ticks.push_back({share, name});
    share /= 10;
  }
  if (!run.yardstick.empty()) plot.lines.push_back(curve("cyclictest", together(run.yardstick).lateness));
  return plot_svg(plot);
}

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

}  // namespace

void add_jitter(CommandLine& line) {
  const auto [jitter, options] = line.add<JitterOptions>(
      "jitter", "Measure the timing of this machine, and compare it with cyclictest", run_jitter);
  add_number(*jitter, "--seconds", options.seconds, 0.1, 1000.0, "S", "Seconds of samples at 1 kHz (default: 60)");
  jitter->add_flag("--load", options.load,
                   "Load the machine meanwhile: processes that compute, fill memory, write, switch, set timers");
  CLI::Option* sleep =
      jitter->add_flag("--sleep-only", options.sleep_only, "Sleep until the next tick, without spinning");
  add_number(*jitter, "--spin-us", options.spin_us, 1.0, 900.0, "US", "Time to spin after sleeping")->excludes(sleep);
  jitter->add_flag("!--no-keep-awake", options.keep_awake, "Let the CPU idle between the beats");
  add_whole(*jitter, "--cpu", options.cpu, 0, 1023, "CPU to measure on (default: an isolated one, else the last)");
  add_whole(*jitter, "--priority", options.priority, 1, 99, "Priority of SCHED_FIFO (default: 90)");
  jitter->add_option("--svg", options.svg, "Draw the histogram into a file")->type_name("FILE");
  jitter->add_flag("--json", options.json, "Print one JSON object instead of text");
}

}  // namespace kadans
