// `kadans debug` as an editor drives it. JIWIY's sine is small, and has loops, functions and coroutines enough.
#include <map>
#include <regex>

#include <doctest/doctest.h>

#include "app/program.h"
#include "debug_client.h"

namespace debug_test {

using namespace kadans::program;
namespace fs = std::filesystem;
using Json = DebugClient::Json;

namespace {

constexpr int behavior_thread = 2;
const fs::path source = KADANS_SOURCE_DIR;
const std::string sine = (source / "behaviors/jiwiy/sine.lua").string();
const Json scenario{{"program", "config/scenarios/jiwiy_sine.json"}, {"stopOnEntry", true}};

Json with(Json launch, const Json& more) {
  launch.update(more);
  return launch;
}

std::string hash_of(const std::string& said) {
  std::smatch found;
  return std::regex_search(said, found, std::regex("state hash ([0-9a-f]{16})")) ? found[1].str() : "none";
}

std::string sim_hash(const fs::path& scenario_file, const std::string& arguments) {
  const Outcome outcome =
      run("sim " + scenario_file.string() + arguments + " --no-record --json", fresh_folder("debug_sim"));
  return Json::parse(outcome.out).at("state_hash");
}

// What shows at a moment: hashes, stack and locals.
std::string shown(DebugClient& client, const Json& stopped) {
  const Json at = client.position();
  std::string text = at.at("state_hash").get<std::string>() + at.at("way_hash").get<std::string>();
  const Json frames = client.frames(stopped.at("threadId"));
  for (const Json& frame : frames) text += "\n" + frame.at("name").get<std::string>() + frame.at("line").dump();
  const Json scopes = client.get("scopes", {{"frameId", frames.at(0).at("id")}}).at("scopes");
  if (scopes.at(0).at("name") != "locals") return text;
  const Json locals = client.get("variables", {{"variablesReference", scopes[0].at("variablesReference")}});
  for (const Json& one : locals.at("variables")) text += "\n" + one.at("name").dump() + one.at("value").dump();
  return text;
}

}  // namespace

TEST_CASE("debug stops at a line of Lua and shows frames, the chart's path, variables and expressions") {
  DebugClient client(source, "");
  const Json launch = with(scenario, {{"program", "config/jiwiy/../scenarios/jiwiy_sine.json"}});
  const Json first = client.begin(launch, sine, {{{"line", 31}}});
  CHECK(first.at("reason") == "entry");
  const Json stopped = client.go("continue");
  CHECK(stopped.at("reason") == "breakpoint");
  CHECK(stopped.at("threadId") == behavior_thread);
  const Json frames = client.frames(behavior_thread);
  CHECK(frames.at(0).at("line") == 31);
  CHECK(frames.at(0).at("name") == "ahead");
  CHECK(frames.at(0).at("source").at("path") == sine);
  CHECK(frames.back().at("name") == "behavior sine");
  CHECK(frames.at(frames.size() - 2).at("name").get<std::string>().starts_with("state "));
  const int frame = frames.at(0).at("id");
  CHECK(client.value(frame, "locals", "i") == "1");
  CHECK(client.value(frame, "upvalues", "points") == "8");
  CHECK(client.value(frame, "params", "pan_rad") == "0.6 rad");
  CHECK(client.value(frame, "s", "time_s") != "none");
  const auto evaluated = [&](const std::string& text) {
    return client.ask("evaluate", {{"expression", text}, {"frameId", frame}});
  };
  CHECK(evaluated("i * 2 + points").at("body").at("result") == "10");
  CHECK(evaluated("params.frequency_Hz").at("body").at("result") == "1");
  CHECK(evaluated("points_s_").at("message").get<std::string>().find("points_s_") != std::string::npos);
  CHECK(evaluated("while true do end").at("message").get<std::string>().find("longer than 2 s") != std::string::npos);
  CHECK(evaluated("joints[1]").at("body").at("result") == "\"pan\"");  // after the endless one
  const Json threads = client.get("threads").at("threads");
  CHECK(threads.size() == 2);
  const Json run_frame = client.frames(1).at(0);
  CHECK(run_frame.at("source").at("path") == (source / "config/scenarios/jiwiy_sine.json").string());
  CHECK(client.value(run_frame.at("id"), "signals", "joint.pan.position_rad") != "none");
  CHECK(client.get("evaluate", {{"expression", "joint.pan.position_rad > 100"}, {"frameId", 1}}).at("result") ==
        "false");
}

TEST_CASE("A debugged run ends as that of sim, wherever it stopped and went back, and whatever was evaluated") {
  for (const std::string name : {"jiwiy_sine", "list_of_behaviors"}) {
    CAPTURE(name);
    const std::string file = "config/scenarios/" + name + ".json";
    DebugClient client(source, file);
    (void)client.begin({{"stopOnEntry", true}, {"duration", 2.5}});
    (void)client.go("kadans/goto", {{"tick", 700}});
    for (int i = 0; i < 20; ++i) {
      (void)client.go(i % 3 == 0 ? "stepBack" : "stepIn", {{"threadId", behavior_thread}});
      (void)client.ask("evaluate", {{"expression", "math.random(100) + #string.rep('x', 1000)"}});
    }
    (void)client.get("continue");
    CHECK(client.wait("exited").is_object());
    CHECK(hash_of(client.said()) == sim_hash(source / file, " --duration 2.5"));
  }
}

TEST_CASE("debug steps over, in, out and back, and equal moments are equal") {
  DebugClient client(source, "config/scenarios/jiwiy_sine.json");
  (void)client.begin({{"stopOnEntry", true}}, sine, {{{"line", 29}, {"hitCondition", "5"}}});
  Json stopped = client.go("continue");
  const Json thread{{"threadId", behavior_thread}};
  std::map<Json, std::string> seen{{client.position().at("at"), shown(client, stopped)}};
  const auto line = [&] { return client.frames(behavior_thread).at(0).at("line").get<int>(); };
  CHECK(line() == 29);
  (void)client.go("stepOut", thread);
  CHECK(client.frames(behavior_thread).at(0).at("name") != "ahead");
  (void)client.go("reverseContinue", thread);
  CHECK(line() == 29);
  const std::vector<std::string> ways{"next",     "stepIn",   "stepIn", "stepIn", "stepBack", "stepBack",
                                      "stepBack", "stepBack", "stepIn", "next",   "stepOut",  "stepBack"};
  int again = 0;
  for (int i = 0; i < 60; ++i) {
    stopped = client.go(ways[static_cast<std::size_t>(i) % ways.size()], thread);
    const auto [moment, fresh] = seen.try_emplace(client.position().at("at"), shown(client, stopped));
    if (!fresh) CHECK(moment->second == shown(client, stopped));
    again += fresh ? 0 : 1;
  }
  CHECK(again > 20);
  const Json at = client.position();
  (void)client.go("kadans/ticks", {{"unit", "control"}, {"count", 25}});
  (void)client.go("kadans/ticks", {{"unit", "behavior"}, {"count", -2}});
  CHECK(client.position().at("at").at(0).get<int>() % 10 == 0);
  (void)client.go("kadans/goto", {{"tick", at.at("at").at(0)}, {"point", at.at("at").at(1)}});
  CHECK(client.position().at("way_hash") == at.at("way_hash"));
  (void)client.go("kadans/goto", {{"tick", 0}});
  CHECK(client.go("stepBack", thread).at("reason") == "entry");
}

TEST_CASE("debug stops at conditions, hit counts and log points of lines") {
  DebugClient client(source, "config/scenarios/jiwiy_sine.json");
  (void)client.begin({{"stopOnEntry", true}}, sine,
                     {{{"line", 31}, {"condition", "i == 3 and time_s > 0.45"}},
                      {{"line", 29}, {"logMessage", "ahead of {time_s > 100} {joints[2]}"}},
                      {{"line", 34}, {"condition", "no_such_name.x"}, {"hitCondition", "2"}}});
  Json stopped = client.go("continue");  // a wrong condition stops, and says so
  CHECK(client.frames(behavior_thread).at(0).at("line") == 34);
  CHECK(has(client.said(), "the condition 'no_such_name.x' is wrong"));
  CHECK(has(client.said(), "ahead of false tilt\n"));
  stopped = client.go("continue");
  const int frame = client.frames(behavior_thread).at(0).at("id");
  CHECK(client.value(frame, "locals", "i") == "3");
  CHECK(std::stod(client.value(frame, "locals", "time_s")) > 0.45);
}

TEST_CASE("debug stops at functions, states, transitions, conditions on signals and failed checks") {
  const auto project = project_copy("debug_stops");
  REQUIRE(edit(project / "config/scenarios/squat.json", "\"min\": 0.6 }", "\"min\": 0.84 }"));
  DebugClient client(project, "config/scenarios/squat.json");
  (void)client.begin({{"stopOnEntry", true}});
  const Json set = client.get("setFunctionBreakpoints", {{"breakpoints",
                                                          {{{"name", "crouch"}},
                                                           {{"name", "squat.squat"}},
                                                           {{"name", "time_s > 1.1 and plant.base.height_m > 0.5"}},
                                                           {{"name", "no thing of any kind"}}}}});
  CHECK(set.at("breakpoints").at(2).at("verified") == true);
  CHECK(set.at("breakpoints").at(3).at("verified") == false);
  const Json info = client.get("dataBreakpointInfo", {{"name", "plant.base.height_m"}});
  CHECK(info.at("dataId") == "plant.base.height_m");
  CHECK(client.get("dataBreakpointInfo", {{"name", "plant.base.hight_m"}}).at("dataId").is_null());
  CHECK(client.go("continue").at("reason") == "data breakpoint");
  CHECK(client.position().at("time_s").get<double>() == doctest::Approx(1.101).epsilon(0.002));
  CHECK(client.go("continue").at("reason") == "function breakpoint");
  CHECK(client.go("continue").at("reason") == "breakpoint");
  CHECK(client.frames(behavior_thread).at(0).at("line") == 20);
  (void)client.get("setFunctionBreakpoints", {{"breakpoints", Json::array()}});
  (void)client.get("setDataBreakpoints",
                   {{"breakpoints", {{{"dataId", "plant.base.height_m"}, {"condition", "< 0.85"}}}}});
  (void)client.get(
      "setExceptionBreakpoints",
      {{"filters", {"check"}}, {"filterOptions", {{{"filterId", "transition"}, {"condition", "squat -> rest"}}}}});
  bool data = false, transition = false, check = false;
  for (int i = 0; i < 6; ++i) {
    const Json stopped = client.go("continue");
    const std::string text = stopped.value("text", "");
    data = data || stopped.at("reason") == "data breakpoint";
    transition = transition || has(text, "squat -> rest");
    check = check || has(text, "check failed: ");
    if (transition) break;
  }
  CHECK(data);
  CHECK(transition);
  CHECK(check);
  CHECK(client.go("reverseContinue", {{"threadId", 1}}).at("reason") != "entry");
}

TEST_CASE("debug stops where a script raises, with its stack, and where the run ends") {
  const auto project = project_copy("debug_error");
  REQUIRE(edit(project / "behaviors/jiwiy/sine.lua", "local list = {}",
               "local list = {}\n  if time_s > 0.25 then list.a.b = 1 end"));
  DebugClient client(project, "");
  (void)client.begin(with(scenario, {{"stopAtEnd", true}}));
  (void)client.get("setExceptionBreakpoints", {{"filters", {"error"}}});
  const Json stopped = client.go("continue");
  CHECK(stopped.at("reason") == "exception");
  CHECK(has(stopped.at("text"), "index field 'a'"));
  const Json info = client.get("exceptionInfo", {{"threadId", behavior_thread}});
  CHECK(info.at("exceptionId") == "error");
  CHECK(info.at("description") == stopped.at("text"));
  const Json frame = client.frames(behavior_thread).at(0);
  CHECK(frame.at("line") == 29);
  CHECK(std::stod(client.value(frame.at("id"), "locals", "time_s")) > 0.25);
  CHECK(client.go("continue").at("text") == "the run is over");
  CHECK(client.go("reverseContinue", {{"threadId", 1}}).at("reason") == "exception");
}

TEST_CASE("debug repeats records forwards and backwards") {
  const auto project = project_copy("debug_records");
  const std::string file = (project / "behaviors/jiwiy/sine.lua").string();
  CHECK(run("sim config/scenarios/jiwiy_sine.json --duration 1.5 --record simulated.mcap", project).exit_code < 2);
  CHECK(run("run config/jiwiy/robot.json --plant ideal --play sine --duration 1.5 --threads-on-virtual-time --soft "
            "--record threads.mcap",
            project)
            .exit_code == 0);
  for (const char* record : {"simulated.mcap", "threads.mcap"}) {
    CAPTURE(record);
    DebugClient client(project, record);
    (void)client.begin({{"stopOnEntry", true}}, file, {{{"line", 31}, {"condition", "i == 2"}}});
    (void)client.go("continue");
    (void)client.go("continue");
    const Json at = client.position();
    CHECK(client.frames(behavior_thread).at(0).at("source").at("path") == file);
    CHECK(!client.frames(1).at(0).contains("source"));  // the record is no text that an editor could open
    (void)client.go("continue");
    CHECK(client.go("reverseContinue", {{"threadId", behavior_thread}}).at("reason") == "breakpoint");
    CHECK(client.position() == at);
    (void)client.go("stepBack", {{"threadId", behavior_thread}});
    (void)client.go("stepIn", {{"threadId", behavior_thread}});
    CHECK(client.position().at("way_hash") == at.at("way_hash"));
    (void)client.get("setBreakpoints", {{"source", {{"path", file}}}, {"breakpoints", Json::array()}});
    (void)client.get("continue");
    CHECK(client.wait("exited").is_object());
    if (std::string(record) == "threads.mcap") CHECK(has(client.said(), "the run repeats the record"));
  }
}

TEST_CASE("A reload at a stop is a branch, which is taken again after going back") {
  const auto project = project_copy("debug_branch");
  const fs::path file = project / "behaviors/jiwiy/sine.lua";
  DebugClient client(project, "");
  (void)client.begin(scenario);
  (void)client.go("kadans/goto", {{"tick", 600}});
  REQUIRE(edit(file, "local list = {}", "local list = {} print('as new')"));
  (void)client.go("evaluate", {{"expression", ":reload"}, {"context", "repl"}});
  (void)client.go("kadans/goto", {{"tick", 1600}});
  CHECK(has(client.said(), "branch 1 in tick 601"));
  const Json after = client.position();
  (void)client.go("kadans/goto", {{"tick", 300}});
  REQUIRE(edit(file, "as new", "as newest"));  // too late for that branch
  (void)client.go("kadans/goto", {{"tick", 1600}});
  CHECK(client.position() == after);
  (void)client.go("kadans/ticks", {{"unit", "behavior"}, {"count", 20}});
  CHECK(has(client.said(), "as new\n"));
  CHECK(!has(client.said(), "as newest"));
}

// An editor that does not know that the run goes on takes the next stop for one of a second thread, and continues it.
TEST_CASE("debug tells when a line in the console lets the run go, and when it is terminated") {
  DebugClient client(source, "");
  (void)client.begin(scenario, sine, {{{"line", 31}, {"hitCondition", "1"}}});
  CHECK(client.go("continue").at("threadId") == behavior_thread);
  for (const std::string line : {":control 3", ":tick 700", ":tick 5"}) {
    CAPTURE(line);
    (void)client.get("evaluate", {{"expression", line}, {"context", "repl"}});
    CHECK(client.wait("continued").at("allThreadsContinued") == true);
    CHECK(client.wait("stopped").at("threadId") == 1);
  }
  CHECK(client.ask("exceptionInfo", {{"threadId", 1}}).at("success") == false);
  (void)client.get("terminate");
  CHECK(!client.wait("terminated").is_null());
  (void)client.get("terminate");
  (void)client.get("disconnect");
  CHECK(client.wait("terminated").is_null());  // so an editor that answers it with `terminate` comes to an end
  CHECK(client.end() == 0);
}

TEST_CASE("debug waits for an editor at a port, where the command line alone says what runs") {
  Running program(source, "debug config/scenarios/jiwiy_sine.json --port 0");
  REQUIRE(program.says("waits for an editor at 127.0.0.1:"));
  DebugClient client(std::stoi(program.heard().substr(program.heard().rfind(':') + 1)));
  const Json other = client.ask("launch", {{"program", "config/scenarios/squat.json"}});
  CHECK(has(other.at("message"), "the command line says what runs"));
  CHECK(client.begin({{"stopOnEntry", true}}).at("reason") == "entry");
  (void)client.get("disconnect");
  CHECK(program.end() == 0);
  CHECK(has(run("debug --port 0", fresh_folder("debug_port")).err, "name the scenario or record"));
}

TEST_CASE("debug tells wrong input in a sentence and goes on, and ends at bytes that are no message") {
  DebugClient client(source, "");
  const auto why = [&](const std::string& command, const Json& arguments = Json::object()) -> std::string {
    const Json response = client.ask(command, arguments);
    CHECK(response.at("success") == false);
    return response.value("message", "");
  };
  CHECK(has(why("continue"), "launch comes first"));
  CHECK(has(why("launch"), "name a scenario or a record"));
  CHECK(has(why("launch", {{"program", "config/no.json"}}), "config/no.json"));
  CHECK(has(why("launch", {{"program", "config/tulip/robot.json"}}), "robot"));
  CHECK(has(why("launch", {{"program", 7}}), "another kind"));
  CHECK(has(why("fly"), "does not know the request 'fly'"));
  CHECK(has(why("initialize", {{"linesStartAt1", false}}), "lines and columns from 1"));
  CHECK(has(why("initialize", {{"pathFormat", "uri"}}), "by their paths"));
  (void)client.begin(scenario);
  CHECK(has(why("kadans/ticks", {{"unit", "year"}}), "not \"year\""));
  CHECK(has(why("evaluate", {{"expression", ":bhavior 3"}, {"context", "repl"}}), "did you mean 'behavior'?"));
  CHECK(has(why("scopes", {{"frameId", -5}}), "no such frame"));
  const auto shown_to_user = [&](const std::string& command, const Json& arguments) {
    return client.ask(command, arguments).at("body").at("error").at("showUser").get<bool>();
  };
  CHECK(shown_to_user("kadans/ticks", {{"unit", "year"}}));
  CHECK(!shown_to_user("evaluate", {{"expression", "no_such_signal"}, {"context", "watch"}}));
  CHECK(has(why("variables", {{"variablesReference", 77}}), "77"));
  CHECK(has(why("scopes"), "missing"));
  const Json set =
      client.get("setBreakpoints", {{"source", {{"path", "/etc/passwd"}}}, {"breakpoints", {{{"line", 1}}}}});
  CHECK(has(set.at("breakpoints").at(0).at("message"), "not in the project"));
  client.write("Content-Length: 99999999999\r\n\r\n");
  CHECK(client.end() == 1);
  CHECK(run("debug --port 70000", fresh_folder("debug_port")).exit_code == 2);
  DebugClient page(source, "");
  page.write("POST / HTTP/1.1\r\nContent-Length: 2\r\n\r\n{}");
  CHECK(page.end() == 1);
}

}  // namespace debug_test
