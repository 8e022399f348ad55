// Every verb against a robot that runs on threads and virtual time.
#include <doctest/doctest.h>

#include "remote/live_instance.h"
#include "telemetry/mcap/mcap_reader.h"

namespace ctl_server_test {

using namespace kadans;
using namespace kadans::remote_test;

namespace {

std::string error_of(const Json& answer) { return answer.value("error", std::string("no error")); }
bool says(const Json& answer, const std::string& text) { return answer.dump().find(text) != std::string::npos; }
Json item(const Json& answer, const std::string& name) {
  for (const Json& one : answer["items"]) {
    if (one["name"] == name) return one;
  }
  return nullptr;
}

}  // namespace

TEST_CASE("status tells of the robot, its ticks go on, and nothing plays") {
  LiveInstance live;
  live.start();
  const Json first = live.ask_until({{"verb", "status"}}, [](const Json& a) { return a["tick"] > 0; });
  CHECK(first["ok"] == true);
  CHECK(first["name"] == "bench");
  CHECK(first["safety"]["level"] == "normal");
  CHECK(first["control_sets"] == Json::array({"posture"}));
  CHECK(first["behaviors"].empty());
  CHECK(first["record"].is_null());
  CHECK(first["clients"]["served"] > 0);
  CHECK(first["clients"]["dropped"] == 0);
  CHECK(first["configuration"] == live.project.configuration().string());
  const Json later = live.ask_until({{"verb", "status"}}, [](const Json& a) { return a["tick"] > 1000; });
  CHECK(later["time_s"] > 1.0);
}

TEST_CASE("lists name all there is, with units, ranges and values") {
  LiveInstance live;
  live.start();
  const Json parameter = item(live.ask({{"verb", "list"}, {"what", "parameters"}}), hip_kp);
  CHECK(parameter["value"] == 40);
  CHECK(parameter["unit"] == "Nm/rad");
  CHECK(parameter["max"] > 40);
  CHECK(live.ask({{"verb", "list"}, {"what", "signals"}})["items"].size() == live.robot.catalog.signals.size());
  CHECK(item(live.ask({{"verb", "list"}, {"what", "sets"}}), "spare")["active"] == false);
  CHECK(item(live.ask({{"verb", "list"}, {"what", "objects"}}), "posture")["joints"] == Json::array({"hip", "knee"}));
  CHECK(item(live.ask({{"verb", "list"}, {"what", "behaviors"}}), "nod")["plays"] == false);
  CHECK(says(live.ask({{"verb", "list"}, {"what", "parameter"}}), "did you mean 'parameters'"));
}

TEST_CASE("get gives parameters and signals, and knows what was meant") {
  LiveInstance live;
  live.start();
  CHECK(live.ask({{"verb", "get"}, {"name", hip_kp}})["value"] == 40);
  const Json signal =
      live.ask_until({{"verb", "get"}, {"name", "safety.level"}}, [](const Json& a) { return a["ok"] == true; });
  CHECK(signal["kind"] == "signal");
  CHECK(signal["value"] == 0);
  CHECK(error_of(live.ask({{"verb", "get"}, {"name", "posture.hip.kp_Nm_per_rd"}}))
            .find("did you mean '" + std::string(hip_kp)) != std::string::npos);
}

TEST_CASE("ctl tells what the drives say of themselves") {
  LiveInstance live;
  live.start();
  (void)live.ask_until({{"verb", "status"}}, [](const Json& a) { return a["tick"] > 0; });
  const Json answer = live.ask({{"verb", "drives"}});
  CHECK(answer["supply_V"].is_null());  // a model without one
  CHECK(answer["emergency"] == false);
  REQUIRE(answer["drives"].size() == 2);
  CHECK(answer["drives"][0] == Json{{"joint", "hip"},
                                    {"state", "enabled"},
                                    {"code", 0},
                                    {"temperature_C", nullptr},
                                    {"homed", true},
                                    {"braked", false}});
}

TEST_CASE("drives are disabled and enabled by ctl, which answers when they are, and other joints are none") {
  LiveInstance live;
  live.start();
  CHECK(live.ask({{"verb", "disable_drives"}, {"joints", "h*"}})["ok"] == true);
  const Json disabled =
      live.ask_until({{"verb", "drives"}}, [](const Json& a) { return a["drives"][0]["state"] == "ready"; });
  CHECK(disabled["drives"][1]["state"] == "enabled");
  CHECK(live.ask({{"verb", "enable_drives"}})["ok"] == true);
  (void)live.ask_until({{"verb", "drives"}}, [](const Json& a) { return a["drives"][0]["state"] == "enabled"; });
  CHECK(live.ask({{"verb", "reset_drives"}})["ok"] == true);
  CHECK(says(live.ask({{"verb", "home_drives"}, {"joints", "knee"}}), "tells when they are homed"));
  CHECK(says(live.ask({{"verb", "enable_drives"}, {"joints", "kne"}}), "did you mean 'knee'"));
  CHECK(error_of(live.ask({{"verb", "release_drives"}})) == "release_drives needs \"joints\"");
  CHECK(error_of(live.ask({{"verb", "release_drives"}, {"joints", ""}})) == "release_drives needs \"joints\"");
  CHECK(item(live.ask({{"verb", "list"}, {"what", "joints"}}), "knee")["unit"] == "rad");
}

TEST_CASE("a drive that does not do what it is asked for is named, with what it says") {
  LiveInstance live;
  live.start();
  CHECK(error_of(live.ask({{"verb", "brake_drives"}, {"joints", "hip"}})) ==
        "hip is enabled, not braked, 5 s after it was asked to brake");
}

TEST_CASE("under the emergency stop no drive is enabled and no brake released, and disabling goes on") {
  LiveInstance live;
  live.start();
  CHECK(live.ask({{"verb", "estop"}})["ok"] == true);
  (void)live.ask_until({{"verb", "status"}}, [](const Json& a) { return a["safety"]["stopped"] == true; });
  CHECK(error_of(live.ask({{"verb", "enable_drives"}})) == "drive of hip: the emergency stop holds the robot");
  CHECK(error_of(live.ask({{"verb", "release_drives"}, {"joints", "*"}})) ==
        "drive of hip: the emergency stop holds the robot");
  CHECK(live.ask({{"verb", "disable_drives"}})["ok"] == true);
}

TEST_CASE("behaviors play, are paused, tuned, replaced and stopped, and status says so") {
  LiveInstance live;
  live.start();
  CHECK(live.ask({{"verb", "play"}, {"list", "wait"}})["text"] == "play wait");
  CHECK(live.ask({{"verb", "status"}})["behaviors"][0]["state"] == "a");
  CHECK(live.ask({{"verb", "status"}})["behaviors"][0]["active"] == Json::array({"a"}));
  CHECK(live.ask({{"verb", "set"}, {"name", "wait.level"}, {"value", 3}})["before"] == 1);
  CHECK(live.ask({{"verb", "get"}, {"name", "wait.level"}})["value"] == 3);
  CHECK(error_of(live.ask({{"verb", "set"}, {"name", "wait.level"}, {"value", 6}})) ==
        "wait.level = 6 is outside its range 0..5 m");
  CHECK(live.ask({{"verb", "undo"}})["now"] == 1);
  CHECK(live.ask({{"verb", "pause"}})["ok"] == true);
  CHECK(live.ask({{"verb", "status"}})["paused"] == true);
  CHECK(live.ask({{"verb", "resume"}})["ok"] == true);
  CHECK(live.ask({{"verb", "reload"}, {"name", "wait"}})["text"] ==
        "no new version: the files are as they were loaded");
  live.project.write("behaviors/bench/wait.lua", "return nonsense(");
  const Json refused = live.ask({{"verb", "reload"}});
  CHECK(refused["ok"] == false);
  CHECK(says(refused, "wait.lua:1"));
  CHECK(says(live.ask({{"verb", "reload"}, {"name", "wiat"}}), "did you mean 'wait'"));
  CHECK(live.ask({{"verb", "play"}, {"list", "nod"}, {"replace", true}})["text"] == "replace nod");
  CHECK(live.ask({{"verb", "stop"}})["ok"] == true);
  CHECK(live.ask({{"verb", "status"}})["behaviors"].back()["plays"] == false);
  CHECK(says(live.ask({{"verb", "play"}, {"list", "nodd"}}), "did you mean 'nod'"));
}

TEST_CASE("a control set is switched to, and another name is refused with the nearest") {
  LiveInstance live;
  live.start();
  CHECK(live.ask({{"verb", "switch"}, {"set", "spare"}})["ok"] == true);
  const Json status =
      live.ask_until({{"verb", "status"}}, [](const Json& a) { return a["control_sets"][0] == "spare"; });
  CHECK(status["control_sets"] == Json::array({"spare"}));
  CHECK(error_of(live.ask({{"verb", "switch"}, {"set", "spar"}})) ==
        "unknown control set 'spar', did you mean 'spare'?");
}

TEST_CASE("estop damps and then switches off, orders are refused with the reason, and clearing lifts it") {
  LiveInstance live;
  live.start();
  CHECK(live.ask({{"verb", "estop"}}, Role::operate)["ok"] == true);
  const auto off = [](const Json& a) { return a["safety"]["level"] == "off"; };
  CHECK(off(live.ask_until({{"verb", "status"}}, off)));
  CHECK(says(live.ask({{"verb", "set"}, {"name", hip_kp}, {"value", 50}}), "held"));
  const std::string who = "uid " + std::to_string(getuid()) + " (operate)";
  const Json status = live.ask({{"verb", "status"}})["safety"];
  CHECK(status["faults"] >= 1);
  CHECK(status["stopped"] == true);
  CHECK(status["first"]["text"] == "emergency_stop: " + who);
  const Json faults = live.ask({{"verb", "faults"}});
  CHECK(faults["level"] == "off");
  CHECK(faults["first"]["code"] == "emergency_stop");
  CHECK(faults["first"]["words"] == who);
  for (const bool replace : {false, true})
    CHECK(says(live.ask({{"verb", "play"}, {"list", "nod"}, {"replace", replace}}), "the emergency stop keeps"));
  CHECK(says(live.ask({{"verb", "resume"}}), "the emergency stop keeps"));
  CHECK(live.ask({{"verb", "clear_faults"}})["ok"] == true);
  const auto well = [](const Json& a) { return a["safety"]["level"] == "normal"; };
  CHECK(well(live.ask_until({{"verb", "status"}}, well)));
  CHECK(says(live.ask({{"verb", "faults"}}), "command_refused"));
  CHECK(live.ask({{"verb", "play"}, {"list", "nod"}})["ok"] == true);
}

TEST_CASE("estop and status work although the behavior thread is dead, everything else says why not") {
  LiveInstance live({.answer_max_ns = 50'000'000, .report_max_ns = 50'000'000});
  live.start(false);
  CHECK(says(live.ask({{"verb", "status"}}), "the behavior thread does not answer"));
  CHECK(says(live.ask({{"verb", "set"}, {"name", hip_kp}, {"value", 50}}), "the behavior thread does not answer"));
  CHECK(live.ask({{"verb", "get"}, {"name", hip_kp}})["value"] == 40);
  CHECK(live.ask({{"verb", "estop"}})["ok"] == true);
  const auto off = [](const Json& a) { return a["safety"]["level"] == "off"; };
  CHECK(off(live.ask_until({{"verb", "status"}}, off)));
}

TEST_CASE("watch sends what was asked for, newer each time, until the client leaves") {
  LiveInstance live;
  live.start();
  RawClient client(live.socket(Role::read));
  REQUIRE(client.send(R"({"verb":"watch","signals":["safety.level","joint.hip.position_rad"],"rate_hz":100})"
                      "\n"));
  const Json head = Json::parse(client.line().value());
  REQUIRE(head["ok"] == true);
  CHECK(head["signals"][1]["unit"] == "rad");
  std::int64_t last = -1;
  for (int i = 0; i < 20; ++i) {
    const Json sample = Json::parse(client.line().value());
    CHECK(sample["values"].size() == 2);
    const std::int64_t tick = sample["tick"];
    CHECK(tick > last);
    last = tick;
  }
  CHECK(says(live.ask({{"verb", "watch"}, {"signals", {"safty.level"}}}), "did you mean 'safety.level'"));
}

TEST_CASE("a record is started and stopped while the robot runs, twice, and no file is lost for it") {
  LiveInstance live;
  live.start();
  CHECK(live.ask({{"verb", "record_stop"}})["error"] == "there is no record to stop");
  for (const char* file : {"one.mcap", "two.mcap"}) {
    CHECK(live.ask({{"verb", "record_start"}, {"file", file}})["text"] == (live.project.root / file).string());
    CHECK(says(live.ask({{"verb", "record_start"}}), "a record goes on already"));
    const Json status = live.ask_until({{"verb", "status"}}, [](const Json& a) { return a["record"]["rows"] > 200; });
    CHECK(status["record"]["dropped"] == 0);
    CHECK(live.ask({{"verb", "record_stop"}})["ok"] == true);
    CHECK(std::filesystem::file_size(live.project.root / file) > 10'000);
  }
  CHECK(says(live.ask({{"verb", "record_start"}, {"file", "one.mcap"}}), "is there already"));
  CHECK(says(live.ask({{"verb", "record_start"}, {"file", "../three.mcap"}}), "names no folder"));
}

TEST_CASE("the flight recorder's last seconds are written when somebody asks, without one that is said") {
  {
    LiveInstance live;
    live.start();
    CHECK(says(live.ask({{"verb", "record_dump"}}), "there is no flight recorder"));
  }
  LiveInstance live;
  live.record_side.record_as({.flight = {.kept_s = 2, .bytes = 1U << 20U}});
  live.record_side.begin();
  live.start();
  (void)live.ask_until({{"verb", "status"}}, [](const Json& a) { return a["tick"] > 3000; });
  CHECK(says(live.ask({{"verb", "record_stop"}}), "there is no record to stop"));
  CHECK(live.ask({{"verb", "record_dump"}, {"file", "a.mcap"}})["text"] == (live.project.root / "a.mcap").string());
  // Refused until the first is complete.
  CHECK(live.ask_until({{"verb", "record_dump"}, {"file", "b.mcap"}}, [](const Json&) { return true; })["ok"] == true);
  McapReader reader((live.project.root / "a.mcap").string());
  std::uint32_t first = 0, last = 0;
  for (McapMessage message; reader.next(message);) {
    if (reader.channels().at(message.channel).topic != "/joint") continue;
    if (first == 0) first = message.sequence;
    last = message.sequence;
  }
  CHECK(reader.complete());
  CHECK(last >= first + 2000);
  CHECK(last < first + 2300);
}

TEST_CASE("who holds all places of a role keeps nobody out: the one that was idle for longest goes") {
  LiveInstance live({.clients_max = {3, 2, 2}});
  live.start();
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 2; ++i) idle.push_back(std::make_unique<RawClient>(live.socket(Role::operate)));
  CHECK(live.ask({{"verb", "estop"}}, Role::operate)["ok"] == true);
  CHECK(idle[0]->line().value_or("").find("another client needed the place") != std::string::npos);
}

TEST_CASE("a line of more than 64 kB is refused, also when its end came with it") {
  LiveInstance live;
  live.start();
  RawClient client(live.socket(Role::read));
  REQUIRE(client.send("{\"verb\":\"status\",\"x\":\"" + std::string(CtlSession::line_bytes_max, 'x') + "\"}\n"));
  CHECK(client.line().value_or("").find("a line has at most 64 kB") != std::string::npos);
}

}  // namespace ctl_server_test
