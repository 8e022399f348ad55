// The JSON reader: what it accepts, where things stand, and what it says to what it refuses.
#include "config/json/json_value.h"

#include <clocale>

#include <doctest/doctest.h>

#include "config/broken.h"
#include "wrong_json.h"

namespace kadans::json_value_test {
namespace {

std::string refusal_of(const std::string& text) {
  return refusal("t.json", "", [&] { parse_json(text, "t.json"); });
}

}  // namespace

TEST_CASE("Every value and every key knows its line and column") {
  const JsonValue value =
      parse_json("// a comment\n{ \"a\": [1, /* two */ 2.5],\n  \"\u00e9\u20ac\": \"x\", \"b\": null }", "t.json");
  REQUIRE(value.kind == JsonValue::Kind::object);
  CHECK(value.place == TextPlace{2, 1});
  REQUIRE(value.members.size() == 3);
  const JsonMember& a = value.members[0];
  CHECK(a.place == TextPlace{2, 3});
  CHECK(a.value.place == TextPlace{2, 8});
  REQUIRE(a.value.items.size() == 2);
  CHECK(a.value.items[1].place == TextPlace{2, 22});
  CHECK(a.value.items[1].number == 2.5);
  CHECK(value.members[1].place == TextPlace{3, 3});
  CHECK(value.members[1].value.place == TextPlace{3, 9});  // columns count characters, not bytes
  CHECK(value.members[2].value.kind == JsonValue::Kind::null);
}

TEST_CASE("Strings mean what RFC 8259 says") {
  const JsonValue value = parse_json(R"(["\"\\\/\b\f\n\r\t", "\u0041\u00e9\u20AC\ud83d\ude00"])", "t.json");
  CHECK(value.items[0].text == "\"\\/\b\f\n\r\t");
  CHECK(value.items[1].text == "A\u00e9\u20ac\U0001f600");
}

TEST_CASE("Numbers are read to the last bit, whatever the locale") {
  const std::string old = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "nl_NL.UTF-8", "C"}) {
    std::setlocale(LC_ALL, name);
    const JsonValue value = parse_json("[0.1, -2.5e-3, 1E+2, 18446744073709551615, -0]", "t.json");
    CHECK(value.items[0].number == 0.1);
    CHECK(value.items[1].number == -0.0025);
    CHECK(value.items[2].number == 100);
    CHECK(value.items[3].text == "18446744073709551615");
    CHECK(value.items[4].number == 0);
  }
  std::setlocale(LC_ALL, old.c_str());
}

TEST_CASE("A byte order mark, comments and any white space are no mistakes") {
  CHECK(refusal_of("\xEF\xBB\xBF{}").empty());
  CHECK(refusal_of("\t/* a\n * b */ {\r\n} // end").empty());
  CHECK(refusal_of("// a line that ends as on old machines\r{}").empty());
  CHECK(refusal_of("\"\\u0000\"").empty());
}

TEST_CASE("Every wrong JSON text is refused at its place in plain words") {
  for (const WrongJson& wrong : wrong_json) {
    CAPTURE(wrong.text);
    CHECK(refusal_of(wrong.text) == std::string(wrong.message));
  }
}

TEST_CASE("What is too deep, too long or too large is refused") {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  CHECK(refusal_of(nested(json_depth_max)).empty());
  CHECK(refusal_of(nested(json_depth_max + 1)) == "1:65: values are nested deeper than 64 levels");
  CHECK(refusal_of(std::string(100'000, '{')) == "1:2: a key in double quotes is needed here, not '{'");
  CHECK(refusal_of(nested(1'000'000)) == "1:65: values are nested deeper than 64 levels");
  CHECK(refusal_of(std::string(json_size_max_bytes + 1, ' ')) == " the file is larger than 16 MB");
  std::string many = "[0";
  for (std::size_t i = 1; i < json_values_max; ++i) many += ",0";
  CHECK(refusal_of(many + "]") == "1:2000000: the file holds more than 1000000 values");
}

TEST_CASE("A file that is not there, or no file, is refused by name") {
  CHECK(refusal("/none/x.json", "", [] { read_input_file("/none/x.json"); }) == " there is no such file");
  CHECK(refusal("/", "", [] { read_input_file("/"); }) == " this is a folder, not a file");
}

}  // namespace kadans::json_value_test
