// A changed file is taken while the robot moves: what the record shows of it, and the program at wall-clock pace.
#include <algorithm>
#include <cmath>
#include <csignal>

#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "app/program.h"

using namespace kadans;

namespace {

void rename_over(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path other = file.string() + ".new";
  program::write(other, text);
  std::filesystem::rename(other, file);
}

// Looks at every set-point of the posture in every tick, and edits the file meanwhile as an editor would.
class Witness final : public RunObserver {
 public:
  Witness(const Catalog& catalog, std::filesystem::path file, std::vector<std::string> texts)
      : file_(std::move(file)), texts_(std::move(texts)) {
    for (SignalId id = 0; id < catalog.signals.size(); ++id) {
      const std::string& name = catalog.signals.info(id).name;
      if (name.starts_with("control.posture.") && name.ends_with(".reference_rad")) positions_.push_back(id);
    }
    state_ = catalog.signals.find("behavior.squat.reloads").value();
    last_.resize(positions_.size());
    speed_.resize(positions_.size());
  }

  void tick(double time_s, std::span<const double> row) override {
    if (ticks_ > 0) late_ = std::max(late_, std::abs(time_s - last_s_ - 0.001));
    const bool near = row[state_] != reloads_ || ticks_ - taken_at_ < 20;
    if (row[state_] != reloads_) reloads_ = row[state_], taken_at_ = ticks_;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const double now = row[positions_[i]], step = now - last_[i];
      if (ticks_ > 1) note(near, step, step - speed_[i]);
      last_[i] = now;
      speed_[i] = ticks_ > 0 ? step : 0;
    }
    last_s_ = time_s;
    if (++ticks_ % 250 == 0 && !texts_.empty() && time_s > 1.6) rename_over(file_, texts_[edits_++ % texts_.size()]);
  }

  std::size_t joints() const { return positions_.size(); }
  double late() const { return late_; }
  double reloads() const { return reloads_; }
  // Of the set-points from one tick to the next: their change, and the change of that.
  struct Most {
    double step_rad = 0, change_rad = 0;
  };
  const Most& most_near() const { return near_; }  // within 20 ticks after a reload
  const Most& most_else() const { return else_; }

 private:
  void note(bool near, double step, double change) {
    Most& most = near ? near_ : else_;
    most.step_rad = std::max(most.step_rad, std::abs(step));
    most.change_rad = std::max(most.change_rad, std::abs(change));
  }

  std::filesystem::path file_;
  std::vector<std::string> texts_;
  std::vector<SignalId> positions_;
  SignalId state_ = 0;
  std::vector<double> last_, speed_;
  double last_s_ = 0, late_ = 0, reloads_ = 0;
  std::int64_t ticks_ = 0, taken_at_ = -1000;
  std::size_t edits_ = 0;
  Most near_, else_;
};

std::string says(const std::string& word) {
  return "local k = require 'kadans'\nreturn k.behavior 'squat' { controls = 'posture', vars = { said = '' },\n"
         "k.state 'a' { endless = true, enter = function(m) m.posture:set_gains 'stiff' end, during = function(m)\n"
         "if m.vars.said ~= '" +
         word + "' then m.vars.said = '" + word + "' print '" + word + " plays' end end } }\n";
}

}  // namespace

TEST_CASE("No set-point jumps, no tick is late and no command is lost when another text of the squat is taken") {
  const auto folder = program::project_copy("live_reload");
  const auto file = folder / "behaviors/tulip/squat.lua";
  const std::string deep = program::read(file);
  std::string flat = deep;
  flat.replace(flat.find("0.10, min"), 4, "0.08");
  const ScenarioConfig scenario = read_scenario_config(folder / "config/scenarios/squat.json");
  RunLog log;
  Assembly robot(scenario, 3, log);
  robot.watch_behaviors();
  Witness witness(robot.catalog(), file, {flat, deep});
  REQUIRE(witness.joints() == 12);
  Checks checks(robot.catalog().signals);
  const RunParts parts = robot.parts();
  const RunResult result = run_scenario(parts, 9, checks, {&witness});
  CHECK(witness.reloads() >= 25);
  CHECK(witness.late() < 1e-9);
  CHECK(result.control_ticks == 9000);
  CHECK(result.behavior_ticks == 900);
  CHECK(result.commands_refused == 0);
  CHECK(result.faults.empty());
  CHECK_FALSE(log.has_errors());
  // In speed and in acceleration the set-points near a reload stay within what they do anyway.
  CHECK(witness.most_else().step_rad > 0.0002);
  CHECK(witness.most_near().step_rad <= 1.05 * witness.most_else().step_rad);
  CHECK(witness.most_near().change_rad <= 1.2 * witness.most_else().change_rad);
}

TEST_CASE(
    "sim with realtime and watch takes what an editor renames over the file, refuses what is wrong, and goes on") {
  const auto folder = program::project_copy("live_watch");
  const auto file = folder / "behaviors/tulip/squat.lua";
  program::write(file, says("first"));
  program::Running live(folder,
                        "sim config/scenarios/squat.json --realtime --watch --no-record --duration 120 >/dev/null");
  CAPTURE(live.heard());
  REQUIRE(live.says("squat: first plays"));
  rename_over(file, says("second"));
  REQUIRE(live.says("reloaded behaviors/tulip/squat.lua"));
  REQUIRE(live.says("squat: second plays"));
  rename_over(file, says("third").substr(0, 150));
  REQUIRE(live.says("reload refused, the old version goes on: behaviors/tulip/squat.lua:"));
  program::write(file, says("fourth"));
  REQUIRE(live.says("squat: fourth plays"));
  CHECK_FALSE(program::has(live.heard(), "third plays"));
  CHECK(live.end(SIGINT) == 130);
}
