#include "football/program/command_line.h"

#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>

using namespace kadans::football;

namespace {

struct Read {
  Options options;
  std::optional<int> code;  // of the program, when it goes no further
};

// `kadans-football match m.json` with these options.
Read read(const std::vector<std::string>& options) {
  std::vector<std::string> words{"kadans-football", "match", "m.json"};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  Read read;
  read.code = read_options(static_cast<int>(argv.size()), argv.data(), read.options);
  return read;
}

Options told(const std::vector<std::string>& options) {
  const Read all = read(options);
  REQUIRE_FALSE(all.code);
  return all.options;
}

}  // namespace

TEST_CASE("a match is shown, at the pace of the clock, only when that is asked for") {
  CHECK(told({}).live.empty());
  CHECK(told({"--live"}).live == "8765");
  CHECK(told({"--live=0"}).live == "0");
  CHECK(told({"--live=9000"}).live == "9000");
}

TEST_CASE("signals are of a record, which is named") {
  CHECK(told({"--record", "a.mcap", "--signals", "joint.*"}).signals == "joint.*");
  CHECK(read({"--signals", "joint.*"}).code == 2);
}
