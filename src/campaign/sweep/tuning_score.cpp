#include "tuning_score.h"

#include <algorithm>
#include <cmath>

#include "kadans/signal/content_hash.h"

namespace kadans {
namespace {

double u_of(const TunedAxis& axis) {
  const auto [low, high] = axis.parameter.range.of;
  if (axis.parameter.range.kind == Distribution::Kind::log_uniform)
    return std::log(axis.start / low) / std::log(high / low);
  return (axis.start - low) / (high - low);
}

}  // namespace

std::vector<double> values_at(const std::vector<TunedAxis>& axes, const std::vector<double>& point) {
  std::vector<double> values;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto [low, high] = axes[i].parameter.range.of;
    values.push_back(std::clamp(with_digits(axes[i].parameter.range.at(point[i]), 6), low, high));
  }
  return values;
}

std::vector<double> start_point(const std::vector<TunedAxis>& axes) {
  std::vector<double> point;
  for (const TunedAxis& axis : axes) point.push_back(std::clamp(u_of(axis), 0.0, 1.0));
  return point;
}

std::vector<SweepCase> common_runs(const TunePlan& plan, const std::vector<SweepSubject>& subjects, std::uint32_t runs,
                                   std::uint64_t seed, const std::string& version) {
  SweepPlan sweep;
  static_cast<ExperimentConfig&>(sweep) = plan;
  sweep.sampling = Sampling::latin_hypercube;
  sweep.cases = runs;
  sweep.seed = seed;
  return sweep_cases(sweep, subjects, version);
}

std::vector<SweepCase> candidate_cases(const std::vector<SweepCase>& runs, const std::vector<TunedAxis>& axes,
                                       const std::vector<std::vector<double>>& candidates) {
  std::vector<SweepCase> cases;
  for (const std::vector<double>& values : candidates) {
    for (const SweepCase& run : runs) {
      SweepCase one = run;
      one.index = cases.size();
      ContentHash hash;
      hash.add(run.id);
      for (std::size_t i = 0; i < values.size(); ++i) {
        one.settings.push_back({axes[i].parameter.pattern.name, values[i]});
        for (const std::string& name : axes[i].names) one.quantities.push_back({name, values[i]});
        hash.add(axes[i].parameter.pattern.name);
        hash.add(number_text(values[i]));
      }
      one.id = hash.hex();
      cases.push_back(std::move(one));
    }
  }
  return cases;
}

double run_score(const TunePlan& plan, const CaseRow& row) {
  double value = plan.failed_score;
  const auto metric = std::ranges::find(row.metrics, plan.score.name, &MetricValue::name);
  if (row.status == RunStatus::passed && metric != row.metrics.end() && std::isfinite(metric->value))
    value = metric->value;
  return plan.greatest ? -value : value;
}

std::vector<double> candidate_scores(const TunePlan& plan, const std::vector<CaseRow>& rows, std::size_t runs) {
  std::vector<double> scores(rows.size() / runs);
  for (std::size_t i = 0; i < rows.size(); ++i)
    scores[i / runs] += run_score(plan, rows[i]) / static_cast<double>(runs);
  return scores;
}

TuningEffect tuning_effect(const TunePlan& plan, const std::vector<CaseRow>& rows) {
  TuningEffect effect{.runs = rows.size() / 2};
  const double sign = plan.greatest ? -1 : 1;
  std::vector<double> before, after, change;
  for (std::size_t i = 0; i < effect.runs; ++i) {
    const CaseRow& was = rows[i];
    const CaseRow& is = rows[i + effect.runs];
    before.push_back(sign * run_score(plan, was));
    after.push_back(sign * run_score(plan, is));
    change.push_back(after.back() - before.back());
    effect.passed_before += was.status == RunStatus::passed ? 1 : 0;
    effect.passed_after += is.status == RunStatus::passed ? 1 : 0;
  }
  effect.before = sample_statistics(before, plan.seed, "before");
  effect.after = sample_statistics(after, plan.seed, "after");
  effect.change = sample_statistics(change, plan.seed, "change");
  return effect;
}

std::string effect_text(const TunePlan& plan, const TuningEffect& effect) {
  std::string text;
  const auto line = [&](const char* when, std::size_t passed, const SampleStatistics& s) {
    const Interval share = wilson_interval(passed, effect.runs);
    text += printed("  %-7s %s %.4g (%.4g .. %.4g), passed %zu of %zu (%.1f .. %.1f %%)\n", when,
                    plan.score.name.c_str(), s.mean, s.mean_interval.low, s.mean_interval.high, passed, effect.runs,
                    100 * share.low, 100 * share.high);
  };
  line("before", effect.passed_before, effect.before);
  line("after", effect.passed_after, effect.after);
  const Interval& change = effect.change.mean_interval;
  const bool better = plan.greatest ? change.low > 0 : change.high < 0;
  const bool worse = plan.greatest ? change.high < 0 : change.low > 0;
  return text + printed("  change  %.4g (%.4g .. %.4g), run by run on fresh seeds: %s\n", effect.change.mean,
                        change.low, change.high, better ? "better" : (worse ? "WORSE" : "no difference that is sure"));
}

}  // namespace kadans
