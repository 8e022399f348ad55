// A robot for tests of decisions, on which nothing plays: the test says what became of what they asked for. What they
// play is loaded as a run does it, so that a wrong argument is refused.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/assembly/assembly.h"
#include "scenario/run.h"
#include "script/test/behavior_test.h"
#include "set_sensors.h"
#include "supervisor/decide/decisions.h"

namespace kadans {

// What a test asks of any chart. Whether this state is active; nullopt: there is none.
std::optional<bool> in(const Behavior& behavior, const std::string& path);
std::vector<std::string> paths_of(const Chart& chart);
std::string lines_said(const RunLog& log);
std::string way_of(const RunLog& log, const std::string& state);  // the states that it went through

class DecisionStage final : public TestStage {
 public:
  // The scenario plays nothing; its robot, and its supervisor if it has one, are those of the test. Throws InputError.
  DecisionStage(ScenarioConfig scenario, const std::filesystem::path& decisions);

  void advance(double seconds) override;
  const Snapshot& snapshot() const override { return seen_; }
  const Catalog& catalog() const override { return assembly_.catalog(); }
  std::string state() const override { return behavior().state(); }
  std::vector<std::string> active() const override { return behavior().active(); }
  std::optional<bool> in(const std::string& path) const override { return kadans::in(behavior(), path); }
  std::vector<std::string> paths() const override { return paths_of(behavior().chart()); }
  std::string outcome() const override { return behavior().outcome(); }
  std::string error() const override { return behavior().failed() ? behavior().error().text() : ""; }
  std::string result() const override { return behavior().result(); }
  std::string control_sets() const override { return ""; }
  std::string said() const override { return lines_said(log_); }
  std::string went() const override { return way_of(log_, state()); }
  std::string emit(const PlayedEvent& event) override;
  bool set_parameter(const std::string& name, double value) override {
    return decisions_.behavior().set_parameter(name, value);
  }
  bool set_sensor(const std::string& name, double value) override;
  std::string orders() const override { return "{" + orders_ + "}"; }
  std::string messages() const override { return "{" + messages_ + "}"; }
  std::string end_play(const std::string& outcome) override;
  std::string set_playing(const std::string& behavior, const std::string& state) override;

 private:
  const Behavior& behavior() const { return decisions_.behavior(); }
  void decide();
  std::string refusal(const PlayOrder& order);
  void play(const PlayOrder& order);

  ScenarioConfig scenario_;
  RunLog log_;
  Assembly assembly_;
  SetSensors sensors_;
  PlayFolders folders_;
  Decisions decisions_;
  Snapshot seen_;
  PlayReport report_;
  std::string orders_, messages_;  // so far, as the fields of a table of Lua
  std::int64_t period_ns_, next_ns_ = 0;
  double due_s_ = 0;
};

}  // namespace kadans
