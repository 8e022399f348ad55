// `kadans shrink`: what of a failing run is needed for its failure. Everything is asked of runs: a part is needed when
// the run passes without it. The order is: first the disturbances and quantities, which are there or not, until none
// can be left out alone; then the impulses and times of those that are left. The other way round every quantity would
// matter, since a robot that is pushed just enough to fall falls only as it is.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "campaign/shrink/delta_search.h"
#include "config/json/foreign_json.h"
#include "config/plan/experiment_plans.h"
#include "config/robot/project_root.h"
#include "config/scenario/based_on.h"
#include "failing_case.h"
#include "kadans/signal/shell_word.h"
#include "reduced_scenario.h"
#include "signal/durable_file.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "trial_runs.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double near_share = 0.01;          // how near impulses and times come to what passes
constexpr std::int64_t whole_push = 10'000;  // the parts into which an impulse is cut

class Shrinking {
 public:
  Shrinking(const ShrinkOptions& options, RunChoices choices)
      : options_(options),
        choices_(std::move(choices)),
        config_(read_scenario(choices_)),
        scenario_(parse_based_json(read_input_file(config_.file), config_.file).value, config_.file),
        runs_(options.jobs, options.runs_max, config_.wall_limit_s) {
    scenario_.choose(choices_.seed, choices_.play);
  }

  const ScenarioConfig& config() const noexcept { return config_; }

  // Throws InputError when it does not fail, or not each time alike.
  void begin() {
    const Trial whole{.text = {}, .file = {}, .whole = choices_};
    const TrialResult once = runs_.run(whole);
    if (!once.refused.empty()) refuse_all(once.refused);
    if (once.timed_out)
      refuse(config_.file, "takes longer than its wall_limit_s of " + number_text(config_.wall_limit_s) +
                               " s: that is a matter of this machine, and no failure that repeats");
    if (once.failures.empty())
      refuse(config_.file, "passes with seed " + std::to_string(seed()) + ": there is no failure to shrink");
    const TrialResult again = runs_.run(whole);
    if (again.state_hash != once.state_hash || again.find(once.failures.front()) == nullptr)
      refuse(config_.file,
             "does not fail alike when it is run twice: its failure depends on more than its files and its seed, "
             "such as the wall clock or a plug-in of its own mind");
    wanted_ = chosen(once);
    period_s_ = once.period_s;
    scenario_.keep_check(wanted_.check);
    scenario_.take_quantities(once.quantities, choices_.set);
    runs_.look_for(wanted_);
    best_ = scenario_.all();
    if (!first_failing({best_}))
      refuse(config_.file, "does not fail any more when what it draws is written down: this is not to be expected");
  }

  // Throws TrialsInterrupted.
  void shrink() {
    try {
      leave_out_parts();
      lessen_pushes();
      shorten_faults();
      shorten_run();
      find_last_moment();
    } catch (const TrialsSpent&) {
      complete_ = false;
    }
  }

  void write(const std::string& out) {
    const std::string doc = "Shrunk from " + config_.name + ", seed " + std::to_string(seed()) + ". " + sentence();
    const auto based = scenario_.based_text(best_, out, doc);
    const auto only_this = [&](const TrialResult& result) {
      return result.failures.size() == 1 && result.find(wanted_) != nullptr;
    };
    std::string text = scenario_.text(best_, out, doc);
    if (based && based->size() < text.size() && only_this(runs_.run({.text = *based, .file = out}))) {
      text = *based;
    } else if (const TrialResult result = runs_.run({.text = text, .file = out}); result.find(wanted_) == nullptr) {
      if (!result.refused.empty()) refuse_all(result.refused);
      refuse(out, "does not fail there as it did: this is not to be expected");
    }
    write_durably(out, text);
    out_ = out;
    if (!options_.json && stderr_is_terminal()) std::fputs("\r\033[K", stderr);
  }

  std::string report() const;
  std::string report_json() const;

 private:
  std::uint64_t seed() const { return choices_.seed.value_or(config_.seed); }

