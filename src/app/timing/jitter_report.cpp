#include "jitter_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "run_report.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array quantiles{p50, p90, p99, p999, p9999, p99999};
constexpr std::array compared{p50, p99, p999};
constexpr std::array<std::int64_t, 10> band_ends_us{1, 2, 5, 10, 20, 50, 100, 200, 500, 1000};
constexpr int bar_width = 40;

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
    const double length = share > 0 ? std::max(1.0, bar_width * (1 + std::log10(share) / 6)) : 0;
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

}  // namespace

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

}  // namespace kadans
