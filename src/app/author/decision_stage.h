// A robot for tests of decisions, on which nothing plays: the test says what became of what they asked for. What they
// play is loaded as a run does it, so that a wrong argument is refused.
#pragma once

#include <string>

#include "robot_stage.h"
#include "supervisor/decide/decisions.h"

namespace kadans {

class DecisionStage final : public RobotStage {
 public:
  // The scenario plays nothing; its robot, and its supervisor if it has one, are those of the test. Throws InputError.
  DecisionStage(ScenarioConfig scenario, const std::filesystem::path& decisions);

  Behavior& behavior() override { return decisions_.behavior(); }
  std::string emit(const PlayedEvent& event) override;
  std::string orders() const override { return "{" + orders_ + "}"; }
  std::string messages() const override { return "{" + messages_ + "}"; }
  std::string end_play(const std::string& outcome) override;
  std::string set_playing(const std::string& behavior, const std::string& state) override;

 private:
  void stepped(std::int64_t time_ns) override;
  void decide();
  std::string refusal(const PlayOrder& order);
  void play(const PlayOrder& order);

  PlayFolders folders_;
  Decisions decisions_;
  PlayReport report_;
  std::string orders_, messages_;  // so far, as the fields of a table of Lua
  std::int64_t period_ns_, next_ns_ = 0;
};

}  // namespace kadans
