// What a live server tells a client, without a socket.
#include "remote/page/live_client.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "remote/live_instance.h"

namespace live_client_test {

using namespace kadans;
using namespace kadans::remote_test;

namespace {

struct Viewer {
  LiveInstance live;
  LiveHub hub{{.instance = live.instance,
               .port = live.instance.open_port(),
               .texts = {.name = "bench", .urdf = "<robot name=\"bench\"/>", .description = "{}"},
               .urdf_file = "bench.urdf",
               .timing = {}}};
  std::uint64_t tick = 0;

  // A row whose first signal is `value`, as the control thread hands it on.
  void row(double value) {
    std::vector<double> values(live.robot.catalog.signals.size(), 0);
    values.front() = value;
    tick += 1400;  // a whole multiple of what the hub asks for
    live.control_side.record(tick, static_cast<std::int64_t>(tick) * 1'000'000, values);
  }
  // The hub asks for rows in the first beat with a client.
  void watch() { hub.beat(); }
  std::uint32_t channel(const std::string& topic) const {
    const auto& all = hub.channels().all();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].topic == topic) return static_cast<std::uint32_t>(i + 1);
    }
    FAIL("no channel ", topic);
    return 0;
  }
};

// The topic of the first signal, which is one of a control object: the objects have topics of their own.
std::string first_topic(const std::string& signal) {
  const std::size_t dot = signal.find('.');
  REQUIRE(signal.substr(0, dot) == "control");
  const std::size_t end = signal.find('.', dot + 1);
  return signal.substr(0, dot) + "/" + signal.substr(dot + 1, end - dot - 1);
}

std::vector<LiveClient::Outgoing> all_of(LiveClient& client) {
  std::vector<LiveClient::Outgoing> all;
  for (LiveClient::Outgoing out; client.next(out);) all.push_back(out);
  return all;
}

std::string text_of(const LiveClient::Outgoing& out) {
  return {reinterpret_cast<const char*>(out.bytes.data()), out.bytes.size()};
}

std::vector<Json> texts_of(LiveClient& client) {
  std::vector<Json> texts;
  for (const LiveClient::Outgoing& out : all_of(client)) {
    if (!out.binary) texts.push_back(Json::parse(text_of(out)));
  }
  return texts;
}

// Of message data: behind kind, subscription, time and the head of CDR.
double first_number(const LiveClient::Outgoing& out) {
  double value = 0;
  std::memcpy(&value, out.bytes.data() + 13 + 4, sizeof value);
  return value;
}

void subscribe(LiveClient& client, std::uint32_t id, std::uint32_t channel) {
  client.text(Json{{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}}.dump());
}

}  // namespace

TEST_CASE("a client of the live server learns who it is, what there is and which fields are which signals") {
  Viewer viewer;
  LiveClient client(viewer.hub, 1, false, "test");
  const std::vector<Json> texts = texts_of(client);
  REQUIRE(texts.size() == 3);
  CHECK(texts[0]["op"] == "serverInfo");
  const std::string first = viewer.live.robot.catalog.signals.info(0).name;
  CHECK(texts[0]["metadata"].value("signals/" + first_topic(first), "").starts_with(first + "\t"));
  CHECK(texts[1]["op"] == "advertise");
  CHECK(texts[2]["op"] == "advertiseServices");
}

TEST_CASE("each client of the live server learns whether it writes and what can be played by then") {
  Viewer viewer;
  const auto told = [&viewer](std::uint64_t id, bool writes) {
    LiveClient client(viewer.hub, id, writes, "test");
    return texts_of(client).at(0)["metadata"];
  };
  CHECK(told(1, false)["writes"] == "no");
  CHECK(told(2, true)["writes"] == "yes");
  CHECK(told(3, false)["writes"] == "no");
  CHECK(told(4, true)["plays"] == "nod wait");
  viewer.live.project.write("behaviors/bench/later.lua", "");
  CHECK(told(5, false)["plays"] == "later nod wait");
  CHECK(told(6, true)["plays"] == "later nod wait");
}

