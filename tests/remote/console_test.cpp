// The console of a running robot: lines run between ticks, each client has its own.
#include <doctest/doctest.h>

#include "remote/live_instance.h"

namespace console_test {

using namespace kadans;
using namespace kadans::remote_test;

namespace {

struct Terminal {
  explicit Terminal(const LiveInstance& live) : client(live.socket(Role::develop)) {}
  Json ask(const char* verb, const std::string& text) {
    (void)client.send(Json{{"verb", verb}, {"text", text}}.dump() + "\n");
    return Json::parse(client.line().value_or("{\"error\":\"closed\"}"));
  }
  std::string says(const std::string& line) {
    const Json answer = ask("line", line);
    return answer["ok"] == true ? answer["text"].get<std::string>() : "error: " + answer["error"].get<std::string>();
  }
  RawClient client;
};

}  // namespace

TEST_CASE("lines see the robot, globals stay with their client, and commands need :write") {
  LiveInstance live;
  live.start();
  Terminal one(live), two(live);
  CHECK(one.says("parameters.posture.hip.kp_Nm_per_rad") == "40");
  CHECK(one.says("signals.safety.level") == "0");
  CHECK(one.says("x = 7").empty());
  CHECK(one.says("x") == "7");
  CHECK(two.says("x") != "7");
  CHECK(one.says("m.posture:set_parameter('hip.kp_Nm_per_rad', 50)").find("only reads") != std::string::npos);
  CHECK(one.ask("line", ":write")["writes"] == true);
  CHECK(one.says("m.posture:set_parameter('hip.kp_Nm_per_rad', 50)") == "true");
  const auto set = [](const Json& a) { return a["value"] == 50; };
  CHECK(set(live.ask_until({{"verb", "get"}, {"name", "posture.hip.kp_Nm_per_rad"}}, set)));
  CHECK(one.says("m.posture:parameter('hip.kp_Nm_per_rad')") == "50");
  CHECK(one.says(":run 3").find("error: :run is for a simulation") == 0);
  CHECK(one.ask("line", ":quit")["leaves"] == true);
}

TEST_CASE("names are completed in the running robot, and there are so many consoles and no more") {
  LiveInstance live;
  live.start();
  Terminal one(live), two(live), three(live), four(live);
  const Json words = one.ask("complete", "signals.safety.lev");
  CHECK(words["words"] == Json::array({"signals.safety.level"}));
  for (Terminal* other : {&two, &three, &four}) CHECK(other->says("1") == "1");
  Terminal five(live);
  CHECK(five.says("1") == "error: all consoles are taken");
  two.client.close();
  std::string answer;
  for (int i = 0; i < 1000 && answer != "1"; ++i) answer = five.says("1");
  CHECK(answer == "1");
}

}  // namespace console_test