  [[noreturn]] static void refuse_all(const std::vector<std::string>& lines) {
    std::vector<InputProblem> problems;
    for (const std::string& line : lines) problems.push_back({.message = line});
    throw InputError(std::move(problems));
  }

  TrialFailure chosen(const TrialResult& result) const {
    if (options_.check.empty()) return result.failures.front();
    for (const TrialFailure& failure : result.failures) {
      if (failure.check == options_.check) return failure;
    }
    std::vector<std::string> failed;
    for (const TrialFailure& failure : result.failures) failed.push_back(failure.check);
    const bool known =
        std::ranges::any_of(config_.checks, [&](const ScenarioCheck& check) { return check.name == options_.check; });
    if (known)
      refuse("--check", "'" + options_.check + "' passes; what fails first is '" + result.failures.front().told + "'");
    refuse_unknown("--check", {.name = options_.check, .place = {}}, "check", failed);
  }

  Trial trial(const Reduction& reduction) const { return {.text = scenario_.text(reduction), .file = config_.file}; }

  // What fails is the best from now on.
  std::optional<std::size_t> first_failing(const std::vector<Reduction>& reductions) {
    std::vector<Trial> trials;
    for (const Reduction& reduction : reductions) trials.push_back(trial(reduction));
    const auto found = runs_.first(trials);
    if (found) best_ = reductions[*found];
    tell_progress();
    return found;
  }
  template <typename Candidate, typename Change>
  FirstFailing<Candidate> asked_of(Change change) {
    return [this, change, from = best_](const std::vector<Candidate>& candidates) {
      std::vector<Reduction> reductions;
      for (const Candidate& candidate : candidates) change(candidate, reductions.emplace_back(from));
      return first_failing(reductions);
    };
  }

  void leave_out_parts() {
    for (Reduction before; before.disturbances != best_.disturbances || before.quantities != best_.quantities;) {
      before = best_;
      (void)fewest_parts(best_.disturbances,
                         asked_of<Parts>([](const Parts& kept, Reduction& to) { to.disturbances = kept; }));
      leave_out_entries();
      (void)fewest_parts(best_.quantities,
                         asked_of<Parts>([](const Parts& kept, Reduction& to) { to.quantities = kept; }));
    }
    Reduction other = best_;
    other.seeded = false;
    if (!scenario_.seed().empty()) (void)first_failing({other});
    std::vector<Reduction> shorter(3, best_);
    for (std::size_t i = 0; i < shorter.size(); ++i) shorter[i].digits = static_cast<int>(2 * i + 2);
    if (std::ranges::count(best_.quantities, true) > 0) (void)first_failing(shorter);
  }

  // All that one entry of the file chose at once: whole patterns, before single quantities.
  void leave_out_entries() {
    const std::vector<VariedQuantity>& quantities = scenario_.quantities();
    Parts entries(scenario_.entries(), false);
    for (std::size_t i = 0; i < quantities.size(); ++i) {
      if (best_.quantities[i]) entries[quantities[i].entry] = true;
    }
    (void)fewest_parts(entries, asked_of<Parts>([&](const Parts& kept, Reduction& to) {
                         for (std::size_t i = 0; i < quantities.size(); ++i)
                           to.quantities[i] = to.quantities[i] && kept[quantities[i].entry];
                       }));
  }

  double impulse_Ns(const Reduction& reduction) const {
    double sum = 0;
    for (std::size_t i = 0; i < reduction.share.size(); ++i) {
      if (reduction.disturbances[i]) sum += reduction.share[i] * scenario_.disturbances()[i].impulse_Ns;
    }
    return sum;
  }

