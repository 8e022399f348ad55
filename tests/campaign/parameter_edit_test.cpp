// Parameters are written into a configuration's text, and nothing else in it moves.
#include "campaign/sweep/parameter_edit.h"

#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"

using namespace kadans;

namespace {

const std::string text = R"({
  // Ünder test; the numbers are E.
  "control": { "objects": [
    { "name": "arm", "parameters": {"kp": 1} },
    {
      "name": "posture",  /* the legs */
      "parameters": {
        "*.kp": 300.0,
        "*_knee.kd":   4,   // by hand
        "*.ki": 100
      }
    },
    { "name": "bare", "type": "x" } ] }
}
)";

std::string edited(const ParameterEdit& edit) { return edit_parameters(text, "r.json", {edit}); }

std::string with(const std::string& from, const std::string& to) {
  std::string all = text;
  return all.replace(all.find(from), from.size(), to);
}

}  // namespace

TEST_CASE("The number of an entry with the same pattern is replaced where it stands") {
  CHECK(edited({"posture", "*_knee.kd", {"l_knee.kd"}, 5.25}) == with("  4,", "  5.25,"));
  CHECK(edited({"posture", "*.kp", {"l_knee.kp"}, 250}) == with("300.0", "250"));
  CHECK(edited({"arm", "kp", {"kp"}, 2}) == with("{\"kp\": 1}", "{\"kp\": 2}"));
}

TEST_CASE("A new entry stands behind the others as they stand") {
  CHECK(edited({"posture", "*_hip.kp", {"l_hip.kp"}, 7}) == with("100\n", "100,\n        \"*_hip.kp\": 7\n"));
  CHECK(edited({"arm", "kd", {"kd"}, 2}) == with("{\"kp\": 1}", "{\"kp\": 1, \"kd\": 2}"));
  CHECK(edited({"bare", "kd", {"kd"}, 2}) == with("\"type\"", "\"parameters\": { \"kd\": 2 }, \"type\""));
}

TEST_CASE("An entry that a later one would overrule is written behind that one") {
  const std::string later = with("\"*.ki\": 100", "\"l_*.kp\": 90");
  const std::string result = edit_parameters(later, "r.json", {{"posture", "*.kp", {"l_knee.kp", "r_knee.kp"}, 50}});
  CHECK(result.find("\"*.kp\": 300.0") != std::string::npos);
  CHECK(result.find("\"l_*.kp\": 90,\n        \"l_knee.kp\": 50,\n        \"r_knee.kp\": 50\n") != std::string::npos);
}

TEST_CASE("An object that is not there is refused") {
  CHECK_THROWS_WITH_AS(edited({"legs", "kp", {"kp"}, 1}), "r.json:1:1: there is no control object 'legs' in it",
                       InputError);
}

TEST_CASE("A number goes into a preset of an object, and one that is not there is refused") {
  const std::string presets = with("\"type\": \"x\"", "\"presets\": { \"stiff\": { \"*.kp\": 9 }, \"soft\": {} }");
  const auto put = [&](const ParameterEdit& edit) { return edit_parameters(presets, "r.json", {edit}); };
  CHECK(put({"bare", "*.kp", {"l_knee.kp"}, 8, "stiff"}).find("\"*.kp\": 8 }") != std::string::npos);
  CHECK(put({"bare", "l_knee.kp", {"l_knee.kp"}, 8, "stiff"}).find("\"*.kp\": 9, \"l_knee.kp\": 8 }") !=
        std::string::npos);
  CHECK(put({"bare", "kd", {"kd"}, 3, "soft"}).find("\"soft\": { \"kd\": 3 }") != std::string::npos);
  CHECK_THROWS_WITH_AS(put({"bare", "kd", {"kd"}, 3, "stif"}),
                       "r.json:13:5: control object 'bare' has no preset 'stif' in it", InputError);
  CHECK_THROWS_AS(put({"arm", "kd", {"kd"}, 3, "stiff"}), InputError);
}

TEST_CASE("What a robot says of its behaviors is changed where it stands, or added as the keys around it stand") {
  const auto put = [](const std::string& to, const BehaviorEdit& edit) { return edit_behaviors(to, "r.json", {edit}); };
  const BehaviorEdit depth{"squat", "depth_m", 0.08};
  const std::string added = "  \"behaviors\": { \"squat\": { \"depth_m\": 0.08 } },\n";
  CHECK(put(text, depth) == with("  // Ünder", added + "  // Ünder"));  // above what is said of the key behind it
  CHECK(put(R"({"name": "x", "control": {}})", depth) ==
        R"({"name": "x", "behaviors": { "squat": { "depth_m": 0.08 } }, "control": {}})");
  CHECK(put("{}", depth) == R"({ "behaviors": { "squat": { "depth_m": 0.08 } } })");

  const std::string some = R"({
  "behaviors": {
    // by hand
    "wave": { "beat_s": 1 },  // slow
    "squat": {
      "hold_s": 2
    }
  }
})";
  std::string wanted = some;
  CHECK(put(some, depth) == wanted.replace(wanted.find("2\n"), 1, "2,\n      \"depth_m\": 0.08"));
  wanted = some;
  CHECK(put(some, {"squat", "hold_s", 2.5}) == wanted.replace(wanted.find("2\n"), 1, "2.5"));
  wanted = some;
  CHECK(put(some, {"stand", "x", 1}) ==
        wanted.replace(wanted.find("    // by hand"), 0, "    \"stand\": { \"x\": 1 },\n"));
  CHECK(put(R"({"behaviors": {}})", depth) == R"({"behaviors": { "squat": { "depth_m": 0.08 } }})");
  CHECK(put(R"({"behaviors": {"squat": {}}})", depth) == R"({"behaviors": {"squat": { "depth_m": 0.08 }}})");
}
