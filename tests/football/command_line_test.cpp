#include "football/program/command_line.h"

#include <vector>

#include <doctest/doctest.h>

using namespace kadans::football;

namespace {

// What `kadans-football match m.json` with these options is told.
Options told(std::vector<std::string> options) {
  std::vector<std::string> words{"kadans-football", "match", "m.json"};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  Options read;
  REQUIRE_FALSE(read_options(static_cast<int>(argv.size()), argv.data(), read));
  return read;
}

}  // namespace

TEST_CASE("a match is shown, at the pace of the clock, only when that is asked for") {
  CHECK(told({}).live.empty());
  CHECK(told({"--live"}).live == "8765");
  CHECK(told({"--live=0"}).live == "0");
  CHECK(told({"--live=9000"}).live == "9000");
}
