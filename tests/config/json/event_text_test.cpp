// Events as people and programs outside write them.
#include "config/scenario/event_text.h"

#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"

namespace event_text_test {

using namespace kadans;

namespace {

std::string refusal(const std::string& text) {
  try {
    (void)read_event(text, "");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("an event is a name, and its data is written in three ways that mean the same") {
  CHECK(event_text(read_event("whistle", "")) == "whistle");
  CHECK(event_text(read_event("ball.seen.far", "")) == "ball.seen.far");
  for (const char* text : {"seen far_m=1.5,left=true,word='a b'", "seen{far_m=1.5, left=true, word=\"a b\"}",
                           "seen {\"far_m\": 1.5, \"left\": true, \"word\": \"a b\"}"}) {
    CAPTURE(text);
    CHECK(event_text(read_event(text, "")) == "seen {\"far_m\":1.5,\"left\":true,\"word\":\"a b\"}");
  }
  CHECK(event_text(read_event("seen {}", "")) == "seen");
}

TEST_CASE("numbers of an event's data keep all their bits as text and back") {
  for (const double value : {0.1, -0.0, 1e-300, 1.0 / 3, 123456789.123456789, 5e-324}) {
    const PlayedEvent event{.name = "x", .data = {{.name = "a", .value = value}}};
    const PlayedEvent again = read_event(event_text(event), "");
    CHECK(std::get<double>(again.data.at(0).value) == value);
    CHECK(std::signbit(std::get<double>(again.data.at(0).value)) == std::signbit(value));
  }
}

TEST_CASE("what is no event, or is more than an event may hold, is refused with a sentence") {
  CHECK(has(refusal(""), "'' is no name of an event"));
  CHECK(has(refusal("ball seen.."), "wanted"));
  CHECK(has(refusal(".seen"), "'.seen' is no name of an event: words of letters"));
  CHECK(has(refusal("a..b"), "is no name"));
  CHECK(has(refusal(std::string(65, 'a')), "is no name"));
  CHECK(has(refusal("seen far=nan"), "wanted a number"));
  CHECK(has(refusal("seen far=1e999"), "wanted a number"));
  CHECK(has(refusal("seen far=1,far=2"), "stands twice"));
  CHECK(has(refusal("seen {\"far\": 1, \"far\": 2}"), "far"));
  CHECK(refusal("seen {\"far\": 1e999}") != "");
  CHECK(has(refusal("seen {\"far\": [1]}"), "field 'far' must be a number, true, false or a text"));
  CHECK(has(refusal("seen {\"far\": {\"a\": 1}}"), "field 'far' must be a number, true, false or a text"));
  CHECK(has(refusal("seen {\"far\": null}"), "field 'far' must be a number, true, false or a text"));
  CHECK(has(refusal("seen {\"a b\": 1}"), "field 'a b' must be named with letters"));
  CHECK(has(refusal("seen word='" + std::string(257, 'x') + "'"), "field 'word' is longer than 256 bytes"));
  CHECK(has(refusal("seen word='\xff'"), "field 'word' is not UTF-8"));
  CHECK(has(refusal("seen a=1} | seen{a=2"), "wanted name=value"));
  std::string many = "seen ", large = "seen ";
  for (int i = 0; i < 65; ++i) many += (i > 0 ? ",f" : "f") + std::to_string(i) + "=1";
  for (int i = 0; i < 20; ++i) large += (i > 0 ? ",f" : "f") + std::to_string(i) + "='" + std::string(250, 'x') + "'";
  CHECK(has(refusal(many), "more than 64"));
  CHECK(has(refusal(large), "more than 4096 bytes"));
  CHECK(has(refusal("seen " + std::string(100'000, '{')), "wanted"));
}

}  // namespace event_text_test
