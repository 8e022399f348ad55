// Live tuning: ranges, undo, and the way back into the configuration.
#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"
#include "remote/instance/parameter_history.h"
#include "remote/live_instance.h"
#include "telemetry/mcap/mcap_reader.h"

namespace ctl_tuning_test {

using namespace kadans;
using namespace kadans::remote_test;

namespace {

const char* const kd = "posture.hip.kd_Nms_per_rad";

Json set(const LiveInstance& live, const std::string& name, double value) {
  return live.ask({{"verb", "set"}, {"name", name}, {"value", value}});
}
double get(const LiveInstance& live, const std::string& name) {
  return live.ask({{"verb", "get"}, {"name", name}})["value"];
}
bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("set changes a parameter in the control engine, a value out of range or an unknown name changes nothing") {
  LiveInstance live;
  live.start();
  const Json done = set(live, hip_kp, 55);
  CHECK(done["ok"] == true);
  CHECK(done["before"] == 40);
  CHECK(done["now"] == 55);
  CHECK(get(live, hip_kp) == 55);
  const Json high = set(live, hip_kp, 1e9);
  CHECK(high["ok"] == false);
  CHECK(has(high["error"], std::string(hip_kp) + " = 1e+09 is outside its range"));
  CHECK(has(set(live, "posture.hip.kp", 1)["error"], "unknown parameter"));
  CHECK(get(live, hip_kp) == 55);
}

TEST_CASE("undo goes back step by step, through all clients' changes") {
  LiveInstance live;
  live.start();
  for (const double value : {50, 60}) CHECK(set(live, hip_kp, value)["ok"] == true);
  CHECK(set(live, kd, 5)["ok"] == true);
  CHECK(live.ask({{"verb", "undo"}})["name"] == kd);
  CHECK(live.ask({{"verb", "undo"}})["now"] == 50);
  CHECK(live.ask({{"verb", "undo"}})["now"] == 40);
  CHECK(live.ask({{"verb", "undo"}})["error"] == "there is nothing to undo");
  CHECK(get(live, hip_kp) == 40);
  CHECK(get(live, kd) == 4);
}

TEST_CASE("save writes what was changed where it stands, with comments and order, and keeps the file's mode") {
  LiveInstance live;
  live.start();
  const std::string before = live.project.read("config/bench/robot.json");
  REQUIRE(chmod(live.project.configuration().c_str(), 0640) == 0);
  CHECK(live.ask({{"verb", "save"}})["saved"].empty());
  CHECK(set(live, hip_kp, 55)["ok"] == true);
  CHECK(set(live, kd, 6.5)["ok"] == true);
  const Json saved = live.ask({{"verb", "save"}});
  CHECK(saved["saved"].size() == 2);
  std::string wanted = before;
  wanted.replace(wanted.find("\"hip.kd_Nms_per_rad\": 4"), 23,
                 "\"hip.kd_Nms_per_rad\": 6.5, \"hip.kp_Nm_per_rad\": 55");
  CHECK(live.project.read("config/bench/robot.json") == wanted);
  struct stat found {};
  REQUIRE(stat(live.project.configuration().c_str(), &found) == 0);
  CHECK((found.st_mode & 0777U) == 0640U);
  CHECK(live.ask({{"verb", "save"}})["saved"].empty());
  CHECK(live.ask({{"verb", "undo"}})["now"] == 4);  // a change again
  CHECK(live.ask({{"verb", "save"}})["saved"][0]["now"] == 4);
}

TEST_CASE("save writes parameters of behaviors under `behaviors`, where the next run finds them") {
  LiveInstance live;
  live.start();
  const std::string before = live.project.read("config/bench/robot.json");
  CHECK(live.ask({{"verb", "play"}, {"list", "wait"}})["ok"] == true);
  CHECK(set(live, "wait.level", 2)["ok"] == true);
  const Json saved = live.ask({{"verb", "save"}});
  CHECK(saved["ok"] == true);
  REQUIRE(saved["saved"].size() == 1);
  CHECK(saved["saved"][0]["name"] == "wait.level");
  CHECK(saved["overridden"].empty());
  std::string wanted = before;
  wanted.insert(wanted.find("  \"control\""), "  \"behaviors\": { \"wait\": { \"level\": 2 } },\n");
  CHECK(live.project.read("config/bench/robot.json") == wanted);
  CHECK(live.ask({{"verb", "save"}})["saved"].empty());
  CHECK(live.ask({{"verb", "undo"}})["now"] == 1);  // a change again
  CHECK(live.ask({{"verb", "save"}})["saved"][0]["now"] == 1);
}

TEST_CASE("save tells which presets override what was saved, and writes into one that is named") {
  LiveInstance live;
  const auto id = live.robot.catalog.parameters.find(hip_kp);
  REQUIRE(id);
  for (ObjectInfo& object : live.robot.catalog.objects) {
    if (object.name == "posture") object.presets = {{"stiff", {{*id, 90}}}, {"same", {{*id, 55}}}, {"other", {}}};
  }
  live.start();
  CHECK(set(live, hip_kp, 55)["ok"] == true);
  CHECK(set(live, kd, 6)["ok"] == true);
  const Json nowhere = live.ask({{"verb", "save"}, {"preset", "other"}});
  CHECK(nowhere["ok"] == false);
  CHECK(has(nowhere["error"], "preset 'other' sets none of what was changed; nothing was saved"));
  const Json saved = live.ask({{"verb", "save"}});
  CHECK(saved["saved"].size() == 2);
  REQUIRE(saved["overridden"].size() == 1);
  CHECK(saved["overridden"][0] == Json{{"name", hip_kp}, {"preset", "stiff"}, {"value", 90.0}});
  const Json absent = live.ask({{"verb", "save"}, {"preset", "stiff"}});  // of this robot's file, that is
  CHECK(has(absent["error"], "control object 'posture' has no preset 'stiff' in it"));
}

TEST_CASE("what was saved can go into a preset as well, later too, and then that overrides nothing any more") {
  LiveInstance live;
  const auto id = live.robot.catalog.parameters.find(hip_kp);
  REQUIRE(id);
  for (ObjectInfo& object : live.robot.catalog.objects) {
    if (object.name == "posture") object.presets = {{"stiff", {{*id, 90}}}};
  }
  std::string text = live.project.read("config/bench/robot.json");
  text.insert(text.find("\"parameters\""), "\"presets\": { \"stiff\": { \"*.kp_Nm_per_rad\": 90 } }, ");
  ConfigurationText file(live.project.configuration(), "bench");
  CHECK_THROWS_AS(file.save({{hip_kp, 40, 55, {}}}, live.robot.catalog, {"stiff", {{hip_kp, 40, 55, {}}}}), InputError);
  live.project.write("config/bench/robot.json", text);
  ConfigurationText known(live.project.configuration(), "bench");
  const auto overridden = known.save({{hip_kp, 40, 55, {}}}, live.robot.catalog);
  REQUIRE(overridden.size() == 1);
  CHECK(known.told(1, overridden) ==
        "1 parameters stand in robot.json; presets override posture.hip.kp_Nm_per_rad (stiff 90)");
  CHECK(known.save({}, live.robot.catalog, {"stiff", {{hip_kp, 40, 55, {}}}}).empty());
  CHECK(has(live.project.read("config/bench/robot.json"),
            "\"stiff\": { \"*.kp_Nm_per_rad\": 90, \"hip.kp_Nm_per_rad\": 55 }"));
  CHECK(known.save({{hip_kp, 40, 55, {}}}, live.robot.catalog).empty());
  CHECK_THROWS_WITH_AS(known.save({{"wave.x", 1, 2, "behaviors/lib/arm.lua"}}, live.robot.catalog),
                       "wave.x is declared in behaviors/lib/arm.lua, and a robot's file names behaviors of "
                       "behaviors/bench alone: change it there, or 'kadans ctl undo'",
                       InputError);
}

TEST_CASE("save refuses when somebody edited the file meanwhile, and their text stays") {
  LiveInstance live;
  live.start();
  CHECK(set(live, hip_kp, 55)["ok"] == true);
  const std::string theirs = live.project.read("config/bench/robot.json") + "// mine\n";
  live.project.write("config/bench/robot.json", theirs);
  const Json refused = live.ask({{"verb", "save"}});
  CHECK(refused["ok"] == false);
  CHECK(has(refused["error"], "was changed since this instance read it"));
  CHECK(live.project.read("config/bench/robot.json") == theirs);
}

TEST_CASE("save follows a link to the file and leaves the link") {
  LiveInstance live;
  live.start();
  namespace fs = std::filesystem;
  fs::rename(live.project.configuration(), live.project.root / "real.json");
  fs::create_symlink(live.project.root / "real.json", live.project.configuration());
  CHECK(set(live, hip_kp, 55)["ok"] == true);
  CHECK(live.ask({{"verb", "save"}})["ok"] == true);
  CHECK(fs::is_symlink(live.project.configuration()));
  CHECK(has(live.project.read("real.json"), "\"hip.kp_Nm_per_rad\": 55"));
}

TEST_CASE("every change stands in the record with who made it, the old value and the new one") {
  LiveInstance live;
  live.start();
  CHECK(live.ask({{"verb", "record_start"}, {"file", "tuned.mcap"}})["ok"] == true);
  CHECK(set(live, hip_kp, 55)["ok"] == true);
  CHECK(live.ask({{"verb", "undo"}})["ok"] == true);
  CHECK(live.ask({{"verb", "estop"}})["ok"] == true);
  (void)live.ask_until({{"verb", "faults"}}, [](const Json& a) { return has(a.dump(), "emergency_stop"); });
  CHECK(live.ask({{"verb", "record_stop"}})["ok"] == true);
  McapReader record((live.project.root / "tuned.mcap").string());
  std::string log;
  for (McapMessage message; record.next(message);) {
    const std::string& topic = record.channels().at(message.channel).topic;
    if (topic == "/log" || topic == "/faults")
      log += std::string(reinterpret_cast<const char*>(message.payload.data()), message.payload.size()) + "\n";
  }
  const std::string who = "uid " + std::to_string(getuid()) + " (develop)";
  CHECK(has(log, who + " set " + hip_kp + ": 40 -> 55"));
  CHECK(has(log, "\"emergency_stop\""));
  CHECK(has(log, "\"words\":\"" + who));
  CHECK(has(log, who + " undid " + hip_kp + ": 55 -> 40"));
}

}  // namespace ctl_tuning_test