  // Several pushes are made smaller together, then each; or each after the other, from either end. From the least of
  // these each is made greater, as long as that lets the others become smaller by more.
  void lessen_pushes() {
    std::vector<std::size_t> pushes;
    for (std::size_t i = 0; i < best_.share.size(); ++i) {
      if (best_.disturbances[i] && scenario_.disturbances()[i].is_push()) pushes.push_back(i);
    }
    const Reduction whole = best_;
    if (pushes.size() > 1) lessen(pushes);
    for (const std::size_t one : pushes) lessen({one});
    if (pushes.size() < 2) return;
    (void)less_from(whole, pushes);
    std::ranges::reverse(pushes);
    (void)less_from(whole, pushes);
    for (const double factor : {1.25, 1.1}) {
      for (bool better = true; better;) {
        better = false;
        for (const std::size_t one : pushes) {
          Reduction greater = best_;
          greater.share[one] = std::min(1.0, factor * greater.share[one]);
          std::vector<std::size_t> others_first = pushes;
          std::partition(others_first.begin(), others_first.end(), [one](std::size_t other) { return other != one; });
          better = less_from(greater, others_first) || better;
        }
      }
    }
  }
  // Makes the pushes smaller from there, in this order. False, and the best stays, when this gives no less.
  bool less_from(const Reduction& start, const std::vector<std::size_t>& pushes) {
    const Reduction least = best_;
    const auto is_less = [&] { return impulse_Ns(best_) < (1 - 0.5 * near_share) * impulse_Ns(least); };
    try {
      if (first_failing({start})) {
        for (const std::size_t one : pushes) lessen({one});
      }
    } catch (const TrialsSpent&) {
      if (!is_less()) best_ = least;
      throw;
    }
    if (is_less()) return true;
    best_ = least;
    return false;
  }
  void lessen(const std::vector<std::size_t>& pushes) {
    (void)least_number(0, whole_push, near_share, asked_of<std::int64_t>([&](std::int64_t parts, Reduction& to) {
                         for (const std::size_t one : pushes)
                           to.share[one] *= static_cast<double>(parts) / static_cast<double>(whole_push);
                       }));
  }

  double failed_at_s() const { return runs_.known(trial(best_)).find(wanted_)->at_s; }

  // In milliseconds.
  void shorten_faults() {
    for (std::size_t i = 0; i < best_.until_s.size(); ++i) {
      const Disturbance& fault = scenario_.disturbances()[i];
      if (!best_.disturbances[i] || !fault.until_s) continue;
      const double longest_s = std::min(*fault.until_s, failed_at_s() + period_s_) - fault.from_s;
      const auto steps = static_cast<std::int64_t>(std::ceil(1000 * longest_s - 1e-6));
      if (steps < 2) continue;
      (void)least_number(0, steps, near_share, asked_of<std::int64_t>([&](std::int64_t length, Reduction& to) {
                           to.until_s[i] = std::round(1e6 * fault.from_s + 1e3 * static_cast<double>(length)) / 1e6;
                         }));
    }
  }

  // A check that is lost on the way ends the run. Any other is judged at the end; then a shorter run counts only when
  // nothing but what is left makes it fail.
  void shorten_run() {
    const double at_s = failed_at_s();
    if (at_s < best_.duration_s - 0.5 * period_s_) {
      Reduction shorter = best_;
      shorter.duration_s = std::round(1e9 * (at_s + period_s_)) / 1e9;
      (void)first_failing({shorter});
      return;
    }
    if (wanted_.check.empty() || !passes_without(best_.duration_s)) return;
    const auto last = static_cast<std::int64_t>(std::ceil(1000 * best_.duration_s));
    (void)least_number(0, last, near_share,
                       [&](const std::vector<std::int64_t>& lengths) -> std::optional<std::size_t> {
                         for (std::size_t i = 0; i < lengths.size(); ++i) {
                           Reduction shorter = best_;
                           shorter.duration_s = static_cast<double>(lengths[i]) / 1000;
                           if (passes_without(shorter.duration_s) && first_failing({shorter})) return i;
                         }
                         return std::nullopt;
                       });
  }
  bool passes_without(double duration_s) {
    Reduction nothing = scenario_.all();
    nothing.disturbances.assign(nothing.disturbances.size(), false);
    nothing.quantities.assign(nothing.quantities.size(), false);
    nothing.duration_s = duration_s;
    return runs_.first({trial(nothing)}, false).has_value();
  }

