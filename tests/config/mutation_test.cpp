// Mutated texts: each is read or refused with InputError, and the JSON reader agrees with nlohmann-json, a parser that
// none of us wrote, on what is JSON and what it says.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "broken.h"
#include "kadans/config/robot_config.h"
#include "kadans/config/scenario_config.h"
#include "kadans/signal/random.h"
#include "right_texts.h"

namespace kadans {
namespace {

std::size_t below(RandomStream& random, std::size_t count) {
  return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
}

// A few bytes changed, removed, doubled or moved.
std::string mutated(std::string text, RandomStream& random) {
  constexpr std::string_view tokens = "{}[]\",:.-+e0159tfn\\u/* \n\t\x01\xC3\xFF";
  const std::size_t changes = 1 + below(random, 3);
  for (std::size_t i = 0; i < changes && !text.empty(); ++i) {
    const std::size_t at = below(random, text.size());
    const std::size_t length = 1 + below(random, 12);
    switch (below(random, 4)) {
      case 0:
        text[at] = tokens[below(random, tokens.size())];
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(below(random, text.size()), length));
        break;
      default:
        text.insert(at, 1, tokens[below(random, tokens.size())]);
        break;
    }
  }
  return text;
}

// Whether both trees say the same.
bool same(const JsonValue& ours, const nlohmann::json& theirs) {
  using Kind = JsonValue::Kind;
  switch (ours.kind) {
    case Kind::null:
      return theirs.is_null();
    case Kind::boolean:
      return theirs.is_boolean() && theirs.get<bool>() == ours.boolean;
    case Kind::number:
      return theirs.is_number() && theirs.get<double>() == ours.number;
    case Kind::string:
      return theirs.is_string() && theirs.get<std::string>() == ours.text;
    case Kind::array:
      break;
    case Kind::object:
      if (!theirs.is_object() || theirs.size() != ours.members.size()) return false;
      for (const JsonMember& member : ours.members) {
        if (!theirs.contains(member.name) || !same(member.value, theirs[member.name])) return false;
      }
      return true;
  }
  if (!theirs.is_array() || theirs.size() != ours.items.size()) return false;
  for (std::size_t i = 0; i < ours.items.size(); ++i) {
    if (!same(ours.items[i], theirs[i])) return false;
  }
  return true;
}

// "" when both agree about the text.
std::string disagreement(const std::string& text) {
  const nlohmann::json theirs = nlohmann::json::parse(text, nullptr, false, true);
  const std::string refused = refusal("t", "", [&] {
    const JsonValue ours = parse_json(text, "t");
    if (theirs.is_discarded() || !same(ours, theirs)) throw std::runtime_error("accepted: " + text);
  });
  // What is refused and is JSON for others must be what we are stricter about.
  const bool stricter =
      refused.find("stands twice") != std::string::npos || refused.find("beyond what a double") != std::string::npos;
  return refused.empty() || theirs.is_discarded() || stricter ? "" : refused + " in " + text;
}

}  // namespace

TEST_CASE("On 4000 mutated texts the JSON reader agrees with nlohmann-json") {
  RandomStream random(20240611, "mutated json");
  std::size_t accepted = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string text = mutated(i % 2 == 0 ? right_scenario : right_robot, random);
    std::string verdict;
    CHECK_NOTHROW(verdict = disagreement(text));
    CHECK(verdict == "");
    accepted += refusal("t", "", [&] { parse_json(text, "t"); }).empty() ? 1 : 0;
  }
  CHECK(accepted > 400);   // the mutations are neither all harmless ...
  CHECK(accepted < 3600);  // ... nor all deadly
}

TEST_CASE("600 mutated robot configurations are read or refused, never more") {
  const std::vector<std::string> types{"joint_pid"};
  const std::string file = KADANS_SOURCE_DIR "/config/t.json";
  RandomStream random(7, "mutated robots");
  std::size_t refused = 0;
  for (int i = 0; i < 600; ++i) {
    const std::string text = mutated(right_robot, random);
    std::string message;
    CHECK_NOTHROW(message = refusal(file, "", [&] { read_robot_config_text(text, file, types); }));
    refused += message.empty() ? 0 : 1;
  }
  CHECK(refused > 300);
}

TEST_CASE("1000 mutated scenarios are read or refused, never more") {
  const std::string file = KADANS_SOURCE_DIR "/config/t.json";
  RandomStream random(8, "mutated scenarios");
  std::size_t refused = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::string text = mutated(right_scenario, random);
    std::string message;
    CHECK_NOTHROW(message = refusal(file, "", [&] { read_scenario_config_text(text, file); }));
    refused += message.empty() ? 0 : 1;
  }
  CHECK(refused > 500);
}

}  // namespace kadans
