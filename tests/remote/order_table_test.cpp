// One table of orders, and the two ways in which a request may be said.
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"
#include "remote/order/order_json.h"

namespace order_table_test {

using namespace kadans;

namespace {

std::string refusal_of(const std::string& line, Role role = Role::develop) {
  try {
    (void)read_request(line, role);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string brief_refusal(const Json& json, bool paced = false) {
  try {
    (void)read_brief_request(json, paced);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("ctl tells of each entry of the world model what is known, and of others that they are there") {
  const std::vector<SeenInfo> declared{
      {.name = "ball", .places = 2, .fields = {{"x_m", "m", "", -9, 9}, {"y_m", "m", "", -9, 9}}},
      {.name = "door", .places = 2, .fields = {{"x_m", "m", "", -9, 9}, {"y_m", "m", "", -9, 9}}}};
  SeenEntries seen;
  seen.count = 2;
  seen.entries[0] = {.confidence = 0.5, .age_s = 0.25, .fields = {1.5, -1}, .source = SeenSource::perception};
  const Json told = world_json(seen, declared)["world"];
  REQUIRE(told.size() == 2);
  CHECK(told[0]["entry"] == "ball");
  CHECK(told[0]["age_s"] == 0.25);
  CHECK(told[0]["source"] == "perception");
  CHECK(told[0]["fields"] == Json{{"x_m", 1.5}, {"y_m", -1.0}});
  CHECK(told[1] == Json{{"entry", "door"}});
}

TEST_CASE("Each order has a verb and words of its own, and a sentence") {
  std::set<std::string> verbs, words;
  for (const OrderInfo& order : order_table::orders) {
    CAPTURE(order.verb);
    CHECK(verbs.insert(order.verb).second);
    CHECK((order.words[0] == '\0' || words.insert(order.words).second));
    CHECK(std::string(order.doc).size() > 5);
    // One text and one number: `text` and `value` of the page must be plain. A second text stands behind the first.
    int texts = 0, numbers = 0;
    for (const OrderArgument& argument : order.arguments) {
      texts += argument.kind == OrderArgument::Kind::text ? 1 : 0;
      numbers += argument.kind == OrderArgument::Kind::number ? 1 : 0;
    }
    CHECK((!order.is_brief() || (texts + numbers <= 2 && numbers <= 1)));
    CHECK((order.kind || order.arguments[0].kind == OrderArgument::Kind::none || !order.is_brief() ||
           order.faces == OrderInfo::Faces::paced));
  }
}

TEST_CASE("An event and its data are one text, however they are said") {
  const Order said =
      read_request(R"({"verb": "emit", "event": "seen", "data": "{\"far_m\": 1}"})", Role::operate).order("");
  const Order brief = read_brief_request(Json{{"verb", "emit"}, {"text", "seen {\"far_m\": 1}"}}, false).order("");
  CHECK(said.kind == Order::Kind::emit);
  CHECK(said.text == "seen {\"far_m\": 1}");
  CHECK(brief.text == said.text);
  CHECK(read_request(R"({"verb": "emit", "event": "seen"})", Role::operate).order("").text == "seen");
  CHECK(refusal_of(R"({"verb": "emit", "event": "seen", "dat": "x"})").find("did you mean 'data'") !=
        std::string::npos);
  CHECK(refusal_of(R"({"verb": "emit"})").find("emit needs \"event\"") != std::string::npos);
  CHECK(refusal_of(R"({"verb": "emit", "event": "seen"})", Role::read).find("needs the role operate") !=
        std::string::npos);
}

TEST_CASE("docs/ctl.md has every order of the command line, and every verb of the sockets") {
  std::ifstream file(KADANS_SOURCE_DIR "/docs/ctl.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  REQUIRE(text.size() > 1000);
  for (const OrderInfo& order : order_table::orders) {
    CAPTURE(order.verb);
    CHECK(text.find("`" + std::string(order.words)) != std::string::npos);
    if (order.faces != OrderInfo::Faces::paced && std::string(order.verb) != "replace")
      CHECK(text.find("`" + std::string(order.verb)) != std::string::npos);
  }
}

TEST_CASE("A request says what the order needs by name, a brief one as text and value, and both become the same") {
  const Order whole = read_request(R"({"verb": "set", "name": "hip.kp", "value": 5})", Role::develop).order("me", 3);
  const Order brief =
      read_brief_request({{"verb", "set"}, {"text", "hip.kp"}, {"value", 5}, {"id", 9}}, false).order("me", 3);
  for (const Order* order : {&whole, &brief}) {
    CHECK(order->kind == Order::Kind::set_parameter);
    CHECK(order->text == "hip.kp");
    CHECK(order->value == 5);
    CHECK(order->who == "me");
    CHECK(order->client == 3);
  }
  CHECK(read_request(R"({"verb": "play", "list": "nod", "replace": true})", Role::operate).order("").kind ==
        Order::Kind::replace);
  CHECK(read_request(R"({"verb": "play", "list": "nod", "replace": false})", Role::operate).order("").kind ==
        Order::Kind::play);
  // What the page always sends along, and what the order has no use for.
  CHECK(read_brief_request({{"verb", "reload"}, {"text", ""}, {"value", 0}}, false).order("").text.empty());
}

TEST_CASE("What the table says of an order and its arguments is held") {
  CHECK(refusal_of(R"({"verb": "set", "name": "x"})") == "set needs \"value\"");
  CHECK(refusal_of(R"({"verb": "set", "name": 5, "value": 1})") == "\"name\" must be a string");
  CHECK(refusal_of(R"({"verb": "watch", "signals": ["a"], "rate_hz": 5000})") ==
        "\"rate_hz\" = 5000 must be 0.01..1000");
  CHECK(refusal_of(R"({"verb": "set_point", "list": "a=1", "time_s": -1})") == "\"time_s\" = -1 must be at least 0");
  CHECK(refusal_of(R"({"verb": "sett", "name": "x", "value": 1})").find("did you mean 'set'") != std::string::npos);
  CHECK(refusal_of(R"({"verb": "set", "name": "x", "valu": 1, "value": 1})").find("did you mean 'value'") !=
        std::string::npos);
  CHECK(refusal_of(R"({"verb": "set", "name": "x", "value": 1})", Role::operate) ==
        "'set' needs the role develop; this socket gives operate");
  CHECK(refusal_of(R"({"verb": "speed", "times": 2})") == "'speed' is for the page and ROS 2");
  CHECK(brief_refusal({{"verb", "set"}, {"text", "x"}}) == "set needs \"value\"");
  CHECK(brief_refusal({{"verb", "set"}, {"text", 7}, {"value", 1}}) == "\"text\" must be a string");
  CHECK(brief_refusal({{"verb", "speed"}, {"value", 1000}}, true) == "\"value\" = 1000 must be 0.01..100");
  CHECK(brief_refusal({{"verb", "speed"}, {"value", 2}}).starts_with("'speed' is no order; there are "));
  CHECK(brief_refusal({{"verb", "speed"}, {"value", 2}}, true).empty());
  CHECK(brief_refusal({{"verb", "line"}, {"text", "os.exit()"}}).starts_with("'line' is no order"));
  // Without its joints such an order would be about all of them.
  CHECK(brief_refusal({{"verb", "disable_drives"}, {"joints", "hip"}}).starts_with("unknown field 'joints'"));
  CHECK(brief_refusal({{"verb", "pause"}, {"text", "nod"}}) == "pause takes no \"text\"");
  CHECK(brief_refusal({{"verb", "pause"}, {"text", ""}, {"value", 3}}) == "pause takes no \"value\"");
  CHECK(brief_refusal(Json::array({1})) == "a request needs \"verb\", a string");
}

}  // namespace order_table_test
