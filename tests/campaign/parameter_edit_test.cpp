// Parameters are written into a configuration's text, and nothing else in it moves.
#include "kadans/campaign/parameter_edit.h"

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
