// `kadans new scenario`: what the robot does, with checks. It is run while it is written, as it is and with motors that
// give no torque: so the checks are known to hold, and known to fail.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/assembly/assembly.h"
#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "kadans/signal/shell_word.h"
#include "new_files.h"
#include "new_subject.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double push_at_s = 1, push_for_s = 0.1, quiet_s = 4;
constexpr double played_most_s = 60;

double to_unit(double value, double unit) { return std::round(value / unit) / std::round(1 / unit); }

// A push that the robot must bear when nothing plays: a robot that stands gets it at its base, any other at the end of
// its longest chain.
struct NewPush {
  std::size_t link = 0;
  std::vector<std::size_t> chain;  // its joints
  Vec3 point_m{};
  double impulse_Ns = 0;  // along each axis
};

NewPush push_for(const NewSubject& subject) {
  const RobotModel& model = subject.model();
  NewPush push;
  if (subject.stands()) return push.impulse_Ns = 0.04 * model.mass_kg(), push;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    std::vector<std::size_t> chain{i};
    while (model.joints[chain.back()].parent > 0) chain.push_back(model.joints[chain.back()].parent - 1);
    if (chain.size() <= push.chain.size()) continue;
    push.chain = std::move(chain);
    push.link = i + 1;
  }
  const Inertia& inertia = model.links[push.link].inertia;
  push.point_m = inertia.com_m;  // off the axis
  for (double& at_m : push.point_m) at_m = to_unit(at_m + 0.03, 1e-3);
  push.impulse_Ns = 0.1 * inertia.mass_kg;
  return push;
}

// What a run showed.
struct SeenRun : RunObserver {
  explicit SeenRun(const SignalTable& table, std::vector<SignalId> watched_signals)
      : watched(std::move(watched_signals)) {
    done = table.find("play.done");
    not_done = table.find("play.not_done");
    height = table.find("plant.base.height_m").value();
    tilt = table.find("plant.base.tilt_rad").value();
    before.resize(watched.size());
  }
  void tick(double time_s, std::span<const double> row) override {
    height_min_m = std::min(height_min_m, row[height]);
    tilt_max_rad = std::max(tilt_max_rad, row[tilt]);
    if (time_s < push_at_s) {
      for (std::size_t i = 0; i < watched.size(); ++i) before[i] = row[watched[i]];
    }
    if (!over_s && done && row[*done] + row[*not_done] > 0 && ended(row)) over_s = time_s;
  }
  bool ended(std::span<const double> row) const { return row[*done] + row[*not_done] >= static_cast<double>(played); }
  bool stop_asked() const override { return until_over && over_s.has_value(); }

  std::vector<SignalId> watched;
  std::vector<double> before;  // of the watched signals, before the push
  std::optional<SignalId> done, not_done;
  SignalId height = 0, tilt = 0;
  double height_min_m = std::numeric_limits<double>::infinity(), tilt_max_rad = 0;
  std::optional<double> over_s;  // when everything had been played
  std::size_t played = 0;
  bool until_over = false;
};

struct TriedRun {
  RunResult result;
  std::unique_ptr<SeenRun> seen;
  std::string failed_check() const {
    for (const CheckResult& check : result.checks) {
      if (!check.passed) return check.name;
    }
    return result.passed ? "" : "the run itself";
  }
};

TriedRun try_run(const Json& json, const fs::path& file, const std::vector<std::string>& signals, bool limp,
                 bool until_over) {
  ScenarioConfig scenario = read_scenario_config_text(json_text(json, 2), file.string());
  if (limp) scenario.set_last.push_back({.key = "joint.*.torque_scale", .value = 0});
  RunLog log;
  Assembly assembly(scenario, scenario.seed, log);
  const SignalTable& table = assembly.catalog().signals;
  std::vector<SignalId> watched;
  for (const std::string& name : signals) watched.push_back(table.find(name).value());
  TriedRun tried{.result = {}, .seen = std::make_unique<SeenRun>(table, watched)};
  tried.seen->played = scenario.behaviors.size();
  tried.seen->until_over = until_over;
  Checks checks(table, scenario.checks, scenario.file, assembly.signal_states());
  tried.result = run_scenario(assembly.parts(), scenario.duration_s, checks, {tried.seen.get()});
  return tried;
}

Json checks_json(const NewSubject& subject, const NewPush& push, const SeenRun& seen, bool plays) {
  Json checks = Json::array();
  if (subject.stands()) {
    checks.push_back({{"name", "stays up, lowest height in m"},
                      {"kind", "always"},
                      {"signal", "plant.base.height_m"},
                      {"min", to_unit(0.8 * seen.height_min_m, 1e-3)}});
    checks.push_back({{"name", "upright, rad"},
                      {"kind", "always"},
                      {"signal", "plant.base.tilt_rad"},
                      {"max", to_unit(seen.tilt_max_rad + 0.15, 1e-2)}});
  }
  if (plays) {
    const double done = static_cast<double>(seen.played);
    checks.push_back({{"name", "all of it ends as done"},
                      {"kind", "at_end"},
                      {"signal", "play.done"},
                      {"min", done},
                      {"max", done}});
  }
  for (std::size_t i = 0; i < seen.watched.size(); ++i) {
    const Joint& joint = subject.model().joints[push.chain[i]];
    const double room = joint.type == JointType::prismatic ? 0.01 : 0.05;
    checks.push_back({{"name", joint.name + " comes back"},
                      {"kind", "at_end"},
                      {"signal", "joint." + joint.name + ".position_rad"},
                      {"min", to_unit(seen.before[i] - room, 1e-3)},
                      {"max", to_unit(seen.before[i] + room, 1e-3)}});
  }
  checks.push_back({{"name", "at rest at the end"}, {"kind", "at_end"}, {"that", "plant.limits.speed_share <= 0.1"}});
  checks.push_back({{"name", "no faults"}, {"kind", "always"}, {"signal", "safety.faults"}, {"max", 0}});
  return checks;
}

