// Scenarios: what the parts mean, and what is said to wrong ones.
#include "config/scenario/scenario_config.h"

#include <filesystem>

#include <doctest/doctest.h>

#include "broken_scenarios.h"
#include "right_texts.h"

namespace kadans::scenario_config_test {
namespace {

const std::string file = KADANS_SOURCE_DIR "/config/t.json";

}  // namespace

TEST_CASE("Every broken scenario is refused at its place, with what was meant") {
  const auto refusal_of = [](const std::string& text) {
    return refusal(file, KADANS_SOURCE_DIR, [&] { read_scenario_config_text(text, file); });
  };
  CHECK(refusal_of(right_scenario).empty());
  for (const Broken& broken : broken_scenarios) {
    CAPTURE(broken.replace);
    const std::string text = replaced(right_scenario, broken.find, broken.replace);
    CHECK(text != right_scenario);
    CHECK(refusal_of(text) == std::string(broken.message));
  }
}

TEST_CASE("A scenario names its robot and behaviors by path and bounds signals in time") {
  const ScenarioConfig scenario = read_scenario_config_text(right_scenario, file);
  CHECK(scenario.name == "stand");
  CHECK(scenario.plant == "bullet");
  CHECK(scenario.duration_s == 2.5);
  CHECK(scenario.seed == 7);
  CHECK(scenario.robot == KADANS_SOURCE_DIR "/config/tulip/robot.json");
  REQUIRE(scenario.behaviors.size() == 1);
  CHECK(scenario.behaviors[0].file == KADANS_SOURCE_DIR "/models/tulip/tulip.urdf");
  CHECK(scenario.behaviors[0].place == TextPlace{7, 18});
  REQUIRE(scenario.checks.size() == 3);
  CHECK(scenario.checks[0].kind == CheckKind::always);
  CHECK(scenario.checks[0].max == 0.05);
  CHECK(scenario.checks[0].min == -std::numeric_limits<double>::infinity());
  CHECK(scenario.checks[2].kind == CheckKind::never);
  CHECK(scenario.checks[2].until_s == 2);
  CHECK(scenario.checks[2].signal_place == TextPlace{11, 51});
}

TEST_CASE("A scenario's joystick is played from its first tick and never lost, unless it says so") {
  const std::string with = "\"seed\": 7, \"joystick\": { \"recording\": \"models/tulip/tulip.urdf\" }";
  const ScenarioConfig scenario = read_scenario_config_text(replaced(right_scenario, "\"seed\": 7", with), file);
  CHECK(scenario.joystick.recording == KADANS_SOURCE_DIR "/models/tulip/tulip.urdf");
  CHECK(scenario.joystick.at_s == 0);
  CHECK(scenario.joystick.lost_at_s == std::numeric_limits<double>::infinity());
}

TEST_CASE("A seed keeps all its 64 bits") {
  const std::string text = replaced(right_scenario, "\"seed\": 7", "\"seed\": 18446744073709551615");
  CHECK(read_scenario_config_text(text, file).seed == 18446744073709551615U);
}

TEST_CASE("A signal that nobody records is refused where the scenario names it") {
  const std::vector<std::string> signals{"base.tilt_rad", "base.height_m"};
  const PlacedName wrong{"base.tillt_rad", {9, 54}};
  CHECK(refusal(file, "", [&] { refuse_unknown(file, wrong, "signal", signals); }) ==
        "9:54: unknown signal 'base.tillt_rad', did you mean 'base.tilt_rad'?");
}

TEST_CASE("The scenarios that come with Kadans can be read") {
  for (const auto& entry : std::filesystem::directory_iterator(KADANS_SOURCE_DIR "/config/scenarios")) {
    if (entry.path().extension() != ".json") continue;
    CAPTURE(entry.path().string());
    CHECK_FALSE(read_scenario_config(entry.path()).checks.empty());
  }
}

}  // namespace kadans::scenario_config_test
