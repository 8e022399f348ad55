#include "document.h"

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include <doctest/doctest.h>

#include "app/sim/input_files.h"

namespace kadans::document {

using namespace kadans::program;

std::vector<Block> blocks_of(const std::string& page) {
  std::vector<Block> blocks;
  std::istringstream lines(page);
  bool inside = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with("```")) {
      inside = !inside;
      const std::size_t space = line.find(' ');
      if (inside) {
        const std::string rest = space == std::string::npos ? "" : line.substr(space + 1);
        blocks.push_back({line.substr(3, space == std::string::npos ? space : space - 3), rest, "", number});
      }
    } else if (inside) {
      blocks.back().text += line + "\n";
    }
  }
  return blocks;
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

namespace {

// The physics of the pages is that of the golden hashes. With another architecture or build of Bullet the last digits
// are others: there, numbers may differ by a hundredth.
bool has_physics_of_pages() {
  return has(read(KADANS_SOURCE_DIR "/config/scenarios.golden.json"), "\"bullet\": \"" + bullet_build() + "\"");
}

bool is_alike(const std::string& shown, const std::string& line) {
  const char *a = shown.c_str(), *b = line.c_str();
  while (*a != 0 && *b != 0) {
    if (std::isdigit(static_cast<unsigned char>(*a)) != 0 && std::isdigit(static_cast<unsigned char>(*b)) != 0) {
      char *after_a = nullptr, *after_b = nullptr;
      const double x = std::strtod(a, &after_a), y = std::strtod(b, &after_b);
      if (!(std::abs(x - y) <= 0.01 * x)) return false;
      a = after_a;
      b = after_b;
    } else if (*a++ != *b++) {
      return false;
    }
  }
  return *a == *b;
}

bool shows_alike(const std::string& printed, const std::string& shown) {
  std::istringstream lines(printed);
  for (std::string line; std::getline(lines, line);) {
    if (is_alike(shown, line)) return true;
  }
  return false;
}

}  // namespace

void check_shown(const Block& block, const std::string& printed) {
  const bool exact = has_physics_of_pages();
  std::istringstream lines(block.text);
  for (std::string line; std::getline(lines, line);) {
    CAPTURE(line);
    CAPTURE(printed);
    CHECK((has(printed, line) || (!exact && shows_alike(printed, line))));
  }
}

void write_file(const Block& block, const std::filesystem::path& project) {
  if (has(block.rest, "/")) {
    write(project / block.rest, block.text);
    const Outcome checked = run("check " + block.rest, project);
    CAPTURE(checked.err);
    CHECK(checked.exit_code == 0);
    return;
  }
  const std::size_t first = block.text.find('\n') + 1;
  REQUIRE(first > 4);
  const std::string file = block.text.substr(3, first - 4);
  write(project / file, block.kind == "json" ? block.text.substr(first) : block.text);  // JSON knows no comments
  if (block.kind != "lua" || !block.rest.empty() || file.ends_with("_test.lua")) return;
  CHECK(run("behavior check " + file, project).exit_code == 0);
}

void check_page(const std::string& page, const std::string& folder) {
  const auto project = project_copy(folder);
  std::string printed;
  for (const Block& block : blocks_of(read(std::filesystem::path(KADANS_SOURCE_DIR) / "docs" / page))) {
    CAPTURE(block.line);
    if (block.kind == "text") {
      check_shown(block, printed);
    } else if (block.kind != "sh") {
      write_file(block, project);
    } else if (block.rest != "long" || std::getenv("KADANS_SOAK") != nullptr) {
      printed = run_commands(block, project);
    }
  }
}

}  // namespace kadans::document
