
#include "scenario_check.h"

#include <algorithm>

namespace kadans {
namespace {

constexpr NumberRange time_range{0, 1e6, "s"};

void list_fields(Fields& f, ScenarioCheck& check) {
  f.string("name", check.name, "name of the check: what must hold", Need::required);
  f.choice("kind", check.kind, check_kinds, "when the condition must hold (never: must not hold)", Need::required);
  f.string("signal", check.signal, "name of a signal that must lie between min and max");
  f.number("min", check.min, {}, "least value, in the signal's unit");
  f.number("max", check.max, {}, "greatest value, in the signal's unit");
  f.string("that", check.that, "instead of signal: a condition on signals in Lua, such as base.height_m > 0.6");
  f.string("when", check.when, "for within and settles: the condition from which the time counts");
  f.number("within_s", check.within_s, time_range, "for within and settles: time after which the condition must hold");
  f.number("from_s", check.from_s, time_range, "time from which the check applies");
  f.number("until_s", check.until_s, time_range, "time until which the check applies (default: the end)");
  check.signal_place = f.place("signal");
  check.that_place = f.place("that");
  check.when_place = f.place("when");
}

// What each kind needs and what means nothing to it.
void verify_kind(const Fields& f, const ScenarioCheck& check) {
  const bool clocked = check.kind == CheckKind::within || check.kind == CheckKind::settles;
  const auto& kind = check_kinds.at(static_cast<std::size_t>(check.kind));
  const auto unasked = [&](const char* key) {
    if (f.has(key)) f.refuse(key, " means nothing to a check of kind " + in_quotes(kind));
  };
  if (clocked) {
    if (!f.has("within_s")) f.refuse(" is of kind " + in_quotes(kind) + " and needs within_s");
    if (check.kind == CheckKind::within && check.when.empty()) f.refuse(" is of kind 'within' and needs when");
  } else {
    unasked("when");
    unasked("within_s");
  }
  if (check.kind == CheckKind::at_end && (f.has("from_s") || f.has("until_s"))) {
    f.refuse(f.place(f.has("from_s") ? "from_s" : "until_s"),
             f.path() + " is judged at the end, from_s and until_s mean nothing here");
  }
}

void verify_demand(const Fields& f, const ScenarioCheck& check) {
  if (f.has("signal") == f.has("that")) {
    f.refuse(f.has("that") ? " has both signal and that, must have one of them"
                           : " needs a signal with min or max, or a condition in that");
    return;
  }
  if (f.has("that")) {
    for (const char* bound : {"min", "max"}) {
      if (f.has(bound)) f.refuse(bound, " belongs to a signal, here the condition decides");
    }
    return;
  }
  if (!f.has("min") && !f.has("max")) f.refuse(" needs min, max or both");
  if (!(check.min <= check.max)) {
    f.refuse("max", check.max, "at least min, " + number_text(check.min));
  }
}

void verify_times(const Fields& f, const ScenarioCheck& check, double duration_s) {
  if (!(check.from_s <= check.until_s)) {
    f.refuse("until_s", check.until_s, "at least from_s, " + number_text(check.from_s) + " s");
  }
  if (duration_s > 0 && !(check.from_s <= duration_s)) {
    f.refuse("from_s", " is " + number_text(check.from_s) + ", the scenario ends at " + number_text(duration_s) + " s");
  }
}

}  // namespace

void check_fields(Fields& f, ScenarioCheck& check, double duration_s, const std::vector<ScenarioCheck>& others) {
  list_fields(f, check);
  if (!f.reading()) return;
  verify_demand(f, check);
  verify_kind(f, check);
  verify_times(f, check, duration_s);
  if (std::ranges::find(others, check.name, &ScenarioCheck::name) != others.end()) {
    f.refuse("name", ": another check is named " + in_quotes(check.name));
  }
}

namespace {

const std::array<std::string, 8> metric_kinds{"max", "min", "mean", "rms", "end", "share", "first_time", "since"};
bool takes_number(MetricKind kind) { return kind <= MetricKind::end; }
bool takes_condition(MetricKind kind) { return kind >= MetricKind::end; }

void verify(const Fields& f, const MetricConfig& metric) {
  const std::string kind = in_quotes(metric_kinds.at(static_cast<std::size_t>(metric.kind)));
  const std::size_t given = std::size_t{f.has("signal")} + f.has("value") + f.has("that");
  const char* const number = f.has("signal") ? "signal" : "value";
  if (given != 1) {
    f.refuse(given > 1 ? " must have one of signal, value and that, not more"
                       : " needs a signal, a number in value, or a condition in that");
  } else if (f.has(number) && !takes_number(metric.kind)) {
    f.refuse(number, ": a metric of kind " + kind + " needs a condition in that");
  } else if (f.has("that") && !takes_condition(metric.kind)) {
    f.refuse("that", ": a metric of kind " + kind + " needs a signal, or a number in value");
  }
  if (metric.name.find_first_of(" ,\"'=") != std::string::npos || metric.name.empty())
    f.refuse(metric.place, "metric " + in_quotes(metric.name) + " must be a word, such as tilt_max_rad");
  if (!(metric.from_s <= metric.until_s)) {
    f.refuse("until_s", metric.until_s, "at least from_s, " + number_text(metric.from_s) + " s");
  }
}

}  // namespace

void metrics_fields(Fields& f, std::vector<MetricConfig>& metrics) {
  f.map("metrics", "numbers by which each run is judged, by name", [&](Fields& e) {
    MetricConfig metric{.name = e.key(), .place = e.key_place(), .signal = {}, .value = {}, .that = {}};
    e.choice("kind", metric.kind, metric_kinds, "how the metric is computed from the signal, number or condition",
             Need::required);
    e.string("signal", metric.signal, "for max, min, mean, rms and end: name of the signal");
    e.string("value", metric.value, "in place of signal: a number in Lua, such as sqrt(base.x_m^2 + base.y_m^2)");
    e.string("that", metric.that, "for end, share, first_time and since: a condition on signals in Lua");
    e.number("from_s", metric.from_s, time_range, "time from which it counts");
    e.number("until_s", metric.until_s, time_range, "time until which it counts (default: the end)");
    metric.signal_place = e.place("signal");
    metric.value_place = e.place("value");
    metric.that_place = e.place("that");
    if (!e.reading()) return;
    verify(e, metric);
    metrics.push_back(std::move(metric));
  });
}

std::string definition(const MetricConfig& metric) {
  return metric.name + " " + metric_kinds.at(static_cast<std::size_t>(metric.kind)) + " [" + metric.signal + "] [" +
         metric.that + "] " + (metric.value.empty() ? "" : "= " + metric.value + " ") + number_text(metric.from_s) +
         " " + number_text(metric.until_s);
}

}  // namespace kadans
