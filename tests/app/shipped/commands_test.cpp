// Every command there is, from the program's own table of commands: a new one is looked at without being named here, or
// the test says what it misses.
#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/command_line.h"
#include "app/program.h"

namespace commands_test {

using namespace kadans;
using namespace kadans::program;
namespace fs = std::filesystem;

namespace {

// What is wrong with a command line, "" when it parses. Nothing is run.
std::string usage_problem(const std::vector<std::string>& words) {
  CommandLine line;
  std::vector<std::string> reversed(words.rbegin(), words.rend());
  try {
    line.app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    return error.get_name() + ": " + error.what();
  }
  return "";
}

std::vector<std::string> split(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

// By the type that the help shows: numbers, and what they may be. All other types are words.
struct NumberType {
  std::vector<std::string> good, wrong;
};
const std::vector<std::string> no_numbers{"", "one", "1x", "1 2", "nan", "-nan", "inf", "1e999", "0x10", "--"};
const std::map<std::string, NumberType> number_types{{"N", {{"1"}, {"1.5", "1e3", "+1", "99999999999999999999"}}},
                                                     {"S", {{"0.5", "1"}, {}}},
                                                     {"X", {{"0.5", "1"}, {}}},
                                                     {"HZ", {{"50"}, {"-1"}}},
                                                     {"US", {{"50"}, {"-1"}}},
                                                     {"MB", {{"50"}, {"-1"}}}};
const std::set<std::string> word_types{"FILE",
                                       "KIND",
                                       "FOLDER",
                                       "NAME=FOLDER",
                                       "DIR",
                                       "PATH",
                                       "TEXT",
                                       "LIST",
                                       "PLAN",
                                       "NAME",
                                       "SIGNAL",
                                       "TOPIC",
                                       "OTHER",
                                       "GROUP",
                                       "IP",
                                       "BRANCH",
                                       "S=FILE",
                                       "NAME=NUMBER",
                                       "NAME[=STEP]",
                                       "SET",
                                       "WxH",
                                       "HOST",
                                       "HOST:PORT",
                                       "TAG",
                                       "DATA",
                                       "JOINTS",
                                       "TYPE",
                                       "PATH|TAG|NAME",
                                       "PART/PARTS",
                                       "LINK=X,Y,Z",
                                       "KIND[:OF]@S[+D][=SIZE]",
                                       "PATTERN[@HZ],...",
                                       "SCENARIO"};

std::string type_of(const CLI::Option& option) {
  std::string type = option.get_type_name();
  if (word_types.contains(type)) return type;
  type = type.substr(0, type.find(':'));
  return type.ends_with("...") && type != "PATTERN[@HZ],..." ? type.substr(0, type.size() - 3) : type;
}

// A command line that parses, but for what stands behind `--seed` and its like.
std::vector<std::string> with_positionals(const CommandEntry& entry, const CLI::Option* but) {
  std::vector<std::string> words = split(entry.words);
  for (const CLI::Option* option : entry.options) {
    if (option == but || !option->get_required()) continue;
    std::string value = number_types.contains(type_of(*option)) ? "1" : "/dev/null";
    if (option->get_type_name().find('{') != std::string::npos) {  // one of some words
      const std::string choice = option->get_type_name();
      value = choice.substr(choice.find('{') + 1, choice.find_first_of(",}") - choice.find('{') - 1);
    }
    if (!option->get_positional()) words.push_back(option->get_name());
    words.push_back(value);
  }
  return words;
}

std::string refusal(const CommandEntry& entry, const CLI::Option* option, const std::string& value) {
  std::vector<std::string> words = with_positionals(entry, option);
  for (const CLI::Option* needed : option->get_needs()) {
    words.push_back(needed->get_name());
    if (!type_of(*needed).empty()) words.emplace_back("/dev/null");
  }
  if (option->get_positional()) {
    words.push_back(value);
  } else {
    words.push_back(option->get_name() + "=" + value);
  }
  return usage_problem(words);
}

// The commands that the help of one shows, without the words that explain them.
std::vector<std::string> examples_of(const std::string& help) {
  std::vector<std::string> examples;
  std::istringstream lines(help.substr(std::min(help.find("Examples:\n"), help.size())));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("  kadans ")) continue;
    bool quoted = false;
    std::size_t end = 2;
    for (; end < line.size() && (quoted || line.compare(end, 2, "  ") != 0); ++end)
      quoted = quoted != (line[end] == '\'');
    examples.push_back(line.substr(9, end - 9));
  }
  return examples;
}

std::vector<std::string> shell_split(const std::string& text) {
  std::vector<std::string> words(1);
  bool quoted = false;
  for (const char c : text) {
    if (c == '\'') {
      quoted = !quoted;
    } else if (c == ' ' && !quoted) {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

}  // namespace

TEST_CASE("every option that is a number refuses what is none, nan, and what it cannot hold") {
  const CommandLine line;
  std::size_t numbers = 0;
  for (const CommandEntry& entry : commands_of(line)) {
    for (const CLI::Option* option : entry.options) {
      CAPTURE(entry.words);
      CAPTURE(option->get_name());
      const std::string type = type_of(*option);
      if (type.empty() || word_types.contains(type)) continue;  // flags have no type
      const auto number = number_types.find(type);
      REQUIRE_MESSAGE(number != number_types.end(), "no type that this test knows: " << type);
      ++numbers;
      const auto accepted = [&](const std::string& value) { return refusal(entry, option, value).empty(); };
      CHECK_MESSAGE(std::ranges::any_of(number->second.good, accepted), refusal(entry, option, number->second.good[0]));
      for (const auto* values : {&no_numbers, &number->second.wrong}) {
        for (const std::string& value : *values) {
          CAPTURE(value);
          CHECK_FALSE(accepted(value));
        }
      }
      if (type == "N") CHECK_FALSE(accepted("-1"));
    }
  }
  CHECK(numbers > 40);
  CHECK(usage_problem({"sim", "x.json", "--seed", "-1"}) != "");
  CHECK(usage_problem({"sim", "x.json", "--seed", "18446744073709551615"}) == "");
  for (const char* flag : {"--live=-1", "--live=70000", "--live=x", "--ros2=233", "--ros2=-2", "--ros2=1.5"})
    CHECK_MESSAGE(usage_problem({"sim", "x.json", flag}) != "", flag);
}

TEST_CASE("every command's --help ends with examples of its own, and each of them parses") {
  const CommandLine line;
  for (const CommandEntry& entry : commands_of(line)) {
    CAPTURE(entry.words);
    const std::vector<std::string> examples = examples_of(entry.command->help());
    CHECK_FALSE(examples.empty());
    for (const std::string& example : examples) {
      CAPTURE(example);
      CHECK(example.starts_with(entry.words));
      const std::string problem = usage_problem(shell_split(example));
      const bool needs_file = has(problem, "File does not exist");  // which an example above it leaves
      CHECK_MESSAGE((problem.empty() || needs_file), problem);
    }
  }
}

TEST_CASE("examples of --help work as they stand") {
  const auto project = project_copy("help_examples");
  REQUIRE(run("sim config/scenarios/squat.json --duration 4.5", project).exit_code == 0);
  REQUIRE(run("sim config/scenarios/fetch.json --duration 4", project).exit_code <= 1);  // cut off before it is done
  fs::copy(project / "squat.mcap", project / "again.mcap");
  const CommandLine line;
  std::size_t tried = 0;
  for (const CommandEntry& entry : commands_of(line)) {
    const bool quick = entry.words.starts_with("log ") || entry.words.starts_with("behavior ") ||
                       entry.words.starts_with("new ") || entry.words == "check" || entry.words == "params" ||
                       entry.words == "lua-stubs" || entry.words == "replay";
    if (!quick) continue;
    for (const std::string& example : examples_of(entry.command->help())) {
      CAPTURE(example);
      fs::remove_all(project / "knee_damper");
      for (const char* made : {"knees.csv", "squat.svg", "short.mcap", "ball.csv"}) fs::remove(project / made);
      const Outcome outcome = run(example, project);
      CHECK_MESSAGE(outcome.exit_code == 0, outcome.err);
      ++tried;
    }
  }
  CHECK(tried > 20);
}

}  // namespace commands_test