  // The last tick of the run as it was from which on it passes without the disturbances that are left, and the one
  // after it. The least push and the shortest fault have to act to their end.
  void find_last_moment() {
    const Reduction whole = scenario_.all();
    const auto failed = std::llround(runs_.known(trial(whole)).find(wanted_)->at_s / period_s_);
    if (whole.disturbances.empty() || failed == 0) return;  // nobody knows when a process broke down
    const auto first_saved = [&](const std::vector<std::int64_t>& before) {
      std::vector<Trial> trials;
      for (const std::int64_t ticks : before) {
        trials.push_back(trial(whole));
        trials.back().undisturbed_s = period_s_ * static_cast<double>(failed - ticks);
      }
      const auto found = runs_.first(trials, false);
      tell_progress();
      return found;
    };
    lost_tick_ = 0;
    if (first_saved({failed})) lost_tick_ = failed - least_number(0, failed, 0, first_saved) + 1;
  }

  void tell_progress() const {
    if (options_.json || !stderr_is_terminal()) return;
    std::fprintf(stderr, "\r\033[K  %zu runs: %td of %zu disturbances, %td of %zu quantities\r", runs_.count(),
                 std::ranges::count(best_.disturbances, true), best_.disturbances.size(),
                 std::ranges::count(best_.quantities, true), best_.quantities.size());
  }

  // "It falls because of a push of 3.4 Ns on torso at 1 s and ground.friction = 0.3."
  std::string sentence() const {
    const std::vector<std::string> needed = scenario_.told(best_);
    std::string text = (falls() ? "It falls because of " : "It fails because of ") + listed(needed, {}, ", ", " and ");
    if (needed.empty()) text += "what it plays: no push, no fault, no event and no other quantity is needed";
    return text + "." + moment();
  }
  std::string moment() const {
    if (!lost_tick_) return "";
    if (*lost_tick_ == 0) return " The run as it was could not be saved from its first tick on.";
    return printed(
        " The run as it was could not be saved from tick %lld (%.9g s) on: without any more disturbances it "
        "fails, too.",
        static_cast<long long>(*lost_tick_), period_s_ * static_cast<double>(*lost_tick_));
  }
  bool falls() const {
    return wanted_.told.find("base.height_m") != std::string::npos || wanted_.fault.starts_with("tilt");
  }

  const ShrinkOptions& options_;
  RunChoices choices_;
  ScenarioConfig config_;
  ReducedScenario scenario_;
  TrialRuns runs_;
  TrialFailure wanted_;
  Reduction best_;
  double period_s_ = 0;
  std::optional<std::int64_t> lost_tick_;
  bool complete_ = true;
  std::string out_;
};

std::string Shrinking::report() const {
  const auto left = [](const std::vector<bool>& parts) {
    return printed("%zu -> %td\n", parts.size(), std::ranges::count(parts, true));
  };
  std::string text = config_.name + ", seed " + std::to_string(seed()) + ": " + wanted_.told +
                     (wanted_.fault.empty() ? "" : ", " + wanted_.fault) +
                     printed(" fails at %.6g s\n", std::min(failed_at_s(), best_.duration_s));
  text += "  disturbances  " + left(best_.disturbances) + "  quantities    " + left(best_.quantities);
  if (const double before = impulse_Ns(scenario_.all()); before > 0)
    text += printed("  impulse       %.4g -> %.4g Ns\n", before, impulse_Ns(best_));
  text += printed("  duration      %.6g -> %.6g s\n", scenario_.duration_s(), best_.duration_s);
  text += "  " + std::to_string(runs_.count()) + " runs" +
          (complete_ ? "" : ": no more were allowed (--max-runs), so more may be left than is needed") + "\n";
  return text + sentence() + "\n  again: kadans sim " + shell_word(out_) + "\n";
}