TEST_CASE("a slow client of the live server gets the newest values and skips what came between") {
  Viewer viewer;
  LiveClient slow(viewer.hub, 1, false, "test");
  const std::string first = viewer.live.robot.catalog.signals.info(0).name;
  subscribe(slow, 7, viewer.channel("/" + first_topic(first)));
  (void)all_of(slow);
  viewer.watch();
  for (const double value : {1.0, 2.0, 3.0}) {
    viewer.row(value);
    viewer.hub.beat();
  }
  const std::vector<LiveClient::Outgoing> got = all_of(slow);
  REQUIRE(got.size() == 1);
  CHECK(first_number(got[0]) == 3.0);
  CHECK(all_of(slow).empty());
}

TEST_CASE("events wait for a slow client of the live server, beyond what is kept the oldest are given up") {
  Viewer viewer;
  LiveClient slow(viewer.hub, 1, false, "test");
  (void)all_of(slow);
  subscribe(slow, 1, viewer.channel("/transitions"));
  const std::size_t sent = LiveChannel::events_kept + 20;
  for (std::size_t i = 0; i < sent; ++i) {
    Event event;
    event.kind = Event::Kind::transition;
    event.transition.to = "s" + std::to_string(i);
    viewer.live.instance.tell(event.line());
    viewer.hub.beat();
  }
  const std::vector<LiveClient::Outgoing> got = all_of(slow);
  REQUIRE(got.size() == LiveChannel::events_kept);
  CHECK(text_of(got.front()).find("\"s20\"") != std::string::npos);
  CHECK(text_of(got.back()).find("\"s" + std::to_string(sent - 1) + "\"") != std::string::npos);
}

TEST_CASE("without the token a client of the live server changes nothing and is told so") {
  Viewer viewer;
  LiveClient reader(viewer.hub, 1, false, "test");
  (void)all_of(reader);
  reader.text(R"({"op":"setParameters","parameters":[{"name":"posture.hip.kp_Nm_per_rad","value":1}]})");
  std::vector<Json> told = texts_of(reader);
  REQUIRE(told.size() == 1);
  CHECK(told[0]["op"] == "status");
  CHECK(told[0]["level"] == 2);

  std::string call("\x02\x01\x00\x00\x00\x05\x00\x00\x00\x04\x00\x00\x00json", 17);
  call += R"({"verb":"estop"})";
  reader.binary(std::as_bytes(std::span(call.data(), call.size())));
  told = texts_of(reader);
  REQUIRE(told.size() == 1);
  CHECK(told[0]["op"] == "serviceCallFailure");
  CHECK(told[0]["callId"] == 5);
  viewer.row(0);  // a stop that was asked for would be taken here
  CHECK(viewer.live.robot.safety.robot_level() == SafetyLevel::normal);
}

TEST_CASE("the live server answers what it does not understand, and goes on") {
  Viewer viewer;
  LiveClient client(viewer.hub, 1, true, "test");
  (void)all_of(client);
  for (const char* wrong : {"", "{", "[]", "null", R"({"op":7})", R"({"op":"subscribe"})",
                            R"({"op":"subscribe","subscriptions":[{"id":-1}]})",
                            R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":999}]})", R"({"op":"fly"})",
                            R"({"op":"setParameters","parameters":[{"name":"x","value":"y"}]})"}) {
    CAPTURE(wrong);
    client.text(wrong);
    const std::vector<Json> told = texts_of(client);
    REQUIRE(told.size() == 1);
    CHECK(told[0]["op"] == "status");
  }
  for (const std::string& wrong : {std::string(), std::string("\x02", 1),
                                   std::string("\x02\x01\x00\x00\x00\x01\x00\x00\x00\xff\xff\xff\xffx", 14)}) {
    client.binary(std::as_bytes(std::span(wrong.data(), wrong.size())));
    CHECK(texts_of(client).size() == 1);
  }
}

