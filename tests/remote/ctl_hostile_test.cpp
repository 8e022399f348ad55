// Clients that are wrong, slow, gone or hostile: they harm nothing but themselves.
#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include "remote/live_instance.h"

namespace ctl_hostile_test {

using namespace kadans;
using namespace kadans::remote_test;

namespace {

const std::string status_line = "{\"verb\":\"status\"}\n";

// The robot's ticks went on without a gap while `attack` ran, and it is as well as before.
template <typename Attack>
void unharmed_by(LiveInstance& live, Attack attack) {
  const std::uint64_t before = live.ask({{"verb", "status"}})["tick"];
  attack();
  static std::uint64_t wanted;
  wanted = before + 200;
  const Json after = live.ask_until({{"verb", "status"}}, [](const Json& a) { return a["tick"] > wanted; });
  CHECK(after["tick"] > wanted);
  CHECK(after["safety"]["level"] == "normal");
  CHECK(after["safety"]["faults"] == 0);
  CHECK(after["commands_refused"] == 0);
  CHECK(live.robot.control_thread.statistics().missed.get() == 0);
  CHECK_FALSE(live.robot.control_thread.over());
  CHECK_FALSE(live.robot.behavior_thread.over());
}

}  // namespace

TEST_CASE("half a line is waited for so long, then its client is dropped") {
  LiveInstance live({.half_line_max_ns = 20'000'000});
  live.start();
  unharmed_by(live, [&] {
    RawClient client(live.socket(Role::develop));
    REQUIRE(client.send("{\"verb\":\"sta"));
    const Json told = Json::parse(client.line().value());
    CHECK(told["error"] == "the rest of the line did not come");
    CHECK_FALSE(client.line());
  });
  CHECK(live.server->counts().dropped == 1);
}

TEST_CASE("a line of 100 MB is cut off after 64 kB") {
  LiveInstance live;
  live.start();
  unharmed_by(live, [&] {
    RawClient client(live.socket(Role::develop));
    const std::string block(1'000'000, 'x');
    int sent = 0;
    while (sent < 100 && client.send(block)) ++sent;
    CHECK(sent < 3);
  });
  CHECK(live.server->counts().dropped == 1);
}

TEST_CASE(
    "of 1,000 connections of one user the newest stay, the others are told why not, and other roles find their place") {
  LiveInstance live;
  live.start();
  unharmed_by(live, [&] {
    std::vector<std::unique_ptr<RawClient>> crowd;
    for (int wave = 0; wave < 4; ++wave) {
      std::vector<std::unique_ptr<RawClient>> arriving(250);
      for (auto& client : arriving) {
        client = std::make_unique<RawClient>(live.socket(Role::read));
        REQUIRE(client->connected());
      }
      std::ranges::move(arriving, std::back_inserter(crowd));
    }
    CHECK(live.ask({{"verb", "status"}}, Role::operate)["ok"] == true);
    constexpr std::size_t stay = 32;
    for (std::size_t i = 0; i < crowd.size() - stay; ++i)
      CHECK(crowd[i]->line().value_or("").find("another client needed the place") != std::string::npos);
    for (std::size_t i = crowd.size() - stay; i < crowd.size(); ++i) {
      REQUIRE(crowd[i]->send(status_line));
      CHECK(Json::parse(crowd[i]->line().value())["ok"] == true);
    }
  });
  const auto room = [](const Json& a) { return a["ok"] == true; };
  CHECK(room(live.ask_until({{"verb", "status"}}, room)));
}

TEST_CASE("who asks and watches without reading keeps nobody, is dropped, and its server's memory stays small") {
  LiveInstance live({.unread_max_ns = 50'000'000});
  live.start();
  unharmed_by(live, [&] {
    RawClient deaf(live.socket(Role::read)), watcher(live.socket(Role::read));
    REQUIRE(watcher.send("{\"verb\":\"watch\",\"signals\":[\"safety.level\"],\"rate_hz\":1000}\n"));
    while (live.server->counts().dropped < 1) {
      (void)deaf.send_some("{\"verb\":\"list\",\"what\":\"signals\"}\n");
      CHECK(live.ask({{"verb", "status"}})["ok"] == true);
    }
    while (live.server->counts().dropped < 2) CHECK(live.ask({{"verb", "status"}})["ok"] == true);
  });
}

TEST_CASE("rubbish gets an answer that says what is wrong") {
  LiveInstance live;
  live.start();
  unharmed_by(live, [&] {
    RawClient client(live.socket(Role::develop));
    const auto error = [&](const std::string& line) {
      REQUIRE(client.send(line + "\n"));
      const Json answer = Json::parse(client.line().value());
      CHECK(answer["ok"] == false);
      return answer["error"].get<std::string>();
    };
    CHECK(error("") == "this is no JSON object on one line");
    CHECK(error(std::string("\0\xff\xfe{", 4)) == "this is no JSON object on one line");
    CHECK(error(std::string(60'000, '[')) == "this is no JSON object on one line");
    CHECK(error("[1,2]") == "this is no JSON object on one line");
    CHECK(error("{}") == "a request needs \"verb\", a string");
    CHECK(error("{\"verb\":7}") == "a request needs \"verb\", a string");
    CHECK(error("{\"verb\":\"stauts\"}") == "unknown verb 'stauts', did you mean 'status'?");
    CHECK(error("{\"verb\":\"get\"}") == "get needs \"name\"");
    CHECK(error("{\"verb\":\"set\",\"name\":\"x\",\"value\":\"1\"}") == "\"value\" must be a number");
    CHECK(error("{\"verb\":\"get\",\"nmae\":\"x\",\"name\":\"x\"}") ==
          "unknown field 'nmae' of get, did you mean 'name'?");
    CHECK(error("{\"verb\":\"watch\",\"signals\":[]}") == "watch what? \"signals\" is empty");
    CHECK(error("{\"verb\":\"watch\",\"signals\":[\"safety.level\"],\"rate_hz\":-1}") ==
          "\"rate_hz\" = -1 must be 0.01..1000");
    CHECK(error("{\"verb\":\"play\",\"list\":\"\xff\"}").size() > 5);
    CHECK(error("{\"verb\":\"line\",\"text\":\"while true do end\"}").find("budget") != std::string::npos);
  });
}

TEST_CASE("clients that leave in the middle of everything leave nothing behind") {
  LiveInstance live;
  live.start();
  unharmed_by(live, [&] {
    const std::array<std::string, 6> requests{"{\"verb\":\"sta",
                                              status_line,
                                              "{\"verb\":\"line\",\"text\":\"x = 1\"}\n",
                                              "{\"verb\":\"list\",\"what\":\"signals\"}\n",
                                              "{\"verb\":\"watch\",\"signals\":[\"safety.level\"],\"rate_hz\":1000}\n",
                                              "{\"verb\":\"undo\"}\n"};
    for (int i = 0; i < 300; ++i) {
      RawClient client(live.socket(Role::develop));
      (void)client.send(requests[static_cast<std::size_t>(i) % requests.size()]);
    }
  });
  const auto two = [](const Json& a) { return a["text"] == "2"; };  // their consoles are free again
  CHECK(two(live.ask_until({{"verb", "line"}, {"text", "1 + 1"}}, two)));
}

TEST_CASE("a client that ends its side after the question still gets the answer") {
  LiveInstance live;
  live.start();
  RawClient client(live.socket(Role::read));
  REQUIRE(client.send(status_line + status_line));
  client.end_of_questions();
  CHECK(Json::parse(client.line().value())["ok"] == true);
  CHECK(Json::parse(client.line().value())["ok"] == true);
  CHECK_FALSE(client.line());
}

}  // namespace ctl_hostile_test
