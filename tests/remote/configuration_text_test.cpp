#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"
#include "remote/instance/parameter_history.h"
#include "remote/live_instance.h"

namespace configuration_text_test {

using namespace kadans;
using namespace kadans::remote_test;

namespace {

std::string why_not(ConfigurationText& text, const std::vector<ParameterChange>& changes, const Catalog& catalog) {
  try {
    text.save(changes, catalog);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("nothing is written when one of the parameters has no place in the file") {
  const LiveInstance live;
  ConfigurationText text(live.project.configuration());
  const std::string before = live.project.read("config/bench/robot.json");
  const std::string why =
      why_not(text, {{"posture.hip.kp_Nm_per_rad", 40, 50}, {"both.posture.weight", 1, 2}}, live.robot.catalog);
  CHECK(why.find("both.posture.weight belongs to no control object") != std::string::npos);
  CHECK(live.project.read("config/bench/robot.json") == before);
  CHECK(why_not(text, {{"posture.hip.kp_Nm_per_rad", 40, 50}}, live.robot.catalog).empty());
  CHECK(why_not(text, {{"spare.knee.kp_Nm_per_rad", 40, 45}}, live.robot.catalog).empty());  // it knows its own text
  CHECK(live.project.read("config/bench/robot.json").find("{ \"knee.kp_Nm_per_rad\": 45 }") != std::string::npos);
  ConfigurationText none({});
  CHECK(why_not(none, {}, live.robot.catalog) == "this instance was not made from a configuration file");
}

}  // namespace configuration_text_test
