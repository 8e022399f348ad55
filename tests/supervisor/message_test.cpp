// What comes from outside of the process: datagrams of perception and messages of other robots. All of it is hostile.
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"
#include "supervisor/messages/robot_messages.h"
#include "supervisor/messages/simulated_network.h"
#include "supervisor/world/perception_message.h"

namespace message_test {

using namespace kadans;
using Answer = RobotMessages::Answer;

namespace {

constexpr std::int64_t second_ns = 1'000'000'000, ms_ns = 1'000'000;

std::vector<SeenInfo> declared() {
  return {{.name = "ball", .places = 2, .fields = {{"x_m", "m", "", -10, 10}, {"y_m", "m", "", -10, 10}}},
          {.name = "battery", .fields = {{"charge", "", "", 0, 1}}}};
}

std::string refusal(const std::string& datagram) {
  std::vector<Observation> seen;
  const std::string why = read_perception(datagram, declared(), second_ns, seen);
  CHECK(seen.empty() == !why.empty());
  return why;
}

MessagesConfig team(const char* name, const char* peer) { return {.name = name, .peers = {peer}}; }

PlayedEvent pass(double x_m) { return {.name = "robot.pass", .data = {{.name = "x_m", .value = x_m}}}; }

struct Pair {
  RobotMessages red{team("red", "blue"), 7}, blue{team("blue", "red"), 9};
  std::string why;
  PlayedEvent event;

