// A list of fields as a reader, apart from any particular file.
#include "config/json/fields.h"

#include <array>

#include <doctest/doctest.h>

#include "config/broken.h"

namespace kadans::fields_test {
namespace {

enum class Colour : std::uint8_t { red, green };
const std::array<std::string, 2> colours{"red", "green"};

struct Thing {
  double mass_kg = 1;
  int count = 3;
  bool on = true;
  Colour colour = Colour::green;
  std::vector<std::pair<std::string, double>> parts;
};

void thing_fields(Fields& f, Thing& thing) {
  f.number("mass_kg", thing.mass_kg, {.min = 0, .unit = "kg"}, "how heavy");
  f.integer("count", thing.count, {0, 9}, "how many");
  f.boolean("on", thing.on, "whether it runs");
  f.choice("colour", thing.colour, colours, "how it looks");
  f.map("parts", "its parts", [&](Fields& part) {
    double size_m = 0.5;
    part.number("size_m", size_m, {0, 1, "m"}, "how large", Need::required);
    thing.parts.emplace_back(part.key(), size_m);
  });
}

std::string refusal_of(const std::string& text, Thing& thing) {
  return refusal("t", "", [&] {
    Problems problems("t");
    read_fields(parse_json(text, "t"), problems, [&](Fields& f) { thing_fields(f, thing); });
    problems.throw_if_any();
  });
}

}  // namespace

TEST_CASE("Fields store what the file gives and keep the rest") {
  Thing thing;
  CHECK(refusal_of(R"({"mass_kg": 2.5, "colour": "red", "parts": {"a b": {"size_m": 0.1}}})", thing).empty());
  CHECK(thing.mass_kg == 2.5);
  CHECK(thing.count == 3);
  CHECK(thing.colour == Colour::red);
  REQUIRE(thing.parts.size() == 1);
  CHECK(thing.parts[0].first == "a b");
}

TEST_CASE("A value that is refused leaves the field as it was") {
  Thing thing;
  CHECK(refusal_of(R"({"mass_kg": -1, "count": 10, "on": 0, "colour": 1})", thing) ==
        "1:13: mass_kg is -1, must be at least 0 kg: how heavy\n"
        "1:26: count is 10, must be 0..9: how many\n"
        "1:36: on must be true or false, not the number 0: whether it runs\n"
        "1:49: colour must be a string, not the number 1: how it looks");
  CHECK(thing.mass_kg == 1);
  CHECK(thing.count == 3);
  CHECK(thing.on);
  CHECK(thing.colour == Colour::green);
}

TEST_CASE("A whole number may be written with a point or an exponent, not with a fraction") {
  Thing thing;
  CHECK(refusal_of(R"({"count": 5.0})", thing).empty());
  CHECK(thing.count == 5);
  CHECK(refusal_of(R"({"count": 0.7e1})", thing).empty());
  CHECK(thing.count == 7);
  CHECK(refusal_of(R"({"count": 2.5})", thing) == "1:11: count is 2.5, must be 0..9, a whole number: how many");
}

TEST_CASE("All mistakes of a file are told, in its order, each once") {
  Thing thing;
  CHECK(refusal_of("{\"parts\": {\"x\": {}, \"y\": 1},\n \"wrong\": 1, \"mass_kg\": null}", thing) ==
        "1:17: key 'size_m' is missing in parts.x: how large\n"
        "1:26: parts.y must be an object, not the number 1: its parts\n"
        "2:2: unknown key 'wrong' (known: mass_kg, count, on, colour, parts)\n"
        "2:25: mass_kg must be a number in kg, not null: how heavy");
}

TEST_CASE("A file with very many mistakes is refused with the first hundred") {
  std::string text = "{\"a0\": 0";
  for (int i = 1; i < 1000; ++i) text += ", \"a" + std::to_string(i) + "\": 0";
  Thing thing;
  std::size_t count = 0;
  try {
    Problems problems("t");
    read_fields(parse_json(text + "}", "t"), problems, [&](Fields& f) { thing_fields(f, thing); });
    problems.throw_if_any();
  } catch (const InputError& error) {
    count = error.problems().size();
  }
  CHECK(count == 100);
}

TEST_CASE("Names from outside are shown short and without control characters") {
  CHECK(in_quotes("a\nb") == "'a?b'");
  CHECK(in_quotes(std::string(100, 'x')) == "'" + std::string(80, 'x') + "...'");
  std::string umlauts;
  for (int i = 0; i < 60; ++i) umlauts += "\u00e4";
  CHECK(in_quotes("x" + umlauts).size() == 1 + 1 + 2 * 39 + 4);  // not cut inside a character
}

TEST_CASE("The same list of fields describes itself") {
  Thing thing;
  const FieldInfo info = describe_fields([&](Fields& f) { thing_fields(f, thing); });
  REQUIRE(info.fields.size() == 5);
  CHECK(info.fields[0].name == "mass_kg");
  CHECK(info.fields[0].unit == "kg");
  CHECK(info.fields[0].default_json == "1");
  CHECK(info.fields[3].choices == std::vector<std::string>{"red", "green"});
  CHECK(info.fields[3].default_json == "\"green\"");
  CHECK(info.fields[4].kind == FieldInfo::Kind::map);
  REQUIRE(info.fields[4].fields.size() == 1);
  CHECK(info.fields[4].fields[0].fields[0].required);
}

}  // namespace kadans::fields_test
