// docs/behaviors.md is true: its files are written into a copy of the project, its commands are run there, and what it
// shows is what they print. `# exits N` behind a command is the exit code it must have.
#include <algorithm>
#include <sstream>

#include <doctest/doctest.h>

#include "app/program.h"

using namespace kadans::program;

namespace {

struct Block {
  std::string kind, text;
  int line = 0;
};

std::vector<Block> blocks_of(const std::string& guide) {
  std::vector<Block> blocks;
  std::istringstream lines(guide);
  bool inside = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) blocks.push_back({line.substr(3), "", number});
    } else if (inside) {
      blocks.back().text += line + "\n";
    }
  }
  return blocks;
}

// The file that the block's first line names: "-- behaviors/x.lua".
std::string file_of(const Block& block) {
  const std::string first = block.text.substr(0, block.text.find('\n'));
  return first.size() > 3 ? first.substr(3) : "";
}

std::string run_commands(const Block& block, const std::filesystem::path& project) {
  std::string printed;
  std::istringstream lines(block.text);
  for (std::string line; std::getline(lines, line);) {
    CAPTURE(line);
    REQUIRE(line.starts_with("kadans "));
    const std::size_t note = line.find("# exits ");
    const int wanted = note == std::string::npos ? 0 : std::stoi(line.substr(note + 8));
    const Outcome outcome = run(line.substr(7, note == std::string::npos ? note : note - 7), project);
    INFO(outcome.out);
    INFO(outcome.err);
    CHECK(outcome.exit_code == wanted);
    printed += outcome.out + outcome.err;
  }
  return printed;
}

void check_shown(const Block& block, const std::string& printed) {
  std::istringstream lines(block.text);
  for (std::string line; std::getline(lines, line);) {
    CAPTURE(line);
    CAPTURE(printed);
    CHECK(has(printed, line));
  }
}

}  // namespace

TEST_CASE("every file of the guide is right, every command of it works and prints what it shows") {
  const auto project = project_copy("guide");
  std::string printed;
  for (const Block& block : blocks_of(read(KADANS_SOURCE_DIR "/docs/behaviors.md"))) {
    CAPTURE(block.line);
    if (block.kind == "sh") {
      printed = run_commands(block, project);
    } else if (block.kind == "text") {
      check_shown(block, printed);
    } else {
      const std::string file = file_of(block);
      REQUIRE_FALSE(file.empty());
      const bool json = block.kind == "json";  // which knows no comments
      write(project / file, json ? block.text.substr(block.text.find('\n') + 1) : block.text);
      if (block.kind != "lua" || file.ends_with("_test.lua")) continue;
      CHECK(run("behavior check " + file, project).exit_code == 0);
    }
  }
}

TEST_CASE("the guide is short") {
  const std::string guide = read(KADANS_SOURCE_DIR "/docs/behaviors.md");
  CHECK(std::count(guide.begin(), guide.end(), '\n') < 400);
}