  Answer hear(const std::string& bytes, std::int64_t now_ns) { return blue.decode(bytes, now_ns, event, why); }
  std::string said(double x_m, std::int64_t now_ns) { return red.encode(pass(x_m), now_ns, why); }
};

}  // namespace

TEST_CASE("a datagram of perception gives observations with the time of the picture") {
  std::vector<Observation> seen;
  CHECK(read_perception("{\"kadans\":1,\"seen\":[{\"entry\":\"battery\",\"age_s\":0,\"charge\":0.5},"
                        "{\"entry\":\"ball\",\"age_s\":0.25,\"confidence\":0.8,\"x_m\":1.5,\"y_m\":-0.5}]}",
                        declared(), second_ns, seen) == "");
  REQUIRE(seen.size() == 2);
  CHECK(seen[0].entry == 1);
  CHECK(seen[0].confidence == 1);
  CHECK(seen[1].time_ns == 750'000'000);
  CHECK(seen[1].confidence == 0.8);
  CHECK(seen[1].fields[0] == 1.5);
  CHECK(seen[1].source == SeenSource::perception);
}

TEST_CASE("a datagram of perception that is wrong is refused whole, with its place") {
  const std::string ball = "{\"entry\":\"ball\",\"age_s\":0.1,\"x_m\":1,\"y_m\":0";
  const auto with = [&](const std::string& seen) { return "{\"kadans\":1,\"seen\":[" + ball + "}," + seen + "]}"; };
  CHECK(refusal("") == "1:1: the file is empty, a JSON object is needed");
  CHECK(refusal("[]").starts_with("1:1: a datagram is one object"));
  CHECK(refusal("{\"seen\":[]}") == "1:1: 'kadans' is missing");
  CHECK(refusal("{\"kadans\":2,\"seen\":[]}").starts_with("1:11: 'kadans' is no number from 1"));
  CHECK(refusal("{\"kadans\":1}") == "1:1: 'seen' is a list of what is seen");
  CHECK(refusal("{\"kadans\":1,\"seen\":[],\"more\":1}").find("other than kadans and seen") != std::string::npos);
  CHECK(refusal(with("3")).find("is an object") != std::string::npos);
  CHECK(refusal(with("{\"entry\":\"bal\",\"age_s\":0}")).find("did you mean 'ball'") != std::string::npos);
  CHECK(refusal(with("{\"entry\":\"ball\",\"x_m\":1,\"y_m\":0}")).find("'age_s' is missing") != std::string::npos);
  CHECK(refusal(with("{\"entry\":\"ball\",\"age_s\":-1,\"x_m\":1,\"y_m\":0}")).find("'age_s'") != std::string::npos);
  CHECK(refusal(with("{\"entry\":\"ball\",\"age_s\":1e9,\"x_m\":1,\"y_m\":0}")).find("'age_s'") != std::string::npos);
  CHECK(refusal(with("{\"entry\":\"ball\",\"age_s\":0,\"x_m\":\"1\",\"y_m\":0}")).find("'x_m'") != std::string::npos);
  CHECK(refusal(with("{\"entry\":\"ball\",\"age_s\":0,\"x_m\":11,\"y_m\":0}")).find("'x_m'") != std::string::npos);
  CHECK(refusal(with("{\"entry\":\"ball\",\"age_s\":0,\"x_m\":1}")).find("'y_m' is missing") != std::string::npos);
  CHECK(refusal(with(ball + ",\"z_m\":1}")).find("has keys that it does not know") != std::string::npos);
  CHECK(refusal(std::string(perception_bytes_max + 1, ' ')).find("longer than") != std::string::npos);
  std::string many = "{\"kadans\":1,\"seen\":[";
  for (std::size_t i = 0; i <= perception_seen_max; ++i) many += (i == 0 ? "1" : ",1");
  CHECK(refusal(many + "]}").find("lists more than 32") != std::string::npos);
}

TEST_CASE("a message comes to its peer as an event with its data and its sender") {
  Pair pair;
  const std::string bytes = pair.said(1.5, second_ns);
  CHECK(bytes ==
        "{\"kadans\":1,\"from\":\"red\",\"boot\":7,\"number\":1,\"sent_ms\":1000,\"event\":\"robot.pass\","
        "\"data\":{\"x_m\":1.5}}");
  REQUIRE(pair.hear(bytes, 3 * second_ns) == Answer::taken);
  CHECK(pair.event.name == "robot.pass");
  CHECK(pair.event.who == "red");
  CHECK(std::get<double>(pair.event.data.at(0).value) == 1.5);
  CHECK(pair.red.decode(bytes, second_ns, pair.event, pair.why) == Answer::own);  // a broadcast comes back
}

TEST_CASE("messages that are repeated, overtaken, of a stranger or wrong are not taken") {
  Pair pair;
  const std::string first = pair.said(1, second_ns), second = pair.said(2, second_ns);
  CHECK(pair.hear(second, second_ns) == Answer::taken);
  CHECK(pair.hear(second, second_ns) == Answer::repeated);
  CHECK(pair.hear(first, second_ns) == Answer::repeated);
  RobotMessages green(team("green", "blue"), 1);
  CHECK(pair.hear(green.encode(pass(1), second_ns, pair.why), second_ns) == Answer::stranger);
  const auto wrong = [&](std::string from, std::string to) {
    std::string bytes = pair.said(3, second_ns);
    bytes.replace(bytes.find(from), from.size(), to);
    CAPTURE(bytes);
    CHECK(pair.hear(bytes, second_ns) == Answer::wrong);
    CHECK_FALSE(pair.why.empty());
  };
  wrong("\"kadans\":1", "\"kadans\":2");
  wrong("\"kadans\":1", "\"kadans\":0");
  wrong("\"boot\":7", "\"boot\":-7");
  wrong("\"boot\":7", "\"boot\":7.5");
  wrong("\"number\":", "\"number\":9999999999999");
  wrong("robot.pass", "whistle");
  wrong("robot.pass", "robot..pass");
  wrong("{\"x_m\":3.0}", "[3]");
  wrong("{\"x_m\":3.0}", "{\"x_m\":{}}");
  wrong("}}", "},\"more\":1}");
  wrong("}}", "}");
  CHECK(pair.hear(std::string(message_bytes_max + 1, ' '), 0) == Answer::wrong);
}

TEST_CASE("a robot that starts again is heard again, although its numbers begin at 1") {
  Pair pair;
  for (int i = 0; i < 5; ++i) CHECK(pair.hear(pair.said(i, second_ns), second_ns) == Answer::taken);
  RobotMessages again(team("red", "blue"), 8);
  CHECK(pair.hear(again.encode(pass(1), 0, pair.why), 2 * second_ns) == Answer::taken);
}

TEST_CASE(
    "a message that took longer than the fastest one by more than age_max_s is too old, whatever the clocks say") {
  Pair pair;  // the other clock is 1000 s ahead
  CHECK(pair.hear(pair.said(1, 1001 * second_ns), second_ns) == Answer::taken);
  CHECK(pair.hear(pair.said(2, 1002 * second_ns), 2 * second_ns + 490 * ms_ns) == Answer::taken);
  CHECK(pair.hear(pair.said(3, 1003 * second_ns), 3 * second_ns + 510 * ms_ns) == Answer::too_old);
  CHECK(pair.hear(pair.said(4, 1004 * second_ns), 4 * second_ns) == Answer::taken);
}

TEST_CASE("what is sent keeps to the budget of any minute, in messages and in bytes, and nothing is delayed") {
  MessagesConfig config = team("red", "blue");
  config.messages_per_minute = 10;
  RobotMessages few(config, 1);
  std::string why;
  const auto sends = [&](RobotMessages& from, std::int64_t now_ns) {
    return !from.encode(pass(1), now_ns, why).empty();
  };
  for (int i = 0; i < 10; ++i) CHECK(sends(few, i * second_ns));
  CHECK_FALSE(sends(few, 59 * second_ns));
  CHECK(why == "the budget of this minute is spent: 10 messages, 60000 bytes");
  CHECK(sends(few, 60 * second_ns));
  CHECK_FALSE(sends(few, 60 * second_ns));
  config.bytes_per_minute = 250;
  RobotMessages small(config, 1);
  int sent = 0;
  for (int i = 0; i < 10; ++i) sent += sends(small, 0) ? 1 : 0;
  CHECK(sent == 2);
  CHECK(small.encode({.name = "robot.long", .data = {{.name = "t", .value = std::string(600, 'x')}}}, 0, why).empty());
  CHECK(why.find("more than 512") != std::string::npos);
}

TEST_CASE("a million changed bytes of messages and perception take nothing that is wrong") {
  Pair pair;
  RandomStream random(1, "bytes");
  const std::string good = pair.said(1, second_ns);
  const std::string ball = "{\"kadans\":1,\"seen\":[{\"entry\":\"ball\",\"age_s\":0.1,\"x_m\":1,\"y_m\":0}]}";
  std::vector<Observation> seen;
  for (int i = 0; i < 20'000; ++i) {
    std::string message = good, datagram = ball;
    for (int change = 0; change < 1 + i % 25; ++change) {
      message[random.next() % message.size()] = static_cast<char>(random.next());
      datagram[random.next() % datagram.size()] = static_cast<char>(random.next());
    }
    if (pair.hear(message, second_ns) == Answer::taken) CHECK(pair.event.name.starts_with("robot."));
    seen.clear();
    if (!read_perception(datagram, declared(), second_ns, seen).empty()) CHECK(seen.empty());
    for (const Observation& one : seen) CHECK(one.entry < 2);
  }
}

TEST_CASE("the simulated network delays, loses and repeats as its seed says, and nobody hears itself") {
  const ScenarioNetwork settings{.delay_s = 0.02, .jitter_s = 0.01, .lost = 0.3};
  const auto heard = [&](std::uint64_t seed) {
    SimulatedNetwork network(settings, 3, seed);
    std::vector<std::string> all;
    int others = 0;
    std::string_view datagram;
    std::int64_t came_ns = 0;
    for (int i = 0; i < 300; ++i) {
      const std::int64_t now_ns = i * 50 * ms_ns;
      (void)network.port(0).send(now_ns, std::to_string(i));
      CHECK_FALSE(network.port(1).receive(now_ns + 19 * ms_ns, datagram, came_ns));
      while (network.port(1).receive(now_ns + 30 * ms_ns, datagram, came_ns)) all.emplace_back(datagram);
      CHECK_FALSE(network.port(0).receive(now_ns + second_ns, datagram, came_ns));
      while (network.port(2).receive(now_ns + 30 * ms_ns, datagram, came_ns)) ++others;
    }
    const double lost = 600 - static_cast<double>(all.size()) - others;
    CHECK(lost == doctest::Approx(180).epsilon(0.2));
    return all;
  };
  CHECK(heard(1) == heard(1));
  CHECK(heard(1) != heard(2));
  SimulatedNetwork whole({.delay_s = 0.02, .jitter_s = 0}, 3, 1);
  std::string_view datagram;
  std::int64_t came_ns = 0;
  for (std::int64_t i = 1; i <= 100; ++i) {
    (void)whole.port(0).send(i * 50 * ms_ns, std::to_string(i));
    for (const std::size_t other : {1U, 2U}) {
      CHECK(whole.port(other).receive((i * 50 + 20) * ms_ns, datagram, came_ns));
      CHECK(datagram == std::to_string(i));
    }
  }
}

}  // namespace message_test
