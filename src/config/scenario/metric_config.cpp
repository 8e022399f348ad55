#include "metric_config.h"

#include <array>

namespace kadans {
namespace {

const std::array<std::string, 8> metric_kinds{"max", "min", "mean", "rms", "end", "share", "first_time", "since"};
constexpr NumberRange time_range{0, 1e6, "s"};

bool takes_signal(MetricKind kind) { return kind <= MetricKind::end; }
bool takes_condition(MetricKind kind) { return kind >= MetricKind::end; }

void verify(const Fields& f, const MetricConfig& metric, Problems& problems) {
  const std::string kind = in_quotes(metric_kinds.at(static_cast<std::size_t>(metric.kind)));
  if (f.has("signal") == f.has("that")) {
    problems.add(f.place(), f.path() + (f.has("that") ? " has both signal and that, must have one of them"
                                                      : " needs a signal, or a condition in that"));
  } else if (f.has("signal") && !takes_signal(metric.kind)) {
    problems.add(f.place("signal"), f.path("signal") + ": a metric of kind " + kind + " needs a condition in that");
  } else if (f.has("that") && !takes_condition(metric.kind)) {
    problems.add(f.place("that"), f.path("that") + ": a metric of kind " + kind + " needs a signal");
  }
  if (metric.name.find_first_of(" ,\"'=") != std::string::npos || metric.name.empty())
    problems.add(metric.place, "metric " + in_quotes(metric.name) + " must be a word, such as tilt_max_rad");
  if (!(metric.from_s <= metric.until_s)) {
    problems.add(f.place("until_s"), f.path("until_s") + " is " + number_text(metric.until_s) +
                                         ", must be at least from_s, " + number_text(metric.from_s) + " s");
  }
}

}  // namespace

void metrics_fields(Fields& f, std::vector<MetricConfig>& metrics, Problems& problems) {
  f.map("metrics", "numbers by which each run is judged, by name", [&](Fields& e) {
    MetricConfig metric{.name = e.key(), .place = e.key_place(), .signal = {}, .that = {}};
    e.choice("kind", metric.kind, metric_kinds, "how the metric is computed from the signal or the condition",
             Need::required);
    e.string("signal", metric.signal, "for max, min, mean, rms and end: name of the signal");
    e.string("that", metric.that, "for end, share, first_time and since: a condition on signals in Lua");
    e.number("from_s", metric.from_s, time_range, "time from which it counts");
    e.number("until_s", metric.until_s, time_range, "time until which it counts (default: the end)");
    metric.signal_place = e.place("signal");
    metric.that_place = e.place("that");
    if (!e.reading()) return;
    verify(e, metric, problems);
    metrics.push_back(std::move(metric));
  });
}

std::string definition(const MetricConfig& metric) {
  return metric.name + " " + metric_kinds.at(static_cast<std::size_t>(metric.kind)) + " [" + metric.signal + "] [" +
         metric.that + "] " + number_text(metric.from_s) + " " + number_text(metric.until_s);
}

}  // namespace kadans
