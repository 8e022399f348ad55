// Mutated texts: each is read or refused with InputError, and the JSON reader agrees with nlohmann-json, a parser that
// none of us wrote, on what is JSON and what it says.
#include <doctest/doctest.h>

#include "config/broken.h"
#include "config/right_texts.h"
#include "config/robot/robot_config.h"
#include "config/scenario/scenario_config.h"
#include "json_agreement.h"
#include "kadans/signal/random.h"

namespace kadans::mutation_test {
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

}  // namespace kadans::mutation_test