TEST_CASE("a client of the live server that asks and does not read is given up") {
  Viewer viewer;
  LiveClient client(viewer.hub, 1, false, "test");
  for (int i = 0; i < 200'000 && !client.hopeless(); ++i) client.text(R"({"op":"getParameters","parameterNames":[]})");
  CHECK(client.hopeless());
}

TEST_CASE("a client of the live server that nests values deep, or says no UTF-8, is told so in words of our own") {
  Viewer viewer;
  LiveClient client(viewer.hub, 1, true, "test");
  (void)all_of(client);
  const std::string deep = std::string(200'000, '[') + std::string(200'000, ']');
  const std::string asks = R"({"op":"getParameters","parameterNames":[],"id":)";
  const std::vector<std::string> all{"\xC3",
                                     "{\"op\":\"\xFF\"}",
                                     deep,
                                     asks + deep + "}",
                                     asks + "{}}",
                                     R"({"op":"fetchAsset","uri":"x","requestId":1e300})",
                                     R"({"op":"subscribe","subscriptions":[{"id":1e300,"channelId":1}]})"};
  for (const std::string& wrong : all) {
    client.text(wrong);
    const std::vector<Json> told = texts_of(client);
    REQUIRE(told.size() == 1);
    CHECK(told[0]["op"] == "status");
    CHECK(told[0].dump().size() < 300);
  }
  CHECK_FALSE(client.hopeless());
}

TEST_CASE("subscriptions and watched parameters of a client of the live server are bounded") {
  Viewer viewer;
  LiveClient client(viewer.hub, 1, false, "test");
  (void)all_of(client);
  const std::uint32_t most = LiveClient::subscriptions_max;
  for (std::uint32_t id = 0; id < most; ++id) subscribe(client, id, 1);
  CHECK(texts_of(client).empty());
  subscribe(client, most, 1);
  CHECK(texts_of(client).size() == 1);
  subscribe(client, 0, 1);  // one that it has
  CHECK(texts_of(client).empty());
  std::size_t refused = 0;
  for (std::size_t i = 0; i <= LiveClient::watched_max; ++i) {
    client.text(Json{{"op", "subscribeParameterUpdates"}, {"parameterNames", {"p" + std::to_string(i)}}}.dump());
    refused += texts_of(client).size();
  }
  CHECK(refused == 1);
}

TEST_CASE("clients of the live server that do not read are given up before all together hold much, the worst first") {
  Viewer viewer;
  std::vector<std::unique_ptr<LiveClient>> clients;
  for (std::uint64_t id = 1; id <= 50; ++id)
    clients.push_back(std::make_unique<LiveClient>(viewer.hub, id, false, "test"));
  LiveClient reads(viewer.hub, 100, true, "test");
  const auto waiting = [&] {
    std::size_t sum = reads.reply_bytes();
    for (const auto& client : clients) sum += client->reply_bytes();
    return sum;
  };
  std::size_t most = 0;
  const std::string asks = R"({"op":"fetchAsset","requestId":1,"uri":")" + std::string(500'000, 'x') + "\"}";
  for (int round = 0; round < 30; ++round) {
    for (const auto& client : clients) client->text(asks);
    most = std::max(most, waiting());
  }
  CHECK(most <= LiveHub::replies_max_bytes);
  CHECK(std::ranges::any_of(clients, [](const auto& client) { return client->hopeless(); }));
  CHECK_FALSE(reads.hopeless());
}

TEST_CASE("the live server hands out no file that is no mesh, whatever a URDF from elsewhere calls one") {
  const Project project;
  project.write("robot/secret.txt", "private");
  project.write("robot/part.stl", "solid");
  LiveAssets assets(
      {.name = "bench",
       .urdf = R"(<mesh filename="secret.txt"/><mesh filename="file:///etc/passwd"/><mesh filename="part.stl"/>)",
       .description = "{}"},
      (project.root / "robot/robot.urdf").string());
  CHECK(*assets.read("part.stl") == "solid");
  CHECK(assets.read("secret.txt") == nullptr);
  CHECK(assets.read("file:///etc/passwd") == nullptr);
}

TEST_CASE("the live server hands out the robot's URDF and no file that it does not name") {
  Viewer viewer;
  CHECK(*viewer.hub.assets().read("package://bench/bench.urdf") == "<robot name=\"bench\"/>");
  for (const char* wrong :
       {"", "/etc/passwd", "file:///etc/passwd", "package://bench/../../etc/passwd", "../robot.json"})
    CHECK(viewer.hub.assets().read(wrong) == nullptr);
}

}  // namespace live_client_test