std::string Shrinking::report_json() const {
  const auto left = [](const std::vector<bool>& parts) {
    return Json{{"before", parts.size()}, {"after", std::ranges::count(parts, true)}};
  };
  Json json{{"scenario", config_.name},
            {"file", config_.file},
            {"seed", seed()},
            {"failure", wanted_.told},
            {"check", wanted_.check},
            {"fault", wanted_.fault},
            {"at_s", std::min(failed_at_s(), best_.duration_s)},
            {"disturbances", left(best_.disturbances)},
            {"quantities", left(best_.quantities)},
            {"impulse_Ns", {{"before", impulse_Ns(scenario_.all())}, {"after", impulse_Ns(best_)}}},
            {"duration_s", {{"before", scenario_.duration_s()}, {"after", best_.duration_s}}},
            {"because_of", scenario_.told(best_)},
            {"sentence", sentence()},
            {"lost_tick", nullptr},
            {"runs", runs_.count()},
            {"complete", complete_},
            {"out", out_}};
  if (lost_tick_) json["lost_tick"] = *lost_tick_;
  return json_text(json) + "\n";
}

// In the working directory, when it belongs to the project; else beside the scenario.
std::string out_of(const ShrinkOptions& options, const ScenarioConfig& scenario) {
  const fs::path name = fs::path(scenario.file).stem().string() + "_shrunk.json";
  const bool here = project_root(fs::current_path() / name) == project_root(scenario.file);
  const fs::path out = !options.out.empty() ? fs::path(options.out)
                       : here               ? name
                                            : fs::path(scenario.file).parent_path() / name;
  if (fs::exists(out) && !options.overwrite && !is_device_or_pipe(out))
    refuse(out, "is there already: name another file with --out, or replace it with --overwrite");
  if (fs::exists(out) && fs::equivalent(out, scenario.file)) refuse(out, "is the scenario itself");
  return out.string();
}

int run_shrink(const ShrinkOptions& options) {
  Shrinking shrinking(options, failing_case(options));
  const std::string out = out_of(options, shrinking.config());
  catch_interrupts();
  try {
    shrinking.begin();
    shrinking.shrink();
    shrinking.write(out);
  } catch (const TrialsInterrupted&) {
    return exit_interrupted;
  } catch (const TrialsSpent&) {
    refuse("--max-runs", "is too little: three runs are needed to know the failure");
  }
  print_text(options.json ? shrinking.report_json() : shrinking.report());
  return exit_passed;
}

}  // namespace

void add_shrink(CommandLine& line) {
  const auto [shrink, options] = line.add<ShrinkOptions>(
      "shrink", "Reduce a failing run to the least that still fails in the same way", run_shrink);
  shrink
      ->add_option("scenario", options.scenario,
                   "Scenario that fails (JSON), or the folder of a sweep's results, or the file of one case in it")
      ->required()
      ->type_name("PATH");
  add_seed(*shrink, options.seed, "Seed of the run (default: the scenario's)");
  shrink->add_option("--set", options.set, "A quantity of the run, as of kadans sim; it is taken away where it can be")
      ->type_name("NAME=NUMBER")
      ->allow_extra_args(false);
  shrink->add_option("--play", options.play, "Behaviors to play instead of the scenario's: \"squat, wave\"")
      ->type_name("LIST");
  add_whole(*shrink, "--case", options.number, 0, sweep_cases_max,
            "Case of the sweep (default: the first that failed)");
  shrink->add_option("--check", options.check, "Name of the check that shall fail (default: the one that fails first)")
      ->type_name("NAME");
  add_whole(*shrink, "--max-runs", options.runs_max, 1, 1'000'000, "Stop after so many runs (default: 2000)");
  add_jobs(*shrink, options.jobs);
  shrink->add_option("--out", options.out, "File of the result (default: NAME_shrunk.json in this folder)")
      ->type_name("FILE");
  shrink->add_flag("--overwrite", options.overwrite, "Replace the file when it is there");
  shrink->add_flag("--json", options.json, "Print one JSON object instead of text");
}

}  // namespace kadans