struct WrittenScenario {
  Json json;
  std::string limp;  // the check that fails without torque; "": none does
};

std::optional<WrittenScenario> with_push(const NewSubject& subject, const NewPush& push, Json json,
                                         const fs::path& file) {
  const double impulse = to_unit(push.impulse_Ns, push.impulse_Ns < 0.1 ? 1e-4 : 1e-2);
  Json written{{"link", subject.model().links[push.link].name}, {"at_s", push_at_s}, {"duration_s", push_for_s}};
  if (subject.stands()) {
    written["impulse_Ns"] = {impulse, 0, 0};
  } else {
    written["impulse_Ns"] = {impulse, impulse, impulse};
    written["point_m"] = push.point_m;
  }
  json["pushes"] = {written};
  json["duration_s"] = push_at_s + quiet_s;
  std::vector<std::string> signals;
  for (const std::size_t joint : push.chain)
    signals.push_back("joint." + subject.model().joints[joint].name + ".position_rad");
  const TriedRun first = try_run(json, file, signals, false, false);
  json["checks"] = checks_json(subject, push, *first.seen, false);
  if (!try_run(json, file, {}, false, false).result.passed) return std::nullopt;
  const TriedRun limp = try_run(json, file, {}, true, false);
  return WrittenScenario{std::move(json), limp.failed_check()};
}

// The push with which it passes, and fails without torque: halved while the robot does not bear it, doubled while a
// robot without torque bears it, too.
WrittenScenario pushed(const NewSubject& subject, const Json& json, const fs::path& file) {
  NewPush push = push_for(subject);
  std::optional<WrittenScenario> best;
  for (int tries = 0; tries < 8; ++tries) {
    std::optional<WrittenScenario> written = with_push(subject, push, json, file);
    if (written && (!best || !written->limp.empty())) best = written;
    if (best && (!best->limp.empty() || !written)) return *best;
    push.impulse_Ns *= written ? 2 : 0.5;
  }
  if (best) return *best;
  refuse(subject.file(), "does not come to rest within " + std::to_string(static_cast<int>(quiet_s)) +
                             " s after a push, however small: let it hold first (`kadans sim` of a scenario without "
                             "checks shows what it does), or name what it shall do: --play LIST");
}

WrittenScenario played(const NewSubject& subject, Json json, const fs::path& file, const std::string& list) {
  json["behaviors"] = {list};
  json["duration_s"] = played_most_s;
  const TriedRun first = try_run(json, file, {}, false, true);
  if (!first.seen->over_s)
    refuse("'" + list + "' does not end within " + std::to_string(static_cast<int>(played_most_s)) +
           " s, so there is no end to check; write its scenario by hand (docs/scenarios.md)");
  json["duration_s"] = std::ceil(*first.seen->over_s + 1);
  json["checks"] = checks_json(subject, {}, *first.seen, true);
  const TriedRun whole = try_run(json, file, {}, false, false);
  if (!whole.result.passed)
    refuse("'" + list + "' does not do what its scenario would check: " + whole.failed_check() + "; `kadans run " +
           subject.robot_file + " --play ... --live` shows it");
  const TriedRun limp = try_run(json, file, {}, true, false);
  return {std::move(json), limp.failed_check()};
}

int run_new_scenario(const NewPartOptions& options) {
  refuse_bad_name(options.name, "a scenario", "nudged");
  NewSubject subject = read_subject(options);
  subject.system.reset();  // of an object there may be one in a program, and the runs have their own
  const fs::path file = subject.project / "config/scenarios" / (options.name + ".json");
  if (fs::exists(file)) write_new_files({file}, {});  // refuses, before the runs
  const Json json{{"name", options.name},
                  {"doc", options.play.empty() ? "Pushed while it holds." : "Plays " + options.play + "."},
                  {"robot", subject.robot_file},
                  {"duration_s", 1}};
  const WrittenScenario written =
      options.play.empty() ? pushed(subject, json, file) : played(subject, json, file, options.play);
  write_new_files({file}, {{fs::proximate(file), json_text(written.json, 2) + "\n"}});
  if (written.limp.empty()) {
    std::fprintf(stderr, "warning: it passes with motors that give no torque, too: its checks say little yet\n");
  } else {
    std::fprintf(stderr, "With motors that give no torque it fails, as it must: %s\n", written.limp.c_str());
  }
  const std::string shown = shell_word("config/scenarios/" + options.name + ".json");
  tell_command("Run it  ", subject.project, "sim " + shown);
  tell_command("Break it", subject.project, "sim " + shown + " --set 'joint.*.torque_scale=0'");
  return options.no_run ? exit_passed : run_kadans({"sim", fs::absolute(file).string(), "--no-record"});
}

}  // namespace

void add_new_scenario(CLI::App& made, CommandLine& line) {
  const auto [scenario, options] = line.add<NewPartOptions>(
      made, "scenario", "Write a scenario with checks that hold, and that fail without torque; run it",
      run_new_scenario);
  add_part_options(*scenario, options, "Its name, for example nudged", "Do not run it at the end");
  scenario
      ->add_option("--play", options.play, "Behaviors to play: \"squat, wave\" (default: none, the robot is pushed)")
      ->type_name("LIST");
}

}  // namespace kadans
